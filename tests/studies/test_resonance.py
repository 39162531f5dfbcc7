"""Speeds and bounds of resonance, against sums written out and the computed peaks."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies.constant import constant_loads
from railbridge.studies.outputs import outputs_at
from railbridge.studies.resonance import (
    first_vertical_mode,
    repeated_distance,
    residual_acceleration,
    resonance_speeds,
)

L, MU, EI = 25.0, 15e3, 3.1e10


def deck(modes=1, damping=0.01, **more):
    return rb.Beam("simple", (L,), MU, EI, **more).deck(modes=modes, damping=damping)


@pytest.mark.parametrize(
    ("name", "distance"), [("HSLM-A1", 18.0), ("HSLM-A5", 22.0), ("HSLM-A10", 27.0)]
)
def test_coaches_of_hslm_repeat_at_their_length(name, distance):
    assert repeated_distance(rb.train(name)) == distance


def test_cars_repeat_at_their_spacing_and_one_axle_at_nothing():
    assert repeated_distance(rb.Train(rb.vehicle("xia2000"), cars=4, car_spacing=22.5)) == 22.5
    assert repeated_distance(rb.AxleTrain((0.0,), (1e5,))) is None


def test_resonance_speeds_are_frequency_times_distance_over_whole_numbers():
    own, train = deck(), rb.train("HSLM-A1")
    f = own.frequencies_hz[0]
    expected = [f * 18.0 / i for i in (3, 2, 1) if 20.0 <= f * 18.0 / i <= 90.0]
    assert resonance_speeds(own, train, 20.0, 90.0) == pytest.approx(expected)
    assert resonance_speeds(own, train, f * 9.0, f * 18.0) == pytest.approx([f * 9.0, f * 18.0])
    assert len(resonance_speeds(own, train, f * 18.1, f * 19.0)) == 0


def test_the_first_vertical_mode_is_not_always_the_first():
    own = deck(modes=4, bending_stiffness_lateral=1e9)
    mode = first_vertical_mode(own)
    assert own.mode_names[mode].startswith("vertical") and mode > 0


def test_the_bound_is_the_sum_written_out():
    """The formulas axle by axle, with complex numbers, for one speed."""
    own, train, v = deck(), rb.train("HSLM-A3"), 53.0
    f, z = own.frequencies_hz[0], own.damping_ratios[0]
    K, lam = v / (2 * L * f), v / f
    A = abs(K / (1 - K**2)) * np.sqrt(
        1 + np.exp(-2 * np.pi * z / K) + 2 * np.exp(-np.pi * z / K) * np.cos(np.pi / K)
    )
    G = max(
        abs(
            sum(
                P * np.exp(2j * np.pi * (xk - x) / lam) * np.exp(-2 * np.pi * z * (xk - x) / lam)
                for x, P in zip(train.axles[: k + 1], train.loads, strict=False)
            )
        )
        for k, xk in enumerate(train.axles)
    )
    found = residual_acceleration(own, train, np.array([v]))
    assert found[0] == pytest.approx(2 / (MU * L) * A * G, rel=1e-10)


@pytest.mark.parametrize("name", ["HSLM-A1", "HSLM-A4", "HSLM-A8"])
def test_it_bounds_what_is_left_behind_and_comes_near(name):
    """At resonance the peak of the first mode lies at it or a little below."""
    own, train = deck(), rb.train(name)
    f = own.frequencies_hz[0]
    speeds = np.linspace(f * 16.0, f * 28.0, 121)
    output = outputs_at(own, ("acceleration_z",), [L / 2])
    peaks = constant_loads(own, train, speeds, output).largest[:, 0]
    bound = residual_acceleration(own, train, speeds)
    worst = np.argmax(peaks)
    # A little more than the bound where the peak comes while the last axles are on the deck.
    assert 0.96 < peaks[worst] / bound[worst] < 1.01
    assert abs(worst - np.argmax(bound)) <= 1


@pytest.mark.parametrize(
    ("span", "stiffness", "name", "above"),
    [(25.0, 3.1e10, "HSLM-A10", 0.03), (40.0, 1.2e11, "HSLM-A9", -0.11)],
)
def test_it_is_an_estimate_and_no_bound(span, stiffness, name, above):
    """The two ends of what the module says of HSLM-A."""
    own = rb.Beam("simple", (span,), MU, stiffness).deck(modes=1, damping=0.01)
    train = rb.train(name)
    f, d = own.frequencies_hz[0], repeated_distance(train)
    speeds = np.linspace(0.9 * f * d, 1.1 * f * d, 161)
    output = outputs_at(own, ("acceleration_z",), [span / 2])
    peaks = constant_loads(own, train, speeds, output).largest[:, 0]
    worst = np.argmax(peaks)
    found = residual_acceleration(own, train, speeds)[worst] / peaks[worst] - 1.0
    assert found == pytest.approx(above, abs=5e-3)


def test_nothing_is_said_where_the_formula_divides_by_nothing():
    own, train = deck(), rb.AxleTrain((0.0,), (1e5,))
    critical = 2 * L * own.frequencies_hz[0]
    found = residual_acceleration(own, train, critical * np.array([0.98, 1.0, 1.02]))
    assert np.isnan(found).tolist() == [False, True, False]


def test_where_it_does_not_apply():
    two = rb.Beam("two", (20.0, 20.0), MU, EI).deck(modes=2, damping=0.01)
    assert residual_acceleration(two, rb.train("HSLM-A1"), np.array([50.0])) is None


def test_a_heavy_mass_at_one_place_is_no_uniform_beam():
    def found(mass):
        beam = rb.Beam("beam", (L,), MU, EI, point_masses=(rb.PointMass(L / 2, mass),))
        own = beam.deck(modes=2, damping=0.01)
        return residual_acceleration(own, rb.train("ICE2"), np.array([50.0]))

    assert found(0.2 * MU * L) is None
    assert found(0.001 * MU * L) > 0.0
