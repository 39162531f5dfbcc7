"""Verdicts: a value beside the limit of a clause, and tables of them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import errors
from ..errors import InputError
from .clauses import Answer, Clause, not_above

__all__ = ["CANNOT_DECIDE", "MET", "NOT_MET", "Verdict", "Verdicts", "judge"]

_LARGEST = 1e30
"""Beyond it a number is no result."""

MET, NOT_MET, CANNOT_DECIDE = "met", "not met", "cannot decide"


@dataclass(frozen=True, repr=False)
class Verdict:
    """A value judged by a clause. Utilisation and verdict follow from value and limit.

    Attributes
    ----------
    clause : Clause
        Of the limit.
    limit, value : float or None
        In the unit of the clause; None where it is not known.
    where, when : float, str or None
        m along the deck and s, or words: "car 3, wheel 2", "ICE2 at 62.5 m/s".
    reason : str
        Why nothing is decided, or what should be known of the value.
    value_clause : Clause or None
        The rule that gave the value, if a rule did.
    """

    clause: Clause
    limit: float | None
    value: float | None
    where: float | str | None = None
    when: float | str | None = None
    reason: str = ""
    value_clause: Clause | None = None

    def __post_init__(self) -> None:
        errors.instance("clause", self.clause, Clause)
        if not self.clause.sense:
            remedy = "Take a limit, as acceleration_limit"
            raise InputError("clause", self.clause.title, "must be that of a limit", remedy)
        if self.value_clause is not None:
            errors.instance("value_clause", self.value_clause, Clause)
        for name in ("limit", "value"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, errors.number(name, getattr(self, name)))
        for name in ("where", "when"):
            given = getattr(self, name)
            if given is not None and not isinstance(given, str):
                object.__setattr__(self, name, errors.number(name, given))
        if self.verdict == CANNOT_DECIDE:
            errors.text("reason", self.reason)

    @property
    def verdict(self) -> str:
        """``met``, ``not met`` or ``cannot decide``; a limit that is just reached is met."""
        if self.limit is None or self.value is None:
            return CANNOT_DECIDE
        if self.clause.sense == "at most":
            met = not_above(self._size, self.limit)
        else:
            met = not_above(self.limit, self.value)
        return MET if met else NOT_MET

    @property
    def utilisation(self) -> float | None:
        """How much of what is allowed is used, 1 at the limit.

        None where nothing is decided, and where the limit is zero, which is no measure.
        """
        if self.verdict == CANNOT_DECIDE or self.limit == 0.0:
            return None
        if self.clause.sense == "at most":
            return max(self._size, 0.0) / self.limit
        return self.limit / self.value if self.value > 0.0 else math.inf

    @property
    def _size(self) -> float:
        """What is compared with a limit that must not be exceeded."""
        return abs(self.value) if self.clause.magnitude else self.value

    @property
    def source(self) -> str:
        """How well limit and value are known, in words; what rests on memory is named."""
        if self.value_clause is None:
            return self.clause.source
        return (
            f"{self.clause.source}; value ({self.value_clause.title}): {self.value_clause.source}"
        )

    def __repr__(self) -> str:
        given, limit = self._shown(self.value), self._shown(self.limit)
        parts = [f"{self.clause.title}: {self.verdict}"]
        parts.append(f"{given}, {self.clause.sense} {limit} {self.clause.unit}".strip())
        if self.utilisation is not None:
            parts.append(f"utilisation {self.utilisation:.3g}")
        if self.where is not None:
            parts.append("at " + self._placed(self.where, "m"))
        if self.when is not None:
            parts.append("when " + self._placed(self.when, "s"))
        if self.reason:
            parts.append(self.reason)
        return f"<{'; '.join(parts)}; {self.clause.name}, {self.clause.edition} [{self.source}]>"

    @staticmethod
    def _shown(number: float | None) -> str:
        return "?" if number is None else f"{number:.5g}"

    @staticmethod
    def _placed(given: float | str, unit: str) -> str:
        return given if isinstance(given, str) else f"{given:.5g} {unit}"

    def to_frame(self):
        """Return a pandas DataFrame of one row; see `Verdicts.to_frame`."""
        return Verdicts([self]).to_frame()


@dataclass(frozen=True)
class Verdicts:
    """Verdicts in a row, one table for a deck and its trains.

    Attributes
    ----------
    rows : tuple of Verdict
    """

    rows: tuple[Verdict, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "rows", errors.instances("rows", self.rows, Verdict))

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def verdict(self) -> str:
        """``not met`` if one is not; ``cannot decide`` if one is undecided or there is none."""
        found = {row.verdict for row in self.rows}
        if NOT_MET in found:
            return NOT_MET
        return MET if found == {MET} else CANNOT_DECIDE

    def to_frame(self):
        """Return a pandas DataFrame, a row for each verdict; what is not known is missing.

        Columns: what, value, sense, limit, unit, utilisation, verdict, where, when, reason, clause,
        edition, source.
        """
        import pandas as pd

        columns: dict[str, Any] = {
            "what": [row.clause.title for row in self.rows],
            "value": pd.Series([row.value for row in self.rows], dtype=float),
            "sense": [row.clause.sense for row in self.rows],
            "limit": pd.Series([row.limit for row in self.rows], dtype=float),
            "unit": [row.clause.unit for row in self.rows],
            "utilisation": pd.Series([row.utilisation for row in self.rows], dtype=float),
            "verdict": [row.verdict for row in self.rows],
            "where": pd.Series([row.where for row in self.rows], dtype=object),
            "when": pd.Series([row.when for row in self.rows], dtype=object),
            "reason": [row.reason for row in self.rows],
            "clause": [row.clause.name for row in self.rows],
            "edition": [row.clause.edition for row in self.rows],
            "source": [row.source for row in self.rows],
        }
        return pd.DataFrame(columns)


def judge(
    value: float | Answer | None,
    limit: Answer,
    *,
    where: float | str | None = None,
    when: float | str | None = None,
    reason: str = "",
) -> Verdict:
    """Return the verdict on a value by a limit.

    Parameters
    ----------
    value : float, Answer or None
        In the unit of the limit. Of a limit that must not be exceeded the magnitude counts, of
        unloading the sign too.
        None, an undecided answer, or a number that is not finite: cannot decide.
    limit : Answer
        As ``acceleration_limit("ballasted")``; its clause says on which side the value must be.
    where, when : float or str, optional
        m along the deck and s, or words.
    reason : str
        Why the value is not known, or what should be known of it.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        A limit that is none, or a value in another unit than the limit.

    Examples
    --------
    >>> judge(2.1, acceleration_limit("ballasted"), where=18.0).verdict
    'met'
    """
    errors.instance("limit", limit, Answer)
    if isinstance(limit.value, bool):
        raise InputError("limit", limit, "must be a number", "Take a limit, as acceleration_limit")
    given, rule, why = _known(value, limit)
    reasons = [reason, why, "" if limit.decided else f"no limit: {limit.reason}"]
    said = "; ".join(part for part in reasons if part)
    return Verdict(limit.clause, limit.value, given, where, when, said, rule)


def _known(value: float | Answer | None, limit: Answer) -> tuple[float | None, Clause | None, str]:
    """Return a value as a number or None, the rule that gave it, and why it is None."""
    if isinstance(value, Answer):
        if value.unit != limit.unit:
            allowed = f"must be in {limit.unit or 'no unit'}, as {limit.clause.title}"
            raise InputError("value", value, allowed, f"It is in {value.unit or 'no unit'}")
        if isinstance(value.value, bool):
            raise InputError("value", value, "must be a number", "It is yes or no")
        known = None if value.value is None else float(value)
        return known, value.clause, value.reason
    if value is None:
        return None, None, "the value is not known"
    if isinstance(value, (float, np.floating)) and not abs(value) <= _LARGEST:
        return None, None, "the value is not a finite number"
    return errors.number("value", value), None, ""
