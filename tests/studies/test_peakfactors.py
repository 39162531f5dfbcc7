"""Extremes of Gaussian processes, against closed forms and against processes that are drawn."""

import math
import warnings

import numpy as np
import pytest
from scipy import integrate, stats

from railbridge.errors import InputError
from railbridge.studies.peakfactors import davenport, extreme, upcrossing_rate

WIDE = np.linspace(0.05, 4.0, 60)
BAND = np.linspace(4.0, 8.0, 60)
NARROW = np.linspace(5.5, 6.5, 60)


class Drawn:
    """env(t) times a sum of cosines of variance one, plus m(t); with 4000 realisations."""

    def __init__(self, omegas, time, shape, mean):
        self.time, self.omegas = time, omegas
        zero = np.zeros_like(time)
        env, env_rate = (part + zero for part in shape)
        self.mean, self.mean_rate = (part + zero for part in mean)
        square = np.mean(omegas**2)
        self.sd, self.sd_rate = env, np.sqrt(env_rate**2 + env**2 * square)
        # 0 / 0 where the envelope is zero: what somebody gets who divides a covariance.
        with np.errstate(invalid="ignore"):
            self.correlation = env * env_rate / (self.sd * self.sd_rate)

    @property
    def process(self):
        return self.mean, self.sd, self.mean_rate, self.sd_rate, self.correlation

    def realisations(self, count=4000):
        rng, k = np.random.default_rng(5), len(self.omegas)
        a, b = rng.normal(size=(2, count, k)) / math.sqrt(k)
        angles = np.outer(self.omegas, self.time)
        return self.mean + self.sd * (a @ np.cos(angles) + b @ np.sin(angles))

    def extreme(self, side="largest"):
        return extreme(self.time, *self.process, side=side)


def drawn(omegas, duration, kind):
    time = np.linspace(0.0, duration, int(duration / 0.04))
    angle, w = np.pi * time / duration, np.pi / duration
    shape = (1.0, 0.0) if kind == "stationary" else (np.sin(angle) ** 2, w * np.sin(2 * angle))
    moves = kind == "moving mean"
    mean = (3 * np.sin(angle), 3 * w * np.cos(angle)) if moves else (0.0, 0.0)
    return Drawn(omegas, time, shape, mean)


# ---- closed forms


@pytest.mark.parametrize("level", [-1.0, 0.0, 2.5])
def test_a_stationary_process_has_the_rate_of_rice(level):
    sd, sd_rate = 0.7, 3.0
    rice = sd_rate / (2 * np.pi * sd) * math.exp(-((level / sd) ** 2) / 2)
    assert upcrossing_rate(level, 0.0, sd, 0.0, sd_rate) == pytest.approx(rice, rel=1e-12)


@pytest.mark.parametrize("rho", [-0.8, 0.0, 0.5, 1.0 - 1e-9])
@pytest.mark.parametrize("mean_rate", [-4.0, 0.0, 2.5])
def test_the_rate_is_the_integral_over_the_joint_density(rho, mean_rate):
    level, mean, sd, sd_rate = 1.3, 0.4, 0.9, 2.0
    found = float(upcrossing_rate(level, mean, sd, mean_rate, sd_rate, min(rho, 0.99)))
    covariance = min(rho, 0.99) * sd * sd_rate
    joint = stats.multivariate_normal(
        [mean, mean_rate], [[sd**2, covariance], [covariance, sd_rate**2]]
    )
    expected, _ = integrate.quad(lambda v: v * joint.pdf([level, v]), 0.0, 25.0, limit=200)
    assert found == pytest.approx(expected, rel=1e-6)


def test_up_crossings_less_down_crossings_are_what_the_share_above_gains():
    """d/dt P(X > b), by differences of the Gaussian distribution."""
    time = np.linspace(0.0, 2.0, 20001)
    m, m_rate = np.sin(time), np.cos(time)
    s, s_slope, inner = 1 + 0.5 * time**2, time, 3.0
    sd_rate = np.hypot(s_slope, s * inner)
    process = (s, m_rate, sd_rate, s * s_slope / (s * sd_rate))
    up = upcrossing_rate(0.8, m, *process)
    down = upcrossing_rate(-0.8, -m, s, -m_rate, *process[2:])
    gained = np.gradient(stats.norm.sf((0.8 - m) / s), time)
    assert (up - down)[1:-1] == pytest.approx(gained[1:-1], abs=1e-6)


