"""What an ensemble tells, against tables, closed forms, and how often intervals hold."""

import math

import numpy as np
import pytest
from scipy import stats

from railbridge.errors import InputError
from railbridge.studies.statistics import (
    describe,
    exceedance,
    needed_for_mean,
    needed_for_percentile,
)

RNG = np.random.default_rng(11)


def test_mean_and_gaussian_deviation_are_those_of_the_textbook():
    """Ten numbers by hand: t(9; 0.975) = 2.262, chi2(9) = 19.02 and 2.700, from printed tables."""
    found = describe([3, 5, 4, 8, 6, 7, 5, 4, 9, 9])
    assert found.mean == 6.0 and found.standard_deviation == pytest.approx(math.sqrt(42 / 9))
    half = 2.262 * math.sqrt(42 / 9 / 10)
    assert found.mean_interval == pytest.approx((6 - half, 6 + half), rel=1e-4)
    expected = (math.sqrt(42 / 19.023), math.sqrt(42 / 2.7004))
    assert found.standard_deviation_interval_gaussian == pytest.approx(expected, rel=1e-4)
    assert (found.smallest, found.smallest_index) == (3.0, 0)
    assert (found.largest, found.largest_index) == (9.0, 8) and found.count == 10


@pytest.mark.parametrize(
    ("draw", "true", "gaussian_holds"),
    [
        (lambda n: RNG.normal(2.0, 3.0, n), 3.0, (0.93, 0.97)),
        (lambda n: RNG.uniform(0.0, 1.0, n), 12**-0.5, (0.97, 1.0)),
        (lambda n: RNG.exponential(1.0, n), 1.0, (0.5, 0.85)),
    ],
)
def test_the_interval_of_the_deviation_holds_for_other_numbers_too(draw, true, gaussian_holds):
    """Chi-square is right for Gaussian numbers only; Bonett's stays near 95 % (his Table 1)."""
    ensembles = [describe(draw(60)) for _ in range(1500)]

    def holds(name):
        return np.mean([lo <= true <= hi for lo, hi in (getattr(e, name) for e in ensembles)])

    assert gaussian_holds[0] < holds("standard_deviation_interval_gaussian") <= gaussian_holds[1]
    assert 0.90 < holds("standard_deviation_interval") <= 0.99


def test_the_interval_of_the_mean_holds_as_often_as_it_says():
    for confidence in (0.8, 0.95):
        found = [describe(RNG.normal(5.0, 2.0, 6), confidence=confidence) for _ in range(3000)]
        holds = np.mean([e.mean_interval[0] <= 5.0 <= e.mean_interval[1] for e in found])
        assert holds == pytest.approx(confidence, abs=0.025)


@pytest.mark.parametrize(("count", "low", "high"), [(100, 40, 61), (20, 6, 15), (6, 1, 6)])
def test_the_interval_of_the_median_is_between_printed_ranks(count, low, high):
    """Ranks of the sign test's 95 % interval as printed in tables of nonparametric statistics."""
    ranks = np.arange(1.0, count + 1)
    median = describe(RNG.permutation(ranks), percentiles=(50,)).percentiles[0]
    assert (median.low, median.high) == (low, high)


def test_ranks_are_the_narrowest_that_keep_both_tails():
    for count, percent, confidence in ((37, 20, 0.9), (250, 95, 0.95), (80, 5, 0.99)):
        found = describe(
            np.arange(1.0, count + 1), percentiles=(percent,), confidence=confidence
        ).percentiles[0]
        below, tail = stats.binom(count, percent / 100), (1 - confidence) / 2
        if not math.isnan(found.low):
            assert below.cdf(found.low - 1) <= tail < below.cdf(found.low)
        if not math.isnan(found.high):
            assert below.sf(found.high - 1) <= tail < below.sf(found.high - 2)


def test_a_bound_that_n_cannot_give_is_not_invented():
    """0.95^N <= 0.025 from N = 72 on: then the largest is a bound of the 95 % percentile."""
    for count, there in ((71, False), (72, True)):
        found = describe(np.arange(float(count)), percentiles=(95,))
        assert math.isnan(found.percentiles[0].high) is not there
        assert bool(found.remarks) is not there
    assert describe(np.arange(72.0), percentiles=(95,)).percentiles[0].high == 71.0
    (remark,) = describe(np.arange(71.0), percentiles=(95,)).remarks
    assert "upper bound of the 95 % percentile" in remark and "takes 72" in remark
    low = describe(np.arange(71.0), percentiles=(5,))
    assert math.isnan(low.percentiles[0].low) and "lower bound" in low.remarks[0]


def test_few_realisations_have_no_interval_of_the_deviation_of_any_numbers():
    found = describe([1.0, 2.0, 4.0])
    assert np.isnan(found.standard_deviation_interval).all()
    assert any("may not be Gaussian" in r for r in found.remarks)
    assert np.isfinite(describe([1.0, 2.0, 4.0, 3.0, 2.5]).standard_deviation_interval).all()


