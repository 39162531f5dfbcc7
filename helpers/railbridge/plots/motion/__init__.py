"""Moving pictures: vector drawings with a small player, in pages and notebooks."""

from .crossings import animate_crossing
from .modes import animate_vehicle_mode
from .player import Animation
from .riding import animate_car_on_waves, animate_rigid_and_flexible

__all__ = [
    "Animation", "animate_car_on_waves", "animate_crossing", "animate_rigid_and_flexible",
    "animate_vehicle_mode",
]  # fmt: skip
