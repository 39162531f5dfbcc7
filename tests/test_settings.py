"""What is filled in when it is left open."""

import inspect
import re
import tracemalloc
import warnings
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import railbridge as rb
from railbridge.settings import (
    Options,
    bytes_needed,
    check,
    default_time_step,
    highest_frequency,
)
from railbridge.trains import Passage

CAR = rb.vehicle("xia2000")
DECK = rb.deck("viaduct36")


def test_defaults():
    s = check(rb.Train(CAR), DECK, rb.Track(), speed=20.0)
    assert (s.lead_in, s.loads, s.interaction, s.tolerance, s.track_offset) == (
        150.0,
        "wheels",
        "iterate",
        1e-8,
        0.0,
    )
    assert s.time_step == 1e-3
    assert (
        check(rb.Train(CAR), DECK, rb.Track(), speed=20.0, track_offset="right").track_offset
        == -2.4
    )


@given(
    speed=st.floats(1.0, 120.0),
    spacing=st.floats(22.0, 40.0),
    wavelength=st.floats(0.05, 50.0),
    cars=st.integers(2, 5),
)
def test_the_chosen_step_resolves_waves_and_divides_the_time_between_cars(
    speed, spacing, wavelength, cars
):
    train = rb.Train(CAR, cars=cars, car_spacing=spacing)
    step = default_time_step(train, rb.Track(rb.Harmonic(1e-3, wavelength=wavelength)), speed)
    assert step <= 1e-3 * (1 + 1e-12)
    assert speed * step <= wavelength / 20 * (1 + 1e-12)
    steps = spacing / speed / step
    assert steps == pytest.approx(round(steps), rel=1e-9)


@pytest.mark.parametrize("cars", [1, 3])
def test_a_notch_is_resolved(cars):
    notch = rb.Notch(((1, 1),), circumference=2.8, offset=0.0, depth=1e-3, length=0.05)
    step = default_time_step(rb.Train(CAR, cars=cars, notches=(notch,)), rb.Track(), 20.0)
    assert 20.0 * step <= 0.05 / 20 * (1 + 1e-12)
    # Against a step four times finer the force on the notched wheel has settled.
    train, track = rb.Train(CAR, notches=(notch,)), rb.Track()
    coarse = train.rigid_forces(track, Passage(20.0, step, int(0.02 / step)))[0][0, 1]
    fine = train.rigid_forces(track, Passage(20.0, step / 4, int(0.02 / step * 4)))[0][0, 1][::4]
    n = min(len(coarse), len(fine))
    assert coarse[:n] == pytest.approx(fine[:n], abs=0.03 * np.abs(fine).max())


def test_a_given_step_may_just_do():
    track = rb.Track(rb.Harmonic(1e-3, wavelength=2.0))
    assert check(rb.Train(CAR), DECK, track, speed=20.0, time_step=0.01).time_step == 0.01
    with pytest.raises(rb.InputError, match="fewer than 10 samples in 2 m"):
        check(rb.Train(CAR), DECK, track, speed=20.0, time_step=0.0101)


def test_a_lead_in_too_short_for_its_fade_in_is_refused():
    track = rb.Track(rb.Table([-100.0, 0.0, 100.0], [2e-3, 2e-3, 2e-3]))
    train, deck = rb.Train(rb.vehicle("xia2000")), rb.deck("viaduct36")
    with pytest.raises(rb.InputError, match=r"^lead_in = 0.03: .* at least 0.4 m"):
        check(train, deck, track, speed=20.0, time_step=1e-3, lead_in=0.03)
    # Not given, it is long enough even where 7.5 s are but a few samples.
    assert check(train, deck, track, speed=1e-6, time_step=1e4).lead_in == pytest.approx(0.2)
    for length in (0.0, 0.4):
        assert (
            check(train, deck, track, speed=20.0, time_step=1e-3, lead_in=length).lead_in == length
        )


