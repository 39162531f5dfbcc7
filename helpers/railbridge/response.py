r"""Exact response of a linear system to sampled, piecewise-linear input.

The system is ``x' = A x + B u, y = C x``. With ``A = V diag(s) W`` and ``W = inv(V)``, each modal
coordinate ``z = W x`` obeys ``z' = s z + w`` with ``w = W B u``. If w runs linearly from ``w[k]``
to ``w[k+1]`` over a step h, the solution at the end of the step is, exactly,

    z[k+1] = a z[k] + b0 w[k] + b1 w[k+1],
    a = exp(s h),   b1 = h phi2(s h),   b0 = h (phi1(s h) - phi2(s h)),
    phi1(x) = (exp(x) - 1) / x,   phi2(x) = (phi1(x) - 1) / x.

This is a first-order digital filter for each mode. It has no stability limit and no algorithmic
damping; its only error is that the input is sampled. Shock-spectrum practice knows it as the
ramp-invariant filter (Smallwood 1981; ISO 18431-4).

It is run a block of B samples at a time. What a mode keeps from one sample to the next is
``z~[k] = z[k] - b1 w[k]``, with ``z~[k+1] = a z~[k] + c w[k]`` and ``c = b0 + a b1``. So within a
block that starts at z~,

    z[k] = a^k z~ + b1 w[k] + c (w[k-1] + a w[k-2] + ... + a^(k-1) w[0]),
    z~ of the next block = a^B z~ + c (w[B-1] + a w[B-2] + ... + a^(B-1) w[0]).

All blocks of the first line are one product of matrices, input and start to output; only the second
goes from block to block. A recursion moves one number at a time, a product fills the processor:
that is ten times faster, and nothing but the order of the sums changes. (A real second-order filter
for q would save half; but its coefficients, near those of ``(1 - 1/x)^2``, lose
eps / (omega h)^2, which these do not.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import eig, expm, matrix_balance
from scipy.signal import lfilter, lsim

from .errors import brief, number

__all__ = [
    "LinearSystem", "SampledModes", "SampledResponse", "lagged", "moved_on", "oscillator",
    "ramp_coefficients", "relaxing", "sampled_modes", "second_order_system",
]  # fmt: skip

_WORST_CONDITION = 1e6
"""Condition of the eigenvectors above which the modes are not trusted: about ten digits would be
left."""
_NEARLY_CRITICAL = 1e-4
"""Distance of a damping ratio from 1 within which ``(z1 - z2) / (s1 - s2)`` would lose digits."""
_BLOCK, _MODES_BLOCK = 8, 16
"""Samples of a block: longer ones multiply more, shorter ones go from block to block more often."""
_GROUP = 16
"""Blocks of a group, see `_starts`."""
_TOGETHER = 256
"""Blocks multiplied at once: what they give is put in its place while it is at hand."""


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
        _, _, right, to_modal = self.system.modal
        start = np.zeros(right.shape[1]) if x0 is None else to_modal @ x0
        runs = u.reshape(len(u), -1, u.shape[-1])
        rows, _ = self._rows(runs, start)
        y = self._outputs(rows, self._blocks[0])[..., : u.shape[-1]]
        # The first sample is the start itself, to the last digit.
        y[..., 0] = (right @ start).real[:, None]
        return y.reshape(len(y), *u.shape[1:])

    def after(self, u: np.ndarray, samples: int) -> np.ndarray:
        """Return how it decays from the sample behind an input's last, where the input is gone.

        Parameters
        ----------
        u : ndarray, shape (p, ..., n)
            From rest.
        samples : int

        Returns
        -------
        ndarray, shape (q, ..., samples)
        """
        n = u.shape[-1]
        if self.coefficients is None:
            longer = np.concatenate([u, np.zeros((*u.shape[:-1], samples))], axis=-1)
            return self(longer)[..., n:]
        product, _, decay = self._blocks
        rows, end = self._rows(u.reshape(len(u), -1, n), np.zeros(len(decay)))
        blocks = -(-samples // _BLOCK)
        passed = self.time_step * _BLOCK * np.arange(blocks)[:, None]
        z = end[:, None] * np.exp(self.system.modal[0] * passed)
        y = [
            self._outputs(rows[:, -1:], product),
            self._outputs(np.concatenate([z.real, z.imag], axis=2), product[-2 * len(decay) :]),
        ]
        # What fills the last block up is behind the input already.
        first = (n - 1) % _BLOCK + 1
        y = np.concatenate(y, axis=2)[..., first : first + samples]
        return y.reshape(len(y), *u.shape[1:-1], samples)

    def _rows(self, runs: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return a row a block: its input, and the z~ it starts with, all real parts first.

        Parameters
        ----------
        runs : ndarray, shape (p, runs, n)
        start : ndarray, shape (m,)

        Returns
        -------
        rows : ndarray, shape (runs, blocks, p B + 2 m)
            Inputs that act alike added up, and those that act on nothing left out.
        end : ndarray, shape (runs, m)
            z~ behind the last block.
        """
        _, gain, decay = self._blocks
        acting = self._inputs
        together = [runs[own].sum(axis=0) if len(own) > 1 else runs[own[0]] for own in acting]
        rows = _in_blocks(together, _BLOCK, 2 * len(decay))
        width = len(acting) * _BLOCK
        added = rows[..., :width] @ gain
        first = start - (runs[..., 0].T @ self.system.modal[1].T) * self.coefficients[2]
        parts = np.moveaxis(added.reshape(*added.shape[:2], 2, len(decay)), (2, 3), (0, 1))
        more = parts[0] + 1j * parts[1]
        z = _starts(more, decay, first.T)
        room = rows[..., width:].reshape(*rows.shape[:2], 2, len(decay))
        room[:, :, 0], room[:, :, 1] = (np.moveaxis(part, 0, -1) for part in (z.real, z.imag))
        return rows, decay * z[..., -1].T + more[..., -1].T

    def _outputs(self, rows: np.ndarray, product: np.ndarray) -> np.ndarray:
        """Return the outputs of blocks, shape (q, runs, samples of all blocks)."""
        runs, blocks, _ = rows.shape
        y = np.empty((len(self.system.c), runs, blocks, _BLOCK))
        for r, own in enumerate(rows):
            for first in range(0, blocks, _TOGETHER):
                some = slice(first, first + _TOGETHER)
                part = (own[some] @ product).reshape(-1, product.shape[1] // _BLOCK, _BLOCK)
                for same, values in zip(y, self._same_outputs, strict=True):
                    same[r, some] = part[:, values]
        return y.reshape(len(y), runs, -1)

    @cached_property
    def _inputs(self) -> list[np.ndarray]:
        """Numbers of the inputs that act alike, as both wheels of an axle do sideways.

        Without those that act on nothing: a wheel may have no spring in a direction.
        """
        found: dict[bytes, list[int]] = {}
        for i, column in enumerate(self.system.b.T + 0.0):
            if column.any():
                found.setdefault(column.tobytes(), []).append(i)
        return [np.array(own) for own in found.values()] or [np.array([0])]

    @cached_property
    def _same_outputs(self) -> list[int]:
        """Which of the outputs that differ each output is."""
        found: dict[bytes, int] = {}
        return [found.setdefault(row.tobytes(), len(found)) for row in self.system.c + 0.0]

    @cached_property
    def _blocks(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What runs a block of samples, from the module's two lines.

        From its p B inputs and 2 m parts of z~, to its q B outputs; from the inputs to the parts
        of what they add to the next block's z~; and a^B.
        """
        poles, left, right, _ = self.system.modal
        left = left[:, [own[0] for own in self._inputs]]
        right = right[np.unique(self._same_outputs, return_index=True)[1]]
        powers, carried, pulse = _pulse(poles, self.coefficients, self.time_step, _BLOCK)
        kernel = ((right * pulse.T[:, None]) @ left).real
        through = _delayed(np.moveaxis(kernel, 0, -1)).transpose(1, 2, 0, 3)
        free = right.T[:, :, None] * powers[:, None, :-1]
        outputs = len(right) * _BLOCK
        rows = [m.reshape(-1, outputs) for m in (through, free.real, -free.imag)]
        gain = (left.T[:, None] * carried.T).reshape(-1, len(poles))
        return np.vstack(rows), np.hstack([gain.real, gain.imag]), powers[:, -1].copy()


@dataclass(frozen=True)
class SampledModes:
    """Independent oscillators ready to be run at one time step, all from rest.

    Made by `sampled_modes`. What a block of samples starts with are, of a mode that swings, the
    parts of z~ of its pole with the positive imaginary part; of one that creeps, z~ of both poles.

    Attributes
    ----------
    swings : ndarray of bool, shape (modes,)
    first : ndarray, shape (2, modes)
        z~ at the first sample per unit of its force.
    gain : ndarray, shape (modes, B, 2)
        From the forces of a block to what they add to the next one's start.
    decay : ndarray, shape (2, modes), complex
        a^B of both poles.
    within : ndarray, shape (2, modes, B + 2, B)
        From the forces and the start of a block to coordinates and velocities.
    others : dict of SampledResponse
        Modes that are all but critically damped or have no stiffness, by number from 0; the general
        response runs them.
    """

    __repr__ = brief

    swings: np.ndarray
    first: np.ndarray
    gain: np.ndarray
    decay: np.ndarray
    within: np.ndarray
    others: dict[int, SampledResponse]

    def __call__(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return coordinates and velocities under modal forces, all of shape (modes, n).

        The first sample of the force does not move anything.
        """
        size, (modes, samples) = self.gain.shape[1], force.shape
        blocks, whole = -(-samples // size), samples // size
        start = self.first * force[:, 0]
        added = np.zeros((modes, blocks, 2))
        in_blocks = force[:, : whole * size].reshape(modes, whole, size)
        np.matmul(in_blocks, self.gain, out=added[:, :whole])
        swings, creeps = self.swings, ~self.swings
        more = [added[swings, :, 0] + 1j * added[swings, :, 1], *added[creeps].transpose(2, 0, 1)]
        first = [start[0, swings] + 1j * start[1, swings], *start[:, creeps]]
        decay = [self.decay[0, swings], *self.decay[:, creeps]]
        z = _starts(*(np.concatenate(each) for each in (more, decay, first)))
        z, slow, quick = np.split(z, np.cumsum([swings.sum(), creeps.sum()]))
        added[swings, :, 0], added[swings, :, 1] = z.real, z.imag
        added[creeps, :, 0], added[creeps, :, 1] = slow.real, quick.real
        # One mode after the other, in one place: memory asked for anew costs more than it is worth.
        result, row = np.empty((2, modes, blocks * size)), np.zeros((blocks, size + 2))
        for m in range(modes):
            row[:whole, :size], row[:, size:] = in_blocks[m], added[m]
            row[whole:, : samples - whole * size] = force[m, whole * size :]
            for values, within in zip(result, self.within, strict=True):
                np.matmul(row, within[m], out=values[m].reshape(blocks, size))
        q, velocity = result[..., :samples]
        q[:, 0] = velocity[:, 0] = 0.0
        for m, system in self.others.items():
            q[m], velocity[m] = system(force[m][None])
        return q, velocity


def sampled_modes(omega: np.ndarray, ratio: np.ndarray, time_step: float) -> SampledModes:
    r"""Prepare modes ``q'' + 2 ratio omega q' + omega^2 q = f`` for one time step (s).

    With both poles, ``z_i' = s_i z_i + f`` gives ``q = (z1 - z2) / (s1 - s2)`` and ``q' = (s1 z1 -
    s2 z2) / (s1 - s2)``, without eigenvectors. Where the mode swings the poles are conjugates, and
    these are ``Im(z1) / omega_d`` and ``Im(s1 z1) / omega_d``: one pole is enough.
    """
    omega, ratio = np.asarray(omega, dtype=float), np.asarray(ratio, dtype=float)
    special = (omega <= 0.0) | (np.abs(ratio - 1.0) <= _NEARLY_CRITICAL)
    omega_, ratio_ = np.where(special, 1.0, omega), np.where(special, 0.0, ratio)
    apart = np.sqrt((ratio_ - 1.0).astype(complex)) * np.sqrt(ratio_ + 1.0)
    fast, swings = ratio_ + apart, apart.imag > 0.0
    # The slow one of two real roots by their product, which is 1: their difference loses digits.
    # Conjugates are made so to the last digit.
    poles = -omega_ * np.array([np.where(swings, fast.conj(), 1.0 / fast), fast])
    coefficients = ramp_coefficients(poles, time_step)
    powers, carried, pulse = _pulse(poles, coefficients, time_step, _MODES_BLOCK)
    outputs = np.array([np.ones_like(poles), poles]) * [[1.0], [-1.0]] / (poles[0] - poles[1])
    # Of modes that swing the second pole only doubles what the first gives.
    weight = np.where(swings, [[2.0], [0.0]], 1.0)
    share = outputs * weight
    kernel = np.einsum("opm,pmj->omj", share, pulse).real
    free = share[..., None] * powers[..., :-1]
    both = free[:, 0].real, -free[:, 0].imag
    states = np.where(swings[:, None], both, free.real.swapaxes(0, 1))
    within = np.concatenate([_delayed(kernel), np.moveaxis(states, 0, 2)], axis=2)
    gain = np.where(swings[:, None], [carried[0].real, carried[0].imag], carried.real)
    first = -coefficients[2]
    first = np.where(swings, [first[0].real, first[0].imag], first.real)
    others = {
        int(m): oscillator(omega[m], ratio[m]).sampled(time_step) for m in np.flatnonzero(special)
    }
    # As they come back from another process: products of arrays in another order differ in the last
    # digit on some processors.
    gain, decay, within = map(
        np.ascontiguousarray, (np.moveaxis(gain, 0, -1), powers[..., -1], within)
    )
    return SampledModes(swings, first, gain, decay, within, others)


def _pulse(
    poles: np.ndarray, coefficients: tuple[np.ndarray, ...], time_step: float, size: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return what the module's two lines for a block of so many samples consist of.

    Returns
    -------
    powers : ndarray, shape (..., size + 1)
        a^k.
    carried : ndarray, shape (..., size)
        ``c a^(size-1-j)``: what a unit of w[j] adds to the next block's start.
    pulse : ndarray, shape (..., size)
        ``b1, c, c a, ...``: z[k] for w = 1, 0, 0 ...
    """
    a, b0, b1 = coefficients
    powers = np.exp(poles[..., None] * time_step * np.arange(size + 1))
    c = (b0 + a * b1)[..., None]
    pulse = np.concatenate([b1[..., None], c * powers[..., : size - 1]], axis=-1)
    return powers, c * powers[..., size - 1 :: -1], pulse


def _delayed(kernel: np.ndarray) -> np.ndarray:
    """Return the matrix from input j to output k of a block, ``kernel[..., k - j]``, else zero."""
    size = kernel.shape[-1]
    lag = np.arange(size) - np.arange(size)[:, None]
    return np.where(lag >= 0, kernel[..., np.maximum(lag, 0)], 0.0)


def _in_blocks(u: Sequence[np.ndarray], size: int, more: int) -> np.ndarray:
    """Return a row for each block of samples, shape (runs, blocks, inputs size + more).

    Input by input, each of shape (runs, samples), and room for `more` numbers. Zeros fill the last
    block up.
    """
    runs, samples = u[0].shape
    whole, rest = divmod(samples, size)
    rows = np.empty((runs, whole + (rest > 0), len(u) * size + more))
    for i, own in enumerate(u):
        place = rows[..., i * size : (i + 1) * size]
        place[:, :whole] = own[:, : whole * size].reshape(runs, whole, size)
        if rest:
            place[:, whole, :rest], place[:, whole, rest:] = own[:, whole * size :], 0.0
    return rows


def _starts(added: np.ndarray, decay: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Return ``z[i+1] = decay z[i] + added[i]`` from the first one on.

    In the same way as the samples: a product within groups of blocks, then from group to group,
    here by doubling, ``z[i] + d z[i-1] + d^2 (z[i-2] + d z[i-3]) ...``, all modes at once.

    Parameters
    ----------
    added : ndarray, shape (m, ..., blocks), complex
    decay : ndarray, shape (m,), complex
    first : ndarray, shape (m, ...), complex

    Returns
    -------
    ndarray, shape (m, ..., blocks), complex
    """
    blocks, size = added.shape[-1], _GROUP
    x = np.zeros((*added.shape[:-1], -(-blocks // size) * size), dtype=complex)
    x[..., 0] = first
    x[..., 1:blocks] = added[..., :-1]
    steps = np.repeat(decay[:, None], size, axis=1)
    powers = np.cumprod(np.concatenate([np.ones((len(decay), 1)), steps], axis=1), axis=1)
    z = x.reshape(len(decay), -1, size) @ _delayed(powers[:, :size])
    z = z.reshape(*x.shape[:-1], -1, size)
    carried, reach = z[..., -1].copy(), 1
    factor = powers[:, size].reshape(-1, *[1] * (carried.ndim - 1))
    while reach < carried.shape[-1]:
        carried[..., reach:] += factor * carried[..., :-reach]
        factor, reach = factor * factor, 2 * reach
    onward = powers[:, 1:].reshape(len(decay), *[1] * (z.ndim - 2), size)
    z[..., 1:, :] += carried[..., :-1, None] * onward
    return z.reshape(x.shape)[..., :blocks]


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


def relaxing(
    system: LinearSystem,
    mass: np.ndarray,
    rows: np.ndarray,
    stiffness: np.ndarray,
    damping: np.ndarray,
) -> LinearSystem:
    """Add dampers that act through a spring (Maxwell) to a system of `second_order_system`.

    Each is one more state, its force f: ``f' = k g.x' - (k/c) f``, and ``-g f`` acts on x.

    Parameters
    ----------
    system : LinearSystem
        With the state ``(x, x')``.
    mass : ndarray, shape (n, n)
    rows : ndarray, shape (m, n)
        g, the stretch of each.
    stiffness, damping : ndarray, shape (m,)
        k of the spring, c of the damper; both above 0.

    Returns
    -------
    LinearSystem
        With the state ``(x, x', f)``; the same system if there are none.
    """
    m, n = rows.shape
    if m == 0:
        return system
    pushes = np.vstack([np.zeros((n, m)), -np.linalg.solve(mass, rows.T)])
    follows = np.hstack([np.zeros((m, n)), stiffness[:, None] * rows])
    a = np.block([[system.a, pushes], [follows, -np.diag(stiffness / damping)]])
    b = np.vstack([system.b, np.zeros((m, system.b.shape[1]))])
    return LinearSystem(a, b, np.hstack([system.c, np.zeros((len(system.c), m))]))


def oscillator(omega: float, ratio: float) -> LinearSystem:
    """Return ``q'' + 2 ratio omega q' + omega^2 q = f``, ratio >= 0, with outputs ``(q, q')``."""
    a = np.array([[0.0, 1.0], [-(omega**2), -2.0 * ratio * omega]])
    return LinearSystem(a, np.array([[0.0], [1.0]]), np.eye(2))
