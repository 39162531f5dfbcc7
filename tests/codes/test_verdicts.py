"""Verdicts: both sides of a limit, what is unknown never passes, and the table."""

import dataclasses

import numpy as np
import pandas as pd
import pytest

import railbridge as rb
from railbridge import codes
from railbridge.codes import Answer, Verdict, Verdicts, judge

BALLAST = codes.acceleration_limit("ballasted")
UNKNOWN = Answer(None, BALLAST.clause, "no such track")
NO_VALUE = codes.n0_bounds(3.0).lower


@pytest.mark.parametrize(
    ("value", "verdict", "utilisation"),
    [
        (0.0, "met", 0.0),
        (2.1, "met", 0.6),
        (3.5, "met", 1.0),
        (0.7 * 5, "met", 1.0),
        (3.5 * (1 + 1e-12), "met", 1.0),
        (3.5001, "not met", 3.5001 / 3.5),
        (-3.6, "not met", 3.6 / 3.5),
        (np.float64(-1.75), "met", 0.5),
        (7, "not met", 2.0),
    ],
)
def test_at_most(value, verdict, utilisation):
    found = judge(value, BALLAST)
    assert found.verdict == verdict
    assert found.utilisation == pytest.approx(utilisation, rel=1e-11)
    assert found.value == value and found.limit == 3.5 and found.clause is BALLAST.clause


@pytest.mark.parametrize(
    ("value", "verdict", "utilisation"),
    [(2.4, "met", 0.5), (1.2, "met", 1.0), (1.1999, "not met", 1.2 / 1.1999),
     (-5.0, "not met", np.inf), (0.0, "not met", np.inf)],
)  # fmt: skip
def test_at_least(value, verdict, utilisation):
    found = judge(value, codes.lateral_frequency_limit())
    assert found.verdict == verdict and found.utilisation == pytest.approx(utilisation)


def test_a_wheel_that_is_loaded_more_is_not_unloaded():
    limit = codes.wheel_unloading_limit()
    found = [judge(x, limit) for x in (-0.9, 0.3, 0.6, 0.61)]
    assert [row.verdict for row in found] == ["met", "met", "met", "not met"]
    assert [row.utilisation for row in found] == pytest.approx([0.0, 0.5, 1.0, 0.61 / 0.6])


def test_uplift_has_no_utilisation():
    limit = codes.uplift_limit()
    assert [judge(x, limit).verdict for x in (1e3, 0.0, -1e-3)] == ["met", "met", "not met"]
    assert judge(1e3, limit).utilisation is None


@pytest.mark.parametrize(
    ("value", "reason"),
    [(None, "the value is not known"), (np.nan, "not a finite number"), (np.inf, "not a finite"),
     (-np.inf, "not a finite"), (1e31, "not a finite")],
)  # fmt: skip
def test_what_is_not_known_is_not_met(value, reason):
    found = judge(value, BALLAST)
    assert found.verdict == "cannot decide" and found.utilisation is None
    assert found.value is None and reason in found.reason
    told = judge(value, BALLAST, reason="this deck gives no accelerations")
    assert told.reason.startswith("this deck gives no accelerations; ")


def test_an_undecided_limit_or_answer_is_not_met():
    found = judge(0.0, UNKNOWN)
    assert found.verdict == "cannot decide" and found.reason == "no limit: no such track"
    assert found.limit is None and found.value == 0.0
    found = judge(NO_VALUE, codes.lateral_frequency_limit())
    assert found.verdict == "cannot decide" and "L = 3 m is outside" in found.reason
    both = judge(None, UNKNOWN)
    assert both.reason == "the value is not known; no limit: no such track"


def test_a_value_by_a_rule_keeps_its_source():
    value = codes.frequency_from_deflection(0.01)
    found = judge(value, codes.lateral_frequency_limit())
    assert found.verdict == "met" and found.value == float(value)
    assert found.value_clause is value.clause
    assert found.source.endswith("value (frequency from the deflection): " + value.clause.source)
    memory = Answer(2.0, codes.frequency_limit([1, 2, 3]).clause)
    assert "from memory, not seen" in judge(memory, codes.lateral_frequency_limit()).source


