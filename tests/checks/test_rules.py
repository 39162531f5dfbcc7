"""What the rules say before any train runs."""

import pytest

import railbridge as rb
from railbridge.checks.questions import Questions
from railbridge.checks.rules import coverage, rules, speed_gaps
from railbridge.checks.structure import Structure


def answers(stiffness=8.8e10, modes=8, speeds=(40.0, 60.0), **needs):
    deck = rb.Beam("beam", (36.0,), 11850.0, stiffness).deck(modes, 0.01)
    own = Structure(deck, rb.Requirements(**({"line_speed": 50.0} | needs)))
    found = rules(own, Questions(own))
    return found | {"speeds_covered": coverage(found, speeds)}


def test_numbers_are_those_of_the_clauses():
    found = answers(line_speed=27.778, kind="steel")
    # The published values for (L, n0, v) = (36, 3.307, 27.778); this n0 is 3.3029 Hz.
    assert float(found["phi_prime"]) == pytest.approx(0.13204, abs=5e-4)
    assert float(found["phi_double_prime"]) == pytest.approx(0.00956, abs=1e-4)
    half = float(found["phi_double_prime"]) / 2
    assert float(found["track_factor"]) == pytest.approx(1.0 + half)
    assert float(found["n0_lower_bound"]) == pytest.approx(2.8263, abs=1e-4)
    assert float(found["n0_upper_bound"]) == pytest.approx(6.4940, abs=1e-4)
    assert float(found["damping_lower_bound"]) == 0.005
    assert bool(found["n0_within_bounds"]) and not bool(found["dynamic_analysis_needed"])
    assert "phi3" in found and "phi2" in answers(careful_track=True)
    assert found["frequency_limit"].unit == "Hz"


def test_a_soft_deck_is_outside_and_needs_an_analysis():
    found = answers(stiffness=2e10)
    assert not bool(found["n0_within_bounds"]) and bool(found["dynamic_analysis_needed"])
    assert found["phi_prime"].value is None


def test_what_is_not_simple_is_not_decided():
    found = answers(simple=False, determinant_length=36.0)
    assert found["dynamic_analysis_needed"].value is None
    assert bool(found["n0_within_bounds"])
    unknown = answers(simple=False)
    assert "determinant_length" in unknown["dynamic_analysis_needed"].reason
    assert unknown["damping_lower_bound"].value is None


def test_a_kind_that_is_not_given_is_said():
    assert "(kind)" in answers()["damping_lower_bound"].reason


@pytest.mark.parametrize(
    ("speeds", "covered"),
    [
        ((40.0, 60.0), True),
        ((40.0 + 1e-12, 60.0 - 1e-12), True),
        ((30.0, 50.0, 70.0), True),
        ((40.1, 60.0), False),
        ((40.0, 59.9), False),
    ],
)
def test_speeds_reach_from_40_to_one_fifth_above_the_line(speeds, covered):
    assert bool(answers(speeds=speeds)["speeds_covered"]) is covered


def test_speeds_are_asked_for_where_an_analysis_may_be_needed():
    short = (40.0, 50.0)
    assert speed_gaps(answers(speeds=short)) == ()  # not needed
    (gap,) = speed_gaps(answers(speeds=short, line_speed=70.0))
    assert "40 to 50 m/s do not cover 40 to 84 m/s" in gap
    assert speed_gaps(answers(speeds=(40.0, 84.0), line_speed=70.0)) == ()
    # Undecided is not "no"; and below 120 km/h the clause names no speeds.
    assert speed_gaps(answers(speeds=short, simple=False, determinant_length=36.0))
    assert "outside" in speed_gaps(answers(stiffness=2e10, line_speed=30.0))[0]
