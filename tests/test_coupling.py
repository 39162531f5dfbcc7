"""The fixed point is the coupled solution: a sprung mass on sine modes, integrated as one system of
equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import railbridge as rb
from railbridge.coupling import iterate, left, prepare
from railbridge.settings import check
from railbridge.vehicles import Body, Spring, Vehicle

L, MASS, EI, MODES, RATIO = 25.0, 2303.0, 2.87e9 * 2.9, 3, 0.01
CAR_MASS, STIFFNESS, DAMPING = 5750.0, 1.595e6, 2.0e4
AMPLITUDE, WAVELENGTH, PHASE = 2e-3, 7.0, 0.0


def coupled(speed, t):
    """Independent: (z, q, z', q') with the wheel riding on r(Vt) + w(Vt, t), convective term
    included. Returns q and force."""
    n = np.arange(1, MODES + 1)
    omega = (n * np.pi / L) ** 2 * np.sqrt(EI / MASS)
    norm = np.sqrt(2 / MASS / L)

    def contact(time, y):
        z, q, vz, vq = y[0], y[1 : 1 + MODES], y[1 + MODES], y[2 + MODES :]
        x = speed * time
        phi, slope = (
            norm * np.sin(n * np.pi * x / L),
            norm * n * np.pi / L * np.cos(n * np.pi * x / L),
        )
        k = 2 * np.pi / WAVELENGTH
        wheel = AMPLITUDE * np.sin(k * x + PHASE) + phi @ q
        rate = AMPLITUDE * k * speed * np.cos(k * x + PHASE) + phi @ vq + speed * (slope @ q)
        return STIFFNESS * (z - wheel) + DAMPING * (vz - rate), phi

    def motion(time, y):
        force, phi = contact(time, y)  # upwards on the deck, without the static part
        q, vq = y[1 : 1 + MODES], y[2 + MODES :]
        accelerations = phi * (force - CAR_MASS * 9.81) - 2 * RATIO * omega * vq - omega**2 * q
        return np.concatenate([[y[1 + MODES]], vq, [-force / CAR_MASS], accelerations])

    solution = solve_ivp(
        motion,
        (0, t[-1]),
        np.zeros(2 + 2 * MODES),
        method="DOP853",
        rtol=1e-11,
        atol=1e-14,
        t_eval=t,
    )
    force = np.array([contact(time, y)[0] for time, y in zip(t, solution.y.T, strict=True)])
    shape = norm * np.sin(n * np.pi / 2)
    return shape @ solution.y[1 : 1 + MODES], force - CAR_MASS * 9.81


def suite(speed, step, **options):
    car = rb.sprung_mass("mass", CAR_MASS, STIFFNESS, DAMPING)
    deck = rb.Beam("beam", (L,), MASS, EI, elements=60).deck(MODES, RATIO)
    track = rb.Track(rb.Harmonic(AMPLITUDE, wavelength=WAVELENGTH, phase=PHASE))
    return rb.cross(
        rb.Train(car), deck, track, speed=speed, time_step=step, lead_in=0.0, tail=0.0, **options
    )


@pytest.mark.parametrize("speed", [15.0, 27.78, 70.0])
def test_the_limit_is_the_coupled_solution(speed):
    run = suite(speed, 5e-4)
    on = speed * run.time < L - 1e-6
    deflection, force = coupled(speed, run.time[on])
    ours = run.displacement(L / 2, kept_only=True)["displacement_z"][on]
    # The mesh's modes and the sampling stay; the rigid-deck guess is hundreds of times worse.
    error = np.abs(ours - deflection).max() / np.abs(deflection).max()
    rigid = (
        np.abs(
            run.at(0).displacement(L / 2, kept_only=True)["displacement_z"][on] - deflection
        ).max()
        / np.abs(deflection).max()
    )
    assert error < 2e-5
    assert rigid > 500 * error
    dynamic = np.abs(force + CAR_MASS * 9.81).max()
    # r' jumps when the wheel enters the waves and the deck: the first samples of the force know it
    # a step late.
    assert run.wheel_forces[0, 1][on][20:] == pytest.approx(force[20:], abs=4e-3 * dynamic)


def test_each_pass_is_nearer_to_the_coupled_solution():
    run = suite(27.78, 1e-3, iterations=5)
    on = 27.78 * run.time < L - 1e-6
    deflection, _ = coupled(27.78, run.time[on])
    errors = [
        np.abs(
            run.at(i).displacement(L / 2, kept_only=True)["displacement_z"][on] - deflection
        ).max()
        for i in range(6)
    ]
    assert (
        errors[1] < 0.5 * errors[0] and errors[2] < 0.5 * errors[1] and errors[5] < 0.02 * errors[0]
    )


def test_error_falls_with_the_square_of_the_step():
    errors = []
    for step in (8e-3, 4e-3, 2e-3):
        run = suite(25.0, step)  # 25 m in whole steps
        on = 25.0 * run.time < L - 1e-6
        deflection, _ = coupled(25.0, run.time[on])
        errors.append(
            np.abs(run.displacement(L / 2, kept_only=True)["displacement_z"][on] - deflection).max()
        )
    assert errors[0] / errors[1] > 3.0 and errors[1] / errors[2] > 3.0


def test_convective_term_counts_more_the_faster_the_train():
    """Static deflection under a wheel that only feels V w' through its damper: force = -c V w'(x)
    q."""
    forces = []
    for speed in (20.0, 40.0):
        train, deck = (
            rb.Train(rb.sprung_mass("m", 1e5, 1e3, 1e4)),
            rb.Beam("b", (L,), MASS, EI).deck(1, 0.0),
        )
        s = check(train, deck, rb.Track(), speed=speed, time_step=1e-3)
        coupling = prepare(train, deck, rb.Track(), s)
        state = coupling.deck_state(coupling.station_loads(coupling.nothing_added()))
        frozen = type(state)(
            np.full_like(state.q, -1.0), np.zeros_like(state.velocity), state.modal_force
        )
        u = coupling.support_input(frozen, coupling.cars)[0, 1, 0]
        x = speed * s.time_step * (np.arange(u.size) + coupling.cars[0].window.start)
        on = (x > 0.1) & (x < L - 0.1)
        norm = np.sqrt(2 / MASS / L)
        expected = -norm * (
            1e3 * np.sin(np.pi * x / L) + 1e4 * speed * np.pi / L * np.cos(np.pi * x / L)
        )
        assert u[on] == pytest.approx(expected[on], rel=1e-3, abs=1e-3 * np.abs(expected).max())
        forces.append(np.abs(u).max())
    assert forces[1] / forces[0] == pytest.approx(2.0, rel=0.01)


def test_changes_are_what_they_are_said_to_be():
    run = suite(27.78, 1e-3, iterations=4)
    window = run.coupling.cars[0].window
    for i in range(1, 5):
        new, old = (run.at(j).wheel_forces[0, 1, window] + CAR_MASS * 9.81 for j in (i, i - 1))
        assert run.changes[i - 1] == pytest.approx(
            np.sqrt(np.mean((new - old) ** 2) / np.mean(new**2)), rel=1e-6
        )
    assert run.ratios == pytest.approx(np.array(run.changes[1:]) / np.array(run.changes[:-1]))


def test_it_stops_below_the_tolerance_twice_in_a_row():
    run = suite(27.78, 1e-3, tolerance=1e-5)
    assert run.converged
    assert run.changes[-1] < 1e-5 and run.changes[-2] < 1e-5 and run.changes[-3] >= 1e-5
    assert iterate(run.coupling).changes == run.changes


def test_what_is_left_is_the_sum_of_what_would_follow():
    falling = [0.3**k for k in range(5)]
    assert left(falling) == pytest.approx(sum(0.3**k for k in range(5, 60)))
    # The slower of the last two falls counts; one change alone, or one that grew, tells nothing.
    assert left([1.0, 0.5, 0.05]) == pytest.approx(0.05) == left([1.0, 0.1, 0.05])
    assert left([7.0, 1.0, 0.1, 0.01]) == pytest.approx(0.01 / 9)
    for unknown in ([0.1], [0.1, 0.2], [0.1, 0.2, 0.01], [0.0, 0.1]):
        assert left(unknown) == np.inf
    assert left([0.0]) == left([0.5, 0.0]) == 0.0


def test_changes_of_displacement_are_what_they_are_said_to_be():
    """The root of the mass times the mean square of the displacement, along the deck by hand."""
    run = suite(27.78, 1e-3, iterations=3, tolerance_of="displacement")
    x = (np.arange(500) + 0.5) / 500 * L
    shapes = run.deck.shapes(x)[:, :, 1]
    states = [run.at(i).state.q for i in range(4)]
    for change, new, old in zip(run.changes, states[1:], states[:-1], strict=True):
        rms = [np.sqrt(MASS * L * np.mean((shapes @ q) ** 2, axis=0)) for q in (new - old, new)]
        assert change == pytest.approx(rms[0].max() / rms[1].max(), rel=2e-3)
    assert sorted(run.states) == [0, 1, 2, 3]
    assert iterate(run.coupling).changes == run.changes


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("relaxation", [None, 0.6, "aitken"])
def test_a_tolerance_of_displacement_is_kept_with_fewer_passes(tolerance, relaxation):
    exact = suite(27.78, 1e-3, tolerance=1e-12).displacement(L / 2)["displacement_z"]
    options = {"tolerance": tolerance, "relaxation": relaxation}
    run = suite(27.78, 1e-3, tolerance_of="displacement", **options)
    ours = run.displacement(L / 2)["displacement_z"]
    assert run.converged
    assert np.abs(ours - exact).max() < tolerance * np.abs(exact).max()
    assert run.iterations < suite(27.78, 1e-3, relaxation=relaxation).iterations


@pytest.mark.parametrize("loads, passes", [("condensed", 9), ("wheels", 5)])
def test_the_paper_case_keeps_a_tolerance_of_displacement(loads, passes):
    changes = {"run.iterations": None, "run.loads": loads, "run.tail": 0.0}
    case = rb.case("paper").replace(changes)
    exact = case.replace({"run.tolerance": 1e-12}).run().displacement(18.0)["displacement_z"]
    run = case.replace({"run.tolerance": 1e-4, "run.tolerance_of": "displacement"}).run()
    ours = run.displacement(18.0)["displacement_z"]
    assert np.abs(ours - exact).max() < 1e-4 * np.abs(exact).max()
    assert run.iterations <= passes < case.run().iterations / 2


def test_passes_that_slow_down_on_the_way_do_not_end_too_early():
    """Every pass carries the solution some cars down the train: on a light deck the changes fall
    fast and then slowly, or rise again."""
    train, track = rb.Train(rb.vehicle("xia2000_planar"), cars=4), rb.Track(rb.Harmonic(5e-3, 14.4))
    for mass in (6e3, 4e3):
        deck = rb.Beam("light", (36.0,), mass, 8.9e10).deck(4, 0.02)
        common = {"speed": 20.0, "time_step": 2e-3, "max_iterations": 100}
        exact = rb.cross(train, deck, track, **common, tolerance=1e-11)
        exact = exact.displacement(18.0)["displacement_z"]
        for tolerance in (1e-2, 1e-3, 1e-4):
            run = rb.cross(
                train, deck, track, **common, tolerance=tolerance, tolerance_of="displacement"
            )
            error = np.abs(run.displacement(18.0)["displacement_z"] - exact).max()
            assert error < tolerance * np.abs(exact).max()


def test_a_tolerance_of_displacement_that_is_not_met_is_told_in_its_words():
    words = "moved the deck by .* of its largest motion; that and what is left must be below"
    with pytest.raises(rb.NotConvergedError, match=words):
        suite(27.78, 1e-3, tolerance_of="displacement", max_iterations=2)


def test_every_wheel_feels_the_deck_at_its_own_place():
    """v at the axis, w + y theta under the wheel, each with its total derivative; springs and
    dampers of Table 1 by hand."""
    rng = np.random.default_rng(2)
    train, deck, offset, speed = (
        rb.Train(rb.vehicle("xia2000"), cars=2),
        rb.deck("viaduct36"),
        2.4,
        25.0,
    )
    s = check(train, deck, rb.Track(), speed=speed, time_step=2e-3, track_offset=offset)
    coupling = prepare(train, deck, rb.Track(), s)
    state = coupling.deck_state(coupling.station_loads(coupling.nothing_added()))
    q, velocity = (rng.normal(size=state.q.shape) for _ in range(2))
    u = coupling.support_input(type(state)(q, velocity, state.modal_force), coupling.cars)
    for car in (0, 1):
        window = coupling.cars[car].window
        for wheel in (w for w in train.wheels if w.car == car + 1):
            place = speed * coupling.time[window] - wheel.delay
            on = (
                np.min(np.abs(place[:, None] - deck.shapes.edges), axis=1) > 1e-6
            )  # the slope of twist has corners there
            on &= (place > 0.0) & (place < deck.length)
            met, slope = deck.shapes(place[on]), deck.shapes(place[on], 1)
            here, now = q[:, window][:, on], velocity[:, window][:, on]
            moved = np.einsum("tmc,mt->ct", met, here)
            rate = np.einsum("tmc,mt->ct", met, now) + speed * np.einsum("tmc,mt->ct", slope, here)
            y = offset + wheel.y
            own = u[wheel.number - 1, :, car, : len(place)]
            ours = own[:, on]
            lateral = 20e6 * moved[0] + 15e3 * rate[0]
            vertical = 2976e3 * (moved[1] + y * moved[2]) + 15e3 * (rate[1] + y * rate[2])
            assert ours[0] == pytest.approx(lateral, abs=1e-9 * np.abs(lateral).max())
            assert ours[1] == pytest.approx(vertical, abs=1e-9 * np.abs(vertical).max())
            assert not own[:, (place < -1e-6) | (place > deck.length + 1e-6)].any()


def test_an_iteration_that_overflows_has_not_converged():
    """A feather of a deck: the changes grow until forces are no numbers any more, which is not 'no
    change'."""
    deck = rb.Beam("beam", (36.0,), 1.0, 8e10).deck(5, 0.0)
    train = rb.Train(rb.vehicle("xia2000_planar"), cars=2)
    track = rb.Track(rb.Harmonic(2e-3, wavelength=10.0))
    with np.errstate(all="ignore"), pytest.raises(rb.NotConvergedError) as caught:
        rb.cross(
            train,
            deck,
            track,
            speed=20.0,
            time_step=2e-3,
            lead_in=0.0,
            tail=0.0,
            max_iterations=300,
            relaxation=1.0,
        )
    assert not caught.value.run.converged and not np.isfinite(caught.value.run.changes[-1])
    assert caught.value.run.iterations < 300


def test_a_vehicle_without_weight_on_the_rail_converges_by_its_lateral_forces():
    body = Body("mass", 1e4, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("y",))
    car = Vehicle(
        "lateral", (body,), (Spring("mass", "rail", (0.0, 0.0, 0.0), (1e6, 0.0), (1e4, 0.0)),), 10.0
    )
    track = rb.Track(lateral=rb.Harmonic(1e-3, wavelength=10.0))
    run = rb.cross(rb.Train(car), rb.deck("viaduct36"), track, speed=20.0, tail=0.0)
    assert run.converged and run.iterations > 2
    assert 0.0 < run.changes[-1] < 1e-8
