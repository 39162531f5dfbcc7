r"""Train and deck solved together at every step: no iteration.

The discrete operators are those of the iteration, so the result is its limit, for every way of
loading. Hertzian contacts, which are not linear, can be solved in this way only.

The loop stands twice: in NumPy (`stepping`), and compiled (`compiled`, with the extra `fast`), some
thirty times faster and equal to the last digits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.util import find_spec

import numpy as np

from ..coupling import Coupling, DeckState, ForcesAdded
from ..errors import brief, frozen
from ..tracks import Track
from .plans import Plan, plan
from .stepping import Marched, march

__all__ = ["Direct", "has_compiler", "on_rigid_deck", "solve_directly"]


@dataclass(frozen=True, eq=False)
class Direct:
    """A crossing solved directly.

    Attributes
    ----------
    coupling : Coupling
        What was given; with Hertzian contacts its `rigid` holds what these carry more than their
        tangents, so that `added` is what the deck's motion adds.
    added : ForcesAdded
    state : DeckState
    """

    __repr__ = brief

    coupling: Coupling
    added: ForcesAdded
    state: DeckState


def has_compiler() -> bool:
    """Whether the extra `fast` is installed, which compiles the loop."""
    return find_spec("numba") is not None


def solve_directly(
    coupling: Coupling, track: Track, progress: Callable[[str], None] | None = None
) -> Direct:
    """Return the coupled solution.

    Parameters
    ----------
    coupling : Coupling
    track : Track
        That of the coupling.
    progress : function of one text, optional
        Called now and then; not while the loop is compiled, which a line on stderr tells of.

    Raises
    ------
    ArithmeticError
        A Hertzian contact whose force does not settle.
    """
    hertzian = coupling.settings.contact == "hertz"
    if all(c.respond is None for c in coupling.cars):
        added = coupling.nothing_added()
        return Direct(coupling, added, coupling.deck_state(coupling.station_loads(added)))
    steps = plan(coupling, track if hertzian else None)
    found = _marched(steps, progress)
    if hertzian:
        coupling = _with_more(coupling, track, found.more)
    state = DeckState(*map(frozen, (found.q, found.velocity, found.force)))
    return Direct(coupling, coupling.train_pass(state), state)


def on_rigid_deck(coupling: Coupling, track: Track) -> Coupling:
    """Return a coupling whose Hertzian contacts stand on a rigid deck: iteration 0.

    Parameters
    ----------
    coupling : Coupling
        With Hertzian contacts, as `solve_directly` leaves it or as it was prepared.
    track : Track
        That of the coupling.

    Raises
    ------
    ArithmeticError
        A contact whose force does not settle.
    """
    steps = plan(coupling, track)
    axles, loads = steps.axles.copy(), steps.loads.copy()
    axles[:, 1] = loads[:, 1] = 0  # never on the deck
    found = _marched(replace(steps, axles=axles, loads=loads), None)
    return _with_more(coupling, track, found.more)


def _marched(steps: Plan, progress: Callable[[str], None] | None) -> Marched:
    # A car whose modes nearly coincide has no diagonal form, which the compiled loop needs.
    if has_compiler() and all(car.decay.ndim == 1 for car in steps.cars):
        try:
            from . import compiled
        except ImportError:  # a compiler that does not go with this NumPy
            return march(steps, progress)
        return compiled.march(steps, progress)
    return march(steps, progress)


def _with_more(coupling: Coupling, track: Track, more: tuple[np.ndarray, ...]) -> Coupling:
    """Return a coupling whose forces on a rigid deck hold the contacts' p."""
    passage = coupling.settings.passage
    rigid = coupling.train.rigid_forces(track, passage, more)
    cars = tuple(replace(c, rigid=own) for c, own in zip(coupling.cars, rigid, strict=True))
    return replace(coupling, cars=cars, more=more)
