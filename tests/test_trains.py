"""Trains: where wheels stand, rigid-deck forces against closed forms, condensation by hand."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railbridge as rb
from railbridge.steady import steady_motion
from railbridge.trains import Passage

CAR = rb.vehicle("xia2000")
V = 20.0


def waves(wavelength, **lateral):
    return rb.Track(vertical=rb.Harmonic(5e-3, wavelength=wavelength), **lateral)


def test_wheels_of_a_train():
    train = rb.Train(CAR, cars=2, car_spacing=22.5)
    wheels = train.wheels
    assert [(w.car, w.number) for w in wheels] == [(c, n) for c in (1, 2) for n in range(1, 9)]
    assert [w.delay for w in wheels] == pytest.approx(
        np.repeat([0, 2.5, 15.6, 18.1, 22.5, 25.0, 38.1, 40.6], 2).tolist()
    )
    assert {w.side for w in wheels if w.y > 0} == {"left"} and {
        w.side for w in wheels if w.y < 0
    } == {"right"}
    assert train.length == pytest.approx(40.6)
    assert train.centres == pytest.approx([9.05, 31.55])
    assert rb.Train(CAR, cars=2).centres == pytest.approx(train.centres)  # the vehicle's own length


def test_mixed_train_takes_half_lengths():
    short = rb.sprung_mass("m", 1e4, 1e6, length=10.0)
    train = rb.Train((CAR, short, CAR))
    assert train.centres == pytest.approx([9.05, 9.05 + 16.25, 9.05 + 32.5])
    assert train.cars == 3 and len(train.kinds()) == 2


@given(
    wavelength=st.floats(6.0, 40.0), phase=st.floats(-3, 3), speed=st.floats(15.0, 60.0),
    sides=st.booleans(),
    excitation=st.sampled_from(["wheels", "car"]),
)  # fmt: skip
@settings(max_examples=8)
def test_rigid_forces_settle_to_the_closed_form(wavelength, phase, speed, sides, excitation):
    vertical = rb.Harmonic(5e-3, wavelength=wavelength, phase=phase)
    other = rb.Harmonic(2e-3, wavelength=wavelength, phase=1.0)
    track = rb.Track(vertical=rb.Rails(vertical, other) if sides else vertical, lateral=other)
    train = rb.Train(CAR, cars=2, car_spacing=23.7)
    h, n = 2e-3, 800
    forces = train.rigid_forces(track, Passage(speed, h, n, 40 * speed, excitation))
    steady = rb.steady_forces(CAR, track, speed, excitation)
    for car in (0, 1):
        centre = speed * h * np.arange(n) - train.centres[car]
        exact = (steady[..., None] * np.exp(2j * np.pi * centre / wavelength)).imag
        # What is left is the sampling, second order in the step.
        assert np.abs(forces[car] - exact).max() < 4e-3 * np.abs(exact).max() + 1.0


def test_rigid_forces_are_second_order_in_the_step():
    track, speed = waves(14.4, lateral=rb.Harmonic(2e-3, wavelength=14.4, phase=1.0)), 20.0
    steady = rb.steady_forces(CAR, track, speed)
    errors = []
    for h in (8e-3, 4e-3, 2e-3):
        n = round(1.6 / h)
        centre = speed * h * np.arange(n) - 9.05
        exact = (steady[..., None] * np.exp(2j * np.pi * centre / 14.4)).imag
        errors.append(
            np.abs(rb.Train(CAR).rigid_forces(track, Passage(speed, h, n, 1000.0))[0] - exact).max()
        )
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("spacing", [22.5, 22.513, 23.0071])
def test_a_car_further_back_feels_the_same_later(spacing):
    """Cars that do not meet the samples alike are run each in its own place between them."""
    track = rb.Track(
        vertical=rb.Harmonic(5e-3, wavelength=11.0), lateral=rb.Harmonic(2e-3, wavelength=13.0)
    )
    h, n = 1e-3, 4000
    forces = rb.Train(CAR, cars=3, car_spacing=spacing).rigid_forces(track, Passage(V, h, n, 150.0))
    t = h * np.arange(n)
    for car in (1, 2):
        late = car * spacing / V
        moved = np.array([[np.interp(t - late, t, f) for f in wheel] for wheel in forces[0]])
        inside = t > late + 0.01
        scale = np.abs(forces[0]).max()
        assert forces[car][..., inside] == pytest.approx(moved[..., inside], abs=3e-5 * scale)
    # One car standing `spacing` further back, run on its own, is the same run exactly.
    if spacing == 22.5:
        assert forces[1][..., 1125:] == pytest.approx(forces[0][..., :-1125], abs=1e-9)


def test_before_its_run_up_a_car_far_back_stands_on_level_track():
    train = rb.Train(CAR, cars=4, car_spacing=22.5)
    forces = train.rigid_forces(waves(14.4), Passage(V, 1e-3, 6000, 10.0))
    assert not forces[3][..., : int(1000 * (67.5 - 10.0) / V)].any()
    assert forces[3][..., int(1000 * 67.5 / V)].any()


def test_a_notch_is_felt_by_its_wheel_first_and_no_other_car():
    notch = rb.Notch(((2, 3),), circumference=2.8, offset=5.0, depth=1e-3, length=0.2)
    train = rb.Train(CAR, cars=2, car_spacing=22.5, notches=(notch,))
    h, n = 2e-4, 12_000
    forces = train.rigid_forces(rb.Track(), Passage(V, h, n))
    assert not forces[0].any()
    meets = (5.0 + 22.5 + 2.5) / V  # wheel 3 is 2.5 m behind its car's first axle
    t = h * np.arange(n)
    assert not forces[1][..., t < meets - h].any()
    shortly = (t >= meets) & (t < meets + 0.2 / V)
    vertical = np.abs(forces[1][:, 1, shortly]).max(axis=1)
    assert np.argmax(vertical) == 2
    assert vertical[2] > 5 * np.delete(vertical, 2).max()
    # The wheel drops into the notch: first the force on the rail is relieved.
    first = forces[1][2, 1, shortly]
    assert first[np.argmax(np.abs(first) > 100.0)] > 0


def test_notch_as_in_the_paper_is_nearly_all_damper():
    notch = rb.Notch(((1, 1),), circumference=2.8, offset=1.0, depth=1e-3, length=0.05)
    forces = rb.Train(CAR, notches=(notch,)).rigid_forces(rb.Track(), Passage(V, 2.5e-5, 4000))[0][
        0, 1
    ]
    damper = 15e3 * V * np.pi * 1e-3 / 0.05
    assert np.abs(forces).max() == pytest.approx(damper, rel=0.15)
    assert 17e3 < np.abs(forces).max() < 23e3


@pytest.mark.parametrize(
    ("loads", "stations", "components"), [("wheels", 4, 3), ("bogies", 2, 5), ("condensed", 1, 5)]
)
def test_condensation_does_the_same_work(loads, stations, components):
    """Virtual work on any motion the stations can follow: linear along x within a station, any
    twist."""
    condensation = rb.Train(CAR).car(1).condensation(loads)
    assert condensation.matrix.shape == (stations, components, 8, 2)
    rng = np.random.default_rng(3)
    forces = rng.normal(size=(8, 2))
    total = 0.0
    for s, offset in enumerate(condensation.offsets):
        v, w, theta, slope_w, slope_v = rng.normal(size=5)
        if components == 3:
            slope_w = slope_v = 0.0
        motion = np.array([v, w, theta, -slope_w, slope_v])[:components]
        load = np.tensordot(condensation.matrix[s], forces, 2)
        for i, c in enumerate(CAR.contacts):
            here = {"wheels": c.x == offset, "bogies": c.x * offset > 0, "condensed": True}[loads]
            if here:
                dx = c.x - offset
                total += forces[i] @ (v + slope_v * dx, w + slope_w * dx + c.y * theta)
        total -= load @ motion
    assert total == pytest.approx(0.0, abs=1e-12)
    places = {"wheels": [9.05, 6.55, -6.55, -9.05], "bogies": [7.8, -7.8], "condensed": [0.0]}[
        loads
    ]
    assert condensation.offsets == pytest.approx(places)


def test_signs_of_the_condensed_components():
    def of(wheel, direction):
        return rb.Train(CAR).car(1).condensation("condensed").matrix[0, :, wheel, direction]

    assert of(0, 0) == pytest.approx([1, 0, 0, 0, 9.05])  # front left, pushed left: yaw to the left
    assert of(0, 1) == pytest.approx(
        [0, 1, 0.98, -9.05, 0]
    )  # lifted: rolls to the right, nose up is negative pitch
    assert of(7, 1) == pytest.approx([0, 1, -0.98, 9.05, 0])


def test_condensed_components_have_names_and_two_places():
    """About the centre of mass the lateral force has an arm of its height; the rest stays."""
    car = rb.Train(CAR).car(1)
    forces = np.random.default_rng(4).normal(size=(8, 2, 5))
    track, centre = car.condensed(forces), car.condensed(forces, "centre")
    assert tuple(track) == tuple(centre) == rb.CONDENSED
    assert track["force_z"] == pytest.approx(forces[:, 1].sum(axis=0))
    height = CAR.body.position[2]
    assert centre["moment_x"] == pytest.approx(track["moment_x"] + height * track["force_y"])
    for name in ("force_y", "force_z", "moment_y", "moment_z"):
        assert centre[name] == pytest.approx(track[name])
    assert car.condensed(forces[..., 0] * 1j)["force_y"] == pytest.approx(1j * track["force_y"][0])
    with pytest.raises(rb.InputError, match="at"):
        car.condensed(forces, "middle")


def test_axle_train():
    train = rb.AxleTrain([0.0, 3.0, 14.0], [1e5, 2e5, 1e5])
    assert train.length == 14.0 and len(train.wheels) == 3
    assert train.car(1).static_forces == pytest.approx(np.array([[0, -1e5], [0, -2e5], [0, -1e5]]))
    assert train.kinds() == [] and train.car(1).vehicle is None
    assert not train.rigid_forces(waves(14.4), Passage(V, 1e-3, 50, 10.0))[0].any()
    with pytest.raises(rb.InputError, match="no cars to condense"):
        train.car(1).condensation("condensed")


def test_an_axle_train_from_spacings_is_the_one_from_places():
    loads = [1e5, 2e5, 1e5, 1e5]
    train = rb.AxleTrain.from_spacings([3.0, 11.0, 2.5], loads, "mine")
    assert train == rb.AxleTrain([0.0, 3.0, 14.0, 16.5], loads) and train.name == "mine"
    assert train.weight == 5e5 and rb.AxleTrain.from_spacings([], [1e5]).axles == (0.0,)


@pytest.mark.parametrize(
    ("spacings", "loads", "words"),
    [
        ([3.0, 0.0], [1e5] * 3, r"spacings\[2\] = 0.0: must be .* above 0 m"),
        ([3.0, -1.0], [1e5] * 3, r"spacings\[2\] = -1.0"),
        ([3.0], [1e5], "loads = .*: must hold 2 numbers, it holds 1. There is one axle more"),
        ([3.0], [1e5] * 3, "loads = .*: must hold 2 numbers, it holds 3"),
        (3.0, [1e5] * 2, "spacings = 3.0: must be a list"),
        ([3.0], [1e5, 0.0], r"loads\[2\] = 0.0"),
    ],
)
def test_spacings_that_make_no_train_are_refused(spacings, loads, words):
    with pytest.raises(rb.InputError, match=words):
        rb.AxleTrain.from_spacings(spacings, loads)


def test_a_name_is_for_people():
    named, other = (rb.AxleTrain([0.0, 3.0], [1e5, 1e5], name) for name in ("a", None))
    assert named == other and hash(named) == hash(other) and "name='a'" in repr(named)
    with pytest.raises(rb.InputError, match="name = 5: must be a text"):
        rb.AxleTrain([0.0], [1e5], 5)


@pytest.mark.parametrize(
    ("made", "named"),
    [
        (lambda: rb.Train(5), "vehicle"),
        (lambda: rb.Train([]), "vehicle"),
        (lambda: rb.Train(CAR, notches=rb.Notch(((1, 1),), 2.7, 9.0, 1e-3, 0.05)), "notches"),
        (lambda: rb.Train(CAR, notches=[5]), "notches"),
    ],
)
def test_what_is_no_vehicle_or_notch_is_refused_in_words(made, named):
    with pytest.raises(rb.InputError) as caught:
        made()
    assert caught.value.field == named


def test_cars_that_overlap_are_named_with_the_spacing_they_need():
    """Wheels of the paper's car stand 9.05 m before and behind its middle."""
    with pytest.raises(
        rb.InputError, match=r"cars 1 and 2 overlap.*need more than 18.1 m"
    ) as error:
        rb.Train(CAR, cars=3, car_spacing=18.1)
    assert (error.value.field, error.value.value) == ("car_spacing", 18.1)
    assert rb.Train(CAR, cars=3, car_spacing=18.1001).length > 0.0
    short = replace(CAR, name="short", length=10.0)
    words = r"^vehicle = 'short': its axles reach over 18.1 m, it is 10 m long"
    with pytest.raises(rb.InputError, match=words):
        rb.Train((CAR, CAR, short, short))


