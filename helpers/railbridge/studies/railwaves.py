"""Waves below the wheels of many crossings side by side, a column for each crossing.

The waves are turned on from block to block: exp(i k x) of the next sample is that of this one times
exp(i k V h), taken anew every 64 samples. The run-up before the deck is taken in closed form.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..tracks import Harmonic, Track
from ..trains import Train

__all__ = ["RailWaves"]

BLOCK = 64
"""Samples after which a wave's phase is taken anew, so that rounding does not pile up."""


class RailWaves:
    """What enters the cars of all lanes, k r + c r' at every wheel in both directions.

    Parameters
    ----------
    train : Train
    tracks : sequence of Track
        Of each lane; rails are harmonic or level.
    speed, lead_in, h : ndarray, shape (lanes,)
        m/s, m, s.
    advance : float
        m a sample.
    """

    def __init__(
        self,
        train: Train,
        tracks: Sequence[Track],
        speed: np.ndarray,
        lead_in: np.ndarray,
        h: np.ndarray,
        advance: float,
    ) -> None:
        self.speed, self.lead_in, self.h, self.advance = speed, lead_in, h, advance
        wheels = train.wheels
        vehicles = {car.number: car.vehicle for car in train.formation}
        shape = len(wheels) * 2, len(tracks)
        self.input, self.damped = np.zeros((2, *shape), dtype=complex)
        ways: dict[tuple[int, str], tuple[np.ndarray, np.ndarray]] = {}
        for j, direction in enumerate(("lateral", "vertical")):
            for side in ("left", "right"):
                rails = [track.rail(direction, side) for track in tracks]
                waves = [r if isinstance(r, Harmonic) else None for r in rails]
                k = np.array([2 * np.pi / r.wavelength if r else 0.0 for r in waves])
                size = [r.amplitude * np.exp(1j * r.phase) if r else 0.0 for r in waves]
                ways[j, side] = k, np.array(size)
        rows: list[tuple[int, str]] = []
        for wheel in wheels:
            vehicle, contact = vehicles[wheel.car], wheel.number - 1
            for j in (0, 1):
                k, size = ways[j, wheel.side]
                stiffness = vehicle.contact_stiffness[contact, j]
                damping = vehicle.contact_damping[contact, j]
                row = len(rows)
                turned = size * np.exp(-1j * k * wheel.delay)
                self.input[row] = (stiffness + 1j * damping * self.speed * k) * turned
                self.damped[row] = damping * turned
                rows.append((j, wheel.side))
        # Rails of one wavelength share the turning phasor.
        by_wave: dict[bytes, list[int]] = {}
        for n, row in enumerate(rows):
            by_wave.setdefault(ways[row][0].tobytes(), []).append(n)
        self.groups = [np.array(own) for own in by_wave.values()]
        self.waves = [ways[rows[own[0]]][0] for own in self.groups]
        # Wheels of one axle are at one place.
        self.delays, self.place_of = np.unique(
            np.repeat([wheel.delay for wheel in wheels], 2), return_inverse=True
        )
        # From here on all lanes are past their fade-in.
        self.settled = int(np.ceil((self.delays.max() - lead_in.min() / 2) / self.advance)) + 1
        self.stands = lead_in == 0.0
        self._turns = [np.exp(1j * k * advance * np.arange(BLOCK)[:, None]) for k in self.waves]
        self._base: tuple[int, list[np.ndarray]] = (-1, [])

    def _turned(self, k: int) -> list[np.ndarray]:
        """Return exp(i k x) of every wave below a wheel without delay, at sample k."""
        block, place = divmod(k, BLOCK)
        if self._base[0] != block:
            at = block * BLOCK * self.advance
            self._base = block, [np.exp(1j * own * at) for own in self.waves]
        return [b * t[place] for b, t in zip(self._base[1], self._turns, strict=True)]

    def at(self, k: int) -> np.ndarray:
        """Return k r + c r' at every wheel, both directions, at sample k."""
        turned = self._turned(k)
        u = np.empty((len(self.place_of), len(self.speed)))
        for group, phasor in zip(self.groups, turned, strict=True):
            own = self.input[group]
            u[group] = own.real * phasor.imag + own.imag * phasor.real
        x = k * self.advance - self.delays
        if k < self.settled:
            factor, rate = (values[self.place_of] for values in self._fade(x))
            u *= factor
            for group, phasor in zip(self.groups, turned, strict=True):
                own = self.speed * self.damped[group]
                u[group] += rate[group] * (own.real * phasor.imag + own.imag * phasor.real)
        if self.stands.any():
            u[np.ix_((x < -1e-9)[self.place_of], self.stands)] = 0.0
        return u

    def _fade(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return how far the run-up has faded in at every place, and its slope; see `FadeIn`."""
        ramp = np.maximum(self.lead_in, 1e-9) / 2
        share = (x[:, None] + self.lead_in) / ramp
        share[:, self.stands] = 1.0
        angle = np.pi * np.clip(share, 0.0, 1.0)
        rate = np.where(self.stands, 0.0, 0.5 * np.pi / ramp * np.sin(angle))
        return 0.5 - 0.5 * np.cos(angle), rate

    def run_up(self, poles: np.ndarray, left: np.ndarray, wheels: slice) -> np.ndarray:
        r"""Return where the modes of a car stand at the first sample, t = 0, in closed form.

        A wave that fades in with a half-cosine is a sum of three, of the frequencies w and w +- W,
        W = pi V / ramp; the full wave follows from the end of the fade. For each, a mode stands at

            z(0) = integral of exp(-s t) exp(i n t) = [exp((i n - s) t) / (i n - s)] over its time.

        The chords between samples of a wave are lower than the wave itself, by the square of
        sin(a) / a with a = n h / 2.

        Parameters
        ----------
        poles : ndarray, shape (modes,)
            Of negative real part.
        left : ndarray, shape (modes, rows)
            What drives them.
        wheels : slice
            Rows of the car among all.

        Returns
        -------
        ndarray, shape (modes, lanes), complex
        """
        ramp = np.maximum(self.lead_in, 1e-9) / 2
        delays = self.delays[self.place_of][:, None]
        begin, end = (
            np.minimum((delays - span) / self.speed, 0.0)
            for span in (self.lead_in, self.lead_in / 2)
        )
        turn = np.pi * self.speed / ramp
        wave = np.empty_like(self.input.real)
        for group, k in zip(self.groups, self.waves, strict=True):
            wave[group] = k * self.speed
        pieces = [(wave, np.ones_like(self.input), end, np.zeros_like(end))]
        for way, share in ((0, 0.5), (1, -0.25), (-1, -0.25)):
            phase = np.exp(-1j * way * turn * (delays - self.lead_in) / self.speed)
            pieces.append((wave + way * turn, share * phase, begin, end))
        standing = np.zeros((len(poles), len(self.speed)), dtype=complex)
        for row, drive in zip(range(wheels.start, wheels.stop), left.T, strict=True):
            for n, share, since, until in pieces:
                # k r + c r' of a wave of another frequency has c i (n - w) more.
                size = self.input[row] + 1j * (n[row] - wave[row]) * self.damped[row]
                size = size * share[row] * np.sinc(n[row] * self.h / (2 * np.pi)) ** 2
                for sign, part in ((1, size), (-1, np.conj(size))):
                    own = sign * 1j * n[row] - poles[:, None]
                    over = np.exp(own * until[row]) - np.exp(own * since[row])
                    standing += drive[:, None] * (sign * part / 2j) * over / own
        return standing
