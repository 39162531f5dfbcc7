"""Inputs stand in the report as they were given, with what became of them."""

import pytest

import railbridge as rb
from railbridge.reports.inputs import (
    file_tables,
    modes_table,
    resolved_deck,
    resolved_train,
    tables_of_case,
)


def cells(table):
    return {row[0]: row[1:] for row in table.rows}


def test_every_key_of_a_case_stands_there_with_its_meaning():
    content = rb.case("paper").content
    tables = {table.name: cells(table) for table in tables_of_case(content)}
    assert list(tables) == ["case deck", "case train", "case track", "case run", "case output"]
    assert tables["case run"]["speed"] == ("20", "m/s; 72 km/h is 20.")
    assert tables["case run"]["loads"][0] == "condensed"
    assert tables["case track"]["lateral.phase"][0] == "1.570796327"
    assert tables["case output"]["points"] == ("[18]", "m along the deck; default mid-length.")
    assert all(about for table in tables.values() for _, about in table.values())


def test_lists_of_tables_are_taken_apart():
    waves = [
        {"kind": "harmonic", "amplitude": 1e-3, "wavelength": 10.0},
        {"kind": "table", "x": [float(i) for i in range(500)], "r": [0.0] * 500},
    ]
    notch = {"wheels": [[1, 2]], "circumference": 2.9, "offset": 0.1, "depth": 1e-3, "length": 0.5}
    changes = {"track.vertical": waves, "track.lateral": None, "train.notch": [notch]}
    case = rb.case("paper", {**changes, "run.time_step": None})
    tables = {table.name: cells(table) for table in tables_of_case(case.content)}
    assert tables["case track"]["vertical[1].wavelength"][0] == "10"
    long = tables["case track"]["vertical[2].x"][0]
    assert long.startswith("[0, 1, 2,") and long.endswith("498, 499]") and len(long) <= 400
    assert tables["case train"]["notch[1].depth"][0] == "0.001"


def test_what_does_not_count_is_left_out():
    content = rb.case("paper").content
    tables = {t.name: cells(t) for t in tables_of_case(content, ["train", "run.speed"])}
    assert "case train" not in tables and "speed" not in tables["case run"]
    assert "loads" in tables["case run"]
    only = {**content, "run": {"speed": 20.0}}
    assert "case run" not in {t.name for t in tables_of_case(only, ["run.speed"])}


def test_files_of_deck_and_vehicle_are_shown():
    deck, car = file_tables(rb.case("paper").content)
    assert cells(deck)["section.area"] == ("4.8", "A, m2.")
    assert cells(deck)["note"][0] == "identified, not known"
    assert cells(deck)["bearing[2].fixed"][0] == "y z roll"
    assert cells(car)["car_body_mass"] == (50990.0, "kg", "Amaral & Mazzilli 2016, Table 1", "")
    vehicle = {"train": {"vehicle": "sprung_mass"}, "track": None}
    other = file_tables(rb.case("paper", vehicle).content)[1]
    assert cells(other)["source"][0].startswith("Yang & Yau (1997)")
    assert not any(key.startswith(("body", "spring")) for key in cells(other))


def test_the_deck_as_computed_has_its_numbers():
    found = cells(resolved_deck(rb.deck("viaduct36")))
    assert found["length"] == (36.0, "m") and found["bearing lines at"] == ("0, 36", "m")
    assert found["mass per metre"] == (pytest.approx(12.0), "t/m")
    assert found["first frequency"] == (pytest.approx(3.307, rel=1e-3), "Hz")
    assert found["tracks, left of the axis"] == ("left 2.4, right -2.4", "m")
    assert found["damping"][0].startswith("Rayleigh, 2.39 to 24.8 % of critical")
    assert found["rail that spreads loads"] == (None, "")


def test_a_deck_of_one_ratio_says_so():
    made = rb.deck_from_table("d", {
        "length": 20.0, "bending_stiffness_vertical": 2e10, "mass": 9000.0,
        "damping": {"modal": 0.015}, "modes": 3,
        "rail": {"bending_stiffness": 1.28e7, "foundation": 1e8},
    })  # fmt: skip
    found = cells(resolved_deck(made))
    assert found["damping"][0] == "1.5 % of critical, by mode"
    assert found["rail that spreads loads"][0] == "bending_stiffness = 1.28e7, foundation = 1e8"


def test_the_train_as_computed_weighs_what_it_weighs():
    train = rb.case("paper").train
    whole, bodies, springs = resolved_train(train, parameters=True)
    found = cells(whole)
    assert found["axles"] == (32, "") and found["cars"] == ("8 of xia2000", "")
    assert found["all axles together, static"][0] == pytest.approx(8 * 585.76, rel=1e-4)
    assert found["heaviest axle, static"][0] == pytest.approx(585.76 / 4, rel=1e-4)
    assert bodies.rows[0][:2] == ("car", pytest.approx(50.99))
    assert len(springs.rows) == 12 and not springs.on_page
    assert springs.rows[0][5:7] == (pytest.approx(460.0), pytest.approx(1060.0))
    assert resolved_train(train)[2].on_page


def test_bare_axle_loads_have_no_cars():
    (table,) = resolved_train(rb.train("HSLM-A1"))
    found = cells(table)
    assert found["bare axle loads"] == ("HSLM-A1", "")
    assert found["heaviest axle, static"] == (pytest.approx(170.0), "kN")


def test_modes_say_which_are_kept_and_how_well_that_is_known():
    deck = rb.deck("viaduct36")
    table = modes_table(deck)
    assert [row[0] for row in table.rows] == list(range(1, 21))
    kept = [row[4] for row in table.rows]
    assert kept == [f <= 30.0 for f in deck.frequencies_hz]
    assert table.rows[0][2] == pytest.approx(3.0, abs=0.01)
    assert "30 Hz" in table.note and "EN 1990, A2.4.4" in table.note and "memory" in table.note


def test_with_two_modes_nobody_can_say_which_are_kept():
    made = rb.deck_from_table("d", {
        "length": 20.0, "bending_stiffness_vertical": 2e10, "mass": 9000.0,
        "damping": {"modal": 0.01}, "modes": 2,
    })  # fmt: skip
    table = modes_table(made)
    assert [row[4] for row in table.rows] == [None, None]
    assert "cannot decide" in table.note
