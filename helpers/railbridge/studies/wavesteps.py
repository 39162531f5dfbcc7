r"""Many waves at one speed, stepped side by side: each a lane of the same train on the same deck.

All lanes share train, deck and step; they differ in the wheel forces on a rigid deck only, which
for a wave are known in closed form. So every matrix of `stepping` is made once a sample, and acts
on all lanes in one product. With the letters used there, of every sample and car

    U = G (q, q')* + P f,      F = F_known + (R, D) (s, U),      s of the next = (S, Q) (s, U),

where f, the new modal forces, solve ``f = sum over cars of B F``. The rows of B go on with the
static influence lines of what is asked for, so that these are met on the way.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from ..direct import CarSteps, Plan
from ..response import ramp_coefficients

__all__ = ["BLOCK", "Asking", "Waves", "Wheels", "step_waves"]

BLOCK = 64
"""Samples whose matrices are made at once."""


@dataclass(frozen=True, eq=False)
class Waves:
    """What the lanes carry: waves of unit size, their cosine and their sine in turn.

    The last lane has no wave, but the static forces and what the plan knows besides.

    Attributes
    ----------
    rates : ndarray, shape (waves,)
        W V, rad/s.
    forces : tuple of ndarray, shape (d, waves), complex
        Of every car the wheel forces on a rigid deck, N, at t = 0.
    start : float
        Time of the first sample, s.
    """

    rates: np.ndarray
    forces: tuple[np.ndarray, ...]
    start: float

    @property
    def lanes(self) -> int:
        """How many there are."""
        return 2 * len(self.rates) + 1


@dataclass(frozen=True, eq=False)
class Asking:
    """What is asked for at every sample, as sums of what the modes do and static influence lines.

    Attributes
    ----------
    of_q, of_velocity, of_force : ndarray, shape (outputs, modes)
    tables : tuple of ndarray, shape (samples on the deck, 3 or 5, outputs)
        Influence lines below a load station, as `Plan.load_tables`.
    residual : ndarray, shape (outputs, modes)
        What of the modal forces is taken off the influence lines: the share of the modes kept.
    lags : ndarray, shape (outputs,)
        By which the rest comes later, s; see `decks.Deck.displaced`.
    """

    of_q: np.ndarray
    of_velocity: np.ndarray
    of_force: np.ndarray
    tables: tuple[np.ndarray, ...]
    residual: np.ndarray
    lags: np.ndarray


@dataclass(frozen=True, eq=False)
class Wheels:
    """Vertical forces of a car's wheels in every lane.

    Attributes
    ----------
    first : int
        Sample of the first.
    forces : ndarray, shape (wheels, n, lanes)
        N on the deck; all that is no wave's in the last lane only.
    """

    first: int
    forces: np.ndarray


def step_waves(
    plan: Plan,
    waves: Waves,
    asking: Asking,
    time_step: float,
    cars: Sequence[int] = (),
    progress: Callable[[str], None] | None = None,
) -> tuple[np.ndarray, dict[int, Wheels]]:
    """Step all lanes together.

    Parameters
    ----------
    plan : Plan
        Of the train on permanent contact, on the track without these waves.
    waves : Waves
    asking : Asking
    time_step : float
        s.
    cars : sequence of int
        Whose wheel forces are kept, numbers from 0.
    progress : function of one text, optional

    Returns
    -------
    outputs : ndarray, shape (outputs, samples, lanes)
    wheels : dict of Wheels
        Of every car that was asked for.
    """
    modes, lanes = plan.reach.shape[1], waves.lanes
    outputs = len(asking.of_q)
    found = np.empty((outputs, plan.samples, lanes))
    wheels = {
        i: Wheels(
            int(plan.windows[i, 0]),
            np.zeros((len(plan.known[i]) // 2, int(np.diff(plan.windows[i])[0]), lanes)),
        )
        for i in cars
    }
    rolling = [_Rolling(car, lanes) for car in plan.cars]
    onward, reach = _onward(plan), plan.reach[:, :, None]
    asked = np.concatenate([asking.of_q, asking.of_velocity, asking.of_force], axis=1)
    state = np.zeros((BLOCK + 1, 3 * modes, lanes))
    standing = np.zeros((BLOCK, outputs, lanes))
    ahead, total = np.zeros((2 * modes, lanes)), np.zeros((modes + outputs, lanes))
    lags = [_Lag(lag, time_step) for lag in asking.lags]
    for first in range(0, plan.samples, BLOCK):
        if progress is not None and first % (8 * BLOCK) == 0:
            progress(f"step {first} of {plan.samples}")
        stop = min(first + BLOCK, plan.samples)
        time = waves.start + time_step * np.arange(first, stop)
        turns = np.exp(1j * time[:, None] * waves.rates)
        block = [
            _Block(plan, asking.tables, i, first, stop)
            for i, (start, end) in enumerate(plan.windows)
            if start < stop and end > first
        ]
        solved = _solved(block, modes, stop - first)
        for n in range(stop - first):
            moved, force = np.split(state[n + 1], [2 * modes])
            on = [own for own in block if own.first <= n < own.stop]
            np.matmul(onward, state[n], out=ahead)
            total[:] = 0.0
            for own in on:
                total += own.meet(rolling[own.car], n, ahead, waves, turns[n])
            still = first + n == 0  # the first sample moves nothing, so wheels feel nothing
            force[:] = total[:modes] if still else solved[n] @ total[:modes]
            standing[n] = total[modes:]
            for own in on:
                standing[n] += own.go_on(rolling[own.car], n, force, still)
                if own.car in wheels:
                    k = first + n - plan.windows[own.car, 0]
                    now = own.force(rolling[own.car], n, force, still)
                    wheels[own.car].forces[:, k] = now
                rolling[own.car].step()
            if not still:
                np.multiply(reach, force, out=moved.reshape(2, modes, lanes))
                moved += ahead
        some, own = state[1 : stop - first + 1], slice(first, stop)
        found[:, own] = np.moveaxis(asked @ some, 0, 1)
        residual = standing[: stop - first] - asking.residual @ some[:, 2 * modes :]
        for output, lag in enumerate(lags):
            found[output, own] += lag(residual[:, output])
        state[0] = state[stop - first]
    return found, wheels


class _Lag:
    """What follows ``lag y' + y = u``, a block at a time; see `response.lagged`."""

    def __init__(self, lag: float, time_step: float) -> None:
        self.filter = None
        if lag > 0.0:
            a, b0, b1 = (c.real[0] for c in ramp_coefficients(np.array([-1.0 / lag]), time_step))
            self.filter = [b1 / lag, b0 / lag], [1.0, -a]
        self.memory: np.ndarray | None = None

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return y of the next samples, shape (n, lanes)."""
        if self.filter is None:
            return u
        if self.memory is None:
            self.memory = -self.filter[0][0] * u[:1]
        y, self.memory = lfilter(*self.filter, u, axis=0, zi=self.memory)
        return y


class _Rolling:
    """One car in all lanes: s and U one above the other, as the products want them."""

    def __init__(self, car: CarSteps, lanes: int) -> None:
        self.onward, self.shown = _real(car)
        self.known = np.zeros((len(self.shown), lanes))
        self.direct = car.direct
        # Two, so that one is filled from the other without a copy.
        self.both, self._next = np.zeros((2, self.onward.shape[1], lanes))

    @property
    def u(self) -> np.ndarray:
        """U, shape (d, lanes)."""
        return self.both[len(self.onward) :]

    def step(self) -> None:
        """Go on to the next sample."""
        np.matmul(self.onward, self.both, out=self._next[: len(self.onward)])
        self.both, self._next = self._next, self.both


def _onward(plan: Plan) -> np.ndarray:
    """Return what makes (q, q')* of q, q' and the modal forces of the sample before."""
    e = [np.diag(own) for own in plan.onward]
    return np.block([[e[0], e[1], e[4]], [e[2], e[3], e[5]]])


def _real(car: CarSteps) -> tuple[np.ndarray, np.ndarray]:
    """Return (S, Q) and (R, D) of a car in real numbers."""
    decay, drive, show = car.decay, car.drive, car.show
    if decay.ndim == 1:
        a, b = np.diag(decay.real), np.diag(decay.imag)
        decay = np.block([[a, -b], [b, a]])
        drive = np.concatenate([drive.real, drive.imag])
        show = np.concatenate([show.real, -show.imag], axis=1)
    return np.concatenate([decay, drive], axis=1), np.concatenate([show, car.direct], axis=1)


class _Block:
    """One car over some samples: its matrices."""

    def __init__(
        self, plan: Plan, tables: Sequence[np.ndarray], car: int, first: int, stop: int
    ) -> None:
        start, end = (int(k) for k in plan.windows[car])
        span = max(start, first), min(end, stop)
        self.car, self.first, self.stop = car, span[0] - first, span[1] - first
        steps, modes = plan.cars[car], plan.reach.shape[1]
        axle, axles, load, loads = plan.of_cars[car]
        below = np.concatenate(
            [_rows(plan.tables, own, span) for own in plan.axles[axle : axle + axles]], axis=2
        )
        of_motion = steps.stiffness @ below[:, 0] + steps.damping @ below[:, 1]
        of_rate = steps.damping @ below[:, 0]
        self.met = np.concatenate([of_motion, of_rate], axis=2)
        self.per = of_motion * plan.reach[0] + of_rate * plan.reach[1]
        stations = plan.loads[load : load + loads]
        under = [_rows(own, s, span) for own in (plan.load_tables, tables) for s in stations]
        half = len(under) // 2
        acting = np.concatenate(
            [np.concatenate(own, axis=1) for own in (under[:half], under[half:])], axis=2
        )
        self.known = plan.known[car][:, span[0] - start : span[1] - start]
        self.back = acting.transpose(0, 2, 1) @ steps.loads
        through = self.back @ steps.direct @ self.per
        self.coupled, self.standing = through[:, :modes], through[:, modes:]

    def meet(
        self, kind: _Rolling, n: int, ahead: np.ndarray, waves: Waves, turn: np.ndarray
    ) -> np.ndarray:
        """Return the forces on modes, and what is asked of them, without the deck's new forces."""
        np.matmul(self.met[n - self.first], ahead, out=kind.u)
        known = kind.known
        np.matmul(kind.shown, kind.both, out=known)
        known[:, :-1] += (waves.forces[self.car] * turn).view(float)
        known[:, -1] += self.known[:, n - self.first]
        return self.back[n - self.first] @ known

    def go_on(self, kind: _Rolling, n: int, new: np.ndarray, still: bool) -> np.ndarray:
        """Let the wheels feel the deck's new forces; return what that adds to what is asked."""
        if still:
            return np.zeros((self.standing.shape[1], new.shape[1]))
        u = kind.u
        u += self.per[n - self.first] @ new
        return self.standing[n - self.first] @ new

    def force(self, kind: _Rolling, n: int, new: np.ndarray, still: bool) -> np.ndarray:
        """Return the vertical wheel forces, shape (wheels, lanes)."""
        if still:
            return kind.known[1::2]
        return kind.known[1::2] + (kind.direct[1::2] @ self.per[n - self.first]) @ new


def _rows(tables: Sequence[np.ndarray], station: np.ndarray, span: tuple[int, int]) -> np.ndarray:
    """Return a station's part of a table over a span of samples, zero off the deck."""
    start, count, which = (int(n) for n in station)
    table = tables[which]
    result = np.zeros((span[1] - span[0], *table.shape[1:]))
    first, stop = max(span[0], start), min(span[1], start + count)
    if first < stop:
        result[first - span[0] : stop - span[0]] = table[first - start : stop - start]
    return result


def _solved(block: Sequence[_Block], modes: int, samples: int) -> np.ndarray:
    """Return what turns forces without the deck's new ones into the new ones, at every sample."""
    coupled = np.tile(np.eye(modes), (samples, 1, 1))
    for own in block:
        coupled[own.first : own.stop] -= own.coupled
    return np.linalg.inv(coupled)
