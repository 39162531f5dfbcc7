"""What stepping train and deck together needs, as arrays; see `stepping` for the formulas."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..coupling import CoupledCar, Coupling
from ..errors import brief
from ..guideways import Stations
from ..response import SampledResponse, oscillator, ramp_coefficients
from ..tracks import Track
from ..trains import rail_input

__all__ = ["CarSteps", "Plan", "plan"]


@dataclass(frozen=True, eq=False)
class CarSteps:
    """One kind of car, ready to be stepped. Wheels have two directions each, d in all.

    Attributes
    ----------
    decay : ndarray, shape (m,) or (m, m)
        S; complex where the car's modes are known, of which only one of each pair is kept.
    drive : ndarray, shape (m, d)
        Q.
    show : ndarray, shape (d, m)
        R.
    direct : ndarray, shape (d, d)
        D - 1: from U to F in the same sample.
    stiffness, damping : ndarray, shape (d, 3 axles)
        K and C.
    loads : ndarray, shape (rows, d)
        L.
    """

    __repr__ = brief

    decay: np.ndarray
    drive: np.ndarray
    show: np.ndarray
    direct: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    loads: np.ndarray

    @property
    def at_rest(self) -> np.ndarray:
        """Where it starts: s, all zero."""
        return np.zeros(len(self.drive), self.drive.dtype)


@dataclass(frozen=True, eq=False)
class Plan:
    """All that the loop needs. Cars are numbered from 0; axles and load stations car by car.

    Attributes
    ----------
    onward : ndarray, shape (6, modes)
        Of every mode: q from q and q', q' from q and q', q and q' from the force of the sample
        before.
    reach : ndarray, shape (2, modes)
        r_q, r_v.
    tables : tuple of ndarray, shape (samples on the deck, 2, 3, modes)
        Shapes and V times slopes below an axle, for each way axles meet the samples.
    load_tables : tuple of ndarray, shape (samples on the deck, 3 or 5, modes)
        Rows of Psi of a load station.
    axles, loads : ndarray of int, shape (stations, 3)
        First sample, number of samples, table of every axle and load station.
    of_cars : ndarray of int, shape (cars, 4)
        First axle, number of axles, first load station, number of load stations of every car.
    cars : tuple of CarSteps
        Of every car; cars of one kind share theirs.
    windows : ndarray of int, shape (cars, 2)
        First sample, at rest, and the one behind the last that a car is stepped.
    known : tuple of ndarray, shape (d, samples of the window)
        F_known.
    first, samples : int
        The first sample, not above 0, and how many there are from 0 on.
    rail : tuple of ndarray, shape (d, samples of the window), or None
        u_rail; None where the contact is permanent.
    pressed : tuple of ndarray, shape (6, wheels), or None
        Of every wheel P0 (N), d0 (m) and c (N s/m), and how spring and damper are stretched: e from
        that of the sample before, from g = k e + c e' there, and from the new g. None where the
        contact is permanent.
    """

    __repr__ = brief

    onward: np.ndarray
    reach: np.ndarray
    tables: tuple[np.ndarray, ...]
    load_tables: tuple[np.ndarray, ...]
    axles: np.ndarray
    loads: np.ndarray
    of_cars: np.ndarray
    cars: tuple[CarSteps, ...]
    windows: np.ndarray
    known: tuple[np.ndarray, ...]
    first: int
    samples: int
    rail: tuple[np.ndarray, ...] | None = None
    pressed: tuple[np.ndarray, ...] | None = None


def plan(coupling: Coupling, track: Track | None = None) -> Plan:
    """Prepare a crossing to be stepped.

    Parameters
    ----------
    coupling : Coupling
    track : Track, optional
        What the rails give, where contacts are Hertzian; permanent contact if not given.
    """
    samples = coupling.settings.samples
    cars = [c for c in coupling.cars if c.respond is not None]
    made: dict[int, CarSteps] = {}
    for c in cars:
        if id(c.car.vehicle) not in made:
            made[id(c.car.vehicle)] = _car_steps(coupling, c)
    steps = tuple(made[id(c.car.vehicle)] for c in cars)
    static = [c.static.reshape(-1, 1) for c in cars]
    if track is None:
        windows = [(c.window.start, c.window.stop) for c in cars]
        known = [
            c.rigid[..., c.window].reshape(len(own), -1) + own
            for c, own in zip(cars, static, strict=True)
        ]
        rail = pressed = None
    else:
        inputs = [rail_input(c.car, track, coupling.settings.passage) for c in cars]
        windows = [(first, max(first, samples)) for first, _ in inputs]
        known = static
        rail = tuple(
            np.ascontiguousarray(u.reshape(-1, u.shape[-1])[:, : stop - start])
            for (_, u), (start, stop) in zip(inputs, windows, strict=True)
        )
        pressed = tuple(_pressed(c, coupling.settings.time_step) for c in cars)
    onward, reach = _deck_steps(coupling)
    couples = coupling.cars[0].load_matrix.shape[1] == 5
    speed = coupling.settings.speed
    modes = coupling.deck.coordinates
    tables = [np.stack([v, speed * s], axis=1) for v, s in _dense(coupling.axles, modes)]
    # A couple does work on the slope: M_z on v', and M_y on theta_y = -w'.
    load_tables = [
        np.concatenate([v, -s[:, 1:2], s[:, :1]], axis=1) if couples else v
        for v, s in _dense(coupling.loads, modes)
    ]
    return Plan(
        onward, reach, tuple(tables), tuple(load_tables),
        _placed(coupling.axles), _placed(coupling.loads),
        np.array([(c.axles[0], len(c.axles), c.loads[0], len(c.loads)) for c in cars]),
        steps, np.array(windows), tuple(known),
        min(0, *(first for first, _ in windows)), samples, rail, pressed,
    )  # fmt: skip


def _car_steps(coupling: Coupling, c: CoupledCar) -> CarSteps:
    """Return a kind of car at the crossing's step, and what its wheels feel and load."""
    vehicle, settings = c.car.vehicle, coupling.settings
    sampled: SampledResponse = c.respond.respond
    system = vehicle.system
    if sampled.coefficients is None:
        decay, b0, ahead = system.step(settings.time_step)
        drive, show = decay @ ahead + b0, system.c
    else:
        _, left, show, _ = system.modal
        decay, b0, b1 = sampled.coefficients
        drive, ahead = (b0 + decay * b1)[:, None] * left, b1[:, None] * left
    direct = (show @ ahead).real - np.eye(len(show))
    felt = np.zeros((len(c.car.wheels), 2, len(c.car.axles), 3))
    for i, axle in enumerate(c.car.axles):
        for wheel in axle.wheels:
            own = felt[wheel.number - 1, :, i]
            if settings.feedback == "all":
                # The rail moves sideways by v - h theta and up by w + y theta.
                own[0] = 1.0, 0.0, -coupling.deck.track_height
                own[1] = 0.0, 1.0, settings.track_offset + wheel.y
            else:
                own[1] = 0.0, 1.0, 0.0
    felt = felt.reshape(len(direct), -1)
    stiffness, damping = (
        values.reshape(-1, 1) * felt
        for values in (vehicle.contact_stiffness, vehicle.contact_damping)
    )
    loads = c.load_matrix.reshape(-1, len(direct))
    return CarSteps(decay, drive, show, direct, stiffness, damping, loads)


