"""Finds out whether there is a screen for a window. Imports nothing heavy."""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec

_DISPLAYS = "DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"


def obstacle() -> str:
    """The reason why no window can open here; empty if one can.

    `SDL_VIDEODRIVER=dummy` counts as a screen: windows then open where nobody sees them.
    """
    if find_spec("pygame") is None:
        return "pygame is not installed: pip install 'slipgym[window]'"
    if sys.platform == "linux" and not any(map(os.environ.get, _DISPLAYS)):
        return "there is no screen: none of DISPLAY, WAYLAND_DISPLAY and SDL_VIDEODRIVER is set"
    return ""
