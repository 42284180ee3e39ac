"""Prints the figures that support the acceptance figures of the physics; exit code 1 if one is not met."""

from __future__ import annotations

import typer

from lab.commands.options import application
from policies.commands.several import taking_several
from policies.commands.validate import Only, accept

EPILOG = """
Examples:\n
\b
  slipgym validate-parts
  slipgym validate-parts --only patch_surface tilt
"""
app = application()


@app.command(epilog=EPILOG, cls=taking_several("--only"))
def main(only: Only = None) -> None:
    """Print the figures of steps, engines, patches, tilt and soft pads; exit code 1 if one is not met."""
    from lab.validation import EXPERIMENTS

    if accept(EXPERIMENTS, only):
        raise typer.Exit(1)
