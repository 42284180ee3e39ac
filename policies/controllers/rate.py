"""Configures controllers to act less often than 120 times a second."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from slipgym.config.load import merge


def at_rate(rate: float, config: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Configuration of a controller that acts at another rate than the environment's control steps.

    Args:
        rate: Actions per second, rounded to whole ones [Hz].
        config: Overrides of the environment's configuration.

    Returns:
        The overrides with that rate as the control rate and as the rate of the slip sensor.
    """
    each = round(rate)
    return merge(config or {}, {"physics": {"control_rate": each}, "sensors": {"slip": {"rate": each}}})
