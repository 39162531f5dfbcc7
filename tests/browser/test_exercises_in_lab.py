"""A student's copy in JupyterLab: run from top to bottom, then answered, wrongly and rightly."""

import json

import pytest
from labpage import NotebookOnPage
from served import NOTEBOOKS
from visit import visiting

from railbridge.lessons import editions

COPY = "99_copy_this_page"


@pytest.fixture(scope="module")
def visited(browser, lab, home):
    kept = json.loads((NOTEBOOKS / "_template.ipynb").read_text(encoding="utf-8"))
    copy = home / "notebooks" / f"{COPY}.ipynb"
    copy.write_text(json.dumps(editions.student(kept)), encoding="utf-8")
    with visiting(browser, lab) as visit:
        yield visit
    for session in lab.ask("api/sessions"):
        lab.ask(f"api/sessions/{session['id']}", method="DELETE")


@pytest.fixture(scope="module")
def notebook(visited):
    shown = NotebookOnPage(visited.page, visited.server, COPY)
    shown.run_all()
    return shown


def test_a_students_copy_runs_and_waits_for_answers(visited, notebook):
    verdicts = visited.page.locator(".rb-verdict").all_text_contents()
    assert len(verdicts) == 4 and all("no answer yet" in text for text in verdicts)
    assert notebook.complaints() == visited.complaints() == []


def test_a_wrong_answer_is_told_what_kind_of_wrong_it_is(visited, notebook):
    assert "stands under a root" in notebook.answer("answer_99_1", "2 * mass")
    assert "power of ten" in notebook.answer("answer_99_1", "4.0  # in t")
    assert "a point before the decimals" in notebook.answer("answer_99_1", "'4000,0'")
    assert "4000" not in "".join(visited.page.locator(".rb-verdict").all_inner_texts())
    assert notebook.complaints() == visited.complaints() == []


def test_a_right_answer_is_told_so(visited, notebook):
    assert "right." in notebook.answer("answer_99_1", "4 * mass")
    assert "1 of 2 right. frequency: too high" in notebook.answer("answer_99_2", "[2.0e6, 9.0]")
    assert "no answer yet" in notebook.answer("answer_99_2", "[..., ...]")
    assert notebook.complaints() == visited.complaints() == []


def test_what_a_figure_shows_is_folded_until_it_is_asked_for(visited, notebook):
    folds = visited.page.locator("details").filter(has_text="Compare: what we see")
    told = folds.first.locator("p").first
    assert folds.count() >= 2 and not told.is_visible()
    folds.first.locator("summary").click()
    told.wait_for()
    assert notebook.complaints() == visited.complaints() == []
