"""The teacher's page: its links, names, times and marking numbers are true, and every misconception
stands where it says."""

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

import nbformat
import numpy as np
import pytest

import railbridge as rb
from railbridge.commands import command as cli

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "teaching.md"
TEXT = PAGE.read_text(encoding="utf-8")
NOTEBOOKS = {
    path.name[:2]: path for path in sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))
}


def words_of(number):
    """The text cells of a notebook, as one text."""
    cells = nbformat.read(NOTEBOOKS[number], as_version=4).cells
    return "\n".join(cell.source for cell in cells if cell.cell_type == "markdown")


def shown_by(number):
    """What the code cells of a notebook have printed, as one text."""
    cells = nbformat.read(NOTEBOOKS[number], as_version=4).cells
    return "\n".join(out.get("text", "") for cell in cells for out in cell.get("outputs", []))


def flat(text):
    """Without line breaks, formula marks and quotes, in lower case: what a reader compares."""
    return (
        re.sub(
            r"[\s*\"]+",
            " ",
            re.sub(r"\$([^$]*)\$", lambda m: re.sub(r"[ _\\,]", "", m.group(1)), text),
        )
        .lower()
        .strip()
    )


def section(title):
    return re.search(
        rf"^#+ {re.escape(title)}\n(.*?)(?=^#|\Z)", TEXT, re.MULTILINE | re.DOTALL
    ).group(1)


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
            assert part in map(anchor, re.findall(r"^#+ (.*)$", headings[path], re.MULTILINE)), (
                target
            )


def test_minutes_are_those_the_notebooks_give():
    table = rows("Minutes a notebook")
    assert [row[0][1:3] for row in table] == [*NOTEBOOKS]
    for notebook, reading, exercises in table:
        said = re.search(r"\*\*Time:\*\*\s+(\d+)\s+minutes", words_of(notebook[1:3])).group(1)
        assert reading == said, notebook
        assert int(exercises) >= int(reading)


@pytest.mark.parametrize(
    ("title", "minutes"), [("A lab of 2 hours", 120), ("A unit of 6 hours", 360)]
)
def test_a_path_takes_the_time_it_promises(title, minutes):
    assert sum(int(row[0]) for row in rows(title)) == minutes


def test_the_lab_leaves_a_quarter_free():
    """What is planned fits into 90 minutes; the rest is one line that says so."""
    *planned, free = rows("A lab of 2 hours")
    assert sum(int(row[0]) for row in planned) == 90
    assert free[0] == "30" and free[1].startswith("**free**") and free[2]
    assert not [row for row in planned if "free" in row[1]]
    assert "90 of 120 minutes are planned" in " ".join(section("A lab of 2 hours").split())


def test_minutes_of_the_lab_can_be_done():
    """No part of a page gets more than the whole page needs, nor less than an eighth of it."""
    whole = {row[0][1:3]: int(row[1]) for row in rows("Minutes a notebook")}
    for minutes, students, *_ in rows("A lab of 2 hours"):
        for number in re.findall(r"\[(0\d)\]\(", students):
            assert whole[number] / 8 <= int(minutes) <= whole[number], number


def test_exercises_figures_equations_and_sections_that_are_named_exist():
    for number in set(re.findall(r"Exercises? (\d+)\.\d", TEXT)):
        text = words_of(number.zfill(2))
        known = re.findall(rf"^### Exercise ({number}\.\d)", text, re.MULTILINE)
        named = re.findall(rf"(?:Exercises? |and |, )({number}\.\d)(?![\d.])", TEXT)
        assert named and set(named) <= set(known)
    for figure in re.findall(r"Figure (\d+\.\d)", TEXT):
        assert f"**Figure {figure}.**" in words_of(figure[:-2].zfill(2))
    for equation in re.findall(r"\((\d\.\d)\)", TEXT):
        assert rf"\tag{{{equation}}}" in words_of(f"0{equation[0]}")
    for number, title in re.findall(r"\b([01]\d), \"([^\"]+)\"", TEXT):
        found = [flat(h) for h in re.findall(r"^#+ (.*)$", words_of(number), re.MULTILINE)]
        assert flat(title) in found, (number, title)


def test_exercises_of_other_notebooks_are_not_missed():
    """The pattern above follows lists such as '1.3' after a full stop too: all that look like an
    exercise of a session."""
    named = r"(?:Homework: |Exercises? |Exercises? \d+\.\d and )(\d+\.\d)(\D)"
    for number, _ in re.findall(named, TEXT):
        assert f"### Exercise {number} (" in words_of(number[:-2].zfill(2)), number


