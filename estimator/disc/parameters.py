"""Parameters of the "disc" estimator."""

from dataclasses import dataclass

from estimator.joint.parameters import JointParameters
from estimator.parameters import parameter


@dataclass(frozen=True)
class DiscParameters(JointParameters):
    """Those of "joint", but for the limit surface.

    Raises:
        ValueError: As `JointParameters`.
    """

    disc: bool = parameter(
        True, "Whether the limit surface is that of a uniform disc; otherwise it is the ellipsoid."
    )
