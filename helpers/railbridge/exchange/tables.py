"""Tables as CSV files: columns of text with their line numbers, and the numbers in them."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import errors
from ..errors import InputError
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
    """

    name: str
    cells: dict[str, list[str]]
    lines: list[int]
    remarks: dict[str, tuple[str, ...]]

    @property
    def units(self) -> tuple[str, ...] | None:
        """What the file itself says of its units."""
        return self.remarks.get("units")

    def numbers(self, column: str) -> np.ndarray:
        """Return a column as finite numbers, naming file and line of the first that is none."""
        cells = self.cells[column]
        try:
            values = np.array(cells, dtype=float)
        except ValueError:
            values = np.array([_float(c) for c in cells])
        for i in np.flatnonzero(~np.isfinite(values))[:1]:
            field, remedy = f"line {self.lines[i]}: {column}", "Use a point as decimal mark"
            raise InputError(field, cells[i], "must be a finite number", remedy, self.name)
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
) -> Columns:
    """Read a CSV file: UTF-8, comma separated, with a header; lines that start with # are comments.

    Parameters
    ----------
    path : str or Path
    required, optional : sequence of str
        Names of the columns that must and may be there, in any order.
    may_be_empty : bool
        Whether a header without rows will do.

    Raises
    ------
    InputError
        No such file or no readable text (named as ``path``); or, with the name of the file as
        source, a column missing, unknown or given twice, a row of another length, or no rows.
    """
    path = Path(path)
    try:
        rows, remarks = _read(path)
    except csv.Error as error:
        allowed = f"is not a readable CSV file ({error})"
        raise InputError("path", path.name, allowed, "Save it as UTF-8 text") from None
    with errors.within(source=path.name):
        header = [cell.strip() for cell in rows[0][1]] if rows else []
        _check_header(header, required, optional)
        for line, row in rows[1:]:
            if len(row) != len(header):
                allowed = f"must have {len(header)} cells, it has {len(row)}"
                remedy = "Put cells that contain a comma between double quotes"
                raise InputError(f"line {line}", ",".join(row), allowed, remedy)
        if len(rows) < 2 and not may_be_empty:
            raise InputError(
                "rows", None, "there are none below the header", "Is it the right file?"
            )
    cells = {h: [row[i].strip() for _, row in rows[1:]] for i, h in enumerate(header)}
    return Columns(path.name, cells, [line for line, _ in rows[1:]], remarks)


def _read(path: Path) -> tuple[list[tuple[int, list[str]]], dict[str, tuple[str, ...]]]:
    """Return the rows of a file that are not blank, each with its line, and what comments say."""
    rows: list[tuple[int, list[str]]] = []
    remarks: dict[str, tuple[str, ...]] = {}
    start, complete = 0, True

    def uncommented() -> Iterator[str]:
        nonlocal start, complete
        for number, line in enumerate(read_text(path).splitlines(), start=1):
            # A cell between quotes may run over several lines, whatever they start with.
            if complete and line.lstrip().startswith("#"):
                key, _, value = line.strip(" #,;\t").partition(":")
                remarks[key.strip().lower()] = tuple(value.replace(",", " ").split())
                continue
            if complete:
                start, complete = number, False
            yield line

    for row in csv.reader(uncommented()):
        complete = True
        if any(cell.replace(";", "").strip() for cell in row):
            rows.append((start, row))
    return rows, remarks


def _check_header(header: list[str], required: Sequence[str], optional: Sequence[str]) -> None:
    """Refuse columns that are given twice, unknown or missing.

    Of a header without any known name nothing is said: it may be somebody else's file.
    """
    known = [*required, *optional]
    if header and not any(name.strip() in known for cell in header for name in cell.split(";")):
        remedy = "Columns: " + ",".join(known) + ". Is it the right file?"
        raise InputError("header", None, "has none of the columns of such a table", remedy)
    for column in header:
        if header.count(column) > 1:
            raise InputError(f"column {column}", None, "appears more than once")
        if column not in known:
            near = errors.did_you_mean(column, known)
            remedy = "Separate cells by commas" if ";" in column else near
            raise InputError(f"column {column}", None, "unknown column", remedy)
    for column in required:
        if column not in header:
            raise InputError(f"column {column}", None, "is missing", "Columns: " + ",".join(known))
