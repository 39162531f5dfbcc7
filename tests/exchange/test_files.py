"""Files of modal models: read, refused and given back."""

import dataclasses
import json
import shutil
import tomllib
import warnings
from dataclasses import replace

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from modal_files import EXAMPLE, cells, change, crossing, differ, read
from opensees import example_tables, viaduct36_in_mm

import railbridge as rb
from railbridge import exchange
from railbridge.cases import pages
from railbridge.commands import command as cli


@pytest.fixture
def folder(tmp_path):
    """A copy of the example that a test may spoil."""
    return shutil.copytree(EXAMPLE, tmp_path / "model")


# ---- round trip


def beams():
    plain = rb.deck("viaduct36")
    beam = plain.recovery.beam
    soft = dataclasses.replace(beam, shear_stiffness_vertical=3e9, shear_stiffness_lateral=3e9)
    spans = rb.deck_from_table("two", TWO_SPANS)
    raised = dataclasses.replace(plain, track_height=1.3)
    tracks = {"tracks": plain.tracks, "width": plain.width}
    return {
        "plain": plain,
        "soft in shear": soft.deck(12, 0.02, **tracks),
        "two spans": spans,
        "track above the axis": raised,
    }


TWO_SPANS = {
    "spans": [20.0, 16.0],
    "mass": 12000.0,
    "bending_stiffness_vertical": 3e10,
    "bending_stiffness_lateral": 3e11,
    "torsional_stiffness": 8e10,
    "polar_inertia": 7e4,
    "damping": {"modal": 0.02},
    "modes": 12,
    "tracks": {"left": 2.0},
}


@pytest.mark.parametrize("units", [("m", "kg"), ("mm", "t")])
@pytest.mark.parametrize("name", ["plain", "soft in shear", "two spans", "track above the axis"])
def test_a_deck_that_is_written_and_read_back_answers_alike(name, units, tmp_path):
    deck = beams()[name]
    back = rb.deck(exchange.export_modes(deck, tmp_path / "out", units))
    assert (
        back.mode_names == deck.mode_names
        and back.tracks == deck.tracks
        and back.supports == deck.supports
    )
    assert back.recovery.lacks and back.track_height == deck.track_height
    ours, theirs = crossing(deck), crossing(back)
    for kind, options in (
        ("displacement", {"kept_only": True}),
        ("velocity", {}),
        ("acceleration", {}),
    ):
        for component, values in getattr(ours, kind)(13.3, **options).values.items():
            other = getattr(theirs, kind)(13.3)[component]
            assert np.max(np.abs(other - values)) < 1e-9 * np.max(np.abs(values)), (kind, component)
    dynamic = ours.wheel_forces - ours.wheel_forces.mean(axis=2, keepdims=True)
    assert np.max(np.abs(theirs.wheel_forces - ours.wheel_forces)) < 1e-9 * np.max(np.abs(dynamic))


@pytest.mark.parametrize(("units", "per_metre"), [(("m", "kg"), 1.0), (("mm", "t"), 1e3)])
def test_written_rotations_are_those_of_the_right_hand(units, per_metre, tmp_path):
    """About z the slope of uy, about y minus the slope of uz, and the twist as it is.

    Our own reader does not ask for them; other programs do.
    """
    deck = rb.deck("viaduct36")
    exchange.export_modes(deck, tmp_path, units)
    rows = np.genfromtxt(
        tmp_path / "modes.csv",
        delimiter=",",
        names=True,
        dtype=None,
        encoding="utf-8",
        skip_header=1,
    )
    nodes = np.genfromtxt(tmp_path / "nodes.csv", delimiter=",", names=True, skip_header=2)
    x = nodes["x"] / per_metre
    assert x[[0, -1]] == pytest.approx([0.0, 36.0])
    for c, slopes, sign in (("uy", "rz", 1.0), ("uz", "ry", -1.0)):
        for mode in np.unique(rows["mode"]):
            own = rows[rows["mode"] == mode]
            slope = np.gradient(own[c] / per_metre, x)[2:-2]
            if np.abs(own[c]).max() > 1e-3 * np.abs(rows[c]).max():
                error = np.abs(sign * own[slopes][2:-2] - slope).max()
                assert error < 0.05 * np.abs(slope).max(), (slopes, mode)
    # Of a mode that twists only: as the deck's own shape, in rad over the root of the unit of mass.
    mode = deck.mode_names.index("torsion 1")
    twist = deck.shapes(x)[:, mode, 2] * np.sqrt(1e3 if units[1] == "t" else 1.0) / per_metre
    assert rows["rx"][rows["mode"] == mode + 1] == pytest.approx(twist, abs=1e-12)


