"""Tables as CSV files: columns of text with their line numbers, and the numbers in them."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import errors
from ..errors import InputError, brief
from ..units import has_decimal_comma, written
from .reading import read_text

__all__ = ["Columns", "labelled", "read_columns"]


@dataclass(frozen=True, eq=False)
class Columns:
    """A CSV file by columns, still as text.

    Attributes
    ----------
    name : str
        Of the file.
    cells : dict of list of str
    lines : list of int
        Line of each row in the file, for messages.
    remarks : dict of tuple of str
        Comments of the form ``# units: mm, t``: the words after the colon by the word before it.
    comma : bool
        Whether numbers have a decimal comma; cells are then separated by semicolons or tabs.
    column_units : dict of str
        What the header says of the units of single columns, ``load (kN)``.
    notes : dict of str
        The same comments as in `remarks`, as they are written.
    """

    __repr__ = brief

    name: str
    cells: dict[str, list[str]]
    lines: list[int]
    remarks: dict[str, tuple[str, ...]]
    comma: bool = False
    column_units: dict[str, str] = field(default_factory=dict)
    notes: dict[str, str] = field(default_factory=dict)

    @property
    def units(self) -> tuple[str, ...] | None:
        """What the file itself says of its units."""
        return self.remarks.get("units")

    def number(self, field: str, cell: str) -> float:
        """Return a cell as a finite number, or refuse it for what it is."""
        with errors.within(source=self.name):
            return written(field, cell, self.comma)

    def numbers(self, column: str) -> np.ndarray:
        """Return a column as finite numbers, naming file and line of the first that is none."""
        cells = self.cells[column]
        try:
            values = np.array(cells, dtype=float)
        except ValueError:
            values = np.array([math.nan])
        if self.comma or not np.all(np.abs(values) <= 1e30):
            named = zip(self.lines, cells, strict=True)
            values = np.array([self.number(f"line {line}: {column}", c) for line, c in named])
        return values

    def labels(self, column: str) -> list[str]:
        """Return a column of node or mode labels; 12 and 12.0 are the same."""
        return [labelled(c) for c in self.cells[column]]

    def unique_labels(self, column: str) -> list[str]:
        """Return a column of labels and refuse one that is given twice, naming both lines."""
        labels = self.labels(column)
        seen: dict[str, int] = {}
        for line, label in zip(self.lines, labels, strict=True):
            if label in seen:
                allowed = f"is given twice, in lines {seen[label]} and {line}"
                raise InputError(column, label, allowed, "Remove or rename one", self.name)
            seen[label] = line
        return labels


def _float(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return math.nan


def labelled(value: Any) -> str:
    """Return the label of a node or mode as text; 12 and 12.0 are the same."""
    text = str(value).strip()
    number = _float(text)
    return str(int(number)) if math.isfinite(number) and number == int(number) else text


def read_columns(
    path: str | Path,
    required: Sequence[str],
    optional: Sequence[str] = (),
    *,
    may_be_empty: bool = False,
    units_in_header: bool = False,
) -> Columns:
    """Read a CSV file: UTF-8, with a header; lines that start with # are comments.

    Cells are separated by commas; or by semicolons or tabs, as the header shows, and numbers may
    then have a decimal comma. Optional columns that are blank throughout are left out.

    Parameters
    ----------
    path : str or Path
    required, optional : sequence of str
        Names of the columns that must and may be there, in any order.
    may_be_empty : bool
        Whether a header without rows will do.
    units_in_header : bool
        Whether a column's name may be followed by its unit: ``load (kN)``, ``load [kN]``.

    Raises
    ------
    InputError
        No such file or no readable text (named as ``path``); or, with the name of the file as
        source, a column missing, unknown or given twice, a row of another length, or no rows.
    """
    try:
        path = Path(path)
        text = read_text(path)
    except TypeError:
        raise InputError("path", path, "must be the path of a CSV file") from None
    with errors.within(source=path.name):
        bare = _without_unit if units_in_header else str
        separator = _separator(text, [*required, *optional], bare)
        rows, notes = _read(text, separator)
        given = [cell.strip() for cell in rows[0][1]] if rows else []
        header = [bare(cell) for cell in given]
        _check_header(header, required, optional)
        for line, row in rows[1:]:
            if len(row) != len(header):
                allowed = f"must have {len(header)} cells, it has {len(row)}"
                raise InputError(f"line {line}", separator.join(row), allowed, _REMEDIES[separator])
        if len(rows) < 2 and not may_be_empty:
            raise InputError(
                "rows", None, "there are none below the header", "Is it the right file?"
            )
    cells = {h: [row[i].strip() for _, row in rows[1:]] for i, h in enumerate(header)}
    cells = {h: c for h, c in cells.items() if h not in optional or any(c) or not c}
    comma = separator != "," and any(has_decimal_comma(c) for own in cells.values() for c in own)
    remarks = {name: _words(said) for name, said in notes.items()}
    units = {h: _UNIT.fullmatch(g)[2].strip() for h, g in zip(header, given, strict=True) if h != g}
    lines = [line for line, _ in rows[1:]]
    return Columns(path.name, cells, lines, remarks, comma, units, notes)


_REMEDIES = {
    ",": "Use a point as decimal mark, and put cells that contain a comma between double quotes",
    ";": "Put cells that contain a semicolon between double quotes",
    "\t": "Put cells that contain a tab between double quotes",
}
"""What to try where a row has another number of cells than the header, by what separates them."""


_UNIT = re.compile(r"([^()\[\]]*?)\s*[(\[]([^()\[\]]*)[)\]]")
"""A column's name and its unit in round or square brackets."""


