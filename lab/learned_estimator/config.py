"""Defines the training of a network: episodes, their ranges, the optimisation."""

from __future__ import annotations

import os
from collections.abc import Mapping
from itertools import product
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, field_validator

from slipgym.config import files, load_randomization
from slipgym.config.base import Count, Frozen, Positive, as_tuple
from slipgym.config.pad import PadRanges
from slipgym.config.yaml_model import Choice, validate
from slipgym.tasks import find

OWN = Path(__file__).with_name("gru.yaml")
"""The training of the weights that come with the clone."""

Texts = Annotated[tuple[str, ...], Field(min_length=1), BeforeValidator(as_tuple)]
Sources = Annotated[
    tuple[Literal["true", "nominal", "estimated"], ...], Field(min_length=1), BeforeValidator(as_tuple)
]
Contacts = Annotated[tuple[Literal["ellipsoid", "disc", "distributed"], ...], BeforeValidator(as_tuple)]
Share = Annotated[float, Field(ge=0.0, le=1.0)]


class Training(Frozen):
    """Training of the network of "gru"; `lab.learned_estimator.cell` has the sizes of the network."""

    tasks: Texts = Field(description="Tasks whose episodes are recorded")
    friction_sources: Sources = Field(description="Friction that the tasks' controllers act on")
    contacts: Contacts = Field(min_length=1, description="Friction models of the pads")
    rigid_contacts: Contacts = Field(
        default=(), description="Friction models of further episodes, without the ranges of rubber"
    )
    sensors: str = Field(default="lab", description="Sensor preset")
    rows: Count = Field(description="Environments of each combination of task, source and contact [-]")
    steps: Count = Field(description="Control steps of each of them [-]")
    disturbed: Share = Field(default=0.5, description="Fraction of rows with disturbed or random actions [-]")
    unzeroed: Share = Field(default=0.3, description="Fraction of recordings that begin under load [-]")
    updates: Count = Field(description="Steps of the optimiser [-]")
    batch: Count = Field(default=48, description="Recordings of each [-]")
    learning_rate: Positive = Field(default=4e-3, description="Largest step size; it falls as a cosine [-]")
    held_out: Share = Field(default=0.04, description="Fraction of recordings for the curve [-]")
    randomization: Mapping[str, Any] = Field(description="Ranges of the episodes, as in a preset")

    @field_validator("tasks")
    @classmethod
    def _tasks(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(find(name).key for name in names)

    @field_validator("randomization")
    @classmethod
    def _ranges(cls, ranges: Mapping[str, Any]) -> Mapping[str, Any]:
        load_randomization(ranges)
        return ranges

    def episodes(self) -> list[dict[str, Any]]:
        """Arguments of the environments and the task, of every combination."""
        ranges = dict(self.randomization)
        rigid = {name: value for name, value in ranges.items() if name not in PadRanges.model_fields}
        pads = [(contact, ranges) for contact in self.contacts]
        pads += [(contact, rigid) for contact in self.rigid_contacts]
        return [
            {
                "task": task,
                "friction_source": source,
                "contact": contact,
                "randomization": chosen,
                "sensors": self.sensors,
            }
            for task, source, (contact, chosen) in product(self.tasks, self.friction_sources, pads)
        ]


def read(choice: Choice = OWN) -> Training:
    """Reads a training.

    Args:
        choice: The path of a YAML file, or a mapping of the same shape.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: A key is unknown or a value is not allowed.
    """
    if isinstance(choice, Mapping):
        return validate(choice, Training, "training of an estimator")
    return validate(files.read(Path(choice)), Training, os.fspath(choice))
