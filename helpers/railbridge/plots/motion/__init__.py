"""Moving pictures: vector drawings with a small player, in pages and notebooks."""

from .crossings import animate_crossing
from .modes import animate_vehicle_mode
from .player import Animation

__all__ = ["Animation", "animate_crossing", "animate_vehicle_mode"]
