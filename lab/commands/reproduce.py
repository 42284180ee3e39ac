"""Reproduces the analyses of the paper (arXiv 2507.06824)."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

EPILOG = """
Examples:\n
\b
  slipgym reproduce coupling
  slipgym reproduce linear --trials 2
  slipgym reproduce planar --contact ellipsoid
"""
app = typer.Typer(epilog=EPILOG, add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
Output = Annotated[Path, typer.Option(help="Folder for the run's own folder.")]
Trials = Annotated[int, typer.Option(min=1, help="Trials per cell.")]
Jobs = Annotated[int, typer.Option(help="Processes; -1: one per core. Changes no result.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of the experiment.")]
Contact = Annotated[str, typer.Option(help="Friction model of the pads: distributed or ellipsoid.")]


@app.callback()
def main() -> None:
    """Reproduce the paper's analyses; each command writes a folder with tables and figures."""


@app.command()
def coupling(output: Output = Path("runs")) -> None:
    """The coupling of mu_c and r: fixed-point map, explicit iteration, lock-out from start values."""
    from lab.reproduction import reproduce_coupling

    _report(reproduce_coupling, output)


@app.command()
def profile(
    output: Output = Path("runs"),
    seeds: Annotated[int, typer.Option(min=1, help="Records with noise of their own.")] = 20,
    seed: Annotated[int, typer.Option(min=0, help="Of the noise.")] = 0,
) -> None:
    """The simulation figure: a uniform disc under a velocity profile, exact and with realistic sensors."""
    from lab.reproduction import reproduce_profile

    _report(reproduce_profile, output, seeds, seed)


@app.command()
def surface(output: Output = Path("runs")) -> None:
    """Limit surfaces of a disc by its pressure, the cells against them, and what the ellipsoid gets wrong."""
    from lab.reproduction import reproduce_surface

    folder = _made(reproduce_surface, output)
    for name in ("cells.md", "bias.md"):
        typer.echo(f"\n{name}\n{(folder / name).read_text(encoding='utf-8').rstrip()}")
    typer.echo(f"\nLook at:\n  {folder / 'surface.png'}")


@app.command()
def linear(
    trials: Trials = 10,
    jobs: Jobs = -1,
    seed: Seed = 0,
    friction_source: Annotated[
        str, typer.Option(help="What the controller acts on: true, estimated or nominal.")
    ] = "true",
    contact: Contact = "distributed",
    output: Output = Path("runs"),
) -> None:
    """Linear slip, 160 trials: every estimator on the same records, beside the paper's table."""
    from lab.reproduction import reproduce_linear

    _report(reproduce_linear, output, trials, jobs, seed, friction_source, contact)


@app.command()
def planar(
    trials: Trials = 10,
    jobs: Jobs = -1,
    seed: Seed = 0,
    contact: Contact = "distributed",
    output: Output = Path("runs"),
) -> None:
    """Planar motion, 40 trials: the gripper turns round a hanging object; beside the paper's table."""
    from lab.reproduction import reproduce_planar

    _report(reproduce_planar, output, trials, jobs, seed, contact)


def _report(reproduce: Callable[..., Path], output: Path, *arguments: object) -> None:
    """Runs an experiment, prints its tables and where its figures are."""
    folder = _made(reproduce, output, *arguments)
    typer.echo("\n" + (folder / "table.md").read_text(encoding="utf-8") + "\nLook at:")
    for path in sorted(folder.glob("*.png")) or [folder / "trials.csv"]:
        typer.echo(f"  {path}")


def _made(reproduce: Callable[..., Path], output: Path, *arguments: object) -> Path:
    """The folder of an analysis; the output is looked at first."""
    from slipgym.atomic_io import check_folder

    try:
        check_folder(output)
        return reproduce(output, *arguments)
    except (ValueError, OSError) as error:
        raise typer.BadParameter(str(error)) from error
