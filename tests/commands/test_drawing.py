"""The command `ensemble`: what it writes and says, and what it refuses in one line."""

import csv
import json
import os
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import railbridge as rb
from railbridge.cases import drawn
from railbridge.commands import command as cli

CASE = """
[deck]
length = 12.0
bending_stiffness_vertical = 5e9
mass = 8000.0
damping = { modal = 0.02 }
modes = 3
elements = 12
[train]
vehicle = "xia2000_planar"
[track.vertical]
kind = "random"
spectrum = "german-low"
band = [6.0, 60.0]
seed = 11
period = 250.0
rails_differ = false
[run]
speed = 40.0
time_step = 4e-3
lead_in = 160.0
tail = 0.1
[output]
points = [6.0]
"""
FILES = {"summary.json", "histories.csv", "realisations.csv", "statistics.csv"}
NAME = "displacement_z at 6 m"
WHEELS = ("--wheels-of", "1", "--realisations", "20")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("case.toml").write_text(CASE, encoding="utf-8")
    return tmp_path


def command(capsys, *arguments):
    code = cli.main(["ensemble", "case.toml", *arguments])
    shown = capsys.readouterr()
    return code, shown.out.splitlines(), shown.err.splitlines()


def response():
    return rb.case("case.toml").random_response(["displacement_z", "acceleration_z"], None, [1])


def test_everything_is_written_and_said(here, capsys):
    code, out, err = command(capsys, *WHEELS, "--out", "new/o")
    assert (code, err) == (0, [])
    assert set(os.listdir("new/o")) == FILES and set(os.listdir()) == {"case.toml", "new"}
    known = response()
    ensemble = known.ensemble(20)
    own, sigma = ensemble.statistics(NAME), known.sigma(NAME)
    assert out[0] == "german-low, 38 waves of 6 to 60 m; 20 realisations, seeds 11 to 30"
    t = known.time(NAME)[np.argmax(sigma)]
    assert out[1] == f"{NAME}: sigma is largest, {sigma.max():.4g} m, at t = {t:.4g} s"
    assert f"by probability: {known.extreme(NAME).mean:.4g} on average" in out[2]
    seed = ensemble.seeds[own.largest_index]
    assert re.search(rf"realisations: {own.mean:.4g} \(.*, worst {own.largest:.4g}: seed", out[3])
    assert out[3].endswith(f"seed {seed}")
    assert out[-1] == "written to new/o" and "track.vertical.seed = its seed" in out[-2]
    assert out[-4].startswith("wheel_unloading") and "seed" in out[-3]


def test_the_seed_that_is_named_runs_to_the_worst(here, capsys):
    command(capsys, *WHEELS, "--out", "o", "--quiet")
    found = json.loads(Path("o/summary.json").read_text())["histories"][NAME]
    worst = found["largest_size_of_realisations"]["worst"]
    assert cli.main(
        ["run", "case.toml", "--set", f"track.vertical.seed={worst['seed']}", "--out", "r", "-q"]
    ) == 0  # fmt: skip
    own = json.loads(Path("r/summary.json").read_text())["points"][0]["displacement_z"]
    size = max(abs(own["min"]["value"]), abs(own["max"]["value"]))
    # The run begins with a run-up, the waves of the ensemble come from far.
    assert size == pytest.approx(worst["value"], rel=2e-3)


