"""Identifies a gripper from a log and writes its configuration and a report."""

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
  slipgym identify log.csv --output my_gripper
  slipgym identify log.csv --columns mapping.yaml --output my_gripper
\n
A log holds t [s], the grip command force [N], the motion of the object against the gripper motion_x,
motion_y, motion_omega [m/s, m/s, rad/s], and the readings f_x, f_y, f_n, tau [N, N, N, N m] and v_x, v_y,
omega [m/s, m/s, rad/s] at the pad's centre; v_x, v_y, omega may be absent. Other
names, units and signs: --columns, which `slipgym map` proposes. docs/identify.md says how to record it.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    log: Annotated[Path, typer.Argument(help="Any file that slipgym estimate reads.")],
    columns: Annotated[
        Path | None, typer.Option(help="YAML: which column is what, its unit and sign.")
    ] = None,
    output: Annotated[Path, typer.Option(help="New folder for gripper.yaml and report.")] = Path(
        "identified"
    ),
    contact: Annotated[
        str, typer.Option(help="Friction model: distributed, disc, ellipsoid.")
    ] = "distributed",
    seed: Annotated[int, typer.Option(min=0, help="Of the starts of the fit.")] = 0,
) -> None:
    """Identify a gripper from a log of its sensors.

    Fits the simulator to the log. Writes gripper.yaml, which the environments take as config, and a report:
    parameters with intervals, what the log does not show, the residual on a held-out part, and what to
    record next.
    """
    with usage_errors(ValueError, OSError, extra="cli"):
        from estimator.records import load_columns
        from slipgym import identification
        from slipgym.atomic_io import check_folder, new_folder

        check_folder(output)
        if output.exists():
            raise FileExistsError(f"{output} exists; --output names another folder")
        result = identification.identify(identification.read_log(log, load_columns(columns)), contact, seed)
        with new_folder(output.expanduser().resolve()) as folder:
            identification.write(result, folder)
    typer.echo(f"{identification.table(result)}\n\nLook at:")
    for name in ("report.md", "report.png", "gripper.yaml"):
        typer.echo(f"  {output / name}")
    typer.echo(f"\n{identification.verdict(result)}")
