"""Functions that learners write, and the cases that each is tried on.

A trial calls the function with arguments of its own and compares what comes back with what the
suite, or a closed form, gives. What is said names the case and the part of the result, never the
number.
"""

from __future__ import annotations

import copy
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..damping import rayleigh
from ..tracks import Notch
from .replies import UNANSWERED, Reply, is_open, number_reply

__all__ = ["TRIALS", "Case", "Trial", "reply"]

SECONDS = 5.0
"""What one call of a learner's function may take."""


@dataclass(frozen=True)
class Case:
    """One call.

    Attributes
    ----------
    words : str
        What the case is: "one wheel, left of the track".
    arguments : tuple
    expected : ndarray
        What must come back.
    """

    words: str
    arguments: tuple[Any, ...]
    expected: np.ndarray


@dataclass(frozen=True)
class Slip:
    """A wrong function that is often written, and what is said to it.

    Attributes
    ----------
    gives : callable
        What it returns for the arguments of a case.
    says : str
    within : float
        How near a result must be to what it gives, relative to the largest entry.
    """

    gives: Callable[..., Any]
    says: str
    within: float = 1e-6

    def explains(self, values: np.ndarray, case: Case) -> bool:
        """Whether this slip makes these wrong values of a case."""
        given = np.asarray(self.gives(*copy.deepcopy(case.arguments)), dtype=float)
        return given.shape == values.shape and np.allclose(
            values, given, rtol=0.0, atol=self.within * np.abs(given).max()
        )


@dataclass(frozen=True)
class Trial:
    """A function that is asked for.

    Attributes
    ----------
    cases : callable
        Gives the cases.
    parts : tuple of str
        What the entries of a result are called; empty where the entries have no names.
    within : float
        Relative to the largest entry of the same part.
    slips : tuple of Slip
    """

    cases: Callable[[], list[Case]]
    parts: tuple[str, ...] = ()
    within: float = 1e-6
    slips: tuple[Slip, ...] = ()


def reply(name: str, given: Any) -> Reply:
    """Return what is said of a function; its score is the share of the cases that it passes.

    Parameters
    ----------
    name : str
        One of `TRIALS`.
    given : callable
    """
    if is_open(given):
        return UNANSWERED
    if not callable(given):
        return Reply(0.0, f"a function is asked for: give {name} itself, without brackets.")
    trial = TRIALS[name]
    cases = trial.cases()
    faults = [_fault(trial, case, given) for case in cases]
    if all(fault is _NOTHING for fault in faults):
        return Reply(0.0, "no answer yet: the function returns nothing.", given=False)
    for number, (case, fault) in enumerate(zip(cases, faults, strict=True), start=1):
        if fault:
            passed = sum(not fault for fault in faults)
            said = f"{passed} of {len(cases)} cases pass. Case {number}, {case.words}: {fault}"
            return Reply(passed / len(cases), said, hinted=True)
    return Reply(1.0, f"right: it passes all {len(cases)} cases.")


_NOTHING = "it returns nothing. Does it end with return?"


def _fault(trial: Trial, case: Case, given: Callable) -> str:
    """Return what is wrong with one call, or nothing."""
    try:
        with np.errstate(all="ignore"), _at_most(SECONDS):
            result = given(*copy.deepcopy(case.arguments))
    except _TooLong:
        return f"it does not end within {SECONDS:g} s. Is there a loop that never stops?"
    except Exception as error:  # whatever a learner's function may raise
        return f"it stops with {type(error).__name__}: {error}."
    if is_open(result):
        return _NOTHING
    if isinstance(result, dict):
        return "it returns a dict: return the numbers, separated by commas."
    try:
        values = np.asarray(result, dtype=float)
    except (TypeError, ValueError):
        return "what it returns are no real numbers."
    expected = np.asarray(case.expected, dtype=float)
    if values.shape != expected.shape and values.size == expected.size == 1:
        return "it returns a list of one number: is a sum missing?"
    if values.shape != expected.shape:
        verb = "is" if expected.size == 1 else "are"
        return f"it returns {_shape(values)}, {_shape(expected)} {verb} expected."
    if not np.isfinite(values).all():
        return "what it returns is not finite: is something divided by zero?"
    difference = _difference(trial, values, expected)
    if difference:
        for slip in trial.slips:
            if slip.explains(values, case):
                return slip.says
    return difference


