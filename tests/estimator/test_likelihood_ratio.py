"""The test of "adaptive" for a change of mu_c while the contact rests."""

import numpy as np
import pytest

import estimator
from estimator.augmented.likelihood_ratio import respond_to_ratio
from estimator.augmented.parameters import AdaptiveParameters
from estimator.augmented.short_slips import _take
from estimator.augmented.slip_law import COP, FALLS, GROWS, MU, SIGMA, STATES, R, predict
from tests.estimator.exact_records import RATE

NEVER = 1e9
NOISE = np.array([0.02, 0.02, 0.04, 5e-4])
SPEED = np.array([3e-4, 3e-4, 0.01])
P = AdaptiveParameters().as_array().view(np.recarray)[0]


class World:
    """n fingers on hard pads that follow the estimator's law; each slip after a rest of 0.1 s."""

    def __init__(self, n, seed=None, r=0.006, **parameters):
        self.batch = estimator.make_batch("adaptive", n, compliance=0.0, compliance_max=0.0, **parameters)
        self.n, self.r, self.k = n, r, 0
        self.rng = None if seed is None else np.random.default_rng(seed)

    def step(self, mu_c, f_n, twist):
        """One sample; mu_c may differ between fingers."""
        wrenches = np.zeros((self.n, 4))
        wrenches[:, 2] = f_n
        for i, mu in enumerate(np.broadcast_to(mu_c, self.n).tolist()):
            if any(twist):
                x = np.zeros(STATES)
                x[MU], x[R], x[SIGMA] = np.log(mu), np.log(self.r), P.viscosity0
                found = predict(P, x, 0.0, 0.0, 1.0, f_n, *twist, np.zeros((3, STATES)), np.zeros((3, 3)))
                wrenches[i, [0, 1, 3]] = found[:3]
            else:
                wrenches[i, 1] = 0.15 * f_n
        twists = np.tile(np.array(twist, dtype=float), (self.n, 1))
        if self.rng is not None:
            wrenches += self.rng.normal(size=wrenches.shape) * NOISE
            twists += self.rng.normal(size=twists.shape) * SPEED * any(twist)
        self.k += 1
        self.batch.update(self.k / RATE, wrenches, twists)

    def slip(self, mu_c, f_n, twist, samples):
        """A rest, then a slip."""
        for _ in range(12):
            self.step(mu_c, f_n, (0.0, 0.0, 0.0))
        for _ in range(samples):
            self.step(mu_c, f_n, twist)


def test_the_response_is_what_a_change_leaves_behind():
    """Two fingers, one with mu_c larger by 0.1 %: error of every state over the change, by differences."""
    world = World(2, jump_odds=NEVER, law_gain=0.0)
    world.batch.states["limits"][:, 4:] = -1.0, 1.0, -1.0, 1.0  # no exponent meets its bound
    for f_n, twist in ((2.0, (0.02, 0.0, 0.0)), (2.0, (0.01, 0.01, 2.0)), (5.0, (0.0, 0.02, 1.0))):
        world.slip(0.5, f_n, twist, 40)
    change = 1e-3
    states = world.batch.states
    states["suspected"] = False
    world.slip(np.array([0.5, 0.5 * np.exp(change)]), 4.0, (0.015, 0.0, 1.5), 6)
    for f_n in (5.0, 7.0, 9.0, 9.0, 9.0):
        world.step(np.array([0.5, 0.5 * np.exp(change)]), f_n, (0.015, 0.0, 1.5))
    assert states["suspected"].all()
    moved = (states["x"][1] - states["x"][0]) / change
    expected = np.zeros(STATES)
    expected[MU] = 1.0
    assert (np.abs(moved[[MU, R, FALLS, COP]]) > 0.05).all()
    # the gain depends on the states, too
    np.testing.assert_allclose(states["response"][0], expected - moved, atol=0.01)


def test_the_response_to_a_scalar_measurement():
    """Against (1 - K h) times the response, and the fit against the sums of Willsky & Jones."""
    rng = np.random.default_rng(0)
    state = estimator.make_batch("adaptive", 1).states.view(np.recarray)[0]
    root, h, before = rng.normal(size=(STATES, STATES)), rng.normal(size=STATES), rng.normal(size=STATES)
    covariance, innovation = root @ root.T, 0.7
    weight = 1.0 / (h @ covariance @ h + 2.0)
    state.suspected, state.response[:] = True, before
    respond_to_ratio(state, h, covariance @ h, weight, innovation)
    shown = h @ before
    np.testing.assert_allclose(state.response, before - covariance @ h * weight * shown, rtol=1e-12)
    assert state.change_fit == pytest.approx(shown * weight * innovation)
    assert state.change_information == pytest.approx(shown * weight * shown)


