"""Writes what a log shows: gripper.yaml, report.md and its picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from slipgym.config import load
from slipgym.contact.pressure import OUTER_RADII
from slipgym.identification.fit import FAR, IMPLAUSIBLE, Result
from slipgym.identification.motions import gains
from slipgym.identification.parameters import DEVIATION, NAMES, PARAMETERS, START, values_of
from slipgym.identification.rollout import CHANNELS

MATERIAL = "identified"
"""Name of the material in gripper.yaml."""
UNITS = ("N", "N", "N", "N m", "m/s", "m/s", "rad/s")


def overrides(result: Result) -> dict[str, Any]:
    """Overrides of the configuration that the environments take as they are."""
    of = dict(zip(NAMES, values_of(result.point).tolist(), strict=True))
    values: dict[str, Any] = {}
    for each in PARAMETERS:
        if each.key:
            *groups, last = each.key.split(".")
            place = values
            for group in groups:
                place = place.setdefault(group, {})
            place[last] = of[each.name]
    defaults = load()
    values["gripper"]["force_gain"] = [of["force gain"]] * 2
    values["gripper"]["pad_radius"] = max(defaults.gripper.pad_radius, OUTER_RADII[result.pressure] * of["r"])
    values["contact"]["model"] = result.contact
    if result.contact == "distributed":
        values["contact"]["pressure"] = result.pressure
    values["contact"]["cop_offset"] = [[of["cop x"], of["cop y"]]] * 2
    mu_s = of["mu_c"] * (1.0 + of["static excess"])
    values["materials"] = {MATERIAL: {"mu_c": of["mu_c"], "mu_s": min(mu_s, 10.0)}}
    values["nominal"] = {**values["materials"][MATERIAL], "r": of["r"]}
    wrench = values["sensors"]["force_torque"]
    wrench["latency_spread"] = 0.0
    for axes, name in (((0, 1), "tangential"), ((2,), "normal"), ((3,), "torque")):
        wrench[f"noise_{name}"] = float(np.sqrt(np.mean(result.noise[list(axes)] ** 2)))
        # the environments draw zero errors anew for each episode: as large as the ones found
        zeros = [of[f"zero {CHANNELS[a]}"] for a in axes]
        wrench[f"bias_{name}"] = float(np.sqrt(np.mean(np.square(zeros))))
    slip = defaults.sensors.slip
    if result.shown[NAMES.index("slip latency")]:
        values["sensors"]["slip"] = {
            "latency_samples": round(of["slip latency"] * slip.rate),
            "latency_spread": 0,
            # the mean over the chips is what the log's velocities show
            "noise": float(np.mean(result.noise[4:6]) / (slip.count * slip.rate) * math.sqrt(slip.chips)),
        }
    return values


def table(result: Result) -> str:
    """The parameters with their 90 % intervals, as Markdown."""
    lines = ["| parameter | value | 90 % interval | |", "|---|---|---|---|"]
    values, interval, implausible = values_of(result.point), result.interval(), result.implausible()
    for each, v, (low, high), shown in zip(PARAMETERS, values, interval, result.shown, strict=True):
        note = "" if shown else "this log does not show it: the prior"
        if each.name in implausible:
            note = f"far from the prior {each.prior:g}"
        lines.append(f"| {each.name} [{each.unit}] | {v:.4g} | {low:.4g} to {high:.4g} | {note} |")
    return "\n".join(lines)


def verdict(result: Result) -> str:
    """Whether the model fits the log, and which values are those of no gripper, in a few sentences."""
    implausible = _implausible(result)
    if misfits := result.misfits():
        far = ", ".join(f"{name} {ratio:.1f}" for name, ratio in misfits.items())
        doubt = (
            f"The model does not fit this log: held-out residuals over the noise are {far}. "
            "Trust neither the parameters nor their intervals."
        )
        return f"{doubt} Values of no usual gripper: {implausible}" if implausible else doubt
    if implausible:
        return f"The model fits this log only with values of no usual gripper: {implausible}"
    return f"The model fits this log: every held-out residual is within {FAR:g} times the noise."


def _implausible(result: Result) -> str:
    """Names the values that are far from their priors, and of what they are a sign; empty if none is."""
    values, away = dict(zip(NAMES, values_of(result.point), strict=True)), result.implausible()
    ends = values_of(START + IMPLAUSIBLE * DEVIATION * np.array([[-1.0], [1.0]])).T
    lines = []
    for each, (low, high) in zip(PARAMETERS, ends, strict=True):
        if each.name in away:
            unit = "" if each.unit == "-" else f" {each.unit}"
            lines.append(
                f"{each.name} = {values[each.name]:.4g}{unit}, {away[each.name]:.1f} deviations from the "
                f"prior {each.prior:g}{unit} ({IMPLAUSIBLE:g} are {low:.2g} to {high:.2g}{unit})"
            )
    advice = (
        "Is a unit, a sign, a zero or a column of the log wrong? Correct the mapping, and identify again."
    )
    return f"{'; '.join(lines)}. {advice}" if lines else ""


def summary(result: Result) -> str:
    """The report, as Markdown."""
    fit = ["| reading | noise | held-out residual | over the noise |", "|---|---|---|---|"]
    for name, noise, held in zip(CHANNELS, result.noise, result.held_out, strict=True):
        if not np.isnan(noise):
            fit.append(f"| {name} | {noise:.3g} | {held:.3g} | {held / noise:.2f} |")
    pressed = f" with {result.pressure} pressure" if result.contact == "distributed" else ""
    ranked = gains(result)
    motions = ["| motion, 20 s | sum of what deviations shrink by [%] | most for |", "|---|---|---|"]
    motions += [f"| {name} | {100 * total:.0f} | {most} |" for name, total, most in ranked]
    return (
        f"# Identified gripper\n\n**{verdict(result)}**\n\n{table(result)}\n\n"
        f"Friction model: {result.contact}{pressed}. "
        "A deviation above half of the prior's counts as not shown.\n\n"
        f"## Held-out part\n\nEvery fourth second, which the fit has not seen.\n\n" + "\n".join(fit) + "\n\n"
        "![log and simulation](report.png)\n\n"
        f"## Record next\n\n20 s of **{ranked[0][0]}**.\n\n" + "\n".join(motions) + "\n"
    )


def write(result: Result, folder: Path) -> None:
    """Writes gripper.yaml, report.md and report.png into a folder that exists."""
    import yaml

    values = overrides(result)
    load(values)  # what the environments would refuse must not be written
    text = '# Written by slipgym identify: gym.make(..., config="gripper.yaml", material="identified")\n'
    text += f"# {verdict(result)}\n"
    (folder / "gripper.yaml").write_text(text + yaml.safe_dump(values, sort_keys=False), encoding="utf-8")
    (folder / "report.md").write_text(summary(result), encoding="utf-8")
    draw(result, folder / "report.png")


def draw(result: Result, path: Path) -> None:
    """Writes the picture, a row per reading."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    present = np.flatnonzero(~np.isnan(result.noise))
    t = np.arange(len(result.log.command)) / result.log.rate
    figure = Figure(figsize=(11, 1.7 * len(present)), layout="constrained")
    FigureCanvasAgg(figure)
    rows = figure.subplots(len(present), 1, sharex=True, squeeze=False)[:, 0]
    for axes, k in zip(rows, present, strict=True):
        there = np.isfinite(result.log.readings[:, k])
        axes.plot(t[there], result.log.readings[there, k], color="0.6", lw=2.0, label="log")
        axes.plot(t, result.before[:, k], color="tab:blue", lw=0.7, label="before")
        axes.plot(t, result.after[:, k], color="tab:red", lw=0.7, label="after")
        axes.set_ylabel(f"{CHANNELS[k]} [{UNITS[k]}]")
    rows[0].legend(ncols=3, loc="upper right")
    rows[-1].set_xlabel("time [s]")
    figure.savefig(path, dpi=90)
