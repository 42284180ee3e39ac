"""Trains a network that imitates the controller with the true friction."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import TASK_HELP, taking_several, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym imitate planar_slip
  slipgym imitate hinge --friction-source estimated --network memoryless
  slipgym imitate hold --seeds 0 1 2 --sensors lab --randomization lab
\n
A network with memory and friction_source none sees sensors alone: what a policy can do that is given no
friction. Training takes a few minutes of one processor; it needs the extra train. See docs/imitation.md.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--seeds", "--set"))
def main(
    task: Annotated[str, typer.Argument(help=TASK_HELP)],
    network: Annotated[
        str, typer.Option(help="Name of a file in configs/imitation, or path of a YAML file.")
    ] = "recurrent",
    friction_source: Annotated[str | None, typer.Option(help="What the network observes.")] = None,
    sensors: Annotated[str | None, typer.Option(help="Sensor preset.")] = None,
    randomization: Annotated[str | None, typer.Option(help="A preset or a YAML file.")] = None,
    seeds: Annotated[list[int] | None, typer.Option(help="One or several.  [default: 0]")] = None,
    set_: Annotated[
        list[str] | None, typer.Option("--set", help="key=value, dotted; one or several.")
    ] = None,
    output: Annotated[Path, typer.Option(help="Folder for the runs' own folders.")] = Path("runs/imitation"),
) -> None:
    """Play rounds of episodes, fit the network, write it as a policy."""
    from policies.training.imitation.command import configured, imitated

    given = {"friction_source": friction_source, "sensors": sensors, "randomization": randomization}
    with usage_errors(ValueError, FileNotFoundError):
        config = configured(network, task, given, set_ or [])
    with usage_errors(FloatingPointError, OSError, extra="train"):
        for line in imitated(config, seeds or [0], output):
            typer.echo(line)
