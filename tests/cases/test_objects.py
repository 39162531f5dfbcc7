"""Deck files: what the keys mean, and how they are refused."""

import copy
import dataclasses
import tomllib

import pytest

import railbridge as rb
from railbridge import exchange
from railbridge.beams.bearings import Bearing
from railbridge.cases import objects as decks
from railbridge.cases import shelf
from railbridge.errors import InputError
from railbridge.exchange.tables import read_columns

SECTION = {
    "youngs_modulus": 35e9, "poisson_ratio": 0.2, "density": 2500.0, "area": 4.8,
    "second_moment_vertical": 2.553, "second_moment_lateral": 25.53, "torsion_constant": 5.59,
}  # fmt: skip
EI, EA, G = 35e9 * 2.553, 35e9 * 4.8, 35e9 / 2.4
TABLE = {
    "length": 36.0,
    "section": SECTION,
    "damping": {"modal": 0.02},
    "width": 9.6,
    "bearing": [
        {"x": 0.0, "y": 1.5, "z": -1.3, "fixed": "y z", "stiffness": {"x": 6e9}},
        {"x": 0.0, "y": -1.5, "z": -1.3, "fixed": "z"},
        {"x": 36.0, "y": 1.5, "z": -1.3, "fixed": ["y", "z"]},
        {"x": 36.0, "y": -1.5, "z": -1.3, "stiffness": {"z": 2e9}},
    ],
}


def changed(**more):
    return {**copy.deepcopy(TABLE), **more}


def beam_of(deck):
    return deck.recovery.beam


def test_bearings_of_a_file_stand_where_it_says():
    deck = decks.deck_from_table("b", TABLE)
    assert deck.bearings == (
        (0.0, 1.5, -1.3),
        (0.0, -1.5, -1.3),
        (36.0, 1.5, -1.3),
        (36.0, -1.5, -1.3),
    )
    assert deck.supports == (0.0, 36.0)
    assert beam_of(deck).bearings[0] == Bearing(0.0, ("y", "z"), 1.5, -1.3, {"x": 6e9})
    assert [b.restrained for b in beam_of(deck).bearings] == [
        ("x", "y", "z"),
        ("z",),
        ("y", "z"),
        ("z",),
    ]
    same = rb.Beam(
        "b",
        (36.0,),
        12e3,
        EI,
        35e9 * 25.53,
        G * 5.59,
        EA,
        2500 * 28.083,
        bearings=beam_of(deck).bearings,
    )
    assert deck.frequencies_hz == pytest.approx(same.deck(20).frequencies_hz, rel=1e-12)


def test_switches_of_a_file_are_off_unless_given():
    usual = decks.deck_from_table("b", changed())
    assert (beam_of(usual).shear_stiffness_vertical, beam_of(usual).rotary_inertia_vertical) == (
        None,
        None,
    )
    assert (beam_of(usual).continuous, usual.track_height, beam_of(usual).centroid_height) == (
        True,
        0.0,
        0.0,
    )
    section = {**SECTION, "shear_area_vertical": 1.4, "shear_area_lateral": 3.0}
    deck = decks.deck_from_table(
        "b", changed(section=section, rotary_inertia=True, track_height=1.1, centroid_height=0.2)
    )
    beam = beam_of(deck)
    assert (beam.shear_stiffness_vertical, beam.shear_stiffness_lateral) == pytest.approx(
        (G * 1.4, G * 3.0)
    )
    assert (beam.rotary_inertia_vertical, beam.rotary_inertia_lateral) == pytest.approx(
        (2500 * 2.553, 2500 * 25.53)
    )
    assert (deck.track_height, beam.centroid_height) == (1.1, 0.2)
    assert deck.frequencies_hz[0] < usual.frequencies_hz[0]
    stiff = {
        "length": 30.0, "mass": 1e4, "bending_stiffness_vertical": 5e10, "damping": {"modal": 0.01},
        "shear_stiffness_vertical": 1e10, "rotary_inertia_vertical": 4e3,
    }  # fmt: skip
    assert beam_of(decks.deck_from_table("b", stiff)).shear_flexibility("vertical") == 5.0


