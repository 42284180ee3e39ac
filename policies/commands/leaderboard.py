"""Ranks all estimators on the same records: who finds mu_c, r and mu_s, when, and how surely."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    import pandas as pd

EPILOG = """
Examples:\n
\b
  slipgym leaderboard --quick
  slipgym leaderboard --closed-loop 16 --estimators adaptive --task hold
  slipgym leaderboard --costs
"""
_USUAL = {"randomization": "none", "contact": "ellipsoid"}  # of the environments in the loop
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = Path("runs"),
    quick: Annotated[bool, typer.Option(help="A few coarse records, to see that it works.")] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the sensors' noise.")] = 0,
    closed_loop: Annotated[
        int, typer.Option(min=0, help="Instead: episodes of every task with the estimators in the loop.")
    ] = 0,
    estimators: Annotated[
        list[str] | None, typer.Option(help="Those in the loop; all if none.", show_default=False)
    ] = None,
    randomization: Annotated[str, typer.Option(help="Preset of the episodes in the loop.")] = _USUAL[
        "randomization"
    ],
    contact: Annotated[str, typer.Option(help="Friction model of the pads in the loop.")] = _USUAL["contact"],
    task: Annotated[
        list[str] | None, typer.Option(help="Tasks in the loop; all if none.", show_default=False)
    ] = None,
    parameter: Annotated[
        list[str] | None,
        typer.Option(help="Parameters of the estimators in the loop, as NAME=VALUE.", show_default=False),
    ] = None,
    imperfections: Annotated[
        bool, typer.Option("--imperfections", help='In the loop: each imperfection of "lab" alone.')
    ] = False,
    smoother: Annotated[
        bool,
        typer.Option("--smoother", help="In the loop of PlanarSlip: a fit that knows all but the unknowns."),
    ] = False,
    jumps: Annotated[
        bool,
        typer.Option("--jumps", help='In the loop: how soon "adaptive" is right again when friction jumps.'),
    ] = False,
    delays: Annotated[
        bool, typer.Option("--delays", help='Only print "adaptive" in stick-slip with late velocities.')
    ] = False,
    ablation: Annotated[
        bool, typer.Option("--ablation", help='Only print what each state and test of "adaptive" is worth.')
    ] = False,
    costs: Annotated[bool, typer.Option("--costs", help="Only print what an update costs.")] = False,
) -> None:
    """Runs all estimators on all scenarios; writes a folder with tables and a picture."""
    environments = {"randomization": randomization, "contact": contact}
    further = estimators or task or parameter or imperfections or smoother or jumps or environments != _USUAL
    if further and not closed_loop:
        named = "--estimators, --task, --parameter, --imperfections, --smoother, --jumps, --randomization"
        named += ", --contact"
        raise typer.BadParameter(f"{named} are for episodes in the loop: --closed-loop 64")
    if ablation:
        from policies.research.leaderboard import ablation as removing
        from policies.research.leaderboard.scenarios import effort_of
        from policies.research.leaderboard.tables import markdown

        if closed_loop:
            found = removing.in_the_loop(closed_loop, seed, tasks=_ids(task), **environments)
        else:
            found = removing.worth(removing.ablation(effort_of(quick, seed)))
        typer.echo(markdown(found, 1 if closed_loop else 2))
        return
    if smoother:
        from policies.research.leaderboard.smoother import compared
        from policies.research.leaderboard.tables import markdown

        typer.echo(markdown(compared(closed_loop, seed), 1))
        return
    if jumps:
        if estimators or imperfections or randomization != _USUAL["randomization"]:
            unused = "--estimators, --imperfections and --randomization"
            raise typer.BadParameter(f'--jumps plays "adaptive" with friction that jumps: without {unused}')
        from policies.research.leaderboard.tables import markdown

        typer.echo(markdown(_after_jumps(closed_loop, seed, task, parameter or [], contact), 2))
        return
    if closed_loop:
        from policies.research.leaderboard.closed_loop import pooled
        from policies.research.leaderboard.tables import markdown

        rows = _in_the_loop(closed_loop, seed, estimators, task, parameter or [], imperfections, environments)
        typer.echo(markdown(rows, 1))
        if len(set(rows["task"])) > 1:
            typer.echo("Over the tasks, each with its own controller:\n")
            typer.echo(markdown(pooled(rows), 1))
        return
    if delays:
        from policies.research.leaderboard.delays import delays as late
        from policies.research.leaderboard.scenarios import effort_of
        from policies.research.leaderboard.tables import markdown

        typer.echo(markdown(late(effort_of(quick, seed)), 1))
        return
    if costs:
        from policies.research.leaderboard import cost
        from policies.research.leaderboard.tables import markdown

        typer.echo(markdown(cost.costs(), 1))
        return
    from policies.research.leaderboard import run_leaderboard

    folder = run_leaderboard(output, quick, seed)
    typer.echo((folder / "leaderboard.md").read_text(encoding="utf-8").partition("\n## mu_c")[0])
    typer.echo(f"Look at:\n  {folder / 'leaderboard.png'}")


def _in_the_loop(
    episodes: int,
    seed: int,
    estimators: list[str] | None,
    tasks: list[str] | None,
    parameters: list[str],
    imperfections: bool,
    environments: dict[str, str],
) -> pd.DataFrame:
    import estimator
    from estimator.records import parse_settings
    from policies.research.leaderboard.closed_loop import closed_loop
    from policies.research.leaderboard.one_imperfection import one_imperfection

    try:
        changed = parse_settings(parameters)
        chosen = {name: {"name": name, **changed} for name in estimators or estimator.names()}
        sensors = one_imperfection() if imperfections else ("realistic", "lab")
        return closed_loop(chosen, episodes, sensors, seed, _ids(tasks), **environments)
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error


def _after_jumps(
    episodes: int, seed: int, tasks: list[str] | None, parameters: list[str], contact: str
) -> pd.DataFrame:
    from estimator.records import parse_settings
    from policies.research.leaderboard.jumps import TASKS, jumps

    try:
        chosen = {"name": "adaptive", **parse_settings(parameters)}
        return jumps(episodes, seed, _ids(tasks) if tasks else TASKS, chosen, contact=contact)
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error


def _ids(tasks: list[str] | None) -> list[str]:
    """Ids of tasks, of all if none is named."""
    from slipgym.registration import TASK_MODULES
    from slipgym.tasks import find

    try:
        return [find(name).id for name in tasks] if tasks else list(TASK_MODULES)
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error
