"""Marks of a class: the notebooks that were handed in, run, and their answers in one table.

Each notebook runs from top to bottom in a fresh kernel, in a copy of its folder, and goes on after
an error. Then the answers are read from the variables that the exercises name: it makes no
difference what a notebook had stored, or whether its check cells are still there.

A notebook is a program, and it runs with the rights of whoever marks.
"""

from __future__ import annotations

import csv
import io
import json
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import InputError
from .answer_tables import Exercise, exercises
from .editions import CHECKED, source

__all__ = ["Row", "Submission", "answers_of", "marked", "submissions", "table"]

CELL_SECONDS = 120
"""What one cell may take; it is then interrupted, and the next one runs."""


@dataclass(frozen=True)
class Submission:
    """One notebook that was handed in.

    Attributes
    ----------
    student : str
        Name of the folder that holds it, or what its own name adds to that of the page.
    page : str
        Number of the page without a leading zero, "1" for notebook 01.
    path : Path
    """

    student: str
    page: str
    path: Path


@dataclass(frozen=True)
class Row:
    """One student.

    Attributes
    ----------
    student : str
    marks : dict
        Marks of each exercise that was answered.
    remarks : tuple of str
        What went wrong while the notebooks ran.
    """

    student: str
    marks: Mapping[str, float]
    remarks: tuple[str, ...]


def submissions(folder: Path, pages: Iterable[str] = ()) -> list[Submission]:
    """Return the notebooks with exercises below a folder, by student and page.

    A student is a folder, ``anna/01_vehicle_modes.ipynb`` (nbgrader's ``anna/week1/...`` too), or a
    file that bears the name, ``01_vehicle_modes_anna.ipynb``. Of two files of one page the one that
    was saved last counts.

    Parameters
    ----------
    folder : Path
    pages : iterable of str
        Numbers of the pages to mark, as "1" or "01"; all if empty.

    Raises
    ------
    InputError
        There is no such folder, or nothing with exercises in it.
    """
    if not folder.is_dir():
        raise InputError("DIR", str(folder), "is no folder", "Give the one that holds a class")
    wanted = {page.lstrip("0") or "0" for page in pages}
    found: dict[tuple[str, str], Submission] = {}
    for path in sorted(folder.rglob("*.ipynb"), key=lambda path: path.stat().st_mtime):
        inside = path.relative_to(folder)
        page = _page(path)
        if page and (not wanted or page in wanted) and ".ipynb_checkpoints" not in inside.parts:
            student = inside.parts[0] if len(inside.parts) > 1 else _name(path.stem)
            found[student, page] = Submission(student, page, path)
    if not found:
        allowed = "holds no notebook with exercises"
        remedy = "One folder per student, with the notebooks inside"
        raise InputError("DIR", str(folder), allowed, remedy)
    return sorted(found.values(), key=lambda each: (each.student, int(each.page)))


def _page(path: Path) -> str:
    """Return the number of the page that a file is a copy of, or nothing."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
    asked = [name.partition(".")[0] for name in re.findall(r'rb\.check\(\\"([\d.]+)', text)]
    number = asked[0] if asked else str(int(path.stem[:2])) if path.stem[:2].isdigit() else ""
    return number if any(e.page == number for e in exercises().values()) else ""


def _name(stem: str) -> str:
    """Return what a file's name adds to ``01_vehicle_modes``: the student."""
    rest = re.sub(r"\d\d_[a-z_]+?(?=[-_ .][A-Z]|[- .]|$)", "", stem).strip("-_ .")
    return rest or stem


def marked(
    handed_in: list[Submission],
    jobs: int = 2,
    seconds: float = CELL_SECONDS,
    progress: Callable[[str], None] = lambda text: None,
) -> list[Row]:
    """Run every notebook and return a row for each student.

    Parameters
    ----------
    handed_in : list of Submission
    jobs : int
        How many run at once.
    seconds : float
        What one cell may take, s.
    progress : callable
        Called with a line of text after each notebook.
    """

    def run(each: Submission) -> tuple[Submission, dict[str, Any], list[str]]:
        scores, faults = _run(each, seconds)
        progress(f"{each.student}, notebook {int(each.page):02d}")
        return each, scores, faults

    marks: dict[str, dict[str, float]] = {each.student: {} for each in handed_in}
    remarks: dict[str, list[str]] = {each.student: [] for each in handed_in}
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        for each, scores, faults in pool.map(run, handed_in):
            marks[each.student] |= scores
            remarks[each.student] += [f"{int(each.page):02d}: {fault}" for fault in faults]
    return [Row(name, marks[name], tuple(remarks[name])) for name in marks]


