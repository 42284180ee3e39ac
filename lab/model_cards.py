"""Writes the model card of a learned policy that comes with slipgym: what it reads, learned from, solves."""

from __future__ import annotations

import re
from pathlib import Path

from policies.learned import LearnedPolicy, pretrained

RESULT = Path(__file__).resolve().parents[1] / "docs" / "results" / "learned.txt"
"""Printed by `slipgym cards`; a card takes its figures from here."""
CARD = """\
---
license: mit
library_name: slipgym
tags: [reinforcement-learning, robotics, gymnasium, slipgym]
---

# {name}

A policy of `{where.id}`, level "{arguments[level]}": `policies.make("{name}")`.

- **Reads**: {columns} numbers at {where.rate:g} Hz (`policy.json` lists them), friction
  "{arguments[friction_source]}", sensors "{arguments[sensors]}", randomization "{arguments[randomization]}".
- **Acts**: {actions}, mode "{arguments[action_mode]}".
- **Network**: {network.kind}, hidden layers {layers}; it needs only numpy to act.
- **Learned**: {origin.algorithm}, {steps:.1f} million steps, seed {seeds}, slipgym
  {origin.versions[slipgym]}: `{origin.command}`
- **Limits**: a simulation's policy. It was tried in the worlds below and on no robot.

## Solved [%]

{solved}
"""


def solved(name: str, text: str) -> str:
    """A policy's row of the printed results, as Markdown with commit and date.

    Args:
        name: The policy.
        text: Content of docs/results/learned.txt.
    """
    printed = re.search(r"^printed: (.+)$", text, re.MULTILINE)
    rows = [
        [cell.strip() for cell in line.strip("| ").split("|")]
        for line in text.splitlines()
        if line[:1] == "|"
    ]
    own = [row for row in rows[2:] if row[0] == name]
    if not own or printed is None:
        return "Not printed yet: `slipgym cards` in a clone prints it."
    lines = [f"| {world} | {share} |" for world, share in list(zip(rows[0], own[0], strict=True))[4:]]
    return f"`slipgym cards`, {printed[1]}:\n\n| world | |\n|---|---:|\n" + "\n".join(lines)


def card(name: str) -> str:
    """The card of a policy as Markdown, with the head that the Hugging Face Hub reads.

    Args:
        name: A policy that comes with slipgym.

    Raises:
        FileNotFoundError: There is no policy of the name.
    """
    description = LearnedPolicy(pretrained.locate(name)).description
    where, origin = description.environment, description.origin
    return CARD.format(
        name=name,
        where=where,
        arguments=where.arguments,
        columns=where.width,
        actions=", ".join(column.name for column in where.action),
        network=description.network,
        layers=", ".join(map(str, description.network.layers)),
        origin=origin,
        steps=1e-6 * origin.steps,
        seeds=", ".join(map(str, origin.seeds)),
        solved=solved(name, RESULT.read_text(encoding="utf-8")),
    )
