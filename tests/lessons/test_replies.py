"""What is said of a number: right, or what kind of wrong, never the number itself."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railbridge.lessons.replies import Reply, Verdict, list_reply, number_reply

RIGHT = 1.337


def says(value, expected=RIGHT, **options):
    return number_reply(value, expected, **options).says


@pytest.mark.parametrize("value", [1.337, 1.34, np.float64(1.336), np.array([1.337]), [1.337]])
def test_a_number_within_the_tolerance_is_right(value):
    assert number_reply(value, RIGHT).right


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (-1.0, "the sign is not"),
        (1e3, "a power of ten"),
        (1e-6, "a power of ten"),
        (2 * np.pi, "rad/s"),
        (1 / (2 * np.pi), "rad/s"),
        (3.6, "km/h"),
        (1 / 3.6, "km/h"),
        (9.81, "a mass where a force"),
        (180 / np.pi, "degrees"),
        (2.0, "twice or half"),
        (0.5, "twice or half"),
        (np.sqrt(2), "the root of two off"),
        (np.sqrt(1e3), "kN/m where N/m"),
        (1.2, "too high"),
        (0.8, "too low"),
        (1.02, "a little too high"),
        (5.0, "far too high"),
        (0.3, "far too low"),
        (-1.2, "the sign is wrong, and its size is too large"),
        (-1e3, "the sign is wrong, and the digits are right"),
    ],
)
@pytest.mark.parametrize("expected", [1.337, 1171.0, 4.87e-4])
def test_each_kind_of_wrong_has_its_words(factor, words, expected):
    assert words in says(factor * expected, expected)


def test_a_negative_answer_is_told_by_its_size():
    assert "its size is too large" in says(-45.0, -36.2)
    assert "its size is too small" in says(-30.0, -36.2)
    assert "the size is right, the sign is not" in says(36.2, -36.2)


def test_an_answer_of_zero_has_an_absolute_tolerance():
    assert number_reply(1e-4, 0.0, near=1e-3).right
    assert "too large" in says(0.1, 0.0, near=1e-3)
    assert says(0.0) == "it is not zero."


def test_the_unit_that_is_asked_for_is_said():
    assert "(asked: kN)" in says(2.0, 3.1, unit="kN")
    assert "asked: kN" in says(3100.0, 3.1, unit="kN")
    assert "look at its unit" in says(3100.0, 3.1)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("1.337", "without quotes"),
        ("1,337", "a point before the decimals"),
        ((1, 337), "12.5 with a point"),
        ([1.0, 2.0, 3.0], "these are 3"),
        (True, "True or False"),
        (len, "call it"),
        (1 + 2j, "complex"),
        (float("nan"), "not finite"),
        (float("inf"), "not finite"),
        ({"a": 1}, "a dict"),
        (np.zeros((0,)), "these are 0"),
    ],
)
def test_what_is_no_number_is_told_in_words(value, words):
    reply = number_reply(value, RIGHT)
    assert words in reply.says and not reply.right and reply.given


@pytest.mark.parametrize("value", [None, ...])
def test_dots_are_no_answer_yet(value):
    for reply in (number_reply(value, RIGHT), list_reply(value, (1.0, 2.0))):
        assert not reply.given and not reply.right and "no answer yet" in reply.says
    assert not list_reply([..., None], (1.0, 2.0)).given


def test_a_list_says_which_of_its_numbers_is_wrong():
    reply = list_reply([1.171, 0.7], (1.171, 0.566), ("bounce", "lowest"), unit="Hz")
    assert reply.score == 0.5
    assert reply.says == "1 of 2 right. lowest: too high (asked: Hz)."
    assert "number 1: " in list_reply([9.0, 0.566], (1.171, 0.566)).says
    assert list_reply(np.array([1.171, 0.566]), (1.171, 0.566)).says == "right."


def test_a_list_of_another_length_or_kind_is_told():
    assert "2 numbers are asked for, these are 3" in list_reply([1, 2, 3], (1.0, 2.0)).says
    for value in ("12", 5.0, {1: 2}, len):
        assert "in a list" in list_reply(value, (1.0, 2.0)).says


def test_a_hint_is_for_what_is_not_understood_not_for_slips():
    assert number_reply(2.0, RIGHT).hinted and list_reply([9.0, 2.0], (1.1, 2.0)).hinted
    assert number_reply(2 * RIGHT, RIGHT).hinted and number_reply(RIGHT / 2**0.5, RIGHT).hinted
    slips = (-RIGHT, 1e3 * RIGHT, RIGHT * 2 * np.pi, "x", None, RIGHT)
    assert not any(number_reply(value, RIGHT).hinted for value in slips)


@given(st.floats(-1e6, 1e6), st.floats(0.01, 1e5))
def test_no_wrong_answer_is_told_the_right_one(value, expected):
    expected = float(f"{expected:.4g}")
    reply = number_reply(value, expected, unit="kN")
    assert reply.right or f"{expected:g}" not in reply.says.replace("57.3", "")


def test_a_verdict_is_shown_in_words_and_in_colour():
    verdict = Verdict("1.2", number_reply(2.0, RIGHT, unit="Hz"))
    assert repr(verdict) == "Exercise 1.2: too high (asked: Hz)."
    assert "<b>Exercise 1.2</b>: too high (asked: Hz)." in verdict._repr_html_()
    shown = {Verdict("1.2", number_reply(v, RIGHT))._repr_html_()[:90] for v in (2.0, RIGHT, None)}
    assert len(shown) == 3, "right, wrong and open look different"


def test_what_a_learner_wrote_is_not_obeyed_by_the_browser():
    assert "<b>x" not in Verdict("1.2", Reply(0.0, "it stops with <b>x</b>"))._repr_html_()


def test_what_is_rounded_too_much_is_told_so():
    assert says(1.3) == "close, but rounded too much: give three digits."
    assert number_reply(0.6, 0.616).says == "close, but rounded too much: give three digits."
    four = number_reply(0.616, 0.6163, within=3e-4)
    assert four.says == "close, but rounded too much: give four digits."


@pytest.mark.parametrize(("value", "expected"), [(1.0, 1.337), (1.0, 1.019), (1.0, 1.083)])
def test_what_is_far_off_or_says_no_difference_is_not_called_rounded(value, expected):
    assert number_reply(value, expected).says in ("too low.", "a little too low.")


def test_only_what_may_be_an_amount_is_asked_whether_it_is_one():
    assert "amount" in number_reply(-2.0, 2.0).says
    reply = number_reply(-2.0, 2.0, component=True)
    assert reply.says == "the size is right, the sign is not. Which way counts as positive?"


def test_right_numbers_in_another_order_are_told_so():
    names = ("bounce", "lowest mode")
    reply = list_reply([0.566, 1.171], (1.171, 0.566), names)
    assert reply.says == (
        "the numbers are right, but their order is not. Asked: bounce, lowest mode."
    )
    assert "that of the question" in list_reply([1.0, 2.0, 3.0], (2.0, 3.0, 1.0)).says
    assert "order" not in list_reply([0.566, 0.566], (1.171, 0.566), names).says


def test_each_wrong_number_has_its_own_hint():
    hints = ("Solve (2.2).", "Times 3.6.")
    reply = list_reply([19.2, 50.0], (19.2, 69.2), ("m/s", "km/h"), hints=hints)
    assert reply.says == "1 of 2 right. km/h: too low. Times 3.6."
    assert "Times" not in list_reply([19.2, -69.2], (19.2, 69.2), hints=hints).says


def test_what_is_counted_has_no_unit():
    assert "too high" in says(36, 10, count=True) and "km/h" not in says(36, 10, count=True)
    assert "km/h" not in list_reply([10, 36], (10.0, 10.0), count=True).says


def test_an_amount_has_no_sign():
    assert "an amount" in says(-28.7, 28.7) and "an amount" not in says(36.2, -36.2)


def test_a_verdict_is_headed_by_what_it_is_about():
    right = number_reply(RIGHT, RIGHT)
    assert str(Verdict("12.4", right)) == "Exercise 12.4: right."
    assert str(Verdict("12.guess", right)) == "Guess 12: right."


def test_what_is_wrong_with_several_numbers_is_said_one_after_the_other():
    reply = list_reply([9.0, 1.0], (1.1, 2.7), ("a", "b"))
    assert reply.says == "0 of 2 right. a: far too high. b: far too low."
