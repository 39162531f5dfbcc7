"""What stands behind a rule: the clause, its range, its sources, and an answer that may be none.

A function of this room carries its `Clause` as the attribute ``clause``. What it answers is an
`Answer`: a number or yes and no, or *cannot decide* with the reason. Outside the range of its
clause a rule gives no number.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeVar

from .. import errors
from ..errors import Range
from ..units import UNITS

__all__ = [
    "EDITION", "FREQUENCY", "GRADES", "KMH", "LENGTH", "SPEED", "UNSEEN", "Answer",
    "CannotDecideError", "Clause", "Within", "by_clause", "not_above", "outside",
]  # fmt: skip

EDITION = "edition 2003 (with 2005 A1)"
"""Of the Eurocodes: EN 1991-2:2003 and EN 1990:2002/A1:2005."""
UNSEEN = "edition not confirmed"

KMH = UNITS["speed"]["km/h"]
"""m/s."""

GRADES = {
    "two": "two sources or more agree",
    "one": "one source",
    "memory": "from memory, not seen",
}
"""How well a rule is known."""

LENGTH = Range(above=0.0, unit="m", remedy="Give the span, or the determinant length")
FREQUENCY = Range(
    above=0.0, unit="Hz", remedy="Give the first bending frequency under permanent load"
)
SPEED = Range(least=0.0, unit="m/s", remedy="Divide km/h by 3.6")

_ROUNDED = 1e-9
"""Share by which a number may miss a bound and still be on it: 120 / 3.6 * 3.6 is not 120."""


def not_above(value: float, bound: float) -> bool:
    """Whether a number is at most a bound, or above it by rounding only."""
    return value <= bound + _ROUNDED * abs(bound)


class CannotDecideError(ValueError):
    """An undecided answer was used as a number, or as yes or no.

    Parameters
    ----------
    answer : Answer
    """

    def __init__(self, answer: Answer) -> None:
        super().__init__(f"{answer.clause.title}: cannot decide: {answer.reason}")
        self.answer = answer


@dataclass(frozen=True)
class Within:
    """Where a rule is valid in one of its arguments.

    Attributes
    ----------
    symbol : str
        Name of the argument.
    least, most : float or None
        Bounds that belong to the range.
    above, below : float or None
        Bounds that do not.
    unit : str
    """

    symbol: str
    least: float | None = None
    most: float | None = None
    above: float | None = None
    below: float | None = None
    unit: str = ""

    def holds(self, value: float) -> bool:
        """Whether a number is in the range; one that misses a bound by rounding is on it."""
        return (
            (self.least is None or not_above(self.least, value))
            and (self.most is None or not_above(value, self.most))
            and (self.above is None or not not_above(value, self.above))
            and (self.below is None or not not_above(self.below, value))
        )

    def said(self, value: float) -> str:
        """Return a number of this argument in words, with its symbol."""
        return f"{self.symbol} = {self._shown(value, 6)}"

    def __str__(self) -> str:
        lower = [(self.least, "<="), (self.above, "<")]
        upper = [(self.most, "<="), (self.below, "<")]
        words = [f"{self._shown(b)} {sign}" for b, sign in lower if b is not None]
        words += [self.symbol, *(f"{sign} {self._shown(b)}" for b, sign in upper if b is not None)]
        return " ".join(words)

    def _shown(self, value: float, digits: int = 4) -> str:
        kmh = f" ({value / KMH:.{digits}g} km/h)" if self.unit == "m/s" else ""
        return f"{value:.{digits}g} {self.unit}".strip() + kmh


@dataclass(frozen=True)
class Clause:
    """A rule of a code, and how well it is known.

    Attributes
    ----------
    title : str
        What it is about, in a few words.
    code, place : str
        The code ("EN 1991-2") and where in it ("6.4.4, Figure 6.10").
    unit : str
        SI, of what it gives; empty for ratios, which are fractions.
    grade : {"two", "one", "memory"}
        How well the rule is known; see `GRADES`.
    memory : str
        What of it rests on memory alone, where that is not all of it.
    ranges : tuple of Within
        Where it is valid; outside nothing is decided.
    conditions : str
        The rest of its range and what it must not be used for, in words.
    sense : {"", "at most", "at least"}
        On which side of the number one must be, if it is a limit.
    magnitude : bool
        Of a limit "at most": whether its sign does not matter. A wheel that is loaded more is not
        unloaded.
    edition : str
    """

    title: str
    code: str
    place: str
    unit: str
    grade: Literal["two", "one", "memory"]
    memory: str = ""
    ranges: tuple[Within, ...] = ()
    conditions: str = ""
    sense: Literal["", "at most", "at least"] = ""
    magnitude: bool = True
    edition: str = EDITION

    def __post_init__(self) -> None:
        for name in ("title", "code", "place", "edition"):
            errors.text(name, getattr(self, name))
        errors.choice("grade", self.grade, GRADES)
        errors.choice("sense", self.sense, ("", "at most", "at least"))
        object.__setattr__(self, "ranges", errors.instances("ranges", self.ranges, Within))

    @property
    def name(self) -> str:
        """Code and place."""
        return f"{self.code}, {self.place}"

    @property
    def validity(self) -> str:
        """The whole range in words."""
        parts = [*map(str, self.ranges), self.conditions]
        return "; ".join(part for part in parts if part) or "no bounds known"

    @property
    def source(self) -> str:
        """How well it is known, in words; what rests on memory alone is named."""
        known = GRADES[self.grade]
        return f"{known}; from memory: {self.memory}" if self.memory else known

    def __str__(self) -> str:
        return f"{self.name}, {self.edition} [{self.source}]"


@dataclass(frozen=True, repr=False)
class Answer:
    """What a rule answers: a number, yes or no, or that it cannot decide.

    ``float(answer)`` and ``bool(answer)`` give what is decided and raise `CannotDecideError` where
    nothing is, so an undecided answer never passes for a number or for a "no".

    Attributes
    ----------
    value : float, bool or None
        In the unit of the clause; None where nothing is decided.
    clause : Clause
    reason : str
        Why nothing is decided; of a decision, what led to it.
    """

    value: float | bool | None
    clause: Clause
    reason: str = ""

    def __post_init__(self) -> None:
        errors.instance("clause", self.clause, Clause)
        if self.value is None:
            errors.text("reason", self.reason)
        elif not isinstance(self.value, bool):
            object.__setattr__(self, "value", errors.number("value", self.value))

    @property
    def decided(self) -> bool:
        """Whether there is an answer at all."""
        return self.value is not None

    @property
    def unit(self) -> str:
        """SI, of the value."""
        return self.clause.unit

    def __float__(self) -> float:
        if self.value is None:
            raise CannotDecideError(self)
        if isinstance(self.value, bool):
            raise TypeError(f"{self.clause.title}: the answer is yes or no; use bool(answer)")
        return self.value

    def __bool__(self) -> bool:
        if self.value is None:
            raise CannotDecideError(self)
        if not isinstance(self.value, bool):
            raise TypeError(f"{self.clause.title}: the answer is a number; use float(answer)")
        return self.value

    def __repr__(self) -> str:
        if self.value is None:
            said = "cannot decide"
        elif isinstance(self.value, bool):
            said = "yes" if self.value else "no"
        else:
            said = f"{self.value:.5g} {self.unit}".strip()
        why = f" ({self.reason})" if self.reason else ""
        return f"<{self.clause.title}: {said}{why}; {self.clause}>"


_Function = TypeVar("_Function", bound=Callable)


def by_clause(clause: Clause) -> Callable[[_Function], _Function]:
    """Return a decorator that attaches a clause to a function, and tells of it in its docstring.

    Parameters
    ----------
    clause : Clause
        Becomes the attribute ``clause``. A section "Notes" of the docstring must be its last.
    """

    def attach(function: _Function) -> _Function:
        text = inspect.cleandoc(function.__doc__)
        title = "" if "\nNotes\n-----\n" in text else "\n\nNotes\n-----"
        said = (
            f"{clause.name}, {clause.edition}.",
            f"Unit: {clause.unit or 'none'}.",
            f"Valid: {clause.validity}.",
            f"Source: {clause.source}.",
        )
        function.__doc__ = f"{text}{title}\n" + ("\n" if not title else "") + "\n".join(said)
        function.clause = clause
        return function

    return attach


def outside(clause: Clause, **values: float) -> str:
    """Return why numbers are outside the ranges of a clause; empty where they are within.

    Parameters
    ----------
    clause : Clause
    **values : float
        By the symbols of its ranges.
    """
    for known in clause.ranges:
        value = values[known.symbol]
        if not known.holds(value):
            return f"{known.said(value)} is outside {known} of {clause.name}"
    return ""
