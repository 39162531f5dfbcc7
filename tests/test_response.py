"""The exact sampled response against closed forms, series in exact arithmetic and an independent
integrator."""

from fractions import Fraction
from math import factorial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.signal import lfilter

from railbridge.errors import InputError
from railbridge.response import (
    LinearSystem,
    lagged,
    moved_on,
    oscillator,
    ramp_coefficients,
    sampled_modes,
    second_order_system,
)


def phi(order, x):
    """phi_order(x) = sum x^j / (j + order)!, summed exactly for a rational number x."""
    x = Fraction(x)
    return float(sum(x**j / factorial(j + order) for j in range(80)))


@pytest.mark.parametrize(
    "x",
    [
        0.0,
        -1e-300,
        -1e-12,
        -1e-8,
        1e-5,
        -1e-3,
        -0.05,
        0.29,
        -0.2999,
        -0.3001,
        -0.7,
        -3.0,
        -9.0,
        2.0,
    ],
)
def test_ramp_coefficients_equal_the_exact_series(x):
    h = 0.5
    a, b0, b1 = (c[0] for c in ramp_coefficients(np.array([x / h]), h))
    assert a == pytest.approx(np.exp(x), rel=1e-14)
    assert b1 == pytest.approx(h * phi(2, x), rel=2e-14)
    assert b0 == pytest.approx(h * (phi(1, x) - phi(2, x)), rel=5e-14)


def test_ramp_coefficients_of_stiff_poles():
    # exp(x) vanishes: phi1 = -1/x, phi2 = -(1 + 1/x)/x.
    x = np.array([-1e3, -1e6, -1e12])
    a, b0, b1 = ramp_coefficients(x, 1.0)
    assert np.all(a == 0.0)
    assert b1 == pytest.approx(-(1 + 1 / x) / x, rel=1e-15)
    assert b0 == pytest.approx(1 / x**2, rel=1e-3)


@given(angle=st.floats(0.0, np.pi), size=st.floats(-6.0, 1.0))
def test_complex_poles_solve_the_scalar_equation(angle, size):
    # One step of z' = s z + w with w from w0 to w1, by Gauss quadrature of the variation of
    # constants.
    s, h, w0, w1 = -np.exp(1j * angle / 2) * 10.0**size, 1.0, 0.7, -1.3
    a, b0, b1 = (c[0] for c in ramp_coefficients(np.array([s]), h))
    points, weights = np.polynomial.legendre.leggauss(60)
    tau = (points + 1) / 2
    exact = np.sum(weights / 2 * np.exp(s * (h - tau)) * (w0 + (w1 - w0) * tau))
    assert b0 * w0 + b1 * w1 == pytest.approx(exact, rel=1e-9, abs=1e-13)


def closed_form(omega, ratio, t, q0=0.0, v0=0.0):
    """Free vibration and unit-ramp response of an oscillator, q(t) and q'(t), for any damping."""
    s = omega * (-ratio + np.array([1, -1]) * np.emath.sqrt(ratio**2 - 1.0))
    if ratio == 1.0:
        e = np.exp(-omega * t)
        free = e * (q0 + (v0 + omega * q0) * t)
        free_v = e * (v0 - omega * (v0 + omega * q0) * t)
        c0, c1 = 2 / omega**3, 1 / omega**2
        ramp = t / omega**2 - 2 / omega**3 + e * (c0 + c1 * t)
        ramp_v = 1 / omega**2 + e * (c1 - omega * (c0 + c1 * t))
        return free + ramp, free_v + ramp_v
    # Particular solution t / w^2 - 2 zeta / w^3; the rest is a sum of two exponentials.
    shift = 2 * ratio / omega**3
    a = np.linalg.solve(
        np.vstack([np.ones(2), s]), np.array([q0 + shift, v0 - 1 / omega**2], dtype=complex)
    )
    e = np.exp(np.outer(t, s))
    return (e @ a).real + t / omega**2 - shift, (e @ (a * s)).real + 1 / omega**2


