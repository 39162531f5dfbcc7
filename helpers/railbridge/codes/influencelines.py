"""Influence lines as load models need them: values, integrals, and where they are positive."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import errors
from ..decks import REACTION_QUANTITIES, Deck, Line
from ..guideways import COMPONENTS

__all__ = ["InfluenceLine", "influence_line", "under_unit_load"]


@dataclass(frozen=True, eq=False)
class InfluenceLine:
    """A result under a load of 1 N downwards along the deck, cubic between edges.

    Attributes
    ----------
    edges : ndarray, shape (e + 1,)
        m, ascending from 0.
    coefficients : ndarray, shape (e, 4)
        Powers 0..3 of the local coordinate 0..1, unit of the result per N.
    """

    edges: np.ndarray
    coefficients: np.ndarray

    @property
    def length(self) -> float:
        """M."""
        return float(self.edges[-1])

    @cached_property
    def size(self) -> float:
        """A bound of its magnitude."""
        return float(np.abs(self.coefficients).sum(axis=1).max())

    def times(self, factor: float) -> InfluenceLine:
        """Return the line multiplied by a number."""
        return InfluenceLine(self.edges, factor * self.coefficients)

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return the value at each x (m); on a jump that behind it, off the deck zero."""
        piece, local, _ = self._placed(x)
        powers = local[:, None] ** np.arange(4)
        found = np.einsum("kp,kp->k", powers, self.coefficients[piece])
        # At a bearing the end of a cubic is zero but for rounding, which is no effect.
        nothing = np.abs(found) <= _NOTHING * self.size
        return np.where(nothing | (x < 0.0) | (x > self.length), 0.0, found)

    def integral(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Return the integral from each start to each end, m times the unit; zero off the deck."""
        return self._primitive(end) - self._primitive(start)

    def positive_integral(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Return the integral of what is positive from each start to each end."""
        return self.positive.integral(start, end)

    @property
    def all_positive(self) -> float:
        """The integral of what is positive, along the whole deck."""
        return float(self.positive._sums[-1])

    @cached_property
    def positive(self) -> InfluenceLine:
        """The line cut where it changes sign, and zero where it was negative."""
        edges, pieces = [self.edges[:1]], []
        for a, b, c in zip(self.edges[:-1], self.edges[1:], self.coefficients, strict=True):
            cuts = [0.0, *_roots(c), 1.0]
            for low, high in zip(cuts[:-1], cuts[1:], strict=True):
                part = _part(c, low, high)
                middle = part @ 0.5 ** np.arange(4)
                pieces.append(part if middle > 0.0 else np.zeros(4))
                edges.append([a + high * (b - a)])
        return InfluenceLine(np.concatenate(edges), np.array(pieces))

    def positive_stretches(
        self, beside: tuple[float, float] | None = None
    ) -> list[tuple[float, float]]:
        """Return where the line is positive, m, less what lies between two places."""
        found: list[tuple[float, float]] = []
        line = self.positive
        for a, b, c in zip(line.edges[:-1], line.edges[1:], line.coefficients, strict=True):
            if not c.any():
                continue
            if found and found[-1][1] == a:
                found[-1] = (found[-1][0], float(b))
            else:
                found.append((float(a), float(b)))
        if beside is None:
            return found
        low, high = beside
        parts = [part for a, b in found for part in ((a, min(b, low)), (max(a, high), b))]
        return [(a, b) for a, b in parts if b > a]

    def _placed(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the piece of each x, where in it x lies (0..1), and its length (m)."""
        piece = np.searchsorted(self.edges, x, side="right") - 1
        piece = np.clip(piece, 0, len(self.coefficients) - 1)
        length = np.diff(self.edges)[piece]
        return piece, (x - self.edges[piece]) / length, length

    @cached_property
    def _sums(self) -> np.ndarray:
        """The integral from 0 to each edge, shape (e + 1,)."""
        whole = self.coefficients @ (1.0 / np.arange(1, 5)) * np.diff(self.edges)
        return np.concatenate([[0.0], np.cumsum(whole)])

    def _primitive(self, x: np.ndarray) -> np.ndarray:
        """Return the integral from 0 to each x."""
        piece, local, length = self._placed(np.clip(x, 0.0, self.length))
        powers = local[:, None] ** np.arange(1, 5) / np.arange(1, 5)
        own = np.einsum("kp,kp->k", powers, self.coefficients[piece])
        return self._sums[piece] + length * own


def _roots(coefficients: np.ndarray) -> list[float]:
    """Return where a cubic is zero between 0 and 1, ascending."""
    size = np.abs(coefficients).max()
    if size == 0.0:
        return []
    # Leading coefficients that are rounding only would send roots to infinity.
    cleaned = np.where(np.abs(coefficients) < 1e-13 * size, 0.0, coefficients)
    roots = np.roots(cleaned[::-1])
    real = roots.real[np.abs(roots.imag) < 1e-9]
    return sorted(float(r) for r in real if 1e-9 < r < 1.0 - 1e-9)


def _part(c: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return the powers of t where s = low + (high - low) t, of a cubic in s."""
    h = high - low
    return np.array(
        [
            c[0] + low * (c[1] + low * (c[2] + low * c[3])),
            h * (c[1] + low * (2 * c[2] + 3 * low * c[3])),
            h**2 * (c[2] + 3 * low * c[3]),
            h**3 * c[3],
        ]
    )


def influence_line(deck: Deck, quantity: str, at: float, y: float = 0.0) -> InfluenceLine:
    """Return the influence line of a result under 1 N downwards on a track.

    Parameters
    ----------
    deck : Deck
    quantity, at
        See `Deck.influence`.
    y : float
        m left of the deck axis, where the load stands: it twists the deck, too.

    Returns
    -------
    InfluenceLine

    Raises
    ------
    InputError
        A quantity that the deck cannot recover.
    """
    deck.influence(quantity, at=at, places=[0.0], load="z")  # refuses what cannot be recovered
    place = errors.place("at", at, (0.0, deck.length))
    if quantity in REACTION_QUANTITIES:
        return _cleaned(under_unit_load(deck.recovery.reaction(quantity, place), y))
    # At a bearing a line may be nothing but rounding: what it is elsewhere tells.
    usual = max(
        under_unit_load(deck.recovery.section(quantity, share * deck.length), y).size
        for share in (0.31, 0.5)
    )
    return _cleaned(under_unit_load(deck.recovery.section(quantity, place), y), usual)


_NOTHING = 1e-14
"""Share of a line's size below which a value is rounding."""
_ROUNDING = 1e-11
"""Share of a line's size below which a piece of it is rounding, and no effect of any load."""


def under_unit_load(line: Line, y: float) -> InfluenceLine:
    """Return what 1 N downwards does, y to the left of the axis."""
    cubic, (z, roll) = line.influence, (COMPONENTS.index(name) for name in ("z", "roll"))
    along = cubic.coefficients[:, :, 0, z] + y * cubic.coefficients[:, :, 0, roll]
    return InfluenceLine(cubic.edges, -along)


def _cleaned(line: InfluenceLine, usual: float = 0.0) -> InfluenceLine:
    """Return a line without the pieces that are rounding only."""
    sizes = np.abs(line.coefficients).max(axis=1, keepdims=True)
    least = _ROUNDING * max(line.size, usual)
    return InfluenceLine(line.edges, np.where(sizes > least, line.coefficients, 0.0))
