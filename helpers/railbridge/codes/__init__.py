"""Clauses of codes as functions: load trains and load models of EN 1991-2, wagons of EN 15528."""

from .hslm import HSLM_A, hslm_a, hslm_b
from .loadmodels import LOAD_MODELS, LoadModel, load_model
from .wagons import LINE_CATEGORIES, wagon_train

__all__ = [
    "HSLM_A", "LINE_CATEGORIES", "LOAD_MODELS", "LoadModel", "hslm_a", "hslm_b", "load_model",
    "wagon_train",
]  # fmt: skip
