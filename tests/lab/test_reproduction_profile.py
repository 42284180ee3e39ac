"""The velocity profile: what the estimators find, against closed forms."""

import numpy as np
import pandas as pd
import pytest

import estimator
from lab.reproduction import profile as module
from lab.reproduction import reproduce_profile
from lab.reproduction.fixed_point import disc_bias
from policies.evaluation.frames import markdown
from policies.leaderboard.profile_course import STEADY, disc, slip, start
from policies.leaderboard.profile_course import profile as profile_course
from policies.leaderboard.scenario import replay
from slipgym.contact import DistributedContact, EllipsoidContact
from slipgym.synthetic import Course, ideal, integrate

START = Course.start(mu_c=0.40, mu_s=0.54, r=disc(0.012), normal=5.0)
VISCOUS = 0.2 * 0.020 / 0.40
OPEN = {"eps_t": 0.1, "eps_tau": 0.1}  # gates that no slip of these tests closes


def errors(gamma_t: float, contact, **parameters: float) -> np.ndarray:
    """Relative errors of mu_c and r by "rls" after 2 s of steady slip, on exact data."""
    course = start(START, "planar", gamma_t, 0.020).to("planar", 2.0)
    last = replay("rls", ideal(integrate(course, contact), instant=True), 0, **parameters)[0, -1]
    return np.array([last["mu_c"] / 0.40, last["r"] / disc(0.012)]) - 1.0


@pytest.mark.parametrize(
    ("gamma_t", "mu_c", "r"), [(0.3, -17, 21), (0.5, -15, 17), (0.707, -9, 5), (0.8, -4, -7), (0.9, 0, -20)]
)
def test_bias_on_a_disc_is_the_documented_one(gamma_t, mu_c, r):
    # docs/estimator.md, in whole percents
    np.testing.assert_allclose(100.0 * np.array(disc_bias(gamma_t)), (mu_c, r), atol=0.6)


def test_bias_is_where_the_ellipsoids_equations_rest():
    """By an integral over the disc, and the equations as the estimator iterates them."""
    gamma_t, viscous = 0.6, 0.02
    omega = np.sqrt(1 - gamma_t**2) / disc(1.0)
    rho, angle = (np.arange(2000) + 0.5) / 2000, 2 * np.pi * (np.arange(2000) + 0.5) / 2000
    x, y = np.outer(rho, np.cos(angle)), np.outer(rho, np.sin(angle))
    v_x, v_y = gamma_t - omega * y, omega * x
    level = 1.0 / np.hypot(v_x, v_y) + viscous
    share = np.outer(rho, np.ones(2000)) / rho.sum() / 2000
    f_t, tau = (share * level * v_x).sum(), (share * level * (x * v_y - y * v_x)).sum()
    r = 1.0
    for _ in range(200):
        v = np.hypot(gamma_t, r * omega)
        mu_c = f_t * v / gamma_t
        r += 0.3 * (tau * v / (r * omega * mu_c) - r)
    # the midpoint rule's error at the centre of rotation is of order 1 / 2000
    np.testing.assert_allclose(disc_bias(gamma_t, viscous), (mu_c - 1.0, r / disc(1.0) - 1.0), atol=5e-4)


@pytest.mark.quick_cases("0.5", "0.9")
@pytest.mark.parametrize("gamma_t", [0.3, 0.5, 0.707, 0.8, 0.9])
def test_planar_errors_on_a_disc_are_the_ellipsoids_bias(gamma_t):
    contact = DistributedContact(cells=41, sigma_2=0.2)
    # 21 cells a side leave 0.7 points, 61 below 0.1: the grid's part is below 0.7 (21 / 41)^2
    np.testing.assert_allclose(errors(gamma_t, contact, **OPEN), disc_bias(gamma_t, VISCOUS), atol=2.5e-3)


