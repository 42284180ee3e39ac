"""Compares the pretrained policies with the controllers and with the best constant grip."""

from typing import Annotated

import typer

from policies.commands.several import Tasks

EPILOG = """
Examples:\n
\b
  slipgym compare-learned rotational_slip --trials 50
  slipgym compare-learned --engine planar
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    tasks: Tasks = None,
    trials: Annotated[int, typer.Option(min=2, help="Episodes of each policy.")] = 200,
    engine: Annotated[str, typer.Option(help="What moves the bodies: bullet or planar.")] = "bullet",
    randomization: Annotated[str, typer.Option(help="A preset or a YAML file.")] = "train",
    jobs: Annotated[int, typer.Option(help="Processes; -1: one per core.")] = 1,
) -> None:
    """Prints what each policy achieves in the same episodes, what learning adds, what friction adds."""
    from lab import compare_learned
    from policies.leaderboard.tables import markdown

    try:
        for task in tasks or compare_learned.learned_tasks():
            found = compare_learned.trials_of(task, trials, engine, randomization, jobs)
            tables = (
                compare_learned.outcomes(found),
                compare_learned.gains(found),
                compare_learned.benefit(found),
            )
            typer.echo("\n".join([f"\n{task}\n", *(markdown(table) for table in tables if len(table))]))
    except (ValueError, FileNotFoundError) as error:
        raise typer.BadParameter(str(error)) from error
