"""Making estimators, their parameters and their errors."""

import copy
import dataclasses
import pickle
import subprocess
import sys

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import ellipsoid, run

GOOD = (0.1, (1.0, 0.0, 5.0, 0.01), (0.01, 0.0, 0.1))


def test_import_loads_no_compiler_and_no_simulator():
    code = (
        "import sys, estimator; estimator.names()\n"
        "heavy = {'numba', 'slipgym', 'policies', 'gymnasium', 'pybullet', 'torch'} & set(sys.modules)\n"
        "estimator.make('rls')\n"
        "heavy |= {'slipgym', 'policies', 'gymnasium', 'pybullet', 'torch'} & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_names():
    assert "rls" in estimator.names()
    for name in estimator.names():
        assert isinstance(estimator.make(name).estimate, estimator.Estimate)


@pytest.mark.parametrize("name", ["kalman", "", None, 3])
def test_an_unknown_name_lists_the_valid_ones(name):
    with pytest.raises(ValueError, match=f"{name!r}.*valid: .*rls"):
        estimator.make(name)
    with pytest.raises(ValueError, match="rls"):
        estimator.make_batch(name, 2)


@pytest.mark.parametrize("make", [estimator.make, lambda name: estimator.make_batch(name, 2)])
def test_an_estimator_of_the_laboratory_says_where_it_is(make):
    with pytest.raises(
        ValueError, match=r'^"gru" is part of the laboratory: use "lab.*in a clone$'
    ) as refused:
        make("gru")
    assert estimator.make(str(refused.value).split('"')[3]).name == "lab.learned_estimator.gru:SPECIFICATION"
    assert "gru" not in estimator.names()


def test_an_unknown_parameter_lists_the_valid_ones():
    with pytest.raises(ValueError, match=r"unknown parameter lambda_.*forgetting"):
        estimator.make("rls", lambda_=0.98)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("heuristic", 1),
        ("heuristic", "no"),
        ("mu_c0", 0.0),
        ("mu_c0", np.nan),
        ("mu_c0", np.inf),
        ("mu_c0", "1.3"),
        ("mu_c0", None),
        ("mu_c0", True),
        ("r0", -0.02),
        ("eps_t", 1.0),
        ("forgetting", 1.0),
        ("forgetting", 0.0),
        ("covariance_limit", 0.5),
        ("n_a", 0),
        ("n_a", 2.0),
        ("n_a", True),
        ("n_b", 65),
        ("stick_samples", 0),
        ("halt_duration", -0.05),
        ("stick_band", 1j),
    ],
)
def test_a_bad_value_names_itself_and_the_range(name, value):
    with pytest.raises(ValueError, match=f"{name} = .*expected"):
        estimator.make("rls", **{name: value})


@pytest.mark.parametrize("name", ["adaptive", "rls", "joint", "disc", "ukf"])
def test_a_length_in_another_unit_is_refused(name):
    """15 mm of a pad as 15 m: no bound of the kind admits it, whichever parameter it is."""
    fields = dataclasses.fields(estimator.make(name).parameters)
    lengths = [each.name for each in fields if each.metadata["unit"] == "m"]
    assert {"r0", "r_min", "r_max"} <= set(lengths)
    for length in lengths:
        with pytest.raises(ValueError, match=rf"{length} = 15: expected a number in \(0, 0\.\d+\] m"):
            estimator.make(name, **{length: 15})


@pytest.mark.parametrize(
    "values",
    [
        {"n_a": 17},
        {"stick_band": 0.002},
        {"mu_c0": 11.0},
        {"mu_s0": 0.001},
        {"r0": 0.2},
        {"r_min": 0.03},
        {"sample_time": 0.1},
    ],
)
def test_values_that_contradict_each_other(values):
    with pytest.raises(ValueError, match=f"{next(iter(values))} = .*<="):
        estimator.make("rls", **values)


@pytest.mark.parametrize("n", [0, -1, 2.0, True, "2"])
def test_a_bad_batch_size(n):
    with pytest.raises(ValueError, match="n = "):
        estimator.make_batch("rls", n)


def test_defaults_are_table_1():
    table = {
        "mu_c0": 1.3,
        "mu_s0": 1.5,
        "r0": 0.02,
        "eps_tau": 0.3,
        "eps_t": 0.3,
        "eps_v": 1.5e-3,
        "eps_fn": 0.2,
        "p0": 1.0,
        "forgetting": 0.98,
        "n_a": 2,
        "n_b": 16,
        "eps_delta": 150.0,
        "halt_duration": 0.05,
        "sample_time": 1 / 120,
    }
    defaults = dataclasses.asdict(estimator.make("rls").parameters)
    assert {name: defaults[name] for name in table} == table
    assert defaults["heuristic"] is True


def test_numpy_scalars_become_plain_ones():
    parameters = estimator.make(
        "rls", n_a=np.int32(3), r0=np.float32(0.5) / 16, heuristic=np.False_
    ).parameters
    values = dataclasses.asdict(parameters)
    assert [type(values[name]) for name in ("n_a", "r0", "heuristic")] == [int, float, bool]
    assert (values["n_a"], values["r0"], values["heuristic"]) == (3, 0.03125, False)


@pytest.mark.parametrize(
    ("sample", "message"),
    [
        ((np.nan, *GOOD[1:]), "t = nan"),
        ((np.inf, *GOOD[1:]), "t = inf"),
        ((None, *GOOD[1:]), "t = None"),
        ((0.0, *GOOD[1:]), "t = 0.0: expected later"),
        ((-1.0, *GOOD[1:]), "t = -1.0: expected later"),
        ((0.1, (1.0, 0.0, np.nan, 0.0), GOOD[2]), "wrench: f_n = nan"),
        ((0.1, (1.0, 0.0, 5.0, -np.inf), GOOD[2]), "wrench: tau = -inf"),
        ((0.1, GOOD[1], (0.0, np.nan, 0.0)), "twist: v_y = nan"),
        ((0.1, (1.0, 0.0, 5.0), GOOD[2]), r"wrench: expected \(f_x, f_y, f_n, tau\), got shape \(3,\)"),
        ((0.1, GOOD[1], [[0.0, 0.0, 0.0]]), r"twist: expected \(v_x, v_y, omega\), got shape \(1, 3\)"),
        ((0.1, GOOD[1], ("a", "b", "c")), "twist: expected .* got not numbers"),
        ((0.1, None, GOOD[2]), "wrench: expected"),
    ],
)
def test_a_bad_sample_is_refused_and_changes_nothing(sample, message):
    est = estimator.make("rls")
    est.update(0.0, *GOOD[1:])
    before, estimate = est.batch.states.tolist(), est.estimate
    with pytest.raises(ValueError, match=message):
        est.update(*sample)
    assert str(est.batch.states.tolist()) == str(before)
    assert est.estimate == estimate


def test_reset_is_a_fresh_start():
    record = ellipsoid(100, 0.02, 1.0, 0.4, 0.01)
    est = estimator.make("rls")
    start = est.estimate
    first = run(est, record)
    est.reset()
    assert est.estimate == start
    assert run(est, record) == first


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda est: pickle.loads(pickle.dumps(est))])
def test_copies_go_their_own_way(duplicate):
    record = ellipsoid(60, 0.02, 1.0, 0.4, 0.01)
    est = estimator.make("rls", r0=0.015)
    run(est, record[:30])
    middle = est.estimate
    twin = duplicate(est)
    rest = run(est, record[30:])
    assert twin.estimate == middle
    assert run(twin, record[30:]) == rest