class _TooLong(Exception):
    """A function did not end in time."""


@contextmanager
def _at_most(seconds: float) -> Iterator[None]:
    """Interrupt what takes longer, where a program can do that to itself: not on Windows."""
    main = threading.current_thread() is threading.main_thread()
    if not (main and hasattr(signal, "setitimer")):
        yield
        return

    def stop(number: int, frame: Any) -> None:
        raise _TooLong

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def _shape(values: np.ndarray) -> str:
    if values.size == 1:
        return "one number"
    return " x ".join(map(str, values.shape)) + " numbers"


def _difference(trial: Trial, values: np.ndarray, expected: np.ndarray) -> str:
    if values.ndim == 1 and _reordered(trial, values, expected):
        order = f": {', '.join(trial.parts)}" if trial.parts else ""
        return f"the numbers are right, but not in the order asked for{order}."
    near = trial.within * (np.abs(expected).max() or 1.0)
    for i, part in enumerate(trial.parts or ("",)):
        # Each part is compared with its own size, what has no parts as a whole.
        value, right = (values[i], expected[i]) if trial.parts else (values, expected)
        off = np.abs(value - right)
        if np.max(off) <= (trial.within * np.abs(right).max() or near):
            continue
        worst = np.unravel_index(np.argmax(off), off.shape)
        options = {"within": trial.within, "near": near, "component": bool(trial.parts)}
        said = number_reply(value[worst], right[worst], **options).says
        if abs(right[worst]) <= near:
            said = "it must be zero where it is not."
        elif abs(value[worst]) <= near:
            said = "it is zero where it must not be."
        return f"{part}: {said}" if part else said
    return ""


def _reordered(trial: Trial, values: np.ndarray, expected: np.ndarray) -> bool:
    """Whether wrong values become right when both are sorted."""
    limit = trial.within * np.abs(expected).max()
    close = np.abs(np.sort(values.ravel()) - np.sort(expected.ravel())).max() <= limit
    return bool(close and np.abs(values - expected).max() > limit)


# ---- the functions, in the order of the notebooks


def _frequencies() -> list[Case]:
    def chain(n: int, mass: float, stiffness: float) -> tuple[np.ndarray, np.ndarray]:
        """Return equal masses between equal springs, the first on the ground, the last free."""
        k = stiffness * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
        k[-1, -1] = stiffness
        return mass * np.eye(n), k

    def closed(n: int, mass: float, stiffness: float) -> np.ndarray:
        angles = (2 * np.arange(1, n + 1) - 1) * np.pi / (2 * (2 * n + 1))
        return np.sqrt(stiffness / mass) * np.sin(angles) / np.pi

    pair = np.array([[2.0, -1.0], [-1.0, 2.0]]) * 1e6
    turned = np.diag([2.0e3, 5.0e3])
    omega = np.sqrt(np.array([7.0 - np.sqrt(19.0), 7.0 + np.sqrt(19.0)]) / 10.0 * 1e3)
    return [
        Case("one mass on one spring", chain(1, 50e3, 4e6), closed(1, 50e3, 4e6)),
        Case("two unequal masses", (turned, pair), omega / (2 * np.pi)),
        Case("a chain of five", chain(5, 4e3, 2e6), closed(5, 4e3, 2e6)),
    ]


