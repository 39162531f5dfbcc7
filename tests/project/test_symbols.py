"""One symbol, one meaning: every notebook's table against the list of the suite."""

import re
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = [
    *sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb")),
    ROOT / "notebooks/_template.ipynb",
]


def rows(text):
    """The cells of every table row whose first cell is a formula."""
    lines = [line for line in text.splitlines() if re.match(r"\| *\$", line)]
    return [[cell.strip() for cell in line.strip().strip("|").split(" | ")] for line in lines]


LIST = {
    symbol: (meaning, unit)
    for symbol, meaning, unit in rows((ROOT / "docs/symbols.md").read_text())
}


def tables(path):
    cells = nbformat.read(path, as_version=4).cells
    found = [
        c.source for c in cells if c.cell_type == "markdown" and "| symbol | in code |" in c.source
    ]
    return [row for text in found for row in rows(text)]


def test_the_list_names_every_symbol_once():
    text = (ROOT / "docs/symbols.md").read_text()
    assert len(rows(text)) == len(LIST)
    single = [s for symbols in LIST for s in re.split(r", (?![^{]*\})", symbols.strip("$"))]
    assert sorted({s for s in single if single.count(s) > 1}) == []


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_a_notebook_means_what_the_list_means(path):
    for symbol, _, meaning, *_ in tables(path):
        assert symbol in LIST, f"{symbol} is missing in docs/symbols.md"
        assert meaning == LIST[symbol][0], symbol
