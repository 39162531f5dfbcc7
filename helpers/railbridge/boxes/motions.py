"""How the sections of a shell move in its modes, and what the modes are called.

At each station the motion of the section is split into the rigid motion nearest to it (least
squares with the mass) and the rest. The kinetic energy falls into five parts accordingly: vertical
(with pitch), lateral (with yaw), torsion, axial, and local: distortion and bending of the plates.
See `ShellModes` for the rule of the names.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..errors import brief
from .plates import PlateModel

__all__ = ["KINDS", "ShellModes", "described", "section_motions", "sectionwise"]

KINDS = ("vertical", "lateral", "torsion", "axial", "local")
"""The parts of a mode's kinetic energy."""

_LABELS = {
    "vertical": "vertical bending", "lateral": "lateral bending", "torsion": "torsion",
    "axial": "axial", "mixed": "axial-bending", "local": "local plate",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class ShellModes:
    """Natural modes of a shell, ascending.

    The rule of the names: local where the local part of the kinetic energy exceeds a half;
    axial-bending where the axial part is between a quarter and three quarters of axial and vertical
    together, and both are more than the rest; else the kind of the largest part.

    Attributes
    ----------
    frequencies_hz : ndarray, shape (m,)
    names : tuple of str
        ``vertical bending 1``, ``axial-bending 1``, ``local plate 1`` ..., numbered within each
        kind.
    shares : dict of ndarray, shape (m,)
        Parts of the kinetic energy: vertical, lateral, torsion, axial, local; their sum is 1.
    motions : ndarray, shape (stations, 6, m)
        The section's rigid motion about its centre of mass: x y z roll pitch yaw, mass-normalised.
    parts : tuple of str
        Which part of the section moves most in the local share: slab, cantilevers ...
    symmetric : ndarray of bool, shape (m,)
        Whether left and right move alike (mirror image); vertical modes are, torsion is not.
    vectors : ndarray, shape (nodes, 6, m)
        All displacements and rotations, mass-normalised.
    """

    __repr__ = brief

    frequencies_hz: np.ndarray
    names: tuple[str, ...]
    shares: dict[str, np.ndarray]
    motions: np.ndarray = field(repr=False)
    parts: tuple[str, ...] = field(repr=False)
    symmetric: np.ndarray = field(repr=False)
    vectors: np.ndarray = field(repr=False)

    def to_frame(self):
        """Return a pandas DataFrame with one row a mode.

        Frequency, name, where it is local, shares of energy in percent.
        """
        import pandas as pd

        columns = {
            "frequency (Hz)": self.frequencies_hz,
            "name": self.names,
            "most local in": self.parts,
        }
        columns |= {f"{k} (%)": 100 * v for k, v in self.shares.items()}
        return pd.DataFrame(columns, index=pd.RangeIndex(1, len(self.names) + 1, name="mode"))


def sectionwise(shell: PlateModel, vectors: np.ndarray) -> np.ndarray:
    """Return the displacements of the section's points, shape (stations, points, 3, m)."""
    count = len(shell.stations) * len(shell.points)
    return vectors[:count, :3].reshape(len(shell.stations), len(shell.points), 3, -1)


def section_motions(shell: PlateModel, vectors: np.ndarray) -> np.ndarray:
    """Return the rigid motion of each section that is nearest to nodal vectors.

    It turns about the centre of mass.

    Parameters
    ----------
    shell : PlateModel
    vectors : ndarray, shape (nodes, 6, m)

    Returns
    -------
    ndarray, shape (stations, 6, m)
        x y z roll pitch yaw, by least squares with the mass.
    """
    moved = sectionwise(shell, vectors)
    y, z = (shell.points - shell.centre).T
    zero, one = np.zeros_like(y), np.ones_like(y)
    rigid = np.stack(
        [
            np.stack([one, zero, zero, zero, z, -y]),
            np.stack([zero, one, zero, -z, zero, zero]),
            np.stack([zero, zero, one, y, zero, zero]),
        ],
        axis=1,
    )  # (6, 3, points)
    weighted = rigid * shell.point_masses
    gram = np.einsum("acp,bcp->ab", weighted, rigid)
    return np.einsum("ab,bcp,spcm->sam", np.linalg.pinv(gram), weighted, moved)


def described(shell: PlateModel, frequencies: np.ndarray, vectors: np.ndarray) -> ShellModes:
    """Attach names, shares of energy and section motions to modes.

    Frequencies (Hz) and mass-normalised vectors.
    """
    motions, moved = section_motions(shell, vectors), sectionwise(shell, vectors)
    parts = np.einsum("s,a,sam->am", shell.tributary, shell.inertias, motions**2)
    total = np.einsum("s,p,spcm->m", shell.tributary, shell.point_masses, moved**2)
    x, y, z, roll, pitch, yaw = parts / total
    shares = {"vertical": z + pitch, "lateral": y + yaw, "torsion": roll, "axial": x}
    shares["local"] = np.clip(1.0 - sum(shares.values()), 0.0, None)
    names, seen = [], dict.fromkeys(_LABELS, 0)
    for i in range(len(frequencies)):
        kind = _kind({k: float(v[i]) for k, v in shares.items()})
        seen[kind] += 1
        names.append(f"{_LABELS[kind]} {seen[kind]}")
    return ShellModes(
        frequencies,
        tuple(names),
        shares,
        motions,
        _liveliest(shell, moved),
        _symmetric(shell, moved),
        vectors,
    )


def _liveliest(shell: PlateModel, moved: np.ndarray) -> tuple[str, ...]:
    """Name the part of the section that moves most, by mean square displacement, in each mode."""
    square = np.einsum("s,spcm->pm", shell.tributary, moved**2)
    names = list(dict.fromkeys(s.part for s in shell.strips if s.counted))
    means = []
    for name in names:
        own = [s for s in shell.strips if s.part == name]
        lengths = np.array(
            [np.linalg.norm(shell.points[s.end] - shell.points[s.start]) for s in own]
        )
        values = np.array([(square[s.start] + square[s.end]) / 2 for s in own])
        means.append(lengths @ values / lengths.sum())
    return tuple(names[i] for i in np.argmax(means, axis=0))


def _symmetric(shell: PlateModel, moved: np.ndarray) -> np.ndarray:
    """Whether each mode is its own mirror image rather than its opposite.

    All true for a section without mirror.
    """
    mirrored = shell.points * [-1.0, 1.0]
    away = np.linalg.norm(shell.points[:, None] - mirrored[None], axis=2)
    twin = np.argmin(away, axis=0)
    if away[twin, np.arange(len(twin))].max() > 1e-6:
        return np.ones(moved.shape[-1], dtype=bool)
    product = np.einsum(
        "c,p,spcm,spcm->m", [1.0, -1.0, 1.0], shell.point_masses, moved, moved[:, twin]
    )
    return product >= 0.0


def _kind(shares: dict[str, float]) -> str:
    if shares["local"] > 0.5:
        return "local"
    along = shares["axial"] + shares["vertical"]
    if along > 0.5 and 0.25 <= shares["axial"] / along <= 0.75:
        return "mixed"
    return max(("vertical", "lateral", "torsion", "axial"), key=lambda k: shares[k])