def test_written_tables_stand_without_the_deck_file(tmp_path):
    deck = rb.deck("viaduct36")
    exchange.export_modes(deck, tmp_path)
    model = exchange.read_modes(tmp_path / "nodes.csv", tmp_path / "modes.csv")
    assert model.to_frame().shape == (20, 2)
    assert differ(exchange.deck_from_modes(model, model.nodes.line()), deck).max() < 1e-12
    # Other readers do not know the rule of thirds: rotations give cubics, twist is a parabola over
    # three nodes.
    change(tmp_path / "nodes.csv", lambda lines: [line for line in lines if "pieces" not in line])
    model = exchange.read_modes(tmp_path / "nodes.csv", tmp_path / "modes.csv")
    bending, twist = differ(exchange.deck_from_modes(model, model.nodes.line()), deck)[[1, 2]]
    assert bending < 1e-12 and twist < 1e-2


NAMES = [
    "bending, first", "two\nlines", "two\r\nlines", "return\ronly", 'said "one"', "#1", "a;b",
    "\U0001f600", "\x1b[31mred\x7f", "a\u2028b", "-" * 300, "back\\slash",
]  # fmt: skip


def test_whatever_modes_and_tracks_are_called_is_read_back(tmp_path):
    deck = replace(rb.deck("viaduct36"), mode_names=tuple(NAMES) + ("plain",) * 8)
    deck = replace(deck, name="\udcff\n", tracks=dict.fromkeys(NAMES, 0.5))
    back = rb.deck(exchange.export_modes(deck, tmp_path / "out"))
    assert back.mode_names == deck.mode_names and back.tracks == deck.tracks


# ---- somebody else's model


def test_the_example_is_what_the_other_program_computes():
    tables = example_tables()
    for name, (header, rows) in tables.items():
        lines = (EXAMPLE / name).read_text(encoding="utf-8").splitlines()
        assert lines[:2] == ["# units: mm, t", header]
        stored, fresh = np.loadtxt(lines[2:], delimiter=","), np.array(rows)
        # Entries that round-off alone makes differ from zero say nothing.
        size = np.abs(fresh).max(axis=0)
        assert np.all(np.abs(stored - fresh) < 1e-6 * size + 1e-12), name


def test_the_example_is_the_shipped_deck():
    deck = rb.deck(EXAMPLE / "deck.toml")
    ours = rb.case("paper").replace({"deck": {"file": "viaduct36", "modes": 10}}).deck
    assert deck.mode_names == (
        "vertical 1", "lateral 1", "vertical 2", "torsion 1", "vertical 3", "torsion 2",
        "lateral 2", "torsion 3", "vertical 4", "torsion 4",
    )  # fmt: skip
    # Nodal masses make torsion of the other program's elements a little soft:
    # pi^2 n^2 / (24 * 24^2), 1.1 % at n = 4.
    assert deck.frequencies_hz == pytest.approx(ours.frequencies_hz, rel=1.2e-2)
    assert deck.frequencies_hz[:4] == pytest.approx(ours.frequencies_hz[:4], rel=1e-3)
    there, here = crossing(deck), crossing(ours)
    for name, limit in (("displacement_z", 1e-3), ("displacement_y", 5e-3), ("rotation_x", 5e-3)):
        a, b = (
            there.displacement(18.0, kept_only=True)[name],
            here.displacement(18.0, kept_only=True)[name],
        )
        assert np.max(np.abs(a)) == pytest.approx(np.max(np.abs(b)), rel=limit)
    for name, limit in (("rotation_y", 3e-3), ("rotation_z", 1e-2)):
        a, b = (run.rotations(6.0, kept_only=True)[name] for run in (there, here))
        assert np.abs(b).max() > 0.0 and np.abs(a - b).max() < limit * np.abs(b).max()


