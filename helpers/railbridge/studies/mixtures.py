r"""Waves of any size and phase at one speed, from five crossings.

Train, deck and a given number of passes are linear in the irregularity. A wave is

    A sin(k x + phi) = A cos(phi) sin(k x) + A sin(phi) sin(k x + pi/2),

so with H_0 the history of anything on level track, and H_i the one with a single wave of unit size,

    H = H_0 + sum over waves of A cos(phi) (H_1 - H_0) + A sin(phi) (H_2 - H_0).

Vertical and lateral waves that both rails share make four waves, and five crossings; rails that
differ make up to nine. Peaks are not linear: they are looked for in each mixture of histories.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import numpy as np

from ..crossing import compute
from ..decks import Deck
from ..results import Crossing
from ..spectra import amplitude_spectrum, deviation_percent
from ..tracks import Harmonic, Rails, Track
from ..trains import Train
from .lanes import KNOWN, Job, has_given_passes, waves_of
from .outputs import Output, history_of

__all__ = ["WORTH", "mixture_key", "run_mixtures"]

WORTH = 12
"""Crossings from which on nine or fewer are computed instead."""
_TOGETHER = 2**25
"""Numbers of mixed histories at once."""


def mixture_key(job: Job, numbers: Sequence[str], more: bool) -> Hashable | None:
    """Return what crossings must share to be mixtures of each other; None if one cannot be any.

    Parameters
    ----------
    job : Job
    numbers : sequence of str
        What is asked of a whole crossing.
    more : bool
        Whether a whole run is needed to answer.
    """
    s, rails = job.settings, waves_of(job.track)
    if not isinstance(job.train, Train) or more or not set(numbers) <= set(KNOWN):
        return None
    if not has_given_passes(s) or rails is None:
        return None
    waves = tuple(
        rail.wavelength if isinstance(rail, Harmonic) else None for rail in rails.values()
    )
    return None if not any(waves) else (id(job.train), s, waves)


def run_mixtures(
    deck: Deck, jobs: Sequence[Job], outputs: Sequence[Output], numbers: Sequence[str]
) -> np.ndarray:
    """Compute crossings that share a `mixture_key`.

    Parameters
    ----------
    deck : Deck
    jobs : sequence of Job
    outputs : sequence of Output
    numbers : sequence of str
        Some of `lanes.KNOWN`.

    Returns
    -------
    ndarray, shape (jobs, 6 outputs + numbers)
        The six of `Peaks` for each output, then the numbers.
    """
    tracks, shares = _basis([job.track for job in jobs])
    first = jobs[0]
    runs = [compute(first.train, deck, track, first.settings) for track in tracks]
    found = np.empty((len(jobs), 6 * len(outputs) + len(numbers)))
    for i, output in enumerate(outputs):
        histories = [_history(run, output) for run in runs]
        time = histories[0][0]
        low, high = _extremes(np.array([values for _, values in histories]), shares)
        static = (np.nan, np.nan) if output.line is None else runs[0].static_extremes(output.line)
        own = (low[0], high[0], time[low[1]], time[high[1]], *static)
        for k, values in enumerate(own):
            found[:, k * len(outputs) + i] = values
    found[:, 6 * len(outputs) :] = np.array(_numbers(runs, shares, numbers)).T
    return found


def _basis(tracks: Sequence[Track]) -> tuple[list[Track], np.ndarray]:
    """Return level track and one for each wave, and how much of each makes every given track.

    Shares have the shape (tracks, basis), those of the level one included.
    """
    each = [waves_of(track) for track in tracks]
    rails = {way: [own[way] for own in each] for way in each[0]}
    both = {d: rails[d, "left"] == rails[d, "right"] for d in ("vertical", "lateral")}
    basis, shares = [Track()], []
    for (direction, side), own in rails.items():
        if not isinstance(own[0], Harmonic) or (both[direction] and side == "right"):
            continue
        size = max(rail.amplitude for rail in own) or 1.0
        for phase, part in ((0.0, np.cos), (np.pi / 2, np.sin)):
            wave = Harmonic(size, wavelength=own[0].wavelength, phase=phase)
            given = wave if both[direction] else Rails(**{side: wave})
            basis.append(Track(**{direction: given}))
            shares.append([rail.amplitude / size * part(rail.phase) for rail in own])
    waves = np.array(shares).T
    return basis, np.column_stack([1.0 - waves.sum(axis=1), waves])


def _history(run: Crossing, output: Output) -> tuple[np.ndarray, np.ndarray]:
    """Return times and values of an output, on both sides of what jumps too."""
    history = history_of(run, output)
    time, values = history.time, history[output.quantity]
    if history.jumps is not None:
        more_time, more = history.jumps(output.quantity)
        time, values = np.concatenate([time, more_time]), np.concatenate([values, more])
    return time, values


def _extremes(
    histories: np.ndarray, shares: np.ndarray
) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Return smallest and largest value of every mixture, each with its place in the history."""
    low, high = (np.empty((2, len(shares))) for _ in range(2))
    together = max(_TOGETHER // histories.shape[1], 1)
    for first in range(0, len(shares), together):
        some = slice(first, first + together)
        mixed = shares[some] @ histories
        rows = np.arange(len(mixed))
        for found, place in ((low, mixed.argmin(axis=1)), (high, mixed.argmax(axis=1))):
            found[0, some], found[1, some] = mixed[rows, place], place
    return tuple((values, places.astype(int)) for values, places in (low, high))


def _numbers(
    runs: Sequence[Crossing], shares: np.ndarray, numbers: Sequence[str]
) -> list[np.ndarray]:
    found = {"iterations": np.full(len(shares), float(runs[0].solves))}
    if {"wheel_unloading", "wheel_force_z"} & set(numbers):
        forces = np.array([run.wheel_forces[:, 1] for run in runs])
        lowest = np.array(
            [_extremes(forces[:, wheel], shares)[0][0] for wheel in range(forces.shape[1])]
        )
        static = np.array([wheel.static_load or np.nan for wheel in runs[0].train.wheels])
        found["wheel_force_z"] = -lowest.min(axis=0)
        highest = np.array(
            [_extremes(forces[:, wheel], shares)[1][0] for wheel in range(forces.shape[1])]
        )
        found["wheel_unloading"] = np.nanmax(1.0 + highest / static[:, None], axis=0)
    if "deviation_from_rigid" in numbers:
        found["deviation_from_rigid"] = _deviations(runs, shares)
    return [found[name] for name in numbers]


def _deviations(runs: Sequence[Crossing], shares: np.ndarray) -> np.ndarray:
    """Return Eq. 3 of the last pass against the rigid deck; see `Crossing.spectrum`."""
    if not runs[0].iterations:
        return np.full(len(shares), np.nan)
    step = runs[0].settings.time_step
    first = runs[0].coupling.cars[0].car
    own = runs[0].settings.first_on_deck(first, runs[0].deck)
    both = [
        np.array([run.at(i).car_forces(1, static=False)["force_z"][own] for run in runs])
        for i in (0, runs[0].iterations)
    ]
    result = []
    for share in shares:
        rigid, last = (amplitude_spectrum(share @ forces, step) for forces in both)
        result.append(deviation_percent(last, rigid))
    return np.array(result)
