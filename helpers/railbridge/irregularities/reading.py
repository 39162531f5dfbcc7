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

__all__ = ["data_root", "spectrum", "spectrum_names"]

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
    if not path.suffix and len(path.parts) == 1:
        path = _shipped(str(source))
    content = _read(path, str(source))
    with within(source=path.name):
        return _spectrum(path.stem, _parsed(content))


def spectrum_names() -> list[str]:
    """Return the names of the shipped spectra."""
    return sorted(path.stem for path in _folder().glob("*.toml"))


def data_root() -> Path:
    """Return the folder of shipped data.

    That of RAILBRIDGE_DATA if set, inside an installed wheel, or of the checkout.
    """
    if os.environ.get("RAILBRIDGE_DATA"):
        return Path(os.environ["RAILBRIDGE_DATA"])
    packaged = Path(__file__).parents[1] / "data"
    return packaged if packaged.is_dir() else Path(__file__).parents[3] / "data"


def _folder() -> Path:
    return data_root() / "spectra"


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


def _read(path: Path, given: str) -> bytes:
    """Return what stands in a file; whoever named it is told where it cannot be read."""
    remedy = ""
    try:
        if path.suffix != ".toml":
            why = "spectrum files are TOML"
            remedy = "Write the path of a .toml file, or a shipped name without an ending"
        elif not path.exists():
            why, remedy = "no such file", f"Looked in {path.parent.resolve().name or 'the root'}"
        elif not path.is_file():
            why = "must be a regular file"
        elif path.stat().st_size > LARGEST:
            why, remedy = "is too large", "Is it the right file?"
        else:
            return path.read_bytes()
    except (OSError, ValueError) as error:  # a name that no file system has is a ValueError
        why = f"cannot be read ({getattr(error, 'strerror', None) or error})"
    raise InputError("spectrum", given, why, remedy)


def _parsed(content: bytes) -> dict[str, Any]:
    try:
        return tomllib.loads(content.decode("utf-8-sig"))
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
