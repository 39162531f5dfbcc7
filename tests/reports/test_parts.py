"""How numbers and texts of a table are read."""

import math

import numpy as np
import pytest

from railbridge.errors import InputError
from railbridge.reports.parts import Column, Table, exact, in_km_h, of_quantity, shown


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "-"), (True, "yes"), (np.bool_(False), "no"), (7, "7"), (np.int64(12), "12"),
        (0.0, "0"), (-0.0, "0"), (1.0, "1"), (0.1, "0.1"), (2.5e-4, "2.5e-4"),
        (1 / 3, "0.3333"), (-7.2426107, "-7.243"), (5961.267, "5961"), (13224.4, "13224"),
        (9999.96, "10000"), (0.00099996, "0.001"), (0.99996, "1"), (1e-3, "0.001"),
        (9.9999e6, "1e7"), (9.999e6, "9999000"), (8.8123456e10, "8.812e10"),
        (-1.23456e-12, "-1.235e-12"),
        (math.nan, "-"), (math.inf, "infinite"), ("a\x1bb", "a\\x1bb"), ("plain", "plain"),
    ],
)  # fmt: skip
def test_values_are_read_with_sensible_digits(value, text):
    assert shown(value) == text


def test_what_was_given_keeps_ten_digits():
    assert exact(1.5707963267948966) == "1.570796327"
    assert exact(36.0) == "36"
    assert exact(8.8e10) == "8.8e10"
    assert exact(True) == "true"
    assert exact([1.0, [2.5, "a"]]) == "[1, [2.5, a]]"
    assert exact({"ratio": 0.03, "frequencies_hz": [3.3, 13.2]}) == (
        "{ ratio = 0.03, frequencies_hz = [3.3, 13.2] }"
    )


@pytest.mark.parametrize("value", np.geomspace(1e-9, 1e12, 43) * 1.2345678)
def test_no_number_is_off_by_more_than_its_digits(value):
    assert float(shown(float(value))) == pytest.approx(value, rel=5.1e-4)
    assert float(exact(float(value))) == pytest.approx(value, rel=1e-9)


def test_units_are_those_of_pictures():
    assert of_quantity("moment_vertical") == ("vertical bending moment", 1e-3, "kN m")
    assert in_km_h(20.0) == pytest.approx(72.0)


def test_a_column_is_set_as_its_cells_are():
    table = Table.of("t", "T", ["a", ("b", "m"), "c", Column("d", verdicts=True)], [
        ("x", 1.5, 1.0, "not met"), ("y" * 50, None, "words", "met"),
        ("some words in a row", 2, 3, "met"),
    ])  # fmt: skip
    assert table.classes == ["text", "number", "text", "text"]
    assert table.cells[0] == [
        ("x", "text short"), ("1.5", "number short"), ("1", "text short"),
        ("not met", "verdict not-met"),
    ]  # fmt: skip
    assert table.cells[1][0] == ("y" * 50, "text long")
    assert table.cells[1][1] == ("-", "number short")
    assert table.cells[2][0] == ("some words in a row", "text")
    assert table.columns[1].head == "b (m)" and table.columns[0].head == "a"


def test_rows_have_as_many_cells_as_there_are_columns():
    with pytest.raises(InputError, match="has 1 cells in a row, must have 2"):
        Table.of("t", "T", ["a", "b"], [(1, 2), (1,)])
