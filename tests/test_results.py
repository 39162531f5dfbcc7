"""What a run can be asked."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.results import ENVELOPE

DECK = rb.deck("viaduct36")
RUN = rb.case("paper").replace({"train.cars": 2, "run.time_step": 2e-3, "run.iterations": 2}).run()
OFF_AXIS = rb.cross(
    rb.AxleTrain([0.0, 3.0], [1e5, 2e5]), DECK, speed=20.0, time_step=2e-3, track_offset=2.4
)


@pytest.mark.parametrize("run", [RUN, OFF_AXIS], ids=["cars", "axles"])
@pytest.mark.parametrize("quantity", ENVELOPE)
def test_an_envelope_is_the_histories_side_by_side(run, quantity):
    """At each place the history that is asked for alone: one way to the same numbers."""
    places = [0.0, 4.5, 18.0, 30.2]
    envelope = run.envelope(quantity, places)
    for x, row in zip(places, envelope.values, strict=True):
        if quantity == "displacement_z":
            alone = run.displacement(x)
        elif quantity == "acceleration_z":
            alone = run.acceleration(x)
        elif quantity == "rotation_y":
            alone = run.rotations(x)
        else:
            alone = run.section_forces(x)
        size = np.abs(envelope.values).max()
        assert row == pytest.approx(alone[quantity], abs=1e-9 * size)


def test_static_extremes_of_a_simple_beam_are_those_of_the_book():
    """Two axles a apart on a span L: the largest moment at mid-span, one axle there, is
    P L / 4 + Q (L / 2 - a) / 2; the largest reaction, one axle over it, P + Q (L - a) / L."""
    beam = rb.Beam("simple", (36.0,), 12e3, 8.93e10, 8.9e11, 8.15e10, polar_inertia=7.02e4)
    run = rb.cross(
        rb.AxleTrain([0.0, 3.0], [1e5, 2e5]), beam.deck(6, 0.02), speed=20.0, time_step=5e-3
    )
    recovery = run.deck.recovery
    low, high = run.static_extremes(recovery.section("moment_vertical", 18.0))
    assert (low, high) == pytest.approx((-(2e5 * 9.0 + 1e5 * 15.0 / 2), 0.0), rel=1e-6)
    worst = [
        max(map(abs, run.static_extremes(recovery.reaction("force_z", x)))) for x in (0.0, 36.0)
    ]
    assert max(worst) == pytest.approx(2e5 + 1e5 * 33.0 / 36.0, rel=1e-6)


def test_statics_are_influence_times_load_at_every_instant():
    line = DECK.recovery.section("moment_vertical", 18.0)
    axles = zip(OFF_AXIS.train.placed_axles, (1e5, 2e5), strict=True)
    expected = np.zeros_like(OFF_AXIS.time)
    for axle, load in axles:
        x = 20.0 * OFF_AXIS.time - axle.delay
        on = (x >= 0.0) & (x <= 36.0)
        expected[on] -= load * line.influence(x[on])[:, 0, 1]
        expected[on] -= 2.4 * load * line.influence(x[on])[:, 0, 2]
    size = np.abs(expected).max()
    assert OFF_AXIS.static(line) == pytest.approx(expected, abs=1e-9 * size)


def test_a_deck_of_modes_alone_says_what_it_cannot():
    run = rb.cross(
        rb.AxleTrain([0.0], [1e5]),
        replace(DECK, recovery=None),
        speed=20.0,
        time_step=2e-3,
    )
    known = rb.cross(rb.AxleTrain([0.0], [1e5]), DECK, speed=20.0, time_step=2e-3)
    alone = known.displacement(18.0, kept_only=True)["displacement_z"]
    assert run.displacement(18.0)["displacement_z"] == pytest.approx(alone, rel=1e-9, abs=1e-18)
    assert run.envelope("moment_vertical", [18.0]) is None
    assert run.envelope("displacement_z", [18.0]) is not None
    for ask in (run.reactions, run.bearing_forces, lambda: run.section_forces(18.0)):
        with pytest.raises(rb.InputError, match="only its modes are known"):
            ask()


def test_what_an_envelope_may_not_be_asked():
    with pytest.raises(rb.InputError, match=r"^quantity = 'moment'"):
        RUN.envelope("moment")
    with pytest.raises(rb.InputError, match=r"^x\[2\] = 36.5"):
        RUN.envelope("displacement_z", [0.0, 36.5])


@pytest.mark.parametrize("spans", [(12.1, 12.2, 12.3), (23.45600000000001,), (0.7, 0.1, 0.2)])
def test_the_end_of_a_deck_is_its_end_however_it_is_rounded(spans):
    deck = rb.Beam("decimals", spans, 12e3, 1.2e10).deck(3, 0.02)
    step = deck.length / 1000
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), deck, speed=10.0, time_step=step, tail=0.0)
    for name in ENVELOPE:
        found = run.envelope(name)
        assert found is None or found.x[-1] == deck.length
    for end in (round(sum(spans), 9), sum(spans), deck.length * (1 + 1e-12)):
        assert np.abs(run.displacement(end)["displacement_z"]).max() < 1e-12
        assert run.displacement(end, self_weight=True)["displacement_z"] is not None
        assert np.isfinite(run.acceleration(end)["acceleration_z"]).all()
        assert np.array_equal(
            run.section_forces(end)["shear_vertical"],
            run.section_forces(deck.length)["shear_vertical"],
        )
        assert run.envelope("moment_vertical", [0.0, end]).x[-1] == deck.length
    for x in (deck.length * (1 + 1e-6), -1e-6):
        with pytest.raises(rb.InputError, match="^x = "):
            deck.recovery.section("moment_vertical", x)
        for ask in (run.displacement, run.velocity, run.acceleration, run.section_forces):
            with pytest.raises(rb.InputError, match="^x = "):
                ask(x)


def test_what_one_works_with_is_shown_in_three_lines():
    car = rb.vehicle("xia2000")
    beam = rb.Beam("b", (10.0,) * 25, 1e4, 1e9)
    track = rb.Track(rb.Table(np.arange(1000.0), np.zeros(1000)))
    shown = [
        RUN, RUN.deck, RUN.envelope("displacement_z"), RUN.deviations, RUN.displacement(18.0), beam,
        car, car.modes(), car.system, RUN.train, rb.AxleTrain(np.arange(90.0), [1e5] * 90), track,
        track.rail("vertical", "left"), RUN.settings, RUN.spectrum, beam.mesh.modes(3),
        rb.case("paper"), rb.case("paper").train.car(1), RUN.deck.shapes,
    ]  # fmt: skip
    for thing in shown:
        text = repr(thing)
        assert type(thing).__name__ in text and len(text) <= 240 and "\n" not in text


def test_histories_say_where_and_in_which_unit():
    assert RUN.wheel_force(1, 3).where == "car 1, wheel 3"
    forces = RUN.car_forces()
    assert forces.where == "car 1"
    assert forces.units == {
        "force_y": "N", "force_z": "N", "moment_x": "N m", "moment_y": "N m", "moment_z": "N m",
    }  # fmt: skip
    bare = rb.cross(rb.AxleTrain([0.0], [1e5]), DECK, speed=20.0, time_step=2e-3)
    assert bare.body_accelerations.shape == (0, 3, 2, len(bare.time))


@pytest.mark.parametrize(
    ("history", "units", "where"),
    [
        (RUN.displacement(4.5), {"displacement_y": "m", "displacement_z": "m", "rotation_x": "rad"},
         "x = 4.5 m"),
        (RUN.velocity(4.5),
         {"velocity_y": "m/s", "velocity_z": "m/s", "velocity_roll": "rad/s"}, "x = 4.5 m"),
        (RUN.acceleration(4.5),
         {"acceleration_y": "m/s2", "acceleration_z": "m/s2", "acceleration_roll": "rad/s2"},
         "x = 4.5 m"),
        (RUN.section_forces(4.5),
         {"moment_vertical": "N m", "moment_lateral": "N m", "torsion": "N m",
          "shear_vertical": "N", "shear_lateral": "N"}, "x = 4.5 m"),
        (RUN.reactions()[36.0],
         {"force_x": "N", "force_y": "N", "force_z": "N", "moment_x": "N m"}, "bearing at 36 m"),
        (RUN.bearing_forces()[2],
         {"force_x": "N", "force_y": "N", "force_z": "N", "moment_x": "N m", "moment_y": "N m",
          "moment_z": "N m"}, "bearing 2 at x = 36, y = 0, z = 0 m"),
        (RUN.envelope("torsion", [0.0, 4.5]).at(1), {"value": "N m"}, "x = 4.5 m"),
    ],
)  # fmt: skip
def test_what_is_asked_of_the_deck_has_units_and_a_place(history, units, where):
    assert history.units == units and list(history.values) == list(units)
    assert history.where == where
    assert all(values.shape == RUN.time.shape for values in history.values.values())


@pytest.mark.parametrize("wrong", [np.zeros(3), "front", None, 1.5, True])
def test_what_is_no_number_of_a_wheel_is_refused(wrong):
    run = rb.paper.run("paper", "condensed", 1)
    with pytest.raises(rb.InputError, match="^car"):
        run.wheel_force(wrong, 1)
    with pytest.raises(rb.InputError, match="^wheel"):
        run.wheel_force(1, wrong)


@pytest.mark.parametrize("wrong", [np.zeros(2), ["displacement_z"], None, 3])
def test_what_is_no_name_of_a_history_is_refused(wrong):
    history = rb.paper.run("paper", "condensed", 1).displacement(18.0)
    for ask in (history.__getitem__, history.extreme, history.extremes):
        with pytest.raises(rb.InputError, match="no such history"):
            ask(wrong)


def test_a_car_moves_as_its_accelerations_say_and_the_deck_adds_to_it():
    for run in (RUN, RUN.at(0)):
        own = run.car_motion(2)
        assert own.units["car z"] == "m" and own.units["car pitch"] == "rad"
        twice = np.diff(own["car z"], 2) / run.settings.time_step**2
        middle = run.body_accelerations[1, 1, 1, 1:-1]
        assert twice == pytest.approx(middle, abs=0.02 * np.abs(middle).max())
    added = RUN.car_motion(2)["car z"] - RUN.at(0).car_motion(2)["car z"]
    entered = RUN.coupling.cars[1].window.start
    assert not added[: entered + 1].any() and added.min() < -1e-3
    bare = rb.cross(rb.AxleTrain([0.0], [1e5]), DECK, speed=20.0, time_step=2e-3)
    with pytest.raises(rb.InputError, match="bare axle loads"):
        bare.car_motion()
    with pytest.raises(rb.InputError, match="car = 3"):
        RUN.car_motion(3)


def moving_force(beam, force, speed, time, x, terms, derivative):
    """w or w' of a simple undamped beam under a force that moves: the sum of sines (Fryba)."""
    (length,), total = beam.spans, np.zeros_like(time)
    for n in range(1, terms + 1):
        k = n * np.pi / length
        omega, drive = k**2 * np.sqrt(beam.bending_stiffness_vertical / beam.mass), k * speed
        q = np.sin(drive * time) - drive / omega * np.sin(omega * time)
        shape = np.sin(k * x) if derivative == 0 else k * np.cos(k * x)
        total += 2 * force / (beam.mass * length) / (omega**2 - drive**2) * q * shape
    return total


