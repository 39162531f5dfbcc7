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
    assert Row("x", "moment", "kN m", 10.0, -11.0, unsigned=True).difference == pytest.approx(0.1)
    assert Row("x", "moment", "kN m", -10.0, -11.0).difference == pytest.approx(-0.1)


def test_a_row_is_labelled_with_its_unit_if_it_has_one():
    assert Row("x", "moment", "kN m", 1.0, 1.0).label == "moment (kN m)"
    assert Row("x", "dynamic factor", "", 1.0, 1.0).label == "dynamic factor"


def test_a_block_of_lines_stands_below_the_head_of_its_case():
    rows = [
        Row("first", "sag", "mm", 2.0, 2.001, "a step", "by hand", 1e-2),
        Row("first", "factor", "", 1.5, 1.5, "a step", "paper", 1e-2),
        Row("second", "sag", "mm", 3.0, 3.0, "a step", "by hand", 1e-2),
    ]
    words = [line.split() for line in verification.report(rows).splitlines()]
    heads = ["theirs", "ours", "difference"]
    assert words[0] == ["first", *heads] and words[4] == ["second", *heads]
    assert words[1][:2] == ["sag", "(mm)"]
    assert words[1][-6:] == ["<", "1e-03", "by", "hand;", "a", "step"]
    assert words[2][0] == "factor" and words[2][-3:] == ["paper;", "a", "step"]
    assert words[3] == [] and words[5][-4:] == ["by", "hand;", "a", "step"]
    frame = verification.frame(rows)
    assert frame["case"].tolist() == ["first: sag (mm)", "first: factor", "second: sag (mm)"]
    assert frame["source"].tolist() == ["by hand", "paper", "by hand"]


def test_a_reason_is_given_again_below_another_head():
    rows = [Row(case, "sag", "mm", 2.0, 2.0, "a step") for case in ("first", "first", "second")]
    shown = [line for line in paper.report(rows).splitlines() if line.strip().startswith("sag")]
    assert [line.split()[-1] for line in shown] == ["step", '"', "step"]


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
