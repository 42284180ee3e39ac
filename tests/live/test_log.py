"""A log has one writer, and a start that fails leaves it as it was."""

import socket

import pytest
from typer.testing import CliRunner

from estimator.live import Live, Log, read, records, ros
from lab.live_streams import feed, readings
from policies.commands.live import app


def start(*words):
    return CliRunner().invoke(app, ["--estimator", "rls", "--seconds", "0", *map(str, words)])


@pytest.fixture
def running(tmp_path):
    """The log of a session that runs."""
    log = Log(tmp_path / "run.jsonl")
    feed(Live("rls", fingers=1, log=log), readings(0.5))
    yield log
    log.close()


def test_a_second_log_of_the_same_file_is_refused(running):
    before = running.path.read_bytes()
    with pytest.raises(ValueError, match=r"run\.jsonl: another session writes"):
        Log(running.path)
    assert running.path.read_bytes() == before
    running.close()
    Log(running.path).close()


def test_a_start_on_the_log_of_another_session_is_refused(running):
    before = running.path.read_bytes()
    done = start("--port", 0, "--log", running.path)
    assert done.exit_code == 2
    assert "another session writes" in done.output
    assert running.path.read_bytes() == before
    assert len(records(running.path)[1]) == 1


@pytest.mark.parametrize("fault", ["port", "policy"])
@pytest.mark.parametrize("there", [True, False])
def test_a_start_that_fails_leaves_the_log_as_it_was(fault, there, running, tmp_path):
    running.close()
    path = running.path if there else tmp_path / "new.jsonl"
    before = path.read_bytes() if there else None
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        words = ["--port", port] if fault == "port" else ["--port", 0, "--policy", "nobody"]
        done = start(*words, "--log", path)
    assert done.exit_code == 2
    assert (f"127.0.0.1:{port}" if fault == "port" else "nobody") in done.output
    assert (path.read_bytes() if path.exists() else None) == before


def test_a_start_begins_the_log(tmp_path):
    assert start("--port", 0, "--log", tmp_path / "new.jsonl").exit_code == 0
    assert [line["live"] for line in read(tmp_path / "new.jsonl")] == [1]


@pytest.mark.parametrize(("door", "serve"), [("ros2", "serve_ros2"), ("rosbridge", "serve_rosbridge")])
@pytest.mark.parametrize("opens", [True, False])
def test_a_door_of_ros_begins_the_log_once_it_is_open(door, serve, opens, tmp_path, monkeypatch):
    def served(*arguments):
        if not opens:
            raise OSError("nobody is there")
        assert not (tmp_path / "new.jsonl").exists()
        while arguments[-1]():
            pass

    monkeypatch.setattr(ros, serve, served)
    done = start("--door", door, "--log", tmp_path / "new.jsonl")
    assert done.exit_code == (0 if opens else 2), done.output
    assert (tmp_path / "new.jsonl").exists() == opens
