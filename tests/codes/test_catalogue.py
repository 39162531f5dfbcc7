"""Every rule has a clause, says it in its docstring and stands on the page."""

import subprocess
import sys
from pathlib import Path

import pytest

from railbridge import codes
from railbridge.codes.catalogue import RULES, table
from railbridge.codes.clauses import EDITION, GRADES, UNSEEN

PAGE = Path(__file__).resolve().parents[2] / "docs" / "codes.md"


def test_every_function_with_a_clause_is_listed_and_offered():
    offered = {name for name in codes.__all__ if hasattr(getattr(codes, name), "clause")}
    offered -= {"Answer", "Verdict"}
    assert offered == set(codes.all_clauses()) and len(RULES) == len(offered)
    assert codes.__all__ == sorted(codes.__all__)
    clauses = {id(clause): clause for clause in codes.all_clauses().values()}.values()
    assert len({clause.title for clause in clauses}) == len(clauses)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.__name__)
def test_docstrings_and_data_say_the_same(rule):
    clause = rule.clause
    for part in (clause.name, clause.edition, clause.validity, clause.source):
        assert part in rule.__doc__
    assert f"Unit: {clause.unit or 'none'}." in rule.__doc__ and clause.grade in GRADES
    eurocode = clause.code.startswith("EN 199")
    assert clause.edition == (EDITION if eurocode else UNSEEN)


def test_the_frame_lists_all():
    frame = codes.clauses_frame()
    assert list(frame.index) == [rule.__name__ for rule in RULES]
    assert frame.loc["uplift_limit", "grade"] == "memory"
    assert "from memory" in frame.loc["phi_prime", "source"]
    assert frame.loc["phi_prime", "valid"].startswith("v <= 55.56 m/s (200 km/h)")


def test_the_page_is_up_to_date():
    text = PAGE.read_text(encoding="utf-8")
    lines = text.partition("<!-- table: clauses -->\n")[2].partition("\n<!-- end -->")[0]
    assert lines.splitlines() == table(), "run `make pages`"
    assert len(table()) == len(RULES) + 2


def test_the_python_of_the_page_runs():
    block = PAGE.read_text(encoding="utf-8").partition("```python\n")[2].partition("```")[0]
    scope = {}
    exec(block, scope)
    assert scope["verdicts"].verdict == "cannot decide"


def test_opening_the_room_loads_no_tables_and_figures():
    code = (
        "import sys, railbridge as rb; rb.codes.phi2(10.0); "
        "print([m for m in ('pandas', 'matplotlib', 'pydantic') if m in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
