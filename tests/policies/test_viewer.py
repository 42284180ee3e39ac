"""The viewer without a browser: session, changes, controls, recording, errors."""

import sys
from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from policies.commands.play import app
from policies.play.video import Recording
from policies.play.viewer import Session, open_viewer
from policies.play.viewer.app import policies_for
from policies.play.viewer.controls import Controls
from policies.play.viewer.interventions import POKE_TIME, poke, set_friction, set_mass
from policies.play.viewer.plots import curves
from slipgym.tasks import find
from slipgym.tasks.episode import EPISODE

SHORT = {"material": "wood", "duration": 0.4, "settle": 0.1, "hold": 0.1, "distance": 0.005}
DT = 1.0 / 120.0


@pytest.fixture
def session():
    made = Session("linear_slip", engine="planar", options=SHORT)
    yield made
    made.close()


def test_time_is_played_in_control_steps(session):
    assert session.advance(2.5 * DT) == 2
    assert session.advance(0.5 * DT) == 1
    assert session.info["time"] == pytest.approx(3 * DT)
    assert session.advance(10.0) == 12  # the rest is not made up for


def test_a_friction_slider_arrives_in_the_next_step_and_the_next_episode(session):
    session.submit("mu_c", 0.7)
    assert session.info["true"][1] == pytest.approx(0.3623)
    session.advance(DT)
    ratio = 0.5155 / 0.3623
    assert session.info["true"][:2] == pytest.approx([0.7 * ratio, 0.7])
    session.restart()
    assert session.info["true"][:2] == pytest.approx([0.7 * ratio, 0.7])
    session.submit("mu_c", None)
    session.advance(DT)
    session.restart()
    assert session.info["true"][1] == pytest.approx(0.3623)


def test_a_mass_slider_arrives_in_the_next_step_and_the_next_episode(session):
    world = session.env.simulation.plant.world[0]
    inertia = float(world["inertia"])
    session.submit("mass", 0.4)
    session.advance(DT)
    assert world["mass"] == pytest.approx(0.4)
    assert world["inertia"] == pytest.approx(2.0 * inertia)
    session.restart()
    assert world["mass"] == pytest.approx(0.4)


@pytest.mark.parametrize("mode", ["grip_force", "force_increment", "log_grip_force"])
def test_a_hand_on_the_grip_replaces_the_policys(mode):
    session = Session("linear_slip", "constant_force", engine="planar", options=SHORT, action_mode=mode)
    for force in (9.0, 3.0):
        session.submit("grip_force", force)
        for _ in range(20):
            session.advance(DT)
        assert session.env.simulation.episode["command"][0] == pytest.approx(force, abs=1e-5)
    session.close()


def test_a_poke_is_a_push_of_that_impulse(session):
    world = session.env.simulation.plant.world[0]
    session.poke("→", 0.02)
    impulse = 0.0
    for _ in range(12):
        session.advance(DT)
        impulse += DT * world["external"]
    assert impulse == pytest.approx([0.02, 0.0, 0.0], abs=1e-12)


def test_latency_and_policy_wait_for_the_next_episode(session):
    session.submit("latency", 3)
    session.submit("policy", "constant_force")
    session.advance(DT)
    assert session.pending == {"latency", "policy"}
    assert session.policy == "linear_slip"
    session.request_restart()
    session.advance(DT)
    assert session.pending == set()
    assert session.policy == "constant_force"
    assert session.env.config.sensors.slip.latency_samples == 3


def test_a_change_that_is_refused_leaves_the_session_as_it_was(session):
    session.submit("latency", 99)
    session.request_restart()
    with pytest.raises(ValueError, match="latency_samples"):
        session.advance(DT)
    assert session.pending == set()
    assert session.advance(DT) == 1
    with pytest.raises(ValueError, match=r"unknown value 'mu'.*mu_c"):
        session.submit("mu", 0.5)


def test_an_episode_ends_and_the_next_one_has_the_next_seed(session):
    while session.outcome is None:
        session.advance(0.1)
    assert session.finished == [session.outcome]
    assert session.outcome.time == pytest.approx(0.6)
    assert session.advance(0.1) == 0
    times, true = curves(session.history, "true_mu_c")
    assert times == pytest.approx(np.arange(len(times)) / 30.0)
    assert true == pytest.approx(0.3623)
    session.restart()
    assert session.seed == 1
    assert session.outcome is None


