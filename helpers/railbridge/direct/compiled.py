"""The loop of `stepping`, compiled by numba (the extra `fast`).

The same formulas in plain loops. Only what the deck needs is made at each sample: what the axles
load it with, `L R s + L (D - 1) (K m + C m')`, whose matrices are multiplied before. Compiled code
is kept on disk, beside this file or in the user's cache, where one of them can be written. For
permanent contact the loop is compiled without all that Hertzian contacts need: `_march` has None in
place of what they are given, and numba leaves out what stands below ``is not None``.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from threading import Timer

import numpy as np
from numba import njit
from numba.core.caching import NullCache

from ..errors import brief
from .plans import CarSteps, Plan
from .stepping import MOST, TOLERANCE, Marched

__all__ = ["march"]

_OPTIONS = {"fastmath": {"contract", "reassoc"}, "error_model": "numpy"}
_PATIENCE = 3.0
"""s after which it is said that the loop is being compiled; to load it takes less."""
_STRETCH = 1000
"""Samples between two looks at whether to go on."""


def _compiled(function: Callable) -> Callable:
    try:
        return njit(cache=True, **_OPTIONS)(function)
    except RuntimeError:
        # Neither this folder nor the user's cache can be written: every process compiles anew.
        return njit(**_OPTIONS)(function)


@dataclass(frozen=True, eq=False)
class _Kinds:
    """Cars of all kinds in arrays as large as the largest needs, zero beyond; see `CarSteps`.

    Attributes
    ----------
    decay : ndarray, shape (2, kinds, m)
        Real and imaginary parts, as of all that follows.
    drive : ndarray, shape (2, kinds, m, d)
    shown : ndarray, shape (2, kinds, rows, m)
        L R.
    loaded : ndarray, shape (2, kinds, rows, 3 axles)
        L (D - 1) K and L (D - 1) C.
    felt : ndarray, shape (2, kinds, d, 3 axles)
        K and C.
    pressing : ndarray, shape (kinds, rows, wheels)
        L (D - 1) from what the contacts carry more.
    wheels : ndarray, shape (2, kinds, wheels, m)
        R of the vertical directions.
    direct : ndarray, shape (kinds, wheels, d)
        D - 1 of the vertical directions.
    given : ndarray, shape (2, kinds, wheels, 3 axles)
        (D - 1) K and (D - 1) C of the vertical directions.
    counts : ndarray of int, shape (kinds,)
        How many wheels each has.
    """

    __repr__ = brief

    decay: np.ndarray
    drive: np.ndarray
    shown: np.ndarray
    loaded: np.ndarray
    felt: np.ndarray
    pressing: np.ndarray
    wheels: np.ndarray
    direct: np.ndarray
    given: np.ndarray
    counts: np.ndarray


def march(plan: Plan, progress: Callable[[str], None] | None = None) -> Marched:
    """Step train and deck together, as `stepping.march` does.

    Where the loop has to be compiled first, a line on stderr says so.

    Parameters
    ----------
    plan : Plan
        Of cars whose modes are known.
    progress : function of one text, optional
        Called every thousand samples.

    Raises
    ------
    ArithmeticError
        A contact force that Newton's method does not find.
    """
    different = list({id(car): car for car in plan.cars}.values())
    kind = np.array([[own is car for own in different].index(True) for car in plan.cars])
    kinds = _kinds(different)
    hertzian = plan.rail is not None
    longest = int((plan.windows[:, 1] - plan.windows[:, 0]).max())
    wheels = kinds.direct.shape[1]
    rows, cars = kinds.shown.shape[2], len(plan.cars)
    loads = np.zeros((cars, longest, rows))
    rail = np.zeros((cars, longest, 2 * wheels) if hertzian else (1, 1, 1))
    pressed = np.zeros((cars, wheels, 6))
    states = np.zeros((2, cars, kinds.decay.shape[2]))
    for i, (car, known) in enumerate(zip(plan.cars, plan.known, strict=True)):
        acting = known
        if hertzian:
            u = plan.rail[i]
            acting = known + car.direct @ u
            rail[i, : u.shape[1], : len(u)] = u.T
            pressed[i, : len(u) // 2] = plan.pressed[i].T
        own = (car.loads @ acting).T
        loads[i, : len(own), : own.shape[1]] = own
    tables, at = _joined(plan.tables)
    load_tables, load_at = _joined(plan.load_tables)
    component, spread = _spread(tables, kinds.loaded)
    found = np.zeros((3, plan.samples, plan.reach.shape[1]))
    more = np.zeros((cars, longest, wheels) if hertzian else (1, 1, 1))
    deck, kept = np.zeros((3, plan.reach.shape[1])), np.zeros((cars, wheels, 2))
    of_hertz = (
        rail, pressed, kinds.pressing, kinds.wheels, kinds.direct, kinds.given, kept, more
    )  # fmt: skip
    if not hertzian:
        of_hertz = (None,) * len(of_hertz)
    given = (
        plan.onward, plan.reach,
        tables, at[plan.axles[:, 2]], plan.axles,
        load_tables, load_at[plan.loads[:, 2]], plan.loads, plan.of_cars, kind, plan.windows,
        loads, kinds.decay, kinds.drive, kinds.shown, kinds.loaded, kinds.felt, kinds.counts,
        component, spread, deck, states, found, *of_hertz,
    )  # fmt: skip
    _make_ready(lambda: _march(plan.first, plan.first, *given))
    for start in range(plan.first, plan.samples, _STRETCH):
        if progress is not None:
            progress(f"step {max(start, 0)} of {plan.samples}")
        if not _march(start, min(start + _STRETCH, plan.samples), *given):
            raise ArithmeticError("a contact force does not settle within a step")
    q, velocity, force = (np.ascontiguousarray(own.T) for own in found)
    parted = tuple(
        np.ascontiguousarray(own[: stop - start, : len(car.direct) // 2].T)
        for own, car, (start, stop) in zip(more, plan.cars, plan.windows, strict=False)
    )
    return Marched(q, velocity, force, parted if hertzian else ())


def _make_ready(call: Callable[[], bool]) -> None:
    """Call a loop of no steps, so that it is loaded, or compiled, before it is needed."""
    with _said():
        try:
            call()
        except Exception:
            # A file of the cache that is damaged, or a full disk: numba passes on whatever comes.
            for function in (_solve, _press, _march, _rows_of, _loads_of):
                with suppress(OSError):
                    function._cache.flush()
                function._cache = NullCache()
            call()


@contextmanager
def _said() -> Iterator[None]:
    """Say on stderr what is waited for, if it takes long."""

    def say() -> None:
        text = "railbridge: compiling the loop that steps train and deck together, once on this "
        with suppress(OSError, ValueError, AttributeError):
            print(f"{text}machine: some 10 to 30 s", file=sys.stderr, flush=True)

    timer = Timer(_PATIENCE, say)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _joined(tables: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return tables one behind the other, and where each begins."""
    begin = np.cumsum([0, *(len(table) for table in tables[:-1])])
    return np.ascontiguousarray(np.concatenate(tables)), begin


