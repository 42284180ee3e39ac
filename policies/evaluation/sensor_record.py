"""Records the sensors of one finger during an episode, each at its own rate."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

import policies
from policies.stepping import environment_for, steps
from slipgym.envs.bullet_simulation import BulletSimulation
from slipgym.envs.engines import resolved
from slipgym.envs.observation import ObservationBuffers
from slipgym.sensors.force_torque import HISTORY, sensed
from slipgym.sensors.slip_velocity import read_slip
from slipgym.tasks import find

FORCE = ("f_x", "f_y", "f_n", "tau_x", "tau_y", "tau")
TWIST = ("v_x", "v_y", "omega")
TRUTH = ("true_mu_s", "true_mu_c", "true_r")


def record_sensors(
    task: str,
    policy: str,
    finger: int = 1,
    seed: int = 0,
    options: Mapping[str, Any] | None = None,
    **keywords: Any,
) -> pd.DataFrame:
    """Runs an episode and keeps every sample of one finger's sensors.

    Args:
        task: "LinearSlip" or whatever else `slipgym.tasks.find` takes.
        policy: As `policies.load` takes it; a learned one brings its action mode, history and so on along.
        finger: 1 or 2.
        seed: Of the environment.
        options: Of `reset`.
        **keywords: Of the environment.

    Returns:
        A row for each time at which a sample is delivered: `t` [s], `FORCE` [N, N m] and `TWIST` [m/s, rad/s]
        at the pad centre in the pad frame, NaN where that sensor has none, and `TRUTH` [-, -, m].

    Raises:
        FileNotFoundError: There is no policy at the path.
        ValueError: The task, the policy, the finger, the engine or an option is unknown or not allowed, or a
            learned policy was trained for another environment.
    """
    env_id = find(task).id
    if finger not in (1, 2):
        raise ValueError(f"finger = {finger!r} must be 1 or 2")
    if resolved(keywords.get("engine", "auto")) == "planar":
        raise ValueError("engine = 'planar' takes only the samples that are read: record with 'bullet'")
    actor = policies.load(policy)
    policies.check_estimates(policy, actor, keywords)
    with environment_for(actor, env_id, **{**policies.modes(actor), **keywords}) as env:
        observation, _ = env.reset(seed=seed, options=dict(options or {}))
        tap = _Tap(env.unwrapped.simulation, finger - 1)  # type: ignore[attr-defined]
        deque(steps(env, actor, observation), maxlen=0)
        return tap.frame()


class _Tap:
    """Collects the samples of one finger, also those within a step of the environment.

    Args:
        simulation: The environment's simulation, just reset.
        finger: 0 or 1.
    """

    def __init__(self, simulation: BulletSimulation, finger: int) -> None:
        self.simulation, self._finger = simulation, finger
        if not simulation.config.sensors.usual:
            raise ValueError(
                "a record holds the force/torque and slip-velocity sensor of a finger, which these sensors "
                'are not; valid: "ideal", "lab", "realistic"'
            )
        self._start = int(simulation.plant.world["tick"][0])
        force, world = simulation.plant.force_torque[0, finger], simulation.plant.world[0]
        latest = simulation.plant.force_torque["delay"][0].max()  # the other finger's reading goes on, too
        needed = int((world["control_ticks"] + latest) // force["period"]) + 2
        if needed > HISTORY:
            rate = simulation.config.sensors.force_torque.rate
            raise ValueError(
                f"sensors.force_torque.rate = {rate} Hz: {needed} samples, a control step and the latency, "
                f"would have to be kept; at most {HISTORY} are"
            )
        simulation.keep_samples(needed)
        self._taken = self._start // int(force["period"])
        self._forces: list[tuple[float, ...]] = []
        self._twists: list[tuple[float, ...]] = []
        self._step, simulation.step = simulation.step, self._one_by_one

    def _one_by_one(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        buffers: ObservationBuffers,
    ) -> None:
        """The loop's `step`, one sample after the other."""
        total = np.zeros_like(self.simulation.infos.terms)
        for _ in range(skip):
            self._step(actions, components, 1, active, buffers)
            self._take()
            total += self.simulation.infos.terms
            if self.simulation.over:
                break
        self.simulation.infos.terms[:] = total

    def _take(self) -> None:
        """Keeps what was sampled since the last call."""
        plant, finger = self.simulation.plant, self._finger
        force = plant.force_torque[0, finger]
        tick_length = float(plant.world["tick_length"][0])
        taken, load = int(plant.world["tick"][0]) // int(force["period"]), np.empty(6)
        for number in range(self._taken + 1, taken + 1):
            ticks = number * int(force["period"]) + int(force["delay"]) - self._start
            sensed(force, number, load)
            self._forces.append((ticks * tick_length, *load[:5], force["mirror"] * load[5]))
        self._taken = taken
        twist, slip_sensors = np.empty(3), plant.slip_sensors.copy()  # reading moves the chips' travel
        read_slip(slip_sensors[0, finger], twist)
        self._twists.append((self.simulation.time, *twist))

    def frame(self) -> pd.DataFrame:
        """All samples in order of time; times to the microsecond, so that those of both sensors compare."""
        forces = pd.DataFrame(self._forces, columns=["t", *FORCE])
        twists = pd.DataFrame(self._twists, columns=["t", *TWIST])
        for stream in (forces, twists):
            stream["t"] = stream["t"].round(6)
        last = twists["t"].iloc[-1]
        frame = forces.loc[forces["t"] <= last].merge(twists, how="outer", on="t", sort=True)
        return frame.assign(**dict(zip(TRUTH, self.simulation.true_friction[0], strict=True)))
