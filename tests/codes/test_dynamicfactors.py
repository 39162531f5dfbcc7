"""Dynamic factors: tables written out by hand, the points of two sources, every border."""

from fractions import Fraction

import numpy as np
import pytest

import railbridge as rb
from railbridge.codes import (
    determinant_length,
    dynamic_effect,
    dynamic_effect_limit,
    judge,
    phi2,
    phi3,
    phi_double_prime,
    phi_prime,
    real_train_factor,
    reduced_for_cover,
    track_factor,
)
from railbridge.codes.dynamicfactors import _passage

# By hand from 144/(100 (r - 1/5)) + 82/100 and 216/(100 (r - 1/5)) + 73/100 with r^2 = L: the
# quotients are 144/180, 144/280 ... of whole numbers.
BY_HAND = """
1    1.67         2.00
4    1.62         1.93
9    1.334285714  1.501428571
16   1.198947368  1.298421053
25   1.12         1.18
36   1.068275862  1.102413793
49   1.031764706  1.047647059
64   1.004615385  1.006923077
81   1.00         1.00
100  1.00         1.00
"""
ROWS = [tuple(map(float, row.split())) for row in BY_HAND.strip().splitlines()]


@pytest.mark.parametrize(("L", "two", "three"), ROWS, ids=lambda x: f"{x:g}")
def test_table_by_hand(L, two, three):
    assert float(phi2(L)) == pytest.approx(two, abs=6e-10)
    assert float(phi3(L)) == pytest.approx(three, abs=6e-10)


@pytest.mark.parametrize(
    ("L", "two", "three"), [(10, 1.3061, 1.4592), (20, 1.1571, 1.2356), (100, 1.0, 1.0)]
)
def test_values_of_two_sources(L, two, three):
    assert [float(phi2(L)), float(phi3(L))] == pytest.approx([two, three], abs=5e-5)


@pytest.mark.parametrize(
    ("phi", "rise", "base", "most"), [(phi2, 1.44, 0.82, 1.67), (phi3, 2.16, 0.73, 2.0)]
)
def test_where_the_bounds_of_phi_begin(phi, rise, base, most):
    for bound, side in ((most, 1), (1.0, -1)):
        edge = (rise / (bound - base) + 0.2) ** 2
        beyond, inside = float(phi(edge - side * 1e-3)), float(phi(edge + side * 1e-3))
        assert beyond == bound and (bound - inside) * side > 0.0
    assert float(phi(0.0401)) == most
    for L in (0.04, 0.03, 1e-6):
        assert not phi(L).decided and "0.04 m < L" in phi(L).reason
    assert float(phi(1e6)) == 1.0


@pytest.mark.parametrize(
    ("spans", "length"),
    [
        ([20.0], 20.0), ([20, 20], 24.0), ([20, 30, 20], 1.3 * 70 / 3), ([10.0] * 4, 14.0),
        ([10.0] * 5, 15.0), ([10.0] * 9, 15.0), ([10, 50, 10], 50.0), ((36.0,), 36.0),
    ],
)  # fmt: skip
def test_determinant_lengths(spans, length):
    assert float(determinant_length(spans)) == pytest.approx(length, rel=1e-12)
    assert determinant_length(spans).unit == "m"


@pytest.mark.parametrize(
    ("phi", "cover", "reduced"),
    [(1.4, 0.0, 1.4), (1.4, 1.0, 1.4), (1.4, 1.001, 1.3999), (1.4, 3.0, 1.2), (1.4, 9.0, 1.0)],
)
def test_cover_reduces(phi, cover, reduced):
    assert float(reduced_for_cover(phi, cover)) == pytest.approx(reduced, rel=1e-12)
    assert [reduced_for_cover(p, 2.0).decided for p in (0.99, 1.0, 2.0, 2.01)] == [
        False, True, True, False,
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("L", "n0", "v", "first", "second"),
    [(10, 10, 50, 0.33161, 0.30336), (36, 3.307, 27.778, 0.13204, 0.00956)],
)
def test_annex_c_at_the_points_of_two_sources(L, n0, v, first, second):
    assert float(phi_prime(L, n0, v)) == pytest.approx(first, abs=5.1e-6)
    assert float(phi_double_prime(L, n0, v)) == pytest.approx(second, abs=5.1e-6)


@pytest.mark.parametrize(("L", "n0", "v"), [(10, 10, 50), (8, 12, 30), (25, 4, 40), (36, 3, 55)])
def test_phi_prime_from_whole_numbers(L, n0, v):
    k = Fraction(v, 2 * L * n0)
    assert float(phi_prime(L, n0, v)) == pytest.approx(float(1 / (1 / k - 1 + k**3)), rel=1e-12)


def test_phi_prime_is_cut_at_0_76_where_it_is_1_325():
    below, at = _passage(1.0, 0.5, 0.76 - 1e-9), _passage(1.0, 0.5, 0.76)
    assert at == 1.325 == _passage(1.0, 0.5, 3.0) and below == pytest.approx(1.325, abs=1e-3)
    assert below != at


# exp by its series to 40 terms, alpha by hand.
def exponential(x):
    term, total = Fraction(1), Fraction(1)
    for i in range(1, 41):
        term *= Fraction(x) / i
        total += term
    return total


