"""What happens when a train crosses a railway bridge.

The ten lines everything else supports::

    import numpy as np
    import railbridge as rb

    train = rb.Train(rb.vehicle("xia2000"), cars=8, car_spacing=22.5)
    deck = rb.deck("viaduct36")
    track = rb.Track(vertical=rb.Harmonic(5e-3, wavelength=14.4))
    run = rb.cross(train, deck, track, speed=20.0)
    run.displacement(x=18.0).to_frame()

Everything is SI inside: m, kg, s, N. See the README for the conventions.

The modules beside this file are the spine: what a course reads, in the order of the paper. Every
folder is a room with a door, its ``__init__``; what stands in a room is loaded when it is first
asked for.
"""

from importlib import import_module as _import_module

from .beams import Beam, Bearing, Pier, PointMass
from .cautions import remarks
from .contacts import Rail, with_wheelsets
from .crossing import NotConvergedError, cross
from .damping import ModalDamping, rayleigh, rayleigh_ratio
from .decks import Deck, History
from .errors import InputError, InputWarning, ResultWarning
from .results import Crossing
from .spectra import Spectrum, amplitude_spectrum, deviation_percent
from .steady import steady_forces
from .tracks import FadeIn, Harmonic, Level, Notch, Rails, Table, Track
from .trains import CONDENSED, AxleTrain, Passage, Train
from .vehicles import AntiRollBar, Body, Spring, Vehicle

__version__ = "0.1.0"

_ROOMS = {
    "boxes": ("Box", "BoxMesh", "Pads"),
    "cases": (
        "Case", "SimpleBridge", "box", "car_parameters", "case", "data_root", "deck",
        "deck_from_table", "open_study", "planar_car", "speed_envelope", "sprung_mass", "summarize",
        "sweep", "track_record", "train", "train_list", "two_bogie_car", "varied_car", "vehicle",
    ),
    "checks": ("Assessment", "Requirements", "assess", "assess_run"),
    "codes": ("LoadModel", "hslm_b", "load_model"),
    "irregularities": (
        "Dip", "Joint", "RandomTrack", "TrackRecord", "TrackSpectrum", "Weld", "export_track",
        "spectrum",
    ),
    "lessons": ("check",),
    "studies": ("Ensemble", "RandomResponse", "random_response"),
    "validation": ("compared",),
}  # fmt: skip
"""Names that a room offers here, too."""
_MODULES = {
    "boxes": "boxes",
    "checks": "checks",
    "codes": "codes",
    "exchange": "exchange",
    "identification": "validation.identification",
    "irregularities": "irregularities",
    "lessons": "lessons",
    "panels": "panels",
    "paper": "validation.paper",
    "plots": "plots",
    "reports": "reports",
    "staggered": "exchange.staggered",
    "studies": "studies",
    "validation": "validation",
    "verification": "validation.verification",
}

__all__ = [
    "AntiRollBar", "Assessment", "AxleTrain", "Beam", "Bearing", "Body", "Box", "BoxMesh",
    "CONDENSED", "Case", "Crossing", "Deck", "Dip", "Ensemble", "FadeIn", "Harmonic", "History",
    "InputError", "InputWarning", "Joint", "Level", "LoadModel", "ModalDamping",
    "NotConvergedError", "Notch", "Pads", "Passage", "Pier", "PointMass", "Rail", "Rails",
    "RandomResponse", "RandomTrack", "Requirements", "ResultWarning", "SimpleBridge", "Spectrum",
    "Spring", "Table", "Track", "TrackRecord", "TrackSpectrum", "Train", "Vehicle", "Weld",
    "amplitude_spectrum", "assess", "assess_run", "box", "car_parameters", "case", "check",
    "compared", "cross", "data_root", "deck", "deck_from_table", "deviation_percent",
    "export_track", "hslm_b", "load_model", "open_study", "planar_car", "random_response",
    "rayleigh", "rayleigh_ratio", "remarks", "spectrum", "speed_envelope", "sprung_mass",
    "steady_forces", "summarize", "sweep", "track_record", "train", "train_list", "two_bogie_car",
    "varied_car", "vehicle", "with_wheelsets",
]  # fmt: skip


def __getattr__(name: str):
    """Open a room when something of it is first asked for."""
    if name in _MODULES:
        return _import_module(f".{_MODULES[name]}", __name__)
    for room, names in _ROOMS.items():
        if name in names:
            return getattr(_import_module(f".{room}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *_MODULES])
