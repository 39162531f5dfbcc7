"""Spectra by shipped name or from a file of your own."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import (
    InputError,
    boolean,
    choice,
    did_you_mean,
    is_list,
    joined,
    keys,
    number,
    numbers,
    table,
    text,
    within,
)  # fmt: skip
from .densities import FormulaDensity
from .formulas import COMPONENTS, FORMULAS, Formula, factors
from .trackspectra import GRADES, Component, TrackSpectrum

__all__ = ["spectrum", "spectrum_names"]

LARGEST = 1e6
"""Bytes of a file."""
_NEEDED = ("family", "formula", "wavenumber", "one_sided", "band", "band_source", "source")
_OF_COMPONENT = ("quantity", "grade", "source")


def spectrum(source: str | Path) -> TrackSpectrum:
    """Return a spectrum of track irregularities by name, or from a file.

    Parameters
    ----------
    source : str or Path
        A shipped name (``german-low``, ``fra-aar-5``, see `spectrum_names`), or the path of a TOML
        file of the same kind; docs/spectra.md describes it.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested); ``fra`` alone, since two families bear it; a file
        that cannot be read or has keys, units or numbers that cannot be used.
    """
    if not isinstance(source, (str, Path)) or not str(source).strip():
        remedy = "Shipped: " + ", ".join(spectrum_names())
        raise InputError("spectrum", source, "must be a name or a path", remedy)
    path = Path(source)
    if path.suffix != ".toml" and len(path.parts) == 1:
        path = _shipped(str(source))
    with within(source=path.name):
        return _spectrum(path.stem, _read(path))


def spectrum_names() -> list[str]:
    """Return the names of the shipped spectra."""
    return sorted(path.stem for path in _folder().glob("*.toml"))


def _folder() -> Path:
    """Return where the shipped spectra stand: as for all data, RAILBRIDGE_DATA leads elsewhere."""
    if os.environ.get("RAILBRIDGE_DATA"):
        return Path(os.environ["RAILBRIDGE_DATA"]) / "spectra"
    packaged = Path(__file__).parents[1] / "data"
    return (packaged if packaged.is_dir() else Path(__file__).parents[3] / "data") / "spectra"


def _shipped(name: str) -> Path:
    names = spectrum_names()
    if name in names:
        return _folder() / f"{name}.toml"
    bare = re.fullmatch(r"fra[-_ ]?([1-6]?)", name.strip().lower())
    if bare:
        kind = bare[1] or "1 ... 6"
        remedy = f"Say fra-aar-{kind} or fra-fryba-{kind}: their sigma differ by 3.5 to 8 times"
        raise InputError("spectrum", name, "names two families of spectra", remedy)
    raise InputError("spectrum", name, "no such spectrum", did_you_mean(name, names))


def _read(path: Path) -> dict[str, Any]:
    try:
        if not path.is_file():
            why = "no such file" if not path.exists() else "must be a regular file"
            raise InputError("", None, why)
        if path.stat().st_size > LARGEST:
            raise InputError("", None, "is too large", "Is it the right file?")
        return tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except OSError as error:
        raise InputError("", None, f"cannot be read ({error.strerror})") from None
    except InputError:
        raise
    except (ValueError, RecursionError):  # UnicodeDecodeError and TOMLDecodeError are ValueErrors
        raise InputError("", None, "is not a valid TOML file") from None


def _spectrum(name: str, content: Mapping[str, Any]) -> TrackSpectrum:
    keys("", content, (*_NEEDED, "note", "base", "constants", *COMPONENTS), _NEEDED)
    for key in ("family", "band_source", "source"):
        text(key, content[key])
    formulas = FORMULAS[choice("formula", content["formula"], FORMULAS)]
    variable = choice("wavenumber", content["wavenumber"], ("rad/m", "1/m"))
    sides = 1 if boolean("one_sided", content["one_sided"]) else 2
    shared = table("constants", content.get("constants", {}))
    parts = {}
    for component in COMPONENTS:
        if component in content:
            own, formula = table(component, content[component]), formulas[component]
            with within(component):
                parts[component] = _component(own, shared, formula, variable, sides)
                if component != "cross_level" and parts[component].quantity == "angle":
                    raise InputError("quantity", "angle", "is that of cross_level only")
    if not parts:
        raise InputError(COMPONENTS[0], None, "is missing", "Give at least one component")
    used = {key for component in parts for key in formulas[component].constants}
    with within("constants"):
        keys("", shared, used)
    band, base = tuple(numbers("band", content["band"], count=2)), content.get("base", 1.5)
    said = (name, content["family"], band, content["source"], parts, base)
    return TrackSpectrum(*said, band_source=content["band_source"])


def _component(
    own: Mapping[str, Any], shared: Mapping[str, Any], formula: Formula, variable: str, sides: int
) -> Component:
    keys("", own, (*_OF_COMPONENT, "note", *formula.constants), _OF_COMPONENT)
    quantity = choice("quantity", own["quantity"], ("height", "angle"))
    if formula.quantity and quantity != formula.quantity:
        allowed = f"of this component the formula gives the {formula.quantity}"
        raise InputError("quantity", quantity, allowed)
    grade, source = choice("grade", own["grade"], GRADES), text("source", own["source"])
    given = {**shared, **own}
    constants = {}
    for name, dimension in formula.constants.items():
        if name not in given:
            raise InputError(name, None, "is missing", f"Add {name}, here or below constants")
        units = factors(dimension, variable, quantity)
        constants[name] = _constant(name, given[name], units, formula.power)
    if formula.power:
        _check_pieces(constants)
    return Component(FormulaDensity(formula, constants, variable, sides), quantity, grade, source)


def _constant(name: str, given: Any, units: Mapping[str, float], several: bool) -> np.ndarray:
    """Return a constant in SI: ``{ value = 0.8246, unit = "rad/m" }``, or a plain number."""
    value, unit = given, ""
    if isinstance(given, Mapping):
        keys(name, given, ("value", "unit"), ("value", "unit"))
        value, unit = given["value"], given["unit"]
    elif "" not in units:
        example = f'{{ value = ..., unit = "{next(iter(units))}" }}'
        raise InputError(name, given, "needs its unit", f"Write {name} = {example}")
    unit = choice(joined(name, "unit"), unit, units)
    if several:
        found = numbers(name, value) if is_list(value) else np.array([number(name, value)])
    else:
        found = np.array(number(name, value, above=0.0))
    return found * units[unit]


def _check_pieces(constants: Mapping[str, np.ndarray]) -> None:
    breaks, pieces = constants["breaks"], constants["A"]
    if np.any(np.diff(breaks) <= 0) or np.any(breaks <= 0):
        raise InputError("breaks", breaks, "must be above 0 and ascend")
    if np.any(pieces <= 0):
        raise InputError("A", pieces, "must be above 0")
    for name in ("A", "n"):
        numbers(name, constants[name], count=len(breaks) + 1)
