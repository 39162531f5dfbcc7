"""The search for boxes whose shells have the printed frequencies: least squares, sensitivities, several starts.

What is sought, and how a box is compared, is in `identification`. One solution of the shell for each step: derivatives follow
from its modes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from .. import errors
from ..boxes.girder import Box, BoxMesh
from ..boxes.motions import ShellModes
from .identification import COARSE, HYPOTHESES, MASS, UNKNOWNS, Fit, box_of, evaluate, solved
from .paper import TABLE2_DECK

__all__ = ["Problem", "identify", "search", "sensitivities"]

_MASS_WEIGHT = 0.5  # one per cent of mass counts as half a per cent of frequency
_TAIL_WEIGHT = 0.5  # of the printed modes 11 to 15, which depend most on mesh and detail


class Problem:
    """Residuals and their derivatives over unknowns scaled to 0..1; one shell solution each point."""

    def __init__(self, inner_diaphragms: int, hypothesis: str, mesh: BoxMesh) -> None:
        self.inner, self.hypothesis, self.mesh = inner_diaphragms, errors.choice("hypothesis", hypothesis, HYPOTHESES), mesh
        self.low = np.array([u.low for u in UNKNOWNS])
        self.span = np.array([u.high for u in UNKNOWNS]) - self.low
        self.weights = np.where(np.arange(len(TABLE2_DECK)) < 10, 1.0, _TAIL_WEIGHT)
        self._solved: tuple[bytes, Any] | None = None

    def values(self, u: np.ndarray) -> dict[str, float]:
        """Return the unknowns by name, in SI."""
        return dict(zip([x.name for x in UNKNOWNS], (self.low + self.span * u).tolist(), strict=True))

    def box(self, u: np.ndarray) -> Box:
        """Return the box of scaled unknowns."""
        return box_of(self.values(u), self.inner)

    def solution(self, u: np.ndarray) -> tuple[Box, ShellModes, np.ndarray]:
        """Return box, modes and which of them belong to the printed ones; the last is remembered."""
        key = np.asarray(u).tobytes()
        if self._solved is None or self._solved[0] != key:
            box = self.box(u)
            self._solved = key, (box, *solved(box, self.hypothesis, self.mesh))
        return self._solved[1]

    def _residuals(self, frequencies: np.ndarray, mass: float) -> np.ndarray:
        return 100 * np.append(self.weights * np.log(frequencies / np.array(TABLE2_DECK)), _MASS_WEIGHT * np.log(mass / MASS))

    def residuals(self, u: np.ndarray) -> np.ndarray:
        """Return weighted differences in per cent: 15 frequencies and the mass, shape (16,)."""
        box, modes, which = self.solution(u)
        return self._residuals(modes.frequencies_hz[which], box.mass_per_metre)

    def jacobian(self, u: np.ndarray) -> np.ndarray:
        """Return derivatives, shape (16, n), by differences of Rayleigh's quotients of the modes at u: no further solutions."""
        box, modes, which = self.solution(u)
        base = self._residuals(modes.frequencies_hz[which], box.mass_per_metre)
        result = np.empty((len(base), len(u)))
        for j in range(len(u)):
            step = np.array(u, dtype=float)
            step[j] += 1e-4 if u[j] < 0.5 else -1e-4
            moved = self.box(step)
            frequencies = moved.shell(self.mesh).quotients(modes.vectors[:, :, which])
            result[:, j] = (self._residuals(frequencies, moved.mass_per_metre) - base) / (step[j] - u[j])
        return result

    def fit(self, u: np.ndarray) -> Fit:
        """Return the comparison with Table 2."""
        box, modes, which = self.solution(u)
        names = tuple(modes.names[i] for i in which)
        return Fit(self.values(u), self.inner, self.hypothesis, modes.frequencies_hz[which], names, box.mass_per_metre)


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
    start : ndarray
        Unknowns scaled to 0..1 between their bounds.
    inner_diaphragms, hypothesis, mesh, steps
        What is held, and the most steps.

    Returns
    -------
    Fit, ndarray
        The best box and its scaled unknowns.
    """
    start = errors.numbers("identification: start", start, count=len(UNKNOWNS), least=0.0, most=1.0)
    problem = Problem(errors.integer("identification: inner_diaphragms", inner_diaphragms, least=0, most=20), hypothesis, mesh)
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


def sensitivities(u: np.ndarray, inner_diaphragms: int = 0, mesh: BoxMesh = COARSE) -> tuple[np.ndarray, np.ndarray]:
    """Return singular values and directions of the residuals' derivatives by the scaled unknowns.

    A singular value is by how many per cent (weighted, root of the sum of squares) frequencies and mass move when the
    unknowns move through their whole range in that direction; below about 1 the data say nothing.

    Returns
    -------
    ndarray, shape (n,), and ndarray, shape (n, n)
        Descending; row i is the direction of value i.
    """
    problem = Problem(inner_diaphragms, "as ordered", mesh)
    _, values, directions = np.linalg.svd(problem.jacobian(u), full_matrices=True)
    return np.concatenate([values, np.zeros(len(u) - len(values))])[: len(u)], directions


def identify(
    starts: int = 6,
    seed: int = 1,
    inner: Sequence[int] = (0, 2),
    workers: int = 2,
    progress: Callable[[str], None] = lambda line: None,
) -> dict[str, Any]:
    """Search from several starts on the coarse mesh, polish the best on the default one, test other hypotheses.

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
        What `stored` reads back: best box, all searches, singular values and directions, alternatives.
    """
    rng = np.random.default_rng(seed)
    count = errors.integer("identification: starts", starts, least=1, most=100)
    draws = rng.uniform(0.2, 0.8, (count, len(UNKNOWNS)))
    with ProcessPoolExecutor(errors.integer("identification: workers", workers, least=1, most=64)) as pool:

        def together(jobs: dict[str, tuple]) -> list[tuple[Fit, np.ndarray]]:
            waiting = {pool.submit(search, *arguments): label for label, arguments in jobs.items()}
            for done in as_completed(waiting):
                fit = done.result()[0]
                errors = f"{fit.rms():.2f} % over the first ten, {fit.rms(15):.2f} % over all"
                progress(f"{waiting[done]}: {errors}, {fit.mass / 1e3:.2f} t/m")
            return [future.result() for future in waiting]

        labels = [(i, n) for n in inner for i in range(count)]
        found = together({f"{n} inner diaphragms, start {i + 1}": (draws[i], n) for i, n in labels})
        coarse, u = min(found, key=lambda pair: _cost(pair[0]))
        held = coarse.inner_diaphragms
        jobs = {name: (u, held, name, COARSE, 12) for name in list(HYPOTHESES)[1:]}
        jobs["polished on the default mesh"] = (u, held, "as ordered", BoxMesh(), 8)
        *others, (best, u) = together(jobs)
    # What is stored is what is drawn.
    best = evaluate({x.name: x.rounded(best.values[x.name]) for x in UNKNOWNS}, held)
    values, directions = sensitivities(u, held)
    return {
        "label": "identified, not known",
        "source": "Amaral & Mazzilli 2016, Tables 2 and 4",
        "unknowns": {x.name: {"low": x.low, "high": x.high, "unit": x.unit, "why": x.why} for x in UNKNOWNS},
        "best": best.to_dict(),
        "coarse": [fit.to_dict() for fit, _ in found],
        "alternatives": [fit.to_dict() for fit, _ in others],
        "singular_values": [round(float(v), 4) for v in values],
        "directions": [{x.name: round(float(c), 3) for x, c in zip(UNKNOWNS, row, strict=True)} for row in directions],
    }


def _cost(fit: Fit) -> float:
    return fit.rms(10) + max(0.0, 100 * abs(fit.mass / MASS - 1) - 10)