@pytest.mark.parametrize("x", [0.0, 6.1, 20.0])
def test_a_deck_s_ends_turn_under_a_moving_force_as_in_closed_form(x):
    beam = rb.Beam("simple", (20.0,), 1e4, 8e9)
    load, same = rb.AxleTrain([0.0], [1e5]), {"speed": 40.0, "time_step": 2e-4, "tail": 0.0}
    run = rb.cross(load, beam.deck(8, 0.0), **same)
    on = (run.time > 0.0) & (run.time < 0.5)
    known = -moving_force(beam, -1e5, 40.0, run.time, x, 60, 1)[on]
    size = np.abs(known).max()
    found = run.rotations(x)["rotation_y"][on]
    assert np.abs(found - known).max() < 2e-3 * size
    # Without the modes left out: the first eight terms of the sum, and farther away.
    kept = run.rotations(x, kept_only=True)["rotation_y"][on]
    eight = -moving_force(beam, -1e5, 40.0, run.time, x, 8, 1)[on]
    assert np.abs(kept - eight).max() < 1e-3 * size
    assert np.abs(kept - known).max() > np.abs(found - known).max()


def test_the_static_part_of_the_modes_left_out_is_in_a_rotation():
    beam = rb.Beam("simple", (20.0,), 1e4, 8e9)
    load = rb.AxleTrain([0.0], [1e5])
    runs = [rb.cross(load, beam.deck(count, 0.02), speed=30.0, time_step=2e-4) for count in (2, 12)]
    few, many = (run.rotations(0.0)["rotation_y"] for run in runs)
    bare = runs[0].rotations(0.0, kept_only=True)["rotation_y"]
    size = np.abs(many).max()
    assert np.abs(few - many).max() < 0.02 * size < np.abs(bare - many).max()


