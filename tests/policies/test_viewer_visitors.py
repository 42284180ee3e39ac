"""Who may drive the viewer, and what it takes: own pages only, and only what its controls offer."""

import math
import socket
import time

import pytest

from policies.play.viewer import Session, open_viewer
from policies.play.viewer.controls import Controls
from policies.play.viewer.guard import Offer, number, one_of, switch
from policies.play.viewer.session import Refused

from .test_viewer import DT, SHORT, Gui

LOCAL = "127.0.0.1"


@pytest.mark.parametrize(
    ("take", "good", "bad"),
    [
        (
            number(0.05, 1.5),
            [0.05, 1, 1.5],
            [0.04, 1.51, math.nan, math.inf, "0.5", None, True, [0.5], 10**400],
        ),
        (number(0, 12, True), [0, 3.0, 12], [2.5, -1, 13, math.nan, "3"]),
        (one_of(("0.5x", "1x")), ["0.5x"], ["1e9x", "nan", "", 1.0, None, ["1x"], {}]),
        (switch, [True, False], [1, 0, "on", None]),
    ],
)
def test_a_control_takes_what_it_offers(take, good, bad):
    for value in good:
        assert take(value) == value
    for value in bad:
        with pytest.raises(ValueError, match=r"must be|not on offer"):
            take(value)


@pytest.fixture
def session():
    made = Session("linear_slip", engine="planar", options=SHORT)
    yield made
    made.close()


@pytest.mark.parametrize(
    ("label", "values"),
    [
        ("policy", ["os:system", "no such policy", "hinge", "/tmp", "", 7]),
        ("speed", ["nanx", "1e9x", "x", "-1x", None]),
        ("friction mu_c", [math.nan, "wood"]),
        ("mass [g]", [math.inf, -math.inf, "heavy"]),
        ("grip force [N]", [math.nan, None]),
        ("latency [samples]", [1.5, math.nan]),
        ("poke [mN s]", [math.nan]),
        ("push", ["up", "", None, ["→"]]),
        ("turn", ["→", "round"]),
        ("pause", ["yes", 2]),
        ("grip by hand", ["yes", None]),
        ("record MP4", ["yes", 1]),
    ],
)
def test_what_no_control_offers_is_refused_and_the_episode_goes_on(session, label, values):
    gui, recorded = Gui(), []
    controls = Controls(gui, session, ["linear_slip", "constant_force"], lambda on: recorded.append(on) or on)
    shown, send = gui.handles[label].value, gui.click if label in ("push", "turn") else gui.move
    for value in values:
        send(label, value)
        with pytest.raises(Refused) as refused:
            session.advance(DT)
        assert str(refused.value).startswith(f"{label} = {value!r}")
        if label not in ("push", "turn"):
            assert gui.handles[label].value == shown
    assert session.values == {}
    assert session.pending == set()
    assert recorded == []
    assert (controls.speed, controls.paused) == (1.0, False)
    controls.update()
    assert session.advance(DT) == 1


@pytest.mark.parametrize(
    ("label", "values", "typed"),
    [
        ("friction mu_c", [0.0, -1.0, 2.0], 0.55),
        ("mass [g]", [3.0, 0.0, 1e9, 10**400], 300.0),
        ("grip force [N]", [0.0, -5.0, 1e6], 12.0),
        ("latency [samples]", [99, -1], 2),
    ],
)
def test_a_number_that_is_typed_digit_by_digit_is_taken_when_it_is_in_range(session, label, values, typed):
    gui = Gui()
    Controls(gui, session, ["linear_slip"])
    for value in values:
        gui.move(label, value)
        session.advance(DT)
        assert gui.handles[label].value == value  # what was typed so far stays in the box
        assert session.values == {}
    gui.move(label, typed)
    session.advance(DT)
    assert len(session.values) == 1


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("mu_c", math.nan),
        ("mu_c", "wood"),
        ("mass", -1.0),
        ("mass", [0.2]),
        ("grip_force", math.nan),
        ("grip_force", "tight"),
        ("policy", {"name": "hold"}),
    ],
)
def test_a_value_that_is_refused_is_not_kept_for_the_next_episode(session, name, value):
    session.submit(name, value)
    with pytest.raises(Refused, match=name):
        session.advance(DT)
    assert session.values == {}
    session.restart()
    assert session.advance(DT) == 1


@pytest.mark.parametrize("name", ["no such policy", "no_such_module:Policy", "json:no_such_name"])
def test_a_policy_that_cannot_be_loaded_is_refused(session, name):
    session.submit("policy", name)
    session.request_restart()
    with pytest.raises(Refused):
        session.advance(DT)
    assert session.policy == "linear_slip"
    assert session.advance(DT) == 1


def test_an_episode_that_was_given_up_waits_for_the_next(session):
    session.submit("mu_c", 0.5)
    session.advance(DT)
    session.give_up()
    assert session.advance(DT) == 0
    assert session.values == {}
    session.restart()
    assert session.advance(DT) == 1


