"""Hinge on states made by hand."""

import math

import pytest

OPTIONS = {"turn": 0.8, "duration": 1.0, "settle": 0.5, "hold": 0.5}
END = 240


@pytest.mark.parametrize("direction", [-1, 1])
def test_the_script_turns_the_wrist_and_rests(hand, direction):
    state = hand("Hinge", **OPTIONS, direction=direction)
    turned = 0.0
    for step in range(END):
        state.episode["step"] = step
        state.task.script_wrist(state.episodes, state.worlds)
        before = state.world["wrist_velocity"][2]
        state.world["wrist_velocity"] += state.world["wrist_acceleration"] / 120.0
        turned += 0.5 * (before + state.world["wrist_velocity"][2]) / 120.0
        if step == 120:
            assert state.world["wrist_velocity"][2] == pytest.approx(direction * 1.0)
    assert turned == pytest.approx(direction * 0.8)
    assert state.world["wrist_velocity"][2] == pytest.approx(0.0, abs=1e-12)


def test_a_turn_faster_than_the_wrist_is_refused(hand):
    with pytest.raises(ValueError, match=r"2\.5 rad in duration = 1 s needs 3\.12 rad/s.*3 rad/s"):
        hand("Hinge", **{**OPTIONS, "turn": 2.5})


def test_terms_and_columns(hand):
    state = hand("Hinge", **OPTIONS, direction=-1, slide_tolerance=0.001, tilt_tolerance=0.1)
    motion = {"wrist": (0.0, 0.0, -0.4), "wrist_velocity": (0.0, 0.0, -1.0)}
    terms = state.evaluate(120, **motion, slip=(0.0006, -0.0008, 0.3), angle=-0.1)
    assert terms["still"] == pytest.approx(math.exp(-1.0))
    assert terms["upright"] == pytest.approx(math.exp(-1.0))
    assert state.columns[0].tolist() == pytest.approx([-0.4, -1.0, 0.0, -0.8, 1.0, 0.0])


@pytest.mark.parametrize(
    ("slid", "angle", "success"),
    [
        (0.0, 0.0, True),
        (0.0019, -0.087, True),
        (0.0021, 0.0, False),
        (0.0, 0.088, False),
        (0.0, -0.088, False),
    ],
)
def test_success_is_upright_and_in_place_throughout(hand, slid, angle, success):
    state = hand("Hinge", **OPTIONS)
    state.evaluate(100, slip=(0.0, -slid, 0.0), angle=angle)
    state.evaluate(END, slip=(0.0, 0.0, 0.0), angle=0.0)
    assert state.episode["success"] == success
