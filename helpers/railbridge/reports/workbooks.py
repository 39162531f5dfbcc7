"""Tables as a workbook for a spreadsheet program; what stands in it is never a formula."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..errors import printable
from .extras import needed
from .parts import Table
from .places import GENERATOR

__all__ = ["workbook_bytes"]

_FORMULA = ("=", "+", "-", "@")
"""With which a text begins that a program might take for a formula."""
_NOT_IN_NAMES = re.compile(r"[][:*?/\\]")
_LONGEST_NAME = 31
"""Letters of a sheet's name."""
_WIDEST = 60
"""Letters of a column."""
_LONGEST_CELL = 32_000
"""Letters that a cell can hold, nearly."""


def workbook_bytes(title: str, tables: Sequence[Table]) -> bytes:
    """Return a workbook with a sheet for each table.

    Parameters
    ----------
    title : str
    tables : sequence of Table

    Returns
    -------
    bytes
        Of an ``.xlsx`` file. Heads carry the units; numbers have all their digits.

    Raises
    ------
    InputError
        Without the extra ``report``.
    """
    needed("openpyxl")
    from openpyxl import Workbook
    from openpyxl.styles import Alignment, Font
    from openpyxl.utils import get_column_letter

    book = Workbook()
    book.remove(book.active)
    book.properties.creator = GENERATOR
    book.properties.title = printable(title)
    for table in tables:
        sheet = book.create_sheet(_sheet_name(table.name, book.sheetnames))
        for i, column in enumerate(table.columns, start=1):
            cell = sheet.cell(1, i)
            _write(cell, column.head)
            cell.font, cell.alignment = Font(bold=True), Alignment(wrap_text=True, vertical="top")
        widest = [min(len(column.head), 24) for column in table.columns]
        for number, row in enumerate(table.rows, start=2):
            for i, value in enumerate(row, start=1):
                text = _write(sheet.cell(number, i), value)
                widest[i - 1] = max(widest[i - 1], text)
        for i, letters in enumerate(widest, start=1):
            sheet.column_dimensions[get_column_letter(i)].width = min(letters + 2, _WIDEST)
        sheet.freeze_panes = "A2"
    if not book.worksheets:
        book.create_sheet("empty")
    file = io.BytesIO()
    book.save(file)
    return file.getvalue()


def _sheet_name(name: str, taken: Sequence[str]) -> str:
    """Return a name that a sheet may have and no other one has: 31 letters, some signs not."""
    plain = _NOT_IN_NAMES.sub(" ", printable(name)).strip("' ")[:_LONGEST_NAME] or "sheet"
    lower, found, number = {each.lower() for each in taken}, plain, 1
    while found.lower() in lower:
        number += 1
        end = f" {number}"
        found = plain[: _LONGEST_NAME - len(end)] + end
    return found


def _write(cell: Any, value: Any) -> int:
    """Write a value into a cell; return about how many letters wide it is."""
    if value is None:
        return 0
    if isinstance(value, (bool, np.bool_)):
        value = "yes" if value else "no"
    if isinstance(value, (int, float, np.number)):
        number = value.item() if isinstance(value, np.number) else value
        if not math.isfinite(number):
            return 0
        cell.value = number
        return 10
    text = printable(str(value))[:_LONGEST_CELL]
    cell.value = text
    cell.data_type = "s"  # whatever it begins with
    cell.quotePrefix = text.startswith(_FORMULA)
    return len(text)
