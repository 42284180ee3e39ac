"""The scripts around versions: lower bounds, and what CI installs."""

import importlib.util
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def script(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / "scripts" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_oldest_versions_are_the_lower_bounds():
    assert {"gymnasium==1.2", "numpy==1.26", "numba==0.63"} <= set(script("matrix").oldest())


def test_a_python_that_is_not_here_is_said_so():
    assert script("matrix").interpreter("2.99") is None


def test_why_pip_did_not_install_something():
    said = "The conflict is caused by:\n    slipgym 0.1.0 depends on pybullet>=3.2.7\nERROR: Cannot install"
    assert script("matrix").reason(said) == "no wheel of pybullet that fits"
    assert script("matrix").reason("WARNING: x\nERROR: No space\nERROR: other") == "No space"


def test_ci_installs_what_the_constraints_say_with_hashes():
    pins = dict(re.findall(r"^([\w.-]+)==(\S+)$", (ROOT / "constraints.txt").read_text(), re.MULTILINE))
    pins = {name.lower().replace("_", "-"): version for name, version in pins.items()}
    lines = [line for line in (ROOT / "requirements-ci.txt").read_text().splitlines() if line[0] != "#"]
    found = [re.fullmatch(r"([\w.-]+)==(\S+) --hash=sha256:[0-9a-f]{64}", line) for line in lines]
    assert all(found)
    different = {
        one[1]: (one[2], pins[one[1].replace("_", "-")])
        for one in found
        if pins.get(one[1].replace("_", "-"), one[2]) != one[2]
    }
    assert different == {}
