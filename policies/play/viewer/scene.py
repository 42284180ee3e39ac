"""Draws object, gripper, forces and target poses in the browser's 3-D view.

World frame: x to the right, z up, finger 2 towards the camera. Shapes and colours are those of
`slipgym.rendering`; every body is sent once per episode, afterwards only its pose.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from slipgym.rendering import palette, stage
from slipgym.rendering.camera import framing
from slipgym.rendering.look import AT_THE_GRASP, Pose, View, feel, look

PUSH: palette.Colour = (0xAA, 0x33, 0x77)
"""Colour of external forces."""
GRIP_LENGTH, FORCE_LENGTH = 0.004, 0.025
"""Length of an arrow for 1 N of grip force, and of other forces [m]."""
_LONGEST, _SHORTEST = 0.12, 0.002  # [m] of an arrow
_FLOOR = -0.22  # [m]
_FIELD = math.radians(34.0)  # that the camera sees, from top to bottom
_AWAY = np.array([0.5, -0.81, 0.3]) * 1.3 / math.tan(_FIELD / 2)  # to the camera, for a span of 1 m


class Scene:
    """The 3-D view: `scene` and `initial_camera` of a `viser.ViserServer`."""

    def __init__(self, scene: Any, camera: Any) -> None:
        self._scene = scene
        self._world = scene.add_frame("/world", show_axes=False)
        scene.set_up_direction("+z")
        scene.configure_default_lights(False)
        scene.configure_environment_map("studio", environment_intensity=0.3)
        scene.add_light_directional("/lamp", intensity=0.7, position=(-0.5, -2.0, 1.0))
        grid = {"cell_color": (214, 219, 226), "section_color": (180, 188, 198), "cell_size": 0.05}
        place = {"plane": "xy", "section_size": 0.25, "position": (0.0, 0.0, _FLOOR)}
        scene.add_grid("/world/floor", 2.4, 2.4, **place, **grid)
        self._camera = camera
        camera.fov, camera.near = _FIELD, 0.01
        self._arrows: dict[str, Any] = {}
        self._add_arrow("/gravity", palette.MUTED)
        self._add_arrow("/world/push", PUSH)
        self._name = scene.add_label("/gravity_name", "g")
        self._bodies: list[Any] = []

    def begin(self, simulation: Any) -> None:
        """Send the bodies of an episode that was just reset."""
        for body in self._bodies:
            body.remove()
        view = look(simulation, 0)
        x, z = view.box.com_offset
        palm, finger = stage.gripper_triangles(view.pad_radius, view.side)
        offset = np.array([0.0, view.box.size[1] / 2 + stage.PAD_THICKNESS / 2, 0.0])
        self._gripper = self._scene.add_frame("/world/gripper", show_axes=False)
        self._object = self._scene.add_frame("/world/object", show_axes=False)
        self._bodies = [self._gripper, self._object]
        triangles, colours = stage.object_triangles(view.box, view.material, view.body)
        self._add("/world/object/body", triangles - (x, 0.0, z), colours)
        self._add("/world/gripper/palm", palm[0], palm[1])
        self._add("/world/gripper/finger_1", finger[0] + offset, finger[1])
        near = stage.mirrored(finger[0], 1) - offset
        self._add("/world/gripper/finger_2", near, finger[1], stage.SEE_THROUGH)
        self._outline("/world/gripper/grasp", view, AT_THE_GRASP, palette.SLIP)
        target = simulation.task.motion.pose(simulation.episode[0])
        if target is not None:
            self._outline("/world/gripper/target", view, target, palette.TARGET)
        self._add_arrow("/world/gripper/friction", palette.FRICTION)
        self._add_arrow("/world/gripper/grip_1", palette.INK)
        self._add_arrow("/world/gripper/grip_2", palette.INK)
        x, z, pitch = simulation.episode["wrist_start"][0].tolist()
        self._framed = framing(stage.footprint(view, (x, z, pitch), target, ()))
        middle = np.array([self._framed.target[0], 0.0, self._framed.target[1]])
        self._camera.look_at = tuple(middle.tolist())
        self._camera.position = tuple((middle + _AWAY * self._framed.span).tolist())
        self._start = np.array([x, z])
        corner = middle + self._framed.span * np.array([-0.8 * view.side, 0.0, 0.75])
        self._point("/gravity", corner, (0.0, 0.0, -0.3 * self._framed.span), 1.0)
        self._name.position = np.add(corner, (0.008, 0.0, -0.014))
        self.update(simulation)

    def update(self, simulation: Any) -> None:
        """Move the bodies and arrows to where they are now, and the world so that one sees them."""
        view, world = look(simulation, 0), simulation.plant.world[0]
        seen = self._framed.follow(np.array(view.wrist[:2]) - self._start)
        x, z = np.subtract(self._framed.target, seen.target).tolist()
        self._world.position = (x, 0.0, z)
        self._object.position, self._object.wxyz = view.position, turned(float(world["angle"]))
        self._gripper.position = (view.wrist[0], 0.0, view.wrist[1])
        self._gripper.wxyz = turned(view.wrist[2])
        half = view.box.size[1] / 2
        (f_x, f_z), _, grip = feel(simulation, 0)
        self._point("/world/gripper/friction", (0.0, -half - 0.002, 0.0), (f_x, 0.0, f_z), FORCE_LENGTH)
        for name, side, force in zip(("grip_1", "grip_2"), (1.0, -1.0), grip, strict=True):
            back = side * (half + stage.PAD_THICKNESS + 0.012 + min(GRIP_LENGTH * force, _LONGEST))
            self._point(f"/world/gripper/{name}", (0.0, back, 0.0), (0.0, -side * force, 0.0), GRIP_LENGTH)
        push_x, push_z, turn = world["external"].tolist()
        start = view.position - (0.0, half + 0.004, 0.0)
        if turn:  # a couple, as the force at its lever
            start, push_z = np.add(start, (0.03, 0.0, 0.0)), push_z + turn / 0.03
        self._point("/world/push", start, (push_x, 0.0, push_z), FORCE_LENGTH)

    def _add_arrow(self, name: str, colour: palette.Colour) -> None:
        shape = {"shaft_radius": 0.0016, "head_radius": 0.0042, "head_length": 0.010}
        linear = tuple(round(255 * (part / 255) ** 2.2) for part in colour)  # viser takes it so for arrows
        ends = np.array([[(0, 0, 0), (0, 0, 0.01)]])
        self._arrows[name] = self._scene.add_arrows(name, ends, linear, visible=False, **shape)

    def _point(self, name: str, start: Any, force: Any, scale: float) -> None:
        """Show a force as an arrow of limited length, unless it is tiny."""
        arrow, length = self._arrows[name], scale * float(np.linalg.norm(force))
        shown = length > _SHORTEST
        if shown:
            way = np.multiply(force, scale * min(1.0, _LONGEST / length))
            arrow.points = np.array([[start, np.add(start, way)]], dtype=np.float32)
        if arrow.visible != shown:
            arrow.visible = shown

    def _add(
        self, name: str, triangles: np.ndarray, colours: np.ndarray, opacity: float | None = None
    ) -> None:
        """Add triangles (n, 3, 3) with colours (n, 4) as one mesh for each colour."""
        kinds, which = np.unique(colours[:, :3], axis=0, return_inverse=True)
        for k, colour in enumerate(kinds):
            corners = triangles[which.reshape(-1) == k].reshape(-1, 3).astype(np.float32)
            faces = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
            paint = {"color": tuple(round(255 * part) for part in colour), "opacity": opacity}
            self._scene.add_mesh_simple(f"{name}/{k}", corners, faces, **paint, flat_shading=True)

    def _outline(self, name: str, view: View, pose: Pose, colour: Any) -> None:
        """Dashed outline of the object's front at a pose in the grip."""
        ends = dashes(view.front(pose) - (0.0, 0.001, 0.0))
        self._scene.add_line_segments(name, ends.astype(np.float32), colour, thickness=0.0011)


def turned(pitch: float) -> tuple[float, float, float, float]:
    """Quaternion (w, x, y, z) of a rotation from x towards z [rad]."""
    return math.cos(0.5 * pitch), 0.0, -math.sin(0.5 * pitch), 0.0


def dashes(corners: np.ndarray, length: float = 0.006) -> np.ndarray:
    """Dashes of a length along a closed line (n, 3), their ends (m, 2, 3) [m]."""
    pieces = []
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        count = max(1, round(float(np.linalg.norm(end - start)) / (2.0 * length)))
        at = (np.arange(count)[:, None] + (0.0, 0.5)) / count
        pieces.append(start + at[..., None] * (end - start))
    return np.concatenate(pieces)
