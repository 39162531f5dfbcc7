"""Amplitude spectra and the deviation between two spectra (Eq. 3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .errors import InputError, brief, integer, number, numbers

__all__ = ["Spectrum", "amplitude_spectrum", "deviation_percent"]

BINS = 60
"""Number of spectral lines in Eq. 3."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """One-sided amplitude spectrum.

    Attributes
    ----------
    frequency : ndarray, shape (bins,)
        Hz; multiples of one over the record length, without zero.
    amplitude : ndarray, shape (bins,)
        In the unit of the signal.
    unit : str
        Unit of the amplitude.
    """

    __repr__ = brief

    frequency: np.ndarray
    amplitude: np.ndarray
    unit: str = "N"

    def to_frame(self):
        """Return a pandas DataFrame with one row a line."""
        import pandas as pd

        return pd.DataFrame(
            {"frequency (Hz)": self.frequency, f"amplitude ({self.unit})": self.amplitude}
        )

    @property
    def peak(self) -> tuple[float, float]:
        """Frequency (Hz) and amplitude of the largest line."""
        i = int(np.argmax(self.amplitude))
        return float(self.frequency[i]), float(self.amplitude[i])


def amplitude_spectrum(
    signal: np.ndarray, time_step: float, bins: int = BINS, unit: str = "N"
) -> Spectrum:
    """Return the one-sided amplitude spectrum of a record.

    Its mean is removed; no window function, no padding.

    ``A_w = 2 |rfft(F - mean)| / N``: a sine of amplitude 1 with a whole number of periods in the
    record gives one line of height 1.

    Parameters
    ----------
    signal : ndarray, shape (n,)
        Equally spaced samples.
    time_step : float
        s.
    bins : int
        Lines kept, from the first above zero (60 in Eq. 3).
    unit : str
        Unit of the signal.

    Raises
    ------
    InputError
        No samples, or one that is not finite; a step or a number of lines that is not positive.
    """
    signal = numbers("signal", signal)
    if len(signal) == 0:
        raise InputError("signal", None, "holds no samples")
    time_step = number("time_step", time_step, above=0.0, unit="s")
    bins = integer("bins", bins, least=1)
    lines = 2.0 * np.abs(np.fft.rfft(signal - signal.mean()))[1 : bins + 1] / len(signal)
    return Spectrum(np.arange(1, len(lines) + 1) / (len(signal) * time_step), lines, unit)


def deviation_percent(spectrum: Spectrum, reference: Spectrum) -> float:
    """Return how far one spectrum's root sum of squares lies above another's, in percent (Eq. 3).

    NaN where the reference is nothing but round-off beside the other, as on level track.

    Wrong when: the two records differ in length, since their lines are then different frequencies.
    """
    ours, theirs = (float(np.linalg.norm(s.amplitude)) for s in (spectrum, reference))
    return (ours / theirs - 1.0) * 100.0 if theirs > 1e-9 * ours else float("nan")
