"""Runs all measurements in order."""

from __future__ import annotations

from pathlib import Path

from lab.benchmarking import measure
from lab.benchmarking.batch import batch
from lab.benchmarking.layers import layers
from lab.benchmarking.resets import resets
from lab.benchmarking.substeps import softer, substeps
from slipgym.benchmarking import report


def with_bullet(env_id: str, pairs: int, json: Path | None = None) -> None:
    """Measure and print the environment with PyBullet against the bare loop, and the parts of its step.

    Args:
        env_id: Id of the environment.
        pairs: Pairs of timed blocks.
        json: File to write the figures to.
    """
    print(report.line(report.machine()))
    player = measure.Player(env_id)
    figures = [
        *measure.against_bare(player, pairs),
        *layers(player.env, measure.ACTIONS, pairs),
        *measure.breakdown(player, max(1, pairs // 3)),
    ]
    player.env.close()
    report.publish(figures, json)


def benchmark(env_id: str, pairs: int, json: Path | None = None) -> None:
    """Measure and print.

    Args:
        env_id: Id of the environment.
        pairs: Pairs of timed blocks of the comparison with the bare loop.
        json: File to write the figures to.
    """
    print(report.line(report.machine()))
    player = measure.Player(env_id)
    figures = [
        *measure.against_bare(player, pairs),
        *measure.breakdown(player, max(1, pairs // 3)),
        *substeps(player.rest(), max(3, pairs // 3)),
        *softer(env_id, max(3, pairs // 3)),
        *measure.life(env_id, max(3, pairs // 10)),
        *measure.distributed(player, env_id, max(3, pairs // 5)),
        *measure.options(player, env_id, max(3, pairs // 5)),
        *measure.contact(),
        *measure.patch(max(3, pairs)),
        *batch(player, env_id, max(3, pairs // 10)),
        *resets(env_id, max(3, pairs // 10)),
    ]
    player.env.close()
    report.publish(figures, json)