def test_the_tables(here, capsys):
    command(capsys, *WHEELS, "--out", "o")
    known = response()
    ensemble = known.ensemble(20)
    wheel = "wheel_force_z of car 1, wheel 2"
    rows = pd.read_csv("o/histories.csv")
    assert rows["t"].to_numpy() == pytest.approx(known.time(NAME), abs=1e-8)
    for name, unit in ((NAME, "m"), (wheel, "N")):
        for kind, values in (("mean", known.mean(name)), ("sigma", known.sigma(name))):
            column = rows[f"{name} {kind} ({unit})".replace(",", "")]
            found = np.interp(known.time(name), rows["t"], column)
            size = np.abs(values).max()
            assert found == pytest.approx(values, rel=1e-7, abs=1e-7 * size), (name, kind)
            assert column.notna().sum() == len(values)
    rows = pd.read_csv("o/realisations.csv", index_col="seed")
    assert rows.index.tolist() == list(range(11, 31))
    for side in ("smallest", "largest"):
        column = rows[f"{NAME} {side} (m)"].to_numpy()
        assert column == pytest.approx(ensemble.values(NAME, side), rel=1e-8)
    assert rows["wheel_unloading largest"].to_numpy() == pytest.approx(
        ensemble.values("wheel_unloading"), rel=1e-8
    )
    rows = pd.read_csv("o/statistics.csv").set_index(["history", "extreme", "way"])
    own = ensemble.statistics(NAME, "smallest")
    row = rows.loc[NAME, "smallest", "realisations"]
    assert row[["mean", "mean low", "mean high"]].tolist() == pytest.approx(
        [own.mean, *own.mean_interval], rel=1e-8
    )
    assert (row["worst"], row["worst seed"], row["unit"]) == (
        pytest.approx(own.smallest, rel=1e-8), 11 + own.smallest_index, "m",
    )  # fmt: skip
    p = known.extreme(NAME)
    row = rows.loc[NAME, "largest size", "probability"]
    assert row["95 % below"] == pytest.approx(p.percentile(95), rel=1e-8)
    assert np.isnan(row["worst seed"]) and np.isnan(row["mean low"])
    # Every row has as many cells as the head.
    for file in FILES - {"summary.json"}:
        with Path("o", file).open(encoding="utf-8", newline="") as lines:
            assert len({len(row) for row in csv.reader(lines)}) == 1


def test_the_summary_says_what_was_drawn(here, capsys):
    command(capsys, *WHEELS, "--out", "o")
    found = json.loads(Path("o/summary.json").read_text())
    assert set(found) == {
        "realisations", "first_seed", "last_seed", "confidence", "random_track", "run",
        "histories", "wheel_unloading", "remarks", "railbridge",
    }  # fmt: skip
    assert [found[key] for key in ("realisations", "first_seed", "last_seed")] == [20, 11, 30]
    track = response().track
    own = found["random_track"]
    assert (own["keys"], own["spectrum"]) == (["track.vertical"], "german-low")
    assert own["band"] == [6.0, 60.0] and own["waves"] == 38
    assert own["period"] == pytest.approx(track.length) and list(own["components"]) == ["vertical"]
    assert own["components"]["vertical"] == {
        "sigma": pytest.approx(rb.spectrum("german-low").sigma("vertical", (6.0, 60.0))),
        "factor": 1.0,
        "grade": "two",
    }
    assert (found["run"]["speed"], found["run"]["time_step"]) == (40.0, 4e-3)
    sigma = response().sigma(NAME)
    one = found["histories"][NAME]
    assert one["sigma"]["value"] == pytest.approx(sigma.max(), rel=1e-9)
    # 20 realisations cannot bound a 95 % percentile from above.
    p95 = one["largest_size_of_realisations"]["percentiles"]["95"]
    assert p95["high"] is None and p95["low"] < p95["value"]
    assert any("20 realisations are too few" in remark for remark in found["remarks"])
    assert "wheel_force_z of car 1, wheel 2" in found["histories"]
    assert 0.0 < found["wheel_unloading"]["mean"] < 1.0


def test_factors_are_those_of_each_direction(here, capsys):
    Path("case.toml").write_text(
        CASE.replace('"xia2000_planar"', '"xia2000"')
        .replace("rails_differ = false", "sigma = 3e-3")
        .replace(
            "[run]",
            '[track.lateral]\nkind = "random"\nspectrum = "german-low"\nband = [6.0, 60.0]\n'
            "seed = 11\nperiod = 250.0\n[run]",
        )
    )
    assert command(capsys, "--out", "o", "--realisations", "2")[0] == 0
    own = json.loads(Path("o/summary.json").read_text())["random_track"]
    assert own["keys"] == ["track.vertical", "track.lateral"]
    size = (3e-3 / rb.spectrum("german-low").sigma("vertical")) ** 2
    factors = {name: each["factor"] for name, each in own["components"].items()}
    assert factors == pytest.approx(
        {"vertical": size, "alignment": 1.0, "cross_level": size, "gauge": 1.0}
    )


