"""Train and deck stepped together: contacts after Hertz, against plain differential equations."""

from dataclasses import replace

import numpy as np
import pytest
from hertz_ode import Rider, crossing

import railbridge as rb
from railbridge.response import ramp_coefficients
from railbridge.stepping import pressing
from railbridge.vehicles import Body, Spring, Vehicle

RIDER = Rider(wheel=1000.0, body=6000.0, stiffness=1.5e6, damping=2e4, contact=1.0e9)
LENGTH, EI, MASS, SPEED = 20.0, 6e9, 6000.0, 40.0


def vehicle(rider, damping=None):
    bodies = tuple(
        Body(name, mass, (0.0, 0.0, 0.0), (0.0, 0.0, z), ("z",))
        for name, mass, z in (("body", rider.body, 1.0), ("wheel", rider.wheel, 0.45))
    )
    dashpot = rider.damping if damping is None else damping
    springs = (
        Spring("body", "wheel", (0.0, 0.0, 0.7), (0.0, rider.stiffness), (0.0, dashpot)),
        Spring("wheel", "rail", (0.0, 0.0, 0.0), (0.0, rider.contact), (0.0, rider.loss)),
    )
    return Vehicle("rider", bodies, springs, 10.0)


def run_of(amplitude, step, ratio=0.01, damping=None, rider=RIDER, **options):
    deck = rb.Beam("beam", (LENGTH,), MASS, EI).deck(4, ratio)
    track = rb.Track(vertical=rb.Harmonic(amplitude, wavelength=1.5))
    chosen = {"speed": SPEED, "time_step": step, "lead_in": 0.0, "tail": 0.1, "contact": "hertz"}
    return rb.cross(rb.Train(vehicle(rider, damping)), deck, track, **(chosen | options))


@pytest.mark.parametrize(
    ("amplitude", "loss", "parts"),
    [
        pytest.param(2e-4, 0.0, False, id="pressed"),
        pytest.param(1e-3, 0.0, True, id="parted"),
        pytest.param(2e-4, 5e4, False, id="pressed, damped"),
        pytest.param(1e-3, 5e4, True, id="parted, damped"),
    ],
)
@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_hertzian_contact_is_that_of_the_differential_equations(amplitude, loss, parts):
    rider = replace(RIDER, loss=loss)
    times = np.arange(0.0, 0.5, 2.5e-4)

    def rail(x):
        return amplitude * np.sin(2 * np.pi * x / 1.5) if x >= 0.0 else 0.0

    def climb(x):
        return amplitude * 2 * np.pi / 1.5 * np.cos(2 * np.pi * x / 1.5) if x >= 0.0 else 0.0

    rails = rail, climb
    force, middle = crossing(rider, SPEED, LENGTH, EI, MASS, 0.01, 4, rails, times)
    errors = []
    for step in (2.5e-4, 1.25e-4, 6.25e-5):
        run = run_of(amplitude, step, rider=rider)
        every = round(2.5e-4 / step)
        ours = -run.wheel_forces[0, 1, ::every][: len(times)]
        moved = run.displacement(10.0, kept_only=True)["displacement_z"][::every][: len(times)]
        # The waves begin with a break, at the first sample; a damper feels it there.
        errors.append(np.sqrt(np.mean((ours - force)[1:] ** 2)) / force.std())
        assert np.max(np.abs(moved - middle)) < 40.0 * (step / 2e-2) ** 2 * np.max(np.abs(middle))
        assert run.parted.any() == parts
    assert errors[-1] < 1.5e-3
    # With the square of the step, as for contacts that hold.
    assert errors[1] < errors[0] / 2.2 and errors[2] < errors[1] / 2.2
    linear = crossing(rider, SPEED, LENGTH, EI, MASS, 0.01, 4, rails, times, unilateral=False)[0]
    assert np.max(np.abs(linear - force)) > 0.02 * force.max()  # the law itself matters here


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_energy_is_what_the_pull_has_put_in():
    """Without dampers: energy changes by the work of the force that keeps the speed."""
    gains = []
    for step in (1e-4, 5e-5):
        run = run_of(1e-3, step, ratio=0.0, damping=0.0)
        energy, work = balance(run, 1e-3)
        assert run.parted.any() and np.ptp(energy) > 20.0
        gains.append(np.max(np.abs(energy - energy[0] - work)) / np.ptp(energy))
    assert gains[1] < 0.01 and gains[1] < gains[0] / 2.5, gains


