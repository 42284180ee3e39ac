"""The command `slipgym live`, its clients, and its other doors."""

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from estimator.live import Live, Log, read, ros
from estimator.live.session import Session
from lab.live_streams import feed, readings
from policies.commands.live import app

ROOT = Path(__file__).parents[2]
CLIENTS = ROOT / "examples" / "live"


def slipgym(*words, **options):
    command = [sys.executable, "-m", "slipgym", "live", *map(str, words)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "200"}
    return subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options
    )


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as door:
        door.bind(("127.0.0.1", 0))
        return door.getsockname()[1]


def compiled_client(port, folder):
    source = (CLIENTS / "client.c").read_text()
    assert "htons(7741)" in source
    (folder / "client.c").write_text(source.replace("htons(7741)", f"htons({port})"))
    flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror"]
    subprocess.run(["cc", *flags, "-o", "client", "client.c"], cwd=folder, check=True)
    return [str(folder / "client"), "2"]


def python_client(port, folder):
    source = (CLIENTS / "client.py").read_text()
    assert "7741" in source
    (folder / "client.py").write_text(source.replace("7741", str(port)))
    return [sys.executable, "-u", str(folder / "client.py"), "2"]


@pytest.mark.parametrize("client", [python_client, compiled_client])
def test_a_client_is_answered_and_all_that_passed_is_recorded(client, tmp_path):
    if client is compiled_client and not shutil.which("cc"):
        pytest.skip("no C compiler")
    port, log = free_port(), tmp_path / "run.jsonl"
    command = client(port, tmp_path)
    server = slipgym("--policy", "hold", "--estimator", "rls", "--port", port, "--log", log, "--seconds", 20)
    assert f"127.0.0.1:{port}" in server.stderr.readline()
    answered = subprocess.run(command, capture_output=True, text=True, check=True)
    server.send_signal(2)  # Ctrl-C
    printed, errors = server.communicate()
    assert server.returncode == 0, errors
    grips = {float(each) for each in re.findall(r"grip ([\d.]+) N", answered.stdout)}
    assert len(grips) > 3
    *_, last, said = answered.stdout.splitlines()
    assert last == "grip 25.00 N"
    assert re.fullmatch(r"\d{3,4} forces, \d{3} velocities, \d+ commands obeyed, \d+ silences; .* hold", said)
    assert "force 2: received" in printed
    lines = list(read(log))
    assert sum("wrench" in line for line in lines) > 1000
    assert sum(line.get("status") == "ok" and "command" in line for line in lines) > 50


@pytest.mark.quick_cases(
    f"{int(signal.SIGTERM)}-python_client-opens0", f"{int(signal.SIGINT)}-compiled_client-opens1"
)
@pytest.mark.parametrize(
    ("client", "opens"), [(python_client, ["--end", "open"]), (compiled_client, ["open"])]
)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_client_runs_until_it_is_stopped_and_says_so(client, opens, number, tmp_path):
    if client is compiled_client and not shutil.which("cc"):
        pytest.skip("no C compiler")
    command = [*client(free_port(), tmp_path)[:-1], "30", *opens]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
        time.sleep(3.0)
        assert running.poll() is None
        running.send_signal(number)
        printed = running.communicate()[0]
    assert running.returncode == 0
    assert "no answer: is slipgym live running?" in printed
    assert printed.splitlines()[0] == "grip 25.00 N"
    assert printed.splitlines()[-2] == "grip 0.00 N"
    assert printed.rstrip().endswith("the gripper is told to open")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_server_reports_when_it_is_stopped(number, tmp_path):
    log = tmp_path / "log.jsonl"
    with slipgym("--port", free_port(), "--log", log) as server:
        server.stderr.readline()
        server.send_signal(number)
        printed = server.communicate()[0]
    assert server.returncode == 0
    assert "force 1: received nothing" in printed
    assert log.is_file()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--door", "ftp"], "udp"),
        (["--mcap", "x.mcap"], "--log"),
        (["--column", "time_left=1"], "--policy"),
        (["--policy", "nonsense"], "nonsense"),
        (["--estimator", "nonsense"], "nonsense"),
        (["--set", "r_max=-1"], "r_max"),
        (["--clocks", "ntp"], "arrival"),
        (["--log", "/no/such/folder/x.jsonl"], "x.jsonl"),
        (["--host", "8.8.8.8"], "assign"),
    ],
)
def test_a_wrong_option_is_one_clear_error(words, says):
    done = CliRunner().invoke(app, ["--port", "0", *words, "--seconds", "1"])
    assert done.exit_code == 2, done.output
    assert says in done.output


