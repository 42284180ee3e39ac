"""Films and windows of policies."""

import os
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from PIL import Image
from typer.main import get_command
from typer.testing import CliRunner

from lab.montage import take_screenshot
from policies.commands.play import app
from policies.play import Video, watch
from policies.play.watch import Keyboard
from policies.task_names import own_policy
from slipgym.config import load
from slipgym.registration import ENVIRONMENTS
from slipgym.rendering import Window
from slipgym.tasks import TASKS

SHORT = {"duration": 0.4, "settle": 0.1, "hold": 0.1, "distance": 0.005}
ROOT = Path(__file__).resolve().parents[2]


def test_a_gif_of_two_episodes(tmp_path):
    path = tmp_path / "new" / "film.gif"
    outcomes = watch("LinearSlip", video=path, episodes=2, seed=4, options=SHORT, progress=False)
    assert [outcome.seed for outcome in outcomes] == [4, 5]
    assert all(outcome.time == pytest.approx(0.6) for outcome in outcomes)
    with Image.open(path) as film:
        assert film.size == (720, 480)
        # still frames of a GIF are merged into longer ones
        total = 0
        for frame in range(film.n_frames):
            film.seek(frame)
            total += film.info["duration"]
        assert total == pytest.approx(2 * (0.6 / 0.04 + 2) * 40, abs=80)
    assert [file.name for file in path.parent.iterdir()] == ["film.gif"]


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # imageio_ffmpeg's own pipes
@pytest.mark.parametrize(("speed", "frames"), [(1.0, 19), (0.5, 37)])
def test_an_mp4_at_its_speed(tmp_path, speed, frames):
    reader = pytest.importorskip("imageio_ffmpeg")
    path = tmp_path / "film.mp4"
    watch("LinearSlip", "constant_force", path, speed=speed, options=SHORT, progress=False)
    film = reader.read_frames(str(path))
    meta = next(film)
    pictures = [np.frombuffer(frame, np.uint8) for frame in film]
    assert meta["size"] == (720, 480)
    assert meta["fps"] == 30
    assert len(pictures) == pytest.approx(frames, abs=1)
    assert np.abs(pictures[0].astype(int) - pictures[-1]).max() > 50


def test_an_error_leaves_no_film(tmp_path):
    def break_off() -> None:
        with Video(tmp_path / "film.gif") as film:
            film.add(np.zeros((480, 720, 3), np.uint8))
            raise RuntimeError("midway")

    with pytest.raises(RuntimeError, match="midway"):
        break_off()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"task": "Slide"}, "unknown task 'Slide'"),
        ({"policy": "hodl"}, "unknown policy 'hodl'.*hold"),
        ({"policy": "keyboard"}, "needs a window"),
        ({"video": "film.avi"}, r"unknown type of video '.avi'.*\.gif, \.mp4"),
        ({"speed": 0.0}, "speed = 0.0"),
        ({"episodes": 0}, "episodes = 0"),
        ({"options": {"distanse": 1}}, "unknown option 'distanse'"),
        ({"material": "glass"}, "unknown material 'glass'"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, changes, words):
    arguments = {"task": "LinearSlip", "video": "film.gif", "progress": False, **changes}
    arguments["video"] = tmp_path / arguments["video"]
    with pytest.raises(ValueError, match=words):
        watch(**arguments)
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def keys(monkeypatch):
    """A hidden window in which the up key is held down, at no one's pace."""
    pytest.importorskip("pygame")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setattr(Window, "vertical", lambda self: 1)
    shown = []
    monkeypatch.setattr(Window, "show", lambda self, picture, rate: shown.append(picture))
    return shown


def test_a_key_held_down_grips_harder(keys):
    config = load(None)
    window = Window("test", (720, 480))
    hand, state, actions = Keyboard(window, config, 10.0), None, []
    for _ in range(config.physics.control_rate):
        action, state = hand.predict(np.zeros(1), state)
        actions.append(float(action[0]))
    assert np.all(np.diff(actions) > 0.0)
    assert state == pytest.approx(18.0)
    window.close()


