"""Nodes of other programs: their units and axes, and the line that carries the rail."""

import numpy as np
import pytest
from modal_files import EXAMPLE

import railbridge as rb
from railbridge.errors import field_types
from railbridge.exchange.nodes import AxisPlace, NodeChoice, NodeRows, model_axes, model_units

NODES = rb.exchange.read_nodes(EXAMPLE / "nodes.csv")
LEFT, RIGHT = {"y": 3.38, "z": 1.3}, {"y": 1.42, "z": 1.3}


# ---- units and axes


def test_units_may_be_said_by_the_file_or_by_the_caller(tmp_path):
    text = (EXAMPLE / "nodes.csv").read_text(encoding="utf-8")
    bare = tmp_path / "bare.csv"
    bare.write_text(text.partition("\n")[2], encoding="utf-8")
    assert np.array_equal(rb.exchange.read_nodes(bare, ["mm", "t"]).places, NODES.places)
    assert rb.exchange.read_nodes(bare, ("mm",)).units == ("mm", "kg")
    with pytest.raises(
        rb.InputError, match=r"^bare.csv: units: are stated nowhere. Add '# units: mm, t'"
    ):
        rb.exchange.read_nodes(bare)
    with pytest.raises(
        rb.InputError, match=r"^units = \['m', 't'\]: nodes.csv itself says mm, t. Remove"
    ):
        rb.exchange.read_nodes(EXAMPLE / "nodes.csv", ("m", "t"))


@pytest.mark.parametrize(
    ("units", "message"),
    [
        ("mm", "units = 'mm': must name a length and a mass"),
        ([], r"units = \[\]: must name a length and a mass"),
        (["mm", "t", "s"], "must name a length and a mass. For instance"),
        (5, "units = 5: must name a length and a mass"),
        (["yd", "t"], r"units\[1\] = 'yd': must be one of m, mm, cm, km, in, ft"),
        (["m", "tt"], r"units\[2\] = 'tt': .* kg, t, .*, or how many kg it is. Did you mean 't'"),
        (["", 2], r"units\[1\] = '': must be one of m"),
    ],
)
def test_units_that_are_none(units, message):
    with pytest.raises(rb.InputError, match=message):
        model_units(units)


@pytest.mark.parametrize(
    "axes",
    [["x", "y", "-z"], ["x", "x", "z"], "xyz", ["x", "up", "z"], ["x", "y"], None, [1, 2, 3]],
)
def test_axes_that_are_no_right_handed_set(axes):
    with pytest.raises(
        rb.InputError, match="axes.*must name the model's axes that point forward, left and up"
    ):
        model_axes(axes)


def test_axes_make_a_rotation():
    turn = model_axes(["x", "-z", "y"])
    assert (turn @ [1.0, 2.0, 3.0]).tolist() == [1.0, -3.0, 2.0]
    assert np.linalg.det(turn) == pytest.approx(1.0)


# ---- the rail line


def test_nodes_are_chosen_by_place_or_one_by_one():
    by_place = NODES.line(LEFT)
    by_name = NODES.line({"nodes": [*range(125, 100, -1)]})
    assert by_place.nodes == by_name.nodes == tuple(str(n) for n in range(101, 126))
    assert NODES.line(NodeChoice(y=3.4, within=0.03)).nodes == by_place.nodes
    assert by_place.length == pytest.approx(36.0) and not by_place.paired
    assert np.abs(by_place.y).max() < 1e-12 and np.abs(by_place.z).max() < 1e-12


def test_the_axis_is_that_of_the_line_or_where_it_is_said_to_be():
    pair = NODES.line({"left": LEFT, "right": RIGHT})
    assert pair.paired and pair.labels[0] == ("101", "201")
    assert pair.y[0] == pytest.approx([0.98, -0.98]) and pair.z[0] == pytest.approx([0.0, 0.0])
    line = NODES.line(NodeRows(LEFT, RIGHT), AxisPlace(y=0.0))
    assert line.y[0] == pytest.approx([3.38, 1.42]) and line.z[0] == pytest.approx([0.0, 0.0])
    assert NODES.line({"left": LEFT, "right": RIGHT}, {"z": 0.0}).z[0] == pytest.approx([1.3, 1.3])


