"""Rows say what they compare, in a line, a text and a frame, and fail where they must."""

import numpy as np
import pytest

from railbridge import compared
from railbridge.validation import paper, verification
from railbridge.validation.rows import Row


def test_line_names_everything():
    line = compared("car mode 4", 1.33446, 1.334, "Hz", limit=0.5)
    wanted = "car mode 4 1.334 Hz paper 1.334 Hz limit 0.5 % ok"
    assert line.split() == wanted.split()


@pytest.mark.parametrize("value", [1.35, -1.334, float("nan"), float("inf")])
def test_a_difference_beyond_the_limit_fails(value):
    with pytest.raises(AssertionError, match="car mode 4"):
        compared("car mode 4", value, 1.334, "Hz", limit=0.5)


def test_printed_rows_as_text_and_as_frame_agree():
    rows = [
        Row("Table 4, x", "moment", "kN m", -10.0, 9.0, "because", unsigned=True),
        Row("Table 4, x", "reaction", "kN", 10.0, float("nan"), "because", unsigned=True),
        Row("Table 3, x", "iteration 1", "%", 1.0, 1.5),
    ]
    assert [row.difference_text for row in rows] == ["-10.00 %", "-", "+0.500"]
    frame = paper.frame(iter(rows))
    assert list(frame.columns) == ["", "paper", "suite", "difference", "why"]
    assert frame["difference"].tolist() == ["-10.00 %", "-", "+0.500"]
    assert frame["suite"].tolist() == ["9.000", "-", "1.500"]
    lines = paper.report(rows).splitlines()
    assert lines[1].endswith("because")
    assert lines[2].endswith('"'), "a reason that repeats is given once"


def test_signs_count_unless_they_are_not_explained():
    assert Row("x", "moment", "kN m", -10.0, 10.0).difference == 2.0
    assert Row("x", "moment", "kN m", -10.0, 10.0, unsigned=True).difference == 0.0


def test_a_row_beyond_its_limit_says_so():
    row = Row("case", "quantity", "m", 1.0, 1.1, "why", "source", 1e-3)
    assert not row.ok and row.difference_text == "< 1e+00"
    assert "BEYOND ITS LIMIT 0.001" in verification.report([row])
    assert Row("case", "quantity", "m", 2.0, 2.0, limit=1e-3).difference_text == "< 1e-09"
    missing = Row("case", "quantity", "m", 2.0, float("nan"), limit=1e-3)
    assert not missing.ok and missing.difference_text == "-"


def test_a_row_without_a_limit_promises_nothing():
    row = Row("case", "quantity", "m", 1.0, np.pi)
    assert row.ok and "LIMIT" not in paper.report([row])
