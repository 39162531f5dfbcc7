"""Crossings: the numbers the paper's case gives, symmetries, limits, and what is refused or warned
about."""

import warnings
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railbridge as rb
from railbridge.vehicles import Body, Spring, Vehicle

CAR = rb.vehicle("xia2000")
DECK = rb.deck("viaduct36")
PAPER = rb.case("paper")
WAVES = rb.Track(
    rb.Harmonic(5e-3, wavelength=14.4), rb.Harmonic(2e-3, wavelength=14.4, phase=np.pi / 2)
)


@lru_cache
def paper(cars, loads):
    return PAPER.replace({"train.cars": cars, "run.loads": loads, "run.tolerance": 1e-6}).run()


def peaks(run):
    """Mid-span displacement (mm) and moments, largest reaction and torsion there (kN, kN m),
    acceleration (m/s2)."""
    forces, reactions = run.section_forces(18.0), run.reactions().values()
    return [
        abs(run.displacement(18.0).extreme("displacement_z")[0]) * 1e3,
        abs(forces.extreme("moment_vertical")[0]) / 1e3,
        max(abs(r.extreme("force_z")[0]) for r in reactions) / 1e3,
        abs(run.acceleration(18.0).extreme("acceleration_z")[0]),
        abs(forces.extreme("moment_lateral")[0]) / 1e3,
        max(abs(r.extreme("moment_x")[0]) for r in reactions) / 1e3,
    ]


@pytest.mark.parametrize(
    ("cars", "loads", "expected"),
    [
        (8, "condensed", [7.23, 5526, 861, 0.40, 62, 2071]),
        (8, "bogies", [7.13, 4840, 695, 0.23, 35, 1656]),
        (8, "wheels", [6.99, 4603, 655, 0.12, 34, 1568]),
        (1, "condensed", [7.14, 5152, 664]),
        (1, "bogies", [5.39, 3458, 529.6]),
        (1, "wheels", [5.39, 3501, 489]),
    ],
)
def test_peaks_of_the_paper_s_case(cars, loads, expected):
    found = peaks(paper(cars, loads))
    for i, (ours, known) in enumerate(zip(found, expected, strict=False)):
        assert ours == pytest.approx(known, rel=4e-3 if i < 3 else 0.05), i


@pytest.mark.parametrize(
    ("loads", "from_previous"),
    [("condensed", [0.92, -0.296, -0.0007, 0.0018]), ("wheels", [2.28, -0.25, -0.0035, 0.001])],
)
def test_equation_3_of_the_paper_s_case(loads, from_previous):
    deviations = paper(8, loads).deviations
    assert deviations.from_previous[:4] == pytest.approx(from_previous, rel=0.02, abs=1.5e-4)
    assert deviations.from_rigid[0] == deviations.from_previous[0]
    growth = np.cumprod(1 + deviations.from_previous / 100)
    assert deviations.from_rigid == pytest.approx(100 * (growth - 1))
    assert len(deviations.to_frame()) == paper(8, loads).iterations


def test_self_weight_stands_apart():
    run = paper(8, "condensed")
    for quantity, at in [
        ("displacement_z", run.displacement),
        ("moment_vertical", run.section_forces),
    ]:
        weight = at(18.0, self_weight=True)[quantity] - at(18.0)[quantity]
        assert np.ptp(weight) < 1e-9 * abs(weight[0])
        assert weight[0] == pytest.approx(
            {"displacement_z": -28.812e-3, "moment_vertical": -19070.6e3}[quantity], rel=1e-4
        )
    total = run.reactions(self_weight=True)[0.0]["force_z"][0] - run.reactions()[0.0]["force_z"][0]
    assert total == pytest.approx(12e3 * 9.81 * 18.0)


def test_before_the_train_and_long_after_it_nothing_moves():
    run = PAPER.replace(
        {"train.cars": 1, "run.loads": "wheels", "run.tail": 12.0, "run.time_step": 2e-3}
    ).run()
    y = run.displacement(18.0)["displacement_z"]
    assert y[0] == 0.0
    assert np.abs(y[-100:]).max() < 1e-3 * np.abs(y).max()


