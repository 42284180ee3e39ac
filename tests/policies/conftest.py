import pytest

from policies.evaluation.experiment import Experiment
from slipgym.config.yaml_model import validate


@pytest.fixture
def small():
    """Makes small experiments: two short trials of a sliding grip in each of eight cells."""

    def make(**changes):
        values = {
            "name": "small",
            "task": "LinearSlip",
            "trials": 2,
            "materials": ["wood", "case"],
            "options": {"duration": 0.2, "settle": 0.05, "hold": 0.05},
            "vary": {"distance": [0.01, 0.02]},
            "policies": [{"name": "constant_force", "parameters": {"force": 2.0}}],
            "friction": [{"source": "estimated"}, {"source": "true"}],
        }
        return validate({**values, **changes}, Experiment, "test")

    return make
