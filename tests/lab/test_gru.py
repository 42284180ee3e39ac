"""The weights of "gru": read without pickle, refused if damaged; what the estimator makes of them."""

import io
import pickle
import zipfile

import numpy as np
import pytest

import estimator
from lab.learned_estimator import weights
from lab.learned_estimator.gru import NAME
from tests.estimator.exact_records import RATE, ellipsoid, planar, run

SLIP = ellipsoid(120, *planar(0.7, 0.008), mu_c=0.4, r=0.008)


def stored(**changes):
    """The bytes of an npz of the clone's weights with some entries replaced; None leaves one out."""
    entries = {"about": np.array("a note"), **weights.load(), **changes}
    stream = io.BytesIO()
    np.savez(stream, **{name: value for name, value in entries.items() if value is not None})
    return stream.getvalue()


def test_the_weights_of_the_clone_are_small_and_say_where_they_come_from():
    assert weights.OWN.stat().st_size < 300_000
    assert "slipgym train-estimator --seed" in weights.note()
    assert "Licence" in weights.note()


class Evil:
    def __reduce__(self):
        return pytest.fail, ("pickled code was run",)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "not a zip file"),
        (b"weights", "not a zip file"),
        (stored()[:-100], "zip"),
        (stored()[:20_000] + b"\x00" * 64 + stored()[20_064:], "CRC"),
        (stored(start=None), "missing or too many: start"),
        (stored(more=np.zeros(3, np.float32)), "missing or too many: more"),
        (stored(start=np.zeros(4, np.float32)), r"start is float32 \(4,\), expected float32 \(3,\)"),
        (stored(start=np.zeros(3)), "start is float64"),
        (stored(start=np.array([0.0, np.nan, 0.0], np.float32)), "start holds numbers that are not finite"),
        (stored(start=np.array([Evil()] * 3)), "allow_pickle"),
        (pickle.dumps(Evil()), "not a zip file"),
        (b"\x00" * (weights.LIMIT + 1), "larger than"),
    ],
)
def test_a_damaged_file_is_refused_and_named(tmp_path, data, message):
    path = tmp_path / "mine.npz"
    path.write_bytes(data)
    with pytest.raises(ValueError, match=message) as caught:
        estimator.make(NAME, weights=str(path))
    assert str(path) in str(caught.value)


def test_a_file_that_unpacks_to_too_much_is_refused(tmp_path):
    path = tmp_path / "bomb.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("start.npy", b"\x00" * (2 * weights.LIMIT))
    with pytest.raises(ValueError, match="unpacks to more than"):
        estimator.make(NAME, weights=str(path))


@pytest.mark.parametrize("value", [3, None, True])
def test_the_file_is_a_text(value):
    with pytest.raises(ValueError, match=f"weights = {value}: expected a text"):
        estimator.make(NAME, weights=value)


def test_a_file_that_is_not_there_or_a_folder_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none\.npz"):
        estimator.make(NAME, weights=str(tmp_path / "a folder of a long name" / ("b" * 150) / "none.npz"))
    with pytest.raises(ValueError, match="no regular file"):
        estimator.make(NAME, weights=str(tmp_path))


def test_weights_are_saved_and_used(tmp_path):
    """A head without weights states its biases: the averages go to them, the deviations are what they say."""
    tensors = {name: np.zeros_like(tensor) for name, tensor in weights.load().items()}
    tensors["head_bias"][:6] = 8.0, 8.0, 8.0, *np.log((0.6, 0.45, 0.007))
    paths = [tmp_path / name for name in ("first.npz", "second.npz")]
    for path in paths:
        weights.save(path, tensors, "a note")
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert weights.note(paths[0]) == "a note"
    e = run(estimator.make(NAME, weights=str(paths[0])), SLIP)[-1]
    assert (e.mu_s, e.mu_c, e.r) == pytest.approx((0.6, 0.45, 0.007), rel=1e-5)
    assert (e.sd_mu_s / e.mu_s, e.sd_mu_c / e.mu_c, e.sd_r / e.r) == pytest.approx((0.1, 0.1, 0.1), rel=1e-5)
    assert (e.confidence_mu_c, e.confidence_r) == pytest.approx((0.5, 0.5), rel=1e-5)
    assert e.sd_lever / (e.mu_c * e.r) == pytest.approx(0.1, rel=1e-5)
    with pytest.raises(ValueError, match="not finite"):
        weights.save(paths[0], {**tensors, "start": np.full(3, np.inf, np.float32)}, "")


def test_values_are_start_values_until_a_slip_shows_them():
    est = estimator.make(NAME)
    for k in range(60):
        e = est.update(k / RATE, (1.0, 0.0, 5.0, 0.01), (0.0, 0.0, 0.0))
    assert (e.mu_s, e.mu_c, e.r) == (0.9, 0.7, 0.01)
    assert (e.confidence_mu_s, e.confidence_mu_c, e.confidence_r) == (0.0, 0.0, 0.0)
    for k in range(60, 90):
        e = est.update(k / RATE, (2.0, 0.0, 5.0, 0.0), (0.02, 0.0, 0.0))
    assert e.confidence_mu_c > 0.0
    assert e.confidence_mu_s > 0.0
    assert (e.r, e.confidence_r) == (0.01, 0.0)


def test_frame_mirroring_and_sign_do_not_matter():
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    first, second = estimator.make(NAME), estimator.make(NAME)
    for t, wrench, twist in SLIP:
        a = first.update(t, wrench, twist)
        f, v = turn @ np.asarray(wrench[:2]), turn @ np.asarray(twist[:2])
        b = second.update(t, (*-f, wrench[2], -wrench[3]), (*v, -twist[2]))
    assert (b.mu_s, b.mu_c, b.r) == pytest.approx((a.mu_s, a.mu_c, a.r), rel=1e-4)


def test_readings_of_the_open_gripper_are_subtracted():
    zero = np.array([0.1, -0.15, 0.2, 1e-3])
    clean, biased = estimator.make(NAME), estimator.make(NAME)
    for k in range(24):
        clean.update(k / RATE, np.zeros(4), np.zeros(3))
        biased.update(k / RATE, zero, np.zeros(3))
    for t, wrench, twist in SLIP:
        a = clean.update(1.0 + t, wrench, twist)
        b = biased.update(1.0 + t, np.asarray(wrench) + zero, twist)
    assert (b.mu_s, b.mu_c, b.r) == pytest.approx((a.mu_s, a.mu_c, a.r), rel=1e-4)
