"""The coupling of mu_c and r against its closed forms."""

import numpy as np
import pandas as pd
import pytest

import estimator
from lab.reproduction import coupling, reproduce_coupling
from lab.reproduction.fixed_point import (
    Slip,
    explicit_iteration,
    paper_map,
    radius_of,
    slope,
    slope_closed_form,
)
from lab.reproduction.lock_out import errors


@pytest.mark.parametrize("gamma_t", [0.1, 0.3, 0.5, 0.7, 0.9, 0.99])
def test_the_truth_is_a_fixed_point_and_the_slope_is_the_closed_form(gamma_t):
    slip = Slip(gamma_t)
    assert radius_of(slip, np.array(slip.mu_c)) == pytest.approx(slip.r, rel=1e-12)
    assert paper_map(slip, np.array(slip.mu_c)) == pytest.approx(slip.mu_c, rel=1e-12)
    assert slope(slip) == pytest.approx(slope_closed_form(gamma_t), abs=1e-8)
    assert abs(slope(slip)) < 1.0


def test_at_full_gain_the_explicit_step_is_an_inversion():
    """r_{k+1} = r*^2 / r_k, whatever the slip."""
    radii = explicit_iteration(Slip(0.6), 0.017, 1.0, 4)
    np.testing.assert_allclose(radii[1:], 0.010**2 / radii[:-1], rtol=1e-12)
    np.testing.assert_allclose(radii[::2], 0.017, rtol=1e-12)


@pytest.mark.parametrize("gain", [0.1, 0.4, 0.9])
def test_near_the_truth_the_error_shrinks_by_one_minus_two_gains(gain):
    error = explicit_iteration(Slip(0.6), 0.010 * (1 + 1e-6), gain, 1) / 0.010 - 1.0
    # the next order of the inversion is error^2, 1e-6 of the error
    assert error[1] / error[0] == pytest.approx(1.0 - 2.0 * gain, abs=1e-5)


def test_lock_out_is_what_one_estimator_does():
    gammas, radii = np.array([0.5, 0.9]), np.array([0.002, 0.02])
    error = errors("rls", gammas, radii, 20.0, progress=False)
    slip = Slip(0.9, f_n=20.0)
    alone = estimator.make("rls", r0=0.02)
    for k in range(1, 361):
        alone.update(k / 120, (slip.f_t, 0.0, slip.f_n, slip.tau), (slip.v_t, 0.0, slip.omega))
    last = alone.estimate
    alone_off = max(abs(last.mu_c / slip.mu_c - 1.0), abs(last.r / slip.r - 1.0))
    assert error[1, 1] == pytest.approx(alone_off, rel=1e-9)
    assert error[1, 1] > 0.2  # Table 1's start value locks out at 20 N and gamma_t 0.9
    assert error[1, 0] < 0.005


@pytest.mark.parametrize("name", ["disc", "joint", "ukf"])
def test_each_finds_the_truth_of_its_own_surface(name):
    gammas, radii = np.array([0.4, 0.7, 0.9]), np.array([0.003, 0.01, 0.05])
    assert (errors(name, gammas, radii, 5.0, progress=False) < 0.01).all()


def test_the_command_writes_what_it_names(tmp_path, monkeypatch):
    monkeypatch.setattr(coupling, "GAMMAS", np.array([0.4, 0.6]))
    monkeypatch.setattr(coupling, "RADII", np.array([0.005, 0.02]))
    folder = reproduce_coupling(tmp_path, progress=False)
    assert {path.name for path in folder.iterdir()} == {
        "versions.json",
        "slopes.csv",
        "lock_out.csv",
        "table.md",
        "map.png",
        "lock_out.png",
    }
    table = pd.read_csv(folder / "lock_out.csv")
    assert set(table["starts"]) == {4}
    assert table["still_off"].between(0.0, 1.0).all()
    printed = (folder / "table.md").read_text(encoding="utf-8")
    assert "| 0.5 | −0.60000000 | −0.60000000 |" in printed
    assert all(f'"{name}" still off' in printed for name in estimator.names())
    rls = 100 * table[(table["estimator"] == "rls") & (table["f_n_N"] == 20)]["still_off"].iloc[0]
    (row,) = (line for line in printed.splitlines() if line.startswith("| 20 |"))
    assert row.split(" | ")[1 + estimator.names().index("rls")] == f"{rls:.0f} %"
