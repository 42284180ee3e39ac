"""Figures as part of a page: SVG that takes the page's colours and letters."""

from __future__ import annotations

import html
import io
import re
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

from policies.evaluation.plots.style import STYLE

_DRAWN: Any = {"svg.fonttype": "none", "svg.hashsalt": "slipgym"}
_VARIABLES = {
    STYLE.ink: "ink",
    STYLE.muted: "muted",
    STYLE.band: "band",
    **{colour: f"c{k}" for k, colour in enumerate(STYLE.palette)},
}
"""Colour -> variable of the page's style."""


def inline(figure: Figure, title: str) -> str:
    """A figure as an <svg> element.

    Args:
        figure: The figure; made within `styled()`.
        title: What those hear who do not see it.
    """
    buffer = io.StringIO()
    with rc_context(_DRAWN):
        figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
    svg = buffer.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r' id="(?![pm][0-9a-f]{10})[^"]*"', "", svg)
    for colour, name in _VARIABLES.items():
        svg = re.sub(colour, f"var(--{name})", svg, flags=re.IGNORECASE)
    head, _, rest = svg.partition(">")
    head = re.sub(r' (width|height)="[^"]*"', "", head)
    head = head.replace("<svg", f'<svg role="img" aria-label="{html.escape(title)}"', 1)
    return f"{head}>{rest}"