def test_a_log_becomes_mcap(tmp_path):
    reader = pytest.importorskip("mcap.reader")
    from estimator.live.log import to_mcap

    log = Log(tmp_path / "run.jsonl")
    live = Live("rls", fingers=1, log=log)
    feed(live, readings(1.0))
    live.feed_grip(1.0, 5.0, 1.0)
    log.close()
    lines = list(read(log.path))
    assert to_mcap(log.path, tmp_path / "run.mcap") == len(lines)
    with (tmp_path / "run.mcap").open("rb") as file:
        found = [
            (channel.topic, json.loads(message.data))
            for _, channel, message in reader.make_reader(file).iter_messages()
        ]
    assert len(found) == len(lines)
    wrench = next(content for topic, content in found if topic == "/finger_1/wrench")
    assert set(wrench) >= {"f_x", "f_y", "f_n", "tau", "tau_x", "tau_y", "t", "arrival", "verdict"}
    assert {topic for topic, _ in found} == {
        "/live", "/grip", "/finger_1/wrench", "/finger_1/twist", "/finger_1/estimate"
    }  # fmt: skip


def test_without_mcap_the_error_says_what_to_install(tmp_path, monkeypatch):
    from estimator.live.log import to_mcap

    monkeypatch.setitem(sys.modules, "mcap.writer", None)
    with pytest.raises(ModuleNotFoundError, match="slipgym"):
        to_mcap(tmp_path / "x", tmp_path / "y")


VECTORS = {"force": {"x": 1, "y": 2, "z": 3}, "torque": {"x": 4, "y": 5, "z": 6}}


@pytest.mark.parametrize("stamp", [{"sec": 7, "nanosec": 5 * 10**8}, {"secs": 7, "nsecs": 5 * 10**8}])
def test_messages_of_ros_1_and_2_are_readings(stamp):
    message = {"header": {"stamp": stamp}, "wrench": VECTORS}
    wanted = {"finger": 2, "t": 7.5, "wrench": [1, 2, 3, 6, 4, 5]}
    assert ros._reading(2, "wrench", message) == wanted


@pytest.mark.parametrize(
    "message",
    [
        {},
        {"header": 1},
        {"header": {"stamp": {"sec": 0, "nanosec": 0}}, "wrench": VECTORS},
        {"header": {"stamp": {}}},
    ],
)
def test_other_messages_of_ros_are_refused_and_counted(message):
    session = Session(Live("rls"))
    (answer,) = session.give(ros._reading(1, "wrench", message), 0.0)
    assert set(answer) == {"error"}


@pytest.mark.parametrize(("module", "serve"), [("rclpy", "ros2"), ("roslibpy", "rosbridge")])
def test_without_ros_the_error_says_what_to_install(module, serve, monkeypatch):
    monkeypatch.setitem(sys.modules, module, None)
    arguments = {"ros2": (ros.serve_ros2, ()), "rosbridge": (ros.serve_rosbridge, ("127.0.0.1",))}
    call, more = arguments[serve]
    with pytest.raises(ModuleNotFoundError, match=rf"slipgym\[{serve}\]"):
        call(Session(Live("rls")), 1, *more)