def after_change(odds, mu_c):
    """Slides at 1.5 N with mu_c 0.5, then turns at 4 and 10 N with another; median errors of mu_c and r."""
    world = World(32, 1, jump_odds=odds)
    for _ in range(4):
        world.slip(0.5, 1.5, (0.02, 0.0, 0.0), 20)
    for f_n in (4.0, 10.0, 4.0):
        world.slip(mu_c, f_n, (0.003, 0.002, 1.0), 8)
    errors = (world.batch.estimates[name] / true - 1.0 for name, true in (("mu_c", mu_c), ("r", world.r)))
    return [float(np.median(np.abs(error))) for error in errors]


@pytest.mark.parametrize("mu_c", [0.35, 0.675])
def test_a_change_at_rest_is_neither_an_exponent_nor_another_radius(mu_c):
    """At another load, in a turn that shows r for the first time; without the test both take a part of it."""
    found, plain = (after_change(odds, mu_c) for odds in (AdaptiveParameters().jump_odds, NEVER))
    assert max(found) < 0.02
    assert min(plain) > 0.05


def test_slips_that_agree_are_rarely_a_change():
    """By its definition a likelihood ratio of exp(5) is seen by chance in at most exp(-5) of the slips.

    mu_c scatters by `sd_between_slips` between the slips of 100 fingers. Three slips each are 300, of which
    2 are expected at most; 8 and more have a probability below 0.1 %.
    """
    fingers, least = 100, AdaptiveParameters().sd_between_slips
    worlds = [World(fingers, 3, jump_odds=odds) for odds in (AdaptiveParameters().jump_odds, NEVER)]
    rng = np.random.default_rng(5)
    for f_n in (3.0, 3.0, 5.0, 4.0):
        mu_c = 0.5 * np.exp(rng.normal(size=fingers) * least)
        for world in worlds:
            world.slip(mu_c, f_n, (0.02, 0.0, 0.0), 12)
    first, second = (world.batch.states["x"] for world in worlds)
    assert np.any(first != second, axis=1).sum() < 8


def test_one_sample_is_no_change():
    """A single sample of a slip that is off by 40 %."""
    worlds = [World(1, jump_odds=odds) for odds in (AdaptiveParameters().jump_odds, NEVER)]
    for world in worlds:
        for _ in range(3):
            world.slip(0.5, 3.0, (0.02, 0.0, 0.0), 20)
        world.slip(0.5, 3.0, (0.02, 0.0, 0.0), 4)
        world.step(0.3, 3.0, (0.02, 0.0, 0.0))
        for _ in range(20):
            world.step(0.5, 3.0, (0.02, 0.0, 0.0))
    np.testing.assert_array_equal(worlds[0].batch.states["x"], worlds[1].batch.states["x"])


def test_an_exponent_stays_in_its_prior():
    """A change adds no more variance to an exponent than was unknown at the start."""
    world = World(16, 1)
    for _ in range(4):
        world.slip(0.5, 1.5, (0.02, 0.0, 0.0), 20)
    for f_n in (4.0, 12.0, 2.0, 8.0):
        world.slip(0.35, f_n, (0.015, 0.01, 1.0), 6)
        covariance = world.batch.states["covariance"]
        assert (covariance[:, FALLS, FALLS] <= P.sd_load_exponent**2 * (1.0 + 1e-9)).all()
        assert (covariance[:, GROWS, GROWS] <= P.sd_radius_exponent**2 * (1.0 + 1e-9)).all()
        for name in ("mu_c", "mu_s", "r", "sd_mu_c", "sd_mu_s", "sd_r"):
            assert np.isfinite(world.batch.estimates[name]).all(), name


def test_mu_s_moves_once_with_a_change():
    """A short slip in which a change is found: mu_s changes by it, and not again by what mu_c has moved."""
    batch = estimator.make_batch("adaptive", 1)
    state = batch.states.view(np.recarray)[0]
    mu_c, f_n, fit, information = 0.4, 5.0, -8e3, 2e4  # the slip itself adds about 1 %
    state.wrenches[:] = 0.0, mu_c * f_n, f_n, 0.0
    state.load = state.event_load = f_n
    state.samples, state.updates_mu_c, state.events_mu_s, state.change_events = 10, 20, 3, 3
    state.x[MU], state.covariance[MU, MU], state.shared, state.event = np.log(mu_c), 1e-4, 1e-4, 0.5
    state.suspected, state.change_samples, state.response[MU] = True, 5, 0.5
    state.change_fit, state.change_information = fit, information
    assert np.isfinite(_take(state, P, 5, 0.02))
    assert not state.suspected
    assert state.event == pytest.approx(0.5 * np.exp(fit / (information + P.sd_jump**-2)), rel=0.03)
