"""One-sided spectra of track irregularities: how rough a track is, wave by wave.

``sigma^2 = integral of S(W) dW`` over the wave numbers ``W = 2 pi / wavelength`` of a band, rad/m.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import InputError, Remark, boolean, choice, frozen, number, numbers, table, text
from .densities import FormulaDensity, ScaledDensity, TableDensity
from .formulas import COMPONENTS

__all__ = ["D1", "D2", "D3", "GRADES", "Component", "Scaling", "TrackSpectrum"]

D1 = (3.0, 25.0)
"""Shortest band of wavelength of EN 13848, m."""
D2 = (25.0, 70.0)
"""Middle band of wavelength of EN 13848, m."""
D3 = (70.0, 150.0)
"""Longest band of wavelength of EN 13848, m; it may end at 200 m."""

GRADES = {
    "two": "two or more independent sources agree",
    "one": "one source only",
    "memory": "remembered by one source, the original not seen",
    "own": "given by you",
}
"""How well the constants of a component are known."""

_TWO_PI = 2 * np.pi


@dataclass(frozen=True)
class Component:
    """What a spectrum knows of one component.

    Attributes
    ----------
    density : FormulaDensity, TableDensity or ScaledDensity
    quantity : {"height", "angle"}
        An angle is the roll of the track, rad.
    grade : str
        A key of `GRADES`.
    source : str
    """

    density: FormulaDensity | TableDensity | ScaledDensity
    quantity: str = "height"
    grade: str = "own"
    source: str = ""


@dataclass(frozen=True)
class Scaling:
    """Sigma of a component in a band, m or rad: that of the printed constants, and the wanted one.

    Attributes
    ----------
    component : str
    band : (float, float)
        m.
    before, wanted : float
    """

    component: str
    band: tuple[float, float]
    before: float
    wanted: float


def _comparable(thing: Any) -> Any:
    """Return what a dataclass, table, list or array holds as something that compares and hashes."""
    if isinstance(thing, np.ndarray):
        return thing.shape, tuple(thing.ravel().tolist())
    if dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        own = {f.name: getattr(thing, f.name) for f in dataclasses.fields(thing)}
        return type(thing), _comparable(own)
    if isinstance(thing, Mapping):
        return tuple((name, _comparable(thing[name])) for name in sorted(thing))
    return tuple(map(_comparable, thing)) if isinstance(thing, (list, tuple)) else thing


@dataclass(frozen=True, eq=False)
class TrackSpectrum:
    """One-sided spectra of the irregularities of a track, per component.

    Attributes
    ----------
    name, family, source : str
    band : (float, float)
        Shortest and longest wavelength for which it is valid, m.
    parts : dict of Component
        Of ``vertical``, ``alignment``, ``cross_level``, ``gauge`` those that are known.
    base : float
        Distance of the rails' contact lines, m: an angle times it is a height of cross-level.
    factor : float
        By which all densities are multiplied; see `scaled`.
    scaling : Scaling or None
    band_source : str
        Where the band of validity comes from.
    """

    name: str
    family: str
    band: tuple[float, float]
    source: str
    parts: Mapping[str, Component]
    base: float = 1.5
    factor: float = 1.0
    scaling: Scaling | None = None
    band_source: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "band", _ordered("band", self.band))
        object.__setattr__(self, "base", number("base", self.base, above=0.0, unit="m"))
        number("factor", self.factor, above=0.0)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TrackSpectrum):
            return NotImplemented
        return self is other or self._contents == other._contents

    def __hash__(self) -> int:
        return hash(self._contents)

    @cached_property
    def _contents(self) -> tuple:
        """All that it holds, to be compared: its dataclasses hold arrays."""
        return _comparable({f.name: getattr(self, f.name) for f in dataclasses.fields(self)})

    def __repr__(self) -> str:
        text = f"TrackSpectrum({self.name!r}, {', '.join(self.components)}"
        return text + (f", {self._scaled_text()})" if self.scaling else ")")

    @property
    def components(self) -> tuple[str, ...]:
        """The components it has."""
        return tuple(name for name in COMPONENTS if name in self.parts)

    def grade(self, component: str) -> str:
        """Return how well the constants of a component are known: a key of `GRADES`."""
        return self._part(component).grade

    def unit(self, component: str, height: bool = False) -> str:
        """Return the unit of `density`."""
        return f"{self._unit(component, height)}2/(rad/m)"

    def density(
        self, component: str, wavenumber: np.ndarray | float, height: bool = False
    ) -> np.ndarray:
        """Return the one-sided density of a component.

        Also outside of the band of validity, for drawings; `sigma` refuses that.

        Parameters
        ----------
        component : str
        wavenumber : array or float
            W = 2 pi / wavelength, rad/m, above 0, of any shape.
        height : bool
            Whether an angle is given as the height over the `base` instead.

        Returns
        -------
        ndarray
            m2/(rad/m), or rad2/(rad/m) where the component is an angle; the shape of `wavenumber`.

        Raises
        ------
        InputError
            No such component; a wave number that is not a finite number above 0.
        """
        part, size = self._part(component), self._size(component, height)
        try:
            given = np.asarray(wavenumber)
        except ValueError:  # lists of different lengths
            allowed = "must be a number or an array of numbers"
            raise InputError("wavenumber", wavenumber, allowed) from None
        if given.ndim == 0:
            flat = np.array([number("wavenumber", given[()], above=0.0, unit="rad/m")])
        else:
            flat = numbers("wavenumber", given.ravel(), above=0.0, unit="rad/m")
        return self.factor * size**2 * part.density.value(flat).reshape(given.shape)

    def sigma(self, component: str, band: Sequence[float] = D1, height: bool = False) -> float:
        """Return the standard deviation of a component over a band of wavelengths.

        Parameters
        ----------
        component : str
        band : (float, float)
            Shortest and longest wavelength, m; `D1`, `D2`, `D3` are those of EN 13848.
        height : bool
            Whether an angle is given as the height over the `base` instead.

        Returns
        -------
        float
            m, or rad where the component is an angle; exact to rounding.

        Raises
        ------
        InputError
            No such component; a band that is reversed, not above 0 or not inside that of validity.
        """
        part, size = self._part(component), self._size(component, height)
        short, long = self.checked_band(band)
        return size * float(
            np.sqrt(self.factor * part.density.integral(_TWO_PI / long, _TWO_PI / short))
        )

    def checked_band(self, band: Sequence[float], field: str = "band") -> tuple[float, float]:
        """Return a band of wavelengths, m, or refuse it: it must be inside that of validity."""
        short, long = _ordered(field, band)
        if short < self.band[0] * (1 - 1e-9) or long > self.band[1] * (1 + 1e-9):
            valid = "{:g} to {:g} m".format(*self.band)
            allowed = f"must be inside the band for which {self.name} is valid, {valid}"
            raise InputError(field, band, allowed, "Take a narrower band, or another spectrum")
        return short, long

    def scaled(
        self, sigma: float, component: str = "vertical", band: Sequence[float] = D1
    ) -> TrackSpectrum:
        """Return the same spectrum, rougher or smoother: one sigma is given.

        The densities of all components are multiplied by the same `factor`.

        Parameters
        ----------
        sigma : float
            Wanted, m (rad where the component is an angle).
        component : str
        band : (float, float)
            m; see `sigma`.

        Raises
        ------
        InputError
            A sigma that is not above 0; as `sigma`.
        """
        wanted = number("sigma", sigma, above=0.0, unit=self._unit(component, False))
        printed = self.sigma(component, band) / float(np.sqrt(self.factor))
        scaling = Scaling(component, self.checked_band(band), printed, wanted)
        return dataclasses.replace(self, factor=(wanted / printed) ** 2, scaling=scaling)

    @cached_property
    def remarks(self) -> tuple[Remark, ...]:
        """What must be known of its constants: which ones have fewer than two sources."""
        found = []
        for grade in ("one", "memory"):
            names = [name for name in self.components if self.parts[name].grade == grade]
            if names:
                said = f"of the spectrum {self.name}: constants from {GRADES[grade]}"
                if grade == "memory":
                    said = f"of the spectrum {self.name}: constants {GRADES[grade]}"
                found.append(Remark(", ".join(names), said))
        return tuple(found)

    def describe(self) -> str:
        """Return in a few lines what it is, where it comes from and how rough it is."""
        lines = [f"{self.name}: {self.family}", f"source: {self.source}"]
        valid = "valid for wavelengths of {:g} to {:g} m".format(*self.band)
        lines.append(valid + f" ({self.band_source})" * bool(self.band_source))
        lines += [f"scaled: {self._scaled_text()}"] if self.scaling else []
        for name in self.components:
            bands = zip(("D1", "D2", "D3"), self._sigmas(name), strict=True)
            said = [f"{d} {s:.4g} {self._small(name)}" for d, s in bands if s == s]
            lines.append(f"{name} ({GRADES[self.grade(name)]}): sigma {', '.join(said) or 'none'}")
        return "\n".join([*lines, *(str(remark) for remark in self.remarks)])

    def to_frame(self):
        """Return a pandas DataFrame with one row a component; NaN where a band is not valid."""
        import pandas as pd

        rows = {
            name: {
                "unit": self.unit(name),
                "grade": self.grade(name),
                "sigma unit": self._small(name),
                **dict(zip(("sigma D1", "sigma D2", "sigma D3"), self._sigmas(name), strict=True)),
            }
            for name in self.components
        }
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("component")

    @classmethod
    def from_table(
        cls,
        wavenumber: Sequence[float],
        densities: Mapping[str, Sequence[float]],
        *,
        name: str = "own table",
        source: str = "own table",
        angle: bool = False,
        base: float = 1.5,
    ) -> TrackSpectrum:
        """Return a spectrum from tables, a power of the wave number between two points.

        Parameters
        ----------
        wavenumber : array, shape (n,)
            rad/m, ascending, at least two. The band of validity goes from the first to the last.
        densities : dict of array, shape (n,)
            One-sided, m2/(rad/m), by component.
        name, source : str
        angle : bool
            Whether the cross-level is an angle, rad2/(rad/m).
        base : float
            m, by which an angle becomes a height.

        Raises
        ------
        InputError
            Wave numbers that do not ascend; a density that is not a finite number above 0; another
            number of them; an unknown component.
        """
        x = numbers("wavenumber", wavenumber, above=0.0, unit="rad/m")
        if len(x) < 2:
            raise InputError("wavenumber", wavenumber, "must hold at least two numbers")
        if np.any(np.diff(x) <= 0):
            at = int(np.argmax(np.diff(x) <= 0)) + 2
            raise InputError(f"wavenumber[{at}]", x[at - 1], "must be above the one before it")
        parts, angle = {}, boolean("angle", angle)
        given = table("densities", densities)
        if not given:
            allowed = "must hold at least one of " + ", ".join(COMPONENTS)
            raise InputError("densities", densities, allowed)
        for component, values in given.items():
            choice("component", component, COMPONENTS)
            quantity = "angle" if angle and component == "cross_level" else "height"
            s = numbers(component, values, count=len(x), above=0.0, unit=_density_unit(quantity))
            parts[component] = Component(TableDensity(frozen(x), frozen(s)), quantity)
        band = (_TWO_PI / x[-1], _TWO_PI / x[0])
        own = (text("name", name), "own", band, text("source", source), parts, base)
        return cls(*own, band_source="from the first to the last point of the table")

    # ---- inside

    def _part(self, component: str) -> Component:
        choice("component", component, COMPONENTS)
        if component not in self.parts:
            allowed = f"is not known of {self.name}"
            remedy = f"It has {', '.join(self.components)}"
            raise InputError("component", component, allowed, remedy)
        return self.parts[component]

    def _size(self, component: str, height: bool) -> float:
        """Return by what the component is multiplied to be what is asked for."""
        as_height = boolean("height", height) and self._part(component).quantity == "angle"
        return self.base if as_height else 1.0

    def _unit(self, component: str, height: bool) -> str:
        angle = self._part(component).quantity == "angle" and not height
        return "rad" if angle else "m"

    def _small(self, component: str) -> str:
        return "m" + self._unit(component, False)

    def _sigmas(self, component: str) -> list[float]:
        """Return sigma in D1, D2, D3, mm or mrad; NaN where the band is not valid."""
        found = []
        for band in (D1, D2, D3):
            try:
                found.append(1e3 * self.sigma(component, band))
            except InputError:
                found.append(np.nan)
        return found

    def _scaled_text(self) -> str:
        s = self.scaling
        unit = self._small(s.component)
        said = f"sigma of {s.component} {1e3 * s.before:.4g} -> {1e3 * s.wanted:.4g} {unit}"
        return said + f" ({s.band[0]:g}-{s.band[1]:g} m), densities times {self.factor:.4g}"


def _density_unit(quantity: str) -> str:
    return ("rad" if quantity == "angle" else "m") + "2/(rad/m)"


def _ordered(field: str, band: Any) -> tuple[float, float]:
    short, long = numbers(field, band, count=2, above=0.0, unit="m").tolist()
    if short >= long:
        raise InputError(field, band, "must be (shortest, longest) wavelength, m", "Turn it round")
    return short, long
