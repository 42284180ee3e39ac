"""Distributions of what the pads' rubber adds, for the randomization."""

from typing import Annotated

from pydantic import Field

from slipgym.config.base import Frozen
from slipgym.config.distribution import Distribution, within


class PadRanges(Frozen):
    """Distributions of fields of `slipgym.config.pad.PadConfig`; both pads have the same values."""

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
