"""Studies the benefit of friction information: controllers and learned policies with and without it."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import Jobs, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym study quick
  slipgym study full --jobs 2
  slipgym study full --episodes 20 --task linear_slip --task hold
  slipgym study my_study.yaml --learned runs/policies
\n
A study is a YAML file; configs/studies/ holds quick, short, full, hard and hard_lab, and docs/study.md says
what their keys mean. A study that was broken off goes on where it stopped; one that has changed runs only
what is new.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    study: Annotated[str, typer.Argument(help="Name of a study, or the path of a YAML file.")] = "quick",
    episodes: Annotated[
        int | None, typer.Option(min=1, help="Episodes per block instead of the study's.")
    ] = None,
    task: Annotated[
        list[str] | None,
        typer.Option(help="Keep only this task: linear_slip, also LinearSlip or its id; repeatable."),
    ] = None,
    kind: Annotated[
        list[str] | None,
        typer.Option(help="Only classic, memory, recurrent, learned or imitation; repeatable."),
    ] = None,
    learned: Annotated[str, typer.Option(help="Folder of learned policies instead of those shipped.")] = "",
    imitation: Annotated[str, typer.Option(help="Folder of the runs of slipgym imitate.")] = "",
    jobs: Jobs = -1,
    output: Annotated[Path, typer.Option(help="Folder for the study's own folder.")] = Path("runs"),
    seed: Annotated[int | None, typer.Option(min=0, help="Seed instead of the study's.")] = None,
) -> None:
    """Run a study and write its tables."""
    with usage_errors(extra="eval"):
        from policies import study as studies
    with usage_errors(ValueError, OSError):
        chosen = studies.narrowed(
            studies.load_study(study),
            episodes=episodes,
            tasks=task,
            kinds=kind,
            learned=learned,
            imitation=imitation,
            seed=seed,
        )
        folder = studies.run_study(chosen, output, jobs)
    typer.echo("\n" + studies.words(chosen, folder))
