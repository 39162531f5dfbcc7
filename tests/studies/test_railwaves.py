"""Waves below the wheels, against the train's own run-up stepped through."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies.railwaves import BLOCK, RailWaves
from railbridge.trains import _rail_input

SPEED, STEP = np.array([20.0, 33.0]), 0.02
LEAD_IN = np.array([60.0, 0.0])


@pytest.fixture(scope="module")
def train():
    return rb.Train(rb.vehicle("xia2000"), cars=2, car_spacing=22.5)


@pytest.fixture(scope="module")
def tracks():
    lateral = rb.Harmonic(2e-3, wavelength=14.4, phase=np.pi / 2)
    return [
        rb.Track(vertical=rb.Harmonic(5e-3, wavelength=w, phase=0.3), lateral=lateral)
        for w in (9.0, 14.4)
    ]


@pytest.fixture(scope="module")
def waves(train, tracks):
    return RailWaves(train, tracks, SPEED, LEAD_IN, STEP / SPEED, STEP)


def test_the_input_is_that_of_the_train_itself(train, tracks, waves):
    samples = 3 * BLOCK
    for lane in (0, 1):
        passage = rb.Passage(SPEED[lane], STEP / SPEED[lane], samples, LEAD_IN[lane])
        row = 0
        for car in train.formation:
            shift = car.axles[0].delay / STEP
            whole = int(np.floor(shift + 1e-6))
            u = _rail_input(car, tracks[lane], passage, shift - whole)
            before = u.shape[-1] - samples
            for k in (0, 1, BLOCK, 2 * BLOCK + 7):
                local = k - whole + before
                own = u[..., local].ravel() if local >= 0 else np.zeros(2 * len(car.wheels))
                met = waves.at(k)[row : row + len(own), lane]
                assert met == pytest.approx(own, rel=1e-9, abs=1e-6), (lane, car.number, k)
            row += 2 * len(car.wheels)


def test_the_run_up_in_closed_form_is_that_of_small_steps(train, tracks, waves):
    """The modes of the first car at t = 0, against a sum over a run-up of fine steps."""
    car = train.formation[0]
    poles, left, _, _ = car.vehicle.system.modal
    found = waves.run_up(poles, left, slice(0, 2 * len(car.wheels)))
    h = STEP / SPEED[0]
    passage = rb.Passage(SPEED[0], h, 2, LEAD_IN[0])
    u = _rail_input(car, tracks[0], passage, 0.0)[..., :-1].reshape(2 * len(car.wheels), -1)
    from railbridge.response import ramp_coefficients

    a, b0, b1 = ramp_coefficients(poles, h)
    z, w = np.zeros(len(poles), dtype=complex), left @ u
    for before, after in zip(w.T[:-1], w.T[1:], strict=True):
        z = a * z + b0 * before + b1 * after
    size = np.abs(z).max()
    assert np.abs(found[:, 0] - z).max() < 1e-5 * size
    assert not found[:, 1].any(), "without a run-up the car stands still"