def test_every_misconception_stands_in_its_notebook_where_the_table_says():
    table = rows("Misconceptions")
    numbers = [row[1] for row in table]
    lessons = [*(f"0{i}" for i in range(1, 8)), "10", "11", "13"]
    assert {n: numbers.count(n) for n in numbers} == dict.fromkeys(lessons, 3)
    for said, number, where in table:
        text = words_of(number)
        main, _, rest = where.partition(": ")
        title = rest.split("; ")[0]
        part = re.search(
            rf"^## {re.escape(main)}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL
        ).group(1)
        below = re.search(
            rf"^### {re.escape(title)}\n(.*?)(?=^### |\Z)",
            part.replace("$l$", "l"),
            re.MULTILINE | re.DOTALL,
        )
        assert below, (number, title)
        key = flat(said)
        assert key in flat(title + "\n" + below.group(1)) or not said.startswith('"'), said
        assert len(below.group(1).split()) > 20, f"{title}: confronted, not only named"


def test_every_objective_is_seen_in_something_that_exists():
    objectives = rows("Objectives and marking")
    assert [row[0] for row in objectives] == [f"O{i}" for i in range(1, len(objectives) + 1)]
    marks = {row[0].split()[0] for row in rows("Numbers for marking")}
    used = {mark for row in objectives for mark in re.findall(r"\bM\d\b", row[2])}
    assert used == marks
    assert all(row[3] and row[4] for row in objectives)


@dataclass(frozen=True)
class Version:
    """What the questions of one version of the marking table are about; SI."""

    soft: float  # share of the secondary stiffness that is left
    wave: float
    span: tuple  # length, first frequency in Hz
    car_on: float  # span under one car
    spacing: float
    light: float  # share of the deck's mass, and the word for it
    share: str
    changes: tuple


VERSIONS = {
    "A": Version(0.8, 18.0, (20.0, 6.0), 25.0, 18.0, 1 / 2, "half", (5e-2, 5e-3)),
    "B": Version(0.7, 16.0, (25.0, 5.0), 30.0, 25.0, 1 / 3, "a third", (4e-2, 8e-3)),
}


def asked(v):
    """What the question of each number must contain."""
    return {
        "M1": f"{100 * (1 - v.soft):.0f} %",
        "M2": f"{v.wave:g} m",
        "M3": f"{v.wave:g} m",
        "M4": f"{v.span[0]:g} m",
        "M5": f"{v.car_on:g} m",
        "M6": f"{v.spacing:g} m",
        "M7": f"{v.share} ",
        "M8": "{:.0e} and {:.0e}".format(*v.changes).replace("e-0", "e-"),
    }


def answers(v):
    """What the marking table must say, computed here."""
    table1 = rb.car_parameters("xia2000")
    softer = table1 | {
        "secondary_vertical_stiffness": v.soft * table1["secondary_vertical_stiffness"]
    }
    series = 1 / (1 / (4 * v.soft * 1060e3) + 1 / (8 * 2976e3))
    modes = rb.two_bogie_car("softer", **softer).modes()
    # By name: softer, bounce changes places with yaw.
    by_hand, exact = (
        np.sqrt(series / 50990) / (2 * np.pi),
        modes.frequencies_hz[modes.names.index("car z")],
    )
    car, waves = rb.vehicle("xia2000"), rb.Track(vertical=rb.Harmonic(5e-3, v.wave))
    delayed, in_phase = (
        abs(rb.steady_forces(car, waves, 20.0, how)[:, 1].sum()) / 1e3 for how in ("wheels", "car")
    )
    share = np.cos(2 * np.pi * 7.8 / v.wave) * np.cos(2 * np.pi * 1.25 / v.wave)
    assert np.isclose(delayed / in_phase, abs(share))
    length, first = v.span
    quotient, sag = (
        (2 * length**2 * first / np.pi) ** 2,
        1e3 * 5 * np.pi**2 * 9.81 / (1536 * first**2),
    )
    middle = v.car_on / 2
    beam = rb.Beam("span", (v.car_on,), 9e3, 2e10).deck(modes=3)
    x = middle + np.array([-9.05, -6.55, 6.55, 9.05])
    cost = []
    for quantity in ("displacement_z", "moment_vertical"):
        line = beam.recovery.section(quantity, middle)
        cost.append(line.influence([middle])[0, 0, 1] / line.influence(x)[:, 0, 1].mean())
    planar, deck = rb.vehicle("xia2000_planar"), rb.deck("viaduct36")
    phi = deck.shapes(18.0 + np.array([c.x for c in planar.contacts]))[:, :, 1]
    bare, at = 2j * np.pi * 13.23, 2 * np.pi * deck.frequencies_hz
    answer = phi / (at**2 + 2 * deck.damping_ratios * at * bare + bare**2)
    full = np.linalg.norm(planar.transfer(13.23)[:, 1, :, 1] @ answer @ phi.T, 2)
    gain = full / v.light
    promise = (
        "below one: each pass shrinks the change"
        if gain < 1
        else "above one: nothing, the change may grow or not"
    )
    changes = v.changes[0] * (v.changes[1] / v.changes[0]) ** np.arange(20)
    passes = next(i + 1 for i in range(1, 20) if max(changes[i - 1 : i + 1]) < 1e-8)
    return {
        "M1": f"{by_hand:.3f} Hz by hand, {exact:.4f} Hz exactly",
        "M2": f"{1.3345 * v.wave:.2f} m/s, {3.6 * 1.3345 * v.wave:.1f} km/h",
        "M3": f"{share:.3f}; {delayed:.1f} kN and {in_phase:.1f} kN",
        "M4": f"{quotient / 1e6:.3f}e6 m4/s2, {sag:.2f} mm",
        "M5": "{:.2f} and {:.2f}".format(*cost),
        "M6": f"{3.6 * 3.307 * v.spacing:.1f} km/h and {3.6 * 3.307 * v.spacing / 2:.1f} km/h",
        "M7": f"{gain:.2f} instead of {full:.2f}, {promise}",
        "M8": f"{passes}; later passes carry what is left through the train, with another ratio",
    }


