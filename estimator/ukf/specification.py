"""What the registry needs to know of "ukf"."""

from estimator.registry import Specification
from estimator.ukf.kernel import update_batch
from estimator.ukf.parameters import UkfParameters
from estimator.ukf.state import initial_states

SPECIFICATION = Specification("ukf", UkfParameters, initial_states, update_batch)
