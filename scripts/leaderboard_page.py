"""Writes the leaderboard as one page of HTML, from the files that `slipgym policy-leaderboard` wrote."""

import json
from itertools import groupby
from pathlib import Path
from typing import Annotated

import typer

PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>slipgym: leaderboard of policies</title>
<style>
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse; display: block; overflow-x: auto }
td, th { padding: .2rem .6rem; text-align: right; border-bottom: 1px solid #ddd }
td:first-child, th:first-child { text-align: left }
</style>
<h1>Leaderboard of policies</h1>
<h2>Rules of entry</h2>
<ol>
<li>Train on what you like; choose nothing by the episodes of the leaderboard, seeds 0, 1, 2, ...</li>
<li>The policy reads its observations alone. Say with <code>--friction-source</code> which friction they hold;
"true" is listed, and is no rival of those that read sensors.</li>
<li>Play at least 200 episodes of every level of a task, with all opponents:
<code>slipgym policy-leaderboard hold --policy YOURS --episodes 200</code></li>
<li>Open a pull request that adds the <code>leaderboard.json</code> it wrote as
<code>leaderboard/NAME.json</code>, and says where policy and training are, under which licence.
A folder of <code>slipgym train</code> or of <code>slipgym import-policy</code> needs no code.</li>
<li>The entry is played again with the same versions. It is listed if the same figures come out.</li>
</ol>
{% for name, board in boards %}<h2>{{ name }}</h2>
<p>{% for key, value in board.played.items() if value not in ({}, None) -%}
{{ key }} {{ value }}{{ ", " if not loop.last }}{% endfor %};
slipgym {{ board.versions.slipgym }}, numpy {{ board.versions.numpy }}</p>
{% for (task, level), rows in board.tables %}<h3>{{ task }}, {{ level }}</h3>
<table><tr>{% for column in rows[0] %}<th>{{ column }}</th>{% endfor %}</tr>
{% for row in rows %}<tr>{% for value in row.values() -%}
<td>{{ "%.1f" % value if value is number else value or "–" }}</td>{% endfor %}</tr>
{% endfor %}</table>
{% endfor %}{% else %}<p>No entries yet.</p>
{% endfor %}</html>
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
KEYS = ("played", "versions", "rows")
CELL = ("task", "level")


def board(path: Path) -> dict:
    """Content of a file, with its rows by task and level, best first.

    Raises:
        ValueError: It is no leaderboard.json; the message names the file.
    """
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        played, versions, rows = (found[key] for key in KEYS)
        rows = sorted(rows, key=lambda row: (*(str(row[key]) for key in CELL), -float(row["solved [%]"])))
        cells = groupby(rows, key=lambda row: tuple(str(row[key]) for key in CELL))
        shown = [
            (cell, [{k: v for k, v in row.items() if k not in CELL} for row in of]) for cell, of in cells
        ]
        return {"played": dict(played), "versions": dict(versions), "tables": shown}
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ValueError(f"{path}: no leaderboard.json of slipgym policy-leaderboard ({error!r})") from error


@app.command()
def main(
    folder: Annotated[Path, typer.Argument(help="Folder of the entries' files, NAME.json.")],
    output: Annotated[Path, typer.Option(help="The page.")] = Path("build/board.html"),
) -> None:
    """Write the page; a folder that does not exist has no entries."""
    from jinja2 import Environment

    from slipgym import atomic_io

    try:
        boards = [(path.stem, board(path)) for path in sorted(folder.glob("*.json"))]
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error
    text = Environment(autoescape=True).from_string(PAGE).render(boards=boards)
    output.parent.mkdir(parents=True, exist_ok=True)
    atomic_io.write(output, text.encode())
    typer.echo(f"{len(boards)} entries: {output}")


if __name__ == "__main__":
    app()