def test_spans_that_do_not_run_through():
    table = {k: v for k, v in TABLE.items() if k not in ("length", "bearing")}
    deck = decks.deck_from_table("b", {**table, "spans": [20.0, 20.0], "continuous": False})
    alone = decks.deck_from_table("b", {**table, "length": 20.0})
    assert deck.frequencies_hz[:2] == pytest.approx([alone.frequencies_hz[0]] * 2, rel=1e-3)
    assert len(deck.bearings) == 4
    own = [
        {"x": 0.0, "fixed": "x y z roll"},
        {"x": 20.0, "fixed": "y z roll", "span": 1},
        {"x": 20.0, "fixed": "x y z roll", "span": 2},
        {"x": 40.0, "fixed": "y z roll"},
    ]
    told = decks.deck_from_table(
        "b", {**table, "spans": [20.0, 20.0], "continuous": False, "bearing": own}
    )
    assert told.frequencies_hz == pytest.approx(deck.frequencies_hz, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"bearing": {"x": 0.0}}, r"deck b: bearing = .*must be a list of tables"),
        ({"bearing": [{"fixed": "z"}]}, r"deck b: bearing\[1\]\.x: is missing"),
        ({"bearing": [{"x": 0.0}]}, r"deck b: bearing\[1\]\.fixed: is missing"),
        (
            {"bearing": [{"x": 0.0, "fixed": 3}]},
            r"bearing\[1\]\.fixed = 3: must list some of x y z",
        ),
        ({"bearing": [{"x": 0.0, "fixed": "x w"}]}, r"bearing\[1\]\.fixed = 'w'"),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "y": 5.0}]},
            r"bearing\[1\]\.y = 5.0: is off the deck, half width 4.8 m",
        ),
        ({"bearing": [{"x": 0.0, "fixed": "z", "z": -1300.0}]}, r"bearing\[1\]\.z = -1300.0"),
        ({"bearing": [{"x": 40.0, "fixed": "z"}]}, r"bearing\[1\]\.x = 40.0"),
        ({"bearing": [{"x": 0.0, "stiffness": {"z": -1.0}}]}, r"bearing\[1\]\.stiffness.z = -1.0"),
        (
            {"bearing": [{"x": 0.0, "stiffness": 6e9}]},
            r"bearing\[1\]\.stiffness = 6000000000.0: must be a table",
        ),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "stifness": {}}]},
            r"bearing\[1\]\.stifness: unknown key",
        ),
        ({"bearing": TABLE["bearing"][1:]}, r"deck b: bearing = .*sliding along x"),
        (
            {"bearing": [*TABLE["bearing"], TABLE["bearing"][0]]},
            r"given to two bearings in one place",
        ),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "span": 1}]},
            r"bearing\[1\]\.span = 1: is only for simple spans",
        ),
        ({"continuous": "no"}, r"continuous = 'no': must be true or false"),
        ({"rotary_inertia": 3.0}, r"rotary_inertia = 3.0: must be true or false"),
        (
            {"rotary_inertia_vertical": 3.0},
            r"rotary_inertia_vertical = 3.0: a section is given too",
        ),
        ({"track_height": 1800.0}, r"track_height = 1800.0"),
        ({"centroid_height": "low"}, r"centroid_height = 'low'"),
        (
            {"section": {**SECTION, "shear_area_vertical": 0.0}},
            r"section.shear_area_vertical = 0.0",
        ),
    ],
    ids=str,
)
def test_bad_decks_are_refused_by_name(change, message):
    with pytest.raises(rb.InputError, match=message):
        decks.deck_from_table("b", changed(**change))


def test_rotary_inertia_needs_a_section_or_numbers():
    table = {
        "length": 30.0,
        "mass": 1e4,
        "bending_stiffness_vertical": 5e10,
        "damping": {"modal": 0.01},
        "rotary_inertia": True,
    }
    with pytest.raises(
        rb.InputError, match="rotary_inertia = True: follows from a section only"
    ) as error:
        decks.deck_from_table("b", table)
    assert "rotary_inertia_vertical" in error.value.remedy


WITHOUT = ("symbol", "source", "note")


def car_table(
    tmp_path, separator=",", decimal=".", columns=("name", "value", "unit"), drop=(), **add
):
    """Write the paper's car in another way, and return the path."""
    table = read_columns(shelf.data_file("vehicles", "xia2000"), ["name", "value", "unit"], WITHOUT)
    rows = zip(*(table.cells[c] for c in ("name", "value", "unit")), strict=True)
    rows = [*(row for row in rows if row[0] not in drop), *((k, *v) for k, v in add.items())]
    rows = [dict(zip(("name", "value", "unit"), row, strict=True)) for row in rows]
    lines = [separator.join(row[c].replace(".", decimal) for c in columns) for row in rows]
    path = tmp_path / "mine.csv"
    path.write_text("\n".join([separator.join(columns), *lines]), encoding="utf-8")
    return path


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_car_s_table_needs_names_values_and_units_only(tmp_path, separator):
    usual = rb.vehicle("xia2000")
    decimal = "." if separator == "," else ","
    for columns in (("name", "value", "unit"), ("unit", "value", "name")):
        found = rb.vehicle(car_table(tmp_path, separator, decimal, columns))
        assert found.bodies == usual.bodies and found.springs == usual.springs
        assert found.length == usual.length == 22.5


@pytest.mark.parametrize("name", ["wheelset_mass", "static_wheelset_mass"])
def test_wheelsets_of_a_car_s_table_weigh_on_the_rail(tmp_path, name):
    usual = rb.vehicle("xia2000")
    found = rb.vehicle(car_table(tmp_path, **{name: ("1.78", "t")}))
    assert found.static_wheelset_mass == 1780.0
    assert found.weight == pytest.approx(usual.weight + 4 * 1780.0 * 9.81)
    more = [
        b.static_load - a.static_load for a, b in zip(usual.contacts, found.contacts, strict=True)
    ]
    assert more == pytest.approx([1780.0 * 9.81 / 2] * 8)
    assert found.modes().frequencies_hz == pytest.approx(usual.modes().frequencies_hz)
    both = car_table(tmp_path, wheelset_mass=("1", "t"), static_wheelset_mass=("1", "t"))
    with pytest.raises(InputError, match="row static_wheelset_mass: appears more than once"):
        rb.vehicle(both)
    with pytest.raises(
        InputError, match="wheelset_mass = -1.0: must be a finite number at least 0"
    ):
        rb.vehicle(car_table(tmp_path, **{name: ("-1", "kg")}))


