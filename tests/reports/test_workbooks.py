"""Workbooks: a sheet a table, units in heads, numbers as numbers, and never a formula."""

import io
import math

import numpy as np
import pytest

from railbridge.reports.parts import Column, Table
from railbridge.reports.workbooks import workbook_bytes

openpyxl = pytest.importorskip("openpyxl")


def opened(*tables):
    return openpyxl.load_workbook(io.BytesIO(workbook_bytes("title", tables)))


@pytest.mark.parametrize(
    "text", ["=1+1", "=cmd|' /C calc'!A0", "+1", "-1", "@SUM(A1)", "\t=1", "=" * 40_000]
)
def test_no_text_becomes_a_formula(text):
    book = opened(Table.of(text[:20], "T", [text[:100], "b"], [(text, 1.0)]))
    sheet = book.worksheets[0]
    for cell in (sheet["A1"], sheet["A2"]):
        assert cell.data_type == "s"
        assert cell.quotePrefix == (text[0] in "=+-@")
    assert len(sheet["A2"].value) <= 32_000


def test_heads_have_units_and_numbers_all_their_digits():
    table = Table.of("sheet", "T", [("mass", "t"), Column("n"), "yes", "none"], [
        (1 / 3, np.int64(4), True, None), (np.float64(2.0), 5, False, math.nan),
        (math.inf, 6, True, "x"),
    ])  # fmt: skip
    sheet = opened(table)["sheet"]
    rows = [[cell.value for cell in row] for row in sheet.iter_rows()]
    assert rows == [
        ["mass (t)", "n", "yes", "none"], [1 / 3, 4, "yes", None], [2.0, 5, "no", None],
        [None, 6, "yes", "x"],
    ]  # fmt: skip
    assert sheet.freeze_panes == "A2"


def test_tables_that_are_not_on_the_page_are_sheets_too():
    tables = [Table.of(name, "T", ["a"], [(1,)], on_page=False) for name in ("one", "two")]
    book = opened(*tables)
    assert book.sheetnames == ["one", "two"]
    assert book.properties.creator == "railbridge report"
    assert opened().sheetnames == ["empty"]


def test_letters_that_a_cell_cannot_hold_are_shown():
    sheet = opened(Table.of("s", "T", ["a"], [("a\x00b\x1b",)]))["s"]
    assert sheet["A2"].value == "a\\x00b\\x1b"


def test_names_of_sheets_that_a_program_refuses_are_none():
    given = ("x" * 40, "X" * 40, "peaks a/b[0]: c?*\\", "''", "sheet")
    names = opened(*[Table.of(name, "T", ["a"], [(1,)]) for name in given]).sheetnames
    assert names[:2] == ["x" * 31, "X" * 29 + " 2"]
    assert not set("[]:*?/\\") & set(names[2])
    assert names[3:] == ["sheet", "sheet 2"]