def _without_unit(cell: str) -> str:
    found = _UNIT.fullmatch(cell)
    return found[1] if found else cell


def _is_comment(number: int, line: str) -> bool:
    # Spreadsheets put a comment that has commas between quotes, and "sep=;" first.
    bare = line.lstrip(' \t"')
    return bare.startswith("#") or (number == 1 and bare[:4].lower() == "sep=")


def _words(value: str) -> tuple[str, ...]:
    """Return what a comment lists, separated by commas or semicolons, or else by blanks."""
    parts = re.split("[,;]", value) if re.search("[,;]", value) else value.split()
    return tuple(part.strip() for part in parts if part.strip())


def _separator(text: str, known: Sequence[str], bare: Callable[[str], str] = str) -> str:
    """Return what separates the cells of the header: what makes most columns that are known."""
    header = ""
    for number, line in enumerate(io.StringIO(text), start=1):
        if line.strip(" ,;\t\n") and not _is_comment(number, line):
            header = line
            break

    def columns(separator: str) -> int:
        return sum(bare(cell.strip(' "\r\n')) in known for cell in header.split(separator))

    return max(_REMEDIES, key=columns)


def _read(text: str, separator: str) -> tuple[list[tuple[int, list[str]]], dict[str, str]]:
    """Return the rows that are not blank, each with its line, and what comments say."""
    rows: list[tuple[int, list[str]]] = []
    notes: dict[str, str] = {}
    start, complete = 1, True

    def uncommented() -> Iterator[str]:
        nonlocal start, complete
        for number, line in enumerate(io.StringIO(text, newline=""), start=1):
            # A cell between quotes may run over several lines, whatever they start with.
            if complete and _is_comment(number, line):
                key, _, value = line.strip(' "#,;\t\r\n').partition(":")
                notes[key.strip().lower()] = value.strip()
                continue
            if complete:
                start, complete = number, False
            yield line

    try:
        for row in csv.reader(uncommented(), delimiter=separator, strict=True):
            complete = True
            if any(cell.replace(";", "").strip() for cell in row):
                rows.append((start, row))
    except csv.Error as error:
        remedy = "Is a double quote not closed, or a cell too long?"
        raise InputError(f"line {start}", None, f"cannot be read ({error})", remedy) from None
    return rows, notes


def _check_header(header: list[str], required: Sequence[str], optional: Sequence[str]) -> None:
    """Refuse columns that are given twice, unknown or missing.

    Of a header without any known name nothing is said: it may be somebody else's file.
    """
    known = [*required, *optional]
    if header and not any(name.strip() in known for cell in header for name in cell.split(";")):
        remedy = "Columns: " + ",".join(known) + ". Is it the right file?"
        if any(name in known for cell in header for name in cell.split()):
            remedy = "Separate cells by commas or semicolons"
        raise InputError("header", None, "has none of the columns of such a table", remedy)
    for column in header:
        if header.count(column) > 1:
            raise InputError(f"column {column}", None, "appears more than once")
        if column not in known:
            near = errors.did_you_mean(column, known)
            raise InputError(f"column {column}", None, "unknown column", near)
    for column in required:
        if column not in header:
            raise InputError(f"column {column}", None, "is missing", "Columns: " + ",".join(known))
