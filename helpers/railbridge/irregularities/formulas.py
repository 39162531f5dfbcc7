"""The kinds of formulas in which spectra of irregularities are printed, and their integrals.

A formula is printed in wave numbers of its own: W in rad/m, or n = W / (2 pi) in 1/m, and its
constants belong to that variable. Here x is whichever of the two the file says, and S is one-sided.

Every formula is smooth between its kinks. Where it is a power of x there, the integral has a closed
form; elsewhere it is a ratio of polynomials without poles at positive x, for which Gauss's rule on
octaves of x is exact to rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

__all__ = ["COMPONENTS", "FORMULAS", "Formula", "factors", "power_integral"]

COMPONENTS = ("vertical", "alignment", "cross_level", "gauge")
"""Vertical level and lateral place of the track axis, cross-level, gauge."""

Constants = Mapping[str, np.ndarray]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True)
class Formula:
    """A formula of one component.

    Attributes
    ----------
    constants : dict
        Dimension of each constant by its printed name; see `factors`.
    value : callable
        (x, constants in SI of x) -> S, same shape as x.
    quantity : {"height", "angle", ""}
        What S must be a density of; "" for either.
    power : bool
        Whether S is a power of x between the ``breaks``; its constants are then lists.
    """

    constants: Mapping[str, str]
    value: Callable[[np.ndarray, Constants], np.ndarray]
    quantity: str = "height"
    power: bool = False

    def integral(self, low: float, high: float, constants: Constants) -> float:
        """Return the integral of S over x from `low` to `high`, both above 0."""
        if self.power:
            edges = _between(low, high, constants["breaks"])
            inside = np.sqrt(edges[:-1] * edges[1:])
            slope = -constants["n"][np.searchsorted(constants["breaks"], inside)]
            middle = self.value(inside, constants)
            ends = [middle * (end / inside) ** slope for end in (edges[:-1], edges[1:])]
            return float(np.sum(power_integral(edges[:-1], edges[1:], *ends)))
        octaves = int(np.ceil(np.log2(high / low))) or 1
        edges = np.linspace(np.log(low), np.log(high), octaves + 1)
        half = np.diff(edges)[:, None] / 2
        x = np.exp(edges[:-1, None] + half * (1 + _NODES))
        return float(np.sum(half * _WEIGHTS * x * self.value(x, constants)))


def _between(low: float, high: float, breaks: np.ndarray) -> np.ndarray:
    return np.concatenate([[low], breaks[(breaks > low) & (breaks < high)], [high]])


def power_integral(x0: np.ndarray, x1: np.ndarray, s0: np.ndarray, s1: np.ndarray) -> np.ndarray:
    """Return the integrals of powers of x through (x0, s0) and (x1, s1), from x0 to x1.

    With L = ln(x1/x0) and q = ln(s1 x1 / (s0 x0)) it is s0 x0 L (e^q - 1)/q.
    """
    length, q = np.log(x1 / x0), np.log(s1 / s0 * (x1 / x0))
    small = np.abs(q) < 1e-8
    safe = np.where(small, 1.0, q)
    return s0 * x0 * length * np.where(small, 1 + q / 2, np.expm1(safe) / safe)


def factors(dimension: str, variable: str, quantity: str) -> dict[str, float]:
    """Return the units of a constant, each with its factor to SI of the variable.

    Parameters
    ----------
    dimension : {"wave number", "density", "roughness", "length", "number"}
        Roughness is a height squared times a wave number: S x^2 of a simple decay.
    variable : {"rad/m", "1/m"}
    quantity : {"height", "angle"}
        What the density is of.
    """
    heights, angles = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}, {"rad": 1.0, "mrad": 1e-3}
    if dimension == "wave number":
        return {variable: 1.0}
    if dimension == "density":
        lengths = angles if quantity == "angle" else heights
        return {f"{unit}2/({variable})": f**2 for unit, f in lengths.items()}
    if dimension == "roughness":
        if variable == "1/m":
            return {"m": 1.0, "cm2/m": 1e-4, "mm2/m": 1e-6}
        return {f"{unit}2 {variable}": f**2 for unit, f in heights.items()}
    return {"m": 1.0} if dimension == "length" else {"": 1.0}


# ---- the formulas


def _german(x: np.ndarray, c: Constants) -> np.ndarray:
    return c["A"] * c["W_c"] ** 2 / ((x**2 + c["W_r"] ** 2) * (x**2 + c["W_c"] ** 2))


def _german_gauge(x: np.ndarray, c: Constants) -> np.ndarray:
    return _german(x, c) * x**2 / (x**2 + c["W_s"] ** 2)


def _german_angle(x: np.ndarray, c: Constants) -> np.ndarray:
    return _german_gauge(x, c) / c["b"] ** 2


def _aar(x: np.ndarray, c: Constants) -> np.ndarray:
    return c["k"] * c["A"] * c["W_c"] ** 2 / (x**2 * (x**2 + c["W_c"] ** 2))


def _aar_across(x: np.ndarray, c: Constants) -> np.ndarray:
    low, corner = c["W_s"] ** 2, c["W_c"] ** 2
    return 4 * c["k"] * c["A"] * corner / ((x**2 + corner) * (x**2 + low))


def _fryba(x: np.ndarray, c: Constants) -> np.ndarray:
    n1, n2 = c["n_1"] ** 2, c["n_2"] ** 2
    return c["A"] * n2 * (x**2 + n1) / (x**4 * (x**2 + n2))


def _pieces(x: np.ndarray, c: Constants) -> np.ndarray:
    piece = np.searchsorted(c["breaks"], x)
    return c["A"][piece] * x ** -c["n"][piece]


def _sncf(x: np.ndarray, c: Constants) -> np.ndarray:
    return c["A"] * c["quality"] / (1 + x / c["n_0"]) ** 3


_W = "wave number"
_CORNERS = {"A": "roughness", "W_c": _W, "W_r": _W}
_LEVEL, _ACROSS = Formula(_CORNERS, _german), Formula(_CORNERS | {"W_s": _W}, _german_gauge)
_ANGLE = Formula(_CORNERS | {"W_s": _W, "b": "length"}, _german_angle, "angle")
_AAR = Formula({"k": "number", "A": "roughness", "W_c": _W}, _aar)
_AAR_ACROSS = Formula(dict(_AAR.constants) | {"W_s": _W}, _aar_across)
_FRYBA = Formula({"A": "roughness", "n_1": _W, "n_2": _W}, _fryba)
_PIECES = Formula({"breaks": _W, "A": "density", "n": "number"}, _pieces, "", True)
_SNCF = Formula({"A": "density", "quality": "number", "n_0": _W}, _sncf, "")

FORMULAS: dict[str, dict[str, Formula]] = {
    "german": dict(zip(COMPONENTS, (_LEVEL, _LEVEL, _ANGLE, _ACROSS), strict=True)),
    "fra_aar": dict(zip(COMPONENTS, (_AAR, _AAR, _AAR_ACROSS, _AAR_ACROSS), strict=True)),
    "fryba": dict.fromkeys(COMPONENTS, _FRYBA),
    "power_pieces": dict.fromkeys(COMPONENTS, _PIECES),
    "sncf": dict.fromkeys(COMPONENTS, _SNCF),
}
r"""The formula of each component by kind.

``german``: vertical and alignment A W_c^2 / ((x^2 + W_r^2)(x^2 + W_c^2)); gauge that times
x^2 / (x^2 + W_s^2); cross-level the latter over b^2, an angle. ``fra_aar``: vertical and alignment
k A W_c^2 / (x^2 (x^2 + W_c^2)); cross-level and gauge 4 k A W_c^2 / ((x^2 + W_c^2)(x^2 + W_s^2)),
heights. ``fryba``: A n_2^2 (x^2 + n_1^2) / (x^4 (x^2 + n_2^2)). ``power_pieces``: A / x^n between
``breaks``. ``sncf``: A quality / (1 + x/n_0)^3.
"""
