"""Measures `slipgym live` under faults: time inside, memory, losses, and the estimates of the record."""

import tempfile
from pathlib import Path
from typing import Annotated

import typer

from lab.commands.options import application

EPILOG = """
Examples:\n
\b
  slipgym live-bars
  slipgym live-bars --minutes 2 --seconds 10
"""
app = application()


@app.command(epilog=EPILOG)
def main(
    minutes: Annotated[float, typer.Option(min=1.0, help="Of stamps, as fast as it goes.")] = 30.0,
    seconds: Annotated[float, typer.Option(min=4.0, help="By UDP, in real time.")] = 60.0,
    estimator: Annotated[str, typer.Option(help="Of the first run.")] = "adaptive",
) -> None:
    """Run one finger as fast as it goes, and two by UDP in real time with a kill half-way."""
    from lab.live_bars import accelerated, by_udp

    with tempfile.TemporaryDirectory() as folder:
        typer.echo("\n".join(accelerated(minutes, estimator, Path(folder) / "fast.jsonl")))
        typer.echo("\n" + "\n".join(by_udp(seconds, Path(folder) / "udp.jsonl")))