def test_a_length_is_needed_only_where_the_spacing_is_not_given():
    bare = replace(CAR, length=None)
    assert rb.Train(bare).length == rb.Train(CAR).length
    spaced = rb.Train(bare, cars=3, car_spacing=22.5)
    assert spaced.centres.tolist() == rb.Train(CAR, cars=3).centres.tolist()
    with pytest.raises(rb.InputError, match="car_spacing: is missing. Give it, or the length of"):
        rb.Train((CAR, bare))
    deck = rb.deck("viaduct36")
    with pytest.raises(rb.InputError, match=r"excitation = 'car': .*xia2000 has no length"):
        rb.cross(spaced, deck, speed=20.0, excitation="car")
    with pytest.raises(rb.InputError, match=r"excitation = 'car': .*xia2000 has no length"):
        rb.steady_forces(bare, waves(14.4), 20.0, "car")
    options = {"speed": 20.0, "time_step": 4e-3, "interaction": "rigid"}
    run, usual = (
        rb.cross(t, deck, waves(14.4), **options) for t in (spaced, rb.Train(CAR, cars=3))
    )
    assert np.array_equal(run.wheel_forces, usual.wheel_forces)


def test_runs_of_bare_axle_loads_can_be_added():
    """They feel nothing of the deck: one train with all axles is the sum of two."""
    deck = rb.Beam("simple", (30.0,), 12e3, 5e10).deck(6, 0.02)
    options = {"speed": 40.0, "time_step": 2e-3}
    first, second = ([0.0, 3.0], [1e5, 2e5]), ([0.0, 10.0, 13.0], [9e4, 9e4, 8e4])
    together = rb.AxleTrain([0.0, 0.0004, 3.0, 10.0, 13.0], [1e5, 9e4, 2e5, 9e4, 8e4])
    whole = rb.cross(together, deck, **options)
    parts = [rb.cross(rb.AxleTrain(*train), deck, **options) for train in (first, second)]
    n = min(len(run.time) for run in parts)
    for name, ask in {
        "displacement_z": lambda run: run.displacement(12.0),
        "moment_vertical": lambda run: run.section_forces(12.0),
        "force_z": lambda run: run.reactions()[30.0],
    }.items():
        total = sum(ask(run)[name][:n] for run in parts)
        found = ask(whole)[name][:n]
        assert np.abs(total - found).max() < 2e-3 * np.abs(found).max(), name


