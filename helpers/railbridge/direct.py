r"""Train and deck solved together at every step: no iteration.

The discrete operators are those of the iteration, so the result is its limit. One step of any sampled system reads

    x[k+1] = E x[k] + B0 u[k] + B1 u[k+1],      y = C x,

and at k+1 the systems are coupled through the wheels now on the deck. With the deck's modal forces f as unknowns and what
is known without them marked by a star,

    (q, q') = (q, q')* + B f                    the deck's modes,
    u = P q + R q'                              what the wheels feel, k w + c w',
    F = F* + (D - 1) u                          what the wheels exert, D = C B1 of the vehicle,
    f = N^T F                                   what the deck feels,

which leaves one linear system of the size of the number of modes at every step.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import block_diag

from .coupling import Coupling, Delta
from .response import LinearSystem, oscillator

__all__ = ["direct"]


def direct(coupling: Coupling, progress: Callable[[str], None] | None = None) -> Delta:
    """Return what the deck's motion adds to each car's wheel forces while it is on the deck, N. Wheel loads only.

    A step loop, about 0.1 ms a step: the iteration stays the fast path.
    """
    if not coupling.vehicles:
        return coupling.at_rest()
    modes = len(coupling.deck.frequencies_hz)
    deck = _Stepper(_deck_system(coupling), coupling.settings.time_step)
    cars = [_Car(coupling, car) for car in range(len(coupling.windows))]
    steps = max(w.stop for w in coupling.windows)
    for k in range(steps):
        if progress is not None and k % 500 == 0:
            progress(f"step {k} of {steps}")
        state, reach = deck.predict()
        here = [c for c in cars if c.window.start <= k < c.window.stop]
        force, coupled = np.zeros(modes), np.eye(modes)
        for car in here:
            known, feedback = car.predict(k, state, reach)
            force += known
            coupled -= feedback
        force = np.linalg.solve(coupled, force)
        state = state + reach @ force
        deck.correct(force)
        for car in here:
            car.correct(state)
    return [c.delta for c in cars]


def _deck_system(coupling: Coupling) -> LinearSystem:
    """All modes as one system: modal forces in, all coordinates and then all velocities out."""
    deck = coupling.deck
    modes = [oscillator(2 * np.pi * f, z) for f, z in zip(deck.frequencies_hz, deck.damping_ratios, strict=True)]
    order = np.arange(2 * len(modes)).reshape(-1, 2).T.ravel()
    return LinearSystem(block_diag(*(m.a for m in modes)), block_diag(*(m.b for m in modes)), np.eye(2 * len(modes))[order])


class _Stepper:
    """A linear system run one sample at a time, from rest; the input of the first sample does not change its state."""

    def __init__(self, system: LinearSystem, time_step: float) -> None:
        self.e, self.b0, self.b1 = system.step(time_step)
        self.c = system.c
        self.direct = self.c @ self.b1
        self.x = self.u = None

    def predict(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the output if the new sample's input were zero, and the output per unit of that input."""
        if self.u is None:
            self.x = np.zeros(len(self.e))
            return self.c @ self.x, np.zeros_like(self.direct)
        self.x = self.e @ self.x + self.b0 @ self.u
        return self.c @ self.x, self.direct

    def correct(self, u: np.ndarray) -> None:
        """Take the new sample's input."""
        if self.u is not None:
            self.x = self.x + self.b1 @ u
        self.u = u


class _Car:
    """One car while it is on the deck, with the deck's shapes under its wheels."""

    def __init__(self, coupling: Coupling, car: int) -> None:
        vehicle = coupling.train.vehicles[car]
        self.window = coupling.windows[car]
        self.stepper = _Stepper(vehicle.system(), coupling.settings.time_step)
        self.k, self.c = vehicle.contact_stiffness.ravel()[:, None], vehicle.contact_damping.ravel()[:, None]
        self.rigid = coupling.rigid[car][:, self.window] + coupling.static[car][:, None]
        self.delta = coupling.at_rest()[car]
        self.shapes, self.slopes = self._under_wheels(coupling, car)

    def _under_wheels(self, coupling: Coupling, car: int) -> tuple[np.ndarray, np.ndarray]:
        """Return shape and V times slope under every wheel and direction, shape (n, 2 wheels, modes); zero off the deck."""
        axles, contacts = coupling.axles, coupling.train.vehicles[car].contacts
        mode, component = axles.pairs
        shape = self.window.stop - self.window.start, 2 * len(contacts), len(coupling.deck.frequencies_hz)
        result = np.zeros((2, *shape))
        height = coupling.deck.track_height
        for i, (axle, contact) in enumerate(zip(coupling.axle_of[car], contacts, strict=True)):
            start = int(axles.starts[axle]) - self.window.start
            window = slice(start, start + int(axles.counts[axle]))
            y = coupling.settings.track_offset + contact.y
            for target, table, factor in zip(result, axles.tables[axles.which[axle]], (1.0, axles.speed), strict=True):
                values = factor * table[:, : int(axles.counts[axle])].T
                for pair, (m, c) in enumerate(zip(mode, component, strict=True)):
                    # The rail moves sideways by v - h theta and up by w + y theta.
                    for row, weight in ((2 * i, (1.0, 0.0, -height)[c]), (2 * i + 1, (0.0, 1.0, y)[c])):
                        if weight:
                            target[window, row, m] += weight * values[:, pair]
        return result[0], result[1]

    def predict(self, k: int, state: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the modal force that is known without the new one, and the modal force per unit of the new one."""
        self.at = k - self.window.start
        shapes = self.shapes[self.at]
        self.feel = np.hstack([self.k * shapes + self.c * self.slopes[self.at], self.c * shapes])
        self.y, self.d = self.stepper.predict()
        exert = self.d - np.eye(len(self.d))
        known = self.rigid[:, self.at] + self.y + exert @ (self.feel @ state)
        return shapes.T @ known, shapes.T @ (exert @ (self.feel @ reach))

    def correct(self, state: np.ndarray) -> None:
        """Take the deck's final state at this sample."""
        u = self.feel @ state
        self.delta[:, self.at] = self.y + self.d @ u - u
        self.stepper.correct(u)
