"""Imports run one way: estimator <- slipgym <- policies <- lab, scripts; and `import slipgym` stays light."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LEARNING = {"torch", "stable_baselines3", "sb3_contrib"}
FORBIDDEN = {
    "estimator": {"slipgym", "policies", "lab", "scripts", "pybullet", "gymnasium"} | LEARNING,
    "slipgym": {"policies", "lab", "scripts"} | LEARNING,
    "policies": {"lab", "scripts"},
    "lab": {"scripts", "tests"},
    "scripts": {"scripts"},
    "tests": {"scripts"},
}
HEAVY = (
    {"numba", "pybullet", "matplotlib", "scipy", "pandas", "pydantic", "estimator"} | LEARNING | {"policies"}
)


def imported(source: str) -> set[str]:
    """The top-level names that a source imports anywhere, by a statement or a call with a literal name."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module)
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if called in ("import_module", "__import__", "importorskip"):
                names.add(str(node.args[0].value))
    return {name.partition(".")[0] for name in names}


def broken(room: Path, forbidden: set[str]) -> dict[str, set[str]]:
    """For each source file of a room, the forbidden imports that it holds."""
    found = {
        str(path.relative_to(room)): imported(path.read_text()) & forbidden for path in room.rglob("*.py")
    }
    return {path: names for path, names in found.items() if names}


@pytest.mark.parametrize("room", FORBIDDEN)
def test_arrows_run_one_way(room):
    assert broken(ROOT / room, FORBIDDEN[room]) == {}


def test_the_product_runs_without_the_laboratory():
    """With `lab` made impossible to import, every module of the product that needs no extra loads."""
    code = (
        "import sys, pkgutil, importlib\nsys.modules['lab'] = None\n"
        "import slipgym, estimator, policies, policies.commands.front as front\n"
        "for name in front.COMMANDS: front.application(name)\n"
        "print([c.name for c in front.app.registered_commands])"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, capture_output=True, text=True)
    assert "leaderboard" in done.stdout
    assert "reproduce" not in done.stdout


@pytest.mark.parametrize(
    "planted",
    [
        "import torch",
        "import numpy, torch.nn as nn",
        "from torch import nn",
        "from torch.nn import functional",
        "def f():\n    import torch",
        "try:\n    import torch\nexcept ImportError:\n    pass",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from torch import Tensor",
        "import importlib\nimportlib.import_module('torch.nn')",
        "torch = __import__('torch')",
    ],
)
def test_a_planted_import_is_found(planted, tmp_path):
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "bad.py").write_text(planted)
    (tmp_path / "good.py").write_text("import torchlike\nfrom . import torch\nprint('import torch')")
    assert broken(tmp_path, {"torch"}) == {str(Path("deep", "bad.py")): {"torch"}}


def loaded_by(statement: str) -> set[str]:
    """The top-level modules that a fresh interpreter holds after a statement."""
    code = f"{statement}\nimport sys, json\nprint(json.dumps(list(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, capture_output=True, text=True)
    return {name.partition(".")[0] for name in json.loads(done.stdout.splitlines()[-1])}


def test_import_slipgym_is_light():
    loaded = loaded_by("import slipgym")
    assert "slipgym" in loaded
    assert loaded & HEAVY == set()


def test_import_policies_loads_no_learning_library():
    loaded = loaded_by("import policies, policies.training.files")
    assert "policies" in loaded
    assert loaded & (LEARNING | {"optuna", "ray"}) == set()


def test_a_heavy_import_is_found():
    assert loaded_by("import slipgym, pydantic") & HEAVY == {"pydantic"}


def test_the_records_room_loads_tables_and_figures_only_when_used():
    loaded = loaded_by("import estimator.records")
    assert loaded & ({"slipgym", "policies", "pandas", "matplotlib", "yaml", "numba"} | LEARNING) == set()
