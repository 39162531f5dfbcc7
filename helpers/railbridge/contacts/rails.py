r"""Rails that spread a wheel's load and carry on over the ends of the deck.

A wheel at x loads the deck beside x too, and is carried by the deck beside x. With the kernel K,
even and of integral 1, a shape phi of the deck, zero off the deck, becomes the shape that a wheel
meets,

    psi(x) = integral of K(x - s) phi(s) ds,

from a `Rail.reach` before the deck to as far behind it. The same psi gives the force on the mode
(psi F) and the motion of the wheel (psi q, and V psi' q for its climb), so both are reciprocal: no
work is lost between wheel and deck.

Sleepers a distance d apart carry 1/4, 1/2 and 1/4 of a wheel's load at x - d, x and x + d. A rail
with bending stiffness EI on a bed that gives way by 1 / k per metre spreads it like a long beam on
an elastic (Winkler) foundation:

    K(s) = b / 2 exp(-b |s|) (cos b s + sin b |s|) = Re (p / 2 exp(-p |s|)),
    b = (k / (4 EI))^(1/4),   p = b (1 - i),

where 1 / b is the elastic length, about 0.7 to 1 m. With

    A(x) = integral of exp(-p (x - s)) phi(s) over all s < x, and B(x) likewise over all s > x,

psi = Re (p / 2 (A + B)) and psi' = Re (p^2 / 2 (B - A)), and A and B go on from place to place by
A(x + h) = exp(-p h) A(x) + what the piece between adds.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Annotated

import numpy as np
from scipy.linalg import solve_banded

from ..errors import InputError, Range, check_fields

__all__ = ["Rail"]

_REACH = 14.0
"""How far a rail on a bed reaches, elastic lengths: a load there is felt by less than 1e-6."""
_MESH = 0.1
"""Longest piece of a shape under a rail on a bed, elastic lengths."""
_SAME = 1e-12
"""Edges of sleepers' shapes that are nearer, share of the length, differ by rounding."""
_LENGTHS = (0.05, 10.0)
"""What an elastic length may be, m."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_TRACK = "Two UIC 60 rails have 1.28e7 N m2, a ballasted track has 5e7 to 3e8 N/m2"


@dataclass(frozen=True)
class Rail:
    """How the rails of a track spread a wheel's load; they also lie on the ground beside the deck.

    Give either `spread`, or `bending_stiffness` and `foundation`.

    Attributes
    ----------
    spread : float, optional
        Distance d of sleepers, m: a quarter, a half and a quarter of a load act at x - d, x and
        x + d (EN 1991-2, 6.3.6.1), and travel with it.
    bending_stiffness : float, optional
        E I of both rails together, N m2: a long beam on an elastic foundation spreads the load.
    foundation : float, optional
        Stiffness of the bed below both rails, N/m per metre of track.

    Raises
    ------
    InputError
        Neither or both ways, a value out of range, or an elastic length
        (4 bending_stiffness / foundation)^(1/4) below 0.05 m or above 10 m.

    Notes
    -----
    The rail spreads, it has no mass, and it does not give way: how far it sinks into its bed below
    the wheel is not counted, nor is the bed's damping, nor how a real rail stiffens the deck's
    ends. A finite-element model that counts all this but mass and damping of the track (20 m, 50
    m/s, UIC 60 on 1e8 N/m2) differs by 0.4 to 0.7 % in displacements, 2 to 6 % in accelerations and
    4 % in the dynamic force of a sprung mass. Wrong where the track's own motion matters: above
    some 50 Hz. A load that stands on sleepers still comes onto a moving end of the deck in steps,
    each a quarter or a half of it; on a bed it comes smoothly.

    Sources: EN 1991-2, 6.3.6.1; beam on elastic foundation: E. Winkler (1867), H. Zimmermann
    (1888).
    """

    spread: Annotated[float, Range(above=0.0, most=5.0, unit="m")] | None = None
    bending_stiffness: Annotated[float, Range(above=0.0, unit="N m2")] | None = None
    foundation: Annotated[float, Range(above=0.0, unit="N/m2")] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        bed = {"bending_stiffness": self.bending_stiffness, "foundation": self.foundation}
        given = {name: value for name, value in bed.items() if value is not None}
        if self.spread is not None and given:
            name, value = next(iter(given.items()))
            allowed = "give either spread, or bending_stiffness and foundation"
            raise InputError(name, value, allowed, "Remove one")
        if self.spread is not None:
            return
        if not given:
            remedy = "Give the distance of sleepers, or bending_stiffness and foundation"
            raise InputError("spread", None, "is missing", remedy)
        for name, value in bed.items():
            if value is None:
                remedy = f"A rail on a bed needs it beside {next(iter(given))}. {_TRACK}"
                raise InputError(name, None, "is missing", remedy)
        low, high = _LENGTHS
        if not low <= self.length <= high:
            allowed = f"with bending_stiffness = {self.bending_stiffness:g} N m2 the elastic "
            allowed += f"length is {self.length:.3g} m, must be {low:g} to {high:g} m"
            raise InputError("foundation", self.foundation, allowed, _TRACK)

    @property
    def length(self) -> float:
        """How far it spreads a load, m: the distance of sleepers, or the elastic length 1 / b."""
        if self.spread is not None:
            return self.spread
        return float((4.0 * self.bending_stiffness / self.foundation) ** 0.25)

    @property
    def reach(self) -> float:
        """How far before and behind the deck a wheel still loads it, m.

        Of a rail on a bed 14 elastic lengths, from where on less than 1e-6 of a load arrives.
        """
        return self.length if self.spread is not None else _REACH * self.length

    @property
    def parts(self) -> tuple[tuple[float, float], ...]:
        """Where sleepers carry a load, m beside it, and which share; none of a rail on a bed."""
        if self.spread is None:
            return ()
        return (-self.spread, 0.25), (0.0, 0.5), (self.spread, 0.25)

    def kernel(self, s: np.ndarray) -> np.ndarray:
        """Return K of a rail on a bed, 1/m, at distances s (m) from the load.

        Raises
        ------
        InputError
            Sleepers, whose load acts at `parts`.
        """
        if self.spread is not None:
            raise InputError("spread", self.spread, "sleepers have no smooth kernel", "See parts")
        angle = np.abs(np.asarray(s, dtype=float)) / self.length
        return np.exp(-angle) * (np.cos(angle) + np.sin(angle)) / (2.0 * self.length)

    def under(self, edges: np.ndarray, coefficients: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return what functions along the deck become for a load on the rail.

        Parameters
        ----------
        edges : ndarray, shape (e + 1,)
            m, ascending.
        coefficients : ndarray, shape (e, 4, ...)
            Cubics between edges, see `guideways.PiecewiseCubic`; zero off the edges.

        Returns
        -------
        edges, coefficients
            Of the spread functions, from one `reach` before the first edge to one behind the last.
            Exact for sleepers. On a bed values and slopes at the edges, a tenth of an elastic
            length apart, are exact but for rounding; between them the cubics are off by at most
            1.1e-6 of what psi and phi differ by, and their slopes by 3.3e-5 of that per elastic
            length.
        """
        flat = np.asarray(coefficients).reshape(*coefficients.shape[:2], -1)
        of_kind = self._on_bed if self.spread is None else self._on_sleepers
        places, spread = of_kind(np.asarray(edges, dtype=float), flat)
        return places, spread.reshape(-1, 4, *coefficients.shape[2:])

    def _on_sleepers(
        self, edges: np.ndarray, coefficients: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the sum of shifted functions, piece by piece between all shifted edges."""
        places = np.unique(np.concatenate([edges + offset for offset, _ in self.parts]))
        least = _SAME * (edges[-1] - edges[0])
        places = places[np.concatenate([[True], np.diff(places) > least])]
        h, middle = np.diff(places), (places[1:] + places[:-1]) / 2
        result = np.zeros((len(h), *coefficients.shape[1:]))
        for offset, share in self.parts:
            own = np.searchsorted(edges, middle - offset, side="right") - 1
            on = np.flatnonzero((own >= 0) & (own < len(edges) - 1))
            own = own[on]
            piece = edges[own + 1] - edges[own]
            start, scale = (places[on] - offset - edges[own]) / piece, h[on] / piece
            for j in range(4):
                for k in range(j, 4):
                    # Powers of start + scale t in powers of t.
                    factor = share * comb(k, j) * start ** (k - j) * scale**j
                    result[on, j] += factor[:, None] * coefficients[own, k]
        return places, result

    def _on_bed(self, edges: np.ndarray, coefficients: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the convolution with K as cubics through exact values and slopes."""
        pole = (1.0 - 1.0j) / self.length
        first, last = edges[0] - self.reach, edges[-1] + self.reach
        count = int(np.ceil((last - first) / (_MESH * self.length)))
        nodes = np.linspace(first, last, count + 1)
        places = np.unique(np.concatenate([nodes, edges]))
        h = np.diff(places)
        own = np.searchsorted(edges, (places[1:] + places[:-1]) / 2, side="right") - 1
        on = (own >= 0) & (own < len(edges) - 1)
        own = own[on]
        piece = (edges[own + 1] - edges[own])[:, None]
        # What every piece adds to A at its end and to B at its start.
        ahead, behind = np.zeros((2, len(h), coefficients.shape[2]), dtype=complex)
        for point, weight in zip((_POINTS + 1) / 2, _WEIGHTS / 2, strict=True):
            local = (places[:-1][on] + point * h[on] - edges[own])[:, None] / piece
            value = coefficients[own, 3]
            for k in (2, 1, 0):
                value = coefficients[own, k] + local * value
            fade = weight * h[on, None] * np.exp(-pole * (1.0 - point) * h[on, None])
            ahead[on] += fade * value
            back = weight * h[on, None] * np.exp(-pole * point * h[on, None])
            behind[on] += back * value
        decay = np.exp(-pole * h)
        a, b = _running(decay, ahead), _running(decay[::-1], behind[::-1])[::-1]
        at = np.searchsorted(places, nodes)
        values = (pole / 2 * (a + b))[at].real
        slopes = (pole**2 / 2 * (b - a))[at].real
        return nodes, _hermite(np.diff(nodes)[:, None], values, slopes)


def _running(decay: np.ndarray, added: np.ndarray) -> np.ndarray:
    """Return A at n + 1 places: A[0] = 0, A[j + 1] = decay[j] A[j] + added[j]."""
    bands = np.ones((2, len(decay) + 1), dtype=complex)
    bands[1, :-1] = -decay
    start = np.zeros((1, added.shape[1]))
    return solve_banded((1, 0), bands, np.concatenate([start, added]))


def _hermite(h: np.ndarray, values: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Return the cubics through values and slopes, powers of the local coordinate 0..1."""
    rise, start, end = np.diff(values, axis=0), h * slopes[:-1], h * slopes[1:]
    powers = [values[:-1], start, 3 * rise - 2 * start - end, start + end - 2 * rise]
    return np.stack(powers, axis=1)
