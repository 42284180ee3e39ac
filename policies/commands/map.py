"""Proposes which columns of a foreign log are what, with their units and signs, and writes the mapping."""

from pathlib import Path
from typing import Annotated

try:
    import typer

    from policies.commands.several import usage_errors
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is not installed: pip install 'slipgym[cli]'") from error

EPILOG = """
Examples:\n
\b
  slipgym map log.csv
  slipgym map run.mcap --output mapping.yaml --plot columns.png
  slipgym estimate run.mcap --columns mapping.yaml
\n
The names of the columns decide what they are, their magnitudes the units, and the normal force in contact
its sign. Look at every line: a name can mislead, and no magnitude shows the direction of an axis.
docs/records.md has the frames.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    log: Annotated[Path, typer.Argument(help="A log, or the folder of a ROS 2 bag.")],
    output: Annotated[Path | None, typer.Option(help="YAML file to write the mapping to.")] = None,
    plot: Annotated[Path | None, typer.Option(help="png to draw the proposed columns to.")] = None,
) -> None:
    """Propose a mapping of the columns of a log, for slipgym estimate --columns."""
    with usage_errors(ModuleNotFoundError, ValueError, OSError):
        from estimator.records import load, load_columns, proposal
        from estimator.records.alignment import align
        from estimator.records.summary import faults
        from estimator.records.table import listed
        from estimator.records.units import BENCH
        from slipgym.atomic_io import check_file, new_file

        if plot is not None and plot.suffix != ".png":
            raise ValueError(f"--plot {plot}: must end with .png")
        for path in (output, plot):
            if path is not None:
                check_file(path)
        found, left = proposal.propose_fingers(log)
        text = proposal.text_of_fingers(found)
        if output is not None:
            with new_file(output) as part:
                part.write_text(text, encoding="utf-8")
        if plot is not None:
            with new_file(plot) as part:
                proposal.plot([each for own in found.values() for each in own], part)
    typer.echo(text + (f"\nnot used: {listed(left)}" if left else ""))
    for path in (output, plot):
        if path is not None:
            typer.echo(f"written: {path}")
    if output is None:
        return
    try:
        columns = load_columns(output)
        read = {name: load(log, own) for name, own in (columns.fingers or {"": columns}).items()}
        told = [line for record in read.values() for line in faults(record, align(record, allow_gaps=True))]
    except ValueError as error:
        typer.echo(f"\nslipgym estimate does not take it yet:\n{error}")
        if _identifies(log, output):
            typer.echo(
                "\nslipgym identify takes it, as a log without a slip sensor; go on with\n"
                f"  slipgym identify {log} --columns {output}"
            )
        return
    for name, record in read.items():
        rates = [1.0 / ((t[-1] - t[0]) / max(len(t) - 1, 1)) for t in (record.force_t, record.twist_t)]
        typer.echo(
            f"\n{name}{': ' * bool(name)}readable: {record.force_t[-1] - record.force_t[0]:.1f} s, forces at "
            f"{rates[0]:.0f} Hz, velocities at {rates[1]:.0f} Hz"
        )
    names = ["estimate", *(["identify"] if all(columns.given.get(key) for key in BENCH) else [])]
    lines = [f"  slipgym {name} {log} --columns {output}" for name in names]
    typer.echo("\n".join([*dict.fromkeys(told), "go on with", *lines]))


def _identifies(log: Path, mapping: Path) -> bool:
    """Whether `slipgym identify` takes a log, as one without a slip sensor."""
    from estimator.online import TWIST
    from estimator.records import load_columns
    from slipgym import identification

    try:
        columns = load_columns(mapping)
        identification.read_log(log, columns)
    except ValueError:
        return False
    return not any(columns.given.get(key) for key in TWIST)
