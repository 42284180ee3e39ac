"""Prints what each sensor preset costs the controllers of Hold, FragileHold and Carry at level hard.

Every policy plays the same episodes with every preset. A policy that needs more than a preset measures has
no figure. `--policy` enters learned policies, see `slipgym train --set environment.sensors=wrist`.
"""

from __future__ import annotations

import contextlib
from typing import Annotated

import pandas as pd
import typer

from lab.commands.options import wrong_arguments
from policies.policy_leaderboard.entries import (
    LEARNED,
    Member,
    best_constant,
    controllers,
    entered,
    learned,
    remembering,
)
from policies.policy_leaderboard.run import kinds, outcomes, play_all
from slipgym.config import load
from slipgym.config.level import load_level
from slipgym.tasks import find

PRESETS = "realistic", "lab", "markers", "wrist", "motor"
TASKS = "Hold", "FragileHold", "Carry"
SHOWN = "controller, estimated", "controller, none"
KINDS = LEARNED | {name: f"recurrent, trained on {name}" for name in ("markers", "wrist")}
"""Kinds of policies that come with slipgym, as `LEARNED` has them."""


def members(task: str, arguments: dict[str, str], episodes: int, names: list[str]) -> list[Member]:
    """The best constant grip with these sensors, the task's controller, the memories, the user's policies."""
    key = find(task).key
    own = [each for each in controllers(key) if each.name in SHOWN]
    with contextlib.suppress(ValueError):  # these sensors measure no slip
        own.append(remembering(task, arguments, episodes))
    own += [each for each in learned(key, KINDS) if each.arguments["friction_source"] == "none"]
    return [best_constant(task, arguments, episodes), *own, *entered(names, "none")]


def main(
    episodes: Annotated[int, typer.Option(min=10, help="Of each task, preset and policy.")] = 200,
    level: Annotated[str, typer.Option(help="Level of difficulty.")] = "hard",
    task: Annotated[list[str] | None, typer.Option(help="Tasks; repeatable.")] = None,
    preset: Annotated[list[str] | None, typer.Option(help="Presets; repeatable.")] = None,
    policy: Annotated[list[str] | None, typer.Option(help="Learned policies; repeatable.")] = None,
) -> None:
    """Print what is solved [%], a row for each task and policy, a column for each preset."""
    with wrong_arguments():
        tasks = [find(name).name for name in task or TASKS]
        for name in tasks:
            load_level(level, find(name).key)
        for chosen in preset or PRESETS:
            load(sensors=chosen)
    rows = []
    for name in tasks:
        for chosen in preset or PRESETS:
            given = {"sensors": chosen, "level": level}
            for member in members(name, given, episodes, policy or []):
                try:
                    played = play_all(name, level, [member], episodes, {"sensors": chosen}, progress=False)
                except ValueError:  # it needs more than these sensors measure, or was trained on others
                    continue
                table = outcomes(name, level, played)
                rows.append(table.assign(sensors=chosen, policy=kinds(table)))
    whole = pd.concat(rows)
    wide = whole.pivot_table(index=["task", "policy"], columns="sensors", values="solved [%]", sort=False)
    typer.echo(wide[[name for name in PRESETS if name in wide]].round(1).to_string(na_rep="-"))