def test_a_bogie_in_millimetres_is_blamed_itself():
    parameters = rb.car_parameters("xia2000") | {"axle_spacing": 2500.0}
    with pytest.raises(rb.InputError, match=r"^vehicle x: axle_spacing = 2500\.0: must be below"):
        rb.two_bogie_car("x", **parameters)


def test_motion_on_a_rigid_deck_settles_to_the_steady_one_and_gives_the_accelerations():
    passage = Passage(V, 2e-3, 1500, 40 * V)
    train = rb.Train(CAR, cars=2)
    second = train.rigid_motion(waves(14.4), passage)[1]
    assert second.shape == (15, 1, 1500)
    place = V * 2e-3 * np.arange(1500) - train.centres[1]
    for name, steady in steady_motion(CAR, waves(14.4), V).items():
        exact = (steady * np.exp(2j * np.pi * place / 14.4)).imag
        assert second[CAR.labels.index(name), 0] == pytest.approx(exact, abs=2e-5), name
    bounce = second[CAR.labels.index("car z"), 0]
    middle = train.rigid_accelerations(waves(14.4), passage)[1][1, 1]
    assert np.diff(bounce, 2) / 2e-3**2 == pytest.approx(middle[1:-1], abs=5e-3)


def test_another_excitation_is_refused_by_name():
    train = rb.Train(rb.vehicle("sprung_mass"))
    passage = rb.Passage(20.0, time_step=1e-3, samples=100, excitation="bogie")
    with pytest.raises(rb.InputError, match=r"^excitation = 'bogie'"):
        train.rigid_forces(rb.Track(), passage)