def _each_by_itself(mass: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    return np.sort(np.sqrt(np.diag(stiffness) / np.diag(mass))) / (2 * np.pi)


def _as_if_symmetric(mass: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    squares = np.linalg.eigvalsh(np.linalg.solve(mass, stiffness))
    return np.sqrt(np.abs(squares)) / (2 * np.pi)


def _notch_shape() -> list[Case]:
    def case(words: str, depth: float, length: float) -> Case:
        xi = np.linspace(-0.5, 2.5, 61) * length
        notch = Notch(((1, 1),), circumference=1e3, offset=0.0, depth=depth, length=length)
        return Case(words, (xi, depth, length), notch.value(xi))

    return [
        case("1 mm deep, 50 mm long", 1e-3, 0.05),
        case("2 mm deep, 80 mm long", 2e-3, 0.08),
        case("a shallow one of 0.1 mm", 1e-4, 0.03),
    ]


def _condensed() -> list[Case]:
    def case(words: str, x: list[float], y: list[float], forces: list[list[float]]) -> Case:
        places, sides, loads = np.array(x), np.array(y), np.array(forces)
        across, up = loads.T
        expected = [across.sum(), up.sum(), sides @ up, -places @ up, places @ across]
        return Case(words, (places, sides, loads), np.array(expected))

    return [
        case("one wheel ahead of the centre", [2.0], [0.0], [[0.0, -50e3]]),
        case(
            "an axle, pushed to the left", [1.5, 1.5], [0.98, -0.98], [[3e3, -70e3], [1e3, -76e3]]
        ),
        case(
            "two axles, four wheels",
            [9.05, 9.05, -6.55, -6.55],
            [0.98, -0.98, 0.98, -0.98],
            [[1e3, -73e3], [-2e3, -71e3], [4e3, -75e3], [5e2, -74e3]],
        ),
    ]


def _rayleigh_coefficients() -> list[Case]:
    rows = [(0.03, 3.307, 16.30), (0.01, 2.0, 9.0), (0.05, 0.8, 30.0)]
    return [
        Case(f"{100 * r:g} % at {a:g} and {b:g} Hz", (r, a, b), np.array(rayleigh(r, (a, b))))
        for r, a, b in rows
    ]


def _static_moment() -> list[Case]:
    def case(words: str, places: list[float], forces: list[float], x: float, span: float) -> Case:
        a, up = np.array(places), 1e3 * np.array(forces)
        roof = np.where(a <= x, a * (span - x), x * (span - a)) / span
        on = (a >= 0) & (a <= span)
        return Case(words, (a, up, x, span), np.array(np.sum(up[on] * roof[on])))

    four, some = [8.9, 11.4, 24.5, 27.0], [-2.0, 5.0, 19.0, 23.0]
    return [
        case("one load in the middle", [18.0], [-100.0], 18.0, 36.0),
        case("four axles, section off the middle", four, [-146.0] * 4, 12.0, 36.0),
        case("axles before and behind", some, [-100.0, -200.0, -100.0, -300.0], 9.0, 20.0),
    ]


def _roof_without_ends(places: np.ndarray, forces: np.ndarray, x: float, span: float) -> np.ndarray:
    roof = np.where(places <= x, places * (span - x), x * (span - places)) / span
    return np.sum(forces * roof)


def _fixed_point() -> list[Case]:
    def linear(x: float) -> float:
        return -0.6 * x + 4.0

    def pair(x: np.ndarray) -> np.ndarray:
        return np.array([[0.2, 0.5], [-0.4, 0.1]]) @ np.asarray(x) + np.array([1.0, 2.0])

    both = np.linalg.solve(np.eye(2) - np.array([[0.2, 0.5], [-0.4, 0.1]]), [1.0, 2.0])
    return [
        Case("x = cos x, from 1", (np.cos, 1.0), np.array(0.7390851332151607)),
        Case("x = 4 - 0.6 x, from 0", (linear, 0.0), np.array(2.5)),
        Case("two unknowns, from zero", (pair, np.zeros(2)), both),
    ]


def _after_many(function: Callable, start: Any) -> Any:
    for _ in range(200):
        start = function(start)
    return start


def _until_it_falls(function: Callable, start: Any) -> Any:
    new = function(start)
    while np.all(new - start >= 0.0):
        start, new = new, function(new)
    return new


def _one_force() -> list[Case]:
    def case(words: str, places: list[float], span: float) -> Case:
        axles = np.array(places)
        a = np.maximum(span / 2 - np.abs(axles), 0.0)  # from the nearer bearing
        sag, moment = a * (3 * span**2 - 4 * a**2), a
        top = span / 2 * 2 * span**2, span / 2
        return Case(words, (axles, span), np.array([top[0] / sag.mean(), top[1] / moment.mean()]))

    car = [-9.05, -6.55, 6.55, 9.05]
    return [
        case("the car of this page on 60 m", car, 60.0),
        case("three axles, 30 m", [-6.0, 0.0, 2.5], 30.0),
        case("a span of 15 m, two axles are off it", car, 15.0),
    ]


def _lever_rule() -> list[Case]:
    def case(words: str, x: float, force: float, places: list[float]) -> Case:
        nodes = np.array(places)
        shares = np.array([np.interp(x, nodes, row) for row in np.eye(len(nodes))])
        return Case(words, (x, force, nodes), force * shares)

    return [
        case("in the middle of two nodes", 2.25, -100.0, [0.0, 1.5, 3.0, 4.5]),
        case("nearer to one of them", 3.4, -73e3, [0.0, 2.0, 3.0, 5.0]),
        case("at the last node", 5.0, -10.0, [0.0, 2.0, 3.0, 5.0]),
    ]


def _resonances() -> list[Case]:
    def case(words: str, f_1: float, distance: float, low: float, high: float) -> Case:
        speeds = [f_1 * distance / i for i in range(1, 100)]
        within = sorted(v for v in speeds if low <= v <= high)
        return Case(words, (f_1, distance, low, high), np.array(within))

    return [
        case("4.5 Hz, 21 m, from 40 to 100 m/s", 4.5, 21.0, 40.0, 100.0),
        case("3.3 Hz, 22.5 m, all speeds from 5 m/s", 3.3, 22.5, 5.0, 200.0),
        case("6 Hz, 25 m, ends that are met", 6.0, 25.0, 50.0, 75.0),
    ]


def _descending(f_1: float, distance: float, low: float, high: float) -> np.ndarray:
    return np.array([v for v in f_1 * distance / np.arange(1, 100) if low <= v <= high])


def _hertz() -> list[Case]:
    def case(words: str, depths: list[float], load: float, stiffness: float) -> Case:
        depth, at_rest = np.array(depths), load / stiffness * 3 / 2
        shares = np.where(depth > 0.0, np.abs(depth / at_rest) ** 1.5, 0.0)
        return Case(words, (depth, load, stiffness), load * shares)

    return [
        case("at the depth of rest, and around it", [8e-5, 1e-4, 1.5e-4], 8e4, 1.2e9),
        case("a contact that parts", [2e-5, 0.0, -3e-5], 6e4, 1.0e9),
        case("an axle of 164 kN", [9.1e-5, -1e-3, 2e-4], 164e3, 2.7e9),
    ]


def _linear(depth: np.ndarray, load: float, stiffness: float) -> np.ndarray:
    return load + stiffness * (depth - 1.5 * load / stiffness)


def _that_pulls(depth: np.ndarray, load: float, stiffness: float) -> np.ndarray:
    share = depth / (1.5 * load / stiffness)
    return load * np.sign(share) * np.abs(share) ** 1.5


def _deviation() -> list[Case]:
    # Each system is one that leaves of a wave exp(i W x) a known size at every place.
    d = 0.25
    x = d * np.arange(121)
    waves, powers = np.array([0.21, 0.5, 1.3, 2.9]), np.array([4e-6, 1e-6, 3e-7, 2e-8])
    window = np.sin(np.pi * x / x[-1]) ** 2

    def from_the_last(r: np.ndarray) -> np.ndarray:
        return np.diff(r, prepend=r[0])

    sizes = np.where(x > 0.0, 4 * np.sin(waves[:, None] * d / 2) ** 2, 0.0)
    rows = [
        ("the height itself", np.copy, np.ones((4, len(x)))),
        ("felt on a bridge only", lambda r: 3.0 * window * r, np.tile(9.0 * window**2, (4, 1))),
        ("the difference from the place before", from_the_last, sizes),
    ]
    return [
        Case(words, (answer, x, waves, powers), np.sqrt(powers @ squares))
        for words, answer, squares in rows
    ]


def _variance(answer: Callable, x: np.ndarray, waves: np.ndarray, powers: np.ndarray) -> Any:
    pairs = [answer(np.cos(w * x)) ** 2 + answer(np.sin(w * x)) ** 2 for w in waves]
    return powers @ np.array(pairs)


def _cosines_only(answer: Callable, x: np.ndarray, waves: np.ndarray, powers: np.ndarray) -> Any:
    return np.sqrt(powers @ np.array([answer(np.cos(w * x)) ** 2 for w in waves]))


def _phases_together(answer: Callable, x: np.ndarray, waves: np.ndarray, powers: np.ndarray) -> Any:
    pairs = [(answer(np.cos(w * x)) + answer(np.sin(w * x))) ** 2 for w in waves]
    return np.sqrt(powers @ np.array(pairs))


def _line_speed() -> list[Case]:
    speeds = np.array([40.0, 46.0, 52.0, 58.0, 63.0])
    peak = np.array([[1.2, 2.0, 4.1, 2.6, 3.3], [0.8, 3.5, 2.4, 2.0, 2.2]])
    failed = np.array([[1.2, 2.0, 2.9, np.nan, 3.7], [0.8, 1.1, 1.5, 2.0, 2.2]])
    rows = [
        ("a limit just reached, then a peak", peak, 46.0),
        ("a crossing that failed", failed, 52.0),
        ("the slowest speed breaks the limit", peak + 3.0, 0.0),
    ]
    return [Case(words, (speeds, values, 3.5), np.array(top / 1.2)) for words, values, top in rows]


def _undivided(speeds: np.ndarray, accelerations: np.ndarray, limit: float) -> float:
    kept = (accelerations <= limit).all(axis=0)
    return float(speeds[: int(np.argmin(np.append(kept, False)))].max(initial=0.0))


def _last_kept(speeds: np.ndarray, accelerations: np.ndarray, limit: float) -> float:
    kept = (accelerations <= limit).all(axis=0)
    return float(speeds[kept].max(initial=0.0)) / 1.2


def _unknown_is_met(speeds: np.ndarray, accelerations: np.ndarray, limit: float) -> float:
    kept = ~(accelerations > limit).any(axis=0)
    return float(speeds[: int(np.argmin(np.append(kept, False)))].max(initial=0.0)) / 1.2


def _below_the_limit(speeds: np.ndarray, accelerations: np.ndarray, limit: float) -> float:
    kept = (accelerations < limit).all(axis=0)
    return float(speeds[: int(np.argmin(np.append(kept, False)))].max(initial=0.0)) / 1.2


TRIALS = {
    "frequencies": Trial(
        _frequencies,
        slips=(
            Slip(
                _as_if_symmetric,
                "eigvalsh is for symmetric matrices, and the inverse of M times K is none. Use "
                "np.linalg.eigvals.",
            ),
            Slip(
                _each_by_itself,
                "that is each mass by itself: the entries beside the diagonal couple them.",
            ),
        ),
    ),
    "notch_shape": Trial(_notch_shape),
    "condense": Trial(_condensed, ("F_y", "F_z", "M_x", "M_y", "M_z")),
    "rayleigh_coefficients": Trial(_rayleigh_coefficients, ("alpha", "beta")),
    "static_moment": Trial(
        _static_moment,
        slips=(Slip(_roof_without_ends, "loads off the span count: they must add nothing."),),
    ),
    "fixed_point": Trial(
        _fixed_point,
        slips=(
            Slip(
                _until_it_falls,
                "it stops after one step, or at the first change that is negative. Go on, and "
                "compare sizes, np.abs(new - old).",
            ),
            Slip(_after_many, "it stops too early: go on until below 1e-10.", within=0.02),
        ),
    ),
    "one_force": Trial(_one_force, ("sag", "moment")),
    "lever_rule": Trial(_lever_rule),
    "resonances": Trial(
        _resonances, slips=(Slip(_descending, "they descend: sort them, the smallest first."),)
    ),
    "deviation": Trial(
        _deviation,
        slips=(
            Slip(_variance, "that is the variance: take the root at the end."),
            Slip(
                _cosines_only,
                "that is the cosines alone: at some places they are zero. Add the sines' squares.",
            ),
            Slip(
                _phases_together,
                "square what cosine and sine give each by itself, and add the squares then.",
            ),
        ),
    ),
    "line_speed": Trial(
        _line_speed,
        slips=(
            Slip(_undivided, "a line for v is looked at up to 1.2 v: divide."),
            Slip(
                _last_kept,
                "it looks behind a peak: a train reaches the calm speeds only through the others.",
            ),
            Slip(
                _unknown_is_met,
                "it takes NaN as met: what is not known is not. Ask for <=, not for the opposite "
                "of >.",
            ),
            Slip(_below_the_limit, "a limit that is just reached is kept."),
        ),
    ),
    "hertz": Trial(
        _hertz,
        slips=(
            Slip(_linear, "that is the tangent, permanent contact. Hertz's law is (13.3)."),
            Slip(_that_pulls, "a contact that has parted carries nothing: it must not pull."),
        ),
    ),
}
"""The functions that exercises ask for, by the name that each bears in its notebook."""
