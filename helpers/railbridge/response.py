r"""Exact response of a linear system to sampled, piecewise-linear input.

The system is ``x' = A x + B u, y = C x``. With ``A = V diag(s) W`` and ``W = inv(V)``, each modal
coordinate ``z = W x`` obeys ``z' = s z + w`` with ``w = W B u``. If w runs linearly from ``w[k]``
to ``w[k+1]`` over a step h, the solution at the end of the step is, exactly,

    z[k+1] = a z[k] + b0 w[k] + b1 w[k+1],
    a = exp(s h),   b1 = h phi2(s h),   b0 = h (phi1(s h) - phi2(s h)),
    phi1(x) = (exp(x) - 1) / x,   phi2(x) = (phi1(x) - 1) / x.

This is a first-order digital filter for each mode, and `scipy.signal.lfilter` runs it in compiled
code. It has no stability limit and no algorithmic damping; its only error is that the input is
sampled. Shock-spectrum practice knows it as the ramp-invariant filter (Smallwood 1981; ISO
18431-4).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import eig, expm, matrix_balance
from scipy.signal import lfilter, lsim

from .errors import brief, number

__all__ = [
    "LinearSystem", "SampledModes", "SampledResponse", "lagged", "moved_on", "oscillator",
    "ramp_coefficients", "sampled_modes", "second_order_system",
]  # fmt: skip

_WORST_CONDITION = 1e6
"""Condition of the eigenvectors above which the modes are not trusted: about ten digits would be
left."""
_NEARLY_CRITICAL = 0.9999
"""Damping ratio from which Im(z) / omega_d would lose digits."""


def ramp_coefficients(
    poles: np.ndarray, time_step: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a, b0 and b1 of the exact step for input that is linear between samples.

    Parameters
    ----------
    poles : ndarray, shape (m,)
        Eigenvalues s of A, 1/s; zero is allowed.
    time_step : float
        h, s.

    Returns
    -------
    a, b0, b1 : ndarray, shape (m,), complex
    """
    x = np.asarray(poles, dtype=complex) * time_step
    small = np.abs(x) < 0.3
    safe = np.where(small, 1.0, x)
    phi1 = np.expm1(safe) / safe
    phi2 = (phi1 - 1.0) / safe
    # The closed form of phi2 loses eps/|x|^2 by cancellation, so near zero it is summed as sum x^j
    # / (j+2)!.
    near = np.where(small, x, 0.0)
    series = np.zeros_like(x)
    for j in range(14, -1, -1):
        series = (series * near + 1.0) / (j + 2)
    phi2 = np.where(small, series, phi2)
    phi1 = np.where(small, 1.0 + near * series, phi1)
    return np.exp(x), time_step * (phi1 - phi2), time_step * phi2


def lagged(u: np.ndarray, lag: float, time_step: float) -> np.ndarray:
    """Return y of ``lag y' + y = u`` from rest, for u that is linear between samples, shape (n,).

    Parameters
    ----------
    u : ndarray, shape (n,)
    lag, time_step : float
        s; without a lag u itself is returned.
    """
    if lag == 0.0:
        return u
    a, b0, b1 = (c.real[0] for c in ramp_coefficients(np.array([-1.0 / lag]), time_step))
    b0, b1 = b0 / lag, b1 / lag
    return lfilter([b1, b0], [1.0, -a], u, zi=-b1 * u[:1])[0]


