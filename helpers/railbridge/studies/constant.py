r"""Constant loads that cross a deck at many speeds.

Nothing that the deck does changes such loads, so no train has to be run. With the front axle at s =
V t, the modal force

    p_m(s) = sum over axles of -P_k (w_m(x) + y theta_m(x)),   x = s - a_k while on the deck,

depends on the place alone. It is sampled once for all speeds, and each speed only sets the step h =
ds / V of the recursion. For q'' + 2 zeta omega q' + omega^2 q = p, the pole s and z' = s z + p, the
exact step of `response.ramp_coefficients` gives q = Im(z) / omega_d. The imaginary part of

    (b1 + b0 / z) / (1 - a / z)   is   (n0 + n1 / z + n2 / z^2) / (1 - 2 Re(a) / z + |a|^2 / z^2),
    n0 = Im(b1),   n1 = Im(b0 - b1 conj(a)),   n2 = -Im(b0 conj(a)),

a real filter of second order. The same with s b0, s b1 gives q', and q'' follows from the equation
of motion: each output needs one pass of `scipy.signal.lfilter` a mode.

Between samples p is taken as linear. Where an axle enters or leaves, at the fraction c of a step, p
bends (by g) or jumps (by J): the chord there has g c (1 - c) ds^2 / 2 + J (c - 1/2) ds too much.
Half of it is taken off the samples on both sides, so that the impulse is right.

Where the deck has a rail, w, theta and influence lines are those that a load on the rail meets, and
each sleeper enters and leaves by itself; on a bed nothing bends or jumps.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.signal import lfilter

from ..decks import Deck
from ..response import lagged, oscillator, ramp_coefficients
from ..settings import highest_frequency
from ..trains import AnyTrain
from .outputs import Output, Peaks, of_modes_counted

__all__ = ["LARGEST_TURN", "NEARLY_CRITICAL", "constant_loads", "place_step"]

LARGEST_TURN = 0.4
"""Angle, rad, by which the highest mode turns in one step; peaks are then met to 1e-4."""
_PER_DECK, _PER_HALF_WAVE = 250, 25
NEARLY_CRITICAL = 0.9999
"""Damping ratio from which on a mode is no longer taken as one that swings."""
_JUST = 1e-9
"""How far from an axle the two sides of a jump are taken, share of the deck."""


def place_step(deck: Deck, speed: float) -> float:
    """Return the step of the front axle, m, in which a crossing at a speed (m/s) is sampled.

    One of a ladder, each half of the one before, so that crossings of similar speed share samples.
    """
    widest = deck.length / max(_PER_DECK, _PER_HALF_WAVE * len(deck.frequencies_hz))
    fine = LARGEST_TURN * speed / max(2 * np.pi * highest_frequency(deck), 1e-9)
    return widest / 2.0 ** max(0, int(np.ceil(np.log2(widest / fine) - 1e-9)))


def constant_loads(
    deck: Deck,
    train: AnyTrain,
    speeds: Sequence[float],
    outputs: Sequence[Output],
    *,
    track_offset: float = 0.0,
    tail: float = 1.0,
    accelerations_up_to_hz: float = np.inf,
) -> Peaks:
    """Return the extremes of constant axle loads at many speeds.

    Parameters
    ----------
    deck : Deck
    train : AnyTrain
        Of which only places and static loads of axles count.
    speeds : sequence of float
        m/s.
    outputs : sequence of Output
    track_offset : float
        m left of the deck axis.
    tail : float
        s of free vibration after the last axle has left.
    accelerations_up_to_hz : float
        Up to which frequency modes count in accelerations; see `Settings`.

    Notes
    -----
    Displacements and accelerations at peaks between samples are those of a parabola.
    """
    speeds = np.asarray(speeds, dtype=float)
    outputs = of_modes_counted(outputs, deck, accelerations_up_to_hz)
    found = np.empty((6, len(speeds), len(outputs)))
    steps = np.array([place_step(deck, speed) for speed in speeds])
    for step in np.unique(steps):
        own = np.flatnonzero(steps == step)
        passage = _passage(deck, train, outputs, track_offset, step, tail * speeds[own].max())
        for i in own:
            along = deck.length + 2 * deck.reach + train.length + tail * speeds[i]
            samples = 2 + int(np.ceil(along / step))
            found[:4, i] = _extremes(passage, deck, outputs, speeds[i], samples)
            found[4:, i] = passage.static_low, passage.static_high
    return Peaks(*found)


@dataclass(frozen=True, eq=False)
class _Passage:
    """What the place of a train alone decides.

    Attributes
    ----------
    step : float
        m.
    start : float
        Place of the front axle at the first sample, m: a step before it loads the deck.
    modal : ndarray, shape (modes, n)
        Modal forces.
    static : ndarray, shape (outputs, n)
        What influence lines give; zero for accelerations.
    fronts : list of ndarray, shape (k,)
        For each section force, places of the front axle (m) just before and just after an axle
        passes the section, and what the influence line gives there; empty for the others.
    static_low, static_high : ndarray, shape (outputs,)
    """

    step: float
    start: float
    modal: np.ndarray
    static: np.ndarray
    fronts: list[tuple[np.ndarray, np.ndarray]]
    static_low: np.ndarray
    static_high: np.ndarray


def _passage(
    deck: Deck,
    train: AnyTrain,
    outputs: Sequence[Output],
    track_offset: float,
    step: float,
    behind: float,
) -> _Passage:
    axles = train.placed_axles
    delays = np.array([axle.delay for axle in axles])
    loads = -np.array(
        [
            [axle.static_load, sum(w.static_load * (track_offset + w.y) for w in axle.wheels)]
            for axle in axles
        ]
    )
    samples = 3 + int(np.ceil((deck.length + 2 * deck.reach + train.length + behind) / step))
    start = -step - deck.reach
    modal = _summed(deck.under_rail(deck.shapes), delays, loads, deck, step, samples)
    _mend_ends(modal, deck, delays, loads, step)
    static = np.zeros((len(outputs), samples))
    fronts = []
    limits = np.full((2, len(outputs)), np.nan)
    for i, output in enumerate(outputs):
        empty = np.zeros(0), np.zeros(0)
        if output.line is None:
            fronts.append(empty)
            continue
        influence = deck.under_rail(output.line.influence)
        static[i] = _summed(influence, delays, loads, deck, step, samples)[0]
        breaks = [output.x + offset for offset, _ in deck.parts] if output.is_force else []
        beside = [_beside(influence, x, delays, loads, deck.length) for x in breaks]
        own = [np.concatenate(each) for each in zip(*beside, strict=True)]
        fronts.append(tuple(own) if own else empty)
        (low, high), _ = _refined(static[i], step, fronts[-1][0] - start)
        limits[:, i] = min(low, *fronts[-1][1], 0.0), max(high, *fronts[-1][1], 0.0)
    return _Passage(step, start, modal, static, fronts, *limits)


def _summed(
    shape: Callable, delays: np.ndarray, loads: np.ndarray, deck: Deck, step: float, samples: int
) -> np.ndarray:
    """Return what functions along the rail give under all axles, shape (functions, samples)."""
    reach, length = deck.reach, deck.length + 2 * deck.reach
    starts = np.ceil(delays / step - 1e-6).astype(int)
    keys = np.round(starts - delays / step, 6)
    total = None
    for key in np.unique(keys):
        # Axles that meet the samples alike share the values.
        count = int(np.floor(length / step - key + 1e-6)) + 1
        x = np.clip(step * (key + np.arange(count)), 0.0, length) - reach
        values = shape(x)[:, :, 1:]
        if total is None:
            total = np.zeros((values.shape[1], samples))
        up, roll = np.ascontiguousarray(values.transpose(2, 1, 0))
        for start, (force, couple) in zip(starts[keys == key] + 1, loads[keys == key], strict=True):
            total[:, start : start + count] += force * up
            if couple:
                total[:, start : start + count] += couple * roll
    return total


def _mend_ends(
    modal: np.ndarray, deck: Deck, delays: np.ndarray, loads: np.ndarray, step: float
) -> None:
    """Take off what the chords beside the ends of the deck have too much; see above."""
    ends = np.array([0.0, deck.length])
    sign = np.array([1.0, -1.0])  # on, off
    start = -step - deck.reach
    jump, bend = (
        np.einsum("emc,kc->ekm", sign[:, None, None] * deck.shapes(ends, d)[:, :, 1:], loads)
        for d in (0, 1)
    )
    for e, (offset, part) in product((0, 1), deck.parts):
        place = (delays + (ends[e] + offset) - start) / step
        # The sample before: an axle exactly on one is on the deck there, at both ends.
        before = np.ceil(place - 1e-6) - 1 if e == 0 else np.floor(place + 1e-6)
        share = (place - before)[:, None]
        off = bend[e] * share * (1 - share) * step / 4 + jump[e] * (share - 0.5) / 2
        for sample in (before.astype(int), before.astype(int) + 1):
            np.subtract.at(modal.T, sample, part * off)


def _beside(
    influence: Callable, x: float, delays: np.ndarray, loads: np.ndarray, length: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return where the front is just before and behind each axle's passing x, and the statics."""
    just = _JUST * length
    fronts = (delays[:, None] + x + np.array([-just, just])).ravel()
    places = fronts[:, None] - delays
    values = influence(places.ravel())[:, 0, 1:].reshape(*places.shape, 2)
    return fronts, np.einsum("fkc,kc->f", values, loads)