def test_options_are_declared_once():
    """The signature and the docstring of `cross` come from the fields of `Options`."""
    names = [f.name for f in fields(Options)]
    shown = inspect.signature(rb.cross).parameters
    assert list(shown) == ["train", "deck", "track", *names, "progress"]
    assert all(shown[name].kind is inspect.Parameter.KEYWORD_ONLY for name in names)
    assert shown["speed"].default is inspect.Parameter.empty
    assert [shown[f.name].default for f in fields(Options)[1:]] == [
        f.default for f in fields(Options)[1:]
    ]
    described = re.findall(r"^(\w+) : ", rb.cross.__doc__, re.MULTILINE)
    assert described == list(shown)
    with pytest.raises(rb.InputError, match="sped.*speed"):
        rb.cross(rb.Train(CAR), DECK, sped=20.0)


@pytest.mark.parametrize(
    ("cars", "options"),
    [
        (1, {"time_step": 2e-3, "iterations": 2}),
        (8, {"time_step": 2e-3, "iterations": 4}),
        (8, {"time_step": 2e-3, "loads": "condensed", "iterations": 2}),
        (4, {"time_step": 1e-3, "interaction": "direct"}),
    ],
)
def test_the_memory_that_is_foreseen_is_about_what_is_used(cars, options):
    """Peak of what NumPy keeps while run, histories and envelope are made: never far above."""
    # A loop that is still to be compiled would count with its compiler.
    rb.cross(rb.Train(CAR), DECK, speed=20.0, time_step=4e-3, interaction="direct", tail=0.0)
    train = rb.Train(CAR, cars=cars)
    settings = check(train, DECK, rb.Track(), speed=20.0, **options)
    foreseen = bytes_needed(train, DECK, settings) - 1.2e8  # what Python and its packages take
    tracemalloc.start()
    run = rb.cross(train, DECK, speed=20.0, **options)
    run.displacement(18.0), run.section_forces(18.0), run.envelope("moment_vertical")
    used = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 0.7 * used < foreseen + 5e6 and foreseen < 4.0 * used + 5e6


def test_a_step_too_coarse_for_hertzian_contacts_is_refused():
    car = rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=900.0)
    track, options = rb.Track(), {"speed": 40.0, "lead_in": 0.0, "tail": 0.1}
    most = 1.0 / car.highest_frequency / 3.0
    with pytest.raises(rb.InputError, match=f"at most {most:.3g} s") as refused:
        check(rb.Train(car), DECK, track, contact="hertz", time_step=1.01 * most, **options)
    assert refused.value.field == "time_step"
    check(rb.Train(car), DECK, track, time_step=1.01 * most, **options)
    # The coarsest one allowed carries the train.
    run = rb.cross(rb.Train(car), DECK, contact="hertz", time_step=0.999 * most, **options)
    slow = rb.cross(rb.Train(car), DECK, time_step=0.999 * most, interaction="direct", **options)
    moved, expected = (r.displacement(18.0)["displacement_z"] for r in (run, slow))
    assert moved == pytest.approx(expected, abs=0.01 * np.abs(expected).max())
    assert not run.parted.any()


def test_the_step_is_chosen_for_hertzian_contacts_of_masses_that_are_no_wheelsets():
    frame = rb.Body("frame", 100.0, (0.0, 50.0, 0.0), (0.0, 0.0, 1.0), ("z", "pitch"))
    car = rb.Body("car", 5e3, (0.0, 5e4, 0.0), (0.0, 0.0, 2.0), ("z", "pitch"))
    springs = [
        rb.Spring(low, high, (x, 0.0, z), (0.0, stiffness), (0.0, damping))
        for x in (1.0, -1.0)
        for low, high, z, stiffness, damping in (
            ("frame", "rail", 0.0, 1e9, 0.0), ("car", "frame", 1.0, 1e6, 1e4),
        )
    ]  # fmt: skip
    vehicle = rb.Vehicle("trolley", (car, frame), tuple(springs), 10.0)
    assert vehicle.contact_frequency == 0.0 and vehicle.highest_frequency > 500.0
    options = {"speed": 40.0, "contact": "hertz", "lead_in": 0.0, "tail": 0.1}
    run = rb.cross(rb.Train(vehicle), DECK, **options)
    static = np.array([[wheel.static_load] for wheel in run.train.wheels])
    assert run.wheel_forces[:, 1] / -static == pytest.approx(1.0, abs=0.02)


