"""The plots of the viewer without a browser: limit surface, why an estimate is off."""

import re
from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

from policies.play.viewer import Session
from policies.play.viewer.controls import status
from policies.play.viewer.plots import WIDTH, Plots, SurfacePlot, _friction, _ticks, boundary
from policies.play.viewer.scene import Scene
from slipgym.contact import EllipsoidContact

SHORT = {"material": "wood", "duration": 0.4, "settle": 0.1, "hold": 0.1, "distance": 0.005}
DT = 1.0 / 120.0


@pytest.fixture
def session():
    made = Session("linear_slip", engine="planar", options=SHORT)
    yield made
    made.close()


def test_the_surface_is_the_steady_friction_of_two_ellipsoidal_pads():
    mu, normal, radius = np.array([0.4, 0.5]), np.array([6.0, 8.0]), np.array([0.009, 0.011])
    curve = boundary(mu, normal, radius)
    assert curve[20] == pytest.approx([0.0, mu @ normal])  # translation alone
    assert curve[-1] == pytest.approx([(mu * normal) @ radius, 0.0], abs=1e-12)  # spin alone
    ratio = np.tan(0.25 * np.pi)  # r omega / v at three quarters
    twist = (0.0, -0.02, ratio * 0.02 / 0.010)
    total = np.zeros(3)
    for k in range(2):
        pad = EllipsoidContact(r=radius[k], mu_c=mu[k], mu_s=mu[k], sigma_0=1e6, sigma_1=0.0, sigma_2=0.0)
        for _ in range(200):
            wrench = pad.step(twist, normal[k], 1e-3)
        total += wrench
    assert curve[30] == pytest.approx([abs(total[2]), np.hypot(total[0], total[1])], rel=1e-6)


def test_the_plot_of_the_surface_draws_what_is_known(session):
    plot = SurfacePlot()
    before = plot.draw(session.env.simulation, session.info)
    assert before.count("<polyline") == 2  # nothing is estimated yet
    for _ in range(5):
        session.advance(0.1)
    after = plot.draw(session.env.simulation, session.info)
    assert after.count("<polyline") == 3
    assert "nan" not in before + after
    assert after.count("<circle") == 2


def test_the_axes_of_the_surface_hold_the_estimated_one(session):
    for _ in range(5):
        session.advance(0.1)
    session.env.simulation.estimated[0, 1:3] *= 3.0  # mu_c and r far above the truth
    drawn = SurfacePlot().draw(session.env.simulation, session.info)
    points = re.findall(r'<polyline points="([^"]*)"', drawn)[2].split()
    x, y = np.array([point.split(",") for point in points], dtype=float).T
    assert x.max() <= WIDTH
    assert y.min() >= 0.0


def test_every_axis_of_the_surface_has_a_number_besides_zero():
    for high in np.geomspace(0.2, 2000.0, 200):
        for ticks in (_ticks(-high, high), _ticks(0.0, high)):
            assert 2 <= len(ticks) <= 5
            assert 0.0 < ticks[-1] <= high


def test_a_band_has_no_width_before_there_are_data(session):
    for _ in range(5):
        session.advance(0.1)
    _, low, high, _, _, mu_c, *_ = _friction(session.history)
    unknown = np.isnan(mu_c)
    assert 0 < unknown.sum() < len(mu_c)
    assert np.array_equal(low[unknown], high[unknown])  # and not NaN, from which the page draws a wedge
    assert (high[~unknown] > low[~unknown]).all()


class Gui:
    """What the plots use of `viser.GuiApi`; it keeps the pieces of HTML."""

    def __init__(self):
        self.pages = []

    def add_folder(self, label):
        return nullcontext()

    def add_html(self, content):
        self.pages.append(SimpleNamespace(content=content))
        return self.pages[-1]

    def add_uplot(self, data, series, **_):
        return SimpleNamespace(data=data)


def test_below_the_plot_of_friction_stands_why_an_estimate_is_off(session):
    gui = Gui()
    plots, words = Plots(gui, session), gui.pages[0]
    assert "not observed: it needs slip with translation in it" in words.content
    while session.info["time"] < 0.4:
        session.advance(DT)
    session.submit("mu_c", 0.9)
    session.advance(DT)
    plots.update()
    assert "friction changed" in words.content
    for name, error, reason in session.env.discrepancies():
        assert f"{name}</b> {error}: {reason}" in words.content
    session.env.simulation.estimated[0, :9] = session.env.simulation.ground_truth[0, :9]
    plots.update()
    assert "no estimate is off" in words.content


class Stage:
    """Stands in for the 3-D view: every node that is added keeps what it is given."""

    def __init__(self):
        self.nodes = {}

    def __getattr__(self, name):
        def add(path="", *_, **given):
            self.nodes[path] = SimpleNamespace(remove=lambda: None, **{"visible": False, **given})
            return self.nodes[path]

        return add


def test_the_view_follows_the_gripper_and_gravity_stays():
    carried, stage, camera = Session("carry", engine="planar"), Stage(), SimpleNamespace()
    simulation = carried.env.simulation
    scene = Scene(stage, camera)
    scene.begin(simulation)
    world, gripper = stage.nodes["/world"], stage.nodes["/world/gripper"]
    start = np.array(gripper.position)
    away = np.linalg.norm(np.subtract(camera.position, camera.look_at))
    while carried.outcome is None and np.linalg.norm(gripper.position - start) < 0.15:
        carried.advance(DT)
        scene.update(simulation)
    assert np.linalg.norm(gripper.position - start) >= 0.15
    seen = np.add(world.position, gripper.position)
    assert np.linalg.norm(seen - start) < 0.15 * away * np.tan(0.5 * camera.fov)
    assert {"/gravity", "/gravity_name"} <= set(stage.nodes)  # outside of the world that moves
    carried.close()


def test_no_minus_stands_before_a_zero(session):
    session.info = {**session.info, "slip": np.array([0.0, 0.0, -1e-5])}
    assert "0.0 mm, 0.0&deg;" in status(session)
