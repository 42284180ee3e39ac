"""Watches a policy: in a window, or as a video where there is none."""

from pathlib import Path
from typing import Annotated, Any

import typer

from policies.commands.several import TASK_HELP, environment_arguments, taking_several, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym play linear_slip
  slipgym play linear_slip --policy keyboard --material wood --speed 0.5
  slipgym play linear_slip --policy linear_slip --video slide.mp4 --option distance=0.02
  slipgym play hold --policy constant_force --video hold.gif --episodes 2 --speed 2
  slipgym play carry --policy carry_lab --video carry.mp4
  slipgym play hold --set level=hard randomization=train
  slipgym play carry --viewer --engine planar
\n
In a window, --policy keyboard leaves the grip force to you: up grips harder, down more loosely; Escape ends.
A window needs pygame (pip install 'slipgym[window]'). docs/rendering.md explains the picture.
--viewer opens a page with sliders in a browser (pip install 'slipgym[viewer]', docs/viewer.md).
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--set"))
def main(
    task: Annotated[str, typer.Argument(help=TASK_HELP)],
    policy: Annotated[
        str | None, typer.Option(help="Name or path of a policy, or keyboard; the task's own by default.")
    ] = None,
    video: Annotated[Path | None, typer.Option(help="MP4 or GIF to write instead of a window.")] = None,
    episodes: Annotated[int, typer.Option(help="How many.")] = 1,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the first episode.")] = 0,
    speed: Annotated[float, typer.Option(help="Seconds of simulation per second of watching.")] = 1.0,
    material: Annotated[str | None, typer.Option(help="Name of a material, or random.")] = None,
    friction_source: Annotated[str | None, typer.Option(help="estimated, true, nominal or none.")] = None,
    estimator: Annotated[str | None, typer.Option(help="A name of estimator.names(), or none.")] = None,
    sensors: Annotated[
        str | None, typer.Option(help="ideal, realistic, lab, markers, wrist or motor.")
    ] = None,
    engine: Annotated[str | None, typer.Option(help="auto, bullet or planar.")] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="Further arguments of the environment: level=hard."),
    ] = None,
    viewer: Annotated[
        bool, typer.Option("--viewer", help="Show it in a browser, with sliders; --video is for recordings.")
    ] = False,
    port: Annotated[int, typer.Option(help="Of the viewer's page, on this machine only.")] = 8080,
    option: Annotated[
        list[str] | None, typer.Option(metavar="NAME=VALUE", help="Option of the episode; repeatable.")
    ] = None,
) -> None:
    """Play a task and show it; prints how each episode went.

    A learned policy acts in the environment of its training, with the arguments that are given in place of
    its own.
    """
    from estimator.records import parse_settings
    from policies.play import watch

    given = {
        "material": material,
        "friction_source": friction_source,
        "estimator": estimator,
        "sensors": sensors,
        "engine": engine,
    }
    with usage_errors(ValueError, OSError, RuntimeError, ModuleNotFoundError):
        options = parse_settings(option or (), "--option")
        keywords: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
        if estimator == "none":
            keywords["estimator"] = None
        keywords |= environment_arguments(set_ or ())
        if viewer:
            if (episodes, speed) != (1, 1.0):
                raise ValueError(
                    "--viewer plays one episode after the other, at the speed of its menu: leave out "
                    "--episodes and --speed"
                )
            from policies.play.viewer import open_viewer

            outcomes = _shown(open_viewer(task, policy, video, seed, options, port, **keywords))
        else:
            outcomes = watch(task, policy, video, episodes, seed, speed, options, **keywords)
    for outcome in outcomes:
        typer.echo(outcome.words())
    if video is not None and not viewer:
        typer.echo(f"video: {video}")


def _shown(page: Any) -> Any:
    """The outcomes of the episodes of a viewer's page, once it is closed."""
    typer.echo(f"open {page.url} in a browser; Ctrl-C ends")
    try:
        page.run()
    except KeyboardInterrupt:
        pass
    finally:
        page.close()
    return page.session.finished
