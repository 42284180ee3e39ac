"""TensorBoard logs that go on after an interruption."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stable_baselines3.common.logger import KVWriter
from torch.utils.tensorboard import SummaryWriter


class TensorboardWriter(KVWriter):
    """Writes a learner's figures for TensorBoard.

    Args:
        folder: Where to.
        steps: Where the run goes on; what the logs have beyond is no longer shown.
    """

    def __init__(self, folder: Path, steps: int) -> None:
        self._writer = SummaryWriter(str(folder), purge_step=steps)

    def write(
        self, key_values: dict[str, Any], key_excluded: dict[str, tuple[str, ...]], step: int = 0
    ) -> None:
        """Writes the numbers among the values."""
        for name, value in key_values.items():
            if "tensorboard" not in (key_excluded[name] or ()) and isinstance(value, int | float):
                self._writer.add_scalar(name, value, step)
        self._writer.flush()

    def close(self) -> None:
        """Closes the file."""
        self._writer.close()