@dataclass(frozen=True)
class LinearSystem:
    """``x' = A x + B u, y = C x``.

    Attributes
    ----------
    a : ndarray, shape (n, n)
    b : ndarray, shape (n, p)
    c : ndarray, shape (q, n)
    """

    __repr__ = brief

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray

    def sampled(self, time_step: float) -> SampledResponse:
        """Prepare the exact response at a fixed time step (s)."""
        h = number("time_step", time_step, above=0.0, unit="s")
        return SampledResponse(
            h, self, None if self.modal is None else ramp_coefficients(self.modal[0], h)
        )

    @cached_property
    def modal(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray] | None:
        """Poles, W B, C V and W of the modes with Im(s) >= 0; None if they nearly coincide."""
        # Displacements and velocities differ in size by the frequency: balanced, that does not
        # count against the eigenvectors.
        balanced, (scale, _) = matrix_balance(self.a, permute=False, separate=True)
        poles, vectors = eig(balanced)
        if np.linalg.cond(vectors) > _WORST_CONDITION:
            return None
        vectors, inverse = scale[:, None] * vectors, np.linalg.inv(vectors) / scale
        keep = poles.imag >= 0.0
        weight = np.where(poles[keep].imag > 0.0, 2.0, 1.0)
        return (
            poles[keep],
            (inverse @ self.b)[keep],
            (self.c @ vectors)[:, keep] * weight,
            inverse[keep],
        )

    def step(self, time_step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return E, B0 and B1 of the exact step ``x[k+1] = E x[k] + B0 u[k] + B1 u[k+1]``.

        The matrix exponential of the system with its input and the input's rate as further states
        gives all three, whether or not A has distinct eigenvectors.
        """
        n, p = self.b.shape
        augmented = np.zeros((n + 2 * p, n + 2 * p))
        augmented[:n, :n] = self.a * time_step
        augmented[:n, n : n + p] = self.b * time_step
        augmented[n : n + p, n + p :] = np.eye(p)
        whole = expm(augmented)
        b1 = whole[:n, n + p :]
        return whole[:n, :n], whole[:n, n : n + p] - b1, b1

    def stepped(self, u: np.ndarray, x0: np.ndarray | None, time_step: float) -> np.ndarray:
        """Run the system step by step, for the rare one whose eigenvectors nearly coincide.

        Arguments and result as for `SampledResponse`. `scipy.signal.lsim` takes the input as linear
        between samples, too, by a matrix exponential that needs no eigenvectors.
        """
        whole = self.a, self.b, self.c, np.zeros((len(self.c), self.b.shape[1]))
        time = time_step * np.arange(u.shape[-1])
        runs = u.reshape(len(u), -1, u.shape[-1])
        y = [
            lsim(whole, runs[:, i].T, time, x0)[1].reshape(len(time), -1).T
            for i in range(runs.shape[1])
        ]
        return np.stack(y, axis=1).reshape(len(self.c), *u.shape[1:])


@dataclass(frozen=True)
class SampledResponse:
    """A linear system ready to be run at one time step; made by `LinearSystem.sampled`.

    Attributes
    ----------
    time_step : float
        s.
    system : LinearSystem
    coefficients : tuple of ndarray, shape (m,), or None
        a, b0 and b1 of every mode, see `ramp_coefficients`; None where the eigenvectors nearly
        coincide.
    """

    __repr__ = brief

    time_step: float
    system: LinearSystem
    coefficients: tuple[np.ndarray, np.ndarray, np.ndarray] | None

    def __call__(self, u: np.ndarray, x0: np.ndarray | None = None) -> np.ndarray:
        """Run the system.

        Parameters
        ----------
        u : ndarray, shape (p, ..., n)
            Input at every sample; further axes are independent runs of the same system.
        x0 : ndarray, shape (states,), optional
            State at the first sample, rest if not given. The first input sample does not change it.

        Returns
        -------
        ndarray, shape (q, ..., n)
        """
        u = np.asarray(u, dtype=float)
        if self.coefficients is None:
            return self.system.stepped(u, x0, self.time_step)
        _, left, right, to_modal = self.system.modal
        a, b0, b1 = self.coefficients
        count, batch = len(a), u.shape[1:]
        start = np.zeros(count) if x0 is None else to_modal @ x0
        # Real and imaginary parts stand one above the other, so that both products below are plain
        # real ones.
        parts = np.empty((2, count, *batch))
        single = left.shape[1] == 1
        if not single:
            np.matmul(
                np.vstack([left.real, left.imag]),
                u.reshape(len(u), -1),
                out=parts.reshape(2 * count, -1),
            )
        w = u[0] if single else np.empty(batch, dtype=complex)
        for m in range(count):
            gain = left[m, 0] if single else 1.0
            if not single:
                w.real, w.imag = parts[0, m], parts[1, m]
            # A filter that starts from nothing would put b1 w[0] into the first sample.
            initial = start[m] - gain * b1[m] * w[..., :1]
            z = lfilter([gain * b1[m], gain * b0[m]], [1.0, -a[m]], w, axis=-1, zi=initial)[0]
            parts[0, m], parts[1, m] = z.real, z.imag
        y = np.hstack([right.real, -right.imag]) @ parts.reshape(2 * count, -1)
        return y.reshape(len(y), *batch)


@dataclass(frozen=True)
class SampledModes:
    """Independent oscillators ready to be run at one time step, all from rest.

    Made by `sampled_modes`.

    Attributes
    ----------
    coefficients : tuple of ndarray, shape (modes,), complex
        a, b0 and b1 of the pole with the positive imaginary part; see `ramp_coefficients`.
    poles : ndarray, shape (modes,), complex
    others : dict of SampledResponse
        Modes that do not swing, by number from 0; the general response runs them.
    """

    __repr__ = brief

    coefficients: tuple[np.ndarray, np.ndarray, np.ndarray]
    poles: np.ndarray
    others: dict[int, SampledResponse]

    def __call__(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return coordinates and velocities under modal forces, all of shape (modes, n).

        The first sample of the force does not move anything.
        """
        q, velocity = np.empty_like(force), np.empty_like(force)
        for m, (f, a, b0, b1, s) in enumerate(
            zip(force, *self.coefficients, self.poles, strict=True)
        ):
            if m in self.others:
                q[m], velocity[m] = self.others[m](f[None])
                continue
            z = lfilter([b1, b0], [1.0, -a], f, zi=-b1 * f[:1])[0]
            np.divide(z.imag, s.imag, out=q[m])
            np.multiply(q[m], s.real, out=velocity[m])
            velocity[m] += z.real
        return q, velocity


def sampled_modes(omega: np.ndarray, ratio: np.ndarray, time_step: float) -> SampledModes:
    r"""Prepare modes ``q'' + 2 ratio omega q' + omega^2 q = f`` for one time step (s).

    With the pole ``s = -ratio omega + i omega_d`` and ``z' = s z + f``, the oscillator's impulse
    response ``exp(-ratio omega t) sin(omega_d t) / omega_d`` gives ``q = Im(z) / omega_d`` and ``q'
    = Im(s z) / omega_d``: one filter a mode, without eigenvectors.
    """
    omega, ratio = np.asarray(omega, dtype=float), np.asarray(ratio, dtype=float)
    swings = (omega > 0.0) & (ratio < _NEARLY_CRITICAL)
    safe = np.where(swings, omega, 1.0), np.where(swings, ratio, 0.0)
    poles = -safe[0] * safe[1] + 1j * safe[0] * np.sqrt(1.0 - safe[1] ** 2)
    others = {
        int(m): oscillator(omega[m], ratio[m]).sampled(time_step) for m in np.flatnonzero(~swings)
    }
    return SampledModes(ramp_coefficients(poles, time_step), poles, others)


def moved_on(
    omega: np.ndarray,
    ratio: np.ndarray,
    state: tuple[np.ndarray, np.ndarray],
    force: tuple[np.ndarray, np.ndarray],
    span: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    r"""Return where modes stand a while later, for times that are not those of samples.

    With both poles, ``s1 - s2`` apart, ``z_i' = s_i z_i + f`` gives ``q = (z1 - z2) / (s1 - s2)``
    and ``q' = (s1 z1 - s2 z2) / (s1 - s2)``.

    Parameters
    ----------
    omega, ratio : ndarray, shape (modes,)
    state : (q, q'), each of shape (modes, n)
        n starts, each with its own end.
    force : (at the start, at the end), each of shape (modes, n)
        Linear between.
    span : ndarray, shape (n,)
        s.

    Returns
    -------
    q, q' : ndarray, shape (modes, n)
    """
    q, velocity = state
    # Equal poles would divide by nothing: this far apart they cost eight digits of sixteen.
    apart = np.sqrt(np.asarray(ratio, dtype=complex) ** 2 - 1.0)
    apart = np.where(np.abs(apart) < 1e-4, 1e-4j, apart)
    poles = omega * (-ratio + apart), omega * (-ratio - apart)
    z = []
    for own, other in (poles, poles[::-1]):
        a, b0, b1 = ramp_coefficients(own[:, None] * span, 1.0)
        start = velocity - other[:, None] * q
        z.append(a * start + span * (b0 * force[0] + b1 * force[1]))
    between = (poles[0] - poles[1])[:, None]
    rates = poles[0][:, None] * z[0] - poles[1][:, None] * z[1]
    return ((z[0] - z[1]) / between).real, (rates / between).real


def second_order_system(
    mass: np.ndarray,
    damping: np.ndarray,
    stiffness: np.ndarray,
    force: np.ndarray,
    output: np.ndarray,
) -> LinearSystem:
    """Write ``M x'' + C x' + K x = H u`` with the state ``(x, x')``.

    Parameters
    ----------
    mass, damping, stiffness : ndarray, shape (n, n)
    force : ndarray, shape (n, p)
        H.
    output : ndarray, shape (q, 2 n)
        Rows that act on ``(x, x')``.
    """
    n = len(mass)
    inverse = np.linalg.inv(mass)
    a = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ damping]])
    return LinearSystem(
        a, np.vstack([np.zeros_like(force), inverse @ force]), np.asarray(output, dtype=float)
    )


def oscillator(omega: float, ratio: float) -> LinearSystem:
    """Return ``q'' + 2 ratio omega q' + omega^2 q = f``, ratio >= 0, with outputs ``(q, q')``."""
    a = np.array([[0.0, 1.0], [-(omega**2), -2.0 * ratio * omega]])
    return LinearSystem(a, np.array([[0.0], [1.0]]), np.eye(2))