def _extremes(
    passage: _Passage, deck: Deck, outputs: Sequence[Output], speed: float, samples: int
) -> np.ndarray:
    """Return smallest, largest and their times of every output at one speed."""
    step, start, force = passage.step, passage.start, passage.modal[:, :samples]
    h = step / speed
    wanted = {
        "q": any(not o.is_acceleration for o in outputs),
        "v": deck.internal_damping > 0.0 and any(o.is_force for o in outputs),
        "a": any(o.is_acceleration for o in outputs),
    }
    q, v, a = _modes(deck, force, h, wanted)
    omega2 = (2 * np.pi * deck.frequencies_hz) ** 2
    result = np.empty((4, len(outputs)))
    for i, output in enumerate(outputs):
        fronts, beside = passage.fronts[i]
        if output.is_acceleration:
            values = output.modal @ a
        else:
            # Modes left out stand still; see `decks.Deck.recovered`.
            rest = -((output.modal / omega2) @ force)
            if output.is_force:
                moving = output.modal @ (q + deck.internal_damping * v if wanted["v"] else q)
                smooth = moving + rest
                values = smooth + passage.static[i, :samples]
                beside = beside + np.interp((fronts - start) / step, np.arange(samples), smooth)
            else:
                rest += passage.static[i, :samples]
                values = output.modal @ q + lagged(rest, deck.internal_damping, h)
        (low, high), (low_at, high_at) = _refined(values, step, fronts - start)
        if len(fronts):
            least, most = int(np.argmin(beside)), int(np.argmax(beside))
            if beside[least] < low:
                low, low_at = beside[least], fronts[least] - start
            if beside[most] > high:
                high, high_at = beside[most], fronts[most] - start
        result[:, i] = low, high, (low_at + start) / speed, (high_at + start) / speed
    return result


