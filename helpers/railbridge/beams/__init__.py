"""Beams in three dimensions on bearings: one way to make a `Deck`."""

from .beam import Beam
from .bearings import Bearing

__all__ = ["Beam", "Bearing"]
