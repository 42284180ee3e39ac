"""The cache of compiled kernels notices a change in a function of another file."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import slipgym

CALL = """
from slipgym.contact.coupled import step_pads
from slipgym.contact.records import pads

held = pads(2, mu_c=0.4, mu_s=0.4, stribeck_velocity=1e-3, sigma_0=1e6, r=0.01, normal=1.0)
step_pads(held, None, (0.2, 1e-4), (0.0, 0.0), (1e-3, 0.0, 0.0), (1e-3, 0.0, 0.0), 1e-3)
print(held["wrench"][0, 0])
"""


@pytest.mark.slow  # it compiles the contact three times
def test_an_edited_kernel_is_compiled_again(tmp_path):
    root, copy = Path(slipgym.__file__).parents[1], tmp_path / "slipgym"
    for package in ("slipgym", "estimator", "policies"):  # slipgym refuses those of another folder
        shutil.copytree(root / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    paths = {**os.environ, "PYTHONPATH": str(tmp_path)}

    def friction() -> float:
        done = subprocess.run(
            [sys.executable, "-c", CALL], cwd=tmp_path, env=paths, capture_output=True, text=True, check=True
        )
        return float(done.stdout.split()[-1])

    before = friction()
    assert before == friction()
    kernel = copy / "contact" / "stribeck.py"  # called from coupled.py
    law = kernel.read_text()
    assert "return mu_c +" in law
    kernel.write_text(law.replace("return mu_c +", "return -0.2 + mu_c +"))
    assert friction() == pytest.approx(0.5 * before)