def test_rotations_are_slopes_of_the_displacements_beside():
    step = 0.01
    for run in (RUN, OFF_AXIS):
        before, after = (run.displacement(12.0 + d) for d in (-step, step))
        found = run.rotations(12.0)
        assert list(found.values) == ["rotation_x", "rotation_y", "rotation_z"]
        for name, way, sign in (
            ("rotation_y", "displacement_z", -1.0),
            ("rotation_z", "displacement_y", 1.0),
        ):
            slope = sign * (after[way] - before[way]) / (2 * step)
            size = np.abs(slope).max()
            assert np.abs(found[name] - slope).max() < 1e-4 * size + 1e-15
        assert np.array_equal(found["rotation_x"], run.displacement(12.0)["rotation_x"])


def test_slopes_that_a_deck_does_not_have_are_nan():
    plain = rb.Beam("plain", (20.0,), 1e4, 8e9).deck(3)
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), plain, speed=20.0, time_step=2e-3)
    for kept_only in (False, True):
        found = run.rotations(0.0, kept_only)
        assert np.isnan(found["rotation_z"]).all() and np.isfinite(found["rotation_y"]).all()
    lacking = replace(plain, recovery=None)
    only = rb.cross(rb.AxleTrain([0.0], [1e5]), lacking, speed=20.0, time_step=2e-3)
    assert only.envelope("shear_vertical") is None
    assert np.isfinite(only.envelope("rotation_y").values).all()


