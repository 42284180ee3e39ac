"""The command `slipgym`: finds the sub-command and loads its file."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Annotated

try:
    import typer
except ModuleNotFoundError as error:
    raise SystemExit("typer is not installed: pip install 'slipgym[eval]'") from error

from policies.console import spell_out

COMMANDS = {
    "demo": "Run a short evaluation with figures: about a minute.",
    "play": "Watch a policy in a window, or write a video.",
    "train": "Train slip-control policies.",
    "evaluate": "Compare policies by the friction they know; test one.",
    "study": "Study what friction information is worth.",
    "imitate": "Train a network that imitates a controller.",
    "train-estimator": 'Train the network of the estimator "gru".',
    "leaderboard": "Rank the estimators on the same records.",
    "policy-leaderboard": "Rank policies on the same episodes.",
    "estimate": "Run an estimator on a record of your gripper.",
    "record": "Write what a finger's sensors read in an episode.",
    "reproduce": "Reproduce the paper's analyses.",
    "validate": "Check the physics; compare with other engines.",
    "benchmark": "Measure the speed of the environments.",
    "warmup": "Compile everything once, for images and CI.",
    "compare-engines": "Compare the planar engine with PyBullet.",
    "compare-learned": "Compare pretrained policies with controllers.",
    "rank": "Compare the order of returns with that of success.",
    "export-policy": "Write a learned policy as an ONNX graph.",
    "import-policy": "Read a zip of Stable-Baselines3 safely.",
    "pushes": "Compare the estimators on real pushes of a block.",
    "ship": "Add trained policies to the pretrained ones.",
}
"""Name of each sub-command and its line of help."""
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


app = typer.Typer(epilog=EPILOG, no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False)


def _add(name: str, line: str) -> None:
    @app.command(
        name,
        help=line,
        add_help_option=False,  # the file has its own
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    )
    def call(ctx: typer.Context) -> None:
        module = import_module(f"policies.commands.{name.replace('-', '_')}")
        module.app(args=ctx.args, prog_name=f"{ctx.parent.info_name if ctx.parent else 'slipgym'} {name}")


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


for _name, _line in COMMANDS.items():
    _add(_name, _line)


def main(arguments: Sequence[str] | None = None) -> None:
    """Calls the sub-command that a command line names.

    Args:
        arguments: Instead of the command line's.
    """
    spell_out()
    app(args=arguments, prog_name="slipgym")
