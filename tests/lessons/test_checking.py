"""The call below an exercise."""

import pytest

import railbridge as rb
from railbridge.errors import InputError
from railbridge.lessons import WrongAnswer


def test_an_exercise_answers():
    assert rb.check("1.1", 1.337).right
    assert str(rb.check("1.1", -1.337)).startswith("Exercise 1.1: the size is right")
    assert str(rb.check("1.1", ...)).startswith("Exercise 1.1: no answer yet")
    assert str(rb.check("1.1")).startswith("Exercise 1.1: no answer yet")


def test_an_unknown_exercise_is_refused():
    with pytest.raises(InputError, match="is no exercise"):
        rb.check("77.1", 3.0)


@pytest.mark.parametrize("mode", ["autograde", "validate"])
def test_a_grading_program_sees_a_wrong_answer_fail(monkeypatch, mode):
    monkeypatch.setenv("NBGRADER_EXECUTION", mode)
    assert rb.check("1.1", 1.337) == 1.0
    assert rb.check("99.2", [2.0e6, 1.0]) == 0.5
    for value in (2.0, ..., "1.337"):
        with pytest.raises(WrongAnswer, match=r"Exercise 1\.1"):
            rb.check("1.1", value)
