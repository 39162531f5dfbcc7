"""The steady state of a vehicle on harmonic rails, in closed form."""

from __future__ import annotations

import numpy as np

from . import errors
from .errors import InputError
from .tracks import Track
from .trains import EXCITATIONS
from .vehicles import Vehicle

__all__ = ["steady_forces", "steady_motion"]


def steady_forces(
    vehicle: Vehicle, track: Track, speed: float, excitation: str = "wheels"
) -> np.ndarray:
    """Return the steady wheel forces on harmonic irregularities, in closed form.

    They are what forces tend to as the run-up grows.

    Parameters
    ----------
    vehicle : Vehicle
    track : Track
        Each rail and direction one `Harmonic` of one common wavelength, or level.
    speed : float
        m/s.
    excitation : {"wheels", "car"}
        See `Passage`.

    Returns
    -------
    ndarray, shape (wheels, 2), complex
        Amplitude and phase: force = Im(F exp(i 2 pi V t / wavelength)), with the car's mid-length
        at x = 0 at t = 0; lateral before vertical.

    Raises
    ------
    InputError
    """
    frequency, met = _steady_support(vehicle, track, speed, excitation)
    return np.tensordot(vehicle.transfer(frequency), met, 2)


def steady_motion(
    vehicle: Vehicle, track: Track, speed: float, excitation: str = "wheels"
) -> dict[str, complex]:
    """Return the steady motion of a vehicle on harmonic irregularities, in closed form.

    Parameters
    ----------
    vehicle, track, speed, excitation
        As for `steady_forces`.

    Returns
    -------
    dict of complex, by freedom as in `Vehicle.labels`
        Amplitude and phase, m or rad, about the place at rest: motion =
        Im(A exp(i 2 pi V t / wavelength)), with the car's mid-length at x = 0 at t = 0.

    Raises
    ------
    InputError
    """
    frequency, met = _steady_support(vehicle, track, speed, excitation)
    motion = np.tensordot(vehicle.motion(frequency), met, 2)
    return dict(zip(vehicle.labels, motion.tolist(), strict=True))


def _steady_support(
    vehicle: Vehicle, track: Track, speed: float, excitation: str
) -> tuple[float, np.ndarray]:
    """Return the frequency, Hz, and how the rail moves below every contact, m, complex.

    Shape (contacts, 2), lateral before vertical.
    """
    if not isinstance(vehicle, Vehicle):
        raise InputError("vehicle", vehicle, "must be a Vehicle")
    if not isinstance(track, Track):
        raise InputError("track", track, "must be a Track")
    errors.choice("excitation", excitation, EXCITATIONS)
    speed = errors.number("speed", speed, above=0.0, unit="m/s")
    rails = [track.rail(d, s) for d in ("lateral", "vertical") for s in ("left", "right")]
    waves = {rail.wavelength for rail in rails if hasattr(rail, "wavelength")}
    others = any(np.isfinite(r.shortest) and not hasattr(r, "wavelength") for r in rails)
    if len(waves) != 1 or others:
        allowed = "the steady state in closed form needs harmonic rails of one wavelength"
        added = any(isinstance(given, list | tuple) for given in (track.vertical, track.lateral))
        lists = "A list adds its parts up; two rails that differ are Rails(left=..., right=...)"
        raise InputError("track", None, allowed, lists * added)
    wavelength = waves.pop()
    met = np.zeros((len(vehicle.contacts), 2), dtype=complex)
    for i, contact in enumerate(vehicle.contacts):
        x = contact.x if excitation == "wheels" else vehicle.front
        for j, direction in enumerate(("lateral", "vertical")):
            rail = track.rail(direction, "right" if contact.y < 0 else "left")
            if hasattr(rail, "wavelength"):
                turn = np.exp(1j * (2 * np.pi * x / wavelength + rail.phase))
                met[i, j] = rail.amplitude * turn
    return speed / wavelength, met