def test_a_full_list_of_pushes_makes_room():
    episode = np.zeros(1, EPISODE)[0]
    episode["step_time"] = DT
    slots = len(episode["push_start"])
    for step in range(slots + 3):
        episode["step"] = step
        poke(episode, "↑", 0.01)
    assert episode["pushes"] == slots
    assert episode["push_start"].tolist() == list(range(3, slots + 3))
    force = 0.01 / POKE_TIME
    assert episode["push_wrench"][-1] == pytest.approx([0.0, force, 0.0])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda episode: poke(episode, "up", 0.01), "unknown direction 'up'; valid: ←"),
        (lambda episode: poke(episode, "↑", 0.0), "impulse = 0.0 must be positive"),
        (lambda episode: set_friction(episode, -1.0), "mu_c = -1.0"),
        (lambda episode: set_mass(episode, float("nan")), "mass = nan"),
    ],
)
def test_a_change_that_makes_no_sense_is_refused(change, words):
    with pytest.raises(ValueError, match=words):
        change(np.ones(1, EPISODE)[0])


class Handle(SimpleNamespace):
    """What a `gui.add_...` of viser returns, as far as the controls use it."""

    def on_update(self, act):
        self.changed = act

    def on_click(self, act):
        self.clicked = act


class Gui:
    """Keeps the handles by their label."""

    def __init__(self):
        self.handles = {}

    def add_folder(self, label):
        return nullcontext()

    def add_html(self, content):
        return self.handles.setdefault(f"html {len(self.handles)}", Handle(content=content))

    def __getattr__(self, name):
        def add(label, *values, initial_value=None, **_):
            value = initial_value if initial_value is not None else values[-1] if values else None
            low, high = values[:2] if name == "add_slider" else (None, None)
            return self.handles.setdefault(label, Handle(value=value, min=low, max=high))

        return add

    def move(self, label, value):
        handle = self.handles[label]
        handle.value = value
        handle.changed(SimpleNamespace(client_id=0, target=handle))

    def click(self, label, value=None):
        handle = self.handles[label]
        handle.value = value
        handle.clicked(SimpleNamespace(client_id=0, target=handle))


def test_controls_act_on_the_session_and_show_it(session):
    gui = Gui()
    controls = Controls(gui, session, ["linear_slip", "constant_force"], lambda wanted: wanted)
    gui.move("friction mu_c", 0.5)
    gui.move("mass [g]", 300.0)
    gui.move("grip force [N]", 7.0)
    gui.move("latency [samples]", 2)
    gui.click("push", "←")
    gui.move("speed", "0.25x")
    gui.move("pause", True)
    session.advance(DT)
    controls.update()
    assert session.values == {"mu_c": 0.5, "mass": 0.3, "grip_force": 7.0, "latency": 2}
    assert session.env.simulation.episode["pushes"][0] == 1
    assert (controls.speed, controls.paused) == (0.25, True)
    page = gui.handles["html 0"].content
    assert "wood, 300 g" in page
    assert '"mu_c true">0.500<' in page
    assert '"set by hand">grip_force, mass, mu_c<' in page
    assert '"next episode">latency<' in page
    gui.click("undo all sliders")
    session.advance(DT)
    controls.begin()
    assert session.values == {}
    assert gui.handles["friction mu_c"].value == pytest.approx(0.362)


def test_what_the_program_changes_is_no_order(session):
    gui = Gui()
    Controls(gui, session, ["linear_slip"])
    handle = gui.handles["friction mu_c"]
    handle.changed(SimpleNamespace(client_id=None, target=handle))
    session.advance(DT)
    assert session.values == {}


def test_recordings_are_numbered_and_have_watching_time(session, tmp_path):
    recording = Recording(tmp_path / "slide.gif")
    for _ in range(2):
        recording.begin()
        for _ in range(10):
            session.advance(0.02)
            recording.add(session.env, 0.04)
        recording.end()
    assert [path.name for path in recording.paths] == ["slide.gif", "slide_2.gif"]
    with Image.open(tmp_path / "slide_2.gif") as video:
        assert video.size == (720, 480)
    with pytest.raises(ValueError, match=r"unknown type of video '.avi'"):
        Recording(tmp_path / "slide.avi")


def test_policies_on_offer_fit_the_task():
    offered = policies_for(find("hinge"), {"engine": "planar"})
    assert {"hinge", "constant_force", "hinge_scratch"} <= set(offered)
    assert not {"linear_slip", "rotational_slip_scratch"} & set(offered)


def test_without_viser_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(ModuleNotFoundError, match=r"pip install 'slipgym\[viewer\]'"):
        open_viewer("linear_slip", engine="planar")
    done = CliRunner().invoke(app, ["linear_slip", "--viewer", "--engine", "planar"])
    assert done.exit_code == 2
    assert "slipgym[viewer]" in " ".join(done.output.split())
