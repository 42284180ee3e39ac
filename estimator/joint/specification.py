"""What the registry needs to know of "joint"."""

from estimator.joint.kernel import update_batch
from estimator.joint.parameters import JointParameters
from estimator.joint.state import initial_states
from estimator.registry import Specification

SPECIFICATION = Specification("joint", JointParameters, initial_states, update_batch)
