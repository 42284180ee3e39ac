"""Configuration model of what a pad of rubber adds to its friction."""

from typing import Annotated

from pydantic import Field

from slipgym.config.base import Frozen
from slipgym.config.pad_ranges import PadRanges


class PadConfig(Frozen):
    """Load dependence, shear, creep, age and anisotropy of both pads: `slipgym.contact.soft_pad`.

    The defaults switch each of them off: the pad is rigid, and its friction is Coulomb's.
    """

    reference_force: Annotated[float, Field(ge=0.01, le=1000.0)] = Field(
        description="Normal force at which the friction coefficients and the radius r hold [N]"
    )
    load_exponent: Annotated[float, Field(ge=-0.4, le=0.5)] = Field(
        description="Friction falls with the normal force to the power of this, and rises where it is "
        "negative; two silicones on PLA -0.23 to 0.38 [-]"
    )
    radius_exponent: Annotated[float, Field(ge=0.0, le=1.0 / 3.0)] = Field(
        description="Contact radius r grows with the normal force to the power of this; Hertz 1/3 [-]"
    )
    cop_lever: Annotated[float, Field(ge=0.0, le=0.02)] = Field(
        description="Shift of the centre of pressure over tangential by normal force, at most 20 mm [m]"
    )
    shear_compliance: Annotated[float, Field(ge=0.0, le=1e-3)] = Field(
        description="Tangential compliance of a pad; 0 is rigid, 5e-5 is 20 N/mm, at most 1 N/mm [m/N]"
    )
    shear_time: Annotated[float, Field(ge=0.0, le=0.1)] = Field(
        description="Damping of the shear over its stiffness [s]"
    )
    creep: Annotated[float, Field(ge=0.0, le=0.9)] = Field(
        description="Fraction of the shear stiffness that relaxes [-]"
    )
    creep_time: Annotated[float, Field(ge=0.01, le=1e3)] = Field(
        description="Time constant of that relaxation [s]"
    )
    aging: Annotated[float, Field(ge=0.0, le=0.5)] = Field(
        description="Growth of mu_s - mu_c with the logarithm of the dwell time [-]"
    )
    aging_time: Annotated[float, Field(ge=1e-6, le=1e6)] = Field(
        description="Dwell time at which that growth begins [s]"
    )
    aging_distance: Annotated[float, Field(ge=1e-6, le=1e-2)] = Field(
        description="Slip after which it is lost [m]"
    )
    anisotropy: Annotated[float, Field(gt=-0.5, lt=0.5)] = Field(
        description="Friction along the pad's x is larger by this fraction, along y smaller [-]"
    )

    @property
    def hard(self) -> bool:
        """Whether each effect is switched off."""
        return not any(getattr(self, name) for name in EFFECTS)


EFFECTS = tuple(name for name in PadRanges.model_fields if name in PadConfig.model_fields)
"""Fields of `PadConfig` that switch an effect off when they are 0: those that can be randomized."""
