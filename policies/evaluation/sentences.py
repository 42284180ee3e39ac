"""The main result of a run in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

WORDS = {
    "estimated": "the estimated friction",
    "true": "the true one",
    "nominal": "nominal values, the same for every object",
    "none": "none",
}
"""Friction source -> how a sentence calls what the policy observes."""


def solved(policy: str, shares: Mapping[str, float]) -> str:
    """How often a policy succeeds by what it observes of the friction.

    Args:
        policy: Its title.
        shares: Friction source -> share of the trials that succeed.

    Returns:
        A sentence or two; empty unless there are several sources.
    """
    if len(shares) < 2:
        return ""
    parts = [f"{100.0 * share:.0f} % with {WORDS.get(source, source)}" for source, share in shares.items()]
    text = f"{policy} succeeds in {_listed(parts)}."
    if {"estimated", "true", "nominal"} <= set(shares):
        gain, whole = shares["estimated"] - shares["nominal"], shares["true"] - shares["nominal"]
        if whole >= 0.05:
            text += f" Of the {100.0 * whole:.0f} points that the truth adds to nominal values the estimate"
            text += f" recovers {100.0 * gain:.0f}."
        else:
            text += " Here it makes little difference which friction the policy observes."
    return text


def _listed(parts: Sequence[str]) -> str:
    return f"{', '.join(parts[:-1])} and {parts[-1]}"
