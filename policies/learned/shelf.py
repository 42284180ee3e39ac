"""The learned policies that come with slipgym."""

from pathlib import Path

from policies.learned.files import DESCRIPTION

SHELF = Path(__file__).parent / "shipped"
"""One folder for each, called by its name."""


def shipped() -> dict[str, Path]:
    """Their folders by name."""
    return {path.parent.name: path.parent for path in sorted(SHELF.glob(f"*/{DESCRIPTION}"))}
