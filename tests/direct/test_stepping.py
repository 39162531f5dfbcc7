"""Train and deck stepped together: contacts after Hertz, against plain differential equations."""

from dataclasses import replace

import numpy as np
import pytest
from hertz_ode import Rider, crossing
from spacecar_ode import Link, Part, SpaceCar, Wheel
from spacecar_ode import crossing as crossing_in_space

import railbridge as rb
from railbridge.contacts.wheelsets import Wheelset, on_wheelsets
from railbridge.direct.stepping import pressing
from railbridge.response import ramp_coefficients
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


def run_of(amplitude, step, ratio=0.01, damping=None, rider=RIDER, depth=0.0, **options):
    deck = rb.Beam("beam", (LENGTH,), MASS, EI).deck(4, ratio)
    # Waves that begin without a step or a break, below the level of the track before.
    below = rb.Table([-1e3, 1e3], [-amplitude, -amplitude])
    track = rb.Track(vertical=[rb.Harmonic(amplitude, wavelength=1.5, phase=np.pi / 2), below])
    chosen = {"speed": SPEED, "time_step": step, "lead_in": 0.0, "tail": 0.1, "contact": "hertz"}
    dip = rb.Notch(((1, 1),), circumference=1e4, offset=0.0, depth=depth, length=1.5)
    train = rb.Train(vehicle(rider, damping), notches=(dip,) if depth else ())
    return rb.cross(train, deck, track, **(chosen | options))


@pytest.mark.parametrize(
    ("depth", "loss", "parts"),
    [
        pytest.param(2e-3, 0.0, False, id="pressed"),
        pytest.param(5e-3, 0.0, True, id="parted"),
        pytest.param(2e-3, 5e4, False, id="pressed, damped"),
        pytest.param(6e-3, 5e4, True, id="parted, damped"),
    ],
)
@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_hertzian_contact_is_that_of_the_differential_equations(depth, loss, parts):
    """One dip of 1.5 m. A wheel that has flown lands ten times and more, each a little late."""
    rider = replace(RIDER, loss=loss)
    times = np.arange(0.0, 0.5, 2.5e-4)

    def rail(x):
        return -depth / 2 * (1.0 - np.cos(2 * np.pi * x / 1.5)) if 0.0 <= x <= 1.5 else 0.0

    def climb(x):
        slope = -np.pi * depth / 1.5 * np.sin(2 * np.pi * x / 1.5)
        return slope if 0.0 <= x <= 1.5 else 0.0

    rails = rail, climb
    force, middle = crossing(rider, SPEED, LENGTH, EI, MASS, 0.01, 4, rails, times)
    errors = []
    for step in (2.5e-4, 1.25e-4, 6.25e-5):
        run = run_of(0.0, step, rider=rider, depth=depth)
        every = round(2.5e-4 / step)
        ours = -run.wheel_forces[0, 1, ::every][: len(times)]
        moved = run.displacement(10.0, kept_only=True)["displacement_z"][::every][: len(times)]
        errors.append(np.sqrt(np.mean((ours - force) ** 2)) / force.std())
        assert np.max(np.abs(moved - middle)) < 40.0 * (step / 2e-2) ** 2 * np.max(np.abs(middle))
        assert run.parted.any() == parts
    assert errors[-1] < (0.04 if parts else 1e-3)
    # With the square of the step, as for contacts that hold.
    assert errors[1] < errors[0] / 3.0 and errors[2] < errors[1] / 3.0
    linear = crossing(rider, SPEED, LENGTH, EI, MASS, 0.01, 4, rails, times, unilateral=False)[0]
    assert np.max(np.abs(linear - force)) > 0.02 * force.max()  # the law itself matters here


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_energy_is_what_the_pull_has_put_in():
    """Without dampers: energy changes by the work of the force that keeps the speed."""
    gains = []
    for step in (1e-4, 5e-5):
        run = run_of(4e-3, step, ratio=0.0, damping=0.0)
        energy, work = balance(run, 4e-3)
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
    rail, climb = amplitude * (np.cos(wave * x) - 1.0), -amplitude * wave * np.sin(wave * x)
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


