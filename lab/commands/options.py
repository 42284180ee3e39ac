"""Shares between the laboratory's commands: common options, errors of ours as errors of the command line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, TypeAlias

import typer

Episodes: TypeAlias = Annotated[int, typer.Option(min=1, help="Episodes of each combination.")]
Quick: TypeAlias = Annotated[
    bool, typer.Option("--quick", help="A few coarse records, to see that it works.")
]
Seed: TypeAlias = Annotated[int, typer.Option(min=0, help="Of the sensors' noise.")]


def application() -> typer.Typer:
    """A command without completion, colours and traces of its own."""
    return typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@contextmanager
def wrong_arguments() -> Iterator[None]:
    """Turns what is wrong with the arguments' values into a usage error.

    Raises:
        typer.BadParameter: A ValueError, an OSError or a missing package of the extra train within.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        raise typer.BadParameter(f"{error.name} is not installed: pip install 'slipgym[train]'") from error
    except (ValueError, OSError) as error:
        raise typer.BadParameter(str(error)) from error