@pytest.fixture
def viewer(tmp_path):
    pytest.importorskip("viser")
    with socket.socket() as free:
        free.bind((LOCAL, 0))
        port = free.getsockname()[1]
    made = open_viewer("linear_slip", video=tmp_path / "v.gif", options=SHORT, port=port, engine="planar")
    yield made
    made.close()


class Visitor:
    """A program that speaks as the page does."""

    def __init__(self, viewer, origin, host=None):
        import msgspec
        import viser
        from websockets.sync.client import connect

        self._viewer, self._encode = viewer, msgspec.msgpack.encode
        port = viewer.server.get_port()
        self._socket = connect(
            f"ws://{host or LOCAL}:{port}",
            sock=socket.create_connection((LOCAL, port)),
            subprotocols=[f"viser-v{viser.__version__}"],
            origin=origin and origin.format(port=port),
            max_size=None,
        )
        places = {"position": [1.0] * 3, "look_at": [0.0] * 3, "up_direction": [0.0, 0.0, 1.0]}
        view = {"wxyz": [1.0, 0.0, 0.0, 0.0], "fov": 1.0, "near": 0.01, "far": 10.0, **places}
        self._tell({"type": "ViewerCameraMessage", "image_height": 9, "image_width": 9, **view})

    def _tell(self, message):
        self._socket.send(self._encode(message))

    def send(self, label, **updates):
        handles = self._viewer.server.gui._gui_input_handle_from_uuid.items()
        uuid = next(uuid for uuid, handle in handles if getattr(handle, "label", None) == label)
        self._tell({"type": "GuiUpdateMessage", "uuid": uuid, "updates": updates})

    def is_closed(self):
        from websockets.exceptions import ConnectionClosed

        try:
            while True:
                self._socket.recv(timeout=0.5)
        except ConnectionClosed as error:
            return error.rcvd is not None and error.rcvd.code == 1008
        except TimeoutError:
            return False


def _play(viewer, until=lambda: False, seconds=2.0):
    end = time.monotonic() + seconds
    while not until() and time.monotonic() < end:
        viewer.frame(1.0 / 30.0)
        time.sleep(0.01)


@pytest.mark.parametrize(
    ("origin", "host"),
    [
        ("http://evil.example", None),
        (None, None),
        ("http://localhost:1", None),
        ("http://evil.example:{port}", "evil.example"),
    ],
)
def test_a_foreign_page_moves_nothing(viewer, origin, host):
    from websockets.exceptions import ConnectionClosed

    try:
        visitor = Visitor(viewer, origin, host)
        visitor.send("friction mu_c", value=0.9)
    except ConnectionClosed:
        return
    _play(viewer, seconds=0.5)
    assert viewer.session.values == {}
    assert visitor.is_closed()
    assert viewer.server.get_clients() == {}
    assert not viewer.server._websock_server._live_connections  # nothing of it is kept


def test_the_own_page_moves_sliders_and_its_bad_values_end_nothing(viewer):
    session, said = viewer.session, []
    viewer._say = lambda title, words, colour: said.append(words)
    visitor = Visitor(viewer, "http://127.0.0.1:{port}")
    _play(viewer, lambda: viewer.server.get_clients())
    visitor.send("friction mu_c", value=0.9)
    _play(viewer, lambda: session.values)
    assert session.values == {"mu_c": 0.9}
    for label, value in [
        ("friction mu_c", math.nan),
        ("policy", "no such policy"),
        ("policy", "os:system"),
        ("speed", "nanx"),
    ]:
        count = len(said)
        visitor.send(label, value=value)
        _play(viewer, lambda count=count: len(said) > count)
        assert said[-1].startswith(f"{label} = ")
    visitor.send("mass [g]", value="heavy")
    visitor.send("latency [samples]", value={"a": 1})
    visitor.send("friction mu_c", gui_api="gone", update_cb=None, no_such_property=1)
    _play(viewer, seconds=0.5)
    visitor.send("next episode", value=True)
    _play(viewer, lambda: session.seed > 0)
    assert session.seed == 1
    _play(viewer, seconds=0.3)
    assert session.env.simulation.episode["step"][0] > 0
    assert session.policy == "linear_slip"


def test_a_policy_that_raises_ends_the_episode_and_not_the_server(viewer):
    said = []
    viewer._say = lambda title, words, colour: said.append(words)

    def predict(*_, **__):
        raise KeyError("no such gain")

    viewer.session._player.predict = predict
    viewer.frame(1.0 / 30.0)
    assert said == ["KeyError: 'no such gain'"]
    viewer.frame(1.0 / 30.0)
    assert len(said) == 1  # it waits for the next episode
    del viewer.session._player.predict
    for _ in range(60):
        viewer.frame(1.0 / 30.0)
    assert viewer.session.seed == 1
    assert not viewer.session.failed


def test_a_value_of_the_program_is_shown_and_no_order():
    gui, orders = Gui(), []
    handle = gui.add_slider("x", 0.0, 1.0, 0.1, 0.5)
    offer = Offer(handle, "x", number(0.0, 1.0), orders.append)
    offer.on_change(orders.append)
    offer.value = 0.7
    assert (handle.value, offer.value, orders) == (0.7, 0.7, [])