def test_the_memory_of_hertzian_contacts_is_foreseen():
    """Every car has a run of its own, on this deck and, for Eq. 3, on a rigid one."""
    train = rb.Train(rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=900.0), cars=8)
    options = {"speed": 40.0, "time_step": 5e-4, "contact": "hertz"}
    foreseen = bytes_needed(train, DECK, check(train, DECK, rb.Track(), **options)) - 1.2e8
    rb.cross(train, DECK, **options)  # what is compiled is not counted
    tracemalloc.start()
    run = rb.cross(train, DECK, **options)
    assert run.deviations.from_rigid.shape == (1,) and not run.parted.any()
    assert np.isfinite(run.body_accelerations).all()
    used = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 0.95 * used < foreseen < 2.0 * used


@pytest.mark.parametrize("length, damping", [(8.0, 0.01), (12.0, 0.02), (20.0, (2.0, 1e-4))])
def test_the_chosen_step_keeps_accelerations(length, damping):
    """Eight samples in a period of the highest mode: within 2 %, displacements within 6e-4, of a
    step four times finer."""
    stiffness = 10e3 * (2 * 6.0 * (36.0 / length) ** 0.8 * length**2 / np.pi) ** 2
    deck = rb.Beam("deck", (length,), 10e3, stiffness).deck(damping=damping)
    train = rb.AxleTrain([0.0, 2.5, 15.0, 17.5], [150e3] * 4)
    s = check(train, deck, rb.Track(), speed=60.0)
    assert s.time_step <= 1.0 / 8 / highest_frequency(deck) * (1 + 1e-12)
    runs = [
        rb.cross(train, deck, speed=60.0, interaction="rigid", time_step=s.time_step / part)
        for part in (1, 4)
    ]
    for kind, name, limit in [
        ("acceleration", "acceleration_z", 2e-2), ("displacement", "displacement_z", 6e-4),
    ]:  # fmt: skip
        found, known = (np.abs(getattr(run, kind)(0.4 * length)[name]).max() for run in runs)
        assert found == pytest.approx(known, rel=limit)


def test_modes_that_hardly_ring_ask_for_no_finer_step():
    deck = rb.deck("viaduct36")
    assert highest_frequency(deck) == pytest.approx(119.74, rel=1e-4)
    assert deck.frequencies_hz[-1] > 160.0
    swings = rb.Beam("deck", (10.0,), 10e3, 4e9).deck(8, 0.01)
    s = check(rb.AxleTrain([0.0], [1e5]), swings, rb.Track(), speed=20.0)
    assert s.time_step == pytest.approx(max(1 / 8 / swings.frequencies_hz[-1], 1e-4))


def spread(axles, apart):
    return rb.AxleTrain([apart * i for i in range(axles)], [1e5] * axles)


