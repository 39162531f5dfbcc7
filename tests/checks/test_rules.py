"""What the rules say before any train runs."""

import pytest

import railbridge as rb
from railbridge.checks.questions import Questions
from railbridge.checks.rules import coverage, line_gaps, rules, speed_gaps
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
        ((40.0, 45.0, 50.0, 55.0, 60.0), True),
        ((40.0 + 1e-12, 45.0, 50.0, 55.0, 60.0 - 1e-12), True),
        ((38.0, 43.0, 48.0, 53.0, 58.0, 63.0), True),
        ((40.1, 45.0, 50.0, 55.0, 60.0), False),
        ((40.0, 45.0, 50.0, 55.0, 59.9), False),
        # Steps of more than 5 m/s pass over resonances.
        ((40.0, 45.0, 50.0, 55.1, 60.0), False),
        ((40.0, 60.0), False),
    ],
)
def test_speeds_reach_from_40_to_one_fifth_above_the_line(speeds, covered):
    assert bool(answers(speeds=speeds)["speeds_covered"]) is covered


def test_speeds_that_were_chosen_beside_peaks_may_lie_apart():
    found = answers()
    assert "steps of up to 20 m/s pass over resonances" in found["speeds_covered"].reason
    assert bool(coverage(found, (40.0, 60.0), chosen=True))


def gaps(speeds, line_speed=160 / 3.6, **more):
    return speed_gaps(answers(speeds=speeds, line_speed=line_speed, **more), speeds, line_speed)


def test_speeds_are_asked_for_where_an_analysis_may_be_needed():
    short = (40.0, 50.0)
    assert gaps(short) == ()  # not needed
    (gap,) = gaps(short, 70.0)
    assert "40 to 50 m/s do not cover 40 to 84 m/s" in gap
    assert "only 40 m/s do not cover" in gaps((40.0,), 70.0)[0]
    assert gaps((*range(40, 84, 5), 84.0), 70.0) == ()
    assert "pass over" in gaps((40.0, 84.0), 70.0)[0]
    # Undecided is not "no"; and below 120 km/h the clause names no speeds.
    assert gaps(short, simple=False, determinant_length=36.0)
    assert "outside" in gaps(short, 30.0, stiffness=2e10)[0]


def test_where_no_analysis_is_needed_speeds_reach_that_of_the_line():
    assert gaps((5.0, 44.4)) == ("speeds: 44.4 m/s does not reach the line's 44.44 m/s",)
    assert gaps((5.0, 160 / 3.6)) == () == gaps((80.0,))


def test_a_crossing_near_the_speed_of_the_line_stands_for_it():
    assert line_gaps((5.0, 95.0), 100.0) == () == line_gaps((101.0,), 100.0)
    (gap,) = line_gaps((40.0, 94.9, 120.0), 100.0)
    assert "94.9 m/s is the fastest up to the line's 100 m/s, give one from 95 m/s on" in gap
