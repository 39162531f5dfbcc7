"""Constant forces that roll over a simple beam, mode by mode in closed form.

For an undamped or damped mode of an Euler-Bernoulli beam, q'' + 2 z w q' + w^2 q = P phi(V t) with
phi = sin(n pi x / L), solved exactly for each force: forced and free part while it is on the beam,
free vibration after. Nothing of the suite is used. Displacement and acceleration at any place and
time, so that peaks can be searched as finely as one likes.
"""

import numpy as np


class SimpleBeam:
    """Span, mass per metre, bending stiffness; damping ratio of each mode."""

    def __init__(self, length, mass, stiffness, ratios):
        self.length, self.mass = length, mass
        n = np.arange(1, len(ratios) + 1)
        self.n = n
        self.omega = (n * np.pi / length) ** 2 * np.sqrt(stiffness / mass)
        self.ratio = np.asarray(ratios)

    def one_force(self, t, speed):
        """q, q'' of all modes for a unit force that enters at t = 0; shape (modes, times)."""
        w, z, t = self.omega[:, None], self.ratio[:, None], np.asarray(t)[None, :]
        o = (self.n * np.pi * speed / self.length)[:, None]  # how fast the mode is driven
        m = self.mass * self.length / 2
        s = -z * w + 1j * w * np.sqrt(1 - z**2)
        # Forced: Im(X e^{i o t}); free: such that q(0) = q'(0) = 0.
        forced = 1 / m / (w**2 - o**2 + 2j * z * w * o)
        q0, v0 = forced.imag, (1j * o * forced).imag
        # free = Re(C e^{s t}) with Re C = -q0, Re(s C) = -v0
        real = -q0
        imag = (v0 + s.real * real) / s.imag
        free = real + 1j * imag
        crossing = self.length / speed
        on = (t >= 0) & (t <= crossing)

        def state(time):
            wave, swing = forced * np.exp(1j * o * time), free * np.exp(s * time)
            q = wave.imag + swing.real
            v = (1j * o * wave).imag + (s * swing).real
            a = (-(o**2) * wave).imag + (s**2 * swing).real
            return q, v, a

        q, _, a = state(np.where(on, t, 0.0))
        q, a = np.where(on, q, 0.0), np.where(on, a, 0.0)
        qe, ve, _ = state(np.full_like(t, crossing))
        later = np.where(t > crossing, t - crossing, 0.0)
        gone_imag = (s.real * qe - ve) / s.imag
        gone = (qe + 1j * gone_imag) * np.exp(s * later)
        after = t > crossing
        return np.where(after, gone.real, q), np.where(after, (s**2 * gone).real, a)

    def response(self, t, x, places, loads, speed):
        """Displacement and acceleration at x, down positive, under axles at places behind."""
        shape = np.sin(self.n * np.pi * x / self.length)
        w = np.zeros(len(t))
        a = np.zeros(len(t))
        for place, load in zip(places, loads, strict=True):
            q, qdd = self.one_force(t - place / speed, speed)
            w += load * (shape @ q)
            a += load * (shape @ qdd)
        return w, a
