"""A seeded campaign: the direct solution is the fixed point, wherever in the space of cases.

Decks of 0.3 to 15 t/m, of one span or two, on rigid or elastic bearings, with and without rails;
cars in space or in their plane, with and without mass in their wheels, on contacts of 2e8 to 3e9
N/m; every way of loading; 8 to 95 m/s. A few cases run always; five hundred, with how each fixed
point was found, by `RAILBRIDGE_CAMPAIGN=500 pytest -s tests/direct/test_direct_campaign.py`.
"""

import os
import warnings

import numpy as np
import pytest

import railbridge as rb

CAMPAIGN = int(os.environ.get("RAILBRIDGE_CAMPAIGN", "0"))
SEEDS = range(CAMPAIGN or 16)
ALLOWED = 1e-8
CAR = rb.vehicle("xia2000")


def drawn(seed):
    """One crossing: train, deck, track, options."""
    rng = np.random.default_rng([14, seed])
    plane = bool(rng.random() < 0.5)
    car = rb.planar_car(CAR) if plane else CAR
    wheeled = bool(rng.random() < 0.5)
    if wheeled:
        mass, contact = rng.uniform(200.0, 2500.0), 10 ** rng.uniform(8.3, 9.5)
        roll = {} if plane else {"roll_inertia": 0.4 * mass}
        car = rb.with_wheelsets(car, mass=mass, contact_stiffness=contact, **roll)
    train = rb.Train(car, cars=int(rng.integers(1, 5)), car_spacing=rng.uniform(22.0, 25.0))
    loads = rng.choice(["wheels", "bogies"] if wheeled else ["wheels", "bogies", "condensed"])
    options = {
        "speed": rng.uniform(8.0, 95.0), "loads": str(loads), "lead_in": 30.0, "tail": 0.1,
        "time_step": float(rng.choice([5e-4, 1e-3])), "tolerance": 1e-10,
        "feedback": str(rng.choice(["all", "all", "vertical"])),
        "track_offset": 0.0 if plane else rng.uniform(-2.6, 2.6),
    }  # fmt: skip
    waves = [
        rb.Harmonic(rng.uniform(0, 3e-3), rng.uniform(4.0, 30.0), rng.uniform(0, 6)) for _ in "vl"
    ]
    return train, drawn_deck(rng), rb.Track(*waves), options


def drawn_deck(rng):
    spans = rng.uniform(12.0, 40.0, size=int(rng.integers(1, 3))).round(2).tolist()
    mass = 10 ** rng.uniform(np.log10(300.0), np.log10(15e3))
    # First frequency 2 to 8 Hz on the longest span, whatever the mass.
    stiffness = mass * (2 * max(spans) ** 2 * rng.uniform(2.0, 8.0) / np.pi) ** 2
    content = {
        "spans": spans, "mass": mass, "bending_stiffness_vertical": stiffness,
        "bending_stiffness_lateral": 8.0 * stiffness, "torsional_stiffness": 0.5 * stiffness,
        "polar_inertia": 4.0 * mass, "modes": int(rng.integers(4, 14)),
        "damping": {"modal": float(rng.choice([0.0, 0.01, 0.03]))},
    }  # fmt: skip
    if rng.random() < 0.3:
        ends = np.concatenate([[0.0], np.cumsum(spans)]).tolist()
        stiff = {"z": 10 ** rng.uniform(8.5, 9.7)}
        content["bearing"] = [
            {"x": x, "fixed": "y roll" + " x" * (i == 0), "stiffness": stiff}
            for i, x in enumerate(ends)
        ]
    if rng.random() < 0.4:
        rails = (
            {"spread": 0.6},
            {"bending_stiffness": 1.28e7, "foundation": 10 ** rng.uniform(7.5, 8.5)},
        )
        content["rail"] = rails[int(rng.integers(2))]
    return rb.deck_from_table("drawn", content)


def apart(run, other):
    """Largest difference of any wheel force, share of the largest dynamic one."""
    static = -np.array([[0.0, wheel.static_load] for wheel in run.train.wheels])[..., None]
    size = np.max(np.abs(run.wheel_forces - static))
    return np.max(np.abs(run.wheel_forces - other.wheel_forces)) / size


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seed", SEEDS)
def test_direct_and_iterated_agree(seed, record_property):
    train, deck, track, options = drawn(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        direct = rb.cross(train, deck, track, interaction="direct", **options)
        iterated = rb.cross(train, deck, track, interaction="iterate", **options)
    assert iterated.converged
    difference = apart(direct, iterated)
    if CAMPAIGN:
        ways = "whole" if iterated.windows is None else f"{len(iterated.windows.stops)} windows"
        print(f"{seed} {difference:.1e} {ways} {len(direct.time)} samples")
    assert difference < ALLOWED
