"""One function per figure: a result and optional axes in, the axes out. Nothing is computed here.

Without axes a function makes a figure of notebook width. It never shows it and changes no settings,
so figures can be composed: give the axes of ``plt.subplots``. Those that move, the four that begin
with ``animate_``, return an `Animation` instead, and `diagram` returns a drawing of its own.
Colours and units are those of `style.QUANTITY_STYLES`: kN, kN m and mm.
``plt.style.use(rb.plots.STYLE)`` gives a notebook's own drawings the same colours.
"""

from .along import deck_envelope
from .carbodies import car_body
from .deck import damping, deck_mode, deck_modes, influence_line
from .diagrams import diagram
from .envelopes import envelope
from .forces import car_forces, spectra, spectrum, wheel_force, wheel_forces
from .maps import map
from .motion import (
    animate_car_on_waves,
    animate_crossing,
    animate_rigid_and_flexible,
    animate_vehicle_mode,
)
from .randomtracks import extremes, random_response, track_spectra, wave_shares
from .response import (
    acceleration,
    convergence,
    deviations,
    displacement,
    iterations,
    load_modes,
    reactions,
    section_force,
    velocity,
)
from .scene import train_on_deck
from .shells import assurance, box_section, shell_mode, shell_modes
from .sketches import vehicle, vehicle_mode
from .style import STYLE as STYLE
from .track import frequencies, irregularity, notch, slope, wheel_paths, wheels_on_track
from .verdictbars import utilisation

__all__ = [
    "acceleration", "animate_car_on_waves", "animate_crossing", "animate_rigid_and_flexible",
    "animate_vehicle_mode", "assurance", "box_section", "car_body", "car_forces", "convergence",
    "damping", "deck_envelope", "deck_mode", "deck_modes", "deviations", "diagram", "displacement",
    "envelope", "extremes", "frequencies", "influence_line", "irregularity", "iterations",
    "load_modes", "map", "notch", "random_response", "reactions", "section_force", "shell_mode",
    "shell_modes", "slope", "spectra", "spectrum", "track_spectra", "train_on_deck", "utilisation",
    "vehicle", "vehicle_mode", "velocity", "wave_shares", "wheel_force", "wheel_forces",
    "wheel_paths", "wheels_on_track",
]  # fmt: skip
