"""What the registry needs to know of "rls"."""

from estimator.registry import Specification
from estimator.rls.kernel import update_batch
from estimator.rls.parameters import RlsParameters
from estimator.rls.state import initial_states

SPECIFICATION = Specification("rls", RlsParameters, initial_states, update_batch)
