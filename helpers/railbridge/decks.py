r"""A deck is a modal deck: frequencies, damping, shapes, and how to recover the rest.

With mass-normalised shapes v_m, w_m (lateral, vertical) and theta_m (twist) each mode obeys

    q'' + 2 zeta omega q' + omega^2 q
        = sum over loads of (v F_y + w F_z + theta M_x - w' M_y + v' M_z) at the load's place x = V
        t - d,

with M_x about the deck axis. How loads travel and what wheels feel is in `guideways`.

A displacement, section force or reaction has the modal value S_m: what one unit of q_m gives. The
modes left out answer the loads as if these stood still (the static influence line under the present
loads, less its modal part, the *residual* r), and the part beta K of Rayleigh damping is viscosity
inside the deck and its bearings, so its forces are carried by sections and bearings. A mode left
out, with ``beta q' + q = f / omega^2`` far above the loads' frequencies, lags behind by beta. So

    displacements    sum S_m q_m + r lagged by beta,
    forces           sum S_m (q_m + beta q_m') + r,

and the second is the static value less ``S_m / omega_m^2 (q'' + alpha q')``: inertia and outer
damping, which Newton's law for the whole deck asks for. A damping given as one ratio for every
mode tells nothing of where it acts: beta is then zero.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from . import errors
from .errors import InputError, Remark, ResultWarning, brief, frozen
from .guideways import COMPONENTS, Guideway, PiecewiseCubic
from .response import SampledModes, lagged, sampled_modes
from .units import without_rounding

__all__ = [
    "BEARING_QUANTITIES", "Deck", "EQUAL", "History", "Line", "ModesOnly", "REACTION_QUANTITIES",
    "Recovery", "SECTION_QUANTITIES", "combined", "cut_group", "load_of", "whole_group",
]  # fmt: skip

SECTION_QUANTITIES = {
    "displacement_y": "m", "displacement_z": "m", "rotation_x": "rad", "rotation_y": "rad",
    "rotation_z": "rad", "moment_vertical": "N m", "moment_lateral": "N m", "torsion": "N m",
    "shear_vertical": "N", "shear_lateral": "N",
}  # fmt: skip
"""What a deck recovers at a section, with units.

Rotations are right-handed and those of the section, which bearings and the gaps at a deck's ends
feel: rotation_y = -psi_w and rotation_z = psi_v. Without shear flexibility psi is the slope of the
deck axis, w' and v'; with it the axis' slope is larger by the shear strain. Where only modes along
the axis are known, it is the axis' slope.
"""
REACTION_QUANTITIES = {"force_x": "N", "force_y": "N", "force_z": "N", "moment_x": "N m"}
"""What a deck recovers at a bearing line, with units."""
BEARING_QUANTITIES = {**REACTION_QUANTITIES, "moment_y": "N m", "moment_z": "N m"}
"""What a deck recovers of one bearing, with units; moments about the bearing itself."""


def load_of(quantity: str) -> str:
    """Return the load of a quantity's own direction, one of `guideways.COMPONENTS`."""
    if quantity in ("rotation_x", "torsion", "moment_x"):
        return "roll"
    # A deck that bends up and down turns about y, one that bends sideways about z.
    about_z = quantity in ("rotation_z", "moment_z")
    upwards = quantity in ("rotation_y", "moment_y") or quantity.endswith(("_z", "vertical"))
    return "z" if upwards and not about_z else "y"


EQUAL = 1e-5
"""Relative difference up to which frequencies count as equal: files give six digits."""


def whole_group(frequencies_hz: np.ndarray, count: int) -> int:
    """Return `count`, or the more modes it takes not to cut a group of equal frequencies.

    Simple spans alike have equal frequencies, and only all of their modes together move each span.

    Parameters
    ----------
    frequencies_hz : ndarray, shape (m,)
        Ascending.
    count : int
    """
    while 0 < count < len(frequencies_hz):
        if frequencies_hz[count] > frequencies_hz[count - 1] * (1.0 + EQUAL):
            break
        count += 1
    return count


