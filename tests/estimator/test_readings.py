"""Warnings about readings that look like faults of a sensor, and readings that do not."""

import re

import numpy as np
import pytest

from estimator import records
from estimator.records.alignment import align
from estimator.records.readings import reading_warnings


def lively(table):
    """The table with velocities that change from sample to sample, as measured ones do."""
    rng = np.random.default_rng(1)
    wave = 1.0 + 0.4 * np.sin(4.0 * table["t"])
    noise = 1.0 + 0.01 * rng.standard_normal(len(table))
    return table.assign(v_y=table["v_y"] * wave * noise, omega=table["omega"] * wave * noise)


def held(name, begin, end):
    """Repeats the reading at the begin until the end [s]."""

    def change(table):
        own = table[name].notna() & (table["t"] >= begin) & (table["t"] < end)
        return table.assign(**{name: table[name].mask(own, table.loc[own, name].iloc[0])})

    return change


def all_held(names, begin, end):
    def change(table):
        for name in names:
            table = held(name, begin, end)(table)
        return table

    return change


FORCES = ("f_x", "f_y", "f_n", "tau")
FAULTS = {
    "clipped force": (
        lambda t: t.assign(f_n=t["f_n"].clip(upper=5.3)),
        r"f_n has its largest value, 5\.3, in 3\d % of the samples: is that the end of the sensor's range\?",
    ),
    "clipped velocity": (
        lambda t: t.assign(v_y=-t["v_y"].clip(upper=0.026)),
        r"v_y has its smallest value, -0\.026, in .* range, or a held speed\?",
    ),
    "frozen force": (
        held("f_x", 0.7, 1.2),
        r"f_x does not change from 0\.70\d to 1\.[12]\d* s, while the other",
    ),
    "frozen sensor": (
        all_held(FORCES, 0.7, 1.2),
        r"the forces do not change from 0\.70?\d? to 1\.[12]\d* s, while the object slips",
    ),
    "frozen velocities": (
        all_held(("v_y", "omega"), 0.5, 0.9),
        r"the velocities do not change from 0\.5 to 0\.\d+ s, and are not zero: is the reading frozen\?",
    ),
    "one column twice": (lambda t: t.assign(f_x=t["f_y"]), r"f_x and f_y have the same values"),
    "deg/s": (
        lambda t: t.assign(omega=t["omega"] * 180 / np.pi),
        r"radius r of 1\.\d+ mm, .* is omega in deg/s\? `omega: \{unit: deg/s\}`",
    ),
    "rad/s as deg/s": (
        lambda t: t.assign(omega=t["omega"] * np.pi / 180, v_y=t["v_y"] * 4.0),
        r"more than a pad has: is omega too small",
    ),
}


def found(table, save):
    record = records.load(save(table))
    return reading_warnings(record, align(record))


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_named(table, save, fault):
    change, message = FAULTS[fault]
    (line,) = found(change(lively(table)), save)
    assert line.startswith("Warning: ")
    assert re.search(message, line), line


def stuck(table):
    still = table["t"] > 1.0
    zero = {name: table[name].mask(still & table[name].notna(), 0.0) for name in ("v_x", "v_y", "omega")}
    return table.assign(**zero)


def sampled_and_held(table):
    own = table["f_n"].notna()
    tenth = np.cumsum(own) % 10 == 1
    return table.assign(**{name: table[name].where(tenth | ~own).ffill().where(own) for name in FORCES})


HEALTHY = {
    "noise": lively,
    "steady": lambda t: t,
    "stick": lambda t: stuck(lively(t)),
    "coarse forces": lambda t: lively(t).assign(f_n=(t["f_n"] / 0.02).round() * 0.02),
    "coarse counts": lambda t: lively(t).assign(v_y=(lively(t)["v_y"] / 1e-3).round() * 1e-3),
    "sampled and held": lambda t: sampled_and_held(lively(t)),
    "no torque": lambda t: lively(t).assign(tau=t["tau"] * 0.0),
}


@pytest.mark.parametrize("case", HEALTHY)
def test_healthy_readings_pass(table, save, case):
    assert found(HEALTHY[case](table), save) == []


def test_the_report_has_them(table, save):
    turned = table.assign(omega=table["omega"] * 180 / np.pi)
    report = records.report(records.estimate(records.load(save(turned)), "rls"))
    assert "is omega in deg/s?" in report
    assert "Everything was observed" not in report
