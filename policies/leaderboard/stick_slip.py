"""Stick-slip as the force loop makes it: closed-loop trials of the environment, as traces.

A prescribed twist cannot show what hurts an estimator here. In a patch that is held still,
friction is a share of f_n: when f_n rises, the force rises with it, and the ratio of a stuck
sample is still that of slip. In closed loop the load stays and the ratio falls.
"""

from __future__ import annotations

import numpy as np

import policies
from policies.stepping import environment_for, steps
from slipgym.synthetic import Trace


def linear_slip_trace(material: str, distance: float, duration: float, seed: int) -> Trace:
    """A trial of slipgym/LinearSlip-v0 under its controller, which knows the true friction.

    So the motion is the same whatever an estimator says. The contact is the distributed one: a
    uniform disc, as everywhere in the leaderboard. The distance is in [m], the duration in [s].

    Returns:
        What finger 1 truly felt and saw, at 120 Hz; the phase is "slip" where a sample moved on average
        faster than 1 mm/s, and "stick" elsewhere.
    """
    controller = policies.make("linear_slip_continuous")
    arguments = {"friction_source": "true", "contact": "distributed", "material": material}
    with environment_for(controller, "slipgym/LinearSlip-v0", **arguments) as env:
        observation, first = env.reset(seed=seed, options={"distance": distance, "duration": duration})
        infos = [step.info for step in steps(env, controller, observation)]
    t = np.array([info["time"] for info in infos])
    motion = np.diff([info["slip"] for info in [first, *infos]], axis=0)
    speed = np.hypot(*motion[:, :2].T) / np.diff(t, prepend=0.0)
    mu_s, mu_c, r = (np.full(len(t), value) for value in first["true"])
    return Trace(
        t=t,
        wrench=np.array([info["contact_wrench"][0] for info in infos]),
        normal=np.array([info["grip_force"][0] for info in infos]),
        twist=np.array([info["slip_twist"] for info in infos]),
        motion=motion,
        mu_s=mu_s,
        mu_c=mu_c,
        r=r,
        phase=np.where(speed > 1e-3, "slip", "stick"),
    )
