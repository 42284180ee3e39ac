"""Trains slip-control policies."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import processes, taking_several, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym train linear_slip
  slipgym train linear_slip_plain --algorithm sac --budget 300000
  slipgym train linear_slip_plain --seeds 0 1 2 --friction-source estimated true none --jobs 2
  slipgym train linear_slip_plain --set ppo.gamma=0.98 num_envs=16
  slipgym train --resume runs/linear_slip__ppo__20260101-120000-000
  slipgym train linear_slip_plain --sweep 20 --ray local
\n
A configuration is a YAML file; configs/training/ holds those that come with slipgym, and docs/training.md
says what their keys mean and what a run writes.
"""
_RUNS = Path("runs")
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--seeds", "--friction-source", "--set"))
def main(
    configuration: Annotated[
        str | None,
        typer.Argument(
            help="Name of a configuration, or path of a YAML file; linear_slip and LinearSlip are "
            "linear_slip_scratch."
        ),
    ] = None,
    task: Annotated[
        str | None,
        typer.Option(help="Task, instead of the configuration's: linear_slip, also LinearSlip or its id."),
    ] = None,
    algorithm: Annotated[
        str | None, typer.Option(help="ppo, recurrent_ppo, sac, tqc or privileged_ppo.")
    ] = None,
    friction_source: Annotated[list[str] | None, typer.Option(help="One or several: runs with each.")] = None,
    randomization: Annotated[str | None, typer.Option(help="A preset or a YAML file.")] = None,
    seeds: Annotated[
        list[int] | None, typer.Option(help="One or several: a run for each.  [default: 0]")
    ] = None,
    budget: Annotated[int | None, typer.Option(help="Steps of all environments together.")] = None,
    set_: Annotated[
        list[str] | None, typer.Option("--set", help="key=value, dotted; one or several.")
    ] = None,
    jobs: Annotated[int, typer.Option(help="Runs at once; -1: one per core.", callback=processes)] = 1,
    ray: Annotated[str, typer.Option(help="Run on Ray: local, or a cluster's address.")] = "",
    sweep: Annotated[int, typer.Option(min=0, help="Search hyperparameters with as many runs.")] = 0,
    resume: Annotated[Path | None, typer.Option(help="Folder of a run or study to go on with.")] = None,
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = _RUNS,
) -> None:
    """Train policies, one run for each seed and friction source; each keeps checkpoints and its curve."""
    from policies.training import files

    options = {
        "task": task,
        "algorithm": algorithm,
        "environment.randomization": randomization,
        "budget": budget,
    }
    sources, sets = friction_source or [], set_ or []
    with usage_errors(ValueError, OSError, extra="train"):
        if resume is not None:
            others = {"a configuration": configuration, "--seeds": seeds, "--friction-source": sources}
            others |= {"--set": sets, "--sweep": sweep, "--output": output if output != _RUNS else None}
            others |= {f"--{name.rpartition('.')[2]}": value for name, value in options.items()}
            from policies.training.run_set import resumed

            work = resumed(resume, others, jobs, ray)
        else:
            config = files.chosen(configuration, options, sets)
            from policies.training.run_set import begun

            path, work = begun(config, seeds or [], sources, sweep, output, jobs, ray)
            if not sweep:
                typer.echo(f"If it is interrupted: slipgym train --resume {path}")
    try:
        typer.echo(work())
    except (ValueError, OSError, FloatingPointError) as error:
        kept = any((resume or path).rglob("*.checkpoint"))
        typer.echo(f"error: {error}" + kept * "; what was trained so far is in the last checkpoint", err=True)
        raise typer.Exit(1) from error