def test_a_process_without_randomness_in_its_rate_crosses_as_a_line():
    """X = X0 + 2 t: the rate is the density times the speed; none downwards."""
    assert upcrossing_rate(1.0, 0.0, 1.0, 2.0, 0.0) == pytest.approx(2 * stats.norm.pdf(1.0))
    assert upcrossing_rate(1.0, 0.0, 1.0, -2.0, 0.0) == 0.0
    # X = X0 (1 + t) at t = 0: correlation one, and only what is above zero rises.
    assert upcrossing_rate(1.5, 0.0, 1.0, 0.0, 1.0, 1.0) == pytest.approx(1.5 * stats.norm.pdf(1.5))
    assert upcrossing_rate(-1.5, 0.0, 1.0, 0.0, 1.0, 1.0) == pytest.approx(0.0, abs=1e-12)


def test_rates_have_the_shape_of_levels_and_times():
    assert upcrossing_rate(1.0, 0.0, 1.0, 0.0, 1.0).shape == ()
    assert upcrossing_rate([1.0, 2.0], 0.0, 1.0, 0.0, 1.0).shape == (2,)
    sd = np.array([0.0, 1.0, 2.0])
    found = upcrossing_rate(np.ones((2, 5)), np.zeros(3), sd, 0.0, 1.0)
    assert found.shape == (2, 5, 3) and np.all(found[..., 0] == 0.0)
    assert found[1, 4, 2] == pytest.approx(upcrossing_rate(1.0, 0.0, 2.0, 0.0, 1.0))


def test_davenport_by_hand():
    """nu T = 600: sqrt(2 ln 600) = 3.5768."""
    found = davenport(1.0, 600.0)
    assert found.mean == pytest.approx(3.5768 + 0.5772 / 3.5768, abs=2e-4)
    assert found.standard_deviation == pytest.approx(1.28255 / 3.5768, abs=1e-4)


def test_a_long_stationary_process_tends_to_davenport():
    off = []
    for crossings in (1e2, 1e4, 1e6, 1e9):
        found = extreme([0.0, crossings], 5.0, 2.0, 0.0, 4 * np.pi)
        g, spread = davenport(1.0, crossings)
        off.append((g / found.peak_factor - 1, spread / found.standard_deviation * 2 - 1))
        assert found.mean == pytest.approx(5.0 + 2.0 * found.peak_factor)
    off = np.abs(off)
    # Measured on exp(-nu T exp(-b^2 / 2)) itself: 0.9, 0.25, 0.12, 0.05 per cent, and 10 to 3.
    assert np.all(off[:, 0] < [0.011, 0.003, 0.0015, 0.0007]) and np.all(np.diff(off, axis=0) < 0)
    assert off[-1, 1] < 0.035


@pytest.mark.parametrize("side", ["largest", "magnitude"])
def test_a_short_stationary_record_is_the_formula_integrated(side):
    """One crossing of the mean: the start counts, and who is still below."""

    def below(b):
        start = stats.norm.cdf(b) - (stats.norm.cdf(-b) if side == "magnitude" else 0.0)
        sides = 2 if side == "magnitude" else 1
        return start * math.exp(-sides * math.exp(-(b**2) / 2) / start) if start > 0.0 else 0.0

    found = extreme([0.0, 1.0], 0.0, 1.0, 0.0, 2 * np.pi, side=side)
    low = 0.0 if side == "magnitude" else -9.0
    area, _ = integrate.quad(below, low, 9.0)
    assert found.mean == pytest.approx(9.0 - area, abs=1e-5)
    for level in (1.0, 2.0, 3.0):
        assert np.interp(level, found.levels, found.probability) == pytest.approx(
            below(level), abs=1e-4
        )


def test_an_instant_has_the_distribution_of_the_process():
    found = extreme([0.0, 1e-9], 1.0, 2.0, 0.0, 1.0)
    assert (found.mean, found.standard_deviation) == pytest.approx((1.0, 2.0), abs=1e-3)
    for p in (0.1, 50.0, 99.9):
        assert found.percentile(p) == pytest.approx(1 + 2 * stats.norm.ppf(p / 100), abs=2e-3)


# ---- against what is drawn