def test_the_envelope_of_shear_is_met_on_both_sides_of_an_axle():
    """Slowly over a simple span: P (1 - x / L) just before and P x / L just after the axle."""
    deck = rb.Beam("simple", (20.0,), 1e4, 8e11).deck(3, 0.05)
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), deck, speed=1.0, time_step=0.02)
    found = run.envelope("shear_vertical", [5.003, 12.007])
    for i, x in enumerate(found.x):
        (low, _), (high, _) = found.at(i).extremes("value")
        known = -1e5 * (1 - x / 20.0), 1e5 * x / 20.0
        assert (low, high) == pytest.approx(known, rel=2e-3)
    turned = run.envelope("rotation_y", [0.0, 20.0])
    # The largest end rotation under one force: P L^2 / (9 sqrt(3) EI).
    largest = 1e5 * 400.0 / 9 / np.sqrt(3) / 8e11
    assert [turned.values[0].max(), -turned.values[1].min()] == pytest.approx(
        [largest] * 2, rel=2e-3
    )


def test_front_and_rear_of_a_body_move_as_its_bounce_and_pitch_say():
    """u at x ahead of the centre of mass: z - x pitch and y + x yaw, differentiated twice."""
    own, motion = RUN.car_accelerations(2), RUN.car_motion(2)
    assert list(own.values)[:2] == ["front acceleration_y", "front acceleration_z"]
    assert own.where == "car 2" and set(own.units.values()) == {"m/s2"}
    vehicle = RUN.train.vehicles[1]
    for body, place, x in vehicle.body_places:
        x -= body.position[0]
        for way, turn, sign in (("z", "pitch", -1.0), ("y", "yaw", 1.0)):
            moved = motion[f"car {way}"] + sign * x * motion[f"car {turn}"]
            twice = np.diff(moved, 2) / RUN.settings.time_step**2
            told = own[f"{place} acceleration_{way}"][1:-1]
            assert twice == pytest.approx(told, abs=0.02 * np.abs(told).max())
    assert {place: x for _, place, x in vehicle.body_places} == {
        "front": pytest.approx(7.8), "middle": 0.0, "rear": pytest.approx(-7.8),
    }  # fmt: skip


def test_bodies_that_cannot_move_sideways_and_loads_without_bodies():
    planar = rb.cross(rb.Train(rb.vehicle("xia2000_planar")), DECK, speed=20.0, time_step=4e-3)
    own = planar.car_accelerations()
    assert np.isnan(own["rear acceleration_y"]).all()
    assert np.isfinite(own["rear acceleration_z"]).all()
    assert "front acceleration_z (m/s2)" in own.to_frame().columns
    with pytest.raises(rb.InputError, match="car = 1: bare axle loads"):
        OFF_AXIS.car_accelerations()
    for wrong in (0, 3, None, "1"):
        with pytest.raises(rb.InputError, match="^car"):
            RUN.car_accelerations(wrong)