@pytest.mark.parametrize("loads", ["wheels", "condensed"])
@pytest.mark.parametrize("speed", [20.0, 80.0])
def test_newton_s_law_holds_for_the_whole_deck_at_every_instant(speed, loads):
    """Bearings carry the loads less the deck's inertia less its outer damping, alpha m w'.

    Up, sideways and about the axis; the deck's share by quadrature of its motion.
    """
    track = replace(WAVES, lateral=rb.Harmonic(2e-3, wavelength=11.0))
    options = {"loads": loads, "track_offset": 2.4, "iterations": 4, "time_step": 2e-3}
    run = rb.cross(rb.Train(CAR, cars=2), DECK, track, speed=speed, **options)
    alpha, _ = rb.rayleigh(0.03, (3.307, 16.30))
    mass, inertia = 12e3, 2500.0 * (2.553 + 25.53)
    # Exact for the cubics of every element.
    x, w = np.polynomial.legendre.leggauss(4)
    edges = DECK.shapes.edges[:, None]
    h = np.diff(edges, axis=0) / 2
    places, weights = (edges[:-1] + h * (x + 1.0)).ravel(), (h * w).ravel()
    state = run.state
    moving = DECK.acceleration(state.q, state.velocity, state.modal_force) + alpha * state.velocity
    deck = np.einsum("k,kmc,mt->ct", weights, DECK.shapes(places), moving)
    deck *= np.array([mass, mass, inertia])[:, None]
    stations = run.coupling.station_loads(run.passes[run.iteration])
    met = np.zeros((3, len(run.time)))
    for load, start in zip(stations, run.coupling.loads.starts, strict=True):
        met[:, start : start + load.shape[1]] += load[:3]
    carried = np.array(
        [
            sum(r[name] for r in run.reactions().values())
            for name in ("force_y", "force_z", "moment_x")
        ]
    )
    size = np.abs(carried).max(axis=1, keepdims=True)
    assert np.max(np.abs(carried + met - deck) / size) < 1e-6


def stiff(deck, factor):
    scaled = replace(deck, frequencies_hz=deck.frequencies_hz * factor)
    return scaled


def test_a_very_stiff_deck_gives_the_rigid_forces():
    options = {"speed": 20.0, "time_step": 1e-3}
    run = rb.cross(rb.Train(CAR, cars=2), stiff(DECK, 1e3), WAVES, track_offset=2.4, **options)
    rigid = rb.cross(rb.Train(CAR, cars=2), DECK, WAVES, interaction="rigid", **options)
    assert run.wheel_forces == pytest.approx(rigid.wheel_forces, abs=1.0)
    assert rigid.converged is None and rigid.changes == () and rigid.iterations == 0


def test_iteration_zero_is_the_rigid_deck():
    run, rigid = (
        paper(1, "wheels"),
        PAPER.replace({"train.cars": 1, "run.interaction": "rigid", "run.loads": "wheels"}).run(),
    )
    assert run.at(0).wheel_forces == pytest.approx(rigid.wheel_forces, rel=1e-12)
    assert run.at(0).displacement(18.0)["displacement_z"] == pytest.approx(
        rigid.displacement(18.0)["displacement_z"]
    )
    assert run.at(run.iterations).spectrum.amplitude == pytest.approx(run.spectrum.amplitude)
    with pytest.raises(rb.InputError, match="iteration"):
        run.at(run.iterations + 1)


@given(scale=st.floats(0.2, 3.0))
@settings(max_examples=3)
def test_dynamic_forces_are_linear_in_the_irregularity(scale):
    def dynamic(amplitude):
        track = rb.Track(
            rb.Harmonic(amplitude, wavelength=14.4), rb.Harmonic(0.4 * amplitude, wavelength=14.4)
        )
        return rb.cross(
            rb.Train(CAR), DECK, track, speed=20.0, time_step=4e-3, iterations=3
        ).wheel_forces

    level = dynamic(0.0)
    once, scaled = dynamic(5e-3) - level, dynamic(5e-3 * scale) - level
    assert scaled == pytest.approx(scale * once, abs=1e-7 * np.abs(once).max())


@given(
    offset=st.floats(0.0, 3.0), phase=st.floats(-3, 3), loads=st.sampled_from(["wheels", "bogies",
    "condensed"]),
)  # fmt: skip
@settings(max_examples=5)
def test_left_and_right_are_mirror_images(offset, phase, loads):
    left, right = (
        rb.Harmonic(a, wavelength=w, phase=phase) for a, w in ((5e-3, 14.4), (3e-3, 11.0))
    )
    sway = rb.Harmonic(2e-3, wavelength=13.0)
    mirrored = rb.Harmonic(2e-3, wavelength=13.0, phase=np.pi)
    options = {"speed": 20.0, "time_step": 4e-3, "iterations": 3, "loads": loads}
    a = rb.cross(
        rb.Train(CAR), DECK, rb.Track(rb.Rails(left, right), sway), track_offset=offset, **options
    )
    b = rb.cross(
        rb.Train(CAR),
        DECK,
        rb.Track(rb.Rails(right, left), mirrored),
        track_offset=-offset,
        **options,
    )
    swapped = (
        b.wheel_forces.reshape(4, 2, 2, -1)[:, ::-1].reshape(a.wheel_forces.shape)
        * np.array([-1, 1])[:, None]
    )
    assert a.wheel_forces == pytest.approx(swapped, abs=1e-4)
    y, z = a.displacement(11.0), b.displacement(11.0)
    for name, sign in [("displacement_y", -1), ("displacement_z", 1), ("rotation_x", -1)]:
        assert y[name] == pytest.approx(sign * z[name], abs=1e-10)
    for name, sign in [("moment_vertical", 1), ("moment_lateral", -1), ("torsion", -1)]:
        assert a.section_forces(11.0)[name] == pytest.approx(
            sign * b.section_forces(11.0)[name], abs=1e-2
        )


