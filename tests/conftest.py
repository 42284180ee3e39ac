"""Compiles what takes longest first, in each process something else, when all tests run in several."""

import signal
from collections.abc import Generator
from importlib.util import find_spec
from typing import Any

import gymnasium as gym
import pytest

import slipgym  # noqa: F401

SLOW_TASKS = ("RotationalSlip", "Hinge")
"""Tasks whose cases of tests marked `quick_tasks` are slow: their kinds of motion occur in other tasks."""
MANY = 1000
"""Tests from which it pays: a few may need none of it."""

# In the background of a shell Ctrl-C is ignored, by children too.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        for mark in item.iter_markers("quick_cases"):
            if not any(item.name.endswith(f"[{case}]") for case in mark.args):
                item.add_marker("slow")
        if item.get_closest_marker("quick_tasks") and any(f"/{task}-v0" in item.name for task in SLOW_TASKS):
            item.add_marker("slow")


def _without_pybullet() -> Generator[None, Any, Any]:
    """What needs PyBullet is skipped where it has no wheel."""
    try:
        return (yield)
    except ModuleNotFoundError as error:
        if find_spec("pybullet") is None and "needs PyBullet" in str(error):
            pytest.skip("needs PyBullet")
        raise


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup() -> Generator[None, Any, Any]:
    return (yield from _without_pybullet())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call() -> Generator[None, Any, Any]:
    return (yield from _without_pybullet())


def pytest_collection_finish(session: pytest.Session) -> None:
    worker = getattr(session.config, "workerinput", {}).get("workerid")
    if len(session.items) < MANY or worker not in ("gw0", "gw1"):
        return
    if worker == "gw1" and find_spec("pybullet") is not None:
        from slipgym.validation.bench import Bench

        for model in ("distributed", "ellipsoid"):  # meanwhile gw0 compiles what all environments need
            with Bench(contact=model, engine="planar") as bench:
                bench.run(bench.step_time)
    contact = {"gw0": "ellipsoid", "gw1": "distributed"}[worker]
    gym.make_vec("slipgym/LinearSlip-v0", num_envs=1, contact=contact).close()