def test_no_verdict_can_be_made_by_hand():
    found = judge(9.0, BALLAST)
    with pytest.raises(dataclasses.FrozenInstanceError):
        found.value = 1.0
    with pytest.raises(AttributeError):
        found.verdict = "met"
    with pytest.raises(TypeError):
        Verdict(BALLAST.clause, 3.5, 9.0, verdict="met")
    with pytest.raises(rb.InputError, match="^reason"):
        Verdict(BALLAST.clause, None, 1.0)
    with pytest.raises(rb.InputError, match=r"^clause\b.*must be that of a limit"):
        Verdict(codes.phi2(10.0).clause, 1.0, 1.0)


@pytest.mark.parametrize("value", ["2", True, [2.0], np.array([1.0, 2.0])])
def test_a_value_is_a_number(value):
    with pytest.raises(rb.InputError, match=r"^value\b"):
        judge(value, BALLAST)


def test_values_in_another_unit_and_limits_that_are_none_are_refused():
    with pytest.raises(rb.InputError, match=r"^value\b.*must be in m/s2, as deck acc.*It is in Hz"):
        judge(codes.n0_bounds(10.0).lower, BALLAST)
    need = codes.dynamic_analysis_needed(10.0, 10.0, 20.0)
    with pytest.raises(rb.InputError, match=r"^value\b.*must be a number. It is yes or no"):
        judge(need, codes.wheel_unloading_limit())
    with pytest.raises(rb.InputError, match=r"^limit\b.*must be a number"):
        judge(1.0, need)
    with pytest.raises(rb.InputError, match=r"^limit\b.*must be a Answer|^limit\b"):
        judge(1.0, 3.5)
    with pytest.raises(rb.InputError, match=r"^clause\b.*limit"):
        judge(1.0, codes.phi2(10.0))
    for field in ("where", "when"):
        with pytest.raises(rb.InputError, match=rf"^{field}\b"):
            judge(1.0, BALLAST, **{field: np.nan})


def test_a_line_says_all():
    text = repr(judge(-4.2, BALLAST, where=18, when="ICE2 at 62.5 m/s", reason="mode 3 left out"))
    for part in (
        "deck acceleration: not met", "-4.2, at most 3.5 m/s2", "utilisation 1.2", "at 18 m",
        "when ICE2 at 62.5 m/s", "mode 3 left out", "EN 1990, A2.4.4, edition 2003 (with 2005 A1)",
        "two sources",
    ):  # fmt: skip
        assert part in text
    assert "?, at most 0.6" in repr(judge(None, codes.wheel_unloading_limit()))
    assert "from memory, not seen" in repr(judge(0.1, codes.wheel_unloading_limit()))
    assert "when 1.25 s" in repr(judge(0.1, BALLAST, when=1.25))


def test_the_table():
    rows = [
        judge(2.1, BALLAST, where=18.0, when=1.2),
        judge(None, codes.wheel_unloading_limit(), where="car 3, wheel 2"),
        judge(1e3, codes.uplift_limit()),
    ]
    frame = Verdicts(rows).to_frame()
    assert list(frame["verdict"]) == ["met", "cannot decide", "met"]
    assert list(frame.columns[:7]) == [
        "what", "value", "sense", "limit", "unit", "utilisation", "verdict",
    ]  # fmt: skip
    assert list(frame["where"])[:2] == [18.0, "car 3, wheel 2"] and pd.isna(frame["where"][2])
    assert np.isnan(frame["value"][1]) and np.isnan(frame["utilisation"][2])
    assert frame["utilisation"][0] == pytest.approx(0.6)
    assert frame["source"][1] == "from memory, not seen"
    assert frame["edition"][0] == "edition 2003 (with 2005 A1)"
    assert rows[0].to_frame().equals(Verdicts(rows[:1]).to_frame())
    assert list(Verdicts().to_frame().columns) == list(frame.columns)


@pytest.mark.parametrize(
    ("values", "verdict"),
    [([1.0, 2.0], "met"), ([1.0, None], "cannot decide"), ([None, 9.0, 1.0], "not met"),
     ([], "cannot decide")],
)  # fmt: skip
def test_all_in_one_word(values, verdict):
    found = Verdicts([judge(value, BALLAST) for value in values])
    assert found.verdict == verdict and len(found) == len(values)
    assert [row.value for row in found] == values


def test_rows_are_verdicts():
    with pytest.raises(rb.InputError, match=r"^rows\[2\]"):
        Verdicts([judge(1.0, BALLAST), "met"])
