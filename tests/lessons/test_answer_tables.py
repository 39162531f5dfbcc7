"""The tables of answers: complete, of the kinds there are, and read without loss."""

import re

import numpy as np
import pytest

from railbridge.errors import InputError
from railbridge.lessons import exercise, exercises
from railbridge.lessons.answer_tables import Choice, Exercise, Number, Numbers, Slip, Written
from railbridge.lessons.trials import TRIALS


def test_every_exercise_is_named_after_its_notebook():
    for name in exercises():
        assert re.fullmatch(r"\d{1,2}\.(\d|guess)", name), name


def test_no_reply_of_a_table_gives_the_number_away():
    for name, asked in exercises().items():
        if isinstance(asked.asks, Number):
            said = [asked.hint, *(slip.says for slip in asked.asks.slips)]
            assert not any(f"{asked.asks.number:g}" in text for text in said), name


def test_every_function_that_is_asked_for_has_its_trial():
    asked = {e.asks.function for e in exercises().values() if isinstance(e.asks, Written)}
    assert asked <= TRIALS.keys()


def test_every_letter_of_a_choice_has_its_reply():
    for name, asked in exercises().items():
        if isinstance(asked.asks, Choice):
            wrong = set(asked.asks.of) - {asked.asks.choice}
            assert asked.asks.choice in asked.asks.of and wrong == asked.asks.replies.keys(), name


def test_an_unknown_exercise_is_refused_with_the_nearest():
    with pytest.raises(InputError, match=r"exercise = '1.1x'.*Did you mean '1\.1'"):
        exercise("1.1x")
    with pytest.raises(InputError, match=r'in quotes.*rb.check\("1.1"'):
        exercise(1.1)
    with pytest.raises(InputError, match="is no exercise"):
        exercise(None)
    with pytest.raises(InputError, match=r"Did you mean '1\.guess'"):
        exercise("guess_1")


def test_a_known_slip_has_its_own_words():
    asked = Number(1.337, "Hz", slips=(Slip(1.451, "that is the secondary springs alone."),))
    assert asked.reply(1.451).says == "that is the secondary springs alone."
    assert "too high" in asked.reply(1.6).says and asked.reply(1.337).right
    assert not asked.reply(...).given


def test_a_known_slip_in_a_list_takes_the_place_of_the_hint():
    slips = (Slip(1.2138, "That is yaw."),)
    asked = Numbers((0.6163, 1.2119), hints=("Softer.", "Beside yaw."), slips=slips, within=3e-4)
    assert asked.reply([0.6163, 1.2138]).says.endswith("That is yaw.")
    assert asked.reply((0.7, 1.5)).says.endswith("Beside yaw.")
    assert not asked.reply(...).given and not asked.reply([..., ...]).given
    for kind in ("12", 5.0, [1.0], np.zeros(3)):
        assert not asked.reply(kind).right


def test_a_choice_is_a_letter():
    asked = Choice("b", "abc", {"a": "not a: the spring is soft."})
    assert asked.reply("B").right and asked.reply(" (b) ").right
    assert asked.reply("a").says == "not a: the spring is soft."
    assert asked.reply("c").says == "not right."
    assert not asked.reply(...).given and not asked.reply("").given
    for value in ("d", "", "ab", 2, None, np.zeros(3), ["b"]):
        assert not asked.reply(value).right
    assert "in quotes" in asked.reply(np.zeros(3)).says
    assert "one of the letters a, b, c" in asked.reply("d").says


def test_words_are_added_to_right_and_to_wrong():
    asked = Exercise("9.1", Numbers((1.0, 2.0)), right="Well seen.", hint="Look at (9.1).")
    assert asked.reply([1.0, 2.0]).says == "right. Well seen."
    assert asked.reply([1.0, 9.0]).says.endswith("Look at (9.1).")
    assert "Look" not in asked.reply(...).says and "Look" not in asked.reply("x").says


def test_an_answer_has_a_variable_of_its_own():
    assert Exercise("1.2", Number(1.0)).variable == "answer_1_2"
    assert Exercise("3.guess", Choice("a", "ab", {})).variable == "guess_3"
    assert Exercise("3.4", Written("condense")).variable == "condense"
    names = [asked.variable for asked in exercises().values()]
    assert len(names) == len(set(names))


def test_hints_and_counts_of_a_list_are_used():
    asked = Numbers((10.0, 25.0), ("plain", "half"), ("Look at (6.4).", "Slower."), count=True)
    assert asked.reply([36, 25]).says == "1 of 2 right. plain: far too high. Look at (6.4)."
    assert asked.reply([11, 26]).says.count(" Slower.") == 1


def test_a_guess_earns_no_marks_and_everything_else_does():
    for name, asked in exercises().items():
        assert asked.marks == 0 if name.endswith("guess") or name == "0.1" else asked.marks > 0


def test_a_mass_that_breaks_the_limit_is_no_answer_to_7_2():
    """A4 reaches 17.030 m/s2 on 15 t/m at the speeds of Figure 7.6, 17.124 between them."""
    for mass, right in ((72.8, False), (72.95, False), (73.0, True), (73.4, True), (74.0, True)):
        assert exercise("7.2").reply(mass).right == right
        assert not right or 15.0 * 17.030 / mass <= 3.5
    assert not exercise("7.2").reply(75.0).right  # it is the least that is asked for


def test_a_speed_in_km_h_is_named_where_lengths_are_asked_for():
    says = exercise("7.1").reply([60 / 3.6 / 3.307, 60 / 1.334]).says
    assert "is a speed in km/h where m/s belongs" in says
