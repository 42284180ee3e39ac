"""Work in other processes: of this machine, or of a Ray cluster."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import joblib


def results(
    function: Callable[..., Any], items: Iterable[tuple[Any, ...]], jobs: int = 1, ray: str = ""
) -> Iterator[Any]:
    """Calls a function for every item, several at once, and yields the results in the items' order.

    Args:
        function: Top-level function of a module.
        items: Its arguments.
        jobs: Processes at once on this machine; -1 for one per core. Without effect with Ray.
        ray: "local" or the address of a Ray cluster, which then decides how many run at once, one core each;
            its machines need slipgym and must see the arguments' folders. Empty: without Ray.

    Raises:
        ModuleNotFoundError: Ray is asked for and not installed.
        ConnectionError: There is no such cluster.
    """
    if not ray:
        work = joblib.Parallel(n_jobs=jobs, return_as="generator")
        yield from work(joblib.delayed(function)(*item) for item in items)
        return
    check(ray)
    module: Any = importlib.import_module("ray")
    where = {"include_dashboard": False} if ray == "local" else {"address": ray}
    module.init(log_to_driver=False, **where)
    try:
        remote = module.remote(num_cpus=1)(function)
        for started in [remote.remote(*item) for item in items]:
            yield module.get(started)
    finally:
        module.shutdown()


def check(ray: str) -> None:
    """Refuse to go to Ray where it is not installed.

    Raises:
        ModuleNotFoundError: Ray is asked for and not installed; the message says how to install it.
    """
    if ray and importlib.util.find_spec("ray") is None:
        raise ModuleNotFoundError(f"--ray {ray} needs Ray: pip install 'slipgym[ray]'")
