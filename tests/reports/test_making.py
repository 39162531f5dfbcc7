"""Whole reports: of hostile files, of what did not converge, of trains over speeds."""

import datetime
from pathlib import Path

import pytest
from pageparts import QUICK, Page, assert_harmless

import railbridge as rb
from railbridge.codes import Verdicts, acceleration_limit, judge, phi2
from railbridge.crossing import NotConvergedError
from railbridge.errors import InputError, InputWarning

DAY = datetime.date(2026, 1, 2)
DATA = Path(rb.data_root())
BAD = '"><img src=x onerror=alert(1)><script>alert(2)</script> $x_2$ {{ 7*7 }}'
TOML = BAD.replace("\\", "\\\\").replace('"', '\\"')

DECK = f"""
name = "{TOML} deck"
source = "{TOML} source"
note = "{TOML} note"
length = 12.0
bending_stiffness_vertical = 5e9
mass = 8000.0
damping = {{ modal = 0.02 }}
modes = 3
[tracks]
"{TOML}" = 0.0
"""
CAR = f"""
name = "{TOML} car"
source = "{TOML} source"
note = "=1+1"
length = 10.0
[[body]]
name = "{TOML} body"
mass = 5750.0
position = [0.0, 0.0, 1.0]
freedoms = ["z"]
[[spring]]
from = "{TOML} body"
to = "rail"
at = [0.0, 0.0, 0.0]
stiffness = [0.0, 1595e3]
damping = [0.0, 0.0]
"""


@pytest.fixture
def hostile(tmp_path):
    """A case of files whose every name is hostile, file names included."""
    deck, car = tmp_path / "<b onclick=x> $d$.toml", tmp_path / "=1+1 <i>.toml"
    deck.write_text(DECK, encoding="utf-8")
    car.write_text(CAR, encoding="utf-8")
    changes = {
        "deck": {"file": str(deck)}, "train": {"vehicle": str(car), "cars": 2, "track": BAD},
        "run.time_step": 4e-3,
    }  # fmt: skip
    return rb.case(QUICK, changes)


def test_hostile_names_are_letters(hostile, tmp_path):
    found = rb.reports.report(hostile, tmp_path / "page.html", workbook=tmp_path / "n.xlsx")
    page = Page((tmp_path / "page.html").read_text(encoding="utf-8"))
    assert_harmless(page)
    for name in ("deck", "source", "note", "car", "body"):
        assert f"{BAD} {name}" in page.text, name
    assert "{{ 7*7 }}" in page.text and "49" not in page.texts
    assert "<b onclick=x> $d$.toml" in page.text and str(tmp_path) not in page.html
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.load_workbook(tmp_path / "n.xlsx")
    cells = [c for sheet in book for row in sheet.iter_rows() for c in row if c.value is not None]
    assert not [c for c in cells if c.data_type == "f"]
    risky = [c for c in cells if str(c.value).startswith("=")]
    assert risky and all(c.quotePrefix for c in risky)
    assert found.title.endswith("<b onclick=x> $d$")


def test_hostile_rows_of_a_table_of_a_car_are_letters(tmp_path):
    car = tmp_path / "car.csv"
    text = (DATA / "vehicles/xia2000.csv").read_text(encoding="utf-8")
    quoted = BAD.replace('"', '""')
    text = text.replace('"Amaral & Mazzilli 2016, Table 1"', f'"{quoted}"')
    car.write_text(text.replace("per damper", "=1+1"), encoding="utf-8")
    changes = {"train.vehicle": str(car), "train.cars": 1, "run.interaction": "rigid"}
    case = rb.case("paper", changes)
    page = Page(rb.reports.report_of_run(case).html())
    assert_harmless(page)
    assert BAD in page.text and "=1+1" in page.text


def test_a_report_of_a_case_is_computed_and_written(tmp_path, quick, quick_report):
    page, book = tmp_path / "page.html", tmp_path / "numbers.xlsx"
    found = rb.reports.report(rb.case(QUICK), page, workbook=book, date=DAY)
    assert page.read_text(encoding="utf-8") == quick_report.html(DAY) == found.html(DAY)
    assert book.exists()
    again = rb.reports.report(found, tmp_path / "again.html", date=DAY)
    assert again is found and (tmp_path / "again.html").read_bytes() == page.read_bytes()


def test_somebody_elses_files_are_met_before_anything_is_computed(tmp_path, monkeypatch):
    monkeypatch.setattr(rb.Case, "compute", None)
    (tmp_path / "mine.html").write_text("mine", encoding="utf-8")
    (tmp_path / "mine.xlsx").write_text("mine", encoding="utf-8")
    case = rb.case(QUICK)
    with pytest.raises(InputError, match="path.*no report"):
        rb.reports.report(case, tmp_path / "mine.html")
    with pytest.raises(InputError, match="workbook.*no report"):
        rb.reports.report(case, tmp_path / "new.html", workbook=tmp_path / "mine.xlsx")


def test_the_first_page_says_what_came_out(quick, quick_report):
    case, run = quick
    first, *_ = quick_report.sections
    table = next(p for p in first.parts if p.kind == "table")
    low, _ = run.displacement(6.0).extreme("displacement_z")
    assert table.rows[0][1] == pytest.approx(1e3 * low, rel=0.02)
    assert quick_report.about == "1 x xia2000_planar over deck, 12 m, at 40 m/s (144 km/h)"
    assert quick_report.verdict == ""