def test_units_and_axes_of_the_model_do_not_matter(folder):
    want = exchange.deck_from_modes(read(EXAMPLE), read(EXAMPLE).nodes.line({"y": 0.0, "z": 0.0}))

    def inches(lines):
        rows = [line.split(",") for line in lines[2:]]
        turned = [[r[0], *(repr(float(v) / 25.4) for v in (r[1], r[3], "-" + r[2]))] for r in rows]
        return ["# units: in, lb", lines[1], *map(",".join, turned)]

    def pounds(lines):
        # y up: the model's y is our z, its z our -y. Shapes are scaled to a modal mass of 7 lb.
        scale, result = (
            (0.45359237 / 1e3 * 7.0) ** 0.5,
            ["# units: in, lb", lines[1] + ",modal_mass"],
        )
        for line in lines[2:]:
            row = line.split(",")
            v = [float(c) for c in row[4:]]
            v = [v[0], v[2], -v[1], *(25.4 * r for r in (v[3], v[5], -v[4]))]
            result.append(",".join([*row[:4], *(repr(scale * c) for c in v), "7.0"]))
        return result

    change(folder / "nodes.csv", inches)
    change(folder / "modes.csv", pounds)
    model = read(folder, masses=False, axes=["x", "-z", "y"])
    deck = exchange.deck_from_modes(model, model.nodes.line({"y": 0.0, "z": 0.0}))
    assert differ(deck, want).max() < 1e-12
    assert deck.frequencies_hz == pytest.approx(want.frequencies_hz)


# ---- deck files and cases


def test_a_case_takes_a_modal_deck_by_file_and_in_place(folder):
    case = rb.case("paper")
    by_file = case.replace({"deck": {"file": str(folder / "deck.toml")}})
    tables = {
        "modes": {k: str(folder / f"{k}.csv") for k in ("nodes", "modes")}
        | {"rail": {"y": 0.0, "z": 0.0}}
    }
    in_place = case.replace(
        {"deck": {**tables, "tracks": {"left": 2.4}, "damping": {"modal": 0.02}}}
    )
    assert by_file.deck.frequencies_hz.tolist() == in_place.deck.frequencies_hz.tolist()
    assert set(in_place.deck.damping_ratios) == {0.02}
    assert len(by_file.replace({"deck.modes": 4}).deck.frequencies_hz) == 4
    change(
        folder / "modes.csv", lambda lines: [line.replace("3.30737617", "3.4") for line in lines]
    )
    assert by_file.replace({"run.speed": 21.0}).deck is by_file.deck, (
        "a change that does not name the deck keeps it"
    )
    assert rb.Case(by_file.content).deck.frequencies_hz[0] == 3.4, (
        "a case made anew reads a changed file again"
    )


def test_paths_in_a_case_file_are_relative_to_it(folder, tmp_path, monkeypatch):
    text = (
        "[deck]\ntracks = { left = 2.4 }\n"
        '[deck.modes]\nnodes = "model/nodes.csv"\nmodes = "model/modes.csv"\n'
        'rail = { y = 0.0, z = 0.0 }\n[train]\nvehicle = "xia2000"\n[run]\nspeed = 20.0\n'
    )
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    monkeypatch.chdir(folder.parent.parent)
    assert len(rb.case(tmp_path / "case.toml").deck.frequencies_hz) == 10


