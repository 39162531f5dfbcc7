"""Reading and checking what users bring."""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
import pytest

from railbridge import errors
from railbridge.errors import InputError, Range


def test_a_message_names_field_value_range_and_remedy():
    with pytest.raises(InputError) as error:
        errors.number("run.speed", -3.0, above=0.0, most=200.0, unit="m/s", remedy="Give it in m/s")
    assert (
        str(error.value)
        == "run.speed = -3.0: must be a finite number above 0 and at most 200 m/s. Give it in m/s."
    )
    assert (error.value.field, error.value.value, error.value.remedy) == (
        "run.speed",
        -3.0,
        "Give it in m/s",
    )


@pytest.mark.parametrize(
    ("given", "shown"),
    [
        (np.float64(-3.0), "-3.0"),
        (np.int64(-3), "-3"),
        (np.array([1.0, 2.0]), "[1.0, 2.0]"),
        (np.array(5.0), "5.0"),
        ("x" * 60, f"'{'x' * 56}..."),
    ],
)
def test_a_message_shows_a_value_as_it_would_be_typed(given, shown):
    assert str(InputError("x", given, "no")) == f"x = {shown}: no."


@pytest.mark.parametrize("good", [3, 3.0, np.float32(3), np.int64(3), np.float64(3)])
def test_numbers_of_any_kind(good):
    assert errors.number("x", good) == 3.0 and type(errors.number("x", good)) is float
    assert errors.integer("x", good) == 3 and type(errors.integer("x", good)) is int


@pytest.mark.parametrize(
    "bad",
    [
        None,
        True,
        np.True_,
        "3",
        b"3",
        3j,
        [3],
        np.array([3.0]),
        np.nan,
        np.inf,
        -np.inf,
        1e300,
        10**400,
        {},
        object(),
    ],
)
def test_what_is_no_number(bad):
    for check in (errors.number, errors.integer):
        with pytest.raises(InputError, match="x"):
            check("x", bad)
    with pytest.raises(InputError):
        errors.numbers("x", [1.0, bad])


def test_ranges():
    assert errors.number("x", 2.0, least=2.0, most=2.0) == 2.0
    assert errors.number("x", 1e-300) == 0.0
    for limits in ({"above": 2.0}, {"least": 2.1}, {"most": 1.9}):
        with pytest.raises(InputError):
            errors.number("x", 2.0, **limits)
    with pytest.raises(InputError, match="whole"):
        errors.integer("x", 2.5)
    with pytest.raises(InputError, match="must hold 3"):
        errors.numbers("x", [1, 2], count=3)
    for wrong in ("1 2", {"a": 1}, 5, None):
        with pytest.raises(InputError, match="list of numbers"):
            errors.numbers("x", wrong)


def test_did_you_mean_and_choice():
    with pytest.raises(InputError, match="Did you mean 'wheels'"):
        errors.choice("run.loads", "wheel", ("wheels", "bogies"))
    with pytest.raises(InputError, match="Known: a, b"):
        errors.keys("t", {"zzz": 1}, ["a", "b"])
    with pytest.raises(InputError, match="t.a: is missing"):
        errors.keys("t", {}, [], ["a"])


def test_plain_turns_numpy_into_python_and_refuses_the_rest():
    content = {"a": np.float32(2), "b": np.arange(3), "c": (1, {"d": np.bool_(True)})}
    plain = errors.plain("x", content)
    assert plain == {"a": 2.0, "b": [0, 1, 2], "c": [1, {"d": True}]}
    assert type(plain["a"]) is float and type(plain["c"][1]["d"]) is bool
    loop: list = []
    loop.append(loop)
    for wrong in (None, object(), {1: 2}, {"a": {3}}, loop, 1j, np.array([None])):
        with pytest.raises(InputError):
            errors.plain("x", wrong)


