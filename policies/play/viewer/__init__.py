"""Shows a live environment in a browser, with sliders; needs the extra "viewer"."""

from policies.play.viewer.app import Viewer, open_viewer
from policies.play.viewer.session import Session

__all__ = ["Session", "Viewer", "open_viewer"]