# ---- bad input


def other_line(number, edit):
    return lambda lines: [
        edit(line) if i == number else line for i, line in enumerate(lines, start=1)
    ]


def mode(number, edit):
    return lambda lines: [edit(line) if line.startswith(f"{number},") else line for line in lines]


def scaled(column, factor):
    return lambda lines: [
        line if i < 2 else cells(line, column, repr(float(line.split(",")[column]) * factor))
        for i, line in enumerate(lines)
    ]


def shapes_scaled(factor):
    def edit(lines):
        for column in range(4, 10):
            lines = scaled(column, factor)(lines)
        return lines

    return edit


def mixed(lines):
    """Mode 3 takes half of mode 1 along."""
    first = {line.split(",")[3]: line.split(",") for line in lines if line.startswith("1,")}

    def mix(line):
        row = line.split(",")
        other = first[row[3]]
        return ",".join(
            [
                *row[:4],
                *(repr(float(a) + 0.5 * float(b)) for a, b in zip(row[4:], other[4:], strict=True)),
            ]
        )

    return mode(3, mix)(lines)


def doubled(lines):
    return [*lines, *(cells(line, 0, "11") for line in lines if line.startswith("5,"))]


def cell(number, column, value):
    """Change one cell of a line."""
    return other_line(number, lambda line: cells(line, column, value))


def replaced(old, new):
    return lambda lines: [line.replace(old, new) for line in lines]


def without_node_9(lines):
    return [line for line in lines if line.split(",")[3:4] != ["9"]]


BAD = {
    "modes.csv": {
        "a row is missing": (
            lambda lines: lines[:80] + lines[81:],
            "modes.csv: mode 2: lacks 1 of the nodes that other modes",
        ),
        "a node that is not there": (
            cell(20, 3, "999"),
            "modes.csv: line 20: node = '999': is not",
        ),
        "a node twice in a mode": (
            lambda lines: [*lines, lines[-1]],
            "modes.csv: mode 10: node = '225': is given twice",
        ),
        "modes that overlap": (
            mixed,
            "modes.csv: modes 1 and 3: 0.45 of their mass products is shared",
        ),
        "a mode twice": (doubled, "modes 5 and 11"),
        "shapes of largest value 1": (
            shapes_scaled(10.0),
            "modes.csv: shapes: phi M phi is 100 for a mode, must be about 1: not mass-normalised, "
            "or masses in another unit",
        ),
        "a column is missing": (
            other_line(2, lambda x: x.replace("uz", "w")),
            "modes.csv: column w: unknown column",
        ),
        "no number": (cell(9, 6, "1;5"), "modes.csv: line 9: uz = '1;5'"),
        "two frequencies": (
            cell(9, 1, "3.4"),
            "modes.csv: mode 1: frequency_hz = [3.30737617, 3.4]",
        ),
        "a free body": (
            mode(1, lambda x: cells(x, 1, "0")),
            "modes.csv: mode 1: frequency_hz = 0.0: must be a finite number above 1e-06 Hz. A mode "
            "of 0 Hz is a free body: hold the deck by its bearings",
        ),
        "damping in per cent": (
            mode(1, lambda x: cells(x, 2, "3")),
            "mode 1: damping_ratio = 3.0: must be a finite number at least 0 and at most 0.5. Give",
        ),
        "a negative damping ratio": (
            mode(3, lambda x: cells(x, 2, "-0.1")),
            "mode 3: damping_ratio = -0.1: must be a finite number at least 0",
        ),
        "a node in no mode": (without_node_9, "masses.csv: mass: 4% of the mass stands"),
    },
    "nodes.csv": {
        "a node twice": (
            lambda lines: [*lines, "7,1,2,3"],
            "nodes.csv: node = '7': is given twice, in lines 9 and 78",
        ),
        "two nodes at one place": (cell(5, 1, "1500"), "two nodes stand at x = 1.5 m"),
        "kg instead of t": (
            other_line(1, lambda x: "# units: mm, kg"),
            "modes.csv: units = ['mm', 't']: the nodes are in mm, kg",
        ),
        "no units": (lambda lines: lines[1:], "nodes.csv: units: are stated nowhere"),
        "an unknown unit": (
            other_line(1, lambda x: "# units: yd, t"),
            "nodes.csv: units[1] = 'yd': must be one of m, mm",
        ),
        "not a number": (cell(9, 1, "nan"), "line 9: x = 'nan': must be a finite number"),
        "a cell too many": (
            other_line(9, lambda x: x + ",0"),
            "line 9 = '7,9000,0,0,0': must have 4 cells",
        ),
    },
    "masses.csv": {
        "a negative mass": (cell(9, 1, "-1"), "masses.csv: node 7: mass"),
        "a mass at no node": (
            cell(9, 0, "999"),
            "masses.csv: node = '999': is not among the nodes",
        ),
        "other units": (
            other_line(1, lambda x: "# units: mm, kg"),
            "masses.csv: units = ['mm', 'kg']: the nodes are in mm, t",
        ),
        "no rows": (
            lambda lines: lines[:2],
            "masses.csv: rows: there are none below the header",
        ),
    },
    "deck.toml": {
        "few rail nodes": (replaced("y = 0.0", "y = 1.0"), "modes.rail = {'y': 1.0"),
        "an unknown key": (
            lambda lines: [*lines, "rails = 1"],
            "modes.rails: unknown key. Did you mean 'rail'?",
        ),
        "a wrong path": (
            replaced('"modes.csv"', '"mode.csv"'),
            "modes.modes = 'mode.csv': no such file. A path in a deck file is relative to that",
        ),
    },
}


