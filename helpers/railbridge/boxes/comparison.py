"""Modes of two models side by side.

How much alike, which belongs to which, a shell's against a beam's.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from .. import errors
from ..beams.beam import Beam
from ..errors import InputError
from .motions import ShellModes
from .shell import Shell

__all__ = ["beam_motions", "mac", "pairs", "shell_against_beam"]


def mac(a: np.ndarray, b: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
    """Return the modal assurance criterion of two sets of shapes.

    ``(a.b)^2 / (a.a b.b)`` with weights (mass).

    Parameters
    ----------
    a : ndarray, shape (n, m)
    b : ndarray, shape (n, k)
    weights : ndarray, shape (n,), optional
        Mass that belongs to each entry.

    Returns
    -------
    ndarray, shape (m, k)
        1: the same shape; 0: none of it (orthogonal). A pair below about 0.8 is no pair.

    Raises
    ------
    InputError
        Sets that do not have the same rows, or a shape that is zero.
    """
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    if a.ndim != 2 or b.ndim != 2 or len(a) != len(b):
        raise InputError(
            "mac", (a.shape, b.shape), "both sets need the same rows, one column a shape"
        )
    w = (
        np.ones(len(a))
        if weights is None
        else errors.numbers("weights", weights, count=len(a), least=0.0)
    )
    norm_a, norm_b = np.einsum("n,nm->m", w, a**2), np.einsum("n,nm->m", w, b**2)
    for name, norm in (("first", norm_a), ("second", norm_b)):
        if np.any(norm == 0.0):
            raise InputError(
                "mac", int(np.argmin(norm)) + 1, f"this shape of the {name} set is zero"
            )
    return (a.T @ (w[:, None] * b)) ** 2 / np.outer(norm_a, norm_b)


def pairs(criterion: np.ndarray, least: float = 0.5) -> dict[int, int]:
    """Pair the rows of a criterion with its columns, best first; pairs below `least` are left out.

    Returns
    -------
    dict
        Column by row, both from 0.
    """
    rows, columns = linear_sum_assignment(-np.asarray(criterion))
    return {int(r): int(c) for r, c in zip(rows, columns, strict=True) if criterion[r, c] >= least}


def beam_motions(beam: Beam, x: np.ndarray, height: float = 0.0) -> np.ndarray:
    """Return the rigid motions of a beam's sections in its modes.

    Parameters
    ----------
    beam : Beam
        Of one piece.
    x : ndarray, shape (s,)
        Places, m.
    height : float
        m above the deck axis, of the point whose translations are wanted.

    Returns
    -------
    ndarray, shape (s, 6, m)
        x y z roll pitch yaw in all modes of the mesh, as `motions.section_motions`; straight
        between nodes.
    """
    mesh, vectors = beam.mesh, beam.modes.vectors
    nodal = vectors[: 6 * len(mesh.nodes)].reshape(len(mesh.nodes), 6, -1)
    right = np.clip(np.searchsorted(mesh.nodes, x), 1, len(mesh.nodes) - 1)
    share = np.clip(
        (x - mesh.nodes[right - 1]) / (mesh.nodes[right] - mesh.nodes[right - 1]), 0.0, 1.0
    )[:, None, None]
    u, v, w, roll, yaw, minus_pitch = (
        (1 - share) * nodal[right - 1] + share * nodal[right]
    ).transpose(1, 0, 2)
    # u is that of the centroid, v and w those of the axis.
    along = u - minus_pitch * (height - beam.centroid_height)
    return np.stack([along, v - roll * height, w, roll, -minus_pitch, yaw], axis=1)


def shell_against_beam(
    shell: Shell, modes: ShellModes, beam: Beam, height: float, count: int = 30
) -> np.ndarray:
    """Return the modal assurance criterion between a shell's modes and the lowest modes of a beam.

    Both are compared as rigid motions of the sections, weighted with the section's mass and
    inertias. The shell's own norm counts its local motion, too: a mode of the plates is like no
    mode of the beam.

    Parameters
    ----------
    shell, modes
        The shell and its modes.
    beam : Beam
    height : float
        m, of the shell's centre of mass above the deck axis of the beam.
    count : int
        Modes of the beam.

    Returns
    -------
    ndarray, shape (modes of the shell, count)
    """
    inside = (shell.stations >= 0.0) & (shell.stations <= beam.length)
    theirs = beam_motions(beam, shell.stations[inside], height)[:, :, :count]
    weights = np.repeat(shell.tributary[inside], 6) * np.tile(shell.inertias, int(inside.sum()))
    ours = modes.motions[inside].reshape(len(weights), -1)
    rigid = 1.0 - modes.shares["local"]
    return mac(ours, theirs.reshape(len(weights), -1), weights) * rigid[:, None]
