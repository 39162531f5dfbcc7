"""Densities per rad/m of one component, by a printed formula or by a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .formulas import Formula, power_integral

__all__ = ["FormulaDensity", "TableDensity"]

_TWO_PI = 2 * np.pi


@dataclass(frozen=True, eq=False)
class FormulaDensity:
    """Density of one component by a printed formula.

    Attributes
    ----------
    formula : Formula
    constants : dict of ndarray
        SI of the variable.
    variable : {"rad/m", "1/m"}
        What the formula is printed in.
    sides : {1, 2}
        2 where the printed density is that of positive and negative wave numbers.
    """

    formula: Formula
    constants: Mapping[str, np.ndarray]
    variable: str
    sides: int = 1

    def value(self, wavenumber: np.ndarray) -> np.ndarray:
        """Return the one-sided density per rad/m at wave numbers in rad/m."""
        to = _TWO_PI if self.variable == "1/m" else 1.0
        return self.sides / to * self.formula.value(wavenumber / to, self.constants)

    def integral(self, low: float, high: float) -> float:
        """Return its integral from one wave number to another, rad/m."""
        to = _TWO_PI if self.variable == "1/m" else 1.0
        return self.sides * self.formula.integral(low / to, high / to, self.constants)


@dataclass(frozen=True, eq=False)
class TableDensity:
    """Density of one component by a table: a power of the wave number between two points.

    Attributes
    ----------
    wavenumber : ndarray, shape (n,)
        rad/m, ascending.
    density : ndarray, shape (n,)
        Per rad/m, one-sided. Outside the table the first and last powers go on.
    """

    wavenumber: np.ndarray
    density: np.ndarray

    def value(self, wavenumber: np.ndarray) -> np.ndarray:
        """Return the density per rad/m at wave numbers in rad/m."""
        x, known_x, known = np.log(wavenumber), np.log(self.wavenumber), np.log(self.density)
        piece = np.clip(np.searchsorted(known_x, x) - 1, 0, len(known_x) - 2)
        slope = (np.diff(known) / np.diff(known_x))[piece]
        return np.exp(known[piece] + slope * (x - known_x[piece]))

    def integral(self, low: float, high: float) -> float:
        """Return its integral from one wave number to another, rad/m."""
        inside = (self.wavenumber > low) & (self.wavenumber < high)
        x = np.concatenate([[low], self.wavenumber[inside], [high]])
        s = self.value(x)
        return float(np.sum(power_integral(x[:-1], x[1:], s[:-1], s[1:])))
