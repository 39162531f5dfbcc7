r"""The fixed point in windows of time, for what does not settle over the whole record.

On a finite record with a smooth answer the passes settle in the end, like ``(c T)^n / n!`` after n
of them over a time T; before, they may grow beyond all numbers, or fall more slowly than passes are
allowed. Over a short window there is neither. So the record is cut into windows, each is iterated
until it has settled, and hands on where train and deck then stand. Where the changes do not fall
the window is halved; where they fall fast the next one is twice as long. A window that would be too
short to be worth it is stepped through, train and deck solved together at every sample, so that
there is always an end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..coupling import CoupledCar, Coupling, DeckState
from ..errors import brief, frozen
from .plans import Plan, plan
from .stepping import handed_on, step

__all__ = ["FEW", "Windows", "in_windows"]

SHORTEST, FIRST, LONGEST = 48, 256, 4096
"""Samples of the shortest window, of the first, and of the longest."""
FEW = 9
"""Passes up to which the next window is longer; who allows no more asks for no windows."""
STILL = 1e-4
"""Dynamic part of a wheel force below which it is measured by this, share of the static force."""
SLOW = 0.5
"""Ratio of two changes in a row above which a window is halved."""


@dataclass(frozen=True, eq=False)
class Windows:
    """A fixed point found in windows.

    Attributes
    ----------
    stops : ndarray of int, shape (windows,)
        The sample behind the last of every window.
    passes : ndarray of int, shape (windows,)
        Passes that each took; 1 where train and deck were solved together.
    changes : ndarray, shape (windows,)
        The last change of each.
    state : DeckState
    """

    __repr__ = brief

    stops: np.ndarray
    passes: np.ndarray
    changes: np.ndarray
    state: DeckState


def in_windows(coupling: Coupling, progress: Callable[[str], None] | None = None) -> Windows:
    """Return the fixed point of a crossing on permanent contact.

    Parameters
    ----------
    coupling : Coupling
    progress : function of one text, optional
    """
    steps = plan(coupling)
    deck = np.zeros((3, steps.reach.shape[1], steps.samples))
    states = [car.at_rest for car in steps.cars]
    free = _free(steps.onward, LONGEST)
    # A car whose modes nearly coincide goes from sample to sample only.
    able = all(car.decay.ndim == 1 for car in steps.cars)
    found: list[tuple[int, int, float]] = []
    # The first sample moves nothing, which no pass needs to find.
    first, size, together = 0, FIRST, 1
    while first < steps.samples:
        stop = min(first + size, steps.samples)
        if first == 0 or size < SHORTEST or not able:
            stop, passes, change = min(first + together, steps.samples), 1, 0.0
            for k in range(first, stop):
                before = deck[:, :, k - 1] if k else np.zeros(deck.shape[:2])
                deck[:, :, k], inputs = step(steps, k, before, states)
                for i, u in inputs.items():
                    states[i] = handed_on(steps.cars[i], states[i], u[:, None])
            size, together = FIRST, min(max(2 * together, FIRST), LONGEST)
        else:
            before = deck[:, :, first - 1]
            part = _Window(coupling, steps, (first, stop), before, states, free)
            passes, change = part.settle()
            if not np.isfinite(change):
                size = size // 2
                continue
            deck[:, :, first:stop] = part.deck
            for i, u in part.inputs.items():
                states[i] = handed_on(steps.cars[i], states[i], u)
            together = FIRST
            if passes <= FEW:
                size = min(2 * size, LONGEST)
        found.append((stop, passes, change))
        if progress is not None:
            progress(f"window {len(found)} up to step {stop} of {steps.samples}: {passes} passes")
        first = stop
    stops, passes, changes = (np.array(own) for own in zip(*found, strict=True))
    return Windows(stops, passes, changes, DeckState(*map(frozen, deck)))


def _free(onward: np.ndarray, count: int) -> np.ndarray:
    """Return how modes go on freely: powers 1 ... count of their steps, shape (2, 2, modes, n)."""
    powers = onward[:4].reshape(2, 2, -1, 1)
    while powers.shape[-1] < count:
        more = np.einsum("abmn,bcm->acmn", powers, powers[..., -1])
        powers = np.concatenate([powers, more], axis=-1)
    return powers[..., :count]


class _Window:
    """Some samples, and what stands before them."""

    def __init__(
        self,
        coupling: Coupling,
        steps: Plan,
        span: tuple[int, int],
        before: np.ndarray,
        states: list[np.ndarray],
        free: np.ndarray,
    ) -> None:
        first, stop = span
        self.settings, self.modes = coupling.settings, coupling.modes
        self.force_before = before[2]
        self.free = np.einsum("abmn,bm->amn", free[..., : stop - first], before[:2])
        cars = [c for c in coupling.cars if c.respond is not None]
        least = STILL * max(np.abs(c.static).max() for c in cars)
        self.cars = [
            _Part(steps, i, span, states[i], c, least)
            for i, c in enumerate(cars)
            if steps.windows[i, 0] < stop and steps.windows[i, 1] > first
        ]
        self.deck = np.zeros((3, *self.free.shape[1:]))
        self.inputs: dict[int, np.ndarray] = {}

    def settle(self) -> tuple[int, float]:
        """Iterate; return passes and the last change, above the tolerance where they do not fall.

        The first guess is the deck under the cars as they would go on by themselves.
        """
        old = [car.forces(np.zeros_like(car.known)) for car in self.cars]
        passes, last = 0, np.inf
        while True:
            self._move(old)
            self.inputs = {car.number: car.felt(self.deck) for car in self.cars}
            new = [car.forces(self.inputs[car.number]) for car in self.cars]
            pairs = zip(self.cars, new, old, strict=True)
            change = max((car.change(*both) for car, *both in pairs), default=0.0)
            passes, old = passes + 1, new
            if change < self.settings.tolerance:
                self._move(new)
                return passes, change
            slow = passes > 2 and not change < SLOW * last
            if slow or passes >= self.settings.max_iterations or not np.isfinite(change):
                return passes, np.inf
            last = change

    def _move(self, forces: list[np.ndarray]) -> None:
        """Let the deck move under the wheel forces of every car."""
        force = np.zeros_like(self.deck[2])
        for car, own in zip(self.cars, forces, strict=True):
            car.act(own, force)
        moved = self.modes(np.concatenate([self.force_before[:, None], force], axis=1))
        self.deck[:2] = [own[:, 1:] for own in moved] + self.free
        self.deck[2] = force


class _Part:
    """One car in a window, or in the part of it in which it is stepped."""

    def __init__(
        self,
        steps: Plan,
        number: int,
        span: tuple[int, int],
        state: np.ndarray,
        c: CoupledCar,
        least: float,
    ) -> None:
        self.number, self.car, self.respond = number, steps.cars[number], c.respond.respond
        self.static, self.least = c.static.reshape(-1, 1), least
        start, stop = (int(k) for k in steps.windows[number])
        first, behind = max(span[0], start), min(span[1], stop)
        self.here = slice(first - span[0], behind - span[0])
        self.known = steps.known[number][:, first - start : behind - start]
        powers = self.car.decay[:, None] ** np.arange(behind - first)
        self.free = ((self.car.show * state) @ powers).real
        axle, axles, load, loads = steps.of_cars[number]
        own = first, behind
        self.below = [_part(steps.tables, s, own) for s in steps.axles[axle : axle + axles]]
        self.under = [_part(steps.load_tables, s, own) for s in steps.loads[load : load + loads]]

    def felt(self, deck: np.ndarray) -> np.ndarray:
        """Return U from the deck's motion, shape (d, n)."""
        q, velocity, _ = deck[:, :, self.here]
        met = np.zeros((2, len(self.below), 3, q.shape[1]))
        for i, (when, table) in enumerate(self.below):
            met[0, i, :, when] = np.einsum("kcm,mk->ck", table[:, 0], q[:, when])
            met[1, i, :, when] = np.einsum("kcm,mk->ck", table[:, 1], q[:, when])
            met[1, i, :, when] += np.einsum("kcm,mk->ck", table[:, 0], velocity[:, when])
        moved, rate = met.reshape(2, -1, q.shape[1])
        return self.car.stiffness @ moved + self.car.damping @ rate

    def forces(self, u: np.ndarray) -> np.ndarray:
        """Return the wheel forces under inputs U, shape (d, n)."""
        # From rest before the window; what stands there already goes on freely.
        answer = self.respond(np.concatenate([np.zeros((len(u), 1)), u], axis=1))[:, 1:]
        return self.known + self.free + answer - u

    def act(self, forces: np.ndarray, on: np.ndarray) -> None:
        """Add the modal forces of wheel forces, both over the window."""
        loads = (self.car.loads @ forces).reshape(len(self.under), -1, forces.shape[1])
        for own, (when, table) in zip(loads, self.under, strict=True):
            there = slice(self.here.start + when.start, self.here.start + when.stop)
            on[:, there] += np.einsum("krm,rk->mk", table, own[:, when])

    def change(self, new: np.ndarray, old: np.ndarray) -> float:
        """Return the largest of any wheel of rms(new - old) / rms(new - static)."""
        moved, size = (np.sqrt(np.mean(x**2, axis=1)) for x in (new - old, new - self.static))
        return float(np.max(moved / np.maximum(size, self.least)))


def _part(
    tables: tuple[np.ndarray, ...], station: np.ndarray, span: tuple[int, int]
) -> tuple[slice, np.ndarray]:
    """Return when in a span of samples a station is on the deck, and its part of the table."""
    start, count, which = (int(n) for n in station)
    first, stop = max(span[0], start), min(span[1], start + count)
    stop = max(first, stop)
    return slice(first - span[0], stop - span[0]), tables[which][first - start : stop - start]
