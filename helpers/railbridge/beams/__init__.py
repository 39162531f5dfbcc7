"""Beams in three dimensions on bearings: one way to make a `Deck`."""

from .beam import Beam
from .bearings import FIXITIES, Bearing, on_deck
from .mesh import BeamModes
from .piers import Pier
from .pointmasses import PointMass
from .properties import BeamProperties, Section, checked_spans, span_ends

__all__ = [
    "FIXITIES", "Beam", "BeamModes", "BeamProperties", "Bearing", "Pier", "PointMass", "Section",
    "checked_spans", "on_deck", "span_ends",
]  # fmt: skip
