"""Steady limit surfaces of pads: friction as a function of the twist of a slip."""

from estimator.limit_surface.disc import DISC_RADIUS, disc_friction, slip_friction

__all__ = ["DISC_RADIUS", "disc_friction", "slip_friction"]
