"""The rules of the page, the same for every notebook. `notebooks/_template.ipynb` explains them and
is checked too.

`broken_rules` returns one line for each rule that a notebook breaks. The tests below apply it to
every notebook in the folder, and to copies of the template that break one rule each, so that no
rule can fall silent.
"""

import copy
import importlib.util
import re
from dataclasses import dataclass
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "notebooks"
TEMPLATE = FOLDER / "_template.ipynb"
TEMPLATE_NUMBER = "99"
NUMBERED = sorted(FOLDER.glob("[0-9][0-9]_*.ipynb"))

GOALS, THEORY, SOLVE = "What you will be able to do", "Theory", "Build, solve, look"
OPEN, CHECK, EXPLORE, EXERCISES = "Open the box", "Check", "Explore", "Exercises"
FOUND, REFERENCES, SYMBOLS = "What we found", "References", "Symbols"
OPENING = ""  # what stands before the first second-level heading


@dataclass(frozen=True)
class Page:
    """What is asked of one notebook; a heading that is not listed may stand anywhere."""

    sections: tuple = (
        GOALS,
        THEORY,
        SOLVE,
        OPEN,
        CHECK,
        EXPLORE,
        EXERCISES,
        FOUND,
        REFERENCES,
        SYMBOLS,
    )
    words: tuple = (500, 1500)
    code_lines: tuple = (40, 130)
    exercises: tuple = ("recall", "change", "extend")
    needs: tuple = ("You need", "Time", "Equations")


# The pages that are no lessons of the usual kind: the door, the comparison, the long check, and the
# one with two programs.
PAGES = {
    # How pages and panels are run, and one exercise, to try how they answer.
    "00": Page(
        (GOALS, EXPLORE, EXERCISES, FOUND, REFERENCES),
        (200, 1600),
        (5, 80),
        ("try",),
        ("You need", "Time"),
    ),
    # A car that moves, the step of a mode by hand, and how far its wheels may have no mass.
    "03": Page(words=(500, 1600), code_lines=(40, 145)),
    # The loop twice: once in fifteen lines without the suite.
    "06": Page(words=(500, 2000), code_lines=(40, 180)),
    # Every table and result of the paper, each with its picture and its layout.
    "08": Page((GOALS, CHECK, FOUND, REFERENCES), (500, 3100), (20, 320), (), ("You need", "Time")),
    "09": Page((GOALS, CHECK, EXERCISES, FOUND, REFERENCES, SYMBOLS), (500, 3000), (20, 280)),
    # Two subjects: what a random track is, and what can be said of a crossing of it.
    "10": Page(words=(500, 2000), code_lines=(40, 180)),
    # Verdicts and where they come from; then two real bridges, each with what is known of it.
    "11": Page(words=(500, 2000), code_lines=(40, 180)),
    # The other program that the page needs is written out on it.
    "12": Page(code_lines=(40, 170)),
    # Four subjects, each with its picture and its limits in numbers: mass of wheels, rails, the
    # spring of the contact, wheels that lift.
    "13": Page(words=(500, 2000), code_lines=(40, 190)),
    # Two models, and how the box behind them was found.
    "14": Page(words=(500, 1900), code_lines=(40, 160)),
}
COURSE = ("00", "01", "02", "03", "04", "05", "06", "07", "08")
CELL_LINES = 15
PRINTED_LETTERS = (
    100  # what a page of the site shows; JupyterLab wraps longer lines in a narrow window
)
COLOURS = "plt.style.use(rb.plots.STYLE)"
FIGURE_WORDS = 12
FILE_BYTES = 400_000

# Tags of a cell. The first two are read by nbval and by railbridge.lessons.
MARKED, ANSWER, CHECKS, EXEMPT = "nbval-check-output", "answer", "check", "not-compared: "
# A section or a shell of a box; and where the page says what that needs.
USES_FEM = re.compile(r"\brb\.box\(|\brb\.Box\(|railbridge\.boxes\b")
SAYS_FEM = re.compile(r"# .*\n\nNeeds the extra `fem`")
SYMBOL_HEADER = ["symbol", "in code", "meaning", "unit", "value", "source"]
RAW_IN_JUPYTER = {
    r"\eqref": "write (3.1) as text",
    ":::{": "use <details> or an alert",
    "> [!": "use an alert <div>",
}
FORBIDDEN_TAGS = ("nbval-skip", "nbval-ignore-output", "nbval-raises-exception", "raises-exception")
# What belongs to tests and stands in tags and docs, not in a lesson.
MACHINERY = re.compile(r"NBVAL_|\bnbval\b|\btest_\w+|\bpytest\b")
FOLDED = re.compile(r"<details>.*?</details>", re.DOTALL)
MACHINE_PATH = re.compile(r"(?<![\w.])/(?:home|root|tmp|Users)/|\b[A-Z]:\\")
WIDGET = "application/vnd.jupyter.widget-"


