"""Lists the public sets of real contacts and fetches one from its own repository."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import usage_errors

EPILOG = """
Examples:\n
\b
  slipgym data
  slipgym data pushes
  slipgym data tugs --from FOLDER --into data
\n
docs/real_data.md says what each set can show.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    name: Annotated[str | None, typer.Argument(help="Set to fetch; lists all if none.")] = None,
    into: Annotated[Path, typer.Option(help="Folder in which a folder NAME is made.")] = Path("data"),
    source: Annotated[
        Path | None, typer.Option("--from", help="Clone that was made by hand, in place of the network.")
    ] = None,
) -> None:
    """List public sets of real contacts, or fetch one: every file is checked, and none is executed."""
    from policies.data.fetch import store
    from policies.data.sets import SETS, find

    if name is None:
        for each in SETS.values():
            typer.echo(f"{each.name:<9} {each.what}; {each.licence}, {each.size / 1e6:.1f} MB")
            typer.echo(f"{'':<9} {each.citation}\n{'':<9} {each.url} at {each.commit}")
        return
    with usage_errors(ValueError, OSError):
        public, target = find(name), into / name
        new = store(public, target, source)
    typer.echo(
        f"{target}: {'' if new else 'was there, '}{len(public.files)} files, each with the known SHA-256"
    )
    typer.echo(f"Licence: {public.licence}, in {target / 'LICENSE'}\nCite: {public.citation}")
