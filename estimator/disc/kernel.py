"""The compiled update of the "disc" estimator: that of "joint" with another limit surface."""

from estimator.compiled import entry_point
from estimator.disc.parameters import DiscParameters
from estimator.joint.kernel import update
from estimator.joint.state import STATE
from estimator.limit_surface.shape import DISC


@entry_point(STATE, DiscParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Update n fingers by one sample each, on the uniform disc.

    Rows and arguments are those of `estimator.joint.kernel.update_batch`.
    """
    for i in range(len(states)):
        update(states[i], parameters[i % len(parameters)], DISC, t, wrenches[i], twists[i], estimates[i])
