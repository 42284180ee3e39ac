"""Compares controllers tuned on an identified and on the true gripper; both are played on the true one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

import policies
from lab.simulated_gripper import HiddenGripper, draw_gripper, simulated_log
from policies.evaluation.play import Played, play_episodes
from slipgym.identification import identify
from slipgym.identification.fit import Result
from slipgym.identification.parameters import NAMES, PARAMETERS
from slipgym.identification.report import MATERIAL, overrides

CANDIDATES = tuple(product((0.7, 0.85, 1.0, 1.2, 1.5, 2.0), (0.5, 1.0, 2.0)))
"""Gains that are tried: `margin` and `reserve` of the controller of Hold."""
TUNED_ON = range(10_000, 10_200)
JUDGED_ON = range(400)
"""Seeds of the episodes."""
SOURCES = "nominal", "estimated"
"""Friction that the controller reads: the gripper's nominal one, or the estimate."""


def rows(seeds: range) -> Iterator[str]:
    """A line per gripper and friction source, and one for each source over all grippers."""
    losses: dict[str, list[float]] = {source: [] for source in SOURCES}
    for seed in seeds:
        hidden = draw_gripper(seed)
        result = identify(simulated_log(hidden, seed))
        found, true = (_gripper(overrides(each)) for each in (result, _truth(result, hidden)))
        for source in SOURCES:
            mine, best = _tuned(found, source), _tuned(true, source)
            # the laboratory does not know its gripper's friction: the nominal values are the identified ones
            known = {**true, "nominal": found["nominal"]}
            reached = 100.0 * _play(known, source, mine, JUDGED_ON).success.mean()
            possible = 100.0 * _play(true, source, best, JUDGED_ON).success.mean()
            losses[source].append(possible - reached)
            yield (
                f"{seed:4d}  friction {source:9s}  tuned on the identified gripper {mine}: {reached:5.1f} %  "
                f"on the true one {best}: {possible:5.1f} %"
            )
    for source, lost in losses.items():
        spread = np.std(lost, ddof=1) / np.sqrt(len(lost)) if len(lost) > 1 else np.nan
        yield f"friction {source}: {np.mean(lost):.1f} points lost ± {spread:.1f}, {max(lost):.1f} at most"


def _truth(result: Result, hidden: HiddenGripper) -> Result:
    """The result of a fit that found the gripper as it is."""
    values = np.array([hidden.values[name] for name in NAMES])
    logs = np.array([each.log for each in PARAMETERS])
    point = np.where(logs, np.log(np.where(logs, values, 1.0)), values)
    return replace(result, point=point, noise=hidden.noise, shown=np.ones(len(NAMES), bool))


def _gripper(values: Mapping[str, Any]) -> dict[str, Any]:
    """The configuration with pads without cells, on which environments are some eighty times faster."""
    return {**values, "contact": {**values["contact"], "model": "disc"}}


def _tuned(config: Mapping[str, Any], source: str) -> tuple[float, float]:
    """The gains that solve most episodes, with the largest return among equals."""
    return max(CANDIDATES, key=lambda gains: _play(config, source, gains, TUNED_ON).strength)


def _play(config: Mapping[str, Any], source: str, gains: tuple[float, float], seeds: range) -> Played:
    margin, reserve = gains
    policy = policies.make("hold", margin=margin, reserve=reserve, config=config)
    arguments = {"level": "hard", "material": MATERIAL, "config": config, "friction_source": source}
    return play_episodes("hold", policy, {**arguments, **policies.modes(policy)}, seeds)