LONG = rb.Beam(
    "in mm", (36_000.0,), mass=12e3, bending_stiffness_vertical=1e17, elements=12,
).deck(modes=1, damping=0.03)  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"speed": 0.02}, "speed = 0.02: this run would need"),
        ({"time_step": 1e-6}, "time_step = 1e-06: "),
        ({"tail": 5e3}, "tail = 5000.0: "),
        ({"lead_in": 1e5}, "lead_in = 100000.0: "),
        ({"max_iterations": 10_000, "time_step": 1e-4}, "max_iterations = 10000: "),
        ({"iterations": 10_000, "time_step": 1e-4}, "iterations = 10000: "),
        ({"train": rb.Train(CAR, cars=2, car_spacing=22_500.0)}, "train.car_spacing = 22500.0: "),
        ({"train": rb.Train(CAR, cars=800)}, "train.cars = 800: "),
        ({"train": spread(2, 50_000.0)}, "train.axles: the last axle is 50000 m behind"),
        ({"train": spread(4000, 0.2)}, "train.axles: 4000 axles; this run"),
        ({"deck": LONG}, "deck.length = 36000.0: "),
        (
            {"track": rb.Track(rb.Harmonic(1e-6, wavelength=1e-4))},
            "track: 0.0001 m of irregularity ask for steps of 2.5e-07 s; this run would need",
        ),
        (
            {"train": rb.Train(rb.with_wheelsets(CAR, mass=1e-6, roll_inertia=1000.0))},
            "train.vehicle: xia2000 on its contacts, 8.11e+06 Hz, asks for steps of 6.85e-09 s; ",
        ),
        (
            {
                "train": rb.Train(rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=1e-6)),
                "contact": "hertz",
            },
            "train.vehicle: xia2000 on its contacts, 6.21e+06 Hz, asks for steps of 2.01e-08 s; ",
        ),
        (
            {"train": rb.Train(rb.sprung_mass("m", 1e3, 1e6, length=1e5), cars=2)},
            "train.vehicle = 'm': cars are 5e+04 m apart or long; this run",
        ),
    ],
)
def test_too_large_a_run_is_refused_by_what_makes_it_so(changes, words):
    """The refusal names the quantity that is too large, not always the time step."""
    own = {"train": rb.Train(CAR), "deck": DECK, "track": rb.Track(), "speed": 20.0} | changes
    three = own.pop("train"), own.pop("deck"), own.pop("track")
    with pytest.raises(rb.InputError, match="GB of memory, too much: the limit is 2 GB") as error:
        rb.cross(*three, **own)
    assert str(error.value).startswith(words)


def test_a_car_s_front_is_asked_for_its_length_before_anything_is_computed():
    bare = rb.Train(replace(CAR, length=None))
    assert check(bare, DECK, rb.Track(), speed=20.0).excitation == "wheels"
    with pytest.raises(rb.InputError, match=r"excitation = 'car': .* has no length"):
        check(bare, DECK, rb.Track(), speed=20.0, excitation="car")


def test_constant_loads_are_not_charged_for_passes():
    """No deck changes them: HSLM-A1 at 54 km/h fits, where passes would have been too much."""
    train, needed = rb.train("HSLM-A1"), []
    for interaction in ("iterate", "rigid"):
        settings = check(train, DECK, rb.Track(), speed=15.0, interaction=interaction)
        needed.append(bytes_needed(train, DECK, settings))
    assert needed[0] == needed[1] < 1e9
    check(train, DECK, rb.Track(), speed=8.0)


# ---- how train and deck meet

WHEELED = rb.with_wheelsets(rb.planar_car(CAR), mass=1800.0)


@pytest.mark.parametrize(
    ("vehicle", "options", "taken"),
    [
        (CAR, {}, "iterate"),
        (WHEELED, {}, "direct"),
        (WHEELED, {"iterations": 4}, "iterate"),
        (WHEELED, {"relaxation": 0.5}, "iterate"),
        (WHEELED, {"tolerance_of": "displacement"}, "iterate"),
        (WHEELED, {"interaction": "iterate"}, "iterate"),
        (WHEELED, {"interaction": "rigid"}, "rigid"),
        (WHEELED, {"contact": "hertz"}, "direct"),
        (CAR, {"interaction": "direct"}, "direct"),
    ],
)
def test_auto_takes_the_direct_solution_where_contacts_are_stiff(vehicle, options, taken):
    s = check(rb.Train(vehicle), DECK, rb.Track(), speed=20.0, **options)
    assert s.interaction == taken
    assert s.auto == ("interaction" not in options)


@pytest.mark.parametrize(
    ("train", "options", "words"),
    [
        (rb.Train(CAR), {"contact": "hertz"}, "contact = 'hertz': .*the suspension.*wheelsets"),
        (rb.AxleTrain([0.0], [1e5]), {"contact": "hertz"}, "bare axle loads have no contacts"),
        (rb.Train(WHEELED), {"contact": "hertz", "interaction": "iterate"}, "^interaction = 'iter"),
        (rb.Train(WHEELED), {"contact": "hertz", "interaction": "rigid"}, "Use 'direct' or 'auto'"),
        (
            rb.Train(WHEELED),
            {"contact": "hertz", "iterations": 4},
            "iterations = 4: .*no passes|passes",
        ),
        (rb.Train(WHEELED), {"contact": "hertz", "relaxation": 0.5}, "^relaxation = 0.5"),
        (rb.Train(WHEELED), {"contact": "Hertz"}, "contact = 'Hertz'"),
        (rb.Train(WHEELED), {"loads": "condensed"}, "loads = 'condensed': .*feeds energy"),
    ],
)
def test_contacts_that_cannot_be(train, options, words):
    with pytest.raises(rb.InputError, match=words):
        check(train, DECK, rb.Track(), speed=20.0, **options)


