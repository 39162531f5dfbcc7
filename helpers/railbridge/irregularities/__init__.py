"""Irregularities of real tracks: their spectra as data with sources."""

from .formulas import COMPONENTS
from .reading import spectrum, spectrum_names
from .trackspectra import D1, D2, D3, GRADES, TrackSpectrum

__all__ = ["COMPONENTS", "D1", "D2", "D3", "GRADES", "TrackSpectrum", "spectrum", "spectrum_names"]