@pytest.mark.parametrize("side", ["largest", "smallest", "magnitude"])
@pytest.mark.parametrize("kind", ["stationary", "envelope", "moving mean"])
@pytest.mark.parametrize("omegas", [WIDE, BAND], ids=["wide", "band"])
def test_the_extreme_is_that_of_what_is_drawn(omegas, kind, side):
    """Mean within 0.06 standard deviations of the process (what clumps leave) and three errors."""
    case = drawn(omegas, 20.0, kind)
    x = case.realisations()
    found = case.extreme(side)
    act = {
        "largest": np.max(x, axis=1), "smallest": np.min(x, axis=1),
        "magnitude": np.max(np.abs(x), axis=1),
    }[side]  # fmt: skip
    if side == "magnitude" and omegas is BAND and kind != "moving mean":
        # Crossings of both limits alternate, half a cycle apart: a clump, and the safe side.
        assert 0.15 < found.mean - np.mean(act) < 0.25
        return
    error = np.std(act) / math.sqrt(len(act))
    assert found.mean == pytest.approx(np.mean(act), abs=0.06 + 3 * error)
    assert found.standard_deviation == pytest.approx(np.std(act), abs=0.06)
    for p in (50, 95):
        assert found.percentile(p) == pytest.approx(np.percentile(act, p), abs=0.1)


