"""Online estimation of contact properties from wrench and slip velocity.

Estimates static friction mu_s, Coulomb friction mu_c and the radius r of the equivalent rim contact, one
estimator per finger, from what a sensorised gripper measures. Needs numpy and numba only: it runs beside a
simulator as well as on a real gripper.

    import estimator

    est = estimator.make("rls")
    e = est.update(t, wrench, twist)
    e.mu_s, e.mu_c, e.r
"""

from estimator.disc.parameters import DiscParameters
from estimator.estimate import ESTIMATE, Estimate
from estimator.joint.parameters import JointParameters
from estimator.registry import make, make_batch, names
from estimator.rls.parameters import RlsParameters
from estimator.ukf.parameters import UkfParameters

__all__ = [
    "ESTIMATE",
    "DiscParameters",
    "Estimate",
    "JointParameters",
    "RlsParameters",
    "UkfParameters",
    "make",
    "make_batch",
    "names",
]
