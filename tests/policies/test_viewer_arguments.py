"""The viewer's arguments, the policies on offer, and values by hand in episodes that change by themselves."""

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from policies.commands.play import app
from policies.learned import pretrained
from policies.play import watch
from policies.play.viewer import Session, open_viewer
from policies.play.viewer.app import policies_for
from slipgym.tasks import find

from .test_viewer import DT, SHORT


def test_what_is_set_by_hand_stays_in_episodes_that_would_change_it():
    early = {"probability": 1.0, "time": {"uniform": [0.05, 0.1]}, "factor": {"uniform": [0.5, 0.6]}}
    own = {"disturbances": [{"kind": "friction_jump", **early}, {"kind": "mass_change", **early}]}
    session = Session("linear_slip", engine="planar", options=SHORT, randomization=own)
    session.submit("mu_c", 0.7)
    session.submit("mass", 0.3)
    for _ in range(3):
        for _ in range(30):
            session.advance(DT)
        assert session.info["true"][1] == pytest.approx(0.7)
        assert session.env.simulation.plant.world["mass"][0] == pytest.approx(0.3)
        session.restart()
    session.close()


def test_policies_on_offer_can_act_in_the_environment():
    hold, given, untold = find("hold"), {"engine": "planar"}, {"hold_lab", "hold_memory"}
    assert untold | {"hold", "hold_scratch"} <= set(policies_for(hold, given))
    assert not untold & set(policies_for(hold, {**given, "friction_source": "true"}))
    assert "hold" not in policies_for(hold, {**given, "estimator": None})


def test_a_policy_in_mid_session_acts_in_the_environment_of_its_training():
    session = Session("hold", engine="planar", options={"duration": 0.1})
    session.submit("latency", 3)
    session.submit("policy", "hold_lab")
    session.advance(DT)
    session.restart()
    assert not session.env.simulation.estimating
    slip = session.env.config.sensors.slip
    assert (slip.latency_samples, slip.scale_error) == (3, 0.05)
    session.close()


def test_a_policy_is_found_by_a_path_object(tmp_path):
    folder = pretrained.folders()["hold_scratch"]
    session = Session("hold", Path(folder), engine="planar")
    assert session.policy == str(folder)
    session.close()
    given = {"engine": "planar", "options": {"duration": 0.1}, "progress": False}
    assert len(watch("hold", Path(folder), tmp_path / "film.gif", **given)) == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--port", "99999"], "port = 99999 must lie in 0 to 65535"),
        (["--port=-1"], "port = -1 must lie in 0 to 65535"),
        (["--episodes", "2"], "leave out --episodes and --speed"),
        (["--speed", "0.5"], "leave out --episodes and --speed"),
    ],
)
def test_arguments_that_the_viewer_cannot_take_are_refused(monkeypatch, arguments, words):
    monkeypatch.setitem(sys.modules, "viser", SimpleNamespace())
    done = CliRunner().invoke(app, ["linear_slip", "--viewer", "--engine", "planar", *arguments])
    assert done.exit_code == 2
    assert words in " ".join(done.output.split())


def test_a_host_that_is_not_of_this_machine_is_refused(monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", SimpleNamespace())
    with pytest.raises(OSError, match="assign requested address"):
        open_viewer("linear_slip", engine="planar", host="192.0.2.1")
