"""Values beside limits where part of a value may be missing: what is not known is never met."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from ..codes import Answer, Verdict, judge
from ..codes.verdicts import NOT_MET
from ..studies import Asked, Row
from ..studies.outputs import Peaks

__all__ = ["Finding", "Point", "Points", "finding", "undecided"]


@dataclass(frozen=True, eq=False)
class Point:
    """One crossing.

    Attributes
    ----------
    train : str
    cars : bool
        Whether the train has cars, not bare axle loads.
    speed : float
        m/s.
    row : Row or str
        What it gave, or why it was refused.
    """

    train: str
    cars: bool
    speed: float
    row: Row | str

    @property
    def words(self) -> str:
        """Train and speed."""
        return f"{self.train} at {self.speed:.4g} m/s ({3.6 * self.speed:.4g} km/h)"

    @property
    def failure(self) -> str:
        """Why there are no numbers; empty where there are."""
        return self.row if isinstance(self.row, str) else self.row.message


@dataclass(frozen=True, eq=False)
class Points:
    """Crossings, and what they gave.

    Attributes
    ----------
    points : tuple of Point
        Those that gave numbers.
    asked : Asked
    failures : tuple of Point
        Those that did not.
    """

    points: tuple[Point, ...]
    asked: Asked
    failures: tuple[Point, ...] = ()

    @classmethod
    def of(cls, points: Sequence[Point], asked: Asked) -> Points:
        """Return crossings with those apart that failed."""
        good = tuple(point for point in points if not point.failure)
        return cls(good, asked, tuple(point for point in points if point.failure))

    def only(self, keep: Sequence[bool]) -> Points:
        """Return some of them."""
        own = tuple(point for point, kept in zip(self.points, keep, strict=True) if kept)
        return Points(own, self.asked, self.failures)

    def __len__(self) -> int:
        return len(self.points)

    @cached_property
    def peaks(self) -> Peaks:
        """Return the extremes of all outputs, arrays of shape (points, outputs)."""
        each = [point.row.peaks(self.asked) for point in self.points]
        names = [field.name for field in fields(Peaks)]
        return Peaks(*(np.concatenate([getattr(own, name) for own in each]) for name in names))

    def number(self, name: str) -> np.ndarray:
        """Return a number of each crossing, shape (points,)."""
        return np.array([point.row.numbers(self.asked)[name] for point in self.points])

    @property
    def gaps(self) -> list[str]:
        """What is said of those that failed."""
        if not self.failures:
            return []
        count = len(self.failures) + len(self.points)
        first = self.failures[0]
        return [f"{len(self.failures)} of {count} crossings failed: {first.words}: {first.failure}"]


@dataclass(frozen=True, eq=False)
class Finding:
    """A verdict, and which crossing decided it.

    Attributes
    ----------
    verdict : Verdict
    point : Point or None
        None where no crossing did.
    value : float or None
        What is known of the value, also where that is not enough to decide.
    """

    verdict: Verdict
    point: Point | None = None
    value: float | None = None

    @property
    def utilisation(self) -> float:
        """That of what is known, NaN where nothing is."""
        clause, limit = self.verdict.clause, self.verdict.limit
        if self.value is None or limit is None:
            return np.nan
        own = Verdict(clause, limit, self.value).utilisation
        return np.nan if own is None else own


def finding(
    value: float | Answer | None,
    limit: Answer,
    gaps: Sequence[str] = (),
    *,
    point: Point | None = None,
    where: float | str | None = None,
    when: str | None = None,
    reason: str = "",
) -> Finding:
    """Return the verdict on a value that may still grow: with gaps it is never met.

    Parameters
    ----------
    value, limit, where, reason
        See `codes.judge`.
    gaps : sequence of str
        What the value leaves out, in words. Beyond the limit already it is not met all the same.
    point : Point, optional
        The crossing that gave the value.
    when : str, optional
        In place of the point's words.
    """
    when = when if point is None else point.words
    found = judge(value, limit, where=where, when=when, reason=reason)
    known = found.value
    if found.verdict == NOT_MET or (known is not None and limit.decided and not gaps):
        return Finding(found, point, known)
    said = [reason, *gaps]
    if known is not None:
        said.insert(0, f"{known:.4g} {limit.unit}".strip() + " as far as known")
    if isinstance(value, Answer) and not value.decided:
        said.append(value.reason)
    if not limit.decided:
        said.append(f"no limit: {limit.reason}")
    words = "; ".join(part for part in said if part)
    return Finding(Verdict(limit.clause, limit.value, None, where, when, words), point, known)


def undecided(found: Finding, why: str) -> Finding:
    """Return a finding that decides nothing, whatever its value: with the value, and why."""
    given, said = found.verdict, [why, found.verdict.reason]
    if given.value is not None:
        said.insert(0, f"{given.value:.4g} {given.clause.unit}".strip() + " as computed")
    words = "; ".join(part for part in said if part)
    return replace(found, verdict=replace(given, value=None, reason=words, value_clause=None))