def test_the_deck_moves_to_the_side_of_the_train_and_twists_towards_it():
    run = rb.cross(rb.Train(CAR), DECK, speed=5.0, time_step=5e-3, track_offset=2.4)
    i = np.argmin(run.displacement(18.0)["displacement_z"])
    assert (
        run.displacement(18.0)["rotation_x"][i] < 0
    )  # a load to the left (y > 0) lowers the left: roll about x negative
    static = (
        DECK.recovery.section("rotation_x", 18.0).influence(np.array([18.0]))[0, 0, 2]
        * -2.4
        * CAR.weight
    )
    assert 0.3 < run.displacement(18.0)["rotation_x"][i] / static < 1.0


def test_aligned_and_unaligned_steps_agree():
    """A given step that cars do not meet alike, against the chosen one, which they do."""
    train = rb.Train(CAR, cars=3, car_spacing=22.5731)
    chosen = rb.cross(train, DECK, WAVES, speed=20.0, track_offset=2.4, tolerance=1e-6)
    given_step = rb.cross(
        train, DECK, WAVES, speed=20.0, track_offset=2.4, time_step=1e-3, tolerance=1e-6
    )
    steps_between_cars = [22.5731 / 20.0 / run.settings.time_step for run in (chosen, given_step)]
    assert steps_between_cars[0] == pytest.approx(round(steps_between_cars[0]), abs=1e-6)
    assert abs(steps_between_cars[1] - round(steps_between_cars[1])) > 0.1
    t = chosen.time
    for name in ("displacement_z", "displacement_y", "rotation_x"):
        a = chosen.displacement(18.0)[name]
        b = np.interp(t, given_step.time, given_step.displacement(18.0)[name])
        assert a == pytest.approx(b, abs=2e-4 * np.abs(a).max())


def test_displacements_converge_with_the_square_of_the_step():
    def midspan(step):
        run = rb.cross(
            rb.Train(CAR),
            DECK,
            WAVES,
            speed=20.0,
            track_offset=2.4,
            time_step=step,
            iterations=8,
            tail=0.2,
        )
        return run.displacement(18.0)["displacement_z"][:: round(8e-3 / step)]

    # 36 m, the axles and the step of 8 ms meet only at some samples: an axle that enters between
    # samples costs accuracy.
    fine, coarse, middle = (midspan(s) for s in (5e-4, 8e-3, 4e-3))
    n = min(map(len, (fine, coarse, middle)))
    e1, e2 = (np.abs(x[:n] - fine[:n]).max() for x in (coarse, middle))
    assert e1 / e2 > 2.8
    assert e2 < 2e-3 * np.abs(fine).max()


@pytest.mark.parametrize("relaxation", [0.5, "aitken"])
def test_relaxation_reaches_the_same_limit(relaxation):
    plain = rb.cross(rb.Train(CAR), DECK, WAVES, speed=20.0, time_step=2e-3)
    relaxed = rb.cross(
        rb.Train(CAR),
        DECK,
        WAVES,
        speed=20.0,
        time_step=2e-3,
        relaxation=relaxation,
        max_iterations=100,
    )
    assert relaxed.converged
    assert relaxed.wheel_forces == pytest.approx(plain.wheel_forces, abs=1e-7 * CAR.weight)


def light(mass):
    return rb.Beam("light", (36.0,), mass, 7.4446e6 * 12e3).deck(8, 0.02)


