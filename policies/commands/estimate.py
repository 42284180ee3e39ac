"""Runs a friction estimator on a record of forces and slip velocities."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

try:
    import typer

    from estimator import DEFAULT
    from policies.commands.several import usage_errors
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is not installed: pip install 'slipgym[cli]'") from error

EPILOG = """
Examples:\n
\b
  slipgym estimate examples/linear_slip_wood.csv.gz
  slipgym estimate log.csv --columns examples/columns.yaml
  slipgym estimate forces.parquet --velocity velocities.parquet --allow-gaps
  slipgym estimate bag.mcap --columns columns.yaml
  slipgym estimate log.csv --estimator rls --set heuristic=false --output /tmp/runs
\n
A record holds one finger: the time t [s], the wrench f_x, f_y, f_n, tau [N, N, N, N m] and the slip
twist v_x, v_y, omega [m/s, m/s, rad/s]; cells are empty where a stream has no sample. Other names,
units and signs, fields of messages, and several fingers: --columns, which `slipgym map` proposes.
docs/records.md describes the format and the files of a run.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    log: Annotated[
        Path, typer.Argument(help="The record: csv, parquet, npz, HDF5, mat, xlsx, mcap or a bag.")
    ],
    columns: Annotated[
        Path | None, typer.Option(help="YAML: which column is what, its unit and sign.")
    ] = None,
    velocity: Annotated[Path | None, typer.Option(help="A file of its own for the velocities.")] = None,
    estimator: Annotated[str, typer.Option(help="Name of the estimator.")] = DEFAULT,
    set_: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Its parameters; repeatable.")
    ] = None,
    allow_gaps: Annotated[
        bool, typer.Option("--allow-gaps", help="Go on after a gap, with the estimator reset.")
    ] = False,
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = Path("runs"),
) -> None:
    """Run a friction estimator on a record of one finger, or of each finger of a mapping.

    Each velocity sample is paired with the newest force at or before it. Writes a folder with the estimates,
    a summary and a figure. Prints the final values, warnings about implausible values and faulty readings,
    what was not observable, and with "adaptive" the delay and the errors of the sensors that it found.
    """
    with usage_errors(ValueError, OSError, extra="cli"):
        from estimator import records
        from slipgym import loading
        from slipgym.atomic_io import check_folder, new_folder

        check_folder(output)
        mapping, settings = records.load_columns(columns), records.parse_settings(set_ or ())
        results = {}
        for finger, own in (mapping.fingers or {"": mapping}).items():
            with _named(finger):
                record = records.load(log, own, velocity)
                loading.ready(estimator)
                results[finger] = records.estimate(record, estimator, allow_gaps, **settings)
        path = output.expanduser().resolve() / records.run_name(log)
        with new_folder(path) as folder:
            for finger, result in results.items():
                (folder / finger).mkdir(exist_ok=True)
                records.write(result, folder / finger)
    for finger, result in results.items():
        typer.echo(f"Finger {finger}\n" if finger else "", nl=False)
        typer.echo(f"{records.report(result)}\n")
    typer.echo("Look at:")
    for found in sorted(path.rglob("*.*"), key=lambda each: (each.parent, each.suffix != ".png", each.name)):
        if found.suffix != ".parquet":
            typer.echo(f"  {found}")


@contextmanager
def _named(finger: str) -> Iterator[None]:
    """Says of which finger an error is."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"finger {finger}: {error}" if finger else str(error)) from error