def balance(run, amplitude):
    """Energy about the static place on a rigid level track, and the work of the pull, J."""
    on = run.time < LENGTH / SPEED - 1e-9
    t, h = run.time[on], run.settings.time_step
    n = np.arange(1, 5)[:, None]
    root = np.sqrt(2.0 / (MASS * LENGTH))
    x = SPEED * t
    shape = root * np.sin(n * np.pi * x / LENGTH)
    slope = root * n * np.pi / LENGTH * np.cos(n * np.pi * x / LENGTH)
    # Signs of shapes are the deck's own.
    own = run.deck.shapes(np.array([2.0]))[0, :, 1]
    sign = np.sign(own * np.sin(n[:, 0] * np.pi * 2.0 / LENGTH))[:, None]
    q, velocity = (sign * getattr(run.state, name)[:, on] for name in ("q", "velocity"))
    force = -run.wheel_forces[0, 1, on]
    motion = run.car_motion(1)
    wheel, body = motion["wheel z"][on], motion["body z"][on]
    rates = np.gradient(wheel, h), np.gradient(body, h)
    wave = 2 * np.pi / 1.5
    rail, climb = amplitude * np.sin(wave * x), amplitude * wave * np.cos(wave * x)
    load = RIDER.load
    depth = 1.5 * load / RIDER.contact
    pressed = np.maximum(depth + rail + np.sum(shape * q, axis=0) - wheel, 0.0)
    omega2 = (2 * np.pi * run.deck.frequencies_hz[:, None]) ** 2
    energy = (
        0.5 * RIDER.wheel * rates[0] ** 2
        + 0.5 * RIDER.body * rates[1] ** 2
        + 0.5 * RIDER.stiffness * (body - wheel) ** 2
        + load * wheel
        + 0.4 * load * pressed**2.5 / depth**1.5
        + 0.5 * np.sum(velocity**2 + omega2 * q**2, axis=0)
    )
    power = force * SPEED * (climb + np.sum(slope * q, axis=0))
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * h)])
    return energy[2:-2] - energy[2], work[2:-2] - work[2]


STIFF = 1.5 * 8e4 / 1e-4
UNDAMPED = np.array([[8e4], [1e-4], [0.0], [0.0], [0.0], [1.0 / STIFF]])
REST = np.zeros((2, 1))


def test_one_contact_by_hand():
    """A wheel that nothing else moves: p is what lies between the law and its tangent."""
    load, depth = 8e4, 1e-4
    stretch = -3e-5  # pressed 30 per cent deeper
    law = load * ((depth - stretch) / depth) ** 1.5
    more = law - load + STIFF * stretch
    # The force follows p alone: carried = known - answer p.
    found, memory = pressing(np.array([-(law - more)]), np.array([[-1.0]]), UNDAMPED, REST)
    assert found == pytest.approx([more], rel=1e-9)
    assert memory[:, 0] == pytest.approx([stretch, STIFF * stretch])


def test_a_contact_that_is_pulled_carries_nothing():
    # Nearly rigid wheels: the linear contact would pull by 100 kN.
    answer, linear = -0.9 * np.eye(2), np.array([1e5, -8e4])
    p, _ = pressing(linear, answer, np.tile(UNDAMPED, 2), np.zeros((2, 2)))
    carried = -(linear + answer @ p)
    assert abs(carried[0]) < 1e-6 and carried[1] == pytest.approx(8e4)


def test_a_damper_in_the_contact_adds_the_law_of_hunt_and_crossley():
    load, depth, damping, h = 8e4, 1e-4, 1e5, 2e-5
    pole = -STIFF / damping
    a, b0, b1 = (v.real for v in ramp_coefficients(np.array([pole]), h))
    contact = np.array([[load], [depth], [damping], a, b0 / damping, b1 / damping])
    # g grows linearly from rest over the step, e and e' follow exactly.
    found, memory = pressing(np.array([-1.1e5]), np.array([[-0.9]]), contact, REST)
    stretch, stretched = memory[:, 0]
    rate = (stretched - STIFF * stretch) / damping
    carried = 1.1e5 + 0.9 * found[0]
    law = load * ((depth - stretch) / depth) ** 1.5 * (1.0 - damping / load * rate)
    assert carried == pytest.approx(law, rel=1e-9)
    assert stretched == pytest.approx(load - carried + found[0])
    assert rate < 0.0 and law > 1.05 * load * ((depth - stretch) / depth) ** 1.5