def cut_group(field: str, frequencies_hz: np.ndarray, count: int) -> list[Remark]:
    """Say where so many modes end in the middle of a group of equal frequencies; see `whole_group`.

    Parameters
    ----------
    field : str
        What the caller calls the number of modes.
    frequencies_hz : ndarray, shape (m,)
        Ascending, with those beyond the last mode kept.
    count : int
    """
    whole = whole_group(frequencies_hz, count)
    if whole == count:
        return []
    text = (
        f"= {count} cuts a group of equal frequencies, {frequencies_hz[count]:.6g} Hz: only "
        f"together do they move the whole deck. Take {whole}."
    )
    return [ResultWarning(field, text)]


@dataclass(frozen=True, eq=False)
class Line:
    """How one output follows from the deck's state and loads.

    Attributes
    ----------
    modal : ndarray, shape (modes,)
        Output per unit modal coordinate, S_m.
    influence : PiecewiseCubic
        Static influence line of the three load components.
    self_weight : float
        The output under the deck's own weight.
    """

    __repr__ = brief

    modal: np.ndarray
    influence: PiecewiseCubic
    self_weight: float


_SAME_PLACE = 1e-12
"""Share of the deck by which edges differ that are one."""


def combined(parts: Sequence[tuple[float, Line]]) -> Line:
    """Return the line of a sum of outputs of one deck, each times a number.

    Parameters
    ----------
    parts : sequence of (float, Line)
        All of them displacements, or all forces: the deck's viscosity tells them apart.
    """
    edges = np.unique(np.concatenate([line.influence.edges for _, line in parts]))
    edges = edges[np.append(True, np.diff(edges) > _SAME_PLACE * edges[-1])]
    cubics = [factor * line.influence.cut(edges).coefficients for factor, line in parts]
    return Line(
        sum(factor * line.modal for factor, line in parts),
        PiecewiseCubic(edges, sum(cubics)),
        float(sum(factor * line.self_weight for factor, line in parts)),
    )


class Recovery(Protocol):
    """How a deck's motion, section forces and reactions follow from its state and loads.

    Every deck has one. What it cannot recover it says in `lacks`, in one sentence; empty if
    nothing.
    """

    lacks: str

    def section(self, quantity: str, x: float) -> Line | None:
        """Return the line of a displacement, rotation or section force at x.

        None where the deck has no such stiffness, or it cannot be recovered.
        """

    def reaction(self, quantity: str, support: float) -> Line | None:
        """Return the line of a reaction, None where that freedom is not held or not known."""

    def bearing(self, number: int, quantity: str) -> Line | None:
        """Return the line of a force of one of the deck's `bearings`, from 1.

        None where it does not hold that freedom.
        """


_MOTIONS = {
    # component of the shapes, derivative along the deck, sign
    "displacement_y": (0, 0, 1.0),
    "displacement_z": (1, 0, 1.0),
    "rotation_x": (2, 0, 1.0),
    "rotation_y": (1, 1, -1.0),
    "rotation_z": (0, 1, 1.0),
}


@dataclass(frozen=True, eq=False)
class ModesOnly:
    """The recovery of a deck of which only the modes are known: the flexibility they have together.

    Attributes
    ----------
    shapes : PiecewiseCubic
    frequencies_hz : ndarray, shape (m,)
    """

    __repr__ = brief

    shapes: PiecewiseCubic
    frequencies_hz: np.ndarray
    lacks: str = field(
        default="only its modes are known, so it has no section forces, reactions or self-weight",
        init=False,
    )

    def section(self, quantity: str, x: float) -> Line | None:
        """Return the line of a displacement or rotation at x, None for section forces.

        Rotations about y and z are slopes of the shapes: those of the deck's axis.
        """
        if errors.choice("quantity", quantity, SECTION_QUANTITIES) not in _MOTIONS:
            return None
        component, derivative, sign = _MOTIONS[quantity]
        modal = sign * self.shapes(np.array([x]), derivative)[0, :, component]
        share = modal / (2 * np.pi * self.frequencies_hz) ** 2
        shape = np.einsum("epmc,m->epc", self.shapes.coefficients, share)[:, :, None]
        return Line(modal, PiecewiseCubic(self.shapes.edges, shape), np.nan)

    def reaction(self, quantity: str, support: float) -> Line | None:
        """Return None: modes alone tell no reaction."""
        return None

    def bearing(self, number: int, quantity: str) -> Line | None:
        """Return None: modes alone tell no bearing force."""
        return None