SPACE = ("y", "z", "roll", "pitch", "yaw")
GAUGE, LOSS = 1.5, 1e5
PARTS = {
    "frame": Part(21e3, (9e3, 2.5e4, 2.6e4), (0.15, 0.03, 1.2), SPACE),
    "first": Part(1600.0, (850.0, 0.0, 900.0), (1.25, 0.0, 0.46), ("y", "z", "roll", "yaw")),
    "second": Part(1600.0, (850.0, 0.0, 900.0), (-1.25, 0.0, 0.46), ("y", "z", "roll", "yaw")),
}
LINKS = [
    Link("frame", name, (x, y, 0.5), (8e6, 5e6, 1.2e6), (2e3, 1e3, 1.5e4), (0.0, 0.0, 8e6))
    for name, x in (("first", 1.25), ("second", -1.25))
    for y in (0.98, -0.98)
]
WHEELS = [
    Wheel(name, (x, y, 0.0), 6e8, 1.1e9, LOSS)
    for name, x in (("first", 1.25), ("second", -1.25))
    for y in (GAUGE / 2, -GAUGE / 2)
]


def in_space():
    """The same vehicle, of the package."""
    frame = PARTS["frame"]
    body = Body("frame", frame.mass, frame.inertia, frame.place)
    springs = [
        Spring(
            link.low, link.high, link.at, link.k[1:], link.c[1:], link.k[0], link.c[0],
            link.series[1:],
        )
        for link in LINKS
    ]  # fmt: skip
    wheelsets = [
        Wheelset(
            name, part.place[0], part.mass, part.inertia[0], part.inertia[2], GAUGE,
            part.place[2], (6e8, 1.1e9), LOSS,
        )
        for name, part in list(PARTS.items())[1:]
    ]  # fmt: skip
    return on_wheelsets("in space", [body], springs, wheelsets, 6.0)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("contact", ["permanent", "hertz"])
def test_wheelsets_that_roll_yaw_and_part_are_those_of_the_differential_equations(contact):
    """Rails that differ left and right, on a deck that bends and twists; some wheels lift."""
    length, mass, speed, offset, height, ratio = 7.0, 7e3, 60.0, 1.7, 1.1, 0.02
    vertical, lateral, torsion, polar = 3e8, 1.2e9, 5e8, 2.5e4
    content = {
        "length": length, "mass": mass, "bending_stiffness_vertical": vertical,
        "bending_stiffness_lateral": lateral, "torsional_stiffness": torsion,
        "polar_inertia": polar, "modes": 3, "damping": {"modal": ratio}, "track_height": height,
    }  # fmt: skip
    deck = rb.deck_from_table("d", content)
    k = np.pi / length
    omega = np.array([k**2 * np.sqrt(e / mass) for e in (lateral, vertical)])
    omega = np.append(omega, k * np.sqrt(torsion / polar))
    size = np.diag(np.sqrt(2.0 / (length * np.array([mass, mass, polar]))))

    def shapes(x):
        on = (x >= 0.0) & (x <= length)
        part = np.array([np.sin(k * x), k * np.cos(k * x)]) * on
        return part[..., None, None] * size

    # Left and right, and sideways: (1 - cos) of the place, level before the deck.
    high, low, aside = 2e-3, 2e-4, 1e-3
    lengths = np.array([2.5, 3.1, 2.5, 3.1]), np.full(4, 5.0)
    depths = np.array([high, low, high, low]), np.full(4, aside)

    def rails(x):
        met = []
        for depth, wave in zip(depths[::-1], lengths[::-1], strict=True):
            turn = 2 * np.pi / wave
            on = x > 0.0
            half = on * depth / 2
            met.append((half * (np.cos(turn * x) - 1.0), -half * turn * np.sin(turn * x)))
        return np.moveaxis(np.array(met), (0, 1, 2), (2, 0, 1))

    def waves(depth, wave):
        below = rb.Table([-1e3, 1e3], [-depth / 2] * 2)
        return [rb.Harmonic(depth / 2, wave, np.pi / 2), below]

    track = rb.Track(rb.Rails(left=waves(high, 2.5), right=waves(low, 3.1)), waves(aside, 5.0))
    times = np.arange(0.0, 0.14, 2e-4)
    car = SpaceCar(PARTS, LINKS, WHEELS)
    exerted, motion = crossing_in_space(
        car, shapes, omega, ratio, speed, offset, height, rails, times, contact == "hertz"
    )
    dynamic = exerted - np.array([[0.0, -load] for load in car.load])[..., None]
    parts = contact == "hertz"
    step, every = (5e-5, 4) if parts else (1e-4, 2)
    run = rb.cross(
        rb.Train(in_space()), deck, track, speed=speed, track_offset=offset, contact=contact,
        time_step=step, lead_in=0.0, tail=0.0, interaction="direct",
    )  # fmt: skip
    ours = run.wheel_forces[..., ::every][..., : len(times)]
    lifted = run.parted[:, ::every][:, : len(times)].any(axis=1)
    assert lifted.any() == parts and not lifted.all()
    wrong = np.sqrt(np.mean((ours - exerted) ** 2, axis=(0, 2)))
    assert np.all(wrong < (0.02 if parts else 5e-3) * np.sqrt(np.mean(dynamic**2, axis=(0, 2))))
    moved = run.car_motion(1)
    for (name, freedom), expected in zip(car.labels, motion, strict=True):
        found = moved[f"{name} {freedom}"][::every][: len(times)]
        assert found == pytest.approx(expected, abs=2e-3 * np.abs(expected).max())


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


