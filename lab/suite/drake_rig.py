"""Drake as a rig: compliant hydroelastic discs on a rigid box."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from lab.suite.rig import FINGER_MASS, MU, PATCH_RADIUS, SIZE, Grasp, Variant, library

STEP = 0.001
"""Drake's default discrete step [s]."""
WRIST_MASS = 1e6
"""So heavy that the grasp does not move the wrist [kg]."""
MODULUS = 1e7
"""Hydroelastic modulus of the pads [Pa]."""
DISSIPATION = 10.0
"""Of Hunt and Crossley [s/m]."""
RESOLUTION = 0.005
"""Edge length of the pads' mesh [m]."""
_DEPTH = 0.005  # [m], half the thickness of a pad
_TINY = 1e-6  # [kg]


@dataclass(frozen=True)
class Settings:
    """Of `MultibodyPlantConfig`."""

    approximation: str = "lagged"
    """`discrete_contact_approximation`; "lagged" is the default."""
    stiction: float = 1e-4
    """`stiction_tolerance` [m/s]; 1e-4 is the default. "sap" does not use it."""


class DrakeRig:
    """A grasp in Drake; the object moves along x, y, z and turns about the grip axis.

    Args:
        grasp: Object and grip.
        settings: Contact approximation and stiction tolerance.

    Raises:
        RuntimeError: Drake is not installed.
    """

    def __init__(self, grasp: Grasp, settings: Settings) -> None:
        load = partial(library, package="drake", purpose="the engine drake")
        self._tree, self._plants = load("pydrake.multibody.tree"), load("pydrake.multibody.plant")
        self._geometry, self._math = load("pydrake.geometry"), load("pydrake.math")
        config = self._plants.MultibodyPlantConfig(
            time_step=STEP,
            contact_model="hydroelastic",
            discrete_contact_approximation=settings.approximation,
            stiction_tolerance=settings.stiction,
        )
        builder = load("pydrake.systems.framework").DiagramBuilder()
        self._plant, _ = self._plants.AddMultibodyPlant(config, builder)
        self._plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
        wrist, fingers, self._joint = self._build(grasp)
        self._plant.Finalize()
        self._wrist, self._fingers = ([joint.velocity_start() for joint in some] for some in (wrist, fingers))
        start = self._joint.velocity_start()
        self._object = [start, start + 1, start + 2]
        self._simulator = load("pydrake.systems.analysis").Simulator(builder.Build())
        self._context = self._plant.GetMyMutableContextFromRoot(self._simulator.get_mutable_context())
        self._forces = np.zeros(self._plant.num_velocities())
        self._forces[self._fingers] = grasp.force
        self._port = self._plant.get_applied_generalized_force_input_port()
        self._heavy = WRIST_MASS * np.array([2.0, 1.0]) + 2.0 * FINGER_MASS
        self.step_time, self._steps = STEP, 0
        self._read()

    def _body(self, name: str, mass: float, inertia: float) -> Any:
        tree = self._tree
        unit = tree.UnitInertia(*[inertia / mass] * 3)
        return self._plant.AddRigidBody(name, tree.SpatialInertia(mass, np.zeros(3), unit))

    def _slide(self, name: str, parent: Any, child: Any, axis: list[float]) -> Any:
        joint = self._tree.PrismaticJoint(name, parent.body_frame(), child.body_frame(), axis)
        return self._plant.AddJoint(joint)

    def _build(self, grasp: Grasp) -> tuple[list[Any], list[Any], Any]:
        """Add bodies and joints; returns the joints of the wrist and of the fingers, and the object's."""
        plant, geometry, rigid = self._plant, self._geometry, self._math.RigidTransform
        world = plant.world_body()
        carriage, wrist = self._body("carriage", WRIST_MASS, 1.0), self._body("wrist", WRIST_MASS, 1.0)
        wrists = [self._slide("x", world, carriage, [1, 0, 0]), self._slide("z", carriage, wrist, [0, 0, 1])]
        turned = self._math.RotationMatrix.MakeXRotation(0.5 * math.pi)  # (x, z, -y) are its axes
        pad, fingers = geometry.Cylinder(PATCH_RADIUS, 2.0 * _DEPTH), []
        for name, side in ("first", 1.0), ("second", -1.0):
            finger = self._body(name, FINGER_MASS, 1e-4)
            fingers.append(self._slide(name, wrist, finger, [0, -side, 0]))
            at = rigid(turned, [0, side * (0.5 * SIZE[1] + _DEPTH), 0])
            plant.RegisterCollisionGeometry(finger, at, pad, name, self._contact(compliant=True))
        slider, box = self._body("slider", _TINY, _TINY), self._body("box", grasp.mass, grasp.inertia)
        self._slide("y", world, slider, [0, 1, 0])
        across = rigid(turned, np.zeros(3))
        joint = self._tree.PlanarJoint(
            "plane", self._frame("across", slider, across), self._frame("face", box, across), np.zeros(3)
        )
        plant.RegisterCollisionGeometry(
            box, rigid(), geometry.Box(*SIZE), "box", self._contact(compliant=False)
        )
        return wrists, fingers, plant.AddJoint(joint)

    def _frame(self, name: str, body: Any, pose: Any) -> Any:
        return self._plant.AddFrame(self._tree.FixedOffsetFrame(name, body, pose))

    def _contact(self, compliant: bool) -> Any:
        geometry = self._geometry
        properties = geometry.ProximityProperties()
        friction = self._plants.CoulombFriction(MU, MU)
        geometry.AddContactMaterial(properties, dissipation=DISSIPATION, friction=friction)
        if compliant:
            geometry.AddCompliantHydroelasticProperties(RESOLUTION, MODULUS, properties)
        else:
            geometry.AddRigidHydroelasticProperties(1.0, properties)
        return properties

    def _read(self) -> None:
        self._positions = self._plant.GetPositions(self._context)
        self._velocities = self._plant.GetVelocities(self._context)

    def step(self, load: np.ndarray, wrist: np.ndarray) -> None:
        """Advance by one discrete step."""
        forces = self._forces
        forces[self._wrist] = self._heavy * (wrist - self._velocities[self._wrist]) / STEP
        forces[self._object] = load
        self._port.FixValue(self._context, forces)
        self._steps += 1
        self._simulator.AdvanceTo(self._steps * STEP)
        self._read()

    def throw(self, velocity: np.ndarray) -> None:
        """Set the velocities of the object's joint."""
        self._velocities[self._object] = velocity
        self._plant.SetVelocities(self._context, self._velocities)
        self._read()

    @property
    def position(self) -> np.ndarray:
        """Centre of mass and angle, (3,) [m, m, rad]."""
        return self._positions[self._object]

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of them, (3,) [m/s, m/s, rad/s]."""
        return self._velocities[self._object]

    @property
    def wrist(self) -> np.ndarray:
        """Pad centre (x, z), (2,) [m]."""
        return self._positions[self._wrist]

    def close(self) -> None:
        """There is nothing to release."""


def variants() -> list[Variant]:
    """The preferred approximation, with the default stiction tolerance and with a small one."""
    rows = {
        "lagged": Settings(),
        "lagged, stiction 1e-6 m/s": Settings(stiction=1e-6),
    }
    return [
        Variant("drake", name, partial(DrakeRig, settings=settings), drawn=name == "lagged")
        for name, settings in rows.items()
    ]
