"""Pages of the static site, laid out as in the repository so that links between them hold;
tools/site.py builds it from them.

Notebooks are taken as they are stored, without solutions unless the site is a teacher's. A caption
becomes a place that can be linked to, a picture gets its caption as text for those who do not see
it, and a panel, which needs a running program, becomes a sentence.
"""

import inspect
import re
import shutil
import sys
from base64 import b64decode
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import nbformat
from PIL import Image

from notebooks import METADATA, PANEL_TEXT
from railbridge.lessons import editions

ROOT = Path(__file__).resolve().parents[1]
PAGES = ROOT / "build" / "site-pages"
DOCUMENTS = ("CONTRIBUTING.md", "CHANGELOG.md")
TEACHING = "teaching.md"  # answers stand there
THUMBNAIL = (640, 480)  # px, shown at half of that
# Not "failed to load": a page on disk has no program behind it that a panel could ask.
STILL = f'<p class="rb-still">{PANEL_TEXT}</p>'
CAPTION = re.compile(r"\*\*Figure (\d+\.\d+)\.\*\*\s*(.*?)(?:\n\s*\n|\Z)", re.DOTALL)
# A sentence ends before a capital; "Eq. 3" and "14.4 m" do not end one.
SENTENCE = re.compile(r"(.*?[.?!])(?=\s+[A-Z*])", re.DOTALL)

INDEX_TAIL = """

```{toctree}
:hidden:
:caption: Notebooks

%(notebooks)s
```

```{toctree}
:hidden:
:caption: More

gallery
%(documents)s
api/index
%(more)s
```
"""


@dataclass(frozen=True)
class Figure:
    """A stored picture and the text below it.

    Attributes
    ----------
    number : str
        As in "4.1".
    notebook : str
        File name without ending.
    caption : str
        First paragraph below the picture, without the number; Markdown.
    png : bytes
    """

    number: str
    notebook: str
    caption: str
    png: bytes

    @property
    def anchor(self):
        return "figure-" + self.number.replace(".", "-")

    @property
    def title(self):
        """The caption's first sentence."""
        first = SENTENCE.match(self.caption)
        return " ".join((first.group(1) if first else self.caption).split())

    @property
    def alt(self):
        """The caption for those who do not see the picture."""
        return f"Figure {self.number}. {plain(self.caption)}"


def plain(markdown):
    """Markdown without its marks; formulas by the names of their symbols."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", markdown)
    text = re.sub(r"\\(?:mathrm|mathbf|text)\b|\\[,;! ]", " ", text)
    text = re.sub(r"[*`${}]", "", text).replace("\\", "")
    return " ".join(text.split())


def caption_below(cells, i):
    """Match of the caption in the text cell that follows cell i, or None."""
    below = cells[i + 1] if i + 1 < len(cells) else None
    return (
        CAPTION.match(below.source) if below is not None and below.cell_type == "markdown" else None
    )


def pictures(cell):
    """PNG images among a cell's outputs, in order."""
    return [
        b64decode(out.data["image/png"])
        for out in cell.get("outputs", [])
        if "image/png" in out.get("data", {})
    ]


def figures(notebook, name):
    """Figures of a notebook that have a caption; the last picture of a cell is the one that the
    caption is about."""
    found = []
    for i, cell in enumerate(notebook.cells):
        caption = caption_below(notebook.cells, i)
        stored = pictures(cell)
        if caption and stored:
            found.append(Figure(caption.group(1), name, caption.group(2).strip(), stored[-1]))
    return found


def page_of(notebook, name):
    """The notebook as it goes to the site: captions that can be linked to, pictures with text,
    sentences for panels."""
    notebook.metadata = nbformat.from_dict(
        METADATA
    )  # names the language, also of a notebook that was never stored
    shown = {figure.number: figure for figure in figures(notebook, name)}
    for i, cell in enumerate(notebook.cells):
        if cell.cell_type == "markdown":
            cell.source = homeward(cell.source)
        for output in cell.get("outputs", []):
            if output.get("data", {}).get("text/plain") == PANEL_TEXT:
                output.data = nbformat.from_dict({"text/html": STILL, "text/plain": PANEL_TEXT})
        caption = caption_below(notebook.cells, i)
        figure = shown.get(caption.group(1)) if caption and pictures(cell) else None
        if figure:
            cell.metadata["mystnb"] = {"image": {"alt": figure.alt}}
            below = notebook.cells[i + 1]
            below.source = f"({figure.anchor})=\n{below.source}"
    return notebook


def homeward(markdown):
    """Links to the README as links to the first page, which it becomes."""
    return re.sub(r"\]\(((?:\.\./)*)README\.md", r"](\1index.md", markdown)


def thumbnail(png):
    """The picture, small, as PNG."""
    small = BytesIO()
    with Image.open(BytesIO(png)) as picture:
        picture = picture.convert("RGB")
        picture.thumbnail(THUMBNAIL, Image.Resampling.LANCZOS)
        picture.quantize(64, dither=Image.Dither.NONE).save(small, "png", optimize=True)
    return small.getvalue()


def gallery(shown, titles):
    """Markdown of the gallery: one picture after the other, by notebook, with links."""
    lines = [
        "# Gallery",
        "",
        "All figures of the notebooks, as they are stored. A picture leads to its place.",
        "",
    ]
    for notebook in dict.fromkeys(figure.notebook for figure in shown):
        lines += [f"## {titles[notebook]}", "", "::::{container} rb-gallery"]
        for figure in (figure for figure in shown if figure.notebook == notebook):
            lines += [
                f":::{{figure}} gallery/{figure.anchor}.png",
                f":target: notebooks/{figure.notebook}.html#{figure.anchor}",
                f":alt: {figure.alt}",
                "",
                f"**Figure {figure.number}.** {figure.title}",
                ":::",
            ]
        lines += ["::::", ""]
    return "\n".join(lines)


