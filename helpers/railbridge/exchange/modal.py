r"""A deck of which only the modes are known: those of another program's model, under the rail.

A line of nodes carries the rail; at each of its places the deck axis moves

* with one node, as on a rigid arm: v = uy + z rx, w = uz - y rx, twist rx, for a node at (y, z)
  from the axis;
* with a left and a right node, as in solid and shell models: twist is the difference of uz over
  their distance, w lies on the straight line through both uz, v is the mean of uy moved by the
  twist.

A single line without rx makes the deck rigid in twist. Between the places v and w are cubic:
Hermite's with w' = -ry and v' = rz where a single line has rotations (those of the cross-section),
otherwise splines through the displacements. Twist is a parabola through places 1-2-3, 3-4-5 and so
on (a last single piece takes the last three), or a spline from a pair of lines. Only where the file
of nodes says ``# pieces: cubic`` all three are cubics through places 1-2-3-4, 4-5-6-7 and so on;
that is how `export_modes` writes a deck, so that it comes back exactly.

Modes alone give no section forces, reactions or self-weight (`Deck.recovery` is None), and their
sum lacks the static flexibility of the modes left out.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

from .. import errors
from ..cautions import (
    BOUNDS,
    UNUSUAL,
    first_vertical,
    frequency_off,
    longest_span,
    scale_in_doubt,
    usual_frequencies,
)
from ..damping import RATIO, Damping, checked_damping, damping_ratios
from ..decks import Deck, cut_group
from ..errors import InputError, Remark, ResultWarning, brief
from ..guideways import PiecewiseCubic
from .interpolation import cubics, hermite, parabolas, spline
from .nodes import Nodes, RailLine

__all__ = ["ModalModel", "Orthogonality", "deck_from_modes"]

_FAR = 10.0
"""How far a first frequency may lie off the range of EN 1991-2 without being refused."""


_MISFIT = 0.2
"""Share by which rotations may miss the slopes and still be used as slopes."""
_STILL = 1e-3
"""Motion in the middle of a span, share of the largest anywhere, below which it stands still."""


@dataclass(frozen=True)
class Orthogonality:
    """How far from orthogonal the modes of a model are.

    Attributes
    ----------
    worst : float
        Largest of abs(phi_i M phi_j) / sqrt((phi_i M phi_i) (phi_j M phi_j)); zero for exact
        modes.
    pair : tuple of str
        The modes it stands between.
    known_masses : bool
        Whether M is the model's, or equal masses at all nodes for want of them.
    own : ndarray, shape (m,)
        phi_i M phi_i, which is 1 for mass-normalised modes; NaN without masses.
    """

    worst: float
    pair: tuple[str, str]
    known_masses: bool
    own: np.ndarray


@dataclass(frozen=True, eq=False)
class ModalModel:
    """Natural modes of a finite-element model, SI, our axes.

    Attributes
    ----------
    nodes : Nodes
    frequencies_hz : ndarray, shape (m,)
        Ascending.
    damping_ratios : ndarray, shape (m,)
        NaN where the file gives none.
    labels : tuple of str
        The modes as the file calls them.
    names : tuple of str, or None
        Column ``name``.
    shapes : ndarray, shape (m, n, 6)
        Mass-normalised ux, uy, uz, rx, ry, rz (1/sqrt(kg), 1/(m sqrt(kg))); NaN at nodes that the
        modes leave out.
    rotations : tuple of bool
        Whether rx, ry, rz are known.
    masses : ndarray, shape (n, 4), or None
        Mass (kg) and inertia about x, y, z (kg m2) of every node.
    """

    __repr__ = brief

    nodes: Nodes
    frequencies_hz: np.ndarray
    damping_ratios: np.ndarray
    labels: tuple[str, ...]
    names: tuple[str, ...] | None
    shapes: np.ndarray
    rotations: tuple[bool, bool, bool]
    masses: np.ndarray | None = None

    def to_frame(self):
        """Return a pandas DataFrame with one row a mode."""
        import pandas as pd

        columns = {"frequency (Hz)": self.frequencies_hz, "damping ratio": self.damping_ratios}
        return pd.DataFrame(columns, index=pd.Index(self.labels, name="mode"))

    def orthogonality(self) -> Orthogonality:
        """Compare every two modes over the nodal masses, or over equal masses where none are known.

        Wrong when: without masses on meshes of uneven density, where true modes may overlap by tens
        of per cent.
        """
        there = np.isfinite(self.shapes[0, :, 0])
        if self.masses is None:
            masses = np.ones((there.sum(), 1)) * [1.0, 0.0, 0.0, 0.0]
        else:
            masses = self.masses[there]
        translations = np.repeat(masses[:, :1], 3, axis=1)
        weights = np.sqrt(np.concatenate([translations, masses[:, 1:]], axis=1))
        # Weighted by the roots first: small entries then do not vanish beside large ones.
        weighted = (self.shapes[:, there] * weights).reshape(len(self.labels), -1)
        gram = weighted @ weighted.T
        own = np.diag(gram).copy()
        # A mode of pure rotation where no inertia is known has nothing to compare.
        moving = own > (0.1 if self.masses is not None else 1e-12 * own.max())
        size = np.sqrt(np.where(moving, own, np.inf))
        overlap = np.abs(np.triu(gram / np.outer(size, size), 1))
        i, j = np.unravel_index(np.argmax(overlap), overlap.shape)
        pair, known = (self.labels[i], self.labels[j]), self.masses is not None
        return Orthogonality(
            float(overlap[i, j]), pair, known, own if known else np.full_like(own, np.nan)
        )


def deck_from_modes(
    model: ModalModel,
    line: RailLine,
    name: str = "deck",
    damping: Damping | None = None,
    *,
    count: int | None = None,
    tracks: Mapping[str, float] | None = None,
    width: float | None = None,
    track_height: float = 0.0,
    supports: Sequence[float] = (),
    unusual: bool = False,
) -> Deck:
    """Return the modal deck that a model makes under its rail line.

    Parameters
    ----------
    model : ModalModel
    line : RailLine
        From ``model.nodes.line(...)``.
    name : str
    damping : float, tuple of float, or ModalDamping, optional
        As for `Beam.deck`, instead of the file's own; needed where it has none.
    count : int, optional
        How many of the lowest modes that move the rail are kept; all if not given.
    tracks, width, track_height, supports
        See `Deck`; places of bearing lines in m from the first node are only drawn.
    unusual : bool
        Accept frequencies and masses beyond those of bridges.

    Raises
    ------
    InputError
        Rail nodes that the modes leave out, no damping, or a first frequency or mass per metre so
        far from those of bridges that the units must be wrong.
    """
    place = {label: i for i, label in enumerate(model.nodes.labels)}
    index = np.array([[place[label] for label in pair] for pair in line.labels])
    shapes = model.shapes[:, index]
    for i, j in np.argwhere(~np.isfinite(shapes[0, :, :, 0]))[:1]:
        allowed = "is a node of the rail that the modes leave out"
        raise InputError("line", line.labels[i][j], allowed, "Write the modes there too")
    said: list[Remark] = []
    functions = _along(line, shapes, model.rotations, said)
    motion = _motion(functions)
    size = np.sum(motion**2, axis=-1)
    if not size.any():
        remedy = "Does it run along the deck's bearings?"
        raise InputError("line", None, "stands still in every mode", remedy)
    kept = np.flatnonzero(np.sqrt(size.sum(axis=1) / size.sum(axis=1).max()) > 1e-6)
    everything = kept
    if count is not None:
        kept = kept[: errors.integer("count", count, least=1, most=len(kept))]
    supports = _checked_supports(supports, line.length)
    frequencies = model.frequencies_hz[kept]
    remarks = cut_group("modes.count", model.frequencies_hz[everything], len(kept))
    remarks += _still(functions, kept, supports)
    rail = PiecewiseCubic(functions.edges, functions.coefficients[:, :, kept])
    if not unusual:
        _refuse_units(line, supports, frequencies, rail, size[kept])
    if model.masses is None:
        _warn_of_overlap(model, motion, kept, said)
    if damping is not None:
        if np.isscalar(damping):
            RATIO.checked("damping", damping)
        ratios = damping_ratios(checked_damping(damping), frequencies)
    elif np.isfinite(model.damping_ratios).all():
        ratios = model.damping_ratios[kept]
    else:
        remedy = "Add the column damping_ratio to the modes, or damping = { modal = 0.01 } to the "
        raise InputError("damping", None, "is missing", remedy + "deck")
    made = Deck(
        name=name,
        length=line.length,
        frequencies_hz=frequencies,
        damping_ratios=ratios,
        mode_names=_names(model, size, kept),
        shapes=rail,
        supports=supports,
        tracks=dict(tracks or {}),
        width=width,
        track_height=track_height,
        remarks=(*remarks, *said),
    )
    accepted = unusual and scale_in_doubt(made)
    return replace(made, remarks=(*made.remarks, Remark(*UNUSUAL))) if accepted else made


def _warn(said: list[Remark], text: str) -> None:
    """Warn whoever reads the modes, and keep the sentence for the results."""
    warnings.warn(text, stacklevel=4)
    said.append(Remark("", text))


def _still(functions: PiecewiseCubic, kept: np.ndarray, supports: Sequence[float]) -> list[Remark]:
    """Name a span that no mode moves up and down, as where a program was asked for too few."""
    edges = np.unique([functions.edges[0], functions.edges[-1], *supports])
    inside = (edges[1:] + edges[:-1]) / 2
    moving = np.abs(functions(inside)[:, kept, 1]).max(axis=1)
    everywhere = np.linspace(edges[0], edges[-1], 201)
    largest = np.abs(functions(everywhere)[:, kept, 1]).max()
    if largest == 0.0:
        return [ResultWarning("modes", "move nothing up and down: vertical results are null.")]
    still = np.flatnonzero((moving < _STILL * largest) & (np.diff(edges) > 1e-6 * edges[-1]))
    if not len(still):
        return []
    i, others = still[0], len(still) - 1
    text = (
        f"move nothing up and down from x = {edges[i]:g} to {edges[i + 1]:g} m"
        + f", nor in {others} other span{'s' * (others > 1)}" * (others > 0)
        + ": too few modes were written."
    )
    return [ResultWarning("modes", text)]


def _checked_supports(supports: Sequence[float], length: float) -> tuple[float, ...]:
    """Return the places of bearing lines, m, ascending; refuse two at one place."""
    found = np.sort(errors.places("supports", supports, (0.0, length), slack=errors.ROUNDED))
    if np.any(np.diff(found) < 1e-3 * length):
        allowed = "two bearing lines stand at one place"
        raise InputError("supports", found, allowed, "Give each line once, m from the first node")
    return tuple(found.tolist())


def _along(
    line: RailLine, shapes: np.ndarray, rotations: tuple[bool, bool, bool], said: list[Remark]
) -> PiecewiseCubic:
    """Return the shapes along the deck axis from those of the line's nodes, shape (m, n, k, 6).

    What is doubtful about them is warned of and added to `said`.
    """
    _, uy, uz, rx, ry, rz = np.moveaxis(shapes, -1, 0)
    lateral, vertical, twist = line.axis_motion(uy, uz, rx)
    if line.cubic and len(line.x) % 3 == 1:
        whole = [cubics(line.x, v) for v in (lateral, vertical, twist)]
        return PiecewiseCubic(line.x[::3], np.stack(whole, axis=-1))
    result = np.zeros((len(line.x) - 1, 4, len(shapes), 3))
    for c, value, slope, known, name, rotation in (
        (0, lateral, rz, rotations[2], "uy", "rz"),
        (1, vertical, -ry, rotations[1], "uz", "-ry"),
    ):
        misfit = _misfit(line.x, value, slope[..., 0]) if known and not line.paired else np.inf
        if misfit < _MISFIT:
            result[..., c] = hermite(line.x, value, slope[..., 0])
        else:
            if np.isfinite(misfit):
                text = f"modes: {rotation} is not the slope of {name} along the rail (off by "
                text += f"{misfit:.0%} at best), so slopes are taken from the displacements."
                _warn(said, text)
            _warn_of_few_nodes(value, name, said)
            result[..., c] = spline(line.x, value)
    result[..., 2] = spline(line.x, twist) if line.paired else parabolas(line.x, twist)
    return PiecewiseCubic(line.x, result)


def _misfit(x: np.ndarray, values: np.ndarray, slopes: np.ndarray) -> float:
    """Return how far rotations are from the slopes of the displacements, where they fit best.

    Usual reasons why they are not: drilling rotations of shells, left-handed rotations, other units
    of the angle.
    """
    from_values = CubicSpline(x, values, axis=-1)(x, 1)
    size = np.linalg.norm(from_values, axis=1)
    bent = size > 1e-3 * size.max()
    misfit = np.linalg.norm(slopes - from_values, axis=1)[bent] / size[bent]
    return float(misfit.min()) if len(misfit) else 0.0


def _warn_of_few_nodes(values: np.ndarray, name: str, said: list[Remark]) -> None:
    """Warn of modes that change sign more than once in three nodes: no spline can follow them."""
    large = np.abs(values) > 1e-3 * np.abs(values).max()
    changes = [(np.diff(np.sign(v[use])) != 0).sum() for v, use in zip(values, large, strict=True)]
    if max(changes) > values.shape[1] / 3:
        mode = int(np.argmax(changes)) + 1
        text = f"modes: the {values.shape[1]} nodes of the rail are few for {name} of mode {mode}"
        text += f", which changes sign {max(changes)} times. Use a finer line, fewer modes, or "
        _warn(said, text + "write rotations too.")


def _motion(functions: PiecewiseCubic) -> np.ndarray:
    """Return v, w and 1.5 m twist at points along the rail, shape (m, 3, points).

    They are multiplied by the root of each point's length: sums of products over the points are
    then integrals along the deck.
    """
    points, weights = np.polynomial.legendre.leggauss(4)
    h = np.diff(functions.edges)
    x = (functions.edges[:-1, None] + h[:, None] * (points + 1) / 2).ravel()
    values = functions(x) * [1.0, 1.0, 1.5]
    lengths = (h[:, None] * weights / 2).ravel()
    return np.moveaxis(values * np.sqrt(lengths)[:, None, None], 0, -1)


def _warn_of_overlap(
    model: ModalModel, motion: np.ndarray, kept: np.ndarray, said: list[Remark]
) -> None:
    """Warn of modes that look alike along the rail of a uniform deck.

    Without masses nobody can say more. Only modes of the whole deck that hardly twist are compared,
    those with as much mass at the rail as the first of them: at a rail off the shear centre twist
    looks like bending, and local modes may look like anything.
    """
    size = np.sum(motion[kept] ** 2, axis=-1)
    whole = size.sum(axis=1)
    calm = size[:, 2] < 0.1 * whole
    bending = kept[calm & (np.abs(np.log2(whole / whole[np.argmax(calm)])) < 1.0)]
    flat = motion[bending].reshape(len(bending), -1)
    flat = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    overlap = np.abs(np.triu(flat @ flat.T, 1))
    if overlap.max(initial=0.0) > 0.3:
        i, j = np.unravel_index(np.argmax(overlap), overlap.shape)
        pair = f"modes {model.labels[bending[i]]} and {model.labels[bending[j]]}"
        text = f"modes: {pair} overlap by {overlap[i, j]:.2f} along the rail of a uniform deck. "
        _warn(said, text + "Give the nodal masses to have their orthogonality checked.")


def _names(model: ModalModel, size: np.ndarray, kept: np.ndarray) -> tuple[str, ...]:
    """Return the model's names, or name modes by their largest motion along the rail."""
    if model.names is not None:
        return tuple(model.names[i] for i in kept)
    seen, names = {}, []
    for i in kept:
        label = ("lateral", "vertical", "torsion")[int(np.argmax(size[i]))]
        seen[label] = seen.get(label, 0) + 1
        names.append(f"{label} {seen[label]}")
    return tuple(names)


