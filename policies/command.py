"""The command `slipgym-evaluate`: a policy in its environment, in any folder, without further packages."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from typing import Any

import policies
from estimator.records import parse_settings
from policies.console import spell_out
from policies.episodes import FRESH, episodes

SPELLINGS = "linear_slip, for example; LinearSlip, slipgym/LinearSlip-v0 or module:attribute name a task, too"
EPILOG = """
examples:
  slipgym-evaluate linear_slip
  slipgym-evaluate hold --episodes 20 --set friction_source=true material=wood engine=planar
  slipgym-evaluate runs/hold__ppo__20260101-120000-000/estimated__0/policy --set randomization=eval_ood

Tables, intervals and figures: scripts/evaluate.py of the sources (docs/evaluation.md).
"""


def main(arguments: Sequence[str] | None = None) -> None:
    """Evaluates what the command line names.

    Args:
        arguments: Instead of the command line's.
    """
    spell_out()
    parser = argparse.ArgumentParser(
        "slipgym-evaluate",
        usage="slipgym-evaluate POLICY [OPTIONS]",
        description="Run episodes on held-out seeds; a learned policy's in the environment of its training.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    known = ", ".join(policies.names())
    parser.add_argument("policy", help=f"folder of a learned policy, module:class, or one of {known}")
    parser.add_argument("--episodes", type=int, default=100, help="how many (default: 100)")
    fresh = f"number of the first held-out seed (default: {FRESH}, which no training chooses by)"
    parser.add_argument("--first", type=int, default=FRESH, help=fresh)
    parser.add_argument("--task", help=f"for a controller that serves every task: {SPELLINGS}")
    parser.add_argument(
        "--set",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=VALUE",
        help="arguments of the environment instead of those of the training",
    )
    given = parser.parse_args(arguments)
    if given.episodes < 1 or given.first < 0:
        parser.error("--episodes must be a whole number >= 1 and --first one >= 0")
    try:
        print(
            outcome_of(
                given.policy, given.episodes, given.first, given.task, environment_arguments(given.set)
            )
        )
    except (FileNotFoundError, TypeError, ValueError) as error:
        parser.error(str(error))


def environment_arguments(texts: Sequence[str]) -> dict[str, Any]:
    """Reads `name=value` pairs; `friction_source=true` is a name, which YAML takes for a truth value.

    Args:
        texts: Such as ["friction_source=true", "engine=planar"].

    Raises:
        ValueError: One has no "=", or its value is no YAML.
    """
    values = parse_settings(texts)
    if values.get("friction_source") is True:
        values["friction_source"] = "true"
    return values


def outcome_of(policy: str, count: int, first: int, task: str | None, changes: Mapping[str, Any]) -> str:
    """Runs episodes of a policy in its environment; returns a line with its success and means.

    Args:
        policy: Folder of a learned policy, module:class, or a name.
        count: Number of episodes.
        first: Number of the first held-out seed.
        task: For a controller that serves every task.
        changes: Arguments of the environment instead of those of the training.

    Raises:
        FileNotFoundError: There is no such policy.
        TypeError: An argument of the environment is of the wrong type.
        ValueError: A name or value is wrong.
    """
    found = []
    for outcome in episodes(policy, count, first, task, changes):
        found.append(outcome)
        if sys.stderr.isatty():
            print(f"\repisode {len(found)} of {count}", end="", file=sys.stderr)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    n = len(found)
    solved, dropped = sum(one.success for one in found), sum(one.dropped for one in found)
    reward, time = (sum(getattr(one, name) for one in found) / n for name in ("reward", "time"))
    means = f"means: reward {reward:.2f}, time {time:.2f} s"
    return f"{policy}: solved {solved} of {n}, dropped {dropped}; {means}"


if __name__ == "__main__":
    main()
