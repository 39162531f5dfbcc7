"""The table ``modes`` of a deck file, as Python has it."""

import dataclasses
import re

import numpy as np
import pytest
from modal_files import EXAMPLE, differ

import railbridge as rb
from railbridge.exchange import ModesTable, beside, deck_from_modes, read_modes, stamps

FILES = {name: str(EXAMPLE / f"{name}.csv") for name in ("nodes", "modes", "masses")}
RAIL = {"y": 0.0, "z": 0.0}


def test_the_table_makes_the_deck_that_its_files_hold():
    table = ModesTable(**FILES, rail=RAIL, supports=[0, 36], count=6)
    deck = table.deck(0.02, name="mine", tracks={"left": 2.4}, width=9.6)
    model = read_modes(FILES["nodes"], FILES["modes"])
    want = deck_from_modes(model, model.nodes.line(RAIL), count=6)
    assert (
        np.array_equal(deck.frequencies_hz, want.frequencies_hz) and differ(deck, want).max() == 0.0
    )
    assert set(deck.damping_ratios) == {0.02} and deck.supports == (0.0, 36.0)
    assert (deck.name, deck.tracks, deck.width) == ("mine", {"left": 2.4}, 9.6)


def test_every_field_is_documented():
    section = ModesTable.__doc__.partition("Attributes")[2]
    for field in dataclasses.fields(ModesTable):
        assert re.search(rf"^ *{field.name} : ", section, re.M), field.name


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"nodes": 5}, "nodes", "must be a text"),
        ({"masses": ""}, "masses", "must be a text"),
        ({"units": "mm"}, "units", "must name a length and a mass"),
        ({"units": ["mm", "kN"]}, "units[2]", "must be one of kg, t, lb, slug"),
        ({"axes": ["x", "y", "-z"]}, "axes", "right-handed"),
        (
            {"rail": {"left": {"nodes": "1"}, "right": {}}},
            "rail.left.nodes",
            "must be a list of nodes",
        ),
        ({"axis": {"x": 0.0}}, "axis.x", "unknown key"),
        ({"supports": [0.0, -1.0]}, "supports[2]", "at least 0 m"),
        ({"count": 0}, "count", "at least 1"),
        ({"unusual": "no"}, "unusual", "true or false"),
    ],
)
def test_what_a_table_may_not_hold_is_refused_before_a_file_is_opened(change, field, words):
    with pytest.raises(rb.InputError) as error:
        ModesTable(**{"nodes": "nowhere.csv", "modes": "nowhere.csv", **change})
    assert error.value.field == field and words in str(error.value)


@pytest.mark.parametrize(
    ("change", "damping", "field", "words"),
    [
        ({"nodes": "no.csv"}, None, "nodes", "= 'no.csv': no such file"),
        ({"modes": "no.csv"}, None, "modes", "= 'no.csv': no such file"),
        ({"masses": "no.csv"}, None, "masses", "= 'no.csv': no such file"),
        ({"units": ["m", "kg"]}, None, "units", "nodes.csv itself says mm, t"),
        ({"rail": None}, None, "rail", "two nodes stand at"),
        ({"supports": [0.0, 36.5]}, None, "supports[2]", "at most 36 m"),
        ({"supports": [0.0, 0.0]}, None, "supports", "two bearing lines stand at one place"),
        ({"supports": [36.0, 0.0, 0.01]}, None, "supports", "two bearing lines stand at one place"),
        ({"count": 11}, None, "count", "at most 10"),
        ({}, -0.1, "damping", "at least 0"),
    ],
)
def test_what_the_files_do_not_allow_names_the_field_of_the_table(change, damping, field, words):
    with pytest.raises(rb.InputError) as error:
        ModesTable(**{**FILES, "rail": RAIL, **change}).deck(damping)
    assert error.value.field == field and words in str(error.value)


def test_frequencies_of_no_bridge_are_named_without_the_name_of_an_argument(tmp_path):
    text = (EXAMPLE / "modes.csv").read_text(encoding="utf-8").replace("mm, t", "m, t")
    nodes = (EXAMPLE / "nodes.csv").read_text(encoding="utf-8").replace("mm, t", "m, t")
    (tmp_path / "modes.csv").write_text(text, encoding="utf-8")
    (tmp_path / "nodes.csv").write_text(nodes, encoding="utf-8")
    files = {name: str(tmp_path / f"{name}.csv") for name in ("nodes", "modes")}
    with pytest.raises(rb.InputError, match="lies an order of magnitude away") as error:
        ModesTable(**files, rail=RAIL).deck()
    assert error.value.field == "first frequency"


def test_the_way_into_a_case_is_put_in_front_but_never_in_front_of_a_file(tmp_path):
    run = {"train": {"vehicle": "xia2000"}, "run": {"speed": 20.0}}
    with pytest.raises(rb.InputError) as error:
        rb.Case({"deck": {"modes": {**FILES, "rail": {"left": {"y": 3.38}}}}, **run}).run()
    assert error.value.field == "deck.modes.rail.right"
    spoiled = tmp_path / "modes.csv"
    spoiled.write_text(
        (EXAMPLE / "modes.csv").read_text(encoding="utf-8") + "1,x", encoding="utf-8"
    )
    with pytest.raises(rb.InputError) as error:
        rb.Case({"deck": {"modes": {**FILES, "modes": str(spoiled), "rail": RAIL}}, **run}).run()
    assert (error.value.source, error.value.field) == ("modes.csv", "line 753")


def test_paths_and_stamps_of_a_deck_file(tmp_path):
    content = {"modes": {"nodes": "n.csv", "modes": "m.csv", "count": 3}, "width": 9.6}
    opened = beside(content, tmp_path)
    assert opened == {
        "modes": {"nodes": str(tmp_path / "n.csv"), "modes": str(tmp_path / "m.csv"), "count": 3},
        "width": 9.6,
    }
    assert content["modes"]["nodes"] == "n.csv" and stamps(opened) == []
    (tmp_path / "n.csv").write_text("node", encoding="utf-8")
    assert stamps(opened)[1:] == [4]
    for other in ({}, {"modes": 20}):
        assert beside(other, tmp_path) == other and stamps(other) == []


def test_supports_of_a_line_whose_nodes_are_rounded_are_its_ends():
    deck = ModesTable(**FILES, rail=RAIL, supports=[0.0, 36.00002]).deck(0.02)
    assert deck.supports == (0.0, 36.0)
