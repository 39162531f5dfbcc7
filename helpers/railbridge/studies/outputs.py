"""What is asked of every crossing of a study: quantities at places along the deck.

An `Output` is one quantity at one place. Of each, a study keeps the smallest and the largest value
over the crossing and the free vibration behind it, with their times, and the same of the static
value under the standing loads, wherever they stand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import errors
from ..cutoffs import counted
from ..decks import SECTION_QUANTITIES, Deck, History, Line, combined
from ..errors import InputError
from ..results import Crossing
from ..tracks import TRACK_GAUGE, TWIST_LENGTH

__all__ = [
    "ACCELERATIONS", "OUTPUTS", "Output", "Peaks", "history_of", "of_modes_counted", "outputs_at",
    "peaks_of_run", "twist_at",
]  # fmt: skip

ACCELERATIONS = {"acceleration_y": "m/s2", "acceleration_z": "m/s2", "acceleration_roll": "rad/s2"}
OUTPUTS = {**SECTION_QUANTITIES, "twist": "m", **ACCELERATIONS}
"""Quantities that a study can be asked for at a place, with units."""
_FORCES = ("moment", "torsion", "shear", "force")


@dataclass(frozen=True, eq=False)
class Output:
    """One quantity at one place of a deck.

    Attributes
    ----------
    quantity : str
        One of `OUTPUTS`, or what it is called: a name that begins with ``force`` is a bearing's.
    x : float
        m.
    modal : ndarray, shape (modes,)
        What each mode has of it: per unit coordinate, or per unit acceleration.
    line : Line or None
        None for an acceleration, which has no static value.
    """

    quantity: str
    x: float
    modal: np.ndarray
    line: Line | None

    @property
    def is_acceleration(self) -> bool:
        """Whether it is one of `ACCELERATIONS`."""
        return self.quantity in ACCELERATIONS

    @property
    def is_rotation(self) -> bool:
        """Whether it is a rotation of the section."""
        return self.quantity.startswith("rotation")

    @property
    def is_force(self) -> bool:
        """Whether it is a section force or a bearing's: the deck's viscosity carries it too."""
        return self.quantity.startswith(_FORCES)


def outputs_at(
    deck: Deck, quantities: Sequence[str], points: Sequence[float]
) -> tuple[Output, ...]:
    """Return what is asked of a deck: every quantity at every place, places outermost.

    Raises
    ------
    InputError
        An unknown quantity, a place off the deck, or what the deck cannot recover.
    """
    if isinstance(quantities, str):
        quantities = (quantities,)
    if not len(quantities):
        raise InputError("quantities", list(quantities), "must name at least one quantity")
    for i, quantity in enumerate(quantities):
        errors.choice("quantities", quantity, OUTPUTS)
        if quantity in quantities[:i]:
            raise InputError("quantities", quantity, "is named twice")
    places = errors.places("points", points, (0.0, deck.length)).tolist()
    if not places:
        raise InputError("points", [], "must hold at least one place, m")
    return tuple(_output(deck, quantity, x) for x in places for quantity in quantities)


def _output(deck: Deck, quantity: str, x: float) -> Output:
    if quantity in ACCELERATIONS:
        component = list(ACCELERATIONS).index(quantity)
        if not list(deck.has.values())[component]:
            raise InputError("quantities", quantity, "the deck does not move that way")
        modal = deck.shapes(np.array([x]))[0, :, component].copy()
        return Output(quantity, x, modal, None)
    if quantity == "twist":
        return twist_at(deck, x)
    line = deck.recovery.section(quantity, x)
    if line is None:
        allowed = deck.recovery.lacks or "the deck has no such stiffness"
        raise InputError("quantities", quantity, allowed, "Leave it out")
    return Output(quantity, x, line.modal, line)


def of_modes_counted(outputs: Sequence[Output], deck: Deck, up_to_hz: float) -> tuple[Output, ...]:
    """Return outputs whose accelerations are made of the modes up to a frequency (Hz) alone.

    What is not computed by `crossing.compute` must ask for them: outputs know the deck, and not the
    settings of a crossing.
    """
    kept = counted(deck.frequencies_hz, up_to_hz)
    return tuple(
        replace(output, modal=np.where(kept, output.modal, 0.0))
        if output.is_acceleration
        else output
        for output in outputs
    )


def twist_at(deck: Deck, x: float) -> Output:
    """Return the twist of the track over the 3 m behind a place: by how much the left rail rises.

    The gauge times the difference of rotations, ``1.435 m (theta(x + 3 m) - theta(x))``. What lies
    beyond the ends of the deck does not rotate.

    Parameters
    ----------
    deck : Deck
    x : float
        m; from 3 m before the deck on.

    Raises
    ------
    InputError
        A deck that is rigid in twist.
    """
    if not deck.has["roll"]:
        raise InputError("quantities", "twist", "the deck is rigid in twist", "Leave it out")
    ends = (-TWIST_LENGTH, 0.0, deck.length, deck.length + TWIST_LENGTH)
    places = [(s, errors.place("x", x + d, ends)) for s, d in ((-1, 0.0), (1, TWIST_LENGTH))]
    on_deck = [(s, place) for s, place in places if 0.0 <= place <= deck.length]
    lines = [(s * TRACK_GAUGE, deck.recovery.section("rotation_x", place)) for s, place in on_deck]
    line = combined(lines)
    return Output("twist", float(x), line.modal, line)


@dataclass(frozen=True, eq=False)
class Peaks:
    """The extremes of every output of some crossings.

    Attributes
    ----------
    low, high : ndarray, shape (crossings, outputs)
        Smallest and largest value, SI.
    low_time, high_time : ndarray, shape (crossings, outputs)
        s; zero when the first axle enters.
    static_low, static_high : ndarray, shape (crossings, outputs)
        The same under the standing loads; NaN for accelerations.
    """

    low: np.ndarray
    high: np.ndarray
    low_time: np.ndarray
    high_time: np.ndarray
    static_low: np.ndarray
    static_high: np.ndarray

    @property
    def largest(self) -> np.ndarray:
        """Largest magnitude, shape (crossings, outputs)."""
        return np.maximum(-self.low, self.high)

    @property
    def largest_time(self) -> np.ndarray:
        """When it comes, s."""
        return np.where(-self.low > self.high, self.low_time, self.high_time)

    @property
    def static(self) -> np.ndarray:
        """Largest magnitude under the standing loads; NaN for accelerations."""
        return np.maximum(-self.static_low, self.static_high)


def history_of(run: Crossing, output: Output) -> History:
    """Return the history of one output in a crossing, under its quantity's name."""
    deck, state, name = run.deck, run.state, output.quantity
    where, units = f"x = {output.x:g} m", {name: OUTPUTS.get(name, "")}
    if output.is_force:
        return run.recovered({name: output.line}, units, where=where)
    if output.is_acceleration:
        modal = deck.acceleration(state.q, state.velocity, state.modal_force)
        (own,) = of_modes_counted([output], deck, run.settings.accelerations_up_to_hz)
        return History(run.time, {name: own.modal @ modal}, units, where)
    static, step = run.static(output.line), run.settings.time_step
    values = deck.displaced(output.line, state.q, state.modal_force, static, step)
    return History(run.time, {name: values}, units, where)


def peaks_of_run(run: Crossing, outputs: Sequence[Output]) -> Peaks:
    """Return the extremes of one crossing that is computed already."""
    found = np.full((6, 1, len(outputs)), np.nan)
    for i, output in enumerate(outputs):
        history = history_of(run, output)
        (low, low_time), (high, high_time) = history.extremes(output.quantity)
        static = (np.nan, np.nan) if output.line is None else run.static_extremes(output.line)
        found[:, 0, i] = low, high, low_time, high_time, *static
    return Peaks(*found)
