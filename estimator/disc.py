"""The "disc" estimator: "joint" on the exact limit surface of a uniform disc."""

from dataclasses import dataclass

from estimator.joint import JointParameters, filter_matrices, initial_states, update_batch
from estimator.parameters import parameter
from estimator.registry import Specification


@dataclass(frozen=True)
class DiscParameters(JointParameters):
    """Those of "joint", with another limit surface.

    Raises:
        ValueError: As `JointParameters`.
    """

    disc: bool = parameter(
        True, "Whether the limit surface is that of a uniform disc; otherwise it is the ellipsoid."
    )


SPECIFICATION = Specification("disc", DiscParameters, initial_states, update_batch, filter_matrices)