@dataclass(frozen=True, eq=False)
class History:
    """Named time histories with units; those that are only rounding are zero.

    Attributes
    ----------
    time : ndarray, shape (n,)
        s.
    values : dict of ndarray, shape (n,)
        By name; NaN where the deck has no such stiffness.
    units : dict of str
    where : str
    jumps : callable or None
        From a name to times (s) and values between the samples, on both sides of what jumps.
    """

    __repr__ = brief

    time: np.ndarray
    values: dict[str, np.ndarray]
    units: dict[str, str]
    where: str = ""
    jumps: Callable[[str], tuple[np.ndarray, np.ndarray]] | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        values = {name: without_rounding(v, self._unit(name)) for name, v in self.values.items()}
        object.__setattr__(self, "values", values)

    def _unit(self, name: str) -> str:
        return self.units.get(name, "")

    def __getitem__(self, name: str) -> np.ndarray:
        if not isinstance(name, str) or name not in self.values:
            raise InputError(
                "name", name, "no such history", errors.did_you_mean(name, self.values)
            )
        return self.values[name]

    def to_frame(self):
        """Return a pandas DataFrame, one column a history, indexed by time."""
        import pandas as pd

        columns = {f"{name} ({self.units[name]})": v for name, v in self.values.items()}
        return pd.DataFrame(columns, index=pd.Index(self.time, name="t (s)"))

    def extreme(self, name: str) -> tuple[float, float]:
        """Return the value of largest magnitude, signed, and its time (s)."""
        return max(self.extremes(name), key=lambda found: abs(found[0]))

    def extremes(self, name: str) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the smallest and the largest value, each with its time (s).

        What jumps between two samples is seen on both sides of the jump. NaN without a finite
        value.
        """
        time, values = self.time, self[name]
        if not np.isfinite(values).any():
            return (np.nan, np.nan), (np.nan, np.nan)
        if self.jumps is not None:
            more_time, more = self.jumps(name)
            time, values = np.concatenate([time, more_time]), np.concatenate([values, more])
            values = without_rounding(values, self._unit(name))
        low, high = np.nanargmin(values), np.nanargmax(values)
        return tuple((float(values[i]), float(time[i])) for i in (low, high))


@dataclass(frozen=True, eq=False, kw_only=True)
class Deck(Guideway):
    """A modal deck.

    Attributes
    ----------
    name, length, tracks, width, track_height, rail
        See `Guideway`.
    shapes : PiecewiseCubic
        Mass-normalised shapes of m modes (1/sqrt(kg), and 1/(m sqrt(kg)) for twist).
    frequencies_hz, damping_ratios : ndarray, shape (m,)
    mode_names : tuple of str
        For instance ``vertical bending 1``.
    supports : tuple of float
        Places of the bearing lines, m.
    recovery : Recovery
        How section forces and reactions follow; `ModesOnly` if not given.
    mass_per_metre : float or None
        kg/m.
    bearings : tuple of (x, y, z)
        Places of the single bearings, m; empty where only bearing lines are known.
    internal_damping : float
        beta of Rayleigh damping, s: viscosity of the deck and its bearings, whose forces they
        carry. Zero where only ratios are known.
    remarks : tuple of Remark
        What whoever made the deck doubts about it, or what it leaves out.
    """

    __repr__ = brief

    frequencies_hz: np.ndarray
    damping_ratios: np.ndarray
    mode_names: tuple[str, ...]
    supports: tuple[float, ...] = ()
    recovery: Recovery | None = field(default=None, repr=False)
    mass_per_metre: float | None = None
    bearings: tuple[tuple[float, float, float], ...] = ()
    internal_damping: float = 0.0
    remarks: tuple[Remark, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        # Copies, since a deck is made once for many crossings.
        for name in ("frequencies_hz", "damping_ratios"):
            object.__setattr__(self, name, frozen(np.array(getattr(self, name), dtype=float)))
        if self.recovery is None:
            object.__setattr__(self, "recovery", ModesOnly(self.shapes, self.frequencies_hz))

    def to_frame(self):
        """Return a pandas DataFrame with one row a mode."""
        import pandas as pd

        columns = {
            "frequency (Hz)": self.frequencies_hz,
            "damping ratio": self.damping_ratios,
            "name": self.mode_names,
        }
        return pd.DataFrame(columns, index=pd.RangeIndex(1, len(self.mode_names) + 1, name="mode"))

    def influence(
        self,
        quantity: str,
        *,
        at: float,
        places: np.ndarray,
        load: str | None = None,
        derivative: int = 0,
    ) -> np.ndarray:
        """Return an influence line: a result at one place under a unit load at each of many.

        Of a load on the deck itself. A wheel's, where a `rail` spreads its load, is `under_load`.

        Parameters
        ----------
        quantity : str
            A displacement, rotation or section force at x = `at`, or a reaction (``force_z``) of
            the bearing line there.
        at : float
            m.
        places : ndarray, shape (n,)
            Where the load stands, m; off the deck it does nothing.
        load : {"y", "z", "roll"}, optional
            A force of 1 N to the left or upwards, or a couple of 1 N m about the axis; if not given
            the one of the quantity's own direction.
        derivative : int
            1 and 2 for the line's slope and curvature along the deck, per m and per m2.

        Returns
        -------
        ndarray, shape (n,)
            The quantity's unit per N or per N m: m/N for a displacement.

        Raises
        ------
        InputError
            A quantity that the deck cannot recover, or has no stiffness or bearing for.
        """
        errors.choice("quantity", quantity, [*SECTION_QUANTITIES, *REACTION_QUANTITIES])
        load = load_of(quantity) if load is None else errors.choice("load", load, COMPONENTS)
        is_reaction = quantity in REACTION_QUANTITIES
        recover = self.recovery.reaction if is_reaction else self.recovery.section
        line = recover(quantity, errors.place("at", at, (0.0, self.length)))
        if line is None and self.recovery.lacks:
            raise InputError("deck", self.name, self.recovery.lacks)
        if line is None:
            allowed = "the deck has no such stiffness or bearing there"
            raise InputError("quantity", quantity, allowed)
        along = errors.numbers("places", places, unit="m")
        derivative = errors.integer("derivative", derivative, most=2)
        of_one_output = line.influence(along, derivative)[:, 0]
        return of_one_output[:, COMPONENTS.index(load)]

    def under_load(self, line: Line) -> Line:
        """Return the line of an output for loads on the rail; the same where there is none."""
        if self.rail is None:
            return line
        return replace(line, influence=self.under_rail(line.influence))

    def sampled(self, time_step: float) -> SampledModes:
        """What gives modal coordinates and velocities from modal forces, at a time step (s)."""
        if time_step not in self._sampled:
            self._sampled.clear()  # one is kept: a slider meets a new step in every run
            omega = 2 * np.pi * self.frequencies_hz
            self._sampled[time_step] = sampled_modes(omega, self.damping_ratios, time_step)
        return self._sampled[time_step]

    @cached_property
    def _sampled(self) -> dict[float, SampledModes]:
        """What `sampled` gave last, by its time step."""
        return {}

    def acceleration(
        self, q: np.ndarray, velocity: np.ndarray, modal_force: np.ndarray
    ) -> np.ndarray:
        """Return modal accelerations from the equation of motion."""
        omega = (2 * np.pi * self.frequencies_hz)[:, None]
        return modal_force - 2 * self.damping_ratios[:, None] * omega * velocity - omega**2 * q

    def recovered(
        self,
        line: Line,
        q: np.ndarray,
        velocity: np.ndarray,
        modal_force: np.ndarray,
        static: np.ndarray,
    ) -> np.ndarray:
        """Return a section force or reaction: what the modes give, and the modes left out.

        Parameters
        ----------
        line : Line
        q, velocity, modal_force : ndarray, shape (modes, n)
        static : ndarray, shape (n,)
            The influence line under the present loads.
        """
        kept = line.modal @ q
        if self.internal_damping:
            kept += self.internal_damping * (line.modal @ velocity)
        return kept + self._residual(line, modal_force, static)

    def displaced(
        self,
        line: Line,
        q: np.ndarray,
        modal_force: np.ndarray,
        static: np.ndarray,
        time_step: float,
    ) -> np.ndarray:
        """Return a displacement or rotation; parameters as for `recovered`, and the step in s."""
        residual = self._residual(line, modal_force, static)
        return line.modal @ q + lagged(residual, self.internal_damping, time_step)

    def _residual(self, line: Line, modal_force: np.ndarray, static: np.ndarray) -> np.ndarray:
        """Return what the modes left out give when the loads stand still, shape (n,)."""
        omega2 = (2 * np.pi * self.frequencies_hz) ** 2
        return static - (line.modal / omega2) @ modal_force
