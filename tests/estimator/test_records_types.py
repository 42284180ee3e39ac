"""The type of a column decides what it is, and a unit is the one that is said."""

import decimal

import numpy as np
import pandas as pd
import pytest

from estimator import records

BEGIN = pd.Timestamp("2024-03-31 00:59:59.5", tz="UTC")  # before the clocks of Berlin jump


def stamps(table):
    return BEGIN + pd.to_timedelta((table["t"] * 1e6).round().astype("int64"), unit="us")


TIMES = {
    "us": lambda t: stamps(t).dt.tz_localize(None).astype("datetime64[us]"),
    "ns": lambda t: stamps(t).dt.tz_localize(None).astype("datetime64[ns]"),
    "zone": lambda t: stamps(t).dt.tz_convert("Europe/Berlin"),
    "Timestamps": lambda t: pd.Series(list(stamps(t)), dtype=object),
    "arrow": lambda t: stamps(t).astype("timestamp[us, tz=UTC][pyarrow]"),
    "durations": lambda t: stamps(t) - BEGIN,
    "arrow durations": lambda t: (stamps(t) - BEGIN).astype("duration[us][pyarrow]"),
    "categories": lambda t: stamps(t).astype("category"),
    "clock": lambda t: (stamps(t) + pd.Timedelta("9h")).dt.time,
}


@pytest.mark.parametrize("kind", TIMES)
@pytest.mark.parametrize("name", ["log.parquet", "log.csv"])
@pytest.mark.parametrize("unit", ["s", "ns"])
def test_dates_and_durations_have_their_own_unit(table, save, mapping, kind, name, unit):
    record = records.load(save(table.assign(t=TIMES[kind](table)), name), mapping(f"t: {{unit: {unit}}}"))
    plain = records.load(save(table, "plain.parquet"))
    for ours, theirs in ((record.force_t, plain.force_t), (record.twist_t, plain.twist_t)):
        np.testing.assert_allclose(ours - record.force_t[0], theirs - plain.force_t[0], atol=2e-6)


def test_milliseconds_are_read_as_such(table, save):
    forces = table.dropna(subset="f_n")
    stamped = forces.assign(t=stamps(forces).dt.tz_localize(None).astype("datetime64[ms]"))
    path = save(table.dropna(subset="omega").assign(t=lambda frame: stamps(frame)), "velocity.parquet")
    record = records.load(save(stamped, "log.parquet"), velocity=path)
    np.testing.assert_allclose(np.diff(record.force_t), 1e-3, atol=1e-6)


NUMBERS = {
    "texts": lambda cells: cells.map(repr, na_action="ignore"),
    "Float64": lambda cells: cells.astype("Float64"),
    "arrow": lambda cells: cells.astype("double[pyarrow]"),
    "categories": lambda cells: cells.astype("category"),
    "decimals": lambda cells: cells.round(6).map(lambda x: decimal.Decimal(repr(x)), na_action="ignore"),
}


@pytest.mark.parametrize("kind", NUMBERS)
def test_numbers_of_any_type(table, save, kind):
    table = table.assign(f_x=table["f_x"].round(6))
    record = records.load(save(table.assign(f_x=NUMBERS[kind](table["f_x"])), "log.parquet"))
    np.testing.assert_array_equal(record.wrench, records.load(save(table, "plain.parquet")).wrench)


def where(name, change):
    return lambda t: t.assign(**{name: change(t).where(t[name].notna())})


WRONG = {
    "booleans": (where("f_y", lambda t: (t["f_y"] > 1.4).astype("boolean")), "f_y is of type bool"),
    "booleans of a slip": (where("omega", lambda t: (t["omega"] > 0).astype("boolean")), "omega is of type"),
    "bytes": (where("f_n", lambda t: t["f_n"].map(lambda x: repr(x).encode())), "f_n is of type .*bytes"),
    "dates": (lambda t: t.assign(f_n=stamps(t)), "f_n is of type .*datetime64"),
    "durations": (lambda t: t.assign(v_x=stamps(t) - BEGIN), "v_x is of type .*timedelta"),
    "lists": (lambda t: t.assign(f_x=[[x] for x in t["f_x"]]), "f_x is of type"),
    "booleans of time": (lambda t: t.assign(t=t["t"] > 1), "t is of type bool"),
    "NaT": (lambda t: t.assign(t=stamps(t).where(t.index != 4)), "row 5: the time is missing"),
    "dates alone": (lambda t: t.assign(t=stamps(t).dt.date), "t is of type .*date"),
    "other dates": (
        lambda t: t.assign(t=stamps(t).dt.strftime("%d.%m.%Y %H:%M:%S.%f")),
        r"row 1: t = 31\.03\.2024 .* is neither a number, nor a time as 2024-",
    ),
    "commas": (
        where("f_x", lambda t: t["f_x"].astype(str).str.replace(".", ",")),
        "row 1: f_x = .*,.* is not",
    ),
    "counts in ns": (lambda t: t.assign(t=stamps(t).astype("int64")), r"is the time in (us|ns)\?"),
    "wrapped forces": (
        where("f_x", lambda t: (1e3 * t["f_x"]).round().mod(2**16).astype("UInt16")),
        r"row \d+: f_x = \d+ is where a counter of type UInt16 wraps",
    ),
    "wrapped time": (
        lambda t: t.assign(t=((t["t"] * 1e6).round() + 2**32 - 1e6).mod(2**32).astype("uint32")),
        "row 1080: t = 0 is where a counter of type uint32 wraps",
    ),
}


@pytest.mark.parametrize("kind", WRONG)
def test_what_is_no_number_is_refused(table, save, kind):
    change, message = WRONG[kind]
    with pytest.raises(ValueError, match=rf"log\.parquet: .*{message}"):
        records.load(save(change(table), "log.parquet"))


def test_words_of_truth_in_a_csv_are_refused(table, save):
    with pytest.raises(ValueError, match="f_y is of type"):
        records.load(save(where("f_y", lambda t: t["f_y"] > 1.4)(table)))


def test_a_mapping_made_by_hand_states_its_units(table, save):
    columns = records.Columns({"t": records.Column("time [ms]", "ms", 1e-3)})
    path = save(table.assign(t=1e3 * table["t"]).rename(columns={"t": "time [ms]"}), "log.parquet")
    plain = records.load(save(table, "plain.parquet"))
    np.testing.assert_allclose(records.load(path, columns).force_t, plain.force_t, rtol=1e-12)


def test_seconds_that_are_unusual_are_read_once_they_are_stated(table, save, mapping):
    slow = table[table["f_n"].notna()].assign(t=lambda frame: 400 * frame["t"], v_x=0.0, v_y=0.0, omega=0.0)
    path = save(slow)
    with pytest.raises(ValueError, match=r"`t: \{unit: s\}`"):
        records.load(path)
    assert records.load(path, mapping("t: {unit: s}")).force_t[0] == 0.4
