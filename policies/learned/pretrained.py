"""Finds the pretrained policies that come with slipgym."""

import os
from pathlib import Path

from estimator.suggestions import unknown
from policies.learned.files import DESCRIPTION

FOLDER = Path(__file__).parent / "pretrained_policies"
"""One folder for each, called by its name."""


def folders() -> dict[str, Path]:
    """Their folders by name."""
    return {path.parent.name: path.parent for path in sorted(FOLDER.glob(f"*/{DESCRIPTION}"))}


def locate(which: str | os.PathLike[str]) -> Path:
    """The folder of a policy: by a name of `folders()`, or itself.

    Raises:
        FileNotFoundError: It is neither; the message lists the names.
    """
    folder = folders().get(os.fspath(which), Path(which))
    if not folder.exists():
        raise FileNotFoundError(unknown("no learned policy at", os.fspath(which), folders()))
    return folder