@pytest.mark.parametrize("compiles", [True, False])
def test_contacts_obey_hertz_where_the_track_starts_with_a_step(compiles, monkeypatch):
    if not compiles:
        monkeypatch.setattr("railbridge.direct.solution.has_compiler", lambda: False)
    car = rb.with_wheelsets(rb.planar_car(rb.vehicle("xia2000")), mass=1800.0)
    deck, r, speed = rb.deck("viaduct36"), 6e-5, 40.0
    track = rb.Track(vertical=rb.Table(x=[-200.0, 600.0], r=[r, r]))
    train = rb.Train(car, cars=2, car_spacing=25.03)
    run = rb.cross(train, deck, track, speed=speed, contact="hertz", lead_in=0.0, tail=0.1)
    bodies = sorted(car.wheelsets, key=lambda body: -body.position[0])
    for wheel, force in zip(train.wheels, run.wheel_forces[:, 1], strict=True):
        x = speed * run.time - wheel.delay
        on_rail = np.where(x > -1e-9, r, 0.0)
        on_rail = on_rail + np.einsum("km,mk->k", deck.shapes(x)[:, :, 1], run.state.q)
        moved = run.car_motion(wheel.car)[f"{bodies[wheel.number - 1].name} z"]
        load = wheel.static_load
        at_rest = 1.5 * load / car.contact_stiffness[wheel.number - 1, 1]
        share = np.maximum(1.0 - (moved - on_rail) / at_rest, 0.0)
        assert force == pytest.approx(-load * share**1.5, abs=1e-9 * load)


def test_iteration_0_of_hertzian_contacts_is_that_of_a_rigid_deck():
    car = rb.with_wheelsets(rb.planar_car(rb.vehicle("xia2000")), mass=1800.0)
    train, track = rb.Train(car, cars=2), rb.Track(vertical=rb.Harmonic(2e-3, wavelength=2.5))
    options = {"speed": 60.0, "contact": "hertz", "lead_in": 40.0, "tail": 0.2, "time_step": 5e-4}
    soft, rigid = (
        rb.cross(train, rb.Beam("beam", (20.0,), 6e3, ei).deck(3, 0.02), track, **options)
        for ei in (3e9, 3e16)
    )
    load = train.wheels[0].static_load
    assert np.abs(soft.wheel_forces - rigid.wheel_forces).max() > load
    assert soft.at(0).wheel_forces == pytest.approx(rigid.wheel_forces, abs=1e-6 * load)
    assert soft.at(0).body_accelerations == pytest.approx(rigid.body_accelerations, abs=1e-6)
    # And back again, without a trace.
    again = soft.at(0).at(1)
    assert again.wheel_forces == pytest.approx(soft.wheel_forces, abs=1e-9 * load)
    before = rb.spectra.deviation_percent(soft.spectrum, rigid.spectrum)
    assert soft.deviations.from_rigid[0] == pytest.approx(before, rel=1e-4)


def test_a_chosen_step_follows_a_wheel_that_lands():
    """A landing is over in a third of a period of the wheelset on its contact."""
    car = rb.with_wheelsets(rb.vehicle("xia2000_planar"), mass=1800.0, contact_damping=100e3)
    bed = rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
    deck = replace(rb.Beam("b", (LENGTH,), MASS, EI).deck(4, 0.01), rail=bed)
    track = rb.Track(vertical=rb.Harmonic(4e-3, wavelength=3.0))
    options = {"speed": 80.0, "contact": "hertz", "lead_in": 30.0, "tail": 0.1}
    chosen = rb.cross(rb.Train(car), deck, track, **options)
    assert chosen.parted.any()
    assert not [r for r in rb.remarks(chosen) if r.field == "time_step"]
    fine = rb.cross(rb.Train(car), deck, track, time_step=chosen.settings.time_step / 4, **options)
    blows = [-run.wheel_forces[:, 1].min() for run in (chosen, fine)]
    assert blows[1] > 5.0 * fine.train.wheels[0].static_load
    assert blows[0] == pytest.approx(blows[1], rel=0.03)