def test_within_says_where_a_field_stands_and_what_the_user_calls_it():
    with (
        pytest.raises(InputError) as error,
        errors.within("deck", {"bearings": "bearing"}, source="my.toml"),
        errors.within("bearings[2]"),
    ):
        errors.number("x", "far")
    assert error.value.field == "deck.bearing[2].x"
    assert str(error.value).startswith(
        "my.toml: deck.bearing[2].x = 'far': must be a finite number"
    )


def test_what_is_refused_inside_a_file_is_found_by_that_file_s_name():
    with (
        pytest.raises(InputError) as error,
        errors.within("deck", {"x": "place"}, source="my.toml"),
    ):
        raise InputError("x", "far", "must be a number", source="modes.csv")
    assert (error.value.source, error.value.field) == ("modes.csv", "x")
    assert str(error.value) == "modes.csv: x = 'far': must be a number."


def test_places_in_lists_count_from_1():
    with pytest.raises(InputError) as error:
        errors.numbers("loads", [1.0, -1.0], above=0.0)
    assert error.value.field == "loads[2]"


@dataclass(frozen=True)
class Example:
    size: Annotated[float, Range(above=0.0, unit="m")]
    place: Annotated[tuple[float, float], Range(unit="m")] = (0.0, 0.0)
    count: Annotated[int, Range(least=1, whole=True)] | None = None
    side: Literal["left", "right"] = "left"
    shown: bool = True
    other: object = None
    noted: Annotated[object, "shape (n,)"] = None

    def __post_init__(self):
        errors.check_fields(self)


def test_a_dataclass_is_held_to_the_types_of_its_fields():
    made = Example(np.float32(2), [1, 2])
    assert (made.size, made.place, made.count) == (2.0, (1.0, 2.0), None)
    assert type(made.size) is float and type(made.place) is tuple
    assert Example(1.0, other=made, noted=made).noted is made
    for given, words in [
        ({"size": 0}, "size = 0: must be a finite number above 0 m"),
        ({"place": [1.0]}, "place = .*must hold 2 numbers"),
        ({"place": [1.0, "x"]}, r"place\[2\] = 'x'"),
        ({"count": 1.5}, "count = 1.5: must be a whole number"),
        ({"count": 0}, "count = 0: .*at least 1"),
        ({"side": "lef"}, "side = 'lef': must be one of left, right. Did you mean 'left'"),
        ({"shown": 1}, "shown = 1: must be true or false"),
    ]:
        with pytest.raises(InputError, match=words):
            Example(**{"size": 1.0, **given})


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_place_that_misses_an_end_by_rounding_is_that_end(sign):
    ends = (0.0, 12.1, 36.6)
    for end in ends:
        assert errors.place("x", end + sign * 1e-12, ends) == end
        assert errors.place("x", end + sign * 3e-8, ends) == end  # 36.6e-9 are rounding
        assert errors.place("x", end + sign * 3e-6, ends, slack=errors.ROUNDED) == end
    inside = 12.1 + sign * 1e-6
    assert errors.place("x", inside, ends) == inside
    assert errors.places("x", [0.0, 36.6 + 1e-9], ends).tolist() == [0.0, 36.6]


@pytest.mark.parametrize("value", [-1e-6, 36.60001, 40, "18", None, np.nan])
def test_a_place_off_the_deck_is_refused_with_digits_enough_to_see_why(value):
    with pytest.raises(InputError, match=r"^x( = |: ).*must be a finite number"):
        errors.place("x", value, (0.0, 36.6))
    with pytest.raises(InputError, match=r"^x\[2\]( = |: )"):
        errors.places("x", [1.0, value], (0.0, 36.6))
    with pytest.raises(InputError, match=r"at most 36\.599999 m"):
        errors.place("x", 36.6, (0.0, 36.599999))