def _modes(
    deck: Deck, force: np.ndarray, h: float, wanted: dict[str, bool]
) -> tuple[np.ndarray | None, ...]:
    """Return coordinates, velocities and accelerations of all modes, None where not wanted."""
    omega, ratio = 2 * np.pi * deck.frequencies_hz, deck.damping_ratios
    swings = (omega > 0.0) & (ratio < NEARLY_CRITICAL)
    found = {key: np.empty_like(force) if wanted[key] else None for key in "qva"}
    safe = np.where(swings, omega, 1.0), np.where(swings, ratio, 0.0)
    pole = safe[0] * (-safe[1] + 1j * np.sqrt(1.0 - safe[1] ** 2))
    a, b0, b1 = ramp_coefficients(pole, h)

    def numerator(weight: np.ndarray) -> np.ndarray:
        left, right, back = weight * b0, weight * b1, np.conj(a)
        terms = right.imag, (left - right * back).imag, -(left * back).imag
        return np.stack(terms, axis=1) / pole.imag[:, None]

    below = np.stack([np.ones_like(a.real), -2 * a.real, np.abs(a) ** 2], axis=1)
    above = {"q": numerator(np.ones_like(pole)), "v": numerator(pole)}
    above["a"] = (
        below - (2 * ratio * omega)[:, None] * above["v"] - (omega**2)[:, None] * above["q"]
    )
    for m, f in enumerate(force):
        if not swings[m]:
            moved, rate = oscillator(omega[m], ratio[m]).sampled(h)(f[None])
            own = {"q": moved, "v": rate}
            own["a"] = f - 2 * ratio[m] * omega[m] * rate - omega[m] ** 2 * moved
        for key, values in found.items():
            if values is not None:
                values[m] = lfilter(above[key][m], below[m], f) if swings[m] else own[key]
    return found["q"], found["v"], found["a"]


def _refined(
    values: np.ndarray, step: float, breaks: np.ndarray
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return smallest and largest of sampled values, and where (m from the first sample).

    At the tip of the parabola through the three samples there, unless one of the `breaks` (m), at
    which the values bend or jump, is near.
    """
    tips, where = [], []
    for k in (int(np.argmin(values)), int(np.argmax(values))):
        tip, shift = values[k], 0.0
        inside = 0 < k < len(values) - 1
        if inside and not (len(breaks) and np.abs(breaks - k * step).min() < 2 * step):
            before, after = values[k - 1], values[k + 1]
            bend = before - 2 * values[k] + after
            if bend:
                shift = 0.5 * (before - after) / bend
                tip -= 0.25 * (before - after) * shift
        tips.append(tip)
        where.append((k + shift) * step)
    return tuple(tips), tuple(where)
