"""What is unlikely to be meant about a track: waves, tables, random rails, rails that differ."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..errors import InputWarning, counted
from ..tracks import Irregularity, Rails, Track
from ..trains import AnyTrain
from .bounds import BOUNDS, doubt

__all__ = ["parts_of", "track_doubts"]


def track_doubts(train: AnyTrain, track: Track) -> list[InputWarning]:
    """Return what is unlikely to be meant about a track below a train."""
    return _of_track(track) + _on_one_rail(train, track)


def _of_track(track: Track) -> list[InputWarning]:
    found = []
    for field, part in parts_of(track):
        if hasattr(part, "amplitude") and hasattr(part, "wavelength"):
            found += _of_wave(field, part)
        elif hasattr(part, "x") and hasattr(part, "r"):
            found += _of_table(field, part)
        elif hasattr(part, "amplitudes"):
            found += _of_sum(field.removesuffix(".left"), part) if ".right" not in field else []
    return found


def _on_one_rail(train: AnyTrain, track: Track) -> list[InputWarning]:
    """Doubt rails that differ below wheels at y = 0, which all stand on the left one."""
    found, apart_by = [], {"lateral": "gauge", "vertical": "cross-level"}
    for column, (direction, apart) in enumerate(apart_by.items()):
        if track.rail(direction, "left") == track.rail(direction, "right"):
            continue
        names = [
            vehicle.name
            for vehicle, _ in train.kinds()
            if all(wheel.y == 0.0 for wheel in vehicle.contacts)
            and vehicle.contact_stiffness[:, column].any()
        ]
        if names:
            text = f"has rails that differ, and all wheels of {counted(names, 4)} stand at y = 0, "
            text += f"on the left rail: {apart} moves them. Give both rails the same, or set "
            text += "rails_differ = false (RandomTrack: leave out cross_level and gauge)"
            found.append(InputWarning(f"track.{direction}", text))
    return found


def parts_of(track: Track) -> Iterator[tuple[str, Irregularity]]:
    """Give every irregularity of a track, as it was given, with its path."""
    for direction in ("vertical", "lateral"):
        yield from _parts(f"track.{direction}", getattr(track, direction))


def _parts(field: str, given: object) -> Iterator[tuple[str, Irregularity]]:
    """Give every irregularity of a direction with its path."""
    if isinstance(given, Rails):
        for side in ("left", "right"):
            yield from _parts(f"{field}.{side}", getattr(given, side))
    elif isinstance(given, (list, tuple)):
        for i, part in enumerate(given, start=1):
            yield from _parts(f"{field}[{i}]", part)
    elif given is not None:
        yield field, given


def _of_wave(field: str, wave: Irregularity) -> list[InputWarning]:
    found = doubt("wavelength", f"{field}.wavelength", wave.wavelength)
    found = found or doubt("amplitude", f"{field}.amplitude", wave.amplitude)
    steep = 2 * np.pi * wave.amplitude / wave.wavelength
    if not found and not BOUNDS["slope"].holds(steep):
        text = f"= {wave.amplitude:g} m in waves of {wave.wavelength:g} m makes slopes of "
        text += f"{steep:.2g}: {BOUNDS['amplitude'].slip(wave.amplitude)}"
        found = [InputWarning(f"{field}.amplitude", text)]
    if not BOUNDS["phase"].holds(wave.phase):
        text = f"= {wave.phase:g} rad is more than a turn: given in degrees?"
        found.append(InputWarning(f"{field}.phase", text))
    return found


def _of_sum(field: str, waves: Irregularity) -> list[InputWarning]:
    """Doubt a random rail whose standard deviation is larger than waves usually are."""
    sigma = float(np.sqrt(np.sum(np.abs(waves.amplitudes) ** 2) / 2))
    bound = BOUNDS["amplitude"]
    if bound.holds(sigma):
        return []
    text = f"is random with a standard deviation of {sigma:.3g} m, usual is {bound.range}"
    return [InputWarning(field, f"{text}: {bound.slip(sigma)}")]


def _of_table(field: str, measured: Irregularity) -> list[InputWarning]:
    steep = float(np.max(np.abs(np.diff(measured.r) / np.diff(measured.x))))
    if BOUNDS["slope"].holds(steep):
        return []
    text = f"reaches {np.abs(measured.r).max():g} m with slopes of {steep:.2g}, usual is "
    return [InputWarning(f"{field}.r", f"{text}{BOUNDS['slope'].range}: given in mm, or x in km?")]