@pytest.mark.parametrize(
    "ratio", [0.0, 0.02, 0.9, 0.99999, 1 - 1e-9, 1.0, 1 + 1e-9, 1.00001, 1.5, 40.0]
)
@pytest.mark.parametrize("step", [1e-4, 0.01, 0.3])
def test_oscillator_under_a_ramp(ratio, step):
    omega = 12.0
    t = step * np.arange(200)
    q, v = oscillator(omega, ratio).sampled(step)(t[None], np.array([0.03, -0.2]))
    exact_q, exact_v = closed_form(omega, ratio if abs(ratio - 1) > 1e-8 else 1.0, t, 0.03, -0.2)
    # Near critical damping the reference itself treats the pole as double, an error of the order of
    # 1e-9.
    rel = 1e-8 if 0 < abs(ratio - 1) < 1e-4 else 1e-10
    assert q == pytest.approx(exact_q, rel=rel, abs=rel * 0.03)
    assert v == pytest.approx(exact_v, rel=rel, abs=rel * 0.4)


def test_critical_damping_uses_the_block_and_never_garbage():
    assert oscillator(12.0, 1.0).sampled(0.01).coefficients is None
    assert oscillator(12.0, 0.9).sampled(0.01).coefficients is not None
    triple = LinearSystem(
        -np.eye(3) * 5 + np.diag([1.0, 1.0], 1), np.array([[0.0], [0.0], [1.0]]), np.eye(3)
    )
    t = np.linspace(0, 2, 201)
    y = triple.sampled(t[1])(np.zeros((1, 201)), np.array([0.0, 0.0, 1.0]))
    assert y == pytest.approx(np.exp(-5 * t) * np.array([t**2 / 2, t, np.ones_like(t)]), rel=1e-11)


@pytest.mark.parametrize("ratio", [0.0, 0.03, 1.0, 3.0])
def test_an_oscillator_stepped_by_its_matrices_meets_the_closed_form(ratio):
    """``x[k+1] = E x[k] + B0 u[k] + B1 u[k+1]``, under a ramp from a start that is not rest."""
    h, t = 0.02, 0.02 * np.arange(60)
    e, b0, b1 = oscillator(12.0, ratio).step(h)
    x = np.array([0.03, -0.2])
    for k, now in enumerate(zip(*closed_form(12.0, ratio, t, *x), strict=True)):
        if k:
            x = e @ x + b0[:, 0] * t[k - 1] + b1[:, 0] * t[k]
        assert x == pytest.approx(now, rel=1e-10, abs=1e-12)