def test_no_silent_non_convergence():
    train = rb.Train(rb.planar_car(CAR), cars=4)
    with pytest.raises(rb.NotConvergedError, match="max_iterations.*relaxation") as error:
        options = {"time_step": 2e-3, "max_iterations": 6, "relaxation": 1.0}
        rb.cross(train, light(2e3), WAVES, speed=20.0, **options)
    run = error.value.run
    assert run.converged is False and len(run.changes) == run.iterations == 6
    assert (
        run.at(2).displacement(18.0)["displacement_z"].min() < 0
    )  # everything computed so far can be read
    assert len(run.ratios) == 5
    given_number = rb.cross(train, light(2e3), WAVES, speed=20.0, time_step=2e-3, iterations=6)
    assert given_number.converged is False  # asked for six, got six, and it says so
    helped = rb.cross(
        train, light(2e3), WAVES, speed=20.0, time_step=2e-3, relaxation=0.4, max_iterations=200
    )
    assert helped.converged


def test_a_diverging_iteration_stops_with_an_error_not_with_numbers():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        with pytest.raises(rb.NotConvergedError):
            rb.cross(
                rb.Train(rb.planar_car(CAR), cars=3),
                light(50.0),
                speed=60.0,
                time_step=2e-3,
                max_iterations=40,
                relaxation=1.0,
            )


def test_wheel_forces_after_the_deck_are_continuous_and_decay():
    run = rb.cross(
        rb.Train(CAR, cars=2), DECK, speed=20.0, track_offset=2.4, tail=12.0, time_step=1e-3
    )
    static = CAR.contacts[0].static_load
    moving = run.wheel_forces[:8, 1] + static  # level track: only the deck moves the car
    stop = run.coupling.cars[0].window.stop
    inside = np.abs(np.diff(moving[:, stop - 200 : stop - 2])).max()
    assert np.abs(np.diff(moving[:, stop - 2 : stop + 2])).max() < 2 * inside
    assert np.abs(moving[:, stop + 1 : stop + 500]).max() > 1e-3 * static * 0.1
    assert np.abs(moving[:, -500:]).max() < 0.05 * np.abs(moving[:, stop:]).max()


def test_bare_axles_need_one_look_at_the_deck():
    run = rb.cross(rb.AxleTrain([0.0, 3.0], [1e5, 1e5]), DECK, WAVES, speed=40.0)
    assert run.converged and set(run.changes) == {0.0}
    assert np.all(run.wheel_forces[:, 1] == -1e5)
    assert np.isnan(run.deviations.from_rigid).all()


def test_car_forces_are_the_sum_of_its_wheels():
    run = paper(8, "wheels")
    forces = run.car_forces(3)
    assert forces["force_z"] == pytest.approx(run.wheel_forces[16:24, 1].sum(axis=0))
    assert run.car_forces(3, static=False)["force_z"] == pytest.approx(
        forces["force_z"] + CAR.weight
    )
    centre = run.car_forces(3, at="centre")
    assert centre["moment_x"] - forces["moment_x"] == pytest.approx(
        1.41 * forces["force_y"], abs=1e-6
    )
    assert run.wheel_force(3, 2)["force_z"] == pytest.approx(run.wheel_forces[17, 1])
    for wrong in (
        lambda: run.wheel_force(9, 1),
        lambda: run.car_forces(9),
        lambda: run.displacement(37.0),
    ):
        with pytest.raises(rb.InputError):
            wrong()


def test_spectrum_covers_the_first_car_s_crossing():
    run = paper(8, "wheels")
    record = (18.1 + 36.0) / 20.0
    assert run.spectrum.frequency[0] == pytest.approx(1 / record, rel=1e-3)
    stop = round(record / 1e-3) + 1
    total = run.wheel_forces[:8, 1, :stop].sum(axis=0)
    assert run.spectrum.amplitude == pytest.approx(rb.amplitude_spectrum(total, 1e-3).amplitude)
    assert run.spectrum.peak[0] == pytest.approx(20 / 14.4, abs=0.5 / record)


@pytest.mark.parametrize("lead_in", [20.0, 60.0, 100.0])
def test_a_short_run_up_is_warned_about_with_the_figure(lead_in):
    options = {"speed": 20.0, "iterations": 1, "time_step": 2e-3}
    settled = rb.cross(rb.Train(CAR), DECK, WAVES, lead_in=3000.0, **options)
    with pytest.warns(UserWarning, match="lead_in.*transient") as caught:
        run = rb.cross(rb.Train(CAR), DECK, WAVES, lead_in=lead_in, **options)
    said = next(str(w.message) for w in caught if "lead_in" in str(w.message))
    printed = float(said.split(": ")[1].split("%")[0]) / 100
    window = run.coupling.cars[0].window
    a, b = (r.coupling.cars[0].rigid[..., window] for r in (run, settled))
    assert printed == pytest.approx(np.linalg.norm(a - b) / np.linalg.norm(b), abs=1.5e-3)


