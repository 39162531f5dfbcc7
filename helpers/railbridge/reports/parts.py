"""What a report consists of: sections of words, lists, tables and pictures."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError, printable
from ..plots.style import QUANTITY_STYLES
from ..units import UNITS

__all__ = [
    "NOTHING", "Column", "Notes", "Picture", "Section", "Table", "Words", "exact", "in_km_h",
    "of_quantity", "shown",
]  # fmt: skip

DIGITS = 4
"""Significant digits of a result."""
INPUT_DIGITS = 10
"""The same of what was given, which a checker compares with a drawing."""
_SHORT = 18
"""Letters of a text that is not broken."""
_LONGEST_WORD = 36
"""Letters of a word that may be broken."""
NOTHING = "-"
"""Stands where there is no number."""
_PLAIN = (1e-3, 1e7)
"""Between them numbers are written without a power of ten."""


def shown(value: Any, digits: int = DIGITS) -> str:
    """Return a value of a table as it is read: numbers with some digits, yes and no in words."""
    if value is None:
        return NOTHING
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if isinstance(value, (int, np.integer)):
        return str(value)
    if isinstance(value, (float, np.floating)):
        return _number(float(value), digits)
    return printable(str(value))


def _number(value: float, digits: int) -> str:
    if math.isnan(value):
        return NOTHING
    if math.isinf(value):
        return "infinite" if value > 0.0 else "-infinite"
    if value == 0.0:
        return "0"
    rounded = float(f"{value:.{digits - 1}e}")
    if not _PLAIN[0] <= abs(rounded) < _PLAIN[1]:
        mantissa, _, power = f"{value:.{digits - 1}e}".partition("e")
        return f"{_trimmed(mantissa)}e{int(power)}"
    decimals = digits - 1 - math.floor(math.log10(abs(rounded)))
    return _trimmed(f"{value:.{max(decimals, 0)}f}")


def _trimmed(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text


def exact(value: Any) -> str:
    """Return what was given as a file has it, numbers with ten digits."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(map(exact, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{printable(k)} = {exact(v)}" for k, v in value.items()) + " }"
    return shown(value, INPUT_DIGITS)


def in_km_h(speed: float) -> float:
    """Return a speed (m/s) in km/h."""
    return float(speed / UNITS["speed"]["km/h"])


def of_quantity(name: str) -> tuple[str, float, str]:
    """Return name, factor from SI and unit of a quantity as it is shown.

    Lengths in mm, forces in kN, as pictures have them.
    """
    style = QUANTITY_STYLES[name]
    return style.words, style.factor, style.unit


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes
    ----------
    name : str
    unit : str
        Of its numbers; empty where they have none.
    digits : int
        Significant ones on the page; a workbook has all.
    verdicts : bool
        Whether it holds verdicts, which are coloured.
    """

    name: str
    unit: str = ""
    digits: int = DIGITS
    verdicts: bool = False

    @property
    def head(self) -> str:
        """Name and unit."""
        return f"{self.name} ({self.unit})" if self.unit else self.name


@dataclass(frozen=True)
class Table:
    """A table, on the page and as a sheet of a workbook.

    Attributes
    ----------
    name : str
        Of the sheet: some 30 letters at most.
    title : str
        Above it on the page.
    columns : tuple of Column
    rows : tuple of tuple
        Numbers, texts, booleans, or None.
    note : str
        Below it.
    on_page, in_workbook : bool
        Where it stands; both if nothing is said.
    """

    name: str
    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]
    note: str = ""
    on_page: bool = True
    in_workbook: bool = True
    kind = "table"

    def __post_init__(self) -> None:
        rows = tuple(tuple(row) for row in self.rows)
        for row in rows:
            if len(row) != len(self.columns):
                allowed = f"has {len(row)} cells in a row, must have {len(self.columns)}"
                raise InputError("rows", self.name, allowed)
        object.__setattr__(self, "columns", tuple(self.columns))
        object.__setattr__(self, "rows", rows)

    @classmethod
    def of(
        cls, name: str, title: str, heads: Sequence[Any], rows: Iterable[Sequence[Any]], **more: Any
    ) -> Table:
        """Return a table of heads, each a `Column`, a name, or a name and a unit."""
        columns = [
            head
            if isinstance(head, Column)
            else Column(head)
            if isinstance(head, str)
            else Column(*head)
            for head in heads
        ]
        return cls(name, title, tuple(columns), tuple(map(tuple, rows)), **more)

    @property
    def cells(self) -> list[list[tuple[str, str]]]:
        """Rows as they are read: a text and its class for each cell."""
        return [
            [
                _cell(value, column, look)
                for value, column, look in zip(row, self.columns, self.classes, strict=True)
            ]
            for row in self.rows
        ]

    @property
    def classes(self) -> list[str]:
        """How each column is set: numbers, or texts, with numbers among them or not."""
        found = []
        for i in range(len(self.columns)):
            known = [row[i] for row in self.rows if row[i] is not None]
            found.append("number" if known and all(map(_is_number, known)) else "text")
        return found


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.number)) and not isinstance(value, bool)


def _cell(value: Any, column: Column, look: str) -> tuple[str, str]:
    """Return a cell as it is read, and its class."""
    text = shown(value, column.digits)
    if column.verdicts:
        return text, "verdict " + text.replace(" ", "-")
    if len(text) <= _SHORT:
        return text, f"{look} short"
    if max(map(len, text.split()), default=0) > _LONGEST_WORD:
        return text, f"{look} long"
    return text, look


@dataclass(frozen=True)
class Picture:
    """A picture with its caption.

    Attributes
    ----------
    title : str
    svg : str
    width, height : float
        px on the screen.
    """

    title: str
    svg: str
    width: float = 900.0
    height: float = 300.0
    kind = "picture"


@dataclass(frozen=True)
class Words:
    """A paragraph.

    Attributes
    ----------
    text : str
    look : {"", "warning", "note"}
    """

    text: str
    look: str = ""
    kind = "words"


@dataclass(frozen=True)
class Notes:
    """A list of sentences.

    Attributes
    ----------
    items : tuple of str
    look : {"", "warning"}
    """

    items: tuple[str, ...]
    look: str = ""
    kind = "notes"


@dataclass(frozen=True)
class Section:
    """A section of a report.

    Attributes
    ----------
    title : str
    parts : tuple of Words, Notes, Table or Picture
    """

    title: str
    parts: tuple[Words | Notes | Table | Picture, ...]
