"""The page: one file, harmless, the same but for the date."""

import datetime
import re

import pytest
from pageparts import QUICK, Page, assert_harmless

import railbridge as rb
from railbridge.errors import InputError
from railbridge.reports import GENERATOR, Column, Notes, Picture, Report, Section, Table, Words

DAYS = datetime.date(2026, 1, 2), datetime.date(2031, 12, 30)
BAD = '"><img src=x onerror=alert(1)><script>alert(2)</script>&amp;\x1b]8;;$x_2$'
SEEN = BAD.replace("\x1b", "\\x1b")


def hostile():
    """A report whose every text is hostile."""
    svg = '<svg xmlns="http://www.w3.org/2000/svg"/>'
    table = Table.of(BAD, BAD, [(BAD, BAD), Column("v", verdicts=True)], [(BAD, BAD)], note=BAD)
    parts = (Words(BAD), Words(BAD, "warning"), Notes((BAD,)), table, Picture(BAD, svg))
    return Report(BAD, BAD, (Section(BAD, parts),), "not met")


def test_whatever_a_text_says_it_is_a_text():
    page = Page(hostile().html(DAYS[0]))
    known = {"verdict " + SEEN.replace(" ", "-")}
    page.attributes = [a for a in page.attributes if a[2] not in known]
    assert_harmless(page)
    assert page.tags.count("img") == 1 and "script" not in page.tags
    for text in [SEEN] * 9:
        assert text in page.text
    assert page.values("alt") == [SEEN]
    assert "Verdict: not met" in page.text


def test_our_mark_is_in_the_first_kilobyte():
    head = hostile().html()[:1024]
    assert f'<meta name="generator" content="{GENERATOR}">' in head


def test_a_page_of_a_crossing_is_harmless_and_whole(quick_report):
    page = Page(quick_report.html())
    assert_harmless(page)
    assert "default-src 'none'" in page.values("content")[1]
    titles = re.findall("<h2.*?>(.*?)</h2>", page.html)
    assert [t.partition(" ")[2] for t in titles] == [
        "In short", "Verdicts", "Inputs", "Modes of the deck", "Results",
        "Assumptions and limits", "Receipt",
    ]  # fmt: skip
    assert len(page.pictures) > 6
    assert page.html.count("<caption>") == sum(t.on_page for t in quick_report.tables)
    assert "along the deck" in {table.name for table in quick_report.tables if not table.on_page}
    assert len(page.html) < 3e6


def test_made_again_only_the_date_differs(quick, quick_report):
    """From the file again, so that nothing is shared but the input."""
    again = rb.reports.report_of_run(rb.case(QUICK))
    one, other = quick_report.html(DAYS[0]), again.html(DAYS[1])
    stamps = [f"<time>{day.isoformat()}</time>" for day in DAYS]
    assert one.count(stamps[0]) == other.count(stamps[1]) == 1
    assert one.replace(*stamps) == other
    assert one == quick_report.html(DAYS[0])


def test_todays_date_is_taken_and_no_other_kind():
    assert f"<time>{datetime.date.today().isoformat()}</time>" in hostile().html()
    with pytest.raises(InputError, match="date.*datetime.date"):
        hostile().html("today")


def test_own_settings_of_matplotlib_do_not_reach_the_page(quick, quick_report):
    import matplotlib.pyplot as plt

    before = plt.get_fignums()
    with plt.rc_context({"font.size": 30, "lines.linewidth": 9, "svg.hashsalt": "mine"}):
        other = rb.reports.report_of_run(*quick)
    assert other.html(DAYS[0]) == quick_report.html(DAYS[0])
    assert plt.get_fignums() == before


def test_it_is_written_over_its_own_kind_alone(tmp_path, quick_report):
    place = tmp_path / "new" / "page.html"
    assert quick_report.write(place, date=DAYS[0]) == place
    quick_report.write(place, date=DAYS[1])
    assert place.read_text(encoding="utf-8") == quick_report.html(DAYS[1])
    place.write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="path.*no report of railbridge"):
        quick_report.write(place)
    assert place.read_text(encoding="utf-8") == "mine"
    quick_report.write(place, force=True)
    assert place.read_text(encoding="utf-8") != "mine"


def test_the_workbook_has_every_table_once(tmp_path, quick_report):
    openpyxl = pytest.importorskip("openpyxl")
    place = quick_report.write_workbook(tmp_path / "numbers.xlsx")
    quick_report.write_workbook(place)  # one of ours
    book = openpyxl.load_workbook(place)
    assert book.sheetnames == [table.name for table in quick_report.tables]
    for table in quick_report.tables:
        head, *rows = book[table.name].iter_rows(values_only=True)
        assert list(head) == [column.head for column in table.columns]
        assert len(rows) == len(table.rows)
    everything = [c for sheet in book for row in sheet.iter_rows() for c in row]
    assert not [c for c in everything if c.data_type == "f"]


def test_without_the_extra_it_says_which(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "jinja2", None)
    with pytest.raises(InputError, match=r"jinja2 is missing.*railbridge\[report\]"):
        hostile().html()
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(InputError, match=r"openpyxl is missing.*railbridge\[report\]"):
        hostile().write_workbook("numbers.xlsx")


def test_the_room_is_known_by_its_name():
    assert rb.reports.Report is Report
