"""Train and deck solved together: the limit of the fixed point, and the coupled differential
equations."""

from dataclasses import replace

import numpy as np
import pytest
from reference import one_planar_car

import railbridge as rb

WAVES = {"vertical": {"kind": "harmonic", "amplitude": 5e-3, "wavelength": 14.4}}
PAPER = rb.case("paper").replace({"run.loads": "wheels", "run.tolerance": 1e-10, "train.cars": 1})
# Level track before the deck and a plane car on the axis: what the reference solves.
PLANE = PAPER.replace(
    {
        "train.vehicle": "xia2000_planar",
        "train.track": 0.0,
        "track": WAVES,
        "run.lead_in": 0.0,
        "run.tail": 0.2,
        "deck.modes": 4,
    }
)
VERTICAL = sum(name.startswith("vertical") for name in PLANE.deck.mode_names)


def mid_span(run):
    return run.displacement(18.0, kept_only=True)["displacement_z"]


def error(run, reference):
    return np.max(np.abs(mid_span(run) - reference)) / np.max(np.abs(reference))


@pytest.fixture(scope="module")
def reference():
    """Mid-span displacement at 20 m/s every millisecond."""
    case = PLANE.replace({"run.interaction": "rigid"})
    return one_planar_car(20.0, VERTICAL, case.run().time, 5e-3, 14.4)


@pytest.mark.parametrize(
    "changes", [{}, {"train.cars": 2}, {"run.speed": 60.0}, {"run.lead_in": 0.0}]
)
def test_direct_is_the_limit_of_the_fixed_point(changes):
    case = PAPER.replace({"run.time_step": 2e-3, **changes})
    together = case.replace({"run.interaction": "direct"}).run()
    iterated = case.run()
    assert iterated.converged
    forces, dynamic = (
        together.wheel_forces,
        together.wheel_forces - together.wheel_forces.mean(axis=2, keepdims=True),
    )
    assert np.max(np.abs(forces - iterated.wheel_forces)) < 1e-8 * np.max(np.abs(dynamic))
    assert np.max(np.abs(mid_span(together) - mid_span(iterated))) < 1e-8 * np.max(
        np.abs(mid_span(iterated))
    )


def test_direct_solves_the_coupled_equations(reference):
    run = PLANE.replace({"run.interaction": "direct"}).run()
    middle, exerted = reference
    assert error(run, middle) < 1e-5
    # Where an axle meets the end of the deck its force jumps; two samples there belong to either
    # side.
    calm = np.ones(len(run.time), dtype=bool)
    for wheel in run.train.wheels:
        for event in (wheel.delay / 20.0, (wheel.delay + 36.0) / 20.0):
            calm &= np.abs(run.time - event) > 2.5e-3
    difference = (run.wheel_forces[:, 1] - exerted)[:, calm]
    # The waves start with a break at the entrance: the damper's jump of 1.3 kN falls half a sample
    # early or late, which shakes the bogie by some 30 N. Everything else is smaller.
    dynamic = np.max(np.abs(exerted + PLANE.train.wheels[0].static_load))
    assert np.max(np.abs(difference)) < 2.5e-3 * dynamic
    assert np.sqrt(np.mean(difference**2)) < 5e-4 * dynamic


def test_each_pass_comes_closer_to_the_coupled_equations(reference):
    run = PLANE.run()
    errors = [error(run.at(i), reference[0]) for i in range(4)]
    assert errors[0] > 5e-3
    assert errors[1] < errors[0] / 5
    assert errors[2] < errors[1] / 5
    assert errors[3] < 2e-5


def test_displacement_converges_with_the_square_of_the_step():
    steps = np.array([4e-3, 2e-3, 1e-3, 5e-4])
    case = PLANE.replace({"run.speed": 90.0, "run.interaction": "direct"})
    errors = []
    for step in steps:
        run = case.replace({"run.time_step": float(step)}).run()
        errors.append(error(run, one_planar_car(90.0, VERTICAL, run.time, 5e-3, 14.4)[0]))
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert 1.7 < order < 2.4, errors


def test_the_climb_along_the_deflected_deck_is_there():
    """At 90 m/s the reference without the convective term differs by far more than the method's own
    error."""
    run = PLANE.replace({"run.speed": 90.0, "run.interaction": "direct"}).run()
    middle, exerted = one_planar_car(90.0, VERTICAL, run.time, 5e-3, 14.4)
    without = one_planar_car(90.0, VERTICAL, run.time, 5e-3, 14.4, climb=False)[0]
    assert np.max(np.abs(without - middle)) > 20 * np.max(np.abs(mid_span(run) - middle))


@pytest.mark.parametrize("feedback", ["all", "vertical"])
@pytest.mark.parametrize("loads", ["wheels", "bogies", "condensed"])
def test_every_way_of_loading_can_be_solved_directly(loads, feedback):
    case = PAPER.replace(
        {"run.time_step": 2e-3, "train.cars": 2, "run.loads": loads, "run.feedback": feedback}
    )
    together = case.replace({"run.interaction": "direct"}).run()
    iterated = case.replace({"run.interaction": "iterate"}).run()
    size = np.max(np.abs(iterated.wheel_forces - iterated.wheel_forces.mean(axis=2)[..., None]))
    assert np.max(np.abs(together.wheel_forces - iterated.wheel_forces)) < 1e-8 * size


def test_bare_axles_are_the_same_solved_either_way():
    tables = {"train": {"axles": [0.0, 2.5], "loads": [1e5, 1e5]}, "track": {}}
    runs = [PAPER.replace({**tables, "run.interaction": i}).run() for i in ("direct", "rigid")]
    assert np.array_equal(mid_span(runs[0]), mid_span(runs[1]))


@pytest.mark.parametrize("compiles", [True, False])
def test_modes_that_loads_do_not_move_are_no_obstacle(compiles, monkeypatch):
    """As of another program's deck: its last mode does not touch the rails."""
    if not compiles:
        monkeypatch.setattr("railbridge.direct.solution.has_compiler", lambda: False)
    deck = rb.Beam("beam", (20.0,), 8e3, 5e9).deck(3, 0.02)
    shapes = replace(deck.shapes, coefficients=deck.shapes.coefficients.copy())
    shapes.coefficients[:, :, -1] = 0.0
    still = replace(deck, shapes=shapes)
    train = rb.Train(rb.planar_car(rb.vehicle("xia2000")))
    runs = [rb.cross(train, still, speed=30.0, interaction=i) for i in ("direct", "iterate")]
    assert np.array_equal(runs[0].state.q[-1], np.zeros(len(runs[0].time)))
    apart = np.abs(runs[0].wheel_forces - runs[1].wheel_forces).max()
    assert apart < 1e-8 * train.wheels[0].static_load
