"""The paper's case, what is varied in it, and 64 ways to read what the paper leaves open."""

from __future__ import annotations

import itertools
from functools import cache
from typing import Any

import numpy as np

from .. import errors
from ..cases.definition import Case, case
from ..results import Crossing

__all__ = ["NOTCH", "READING", "SCENARIOS", "readings", "run", "scenario"]

READING = {
    "run.excitation": "car",
    "run.feedback": "vertical",
    "track.vertical.wavelength": 15.0,
    "track.lateral.wavelength": 15.0,
}
"""A guess at what the paper did, never the default.

The wheels of a car in phase, only vertical feedback, 15 m waves."""

NOTCH = {"wheels": [[1, 1]], "circumference": 2.7, "offset": 9.0, "depth": 1e-3, "length": 0.05}
"""The notch of the scenario ``notch``: 1 mm by 50 mm on the first wheel of the first car.

It meets the rail 9 m behind the entrance."""


def _waves(half_waves: float, length: float) -> dict[str, Any]:
    """Return the changes for n half-waves on a length in metres."""
    wavelength = 2.0 * length / half_waves
    return {"track.vertical.wavelength": wavelength, "track.lateral.wavelength": wavelength}


SCENARIOS: dict[str, tuple[str, dict[str, Any]]] = {
    "paper": ("n = 5 half-waves on l = 36 m: 14.4 m waves", {}),
    "l37.5": (
        "n = 5 half-waves on l = 37.5 m: 15 m waves, 1.33 Hz at 20 m/s",
        _waves(5.0, 37.5),
    ),
    "n11.7": ("n = 11.7 half-waves on l = 36 m: 3.25 Hz at 20 m/s", _waves(11.7, 36.0)),
    "n11.7 l37.5": ("n = 11.7 half-waves on l = 37.5 m: 3.12 Hz at 20 m/s", _waves(11.7, 37.5)),
    "notch": (
        "a notch of 1 mm by 50 mm on the first wheel, as in the paper: no wheel could follow it",
        # Ten samples in 50 mm at 20 m/s ask for a quarter of the paper case's time step.
        {"train.notch": [NOTCH], "run.time_step": 2.5e-4},
    ),
    "one car": ("one car instead of eight", {"train.cars": 1}),
    "paper reading": (
        "a guess: wheels of a car in phase, vertical feedback only, 15 m waves",
        READING,
    ),
    "identified": (
        "on the beam of the box fitted to Table 2, see `identification`",
        {"deck.file": "viaduct36_identified"},
    ),
}
"""Name: what the scenario is, and the keys of the paper's case that it changes."""


def scenario(name: str, **changes: Any) -> Case:
    """Return one of the paper's scenarios as a case.

    Parameters
    ----------
    name : str
        One of `SCENARIOS`.
    **changes : object
        Further keys of the case's table ``run``, for instance ``loads="wheels"``.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested), or a change that the case refuses.
    """
    _, changed = SCENARIOS[errors.choice("name", name, SCENARIOS)]
    return case("paper").replace({**changed, **{f"run.{k}": v for k, v in changes.items()}})


def run(name: str = "paper", loads: str = "condensed", iterations: int | None = None) -> Crossing:
    """Run a scenario once and keep the result.

    Parameters
    ----------
    name : str
        One of `SCENARIOS`.
    loads : {"condensed", "bogies", "wheels"}
        One force per car, one per bogie, or true wheel loads.
    iterations : int, optional
        Passes of the fixed point; without, until it has converged.
    """
    return _run(name, loads, iterations)


@cache
def _run(name: str, loads: str, iterations: int | None) -> Crossing:
    return scenario(name, loads=loads, iterations=iterations).compute()


def readings() -> list[tuple[dict[str, Any], float]]:
    """Return the first deviation of Eq. 3 for 64 ways to read the paper.

    One force per car or true wheel loads, all ways of excitation and of feedback, two wavelengths
    and four places of the waves relative to the deck. Three cars are enough: a fourth comes when
    the first has left the record that Eq. 3 uses.

    Returns
    -------
    list of (dict, float)
        What each reading changes, and the deviation that it gives, percent.
    """
    options = {
        "run.loads": ("condensed", "wheels"),
        "run.excitation": ("wheels", "car"),
        "run.feedback": ("all", "vertical"),
        "wavelength": (14.4, 15.0),
        "phase": (0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi),
    }
    base = case("paper").replace({"train.cars": 3, "run.tail": 0.0, "run.iterations": 1})
    result = []
    for values in itertools.product(*options.values()):
        reading = dict(zip(options, values, strict=True))
        changes = {k: v for k, v in reading.items() if k.startswith("run.")}
        for direction, ahead in (("vertical", 0.0), ("lateral", np.pi / 2)):
            changes[f"track.{direction}.wavelength"] = reading["wavelength"]
            changes[f"track.{direction}.phase"] = reading["phase"] + ahead
        crossing = base.replace(changes).compute()
        result.append((reading, float(crossing.deviations.from_rigid[0])))
    return result
