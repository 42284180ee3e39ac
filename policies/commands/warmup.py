"""Compiles the environments ahead of their first use."""

import itertools
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any, get_args

import typer

from policies.commands.several import usage_errors

EPILOG = """
Examples:\n
\b
  slipgym warmup
  slipgym warmup --task hold --engine planar
  slipgym warmup --target x86-64-v3 --into programs
\n
For container images and CI: programs are kept in NUMBA_CACHE_DIR, if it is set, or beside the sources.
docs/numba.md says what is compiled, and how a wheel carries programs.
"""
VARIED = "linear_slip"
"""Task whose programs are compiled for every contact and sensor: the other tasks share them."""
TARGETS = ("x86-64", "x86-64-v2", "x86-64-v3", "x86-64-v4")
"""Processors that LLVM knows; it takes an unknown name without an error."""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def main(
    task: Annotated[list[str] | None, typer.Option(help="Only this task; repeatable.")] = None,
    engine: Annotated[list[str] | None, typer.Option(help="Only bullet or planar; repeatable.")] = None,
    randomization: Annotated[str, typer.Option(help="Preset or YAML file of the episodes.")] = "none",
    sensors: Annotated[str, typer.Option(help="Sensor preset.")] = "realistic",
    variants: Annotated[
        bool, typer.Option("--variants", help="Also every contact, sensor preset and estimator.")
    ] = False,
    target: Annotated[
        str | None,
        typer.Option(help="Processors to compile for, as LLVM names them.", show_default="this machine's"),
    ] = None,
    into: Annotated[Path | None, typer.Option(help="Folder of the programs; with --variants.")] = None,
) -> None:
    """Compile the environments once, so that no later process waits for it."""
    if target is not None or into is not None:
        _elsewhere(target, into, task or [], engine or [])
        return
    from tqdm import tqdm

    from slipgym.registration import TASK_MODULES
    from slipgym.tasks import find

    with usage_errors(ValueError, RuntimeError, ModuleNotFoundError):
        ids = [find(name).id for name in task] if task else [*TASK_MODULES]
        engines = engine or [*(("bullet",) if find_spec("pybullet") else ()), "planar"]
        wanted: list[tuple[str, dict[str, Any]]] = [
            (env_id, {"engine": kind, "randomization": randomization, "sensors": sensors})
            for kind, env_id in itertools.product(engines, ids)
        ]
        if variants:
            wanted += [(find(VARIED).id, options) for options in _variants(engines)]
        for env_id, options in tqdm(wanted, disable=None, leave=False):
            _step(env_id, options)
    typer.echo(f"compiled: {len(wanted)} environments")


def _variants(engines: list[str]) -> Iterator[dict[str, Any]]:
    """Keyword arguments of environments that need programs of their own, also of one without estimator."""
    import estimator
    from slipgym.config.load import names
    from slipgym.config.physics import ContactModel

    for kind in engines:
        for contact, preset in itertools.product(get_args(ContactModel), names("sensors")):
            yield {"engine": kind, "contact": contact, "sensors": preset, "randomization": "lab"}
        for name in (*estimator.names(), None):
            yield {"engine": kind, "estimator": name}


def _step(env_id: str, options: dict[str, Any]) -> None:
    """Make an environment, and with the planar engine a batch, and step it."""
    import gymnasium as gym

    env = gym.make(env_id, **options)
    env.reset(seed=0)
    env.step(env.action_space.sample())
    env.close()
    if options["engine"] == "planar":
        envs = gym.make_vec(env_id, num_envs=1, **{k: v for k, v in options.items() if k != "engine"})
        envs.reset(seed=0)
        envs.step(envs.action_space.sample())
        envs.close()


def _elsewhere(target: str | None, into: Path | None, tasks: list[str], engines: list[str]) -> None:
    """Compile for other processors or into another folder, in a process that numba starts up for that."""
    from estimator._numba.folders import ABOUT, versions
    from slipgym.atomic_io import check_folder, write

    environment = dict(os.environ)
    if target is not None:
        if target not in TARGETS:
            raise typer.BadParameter(f"--target: {target!r} must be one of {', '.join(TARGETS)}")
        environment |= {"NUMBA_CPU_NAME": target, "NUMBA_CPU_FEATURES": ""}
    if into is not None:
        with usage_errors(OSError, hint="--into"):
            check_folder(into)
        into.mkdir(parents=True, exist_ok=True)
        environment["NUMBA_CACHE_DIR"] = str(into.resolve())
    command = [sys.executable, "-m", "slipgym", "warmup", *(["--variants"] if not tasks else [])]
    command += [word for name in tasks for word in ("--task", name)]
    command += [word for name in engines for word in ("--engine", name)]
    done = subprocess.run(command, env=environment, check=False)
    if done.returncode:
        raise typer.Exit(done.returncode)
    if into is not None:
        write(into / ABOUT, json.dumps({**versions(), "target": target}, indent=2).encode())