@pytest.mark.parametrize("version", VERSIONS)
def test_marking_numbers_are_computed(version):
    v = VERSIONS[version]
    table = {
        row[0].split()[0]: row
        for row in rows("Numbers for marking")
        if row[0].split()[1] == version
    }
    assert {name: row[3] for name, row in table.items()} == answers(v)
    for name, part in asked(v).items():
        assert part in table[name][2], name


def test_neighbours_have_other_numbers():
    first, second = (answers(v) for v in VERSIONS.values())
    assert all(first[name] != second[name] for name in first)


def test_answers_of_the_guess_sheet_stand_in_the_notebooks():
    table = rows("The guess sheet")
    assert [row[0] for row in table] == [f"G{i}" for i in range(1, len(table) + 1)]
    for name, where, _, answer in table:
        told = words_of(where[:2]) + shown_by(where[:2])
        for number in re.findall(r"\d+(?:\.\d+)?", answer.removeprefix("nearest 10")):
            assert re.search(rf"(?<![\d.]){re.escape(number)}(?!\d)", told), (name, number)


def test_every_guess_is_asked_in_a_path():
    guesses = {row[0] for row in rows("The guess sheet")}
    unit, more, lab = (
        set(re.findall(r"G\d+", section(path)))
        for path in ("A unit of 6 hours", "An hour more", "A lab of 2 hours")
    )
    assert unit | more == guesses and not unit & more
    assert lab < unit
    assert "five guesses" in section("What is handed in, and marks") and len(lab) == 5


def test_every_objective_is_met_in_the_unit_and_marks_add_up():
    objectives = [row[0] for row in rows("Objectives and marking")]
    met = re.findall(r"\bO\d+\b", " ".join(row[3] for row in rows("A unit of 6 hours")))
    assert met == objectives
    marks = [(row[0], int(row[2])) for row in rows("What is handed in, and marks")]
    assert dict(marks)["unit"] == 2 * len(objectives)
    assert sum(m for path, m in marks if path == "lab") == 2 + 2 * len(
        set(re.findall(r"M\d", section("A lab of 2 hours")))
    )


def test_commands_of_the_page_are_known(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    shown = [
        line
        for block in re.findall(r"```\n(.*?)```", TEXT, re.DOTALL)
        for line in block.splitlines()
    ]
    assert shown == [
        "railbridge copy-notebooks course --student",
        "railbridge copy-notebooks mine --teacher",
        "railbridge mark submissions --out marks.csv",
    ]
    for line in shown[:2]:
        assert cli.main(shlex.split(line)[1:]) == 0
        assert Path(line.split()[2], "03_rigid_deck_forces.ipynb").is_file()
    assert "open them with: python -m jupyterlab course" in capsys.readouterr().out
    assert "`python -m jupyterlab course`" in TEXT
    assert Path("mine/sheets/guess_sheet.html").is_file() and not Path("course/sheets").exists()
    Path("course/03_rigid_deck_forces.ipynb").write_text("edited")
    assert cli.main(shlex.split("copy-notebooks course --student --force")) == 0
    assert Path("course/03_rigid_deck_forces.edited-1.ipynb").read_text() == "edited"
