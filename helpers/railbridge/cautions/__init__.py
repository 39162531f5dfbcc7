"""What is said beside numbers: input unlikely to be meant, results not to be trusted."""

from .bounds import BOUNDS, doubt, frequency_off, material, soft_bearing, usual_frequencies
from .notices import ends_move, remarks, remarks_before, unsettled
from .plausibility import (
    UNUSUAL,
    damping_constants,
    damping_frequencies,
    doubts,
    first_vertical,
    longest_span,
    scale_in_doubt,
)
from .tracksindoubt import parts_of

__all__ = [
    "BOUNDS", "UNUSUAL", "damping_constants", "damping_frequencies", "doubt", "doubts",
    "ends_move", "first_vertical", "frequency_off", "longest_span", "material", "parts_of",
    "remarks", "remarks_before", "scale_in_doubt", "soft_bearing", "unsettled",
    "usual_frequencies",
]  # fmt: skip
