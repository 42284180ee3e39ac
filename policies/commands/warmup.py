"""Compiles the environments ahead of their first use."""

from typing import Annotated, Any

import typer

EPILOG = """
Examples:\n
\b
  slipgym warmup
  slipgym warmup --task hold --engine planar
\n
For container images and CI: programs are kept in NUMBA_CACHE_DIR, if it is set, or beside the sources.
docs/numba.md says what is compiled.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    task: Annotated[
        list[str] | None, typer.Option(help="Only this task; repeatable.", show_default=False)
    ] = None,
    engine: Annotated[
        list[str] | None, typer.Option(help="Only bullet or planar; repeatable.", show_default=False)
    ] = None,
    randomization: Annotated[str, typer.Option(help="Preset or YAML file of the episodes.")] = "none",
    sensors: Annotated[str, typer.Option(help="Sensor preset.")] = "realistic",
) -> None:
    """Compile the environments once, so that no later process waits for it."""
    import gymnasium as gym
    from tqdm import tqdm

    from slipgym.registration import TASK_MODULES
    from slipgym.tasks import find

    try:
        ids = [find(name).id for name in task] if task else [*TASK_MODULES]
        wanted = [(env_id, kind) for kind in engine or ("bullet", "planar") for env_id in ids]
        for env_id, kind in tqdm(wanted, disable=None, leave=False):
            options: dict[str, Any] = {"engine": kind, "randomization": randomization, "sensors": sensors}
            env = gym.make(env_id, **options)
            env.reset(seed=0)
            env.step(env.action_space.sample())
            env.close()
            if kind == "planar":
                del options["engine"]
                envs = gym.make_vec(env_id, num_envs=1, **options)
                envs.reset(seed=0)
                envs.step(envs.action_space.sample())
                envs.close()
    except (ValueError, RuntimeError, ModuleNotFoundError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(f"compiled: {len(wanted)} environments")
