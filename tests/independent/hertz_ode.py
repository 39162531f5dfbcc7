"""A sprung mass on a wheel on a beam, with a contact after Hertz, as plain differential equations.

Written for the tests from Newton's laws, without the package: scipy's adaptive integrator at a
tight tolerance, so that a wheel that leaves the rail does so between any samples.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

G = 9.81


@dataclass(frozen=True)
class Rider:
    """A body on a spring and damper on a wheel.

    The contact's tangent at the static load has the stiffness `contact` and the damping `loss`.
    """

    wheel: float
    body: float
    stiffness: float
    damping: float
    contact: float
    loss: float = 0.0

    @property
    def load(self):
        """Static load of the wheel, N."""
        return (self.wheel + self.body) * G


def crossing(rider, speed, length, ei, mass, ratio, modes, rail, times, unilateral=True):
    """Return wheel force on the beam (N, down positive) and mid-span displacement (m).

    The wheel is at x = speed t (m) and at rest at first; `rail` are r(x) and dr/dx.
    """
    n = np.arange(1, modes + 1)
    omega = (n * np.pi / length) ** 2 * np.sqrt(ei / mass)
    depth = 1.5 * rider.load / rider.contact

    def shape(x):
        inside = 0.0 <= x <= length
        return np.sin(n * np.pi * x / length) * np.sqrt(2.0 / (mass * length)) * inside

    def slope(x):
        k = n * np.pi / length
        inside = 0.0 <= x <= length
        return k * np.cos(k * x) * np.sqrt(2.0 / (mass * length)) * inside

    def force(x, q, v, zw, vw):
        d = depth + shape(x) @ q + rail[0](x) - zw
        rate = shape(x) @ v + speed * (slope(x) @ q + rail[1](x)) - vw
        if not unilateral:
            return rider.load + rider.contact * (d - depth) + rider.loss * rate
        law = rider.load * (max(d, 0.0) / depth) ** 1.5
        return max(law * (1.0 + rider.loss / rider.load * rate), 0.0)

    def rates(t, s):
        q, v = s[:modes], s[modes : 2 * modes]
        zw, zb, vw, vb = s[2 * modes :]
        x = speed * t
        p = force(x, q, v, zw, vw)
        spring = rider.stiffness * (zb - zw) + rider.damping * (vb - vw)
        return np.concatenate(
            [
                v,
                -2 * ratio * omega * v - omega**2 * q - shape(x) * p,
                [vw, vb, (p - rider.load + spring) / rider.wheel, -spring / rider.body],
            ]
        )

    y0 = np.zeros(2 * modes + 4)
    found = solve_ivp(
        rates, (times[0], times[-1]), y0, "DOP853", times, rtol=1e-10, atol=1e-13, max_step=5e-4
    )
    q, v, (zw, _, vw, _) = np.split(found.y, [modes, 2 * modes])
    forces = [force(speed * t, *s) for t, *s in zip(times, q.T, v.T, zw, vw, strict=True)]
    return np.array(forces), shape(length / 2) @ q
