"""What the site is laid out from: captions, texts for pictures, links, the list of functions.

The build itself runs in CI.
"""

import re
from base64 import b64encode
from io import BytesIO
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output
from PIL import Image

import railbridge as rb
import site_pages
from notebooks import PANEL_TEXT

NOTEBOOKS = sorted((Path(__file__).resolve().parents[2] / "notebooks").glob("[0-9][0-9]_*.ipynb"))
CAPTION = (
    "**Figure 4.1.** Waves of 14.4 m, as in Eq. 3 of\nthe *paper*. Then $V/\\lambda$ "
    "falls.\n\nMore text."
)


def png(width=900, height=450):
    buffer = BytesIO()
    Image.new("RGB", (width, height), "white").save(buffer, "png")
    return buffer.getvalue()


def drawn(*images):
    shown = [
        new_output("display_data", {"image/png": b64encode(image).decode()}) for image in images
    ]
    return new_code_cell("plt.show()", outputs=shown)


@pytest.fixture
def page():
    """A notebook with a figure, a picture and a caption without the other, and a panel."""
    panel = new_output("display_data", {"text/plain": PANEL_TEXT})
    return new_notebook(
        cells=[
            new_markdown_cell(
                "# 04 - Find\n\nSee [the README](../README.md#start) and [03](03_x.ipynb)."
            ),
            drawn(png(), png(800)),
            new_markdown_cell(
                "**Figure 4.1.** Waves of 14.4 m, as in Eq. 3 of\nthe *paper*. Then "
                "$V/\\lambda$ falls.\n\nMore text."
            ),
            drawn(png()),
            new_markdown_cell("No caption."),
            new_code_cell("1"),
            new_markdown_cell("**Figure 4.2.** Nothing was drawn."),
            new_code_cell("panel", outputs=[panel]),
        ]
    )


def test_a_figure_is_a_picture_with_its_caption_below(page):
    (figure,) = site_pages.figures(page, "04_x")
    assert (figure.number, figure.anchor, figure.notebook) == ("4.1", "figure-4-1", "04_x")
    assert figure.title == "Waves of 14.4 m, as in Eq. 3 of the *paper*."
    assert (
        figure.alt == "Figure 4.1. Waves of 14.4 m, as in Eq. 3 of the paper. Then V/lambda falls."
    )
    assert Image.open(BytesIO(figure.png)).width == 800  # the last picture stands above the caption


def test_page_has_places_texts_and_sentences(page):
    made = site_pages.page_of(page, "04_x")
    assert made.cells[2].source.startswith("(figure-4-1)=\n**Figure 4.1.**")
    assert made.cells[1].metadata["mystnb"]["image"]["alt"].startswith("Figure 4.1. Waves")
    assert "mystnb" not in made.cells[3].metadata
    assert made.cells[6].source == "**Figure 4.2.** Nothing was drawn."
    assert PANEL_TEXT in made.cells[7].outputs[0].data["text/html"]
    assert (
        "](../index.md#start)" in made.cells[0].source and "](03_x.ipynb)" in made.cells[0].source
    )


def test_thumbnails_are_small_and_keep_their_shape():
    small = Image.open(BytesIO(site_pages.thumbnail(png(1800, 900))))
    assert small.size == (640, 320)
    assert Image.open(BytesIO(site_pages.thumbnail(png(300, 600)))).size == (240, 480)


def test_gallery_leads_to_the_place_of_each_picture(page):
    text = site_pages.gallery(site_pages.figures(page, "04_x"), {"04_x": "04 - Find"})
    assert ":target: notebooks/04_x.html#figure-4-1" in text
    assert ":::{figure} gallery/figure-4-1.png" in text
    assert "## 04 - Find" in text


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_stored_caption_finds_its_picture(path):
    notebook = nbformat.read(path, as_version=4)
    written = [
        number
        for cell in notebook.cells
        if cell.cell_type == "markdown"
        for number in re.findall(r"^\*\*Figure (\d+\.\d+)\.\*\*", cell.source, re.MULTILINE)
    ]
    found = [figure.number for figure in site_pages.figures(notebook, path.stem)]
    # An animation or a diagram has no picture to make small.
    other = [n for n in written if n not in found]
    cells = {i: site_pages.caption_below(notebook.cells, i) for i in range(len(notebook.cells))}
    for number in other:
        above = next(
            notebook.cells[i]
            for i, caption in cells.items()
            if caption and caption.group(1) == number
        )
        shown = {kind for out in above.outputs for kind in out.get("data", {})}
        assert shown & {"text/html", "image/svg+xml"}, f"Figure {number} has no picture"
    assert len(set(found)) == len(found)


def test_every_public_name_has_its_place():
    pages = site_pages.api_pages()
    text = "\n".join(pages.values())
    for name in rb.__all__:
        assert f":: railbridge.{name}\n" in text, name
    for name in rb.plots.__all__:
        assert f":: railbridge.plots.{name}\n" in text, name
    assert ".. autoexception:: railbridge.NotConvergedError" in text
    assert ".. autoclass:: railbridge.panels.Panel" in text
    assert all(f":doc:`{name}`" in pages["index"] for name in pages if name != "index")


@pytest.fixture(scope="module")
def sites(tmp_path_factory):
    """The pages for students and for teachers, laid out."""
    made = {}
    for teacher in (False, True):
        made[teacher] = tmp_path_factory.mktemp("pages") / "site"
        site_pages.lay_out(made[teacher], teacher)
    return made


def words(folder, *patterns):
    return "".join(p.read_text(encoding="utf-8") for each in patterns for p in folder.glob(each))


def test_the_students_site_has_neither_answers_nor_the_teachers_page(sites):
    notebooks = words(sites[False], "notebooks/*.ipynb")
    assert "<summary>Solution" not in notebooks and "<summary>Hint" in notebooks
    assert not (sites[False] / "docs" / "teaching.md").exists()
    assert "teaching.md)" not in words(sites[False], "*.md", "docs/*.md", "notebooks/*.ipynb")
    assert "docs/teaching\n" not in (sites[False] / "index.md").read_text(encoding="utf-8")


def test_a_teachers_site_has_both(sites):
    assert "<summary>Solution" in words(sites[True], "notebooks/*.ipynb")
    assert (sites[True] / "docs" / "teaching.md").exists()
    assert "(docs/teaching.md)" in (sites[True] / "index.md").read_text(encoding="utf-8")
