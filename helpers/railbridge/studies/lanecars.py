"""A car of many crossings side by side: its modes, a column for each crossing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

__all__ = ["LaneCar", "parts_of"]


@dataclass(eq=False)
class LaneCar:
    """One car of all lanes: its modes, and where they stand for the rigid deck and each pass.

    Attributes
    ----------
    poles : ndarray, shape (modes,)
    a, b0, b1 : ndarray, shape (modes, lanes)
        See `response.ramp_coefficients`.
    left : (real, imaginary), each shape (modes, wheel directions)
        What drives the modes, from k r + c r'.
    right : (real, imaginary), each shape (wheel directions, modes)
        What the springs carry.
    felt : (real, imaginary), each shape (modes, 6 axles)
        What drives the modes, from the deck's motion below the axles and its rate.
    shown : (real, imaginary), each shape (3 axles, modes)
        What the springs carry as loads of the axles about the deck's axis.
    direct : ndarray, shape (3 axles, 6 axles)
        What the deck's motion takes off these loads.
    to_wheels : ndarray, shape (wheel directions, 6 axles)
        k w + c w' of the wheels.
    wheels, axles : slice
        Rows of its wheels' directions, and of its axles' y, z and roll.
    states : list of ndarray, shape (modes, lanes)
    """

    poles: np.ndarray
    a: np.ndarray
    b0: np.ndarray
    b1: np.ndarray
    left: tuple[np.ndarray, np.ndarray]
    right: tuple[np.ndarray, np.ndarray]
    felt: tuple[np.ndarray, np.ndarray]
    shown: tuple[np.ndarray, np.ndarray]
    direct: np.ndarray
    to_wheels: np.ndarray
    wheels: slice
    axles: slice
    states: list[np.ndarray]

    def __post_init__(self) -> None:
        self._drive, self._work = np.empty((2, *self.a.shape), dtype=complex)

    def _driven(self, number: int, by: tuple[np.ndarray, np.ndarray], u: np.ndarray) -> np.ndarray:
        """Add what a sample's input does there; return real and imaginary parts in turn."""
        self._drive.real, self._drive.imag = by[0] @ u, by[1] @ u
        state = self.states[number]
        state += np.multiply(self.b1, self._drive, out=self._work)
        return state.view(float)

    def _go_on(self, number: int) -> None:
        state = self.states[number]
        state *= self.a
        state += np.multiply(self.b0, self._drive, out=self._work)

    def rigid_forces(self, u: np.ndarray) -> np.ndarray:
        """Go on to a sample with k r + c r' below the wheels; return the wheel forces there."""
        result = _real_of(self.right, self._driven(0, self.left, u)) - u
        self._go_on(0)
        return result

    def start(self, standing: np.ndarray, u: np.ndarray) -> None:
        """Let the modes stand somewhere at the first sample, with k r + c r' below the wheels."""
        self.states[0][:] = standing - self.b1 * (self.left[0] @ u + 1j * (self.left[1] @ u))

    def added(
        self, number: int, motion: np.ndarray, wheels: bool
    ) -> tuple[np.ndarray, np.ndarray | None]:
        """Go on to a sample with a motion of the deck below the axles.

        Return what that adds to the axles' loads, and to the wheel forces.
        """
        parts = self._driven(number, self.felt, motion)
        loads = _real_of(self.shown, parts) - self.direct @ motion
        forces = _real_of(self.right, parts) - self.to_wheels @ motion if wheels else None
        self._go_on(number)
        return loads, forces


def _real_of(matrix: tuple[np.ndarray, np.ndarray], parts: np.ndarray) -> np.ndarray:
    """Return the real part of a product: of two real products every other number."""
    return (matrix[0] @ parts)[:, ::2] - (matrix[1] @ parts)[:, 1::2]


def parts_of(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return real and imaginary part, each in one piece."""
    return np.ascontiguousarray(values.real), np.ascontiguousarray(values.imag)
