"""Shared parts of command lines: several values of an option, help of a task's name, refusals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Annotated, Any, TypeAlias

import typer
from typer.core import TyperCommand

from slipgym.registration import TASK_MODULES

TASK_HELP = (
    "Task: linear_slip, rotational_slip, hinge, planar_slip, hold, fragile_hold, carry, pivot_to or "
    "explore; LinearSlip, slipgym/LinearSlip-v0 or module:attribute name one, too."
)
TASKS = [module.rpartition(".")[2] for module in TASK_MODULES.values()]
"""Keys of the tasks that come with slipgym."""
Tasks: TypeAlias = Annotated[
    list[str] | None, typer.Argument(help=f"Of {', '.join(TASKS)} (also LinearSlip or ids); all if none.")
]
"""Argument of a command that takes several tasks."""


def processes(jobs: int) -> int:
    """Refuses a number of processes that is 0 or below -1."""
    if jobs < -1 or jobs == 0:
        raise typer.BadParameter("must be at least 1, or -1 for one per core")
    return jobs


Jobs: TypeAlias = Annotated[
    int, typer.Option(help="Processes; -1: one per core. Changes no result.", callback=processes)
]
"""Option of a command that works in several processes."""


def expanded(arguments: Sequence[str], several: Sequence[str]) -> list[str]:
    """The arguments with the name of an option that takes several values, as in `--seeds 0 1 2`, before each.

    Args:
        arguments: Of a command line.
        several: Names of the options, with their dashes.
    """
    found, option = [], ""
    for argument in arguments:
        if argument.startswith("--"):
            option = argument if argument in several else ""
            found.append(argument)
        else:
            found += [option, argument] if option and found[-1] != option else [argument]
    return found


def taking_several(*names: str) -> type[TyperCommand]:
    """A class of commands whose options of these names take several values."""

    class Command(TyperCommand):
        def parse_args(self, ctx: typer.Context, args: list[str]) -> list[str]:  # type: ignore[override]
            return super().parse_args(ctx, expanded(args, names))

    return Command


@contextmanager
def usage_errors(*kinds: type[Exception], extra: str = "", hint: str | None = None) -> Iterator[None]:
    """Refuses the command line with the message of an error.

    Args:
        kinds: Of the errors.
        extra: An extra of slipgym; where a package is missing, the message says how to install it.
        hint: Name of the option that is wrong.

    Raises:
        typer.BadParameter: In place of an error of these kinds.
    """
    caught = (*kinds, ModuleNotFoundError) if extra else kinds
    try:
        yield
    except caught as error:
        message = str(error)
        if extra and isinstance(error, ModuleNotFoundError) and "pip install" not in message:
            message = f"{error.name} is not installed: pip install 'slipgym[{extra}]'"
        raise typer.BadParameter(message, param_hint=hint) from error


def environment_arguments(texts: Sequence[str]) -> dict[str, Any]:
    """Reads `name=value` pairs; the value in `friction_source=true` is a name.

    Dotted keys are those of nested values, and "environment." may stand before them as in a training.

    Args:
        texts: Such as ["friction_source=true", "config.tasks.hold.tolerance=0.001"].

    Raises:
        ValueError: One has no "=", or its value is no YAML.
    """
    from estimator.records import parse_settings
    from policies.training.files import with_values
    from slipgym.config.base import as_name

    values = with_values({}, parse_settings([text.removeprefix("environment.") for text in texts]))
    return {key: as_name(value) if key == "friction_source" else value for key, value in values.items()}
