"""Damping of a deck: one ratio, Rayleigh's two constants, or a ratio for each mode."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from . import errors
from .errors import InputError, Range, check_fields

__all__ = [
    "ALPHA", "BETA", "RATIO", "Damping", "ModalDamping", "checked_damping", "damping_ratios",
    "rayleigh", "rayleigh_ratio", "viscosity",
]  # fmt: skip

RATIO = Range(least=0.0, most=0.5)
"""What a damping ratio may be, share of critical."""
ALPHA, BETA = Range(least=0.0, unit="1/s"), Range(least=0.0, unit="s")
"""What the two constants of Rayleigh damping may be."""


@dataclass(frozen=True)
class ModalDamping:
    """A damping ratio of its own for each mode.

    Nothing is known of where it acts, so sections and bearings carry none of its forces.

    Attributes
    ----------
    ratios : tuple of float
        Shares of critical of a deck's first modes, in the order of their frequencies; the last one
        holds for all higher modes, too.

    Raises
    ------
    InputError
        No ratio, or one that is not within 0 and 0.5.
    """

    ratios: Annotated[tuple[float, ...], RATIO]

    def __post_init__(self) -> None:
        check_fields(self)
        if not self.ratios:
            raise InputError("ratios", [], "must hold at least one ratio")

    def of_modes(self, count: int) -> np.ndarray:
        """Return the ratios of so many modes, shape (count,)."""
        return np.array([*self.ratios, *self.ratios[-1:] * count])[:count]


Damping = ModalDamping | Sequence[float] | float
"""One ratio for every mode; (alpha, beta) of Rayleigh, 1/s and s; or a ratio for each mode."""


def rayleigh(ratio: float, frequencies_hz: Sequence[float]) -> tuple[float, float]:
    """Return alpha (1/s) and beta (s) that give one damping ratio at two frequencies (Hz).

    ``zeta = alpha / (2 omega) + beta omega / 2``; Section 2.4 of the paper asks 3 % at modes 1 and
    5.
    """
    ratio = RATIO.checked("ratio", ratio)
    f1, f2 = errors.numbers("frequencies_hz", frequencies_hz, count=2, above=0.0, unit="Hz")
    if f1 == f2:
        raise InputError(
            "frequencies_hz", list(frequencies_hz), "must be two different frequencies"
        )
    w1, w2 = 2 * np.pi * f1, 2 * np.pi * f2
    return float(2 * ratio * w1 * w2 / (w1 + w2)), float(2 * ratio / (w1 + w2))


def rayleigh_ratio(alpha: float, beta: float, frequencies_hz: np.ndarray) -> np.ndarray:
    """Return the damping ratio at each frequency (Hz)."""
    alpha, beta = ALPHA.checked("alpha", alpha), BETA.checked("beta", beta)
    checked = errors.number if np.ndim(frequencies_hz) == 0 else errors.numbers
    omega = 2 * np.pi * checked("frequencies_hz", frequencies_hz, above=0.0, unit="Hz")
    return alpha / (2 * omega) + beta * omega / 2


def checked_damping(damping: Damping) -> Damping:
    """Return a damping, refused where it is none of the kinds that `Damping` has."""
    if isinstance(damping, ModalDamping):
        return damping
    if np.isscalar(damping):
        return errors.number("damping", damping, least=0.0)
    return errors.numbers("damping", damping, count=2, least=0.0)


def damping_ratios(damping: Damping, frequencies_hz: np.ndarray) -> np.ndarray:
    """Return the damping ratio of each mode, of ascending frequencies."""
    if isinstance(damping, ModalDamping):
        return damping.of_modes(len(frequencies_hz))
    if np.isscalar(damping):
        return np.full(len(frequencies_hz), damping)
    return rayleigh_ratio(*damping, frequencies_hz)


def viscosity(damping: Damping) -> float:
    """Return beta of Rayleigh damping, s, what sections and bearings carry; 0 of ratios."""
    known = not isinstance(damping, ModalDamping) and not np.isscalar(damping)
    return float(damping[1]) if known else 0.0
