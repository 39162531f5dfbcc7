"""Measured tracks on an even grid, and within a band of wavelengths."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ..errors import InputError

__all__ = ["LEAST_PER_WAVE", "band_limited", "even", "refuse_few"]

LEAST_PER_WAVE = 4
"""Samples in the shortest wave of the band: the slope of a cubic spline is then within 5 %."""
_ROLL_OFF = 0.5
"""Octaves outside of the band over which the gain falls from one to zero."""
_EVEN = 1e-6
"""Share of the spacing by which places of an even grid may be off."""


def refuse_few(place: np.ndarray) -> None:
    """Refuse fewer samples than a cubic spline needs."""
    if len(place) < 4:
        raise InputError("rows", len(place), "must be at least four samples")


def even(place: np.ndarray, columns: dict[str, np.ndarray]) -> tuple[float, float, dict]:
    """Return the first place and the spacing (m) of an even grid, and the columns on it.

    Places that are even already are kept. Others are met by cubic splines through all samples, at
    the median of their spacing.

    Parameters
    ----------
    place : ndarray, shape (n,)
        Ascending, m.
    columns : dict of ndarray, shape (n,)

    Raises
    ------
    InputError
        Fewer than four samples.
    """
    refuse_few(place)
    step = (place[-1] - place[0]) / (len(place) - 1)
    grid = place[0] + step * np.arange(len(place))
    if np.max(np.abs(place - grid)) <= _EVEN * step:
        return float(place[0]), float(step), dict(columns)
    step = float(np.median(np.diff(place)))
    grid = place[0] + step * np.arange(int((place[-1] - place[0]) / step + _EVEN) + 1)
    found = {name: CubicSpline(place, r)(grid) for name, r in columns.items()}
    return float(place[0]), step, found


def band_limited(r: np.ndarray, step: float, band: tuple[float, float]) -> np.ndarray:
    """Return what is left of a record within a band of wavelengths, without a shift of phase.

    The gain is real: one within the band, zero half an octave outside of it, a half-cosine over the
    logarithm of the wavelength between. Mean and straight line are taken out first, and what lies
    beyond the ends is taken for zero. Within one of the longest waves from an end the result
    depends on that guess: of random track it is off by about 0.4 of its standard deviation over the
    first 50 m, by 0.06 in the middle of 600 m, where the rest of the record decides.

    Parameters
    ----------
    r : ndarray, shape (n,)
        On an even grid.
    step : float
        Its spacing, m.
    band : (float, float)
        Shortest and longest wavelength, m.

    Returns
    -------
    ndarray, shape (n,)
    """
    along = np.arange(len(r)) - (len(r) - 1) / 2
    r = r - np.polyval(np.polyfit(along, r, 1), along)
    count = 2 ** int(np.ceil(np.log2(len(r) + 4 * band[1] / step)))
    kept = np.fft.rfft(r, count) * _gain(np.fft.rfftfreq(count, step), band)
    return np.fft.irfft(kept, count)[: len(r)]


def _gain(per_metre: np.ndarray, band: tuple[float, float]) -> np.ndarray:
    octave = np.log2(np.maximum(per_metre, 1e-12))
    first, last = np.log2(1.0 / band[1]), np.log2(1.0 / band[0])
    outside = np.maximum(np.maximum(first - octave, octave - last), 0.0)
    return 0.5 + 0.5 * np.cos(np.pi * np.minimum(outside / _ROLL_OFF, 1.0))
