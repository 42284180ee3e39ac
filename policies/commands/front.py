"""The command `slipgym`: finds the sub-command and loads its file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from importlib import import_module
from importlib.metadata import PackageNotFoundError, requires
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any

try:
    import typer
    from typer.core import TyperGroup
except ModuleNotFoundError as error:
    raise SystemExit("typer is not installed: pip install 'slipgym[eval]'") from error

from policies.console import spell_out

COMMANDS = {
    "demo": "Show what friction is worth: about a minute.",
    "play": "Watch a policy in a window, or write a video.",
    "train": "Train slip-control policies.",
    "evaluate": "Compare policies by the friction they know; test one.",
    "study": "Study what friction information is worth.",
    "imitate": "Train a network that imitates a controller.",
    "demonstrate": "Store episodes of a policy as a Minari dataset.",
    "leaderboard": "Rank the estimators on the same records.",
    "policy-leaderboard": "Rank policies on the same episodes.",
    "estimate": "Run an estimator on a record of your gripper.",
    "map": "Propose which columns of a log are what.",
    "live": "Estimate, and command a grip, while a gripper runs.",
    "identify": "Fit the simulator to a log of your gripper.",
    "data": "List or fetch public data of real contacts.",
    "record": "Write what a finger's sensors read in an episode.",
    "validate": "Check the physics against its acceptance figures.",
    "benchmark": "Measure the speed of the environments.",
    "warmup": "Compile everything once, for images and CI.",
    "export-policy": "Write a learned policy as an ONNX graph.",
    "import-policy": "Read a zip of Stable-Baselines3 safely.",
}
"""Name of each sub-command and its line of help."""
LABORATORY = "lab.commands"
"""Sub-commands that only a clone of the repository has."""
OF_THE_LABORATORY = {
    "benchmark-parts", "cards", "closed-loop", "compare-engines", "compare-estimators", "compare-simulators",
    "delays", "estimate-and-memory", "estimator-costs", "fuzz", "hidden-grippers", "imperfections",
    "install-sizes", "jumps", "live-bars", "pushes", "rank", "reproduce", "seeds", "sensor-bounds",
    "sensor-costs", "ship", "study-report", "train-estimator", "validate-parts", "validate-real",
}  # fmt: skip
"""Their names, for a message where they are not installed."""
EPILOG = """
Examples:\n
\b
  slipgym demo
  slipgym play rotational_slip --video turn.gif
  slipgym evaluate planar_slip --trials 20
  slipgym train linear_slip_plain
  slipgym estimate log.csv --columns columns.yaml
\n
slipgym COMMAND --help explains a command and shows examples.
"""


_OWN = "slipgym", "estimator", "policies", "lab"
_SMALL = "cli", "eval", "records"
"""Extras that others contain, the smallest first."""


class _Front(TyperGroup):
    """The sub-commands; one of the laboratory is refused with what it needs."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        for name in (args[0], "-".join(args[:2])):  # "validate real" is validate-real
            if name in OF_THE_LABORATORY and name not in ALL:
                ctx.fail(
                    f"{name!r} is a command of the laboratory, which only a clone of the repository has: "
                    "pip install -e . there (docs/install.md)"
                )
        return super().resolve_command(ctx, args)


app = typer.Typer(
    cls=_Front, epilog=EPILOG, no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False
)


def _of_the_clone() -> dict[str, str]:
    """Name and line of help of each sub-command of the laboratory; none outside of a clone."""
    root = Path(__file__).parents[2]
    found = find_spec(LABORATORY.partition(".")[0])
    if found is None or found.origin is None or not (root / "pyproject.toml").is_file():
        return {}
    if Path(found.origin).parent.parent.resolve() != root.resolve():
        return {}
    return import_module(LABORATORY).COMMANDS


def application(name: str) -> typer.Typer:
    """The sub-command of a name.

    Args:
        name: One of `COMMANDS`, or of the laboratory.
    """
    package = "policies.commands" if name in COMMANDS else LABORATORY
    return import_module(f"{package}.{name.replace('-', '_')}").app


def _add(name: str, line: str) -> None:
    @app.command(
        name,
        help=line,
        add_help_option=False,  # the file has its own
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    )
    def call(ctx: typer.Context) -> None:
        parent = ctx.parent.info_name if ctx.parent else "slipgym"
        called, arguments = name, ctx.args
        if arguments and f"{name}-{arguments[0]}" in ALL:  # "validate real" is validate-real
            called, arguments = f"{name}-{arguments[0]}", arguments[1:]
        try:
            application(called)(args=arguments, prog_name=f"{parent} {called}")
        except ModuleNotFoundError as error:
            if not error.name or error.name.partition(".")[0] in _OWN:
                raise
            ctx.fail(f"{error.name} is not installed: pip install 'slipgym[{_extra_of(error.name)}]'")


def _extra_of(module: str) -> str:
    """The smallest extra of slipgym that a module comes with; "eval", if none says so."""
    try:
        lines = requires("slipgym") or []
    except PackageNotFoundError:
        lines = []
    named = re.compile(rf"{re.escape(module.partition('.')[0])}\b.*extra *== *['\"]([\w-]+)", re.IGNORECASE)
    found = [match[1] for line in lines if (match := named.match(line))]
    return next((each for each in (*_SMALL, *found) if each in found and each != "dev"), "eval")


def _version(wanted: bool) -> None:
    if wanted:
        import slipgym

        typer.echo(f"slipgym {slipgym.__version__}")
        raise typer.Exit


@app.callback()
def front(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Slip-aware in-hand manipulation with a friction estimator in the loop."""


ALL = COMMANDS | _of_the_clone()
"""Sub-commands that this installation has."""
for _name, _line in ALL.items():
    _add(_name, _line)


def main(arguments: Sequence[str] | None = None) -> None:
    """Calls the sub-command that a command line names.

    Args:
        arguments: Instead of the command line's.
    """
    spell_out()
    app(args=arguments, prog_name="slipgym")
