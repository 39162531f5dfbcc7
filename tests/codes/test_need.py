"""Need of a dynamic analysis: every branch that is decided, and that the rest never passes."""

import itertools

import pytest

import railbridge as rb
from railbridge.codes import analysis_speeds, dynamic_analysis_needed, n0_bounds

KMH = 1 / 3.6
YES, NO, UNDECIDED = True, False, None


@pytest.mark.parametrize(
    ("L", "n0", "kmh", "simple", "needed"),
    [
        (10, 10.0, 160, True, NO),
        (10, 10.0, 200, True, NO),
        (10, 10.0, 200.01, True, YES),
        (10, 7.99, 160, True, YES),
        (10, 8.0, 160, True, NO),
        (10, 16.94, 160, True, YES),
        (4, 20.0, 160, True, NO),
        (3.99, 20.0, 160, True, UNDECIDED),
        (100, 2.0, 160, True, NO),
        (100.1, 2.0, 160, True, UNDECIDED),
        (3.0, 20.0, 250, True, YES),
        (10, 10.0, 160, False, UNDECIDED),
        (10, 7.0, 160, False, UNDECIDED),
        (10, 10.0, 250, False, YES),
        (50, 3.0, 300, True, YES),
    ],
)
def test_branches(L, n0, kmh, simple, needed):
    answer = dynamic_analysis_needed(L, n0, kmh * KMH, simple=simple)
    assert answer.value is needed and answer.reason
    if needed is None:
        with pytest.raises(rb.codes.CannotDecideError, match="cannot decide"):
            bool(answer)
    else:
        assert bool(answer) is needed


def test_it_says_no_only_where_two_sources_do():
    grid = itertools.product((2, 4, 9, 35, 100, 120), (1, 3, 5, 9, 25), (20, 55, 56), (True, False))
    for L, n0, v, simple in grid:
        if dynamic_analysis_needed(L, n0, v, simple=simple).value is False:
            lower, upper = map(float, n0_bounds(L))
            assert simple and v < 55.6 and 4 <= L <= 100 and lower <= n0 <= upper


@pytest.mark.parametrize(
    ("v", "fastest"), [(100 / 3, 40.0), (120 * KMH, 40.0), (50, 60.0), (100, 120)]
)
def test_speeds_of_the_analysis(v, fastest):
    slow, fast = analysis_speeds(v)
    assert float(slow) == 40.0 and float(fast) == pytest.approx(fastest) and float(fast) >= 40.0
    assert "from memory" in repr(slow) and slow.unit == "m/s"


def test_a_slow_line_has_no_speeds():
    for answer in analysis_speeds(33.3):
        assert not answer.decided and "33.33 m/s (120 km/h) <= v" in answer.reason


@pytest.mark.parametrize(
    ("given", "field"),
    [((0, 5, 30), "L"), ((10, "5", 30), "n0"), ((10, 5, -1), "v"), ((10, None, 99), "n0")],
)
def test_bad_numbers_are_refused_before_a_branch_is_taken(given, field):
    with pytest.raises(rb.InputError) as error:
        dynamic_analysis_needed(*given)
    assert error.value.field == field and error.value.remedy
    with pytest.raises(rb.InputError, match=r"^simple\b"):
        dynamic_analysis_needed(10, 10, 90, simple="yes")
    with pytest.raises(rb.InputError, match=r"^v\b"):
        analysis_speeds(-1.0)