@pytest.mark.parametrize("ratio", [0.03, 1.0, 3.0])
def test_sine_is_met_to_second_order(ratio):
    omega, drive = 12.0, 20.0

    def error(step):
        t = step * np.arange(round(2.0 / step) + 1)
        q = oscillator(omega, ratio).sampled(step)(np.cos(drive * t)[None])[0]  # nonzero at t = 0
        ode = solve_ivp(
            lambda t, y: [y[1], np.cos(drive * t) - 2 * ratio * omega * y[1] - omega**2 * y[0]],
            (0, 2.0), [0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-15, t_eval=t,
        )  # fmt: skip
        return np.abs(q - ode.y[0]).max()

    coarse, fine = error(0.01), error(0.005)
    assert 3.8 < coarse / fine < 4.2
    assert fine < 1e-5


def test_a_high_frequency_is_no_reason_for_the_slow_block():
    h, n = 1e-3, 50
    t = h * np.arange(n)
    for omega in (1e5, 1e9):
        system = oscillator(omega, 0.01).sampled(h)
        assert system.coefficients is not None
        q, v = closed_form(omega, 0.01, t)
        y = system(t[None])
        assert y[0] == pytest.approx(q, rel=1e-9, abs=1e-12 / omega**2)


def test_the_first_sample_of_input_does_not_move_the_state():
    y = oscillator(5.0, 0.1).sampled(0.01)(np.ones((1, 3)))
    assert np.all(y[:, 0] == 0.0)
    for ratio in (0.1, 1.0):
        start = oscillator(5.0, ratio).sampled(0.01)(np.ones((1, 3)), np.array([0.3, 0.7]))
        assert start[:, 0] == pytest.approx([0.3, 0.7], rel=1e-12)


@given(seed=st.integers(0, 10**6), n=st.integers(1, 4), runs=st.integers(1, 3))
@settings(max_examples=25)
def test_a_chain_of_masses_against_an_independent_integrator(seed, n, runs):
    rng = np.random.default_rng(seed)
    mass = np.diag(rng.uniform(0.5, 3.0, n))
    root = rng.normal(size=(n, n))
    stiffness = root @ root.T + 5 * np.eye(n)
    damping = 0.05 * stiffness + np.diag(rng.uniform(0, 1, n))
    force, output = rng.normal(size=(n, 2)), rng.normal(size=(3, 2 * n))
    system = second_order_system(mass, damping, stiffness, force, output)
    t = np.linspace(0, 3.0, 31)
    u = rng.normal(size=(2, runs, 31))
    x0 = rng.normal(size=2 * n)
    ours = system.sampled(t[1])(u, x0)
    assert ours.shape == (3, runs, 31)
    for r in range(runs):
        assert system.sampled(t[1])(u[:, r], x0) == pytest.approx(ours[:, r], rel=1e-10, abs=1e-12)

    def rate(time, x):
        here = [np.interp(time, t, row) for row in u[:, 0]]
        acceleration = np.linalg.solve(mass, force @ here - damping @ x[n:] - stiffness @ x[:n])
        return np.concatenate([x[n:], acceleration])

    x = x0
    for k in range(30):  # piece by piece: the input has a corner at every sample
        x = solve_ivp(rate, (t[k], t[k + 1]), x, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
        assert ours[:, 0, k + 1] == pytest.approx(output @ x, rel=1e-7, abs=1e-8)


@given(
    ratio=st.floats(0.0, 5.0),
    omega=st.floats(0.1, 1e4),
    step=st.floats(1e-5, 0.1),
    seed=st.integers(0, 99),
)
@settings(max_examples=60)
def test_halving_the_step_of_a_piecewise_linear_input_changes_nothing(ratio, omega, step, seed):
    u = np.random.default_rng(seed).normal(size=40)
    fine = np.interp(np.arange(79) / 2, np.arange(40), u)
    system = oscillator(omega, ratio)
    once, twice = system.sampled(step)(u[None]), system.sampled(step / 2)(fine[None])[:, ::2]
    scale = np.abs(once).max(axis=1, keepdims=True)
    assert np.all(np.abs(once - twice) <= 1e-8 * scale)
    assert np.all(np.isfinite(once))


RATIOS = [0.0, 0.02, 0.9, 0.9998, 0.99995, 1.0, 1.00005, 1.0002, 1.5, 40.0]


@pytest.mark.parametrize("turn", [1e-7, 1e-4, 0.02, 0.5, 3.0, 40.0])
@pytest.mark.parametrize("samples", [2, 15, 16, 17, 400])
def test_modes_under_a_ramp_and_how_short_the_steps_may_be(turn, samples):
    """All ways a mode can move at once; omega h from a ten-millionth, where recursions lose digits,
    to several turns a step."""
    omega, h = 12.0, turn / 12.0
    t = h * np.arange(samples)
    modes = sampled_modes(np.full(len(RATIOS), omega), np.array(RATIOS), h)
    assert sorted(modes.others) == [4, 5, 6], "within a ten-thousandth of critical"
    motion = modes(np.tile(t, (len(RATIOS), 1)))
    for m, ratio in enumerate(RATIOS):
        # The closed form is a difference of large numbers at first; a double pole takes half.
        early = turn * samples * (1 + 2 * ratio) < 5.0
        series = [ramp_series(omega, ratio, t, power) for power in (3, 2)]
        exact = series if early else closed_form(omega, ratio, t)
        near = 1e-7 if 0.9 < ratio < 1.01 else 1e-11
        if ratio > 0.99:  # two real roots close together for so short a step
            near = max(near, near * 1e-4 / turn)
        noise = 0.0 if early else 1e-14 * (1 + 2 * ratio) / omega**2 * np.array([1 / omega, 1.0])
        for own, expected, least in zip(motion, exact, np.broadcast_to(noise, 2), strict=True):
            assert np.abs(own[m] - expected).max() <= near * np.abs(expected).max() + least


def ramp_series(omega, ratio, t, power):
    """q (power 3) or q' (power 2) under a unit ramp from rest as a power series in t, for short
    times."""
    total, a, b = np.zeros_like(t), 1.0, 0.0
    for n in range(power, power + 40):
        # q = sum c_n t^n / n!, with c_3 = 1 and c_(n+2) = -2 zeta omega c_(n+1) - omega^2 c_n.
        total = total + a * t**n / factorial(n)
        a, b = -2 * ratio * omega * a - omega**2 * b, a
    return total


@pytest.mark.parametrize("turn", [1e-5, 1e-3, 0.02, 0.5, 3.0])
def test_modes_that_swing_are_one_complex_filter(turn):
    """The recursion ``z[k+1] = a z[k] + b0 f[k] + b1 f[k+1]``, sample by sample."""
    rng, omega, n = np.random.default_rng(5), 20.0, 5000
    f = rng.normal(size=(3, n)).cumsum(axis=1)
    ratios = np.array([0.0, 0.03, 0.7])
    q, velocity = sampled_modes(np.full(3, omega), ratios, turn / omega)(f)
    poles = omega * (-ratios + 1j * np.sqrt(1 - ratios**2))
    coefficients = ramp_coefficients(poles, turn / omega)
    for s, a, b0, b1, own, rate, force in zip(poles, *coefficients, q, velocity, f, strict=True):
        z = lfilter([b1, b0], [1.0, -a], force, zi=-b1 * force[:1])[0]
        for found, expected in ((own, z.imag / s.imag), (rate, (s * z).imag / s.imag)):
            assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()


def test_independent_runs_do_not_touch_each_other_and_a_future_does_not_touch_the_past():
    system, rng = oscillator(30.0, 0.1).sampled(1e-2), np.random.default_rng(1)
    u = rng.normal(size=(1, 3, 77))
    y = system(u)
    for cut in (1, 7, 8, 9, 76):
        assert system(u[:, :, :cut]) == pytest.approx(y[:, :, :cut], rel=1e-13, abs=1e-15)
        late = np.where(np.arange(77) < cut, 0.0, u)
        assert np.all(system(late)[:, :, :cut] == 0.0)
    assert system(u[:, 1]) == pytest.approx(y[:, 1], rel=1e-13, abs=1e-15)


def test_time_step_must_be_positive():
    with pytest.raises(InputError, match="time_step"):
        oscillator(1.0, 0.1).sampled(0.0)


@pytest.mark.parametrize("lag", [1e-5, 1e-3, 0.3])
def test_a_lag_is_that_of_a_first_order_equation(lag):
    """A ramp 3 t gives ``3 (t - lag + lag exp(-t / lag))``; after it, decay."""
    h = 2e-3
    t = h * np.arange(200)
    u = np.minimum(3.0 * t, 0.3)
    y = lagged(u, lag, h)
    up = t <= 0.1
    assert y[up] == pytest.approx(3.0 * (t - lag + lag * np.exp(-t / lag))[up], abs=1e-12)
    after = t >= 0.1
    assert 0.3 - y[after] == pytest.approx(
        (0.3 - y[after][0]) * np.exp(-(t[after] - t[after][0]) / lag), abs=1e-9
    )
    assert lagged(u, 0.0, h) is u


@pytest.mark.parametrize("ratio", [0.0, 0.03, 0.9, 1.0, 1.0 + 1e-9, 3.0])
def test_modes_that_move_on_meet_the_next_sample(ratio):
    """In one span of a step, and in two that share it: as the sampled modes do."""
    omega, h = 40.0, 5e-3
    system = oscillator(omega, ratio).sampled(h)
    force = np.array([[0.0, 1.0, -0.5, 2.0]])
    q, velocity = system(force)

    def go(state, ends, span):
        ends = tuple(np.full((1, 1), f) for f in ends)
        state = tuple(np.full((1, 1), x) for x in state)
        moved = moved_on(np.array([omega]), np.array([ratio]), state, ends, np.array([span]))
        return [float(x[0, 0]) for x in moved]

    # On the straight line from -0.5 to 2 the force is 0.5 after two fifths of the step.
    once = go((q[2], velocity[2]), force[0, 2:], h)
    twice = go(go((q[2], velocity[2]), (-0.5, 0.5), 0.4 * h), (0.5, 2.0), 0.6 * h)
    size = np.abs(q).max(), np.abs(velocity).max()
    for found in (once, twice):
        for value, last, scale in zip(found, (q[3], velocity[3]), size, strict=True):
            assert value == pytest.approx(last, abs=1e-7 * scale)
