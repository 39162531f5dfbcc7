"""Wheels that leave the rail or would, and bearings that would: which, where, when, how hard."""

from __future__ import annotations

import numpy as np

from ..errors import Remark, ResultWarning
from ..results import Crossing
from ..settings import contact_frequency

__all__ = ["lifting", "parted", "pulling"]

HELD = 0.005
"""Share of the static wheel force from which on the lateral force of a wheel off the rail is told
of."""
LANDING = 6.0
"""Samples in a period of a wheelset on its contacts with which a landing is all wrong."""
LANDS_OFF = 0.05
"""Share of a landing's force from which on its error is told of."""
HARD = 2.0
"""Force of a wheel over its static one from which on it is told, where any wheel lifts."""


def parted(run: Crossing) -> list[Remark]:
    """Name the wheel that is off the rail for the longest time."""
    off = run.parted
    if not off.any():
        return []
    longest = (0, 0, 0)
    for i in np.flatnonzero(off.any(axis=1)):
        edges = np.flatnonzero(np.diff(np.concatenate([[False], off[i], [False]]).astype(int)))
        for start, stop in edges.reshape(-1, 2).tolist():
            longest = max(longest, (stop - start, i, start))
    samples, i, k = longest
    wheel, t = run.train.wheels[i], run.time[k]
    others = int(off.any(axis=1).sum()) - 1
    text = (
        f"Wheel {wheel.number} of car {wheel.car} leaves the rail for "
        f"{1e3 * samples * run.settings.time_step:.3g} ms at t = {t:.4g} s, "
        f"{_place(run.settings.speed * t - wheel.delay, run.deck.length)}"
        + f"; {others} other wheel{'s' * (others > 1)} too, not longer" * bool(others)
        + "."
        + _landing(run)
    )
    contact = run.train.car(wheel.car).vehicle.contact_damping[wheel.number - 1]
    if not contact[1]:
        text += (
            " Its contact has no damper, so it bounces on, and what it strikes later hangs on the "
            "time step: give contact_damping."
        )
    held = np.abs(run.wheel_forces[:, 0] * off).max()
    if held > HELD * wheel.static_load:
        text += (
            " Sideways the springs of the contacts hold on to wheels off the rail, here by up to "
            f"{held / 1e3:.3g} kN, which no rail does."
        )
    return [ResultWarning("", text), *_coarse_landing(run)]


def _coarse_landing(run: Crossing) -> list[Remark]:
    """Say how far a step spoils the blow of a wheel that lands: far more than forces on contact.

    With n samples in a period of the wheelset on its contacts it is off by some (6 / n)^2, as
    halving the step shows, of contacts with dampers of 50 to 200 kN s/m.
    """
    frequency, step = contact_frequency(run.train), run.settings.time_step
    off = (LANDING * frequency * step) ** 2
    if off < LANDS_OFF:
        return []
    text = (
        f"= {step:g} s leaves {1 / (frequency * step):.2g} samples in a period of wheelsets on "
        f"their contacts, {frequency:.3g} Hz: what a wheel strikes on landing is off by some "
        f"{100 * off:.2g} %. At most {np.sqrt(LANDS_OFF) / LANDING / frequency:.2g} s would do."
    )
    return [ResultWarning("time_step", text)]


def _landing(run: Crossing) -> str:
    """Return in words how hard the wheel presses that presses hardest, where that is much."""
    static = np.array([wheel.static_load for wheel in run.train.wheels])
    times = -run.wheel_forces[:, 1] / static[:, None]
    i, k = np.unravel_index(np.argmax(times), times.shape)
    if times[i, k] < HARD:
        return ""
    wheel, force = run.train.wheels[i], -run.wheel_forces[i, 1, k]
    return (
        f" Wheel {wheel.number} of car {wheel.car} presses with {force / 1e3:.3g} kN at "
        f"t = {run.time[k]:.4g} s, {times[i, k]:.3g} times its load at rest: an upper bound, since "
        "rails and sleepers do not give way below it."
    )


def pulling(run: Crossing) -> list[Remark]:
    """Name the wheel that pulls on the rail hardest."""
    if not run.train.kinds():
        return []  # bare axle loads stay as they are
    static = np.array([wheel.static_load for wheel in run.train.wheels])
    if static.min() > 0.0 and np.all(run.wheel_forces[:, 1].max(axis=1) <= 0.0):
        return []  # the common case, without further histories
    unloading = np.nan_to_num(run.wheel_unloading)
    if not unloading.max() > 1.0:
        return []
    i, k = np.unravel_index(np.argmax(unloading), unloading.shape)
    wheel, t = run.train.wheels[i], run.time[k]
    others = int(np.sum(unloading.max(axis=1) > 1.0)) - 1
    wheelsets = all(vehicle.wheelsets for vehicle, _ in run.train.kinds())
    text = (
        f"Wheel {wheel.number} of car {wheel.car} pulls on the rail by "
        f"{run.wheel_forces[i, 1, k] / 1e3:.3g} kN (unloading {unloading[i, k]:.3g}) at "
        f"t = {t:.4g} s, {_place(run.settings.speed * t - wheel.delay, run.deck.length)}"
        + f", and {others} other wheel{'s' * (others > 1)} too" * bool(others)
        + ": it would lift off, which "
        + ("contact = 'hertz' computes." if wheelsets else "is not computed.")
    )
    return [ResultWarning("", text)]


def _place(x: float, length: float) -> str:
    if 0.0 <= x <= length:
        return f"at x = {x:.4g} m"
    return f"{-x:.4g} m before the deck" if x < 0.0 else f"{x - length:.4g} m behind the deck"


def lifting(run: Crossing) -> list[Remark]:
    """Name the bearing that pulls the deck down hardest, the deck's own weight counted."""
    deck, worst = run.deck, (0.0, 0.0, "")
    if deck.recovery.lacks:
        return []
    if deck.bearings:
        places = [
            (
                f"Bearing {number} at x = {x:g}, y = {y:g} m",
                deck.recovery.bearing(number, "force_z"),
            )
            for number, (x, y, _) in enumerate(deck.bearings, start=1)
        ]
    else:
        places = [
            (f"The bearing line at x = {x:g} m", deck.recovery.reaction("force_z", x))
            for x in deck.supports
        ]
    lines = {where: line for where, line in places if line is not None}
    history = run.recovered(lines, dict.fromkeys(lines, "N"), self_weight=True)
    for where in lines:
        (low, t), (high, _) = history.extremes(where)
        if low < min(worst[0], -1e-6 * abs(high)):
            worst = low, t, where
    if not worst[2]:
        return []
    text = (
        f"{worst[2]} would have to hold the deck down by {-worst[0] / 1e3:.3g} kN at "
        f"t = {worst[1]:.4g} s, its own weight counted: it would lift, which is not computed."
    )
    return [ResultWarning("", text)]
