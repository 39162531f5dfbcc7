"""The modal deck: Rayleigh damping, shapes, moving loads and the static correction."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railbridge as rb
from railbridge.coupling import prepare
from railbridge.decks import combined, load_of
from railbridge.settings import check

L, M, EI = 36.0, 12e3, 8.93e10


def simple(damping=0.02, modes=12):
    return rb.Beam("simple", (L,), M, EI, 8.9e11, 8.15e10, polar_inertia=7.02e4).deck(
        modes, damping
    )


def moving_force(t, speed, load, x, modes, ratio):
    """Displacement and moment of a simple beam under a constant force, mode by mode in closed form
    (Fryba 1972)."""
    displacement, moment = np.zeros_like(t), np.zeros_like(t)
    for n in range(1, modes + 1):
        w = (n * np.pi / L) ** 2 * np.sqrt(EI / M)
        drive, damped = n * np.pi * speed / L, w * np.sqrt(1 - ratio**2)
        gain = -2 * load / M / L
        # Particular solution a sin + b cos, then the free part that starts from rest.
        matrix = np.array(
            [[w**2 - drive**2, -2 * ratio * w * drive], [2 * ratio * w * drive, w**2 - drive**2]]
        )
        a, b = np.linalg.solve(matrix, [gain, 0.0])
        c1, c2 = -b, -(a * drive + ratio * w * b) / damped
        q = a * np.sin(drive * t) + b * np.cos(drive * t)
        q += np.exp(-ratio * w * t) * (c1 * np.cos(damped * t) + c2 * np.sin(damped * t))
        shape = np.sin(n * np.pi * x / L)
        displacement += q * shape
        moment += EI * (n * np.pi / L) ** 2 * q * shape
    return displacement, moment


@pytest.mark.parametrize("speed", [20.0, 60.0, 100.0])
def test_one_moving_force_on_a_simple_beam(speed):
    ratio, load, x = 0.02, 2e5, 14.0
    run = rb.cross(
        rb.AxleTrain([0.0], [load]), simple(ratio, 36), speed=speed, time_step=2e-4, tail=0.0
    )
    t = run.time
    on = t < L / speed
    displacement, moment = moving_force(t, speed, load, x, 12, ratio)
    ours = run.displacement(x=x)["displacement_z"]
    assert ours[on] == pytest.approx(displacement[on], abs=2e-4 * np.abs(displacement).max())
    # With the static correction few modes give the moment that takes the series hundreds.
    _, moment = moving_force(t, speed, load, x, 400, ratio)
    few = rb.cross(
        rb.AxleTrain([0.0], [load]), simple(ratio, 36), speed=speed, time_step=2e-4, tail=0.0
    )
    ours = few.section_forces(x=x)["moment_vertical"]
    assert ours[on] == pytest.approx(moment[on], abs=6e-3 * np.abs(moment).max())


def test_a_slowly_moving_force_gives_influence_lines():
    load, speed, x = 1e5, 1.0, 9.0
    train = rb.AxleTrain([0.0], [load])
    run = rb.cross(train, simple(0.3, 9), speed=speed, time_step=0.02, tail=0.0, track_offset=2.4)
    place = speed * run.time
    on = (place > 0.5) & (place < L - 0.5) & (np.abs(place - x) > 0.1)
    place = place[on]
    forces = run.section_forces(x=x)
    triangle = np.where(place < x, place * (L - x), x * (L - place)) / L
    assert forces["moment_vertical"][on] == pytest.approx(-load * triangle, abs=2e-3 * load * 9)
    shear = np.where(place < x, -place / L, 1 - place / L)
    assert forces["shear_vertical"][on] == pytest.approx(-load * shear, abs=5e-3 * load)
    assert forces["torsion"][on] == pytest.approx(-2.4 * load * shear, abs=5e-3 * 2.4 * load)
    reactions = run.reactions()
    left, right = reactions[0.0], reactions[L]
    assert left["force_z"][on] == pytest.approx(load * (1 - place / L), abs=5e-3 * load)
    assert right["force_z"][on] == pytest.approx(load * place / L, abs=5e-3 * load)
    assert left["moment_x"][on] == pytest.approx(
        2.4 * load * (1 - place / L), abs=5e-3 * 2.4 * load
    )
    assert (left["force_z"] + right["force_z"])[on] == pytest.approx(load, rel=5e-3)


def test_couples_of_condensed_loads_do_work_on_slopes():
    """A slow condensed car: moment lines of the resultant and of its couples, from the influence
    line's slope."""
    car = rb.vehicle("xia2000")
    body = car.bodies[0]
    heavy_nose = rb.Vehicle(
        "nose",
        (rb.Body(body.name, body.mass, body.inertia, (2.0, 0.0, 1.41)), *car.bodies[1:]),
        car.springs,
        22.5,
    )
    run = rb.cross(
        rb.Train(heavy_nose),
        simple(0.3, 9),
        speed=2.0,
        time_step=0.02,
        loads="condensed",
        tail=0.0,
        iterations=2,
    )
    place = 2.0 * run.time - 9.05
    on = (place > 4.0) & (place < 17.0)
    weight, couple = (
        heavy_nose.weight,
        2.0 * body.mass * 9.81,
    )  # about y at the middle: the load stands 2 m ahead
    reaction = run.reactions()[L]["force_z"][on]
    assert reaction == pytest.approx((weight * place[on] + couple) / L, rel=4e-2)