@pytest.mark.parametrize("value", ["18", np.nan, 40.0, -1.0])
def test_a_place_that_is_refused_has_a_unit_and_a_remedy(value):
    said = "must be a finite number( at least 0 and at most 36.6| in) m. Count from the first end."
    remedy = "Count from the first end"
    with pytest.raises(InputError, match=rf"^x( = .*|): {said}$"):
        errors.place("x", value, (0.0, 36.6), remedy=remedy)
    if isinstance(value, float) and np.isfinite(value):
        with pytest.raises(InputError, match=rf"^x\[2\] = .*: {said}$"):
            errors.places("x", [1.0, value], (0.0, 36.6), remedy=remedy)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("plain, \u00fc and \U0001f600", "plain, \u00fc and \U0001f600"),
        ("\x1b[31mred\x07", "\\x1b[31mred\\x07"),
        ("a\nb\t\x7f\x9b", "a\\nb\\t\\x7f\\x9b"),
        ("right\u202eto left\u2066\u2028", "right\\u202eto left\\u2066\\u2028"),
        ("half \udcff", "half \\udcff"),
    ],
)
def test_control_characters_are_shown(text, shown):
    assert errors.printable(text) == shown
    assert shown in str(InputError("a", None, text)) and shown in str(errors.InputWarning("", text))
    assert shown in str(InputError(text, 1, "no", source=text))


def test_representations_fit_into_three_lines():
    @dataclass(frozen=True, repr=False)
    class Inner:
        name: str

        __repr__ = errors.brief

    @dataclass(frozen=True)
    class Outer:
        __repr__ = errors.brief

        a: object
        b: object = 2.0

    assert repr(Outer(np.zeros((3, 4)))) == "Outer(a=<array 3 x 4>, b=2.0)"
    assert repr(Outer([1, 2], Inner("x"))) == "Outer(a=[1, 2], b=Inner('x'))"
    assert repr(Outer(tuple(range(99)), {"k": 1})) == "Outer(a=<99 items>, b=[k: 1])"
    assert repr(Outer("y" * 500)).startswith("Outer(a='yyyy") and len(repr(Outer("y" * 500))) < 100
    assert repr(Outer(Outer(1))) == "Outer(a=Outer(...), b=2.0)"
    long = Outer(*[[Inner("n" * 12)] * 3] * 2)
    assert len(repr(long)) <= 240 and "\n" not in repr(long)


@pytest.mark.parametrize(
    ("key", "shown"), [("", '""'), ("box deck.depth", '"box deck.depth"'), ("a-b_2", "a-b_2")]
)
def test_keys_are_named_as_they_are_written(key, shown):
    with pytest.raises(InputError) as error:
        errors.keys("deck", {key: 1}, ["length"])
    assert str(error.value).startswith(f"deck.{shown}: unknown key")


@pytest.mark.parametrize(
    ("values", "limits", "said"),
    [
        ([1.0, -2.0], {"above": 0.0}, r"x\[2\] = -2.0.*above 0"),
        ([0.5, 1.0, 9.0], {"most": 5.0}, r"x\[3\] = 9.0.*at most 5"),
        ([1.0, np.nan], {}, r"x\[2\] = nan.*finite"),
        ([1.0, 1e31], {}, r"x\[2\].*finite"),
        ([1.0, 2.5], {"whole": True}, r"x\[2\] = 2.5.*whole"),
        ([1e-40, 1.0], {"above": 0.0}, r"x\[1\].*above 0"),
    ],
)
def test_arrays_are_held_to_the_same_limits_as_lists(values, limits, said):
    for given in (values, np.array(values)):
        with pytest.raises(InputError, match=said):
            errors.numbers("x", given, **limits)


def test_arrays_of_numbers_are_taken_whole():
    given = np.array([1e-40, 1.0, 3.0])
    found = errors.numbers("x", given, least=0.0, most=3.0)
    assert found.tolist() == errors.numbers("x", given.tolist()).tolist() == [0.0, 1.0, 3.0]
    assert found is not given and given[0] == 1e-40
    assert errors.numbers("x", np.array([1, 2], dtype=np.int8)).dtype == float
