"""Pushes on known supports: reading and reduction of a log, exact supports, fits, streams."""

import numpy as np
import pytest
from scipy.integrate import dblquad

import estimator
from estimator.limit_surface import DISC_RADIUS, disc_friction
from lab.pushes import EXTRACT, read, write
from lab.pushes import extract as extracting
from lab.pushes.extract import COLUMNS, Pushes
from lab.pushes.fit import expected, fit, friction_of_each, harmonic, misfit
from lab.pushes.logs import parse, reduced
from lab.pushes.replay import HOLD, SAMPLES, replay, stream
from lab.pushes.run import resamples, run_pushes
from lab.pushes.sources import FOLDER, HELD_OUT, LOGS, Log
from lab.pushes.support import CENTRE, FEET, LEG, PATCH, WEIGHT, mean_path, points, surface

SUPPORTS = [*FEET, PATCH]
needs_extract = pytest.mark.skipif(not EXTRACT.exists(), reason="the extract is not part of the repository")


def matrix(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def pose(x, y, yaw):
    return f"{1e3 * x} {1e3 * y} 8.5 {np.cos(yaw / 2)} 0 0 {np.sin(yaw / 2)}"


def written(force, place, twist, start, waiting=100, pushing=400):
    """A log of one push that moves the block by a twist of its own frame, integrated in small steps."""
    x, y, yaw = start
    heading = 0.7  # of the pusher
    zero = np.array([0.02, -0.08])
    corner = np.array([x, y]) - matrix(yaw) @ CENTRE
    before = pose(*corner, yaw)
    forces, pusher = [], []
    for k in range(waiting + pushing):
        moving = k >= waiting
        if moving:
            for _ in range(50):
                step = np.array(twist) / pushing / 50
                x, y = np.array([x, y]) + matrix(yaw + 0.5 * step[2]) @ step[:2]
                yaw += step[2]
        # reading of a sensor whose axes are at 45 degrees, one of them mirrored: minus the force on the block
        local = matrix(-heading) @ matrix(yaw) @ force * moving
        reading = zero - np.array([local[0] + local[1], local[0] - local[1]]) / np.sqrt(2.0)
        at = np.array([x, y]) + matrix(yaw) @ (np.array(place) - CENTRE)
        forces.append(f"{0.01 * k} {reading[0]} {reading[1]}")
        pusher.append(f"{0.01 * k} {pose(*at, heading)}")
    after = pose(*(np.array([x, y]) - matrix(yaw) @ CENTRE), yaw)
    return "\n".join(["1", before, after, str(len(forces)), *forces, str(len(pusher)), *pusher, ""])


def ideal(support, mu_c=0.3, number=40, scale=1.0, seed=0):
    """Pushes that obey the exact law of a support, with all lengths times a factor."""
    rng = np.random.default_rng(seed)
    r = surface(support).effective_radius
    displacement = rng.normal(size=(number, 3)) * [0.01, 0.01, 0.01 / r]
    rest = np.zeros((number, len(COLUMNS) - 6))
    log = Pushes(f"ideal, {support}", np.hstack((np.zeros((number, 3)), displacement, rest)))
    return Pushes(log.name, np.hstack((mu_c * expected(log, scale), displacement, rest)))


def as_logged(pushes):
    return np.arange(len(pushes.values))[None]


@pytest.mark.parametrize(
    ("twist", "start"),
    [
        ((0.012, -0.004, 0.2), (0.6, 0.02, 2.9)),
        ((-0.003, 0.01, -0.3), (0.5, 0.1, -3.0)),
        ((0.01, 0, 0), (0, 0, 0)),
    ],
)
def test_a_log_gives_back_wrench_and_displacement(twist, start):
    """Force and place are fixed to the block. The reduction sees neither: a wrong sign or frame shows.

    The numbers are printed with 16 digits; the pusher is where it is at the end of each sample, while the
    block's angle begins with the contact: 1/400 of the motion, or 3e-5 m, times 3.5 N.
    """
    force, place = np.array([3.0, -1.5]), (0.0, 0.09)
    (push,) = parse(written(force, place, twist, start))
    found = dict(zip(COLUMNS, reduced(push), strict=True))
    np.testing.assert_allclose([found[c] for c in ("d_x", "d_y", "d_theta")], twist, rtol=0, atol=2e-9)
    np.testing.assert_allclose([found["f_x"], found["f_y"]], force, atol=4e-3)
    arm = np.array(place) - CENTRE
    assert found["tau"] == pytest.approx(arm[0] * force[1] - arm[1] * force[0], abs=1.5e-4)
    np.testing.assert_allclose([found["x"], found["y"]], place, atol=5e-5)
    assert found["duration"] == pytest.approx(3.99)
    middle = start[2] + 0.5 * twist[2]
    assert np.cos(found["yaw"] - middle) == pytest.approx(1.0, abs=1e-9)


def test_a_cut_log_is_refused():
    text = written((3.0, 0.0), (0.0, 0.05), (0.01, 0.0, 0.1), (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="rows of 8 numbers"):
        list(parse(text[:-3000]))


@pytest.mark.parametrize("support", FEET)
def test_three_feet_carry_the_weight_about_the_centre_of_mass(support):
    positions, shares = points(support)
    assert (shares > 0.0).all()
    assert shares.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(shares @ positions, 0.0, atol=1e-16)


def test_the_radius_of_the_patch_is_that_of_a_triangle():
    """An integral in place of the sum; 1600 triangles are off by their second moments, under 1e-3."""
    integral, _ = dblquad(lambda y, x: np.hypot(x - 1 / 3, y - 1 / 3), 0, 1, 0, lambda x: 1 - x)
    assert surface(PATCH).effective_radius == pytest.approx(2.0 * LEG * integral, rel=1e-3)
    positions, shares = points(PATCH)
    np.testing.assert_allclose(shares @ positions, 0.0, atol=1e-15)


def test_an_unknown_support_lists_the_valid_ones():
    with pytest.raises(ValueError, match=r"large, wide, small, tiny, patch"):
        points("huge")


@pytest.mark.parametrize("support", SUPPORTS)
def test_the_fits_find_the_truth(support):
    pushes = ideal(support, mu_c=0.31)
    found = fit(pushes, as_logged(pushes))
    assert found.mu_c == pytest.approx(0.31, rel=1e-12)
    assert found.mu_c_wrench == pytest.approx(0.31, rel=1e-12)
    assert found.scale == 1.0
    assert misfit(pushes, 0.31).residual.max() < 1e-12


def test_the_friction_work_is_the_wrench_on_the_path():
    pushes = ideal("wide", mu_c=0.4)
    work = (pushes.wrench * pushes.displacement).sum(axis=1)
    np.testing.assert_allclose(work, 0.4 * WEIGHT * mean_path("wide", pushes.displacement), rtol=1e-12)
    np.testing.assert_allclose(friction_of_each(pushes), 0.4, rtol=1e-12)


def test_least_squares_find_the_lengths():
    """Candidates are 1 % apart."""
    pushes = ideal(PATCH, scale=1.3)
    assert fit(pushes, as_logged(pushes)).scale == pytest.approx(1.3, rel=0.006)


def test_errors_of_direction_cost_least_squares_more_than_the_work():
    """Measured displacements are off by 15 degrees: the first order of the error is in least squares only."""
    pushes = ideal("small", number=400)
    turned = pushes.values.copy()
    angles = np.random.default_rng(1).normal(size=400) * np.radians(15.0)
    turned[:, 3:5] = [matrix(angle) @ d for angle, d in zip(angles, turned[:, 3:5], strict=True)]
    found = fit(Pushes(pushes.name, turned), as_logged(pushes))
    assert found.mu_c_wrench < found.mu_c < 0.3


def test_a_harmonic_is_found():
    heading = np.random.default_rng(2).uniform(-3.0, 3.0, 300)
    spread = 1.0 + 0.08 * np.cos(2.0 * heading - 1.0)
    assert harmonic(spread, heading, 2) == pytest.approx(0.08, rel=1e-9)


def test_friction_opposes_every_slip_of_a_stream():
    pushes = ideal("large")
    wrenches, twists = stream(pushes, resamples(pushes, 3, 0))
    assert wrenches.shape == (40 * SAMPLES, 4, 4)
    power = (wrenches[..., [0, 1, 3]] * twists).sum(axis=2)
    moves = np.abs(twists).max(axis=2) > 0.0
    assert moves.sum() == 4 * 40 * HOLD
    assert (power[moves] < 0.0).all()
    assert (wrenches[..., 2] == WEIGHT).all()


def ellipsoid(turn, r):
    """Force and torque over r of the ellipsoid and of the disc, over mu_c and the weight."""
    return np.cos(turn), np.sin(turn)


def disc(turn, r):
    force, torque = disc_friction(DISC_RADIUS * np.cos(turn) / np.sin(turn))
    return force, torque / DISC_RADIUS


@pytest.mark.parametrize(("name", "law"), [("joint", ellipsoid), ("disc", disc), ("ukf", disc)])
def test_an_estimator_finds_friction_that_obeys_its_own_law(name, law):
    """mu_c and r in lengths of the block: the stream's scales cancel. The start is forgotten to under 1 %."""
    rng = np.random.default_rng(3)
    turns, headings, r = rng.uniform(0.4, 1.2, 50), rng.uniform(-3.0, 3.0, 50), 0.045
    rows = []
    for turn, heading in zip(turns, headings, strict=True):
        force, torque = law(turn, r)
        direction = np.array([np.cos(heading), np.sin(heading)])
        wrench = 0.3 * WEIGHT * np.array([*(force * direction), torque * r])
        rows.append([*wrench, *(0.01 * np.cos(turn) * direction), 0.01 * np.sin(turn) / r, 0, 0, 0, 0])
    pushes = Pushes("law, patch", np.array(rows))
    mu_c, found_r = replay(name, pushes, as_logged(pushes))
    assert mu_c == pytest.approx(0.3, rel=0.01)
    assert found_r == pytest.approx(r, rel=0.01)


@pytest.fixture
def clone(tmp_path, monkeypatch):
    """A clone whose logs hold a push each; the known digests are theirs."""
    text = written((3.0, 1.0), (0.0, 0.08), (0.01, 0.002, -0.1), (0.5, 0.0, 1.0))
    short = {}
    for name, log in LOGS.items():
        path = tmp_path / FOLDER / log.path
        path.parent.mkdir(parents=True)
        path.write_text(text)
        short[name] = Log(log.path, "")
    monkeypatch.setattr("lab.pushes.logs.LOGS", short)
    return tmp_path


def test_an_extract_holds_the_means_of_a_clone(clone, tmp_path):
    """Seven significant digits."""
    made = read(clone)
    assert [log.name for log in made] == list(LOGS)
    write(made, tmp_path / "extract.csv")
    again = read(tmp_path / "extract.csv")
    for one, other in zip(made, again, strict=True):
        assert one.support == other.support == one.name.split(", ")[1]
        np.testing.assert_allclose(other.values, one.values, rtol=6e-7)
    head = (tmp_path / "extract.csv").read_text().split("log,")[0]
    assert "Apache License" in head
    assert "4d86db9" in head


def test_another_log_is_refused(clone, monkeypatch):
    monkeypatch.setattr("lab.pushes.logs.LOGS", LOGS)
    with pytest.raises(ValueError, match="is not the log of commit 4d86db9"):
        read(clone)


def test_a_log_of_another_form_is_reported(clone, monkeypatch):
    names = list(HELD_OUT)[:2]
    held = {name: Log(f"{k}.txt", "") for k, name in enumerate(names)}
    for module in (extracting, "logs"):
        where = "lab.pushes.logs" if module == "logs" else module.__name__
        monkeypatch.setattr(f"{where}.HELD_OUT", held)
    (clone / FOLDER / "0.txt").write_text("2\n1 2 3\n")
    (clone / FOLDER / "1.txt").write_bytes((clone / FOLDER / LOGS["wood, patch"].path).read_bytes())
    found, failed = extracting.read_held_out(clone)
    assert list(failed) == names[:1]
    assert [(log.name, log.support) for log in found] == [(names[1], "wide")]


def test_what_is_missing_is_said(tmp_path):
    with pytest.raises(ValueError, match=r"clone https://github\.com/robinzhoucmu/MLab_EXP"):
        read(tmp_path / "gone.csv")
    (tmp_path / "other.csv").write_text("log,f_x\nboard,1\n")
    with pytest.raises(ValueError, match="is not an extract"):
        read(tmp_path / "other.csv")


def test_the_tables_have_a_column_for_every_estimator():
    logs = [Pushes(f"board, {support}", ideal(support).values) for support in ("large", "tiny", PATCH)]
    page = run_pushes(logs, number=3)
    assert page.startswith("120 of 120 pushes")
    header = "| log | " + " | ".join(estimator.names())
    assert page.count(header) == 2
    assert "| board, tiny | 40 of 40 | 0.300 [0.300, 0.300] |" in page
    assert page.count("| log | best | in [%] | adaptive | ukf | disc | joint | rls |") == 3


@needs_extract
@pytest.mark.parametrize("log", read() if EXTRACT.exists() else [], ids=lambda log: log.name)
def test_the_extract_is_plausible(log):
    """Fifty pushes; friction takes energy in each; forces fit 1.518 kg, and motions are centimetres."""
    assert log.values.shape == (50, len(COLUMNS))
    assert (friction_of_each(log) > 0.0).all()
    ratio = np.hypot(*log.wrench[:, :2].T) / WEIGHT
    assert ratio.max() < 0.6
    assert np.abs(log.displacement[:, :2]).max() < 0.03
    x, y = log.values[:, COLUMNS.index("x")], log.values[:, COLUMNS.index("y")]
    edge = np.min([np.abs(x), np.abs(y), np.abs(LEG - x - y) / np.sqrt(2.0)], axis=0)
    assert np.median(edge) < 2e-3  # the pusher touches an edge of the block
