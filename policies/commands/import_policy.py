"""Turns a zip of Stable-Baselines3 into the folder of a policy; nothing in the zip is executed."""

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import environment_arguments, taking_several, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym import-policy model.zip hold_ppo --environment slipgym/Hold-v0 --set friction_source=estimated
\n
docs/policy_leaderboard.md says how the policy enters the leaderboard.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--set"))
def main(
    zip_: Annotated[Path, typer.Argument(metavar="ZIP", help="What `model.save` wrote.")],
    folder: Annotated[Path, typer.Argument(help="Folder to write.")],
    environment: Annotated[str, typer.Option(help="Task or id of the environment of the training.")],
    set_: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Arguments of that environment.")
    ] = None,
) -> None:
    """Write a policy's folder from the tensors of a zip (extra `train`)."""
    from policies.learned.sb3_zip import import_zip
    from slipgym.tasks import find

    with usage_errors(ValueError, TypeError, OSError):
        import_zip(zip_, folder, find(environment).id, environment_arguments(set_ or []))
    typer.echo(f"policy: {folder}")
