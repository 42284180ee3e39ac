"""Configuration models of what a pad of rubber adds to its friction, and of its distributions."""

from typing import Annotated

from pydantic import Field

from slipgym.config.base import Frozen, number
from slipgym.config.distribution import Drawn, Ranged, ranged

LEAST = 0.25
"""Smallest `radius_exponent` with `friction_by_area`: the largest `load_exponent` belongs to it."""


class PadRanges(Ranged):
    """Distributions of fields of `PadConfig`; both pads have the same values.

    Friction in proportion to the contact's area (Schallamach, Proc. Phys. Soc. B 65, 1952) ties two of them:
    mu f_n grows as r^2, so that load_exponent = 1 - 2 radius_exponent; Hertz has 1/3 for both.
    """

    load_exponent: Drawn = ranged(
        -0.4, 0.5, "Exponent with which friction falls with the normal force; it may rise"
    )
    radius_exponent: Drawn = ranged(
        0.0, 1.0 / 3.0, "Exponent with which the contact radius grows with the normal force"
    )
    cop_lever: Drawn = ranged(
        0.0, 0.02, "Shift of the centre of pressure over tangential by normal force [m]"
    )
    shear_compliance: Drawn = ranged(0.0, 1e-3, "Tangential compliance of a pad [m/N]")
    creep: Drawn = ranged(0.0, 0.9, "Fraction of the shear stiffness that relaxes")
    aging: Drawn = ranged(0.0, 0.5, "Growth of mu_s - mu_c with the logarithm of the dwell time")
    anisotropy: Drawn = ranged(
        -0.49, 0.49, "Relative difference of the friction along the pad's x from the mean"
    )
    friction_by_area: bool | None = Field(
        default=None, description="Whether load_exponent is 1 - 2 radius_exponent instead of free"
    )


class PadConfig(Frozen):
    """Load dependence, shear, creep, age and anisotropy of both pads: `slipgym.contact.soft_pad`.

    The defaults switch each of them off: the pad is rigid, and its friction is Coulomb's.
    """

    reference_force: float = number(
        0.01, 1000.0, "Normal force at which the friction coefficients and the radius r hold [N]"
    )
    load_exponent: float = number(
        -0.4,
        0.5,
        "Friction falls with the normal force to the power of this, and rises where it is "
        "negative; two silicones on PLA -0.23 to 0.38 [-]",
    )
    radius_exponent: float = number(
        0.0, 1.0 / 3.0, "Contact radius r grows with the normal force to the power of this; Hertz 1/3 [-]"
    )
    cop_lever: float = number(
        0.0, 0.02, "Shift of the centre of pressure over tangential by normal force, at most 20 mm [m]"
    )
    shear_compliance: float = number(
        0.0, 1e-3, "Tangential compliance of a pad; 0 is rigid, 5e-5 is 20 N/mm, at most 1 N/mm [m/N]"
    )
    shear_time: float = number(0.0, 0.1, "Damping of the shear over its stiffness [s]")
    creep: float = number(0.0, 0.9, "Fraction of the shear stiffness that relaxes [-]")
    creep_time: float = number(0.01, 1e3, "Time constant of that relaxation [s]")
    aging: float = number(0.0, 0.5, "Growth of mu_s - mu_c with the logarithm of the dwell time [-]")
    aging_time: float = number(1e-6, 1e6, "Dwell time at which that growth begins [s]")
    aging_distance: float = number(1e-6, 1e-2, "Slip after which it is lost [m]")
    anisotropy: Annotated[float, Field(gt=-0.5, lt=0.5)] = Field(
        description="Friction along the pad's x is larger by this fraction, along y smaller [-]"
    )

    @property
    def hard(self) -> bool:
        """Whether each effect is switched off."""
        return not any(getattr(self, name) for name in EFFECTS)


EFFECTS = tuple(name for name in PadRanges.model_fields if name in PadConfig.model_fields)
"""Fields of `PadConfig` that switch an effect off when they are 0: those that can be randomized."""
