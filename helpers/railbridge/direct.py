r"""Train and deck solved together at every step: no iteration.

The discrete operators are those of the iteration, so the result is its limit. One step of any
sampled system reads

    x[k+1] = E x[k] + B0 u[k] + B1 u[k+1],      y = C x,

and at k+1 the systems are coupled through the wheels now on the deck. With the deck's modal forces
f as unknowns and what is known without them marked by a star,

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

from .coupling import CoupledCar, Coupling, ForcesAdded
from .response import LinearSystem, oscillator

__all__ = ["solve_directly"]


def solve_directly(
    coupling: Coupling, progress: Callable[[str], None] | None = None
) -> ForcesAdded:
    """Return what the deck's motion adds to each car's wheel forces while it is on the deck, N.

    Wheel loads only. A step loop, about 0.1 ms a step: the iteration stays the fast path.
    """
    added = [np.array(own) for own in coupling.nothing_added()]
    cars = [
        _CarStepper(coupling, c, own)
        for c, own in zip(coupling.cars, added, strict=True)
        if c.respond is not None
    ]
    if not cars:
        return added
    modes = coupling.deck.coordinates
    deck = _Stepper(_deck_system(coupling), coupling.settings.time_step)
    steps = max(c.window.stop for c in coupling.cars)
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
    return added


def _deck_system(coupling: Coupling) -> LinearSystem:
    """All modes as one system: modal forces in, all coordinates and then all velocities out."""
    deck = coupling.deck
    pairs = zip(deck.frequencies_hz, deck.damping_ratios, strict=True)
    modes = [oscillator(2 * np.pi * frequency, ratio) for frequency, ratio in pairs]
    order = np.arange(2 * len(modes)).reshape(-1, 2).T.ravel()
    a, b = block_diag(*(m.a for m in modes)), block_diag(*(m.b for m in modes))
    return LinearSystem(a, b, np.eye(2 * len(modes))[order])


class _Stepper:
    """A linear system run one sample at a time, from rest.

    The input of the first sample does not change its state.
    """

    def __init__(self, system: LinearSystem, time_step: float) -> None:
        self.e, self.b0, self.b1 = system.step(time_step)
        self.c = system.c
        self.direct = self.c @ self.b1
        self.x = self.u = None

    def predict(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the output if the new sample's input were zero, and the output per unit of it."""
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


class _CarStepper:
    """One car while it is on the deck; its wheels and their two directions stand in one row."""

    def __init__(self, coupling: Coupling, c: CoupledCar, added: np.ndarray) -> None:
        vehicle = c.car.vehicle
        self.window, self.added = c.window, added
        self.stepper = _Stepper(vehicle.system, coupling.settings.time_step)
        self.k = vehicle.contact_stiffness.reshape(-1, 1)
        self.c = vehicle.contact_damping.reshape(-1, 1)
        rigid = c.rigid[..., c.window] + c.static[..., None]
        self.rigid = rigid.reshape(len(self.k), -1)
        self.shapes, self.slopes = (
            under.reshape(len(under), len(self.k), -1) for under in _under_wheels(coupling, c)
        )

    def predict(
        self, k: int, state: np.ndarray, reach: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the modal force that is known without the new one, and that per unit of it."""
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
        self.added[..., self.at] = (self.y + self.d @ u - u).reshape(-1, 2)
        self.stepper.correct(u)


def _under_wheels(coupling: Coupling, c: CoupledCar) -> tuple[np.ndarray, np.ndarray]:
    """Return shape and V times slope of the deck's modes under every wheel, zero off the deck.

    Both of shape (n, wheels, 2, modes).
    """
    axles = coupling.axles
    mode, component = axles.pairs
    result = np.zeros((2, c.on_deck, len(c.car.wheels), 2, coupling.deck.coordinates))
    height = coupling.deck.track_height
    for axle, station in zip(c.car.axles, c.axles, strict=True):
        count = int(axles.counts[station])
        start = int(axles.starts[station]) - c.window.start
        window = slice(start, start + count)
        for under, table, factor in zip(
            result, axles.tables[axles.which[station]], (1.0, axles.speed), strict=True
        ):
            values = factor * table[:, :count].T
            for wheel in axle.wheels:
                y = coupling.settings.track_offset + wheel.y
                # The rail moves sideways by v - h theta and up by w + y theta.
                weights = ((1.0, 0.0, -height), (0.0, 1.0, y))
                for pair, (m, part) in enumerate(zip(mode, component, strict=True)):
                    for direction in (0, 1):
                        if weights[direction][part]:
                            under[window, wheel.number - 1, direction, m] += (
                                weights[direction][part] * values[:, pair]
                            )
    return result[0], result[1]