@pytest.mark.parametrize(
    ("L", "n0", "v", "alpha"),
    [(10, 12, 11, Fraction(1, 2)), (10, 12, 22, 1), (10, 12, 44, 1), (4, 20, 11, Fraction(1, 2))],
)
def test_phi_double_prime_by_series(L, n0, v, alpha):
    short, long = (1 / exponential(Fraction(L, d) ** 2) for d in (10, 20))
    exact = alpha * (56 * short + 50 * (Fraction(L * n0, 80) - 1) * long) / 100
    assert float(phi_double_prime(L, n0, v)) == pytest.approx(float(exact), rel=1e-11)


def test_phi_double_prime_is_never_negative():
    # Within Figure 6.10 L n0 is 80 or more, so the second summand never is, either.
    for L in np.linspace(4.0, 100.0, 33):
        lower = float(rb.codes.n0_bounds(L).lower)
        assert float(phi_double_prime(L, lower, 30.0)) >= 0.0


LIMIT = 200 / 3.6


@pytest.mark.parametrize("rule", [phi_prime, phi_double_prime, real_train_factor])
def test_annex_c_ends_at_200_kmh_and_at_the_figure(rule):
    for v, decided in ((0.0, True), (55.5555, True), (LIMIT, True), (55.556, False), (90, False)):
        assert rule(10, 10, v).decided is decided, v
    assert "(200.002 km/h) is outside v <= 55.56 m/s (200 km/h)" in rule(10, 10, 55.556).reason
    for n0, decided in ((7.99, False), (8.0, True), (16.92, True), (16.94, False)):
        assert rule(10, n0, 30.0).decided is decided, n0
    for L, n0, decided in ((3.99, 20, False), (4, 20, True), (100, 2, True), (100.1, 2, False)):
        assert rule(L, n0, 30.0).decided is decided, L
    assert "speed limit" in rule.clause.memory and "from memory" in repr(rule(10, 10, 20))


def test_factors_are_sums():
    L, n0, v = 12.0, 9.0, 40.0
    first, second = float(phi_prime(L, n0, v)), float(phi_double_prime(L, n0, v))
    assert second > 0.1
    assert float(real_train_factor(L, n0, v)) == pytest.approx(1 + first + second, rel=1e-14)
    half = real_train_factor(L, n0, v, maintained=True)
    assert float(half) == pytest.approx(1 + first + second / 2, rel=1e-14)
    assert float(track_factor(L, n0, v)) == pytest.approx(1 + second / 2, rel=1e-14)
    bad = track_factor(L, n0, v, maintained=False)
    assert float(bad) == pytest.approx(1 + second, rel=1e-14)
    # A dynamic analysis is asked for above 200 km/h.
    assert float(track_factor(L, n0, 97.0)) == float(track_factor(L, n0, 22.0))
    assert not track_factor(L, 30.0, v).decided and not track_factor(101.0, 2.0, v).decided


BAD = [0, -5, None, "5", True, np.nan, np.inf, [3.0]]


@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize("rule", [phi_prime, phi_double_prime, real_train_factor, track_factor])
def test_bad_numbers_are_refused_by_name(rule, bad):
    with pytest.raises(rb.InputError, match=r"^L\b.*above 0 m\. Give the span"):
        rule(bad, 10.0, 20.0)
    with pytest.raises(rb.InputError, match=r"^n0\b.*above 0 Hz\. Give"):
        rule(10.0, bad, 20.0)
    if bad != 0 or bad is True:
        with pytest.raises(rb.InputError, match=r"^v\b.*at least 0 m/s\. Divide km/h by 3\.6"):
            rule(10.0, 10.0, bad)


@pytest.mark.parametrize("bad", BAD)
def test_bad_lengths_of_phi(bad):
    for rule in (phi2, phi3):
        with pytest.raises(rb.InputError, match=r"^L\b.*above 0 m\. Give the span"):
            rule(bad)


def test_other_refusals():
    for spans in ([], 20.0, [20.0, 0.0], ["a"]):
        with pytest.raises(rb.InputError, match=r"^spans"):
            determinant_length(spans)
    with pytest.raises(rb.InputError, match=r"^cover\b.*at least 0 m\. Give the height"):
        reduced_for_cover(1.2, -1.0)
    with pytest.raises(rb.InputError, match=r"^phi\b.*float\(phi2\(L\)\)"):
        reduced_for_cover(phi2(10.0), 2.0)
    for rule in (real_train_factor, track_factor):
        with pytest.raises(rb.InputError, match=r"^maintained\b"):
            rule(10.0, 10.0, 20.0, maintained="yes")


def test_the_moment_of_a_dynamic_analysis_and_beside_what_it_is_held():
    track = track_factor(10.0, 10.0, 50.0)  # 1 + 0.30336 / 2
    value = dynamic_effect(2e6, 0.4, track)
    assert float(value) == pytest.approx((1.0 + 0.4 + 0.30336 / 2) * 2e6, rel=1e-5)
    limit = dynamic_effect_limit(-2e6, phi3(10.0))
    assert float(limit) == pytest.approx(1.4592 * 2e6, rel=1e-4)
    assert judge(value, limit).verdict == "not met"
    assert judge(dynamic_effect(1.8e6, 0.4, track), limit).verdict == "met"
    outside = track_factor(10.0, 5.0, 50.0)
    assert "outside" in dynamic_effect(2e6, 0.4, outside).reason
    assert "outside" in dynamic_effect_limit(2e6, phi3(0.03)).reason
    for call in (lambda: dynamic_effect(2e6, -1.1, track), lambda: dynamic_effect(2e6, 0.1, 1.2)):
        with pytest.raises(rb.InputError, match="phi_dyn|track"):
            call()
