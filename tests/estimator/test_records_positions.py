"""Sensors that count displacement, and scales and offsets of a mapping."""

import numpy as np
import pytest

from estimator import records

COUNT = 7.94e-6  # [m]


def counted(table, rate=120.0):
    """Displacements instead of velocities: whole counts of a chip, and an angle in degrees that wraps."""
    twists = table["omega"].notna()
    t = table.loc[twists, "t"]
    y = np.floor(0.02 * t / COUNT)
    angle = np.degrees(table.loc[twists, "omega"] * t)
    return table.drop(columns=["v_x", "v_y", "omega"]).assign(
        x=(0.0 * t).reindex(table.index),
        y=y.reindex(table.index),
        angle=((angle + 180.0) % 360.0 - 180.0).reindex(table.index),
    )


MAPPING = f"""
v_x: {{position: x, unit: m, scale: {COUNT}}}
v_y: {{position: y, scale: {COUNT}}}
omega: {{position: angle, unit: deg}}
"""


def test_a_velocity_is_the_difference_over_the_time_before_it(table, mapping):
    turned = table.assign(omega=table["omega"] * 4)
    record = records.from_arrays(counted(turned), None, mapping(MAPPING))
    plain = records.from_arrays(turned)
    np.testing.assert_array_equal(record.twist_t, plain.twist_t[1:])
    np.testing.assert_allclose(record.twist[:, 1], 0.02, atol=1.01 * COUNT * 120)
    assert (np.diff(np.round(record.twist[:, 1] * np.diff(plain.twist_t) / COUNT, 6)) % 1 == 0).all()
    assert record.twist[:, 1].mean() == pytest.approx(0.02, rel=1e-3)
    np.testing.assert_allclose(record.twist[:, 2], plain.twist[1:, 2], rtol=1e-6)
    assert (record.twist[:, 0] == 0.0).all()


def test_nothing_is_differentiated_across_a_gap(table, mapping):
    cut = counted(table).loc[(table["t"] < 0.8) | (table["t"] > 1.2)]
    jump = cut.assign(y=cut["y"] + 1e4 * (cut["t"] > 1.0))  # the sensor was lifted
    record = records.from_arrays(jump, None, mapping(MAPPING))
    assert record.twist[:, 1].max() < 0.03
    assert len(record.twist_t) == cut["y"].notna().sum() - 2


def test_positions_that_a_log_holds_are_differentiated_between_samples(table, mapping):
    """Held in 1000 rows a second, 120 positions a second would be spikes of speed between zeros."""
    rng = np.random.default_rng(1)
    t = np.arange(1, 4001) / 1000
    speed = 0.02 + 0.005 * np.sin(3.0 * np.arange(481)) + 0.002 * rng.standard_normal(481)
    y = np.cumsum(speed / 120)
    now = np.floor(t * 120).astype(int)
    held = {"t": t, "f_x": 0 * t, "f_y": 2 + 0 * t, "f_n": 5 + np.sin(t), "tau": 0.01 * t}
    held |= {"x": 0 * t, "y": y[now], "angle": 0 * t}
    record = records.from_arrays(held, None, mapping(MAPPING.replace(str(COUNT), "1")))
    assert record.hold == pytest.approx(1 / 120, rel=0.01)
    assert record.twist[:, 1].min() > 0.005
    assert record.twist[:, 1].max() < 0.04


def test_a_position_without_motion_is_a_velocity_of_zero(table, mapping):
    still = counted(table.assign(omega=table["omega"] * 0.0)).assign(y=lambda frame: frame["x"] + 7.0)
    assert (records.from_arrays(still, None, mapping(MAPPING)).twist == 0.0).all()


def test_scale_and_offset(table, mapping):
    raw = table.assign(f_n=(table["f_n"] - 3.0) * 100.0, t=table["t"] * 1e3)
    columns = mapping("f_n: {scale: 10, unit: mN, offset: 3000}\nt: {unit: ms, offset: 500}")
    record, plain = records.from_arrays(raw, None, columns), records.from_arrays(table)
    np.testing.assert_allclose(record.wrench[:, 2], plain.wrench[:, 2], rtol=1e-12)
    np.testing.assert_allclose(record.force_t, plain.force_t + 0.5, rtol=1e-12)


def test_velocities_may_have_a_clock_of_their_own_in_one_file(table, mapping):
    late = mapping("velocity_t: {column: t, offset: -0.05}")
    record, plain = records.from_arrays(table, None, late), records.from_arrays(table)
    np.testing.assert_allclose(record.twist_t, plain.twist_t - 0.05, rtol=1e-12)
    np.testing.assert_array_equal(record.force_t, plain.force_t)


def test_the_unit_of_a_position_may_be_in_its_name(table, mapping):
    text = MAPPING.replace(
        "v_y: {position: y, scale: 7.94e-06}", "v_y: {position: 'y [mm]', scale: 7.94e-03}"
    )
    frame = counted(table).rename(columns={"y": "y [mm]"})
    expected = records.from_arrays(counted(table), None, mapping(MAPPING)).twist
    np.testing.assert_allclose(records.from_arrays(frame, None, mapping(text)).twist, expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("f_n: {position: Fz}", r"f_n: a position is of one of v_x, v_y, omega"),
        ("v_x: {position: x, column: x}", r"v_x: a position .* takes the place of a column"),
        ("v_x: {position: x, unit: mm/s}", r"v_x: unknown unit 'mm/s'; .*valid: m, mm, cm, um"),
        ("omega: {position: a, unit: rad/s}", r"omega: unknown unit 'rad/s'; did you mean 'rad'\?"),
        ("f_n: {scale: 0}", r"f_n: scale = 0 must be a positive number"),
        ("f_n: {scale: -1}", r"f_n: scale = -1 must be a positive number"),
        ("f_n: {scale: .nan}", r"f_n: scale = nan must be a positive number"),
        ("f_n: {scale: true}", r"f_n: scale = True must be a positive number"),
        ("f_n: {offset: .inf}", r"f_n: offset = inf must be a number"),
        ("f_n: {offset: five}", r"f_n: offset = 'five' must be a number"),
        ("fingers: [left]", r"fingers: .* must be names of fingers, each with its own columns"),
        ("fingers: {left: Fz1}", r"mapping\.yaml: left: must be a mapping of names to columns"),
        ("fingers: {left: {f_N: Fz1}}", r"mapping\.yaml: left: unknown key 'f_N'; did you mean 'f_n'\?"),
        ("fingers: {../left: {f_n: Fz1}}", r"fingers: .* must be names of fingers"),
    ],
)
def test_what_a_mapping_cannot_say(mapping, text, message):
    with pytest.raises(ValueError, match=message):
        mapping(text)
