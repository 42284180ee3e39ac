"""Compares the planar engine with PyBullet: the same actions, and the same controllers."""

from typing import Annotated

import typer

from slipgym.registration import TASK_MODULES

TASKS = [module.rpartition(".")[2] for module in TASK_MODULES.values()]
EPILOG = """
Examples:\n
\b
  slipgym compare-engines hinge --trials 20
  slipgym compare-engines --randomization lab
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    experiments: Annotated[
        list[str] | None,
        typer.Argument(help=f"Experiments; {', '.join(TASKS)} (or LinearSlip) if none.", show_default=False),
    ] = None,
    trials: Annotated[int, typer.Option(min=1, help="Trials of each.")] = 200,
    sensors: Annotated[str, typer.Option(help="Sensor preset.")] = "realistic",
    randomization: Annotated[
        str, typer.Option(help="Randomization preset; lab has soft pads and unlike fingers.")
    ] = "none",
) -> None:
    """Prints how far apart the episodes of both engines end, and how often they succeed."""
    from lab.engines import compare
    from policies.evaluation import load_experiment
    from policies.evaluation.frames import markdown

    try:
        changes = {"sensors": sensors, "randomization": randomization}
        chosen = [load_experiment(name).model_copy(update=changes) for name in experiments or TASKS]
    except (ValueError, FileNotFoundError) as error:
        raise typer.BadParameter(str(error)) from error
    for experiment in chosen:
        typer.echo(markdown(compare(experiment, trials), 3))