def _spread(tables: np.ndarray, loaded: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the component in which each mode moves, and `_Kinds.loaded` by axle and mode.

    Shape (2, kinds, rows, axles, modes); no axles where a mode moves in several components. Where
    each has its own, the sum over three rows an axle is one over axles, a third of the work.
    """
    moves = np.any(tables != 0.0, axis=(0, 1))
    component = np.argmax(moves, axis=0)
    axles = loaded.shape[3] // 3 if np.all(moves.sum(axis=0) <= 1) else 0
    rows = 3 * np.arange(axles)[:, None] + component
    return component, np.ascontiguousarray(loaded[..., rows])


def _kinds(cars: list[CarSteps]) -> _Kinds:
    def filled(parts: list[np.ndarray]) -> np.ndarray:
        shape = np.max([part.shape for part in parts], axis=0)
        result = np.zeros((len(parts), *shape))
        for own, part in zip(result, parts, strict=True):
            own[tuple(slice(n) for n in part.shape)] = part
        return result

    def both(parts: list[np.ndarray]) -> np.ndarray:
        return np.stack([filled([p.real for p in parts]), filled([p.imag for p in parts])])

    def pair(first: list[np.ndarray], second: list[np.ndarray]) -> np.ndarray:
        return np.stack([filled(first), filled(second)])

    return _Kinds(
        decay=both([c.decay for c in cars]),
        drive=both([c.drive for c in cars]),
        shown=both([c.loads @ c.show for c in cars]),
        loaded=pair(
            [c.loads @ c.direct @ c.stiffness for c in cars],
            [c.loads @ c.direct @ c.damping for c in cars],
        ),
        felt=pair([c.stiffness for c in cars], [c.damping for c in cars]),
        pressing=filled([c.loads @ c.direct[:, 1::2] for c in cars]),
        wheels=both([c.show[1::2] for c in cars]),
        direct=filled([c.direct[1::2] for c in cars]),
        given=pair(
            [c.direct[1::2] @ c.stiffness for c in cars], [c.direct[1::2] @ c.damping for c in cars]
        ),
        counts=np.array([len(c.direct) // 2 for c in cars]),
    )


@_compiled
def _solve(a, b, columns):
    """Solve a x = b in place, by elimination with pivots: x stands in b, in its first columns."""
    n = len(a)
    for i in range(n):
        best = i
        for j in range(i + 1, n):
            if abs(a[j, i]) > abs(a[best, i]):
                best = j
        if best != i:
            for c in range(n):
                a[i, c], a[best, c] = a[best, c], a[i, c]
            for c in range(columns):
                b[i, c], b[best, c] = b[best, c], b[i, c]
        inverse = 1.0 / a[i, i]
        for j in range(i + 1, n):
            factor = a[j, i] * inverse
            if factor != 0.0:
                for c in range(i + 1, n):
                    a[j, c] -= factor * a[i, c]
                for c in range(columns):
                    b[j, c] -= factor * b[i, c]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            for c in range(columns):
                b[i, c] -= a[i, j] * b[j, c]
        for c in range(columns):
            b[i, c] /= a[i, i]


@_compiled
def _press(count, linear, answer, contacts, memory, p):
    """Find p of Hertzian contacts in place, see `stepping.pressing`; return whether it settled.

    Contacts and memory have a row for each wheel.
    """
    inverse, matrix = np.empty((count, count + 1)), np.empty((count, count))
    free, d, force, step = (
        np.empty((count, 1)), np.empty((count, 1)), np.empty((count, 1)), np.empty((count, 1)),
    )  # fmt: skip
    rate, still, tangent = np.zeros(count), np.zeros(count), np.empty(count)
    for i in range(count):
        for j in range(count):
            inverse[i, j] = 1.0 if i == j else 0.0
            matrix[i, j] = answer[i, j]
        inverse[i, count] = linear[i]
    _solve(matrix, inverse, count + 1)
    for i in range(count):
        load, depth, damping, decay, before, beta = contacts[i]
        alpha = decay * memory[i, 0] + before * memory[i, 1]
        free[i, 0] = depth - alpha - beta * (load - inverse[i, count])
        d[i, 0] = free[i, 0]
        if damping > 0.0:
            k = 1.5 * load / depth
            rate[i] = (1.0 / beta - k) / load
            still[i] = depth - alpha / (1.0 - k * beta)
    settled = False
    for _ in range(MOST + 1):
        for i in range(count):
            load, depth = contacts[i, 0], contacts[i, 1]
            share = max(d[i, 0] / depth, 0.0)
            more, root = 1.0 + rate[i] * (d[i, 0] - still[i]), np.sqrt(share)
            force[i, 0] = max(load * share * root * more, 0.0)
            tangent[i] = 1.5 * load / depth * root * more + load * share * root * rate[i]
            if force[i, 0] <= 0.0:
                tangent[i] = 0.0
        if settled:
            for i in range(count):
                p[i] = -inverse[i, count]
                for j in range(count):
                    p[i] -= inverse[i, j] * force[j, 0]
                memory[i, 0] = contacts[i, 1] - d[i, 0]
                memory[i, 1] = contacts[i, 0] - force[i, 0] + p[i]
            return True
        for i in range(count):
            step[i, 0] = d[i, 0] - free[i, 0]
            for j in range(count):
                opening = -contacts[i, 5] * ((1.0 if i == j else 0.0) + inverse[i, j])
                step[i, 0] += opening * force[j, 0]
                matrix[i, j] = opening * tangent[j]
            matrix[i, i] += 1.0
        _solve(matrix, step, 1)
        settled = True
        for i in range(count):
            d[i, 0] -= step[i, 0]
            settled &= abs(step[i, 0]) / contacts[i, 1] <= TOLERANCE
    return False


@_compiled
def _march(
    first, stop, onward, reach,
    tables, at, axles, load_tables, load_at, loads_of,
    of_cars, kind, windows, known,
    decay, drive, shown, loaded, felt, counts, component, spread,
    deck, states, found,
    rail, pressed, pressing, wheels, direct, given, kept, more,
):  # fmt: skip
    """Run the loop of `stepping.march` from a sample to before another.

    Returns whether all contacts settled. `deck`, `states` and `kept` hold what goes on from sample
    to sample; all from `rail` on is None where the contact is permanent.
    """
    modes, cars = reach.shape[1], len(kind)
    rows, size, d = shown.shape[2], decay.shape[2], drive.shape[3]
    places = loaded.shape[3]
    most = 0
    if rail is not None:
        most = cars * counts.max()
    q, velocity, force = deck[0], deck[1], deck[2]
    ahead, rate = np.zeros(modes), np.zeros(modes)
    # Of every car on the deck, so that they are there when the deck's forces are known.
    shapes = np.zeros((cars, places, modes))
    slopes = np.zeros((cars, places, modes))
    acting = np.zeros((cars, rows, modes))
    of_motion, of_rate = np.zeros((places, modes)), np.zeros((places, modes))
    axles_alone = spread.shape[3]
    own_motion, own_rate = np.zeros((axles_alone, modes)), np.zeros((axles_alone, modes))
    per = np.zeros((rows, modes))
    moved, moving, u = np.zeros(places), np.zeros(places), np.zeros(d)
    coupled, right = np.zeros((modes, modes)), np.zeros((modes, 1 + most))
    linear, answer, p = np.zeros(most), np.zeros((most, most)), np.zeros(most)
    contacts, memory = np.zeros((most, 6)), np.zeros((most, 2))
    per_wheel = np.zeros((most, modes))
    here_at = np.full(cars, first - 1)  # when each was last on the deck
    low = 0
    for k in range(first, stop):
        while low < cars and windows[low, 1] <= k:
            low += 1
        free = 1.0 if k > 0 else 0.0
        for m in range(modes):
            if free:
                ahead[m] = (
                    onward[0, m] * q[m] + onward[1, m] * velocity[m] + onward[4, m] * force[m]
                )
                rate[m] = onward[2, m] * q[m] + onward[3, m] * velocity[m] + onward[5, m] * force[m]
            for j in range(modes):
                coupled[m, j] = 0.0
            coupled[m, m] = 1.0
            right[m, 0] = 0.0
        on, columns = 0, 1
        for c in range(low, cars):
            if not windows[c, 0] <= k < windows[c, 1]:
                continue
            n, now = kind[c], k - windows[c, 0]
            count = counts[n]
            # What it meets of the deck.
            here = _rows_of(
                tables, at, axles, of_cars[c, 0], of_cars[c, 1], k, shapes[c], slopes[c]
            )
            here |= _loads_of(
                load_tables, load_at, loads_of, of_cars[c, 2], of_cars[c, 3], k, acting[c]
            )
            for i in range(places):
                value, climb = 0.0, 0.0
                if here:
                    for m in range(modes):
                        value += shapes[c, i, m] * ahead[m]
                        climb += slopes[c, i, m] * ahead[m] + shapes[c, i, m] * rate[m]
                moved[i], moving[i] = value, climb
            if rail is not None:
                for i in range(d):
                    value = rail[c, now, i]
                    for j in range(places):
                        value += felt[0, n, i, j] * moved[j] + felt[1, n, i, j] * moving[j]
                    u[i] = value
                # Those on the deck stand one behind the other; one off it is found at once, behind
                # them.
                own = columns - 1
                for w in range(count):
                    contacts[own + w], memory[own + w] = pressed[c, w], kept[c, w]
                    value = -pressed[c, w, 0]
                    for i in range(size):
                        value += (
                            wheels[0, n, w, i] * states[0, c, i]
                            - wheels[1, n, w, i] * states[1, c, i]
                        )
                    for i in range(d):
                        value += direct[n, w, i] * u[i]
                    linear[own + w] = value
                if not here:
                    for w in range(count):
                        for i in range(count):
                            answer[w, i] = direct[n, w, 2 * i + 1]
                    if not _press(
                        count, linear[own:], answer, contacts[own:], memory[own:], p[own:]
                    ):
                        return False
                    for w in range(count):
                        more[c, now, w], kept[c, w] = p[own + w], memory[own + w]
            if not here:
                continue
            on += 1
            here_at[c] = k
            for r in range(rows):
                value = known[c, now, r]
                for i in range(size):
                    value += (
                        shown[0, n, r, i] * states[0, c, i] - shown[1, n, r, i] * states[1, c, i]
                    )
                for i in range(places):
                    value += loaded[0, n, r, i] * moved[i] + loaded[1, n, r, i] * moving[i]
                for m in range(modes):
                    right[m, 0] += acting[c, r, m] * value
            for i in range(places):
                for m in range(modes):
                    of_motion[i, m] = free * shapes[c, i, m] * reach[0, m]
                    of_rate[i, m] = shapes[c, i, m] * reach[1, m] + slopes[c, i, m] * reach[0, m]
                    of_rate[i, m] *= free
            for i in range(axles_alone):
                for m in range(modes):
                    own_motion[i, m] = of_motion[3 * i + component[m], m]
                    own_rate[i, m] = of_rate[3 * i + component[m], m]
            if rail is not None:
                for w in range(count):
                    column = columns + w
                    for m in range(modes):
                        right[m, column] = 0.0
                        for r in range(rows):
                            right[m, column] += acting[c, r, m] * pressing[n, r, w]
                    for m in range(modes):
                        value = 0.0
                        for i in range(places):
                            value += given[0, n, w, i] * of_motion[i, m]
                            value += given[1, n, w, i] * of_rate[i, m]
                        per_wheel[column - 1, m] = value
                columns += count
            for r in range(rows):
                for m in range(modes):
                    per[r, m] = 0.0
                for i in range(axles_alone):
                    for m in range(modes):
                        per[r, m] += spread[0, n, r, i, m] * own_motion[i, m]
                        per[r, m] += spread[1, n, r, i, m] * own_rate[i, m]
                for i in range(0 if axles_alone else places):
                    by_motion, by_rate = loaded[0, n, r, i], loaded[1, n, r, i]
                    for m in range(modes):
                        per[r, m] += by_motion * of_motion[i, m] + by_rate * of_rate[i, m]
            for r in range(rows):
                for j in range(modes):
                    factor = acting[c, r, j]
                    if factor != 0.0:
                        for m in range(modes):
                            coupled[j, m] -= factor * per[r, m]
        if on:
            _solve(coupled, right, columns)
        if rail is not None and on:
            for w in range(columns - 1):
                for i in range(columns - 1):
                    answer[w, i] = 0.0
                for m in range(modes):
                    linear[w] += per_wheel[w, m] * right[m, 0]
                    for i in range(columns - 1):
                        answer[w, i] += per_wheel[w, m] * right[m, 1 + i]
            own = 0
            for c in range(low, cars):
                if here_at[c] == k:
                    count = counts[kind[c]]
                    for w in range(count):
                        for i in range(count):
                            answer[own + w, own + i] += direct[kind[c], w, 2 * i + 1]
                    own += count
            if not _press(columns - 1, linear, answer, contacts, memory, p):
                return False
            own = 0
            for c in range(low, cars):
                if here_at[c] == k:
                    count = counts[kind[c]]
                    for w in range(count):
                        more[c, k - windows[c, 0], w] = p[own + w]
                        kept[c, w] = memory[own + w]
                    own += count
            for m in range(modes):
                for i in range(columns - 1):
                    right[m, 0] += right[m, 1 + i] * p[i]
        for m in range(modes):
            force[m] = right[m, 0] if on else 0.0
            q[m], velocity[m] = ahead[m], rate[m]
            if free:
                q[m] += reach[0, m] * force[m]
                velocity[m] += reach[1, m] * force[m]
            if k >= 0:
                found[0, k, m], found[1, k, m], found[2, k, m] = q[m], velocity[m], force[m]
        for c in range(low, cars):
            if not windows[c, 0] <= k < windows[c, 1]:
                continue
            n = kind[c]
            for i in range(places):
                value, climb = 0.0, 0.0
                for m in range(modes if here_at[c] == k else 0):
                    value += shapes[c, i, m] * q[m]
                    climb += slopes[c, i, m] * q[m] + shapes[c, i, m] * velocity[m]
                moved[i], moving[i] = value, climb
            for i in range(d):
                value = 0.0
                if rail is not None:
                    value = rail[c, k - windows[c, 0], i]
                for j in range(places):
                    value += felt[0, n, i, j] * moved[j] + felt[1, n, i, j] * moving[j]
                u[i] = value
            if rail is not None:
                for w in range(counts[n]):
                    u[2 * w + 1] += more[c, k - windows[c, 0], w]
            for i in range(size):
                re, im = states[0, c, i], states[1, c, i]
                a, b = decay[0, n, i], decay[1, n, i]
                real, imaginary = a * re - b * im, a * im + b * re
                for j in range(d):
                    real += drive[0, n, i, j] * u[j]
                    imaginary += drive[1, n, i, j] * u[j]
                states[0, c, i], states[1, c, i] = real, imaginary
    return True


@_compiled
def _rows_of(tables, at, stations, begin, count, k, shapes, slopes):
    """Fill in a car's shapes and slopes at a sample; return whether any axle is on the deck."""
    here = False
    for i in range(count):
        start, on_deck = stations[begin + i, 0], stations[begin + i, 1]
        within = 0 <= k - start < on_deck
        row = at[begin + i] + k - start
        for r in range(3):
            for m in range(shapes.shape[1]):
                shapes[3 * i + r, m] = tables[row, 0, r, m] if within else 0.0
                slopes[3 * i + r, m] = tables[row, 1, r, m] if within else 0.0
        here |= within
    return here


@_compiled
def _loads_of(tables, at, stations, begin, count, k, acting):
    """Fill in the rows of a car's load stations at a sample; return whether any is on the deck."""
    here = False
    rows = tables.shape[1]
    for i in range(count):
        start, on_deck = stations[begin + i, 0], stations[begin + i, 1]
        within = 0 <= k - start < on_deck
        row = at[begin + i] + k - start
        for r in range(rows):
            for m in range(acting.shape[1]):
                acting[rows * i + r, m] = tables[row, r, m] if within else 0.0
        here |= within
    return here
