"""Tables of files as types: what is refused, under which path, and what the schema says of it."""

from dataclasses import dataclass
from typing import Annotated, Literal

import jsonschema
import pytest
from pydantic import TypeAdapter

from railbridge.cases.tabletypes import (
    by_key,
    checked,
    fields_of,
    key,
    list_of,
    meanings,
    named_numbers,
    number,
    numbers,
    switched,
    table,
    text,
)  # fmt: skip
from railbridge.errors import InputError, Range


@dataclass
class Pier:
    """A pier.

    Attributes
    ----------
    x : float
        m.
    shape : str
        Round or square.
    sides : tuple of float
        m, of a square one.
    """

    x: Annotated[float, Range(least=0.0, unit="m")]
    shape: Literal["round", "square"] = "round"
    sides: tuple[float, ...] = ()


PIER = table("Pier", "A pier.", **fields_of(Pier, sides=numbers(2, above=0.0)))
ROW = table(
    "Row",
    "Piers in a row, or a wall.",
    pier=key(list_of(PIER, "pier"), "The piers.", required=True),
    stiffness=key(named_numbers(("x", "y"), above=0.0, unit="N/m"), "By direction."),
)
WALL = table("Wall", "A wall.", wall=key(number(above=0.0), "m.", required=True))
EITHER = switched(lambda v: by_key(v, ("wall",), "row"), {"wall": WALL, "row": ROW})

GOOD = {"pier": [{"x": 0.0}, {"x": 3.0, "shape": "square", "sides": [1.0, 2.0]}]}


@pytest.mark.parametrize(
    ("given", "path", "said"),
    [
        ({}, "bridge.pier", "is missing"),
        ({"pier": {"x": 1.0}}, "bridge.pier", "[[pier]]"),
        ({"pier": [{"x": 0.0}, {"x": -1.0}]}, "bridge.pier[2].x", "at least 0"),
        ({"pier": [{"x": 0.0, "shap": "round"}]}, "bridge.pier[1].shap", "shape"),
        ({"pier": [{"x": 0.0, "shape": "rund"}]}, "bridge.pier[1].shape", "round"),
        ({"pier": [{"x": 0.0, "sides": [1.0]}]}, "bridge.pier[1].sides", "2"),
        ({"pier": [{"x": 0.0, "sides": [1.0, 0.0]}]}, "bridge.pier[1].sides[2]", "above 0"),
        ({"pier": [{"x": 0.0}], "stiffness": {"z": 1.0}}, "bridge.stiffness", "x, y"),
        ({"pier": [{"x": 0.0}], "stiffness": {"x": True}}, "bridge.stiffness.x", "number"),
        ({"wall": "high"}, "bridge.wall", "number"),
        ("a wall", "bridge", "table"),
        ({"pier": [3]}, "bridge.pier[1]", "table"),
    ],
)
def test_what_is_wrong_is_named_where_it_stands_and_the_schema_refuses_it_too(given, path, said):
    with pytest.raises(InputError) as error:
        checked(EITHER, given, "bridge")
    assert error.value.field == path
    assert said in str(error.value)
    schema = TypeAdapter(EITHER).json_schema(by_alias=True)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(given, schema)


def test_what_is_right_is_read_and_the_schema_agrees():
    row = checked(EITHER, GOOD, "bridge")
    assert row.pier[1].given == {"x": 3.0, "shape": "square", "sides": (1.0, 2.0)}
    assert row.pier[0].shape == "round" and not row.pier[0].has("shape")
    jsonschema.validate(GOOD, TypeAdapter(EITHER).json_schema(by_alias=True))


def test_meanings_come_from_the_dataclass():
    assert meanings(Pier) == {
        "x": "m.",
        "shape": "Round or square.",
        "sides": "m, of a square one.",
    }
    assert PIER.model_fields["shape"].description == "Round or square."


def test_a_field_that_does_not_say_enough_needs_a_type():
    with pytest.raises(TypeError):
        fields_of(Pier)


def test_texts_are_not_empty():
    with pytest.raises(InputError, match="^name"):
        checked(table("T", "A table.", name=key(text(), "Its name.")), {"name": " "})