def _run(each: Submission, seconds: float) -> tuple[dict[str, float], list[str]]:
    """Return the marks of one notebook's exercises, and what went wrong."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import DeadKernelError

    try:
        notebook = nbformat.read(each.path, as_version=4)
    except Exception:  # whatever a file may hold that is called a notebook
        return {}, ["it cannot be read as a notebook"]
    notebook.cells = [*notebook.cells, nbformat.v4.new_code_cell(_READ.format(page=each.page))]
    with tempfile.TemporaryDirectory() as scratch:
        there = Path(scratch) / "handed_in"
        ignored = shutil.ignore_patterns(".ipynb_checkpoints", "*.ipynb", ".*")
        shutil.copytree(each.path.parent, there, ignore=ignored)
        client = NotebookClient(
            notebook,
            kernel_name="python3",
            timeout=seconds,
            interrupt_on_timeout=True,
            allow_errors=True,
            resources={"metadata": {"path": str(there)}},
            extra_arguments=["--log-level=ERROR"],
        )
        try:
            client.execute(env={**os.environ, "OMP_NUM_THREADS": "1", "NBGRADER_EXECUTION": ""})
        except DeadKernelError:
            return {}, ["its kernel died"]
    return _read(notebook.cells, seconds)


_READ = """
import json as _json
from railbridge.lessons.marking import answers_of as _answers_of
print(_json.dumps(_answers_of("{page}", globals())))
"""


def answers_of(page: str, names: Mapping[str, Any]) -> dict[str, float]:
    """Return the marks of what a notebook's variables answer; what is open is left out.

    Parameters
    ----------
    page : str
        Number of the page, without a leading zero.
    names : mapping
        The notebook's variables by name.
    """
    asked = [e for e in exercises().values() if e.page == page and e.marks]
    replies = {e.name: (e, e.reply(names.get(e.variable))) for e in asked}
    return {
        name: round(e.marks * reply.score, 2) for name, (e, reply) in replies.items() if reply.given
    }


def _read(cells: list[Any], seconds: float) -> tuple[dict[str, float], list[str]]:
    """Return what the last cell printed, and the first error before it."""
    *own, last = cells
    slow = {"KeyboardInterrupt": f"it took longer than {seconds:g} s"}
    faults = [
        f"{slow.get(out['ename'], out['ename'])} in the cell '{source(cell).splitlines()[0][:40]}'"
        for cell in own
        if cell["cell_type"] == "code" and not CHECKED.search(source(cell))
        for out in cell["outputs"]
        if out["output_type"] == "error"
    ]
    printed = "".join(out.get("text", "") for out in last["outputs"])
    try:
        scores = json.loads(printed)
    except ValueError:
        return {}, [*faults[:1], "its answers could not be read"]
    return scores, faults[:1]


def table(rows: list[Row], asked: Iterable[Exercise]) -> str:
    """Return the marks as CSV: a row for each student, a column for each exercise.

    An empty field is an exercise without an answer.

    Parameters
    ----------
    rows : list of Row
    asked : iterable of Exercise
        What could be answered; the column "of" is the sum of its marks.
    """
    asked = [each for each in asked if each.marks]
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["student", *(e.name for e in asked), "marks", "of", "remarks"])
    for row in rows:
        given = [row.marks.get(e.name, "") for e in asked]
        total = round(sum(mark for mark in given if mark != ""), 2)
        fields = [f"{value:g}" if value != "" else "" for value in given]
        of = sum(e.marks for e in asked)
        writer.writerow([_plain(row.student), *fields, f"{total:g}", of, "; ".join(row.remarks)])
    return file.getvalue()


def _plain(name: str) -> str:
    """Return a name that a spreadsheet does not take for a formula."""
    return f"'{name}" if name[:1] in "=+-@" else name
