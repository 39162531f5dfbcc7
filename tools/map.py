"""Compute the maps that are shipped: ``python tools/map.py``, about ten minutes on one core.

``data/studies/speed_wavelength.nc``: one car of the paper on ``viaduct36`` over speed and
wavelength, with true wheel loads and four passes. ``data/studies/deck_mass.nc``: the same over
decks of one frequency and several masses, iterated until it settles. Finished crossings are kept
below ``build/maps`` and found again.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

import railbridge as rb

ROOT = Path(__file__).resolve().parents[1]
STUDIES = ROOT / "data" / "studies"
KEPT = ROOT / "build" / "maps"

CAR = {
    "train.vehicle": "xia2000_planar", "train.cars": 1, "track.lateral": {"kind": "none"},
    "run.loads": "wheels",
}  # fmt: skip
"""What makes the paper's case one of a single car, in the vertical plane."""
PASSES = {"run.iterations": 4}
SETTLED = {"run.tolerance": 1e-6, "run.max_iterations": 60}
RIGID = {"run.interaction": "rigid"}

SPEEDS = np.arange(4.0, 103.0, 2.0)  # m/s
WAVELENGTHS = np.round(14.4 * 2.0 ** (np.arange(-23, 27) / 10), 4)  # m, ten an octave
COARSE_SPEEDS = np.arange(8.0, 101.0, 4.0)
COARSE_WAVELENGTHS = np.round(14.4 * 2.0 ** (np.arange(-10, 11) / 5), 4)
DECK_MASSES = np.array([3e3, 4e3, 6e3, 8e3, 12e3, 18e3, 24e3])  # kg/m

MEASURE = ("displacement_z", "acceleration_z", "wheel_unloading", "wheel_force_z")
UNITS = {
    "displacement_z": "m",
    "acceleration_z": "m/s2",
    "wheel_unloading": "-",
    "wheel_force_z": "N",
}
WORDS = {
    "displacement_z": "largest vertical displacement at mid-span",
    "acceleration_z": "largest vertical acceleration at mid-span",
    "wheel_unloading": "largest share of its static force that a wheel loses",
    "wheel_force_z": "largest vertical force of an axle, static part included",
}


def base_case():
    """Return the case of a map at the paper's speed and wavelength."""
    return rb.case("paper").replace(CAR)


def with_mass(case, mass):
    """Return the case on a deck of the same frequencies and another mass per metre, kg/m."""
    deck = {"length": 36.0, "mass": float(mass), "modes": 20}
    deck["bending_stiffness_vertical"] = 35e9 * 2.553 * float(mass) / 12e3
    deck["damping"] = {"ratio": 0.03, "frequencies_hz": [3.307, 16.30]}
    return case.replace({"deck": deck, "train.track": 0.0})


def study(case, passes, speeds, wavelengths, out=None, progress=None):
    """Return one map: with passes, on a rigid deck, and what the passes change.

    Parameters
    ----------
    case : Case
    passes : mapping
        Changes of the case for the run with passes.
    speeds, wavelengths : sequence of float
        m/s and m.
    out : Path, optional
        A folder in which finished crossings are kept.
    """
    over = {"run.speed": list(map(float, speeds))}
    over["track.vertical.wavelength"] = list(map(float, wavelengths))
    folders = (None, None) if out is None else (out / "passes", out / "rigid")
    measure = [*MEASURE, "deviation_from_rigid", "iterations"]
    moved = rb.sweep(case.replace(passes), over, None, measure, out=folders[0], progress=progress)
    rigid = rb.sweep(case.replace(RIGID), over, None, MEASURE, out=folders[1], progress=progress)
    for found in (moved, rigid):
        failed = [text for text in found.message.values.ravel() if text]
        if failed:
            raise SystemExit(f"{len(failed)} crossings have no numbers: {failed[0]}")
    found = moved[["deviation_from_rigid", "iterations"]]
    for name in MEASURE:
        for ending, values in ("", moved[name]), ("_rigid", rigid[name]):
            values = values.isel(x=0, drop=True) if "x" in values.dims else values
            words = WORDS[name] + ", rigid-deck forces" * bool(ending)
            found[name + ending] = values.assign_attrs(units=UNITS[name], long_name=words)
    found["displacement_z_static"] = moved.displacement_z_static.isel(x=0, drop=True)
    for name in ("displacement_z", "acceleration_z", "wheel_force_z"):
        change = 100 * (found[name] / found[f"{name}_rigid"] - 1)
        words = f"what the passes change: {WORDS[name]}"
        found[f"deviation_{name}"] = change.assign_attrs(units="%", long_name=words)
    return found


def speed_and_wavelength(progress=None):
    """Return the map of the paper's car and deck."""
    found = study(base_case(), PASSES, SPEEDS, WAVELENGTHS, KEPT / "speed_wavelength", progress)
    return described(found, base_case(), "one car on viaduct36, over speed and wavelength")


def deck_mass(progress=None):
    """Return the map over masses of the deck."""
    import xarray as xr

    maps = []
    for mass in DECK_MASSES:
        case, out = with_mass(base_case(), mass), KEPT / f"deck_mass_{mass:g}"
        maps.append(study(case, SETTLED, COARSE_SPEEDS, COARSE_WAVELENGTHS, out, progress))
    mass = xr.IndexVariable(
        "deck_mass", DECK_MASSES, {"units": "kg/m", "long_name": "mass of the deck"}
    )
    case = with_mass(base_case(), 12e3)
    return described(xr.concat(maps, mass), case, "one car on decks of one frequency")


def described(found, case, title):
    """Add what the map is of, and make it small."""
    car, deck = case.train.vehicles[0], case.deck
    modes = dict(zip(car.modes().names, car.modes().frequencies_hz, strict=True))
    found = found.drop_vars("message", errors="ignore").astype(np.float32)
    for name, unit in ("speed", "m/s"), ("wavelength", "m"):
        found[name] = found[name].assign_attrs(units=unit, long_name=name)
    return found.assign_attrs(
        title=title, made_by="tools/map.py", version=rb.__version__,
        deck_frequency_hz=float(deck.frequencies_hz[0]), car_frequency_hz=float(modes["car z"]),
        car_mass=sum(wheel.static_load for wheel in case.train.wheels) / 9.81,
        filter_zeros=filter_zeros(car), deck_length=deck.length,
        amplitude=5e-3, paper_speed=20.0, paper_wavelength=14.4,
    )  # fmt: skip


def filter_zeros(car, shortest=2.5):
    """Return the wavelengths, m, that lift no car as a whole (notebook 02), longest first."""
    places = np.unique(np.abs([contact.x for contact in car.contacts]))
    bogies, axles = places.mean(), np.ptp(places) / 2  # half distances
    zeros = [4 * half / odd for half in (bogies, axles) for odd in range(1, 99, 2)]
    return sorted((float(z) for z in zeros if z > shortest), reverse=True)


def store(found, path):
    """Write a map as a small netCDF file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    found.to_netcdf(path, encoding={name: {"zlib": True} for name in found.data_vars})
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size / 1e3:.0f} kB")


def main():
    """Compute what is asked for, or both."""
    makers = {"speed_wavelength": speed_and_wavelength, "deck_mass": deck_mass}
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("maps", nargs="*", choices=[*makers, []], help="default: both")
    for name in parser.parse_args().maps or makers:
        store(makers[name](), STUDIES / f"{name}.nc")


if __name__ == "__main__":
    main()
