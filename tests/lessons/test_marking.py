"""Marks of a class: what was handed in is run, and what is wrong fails."""

import csv
import io
import json
import os
from pathlib import Path

import pytest

from railbridge.commands.command import main
from railbridge.errors import InputError
from railbridge.lessons import editions, exercises
from railbridge.lessons.marking import Row, answers_of, marked, submissions, table

ROOT = Path(__file__).resolve().parents[2]
TEMPLATE = json.loads((ROOT / "notebooks" / "_template.ipynb").read_text(encoding="utf-8"))
ASKED = [each for each in exercises().values() if each.name.startswith("99.")]
IMPORTS = "import numpy as np\n\nimport railbridge as rb\n\nmass, stiffness = 1000.0, 4.0e6\n"


def answered(**answers):
    """The template's exercises with these answers, and no more of the page than they need."""
    page = editions.student(TEMPLATE)
    kept = [c for c in page["cells"] if {"answer", "check"} & {*c["metadata"].get("tags", [])}]
    for cell in kept:
        for name, code in answers.items():
            if editions.source(cell).startswith(f"{name} = "):
                cell["source"] = f"{name} = {code}"
    first = {"cell_type": "code", "id": "first", "metadata": {}, "source": IMPORTS}
    first |= {"outputs": [], "execution_count": None}
    return json.dumps({**page, "cells": [first, *kept]})


RIGHT = {
    "answer_99_1": "4 * mass",
    "answer_99_2": "[stiffness / 2, np.sqrt(stiffness / 2 / mass) / (2 * np.pi)]",
    "answer_99_3": "9.967",
}


@pytest.fixture(scope="module")
def school(tmp_path_factory):
    folder = tmp_path_factory.mktemp("school")

    def hand_in(place, text):
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        (folder / place).write_text(text, encoding="utf-8")

    hand_in("anna/99_copy.ipynb", answered(**RIGHT))
    hand_in("bela/week 1/99_copy.ipynb", answered(**RIGHT | {"answer_99_1": "2 * mass"}))
    hand_in("99_copy_Cleo.ipynb", answered(answer_99_2="[2.0e6, 1.0]"))
    hand_in("=dora/99_copy.ipynb", answered(**RIGHT | {"answer_99_1": "unknown"}))
    hand_in("emil/99_copy.ipynb", answered(**RIGHT | {"answer_99_1": "__import__('os')._exit(1)"}))
    hand_in("anna/.ipynb_checkpoints/99_copy.ipynb", answered())
    hand_in("fritz/99_copy.ipynb", '{"cells": "rb.check(\\"99.1\\", 1)"}')
    return folder


@pytest.fixture(scope="module")
def rows(school):
    return {row.student: row for row in marked(submissions(school))}


def test_a_student_is_a_folder_or_a_file_with_a_name(school):
    found = [(each.student, each.page) for each in submissions(school)]
    names = ["=dora", "Cleo", "anna", "bela", "emil", "fritz"]
    assert found == [(name, "99") for name in names]


def test_what_is_right_earns_its_mark_and_what_is_wrong_none(rows):
    assert rows["anna"] == Row("anna", {"99.1": 1, "99.2": 1, "99.3": 1}, ())
    assert rows["bela"].marks == {"99.1": 0, "99.2": 1, "99.3": 1}


def test_half_of_a_list_is_half_a_mark_and_what_is_open_is_left_out(rows):
    assert rows["Cleo"].marks == {"99.2": 0.5}


def test_an_error_in_one_answer_costs_no_other(rows):
    assert rows["=dora"].marks == {"99.2": 1, "99.3": 1}
    assert "NameError in the cell 'answer_99_1 = unknown'" in rows["=dora"].remarks[0]


def test_what_cannot_be_run_is_said(rows):
    assert rows["emil"].remarks == ("99: its kernel died",)
    assert rows["fritz"].remarks == ("99: it cannot be read as a notebook",)
    assert rows["emil"].marks == rows["fritz"].marks == {}


def test_the_table_has_a_row_per_student(rows):
    lines = list(csv.reader(io.StringIO(table(list(rows.values()), ASKED))))
    assert lines[0] == ["student", "99.1", "99.2", "99.3", "marks", "of", "remarks"]
    found = {line[0]: line[1:6] for line in lines[1:]}
    assert found["anna"] == ["1", "1", "1", "3", "3"]
    assert found["bela"] == ["0", "1", "1", "2", "3"]
    assert found["Cleo"] == ["", "0.5", "", "0.5", "3"]
    assert "'=dora" in found, "a name is no formula"


def test_what_takes_too_long_is_interrupted(tmp_path):
    slow = "[__import__('time').sleep(30), 4 * mass][1]"
    (tmp_path / "99_copy_Gerd.ipynb").write_text(answered(**RIGHT | {"answer_99_1": slow}))
    (row,) = marked(submissions(tmp_path), seconds=4)
    assert row.marks == {"99.2": 1, "99.3": 1}
    assert "took longer than 4 s" in row.remarks[0]


def test_the_last_of_two_files_counts(tmp_path):
    for name, at in (("99_old.ipynb", 1e9), ("99_new.ipynb", 2e9)):
        path = tmp_path / "hanna" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(answered())
        os.utime(path, (at, at))
    (found,) = submissions(tmp_path)
    assert found.path.name == "99_new.ipynb"


def test_only_some_pages(school):
    assert len(submissions(school, ["99"])) == 6
    with pytest.raises(InputError, match="holds no notebook with exercises"):
        submissions(school, ["01"])


@pytest.mark.parametrize("kind", ["missing", "file", "empty"])
def test_a_folder_without_notebooks_is_refused(tmp_path, kind):
    place = tmp_path / kind
    if kind == "file":
        place.write_text("x")
    if kind == "empty":
        place.mkdir()
    with pytest.raises(InputError, match="DIR"):
        submissions(place)


def test_answers_are_read_by_the_names_that_exercises_give():
    assert answers_of("99", {"answer_99_1": 4000.0, "answer_99_3": ..., "other": 3}) == {"99.1": 1}
    assert "99.guess" not in answers_of("99", {"guess_99": "c"})


def test_the_command_writes_the_table_and_keeps_what_is_there(tmp_path, capsys):
    (tmp_path / "in" / "ida").mkdir(parents=True)
    (tmp_path / "in" / "ida" / "99_copy.ipynb").write_text(answered(**RIGHT))
    out = tmp_path / "marks.csv"
    assert main(["mark", str(tmp_path / "in"), "--out", str(out)]) == 0
    assert "1 student, 1 notebook; " in capsys.readouterr().out
    before = out.read_text(encoding="utf-8")
    assert before.splitlines()[1].startswith("ida,1,1,1,3,3")
    assert main(["mark", str(tmp_path / "in"), "--out", str(out)]) == 2
    assert "left alone" in capsys.readouterr().err and out.read_text(encoding="utf-8") == before
    assert main(["mark", str(tmp_path / "in"), "--out", str(tmp_path / "marks.txt")]) == 2
    assert main(["mark", str(tmp_path / "no"), "--out", str(tmp_path / "b.csv")]) == 2
    assert not (tmp_path / "b.csv").exists()
