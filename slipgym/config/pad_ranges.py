"""Distributions of what the pads' rubber adds, for the randomization."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from slipgym.config.base import Frozen
from slipgym.config.distribution import Distribution, within

LEAST = 0.25
"""Smallest `radius_exponent` with `friction_by_area`: the largest `load_exponent` belongs to it."""


class PadRanges(Frozen):
    """Distributions of fields of `slipgym.config.pad.PadConfig`; both pads have the same values.

    Friction in proportion to the contact's area (Schallamach, Proc. Phys. Soc. B 65, 1952) ties two of them:
    mu f_n grows as r^2, so that load_exponent = 1 - 2 radius_exponent; Hertz has 1/3 for both.
    """

    load_exponent: Annotated[Distribution | None, within(-0.4, 0.5)] = Field(
        default=None, description="Exponent with which friction falls with the normal force; it may rise"
    )
    radius_exponent: Annotated[Distribution | None, within(0.0, 1.0 / 3.0)] = Field(
        default=None, description="Exponent with which the contact radius grows with the normal force"
    )
    cop_lever: Annotated[Distribution | None, within(0.0, 0.02)] = Field(
        default=None, description="Shift of the centre of pressure over tangential by normal force [m]"
    )
    shear_compliance: Annotated[Distribution | None, within(0.0, 1e-3)] = Field(
        default=None, description="Tangential compliance of a pad [m/N]"
    )
    creep: Annotated[Distribution | None, within(0.0, 0.9)] = Field(
        default=None, description="Fraction of the shear stiffness that relaxes"
    )
    aging: Annotated[Distribution | None, within(0.0, 0.5)] = Field(
        default=None, description="Growth of mu_s - mu_c with the logarithm of the dwell time"
    )
    anisotropy: Annotated[Distribution | None, within(-0.49, 0.49)] = Field(
        default=None, description="Relative difference of the friction along the pad's x from the mean"
    )
    friction_by_area: bool | None = Field(
        default=None, description="Whether load_exponent is 1 - 2 radius_exponent instead of free"
    )

    @model_validator(mode="after")
    def _exponents_are_told_once(self) -> Self:
        radius = self.radius_exponent
        if self.friction_by_area and self.load_exponent is not None:
            raise ValueError("load_exponent and friction_by_area exclude each other")
        if self.friction_by_area and (radius is None or radius.ends[0] < LEAST):
            raise ValueError(f"friction_by_area needs a radius_exponent from {LEAST:g} to 0.333333")
        return self
