"""Online estimation of contact properties from wrench and slip velocity.

Estimates static friction mu_s, Coulomb friction mu_c and the radius r of the equivalent rim contact, one
estimator per finger, from the measurements of a sensorised gripper. Needs only numpy and numba, so it runs
beside a simulator as well as on a real gripper.

    import estimator

    est = estimator.make(estimator.DEFAULT)
    e = est.update(t, wrench, twist)
    e.mu_s, e.mu_c, e.r
"""

import importlib
from typing import TYPE_CHECKING, Any

from estimator.batch import BatchEstimator, make_batch
from estimator.estimate import ESTIMATE, Estimate
from estimator.online import OnlineEstimator, make
from estimator.reasons import reasons
from estimator.registry import DEFAULT, FilterMatrices, Specification, names

if TYPE_CHECKING:
    from estimator.disc import DiscParameters
    from estimator.joint import JointParameters
    from estimator.rls import RlsParameters
    from estimator.ukf import UkfParameters
    from estimator.window.parameters import AdaptiveParameters

_PARAMETERS = {
    "AdaptiveParameters": "estimator.window.parameters",
    "DiscParameters": "estimator.disc",
    "JointParameters": "estimator.joint",
    "RlsParameters": "estimator.rls",
    "UkfParameters": "estimator.ukf",
}
"""Class -> its module; imported on first use, because numba is slow to import."""

__all__ = [
    "DEFAULT",
    "ESTIMATE",
    "AdaptiveParameters",
    "BatchEstimator",
    "DiscParameters",
    "Estimate",
    "FilterMatrices",
    "JointParameters",
    "OnlineEstimator",
    "RlsParameters",
    "Specification",
    "UkfParameters",
    "make",
    "make_batch",
    "names",
    "reasons",
]


def __getattr__(name: str) -> Any:
    if name in _PARAMETERS:
        return getattr(importlib.import_module(_PARAMETERS[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
