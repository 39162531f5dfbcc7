"""What is wrong with a measured track, and how it is mended where that is asked for.

Each check names place and size of the first thing that is wrong. Nothing is mended by itself: a
jump may be a fault of the record or a broken rail.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np

from .. import errors
from ..errors import InputError

__all__ = ["LONGEST_GAP", "REPAIRS", "Samples", "checked_repairs", "mended"]

REPAIRS = ("repeated", "gap", "step", "drift")
"""What can be mended, in the order in which it is looked for."""
LONGEST_GAP = 5.0
"""m; a straight line across more would be an invention, not a repair."""
_WIDE = 3.0
"""Medians of the spacing from which on samples are missing."""
_MOST_DROPPED = 0.05
"""Share of the samples whose places may be dropped as repeated."""


@dataclass(frozen=True, eq=False)
class Samples:
    """What a record holds.

    Attributes
    ----------
    place : ndarray, shape (n,)
        m.
    columns : dict of ndarray, shape (n,)
        m, by name; NaN where a sample is missing.
    done : tuple of str
        What was mended, in sentences.
    """

    place: np.ndarray
    columns: Mapping[str, np.ndarray]
    done: tuple[str, ...] = ()

    def kept(self, which: np.ndarray, said: str = "") -> Samples:
        """Return some of the samples, with a sentence that says so."""
        columns = {name: r[which] for name, r in self.columns.items()}
        return Samples(self.place[which], columns, (*self.done, said) if said else self.done)


def mended(
    samples: Samples, repair: Collection[str], largest_step: float, largest_drift: float
) -> Samples:
    """Return samples with ascending places, none missing, without steps or drift.

    Parameters
    ----------
    samples : Samples
    repair : collection of str
        What is mended; see `REPAIRS`. All else is refused.
    largest_step : float
        Most that neighbours may differ, m.
    largest_drift : float
        Most that a straight line through all samples may rise from end to end, m.

    Raises
    ------
    InputError
        Naming the column, with place and size.
    """
    samples = _ascending(samples, "repeated" in repair)
    samples = _whole(samples, "gap" in repair)
    samples = _without_steps(samples, "step" in repair, largest_step)
    return _without_drift(samples, "drift" in repair, largest_drift)


def _remedy(name: str) -> str:
    return f'Correct the record, or mend it by repair = ["{name}"]'


def _ascending(samples: Samples, repair: bool) -> Samples:
    place = samples.place
    if len(place) > 1 and np.median(np.diff(place)) < 0:
        allowed = "descends: the record runs the other way"
        remedy = "Reverse the rows, and swap left and right with it"
        raise InputError(f"place from {place[0]:g} m to {place[-1]:g} m", None, allowed, remedy)
    furthest = np.maximum.accumulate(place)
    good = np.concatenate([[True], place[1:] > furthest[:-1]])
    if good.all():
        return samples
    i = int(np.argmin(good))
    back = furthest[i - 1] - place[i]
    what = f"goes back by {back:.4g} m" if back > 0 else "is given twice"
    dropped = int(np.sum(~good))
    if not repair:
        raise InputError(f"place {place[i]:g} m", None, what, _remedy("repeated"))
    if dropped > max(_MOST_DROPPED * len(place), 1):
        allowed = f"{what}, as {dropped} of {len(place)} samples do: too many to drop"
        raise InputError(f"place {place[i]:g} m", None, allowed, "Is the column right?")
    said = f"repeated: {dropped} samples dropped whose place does not ascend, the first at "
    return samples.kept(good, f"{said}{place[i]:g} m")


def _whole(samples: Samples, repair: bool) -> Samples:
    """Return samples without gaps: between places, or missing in a column."""
    missing = np.any([np.isnan(r) for r in samples.columns.values()], axis=0)
    if missing.any():
        samples = _filled(samples, missing, repair)
    place = samples.place
    spacing = np.diff(place)
    usual = float(np.median(spacing))
    wide = np.flatnonzero(spacing > _WIDE * usual)
    if not len(wide):
        return samples
    for i in wide:
        _refuse_gap("place", place[i], spacing[i], repair)
    inside = [
        np.linspace(place[i], place[i + 1], int(np.ceil(spacing[i] / usual)) + 1)[1:-1]
        for i in wide
    ]
    whole = np.sort(np.concatenate([place, *inside]))
    columns = {name: np.interp(whole, place, r) for name, r in samples.columns.items()}
    said = [f"gap: {spacing[i]:.4g} m at {place[i]:g} m filled by a straight line" for i in wide]
    return Samples(whole, columns, (*samples.done, *said))


def _refuse_gap(column: str, at: float, length: float, repair: bool) -> None:
    allowed = f"has a gap of {length:.4g} m"
    if not repair:
        raise InputError(f"{column} at {at:g} m", None, allowed, _remedy("gap"))
    if length > LONGEST_GAP:
        allowed += f"; at most {LONGEST_GAP:g} m can be filled"
        raise InputError(
            f"{column} at {at:g} m", None, allowed, "Use the part before it or behind it"
        )


def _filled(samples: Samples, missing: np.ndarray, repair: bool) -> Samples:
    """Return samples with straight lines where some are missing; what lacks an end is cut off."""
    known = np.flatnonzero(~missing)
    if len(known) < 2:
        raise InputError("place", None, "has no sample at which all columns are known")
    first, last = known[0], known[-1]
    if (first > 0 or last < len(missing) - 1) and not repair:
        name, r = next((n, r) for n, r in samples.columns.items() if np.isnan(r[[0, -1]]).any())
        end = samples.place[0 if np.isnan(r[0]) else -1]
        allowed = "is missing at an end of the record"
        raise InputError(f"{name} at {end:g} m", None, allowed, _remedy("gap"))
    if first > 0 or last < len(missing) - 1:
        cut = len(missing) - (last - first + 1)
        which = np.arange(first, last + 1)
        samples = samples.kept(which, f"gap: {cut} samples cut off at the ends, where some lack")
    place, columns, said = samples.place, dict(samples.columns), list(samples.done)
    for name, r in samples.columns.items():
        known = np.flatnonzero(~np.isnan(r))
        for i in np.flatnonzero(np.diff(known) > 1):
            start, stop = place[known[i]], place[known[i + 1]]
            _refuse_gap(name, start, stop - start, repair)
            length = f"{stop - start:.4g} m at {start:g} m"
            said.append(f"gap: {length} of {name} filled by a straight line")
        columns[name] = np.interp(place, place[known], r[known])
    return Samples(place, columns, tuple(said))


def _without_steps(samples: Samples, repair: bool, largest: float) -> Samples:
    place, columns, said = samples.place, dict(samples.columns), list(samples.done)
    for name, r in samples.columns.items():
        jumps = np.diff(r)
        steps = np.flatnonzero(np.abs(jumps) > largest)
        if not len(steps):
            continue
        i = steps[np.argmax(np.abs(jumps[steps]))]
        size = f"{1e3 * jumps[i]:.4g} mm"
        if not repair:
            allowed = f"jumps by {size} between neighbours, at most {1e3 * largest:g} mm"
            raise InputError(f"{name} at {place[i]:g} m", None, allowed, _remedy("step"))
        smooth = np.setdiff1d(np.arange(len(jumps)), steps)
        usual = np.interp(steps, smooth, jumps[smooth]) if len(smooth) else 0.0
        lift = np.zeros(len(r))
        lift[steps + 1] = jumps[steps] - usual
        columns[name] = r - np.cumsum(lift)
        count = f"{len(steps)} of {name}" if len(steps) > 1 else f"one of {name}"
        said.append(
            f"step: {count} taken out, the largest {size} at {place[i]:g} m; what is behind moved"
        )
    return replace(samples, columns=columns, done=tuple(said))


def _without_drift(samples: Samples, repair: bool, largest: float) -> Samples:
    place, columns, said = samples.place, dict(samples.columns), list(samples.done)
    middle, length = np.mean(place), place[-1] - place[0]
    for name, r in samples.columns.items():
        rate = np.polyfit(place - middle, r, 1)[0]
        rise = f"{1e3 * rate * length:.4g} mm over {length:.4g} m"
        if abs(rate * length) <= largest:
            continue
        if not repair:
            allowed = f"drifts by {rise}, at most {1e3 * largest:g} mm"
            raise InputError(f"column {name}", None, allowed, _remedy("drift"))
        columns[name] = r - rate * (place - middle)
        said.append(f"drift: a straight line of {name}, {rise}, taken out")
    return replace(samples, columns=columns, done=tuple(said))


def checked_repairs(repair: Collection[str] | str) -> tuple[str, ...]:
    """Return what is to be mended, each a word of `REPAIRS`."""
    words = repair.split() if isinstance(repair, str) else repair
    if not isinstance(words, (list, tuple, set, frozenset)):
        raise InputError("repair", repair, "must list some of " + ", ".join(REPAIRS))
    return tuple(errors.choice("repair", word, REPAIRS) for word in words)
