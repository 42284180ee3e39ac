"""Plays the same episodes with every policy: each task, each level, opponents and entries."""

from pathlib import Path
from typing import Annotated, Any

import typer

from estimator import DEFAULT
from policies.commands.several import TASKS, Tasks, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym policy-leaderboard
  slipgym policy-leaderboard hold --level hard --sensors lab
  slipgym policy-leaderboard rotational_slip --level hard --sensors lab --without scale
  slipgym policy-leaderboard hold --policy grips:Wary
  slipgym policy-leaderboard hold --engine bullet --episodes 50
  slipgym policy-leaderboard hold --level hard --worlds
\n
docs/policy_leaderboard.md explains the table and how to enter a policy.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    tasks: Tasks = None,
    episodes: Annotated[int, typer.Option(min=2, help="Episodes of each policy.")] = 200,
    level: Annotated[list[str] | None, typer.Option(help="Only this level; repeatable.")] = None,
    sensors: Annotated[str, typer.Option(help="Sensor preset.")] = "realistic",
    without: Annotated[
        list[str] | None, typer.Option(help="Imperfection that sensors 'lab' then lack; repeatable.")
    ] = None,
    randomization: Annotated[str, typer.Option(help="A preset or a YAML file.")] = "none",
    estimator: Annotated[str, typer.Option(help="Estimator of the environments.")] = DEFAULT,
    engine: Annotated[str, typer.Option(help="planar or bullet.")] = "planar",
    policy: Annotated[
        list[str] | None, typer.Option(help="A policy to enter: module:class or a folder; repeatable.")
    ] = None,
    friction_source: Annotated[
        str | None,
        typer.Option(
            help="Of the entered policies.  [default: that of a policy's file, else estimated]",
            show_default=False,
        ),
    ] = None,
    imitation: Annotated[Path | None, typer.Option(help="Folder of the runs of slipgym imitate.")] = None,
    worlds: Annotated[
        bool, typer.Option("--worlds", help="Instead: each policy in other worlds, such as PyBullet.")
    ] = False,
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = Path("runs"),
) -> None:
    """Print a table of policies by success, and write it with a picture."""
    import pandas as pd

    import policies
    from policies.evaluation.frames import markdown
    from policies.evaluation.one_policy import environment_of
    from policies.leaderboard.imperfections import without as lacking
    from policies.policy_leaderboard import entries, run
    from policies.policy_leaderboard.folder import write
    from policies.policy_leaderboard.run import generalisation, table, worth
    from slipgym.atomic_io import check_folder
    from slipgym.config.level import level_names
    from slipgym.envs.arguments import ENGINES, FRICTION_SOURCES, one_of
    from slipgym.envs.engines import resolved
    from slipgym.tasks import find

    same: dict[str, Any] = {"sensors": sensors, "randomization": randomization, "estimator": estimator}
    found, worths = [], []
    with usage_errors(ValueError, OSError):
        check_folder(output)
        same["config"] = lacking(without or [])
        if worlds and engine != "planar":
            raise ValueError(f"--engine {engine}: --worlds plays on both engines")
        engine = resolved(one_of("engine", engine, ENGINES))
        chosen = list({find(task).name: task for task in tasks or TASKS}.values())
        for task in chosen:
            if find(task).key not in policies.names():
                raise ValueError(f"{task}: no controller to compare with; slipgym evaluate takes this task")
        if friction_source is not None and not policy:
            raise ValueError(f"--friction-source {friction_source}: of policies entered with --policy")
        if without and sensors != "lab":
            raise ValueError(f"--without {without[0]}: of the sensors 'lab', and these are {sensors!r}")
        if friction_source is not None:
            one_of("friction source", friction_source, FRICTION_SOURCES)
        mine = entries.entered(policy or [], friction_source)
        for task in chosen:
            for each in mine:  # one for another task, whose observations may be as long, is refused
                environment_of(each.name, each.policy, task)
        levels = list(dict.fromkeys(level or []))
        cells = [(task, name) for task in chosen for name in levels or level_names(find(task).key)]
        for task, name in cells:
            others = entries.opponents(task, {**same, "level": name}, max(episodes // 2, 1), imitation)
            members = [*mine, *others]
            if worlds:
                found.append(generalisation(task, name, members, episodes, same))
                continue
            played = run.play_all(task, name, members, episodes, same, engine)
            found.append(run.outcomes(task, name, played))
            worths.append(worth(task, name, members, played))
            typer.echo(markdown(found[-1], 1))
    whole = pd.concat(found, ignore_index=True)
    if worlds:
        folder = write(whole, output, name="worlds")
        typer.echo(f"Solved [%]:\n\n{markdown(whole, 1)}\nLook at:\n  {folder / 'worlds.csv'}")
        return
    folder = write(whole, output, {"episodes": episodes, "engine": engine, **same})
    typer.echo(f"Solved [%], {episodes} episodes each:\n\n{markdown(run.by_level(whole), 1)}")
    typer.echo(f"Worth of friction: episodes solved [%], {episodes} each\n\n{markdown(table(worths), 1)}")
    typer.echo(f"Look at:\n  {folder / 'policies.png'}")
