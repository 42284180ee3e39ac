"""The workloads of the benchmark: what they print, and that each is what it is called."""

import pytest

from policies.evaluation.workloads import workloads


@pytest.mark.slow
@pytest.mark.parametrize("env_id", ["slipgym/LinearSlip-v0", "slipgym/PlanarSlip-v0"])
def test_every_workload_is_measured(env_id):
    figures = {figure.name: figure.value for figure in workloads(env_id, blocks=1, size=64, steps=60)}
    shares = {name: value for name, value in figures.items() if name.endswith("slipping rows")}
    assert len(figures) == 10
    assert len(shares) == 5
    firm, limit = (next(v for n, v in shares.items() if w in n) for w in ("held firmly", "slip limit"))
    assert firm < 0.02
    assert limit > 0.25
    assert all(value > 0.0 for name, value in figures.items() if name not in shares)
