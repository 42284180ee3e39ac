"""Parameters of the "disc" estimator."""

from dataclasses import dataclass

from estimator.joint.parameters import JointParameters
from estimator.parameters import parameter


@dataclass(frozen=True)
class DiscParameters(JointParameters):
    """Those of "joint", with the law error of a surface that is exact.

    Each field's metadata holds its documentation, unit and valid interval.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    law_error: float = parameter(
        0.005, "Relative error of the friction law in a sample, as if it were white.", "[0, inf)"
    )
