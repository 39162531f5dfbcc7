"""What panels share: controls, the cases they start from, and words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..cases.definition import Case
from ..cases.definition import case as load_case
from .control import Control

__all__ = [
    "FREQUENCIES",
    "ITERATED",
    "ITERATIONS",
    "LOADS",
    "LONGEST",
    "RIGID",
    "SPEEDS",
    "SPEED_GRID",
    "Values",
    "amplitude_control",
    "cars_control",
    "conditions_in_words",
    "forcing_frequency",
    "iteration_control",
    "loads_control",
    "name_of_start",
    "speed_control",
    "starting_case",
    "wavelength_control",
]

ITERATIONS = 4
LOADS = {"condensed": "condensed loads", "bogies": "bogie loads", "wheels": "wheel loads"}

Values = Mapping[str, Any]

# ---- the controls, in their fixed order


SPEEDS = (5.0, 80.0)  # m/s, ends of the slider
LONGEST = 40.0  # m, end of the slider of wavelengths


def speed_control(ends: tuple[float, float] = SPEEDS) -> Control:
    """Return the control of the speed, m/s, with km/h beside it."""

    def in_km_h(v: float) -> str:
        return f"= {3.6 * v:.1f} km/h"

    return Control("speed", "speed (m/s)", ("run.speed",), *ends, 0.5, unit="m/s", aside=in_km_h)


def wavelength_control(longest: float = LONGEST) -> Control:
    """Return the control of the length of all waves, m, up to the longest."""
    paths = ("track.vertical.wavelength", "track.lateral.wavelength")
    return Control("wavelength", "wavelength (m)", paths, 3.0, longest, 0.1, unit="m")


def amplitude_control() -> Control:
    """Return the control of the vertical waves' amplitude."""
    paths = ("track.vertical.amplitude",)
    return Control("amplitude", "amplitude (mm)", paths, 0.0, 0.010, 0.0005, 1e3, "m")


SPEED_GRID = np.linspace(*SPEEDS, 151)  # m/s, half a metre a second apart
FREQUENCIES = (0.1, 40.0)  # Hz, around all that sliders of speed and wavelength can make


def cars_control() -> Control:
    """Return the control of the number of cars."""
    return Control("cars", "cars", ("train.cars",), 1, 16, 1)


def iteration_control() -> Control:
    """Return the control of the iteration that is shown."""
    return Control("iteration", "iteration", (), 0, ITERATIONS, 1, start=ITERATIONS)


def loads_control() -> Control:
    """Return the control of how wheel forces act on the deck."""
    return Control("loads", "loads", ("run.loads",), choices=tuple(LOADS))


# ---- the cases they start from

RIGID = {"run.interaction": "rigid", "run.iterations": None}
ITERATED = {"run.iterations": ITERATIONS}


def starting_case(case: Case | None, changes: Values) -> Case:
    """Return the given case, or the paper's, with changes.

    The paper's time step is left to be chosen, since it depends on speed and wavelength.
    """
    if case is None:
        case, changes = load_case("paper"), {"run.time_step": None, **changes}
    return case.replace(changes)


def name_of_start(case: Case | None) -> str:
    """Return what the legend calls the case that a panel starts from."""
    return "paper case" if case is None else "at the start"


# ---- words and numbers that several panels share


def conditions_in_words(values: Values) -> str:
    """Return speed, waves and cars as the beginning of a sentence."""
    v, waves = values["speed"], f"{values['wavelength']:.1f} m waves"
    if "amplitude" in values:
        waves += f" of {1e3 * values['amplitude']:.1f} mm"
    if "cars" in values:
        waves += f", {values['cars']} car{'s' if values['cars'] > 1 else ''}"
    return f"{v:.1f} m/s ({3.6 * v:.1f} km/h), {waves}: "


def forcing_frequency(values: Values) -> float:
    """Return the forcing frequency, Hz."""
    return values["speed"] / values["wavelength"]
