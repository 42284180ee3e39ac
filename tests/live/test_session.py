"""Messages: what is understood, what is refused, and what nobody can break."""

import json
import os
import socket
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from estimator.live import Live, Log, read
from estimator.live.session import LONGEST, Session
from estimator.live.udp import LINES, opened, serve
from lab.live_streams import readings

ROOT = Path(__file__).parents[2]
WRENCH = {"finger": 1, "t": 0.0, "wrench": [0.0, 0.0, 5.0, 0.0]}
GARBAGE = [
    b"x",
    b"\xff\xfe\x00",
    b"[" * 50000,
    b"{}",
    b"[]",
    b"null",
    b"1e999",
    b"9" * 5000,
    b'{"finger": 1, "t": 0}',
    b'{"finger": 1, "wrench": [0, 0, 5, 0]}',
    b'{"finger": 1, "t": 0, "wrench": [0, 0, 5, 0], "twist": [0, 0, 0]}',
    b'{"finger": 1, "t": 0, "wrench": {"f_x": 1}}',
    b'{"finger": {}, "t": 0, "wrench": [0, 0, 5, 0]}',
    b'{"finger": "1", "t": 0, "wrench": [0, 0, 5, 0]}',
    b'{"finger": 1, "t": [], "wrench": [0, 0, 5, 0]}',
    b'{"finger": 1, "t": 0, "wrench": "0050"}',
    b'{"finger": 1, "t": 0, "wrench": [0, 0, 5, 0], "__class__": 1}',
    b'{"t": 0, "grip": "hard"}',
    b'{"t": null, "grip": [1]}',
    b'{"columns": {"time_left": 1}}',
]


def text(kind, t, values, finger=1):
    return json.dumps({"finger": finger, "t": t, kind: values})


@pytest.mark.parametrize("garbage", GARBAGE, ids=range(len(GARBAGE)))
def test_garbage_is_refused_answered_and_counted(garbage):
    session = Session(Live("rls"))
    (answer,) = session.take(garbage, 0.0)
    assert set(answer) == {"error"}
    assert len(answer["error"]) <= 200
    assert sum(session.malformed.values()) == 1


@pytest.mark.parametrize(
    ("message", "says"),
    [
        ({"finger": 1, "t": "0", "twist": [0, 0, 0]}, "t = '0': expected a number [s]"),
        ({"t": [1], "grip": 8.0}, "t = [1]: expected a number [s]"),
        ({"t": 0.0, "grip": "hard"}, "grip = 'hard': expected a number [N]"),
        ({"t": 0.0, "grip": True}, "grip = True: expected a number [N]"),
        ({"finger": 1, "t": 0.0, "twist": [0, "a"]}, "twist = [0, 'a']: expected 3 numbers, v_x, v_y, omega"),
        (
            {"finger": 1, "t": 0.0, "wrench": 5},
            "wrench = 5: expected 4 numbers, f_x, f_y, f_n, tau, or 6, with tau_x, tau_y",
        ),
        ({"finger": "1", "t": 0.0, "twist": [0, 0, 0]}, "finger = '1': expected one of 1, 2"),
        ({"finger": 1, "t": 0.0}, "keys ['finger', 't']: expected those of one form: finger, t, wrench; "),
    ],
)
def test_an_error_names_the_key_of_the_message_and_its_value(message, says):
    (answer,) = Session(Live("rls")).give(message, 0.0)
    assert answer["error"].startswith(says)


@pytest.mark.parametrize("key", ["finger", "t", "twist"])
def test_an_error_of_any_depth_is_an_answer(key):
    """At any depth that the parser takes, up to where it gives up."""
    session = Session(Live("rls"))
    for depth in range(1, 1100):
        message = {"finger": "1", "t": "0", "twist": "[0, 0, 0]"} | {key: "[" * depth + "]" * depth}
        message = ", ".join(f'"{name}": {value}' for name, value in message.items())
        assert all("error" in answer for answer in session.take(f"{{{message}}}", 0.0))
    assert sum(session.malformed.values()) == depth


@given(st.binary(max_size=200) | st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=6)
    | st.dictionaries(st.sampled_from(["finger", "t", "wrench", "twist", "grip", "columns", "x"]), inner),
))  # fmt: skip
def test_no_message_breaks_a_session(message):
    session = Session(Live("rls"))
    found = session.take(message, 0.0) if isinstance(message, bytes) else session.give(message, 0.0)
    received = sum(n["received"] for n in session.live.counts.values())
    grip = isinstance(message, dict) and set(message) == {"t", "grip"}
    assert sum(session.malformed.values()) + received + (grip and not found) == 1


def test_errors_are_counted_but_not_all_answered_or_recorded(tmp_path):
    log = Log(tmp_path / "log.jsonl")
    session = Session(Live("rls", log=log), log=log)
    answers = [session.take(b"x", 0.0) for _ in range(1000)]
    many = [session.take(json.dumps({"finger": k, "t": 0, "twist": [0, 0, 0]}), 0.0) for k in range(3, 1000)]
    log.close()
    assert sum(map(len, answers)) == 10
    assert sum(map(len, many)) == 0
    assert sum(session.malformed.values()) == 1997
    assert len(session.malformed) <= 101
    assert len(list(read(log.path))) == 11
    assert "1000 messages refused: not JSON" in session.report()


def test_a_message_that_is_too_long_is_not_parsed():
    session = Session(Live("rls"))
    (answer,) = session.take(b" " * LONGEST + json.dumps(WRENCH).encode(), 0.0)
    assert "longer" in answer["error"]


