"""Names the public sets of real contacts: where each lies, its licence, and the digest of every file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from estimator.suggestions import unknown


class Known(NamedTuple):
    """Size and digest that a file of a set must have."""

    sha256: str
    size: int
    """[bytes]."""


@dataclass(frozen=True)
class PublicSet:
    """A set of others, which stays under their licence."""

    name: str
    what: str
    repository: str
    """Owner and name on GitHub."""
    commit: str
    licence: str
    citation: str

    @property
    def url(self) -> str:
        """Address of the repository."""
        return f"https://github.com/{self.repository}"

    @cached_property
    def files(self) -> dict[str, Known]:
        """Path in the repository -> digest and size, of the files that are used, the licence first."""
        lines = Path(__file__).with_name(f"{self.name}.sha256").read_text(encoding="utf-8").splitlines()
        rows = (line.split(" ", 2) for line in lines)
        return {path: Known(sha256, int(size)) for sha256, size, path in rows}

    @property
    def size(self) -> int:
        """Of all its files [bytes]."""
        return sum(known.size for known in self.files.values())


SETS = {
    each.name: each
    for each in (
        PublicSet(
            "pushes",
            "quasi-static pushes of a block on known supports: wrench and pose",
            "robinzhoucmu/MLab_EXP",
            "4d86db9438203f51c4368e5b886def5c402955f3",
            "Apache-2.0",
            "J. Zhou, R. Paolini, J. A. Bagnell, M. T. Mason, A Convex Polynomial Force-Motion Model for "
            "Planar Sliding: Identification and Application, ICRA 2016",
        ),
        PublicSet(
            "silicone",
            "friction of two silicones on PLA by load, at one speed",
            "tolstoys19/Friction-Measurements-Between-PLA-and-Silicone",
            "b970d33f3c8c5eacfb93c61c2f5235ec11024a4b",
            "MIT",
            "P. E. Tortós-Vinocour et al., Development of a Dual Function Joint Modular Soft Actuator and "
            "its Evaluation using a Novel Dummy Finger Joint-Soft Actuator Complex Model, IEEE RA-L 2024, "
            "doi 10.1109/LRA.2024.3376975",
        ),
        PublicSet(
            "tugs",
            "137 grasps with magnetic pads, 103 of them tugged: field, one label a grasp",
            "notvenky/eFlesh",
            "ab5ca56a87df7cbf59264138998bf74efc216b13",
            "MIT",
            "V. Pattabiraman, Z. Huang, D. Panozzo, D. Zorin, L. Pinto, R. Bhirangi, eFlesh: Highly "
            "customizable Magnetic Touch Sensing using Cut-Cell Microstructures, arXiv 2506.09994, 2025",
        ),
    )
}
"""Name -> set."""


def find(name: str) -> PublicSet:
    """The set of a name.

    Raises:
        ValueError: There is none.
    """
    if name not in SETS:
        raise ValueError(unknown("unknown set", name, list(SETS)))
    return SETS[name]
