"""Shows policies at work: in a window, as a video, as a screenshot."""

from policies.play.video import VIDEO_TYPES, Video
from policies.play.watch import Outcome, watch

__all__ = ["VIDEO_TYPES", "Outcome", "Video", "watch"]