@given(offset=st.floats(-3.0, 3.0), seed=st.integers(0, 99))
@settings(max_examples=5)
def test_loads_add_up(offset, seed):
    """The deck is linear: three axles are the sum of three single ones, each later."""
    rng = np.random.default_rng(seed)
    loads = rng.uniform(5e4, 2e5, 3)
    axles = [0.0, 4.0, 10.0]
    together = rb.cross(
        rb.AxleTrain(axles, loads), DECK, speed=40.0, time_step=1e-3, track_offset=offset
    )
    y = together.displacement(x=13.0)
    total = {k: np.zeros_like(v) for k, v in y.values.items()}
    for axle, load in zip(axles, loads, strict=True):
        single = rb.cross(
            rb.AxleTrain([0.0], [load]),
            DECK,
            speed=40.0,
            time_step=1e-3,
            track_offset=offset,
            tail=1.5,
        )
        late = round(axle / 40.0 / 1e-3)
        for k, v in single.displacement(x=13.0).values.items():
            total[k][late:] += v[: len(total[k]) - late]
    for k, v in total.items():
        assert y[k] == pytest.approx(v, abs=1e-9 * np.abs(y["displacement_z"]).max())


DECK = simple(0.02, 12)


def test_names_tracks_and_frames():
    deck = rb.deck("viaduct36")
    assert deck.track_offset("left") == 2.4 and deck.track_offset("right") == -2.4
    assert deck.has == {"y": True, "z": True, "roll": True}
    assert len(deck.to_frame()) == 20
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), deck, speed=50.0)
    frame = run.displacement(x=18.0).to_frame()
    assert list(frame.columns) == ["displacement_y (m)", "displacement_z (m)", "rotation_x (rad)"]
    value, time = run.displacement(x=18.0).extreme("displacement_z")
    assert value < 0 and 0 < time < 1
    with pytest.raises(rb.InputError, match="displacement_z"):
        run.displacement(x=18.0)["displacment_z"]


def test_static_values_of_the_lesson():
    """Four axles and one resultant, m = 12.0 t/m: 4.810 and 6.372 mm, 2987 and 5272 kN m."""
    recovery = rb.deck("viaduct36").recovery
    w, m = (recovery.section(q, 18.0).influence for q in ("displacement_z", "moment_vertical"))
    four = 18.0 + np.array([9.05, 6.55, -6.55, -9.05])
    one = np.array([18.0])
    total = 585.76e3
    assert total * w(one)[:, 0, 1].mean() == pytest.approx(6.372e-3, rel=2e-3)
    assert total * w(four)[:, 0, 1].mean() == pytest.approx(4.810e-3, rel=2e-3)
    assert total * m(one)[:, 0, 1].mean() == pytest.approx(5272e3, rel=1e-3)
    assert total * m(four)[:, 0, 1].mean() == pytest.approx(2987e3, rel=1e-3)


def test_a_track_s_name_on_a_deck_that_names_none():
    with pytest.raises(rb.InputError, match="the deck names no tracks"):
        rb.Beam("b", (30.0,), 1e4, 5e10).deck(3).track_offset("left")


def test_a_deck_is_made_once_so_its_numbers_cannot_be_changed():
    deck = rb.case("paper").deck
    with pytest.raises(ValueError, match="read-only"):
        deck.frequencies_hz[0] = 1.0
    assert deck == rb.case("paper").deck and deck != rb.deck(
        "viaduct36"
    )  # the same one, or another; never an error


# ---- rails above the deck axis


def high(height, modes=14):
    """The shipped deck's beam with its rails at a height."""
    return rb.Beam("b", (L,), M, EI, 8.9e11, 8.15e10, polar_inertia=7.02e4).deck(
        modes, 0.02, track_height=height
    )


