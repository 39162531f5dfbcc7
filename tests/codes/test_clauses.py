"""Answers and clauses: what is undecided never passes for a number, ranges at their bounds."""

import math

import numpy as np
import pytest

import railbridge as rb
from railbridge.codes import Answer, CannotDecideError, Clause, Within
from railbridge.codes.clauses import EDITION, by_clause, not_above, outside

RULE = Clause("height", "EN 1", "2.3", "m", "two")


def clause(**changed):
    return Clause(**{**vars(RULE), **changed})


def test_a_number():
    answer = Answer(np.float64(2.5), RULE)
    assert float(answer) == 2.5 and type(answer.value) is float
    assert answer.decided and answer.unit == "m"
    assert math.sqrt(answer) == pytest.approx(2.5**0.5)
    with pytest.raises(TypeError, match=r"height: the answer is a number; use float"):
        bool(answer)
    assert repr(answer) == f"<height: 2.5 m; EN 1, 2.3, {EDITION} [two sources or more agree]>"


def test_yes_and_no():
    yes, no = Answer(True, RULE, "so it is"), Answer(False, RULE)
    assert bool(yes) is True and bool(no) is False and no.decided
    with pytest.raises(TypeError, match="yes or no; use bool"):
        float(no)
    assert "height: yes (so it is);" in repr(yes) and "height: no;" in repr(no)


def test_undecided_is_neither():
    answer = Answer(None, RULE, "too far")
    assert not answer.decided
    for use in (float, bool, math.sqrt):
        with pytest.raises(CannotDecideError, match="^height: cannot decide: too far$") as error:
            use(answer)
        assert error.value.answer is answer
    assert "height: cannot decide (too far);" in repr(answer)


@pytest.mark.parametrize("value", [np.nan, np.inf, "2", [2.0]])
def test_an_answer_is_a_finite_number(value):
    with pytest.raises(rb.InputError, match=r"^value\b.*finite number"):
        Answer(value, RULE)


def test_an_undecided_answer_has_a_reason_and_all_a_clause():
    with pytest.raises(rb.InputError, match="^reason"):
        Answer(None, RULE)
    with pytest.raises(rb.InputError, match="^clause"):
        Answer(1.0, "EN 1")


def test_memory_is_named():
    assert clause(grade="memory").source == "from memory, not seen"
    assert clause(grade="one", memory="its bound").source == "one source; from memory: its bound"
    assert "[from memory, not seen]" in repr(Answer(1.0, clause(grade="memory")))


@pytest.mark.parametrize(
    ("field", "value"),
    [("grade", "three"), ("sense", "below"), ("title", ""), ("code", None), ("ranges", [1])],
)
def test_clauses_are_checked(field, value):
    with pytest.raises(rb.InputError, match=rf"^{field}\b"):
        clause(**{field: value})


@pytest.mark.parametrize(
    ("known", "inside", "beyond", "words"),
    [
        (Within("L", least=4.0, unit="m"), (4.0, 4.1), (3.99,), "4 m <= L"),
        (Within("L", most=4.0, unit="m"), (4.0, -1.0), (4.01,), "L <= 4 m"),
        (Within("L", above=4.0), (4.01, 1e9), (4.0, 3.0), "4 < L"),
        (Within("L", below=4.0), (3.99,), (4.0, 5.0), "L < 4"),
        (Within("v", 10, 20, unit="m/s"), (10, 20), (9.9, 20.1),
         "10 m/s (36 km/h) <= v <= 20 m/s (72 km/h)"),
        (Within("x"), (0.0, 1e9, -1e9), (), "x"),
    ],
)  # fmt: skip
def test_ranges(known, inside, beyond, words):
    assert all(map(known.holds, inside)) and not any(map(known.holds, beyond))
    assert str(known) == words


def test_rounding_does_not_leave_a_range():
    speed = Within("v", most=120 / 3.6)
    assert 0.1 * 1200 / 3.6 > 33.3 and speed.holds(120 / 3.6 * (1 + 1e-15))
    assert not speed.holds(120 / 3.6 * (1 + 1e-8))
    opened = Within("L", below=0.3)
    assert 0.1 + 0.2 > 0.3 and not opened.holds(0.1 + 0.2) and not opened.holds(0.3 * (1 - 1e-15))
    assert not_above(0.0, 0.0) and not not_above(1e-300, 0.0) and not_above(-5.0, -5.0)


def test_the_reason_names_argument_and_clause():
    rule = clause(ranges=(Within("L", most=9.0, unit="m"), Within("v", most=20.0, unit="m/s")))
    assert outside(rule, L=9.0, v=20.0) == ""
    assert outside(rule, L=9.5, v=99.0) == "L = 9.5 m is outside L <= 9 m of EN 1, 2.3"
    said = "v = 25 m/s (90 km/h) is outside v <= 20 m/s (72 km/h) of EN 1, 2.3"
    assert outside(rule, L=1.0, v=25.0) == said
    assert rule.validity == "L <= 9 m; v <= 20 m/s (72 km/h)"
    assert clause(conditions="dry").validity == "dry" and RULE.validity == "no bounds known"


def test_a_docstring_tells_of_the_clause():
    @by_clause(RULE)
    def first():
        """Return it."""

    @by_clause(RULE)
    def second():
        """Return it.

        Notes
        -----
        Wrong in rain.
        """

    said = f"EN 1, 2.3, {EDITION}.\nUnit: m.\nValid: no bounds known.\nSource: two sources or more"
    assert first.clause is RULE and f"Return it.\n\nNotes\n-----\n{said}" in first.__doc__
    assert f"-----\nWrong in rain.\n\n{said}" in second.__doc__
    assert second.__doc__.count("Notes") == 1
