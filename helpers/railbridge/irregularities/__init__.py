"""What the rails are off by: spectra as data, tracks drawn from them, measured records."""

from .cosines import Cosines
from .families import COMPONENTS, TrackSpectrum, spectrum
from .realisations import RandomTrack

__all__ = ["COMPONENTS", "Cosines", "RandomTrack", "TrackSpectrum", "spectrum"]
