"""The unit of a time that nothing states, and times that do not go on."""

import numpy as np
import pytest

from estimator import records
from estimator.records import proposal
from estimator.records.alignment import align
from estimator.records.readings import reading_warnings


def log(step, count, start=0.0, every=1, **columns):
    """A record of constant slip whose velocities have every `every`-th row."""
    t = start + step * np.arange(count)
    wave = np.sin(np.arange(count))
    found = {"t": t, "f_x": 1.0 + 0.1 * wave, "f_y": 0.1 * wave, "f_n": 4.0 + 0.1 * wave, "tau": 1e-3 * wave}
    held = np.arange(count) % every == 0
    found |= {name: np.where(held, 1e-2 + 1e-3 * wave, np.nan) for name in ("v_x", "v_y", "omega")}
    return found | columns


def doubts(given, columns=None):
    record = records.from_arrays(given, None, columns)
    lines = reading_warnings(record, align(record, allow_gaps=True))
    return [line for line in lines if "unit of t is not stated" in line]


def test_ten_hertz_of_minutes_may_be_ten_kilohertz(mapping):
    """10 Hz for five minutes or, in ms, 10 kHz for 0.3 s: nothing decides."""
    (line,) = doubts(log(0.1, 3001))
    assert "in s the forces have 10 Hz for 300 s, in ms the forces have 10000 Hz for 0.3 s" in line
    assert "`t: {unit: s}` or `t: {unit: ms}`" in line
    for stated in ("t: {unit: s}", "t: {scale: 0.9}"):
        assert doubts(log(0.1, 3001), mapping(stated)) == []


def test_a_record_of_hours_is_one_in_milliseconds(mapping):
    """10 kHz for 6.5 s; in seconds it would be 10 Hz for 1.8 hours."""
    long = log(0.1, 65_001)
    with pytest.raises(ValueError, match=r"arrays: .* in ms the forces have 10000 Hz for 6\.5 s; .*ms\}`"):
        records.from_arrays(long)
    assert doubts(long, mapping("t: {unit: ms}")) == doubts(long, mapping("t: {unit: s}")) == []


@pytest.mark.parametrize(
    "clear",
    [
        log(0.1, 300),  # 30 s; 30 ms are no record
        log(0.04, 2000),
        log(1 / 30, 3001),  # in ms it had 30 kHz
        log(0.1, 3001, start=1.7e9),  # seconds since 1970
        log(0.001, 400_000, every=50),  # velocities of 20 Hz on the clock of forces of 1 kHz
    ],
    ids=["short", "25 Hz", "30 Hz", "since 1970", "two rates"],
)
def test_what_decides_the_unit_needs_no_warning(clear):
    assert doubts(clear) == []


def test_milliseconds_since_1970_are_asked_for():
    with pytest.raises(ValueError, match="in ms the forces have 16000 Hz"):
        records.from_arrays(log(0.0625, 3001, start=1.7e12))


def test_rows_in_reverse_order_are_no_counter_that_wraps(mapping):
    turned = {name: values[::-1] for name, values in log(0.001, 300).items()}
    with pytest.raises(ValueError, match=r"row 2: .* time runs backwards throughout: sort .*sign: -1") as why:
        records.from_arrays(turned)
    assert "wraps" not in str(why.value)
    down = records.from_arrays(turned, None, mapping("t: {sign: -1}"))
    assert np.ptp(down.force_t) == pytest.approx(0.299)


@pytest.mark.parametrize(("count", "unit"), [(300, "'s'"), (3001, "'s'"), (65_001, "'ms'")])
def test_the_proposal_is_the_likely_unit(save, count, unit):
    pandas = pytest.importorskip("pandas")
    path = save(pandas.DataFrame(log(0.1, count)).round(4))
    line = proposal.text_of_fingers(proposal.propose_fingers(path)[0]).splitlines()[1]
    assert line.startswith(f"t: {{column: 't', unit: {unit}}}")
    assert line.endswith("; 10000 Hz if it is in ms") == (count == 3001)