def test_a_car_s_length_may_be_left_out(tmp_path):
    path = car_table(tmp_path, drop=("length",))
    assert rb.vehicle(path).length is None
    tables = {**rb.case("paper").content, "train": {"vehicle": str(path), "cars": 2}}
    with pytest.raises(InputError, match=r"train.car_spacing: is missing. Give it, or the length"):
        rb.Case(tables)
    found = rb.Case({**tables, "train": {**tables["train"], "car_spacing": 22.5}})
    assert found.train.centres.tolist() == rb.Train(rb.vehicle("xia2000"), 2).centres.tolist()
    text = shelf.data_file("vehicles", "sprung_mass").read_text(encoding="utf-8")
    (tmp_path / "mine.toml").write_text(text.replace("length = 10.0", ""), encoding="utf-8")
    assert rb.vehicle(tmp_path / "mine.toml").length is None


def test_a_car_in_other_units_is_the_same_car(tmp_path):
    usual = rb.vehicle("xia2000")
    pound = 4.4482216152605
    other = {
        "bogie_mass": (4360 / (pound / 0.0254), "lbf s2/in"),
        "car_body_mass": (50.99e-3, "kN s2/mm"),
        "primary_vertical_stiffness": (2976 / (pound / 0.0254), "kip/in"),
        "secondary_vertical_damping": (30.0, "N s/mm"),
    }
    written = {name: (repr(value), unit) for name, (value, unit) in other.items()}
    found = rb.vehicle(car_table(tmp_path, drop=tuple(other), **written))
    assert found.modes().frequencies_hz == pytest.approx(usual.modes().frequencies_hz, rel=1e-12)
    assert found.damping_matrix == pytest.approx(usual.damping_matrix)


BED = {"bending_stiffness": 1.28e7, "foundation": 1e8}


@pytest.mark.parametrize("rail", [{"spread": 0.6}, BED])
def test_every_maker_of_decks_takes_a_rail(rail, tmp_path):
    plain = rb.deck("viaduct36")
    folder = exchange.export_modes(dataclasses.replace(plain, rail=rb.Rail(**rail)), tmp_path)
    shipped = tomllib.loads(shelf.data_file("decks", "viaduct36_identified").read_text("utf-8"))
    for name, deck in {
        "beam": rb.deck_from_table("b", changed(rail=rail)),
        "box": rb.deck_from_table("box", {**shipped, "rail": rail}),
        "modes": rb.deck(folder),
        "beside a file": rb.case("paper").replace({"deck.rail": rail}).deck,
        "in Python": rb.deck("viaduct36", rail=rb.Rail(**rail)),
    }.items():
        assert deck.rail == rb.Rail(**rail), name
    assert plain.rail is None and rb.case("paper").deck.rail is None


@pytest.mark.parametrize(
    ("rail", "words"),
    [
        ({"spread": 600.0}, "deck.rail.spread = 600.0: must be .* at most 5 m"),
        ({"spread": 0.6, "foundation": 1e8}, "deck.rail.foundation .* give either"),
        ({"foundation": 1e8}, "deck.rail.bending_stiffness: is missing"),
        ({}, "deck.rail.spread: is missing"),
        ({"sprad": 0.6}, "deck.rail.sprad: unknown key. Did you mean 'spread'"),
        (0.6, "deck.rail = 0.6: must be a table"),
        (BED | {"foundation": 100.0}, "deck.rail.foundation .* elastic length is 26.7 m"),
    ],
)
def test_a_rail_of_a_table_is_refused_by_its_key(rail, words):
    case = {"deck": changed(rail=rail), "train": {"vehicle": "xia2000"}, "run": {"speed": 20.0}}
    with pytest.raises(InputError, match=words):
        rb.Case(case)


def test_a_rail_too_wide_for_the_deck_is_refused_by_its_key():
    table = changed(length=3.0, bearing=[], rail={"spread": 1.2})
    case = {"deck": table, "train": {"vehicle": "xia2000"}, "run": {"speed": 20.0}}
    with pytest.raises(InputError, match=r"deck.rail.spread = 1.2: spreads a load over 1.2 m"):
        rb.Case(case)


def test_a_rail_in_another_unit_is_doubted():
    soft = changed(rail={"bending_stiffness": 1.28e4, "foundation": 1e5})
    case = {"deck": soft, "train": {"vehicle": "xia2000"}, "run": {"speed": 20.0}}
    said = " ".join(map(str, rb.Case(case).doubts))
    assert "deck.rail.bending_stiffness = 12800 N m2" in said and "given in kN m2?" in said
    assert "deck.rail.foundation = 100000 N/m2" in said and "given in kN/m2?" in said
