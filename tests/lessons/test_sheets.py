"""Sheets to print: every question, no answer."""

import re
from pathlib import Path

import pytest

from railbridge.errors import InputError
from railbridge.lessons.sheets import sheets

TEACHING = (Path(__file__).resolve().parents[2] / "docs/teaching.md").read_text(encoding="utf-8")


def keys(letter):
    """The last column of a table of the teacher's page."""
    lines = [x for x in TEACHING.splitlines() if re.match(rf"\| {letter}\d", x)]
    return [line.strip().strip("|").split("|")[-1].strip() for line in lines]


def test_there_are_a_guess_sheet_and_two_versions_of_the_numbers():
    made = sheets(TEACHING)
    assert sorted(made) == ["guess_sheet.html", "numbers_A.html", "numbers_B.html"]
    for name, text in made.items():
        letter = "G" if name.startswith("guess") else "M"
        asked = len(keys(letter)) // (1 if letter == "G" else 2)
        assert text.count("<tr>") == asked + 1, name
        assert text.count('class="answer"></td>') == asked
        assert "Name: ____" in text and f"G{len(keys('G')) + 1}" not in text


def test_no_sheet_carries_the_key():
    printed = "".join(sheets(TEACHING).values())
    assert all(len(key) > 5 for key in keys("G"))
    for key in [*keys("G"), *keys("M")]:
        assert key not in printed


def test_every_question_stands_alone():
    for text in sheets(TEACHING).values():
        assert "The same" not in text


def test_what_looks_like_html_or_code_is_printed_as_such():
    others = "\n| M1 A | 01 | x | y |\n| M1 B | 01 | x | y |"
    row = "| G1 | 01 | Is `a < b` in [01](01.ipynb)? | no |" + others
    assert "Is <code>a &lt; b</code> in 01?" in sheets(row)["guess_sheet.html"]


def test_a_page_without_its_tables_is_refused():
    with pytest.raises(InputError, match="no table"):
        sheets("# For teachers")