def test_verdicts_and_rules_come_in(quick):
    case, run = quick
    verdicts = Verdicts([judge(9.0, acceleration_limit("ballasted"), where=6.0)])
    made = rb.reports.report_of_run(
        case, run, verdicts=verdicts, rules={"phi2": phi2(12.0)}, title="Bridge 7"
    )
    page = Page(made.html())
    assert "Verdict: not met" in page.text and "Bridge 7" in page.text
    assert "banner verdict not-met" in page.values("class")
    assert "phi2" in page.text and "No limits" not in page.text


def test_what_did_not_converge_says_so_first():
    case = rb.case(QUICK, {"run.max_iterations": 1, "run.tolerance": 1e-12})
    with pytest.raises(NotConvergedError):
        case.compute()
    page = Page(rb.reports.report_of_run(case).html())
    assert "The iteration did not converge: these numbers are not a solution." in page.text
    assert page.text.index("did not converge") < page.text.index("The largest values")
    given = rb.case(QUICK, {"run.iterations": 1})
    assert "not a solution" not in Page(rb.reports.report_of_run(given).html()).text


def test_doubts_and_remarks_stand_in_the_report():
    doubtful = rb.case(QUICK, {"deck.mass": 80.0})
    run = doubtful.replace({"run.interaction": "rigid"}).compute()
    warned = [str(r) for r in doubtful.remarks(run) if r.warned]
    assert warned
    page = Page(rb.reports.report_of_run(doubtful, run).html())
    for remark in warned:
        assert " ".join(remark.split()) in page.text
    assert "Doubts and warnings" in page.text and "warning" in page.values("class")


@pytest.fixture(scope="module")
def over_speeds():
    case = rb.case(QUICK, {"track": None})
    names = {name: rb.train(name) for name in ("ICE2", "HSLM-A1")}
    tables = {name: {"name": name} for name in names}
    found = rb.speed_envelope(case.deck, names, [40.0, 50.0])
    return case, names, tables, found


def test_trains_over_speeds(over_speeds):
    case, names, tables, found = over_speeds
    doubt = InputWarning("run.speed", "= 50 m/s is doubted.")
    made = rb.reports.report_of_envelope(case, names, found, tables=tables, doubts=[doubt])
    page = Page(made.html(DAY))
    assert_harmless(page)
    assert made.about.startswith("ICE2 and HSLM-A1 over deck, 12 m, at 2 speeds from 40 m/s")
    assert "is doubted" in page.text
    sheets = {table.name: table for table in made.tables}
    assert {"speeds", "trains", "peaks acceleration_z", "all numbers"} <= sheets.keys()
    assert "case train" not in sheets
    assert [row[0] for row in sheets["trains"].rows] == ["ICE2", "HSLM-A1"]
    assert ("train ICE2", "ICE2.csv") in [row[:2] for row in sheets["inputs"].rows]
    again = rb.reports.report_of_envelope(case, names, found, tables=tables, doubts=[doubt])
    assert again.html(DAY) == page.html


def test_other_studies_are_not_taken_for_speeds(over_speeds):
    case, names, _, found = over_speeds
    with pytest.raises(InputError, match="not over train and speed"):
        rb.reports.report_of_envelope(case, names, found.isel(train=0))


def test_a_study(tmp_path):
    case = rb.case(QUICK)
    over = {"run.speed": [30.0, 40.0], "deck.mass": [8000.0, 9000.0]}
    found = rb.sweep(case, over)
    study = {"case": str(QUICK), "over": over}
    made = rb.reports.report_of_study(case, found, study=study)
    page = Page(made.html(DAY))
    assert_harmless(page)
    assert made.about.endswith("4 crossings, 2 speed x 2 mass")
    other = rb.reports.report_of_study(case, found, study={**study, "case": "other.toml"})
    digests = [next(t for t in m.tables if t.name == "inputs").rows[0][3] for m in (made, other)]
    assert digests[0] != digests[1]
    assert page.html == rb.reports.report_of_study(case, found, study=study).html(DAY)


def test_names_of_trains_in_a_study_are_letters():
    case = rb.case(QUICK, {"track": None})
    trains = {BAD: {"name": "ICE2"}, "$b$": {"name": "HSLM-A1"}}
    found = rb.sweep(case, {"run.speed": [40.0, 50.0]}, trains)
    made = rb.reports.report_of_study(case, found, study={"case": "x", "trains": trains})
    page = Page(made.html())
    assert_harmless(page)
    assert BAD in page.text


def test_a_run_is_not_computed_twice(quick, monkeypatch):
    case, run = quick
    monkeypatch.setattr(rb.Case, "compute", None)
    assert rb.reports.report_of_run(case, run).title == "Train on a bridge: deck"


def test_wrong_things_are_refused(quick):
    with pytest.raises(InputError, match="case.*must be a Case"):
        rb.reports.report_of_run("paper")
    with pytest.raises(InputError, match="run.*must be a Crossing"):
        rb.reports.report_of_run(quick[0], "run")
