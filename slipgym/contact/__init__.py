"""Friction between a pad and an object in planar slip."""

from slipgym.contact.distributed import DistributedContact
from slipgym.contact.ellipsoid import DiscContact, EllipsoidContact

__all__ = ["DiscContact", "DistributedContact", "EllipsoidContact"]