@pytest.mark.parametrize("loads", ["wheels", "bogies", "condensed"])
def test_the_rail_s_motion_and_the_loads_do_the_same_work(loads):
    """Power balance: what wheels do on the rail's motion is what modal forces do on the modes,
    whatever the height.

    On the rail, v - h theta and w + y theta, from the shapes themselves; condensed loads do it on
    the motion at their own point.
    """
    rng = np.random.default_rng(4)
    train, deck, offset, speed = rb.Train(rb.vehicle("xia2000")), high(1.7), 2.4, 25.0
    s = check(
        train, deck, rb.Track(), speed=speed, time_step=2e-3, track_offset=offset, loads=loads
    )
    coupling = prepare(train, deck, rb.Track(), s)
    window = coupling.cars[0].window
    delta = [rng.normal(size=d.shape) * 1e4 for d in coupling.nothing_added()]
    state = coupling.deck_state(coupling.station_loads(delta))
    forces = delta[0] + coupling.cars[0].rigid[..., window] + coupling.cars[0].static[..., None]
    k = 700
    q = rng.normal(size=len(deck.frequencies_hz))
    power, contacts = 0.0, train.vehicles[0].contacts
    middle = speed * coupling.time[k] - train.centres[0]
    groups = {"wheels": lambda c: c.x, "condensed": lambda c: 0.0}
    groups["bogies"] = lambda c: np.mean([other.x for other in contacts if other.body == c.body])
    for i, contact in enumerate(contacts):
        point = groups[loads](contact)
        arm = contact.x - point
        v, w, theta = q @ deck.shapes(np.array([middle + point]))[0]
        slope_v, slope_w, _ = q @ deck.shapes(np.array([middle + point]), 1)[0]
        lateral, vertical = forces[i, :, k - window.start]
        power += lateral * (v - 1.7 * theta + arm * slope_v)
        power += vertical * (w + (offset + contact.y) * theta + arm * slope_w)
    assert q @ state.modal_force[:, k] == pytest.approx(power, rel=1e-9)


def test_wheels_feel_the_rail_and_not_the_axis():
    """Springs of Table 1 on v - h theta, with its total derivative, by hand."""
    rng = np.random.default_rng(5)
    train, deck, height, speed = rb.Train(rb.vehicle("xia2000")), high(1.7), 1.7, 25.0
    s = check(train, deck, rb.Track(), speed=speed, time_step=2e-3)
    coupling = prepare(train, deck, rb.Track(), s)
    state = coupling.deck_state(coupling.station_loads(coupling.nothing_added()))
    q, velocity = (rng.normal(size=state.q.shape) for _ in range(2))
    u = coupling.support_input(type(state)(q, velocity, state.modal_force), coupling.cars)[:, :, 0]
    k, start = 701, coupling.cars[0].window.start
    place = np.array([speed * coupling.time[k] - train.wheels[0].delay])
    met, slope = deck.shapes(place)[0].T, deck.shapes(place, 1)[0].T
    moved, rate = met @ q[:, k], met @ velocity[:, k] + speed * slope @ q[:, k]
    expected = 20e6 * (moved[0] - height * moved[2]) + 15e3 * (rate[0] - height * rate[2])
    assert u[0, 0, k - start] == pytest.approx(expected, rel=1e-9)


def test_a_lateral_force_on_high_rails_twists_the_deck_by_the_lever():
    """The torque is the car's rolling less h F_y; both solutions agree on the twist."""
    train = rb.Train(rb.vehicle("xia2000"))
    track = rb.Track(lateral=rb.Harmonic(3e-3, wavelength=20.0))
    common = {"speed": 30.0, "time_step": 1e-3, "lead_in": 60.0, "tail": 0.2}
    with pytest.warns(UserWarning, match="transient"):
        iterated = rb.cross(train, high(1.7), track, tolerance=1e-10, **common)
        direct = rb.cross(train, high(1.7), track, interaction="direct", **common)
        level = rb.cross(train, high(0.0), track, tolerance=1e-10, **common)
    twist = iterated.displacement(L / 2)["rotation_x"]
    assert direct.displacement(L / 2)["rotation_x"] == pytest.approx(
        twist, abs=1e-7 * np.abs(twist).max()
    )
    # On the axis only the car's rolling twists the deck; on high rails the lateral forces add -h
    # F_y.
    moment, without = iterated.reactions(), level.reactions()
    forces = iterated.wheel_forces[:, 0]
    on = (iterated.time > 0.8) & (iterated.time < 1.0)  # the whole car stands on the deck
    torque = sum(h["moment_x"] for h in moment.values())[on]
    roll = sum(f * w.y for f, w in zip(iterated.wheel_forces[:, 1], train.wheels, strict=True))[on]
    quasi = -(roll - 1.7 * forces.sum(axis=0)[on])
    assert np.abs(torque - quasi).max() < 0.1 * np.abs(quasi).max()  # less the deck's own inertia
    assert (
        np.abs(torque).max() > 1.3 * np.abs(sum(h["moment_x"] for h in without.values())[on]).max()
    )


def test_a_history_is_a_table_over_time():
    history = rb.History(np.array([0.0, 0.5]), {"a": np.array([1.0, 2.0])}, {"a": "kN"})
    frame = history.to_frame()
    assert frame.index.name == "t (s)" and frame.index.tolist() == [0.0, 0.5]
    assert frame["a (kN)"].tolist() == [1.0, 2.0]


