"""Verdicts in a report: worded and coloured, with clause, edition and how well it is known."""

import pytest
from pageparts import QUICK, Page

import railbridge as rb
from railbridge import codes
from railbridge.codes import Verdicts, judge
from railbridge.reports import Report
from railbridge.reports.judgements import (
    judged_over_speeds,
    judged_run,
    requirements_table,
    verdicts_section,
)

VERDICTS = Verdicts([
    judge(2.1, codes.acceleration_limit("ballasted"), where=18.0, when="ICE2 at 62.5 m/s"),
    judge(4.2, codes.acceleration_limit("ballasted"), where=18.0, when=3.25),
    judge(None, codes.twist_limit(50.0), reason="the deck has no twist"),
    judge(0.01, codes.deflection_limit(36.0)),
    judge(9000.0, codes.horizontal_radius_limit(50.0)),
])  # fmt: skip


def page(section):
    return Page(Report("t", "a", (section,), "not met").html())


def test_all_that_is_known_of_a_verdict_stands_there():
    section = verdicts_section(VERDICTS)
    table = section.parts[2]
    heads = [column.head for column in table.columns]
    rows = [dict(zip(heads, row, strict=True)) for row in table.rows]
    assert rows[0] == {
        "what": VERDICTS.rows[0].clause.title, "verdict": "met",
        "value": 2.1, "sense": "at most", "limit": 3.5, "unit": "m/s²",
        "utilisation": pytest.approx(0.6), "where": "x = 18 m", "when": "ICE2 at 62.5 m/s",
        "remark": None,
        "clause": VERDICTS.rows[0].clause.name, "edition": VERDICTS.rows[0].clause.edition,
        "how well it is known": VERDICTS.rows[0].source,
    }  # fmt: skip
    assert rows[1]["verdict"] == "not met" and rows[1]["when"] == "t = 3.25 s"
    assert rows[2]["verdict"] == "cannot decide" and rows[2]["value"] is None
    assert rows[2]["remark"] == "the deck has no twist; the value is not known"
    assert (rows[3]["value"], rows[3]["limit"], rows[3]["unit"]) == (10.0, 60.0, "mm")
    assert (rows[4]["limit"], rows[4]["unit"]) == (6000.0, "m")


def test_on_the_page_numbers_have_their_units():
    rows = verdicts_section(VERDICTS).parts[0].rows
    clause = VERDICTS.rows[0].clause
    assert rows[0] == (
        f"{clause.title} ({clause.name})", "met", "2.1 m/s²", "at most 3.5 m/s²",
        pytest.approx(0.6),
        "x = 18 m; ICE2 at 62.5 m/s", None,
    )  # fmt: skip
    assert rows[3][2:4] == ("10 mm", "at most 60 mm") and rows[4][3] == "at least 6000 m"
    assert rows[2][2] is None and rows[2][5] is None


def test_how_much_is_used_is_drawn_the_same_again():
    pictures = [verdicts_section(VERDICTS).parts[1] for _ in range(2)]
    assert pictures[0].kind == "picture" and pictures[0] == pictures[1]


def test_verdicts_are_words_and_colours():
    read = page(verdicts_section(VERDICTS))
    looks = [value for value in read.values("class") if value.startswith("verdict")]
    assert looks == [
        "verdict met", "verdict not-met", "verdict cannot-decide", "verdict met", "verdict met",
    ]  # fmt: skip
    for words in ("not met", "cannot decide", "the deck has no twist"):
        assert words in read.text


def test_each_clause_stands_once_with_edition_and_grade():
    clauses = verdicts_section(VERDICTS).parts[3]
    assert len(clauses.rows) == 4
    first = VERDICTS.rows[0].clause
    assert clauses.rows[0] == (
        first.name, first.title, first.edition, first.validity.replace("`", ""),
        first.source,
    )  # fmt: skip


def test_the_rule_of_a_value_is_a_clause_too():
    value = codes.Answer(2.0, codes.kept_modes([1.0, 2.0, 3.0]).limit.clause)
    verdict = codes.Verdict(codes.acceleration_limit("ballasted").clause, 3.5, 2.0,
                            value_clause=value.clause)  # fmt: skip
    clauses = verdicts_section(Verdicts([verdict])).parts[3]
    assert [row[1] for row in clauses.rows] == [verdict.clause.title, value.clause.title]


def test_rules_answer_in_words():
    rules = {
        "need": codes.dynamic_analysis_needed(36.0, 3.3, 40.0),
        "open": codes.dynamic_analysis_needed(36.0, 3.3, 40.0, simple=False),
        "factor": codes.phi2(20.0),
    }
    table = verdicts_section(None, rules).parts[-1]
    rows = {row[0]: row[1:] for row in table.rows}
    assert rows["need"][0] is False and rows["open"][0] == "cannot decide"
    assert rows["open"][2] == "the structure is not a simple one"
    assert abs(rows["factor"][0] - 1.1571) < 1e-4
    assert "no" in page(verdicts_section(None, rules)).text


def test_without_limits_it_says_how_to_ask():
    (words,) = verdicts_section(None).parts
    assert "No limits" in words.text and "[checks]" in words.text
    (words,) = verdicts_section(Verdicts()).parts
    assert "No limit applies" in words.text


@pytest.fixture(scope="module")
def asking():
    return rb.case(QUICK, {"checks": {"line_speed": 40.0}, "track": None})


def test_a_case_without_checks_is_not_judged(quick):
    case, run = quick
    assert judged_run(case, run) is None
    assert judged_over_speeds(case, {"t": case.train}, [40.0]) is None


def test_a_run_is_judged_by_what_its_case_asks_for(asking):
    run = asking.compute()
    assert judged_run(asking, run) == rb.assess_run(run, asking.requirements)


def test_trains_are_judged_on_the_track_and_with_the_choices_of_the_case():
    case = rb.case(QUICK, {"checks": {"line_speed": 40.0}})
    trains = {"own": case.train, "ICE2": rb.train("ICE2")}
    found = judged_over_speeds(case, trains, [40.0])
    own = {k: v for k, v in case.options.items() if k != "speed"}
    known = rb.assess(case.deck, trains, [40.0], case.requirements, track=case.track, **own)
    assert found.verdicts == known.verdicts
    section = verdicts_section(found.verdicts, found.rules, found)
    table = next(p for p in section.parts if getattr(p, "name", "") == "verdicts of trains")
    assert {row[0] for row in table.rows} == {"own", "ICE2"}
    of_own = {row[1]: row for row in table.rows if row[0] == "own"}
    frame = known.per_train().loc["own"]
    assert of_own["deck acceleration"][3] == pytest.approx(frame.loc["deck acceleration", "value"])
    assert of_own["deck acceleration"][6:] == (40.0, pytest.approx(144.0))


def test_what_the_codes_were_told_has_meanings(asking):
    rows = {row[0]: row[1:] for row in requirements_table(asking.requirements).rows}
    assert rows["line_speed"][0] == "40" and rows["line_speed"][1].startswith("Largest speed")
    assert rows["kind"][0] == "-" and all(about for _, about in rows.values())
