"""Moving pictures: vector drawings with a small player, in pages and notebooks."""

from .animation import Animation, animate_crossing, animate_vehicle_mode

__all__ = ["Animation", "animate_crossing", "animate_vehicle_mode"]
