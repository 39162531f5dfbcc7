"""Damping: the values of the sources, both sides of 20 m and 30 m, and what is refused."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.codes import (
    DAMPING,
    additional_damping,
    damping_limit,
    damping_lower_bound,
    damping_ratio,
    judge,
)

# Per cent at 5, 10, 15, 20 and 60 m, by hand: 0.5 + 0.125 x 15 = 2.375 and so on.
BY_HAND = {
    "steel": (2.375, 1.75, 1.125, 0.5, 0.5),
    "composite": (2.375, 1.75, 1.125, 0.5, 0.5),
    "prestressed concrete": (2.05, 1.7, 1.35, 1.0, 1.0),
    "filler beam": (2.55, 2.2, 1.85, 1.5, 1.5),
    "reinforced concrete": (2.55, 2.2, 1.85, 1.5, 1.5),
}


@pytest.mark.parametrize("kind", BY_HAND)
def test_lower_bounds_by_hand(kind):
    found = [100 * float(damping_lower_bound(kind, L)) for L in (5, 10, 15, 20, 60)]
    assert found == pytest.approx(BY_HAND[kind], rel=1e-12)
    near = [float(damping_lower_bound(kind, L)) for L in (19.99, 20.0, 20.01)]
    assert near[0] > near[1] == near[2]


def test_all_kinds_are_compared():
    assert set(BY_HAND) == set(DAMPING)


@pytest.mark.parametrize(("L", "percent"), [(10, 0.32888), (15, 0.65272), (20, 0.29648)])
def test_additional_damping_at_the_values_of_the_sources(L, percent):
    assert 100 * float(additional_damping(L)) == pytest.approx(percent, abs=5.1e-6)


def test_additional_damping_is_cut_at_zero_and_ends_at_30_m():
    # The numerator L (0.0187 - 0.00064 L) changes its sign at 29.21875 m.
    assert float(additional_damping(29.21)) > 0.0
    assert [float(additional_damping(L)) for L in (29.22, 29.5, 29.999)] == [0.0, 0.0, 0.0]
    for L in (30.0, 30.001, 80.0):
        answer = additional_damping(L)
        assert not answer.decided and "0 m < L < 30 m" in answer.reason
    assert 0.0 < float(additional_damping(0.1)) < 1e-4


def test_additional_damping_is_off_unless_it_is_asked_for():
    lower = float(damping_lower_bound("steel", 15.0))
    assert float(damping_ratio("steel", 15.0)) == lower
    assert float(damping_ratio("steel", 15.0, vehicles=True)) == lower
    more = damping_ratio("steel", 15.0, additional=True)
    assert float(more) == pytest.approx(lower + 0.0065272, abs=1e-7)
    assert not damping_ratio("steel", 30.0, additional=True).decided
    assert damping_ratio("steel", 30.0).decided


def test_additional_damping_is_refused_with_vehicles():
    with pytest.raises(rb.InputError, match=r"^additional = True: must be false with vehicles.*Le"):
        damping_ratio("steel", 15.0, additional=True, vehicles=True)


@pytest.mark.parametrize("bad", [0, -1, None, "10", True, np.nan, np.inf])
def test_bad_lengths(bad):
    for call in (
        lambda: damping_lower_bound("steel", bad),
        lambda: additional_damping(bad),
        lambda: damping_ratio("steel", bad, additional=True),
    ):
        with pytest.raises(rb.InputError, match=r"^L\b.*above 0 m\. Give the span"):
            call()


@pytest.mark.parametrize("kind", ["stel", None, "wood", 1])
def test_another_material_is_refused(kind):
    with pytest.raises(rb.InputError, match=r"^kind\b.*steel, composite, prestressed concrete"):
        damping_lower_bound(kind, 10.0)


@pytest.mark.parametrize("field", ["additional", "vehicles"])
def test_choices_are_true_or_false(field):
    with pytest.raises(rb.InputError, match=rf"^{field} = 1: must be true or false"):
        damping_ratio("steel", 10.0, **{field: 1})


def test_a_deck_may_have_what_is_the_lower_bound_or_was_measured():
    assert float(damping_limit("steel", 10.0)) == float(damping_lower_bound("steel", 10.0))
    assert float(damping_limit("steel", 10.0, 0.03)) == 0.03
    assert float(damping_limit(None, 10.0, 0.004)) == 0.004
    unknown = damping_limit(None, 10.0)
    assert not unknown.decided and "filler beam" in unknown.reason
    assert judge(0.0176, damping_limit("steel", 10.0)).verdict == "not met"
    assert judge(0.0175, damping_limit("steel", 10.0)).verdict == "met"
    with pytest.raises(rb.InputError, match="measured"):
        damping_limit("steel", 10.0, 0.0)
    with pytest.raises(rb.InputError, match="kind"):
        damping_limit("stone", 10.0)
