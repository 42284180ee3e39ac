"""Writes a learned policy in the form that a controller on a robot can run."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import usage_errors

EPILOG = """
Examples:\n
\b
  slipgym export-policy runs/ppo/policy --onnx policy.onnx
\n
docs/policy_files.md says what the graph's inputs and outputs are.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    policy: Annotated[str, typer.Argument(help="Name of a learned policy, or its folder.")],
    onnx: Annotated[Path, typer.Option(help="File to write, as an ONNX graph.")],
) -> None:
    """Write a learned policy as an ONNX graph, normalisation and clipping inside (extra `onnx`)."""
    try:
        from policies.learned.onnx_graph import write_onnx
    except ModuleNotFoundError as error:
        raise typer.BadParameter(
            f"needs {error.name}: pip install 'slipgym[onnx]'", param_hint="--onnx"
        ) from error

    with usage_errors(ValueError, OSError):
        write_onnx(policy, onnx)
    typer.echo(f"graph: {onnx}")