def test_ros_2_readings_are_answered():
    rclpy = pytest.importorskip("rclpy")
    geometry, text = pytest.importorskip("geometry_msgs.msg"), pytest.importorskip("std_msgs.msg")
    session, stop = Session(Live("rls", fingers=1)), threading.Event()
    server = threading.Thread(target=ros.serve_ros2, args=(session, 1, lambda: not stop.is_set()))
    server.start()
    context = rclpy.context.Context()
    rclpy.init(context=context)
    try:
        node = rclpy.create_node("gripper", context=context)
        executor = rclpy.executors.SingleThreadedExecutor(context=context)
        executor.add_node(node)
        heard = []
        node.create_subscription(text.String, ros.ESTIMATES, lambda m: heard.append(json.loads(m.data)), 10)
        outs = {
            "wrench": node.create_publisher(geometry.WrenchStamped, "/finger_1/wrench", 1000),
            "twist": node.create_publisher(geometry.TwistStamped, "/finger_1/slip", 1000),
        }
        while not all(out.get_subscription_count() for out in outs.values()):
            time.sleep(0.01)
        for kind, t, values in readings(1.0):
            message = geometry.WrenchStamped() if kind == "wrench" else geometry.TwistStamped()
            message.header.stamp.sec, message.header.stamp.nanosec = 100, round(t * 1e9)
            if kind == "wrench":
                body = message.wrench
                body.force.x, body.force.y, body.force.z, body.torque.z, body.torque.x, body.torque.y = values
            else:
                message.twist.linear.x, message.twist.linear.y, message.twist.angular.z = values
            outs[kind].publish(message)
            executor.spin_once(timeout_sec=0.001)
        end = time.monotonic() + 60.0
        while len(heard) < 50 and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.1)
    finally:
        stop.set()
        server.join()
        rclpy.try_shutdown(context=context)
    assert len(heard) >= 50
    assert {answer["estimate"] for answer in heard} == {1}
    assert session.live.counts["force 1"]["received"] > 900


BRIDGE = """
import json, sys
from autobahn.twisted.websocket import WebSocketServerFactory, WebSocketServerProtocol
from twisted.internet import reactor
from lab.live_streams import readings

class Bridge(WebSocketServerProtocol):
    asked = set()

    def onMessage(self, payload, binary):
        message = json.loads(payload)
        if message["op"] == "subscribe":
            self.asked.add(message["topic"])
            if len(self.asked) == 2:
                self.play()
        if message["op"] == "publish":
            print(json.dumps(message), flush=True)

    def play(self):
        for kind, t, values in readings(1.0):
            stamp = {"secs": 100, "nsecs": round(t * 1e9)}
            pad = dict(zip(("x", "y", "z"), values[:3] if kind == "wrench" else [*values[:2], 0.0]))
            turn = [*values[4:], values[3]] if kind == "wrench" else [0.0, 0.0, values[2]]
            turn = dict(zip(("x", "y", "z"), turn))
            body = {"force": pad, "torque": turn} if kind == "wrench" else {"linear": pad, "angular": turn}
            topic = "/finger_1/" + {"wrench": "wrench", "twist": "slip"}[kind]
            message = {"op": "publish", "topic": topic, "msg": {"header": {"stamp": stamp}, kind: body}}
            self.sendMessage(json.dumps(message).encode())

factory = WebSocketServerFactory()
factory.protocol = Bridge
port = reactor.listenTCP(0, factory, interface="127.0.0.1")
print(port.getHost().port, flush=True)
reactor.run()
"""


def test_rosbridge_readings_are_answered():
    pytest.importorskip("roslibpy")
    bridge = subprocess.Popen([sys.executable, "-c", BRIDGE], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    assert bridge.stdout is not None
    port = int(bridge.stdout.readline())
    live = slipgym(
        "--door", "rosbridge", "--port", port, "--fingers", 1, "--estimator", "rls", "--seconds", 5
    )
    messages = [json.loads(bridge.stdout.readline()) for _ in range(100)]
    printed, errors = live.communicate()
    bridge.kill()
    bridge.communicate()
    assert live.returncode == 0, errors
    assert {message["topic"] for message in messages} == {ros.ESTIMATES}
    assert json.loads(messages[-1]["msg"]["data"])["estimate"] == 1
    assert re.search(r"force 1: received (\d+), accepted \1, waiting", printed)