def _deck_steps(coupling: Coupling) -> tuple[np.ndarray, np.ndarray]:
    """Return how every mode of the deck goes on, see `Plan`."""
    deck, h = coupling.deck, coupling.settings.time_step
    onward, reach = np.zeros((6, deck.coordinates)), np.zeros((2, deck.coordinates))
    for m, (frequency, ratio) in enumerate(
        zip(deck.frequencies_hz, deck.damping_ratios, strict=True)
    ):
        e, b0, b1 = oscillator(2 * np.pi * frequency, ratio).step(h)
        onward[:4, m], onward[4:, m], reach[:, m] = e.ravel(), b0[:, 0], b1[:, 0]
    return onward, reach


def _dense(stations: Stations, modes: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return shapes and slopes of every table, each of shape (samples, 3, modes)."""
    mode, component = stations.pairs
    result = []
    for table in stations.tables:
        full = np.zeros((2, table[0].shape[1], 3, modes))
        for own, values in zip(full, table, strict=True):
            own[:, component, mode] = values.T
        result.append((full[0], full[1]))
    return result


def _placed(stations: Stations) -> np.ndarray:
    return np.stack([stations.starts, stations.counts, stations.which], axis=1)


def _pressed(c: CoupledCar, time_step: float) -> np.ndarray:
    """Return what a car's Hertzian contacts are, see `Plan.pressed`."""
    vehicle, load = c.car.vehicle, -c.static[:, 1]
    k, damping = vehicle.contact_stiffness[:, 1], vehicle.contact_damping[:, 1]
    shares = np.zeros((3, len(k)))
    shares[2] = 1.0 / k
    has = damping > 0.0
    poles = -k[has] / damping[has]
    a, b0, b1 = (values.real for values in ramp_coefficients(poles, time_step))
    shares[:, has] = a, b0 / damping[has], b1 / damping[has]
    return np.stack([load, 1.5 * load / k, damping, *shares])
