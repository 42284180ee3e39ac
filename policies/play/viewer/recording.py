"""Records the environment's pictures into MP4 files while the viewer runs."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from policies.play.video import Video


class Recording:
    """One video after the other, each with the plots of `slipgym.rendering` beside the view.

    Args:
        path: The first video, MP4 or GIF; later ones get a number.

    Attributes:
        paths: Videos that are complete.
        running: Whether a video is being made.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._path, self._due = Path(path), 0.0
        self._video = Video(path)
        self.paths: list[Path] = []
        self.running = False

    def begin(self) -> None:
        """Begin a video.

        Raises:
            OSError: The folder cannot be written.
            ModuleNotFoundError: The extra "eval" is missing.
        """
        number = len(self.paths) + 1
        name = self._path.name if number == 1 else f"{self._path.stem}_{number}{self._path.suffix}"
        self._file = self._path.with_name(name)
        self._video = Video(self._file).__enter__()
        self._due, self.running = 0.0, True

    def add(self, env: Any, seconds: float) -> None:
        """Append the pictures for a stretch of watching time [s], at the video's rate."""
        self._due += seconds * self._video.rate
        if self._due < 1.0:
            return
        picture = env.render()
        while self._due >= 1.0:
            self._due -= 1.0
            self._video.add(picture)

    def end(self) -> Path | None:
        """Complete the video; its path, or None if there is none."""
        if not self.running:
            return None
        self.running = False
        self._video.__exit__(None, None, None)
        self.paths.append(self._file)
        return self._file
