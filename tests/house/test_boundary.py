"""The boundary between public and inner modules of slipgym, which `policies` and `scripts` keep to."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PUBLIC = (
    "slipgym",
    "slipgym.atomic_io",
    "slipgym.benchmarking",
    "slipgym.config",
    "slipgym.contact",
    "slipgym.envs",
    "slipgym.envs.actions",
    "slipgym.envs.arguments",
    "slipgym.envs.engines",
    "slipgym.envs.load_part",
    "slipgym.envs.observation",
    "slipgym.envs.simulation",
    "slipgym.registration",
    "slipgym.rendering",
    "slipgym.synthetic",
    "slipgym.tasks",
    "slipgym.validation",
)
"""Public modules, with all below them; of `slipgym.envs` those that are listed."""
INNER = {
    "policies/evaluation/sensor_record.py": "keeps raw sensor samples",
    "policies/live.py": "makes observations of the readings of a real gripper",
    "policies/play/watch.py": "makes an environment of a class",
    "policies/policy_leaderboard/entries.py": "reads the privileged group by its columns",
    "policies/training/adapter.py": "wraps the vector environment",
    "policies/training/checkpoint_io.py": "writes the state of environments",
}
"""Files that may import inner modules, and why."""


def imported(source: str) -> set[str]:
    """Modules of slipgym that a source imports anywhere."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module)
    return {name for name in names if name.partition(".")[0] == "slipgym"}


def public(module: str) -> bool:
    """Whether a module is public."""
    if module in PUBLIC:
        return True
    folder = module.rpartition(".")[0]
    return folder in PUBLIC and folder not in ("slipgym", "slipgym.envs")


def sources() -> list[Path]:
    return sorted([*(ROOT / "policies").rglob("*.py"), *(ROOT / "scripts").rglob("*.py")])


def test_inner_modules_are_used_by_few_files_that_say_why():
    found = {}
    for path in sources():
        inner = {name for name in imported(path.read_text()) if not public(name)}
        if inner:
            found[path.relative_to(ROOT).as_posix()] = inner
    assert set(found) == set(INNER), found
    assert not any(".".join(("slipgym", "_numba")) in name for names in found.values() for name in names)


@pytest.mark.parametrize(
    ("folder", "names"), [("policies", r"\w+"), ("scripts", r"\w+"), ("tests", "(loop|simulation|observer)")]
)
def test_nobody_touches_what_an_environment_keeps_to_itself(folder, names):
    private = re.compile(rf"\b(env|envs|unwrapped|simulation)\._(?!_){names}\b")
    touched = {
        str(path.relative_to(ROOT)): match.group()
        for path in (ROOT / folder).rglob("*.py")
        for match in private.finditer(path.read_text())
        if path != Path(__file__)
    }
    assert touched == {}


def test_the_rules_find_what_they_are_for():
    assert imported("import numpy\nfrom slipgym.world import plant\ndef f():\n    import slipgym._numba") == {
        "slipgym.world",
        "slipgym._numba",
    }
    assert public("slipgym.config.errors")
    assert not public("slipgym.world.plant")
    assert not public("slipgym.envs.slip_env")