def test_nan_and_null_are_readings_that_failed():
    session = Session(Live("rls"))
    for values in ("[NaN, 0, 5, 0]", "[null, 0, 5, 0]", "[1e999, 0, 5, 0]"):
        assert session.take(f'{{"finger": 1, "t": 0.0, "wrench": {values}}}', 0.0) == []
    assert session.live.counts["force 1"]["not_finite"] == 3


class Door:
    """A UDP door that serves in a thread, and a client's socket."""

    def __init__(self, session):
        self.socket, self.stop = opened(port=0), threading.Event()
        self.thread = threading.Thread(
            target=serve, args=(session, self.socket, lambda: not self.stop.is_set())
        )
        self.client = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.client.settimeout(30.0)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.stop.set()
        self.thread.join()
        self.socket.close()
        self.client.close()

    def send(self, data):
        self.client.sendto(data, self.socket.getsockname())

    def answer(self):
        return json.loads(self.client.recv(65535))


def test_the_door_answers_estimates_after_garbage():
    session = Session(Live("rls", fingers=1))
    with Door(session) as door:
        door.send(b"\xff\x00garbage")
        assert door.answer() == {"error": "not JSON"}
        lines = [text(*row) for row in readings(0.2)]
        for k in range(0, len(lines), 20):
            door.send("\n".join(lines[k : k + 20]).encode())
        answer = door.answer()
    assert answer["estimate"] == 1
    assert answer["sd_mu_c"] > 0.0
    assert answer["status"] == "ok"


def test_lines_beyond_the_limit_of_a_datagram_are_counted():
    session = Session(Live("rls", fingers=1))
    with Door(session) as door:
        door.send(b"x\n" * (LINES + 50))
        door.answer()
        door.send(b"y")
        while sum(session.malformed.values()) < LINES + 51:
            pass
    assert session.malformed[f"beyond the first {LINES} lines of a datagram"] == 50


def test_the_default_door_is_closed_to_other_machines():
    with opened(port=0) as door:
        assert door.getsockname()[0] == "127.0.0.1"


KILLED = """
import sys
from estimator.live import Live, Log
from lab.live_streams import feed, readings
live = Live("rls", fingers=1, log=Log(sys.argv[1]))
stream = readings(60.0)
for k, row in enumerate(stream):
    feed(live, [row])
    if k == 1500:
        print("running", flush=True)
"""


def test_a_log_survives_a_kill_and_is_continued(tmp_path):
    from estimator import records
    from estimator.live import records as of_log

    path = tmp_path / "log.jsonl"
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(path)], cwd=ROOT, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "running\n"
    process.kill()
    process.communicate()
    before = list(read(path))
    assert len(before) > 1500
    with path.open("ab") as file:
        file.write(b'{"finger":1,"t":0.1,"wren')  # as a power cut leaves it
    assert list(read(path)) == before
    log = Log(path)
    live = Live("rls", fingers=1, log=log)
    outputs = [live.feed_wrench(1, t, v, t) if kind == "wrench" else live.feed_twist(1, t, v, t)
               for kind, t, v in readings(1.0)]  # fmt: skip
    live.flush()
    log.close()
    assert list(read(path))[: len(before)] == before
    killed, continued = of_log(path)[1]
    found = records.estimate(continued, "rls", allow_gaps=True).estimates.tolist()
    wanted = [tuple(output.estimate) for each in outputs for output in each]
    assert found[: len(wanted)] == wanted
    told = [line["mu_c"] for line in before if "estimate" in line]
    offline = records.estimate(killed, "rls", allow_gaps=True).estimates["mu_c"].tolist()
    assert offline[: len(told)] == told
    assert len(told) > 50


@pytest.mark.parametrize("content", ["a letter\n", "{}\n", '{"live": 1}\nnonsense\n{"grip": 1}\n', "[1]\n"])
def test_a_file_that_is_no_log_is_refused_and_kept(content, tmp_path):
    path = tmp_path / "letter.txt"
    path.write_text(content)
    with pytest.raises(ValueError, match="letter"):
        list(read(path))
    if "live" not in content:
        with pytest.raises(ValueError, match="letter"):
            Log(path)
    assert path.read_text() == content


class Full:
    """A file on a full disk: it takes a part of a line, or nothing."""

    def __init__(self, file, takes):
        self.file, self.takes = file, takes

    def write(self, text):
        if self.takes == 0:
            raise OSError(28, "No space left on device")
        return self.file.write(text[: self.takes])

    def truncate(self, size):
        self.file.truncate(size)


@pytest.mark.parametrize("takes", [0, 5])
def test_a_full_disk_stops_no_gripper_and_is_told(takes, tmp_path):
    log = Log(tmp_path / "log.jsonl")
    session = Session(Live("rls", fingers=1, log=log), log=log)
    whole = log._file
    log._file = Full(whole, takes)
    session.take(json.dumps(WRENCH), 0.0)
    log._file = whole
    session.take(json.dumps({**WRENCH, "t": 0.001}), 0.001)
    log.close()
    assert [line.get("t") for line in read(log.path)] == [None, 0.001]
    assert "1 lines are not in" in session.report()


def test_clocks_that_differ_are_told_while_it_runs():
    session, answers = Session(Live("rls", fingers=1)), []
    for kind, t, values in readings(3.0):
        answers += session.take(text(kind, t + 0.3 * (kind == "twist"), values), t) + session.tick(t)
    (warning,) = [answer["warning"] for answer in answers if "warning" in answer]
    assert "+0.300 s" in warning


def test_a_pipe_is_no_log(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ValueError, match="regular"):
        Log(tmp_path / "pipe")
