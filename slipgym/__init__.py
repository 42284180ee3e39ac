"""Gymnasium environments for slip-aware in-hand manipulation, with a friction estimator in the loop.

`import slipgym` registers the environments with Gymnasium:

    slipgym/LinearSlip-v0      slide the object down by a given distance
    slipgym/RotationalSlip-v0  turn it by a given angle
    slipgym/Hinge-v0           let it hang upright while the wrist pitches
    slipgym/PlanarSlip-v0      bring it to a pose (x, y, theta) in the grip
    slipgym/Hold-v0            keep it still while something shakes and pokes it
    slipgym/FragileHold-v0     lift and carry it without breaking it
    slipgym/Carry-v0           pick it up, swing it and set it down with little grip
    slipgym/PivotTo-v0         swing it to an angle by strokes of the wrist
    slipgym/Explore-v0         find its friction with little slip, and state it

    gym.make("slipgym/LinearSlip-v0", friction_source="estimated")
    gym.make_vec("slipgym/LinearSlip-v0", num_envs=1024)

Public modules:

    slipgym.envs         the environment classes, scalar and vector
    slipgym.contact      friction of one pad on its own
    slipgym.config       configuration, presets, randomization
    slipgym.tasks        the tasks; what a task of your own is made of
    slipgym.synthetic    records of one finger without a simulator
    slipgym.policies     controllers, learned policies, training: the package `policies`
    slipgym.estimator    the estimators alone: the package `estimator`
"""

from typing import TYPE_CHECKING, Any

from slipgym.beside import refuse_hidden
from slipgym.registration import register
from slipgym.version import __version__

if TYPE_CHECKING:
    from slipgym.envs import register_task

__all__ = ["__version__", "register_task"]

refuse_hidden("estimator")
register()


def __getattr__(name: str) -> Any:
    if name == "register_task":  # loads numba: on first use
        from slipgym.envs import register_task

        return register_task
    import gymnasium

    from estimator.suggestions import asking

    said, own = f"module {__name__!r} has no attribute {name!r}", f"gymnasium.{name}"
    if hasattr(gymnasium, name):  # `slipgym.make`
        raise AttributeError(f"{said}; did you mean {own!r}?")
    raise AttributeError(asking(said, name, [*__dir__(), "policies.make_vec_env"]))


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