ROW = {"nodes": [101, 102, 103]}


@pytest.mark.parametrize(
    ("rail", "field", "words"),
    [
        (
            {"nodes": [1, 2, 999]},
            "rail.nodes",
            "= '999': is no node of the model. Did you mean '9'?",
        ),
        ({"nodes": [1, 2, 2.0]}, "rail.nodes", "= '2': is listed more than once"),
        ({"nodes": "1 2 3"}, "rail.nodes", "must be a list of nodes"),
        ({"nodes": 5}, "rail.nodes", "must be a list of nodes"),
        ({"nodes": [1, 2]}, "rail", "holds 2 nodes, must be at least 3"),
        (
            {"y": 0.0, "nodes": [1, 2, 3]},
            "rail.y",
            "cannot stand beside nodes. Choose nodes by place or",
        ),
        ({"within": 0.1, "nodes": [1, 2, 3]}, "rail.within", "cannot stand beside nodes"),
        ({"y": "left"}, "rail.y", "must be a finite number in m"),
        ({"y": 0.0, "within": 0.0}, "rail.within", "above 0 m"),
        ({"x": 0.0}, "rail.x", "unknown key. Known: nodes, within, y, z"),
        (
            {"y": 7.0},
            "rail",
            "{'y': 7.0}: holds 0 nodes, must be at least 3. Check y and z (in m), or widen",
        ),
        (5, "rail", "must be a table"),
        (None, "rail", "two nodes stand at x = 0 m"),
        ({"left": LEFT}, "rail.right", "is missing. Give a left and a right row, or one row"),
        ({"left": LEFT, "rigth": RIGHT}, "rail.right", "is missing"),
        ({"left": LEFT, "right": RIGHT, "y": 0.0}, "rail.y", "= 0.0: cannot stand beside left"),
        ({"left": LEFT, "right": RIGHT, "x": 0.0}, "rail.x", "unknown key"),
        (
            {"left": {"y": 1.42}, "right": {"y": 3.38}},
            "rail.left",
            "must stand left of the right row, at larger y",
        ),
        (
            {"left": LEFT, "right": {"nodes": [1, 2, "a"]}},
            "rail.right.nodes",
            "is no node of the model",
        ),
        ({"left": {"y": "a"}, "right": RIGHT}, "rail.left.y", "must be a finite number in m"),
        ({"left": LEFT, "right": 3}, "rail.right", "must be a table"),
        (
            {"left": LEFT, "right": {"nodes": [1, 2, 3]}},
            "rail",
            "holds 25 left and 3 right nodes, must be pairs",
        ),
        ({"left": ROW, "right": {"nodes": [201, 203, 204]}}, "rail", "must stand at the same x"),
    ],
)
def test_choices_that_make_no_line_name_the_field(rail, field, words):
    with pytest.raises(rb.InputError) as error:
        NODES.line(rail)
    assert error.value.field == field
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("axis", "field", "words"),
    [
        ({"y": "middle"}, "axis.y", "must be a finite number in m"),
        ({"x": 0.0}, "axis.x", "unknown key. Known: y, z"),
        (0.0, "axis", "must be a table"),
    ],
)
def test_a_place_of_the_axis_that_is_none(axis, field, words):
    with pytest.raises(rb.InputError) as error:
        NODES.line(LEFT, axis)
    assert error.value.field == field and words in str(error.value)


def test_what_a_choice_may_hold_stands_in_its_types():
    kinds = {
        name: (kind.kind, kind.range.unit, kind.optional)
        for name, kind in field_types(NodeChoice).items()
    }
    assert kinds["y"] == kinds["z"] == ("number", "m", True) and kinds["within"] == (
        "number",
        "m",
        False,
    )
