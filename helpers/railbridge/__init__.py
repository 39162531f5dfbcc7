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
"""

from importlib import import_module as _import_module

from .beam import Beam, Bearing
from .box import Box, BoxMesh, Pads, box
from .case import Case, case
from .checks import compared
from .crossing import Crossing, NotConvergedError, cross
from .deck import Deck, History, rayleigh, rayleigh_ratio
from .decks import deck, deck_from_table
from .fleet import planar_car, sprung_mass, vehicle
from .inputs import InputError
from .spectra import Spectrum, amplitude_spectrum, deviation_percent
from .summary import summarize
from .track import Harmonic, Level, Notch, Rails, Table, Track
from .train import AxleTrain, Train, steady_forces
from .vehicle import Body, Spring, Vehicle

__version__ = "0.1.0"

__all__ = [
    "AxleTrain", "Beam", "Bearing", "Body", "Box", "BoxMesh", "Case", "Crossing", "Deck", "Harmonic", "History",
    "InputError", "Level", "NotConvergedError", "Notch", "Pads", "Rails", "Spectrum", "Spring", "Table", "Track", "Train",
    "Vehicle", "amplitude_spectrum", "box", "case", "compared", "cross", "deck", "deck_from_table", "deviation_percent",
    "planar_car", "rayleigh", "rayleigh_ratio", "sprung_mass", "steady_forces", "summarize", "vehicle",
]  # fmt: skip

_LAZY = ("identification", "panels", "paper", "plots", "staggered")


def __getattr__(name: str):
    """Load the floors that need matplotlib or widgets only when they are first used."""
    if name in _LAZY:
        return _import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *_LAZY])