@pytest.mark.parametrize("gamma_t", [0.5, 0.8])
def test_on_an_ellipsoid_there_is_no_such_bias(gamma_t):
    # only sigma_2 v is read as friction; the start value has faded by 0.98^240 = 0.8 %
    np.testing.assert_allclose(errors(gamma_t, EllipsoidContact(sigma_2=0.2)), (VISCOUS, 0.0), atol=2e-3)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "CELLS", 25)  # 0.5 points, and a third of the time
        return reproduce_profile(tmp_path_factory.mktemp("runs"), seeds=2, progress=False)


@pytest.mark.slow
def test_the_command_writes_what_it_names(folder):
    names = {"series.csv", "phases.csv", "events.csv", "table.md", "versions.json"}
    assert {path.name for path in folder.iterdir()} == names | {"ideal.png", "realistic.png"}
    series = pd.read_csv(folder / "series.csv")
    assert series.groupby(["sensors", "estimator"]).size().nunique() == 1
    page = (folder / "table.md").read_text(encoding="utf-8")
    heading = " | ".join((*estimator.names(), "disc, exact"))
    assert page.count(f" | {heading} |") == 3
    table = pd.read_csv(folder / "phases.csv").set_index(["sensors", "estimator", "phase"])
    row = page[page.index("## Error of r") :].partition("| more spin |")[2].split("\n")[0].split(" | ")
    for cell, place in ((row[1 + estimator.names().index("joint") + 1], "realistic"), (row[-1], "ideal")):
        error = table.loc[(place, "joint" if place == "realistic" else "disc", "more spin"), "r_%"]
        assert cell.strip(" |").replace("−", "-") == f"{error:+.1f}"


def test_rls_finds_the_truth_where_the_model_holds_and_its_bias_where_not(folder):
    """On exact data, from Table 1's start values."""
    table = pd.read_csv(folder / "phases.csv")
    found = table[(table["sensors"] == "ideal") & (table["estimator"] == "rls")].set_index("phase")
    assert list(found.index) == list(STEADY)
    assert found.loc[["linear", "linear again"], "mu_c_%"].abs().max() < 1.5
    assert abs(found.loc["rotational", "r_%"]) < 1.5
    planar = found[found["gamma_t"].between(0.1, 0.9)]
    assert len(planar) == 4
    for name in ("mu_c", "r"):
        assert (planar[f"{name}_%"] - planar[f"{name}_predicted_%"]).abs().max() < 1.0
    assert planar["mu_c_predicted_%"].max() < -4.0  # a bias worth the name


def test_everything_changes_while_it_slides():
    course = profile_course()
    t = np.arange(0.0, course.times[-1], 0.01)
    (v_x, _, omega, _, mu_c, mu_s, r), phases = course.at(t), course.phases(t)
    for label in ("growing", "shrinking"):
        inside = phases == label
        assert min(v_x[inside][30:].min(), omega[inside][30:].min()) > 0.0
        for values in (mu_c, mu_s, r):
            assert np.ptp(values[inside]) > 0.2 * values[inside].mean()
    assert 1.2 < (mu_s / mu_c).min() < (mu_s / mu_c).max() < 1.4


def test_a_stop_is_an_event_and_its_estimate_is_judged_before_the_next():
    trace = integrate(slip(START.to("stop", 0.2), "linear", 0.3, 1.0, 0.020))
    estimates = np.zeros((1, len(trace.t)), [("mu_s", float)])
    estimates["mu_s"] = 0.54 * (1.0 + 0.1 * (trace.phase == "linear"))
    table = module.events(trace, "ideal", "rls", estimates)
    assert table["event"].tolist() == ["start of linear", "stop of linear"]
    np.testing.assert_allclose(table["error_%"], [10.0, 0.0], atol=1e-9)


def test_markdown_has_a_dash_for_what_is_not_there():
    table = pd.DataFrame({"name": ["a"], "x": [-1.234], "n": [3], "none": [np.nan]})
    assert markdown(table, digits=1).splitlines()[-1] == "| a | −1.2 | 3 | – |"