def _refuse_units(
    line: RailLine,
    supports: Sequence[float],
    frequencies: np.ndarray,
    functions: PiecewiseCubic,
    size: np.ndarray,
) -> None:
    """Refuse a first frequency or a mass per metre beyond those of bridges by orders of magnitude.

    That of the first mode that moves up and down, if there is one. A mass-normalised mode in which
    the deck moves as a whole has an integral of phi^2 of about 1 / mass per metre.
    """
    vertical = first_vertical(size)
    mode = 0 if vertical is None else vertical
    x = np.linspace(0.0, line.length, 201)
    shape = None if vertical is None else functions(x)[:, mode, 1]
    span = longest_span(supports, line.length, x, shape)
    first = float(frequencies[mode])
    if abs(frequency_off(first, span)) > _FAR:
        allowed = f"lies an order of magnitude away: {usual_frequencies(span)}"
        remedy = "Check the units of length (mm or m?) and of frequency (Hz, not rad/s); "
        remedy += "unusual = true if the deck is so"
        raise InputError("modes: first frequency", first, allowed, remedy)
    usual = BOUNDS["mass"]
    mass = 1.0 / (size[0].max() if vertical is None else size[vertical, 1])
    if not usual.low < mass < usual.high:
        allowed = f"make the deck {mass:.3g} kg per metre"
        allowed += f", bridges have {usual.low:g} to {usual.high:g}"
        remedy = "Check the unit of mass (kg or t?); shapes scaled to a largest value of 1 need "
        remedy += "the column modal_mass"
        raise InputError("modes: shapes", None, allowed, remedy)
