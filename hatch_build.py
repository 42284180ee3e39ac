"""Puts compiled programs into the wheel, if SLIPGYM_PROGRAMS names a folder of them.

`slipgym warmup --into` fills the folder; `make wheel` does both. Such a wheel is for one version of Python
and for Linux on x86-64.
"""

import os
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class ProgramsHook(BuildHookInterface):
    """Adds the programs and the tag of the platform."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called before the wheel is built.

        Raises:
            FileNotFoundError: The folder holds no programs.
        """
        programs = os.environ.get("SLIPGYM_PROGRAMS")
        if not programs or self.target_name != "wheel":
            return
        folder = Path(programs).resolve()
        if not (folder / "about.json").is_file():
            raise FileNotFoundError(
                f"SLIPGYM_PROGRAMS: {folder} holds no programs; slipgym warmup --into makes them"
            )
        for path in [folder / "about.json", *folder.rglob("*.nbc")]:
            build_data["force_include"][str(path)] = (
                f"estimator/_programs/{path.relative_to(folder).as_posix()}"
            )
        python = f"cp{sys.version_info.major}{sys.version_info.minor}"
        build_data.update(pure_python=False, tag=f"{python}-{python}-manylinux_2_17_x86_64")
