"""What the registry needs to know of "disc"."""

from estimator.disc.parameters import DiscParameters
from estimator.joint.kernel import update_batch
from estimator.joint.state import initial_states
from estimator.registry import Specification

SPECIFICATION = Specification("disc", DiscParameters, initial_states, update_batch)
