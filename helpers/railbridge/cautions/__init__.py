"""What is said beside numbers: input unlikely to be meant, results not to be trusted."""

from .bounds import BOUNDS, doubt, frequency_off, material, soft_bearing, usual_frequencies
from .notices import (
    SETTLED,
    ends_move,
    left_open,
    remarks,
    remarks_before,
    transient,
    unsettled,
)
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
    "BOUNDS", "SETTLED", "UNUSUAL", "damping_constants", "damping_frequencies", "doubt", "doubts",
    "ends_move", "first_vertical", "frequency_off", "left_open", "longest_span", "material",
    "parts_of", "remarks", "remarks_before", "scale_in_doubt", "soft_bearing", "transient",
    "unsettled", "usual_frequencies",
]  # fmt: skip