@pytest.mark.parametrize(("file", "name"), [(file, name) for file in BAD for name in BAD[file]])
def test_what_cannot_be_used_is_refused(file, name, folder):
    edit, message = BAD[file][name]
    change(folder / file, edit)
    with pytest.raises(rb.InputError) as error:
        rb.deck(folder / "deck.toml")
    assert message in str(error.value)


def units(text):
    return {
        name: other_line(1, lambda line: f"# units: {text}") for name in ("nodes.csv", "modes.csv")
    }


ODD = {
    "m instead of mm": (units("m, t"), "an order of magnitude away: bridges of 3.6e+04 m"),
    "squares of rad/s": ({"modes.csv": scaled(1, 130.0)}, "first frequency = 429.9"),
    "kg instead of t": (units("mm, kg"), "make the deck 12 kg per metre"),
    "shapes of largest value 1": (
        {"modes.csv": shapes_scaled(0.0147)},
        "need the column modal_mass",
    ),
}


@pytest.mark.parametrize("name", ODD)
def test_units_that_make_no_bridge_are_refused_without_masses_too(name, folder):
    edits, message = ODD[name]
    for file, edit in edits.items():
        change(folder / file, edit)
    change(
        folder / "deck.toml",
        lambda lines: [x for x in lines if not x.startswith(("masses", "supports"))],
    )
    with pytest.raises(rb.InputError) as error:
        rb.deck(folder / "deck.toml")
    assert message in str(error.value)
    change(folder / "deck.toml", lambda lines: [*lines, "unusual = true"])
    assert rb.deck(folder / "deck.toml").length > 0.0


