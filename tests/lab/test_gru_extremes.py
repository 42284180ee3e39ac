"""Readings and weights of "gru" of any size: what is not refused gives finite estimates."""

import numpy as np
import pytest

import estimator
from lab.learned_estimator import weights
from lab.learned_estimator.gru import NAME
from tests.estimator.test_extreme_readings import RATE, SIZES, assert_finite, samples


@pytest.mark.parametrize("place", range(7))
def test_no_reading_leaves_a_number_that_is_not_finite(place):
    rng = np.random.default_rng(place)
    signed = [sign * size for size in SIZES for sign in (1.0, -1.0)]
    batch = estimator.make_batch(NAME, len(signed))
    for k, (wrench, twist) in enumerate(samples(rng, 100)):
        readings = np.tile(np.concatenate([wrench, twist]), (len(signed), 1))
        if k % 7 == 3:
            readings[:, place] = rng.permutation(signed)
        batch.update(k / RATE, np.ascontiguousarray(readings[:, :4]), np.ascontiguousarray(readings[:, 4:]))
        assert_finite(batch, f"sample {k}")


@pytest.mark.parametrize("size", [3e38, 1e33, 1e5])
@pytest.mark.parametrize("name", weights.SHAPES)
def test_weights_are_refused_or_give_finite_estimates(tmp_path, name, size):
    tensors = weights.load()
    signs = np.where(np.arange(tensors[name].size) % 2, size, -size).astype(np.float32)
    path = tmp_path / "mine.npz"
    changed = {**tensors, name: signs.reshape(tensors[name].shape)}
    if size > 1e5:
        with pytest.raises(ValueError, match="could give values that are not finite"):
            weights.save(path, changed, "a note")
        return
    weights.save(path, changed, "a note")
    batch = estimator.make_batch(NAME, 2, weights=str(path))
    rng = np.random.default_rng(2)
    for k, (wrench, twist) in enumerate(samples(rng, 100)):
        large = 10.0 ** rng.uniform(-300.0, 11.9, 7) if k % 3 == 1 else 1.0
        readings = np.concatenate([wrench, twist]) * np.stack([np.ones(7), np.ones(7) * large])
        batch.update(k / RATE, np.ascontiguousarray(readings[:, :4]), np.ascontiguousarray(readings[:, 4:]))
        assert_finite(batch, f"sample {k}")


def test_huge_weights_of_a_file_are_refused_at_load(tmp_path, monkeypatch):
    path = tmp_path / "mine.npz"
    huge = np.full(weights.SHAPES["head_of_hidden"], 3e38, np.float32)
    with monkeypatch.context() as unchecked:
        unchecked.setattr(weights, "_check_reach", lambda tensors: None)
        weights.save(path, {**weights.load(), "head_of_hidden": huge}, "a note")
    with pytest.raises(ValueError, match=r"head_of_hidden .* not finite") as refused:
        estimator.make(NAME, weights=str(path))
    assert str(path) in str(refused.value)