def load_tool():
    spec = importlib.util.spec_from_file_location("notebooks_tool", ROOT / "tools" / "notebooks.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


PANEL_TEXT = load_tool().PANEL_TEXT


# ---- reading a notebook


def is_code(cell):
    return cell.cell_type == "code"


def is_text(cell):
    return cell.cell_type == "markdown"


def tags(cell):
    return cell.metadata.get("tags", [])


def exempt(cell):
    """True if the cell says why what it prints is not compared."""
    return any(tag.startswith(EXEMPT) and len(tag) > len(EXEMPT) + 10 for tag in tags(cell))


def figures(cell):
    return sum(
        mime.startswith("image/") for out in cell.get("outputs", []) for mime in out.get("data", {})
    )


def is_panel(cell):
    return any(
        out.get("data", {}).get("text/plain") == PANEL_TEXT for out in cell.get("outputs", [])
    )


def prints(cell):
    """True if the stored cell shows text that is neither the shadow of a figure nor of a panel."""
    for out in cell.get("outputs", []):
        data = out.get("data", {})
        shown = (
            out.get("text")
            or ("text/html" in data)
            or ("text/latex" in data)
            or data.get("text/plain")
        )
        if (
            shown
            and not any(mime.startswith("image/") for mime in data)
            and data.get("text/plain") != PANEL_TEXT
        ):
            return True
    return False


def code_lines(cell):
    """Lines that a reader has to read: not blank, not the setting that stands on every page."""
    lines = [line.strip() for line in cell.source.splitlines()]
    return [line for line in lines if line and COLOURS not in line]


def prose(cell):
    """The words of a text cell, without what is folded, formulas, tables, links' targets, HTML tags
    and code."""
    text = re.sub(
        r"```.*?```|\$\$.*?\$\$|\$[^$\n]*\$|<[^>]+>|\]\([^)]*\)",
        " ",
        FOLDED.sub(" ", cell.source),
        flags=re.DOTALL,
    )
    text = re.sub(r"^\s*\|.*$", " ", text, flags=re.MULTILINE)
    return [word for word in text.split() if re.search(r"[^\W\d_]", word)]


def headings(cell, level):
    source = re.sub(r"```.*?```", "", cell.source, flags=re.DOTALL)
    return re.findall(rf"^{'#' * level} +(.+?) *$", source, re.MULTILINE) if is_text(cell) else []


def section_of(notebook):
    """{heading: its cells}; the cells before the first second-level heading stand under ''."""
    sections, current = {"": []}, ""
    for cell in notebook.cells:
        for heading in headings(cell, 2):
            current = heading
        sections.setdefault(current, []).append(cell)
    return sections


def joined(cells):
    return "\n".join(cell.source for cell in cells)


# ---- the rules, in groups


def rules_of_the_page(notebook, number, page):
    first = notebook.cells[0].source if notebook.cells else ""
    title = re.match(r"# (\d\d) - [A-Z][a-z]+ \S.*", first)
    if not title or title.group(1) != number:
        yield f"the first line is the title: '# {number} - Verb ...'"
    if sum(len(headings(cell, 1)) for cell in notebook.cells) != 1:
        yield "there is one first-level heading, the title"
    code = joined(filter(is_code, notebook.cells))
    if USES_FEM.search(code) and not SAYS_FEM.match(first):
        yield "a page that needs an extra says so below its title: 'Needs the extra `fem`'"
    if "?" not in first:
        yield "the question that the page answers stands below the title"
    found = [heading for cell in notebook.cells for heading in headings(cell, 2)]
    for heading in page.sections:
        if found.count(heading) != 1:
            yield f"section '## {heading}' appears once"
    present = [heading for heading in found if heading in page.sections]
    if len(present) == len(page.sections) and present != list(page.sections):
        yield "sections stand in this order: " + ", ".join(page.sections)
    sections = section_of(notebook)
    for need in page.needs:
        if f"**{need}:**" not in joined(sections[OPENING]):
            yield f"'**{need}:**' stands above '{GOALS}'"
    text = joined(filter(is_text, notebook.cells))
    if found := MACHINERY.search(joined(notebook.cells)):
        yield f"how pages are tested is no part of a lesson: '{found.group()}'"
    for raw, instead in RAW_IN_JUPYTER.items():
        if raw in text:
            yield f"JupyterLab shows '{raw}' as it is: {instead}"
    words = sum(len(prose(cell)) for cell in notebook.cells if is_text(cell))
    if not page.words[0] <= words <= page.words[1]:
        yield f"{page.words[0]} to {page.words[1]} words of text, not {words}"


def rules_of_the_opening(notebook, number, page):
    """Something to see and something to guess come first."""
    opening = section_of(notebook)[OPENING]
    seen = [cell for cell in opening if figures(cell) or is_panel(cell)]
    if not seen:
        yield f"a picture or a panel stands above '{GOALS}'"
    if page.exercises:
        guess = f"guess_{int(number)}"
        if not any(ANSWER in tags(cell) and f"{guess} = ..." in cell.source for cell in opening):
            yield f"a guess to write down, '{guess} = ...' tagged {ANSWER}, above '{GOALS}'"
        asked = f'rb.check("{int(number)}.guess", {guess})'
        if not any(CHECKS in tags(cell) and cell.source == asked for cell in notebook.cells):
            yield f"where the page shows it, the guess is checked: {asked}"


def rules_of_the_sections(notebook, number, page):
    sections = section_of(notebook)
    if SYMBOLS in page.sections:
        folds = FOLDED.findall(joined(filter(is_text, sections.get(SYMBOLS, []))))
        rows = [
            [entry.strip().lower() for entry in line.strip("| ").split("|")]
            for line in "\n".join(folds).splitlines()
        ]
        if SYMBOL_HEADER not in rows:
            yield "a folded symbol table with the columns " + " | ".join(SYMBOL_HEADER)
        if not any("(../docs/symbols.md)" in fold for fold in folds):
            yield "the symbol table leads to the list of the suite, ../docs/symbols.md"
    if THEORY in page.sections:
        code = joined(filter(is_code, notebook.cells))
        if "rb.plots.diagram(" not in code and "rb.plots.vehicle(" not in code:
            yield "a drawn sketch: rb.plots.diagram or rb.plots.vehicle"
        blocks = re.findall(
            r"^```(\w*)\n(.*?)^```", joined(notebook.cells), re.DOTALL | re.MULTILINE
        )
        if any(not language and re.search(r"--|\|", block) for language, block in blocks):
            yield "sketches are drawn, not made of letters"
    if THEORY in page.sections and rf"\tag{{{int(number)}." not in joined(sections.get(THEORY, [])):
        yield rf"numbered equations in '{THEORY}': \tag{{{int(number)}.1}}"
    if OPEN in page.sections and not any(
        "assert" in c.source for c in sections.get(OPEN, []) if is_code(c)
    ):
        yield f"'{OPEN}' asserts that the derivation equals the helper"
    if CHECK in page.sections and not any(MARKED in tags(cell) for cell in sections.get(CHECK, [])):
        yield f"'{CHECK}' compares numbers in a cell tagged {MARKED}"
    for heading, cells in sections.items():
        for i, cell in enumerate(cells):
            if heading and is_panel(cell) and not any(map(figures, cells[:i])):
                yield f"in '{heading}' a static figure stands before the panel"
    yield from rules_of_the_exercises(sections.get(EXERCISES, []), number, page)
    text = joined(notebook.cells)
    if text.count("<details>") != text.count("</details>"):
        yield "every <details> is closed"


def rules_of_the_exercises(cells, number, page):
    """Each has a cell to answer in, one that answers, a hint and a solution that can be run."""
    if not page.exercises:
        return
    parts, current = [], None
    for cell in cells:
        for title in headings(cell, 3):
            current = (title, [])
            if title.startswith("Exercise"):
                parts.append(current)
        if current:
            current[1].append(cell)
    titles = [title for title, _ in parts]
    for kind in page.exercises:
        if not any(title.endswith(f"({kind})") for title in titles):
            yield f"an exercise '### Exercise {int(number)}.1 ({kind})'"
    if any("assert" in cell.source for cell in cells if is_code(cell)):
        yield f"no assert in '{EXERCISES}': it gives the solution away"
    for i, (title, part) in enumerate(parts, start=1):
        if not title.startswith(f"Exercise {int(number)}.{i} ("):
            yield f"exercise {i} is called '### Exercise {int(number)}.{i} (...)', not '{title}'"
        text = joined(filter(is_text, part))
        for fold in ("Hint", "Solution"):
            if not re.search(rf"<details>\s*<summary>{fold}[^<]*</summary>\n\n", text):
                yield (
                    f"'{title}': <details><summary>{fold}</summary>, then an empty line, "
                    "then the text"
                )
        name = f"{int(number)}.{i}"
        answers = [cell for cell in part if ANSWER in tags(cell)]
        checks = [cell for cell in part if CHECKS in tags(cell)]
        if len(answers) != 1 or "..." not in answers[0].source:
            yield f"'{title}': one cell tagged {ANSWER}, with three dots to replace"
        called = rf'rb\.check\("{re.escape(name)}", \w+\)'
        if len(checks) != 1 or not re.fullmatch(called, checks[0].source):
            yield f"'{title}': one cell tagged {CHECKS}: rb.check(\"{name}\", ...)"
        if not re.search(r"<summary>Solution[^<]*</summary>.*```python\n", text, re.DOTALL):
            yield f"'{title}': the solution has a block of Python that can stand in the answer cell"
        if any(FOLDED.sub("", cell.source).strip() for cell in part[-1:] if is_text(cell)):
            yield f"'{title}': the solution has a text cell of its own, the last one"


def rules_of_the_cells(notebook, number, page):
    if not any(map(is_code, notebook.cells)):
        yield "there is code"
    total = 0
    for before, cell in zip([None, *notebook.cells], notebook.cells, strict=False):
        if not is_code(cell):
            continue
        lines = code_lines(cell)
        total += 0 if {ANSWER, CHECKS} & {*tags(cell)} else len(lines)
        name = f"cell '{lines[0][:40] if lines else ''}'"
        if before is None or (not is_text(before) and CHECKS not in tags(cell)):
            yield f"{name}: a text cell stands before it"
        if not lines:
            yield f"{name} is empty"
        if len(lines) > CELL_LINES:
            yield f"{name}: {len(lines)} lines, limit {CELL_LINES}"
        for tag in FORBIDDEN_TAGS:
            if tag in tags(cell):
                yield f"{name}: {tag} hides what is printed; tag it '{EXEMPT}reason'"
    if not page.code_lines[0] <= total <= page.code_lines[1]:
        yield f"{page.code_lines[0]} to {page.code_lines[1]} lines of code, not {total}"
    importing = [
        cell
        for cell in notebook.cells
        if is_code(cell) and re.search(r"^(import|from) ", cell.source, re.M)
    ]
    if len(importing) > 1:
        yield "one cell imports, not " + str(len(importing))
    if "plt.subplots(" in joined(filter(is_code, notebook.cells)) and not any(
        COLOURS in cell.source for cell in importing
    ):
        yield (
            f"a page that draws by itself sets the colours of the suite where it imports: {COLOURS}"
        )


def rules_of_the_figures(notebook, number, page):
    shown = 0
    for cell, after in zip(notebook.cells, [*notebook.cells[1:], None], strict=True):
        if not figures(cell):
            continue
        shown += 1
        label = f"**Figure {int(number)}.{shown}.**"
        if figures(cell) > 1:
            yield f"one figure a cell; there are {figures(cell)} before {label}"
        if after is None or not is_text(after) or not after.source.startswith(label):
            yield f"the text cell after a figure starts with {label}"
        elif len(prose(after)) - 2 < FIGURE_WORDS:
            yield f"{label} says in at least {FIGURE_WORDS} words what is to be seen"


def rules_of_the_outputs(notebook, number, page):
    counts = [cell.execution_count for cell in notebook.cells if is_code(cell)]
    if counts != [*range(1, len(counts) + 1)]:
        yield "stored by tools/notebooks.py: all cells executed once, in order"
    if "widgets" in notebook.metadata:
        yield "no stored widget state"
    for cell in filter(is_code, notebook.cells):
        name = f"cell '{cell.source.splitlines()[0][:40] if cell.source else ''}'"
        marked = MARKED in tags(cell)
        if prints(cell) and not marked and not exempt(cell):
            yield f"{name} prints: tag it '{MARKED}' or '{EXEMPT}reason'"
        for line in "".join(
            out.text for out in cell.outputs if out.get("name") == "stdout"
        ).splitlines():
            if len(line) > PRINTED_LETTERS:
                yield (
                    f"{name} prints {len(line)} letters in a line, limit {PRINTED_LETTERS}: "
                    f"'{line[:30]}'"
                )
        if (marked or exempt(cell)) and not prints(cell):
            yield f"{name} is marked but prints nothing"
        if marked and exempt(cell):
            yield f"{name} is marked both for comparison and as not compared"
        for out in cell.outputs:
            if out.output_type == "error":
                yield f"{name}: no stored error"
            if out.get("name") == "stderr":
                yield f"{name}: no stored warning"
            if any(mime.startswith(WIDGET) for mime in out.get("data", {})):
                yield f"{name}: no stored widget view"
            if MACHINE_PATH.search(
                str(out.get("text", "")) + str(out.get("data", {}).get("text/plain", ""))
            ):
                yield f"{name}: no path of a machine"


def rules_of_the_links(notebook, number, page, path):
    text = re.sub(
        r"```.*?```|`[^`\n]*`", "", joined(filter(is_text, notebook.cells)), flags=re.DOTALL
    )
    for target in [
        *re.findall(r"\]\(<?([^)>\s]+)>?[^)]*\)", text),
        *re.findall(r"(?:src|href)=\"([^\"]+)\"", text),
    ]:
        local = target.split("#")[0]
        if local and not re.match(r"\w+:", target) and not (path.parent / local).exists():
            yield f"link to {target}: no such file"
    following = [
        other.name
        for other in sorted(path.parent.glob("[0-9][0-9]_*.ipynb"))
        if other.name[:2] > number
    ]
    if (
        following
        and number != TEMPLATE_NUMBER
        and not re.search(rf"\*\*Next:\*\* \[[^]]+\]\({following[0]}\)", text)
    ):
        yield f"'**Next:** [title]({following[0]})' leads on"


def broken_rules(notebook, path):
    """One line for each rule that the notebook breaks."""
    number = TEMPLATE_NUMBER if path.name == TEMPLATE.name else path.name[:2]
    page = PAGES.get(number, Page())
    groups = (
        rules_of_the_page,
        rules_of_the_opening,
        rules_of_the_sections,
        rules_of_the_cells,
        rules_of_the_figures,
        rules_of_the_outputs,
    )
    found = [line for group in groups for line in group(notebook, number, page)]
    return found + [*rules_of_the_links(notebook, number, page, path)]


# ---- the notebooks obey


@pytest.mark.parametrize("path", [*NUMBERED, TEMPLATE], ids=lambda path: path.name)
def test_notebook_obeys_the_rules(path):
    assert path.stat().st_size < FILE_BYTES, f"limit {FILE_BYTES / 1000:.0f} kB"
    text = path.read_text(encoding="utf-8")
    nbformat.validate(nbformat.reads(text, as_version=nbformat.NO_CONVERT))
    notebook = nbformat.reads(text, as_version=4)
    assert '"application/vnd.jupyter.widget' not in text
    assert broken_rules(notebook, path) == []


def test_the_course_is_complete():
    numbers = [path.name[:2] for path in NUMBERED]
    assert [n for n in COURSE if n not in numbers] == []


def test_numbers_are_used_once():
    numbers = [path.name[:2] for path in NUMBERED]
    assert numbers == sorted(set(numbers))


def test_printed_cells_are_compared():
    """Counts, over all notebooks, what is printed against what is compared or openly left out."""
    cells = [
        c
        for path in [*NUMBERED, TEMPLATE]
        for c in nbformat.read(path, as_version=4).cells
        if is_code(c)
    ]
    printing = [cell for cell in cells if prints(cell)]
    compared = [cell for cell in printing if MARKED in tags(cell)]
    left_out = [cell for cell in printing if exempt(cell)]
    assert len(compared) + len(left_out) == len(printing)
    assert len(left_out) < len(compared), "most of what is printed can be compared"


# ---- and no rule is asleep: each of these breaks the template in one place


def replace(old, new, kind=None):
    def change(notebook):
        cells = [
            c for c in notebook.cells if old in c.source and (kind is None or c.cell_type == kind)
        ]
        assert cells, f"the template no longer contains {old!r}"
        cells[0].source = cells[0].source.replace(old, new)

    return change


def first(notebook, condition):
    return next(cell for cell in notebook.cells if condition(cell))


def drop_caption(notebook):
    i = next(i for i, cell in enumerate(notebook.cells) if figures(cell))
    notebook.cells[i + 1].source = "A picture."


def short_caption(notebook):
    i = next(i for i, cell in enumerate(notebook.cells) if figures(cell))
    notebook.cells[i + 1].source = "**Figure 99.1.** It goes up."


def drop_text_before_code(notebook):
    second = [i for i, cell in enumerate(notebook.cells) if is_code(cell)][1]
    del notebook.cells[second - 1]


def swap_sections(notebook):
    for cell in notebook.cells:
        for a, b in ((CHECK, "SWAP"), (EXPLORE, CHECK), ("SWAP", EXPLORE)):
            cell.source = re.sub(rf"^## {a}$", f"## {b}", cell.source, flags=re.MULTILINE)


def panel_first(notebook):
    i = next(i for i, cell in enumerate(notebook.cells) if is_panel(cell))
    j = max(j for j in range(i) if figures(notebook.cells[j]))
    notebook.cells[j].outputs = []


def output(**fields):
    def change(notebook):
        first(notebook, is_code).outputs.append(nbformat.v4.new_output(**fields))

    return change


def stream(text, name="stdout"):
    return output(output_type="stream", name=name, text=text)


BREAKING = {
    "another number": (replace("# 99 -", "# 98 -"), "the first line is the title"),
    "no verb": (replace("# 99 - ", "# 99 - The"), "the first line is the title"),
    "two titles": (replace(f"## {OPEN}", f"# {OPEN}"), "one first-level heading"),
    "extra not named": (
        lambda nb: first(nb, is_code).update(source="box = rb.box('viaduct36_identified')"),
        "an extra says so below its title",
    ),
    "no question": (
        lambda nb: nb.cells[0].update(source=nb.cells[0].source.replace("?", ".")),
        "the question",
    ),
    "no section": (replace(f"## {THEORY}", "## Thoughts"), f"section '## {THEORY}'"),
    "section order": (swap_sections, "sections stand in this order"),
    "no time": (replace("**Time:**", "Time:"), "'**Time:**'"),
    "raw reference": (replace(r"\tag{99.1}", r"\tag{99.1} \eqref{a}"), "JupyterLab shows"),
    "too many words": (
        lambda nb: nb.cells[0].update(source=nb.cells[0].source + " word" * 1500),
        "words of text",
    ),
    "no symbol table": (replace("| symbol |", "| sign |"), "a folded symbol table"),
    "open symbol table": (
        replace("<details><summary>The symbols", "<div><summary>The symbols"),
        "a folded symbol table",
    ),
    "no list of symbols": (replace("(../docs/symbols.md)", ""), "leads to the list of the suite"),
    "no sketch": (replace("rb.plots.diagram(", "print("), "a drawn sketch"),
    "sketch of letters": (
        lambda nb: nb.cells[0].update(source=nb.cells[0].source + "\n```\n +--+\n```\n"),
        "not made of letters",
    ),
    "nothing to see first": (
        lambda nb: first(nb, figures).update(outputs=[]),
        "a picture or a panel stands above",
    ),
    "nothing to guess": (
        lambda nb: first(nb, lambda c: ANSWER in tags(c)).update(source="x = ..."),
        "a guess to write down",
    ),
    "guess not checked": (
        replace('rb.check("99.guess"', 'rb.check("99.1"'),
        "the guess is checked",
    ),
    "talk of tests": (
        lambda nb: nb.cells[0].update(source=nb.cells[0].source + " Pinned by test_modes."),
        "no part of a lesson",
    ),
    "no cell to answer in": (
        replace("answer_99_2 = [..., ...]", "x = 2"),
        "with three dots to replace",
    ),
    "no check": (replace('rb.check("99.2"', 'rb.check("99.3"'), 'rb.check("99.2", ...)'),
    "solution without code": (
        replace("```python\nanswer_99_1", "```\nanswer_99_1"),
        "block of Python",
    ),
    "solution in the open": (
        replace("<details><summary>Solution", "Look:\n<details><summary>Solution"),
        "a text cell of its own",
    ),
    "assert in the exercises": (
        replace("answer_99_1 = ...", "assert True\nanswer_99_1 = ...", "code"),
        "gives the solution away",
    ),
    "no equation number": (
        lambda nb: [c.update(source=c.source.replace(r"\tag{", "(")) for c in nb.cells],
        "numbered",
    ),
    "box not asserted": (
        lambda nb: [c.update(source=c.source.replace("assert", "print")) for c in nb.cells],
        OPEN,
    ),
    "nothing checked": (
        lambda nb: [c.metadata.update(tags=[]) for c in nb.cells if "difference" in c.source],
        CHECK,
    ),
    "panel without figure": (panel_first, "a static figure stands before the panel"),
    "no exercise of a kind": (replace("(extend)", "(more)"), "(extend)"),
    "exercise number": (replace("Exercise 99.2", "Exercise 99.7"), "exercise 2 is called"),
    "no hint": (replace("<summary>Hint", "<summary>Idea"), "<summary>Hint"),
    "no empty line": (replace("</summary>\n\n", "</summary>\n"), "then an empty line"),
    "open fold": (replace("</details>", ""), "every <details> is closed"),
    "no text before code": (drop_text_before_code, "a text cell stands before it"),
    "long cell": (lambda nb: first(nb, is_code).update(source="x = 1\n" * 16), "16 lines"),
    "empty cell": (
        lambda nb: first(nb, is_code).update(source="\n"),
        "is empty",
    ),
    "hidden output": (
        lambda nb: first(nb, is_code).metadata.update(tags=["nbval-skip"]),
        "nbval-skip hides",
    ),
    "too much code": (lambda nb: nb.cells.extend(copy.deepcopy(nb.cells) * 3), "lines of code"),
    "second import": (replace("print(", "import os\nprint(", "code"), "one cell imports"),
    "own colours": (
        replace(f"{COLOURS}  # colours of the suite", "", "code"),
        "sets the colours of the suite",
    ),
    "long line": (stream("x" * 101 + "\n"), "prints 101 letters"),
    "no caption": (drop_caption, "the text cell after a figure"),
    "short caption": (short_caption, "at least 12 words"),
    "two figures": (
        lambda nb: (c := first(nb, figures)).update(outputs=c.outputs * 2),
        "one figure a cell",
    ),
    "not executed": (
        lambda nb: first(nb, is_code).update(execution_count=None),
        "all cells executed",
    ),
    "widget state": (lambda nb: nb.metadata.update(widgets={}), "no stored widget state"),
    "widget view": (
        output(output_type="display_data", data={WIDGET + "view+json": {}}),
        "no stored widget view",
    ),
    "unmarked print": (stream("hello\n"), "prints: tag it"),
    "silent mark": (lambda nb: first(nb, prints).update(outputs=[]), "marked but prints nothing"),
    "double mark": (
        lambda nb: first(nb, prints).metadata.update(tags=[MARKED, EXEMPT + "because of this"]),
        "marked both",
    ),
    "error": (output(output_type="error", ename="E", evalue="", traceback=[]), "no stored error"),
    "warning": (stream("careful", "stderr"), "no stored warning"),
    "machine path": (stream("/home/someone/x.csv\n"), "no path of a machine"),
    "dead link": (replace("## References", "## References\n[a](no.md)"), "no such file"),
}


@pytest.mark.parametrize("name", BREAKING)
def test_a_broken_rule_is_noticed(name):
    notebook = nbformat.read(TEMPLATE, as_version=4)
    change, message = BREAKING[name]
    change(notebook)
    found = broken_rules(notebook, TEMPLATE)
    assert any(message in line for line in found), found


def test_next_leads_to_the_next_notebook_that_exists(tmp_path):
    for name in ("03_a.ipynb", "06_b.ipynb", "08_c.ipynb"):
        (tmp_path / name).touch()
    cell = nbformat.v4.new_markdown_cell("**Next:** [08 - Compare](08_c.ipynb)")
    notebook = nbformat.v4.new_notebook(cells=[cell])
    assert [*rules_of_the_links(notebook, "06", Page(), tmp_path / "06_b.ipynb")] == []
    assert [*rules_of_the_links(notebook, "08", Page(), tmp_path / "08_c.ipynb")] == []
    assert "06_b.ipynb" in [*rules_of_the_links(notebook, "03", Page(), tmp_path / "03_a.ipynb")][0]
