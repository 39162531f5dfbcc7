"""Waves side by side against the crossing of each wave by itself, which knows nothing of lanes."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies import unitwaves
from railbridge.studies.unitwaves import unit_waves, wave_forces

SPEED = 20.0
FAR = 40 * SPEED
"""m of run-up after which nothing is left of how the track began."""
EDGES = np.array([0.3, 0.6, 1.5])
POINTS = (9.0, 18.0)
QUANTITIES = ("displacement_z", "rotation_x", "acceleration_z", "moment_vertical", "displacement_y")


def _rails(component, wavelength, phase):
    def wave(size, more=0.0):
        return rb.Harmonic(size, wavelength=wavelength, phase=phase + more)

    whole, apart = wave(1e-3), rb.Rails(wave(0.5e-3), wave(0.5e-3, np.pi))
    direction = "vertical" if component in ("vertical", "cross_level") else "lateral"
    return rb.Track(**{direction: whole if component in ("vertical", "alignment") else apart})


def _reference(run, name):
    if name.startswith("wheel_force_z"):
        car, wheel = (int(part.split()[-1]) for part in name.split(", "))
        return run.wheel_force(car, wheel)["force_z"]
    quantity, place = name.split(" at ")
    x = float(place.removesuffix(" m"))
    if quantity.startswith("acceleration"):
        return run.acceleration(x)[quantity]
    ask = run.section_forces if quantity.startswith("moment") else run.displacement
    return ask(x)[quantity]


def _hold(train, deck, components, quantities=QUANTITIES, limit=1e-6, **options):
    waves = unit_waves(
        train, deck, EDGES, components=components, quantities=quantities, points=POINTS,
        wheels_of=(2,), speed=SPEED, **options,
    )  # fmt: skip
    if options.get("interaction") != "rigid":
        options["interaction"] = "direct"
    for c, component in enumerate(components):
        for i, wavenumber in enumerate(waves.wavenumbers):
            for part, phase in enumerate((np.pi / 2, 0.0)):
                track = _rails(component, 2 * np.pi / wavenumber, phase)
                run = rb.cross(train, deck, track, speed=SPEED, lead_in=FAR, **options)
                for name, own in waves.histories.items():
                    known = _reference(run, name)
                    first = int(round((own.time[0] - run.time[0]) / run.settings.time_step))
                    known = known[first : first + len(own.time)]
                    found = own.level + 1e-3 * own.waves[c, :, 2 * i + part]
                    size = np.abs(known - own.level).max()
                    round_off = 1e-9 * np.abs(own.level).max() + 1e-15
                    error = np.abs(found - known).max()
                    assert error < limit * size + round_off, (component, name)


@pytest.fixture(scope="module")
def train():
    return rb.Train(rb.vehicle("xia2000"), cars=2, car_spacing=22.5)


@pytest.fixture(scope="module")
def deck():
    return rb.deck("viaduct36")


def test_all_components_are_those_of_crossings_of_single_waves(train, deck):
    components = tuple(unitwaves.COMPONENTS)
    _hold(train, deck, components, track_offset=2.4, time_step=2e-3)


@pytest.mark.parametrize("loads", ["bogies", "condensed"])
def test_every_way_of_loading(train, deck, loads):
    _hold(train, deck, ("vertical",), track_offset=2.4, time_step=2e-3, loads=loads)


def test_a_rigid_deck_for_the_wheels(train, deck):
    _hold(train, deck, ("vertical",), track_offset=2.4, time_step=2e-3, interaction="rigid")


def test_wheelsets_under_a_rail(deck):
    train = rb.Train(rb.vehicle("xia2000_wheelsets"), cars=2, car_spacing=22.5)
    deck = replace(deck, rail=rb.Rail(bending_stiffness=1.28e7, foundation=1e8))
    quantities = "displacement_z", "acceleration_z", "moment_vertical"
    _hold(train, deck, ("vertical", "cross_level"), quantities, time_step=5e-4)


def test_wheels_that_stand_on_an_end_that_moves_from_the_first_sample_on():
    # They did feel it there, which was 0.3 % of the acceleration, more than the waves' own share.
    content = {
        "length": 36.0, "mass": 8e3, "bending_stiffness_vertical": 5e10, "damping": {"modal": 0.02},
        "bearing": [
            {"x": 0.0, "fixed": "x y roll", "stiffness": {"z": 2e9}},
            {"x": 36.0, "fixed": "y roll", "stiffness": {"z": 2e9}},
        ],
    }  # fmt: skip
    deck = rb.deck_from_table("elastic", content)
    train = rb.Train(rb.vehicle("xia2000_planar"), cars=2, car_spacing=22.5)
    _hold(train, deck, ("vertical",), ("displacement_z", "acceleration_z"), time_step=4e-3)


def test_forces_on_a_rigid_deck_tend_to_the_transfer_function_as_the_step_falls():
    car = rb.vehicle("xia2000")
    wavelength, speed = 7.0, 30.0
    track = rb.Track(vertical=rb.Harmonic(1.0, wavelength=wavelength, phase=np.pi / 2))
    # The one is Re F exp(i W V t) of a cosine, the other Im of a sine with its phase.
    known = rb.steady_forces(car, track, speed) / 1j
    errors = []
    for step in (2e-3, 1e-3):
        waves = np.array([2 * np.pi / wavelength])
        found = wave_forces(car, waves, "vertical", speed, step).reshape(known.shape)
        errors.append(np.abs(found - known).max() / np.abs(known).max())
    assert errors[1] < 1e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.02)


def test_level_track_is_one_of_the_lanes(train, deck):
    waves = unit_waves(train, deck, [0.5, 0.6], speed=SPEED, track_offset=2.4)
    run = rb.cross(train, deck, speed=SPEED, track_offset=2.4, interaction="direct")
    known = run.displacement(18.0)["displacement_z"]
    (own,) = waves.histories.values()
    assert own.level == pytest.approx(known, abs=1e-9 * np.abs(known).max())


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"contact": "hertz"}, "contact"),
        ({"iterations": 3}, "iterations"),
        ({"relaxation": 0.5}, "relaxation"),
        ({"components": ()}, "components"),
        ({"components": ("twist",)}, "components"),
        ({"components": ("vertical", "vertical")}, "components"),
        ({"wheels_of": (3,)}, "car"),
        ({"edges": [0.5]}, "edges"),
        ({"edges": [0.5, 0.4]}, "edges"),
        ({"edges": [0.0, 0.4]}, "edges"),
        ({"time_step": 0.05}, "time_step"),
    ],
)
def test_what_cannot_be_is_refused(deck, options, field):
    train = rb.Train(rb.vehicle("xia2000_wheelsets"), cars=2, car_spacing=22.5)
    edges = options.pop("edges", [0.5, 2.0])
    with pytest.raises(rb.InputError) as refusal:
        unit_waves(train, deck, edges, speed=SPEED, **options)
    assert refusal.value.field.startswith(field)


def test_bare_loads_are_refused(deck):
    with pytest.raises(rb.InputError, match="do not feel the track"):
        unit_waves(rb.AxleTrain([0.0], [1e5]), deck, [0.5, 0.6], speed=SPEED)


def test_what_is_certain_stands_below_the_waves(deck):
    notch = rb.Notch(((1, 1),), 2.9, 0.0, 1e-3, 0.3)
    train = rb.Train(rb.vehicle("xia2000"), cars=2, car_spacing=22.5, notches=(notch,))
    sides = rb.Rails(rb.Harmonic(2e-3, wavelength=9.0), rb.Harmonic(1e-3, wavelength=5.0))
    base = rb.Track(vertical=sides, lateral=rb.Harmonic(1e-3, wavelength=7.0))
    options = {"speed": SPEED, "track_offset": 2.4, "time_step": 1e-3}
    waves = unit_waves(train, deck, [0.5, 0.6], base=base, wheels_of=(1,), **options)
    run = rb.cross(train, deck, base, interaction="direct", **options)
    for name, own in waves.histories.items():
        known = _reference(run, name)
        first = int(round(own.time[0] / run.settings.time_step))
        known = known[first : first + len(own.time)]
        assert own.level == pytest.approx(known, abs=1e-9 * np.abs(known).max()), name


def test_too_many_waves_are_refused_before_they_are_computed(train, deck):
    edges = np.linspace(0.01, 2.0, 200_000)
    with pytest.raises(rb.InputError, match="memory"):
        unit_waves(train, deck, edges, speed=SPEED)


def test_gauge_moves_nothing_on_massless_axles_and_takes_no_time(train, deck):
    waves = unit_waves(
        train, deck, EDGES, components=("gauge", "vertical"), wheels_of=(1,), speed=SPEED
    )
    alone = unit_waves(train, deck, EDGES, components=("gauge",), speed=SPEED)
    for own in waves.histories.values():
        assert own.waves.shape == (2, len(own.time), 4)
        assert not own.waves[0].any()
        assert own.waves[1].any()
    (own,) = alone.histories.values()
    assert own.waves.shape == (1, len(own.time), 4)
    assert not own.waves.any()


def test_hills_of_an_axle_force_are_bounce_and_pitch_of_its_bogie():
    """What Figure 10.6 of the notebooks is said to show: at 11 m bounce, at 6.5 m pitch, and at
    8.4 m the two cancel at the first axle of a bogie and add at the second."""
    car, speed = rb.vehicle("xia2000_planar"), 80.0
    delays = np.array([wheel.delay for wheel in rb.Train(car).wheels])

    def parts(wavelength):
        stiffness = car.transfer(speed / wavelength)[:, 1, :, 1]
        met = np.exp(-2j * np.pi * delays / wavelength)
        together = met.reshape(2, 2).mean(axis=1).repeat(2)  # axles of a bogie
        return (np.abs(stiffness @ r)[:2] for r in (together, met - together, met))

    bounce, pitch, _ = parts(11.0)
    assert np.all(bounce > 2 * pitch)
    bounce, pitch, _ = parts(6.5)
    assert np.all(pitch > 4 * bounce)
    bounce, pitch, both = parts(8.44)
    assert both[0] < 0.15 * (bounce + pitch)[0] and both[1] > 0.95 * (bounce + pitch)[1]
    Omega = 2 * np.pi / np.array([11.0, 8.44, 6.5])
    hill, dip, higher = abs(wave_forces(car, Omega, "vertical", speed, 1e-3)[1])
    assert dip < 0.6 * hill < 0.6 * higher
