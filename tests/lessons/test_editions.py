"""Editions of a notebook: what a student gets, what a teacher gets, and what nbgrader reads."""

import copy
import json
from pathlib import Path

import nbformat
import pytest

from railbridge.lessons import editions, exercises
from railbridge.lessons.editions import exercise_of, source, student, teacher, without_solutions

ROOT = Path(__file__).resolve().parents[2]
TEMPLATE = ROOT / "notebooks" / "_template.ipynb"
PAGES = [
    path
    for path in [*sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb")), TEMPLATE]
    if '"answer"' in path.read_text(encoding="utf-8")
]


def read(path=TEMPLATE):
    return json.loads(path.read_text(encoding="utf-8"))


def text(notebook):
    return "\n".join(source(cell) for cell in notebook["cells"])


def cells(notebook, tag):
    return [c for c in notebook["cells"] if tag in c["metadata"].get("tags", [])]


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
@pytest.mark.parametrize("make", [student, teacher, without_solutions])
def test_every_edition_is_a_valid_notebook_and_the_kept_one_is_untouched(path, make):
    kept = read(path)
    before = copy.deepcopy(kept)
    nbformat.validate(nbformat.from_dict(make(kept)))
    assert kept == before


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_a_student_gets_no_outputs_and_no_solutions(path):
    made = student(read(path))
    assert "Solution" not in text(made) and "BEGIN SOLUTION" not in text(made)
    assert not any(cell.get("outputs") for cell in made["cells"])
    assert all(cell.get("execution_count") is None for cell in made["cells"])
    assert ("<summary>Hint" in text(made)) is ("### Exercise" in text(made)), "hints stay"


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_a_student_sees_the_first_sentence_of_a_caption_and_may_open_the_rest(path):
    for cell in student(read(path))["cells"]:
        if source(cell).startswith("**Figure"):
            shown = source(cell).partition("<details>")[0].strip()
            assert shown.count("\n\n") == 0 or "<details>" not in source(cell)
    kept = source(next(c for c in read()["cells"] if source(c).startswith("**Figure 99.2")))
    made = source(
        next(c for c in student(read())["cells"] if source(c).startswith("**Figure 99.2"))
    )
    assert "It swings between" in kept and "It swings between" in made.partition("<details>")[2]
    assert "marks one period.\n\n<details>" in made
    assert "<!-- seen -->" not in made
    assert made.count("Compare: what we see") == 2, "the caption, and what is marked as seen"


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_a_teacher_gets_an_answer_in_every_answer_cell(path):
    kept, made = read(path), teacher(read(path))
    assert len(cells(made, "answer")) == len(cells(kept, "answer")) > 0
    for cell in cells(made, "answer"):
        stub, begin, rest = source(cell).partition("### BEGIN SOLUTION\n")
        assert "..." in stub and begin
        code, end, after = rest.partition("\n### END SOLUTION")
        assert code.strip() and end and not after
        compile(source(cell), "answer", "exec")
    assert "<summary>Solution" not in text(made), "what nbgrader releases holds none"


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_every_exercise_of_the_table_is_asked_once_and_no_other(path):
    number = "99" if path == TEMPLATE else str(int(path.name[:2]))
    asked = [exercise_of(cell).name for cell in read(path)["cells"] if exercise_of(cell)]
    known = [name for name in exercises() if name.partition(".")[0] == number]
    assert sorted(asked) == sorted(known)


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
@pytest.mark.parametrize("make", [student, teacher])
def test_nbgrader_finds_where_answers_and_marks_stand(path, make):
    made = make(read(path))
    known = [c["metadata"]["nbgrader"] for c in made["cells"] if "nbgrader" in c["metadata"]]
    assert len(known) == len(cells(made, "answer")) + len(cells(made, "check"))
    ids = [each["grade_id"] for each in known]
    assert len(ids) == len(set(ids))
    for each in known:
        assert each["schema_version"] == 3 and each["task"] is False
        assert {"grade", "locked", "solution"} <= each.keys()
        assert each["solution"] is not each["locked"]
        assert ("points" in each) is each["grade"]
    assert not any(each["grade"] for each in known if each["grade_id"].endswith("guess"))
    worth = [exercise_of(cell).marks for cell in made["cells"] if exercise_of(cell)]
    assert sum(each.get("points", 0) for each in known) == sum(worth)


def test_the_words_of_a_solution_are_comments_of_its_code():
    (answer,) = [c for c in cells(teacher(read()), "answer") if "answer_99_1" in source(c)]
    assert source(answer) == (
        "answer_99_1 = ...  # kg\n### BEGIN SOLUTION\nanswer_99_1 = 4 * mass\n"
        "# Four times the mass, 4000 kg: 5.03 Hz.\n### END SOLUTION"
    )


def test_the_names_of_the_editions():
    assert editions.EDITIONS.keys() == {"reader", "student", "teacher"}
    assert editions.EDITIONS["reader"](read()) == read()


def cell(kind, text, **metadata):
    return {"cell_type": kind, "id": "a", "metadata": metadata, "source": text}


def test_a_cell_that_holds_more_than_the_solution_keeps_the_rest():
    fold = "<details><summary>Solution</summary>\n\n4 Hz\n\n</details>\n"
    page = {"cells": [cell("markdown", f"Before.\n\n{fold}\nAfter."), cell("markdown", fold)]}
    assert [source(c) for c in without_solutions(page)["cells"]] == ["Before.\n\nAfter."]


def test_points_and_numbers_of_equations_do_not_end_a_first_sentence():
    caption = "**Figure 1.2.** Eq. 3 over 14.4 m of track, iterations 1 to 4. It falls.\n\nNext."
    (made,) = student({"cells": [cell("markdown", caption)]})["cells"]
    shown, _, folded = source(made).partition("\n\n<details>")
    assert shown == "**Figure 1.2.** Eq. 3 over 14.4 m of track, iterations 1 to 4."
    assert "It falls." in folded and folded.rstrip().endswith("Next.")


def test_a_caption_of_one_sentence_folds_nothing_that_follows():
    caption = (
        "**Figure 1.2.** The car from the side.\n\n**Guess first.** Which is slower? Write it."
    )
    (made,) = student({"cells": [cell("markdown", caption)]})["cells"]
    assert source(made) == caption
