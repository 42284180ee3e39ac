"""Warns about final values that are not plausible for a fingertip."""

from __future__ import annotations

from estimator.records.run import Result

FRICTION = (0.05, 3.0)
"""Plausible friction coefficients [-], from lubricated steel to silicone rubber on glass."""
RADIUS = (0.001, 0.05)
"""Plausible radii of the equivalent rim contact of a fingertip or pad [m]."""


def warnings(result: Result) -> list[str]:
    """A line for each final value that was estimated from data and is not plausible for a fingertip.

    Friction coefficients are expected within 0.05 to 3, mu_s above mu_c, and r within 1 to 50 mm and between
    the bounds `r_min` and `r_max` of the estimator, where it has them.
    """
    last, lines = result.estimates[-1], []
    seen = {name: float(last[name]) for name in ("mu_s", "mu_c", "r") if last[f"confidence_{name}"] > 0.0}
    for name in ("mu_s", "mu_c"):
        if name in seen and not FRICTION[0] <= seen[name] <= FRICTION[1]:
            lines.append(
                f"Warning: {name} = {seen[name]:.3g} is implausible, outside {FRICTION[0]:g} to "
                f"{FRICTION[1]:g}: check units and columns, or use another estimator."
            )
    if "mu_s" in seen and seen["mu_s"] <= last["mu_c"]:
        lines.append(
            f"Warning: mu_s is not above mu_c = {last['mu_c']:.3g}: the stick-slip events show no more than "
            "Coulomb friction. Do not rely on mu_s."
        )
    lines += [*_radius_warnings(result, seen), *_viscosity_warnings(result)]
    return lines


def _viscosity_warnings(result: Result) -> list[str]:
    errors = () if result.calibration is None else result.calibration.errors
    return [
        f"Warning: sigma_2 = {error.value:.3g} s/m: friction falls as the speed rises, which is no "
        "viscosity: check the signs of the velocities and the zeros of the forces."
        for error in errors
        if error.name == "sigma_2" and error.seen and error.value < -2.0 * error.sd
    ]


def _radius_warnings(result: Result, seen: dict[str, float]) -> list[str]:
    if "r" not in seen:
        return []
    r, what = seen["r"], f"Warning: r = {1e3 * seen['r']:.3g} mm"
    smallest, largest = (getattr(result.parameters, name, None) for name in ("r_min", "r_max"))
    if largest is not None and r >= largest:
        return [f"{what} is at its upper bound r_max: is the pad larger, or is the CoP wrong?"]
    if smallest is not None and r <= smallest:
        return [f"{what} is at its lower bound r_min: check omega and tau."]
    if not RADIUS[0] <= r <= RADIUS[1]:
        return [
            f"{what} is implausible, outside {1e3 * RADIUS[0]:g} to {1e3 * RADIUS[1]:g} mm: "
            "check units and columns, or use another estimator."
        ]
    return []