def test_playing_by_hand(keys):
    (outcome,) = watch("LinearSlip", "keyboard", options=SHORT)
    assert outcome.slip[1] > -1e-4  # it was held
    assert len(keys) == pytest.approx(0.6 * 30 + 2, abs=1)


def test_closing_the_window_ends_it(keys, monkeypatch):
    def close(self, picture, rate):
        self.closed = True

    monkeypatch.setattr(Window, "show", close)
    assert watch("LinearSlip", options=SHORT) == []


def test_every_task_has_a_policy_to_show():
    assert own_policy("LinearSlip") == "linear_slip"
    picture = take_screenshot("slipgym/LinearSlip-v0", "wood")
    assert picture.shape == (480, 720, 3)


def test_the_command_line(tmp_path):
    displays = {"DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"}
    without_display = {name: value for name, value in os.environ.items() if name not in displays}

    options = [word for name, value in SHORT.items() for word in ("--option", f"{name}={value}")]
    words = "LinearSlip", "--video", "film.gif", "--material", "wood", *options
    done = subprocess.run(
        [sys.executable, str(ROOT / "scripts" / "play.py"), *words],
        cwd=tmp_path,
        env={**without_display, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "seed 0:" in done.stdout
    assert (tmp_path / "film.gif").stat().st_size > 1000


def test_without_a_screen_the_command_line_names_the_option_of_a_video(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)
    done = CliRunner().invoke(app, ["LinearSlip"])
    assert done.exit_code == 2
    assert "--video" in done.stderr


def test_an_episode_without_an_estimator_is_shown(tmp_path):
    options = [word for name, value in SHORT.items() for word in ("--option", f"{name}={value}")]
    words = ["LinearSlip", "--estimator", "none", "--video", str(tmp_path / "film.gif"), *options]
    done = CliRunner().invoke(app, [*words, "--policy", "constant_force"])
    assert done.exit_code == 0, done.output
    refused = CliRunner().invoke(app, words)  # the task's own controller acts on estimates
    assert refused.exit_code == 2
    assert "estimator=None" in refused.output.replace("\n", " ")


@pytest.mark.parametrize("env_id", ENVIRONMENTS)
def test_every_environment_has_its_picture_in_the_docs(env_id):
    key = TASKS[env_id.removeprefix("slipgym/").rpartition("-")[0]].key
    with Image.open(ROOT / "docs" / "images" / f"{key}.png") as picture:
        assert picture.size == (720, 480), "run scripts/make_docs.py"


def test_the_help_names_all_presets_of_sensors():
    help = next(each.help for each in get_command(app).params if "--sensors" in each.opts)
    named = set(help.rstrip(".").replace(" or ", ", ").split(", "))
    assert named == {each.stem for each in (ROOT / "configs" / "sensors").glob("*.yaml")}


@pytest.mark.parametrize(
    ("words", "arguments"),
    [
        (["--policy", "hold_lab"], {"level": "hard", "sensors": "lab", "estimator": None}),
        (["--policy", "hold_lab", "--set", "level=easy"], {"level": "easy", "sensors": "lab"}),
        (["--set", "level=hard", "randomization=train"], {"level": "hard", "randomization": "train"}),
        (
            ["--estimator", "none", "--friction-source", "true"],
            {"estimator": None, "friction_source": "true"},
        ),
    ],
)
def test_arguments_of_the_environment(tmp_path, monkeypatch, words, arguments):
    """A learned policy has those of its training, where no others are given."""
    made, make = {}, gym.make

    def remember(env_id, **keywords):
        made.update(keywords)
        return make(env_id, **keywords)

    monkeypatch.setattr(gym, "make", remember)
    short = "--option", "duration=0.05", "--engine", "planar", "--video", str(tmp_path / "film.gif")
    done = CliRunner().invoke(app, ["hold", *words, *short])
    assert done.exit_code == 0, done.output
    assert {name: made[name] for name in arguments} == arguments
