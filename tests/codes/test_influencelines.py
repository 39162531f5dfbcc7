"""Influence lines of load models against the deck's own, and their integrals against sums."""

import numpy as np
import pytest
from scipy.integrate import trapezoid

import railbridge as rb
from railbridge.codes.influencelines import InfluenceLine, influence_line

DECK = rb.Beam("two", (20.0, 30.0), 1e4, 5e9, torsional_stiffness=4e9, polar_inertia=5e4).deck(6)
X = np.linspace(0.013, 49.987, 3001)


@pytest.mark.parametrize(
    ("quantity", "at"),
    [("moment_vertical", 8.0), ("shear_vertical", 25.3), ("force_z", 20.0), ("torsion", 12.0)],
)
def test_values_are_those_of_the_deck_under_a_load_downwards(quantity, at):
    line = influence_line(DECK, quantity, at, y=2.0)
    expected = -DECK.influence(quantity, at=at, places=X, load="z")
    expected -= 2.0 * DECK.influence(quantity, at=at, places=X, load="roll")
    assert line.value(X) == pytest.approx(expected, abs=1e-12 * np.abs(expected).max())
    assert not line.value(np.array([-0.1, 50.1])).any()


def test_integrals_are_those_of_the_values():
    line = influence_line(DECK, "moment_vertical", 8.0)
    ends = np.array([-5.0, 0.0, 3.3, 20.0, 31.7, 49.0, 50.0, 60.0])
    for turned in (line, line.times(-1.0)):
        for low in ends[:4]:
            for high in ends[4:]:
                x = np.linspace(low, high, 100_001)
                values = turned.value(x)
                places = np.array([low]), np.array([high])  # as load models ask
                expected = trapezoid(values, x), trapezoid(np.maximum(values, 0.0), x)
                found = turned.integral(*places)[0], turned.positive_integral(*places)[0]
                assert found == pytest.approx(expected, rel=1e-5, abs=1e-4)
        whole = turned.positive_integral(np.array([-5.0]), np.array([60.0]))[0]
        assert turned.all_positive == pytest.approx(whole)


def test_a_line_is_cut_where_it_changes_sign_inside_a_piece():
    # (s - 1/4)(s - 1/2)(s - 1) on 8 m, then a step to -1.
    cubic = np.polynomial.polynomial.polyfromroots([0.25, 0.5, 1.0])
    line = InfluenceLine(np.array([0.0, 8.0, 10.0]), np.array([cubic, [-1.0, 0, 0, 0]]))
    assert line.positive_stretches() == [pytest.approx((2.0, 4.0))]
    assert line.times(-1.0).positive_stretches() == [
        pytest.approx((0.0, 2.0)), pytest.approx((4.0, 10.0))
    ]  # fmt: skip
    assert line.positive_stretches((2.5, 3.0)) == [
        pytest.approx((2.0, 2.5)), pytest.approx((3.0, 4.0))
    ]  # fmt: skip
    assert line.positive_stretches((0.0, 9.0)) == []
    x = np.linspace(0.0, 10.0, 997)
    for turned in (line, line.times(-1.0)):
        cut = turned.positive.value(x)
        assert cut == pytest.approx(np.maximum(turned.value(x), 0.0), abs=1e-12)


def test_what_a_deck_cannot_tell_is_refused_by_name():
    with pytest.raises(rb.InputError, match="quantity"):
        influence_line(DECK, "moment", 8.0)
    with pytest.raises(rb.InputError, match="no such stiffness or bearing there"):
        influence_line(DECK, "force_z", 8.0)
    with pytest.raises(rb.InputError, match="at = 51"):
        influence_line(DECK, "moment_vertical", 51.0)
