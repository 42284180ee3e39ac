"""Opens the ROS doors: ROS 2 by rclpy, ROS 1 and 2 by a rosbridge.

Topics: `/finger_1/wrench` (geometry_msgs/WrenchStamped), `/finger_1/slip` (geometry_msgs/TwistStamped), the
same of finger 2; estimates are published on `/slipgym/estimates` (std_msgs/String, JSON) and commands on
`/slipgym/grip_force` (std_msgs/Float64). The z axis of the messages is the contact normal.
"""

from __future__ import annotations

import importlib
import json
import queue
from collections.abc import Callable, Mapping
from typing import Any

from estimator.live.session import Session
from estimator.live.udp import TICK

ESTIMATES, COMMANDS = "/slipgym/estimates", "/slipgym/grip_force"
KINDS = {"wrench": ("wrench", "WrenchStamped"), "slip": ("twist", "TwistStamped")}
DEPTH = 1000
"""Messages of a topic that wait at most."""


def serve_ros2(session: Session, fingers: int, going: Callable[[], bool] = lambda: True) -> None:
    """Answers on ROS 2 until `going`, asked after each message or tick, says no.

    Raises:
        ModuleNotFoundError: rclpy or the messages are not installed.
    """
    rclpy, qos = _extra("rclpy", "ros2"), _extra("rclpy.qos", "ros2")
    messages = _extra("geometry_msgs.msg", "ros2"), _extra("std_msgs.msg", "ros2")
    context = rclpy.context.Context()
    rclpy.init(context=context, signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
    try:
        node = rclpy.create_node("slipgym", context=context)
        executor = rclpy.executors.SingleThreadedExecutor(context=context)
        executor.add_node(node)
        estimates = node.create_publisher(messages[1].String, ESTIMATES, 10)
        commands = node.create_publisher(messages[1].Float64, COMMANDS, 10)

        def publish(answers: list[dict[str, Any]]) -> None:
            for answer in answers:
                if "command" in answer:
                    commands.publish(messages[1].Float64(data=answer["grip_force"]))
                estimates.publish(messages[1].String(data=json.dumps(answer)))

        def hear(finger: int, topic: str) -> None:
            kind, name = KINDS[topic]
            profile = qos.QoSProfile(depth=DEPTH, reliability=qos.ReliabilityPolicy.BEST_EFFORT)
            node.create_subscription(
                getattr(messages[0], name),
                f"/finger_{finger}/{topic}",
                lambda message: publish(session.give(_reading(finger, kind, _as_mapping(message, kind)))),
                profile,
            )

        for finger in range(1, fingers + 1):
            for topic in KINDS:
                hear(finger, topic)
        node.create_timer(TICK, lambda: publish(session.tick()))
        while going():
            executor.spin_once(timeout_sec=TICK)
    finally:
        rclpy.try_shutdown(context=context)


def serve_rosbridge(
    session: Session, fingers: int, host: str, port: int = 9090, going: Callable[[], bool] = lambda: True
) -> None:
    """Answers on a rosbridge, of ROS 1 or 2, until `going`, asked after each message or tick, says no.

    Raises:
        ModuleNotFoundError: roslibpy is not installed.
        OSError: There is no rosbridge.
    """
    roslibpy = _extra("roslibpy", "rosbridge")
    bridge, heard = roslibpy.Ros(host, port), queue.Queue()
    try:
        bridge.run(timeout=5)
        estimates = roslibpy.Topic(bridge, ESTIMATES, "std_msgs/String")
        commands = roslibpy.Topic(bridge, COMMANDS, "std_msgs/Float64")
        for finger in range(1, fingers + 1):
            for topic, (kind, name) in KINDS.items():
                where = f"/finger_{finger}/{topic}"
                roslibpy.Topic(bridge, where, f"geometry_msgs/{name}", queue_length=DEPTH).subscribe(
                    lambda message, finger=finger, kind=kind: heard.put(_reading(finger, kind, message))
                )
        while going():
            try:
                answers = session.give(heard.get(timeout=TICK))
            except queue.Empty:
                answers = []
            for answer in answers + session.tick():
                if "command" in answer:
                    commands.publish({"data": answer["grip_force"]})
                estimates.publish({"data": json.dumps(answer)})
    except roslibpy.core.RosTimeoutError as error:
        raise OSError(f"no rosbridge at {host}:{port}: {error}") from error
    finally:
        bridge.close()


def _as_mapping(message: Any, kind: str) -> dict[str, Any]:
    """The parts of a message of rclpy as a rosbridge has them."""
    body = getattr(message, kind)
    parts = {
        part: {axis: getattr(getattr(body, part), axis) for axis in "xyz"}
        for part in (("force", "torque") if kind == "wrench" else ("linear", "angular"))
    }
    stamp = message.header.stamp
    return {"header": {"stamp": {"sec": stamp.sec, "nanosec": stamp.nanosec}}, kind: parts}


def _reading(finger: int, kind: str, message: Mapping[str, Any]) -> dict[str, Any] | str:
    """A message of `Session`, or what is wrong; a stamp of 0 is one that the driver did not set."""
    try:
        stamp = message["header"]["stamp"]
        seconds = stamp["sec"] if "sec" in stamp else stamp["secs"]
        t = seconds + 1e-9 * (stamp["nanosec"] if "nanosec" in stamp else stamp["nsecs"])
        body = message[kind]
        if kind == "wrench":
            force, torque = body["force"], body["torque"]
            values = [force["x"], force["y"], force["z"], torque["z"], torque["x"], torque["y"]]
        else:
            values = [body["linear"]["x"], body["linear"]["y"], body["angular"]["z"]]
    except (KeyError, TypeError):
        return f"no {KINDS['wrench' if kind == 'wrench' else 'slip'][1]}"
    return {"finger": finger, "t": t, kind: values} if t else "the header has no stamp"


def _extra(module: str, extra: str) -> Any:
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        message = f"{error.name} is not installed: pip install 'slipgym[{extra}]', or source your ROS"
        raise ModuleNotFoundError(message, name=error.name) from error
