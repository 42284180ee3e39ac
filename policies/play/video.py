"""Writes videos, MP4 or GIF: one, or one after the other while the viewer runs."""

from __future__ import annotations

import os
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from slipgym.atomic_io import new_file
from slipgym.config.errors import unknown
from slipgym.rendering import palette

_SIGNS = palette.INK, palette.MUTED, palette.SLIP, palette.GRIP_2, palette.MU_C, palette.MU_S


class _Mp4:
    """H.264, one frame at a time to ffmpeg."""

    def __init__(self, path: Path, rate: int) -> None:
        from imageio_ffmpeg import write_frames

        made = {"fps": rate, "codec": "libx264", "quality": 7, "macro_block_size": 2}
        self._begin = partial(write_frames, str(path), **made)
        self._frames: Any = None

    def add(self, picture: np.ndarray) -> None:
        if self._frames is None:
            self._frames = self._begin(picture.shape[1::-1])
            self._frames.send(None)
        self._frames.send(np.ascontiguousarray(picture))

    def finish(self) -> None:
        if self._frames is not None:
            self._frames.close()


class Gif:
    """Frames reduced to the first one's colours and the plots', the same for all: what rests stays still."""

    def __init__(self, path: Path, rate: int) -> None:
        self._path, self._rate = path, rate
        self._frames: list[Image.Image] = []
        self._colours = Image.new("P", (1, 1))

    def add(self, picture: np.ndarray) -> None:
        """Append a frame (height, width, 3) uint8."""
        image = Image.fromarray(picture)
        if not self._frames:
            signs = [channel for sign in _SIGNS for channel in sign]
            signs += [(channel + 255) // 2 for channel in signs]  # and their edges
            most = image.quantize(256 - len(signs) // 3).getpalette() or []
            self._colours.putpalette(most[: 768 - len(signs)] + signs)
        self._frames.append(image.quantize(palette=self._colours, dither=Image.Dither.NONE))

    def finish(self) -> None:
        """Write the file."""
        if self._frames:
            first, *rest = self._frames
            shown: dict[str, Any] = {"duration": 1000 // self._rate, "loop": 0, "disposal": 1}
            first.save(self._path, save_all=True, append_images=rest, **shown)


VIDEO_TYPES: dict[str, tuple[type[_Mp4 | Gif], int]] = {".mp4": (_Mp4, 30), ".gif": (Gif, 25)}
"""File type -> writer and frames per second; a GIF counts time in hundredths of a second."""


class Video:
    """A video that appears at its path when it is complete, or not at all.

    Use it in a `with` statement; an error inside leaves nothing behind.

    Args:
        path: Where it shall appear; its type is in its name.

    Raises:
        ValueError: The type is unknown.
        OSError: The folder cannot be written.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._path = Path(path)
        kind = self._path.suffix.lower()
        if kind not in VIDEO_TYPES:
            raise ValueError(unknown("type of video", kind, VIDEO_TYPES))
        self._make, self.rate = VIDEO_TYPES[kind]

    def __enter__(self) -> Video:
        with ExitStack() as stack:
            self._writer = self._make(stack.enter_context(new_file(self._path)), self.rate)
            self._stack = stack.pop_all()
        return self

    def add(self, picture: np.ndarray) -> None:
        """Appends a picture (height, width, 3) uint8, of the size of the first."""
        self._writer.add(picture)

    def __exit__(self, *error: Any) -> bool | None:
        self._stack.callback(self._writer.finish)  # before the file takes its place
        return self._stack.__exit__(*error)


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