@pytest.mark.parametrize(("count", "share"), [(10, 0.741), (59, 0.9505), (299, 0.9900)])
def test_what_the_largest_covers_is_wilks(count, share):
    """59 for 95 % and 299 for 99 % are the numbers of Wilks's tolerance limit."""
    assert describe(np.arange(float(count))).covered == pytest.approx(share, abs=5e-4)


def test_equal_realisations_have_intervals_of_no_width():
    found = describe([2.0] * 100)
    assert found.mean_interval == (2.0, 2.0) and found.standard_deviation_interval == (0.0, 0.0)
    assert found.percentiles[2].low == found.percentiles[2].high == 2.0


def test_values_are_kept_as_they_were_given():
    given = np.array([3.0, 1.0, 2.0])
    found = describe(given)
    given[0] = 99.0
    assert found.values.tolist() == [3.0, 1.0, 2.0] and not found.values.flags.writeable


@pytest.mark.parametrize(
    ("above", "count", "low", "high"),
    [(0, 10, 0.0, 0.3085), (1, 10, 0.0025, 0.4450), (5, 10, 0.1871, 0.8129), (10, 10, 0.6915, 1.0)],
)
def test_exceedance_is_the_table_of_clopper_and_pearson(above, count, low, high):
    values = np.where(np.arange(count) < above, 2.0, 1.0)
    found = exceedance(values, 1.0)
    assert (found.above, found.share) == (above, above / count)
    assert (found.low, found.high) == pytest.approx((low, high), abs=6e-5)
    same = stats.binomtest(above, count).proportion_ci(0.95, "exact")
    assert (found.low, found.high) == pytest.approx((same.low, same.high), abs=1e-9)


def test_needed_for_mean_is_the_first_that_is_narrow_enough():
    pilot = RNG.normal(10.0, 2.0, 30)
    for width in (0.5, 0.05, 0.003):
        needed = needed_for_mean(pilot, width)

        def half(n, pilot=pilot):
            return stats.t.ppf(0.975, n - 1) * np.std(pilot, ddof=1) / math.sqrt(n) / np.mean(pilot)

        assert half(needed) <= width and (needed == 2 or half(needed - 1) > width)
    assert needed_for_mean(-pilot, 0.05) == needed_for_mean(pilot, 0.05)


def test_needed_for_percentile_gives_intervals_of_that_width():
    """Of a uniform distribution from 0 to 1: half the interval is z sqrt(p (1 - p) / N)."""
    pilot = (np.arange(4000) + 0.5) / 4000
    needed = needed_for_percentile(pilot, 80, 0.02)
    assert needed == pytest.approx(1.95996**2 * 0.2 / 0.8 / 0.02**2, rel=0.02)
    widths = [
        (p.high - p.low) / 2 / 0.8
        for p in (describe(RNG.uniform(size=needed), percentiles=(80,)).percentiles[0]
                  for _ in range(100))
    ]  # fmt: skip
    assert np.mean(widths) == pytest.approx(0.02, rel=0.05)


def test_needed_for_percentile_is_never_less_than_its_bounds_take():
    assert needed_for_percentile(np.full(50, 3.0), 95, 0.1) >= 72
    assert not describe(np.arange(73.0), percentiles=(95,)).remarks


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda: describe([1.0]), "one realisation proves nothing"),
        (lambda: describe([1.0, math.nan]), "values[2]"),
        (lambda: describe([math.inf, 1.0]), "values[1]"),
        (lambda: describe(3.0), "must be a list"),
        (lambda: describe([1.0, 2.0], confidence=95), "below 1"),
        (lambda: describe([1.0, 2.0], confidence=0.0), "above 0"),
        (lambda: describe([1.0, 2.0], confidence=1.0), "below 1"),
        (lambda: describe([1.0, 2.0], percentiles=(50, 100)), "percentiles[2]"),
        (lambda: describe([1.0, 2.0], percentiles=(0,)), "percentiles[1]"),
        (lambda: exceedance([1.0, 2.0], math.nan), "limit"),
        (lambda: exceedance([1.0], 2.0), "two realisations"),
        (lambda: needed_for_mean([-1.0, 1.0], 0.05), "near zero"),
        (lambda: needed_for_mean([1.0, 2.0], 0.0), "width"),
        (lambda: needed_for_percentile([-1.0, 0.0, 1.0], 50, 0.1), "near zero"),
        (lambda: needed_for_percentile([1.0, 2.0], 101, 0.1), "percent"),
    ],
)
def test_refusals(act, words):
    with pytest.raises(InputError) as refused:
        act()
    assert words.lower() in str(refused.value).lower()


def test_the_table_bears_the_unit():
    table = describe(np.arange(100.0), unit="kN").to_frame()
    assert list(table.columns) == ["value (kN)", "low (kN)", "high (kN)", "realisation"]
    assert table.loc["largest", "value (kN)"] == 99.0 and table.loc["largest", "realisation"] == 99
    assert table.loc["95 % lie below", "low (kN)"] == 89.0
    assert list(describe([1.0, 2.0]).to_frame().columns)[0] == "value"
