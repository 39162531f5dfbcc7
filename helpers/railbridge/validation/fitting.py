"""The search for boxes whose shells have the printed frequencies.

Least squares from several starts, and sensitivities. What is sought, and how a box is compared, is
in `candidates`. One solution of the shell for each step: derivatives follow from its modes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from .. import errors
from ..boxes import Box, BoxMesh
from ..boxes.motions import ShellModes
from . import published
from .candidates import COARSE, HYPOTHESES, UNKNOWNS, Fit, box_of, evaluate, paired_modes

__all__ = ["Problem", "identify", "search", "sensitivities"]

_MASS_WEIGHT = 0.5  # one per cent of mass counts as half a per cent of frequency
_TAIL_WEIGHT = 0.5  # of the printed modes 11 to 15, which depend most on mesh and detail


class Problem:
    """Residuals and their derivatives over unknowns scaled to 0..1 between their bounds.

    One shell solution each point.

    Parameters
    ----------
    inner_diaphragms : int
    hypothesis : str
        One of `HYPOTHESES`.
    mesh : BoxMesh
    """

    def __init__(self, inner_diaphragms: int, hypothesis: str, mesh: BoxMesh) -> None:
        self.inner = errors.integer("inner_diaphragms", inner_diaphragms, least=0, most=20)
        self.hypothesis = errors.choice("hypothesis", hypothesis, HYPOTHESES)
        self.mesh = mesh
        self.low = np.array([x.low for x in UNKNOWNS])
        self.span = np.array([x.high for x in UNKNOWNS]) - self.low
        printed = np.arange(len(published.TABLE2_DECK))
        self.weights = np.where(printed < 10, 1.0, _TAIL_WEIGHT)
        self._last: tuple[bytes, Any] | None = None

    def values(self, u: np.ndarray) -> dict[str, float]:
        """Return the unknowns by name, in SI."""
        names = [x.name for x in UNKNOWNS]
        return dict(zip(names, (self.low + self.span * u).tolist(), strict=True))

    def box(self, u: np.ndarray) -> Box:
        """Return the box of scaled unknowns."""
        return box_of(self.values(u), self.inner)

    def solution(self, u: np.ndarray) -> tuple[Box, ShellModes, np.ndarray]:
        """Return box, modes and which of them belong to the printed ones.

        The last solution is remembered.
        """
        key = np.asarray(u).tobytes()
        if self._last is None or self._last[0] != key:
            box = self.box(u)
            self._last = key, (box, *paired_modes(box, self.hypothesis, self.mesh))
        return self._last[1]

    def _residuals(self, frequencies: np.ndarray, mass: float) -> np.ndarray:
        of_frequencies = self.weights * np.log(frequencies / np.array(published.TABLE2_DECK))
        return 100 * np.append(of_frequencies, _MASS_WEIGHT * np.log(mass / published.MASS))

    def residuals(self, u: np.ndarray) -> np.ndarray:
        """Return weighted differences in per cent: 15 frequencies and the mass, shape (16,)."""
        box, modes, which = self.solution(u)
        return self._residuals(modes.frequencies_hz[which], box.mass_per_metre)

    def jacobian(self, u: np.ndarray) -> np.ndarray:
        """Return derivatives of the residuals, shape (16, n).

        By differences of Rayleigh's quotients of the modes at u: no further solutions.
        """
        box, modes, which = self.solution(u)
        base = self._residuals(modes.frequencies_hz[which], box.mass_per_metre)
        result = np.empty((len(base), len(u)))
        for j in range(len(u)):
            step = np.array(u, dtype=float)
            step[j] += 1e-4 if u[j] < 0.5 else -1e-4
            moved = self.box(step)
            frequencies = moved.shell(self.mesh).quotients(modes.vectors[:, :, which])
            change = self._residuals(frequencies, moved.mass_per_metre) - base
            result[:, j] = change / (step[j] - u[j])
        return result

    def fit(self, u: np.ndarray) -> Fit:
        """Return the comparison with Table 2."""
        box, modes, which = self.solution(u)
        names = tuple(modes.names[i] for i in which)
        frequencies = modes.frequencies_hz[which]
        values = self.values(u)
        return Fit(values, self.inner, self.hypothesis, frequencies, names, box.mass_per_metre)


def search(
    start: np.ndarray,
    inner_diaphragms: int = 0,
    hypothesis: str = "as ordered",
    mesh: BoxMesh = COARSE,
    steps: int = 20,
) -> tuple[Fit, np.ndarray]:
    """Improve one start by bounded least squares.

    Parameters
    ----------
    start : ndarray, shape (16,)
        Unknowns scaled to 0..1 between their bounds.
    inner_diaphragms, hypothesis, mesh
        See `Problem`.
    steps : int
        The most steps.

    Returns
    -------
    Fit, ndarray
        The best box and its scaled unknowns.

    Raises
    ------
    InputError
        Naming the argument.
    """
    start = errors.numbers("start", start, count=len(UNKNOWNS), least=0.0, most=1.0)
    problem = Problem(inner_diaphragms, hypothesis, mesh)
    result = least_squares(
        problem.residuals,
        np.clip(start, 1e-3, 1 - 1e-3),
        problem.jacobian,
        bounds=(0.0, 1.0),
        max_nfev=steps,
        ftol=1e-4,
        xtol=1e-4,
    )
    return problem.fit(result.x), result.x


def sensitivities(
    u: np.ndarray, inner_diaphragms: int = 0, mesh: BoxMesh = COARSE
) -> tuple[np.ndarray, np.ndarray]:
    """Return singular values and directions of the residuals' derivatives by the scaled unknowns.

    A singular value is by how many per cent (weighted, root of the sum of squares) frequencies and
    mass move when the unknowns move through their whole range in that direction; below about 1 the
    data say nothing.

    Returns
    -------
    ndarray, shape (n,), and ndarray, shape (n, n)
        Descending; row i is the direction of value i.
    """
    problem = Problem(inner_diaphragms, "as ordered", mesh)
    _, values, directions = np.linalg.svd(problem.jacobian(u), full_matrices=True)
    unseen = np.zeros(len(u) - len(values))
    return np.concatenate([values, unseen])[: len(u)], directions


def identify(
    starts: int = 6,
    seed: int = 1,
    inner: Sequence[int] = (0, 2),
    workers: int = 2,
    progress: Callable[[str], None] = lambda line: None,
) -> dict[str, Any]:
    """Search from several starts and return the best box and all that tells how sure it is.

    Starts are improved on the coarse mesh, the best of them is polished on the default one, and
    other hypotheses about the pairing are tried from it.

    Parameters
    ----------
    starts : int
        The same for each number of inner diaphragms.
    seed : int
        Of the random starts.
    inner : sequence of int
        Numbers of inner diaphragms to try.
    workers : int
        Searches that run at a time, each in a process of its own.
    progress : callable
        Told a line for each search.

    Returns
    -------
    dict
        What `identification.stored` reads back: best box, all searches, singular values and
        directions, alternatives.
    """
    rng = np.random.default_rng(seed)
    count = errors.integer("starts", starts, least=1, most=100)
    draws = rng.uniform(0.2, 0.8, (count, len(UNKNOWNS)))
    with ProcessPoolExecutor(errors.integer("workers", workers, least=1, most=64)) as pool:

        def searches(jobs: dict[str, tuple]) -> list[tuple[Fit, np.ndarray]]:
            waiting = {pool.submit(search, *arguments): label for label, arguments in jobs.items()}
            for done in as_completed(waiting):
                fit = done.result()[0]
                rms = f"{fit.rms():.2f} % over the first ten, {fit.rms(15):.2f} % over all"
                progress(f"{waiting[done]}: {rms}, {fit.mass / 1e3:.2f} t/m")
            return [future.result() for future in waiting]

        coarse = searches(
            {
                f"{n} inner diaphragms, start {i + 1}": (draws[i], n)
                for n in inner
                for i in range(count)
            }
        )
        nearest, u = min(coarse, key=lambda pair: _cost(pair[0]))
        kept = nearest.inner_diaphragms
        jobs = {name: (u, kept, name, COARSE, 12) for name in list(HYPOTHESES)[1:]}
        jobs["polished on the default mesh"] = (u, kept, "as ordered", BoxMesh(), 8)
        *others, (polished, u) = searches(jobs)
    # What is stored is what is drawn.
    best = evaluate({x.name: x.rounded(polished.values[x.name]) for x in UNKNOWNS}, kept)
    values, directions = sensitivities(u, kept)
    names = [x.name for x in UNKNOWNS]
    return {
        "label": "identified, not known",
        "source": "Amaral & Mazzilli 2016, Tables 2 and 4",
        "unknowns": {
            x.name: {"low": x.low, "high": x.high, "unit": x.unit, "why": x.why} for x in UNKNOWNS
        },
        "best": best.to_dict(),
        "coarse": [fit.to_dict() for fit, _ in coarse],
        "alternatives": [fit.to_dict() for fit, _ in others],
        "singular_values": [round(float(v), 4) for v in values],
        "directions": [
            {name: round(float(c), 3) for name, c in zip(names, row, strict=True)}
            for row in directions
        ],
    }


def _cost(fit: Fit) -> float:
    """Return the error over the first ten, plus what the mass is beyond 10 % off."""
    return fit.rms(10) + max(0.0, 100 * abs(fit.mass / published.MASS - 1) - 10)