def test_quiet_says_nothing_and_old_results_are_replaced(here, capsys):
    Path("o").mkdir()
    Path("o/summary.json").write_text("old")
    Path("o/mine.txt").write_text("mine")
    assert command(capsys, "--out", "o", "--realisations", "3", "-q") == (0, [], [])
    assert set(os.listdir("o")) == FILES | {"mine.txt"}
    assert Path("o/summary.json").read_text() != "old"


def test_a_wheel_that_would_lift_is_warned_of(here, capsys):
    more = ("--set", "track.vertical.sigma=20e-3", "--out", "o")
    code, _, err = command(capsys, *WHEELS, *more)
    assert code == 0
    lifted = [line for line in err if "would lift in" in line]
    assert len(lifted) == 1 and re.search(r"in \d+ of 20 realisations", lifted[0])


def test_a_doubt_is_said_first_and_strict_refuses_it(here, capsys):
    slip = ("--set", "run.speed=144", "--set", "track.vertical.period=450", "--out", "o")
    slip += ("--realisations", "2", "--quiet")
    code, _, err = command(capsys, *slip)
    assert code == 0 and [line for line in err if "given in km/h" in line] == err
    remarks = json.loads(Path("o/summary.json").read_text())["remarks"]
    assert any("given in km/h" in remark for remark in remarks)
    code, out, err = command(capsys, *slip[:2], "--strict", "--out", "p")
    assert (code, out, len(err), os.path.exists("p")) == (2, [], 1, False)


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("--realisations", "1"), "--realisations = 1: .*at least 2"),
        (("--measure", "dispacement_z"), "--measure.*'displacement_z'"),
        (("--measure", ","), "--measure"),
        (("--measure", "wheel_unloading"), "--measure.*--wheels-of"),
        (("--points", "99"), r"--points\[1\] = 99"),
        (("--points", "a"), "--points"),
        (("--wheels-of", "2"), "--wheels-of = 2.*at most 1"),
        (("--wheels-of", "1;2"), "--wheels-of = '1;2'.*1,8"),
        (("--wheels-of", "0"), "--wheels-of = 0"),
        (("--set", "track.vertical.spectrum=german"), "track.vertical.spectrum = 'german'"),
        (("--set", 'track.vertical={kind="none"}'), ": track: holds nothing of kind"),
        (("--set", "run.iterations=3"), "run.iterations = 3"),
        (("--set", "track.vertical.period=50"), "period"),
        (("--set", "speed"), "--set"),
    ],
)
def test_slips_are_refused_in_one_line(here, capsys, arguments, why):
    code, out, err = command(capsys, *arguments, "--out", "o")
    assert (code, out, len(err)) == (2, [], 1)
    assert re.search(why, err[0])
    assert set(os.listdir()) == {"case.toml"}


def test_places_that_cannot_be_written_are_refused_before_computing(here, capsys, monkeypatch):
    Path("file").write_text("mine")
    monkeypatch.setattr(rb.Case, "random_response", lambda *_: pytest.fail("computed"))
    code, _, err = command(capsys, "--out", "file")
    assert (code, len(err)) == (2, 1) and "is a file" in err[0]


@pytest.mark.parametrize(
    ("error", "code"), [(KeyboardInterrupt(), 130), (MemoryError(), 1), (OSError(28, "full"), 1)]
)
def test_what_stops_in_the_middle_leaves_nothing(here, capsys, monkeypatch, error, code):
    def broken(*_):
        yield "head\n"
        raise error

    monkeypatch.setattr(drawn.Drawn, "_realisations", broken)
    stopped, out, err = command(capsys, "--out", "new/o", "--realisations", "2")
    assert (stopped, out, len(err)) == (code, [], 1)
    assert set(os.listdir()) == {"case.toml"}