def test_doubtful_models_are_warned_about(folder):
    change(folder / "modes.csv", scaled(1, 2 * np.pi))
    turned = rb.deck(folder / "deck.toml")
    with pytest.warns(
        rb.InputWarning,
        match=r"frequency of 20.8 Hz, bridges of 36 m have about 2.8 to 6.5 Hz",
    ):
        crossing(turned, interaction="rigid", iterations=None)
    change(folder / "modes.csv", scaled(1, 0.5 / np.pi))
    change(folder / "modes.csv", scaled(8, -1.0))
    with pytest.warns(UserWarning, match="-ry is not the slope of uz along the rail"):
        turned = rb.deck(folder / "deck.toml")
    assert any("-ry is not the slope of uz" in str(remark) for remark in turned.remarks)
    assert differ(turned, rb.deck(EXAMPLE / "deck.toml")).max() < 5e-3
    change(folder / "modes.csv", scaled(8, -1.0))
    change(folder / "modes.csv", mixed)
    change(folder / "deck.toml", lambda lines: [x for x in lines if not x.startswith("masses")])
    with pytest.warns(UserWarning, match="modes 1 and 3 overlap by 0.45 along the rail"):
        doubtful = rb.deck(folder / "deck.toml")
    run = crossing(doubtful, interaction="rigid", iterations=None)
    told = [str(remark) for remark in rb.remarks(run)]
    assert any("modes 1 and 3 overlap by 0.45" in text for text in told), "results say so, too"


