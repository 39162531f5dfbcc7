"""The command `report`: what it writes and says, and what it refuses before it computes."""

import os
import re
import shutil
from pathlib import Path

import pytest

import railbridge as rb
from railbridge.commands import command as cli
from railbridge.commands import reporting
from railbridge.studies import engine

QUICK = Path(__file__).resolve().parents[1] / "quick_case.toml"
STUDY = """
case = "case.toml"
measure = ["displacement_z", "wheel_unloading"]
[over]
"run.speed" = [30.0, 40.0]
"""
CHECKS = '\n[checks]\nline_speed = 40.0\ntrack = "ballasted"\n'


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(QUICK, "case.toml")
    Path("study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


def command(capsys, *arguments):
    code = cli.main(["report", *arguments])
    shown = capsys.readouterr()
    return code, shown.out.splitlines(), shown.err.splitlines()


def page(name="out.html"):
    return Path(name).read_text(encoding="utf-8")


def never(*_, **__):
    raise AssertionError("it was computed")


def test_one_crossing(here, capsys):
    code, out, err = command(capsys, "case.toml", "--out", "a/out.html", "--excel", "b/n.xlsx")
    assert (code, err) == (0, [])
    assert out == ["Train on a bridge: deck: written to a/out.html and b/n.xlsx"]
    assert page("a/out.html").startswith("<!DOCTYPE html>") and Path("b/n.xlsx").exists()
    assert sorted(os.listdir()) == ["a", "b", "case.toml", "study.toml"]
    assert os.listdir("a") == ["out.html"] and os.listdir("b") == ["n.xlsx"]
    assert "No limits of a code were asked for" in page("a/out.html")


def test_keys_are_changed_and_the_title_is_given(here, capsys):
    asked = ("--set", "run.speed=30", "--title", "Bridge <7>", "--out", "out.html")
    code, out, _ = command(capsys, "case.toml", *asked)
    assert code == 0 and out == ["Bridge <7>: written to out.html"]
    assert "at 30 m/s (108 km/h)" in page() and "<h1>Bridge &lt;7&gt;</h1>" in page()


def test_quiet_says_nothing(here, capsys):
    assert command(capsys, "case.toml", "--out", "out.html", "-q") == (0, [], [])


def test_a_case_with_checks_is_judged(here, capsys):
    with Path("case.toml").open("a", encoding="utf-8") as file:
        file.write(CHECKS)
    code, out, _ = command(capsys, "case.toml", "--out", "out.html", "--excel", "n.xlsx")
    case = rb.case("case.toml")
    verdict = rb.assess_run(case.compute(), case.requirements).verdict
    assert code == 0
    assert out == [f"Train on a bridge: deck: verdict: {verdict}; written to out.html and n.xlsx"]
    assert f"Verdict: {verdict}" in page() and "deck acceleration" in page()
    assert "No limits" not in page()


def test_a_case_with_checks_over_speeds_is_assessed(here, capsys):
    with Path("case.toml").open("a", encoding="utf-8") as file:
        file.write(CHECKS)
    asked = ("--trains", "ICE2,HSLM-A1", "--speeds", "40,48", "--out", "out.html", "-q")
    code, _, _ = command(capsys, "case.toml", *asked)
    assert code == 0
    assert "What each train comes to" in page() and "What the codes say besides" in page()
    assert re.search(r"Verdict: (met|not met|cannot decide)", page())


def test_quantities_and_verdicts_come_from_one_pass(here, capsys, monkeypatch):
    with Path("case.toml").open("a", encoding="utf-8") as file:
        file.write(CHECKS)
    computed, compute = [], engine.compute

    def counted(train, deck, track, settings):
        computed.append(settings.speed)
        return compute(train, deck, track, settings)

    monkeypatch.setattr(engine, "compute", counted)
    code, *_ = command(capsys, "case.toml", "--speeds", "40,48", "--out", "out.html", "-q")
    assert code == 0 and computed == [40.0, 48.0]
    assert "Verdict: " in page() and "moment by dynamic analysis" in page()


def test_the_own_train_of_a_case_over_speeds(here, capsys):
    asked = ("--speeds", "30:40:5", "--measure", "displacement_z", "--out", "out.html")
    code, out, err = command(capsys, "case.toml", *asked)
    assert code == 0, err
    assert "1 x xia2000_planar over deck, 12 m, at 3 speeds from 30 m/s" in page()
    assert out == ["Trains on a bridge: deck: written to out.html"]


def test_trains_over_a_deck(here, capsys):
    asked = ("--trains", "ICE2", "--speeds", "150,200km/h", "--points", "9,18")
    code, out, err = command(capsys, "viaduct36", *asked, "--out", "out.html")
    assert (code, err) == (0, [])
    assert "41.67 m/s (150 km/h) to 55.56 m/s (200 km/h)" in page()
    assert "ICE2.csv" in page() and "viaduct36.toml" in page()
    shutil.copy(Path(rb.data_root()) / "decks/viaduct36.toml", "deck.toml")
    code, _, _ = command(capsys, "deck.toml", *asked, "--out", "own.html")
    assert code == 0 and "deck.toml" in page("own.html") and str(here) not in page("own.html")


def test_chosen_speeds(here, capsys):
    asked = ("--trains", "ICE2", "--speeds", "200:210km/h", "--measure", "displacement_z", "-q")
    code, _, err = command(capsys, "viaduct36", *asked, "--out", "out.html")
    assert (code, err) == (0, [])
    assert re.search(r"at \d+ speeds from 55.56 m/s \(200 km/h\) to 58.33 m/s", page())


def test_a_study(here, capsys):
    code, out, err = command(capsys, "study.toml", "--out", "out.html", "--excel", "n.xlsx")
    assert (code, err) == (0, [])
    assert out == ["Study of a bridge: deck: written to out.html and n.xlsx"]
    assert "deck, 12 m: 2 crossings, 2 speed" in page()


def test_crossings_that_are_known_are_not_computed_again(here, capsys, monkeypatch):
    assert cli.main(["sweep", "study.toml", "--out", "known", "-q"]) == 0
    monkeypatch.setattr("railbridge.studies.engine.respond", never)
    monkeypatch.setattr("railbridge.cases.sweeping.Task.__call__", never)
    code, _, err = command(capsys, "study.toml", "--results", "known", "--out", "out.html")
    assert (code, err) == (0, [])


def test_a_crossing_without_numbers_is_told_of(here, capsys):
    study = STUDY.replace('"run.speed" = [30.0, 40.0]', '"run.time_step" = [4e-3, 0.5]')
    Path("study.toml").write_text(study, encoding="utf-8")
    code, _, _ = command(capsys, "study.toml", "--out", "out.html")
    if code == 3:
        assert "1 of 2 crossings have no numbers" in page()
    else:
        assert code == 2 and not Path("out.html").exists()


def test_what_does_not_converge_is_written_and_is_code_3(here, capsys):
    asked = ("--set", "run.max_iterations=1", "--set", "run.tolerance=1e-12")
    code, out, err = command(capsys, "case.toml", *asked, "--out", "out.html")
    assert code == 3 and out == ["Train on a bridge: deck: written to out.html"]
    assert any("not converge" in line for line in err)
    assert "The iteration did not converge" in page()


def test_doubts_are_said_and_stand_in_the_report(here, capsys):
    asked = ("case.toml", "--set", "deck.mass=400", "--out", "out.html")
    code, _, err = command(capsys, *asked)
    assert code in (0, 3) and err and all("warning: " in line for line in err[:1])
    doubt = err[0].partition("warning: ")[2]
    assert doubt.split(":")[0].split("=")[0].strip() in page()
    Path("out.html").unlink()
    code, _, err = command(capsys, *asked, "--strict")
    assert code == 2 and err and not Path("out.html").exists()


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        (("case.toml", "--out", "out.pdf"), r"--out = 'out.pdf': must end in \.html"),
        (("case.toml", "--out", "mine.html"), "--out = 'mine.html': exists already"),
        (("case.toml", "--out", "o.html", "--excel", "mine.xlsx"), "--excel = 'mine.xlsx': exists"),
        (("case.toml", "--out", "o.html", "--excel", "n.csv"), r"--excel.*must end in \.xlsx"),
        (("case.toml", "--out", "o.html", "--trains", "ICE2"), "--trains = 'ICE2'.*--speeds"),
        (("case.toml", "--out", "o.html", "--results", "d"), "--results = 'd'"),
        (("viaduct36", "--out", "o.html"), "--trains: is missing"),
        (("viaduct36", "--out", "o.html", "--trains", "ICE2"), "--speeds: is missing"),
        (("viaduct36", "--out", "o.html", "--set", "a=1"), "--set = 'a=1': changes keys of a case"),
        (("study.toml", "--out", "o.html", "--speeds", "30,40"), "--speeds.*a study says these"),
        (("study.toml", "--out", "o.html", "--set", "a=1"), "--set.*a study says these itself"),
        (("case.toml", "--out", "o.html", "--workers", "0"), "--workers"),
        (("case.toml", "--out", "o.html", "--title", ""), "--title"),
        (("case.toml", "--out", "o.html", "--speeds", "fast"), "--speeds"),
        (("none.toml", "--out", "o.html"), "none.toml.*no such file"),
        (("nonsense", "--out", "o.html"), "no such"),
    ],
)
def test_what_is_wrong_is_refused_in_one_line(here, capsys, monkeypatch, asked, says):
    monkeypatch.setattr(rb.Case, "compute", never)
    monkeypatch.setattr(reporting, "_computed", never)
    Path("mine.html").write_text("mine", encoding="utf-8")
    Path("mine.xlsx").write_text("mine", encoding="utf-8")
    before = sorted(os.listdir())
    code, out, err = command(capsys, *asked)
    assert code == 2 and out == [] and len(err) == 1
    assert re.search(says, err[0]), err[0]
    assert sorted(os.listdir()) == before
    assert Path("mine.html").read_text(encoding="utf-8") == "mine"


def test_force_replaces_any_file_and_ours_need_none(here, capsys):
    Path("out.html").write_text("mine", encoding="utf-8")
    assert command(capsys, "case.toml", "--out", "out.html", "--force", "-q")[0] == 0
    first = page()
    assert command(capsys, "case.toml", "--out", "out.html", "-q")[0] == 0
    assert page() == first


def test_it_says_which_package_is_missing(here, capsys, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "openpyxl", None)
    monkeypatch.setattr(rb.Case, "compute", never)
    code, _, err = command(capsys, "case.toml", "--out", "o.html", "--excel", "n.xlsx")
    assert code == 2 and "openpyxl is missing" in err[0] and "railbridge[report]" in err[0]
