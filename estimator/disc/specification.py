"""What the registry needs to know of "disc"."""

from dataclasses import dataclass

from estimator.joint.kernel import update_batch
from estimator.joint.parameters import JointParameters
from estimator.joint.state import initial_states
from estimator.parameters import parameter
from estimator.registry import Specification


@dataclass(frozen=True)
class DiscParameters(JointParameters):
    """Those of "joint", but for the limit surface.

    Raises:
        ValueError: As `JointParameters`.
    """

    disc: bool = parameter(
        True, "Whether the limit surface is that of a uniform disc; otherwise it is the ellipsoid."
    )


SPECIFICATION = Specification("disc", DiscParameters, initial_states, update_batch)
