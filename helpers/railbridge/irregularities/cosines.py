r"""Sums of cosines: value and slope in closed form, at any number of places."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .. import errors
from ..errors import InputError, brief, frozen

__all__ = ["Cosines"]

_EVEN = 1e-10
"""m by which places may differ from evenly spaced ones and still count as such."""
_TOGETHER = 2**21
"""Cosines that are taken at once where places are not evenly spaced."""
_MOST = 2**14
"""Places that are one product of matrices at once."""


@dataclass(frozen=True, eq=False)
class Cosines:
    """``r(x) = Re sum over k of A_k exp(i W_k x)``, an `Irregularity`.

    Attributes
    ----------
    wavenumbers : ndarray, shape (waves,)
        W, rad/m.
    amplitudes : ndarray, shape (waves,), complex
        A, m: size and phase of every wave.
    period : float
        m after which the track repeats itself.
    told : str
        What must be known of where it comes from, for the remarks of a crossing.
    """

    __repr__ = brief

    wavenumbers: np.ndarray
    amplitudes: np.ndarray
    period: float = np.inf
    told: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        waves = errors.numbers("wavenumbers", self.wavenumbers, above=0.0, unit="rad/m")
        amplitudes = np.array(self.amplitudes, dtype=complex)
        if amplitudes.shape != waves.shape or not np.isfinite(amplitudes).all():
            allowed = f"must hold {len(waves)} finite complex numbers, m"
            raise InputError("amplitudes", self.amplitudes, allowed)
        object.__setattr__(self, "wavenumbers", frozen(waves))
        object.__setattr__(self, "amplitudes", frozen(amplitudes))

    @property
    def shortest(self) -> float:
        """The shortest wave, m."""
        moving = self.wavenumbers[self.amplitudes != 0.0]
        return 2 * np.pi / float(moving.max()) if len(moving) else np.inf

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        return self._summed(x, self.amplitudes)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx."""
        return self._summed(x, 1j * self.wavenumbers * self.amplitudes)

    def _summed(self, x: np.ndarray, amplitudes: np.ndarray) -> np.ndarray:
        """Return Re sum A exp(i W x), in parts of a size that memory holds."""
        x = np.asarray(x, dtype=float)
        flat, result = x.ravel(), np.empty(x.size)
        for first in range(0, x.size, _MOST):
            some = slice(first, first + _MOST)
            result[some] = self._part(flat[some], amplitudes)
        return result.reshape(x.shape)

    def _part(self, x: np.ndarray, amplitudes: np.ndarray) -> np.ndarray:
        step = (x[-1] - x[0]) / max(len(x) - 1, 1)
        if np.abs(x - x[0] - step * np.arange(len(x))).max() <= _EVEN:
            return self._even(x[0], step, len(x), amplitudes)
        result = np.empty(len(x))
        together = max(_TOGETHER // len(self.wavenumbers), 1)
        for first in range(0, len(x), together):
            some = slice(first, first + together)
            turned = np.exp(1j * x[some, None] * self.wavenumbers)
            result[some] = turned.real @ amplitudes.real - turned.imag @ amplitudes.imag
        return result

    def _even(self, start: float, step: float, count: int, amplitudes: np.ndarray) -> np.ndarray:
        """Return the sum at evenly spaced places.

        With x = X + s, a coarse place and one of few steps from it, exp(i W x) is a product, and
        the sum over waves a product of matrices: cosines are taken at the two lists only.
        """
        inner = int(np.ceil(np.sqrt(count)))
        outer = -(-count // inner)
        coarse = start + step * inner * np.arange(outer)
        far = amplitudes * np.exp(1j * coarse[:, None] * self.wavenumbers)
        near = np.exp(1j * self.wavenumbers[:, None] * (step * np.arange(inner)))
        return (far.real @ near.real - far.imag @ near.imag).ravel()[:count]