def lateral_first(folder, factor):
    """Give the first lateral mode the lowest frequency, and multiply all."""
    kinds = [name.split()[0] for name in rb.deck(EXAMPLE / "deck.toml").mode_names]
    lateral = str(kinds.index("lateral") + 1)
    lines = (EXAMPLE / "modes.csv").read_text(encoding="utf-8").splitlines()
    for i, line in enumerate(lines[2:], start=2):
        row = line.split(",")
        f = 0.9 if row[0] == lateral else float(row[1])
        lines[i] = cells(line, 1, repr(f * factor))
    (folder / "modes.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def test_radians_are_noticed_where_the_lowest_mode_is_a_lateral_one(folder):
    """0.9 Hz in rad/s is 5.7, which would do for a deck of 36 m: the vertical one tells."""
    lateral_first(folder, 1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        crossing(rb.deck(folder / "deck.toml"), interaction="rigid", iterations=None)
    lateral_first(folder, 2 * np.pi)
    with pytest.warns(rb.InputWarning, match=r"first vertical frequency of 20.8 Hz.* rad/s\?"):
        crossing(rb.deck(folder / "deck.toml"), interaction="rigid", iterations=None)


def blanked(column):
    return lambda lines: [*lines[:2], *(cells(line, column, "") for line in lines[2:])]


def test_blank_rotations_are_none(folder):
    """As Nastran writes those of solid elements."""
    for columns in ((8, 9), (8, 9, 7)):
        for column in columns:
            change(folder / "modes.csv", blanked(column))
        blank = rb.deck(folder / "deck.toml")
        assert blank.has == {"y": True, "z": True, "roll": 7 not in columns}
        if blank.has["roll"]:
            assert differ(blank, rb.deck(EXAMPLE / "deck.toml")).max() < 5e-3


def test_one_blank_rotation_is_said_to_be_blank(folder):
    change(folder / "modes.csv", lambda lines: [*lines[:7], cells(lines[7], 8, " "), *lines[8:]])
    with pytest.raises(
        rb.InputError, match=r"modes.csv: line 8: ry = '': is blank, must be a number"
    ):
        rb.deck(folder / "deck.toml")


def european(text):
    """What a spreadsheet makes of a table where commas are decimal marks."""
    head, *lines = text.splitlines()
    body = [line.replace(",", ";").replace(".", ",") for line in lines]
    return "\r\n".join([head.replace(",", ";") + ";;;", *body]) + "\r\n"


@pytest.mark.parametrize("separator", [";", "\t"])
def test_semicolons_and_decimal_commas_are_read(folder, separator):
    plain = rb.deck(EXAMPLE / "deck.toml")
    for name in ("nodes.csv", "modes.csv", "masses.csv"):
        text = european((folder / name).read_text(encoding="utf-8"))
        (folder / name).write_text(text.replace(";", separator), encoding="utf-8-sig")
    found = rb.deck(folder / "deck.toml")
    assert found.frequencies_hz.tolist() == plain.frequencies_hz.tolist()
    assert differ(found, plain).max() == 0.0


@pytest.mark.parametrize(
    ("units", "kilograms", "metres"),
    [
        (("in", "lbf s2/in"), 175.12683524647636, 0.0254),
        (("in", "kip s2/in"), 175126.83524647636, 0.0254),
        (("mm", "kN s2/mm"), 1e6, 1e-3),
        (("in", 175.12683524647636), 175.12683524647636, 0.0254),
        ((0.3048, "slug"), 14.593902937206364, 0.3048),
    ],
)
def test_masses_of_other_sets_of_units(units, kilograms, metres, tmp_path):
    """A deck goes out and comes back; its places and shapes are in the units of the table."""
    deck = rb.deck("viaduct36")
    back = rb.deck(exchange.export_modes(deck, tmp_path, units))
    assert differ(back, deck).max() < 1e-12 and back.length == pytest.approx(36.0)
    nodes = (tmp_path / "nodes.csv").read_text(encoding="utf-8").splitlines()
    assert float(nodes[-1].split(",")[1]) == pytest.approx(36.0 / metres)
    row = (tmp_path / "modes.csv").read_text(encoding="utf-8").splitlines()[30].split(",")
    there = deck.shapes(np.array([float(nodes[int(row[4]) + 2].split(",")[1]) * metres]))[0, 0]
    assert float(row[7]) == pytest.approx(there[1] * np.sqrt(kilograms))


def test_other_refusals_name_the_field(folder):
    for axes in (["x", "y", "-z"], ["x", "x", "z"], "xyz", ["x", "up", "z"]):
        with pytest.raises(rb.InputError, match="axes"):
            read(EXAMPLE, axes=axes)
    change(
        folder / "modes.csv",
        lambda lines: [
            cells(x, 2, "damping_ratio" if i == 1 else "") if i else x for i, x in enumerate(lines)
        ],
    )
    with pytest.raises(rb.InputError, match="damping: is missing"):
        rb.deck(folder / "deck.toml")
    change(folder / "modes.csv", without_node_9)
    change(folder / "deck.toml", lambda lines: [x for x in lines if not x.startswith("masses")])
    with pytest.raises(
        rb.InputError, match="rail = '9': is a node of the rail that the modes leave out"
    ):
        rb.deck(folder / "deck.toml")


def test_the_other_programs_deck_is_the_shipped_section():
    assert viaduct36_in_mm().masses()[1].tolist() == pytest.approx(
        [12e3 * 1e-3 * 1.5, 2500 * (2.553 + 25.53) * 1.5 * 1e3]
    )


def test_a_modal_deck_runs_by_command_and_fits_the_schema(folder, tmp_path, capsys):
    schema = pages.schema()
    deck = tomllib.loads((folder / "deck.toml").read_text(encoding="utf-8"))
    content = {
        "deck": deck,
        "train": {"vehicle": "xia2000_planar"},
        "run": {"speed": 20.0, "time_step": 4e-3, "iterations": 1},
    }
    Draft202012Validator(schema).validate(content)
    for spoiled in (
        {"modes": {"nodes": "nodes.csv"}},
        {**deck, "mass": 1.0},
        {"modes": {**deck["modes"], "unit": "mm"}},
    ):
        assert not Draft202012Validator(schema).is_valid({**content, "deck": spoiled})
        with pytest.raises(rb.InputError):
            rb.Case({**content, "deck": spoiled})
    case = tmp_path / "case.toml"
    run = '[train]\nvehicle = "xia2000_planar"\n[run]\nspeed = 20.0\n'
    run += "time_step = 4e-3\niterations = 1\n"
    case.write_text(f'[deck]\nfile = "model/deck.toml"\n{run}', encoding="utf-8")
    assert cli.main(["run", str(case), "--out", str(tmp_path / "out")]) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert summary["remarks"] and summary["points"][0]["moment_vertical"] is None
    header = (tmp_path / "out" / "points.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "displacement_z" in header and "moment" not in header
