"""Prints what each sensor preset costs the controllers of Hold, FragileHold and Carry at level hard.

Every policy plays the same episodes with every preset. A policy that needs more than a preset measures has
no figure. `--policy` enters learned policies, see `slipgym train --set environment.sensors=wrist`.
"""

from __future__ import annotations

from typing import Annotated

import pandas as pd
import typer

import policies
from policies.policy_leaderboard.entries import Member, best_constant, controllers, entered, remembering
from policies.policy_leaderboard.run import kinds, outcomes
from slipgym.tasks import find

PRESETS = "realistic", "lab", "markers", "wrist", "motor"
TASKS = "Hold", "FragileHold", "Carry"
LIFTS = {"noise": 0.4, "guess": 0.6, "least": 1.5}
WIDER = {
    ("Hold", "markers"): {"doubt": 0.0, "exploration": None},
    ("FragileHold", "markers"): {**LIFTS, "speed": 5e-3},
    ("FragileHold", "wrist"): LIFTS,
    ("Carry", "markers"): {**LIFTS, "speed": 5e-3},
    ("Carry", "wrist"): LIFTS,
}
"""Gains of the controllers with thresholds above the noise of these sensors, found by a handful of tries."""
SHOWN = "controller, estimated", "controller, none", "controller, memory of slips"


def members(task: str, arguments: dict[str, str], episodes: int, names: list[str]) -> list[Member]:
    """The best constant grip with these sensors, the task's controller with them, and the user's policies."""
    key = find(task).key
    own = [*controllers(key), remembering(key)]
    mine = entered(names, "none")
    if (find(task).name, arguments["sensors"]) in WIDER:
        wider = policies.make(key, **WIDER[find(task).name, arguments["sensors"]])
        mine.append(
            Member(
                "controller, wider thresholds",
                wider,
                {**policies.modes(wider), "friction_source": "estimated"},
            )
        )
    return [best_constant(task, arguments, episodes), *(each for each in own if each.name in SHOWN), *mine]


def main(
    episodes: Annotated[int, typer.Option(min=10, help="Of each task, preset and policy.")] = 200,
    level: Annotated[str, typer.Option(help="Level of difficulty.")] = "hard",
    task: Annotated[list[str] | None, typer.Option(help="Tasks; repeatable.")] = None,
    preset: Annotated[list[str] | None, typer.Option(help="Presets; repeatable.")] = None,
    policy: Annotated[list[str] | None, typer.Option(help="Learned policies; repeatable.")] = None,
) -> None:
    """Print what is solved [%], a row for each task and policy, a column for each preset."""
    rows = []
    for name in task or TASKS:
        for chosen in preset or PRESETS:
            given = {"sensors": chosen, "level": level}
            for member in members(name, given, episodes, policy or []):
                try:
                    table = outcomes(name, level, [member], episodes, {"sensors": chosen}, progress=False)
                except (
                    ValueError
                ):  # these sensors do not measure what it needs, or not what it was trained on
                    continue
                rows.append(table.assign(sensors=chosen, policy=kinds(table)))
    whole = pd.concat(rows)
    wide = whole.pivot_table(index=["task", "policy"], columns="sensors", values="solved [%]", sort=False)
    typer.echo(wide[[name for name in PRESETS if name in wide]].round(1).to_string(na_rep="-"))
