"""What real rails are off by: spectra as data, tracks drawn from them, measured records, faults."""

from .cosines import Cosines
from .formulas import COMPONENTS
from .reading import spectrum, spectrum_names
from .realisations import PAIRS, PERIOD, RandomTrack, phases
from .records import Loss, RecordedRail, TrackRecord, record_of
from .shapes import Dip, Joint, Weld
from .trackspectra import D1, D2, D3, GRADES, TrackSpectrum
from .writing import export_track

__all__ = [
    "COMPONENTS", "Cosines", "D1", "D2", "D3", "Dip", "GRADES", "Joint", "Loss", "PAIRS", "PERIOD",
    "RandomTrack", "RecordedRail", "TrackRecord", "TrackSpectrum", "Weld", "export_track",
    "phases", "record_of", "spectrum", "spectrum_names",
]  # fmt: skip