def test_an_influence_line_is_read_by_name():
    """Of a simple beam they are in every table: P a b / L, and W L^3 / 48 E I below the load."""
    deck, length = rb.deck("viaduct36"), 36.0
    x = np.array([9.0, 18.0, 30.0])
    roof = -np.array([4.5, 9.0, 3.0])
    moment = deck.influence("moment_vertical", at=18.0, places=x)
    assert moment == pytest.approx(-roof, rel=1e-9)  # an upward load makes it hog
    sag = deck.influence("displacement_z", at=18.0, places=[18.0])
    assert sag == pytest.approx(length**3 / (48 * 35e9 * 2.553), rel=1e-6)
    share = deck.influence("force_z", at=0.0, places=x)
    assert share == pytest.approx(-(1 - x / length), rel=1e-9)
    twisting = deck.influence("torsion", at=0.0, places=x)
    assert np.abs(twisting) == pytest.approx(1 - x / length, rel=1e-9)
    sideways = deck.influence("moment_lateral", at=18.0, places=x)
    assert np.abs(sideways) == pytest.approx(-roof, rel=1e-9)


def test_an_influence_line_has_slope_and_curvature_and_ends_with_the_deck():
    deck = rb.deck("viaduct36")
    line = partial(deck.influence, "displacement_z", at=12.0)
    x, d = np.array([7.0, 21.0]), 1e-2
    ahead, here, behind = line(places=x + d), line(places=x), line(places=x - d)
    slope, bend = (line(places=x, derivative=order) for order in (1, 2))
    assert slope == pytest.approx((ahead - behind) / (2 * d), rel=1e-5)
    assert bend == pytest.approx((ahead - 2 * here + behind) / d**2, rel=1e-4)
    assert line(places=[-1.0, 37.0]).tolist() == [0.0, 0.0]
    # A couple on the left track's side: a force beside the axis also twists.
    twist = deck.influence("rotation_x", at=12.0, places=x, load="roll")
    assert twist == pytest.approx(deck.influence("rotation_x", at=12.0, places=x))
    assert deck.influence("rotation_x", at=12.0, places=x, load="z") == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (("displacement", 18.0, None), "displacement_z"),
        (("displacement_z", 40.0, None), "at = 40"),
        (("displacement_z", 18.0, "x"), "load"),
        (("moment_lateral", 18.0, None), "no such stiffness"),
        (("force_z", 18.0, None), "support|bearing"),
    ],
)
def test_an_influence_line_that_is_not_there_is_refused(asked, said):
    quantity, at, load = asked
    upright = rb.Beam("upright", (L,), M, EI).deck(3, 0.02)
    with pytest.raises(rb.InputError, match=said):
        upright.influence(quantity, at=at, places=[9.0], load=load)


def test_a_deck_of_modes_alone_says_what_it_lacks():
    known = simple(0.02, 3)
    bare = replace(known, recovery=None)
    with pytest.raises(rb.InputError, match="only its modes are known"):
        bare.influence("moment_vertical", at=18.0, places=[9.0])
    assert bare.influence("displacement_z", at=18.0, places=[18.0]) == pytest.approx(
        known.influence("displacement_z", at=18.0, places=[18.0]), rel=0.02
    )


@pytest.mark.parametrize(
    ("load", "quantities"),
    [
        ("y", ("displacement_y", "rotation_z", "moment_lateral", "shear_lateral", "force_y")),
        ("z", ("displacement_z", "rotation_y", "moment_vertical", "shear_vertical", "force_z")),
        ("roll", ("rotation_x", "torsion", "moment_x")),
        ("z", ("moment_y",)),
        ("y", ("moment_z",)),
    ],
)
def test_the_load_of_a_quantity_s_own_direction(load, quantities):
    assert [load_of(quantity) for quantity in quantities] == [load] * len(quantities)


def test_lines_add_up_wherever_their_sections_are():
    deck = simple()
    places = np.linspace(0.0, L, 401)
    lines = [deck.recovery.section("moment_vertical", x) for x in (7.3, 18.0, 29.1)]
    weights = (2.0, -1.0, 0.5)
    own = combined(list(zip(weights, lines, strict=True)))
    for derivative in (0, 1):
        expected = sum(
            w * line.influence(places, derivative) for w, line in zip(weights, lines, strict=True)
        )
        assert own.influence(places, derivative) == pytest.approx(expected, abs=1e-9)
    assert own.modal == pytest.approx(sum(w * s.modal for w, s in zip(weights, lines, strict=True)))
    assert own.self_weight == pytest.approx(
        sum(w * line.self_weight for w, line in zip(weights, lines, strict=True))
    )