@pytest.mark.parametrize("kind", ["stationary", "envelope", "moving mean"])
def test_a_short_record_needs_the_share_that_is_still_below(kind):
    """One crossing of the mean in 5 s: the plain P0 exp(-integral nu dt) is off by 0.16 to 0.5."""
    case = drawn(WIDE, 5.0, kind)
    act = np.max(case.realisations(), axis=1)
    assert case.extreme().mean == pytest.approx(np.mean(act), abs=0.13)
    levels = np.linspace(-6.0, 9.0, 1500)
    rates = integrate.trapezoid(upcrossing_rate(levels, *case.process), case.time, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        start = stats.norm.cdf((levels - case.mean[0]) / case.sd[0])
    plain = levels[-1] - integrate.trapezoid(start * np.exp(-rates), levels)
    assert np.mean(act) - plain > 0.13


@pytest.mark.parametrize("kind", ["stationary", "envelope", "moving mean"])
def test_clumps_of_a_narrow_band_leave_it_on_the_safe_side(kind):
    case = drawn(NARROW, 20.0, kind)
    act = np.max(case.realisations(), axis=1)
    assert 0.2 < case.extreme().mean - np.mean(act) < 0.55


def test_many_crossings_are_counted_as_often_as_the_rate_says():
    case = drawn(BAND, 10.0, "moving mean")
    x = case.realisations()
    for level in (1.0, 3.0, 4.0):
        each = np.sum((x[:, :-1] < level) & (x[:, 1:] >= level), axis=1)
        expected = integrate.trapezoid(upcrossing_rate(level, *case.process), case.time)
        error = np.std(each) / math.sqrt(len(each))
        # Samples 0.04 s apart miss some: two crossings between them.
        assert np.mean(each) == pytest.approx(expected, abs=3 * error + 0.01 * expected)


# ---- the ends


def test_nothing_warns_where_the_deviation_is_zero():
    time = np.linspace(0.0, 4.0, 401)
    on = (time > 1.0) & (time < 3.0)
    sd = np.where(on, np.sin(np.pi * (time - 1) / 2) ** 2, 0.0)
    rate = np.where(on, np.pi / 2 * np.sin(np.pi * (time - 1)), 0.0)
    sd_rate = np.hypot(rate, 8 * sd)
    rho = np.where(sd > 0, rate / np.where(sd_rate > 0, sd_rate, 1), np.nan)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for side in ("largest", "smallest", "magnitude"):
            found = extreme(time, 0 * time, sd, 0 * time, sd_rate, rho, side=side)
            assert np.all(np.diff(found.probability) > -1e-12) and np.all(np.diff(found.levels) > 0)
    inside = slice(100, 301)
    alone = extreme(time[inside], 0.0, sd[inside], 0.0, sd_rate[inside], rho[inside])
    assert extreme(time, 0.0, sd, 0.0, sd_rate, rho).mean == pytest.approx(alone.mean, abs=1e-3)


def test_where_nothing_is_random_the_extreme_is_that_of_the_mean():
    time = np.linspace(0.0, 1.0, 101)
    m, m_rate = -3 * np.sin(np.pi * time), -3 * np.pi * np.cos(np.pi * time)
    for side, value in (("largest", 0.0), ("smallest", -3.0), ("magnitude", 3.0)):
        found = extreme(time, m, 0.0, m_rate, 0.0, np.nan, side=side)
        assert found.mean == pytest.approx(value, abs=1e-12) and found.standard_deviation == 0.0
        assert found.percentile(95) == pytest.approx(value, abs=1e-12)
        assert math.isnan(found.peak_factor)


def test_what_the_mean_reaches_while_nothing_is_random_is_certain():
    time = np.linspace(0.0, 1.0, 101)
    sd = np.where(time < 0.5, 0.1, 0.0)
    m = np.where(time < 0.5, 0.0, 3 * np.sin(np.pi * (2 * time - 1)))
    found = extreme(time, m, sd, 0.0, 20 * sd)
    assert found.mean == pytest.approx(3.0, abs=0.01) and found.percentile(5) > 2.99


def test_a_small_deviation_about_a_mean_that_moves_far_gives_little_more_than_the_mean():
    """The step is ten deviations of the mean's motion: no sample may be counted as a crossing."""
    time = np.linspace(0.0, 1.0, 101)
    m, m_rate = np.sin(np.pi * time), np.pi * np.cos(np.pi * time)
    found = extreme(time, m, 3e-3, m_rate, 3e-3 * 20.0)
    assert 1.0 < found.mean < 1.0 + 3 * 3e-3 and found.peak_factor == pytest.approx(
        (found.mean - 1.0) / 3e-3
    )


def test_sides_mirror_each_other():
    case = drawn(BAND, 8.0, "moving mean")
    m, s, m_rate, sd_rate, rho = case.process
    up = extreme(case.time, m, s, m_rate, sd_rate, rho)
    down = extreme(case.time, -m, s, -m_rate, sd_rate, rho, side="smallest")
    assert down.mean == pytest.approx(-up.mean) and down.of_mean == -up.of_mean
    assert down.peak_factor == pytest.approx(up.peak_factor)
    assert down.percentile(10) == pytest.approx(-up.percentile(90), abs=1e-9)
    both = [
        extreme(case.time, sign * m, s, sign * m_rate, sd_rate, rho, side="magnitude").mean
        for sign in (1, -1)
    ]
    assert both[0] == pytest.approx(both[1], rel=1e-9)
    # Up to 3 with deviation 1: the size is that of the upper side, but for rare ones.
    size = extreme(case.time, m, s, m_rate, sd_rate, rho, side="magnitude")
    assert size.mean == pytest.approx(up.mean, abs=0.01)


def test_figures_of_a_distribution_agree_with_its_levels():
    found = extreme([0.0, 50.0], 0.0, 1.0, 0.0, 6.0)
    table = found.to_frame()
    assert list(table.columns) == ["level", "probability below"]
    density = np.diff(found.probability)
    middle = (found.levels[1:] + found.levels[:-1]) / 2
    assert found.mean == pytest.approx(np.sum(density * middle), abs=1e-6)
    spread = np.sqrt(np.sum(density * (middle - found.mean) ** 2))
    assert found.standard_deviation == pytest.approx(spread, rel=1e-3)


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda: davenport(1.0, 5.0), "up-crossings"),
        (lambda: davenport(0.0, 5.0), "rate"),
        (lambda: upcrossing_rate(math.nan, 0.0, 1.0, 0.0, 1.0), "level"),
        (lambda: upcrossing_rate(1.0, 0.0, -1.0, 0.0, 1.0), "sd"),
        (lambda: upcrossing_rate(1.0, 0.0, 1.0, 0.0, -1.0), "sd_rate"),
        (lambda: upcrossing_rate(1.0, 0.0, 1.0, 0.0, 1.0, 1.1), "correlation"),
        (lambda: upcrossing_rate(1.0, 0.0, 1.0, 0.0, 1.0, math.nan), "correlation"),
        (lambda: upcrossing_rate(1.0, [0.0, 1.0], [1.0] * 3, 0.0, 1.0), "must hold 3"),
        (lambda: extreme([0.0, 1.0], [math.inf, 0.0], 1.0, 0.0, 1.0), "mean[1]"),
        (lambda: extreme([0.0, 0.0], 0.0, 1.0, 0.0, 1.0), "ascending"),
        (lambda: extreme([0.0], 0.0, 1.0, 0.0, 1.0), "two instants"),
        (lambda: extreme([0.0, 1.0], 0.0, [1.0] * 3, 0.0, 1.0), "must hold 2"),
        (lambda: extreme([0.0, 1.0], 0.0, 1.0, 0.0, 1.0, side="larges"), "largest"),
        (lambda: extreme([0.0, 1.0], 0.0, 1.0, 0.0, 1.0).percentile(100), "99.9"),
    ],
)
def test_refusals(act, words):
    with pytest.raises(InputError) as refused:
        act()
    assert words in str(refused.value)
