"""Editions of a notebook: for a student, for a teacher, and without solutions.

One notebook is kept, with outputs and folded solutions. In it

* a code cell with the tag ``answer`` is where a learner writes; it names the variable or function
  that the exercise asks for, ``answer_1_2 = ...``;
* a code cell with the tag ``check`` below it calls ``rb.check("1.2", answer_1_2)``;
* a text cell that begins with a fold called *Solution* follows; the Python block inside is what the
  answer cell would hold;
* what a figure or a number shows stands between ``<!-- seen -->`` and ``<!-- /seen -->``, or is all
  but the first sentence of a caption.

A student's edition has no outputs and no solutions, and folds what is seen: predict, run, compare.
A teacher's edition has everything, with each solution, code and words, in its answer cell between
the marks that nbgrader knows; what nbgrader releases of it is then a student's edition, too. Both
carry what nbgrader needs to collect and to mark.

A notebook here is the JSON object of its file; none is changed in place.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from typing import Any

from .answer_tables import Choice, Exercise, exercise

__all__ = ["EDITIONS", "exercise_of", "source", "student", "teacher", "without_solutions"]

Cell = dict[str, Any]
Notebook = dict[str, Any]

ANSWER, CHECK = "answer", "check"
CHECKED = re.compile(r'rb\.check\("([^"]+)"')
SOLUTION = re.compile(r"<details>\s*<summary>Solution[^<]*</summary>(.*?)</details>\s*", re.DOTALL)
BLOCK = re.compile(r"```python\n(.*?)```", re.DOTALL)
SEEN = re.compile(r"<!-- seen -->\s*(.*?)\s*<!-- /seen -->", re.DOTALL)
# The first sentence of a caption ends before a capital: not at "Eq. 3" nor at "14.4 m".
CAPTION = re.compile(r"(\*\*Figure \d+\.\d+\.\*\*\s+.*?[.?!])\s+(?=[A-Z*$])(.+)", re.DOTALL)
FOLD = "<details><summary>Compare: what we see</summary>\n\n{}\n\n</details>"


def source(cell: Cell) -> str:
    """Return the text of a cell."""
    text = cell["source"]
    return text if isinstance(text, str) else "".join(text)


def tagged(cell: Cell, tag: str) -> bool:
    """Whether a cell bears a tag."""
    return tag in cell.get("metadata", {}).get("tags", [])


def exercise_of(cell: Cell) -> Exercise | None:
    """Return the exercise that a cell checks, or None."""
    found = CHECKED.search(source(cell)) if tagged(cell, CHECK) else None
    return exercise(found.group(1)) if found else None


def student(notebook: Notebook) -> Notebook:
    """Return the edition to hand out."""
    made = _folded(without_solutions(notebook))
    for cell in made["cells"]:
        if cell["cell_type"] == "code":
            cell.update(outputs=[], execution_count=None)
    _mark_for_nbgrader(made)
    return made


def teacher(notebook: Notebook) -> Notebook:
    """Return the edition with every solution in its place."""
    solutions, made = _solutions(notebook), _folded(without_solutions(notebook))
    _mark_for_nbgrader(made)
    for place, check in _answer_cells(made):
        asked, cell = exercise_of(check), made["cells"][place]
        solution = solutions.get(asked.name) or _letter(asked)
        stub = source(cell).rstrip("\n")
        _write(cell, f"{stub}\n### BEGIN SOLUTION\n{solution}\n### END SOLUTION")
        for stale in (cell, check):
            stale.update(outputs=[], execution_count=None)
    return made


def without_solutions(notebook: Notebook) -> Notebook:
    """Return the notebook without its solutions; a cell that held nothing else goes."""
    made = copy.deepcopy(notebook)
    kept = []
    for cell in made["cells"]:
        if cell["cell_type"] == "markdown" and SOLUTION.search(source(cell)):
            rest = SOLUTION.sub("", source(cell)).strip()
            if not rest:
                continue
            _write(cell, rest)
        kept.append(cell)
    made["cells"] = kept
    return made


EDITIONS: dict[str, Callable[[Notebook], Notebook]] = {
    "reader": copy.deepcopy,
    "student": student,
    "teacher": teacher,
}
"""What makes an edition, by its name; a reader's is the notebook as it is kept."""


def _write(cell: Cell, text: str) -> None:
    cell["source"] = text if isinstance(cell["source"], str) else text.splitlines(keepends=True)


def _folded(notebook: Notebook) -> Notebook:
    """Fold, in place, what gives an observation away."""
    for cell in notebook["cells"]:
        if cell["cell_type"] == "markdown":
            _write(cell, _with_folds(source(cell)))
    return notebook


def _with_folds(text: str) -> str:
    """Fold what would give an observation away."""
    first, blank, rest = text.partition("\n\n")
    caption = CAPTION.fullmatch(first.strip())
    if caption:
        text = f"{caption.group(1)}\n\n{FOLD.format(caption.group(2))}{blank}{rest}"
    return SEEN.sub(lambda found: FOLD.format(found.group(1)), text)


def _answer_cells(notebook: Notebook) -> list[tuple[int, Cell]]:
    """Return the place of each answer cell with the cell that checks it.

    The check of a guess may stand far below it.
    """
    cells = notebook["cells"]
    checks = {exercise_of(c).variable: c for c in cells if exercise_of(c)}
    found = []
    for place, cell in enumerate(cells):
        if tagged(cell, ANSWER):
            name = re.search(r"^(?:def )?(\w+)(?= = |\()", source(cell), re.MULTILINE)
            found.append((place, checks[name.group(1)]))
    return found


def _solutions(notebook: Notebook) -> dict[str, str]:
    """Return each solution by the exercise that is checked before it: code, words as comments."""
    found, last = {}, None
    for cell in notebook["cells"]:
        asked = exercise_of(cell)
        last = asked.name if asked else last
        fold = SOLUTION.search(source(cell)) if cell["cell_type"] == "markdown" else None
        block = BLOCK.search(fold.group(1)) if fold else None
        if block and last:
            words = BLOCK.sub("", fold.group(1)).strip()
            lines = [f"# {line}".rstrip() for line in words.splitlines()]
            found[last] = "\n".join([block.group(1).rstrip(), *lines])
    return found


def _letter(asked: Exercise) -> str:
    """Return the code that answers a guess."""
    right = asked.asks.choice if isinstance(asked.asks, Choice) else "..."
    return f'{asked.variable} = "{right}"'


def _mark_for_nbgrader(notebook: Notebook) -> None:
    """Write into answer and check cells what nbgrader knows them by, in its third schema."""
    for place, check in _answer_cells(notebook):
        asked = exercise_of(check)
        number = asked.name.replace(".", "-")
        answer = {"grade": False, "locked": False, "solution": True}
        graded = {"grade": asked.marks > 0, "locked": True, "solution": False}
        if asked.marks:
            graded["points"] = asked.marks
        pairs = (notebook["cells"][place], ANSWER, answer), (check, CHECK, graded)
        for cell, kind, known in pairs:
            shared = {"grade_id": f"{kind}-{number}", "schema_version": 3, "task": False}
            cell["metadata"] = {**cell.get("metadata", {}), "nbgrader": {**known, **shared}}