def first_line(thing):
    return (inspect.getdoc(thing) or "").partition("\n")[0]


def short(module):
    return module.__name__.rpartition(".")[2]


def home(name, thing, asked=()):
    """The module that defines a public name; for data, the first whose source assigns it."""
    if inspect.isclass(thing) or inspect.isroutine(thing):
        return sys.modules[thing.__module__]
    ours = [module for key, module in sys.modules.items() if key.startswith("railbridge.")]
    ours = [*asked, *ours]
    assigned = re.compile(rf"^{name}(: [^=\n]+)? = ", re.MULTILINE)
    return next(module for module in ours if assigned.search(inspect.getsource(module)))


def api_pages():
    """{file name: reStructuredText} for the public names, by room or by module of the spine."""
    import railbridge as rb

    rooms = {name: getattr(rb, name) for name in dir(rb) if name not in rb.__all__}
    modules, listed = {}, set()
    for name in rb.__all__:
        thing = getattr(rb, name)
        place = home(name, thing)
        place = rooms.get(place.__name__.split(".")[1], place)
        modules.setdefault(place, []).append(f"railbridge.{name}")
        listed.add(id(thing))
    for module in rooms.values():
        for name in module.__all__:
            thing = getattr(module, name)
            if id(thing) not in listed:
                listed.add(id(thing))
                owner = module if callable(thing) else home(name, thing, [module])
                modules.setdefault(module, []).append(f"{owner.__name__}.{name}")
    pages = {
        short(module): api_page(module, modules[module]) for module in sorted(modules, key=short)
    }
    title = "Functions and classes"
    lines = [
        title,
        "=" * len(title),
        "",
        "``import railbridge as rb`` gives all that stands here without a module's name;",
    ]
    lines += [
        "``rb.plots``, ``rb.panels`` and the like are loaded when first used. Everything is SI.",
        "",
    ]
    lines += [
        f"* :doc:`{short(module)}` - {first_line(module)}" for module in sorted(modules, key=short)
    ]
    lines += ["", ".. toctree::", "   :hidden:", "", *(f"   {name}" for name in pages), ""]
    return {**pages, "index": "\n".join(lines)}


def api_page(module, names):
    """One module's page: its own first line, then each name with its docstring."""
    title = short(module)
    lines = [
        title,
        "=" * len(title),
        "",
        first_line(module),
        "",
        f".. currentmodule:: {module.__name__}",
        "",
    ]
    for name in names:
        owner, _, last = name.rpartition(".")
        kind = directive(getattr(sys.modules[owner], last))
        lines += [f".. {kind}:: {name}", *(["   :members:"] if kind == "autoclass" else []), ""]
    return "\n".join(lines)


def directive(thing):
    """Name of the autodoc directive for a thing."""
    if inspect.isclass(thing):
        return "autoexception" if issubclass(thing, Exception) else "autoclass"
    return "autofunction" if callable(thing) else "autodata"


def without_teaching(markdown):
    """Links to the teacher's page as plain text."""
    return re.sub(rf"\[([^\]]*)\]\([^)]*{TEACHING}[^)]*\)", r"\1", markdown)


def kept(path, teacher):
    """The stored notebook, without solutions unless they are asked for."""
    notebook = nbformat.read(path, as_version=4)
    return notebook if teacher else nbformat.from_dict(editions.without_solutions(notebook))


def lay_out(pages=PAGES, teacher=False):
    """Write all pages of the site below one folder, as in the repository.

    A teacher's also has solutions, the teacher's page and its sheets.
    """
    shutil.rmtree(pages, ignore_errors=True)
    for folder in ("notebooks", "gallery", "api"):
        (pages / folder).mkdir(parents=True)
    shown, titles = [], {}
    for path in sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb")):
        notebook = kept(path, teacher)
        titles[path.stem] = notebook.cells[0].source.splitlines()[0].lstrip("# ")
        shown += figures(notebook, path.stem)
        nbformat.write(page_of(notebook, path.stem), pages / "notebooks" / path.name)
    for figure in shown:
        (pages / "gallery" / f"{figure.anchor}.png").write_bytes(thumbnail(figure.png))
    (pages / "gallery.md").write_text(gallery(shown, titles), encoding="utf-8")
    for name, text in api_pages().items():
        (pages / "api" / f"{name}.rst").write_text(text, encoding="utf-8")
    # What the pages link to.
    for name in ("binder", "data", "docker", "docs", "tests", "tools"):
        shutil.copytree(
            ROOT / name,
            pages / name,
            ignore=shutil.ignore_patterns("site", "__pycache__", "browser"),
        )
    for name in (*DOCUMENTS, "LICENSE", "LICENSE-notebooks.md", "CITATION.cff"):
        shutil.copy(ROOT / name, pages)
    if not teacher:
        (pages / "docs" / TEACHING).unlink()
    fitted = (lambda text: text) if teacher else without_teaching
    for path in (*pages.glob("*.md"), *pages.glob("docs/*.md")):
        text = path.read_text(encoding="utf-8")
        path.write_text(fitted(homeward(text)), encoding="utf-8")
    documents = sorted(
        path.relative_to(pages).with_suffix("").as_posix() for path in (pages / "docs").glob("*.md")
    )
    parts = {
        "notebooks": "\n".join(f"notebooks/{name}" for name in titles),
        "documents": "\n".join(documents),
        "more": "\n".join(
            name.removesuffix(".md") for name in (*DOCUMENTS, "LICENSE-notebooks.md")
        ),
    }
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (pages / "index.md").write_text(fitted(readme) + INDEX_TAIL % parts, encoding="utf-8")
