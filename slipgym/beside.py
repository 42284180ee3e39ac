"""Finds the packages `estimator` and `policies`, which are installed beside `slipgym`."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any


def refuse_hidden(name: str) -> None:
    """Raise ImportError if a file of somebody else has the name of a package beside slipgym.

    Python takes the first package of a name on its path, and a script's folder comes before the installed
    ones.
    """
    spec = find_spec(name)
    if spec is None:
        return  # not installed
    found = spec.origin or next(iter(spec.submodule_search_locations or ()), "")
    own = Path(__file__).resolve().parent.parent / name
    if not Path(found).resolve().is_relative_to(own):
        raise ImportError(
            f"{found} hides the package {name!r} of slipgym: rename it, or start Python in another folder"
        )


def under_slipgym(name: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """`__getattr__` and `__dir__` of the module slipgym.<name>, which shows the package <name>."""
    refuse_hidden(name)
    package = import_module(name)

    def attribute(asked: str) -> Any:
        try:
            return getattr(package, asked)
        except AttributeError:
            if asked.startswith("_") or find_spec(f"{name}.{asked}") is None:
                raise
            return import_module(f"{name}.{asked}")

    return attribute, lambda: dir(package)
