"""Prismatic shells on bearings of stated size, and their natural modes.

The plates are in `plates`, what bearings hold in `pads`, what the modes are called in `motions`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import csc_array, csr_array

from .. import errors
from ..beams.eigen import lowest
from ..errors import InputError, brief
from ..guideways import PiecewiseCubic
from ..settings import refuse_bytes
from .motions import ShellModes, described, sectionwise
from .pads import Pad, elimination, free_motion_count, support_rows
from .plates import PlateModel, freedoms_of

__all__ = ["Shell", "shell_bytes"]


def shell_bytes(freedoms: int, modes: int) -> float:
    """Return about how much memory the modes of a shell need, bytes.

    Its matrices when they are factorised, measured from 8 000 to 124 000 freedoms, and its shapes.
    """
    return 7.0e3 * freedoms * (freedoms / 1e5) ** 0.3 + 40.0 * freedoms * modes + 1.2e8


@dataclass(frozen=True, eq=False)
class Shell(PlateModel):
    """A prismatic shell on pads.

    Attributes
    ----------
    points, strips, stations, youngs_modulus, poisson_ratio, density, plates, line_masses
        See `PlateModel`.
    pads : tuple of Pad

    Raises
    ------
    InputError
        Pads that leave the shell a mechanism, or pads or plates off the shell.
    """

    __repr__ = brief

    pads: tuple[Pad, ...] = ()

    def __post_init__(self) -> None:
        start, end = self.stations[0], self.stations[-1]
        for i, pad in enumerate(self.pads, start=1):
            errors.number(
                f"pads[{i}].x",
                pad.x,
                least=start,
                most=end,
                unit="m",
                remedy="It lies off the deck",
            )
            errors.number(f"pads[{i}].length", pad.length, above=0.0, unit="m")
        free = free_motion_count(self._support_rows, self.nodes, end - start)
        if free:
            given = [(p.x, " ".join((*p.fixed, *p.stiffness))) for p in self.pads]
            raise InputError(
                "pads", given, f"leave {free} ways to move as a rigid body, so it is a mechanism",
                "Hold x once, and y and z at two places",
            )  # fmt: skip

    @cached_property
    def _support_rows(self) -> list[tuple[csr_array, float]]:
        return support_rows(self.pads, self.stations, len(self.points), 6 * len(self.nodes))

    @cached_property
    def _turn(self) -> tuple[csr_array, np.ndarray]:
        return elimination(self._support_rows, 6 * len(self.nodes))

    @cached_property
    def _reduced(self) -> tuple[csc_array, csc_array]:
        """K and M with the bearings, over the freedoms that are left."""
        k, m = self.matrices
        for row, stiffness in self._support_rows:
            if np.isfinite(stiffness):
                k = k + stiffness * (row.T @ row)
        turn, _ = self._turn
        return csc_array(turn.T @ k @ turn), csc_array(turn.T @ m @ turn)

    # ---- modes

    def modes(self, count: int = 15) -> ShellModes:
        """Return the lowest modes.

        Raises
        ------
        InputError
            More modes than a quarter of the freedoms.
        """
        count = errors.integer("modes", count, least=1)
        needed = shell_bytes(6 * len(self.nodes), count)
        refuse_bytes("modes", count, needed, "so many", "Use fewer modes or a coarser mesh")
        k, m = self._reduced
        count = errors.integer("modes", count, least=1, most=max(k.shape[0] // 4, 1))
        squares, vectors = lowest(k, m, count)
        full = (self._turn[0] @ vectors).reshape(len(self.nodes), 6, count)
        large = np.abs(full[:, :3]).reshape(-1, count)
        sign = np.sign(
            full[:, :3].reshape(-1, count)[
                np.argmax(large > 0.5 * large.max(axis=0), axis=0), np.arange(count)
            ]
        )
        return described(self, np.sqrt(squares) / (2 * np.pi), full * sign)

    def quotients(self, vectors: np.ndarray) -> np.ndarray:
        """Return Rayleigh's quotients of given shapes, as frequencies, Hz.

        With the modes of a shell that differs little they are its frequencies but for the square of
        the difference, and cost no solution: derivatives by dimensions follow from them.

        Parameters
        ----------
        vectors : ndarray, shape (nodes, 6, m)
            Of a shell with the same mesh and the same kind of bearings.
        """
        turn, left = self._turn
        moved = turn @ vectors.reshape(-1, vectors.shape[-1])[left]
        k = sum(
            stiffness * (row @ moved).ravel() ** 2
            for row, stiffness in self._support_rows
            if np.isfinite(stiffness)
        )
        m = self._point_inertia @ moved**2
        for stiffness, mass, quads in self._elements:
            corners = moved[freedoms_of(quads)]
            k = k + np.einsum("eim,eim->m", corners, np.einsum("ij,ejm->eim", stiffness, corners))
            m = m + np.einsum("eim,eim->m", corners, np.einsum("ij,ejm->eim", mass, corners))
        return np.sqrt(k / m) / (2 * np.pi)

    def shapes(
        self, vectors: np.ndarray, points: tuple[int, int], start: float, end: float
    ) -> PiecewiseCubic:
        """Return shapes along the deck as the line through two points of the section moves.

        Lateral and vertical are the mean of the two points, twist is the difference of their
        heights over their distance: for the two web heads that is what the rails do, which stand
        nearly above the webs. A cubic spline joins stations.

        Parameters
        ----------
        vectors : ndarray, shape (nodes, 6, m)
        points : (left, right)
            Points of the section.
        start, end : float
            m, the range of x, both stations.
        """
        moved = sectionwise(self, vectors)
        left, right = moved[:, points[0]], moved[:, points[1]]
        apart = self.points[points[0], 0] - self.points[points[1], 0]
        middle = (left + right) / 2
        values = np.stack([middle[:, 1], middle[:, 2], (left[:, 2] - right[:, 2]) / apart], axis=2)
        spline = CubicSpline(self.stations, values)
        inside = np.flatnonzero((self.stations > start - 1e-9) & (self.stations < end + 1e-9))
        edges = self.stations[inside]
        h = np.diff(edges)
        # CubicSpline keeps the highest power first, of x - edge in m.
        powers = spline.c[::-1, inside[:-1]].transpose(1, 0, 2, 3)
        return PiecewiseCubic(
            edges - start, powers * h[:, None, None, None] ** np.arange(4)[:, None, None]
        )
