"""The teacher's page: its links, names, times and marking numbers are true, and every misconception stands where it says."""

import re
import shlex
from pathlib import Path

import nbformat
import numpy as np
import pytest

import railbridge as rb
from railbridge import cli
from railbridge.fleet import CAR_PARAMETERS, two_bogie_car
from railbridge.inputs import data_file, read_parameters

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "teaching.md"
TEXT = PAGE.read_text(encoding="utf-8")
NOTEBOOKS = {path.name[:2]: path for path in sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))}


def words_of(number):
    """The text cells of a notebook, as one text."""
    cells = nbformat.read(NOTEBOOKS[number], as_version=4).cells
    return "\n".join(cell.source for cell in cells if cell.cell_type == "markdown")


def flat(text):
    """Without line breaks, formula marks and quotes, in lower case: what a reader compares."""
    return re.sub(r"[\s*\"]+", " ", re.sub(r"\$([^$]*)\$", lambda m: re.sub(r"[ _\\,]", "", m.group(1)), text)).lower().strip()


def section(title):
    return re.search(rf"^#+ {re.escape(title)}\n(.*?)(?=^#|\Z)", TEXT, re.MULTILINE | re.DOTALL).group(1)


def rows(title):
    """The rows of the first table of a section, without its header."""
    lines = [line for line in section(title).splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def anchor(heading):
    return re.sub(r"[^\w -]", "", heading).strip().lower().replace(" ", "-")


def test_every_link_leads_somewhere():
    headings = {PAGE: TEXT, ROOT / "README.md": (ROOT / "README.md").read_text(encoding="utf-8")}
    for target in re.findall(r"\]\((?!\w+:)([^()\s]+)\)", TEXT):
        name, _, part = target.partition("#")
        path = (PAGE.parent / name).resolve() if name else PAGE
        assert path.is_file(), target
        if part:
            assert part in map(anchor, re.findall(r"^#+ (.*)$", headings[path], re.MULTILINE)), target


def test_minutes_are_those_the_notebooks_give():
    table = rows("Minutes a notebook")
    assert {row[0][1:3] for row in table} >= {"00", "01", "02", "03", "04", "05", "06", "08", "09"}
    for notebook, reading, exercises in table:
        said = re.search(r"\*\*Time:\*\*\s+(\d+)\s+minutes", words_of(notebook[1:3])).group(1)
        assert reading == said, notebook
        assert int(exercises) >= int(reading)


@pytest.mark.parametrize(("title", "minutes"), [("A lab of 2 hours", 120), ("A unit of 6 hours", 360)])
def test_a_path_takes_the_time_it_promises(title, minutes):
    assert sum(int(row[0]) for row in rows(title)) == minutes


def test_exercises_figures_equations_and_sections_that_are_named_exist():
    for number in set(re.findall(r"Exercises? (\d)\.\d", TEXT)):
        known = re.findall(rf"^### Exercise ({number}\.\d)", words_of(f"0{number}"), re.MULTILINE)
        named = re.findall(rf"(?:Exercises? |and |, )({number}\.\d)(?![\d.])", TEXT)
        assert named and set(named) <= set(known)
    for figure in re.findall(r"Figure (\d\.\d)", TEXT):
        assert f"**Figure {figure}.**" in words_of(f"0{figure[0]}")
    for equation in re.findall(r"\((\d\.\d)\)", TEXT):
        assert rf"\tag{{{equation}}}" in words_of(f"0{equation[0]}")
    for number, title in re.findall(r"\b(0\d), \"([^\"]+)\"", TEXT):
        found = [flat(h) for h in re.findall(r"^#+ (.*)$", words_of(number), re.MULTILINE)]
        assert flat(title) in found, (number, title)


def test_exercises_of_other_notebooks_are_not_missed():
    """The pattern above follows lists such as '1.3' after a full stop too: all that look like an exercise of a session."""
    for number, _ in re.findall(r"(?:Homework: |Exercises? |and )(\d\.\d)(\D)", TEXT):
        assert f"### Exercise {number} (" in words_of(f"0{number[0]}"), number


def test_every_misconception_stands_in_its_notebook_where_the_table_says():
    table = rows("Misconceptions")
    numbers = [row[1] for row in table]
    assert {n: numbers.count(n) for n in numbers} == {f"0{i}": 3 for i in range(1, 7)}
    for said, number, where in table:
        text = words_of(number)
        main, _, rest = where.partition(": ")
        title = rest.split("; ")[0]
        part = re.search(rf"^## {re.escape(main)}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL).group(1)
        below = re.search(rf"^### {re.escape(title)}\n(.*?)(?=^### |\Z)", part.replace("$l$", "l"), re.MULTILINE | re.DOTALL)
        assert below, (number, title)
        key = flat(said)
        assert key in flat(title + "\n" + below.group(1)) or not said.startswith('"'), said
        assert len(below.group(1).split()) > 20, f"{title}: confronted, not only named"


def test_every_objective_is_seen_in_something_that_exists():
    objectives = rows("Objectives and marking")
    assert [row[0] for row in objectives] == [f"O{i}" for i in range(1, len(objectives) + 1)]
    marks = {row[0] for row in rows("Numbers for marking")}
    used = {mark for row in objectives for mark in re.findall(r"\bM\d\b", row[2])}
    assert used == marks
    assert all(row[3] and row[4] for row in objectives)


def answers():
    """What the marking table must say, computed here."""
    table1 = read_parameters(data_file("vehicles", "xia2000"), CAR_PARAMETERS)
    softer = table1 | {"secondary_vertical_stiffness": 0.8 * table1["secondary_vertical_stiffness"]}
    series = 1 / (1 / (4 * 0.8 * 1060e3) + 1 / (8 * 2976e3))
    by_hand, exact = np.sqrt(series / 50990) / (2 * np.pi), two_bogie_car("softer", **softer).modes().frequencies_hz[3]
    car, waves = rb.vehicle("xia2000"), rb.Track(vertical=rb.Harmonic(5e-3, 18.0))
    delayed, in_phase = (abs(rb.steady_forces(car, waves, 20.0, how)[1::2].sum()) / 1e3 for how in ("wheels", "car"))
    share = np.cos(2 * np.pi * 7.8 / 18) * np.cos(2 * np.pi * 1.25 / 18)
    assert np.isclose(delayed / in_phase, abs(share))
    quotient, sag = (2 * 20.0**2 * 6.0 / np.pi) ** 2, 1e3 * 5 * np.pi**2 * 9.81 / (1536 * 6.0**2)
    beam = rb.Beam("span", (25.0,), 9e3, 2e10).deck(modes=3)
    x = 12.5 + np.array([-9.05, -6.55, 6.55, 9.05])
    cost = []
    for quantity in ("displacement_z", "moment_vertical"):
        line = beam.recovery.section(quantity, 12.5)
        cost.append(line.influence([12.5])[0, 0, 1] / line.influence(x)[:, 0, 1].mean())
    omega = 2 * np.pi * 3.307
    force = abs(rb.steady_forces(car, rb.Track(vertical=rb.Harmonic(1.0, 20.0 / 3.307)), 20.0, "car")[1::2].sum())
    gain = [force * 2 / (mass * 36.0) / (0.06 * omega**2) for mass in (6e3, 12e3)]
    changes = 5e-2 * 0.1 ** np.arange(20)
    passes = next(i + 1 for i in range(1, 20) if max(changes[i - 1 : i + 1]) < 1e-8)
    return {
        "M1": f"{by_hand:.3f} Hz by hand, {exact:.4f} Hz exactly",
        "M2": f"{1.3345 * 18:.2f} m/s, {3.6 * 1.3345 * 18:.1f} km/h",
        "M3": f"{share:.3f}; {delayed:.1f} kN and {in_phase:.1f} kN",
        "M4": f"{quotient / 1e6:.3f}e6 m4/s2, {sag:.2f} mm",
        "M5": "{:.2f} and {:.2f}".format(*cost),
        "M6": f"{3.6 * 3.307 * 18:.1f} km/h and {3.6 * 3.307 * 9:.1f} km/h",
        "M7": f"{gain[0]:.2f} instead of {gain[1]:.2f}; it may grow before it falls",
        "M8": f"{passes}; later passes carry what is left through the train, with another ratio",
    }


def test_marking_numbers_are_computed():
    assert {row[0]: row[3] for row in rows("Numbers for marking")} == answers()


def test_commands_of_the_page_are_known(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    shown = [line for block in re.findall(r"```\n(.*?)```", TEXT, re.DOTALL) for line in block.splitlines()]
    assert shown[0] == "railbridge copy-notebooks course"
    assert cli.main(shlex.split(shown[0])[1:]) == 0
    assert Path("course/03_rigid_deck_forces.ipynb").is_file()
    assert "open them with: python -m jupyterlab course" in capsys.readouterr().out and "python -m jupyterlab course" in shown
    assert "python -m pytest --nbval-lax 03_rigid_deck_forces.ipynb" in shown
    Path("course/03_rigid_deck_forces.ipynb").write_text("edited")
    assert cli.main(shlex.split("copy-notebooks course --force")) == 0
    assert Path("course/03_rigid_deck_forces.edited-1.ipynb").read_text() == "edited"
