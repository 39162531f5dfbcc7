"""One row "theirs, ours, difference, why", and how rows become a line, a text or a frame."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

__all__ = ["Layout", "Row", "compared"]


@dataclass(frozen=True)
class Row:
    """One number that somebody else states, beside ours.

    Attributes
    ----------
    case : str
        The table or the case that the number belongs to.
    quantity, unit : str
    theirs, ours : float
        In `unit`; `ours` is NaN where the suite has no such number.
    why : str
        The likely reason of the difference, or what was assumed.
    source : str
        Where theirs comes from: ``paper``, ``closed form``, ``by hand``.
    limit : float or None
        Largest difference allowed, relative to theirs; None where no agreement is promised.
    unsigned : bool
        Whether magnitudes are compared, because the sign of theirs is not explained.
    """

    case: str
    quantity: str
    unit: str
    theirs: float
    ours: float
    why: str = ""
    source: str = "paper"
    limit: float | None = None
    unsigned: bool = False

    @property
    def label(self) -> str:
        """Quantity and unit."""
        return self.quantity + (f" ({self.unit})" if self.unit else "")

    @property
    def difference(self) -> float:
        """Ours against theirs, relative to the magnitude of theirs."""
        ours, theirs = self.ours, self.theirs
        if self.unsigned:
            ours, theirs = abs(ours), abs(theirs)
        return (ours - theirs) / abs(theirs)

    @property
    def ok(self) -> bool:
        """Whether the difference is within its limit, if it has one."""
        return self.limit is None or bool(abs(self.difference) <= self.limit)

    @property
    def difference_text(self) -> str:
        """The difference as it is printed.

        With a limit, a bound that round-off does not change: the next power of ten, 1e-9 at least.
        Without, percent, or percentage points where the number itself is in percent.
        """
        if np.isnan(self.ours):
            return "-"
        if self.limit is not None:
            size = max(abs(self.difference), 1e-9)
            return f"< {10.0 ** np.ceil(np.log10(size)):.0e}"
        if self.unit == "%":
            return f"{self.ours - self.theirs:+.3f}"
        return f"{100 * self.difference:+.2f} %"


@dataclass(frozen=True)
class Layout:
    """How the rows of one kind are printed.

    Attributes
    ----------
    theirs, ours : str
        Heads of the two columns of numbers.
    number : str
        Format of the numbers: ``.3f``.
    quantity_width, difference_width : int
        Characters of these columns in `report`.
    sources : bool
        Whether the rows come from several sources: each then names its own. If not, the source
        goes without saying, and `report` gives a reason that repeats only once.
    """

    theirs: str
    ours: str
    number: str
    quantity_width: int
    difference_width: int
    sources: bool

    def report(self, rows: Iterable[Row]) -> str:
        """Return rows as text: quantity, theirs, ours, difference, why, a block for each case."""
        quantity, difference = self.quantity_width, self.difference_width
        heads = f" {self.theirs:>11} {self.ours:>11} {'difference':>{difference}}"
        lines, before = [], None
        for row in rows:
            if before is None or row.case != before.case:
                lines += ["", f"{row.case:<{quantity + 2}}{heads}"]
                before = None
            repeated = before is not None and row.why and row.why == before.why
            why = f"{row.source}; {row.why}" if self.sources else '  "' if repeated else row.why
            flag = "" if row.ok else f"  BEYOND ITS LIMIT {row.limit:g}"
            theirs, ours = self._number(row.theirs), self._number(row.ours)
            line = f"  {row.label:<{quantity}} {theirs:>11} {ours:>11}"
            line += f" {row.difference_text:>{difference}}  {why}{flag}"
            lines.append(line.rstrip())
            before = row
        return "\n".join(lines[1:])

    def frame(self, rows: Iterable[Row]):
        """Return rows as a pandas DataFrame of text: quantity, theirs, ours, difference, why."""
        import pandas as pd

        rows = tuple(rows)
        if self.sources:
            columns = {
                "case": [f"{row.case}: {row.label}" for row in rows],
                "source": [row.source for row in rows],
            }
        else:
            columns = {"": [row.label for row in rows]}
        columns |= {
            self.theirs: [self._number(row.theirs) for row in rows],
            self.ours: [self._number(row.ours) for row in rows],
            "difference": [row.difference_text for row in rows],
            "why": [row.why for row in rows],
        }
        return pd.DataFrame(columns)

    def _number(self, value: float) -> str:
        return "-" if np.isnan(value) else f"{value:{self.number}}"


def compared(
    name: str,
    value: float,
    reference: float,
    unit: str = "",
    *,
    limit: float,
    source: str = "paper",
    digits: int = 4,
) -> str:
    """Return one line that compares a number with a reference, or fail if they differ too much.

    The line reads ``name   value unit   source reference unit   limit % ok``, rounded well above
    numerical noise.

    Parameters
    ----------
    name : str
        What is compared.
    value, reference : float
        In `unit`.
    unit : str
    limit : float
        Allowed difference, percent of the reference.
    source : str
        Where the reference comes from: ``paper``, ``closed form``, ``by hand``.
    digits : int
        Significant digits of the two numbers in the line.

    Raises
    ------
    AssertionError
        The difference exceeds the limit, or is not a number.
    """
    row = Row("", name, unit, reference, value, source=source, limit=limit / 100)

    def rounded(number: float) -> str:
        return f"{number:#.{digits}g}".rstrip(".") + (f" {unit}" if unit else "")

    numbers = f"{rounded(value):>15}   {source} {rounded(reference):>15}"
    line = f"{name:<30} {numbers}   limit {limit:g} %"
    if not row.ok:
        raise AssertionError(f"{line}   differs by {100 * abs(row.difference):.3g} %")
    return f"{line}   ok"
