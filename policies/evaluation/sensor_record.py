"""Records the sensors of one finger during an episode, each at its own rate, and writes them as files."""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import policies
from estimator.records.extras import extra
from estimator.records.units import UNITS
from policies.stepping import environment_for, steps
from slipgym.atomic_io import check_file, new_file
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


WRITTEN = (".csv", ".csv.gz", ".parquet", ".h5", ".hdf5", ".mcap")
"""Types of files that can be written; `estimator.records.load` reads them all, and more."""
_BOTH = {".h5": "h5py", ".hdf5": "h5py", ".mcap": "mcap.writer"}
"""Types that hold both streams as tables of their own -> what writes them."""


def save_record(frame: pd.DataFrame, path: Path, velocity: Path | None = None) -> None:
    """Writes a record; a csv keeps seven digits, finer than any of the sensors; other types keep all.

    Args:
        frame: From `record_sensors`.
        path: Its type is in its name: one of `WRITTEN`.
        velocity: A file of its own for the velocities; None keeps all in one.

    Raises:
        ValueError: The type is unknown.
        OSError: A file cannot be written.
    """
    check_targets(path, velocity)
    forces = frame.drop(columns=list(TWIST)).loc[frame["f_n"].notna()]
    twists = frame.loc[frame["omega"].notna(), ["t", *TWIST]]
    if velocity is not None:
        _write(forces, path)
        _write(twists, velocity)
    elif path.suffix in _BOTH:
        with new_file(path) as partial:
            (_write_mcap if path.suffix == ".mcap" else _write_hdf5)(
                {"wrench": forces, "slip": twists}, partial
            )
    else:
        _write(frame, path)


def check_targets(path: Path, velocity: Path | None = None) -> None:
    """Finds out before an episode is played whether `save_record` can write these files.

    Raises:
        ValueError: The type of one is unknown, or a file of its own for the velocities makes no sense.
        ModuleNotFoundError: The library of a type is not installed.
        OSError: One cannot be written.
    """
    if velocity is not None and velocity.resolve() == path.resolve():
        raise ValueError(f"{path}: forces and velocities need a file each")
    for target in (path, *([] if velocity is None else [velocity])):
        if not target.name.endswith(WRITTEN):
            raise ValueError(f"{target.name}: unknown file type; records are {', '.join(WRITTEN)}")
        if target.suffix in _BOTH:
            if velocity is not None:
                raise ValueError(f"{target.name}: holds both streams already; leave --velocity out")
            extra(_BOTH[target.suffix])
        check_file(target)


def _write(frame: pd.DataFrame, path: Path) -> None:
    with new_file(path) as partial:
        if path.suffix == ".parquet":
            frame.to_parquet(partial, index=False)
        else:
            packing: Any = {"method": "gzip", "mtime": 0} if path.suffix == ".gz" else None
            frame.to_csv(partial, index=False, float_format="%.7g", compression=packing)


def _write_hdf5(streams: dict[str, pd.DataFrame], path: Path) -> None:
    """A group for each stream, with a dataset for each column, and its unit."""
    with extra("h5py").File(path, "w") as file:
        for name, frame in streams.items():
            for column in frame:
                data = file.create_dataset(f"{name}/{column}", data=frame[column].to_numpy())
                data.attrs["unit"] = next(iter(UNITS[column]))


def _write_mcap(streams: dict[str, pd.DataFrame], path: Path) -> None:
    """A topic for each stream, with a message of JSON for each row; the time is that of the message."""
    with path.open("wb") as file:
        out = extra("mcap.writer").Writer(file)
        out.start(profile="", library="slipgym")
        for name, frame in streams.items():
            columns = [column for column in frame if column != "t"]
            fields = {
                column: {"type": "number", "description": next(iter(UNITS[column]))} for column in columns
            }
            schema = json.dumps({"type": "object", "properties": fields}).encode()
            number = out.register_schema(f"slipgym.{name}", "jsonschema", schema)
            channel = out.register_channel(f"/finger/{name}", "json", number)
            for t, *row in zip(frame["t"], *(frame[column] for column in columns), strict=True):
                told = {column: value for column, value in zip(columns, row, strict=True) if value == value}
                out.add_message(channel, round(t * 1e9), json.dumps(told).encode(), round(t * 1e9))
        out.finish()
