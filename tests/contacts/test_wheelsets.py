"""Wheelsets with mass: against closed forms, against the massless car as their limit, and against
bodies and springs written out by hand."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import railbridge as rb
from railbridge.contacts.hertz import HertzContact
from railbridge.contacts.wheelsets import Wheelset, on_wheelsets, with_wheelsets

CAR = rb.vehicle("xia2000")
STEEL = {"mass": 1800.0, "roll_inertia": 1000.0}


def test_a_wheelset_on_its_contact_in_closed_form():
    """One mass between a spring to a heavy body and its contact: force = k (x - r) by Newton."""
    m, M, k, c, kc, f = 1500.0, 8e3, 1.2e6, 2e4, 2.6e9, 37.0
    car = with_wheelsets(rb.sprung_mass("m", M, k, c), mass=m, contact_stiffness=kc / 2)
    s = 2j * np.pi * f
    upper = k + c * s
    above = M * s**2 * upper / (M * s**2 + upper)  # of the mass on its spring
    expected = -kc * (m * s**2 + above) / (m * s**2 + above + kc)
    assert car.transfer(f)[0, 1, 0, 1] == pytest.approx(expected, rel=1e-9)
    assert car.labels == ("mass z", "mass wheelset 1 z")
    # Far above the contact's own frequency the rail feels its spring only.
    assert car.transfer(1e5)[0, 1, 0, 1] == pytest.approx(-kc, rel=1e-3)
    assert car.contacts[0].static_load == pytest.approx((m + M) * 9.81)


def test_static_loads_and_weight_are_those_of_static_wheelsets():
    heavy = replace(CAR, static_wheelset_mass=1800.0)
    rolling = with_wheelsets(heavy, roll_inertia=1000.0)
    assert rolling.weight == pytest.approx(heavy.weight, rel=1e-12)
    assert rolling.static_wheelset_mass == 0.0
    # The weight that was there already does not press the contact twice.
    light = with_wheelsets(CAR, mass=1800.0, roll_inertia=1000.0)
    assert rolling.contact_stiffness == pytest.approx(light.contact_stiffness, rel=1e-12)
    loads = [[c.static_load for c in v.contacts] for v in (rolling, heavy)]
    assert loads[0] == pytest.approx(loads[1], rel=1e-9)
    assert [axle.x for axle in rolling.axles] == [axle.x for axle in heavy.axles]
    assert [c.y for c in rolling.contacts] == [0.75, -0.75] * 4
    assert rolling.length == CAR.length and rolling.name == CAR.name
    planar = with_wheelsets(rb.vehicle("manchester"))
    assert [c.static_load for c in planar.contacts] == pytest.approx(
        [c.static_load for c in rb.vehicle("manchester").contacts]
    )


def axles_together(car, frequency):
    """Transfer with both wheels of an axle moved sideways alike, their lateral forces added; up
    and down wheel by wheel."""
    transfer = car.transfer(frequency)
    wheels = len(transfer)
    ways = np.zeros((wheels // 2 + wheels, wheels, 2))
    ways[: wheels // 2, :, 0] = np.kron(np.eye(wheels // 2), [[1, 1]])
    ways[wheels // 2 :, :, 1] = np.eye(wheels)
    return np.einsum("pwi,wivj,qvj->pq", ways, transfer, ways)


@pytest.mark.parametrize("frequency", [0.0, 0.5, 1.4, 10.0, 30.0])
def test_light_wheelsets_on_stiff_contacts_are_the_massless_car(frequency):
    """Of first order in the mass, and in the primary springs over the contact.

    The rails move sideways alike: massless wheels let left and right go apart, a wheelset does not.
    """
    exact = axles_together(CAR, frequency)
    scale = max(np.abs(exact).max(), 1e6)

    def missed(share):
        car = with_wheelsets(
            CAR, mass=1e2 * share, roll_inertia=50.0 * share, gauge=2 * 0.98,
            contact_stiffness=1e10 / share, contact_lateral_stiffness=1e10 / share,
        )  # fmt: skip
        return np.abs(axles_together(car, frequency) - exact).max() / scale

    errors = [missed(share) for share in (1.0, 0.1, 0.01)]
    if frequency:
        assert errors[1] / errors[0] == pytest.approx(0.1, rel=0.25)
        assert errors[2] / errors[1] == pytest.approx(0.1, rel=0.1)
    assert errors[2] < 1e-3


def test_the_mass_shows_where_static_wheelsets_are_said_to_be_wrong():
    """Up and down in phase at 4.2 Hz: the force grows by 64 % (`Vehicle.static_wheelset_mass`)."""
    rolling = with_wheelsets(CAR, **STEEL)

    def pressed(car, f):
        return abs(car.transfer(f)[:, 1, :, 1].sum())

    for f, percent in (1.389, -0.3), (2.0, -14), (4.2, 64):
        assert 100 * pressed(rolling, f) / pressed(CAR, f) - 100 == pytest.approx(percent, abs=0.6)


@pytest.mark.parametrize(
    ("low", "high", "least", "most"),
    [
        (0.5, 2.0, 0.925, 1.165),
        (4.0, 6.0, 1.5, 2.5),
        (10.0, 14.0, 0.75, 1.65),
        (20.0, 30.0, 2.3, 7.0),
    ],
)
def test_how_much_mass_adds_to_the_swing_of_the_worst_axle(low, high, least, most):
    """What notebook 13 says of the frequency V / wavelength, with true delays, at all speeds."""
    car = rb.vehicle("xia2000_planar")
    rolling = with_wheelsets(car, mass=1800.0, contact_damping=100e3)

    def swing(car, speed, f):
        track = rb.Track(vertical=rb.Harmonic(1e-3, speed / f))
        return np.abs(rb.steady_forces(car, track, speed)[:, 1]).max()

    for speed in (20.0, 35.0, 50.0, 80.0, 100.0):
        for f in np.geomspace(low, high, 25):
            assert least < swing(rolling, speed, f) / swing(car, speed, f) < most


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
@pytest.mark.parametrize(
    ("speed", "wave", "size"),
    [(80.0, 3.0, 3.3e-3), (80.0, 14.0, 5e-3), (60.0, 3.0, 5e-3), (20.0, 5.0, 5e-3)],
)
def test_mass_of_wheels_changes_a_sag_by_five_per_cent_while_no_axle_lifts(speed, wave, size):
    car, rail = rb.vehicle("xia2000_planar"), rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
    deck = replace(rb.deck("viaduct36"), rail=rail)
    track = rb.Track(vertical=rb.Harmonic(size, wave))
    found = []
    for each in (
        replace(car, static_wheelset_mass=1800.0),
        with_wheelsets(car, mass=1800.0, contact_damping=100e3),
    ):
        run = rb.cross(rb.Train(each), deck, track, speed=speed, lead_in=2 * speed)
        found.append(run.displacement(18.0).extreme("displacement_z")[0])
    assert run.wheel_forces[:, 1].max() < 0
    assert found[1] == pytest.approx(found[0], rel=0.055)


def test_the_contact_is_hertz_s_at_the_load_of_the_axle():
    body = replace(CAR.bodies[0], position=(0.8, 0.0, 1.41))
    ahead = replace(CAR, bodies=(body, *CAR.bodies[1:]))  # more on the front axles
    rolling = with_wheelsets(ahead, **STEEL, wheel_radius=0.42, rail_head_radius=0.2)
    hertz = HertzContact(0.42, 0.2)
    loads = [c.static_load for c in rolling.contacts]
    assert loads[0] > 1.05 * loads[-1]
    expected = [hertz.stiffness(load) for load in loads]
    assert rolling.contact_stiffness[:, 1] == pytest.approx(expected, rel=1e-9)
    assert rolling.contact_stiffness[:, 0] == pytest.approx(
        hertz.lateral_share * np.array(expected)
    )
    given_ = with_wheelsets(CAR, **STEEL, contact_stiffness=1.1e9)
    assert given_.contact_stiffness[:, 1] == pytest.approx(1.1e9)
    both = with_wheelsets(CAR, **STEEL, contact_stiffness=1.1e9, contact_lateral_stiffness=5e8)
    assert both.contact_stiffness[:, 0] == pytest.approx(5e8)


def test_in_the_plane_one_contact_stands_for_two_wheels():
    plane = with_wheelsets(rb.planar_car(CAR), mass=1800.0)
    space = rb.planar_car(with_wheelsets(CAR, **STEEL))
    assert plane.labels == space.labels
    assert plane.modes().frequencies_hz == pytest.approx(space.modes().frequencies_hz, rel=1e-9)
    assert plane.transfer(20.0) == pytest.approx(space.transfer(20.0), rel=1e-8)
    assert {b.freedoms for b in plane.wheelsets} == {("z",)}
    assert {c.y for c in plane.contacts} == {0.0}


def test_wheelsets_are_known_and_hang_in_their_bogies():
    rolling = with_wheelsets(CAR, **STEEL)
    assert [b.name for b in rolling.wheelsets] == [
        "front wheelset 1", "front wheelset 2", "rear wheelset 1", "rear wheelset 2",
    ]  # fmt: skip
    assert [c.carries for c in rolling.contacts] == ["front bogie"] * 4 + ["rear bogie"] * 4
    assert rolling.contacts[0].body == "front wheelset 1"
    assert CAR.wheelsets == () and CAR.contacts[0].carries == "front bogie"
    assert [b.name for b in rolling.car_bodies] == ["car"]
    assert rolling.body_places[0][2] == pytest.approx(7.8)
    names = rolling.modes().names
    assert names[:5] == CAR.modes().names[:5] and "front wheelset 1 z" in rolling.labels
    for loads in ("wheels", "bogies", "condensed"):
        ours, theirs = (rb.Train(v).car(1).condensation(loads) for v in (rolling, CAR))
        assert ours.offsets == pytest.approx(theirs.offsets)
        assert ours.matrix.shape == theirs.matrix.shape


def test_what_stands_on_one_axle_is_no_wheelset_if_it_is_the_car():
    """A heavy mass on one wheel with a light one on top; and the other way round."""
    bodies = [
        rb.Body(name, mass, (0.0, 0.0, 0.0), (0.0, 0.0, z), ("z",))
        for name, mass, z in (("low", 5e3, 1.0), ("high", 1e3, 2.0))
    ]
    springs = (
        rb.Spring("low", "rail", (0.0, 0.0, 0.0), (0.0, 1e6), (0.0, 0.0)),
        rb.Spring("high", "low", (0.0, 0.0, 1.5), (0.0, 1e5), (0.0, 0.0)),
    )
    assert rb.Vehicle("heavy below", tuple(bodies), springs).wheelsets == ()
    bodies[0] = replace(bodies[0], mass=500.0)
    car = rb.Vehicle("heavy above", tuple(bodies), springs)
    assert [b.name for b in car.wheelsets] == ["low"] and car.contacts[0].carries == "high"


def shared_axle():
    """Two coaches on three axles; the middle wheelset hangs in both."""
    coaches = tuple(
        rb.Body(f"coach {i}", 2e4, (2e4, 3e5, 3e5), (x, 0.0, 1.5), ("z", "pitch"))
        for i, x in ((1, 5.0), (2, -5.0))
    )
    springs, wheelsets = [], []
    for i, x in enumerate((9.0, 0.0, -9.0), start=1):
        wheelsets.append(Wheelset(f"axle {i}", x, 1500.0, gauge=0.0))
        for coach in (1, 2):
            if abs(x - (5.0, -5.0)[coach - 1]) < 6.0:
                springs.append(
                    rb.Spring(f"coach {coach}", f"axle {i}", (x, 0, 1), (0, 1e6), (0, 1e4))
                )
    return on_wheelsets("pair", coaches, springs, wheelsets, 20.0)


def test_a_wheelset_between_two_coaches_is_a_station_of_its_own():
    pair = shared_axle()
    assert [c.carries for c in pair.contacts] == ["coach 1", "axle 2", "coach 2"]
    assert rb.Train(pair).car(1).condensation("bogies").offsets == pytest.approx([9.0, 0.0, -9.0])
    assert [b.name for b in pair.car_bodies] == ["coach 1", "coach 2"]
    # Static loads on three axles of two coaches by hand; the contact of each is at its own.
    ends = 2e4 * 9.81 * 5.0 / 9.0
    loads = [ends + 1500 * 9.81, 2 * (2e4 * 9.81 - ends) + 1500 * 9.81]
    assert [c.static_load for c in pair.contacts] == pytest.approx([*loads, loads[0]])
    stiffness = 2 * np.array([HertzContact().stiffness(load / 2) for load in loads])
    assert pair.contact_stiffness[:2, 1] == pytest.approx(stiffness, rel=1e-6)


def test_wheelsets_written_out_by_hand_are_the_same():
    rolling = with_wheelsets(rb.vehicle("manchester"), contact_stiffness=1.4e9)
    plain = rb.vehicle("manchester")
    bodies = [*plain.bodies]
    springs = [s for s in plain.springs if not s.on_rail]
    for i, s in enumerate(s for s in plain.springs if s.on_rail):
        x, name = s.at[0], f"set {i}"
        bodies.append(rb.Body(name, 1813.0, (0.0, 0.0, 0.0), (x, 0.0, 0.0), ("z",)))
        springs.append(rb.Spring(s.from_, name, s.at, s.stiffness, s.damping))
        springs.append(rb.Spring(name, "rail", (x, 0.0, 0.0), (0.0, 2.8e9), (0.0, 0.0)))
    by_hand = rb.Vehicle("by hand", tuple(bodies), tuple(springs), 25.0)
    assert rolling.modes().frequencies_hz == pytest.approx(by_hand.modes().frequencies_hz)
    assert rolling.transfer(15.0) == pytest.approx(by_hand.transfer(15.0))
    assert [c.carries for c in by_hand.contacts] == ["front bogie"] * 2 + ["rear bogie"] * 2


def test_a_train_on_wheelsets_crosses_a_bridge():
    """The direct solution; condensed per bogie as without wheelsets."""
    deck, speed = rb.deck("viaduct36"), 30.0
    track = rb.Track(vertical=rb.Harmonic(1e-3, wavelength=14.4))
    rolling = with_wheelsets(CAR, **STEEL)
    heavy = replace(CAR, static_wheelset_mass=1800.0)
    options = {"speed": speed, "time_step": 2.5e-4, "lead_in": 40.0}
    ours, theirs = (
        rb.cross(rb.Train(v), deck, track, interaction="direct", **options)
        for v in (rolling, heavy)
    )
    sag = [np.abs(run.displacement(18.0)["displacement_z"]).max() for run in (ours, theirs)]
    assert sag[0] == pytest.approx(sag[1], rel=5e-3)
    deck_light = [
        rb.cross(rb.Train(v), deck, track, interaction="rigid", loads="bogies", **options)
        for v in (rolling, heavy)
    ]
    assert len(deck_light[0].coupling.axles.starts) == len(deck_light[1].coupling.axles.starts)


def test_a_wheelset_below_a_mass_on_a_beam_against_an_ode_of_its_own():
    """Sprung mass, wheelset and three modes of a simple beam as one stiff ODE by Radau."""
    m, M, k, c, kc, speed = 1200.0, 8e3, 9e5, 2e4, 4e8, 25.0
    span, per_metre, stiffness, ratio = 20.0, 9e3, 9e9, 0.02
    # Gravity acts on all; the static sag of springs is counted from a rigid, level rail.
    number = np.arange(1, 4)
    omega = (number * np.pi / span) ** 2 * np.sqrt(stiffness / per_metre)
    modal = per_metre * span / 2
    static = (m + M) * 9.81

    def slope(t, y):
        q, v, (z, zs, vz, vs) = y[:3], y[3:6], y[6:]
        shape = np.sin(number * np.pi * speed * t / span) * (t <= span / speed)
        press = kc * (z - shape @ q)  # of the contact, up on the rail less static
        spring = k * (zs - z) + c * (vs - vz)
        a = (shape * (press - static)) / modal - 2 * ratio * omega * v - omega**2 * q
        return np.concatenate([v, a, [vz, vs, (spring - press) / m, -spring / M]])

    time = np.linspace(0.0, span / speed, 401)
    run = solve_ivp(slope, (0, time[-1]), np.zeros(10), "Radau", time, rtol=1e-9, atol=1e-12)
    sag = np.sin(number * np.pi / 2) @ run.y[:3]
    shapes = np.sin(np.outer(number, np.pi * speed * time / span))
    force = kc * (run.y[6] - np.sum(shapes * run.y[:3], axis=0)) - static
    deck = rb.Beam("beam", (span,), per_metre, stiffness).deck(3, ratio)
    car = with_wheelsets(rb.sprung_mass("m", M, k, c), mass=m, contact_stiffness=kc / 2)

    def missed(step):
        found = rb.cross(rb.Train(car), deck, speed=speed, time_step=step, interaction="direct")
        own = deck.shapes(np.array([span / 2]))[0, :, 1] @ found.state.q  # of the modes alone
        there = (
            np.interp(time, found.time, own),
            np.interp(time, found.time, found.wheel_forces[0, 1]),
        )
        exact = sag, force
        inner = slice(2, -2)  # the rail breaks its angle at the ends
        return [
            np.abs((a - b)[inner]).max() / np.abs(b).max()
            for a, b in zip(there, exact, strict=True)
        ]

    coarse, fine = missed(2e-4), missed(1e-4)
    assert fine[0] < 4e-6 and fine[1] < 3e-6
    assert fine[0] < 0.3 * coarse[0]  # of second order


@given(seed=st.integers(0, 99), frequency=st.floats(0.0, 300.0), held=st.booleans())
@settings(max_examples=25, deadline=None)
def test_transfer_is_reciprocal(seed, frequency, held):
    """Force at one contact by motion at another is the same the other way round, with every kind
    of part in the vehicle."""
    chance = np.random.default_rng(seed)
    along = {"longitudinal_stiffness": 1e7, "yaw_inertia": 900.0} if held else {}
    rolling = with_wheelsets(CAR, **STEEL, gauge=chance.uniform(1.0, 2.0), **along)
    springs = tuple(
        replace(s, series_stiffness=tuple(chance.uniform(1e6, 1e7, 2)))
        if not s.on_rail and chance.random() < 0.5
        else s
        for s in rolling.springs
    )
    bars = (rb.AntiRollBar("car", "front bogie", 2e6, 1e4),)
    transfer = replace(rolling, springs=springs, anti_roll_bars=bars).transfer(frequency)
    whole = transfer.reshape(16, 16)
    assert whole == pytest.approx(whole.T, rel=1e-6, abs=1e-9 * np.abs(whole).max())


# ---- refusals


@pytest.mark.parametrize(
    ("given_", "says"),
    [
        ({"roll_inertia": 1e3}, "mass: is missing. Give it in kg"),
        ({"mass": -1.0, "roll_inertia": 1e3}, "mass = -1.0: must be a finite number above 0 kg"),
        ({"mass": 1e3}, "roll_inertia: is missing"),
        (STEEL | {"roll_inertia": 0.0}, "roll_inertia = 0.0: must be a finite number above 0"),
        (STEEL | {"gauge": 0.0}, "gauge = 0.0: must be a finite number above 0 and at most 5 m"),
        (STEEL | {"contact_stiffness": 9e5}, "contact_stiffness = 900000.0: must be a finite"),
        (STEEL | {"contact_stiffness": 2e12}, "contact_stiffness = 2000000000000.0: must be"),
        (STEEL | {"contact_lateral_stiffness": 1.0}, "contact_lateral_stiffness = 1.0: must be"),
        (
            STEEL | {"contact_stiffness": 1e9, "contact_poisson": 0.3},
            "contact_poisson = 0.3: contact_stiffness is given too, never both",
        ),
        (STEEL | {"wheel_radius": 460.0}, "wheel_radius = 460.0: must be a finite number"),
        (STEEL | {"yaw_inertia": 1e3}, "yaw_inertia = 1000.0: nothing holds the wheelset in yaw"),
        (STEEL | {"longitudinal_stiffness": 1e7}, "yaw_inertia: is missing"),
        (STEEL | {"longitudinal_damping": 1e4}, "longitudinal_damping = 10000.0: needs"),
    ],
)
def test_what_cannot_be_is_named(given_, says):
    with pytest.raises(rb.InputError) as refused:
        with_wheelsets(CAR, **given_)
    assert says in str(refused.value)


def test_wheelsets_are_given_once_and_to_vehicles():
    with pytest.raises(rb.InputError, match="has wheelsets already: front wheelset 1"):
        with_wheelsets(with_wheelsets(CAR, **STEEL), **STEEL)
    with pytest.raises(rb.InputError, match="vehicle = 'xia2000': must be a Vehicle"):
        with_wheelsets("xia2000", **STEEL)
    for name in ("gauge", "roll_inertia"):
        with pytest.raises(rb.InputError, match=f"{name} = 1.5: has no meaning where left and"):
            with_wheelsets(rb.vehicle("manchester"), **{name: 1.5})


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"mass": 0.0}, "mass = 0.0: must be a finite number above 0 kg"),
        ({"gauge": 1.5}, "roll_inertia: is needed"),
        ({"roll_inertia": 1e3}, "roll_inertia = 1000.0: has no meaning in the vertical plane"),
        ({"contact_stiffness": (0.0, 1e5)}, "contact_stiffness[2] = 100000.0: must be"),
        ({"contact_stiffness": (1e5, 1e9)}, "contact_stiffness[1] = 100000.0: must be"),
        ({"contact_stiffness": 1e9}, "contact_stiffness = 1000000000.0: must be a list"),
        (
            {"contact_stiffness": (0.0, 1e9), "wheel_radius": 0.4},
            "wheel_radius = 0.4: contact_stiffness is given too",
        ),
    ],
)
def test_a_wheelset_names_what_cannot_be(changes, says):
    with pytest.raises(rb.InputError) as refused:
        Wheelset(**{"name": "axle", "x": 0.0, "mass": 1e3, "gauge": 0.0} | changes)
    assert str(refused.value).startswith(says)


def test_a_wheelset_without_a_spring_and_names_twice_are_refused():
    car = rb.Body("car", 1e4, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    spring = rb.Spring("car", "axle", (0.0, 0.0, 0.5), (0.0, 1e6), (0.0, 0.0))
    axle = Wheelset("axle", 0.0, 1e3, gauge=0.0)
    assert on_wheelsets("one", [car], [spring], [axle]).wheelsets[0].name == "axle"
    with pytest.raises(rb.InputError, match=r"wheelsets\[2\].name = 'other': no spring ends"):
        on_wheelsets("one", [car], [spring], [axle, replace(axle, name="other")])
    with pytest.raises(rb.InputError, match=r"wheelsets\[1\].name = 'axle': must be unique"):
        on_wheelsets("one", [car], [spring], [axle, axle])
    with pytest.raises(rb.InputError, match=r"springs\[1\]\.to = 'axel'.*Did you mean 'axle'"):
        wrong = rb.Spring("car", "axel", (0.0, 0.0, 0.5), (0.0, 1e6), (0.0, 0.0))
        on_wheelsets("one", [car], [wrong, spring], [axle])


def test_a_wheelset_with_the_name_of_a_body_is_named():
    body = rb.Body("m", 8e3, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    spring = rb.Spring("m", "rail", (0.0, 0.0, 0.0), (0.0, 1e6), (0.0, 1e4))
    with pytest.raises(rb.InputError, match=r"wheelsets\[1\].name = 'm': is the name of a body"):
        on_wheelsets("car", [body], [spring], [Wheelset("m", 0.0, 1500.0, gauge=0.0)])


def test_what_belongs_to_wheelsets_is_refused_without_their_mass():
    parameters = rb.car_parameters("xia2000_wheelsets") | {"wheelset_mass": 0.0}
    with pytest.raises(rb.InputError, match="wheelset_roll_inertia = 1000.0: has no meaning"):
        rb.two_bogie_car("car", **parameters)
