"""Controllers whose gains are declared once, with units and ranges, and set by keyword."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Generic, TypeVar

from pydantic import Field

from policies.controllers.base import ForcePolicy
from policies.controllers.sensing import ConservativePrior
from slipgym.config import Overrides
from slipgym.config.base import Frozen
from slipgym.config.yaml_model import validate

G = TypeVar("G", bound=Frozen)
Fraction = Annotated[float, Field(ge=0, lt=1)]
"""A fraction in [0, 1)."""
RENAMED = {"caution": "prior", "probe": "exploration", "worth": "least"}
"""Keyword of version 0.1.0 -> its present name; the old ones go in the version after the next."""


def Gain(default: Any, description: str, **limits: Any) -> Any:
    """A gain with its default, its meaning with the unit in brackets, and limits as of pydantic's `Field`."""
    return Field(default=default, description=description, **limits)


class GainPolicy(ForcePolicy, Generic[G]):
    """A controller with gains, and a conservative prior for friction that is not known yet.

    Args:
        gains: All gains; None: the class's defaults.
        prior: Friction assumed until the estimate has confidence; None: the class's own.
        config: Overrides of the environment's configuration.
        **parameters: Single gains by name, which replace those of `gains`.

    Raises:
        ValueError: A gain is unknown or out of range, or the configuration is not valid.
    """

    Gains: ClassVar[type[Frozen]]
    """Model of the gains: names, units, ranges and defaults."""
    prior_default: ClassVar[ConservativePrior] = ConservativePrior()
    """The class's own prior."""
    acts_on_friction = True
    remembers_slips: ClassVar[bool] = False
    """Whether it acts on its own memory of slips as long as no friction is observed."""

    def __init__(
        self,
        gains: G | None = None,
        prior: ConservativePrior | None = None,
        config: Overrides | None = None,
        **parameters: Any,
    ) -> None:
        super().__init__(config)
        parameters = renamed(parameters)
        prior = parameters.pop("prior", prior)
        values = {} if gains is None else gains.model_dump()
        self.gains: G = validate({**values, **parameters}, self.Gains, type(self).__name__)  # type: ignore[assignment]
        self.prior = prior or self.prior_default
        self._dt = 1.0 / self.config.physics.control_rate
        self._prepare(config)

    def _prepare(self, config: Overrides | None) -> None:
        """Set what follows from gains, prior and configuration, of which `config` holds the overrides."""

    @property
    def modes(self) -> dict[str, Any]:
        """Keyword arguments of its environments: it reads the deviations of the estimates."""
        return {"action_mode": self.action_mode, "observation_mode": "deviations"}


def renamed(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters by their present names; warns about names of version 0.1.0."""
    found = {}
    for name, value in parameters.items():
        if name in RENAMED:
            warnings.warn(
                f"the controllers' parameter {name!r} is now {RENAMED[name]!r}",
                DeprecationWarning,
                stacklevel=3,
            )
        found[RENAMED.get(name, name)] = value
    return found
