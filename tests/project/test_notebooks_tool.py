"""Storing outputs (tools/notebooks.py) and comparing them (nbval, conftest.py): both must fail when
they should."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from base64 import b64decode, b64encode
from io import BytesIO
from pathlib import Path

import matplotlib.pyplot as plt
import nbformat
import numpy as np
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
TEMPLATE = ROOT / "notebooks" / "_template.ipynb"


@pytest.fixture(scope="module")
def tool():
    spec = importlib.util.spec_from_file_location("notebooks_tool", ROOT / "tools" / "notebooks.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def notebook(*sources, **outputs):
    cells = [new_markdown_cell("text"), *(new_code_cell(source) for source in sources)]
    for name, output in outputs.items():
        cells[-1].outputs = [new_output(name, **output)]
    return new_notebook(cells=cells)


def test_what_is_stored_depends_on_the_cells_alone(tool, tmp_path):
    path = tmp_path / "01_a.ipynb"
    page = notebook(
        "import sys\nfor i in range(3):\n    print(i)\n    sys.stdout.flush()",
        "import ipywidgets as widgets\nwidgets.VBox([widgets.FloatSlider(), widgets.Label('x')])",
    )
    page.metadata = {"widgets": {}, "kernelspec": {"name": "someones-own", "display_name": "Mine"}}
    page.cells[1].metadata = {
        "tags": ["kept"],
        "execution": {"iopub.status.busy": "2020-01-01T00:00:00"},
    }
    nbformat.write(page, path)
    line, good = tool.store(path)
    assert good and line.startswith("stored")
    stored = nbformat.read(path, as_version=4)
    assert stored.metadata == tool.METADATA
    assert stored.cells[1].metadata == {"tags": ["kept"]}
    assert [out.text for out in stored.cells[1].outputs] == ["0\n1\n2\n"]
    assert [out.data for out in stored.cells[2].outputs] == [{"text/plain": tool.PANEL_TEXT}]
    assert [cell.execution_count for cell in stored.cells[1:]] == [1, 2]
    before = path.read_bytes()
    line, good = tool.store(path)
    assert good and line.startswith("unchanged")
    assert path.read_bytes() == before
    assert [*tmp_path.iterdir()] == [path]


def test_a_notebook_that_raises_is_not_stored(tool, tmp_path):
    path = tmp_path / "01_a.ipynb"
    nbformat.write(notebook("print('first')", "1 / 0"), path)
    before = path.read_bytes()
    line, good = tool.store(path)
    assert not good
    assert line.startswith("REFUSED    01_a.ipynb") and "ZeroDivisionError" in line
    assert path.read_bytes() == before
    assert [*tmp_path.iterdir()] == [path]


@pytest.mark.parametrize(
    ("kind", "output", "reason"),
    [
        ("stream", {"name": "stderr", "text": "UserWarning: careful"}, "warns"),
        (
            "error",
            {"ename": "ValueError", "evalue": "no", "traceback": []},
            "raises ValueError: no",
        ),
        (
            "execute_result",
            {"data": {"text/plain": "<function f at 0x7f00deadbeef>"}},
            "memory address",
        ),
    ],
)
def test_outputs_that_are_refused(tool, kind, output, reason):
    with pytest.raises(tool.Refused, match=reason):
        tool.complain(notebook("x", **{kind: output}))


def test_missing_and_repeated_cell_ids_become_the_same_in_every_run(tool):
    page = notebook("a = 1", "a = 2")
    for cell in page.cells:
        cell["id"] = "same"
    tool.tidy(page)
    assert [cell["id"] for cell in page.cells] == ["same", "cell-001", "cell-002"]


def test_check_lists_notebooks_without_outputs(tool, tmp_path, capsys):
    path = tmp_path / "01_a.ipynb"
    nbformat.write(notebook("x = 1"), path)
    with pytest.raises(SystemExit) as stop:
        tool.main(["--check", str(path)])
    assert stop.value.code == 1
    assert "01_a.ipynb" in capsys.readouterr().out


def test_a_rendered_page_shows_the_figure_and_a_sentence_for_the_panel(tool):
    from nbconvert import HTMLExporter

    page, _ = HTMLExporter().from_filename(str(TEMPLATE))
    body = page[page.index("<body") :]
    at = body.index(tool.PANEL_TEXT)
    explore = body.index(">Explore<")
    assert "data:image/png;base64" in body[explore:at]
    assert "widget-view+json" not in body and "FloatSlider(value" not in body


def changed_digit(page):
    """Change the last digit of the first compared print."""
    cell = next(
        cell for cell in page.cells if "nbval-check-output" in cell.metadata.get("tags", [])
    )
    text = cell.outputs[0].text
    at = [match.start() for match in re.finditer(r"\d", text)][-1]
    cell.outputs[0].text = text[:at] + str((int(text[at]) + 1) % 10) + text[at + 1 :]


def stripped(page):
    for cell in page.cells:
        if cell.cell_type == "code":
            cell.update(outputs=[], execution_count=None)


def test_a_changed_digit_and_a_stripped_notebook_fail(tmp_path):
    """The real settings on three copies of a stored notebook: as it is, one digit changed, outputs
    removed."""
    for name in ("conftest.py", "pyproject.toml", "tests/nbval_sanitize.cfg"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    for name, change in (("as_it_is", None), ("changed", changed_digit), ("stripped", stripped)):
        page = nbformat.read(TEMPLATE, as_version=4)
        del page.cells[16:]  # as far as its first compared print, to save time
        if change:
            change(page)
        nbformat.write(page, tmp_path / f"{name}.ipynb")
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")
    }
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            "--color=no",
            "-p",
            "no:cacheprovider",
            "--rootdir=.",
            ".",
        ],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
    )
    failed = re.findall(r"^FAILED (\w+)\.ipynb::Cell (\d+)", done.stdout, re.MULTILINE)
    assert done.returncode == 1, done.stdout
    assert failed.count(("changed", "3")) == 1, "the first cell that is compared"
    assert {name for name, _ in failed} == {"changed", "stripped"}
    assert [name for name, _ in failed].count("changed") == 1
    assert "Cell outputs differ" in done.stdout
    assert "stored without output" in done.stdout


def test_pictures_are_stored_small_and_look_the_same(tool):
    figure, ax = plt.subplots()
    ax.plot(np.sin(np.linspace(0.0, 60.0, 500)), "C1")
    whole = BytesIO()
    figure.savefig(whole, format="png", dpi=100)
    plt.close(figure)
    stored = tool.with_few_colours(b64encode(whole.getvalue()).decode())
    assert len(b64decode(stored)) < 0.6 * len(whole.getvalue())
    before, after = (
        np.asarray(Image.open(BytesIO(b)).convert("RGB"), dtype=float)
        for b in (whole.getvalue(), b64decode(stored))
    )
    assert before.shape == after.shape
    assert np.abs(before - after).mean() < 1.0
