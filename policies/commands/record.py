"""Records the sensors of one finger in a simulated episode, for `slipgym estimate`."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import TASK_HELP, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym record linear_slip slide.csv.gz --material wood --option duration=3
  slipgym record linear_slip forces.parquet --velocity velocities.parquet --finger 2
  slipgym record hold hold.mcap --policy constant_force
\n
Forces come at 1000 Hz and velocities at 120 Hz, at the pad centre, with the true friction beside them;
cells are empty where a sensor has no sample. docs/records.md describes the format.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    task: Annotated[str, typer.Argument(help=TASK_HELP)],
    files: Annotated[
        list[str],
        typer.Argument(
            metavar="[POLICY] RECORD",
            help="csv, csv.gz, parquet, h5 or mcap to write; a policy before it is as --policy.",
        ),
    ],
    policy: Annotated[
        str | None, typer.Option(help="Name of a policy, or its folder; the task's own by default.")
    ] = None,
    velocity: Annotated[Path | None, typer.Option(help="A file of its own for the velocities.")] = None,
    finger: Annotated[int, typer.Option(help="1 or 2.")] = 1,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the environment.")] = 0,
    material: Annotated[str, typer.Option(help="Name of a material, or random.")] = "random",
    sensors: Annotated[str, typer.Option(help="realistic, ideal or lab.")] = "realistic",
    option: Annotated[
        list[str] | None, typer.Option(metavar="NAME=VALUE", help="Option of the episode; repeatable.")
    ] = None,
) -> None:
    """Run an episode and write what one finger's sensors said, with its truth."""
    from estimator.records import parse_settings
    from policies.evaluation.sensor_record import check_targets, record_sensors, save_record
    from policies.task_names import own_policy

    *before, last = files
    if len(before) > (policy is None):
        raise typer.BadParameter(f"one RECORD, and at most one POLICY before it, got {' '.join(files)}")
    record = Path(last)
    with usage_errors(ValueError, OSError, ModuleNotFoundError):
        policy = policy or (before[0] if before else own_policy(task))
        options = parse_settings(option or (), "--option")
        check_targets(record, velocity)
        frame = record_sensors(task, policy, finger, seed, options, material=material, sensors=sensors)
        save_record(frame, record, velocity)
    typer.echo(f"{len(frame)} rows, {frame['t'].iloc[-1]:.2f} s: {record}")
