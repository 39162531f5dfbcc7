"""Clauses of codes as functions.

Load trains and load models of EN 1991-2, wagons of EN 15528; dynamic factors, damping, limits and
ride, each with its clause and how well that is known; verdicts.
"""

from .catalogue import all_clauses, clauses_frame
from .clauses import Answer, CannotDecideError, Clause, Within
from .damping import (
    DAMPING,
    additional_damping,
    damping_limit,
    damping_lower_bound,
    damping_ratio,
)
from .dynamicfactors import (
    determinant_length,
    dynamic_effect,
    dynamic_effect_limit,
    phi2,
    phi3,
    phi_double_prime,
    phi_prime,
    real_train_factor,
    reduced_for_cover,
    track_factor,
)
from .frequencies import Bounds, frequency_from_deflection, n0_bounds
from .hslm import HSLM_A, hslm_a, hslm_b
from .influencelines import InfluenceLine, under_unit_load
from .limits import (
    KeptModes,
    acceleration_limit,
    comfort_limit,
    deflection_limit,
    frequency_limit,
    horizontal_radius_limit,
    horizontal_rotation_limit,
    kept_modes,
    lateral_frequency_limit,
    total_twist_limit,
    twist_limit,
    uplift_limit,
    wheel_unloading_limit,
)
from .loadmodels import ALPHAS, LOAD_MODELS, LoadModel, load_model
from .need import analysis_speeds, dynamic_analysis_needed
from .ride import (
    largest_running_rms,
    ride_class_limit,
    sperling,
    sperling_weighting,
    weighted,
    weighted_rms,
    weighting,
)
from .verdicts import Verdict, Verdicts, judge
from .wagons import LINE_CATEGORIES, wagon_train

__all__ = [
    "ALPHAS", "Answer", "Bounds", "CannotDecideError", "Clause", "DAMPING", "HSLM_A",
    "InfluenceLine", "KeptModes", "LINE_CATEGORIES", "LOAD_MODELS", "LoadModel", "Verdict",
    "Verdicts", "Within", "acceleration_limit", "additional_damping", "all_clauses",
    "analysis_speeds", "clauses_frame", "comfort_limit", "damping_limit", "damping_lower_bound",
    "damping_ratio", "deflection_limit", "determinant_length", "dynamic_analysis_needed",
    "dynamic_effect", "dynamic_effect_limit", "frequency_from_deflection", "frequency_limit",
    "horizontal_radius_limit", "horizontal_rotation_limit", "hslm_a", "hslm_b", "judge",
    "kept_modes", "largest_running_rms", "lateral_frequency_limit", "load_model", "n0_bounds",
    "phi2", "phi3", "phi_double_prime", "phi_prime", "real_train_factor", "reduced_for_cover",
    "ride_class_limit", "sperling", "sperling_weighting", "total_twist_limit", "track_factor",
    "twist_limit", "under_unit_load", "uplift_limit", "wagon_train", "weighted", "weighted_rms",
    "weighting", "wheel_unloading_limit",
]  # fmt: skip
