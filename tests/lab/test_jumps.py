"""How soon mu_c is right again after a jump of friction in the loop."""

import numpy as np
import pytest
from typer.testing import CliRunner

from lab.commands.jumps import app
from lab.leaderboard.jumps import ENOUGH, FACTORS, TASKS, Course, jumps, summary, watched

LAB = {"estimator": "adaptive", "sensors": "lab"}
REALISTIC = {"estimator": "adaptive", "sensors": "realistic"}


def test_a_finger_counts_if_it_was_right_and_slips():
    """Finger 0 is right, jumps and is right again; finger 1 was wrong before."""
    steps, rate = 200, 120
    error, mu_c = np.full((steps, 1, 2), 0.01), np.full((steps, 1, 2), 0.4)
    error[:, :, 1] = 0.2
    mu_c[50:] *= 1.35
    error[50:80, 0, 0] = -0.26
    slips, running = np.zeros((steps, 1, 2), bool), np.ones((steps, 1, 2), bool)
    slips[60:150] = True
    running[190:] = False
    course = Course(error, mu_c, slips, running, 1.0 / rate)
    without = course._replace(mu_c=np.full_like(mu_c, 0.4), error=np.full_like(error, 0.06))
    found = summary(course, without)
    assert found["seen"] == 1
    assert found["first right"] == pytest.approx(21 / rate)  # steps 60 to 80
    assert found["within 0.5 s"] == found["right at 0.5 s"] == 100.0
    assert found["without jump"] == 0.0
    course.error[118:, 0, 0] = 0.1  # it is wrong again when it has slipped for 0.5 s
    assert summary(course, without)["right at 0.5 s"] == 0.0
    course.slips[:] = False
    course.error[50:, 0, 0] = 0.3  # it does not slip, so it shows nothing
    assert summary(course, without)["seen"] == 0


@pytest.mark.slow
def test_the_moment_of_the_jump_does_not_depend_on_its_size():
    small, large = (watched(TASKS[0], 3, 3, factor, **LAB).mu_c for factor in (1.06, 1.35))
    moments = [np.abs(mu_c / mu_c[0] - 1.0).argmax(axis=0) for mu_c in (small, large)]
    assert (moments[0] > 0).all()
    np.testing.assert_array_equal(*moments)


@pytest.mark.slow
@pytest.mark.xfail(reason="72 % instead of 75 % of the fingers", strict=True)
def test_planar_slip_is_right_again():
    """Disc, realistic sensors, as `slipgym jumps` prints it: three of four fingers at least.

    83 % of 64 fingers have a standard error of 5 %.
    """
    without = watched(TASKS[1], 32, 68100, 1.0, **REALISTIC, contact="disc")
    for factor in FACTORS:
        found = summary(watched(TASKS[1], 32, 68100, factor, **REALISTIC, contact="disc"), without)
        assert found["right at 0.5 s"] >= 75.0
        assert found["without jump"] >= 95.0


@pytest.mark.slow
def test_an_estimator_that_never_learns_is_never_right_again():
    deaf = {"name": "adaptive", "eps_v": 1e3}
    found = jumps(4, 0, TASKS[:1], deaf)
    assert not found["within 0.5 s"].fillna(0.0).any()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--episodes 0", "--episodes"),
        ("--episodes 2 --parameter memry=1", "did you mean 'memory'"),
        ("--episodes 2 --task holdd", "hold"),
    ],
)
def test_the_command_says_what_it_cannot_do(words, said):
    asked = CliRunner().invoke(app, words.split())
    assert asked.exit_code != 0
    assert said in " ".join(asked.output.replace("│", " ").split())


@pytest.mark.slow
@pytest.mark.xfail(reason="two of eight rows 0.53 and 0.57 s instead of 0.5 s", strict=True)
def test_it_is_right_again_after_little_slip():
    """LinearSlip: nearly all fingers, with either sensors. PlanarSlip: the typical one; see the page."""
    found = jumps(32, 500)
    linear = found[found["task"] == "LinearSlip"]
    assert (linear["within 0.5 s"] >= 90.0).all()
    assert (found["first right"] <= ENOUGH).all()
    assert (found["seen"] >= 20).all()