@pytest.mark.parametrize("lead_in", [None, 0.0, 150.0, 148.0])
@pytest.mark.parametrize("speed", [20.0, 40.0, 80.0])
def test_the_default_run_up_is_long_enough(lead_in, speed):
    lead_in = lead_in and lead_in * speed / 20.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rb.cross(
            rb.Train(CAR), DECK, WAVES, speed=speed, lead_in=lead_in, iterations=1, time_step=2e-3
        )


def test_a_short_run_up_on_level_track_bare_axles_or_a_table_is_no_matter():
    table = rb.Track(rb.Table([0.0, 10.0, 20.0], [0.0, 1e-3, 0.0]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for train, track in [
            (rb.Train(CAR), rb.Track()),
            (rb.AxleTrain([0.0], [1e5]), WAVES),
            (rb.Train(CAR), table),
        ]:
            rb.cross(train, DECK, track, speed=20.0, lead_in=1.0, iterations=1, time_step=2e-3)
        level = rb.Track(rb.Harmonic(0.0, wavelength=3.0))
        rb.cross(rb.Train(CAR), DECK, level, speed=20.0, lead_in=1.0, iterations=1, time_step=2e-3)


def test_results_cannot_be_changed_by_accident():
    run = rb.cross(rb.Train(CAR), DECK, WAVES, speed=20.0, iterations=1, time_step=2e-3)
    for array in (run.time, run.wheel_forces, run.body_accelerations, run.state.q):
        with pytest.raises(ValueError, match="read-only"):
            array[..., 0] = 1.0
    assert run == run and run != run.at(0)


def test_bare_axles_have_no_contraction():
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), DECK, speed=20.0, time_step=2e-3)
    assert run.changes == (0.0, 0.0) and np.isnan(run.ratios).all() and run.ratios.shape == (1,)


def test_what_is_no_track_is_refused():
    with pytest.raises(rb.InputError, match="track"):
        rb.cross(rb.Train(CAR), DECK, [], speed=20.0)


def test_self_weight_without_recovery_is_refused():
    deck = replace(DECK, recovery=None)
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), deck, speed=20.0, time_step=2e-3)
    assert np.isfinite(run.displacement(18.0)["displacement_z"]).all()
    with pytest.raises(rb.InputError, match="only its modes are known"):
        run.displacement(18.0, self_weight=True)


def test_car_forces_at_a_centre_of_mass_off_the_middle():
    """Newton and Euler of a rigid car on a rigid deck: the couples about its centre of mass are
    those of its own rotation."""
    x, y, z = 1.3, 0.2, 1.5
    body = Body("car", 3e4, (3e4, 3e5, 3e5), (x, y, z))
    springs = tuple(
        Spring("car", "rail", (a, b, 0.0), (8e5, 1e6), (2e4, 3e4)) for a in (4.0,
        -3.0) for b in (1.0, -0.8)
    )  # fmt: skip
    train = rb.Train(Vehicle("off centre", (body,), springs, 9.0))
    run = rb.cross(train, DECK, WAVES, speed=20.0, interaction="rigid", time_step=2e-3)
    centre = run.car_forces(at="centre", static=False)
    # Pitch acceleration from the vertical ones above the foremost and rearmost springs.
    vertical = run.body_accelerations[0, :, 1]
    pitch = (vertical[0] - vertical[2]) / -7.0
    assert centre["moment_y"] == pytest.approx(
        -3e5 * pitch, abs=1e-6 * np.abs(centre["moment_y"]).max()
    )
    lateral = run.body_accelerations[0, :, 0]
    yaw = (lateral[0] - lateral[2]) / 7.0
    assert centre["moment_z"] == pytest.approx(
        -3e5 * yaw, abs=1e-6 * np.abs(centre["moment_z"]).max()
    )
    # Weight acts through the centre of mass: no couple about it at rest.
    whole = run.car_forces(at="centre")
    assert (whole["moment_x"] - centre["moment_x"])[0] == pytest.approx(0.0, abs=1.0)
    assert (whole["moment_y"] - centre["moment_y"])[0] == pytest.approx(0.0, abs=1.0)


def test_states_kept_from_the_iteration_are_those_of_its_passes():
    run = rb.case("paper").replace({"train.cars": 2, "run.time_step": 0.004}).compute()
    assert sorted(run.states) == [0, run.iterations - 1]
    for i in range(run.iterations + 1):
        expected = run.coupling.deck_state(run.coupling.station_loads(run.passes[i]))
        assert np.array_equal(run.at(i).state.q, expected.q) and np.array_equal(
            run.at(i).state.velocity, expected.velocity
        )
    assert run.at(2).state is run.at(2).state
