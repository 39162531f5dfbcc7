"""Every solution is run where its answer cell stands, and every check must then say "right".

This is what holds the tables of answers: each number there is computed by the page's own code.
"""

import json
import os
from importlib.util import find_spec
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from railbridge.lessons import editions

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "notebooks"
PAGES = [
    path
    for path in [*sorted(FOLDER.glob("[0-9][0-9]_*.ipynb")), FOLDER / "_template.ipynb"]
    if '"answer"' in path.read_text(encoding="utf-8")
]


def replies(notebook):
    """What each check cell says, by its exercise."""
    return {
        editions.exercise_of(cell).name: out["data"]["text/plain"]
        for cell in notebook["cells"]
        if editions.exercise_of(cell)
        for out in cell["outputs"]
        if "data" in out
    }


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_every_solution_is_right(path):
    kept = json.loads(path.read_text(encoding="utf-8"))
    for extra, package in ("fem", "pyfe3d"), ("study", "netCDF4"):
        says = f"Needs the extra `{extra}`" in editions.source(kept["cells"][0])
        if says and not find_spec(package):
            pytest.skip(f"needs the extra {extra}: pip install -e .[{extra}]")
    made = nbformat.reads(json.dumps(editions.teacher(kept)), as_version=4)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    NotebookClient(
        made, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}}
    ).execute()
    asked = [
        editions.exercise_of(cell).name for cell in kept["cells"] if editions.exercise_of(cell)
    ]
    said = replies(made)
    assert said.keys() == set(asked)
    assert {name: text for name, text in said.items() if ": right" not in text} == {}