def test_condensed_loads_of_wheels_on_stiff_contacts_do_blow_up(monkeypatch):
    """Why they are refused: with the refusal taken away forces grow without end."""
    monkeypatch.setattr("railbridge.settings._refuse_condensed", lambda *_: None)
    options = {"speed": 20.0, "loads": "condensed", "lead_in": 0.0, "tail": 0.0}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = rb.cross(rb.Train(WHEELED), DECK, **options)
    assert np.abs(run.wheel_forces).max() > 1e3 * WHEELED.weight


class Rail:
    """A level rail that is known between two places, and that repeats."""

    shortest = np.inf

    def __init__(self, extent=None, period=None):
        self.extent, self.period = extent, period

    value = slope = staticmethod(np.zeros_like)


def last_place(train, **options):
    """The last place, m, that wheels are asked for."""
    met = []

    class Watched(Rail):
        def value(self, x):
            met.extend(x)
            return np.zeros_like(x)

    rb.cross(train, DECK, rb.Track(vertical=Watched()), **options)
    return max(met)


@pytest.mark.parametrize("excitation", ["wheels", "car"])
@pytest.mark.parametrize("lead_in", [40.0, 0.0])
def test_a_rail_must_be_known_wherever_wheels_go(excitation, lead_in):
    train = rb.Train(CAR, cars=2, car_spacing=22.5)
    options = {"speed": 20.0, "lead_in": lead_in, "excitation": excitation, "tail": 0.5}
    last = last_place(train, **options)
    assert last >= DECK.length + train.length + 0.5 * 20.0
    for direction in ("vertical", "lateral"):
        check(train, DECK, rb.Track(**{direction: Rail((-lead_in, last))}), **options)
        for extent in [(-lead_in + 0.01, last), (-lead_in, last - 0.05)]:
            with pytest.raises(rb.InputError) as caught:
                check(train, DECK, rb.Track(**{direction: Rail(extent)}), **options)
            words = f"track.{direction}: is known from x = {extent[0]:.6g} m to {extent[1]:.6g} m, "
            words += f"and wheels need it from {-lead_in:.6g} m to {last:.6g} m"
            assert str(caught.value).startswith(words)
            assert "shorter lead_in" in str(caught.value) and "origin" in str(caught.value)


def test_a_rail_that_is_too_short_is_named():
    train, short = rb.Train(CAR), Rail((-200.0, 20.0))
    for track, field in [
        (rb.Track(vertical=rb.Rails(None, short)), "track.vertical.right"),
        (rb.Track(lateral=[rb.Harmonic(1e-3, wavelength=10.0), short]), "track.lateral"),
    ]:
        with pytest.raises(rb.InputError) as caught:
            check(train, DECK, track, speed=20.0)
        assert caught.value.field == field
    # Bare axle loads meet no rail.
    check(rb.AxleTrain([0.0, 2.0], [1e5, 1e5]), DECK, rb.Track(vertical=short), speed=20.0)


def test_a_rail_must_not_repeat_below_a_train():
    train = rb.Train(CAR, cars=2, car_spacing=22.5)
    needed = 150.0 + DECK.length + train.length
    check(train, DECK, rb.Track(vertical=Rail(period=needed)), speed=20.0)
    words = f"track.vertical: repeats after {needed - 1:.6g} m, less than .* {needed:.6g} m"
    with pytest.raises(rb.InputError, match=words):
        check(train, DECK, rb.Track(vertical=Rail(period=needed - 1.0)), speed=20.0)
