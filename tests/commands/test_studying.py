"""The commands `sweep` and `envelope`: killed and gone on with, refused in one line, exit codes."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from railbridge.cases import shelf
from railbridge.commands import command as cli

pytest.importorskip("zarr")
xr = pytest.importorskip("xarray")

CASE = (Path(__file__).parents[1] / "quick_case.toml").read_text(encoding="utf-8")
STUDY = """
case = "case.toml"
[over]
"run.speed" = { from = 20.0, to = 49.0, step = 1.0 }
"""
SWEEP = ("sweep", "study.toml", "--chunk", "2", "--out")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("case.toml").write_text(CASE, encoding="utf-8")
    Path("study.toml").write_text(STUDY, encoding="utf-8")
    deck = CASE.split("[deck]")[1].split("[train]")[0]
    Path("deck.toml").write_text(deck, encoding="utf-8")
    return tmp_path


def command(capsys, *arguments):
    code = cli.main(list(arguments))
    shown = capsys.readouterr()
    return code, shown.out, shown.err


def identical(one, other):
    with xr.open_dataset(one) as a, xr.open_dataset(other) as b:
        assert a.identical(b)


def blocks(folder):
    return list(Path(folder, "points.zarr", "fingerprints").rglob("c/*/0"))


def stopped_in_the_middle(number, *more):
    """Exit code and stderr of a sweep that got a signal when some chunks were finished."""
    arguments = [sys.executable, "-m", "railbridge", *SWEEP, "o", *more]

    def listen():
        # A shell that starts the tests in the background has SIGINT ignored, and children inherit
        # that.
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(arguments, preexec_fn=listen, **pipes) as program:
        while len(blocks("o")) < 3 and program.poll() is None:
            time.sleep(0.002)
        program.send_signal(number)
        return program.communicate(timeout=60)[1], program.returncode


@pytest.mark.parametrize("more", [(), ("--workers", "2")])
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_a_stopped_sweep_goes_on_and_gives_the_same_bits(here, capsys, number, more):
    said, code = stopped_in_the_middle(number, *more)
    if number == signal.SIGKILL:
        assert code == -signal.SIGKILL
    else:
        assert code in (130, -signal.SIGINT)
        assert re.search(r"stopped: \d+ of 30 crossings are kept in o", said)
        assert "Traceback" not in said
    code, out, _ = command(capsys, *SWEEP, "o")
    assert code == 0
    known = int(re.search(r"(\d+) known already", out)[1])
    assert 4 <= known < 30
    assert command(capsys, *SWEEP, "whole")[0] == 0
    identical("o/sweep.nc", "whole/sweep.nc")
    assert Path("o/sweep.csv").read_bytes() == Path("whole/sweep.csv").read_bytes()
    assert "30 known already" in command(capsys, *SWEEP, "o")[1]


def test_an_envelope_has_one_row_a_train_speed_and_place(here, capsys):
    more = ["--trains", "HSLM-A1,HSLM-A2", "--speeds", "150:200:25km/h", "--points", "3,6"]
    code, out, _ = command(capsys, "envelope", "deck.toml", *more, "--out", "e", "--dry-run")
    assert (code, os.path.exists("e")) == (0, False)
    assert re.match(r"6 crossings \(2 train x 3 speed\); .* GB, about ", out)
    assert command(capsys, "envelope", "deck.toml", *more, "--out", "e")[0] == 0
    rows = Path("e/envelope.csv").read_text().splitlines()
    assert len(rows) == 1 + 2 * 3 * 2
    want = "train,speed (m/s),x (m),displacement_z (m),acceleration_z (m/s2),moment_vertical (N m),"
    want += "displacement_z_static (m)"
    assert rows[0].startswith(want)


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("--trains", "HSLM-A1", "--speeds", "200,150km/h"), "--speeds.*ascend"),
        (("--trains", "HSLM-A1", "--speeds", "1km/h:2:1m/s"), "mixes"),
        (("--trains", "HSLM-A99", "--speeds", "50"), "HSLM-A9"),
        (("--trains", ",", "--speeds", "50"), "at least one train"),
        (("--trains", "HSLM-A1", "--speeds", "50", "--points", "99"), "99"),
        (("--trains", "HSLM-A1", "--speeds", "50", "--workers", "0"), "--workers"),
        (("--trains", "HSLM-A1", "--speeds", "50", "--chunk", "0"), "--chunk"),
        (("--trains", "HSLM-A1", "--speeds", "50", "--hours", "1e-9"), "--hours"),
        (("--trains", "HSLM-A1", "--speeds", "50", "--measure", "dispacement_z"), "displacement_z"),
        (("--trains", "HSLM-A1", "--speeds", "1:9e9:1"), "at most"),
        (("--trains", "no.csv", "--speeds", "50"), "no.csv"),
        (("--trains", "HSLM", "--speeds", "50"), "--trains.*'HSLM-A'.*railbridge list trains"),
        (("--trains", "HSLM-B", "--speeds", "50"), "--trains.*n = 10, d = .*railbridge sweep"),
        (("--trains", "ICE2", "--speeds", "150-300km/h"), "--speeds = .*use a colon"),
        (("--trains", "ICE2", "--speeds", "300:150km/h"), "--speeds.*ascend"),
        (("--trains", "ICE2", "--speeds", "150:300"), r"--speeds\[2\] = 300.*at most 200 m/s"),
        (("--trains", "ICE2", "--speeds", "50", "--points", "30"), r"--points\[1\].*12 m\.$"),
        (("--trains", "ICE2", "--speeds", "50:60", "--points", "30"), r": --points\[1\].*12 m\.$"),
        (("--trains", "HSLM-A1", "--speeds", "50", "--cluster", "nonsense"), "--cluster"),
    ],
)  # fmt: skip
def test_slips_are_refused_in_one_line(here, capsys, arguments, why):
    code, _, err = command(capsys, "envelope", "deck.toml", *arguments, "-q", "--out", "e")
    assert (code, len(err.splitlines())) == (2, 1)
    assert re.search(why, err)


def test_places_that_cannot_be_written_are_refused(here, capsys):
    Path("file").write_text("mine")
    Path("foreign/points.zarr").mkdir(parents=True)
    for out, why in (("file", "is a file"), ("file/in", "is a file"), ("foreign", "is no study")):
        code, _, err = command(capsys, *SWEEP, out)
        assert (code, why in err, err.count("\n")) == (2, True, 1)
    assert Path("file").read_text() == "mine"


def test_failed_points_are_counted_and_told(here, capsys):
    Path("study.toml").write_text(
        'case = "case.toml"\npoints = [9.0]\n[over]\n"deck.length" = [8.0, 12.0]\n'
    )
    code, out, _ = command(capsys, *SWEEP, "o")
    assert code == 3
    assert "1 of 2 crossings have no numbers" in out
    assert "known already" not in out
    again = command(capsys, *SWEEP, "o")
    assert again[0] == 3
    assert "1 known already" in again[1]


def test_files_of_a_study_are_looked_for_beside_it(here, capsys, monkeypatch):
    shutil.copy(shelf.data_file("trains", "ICE2", ".csv"), "mine.csv")
    more = ("--trains", "mine.csv", "--speeds", "50", "--out", "a")
    assert command(capsys, "envelope", "deck.toml", *more)[0] == 0
    Path("study.toml").write_text(
        'case = "case.toml"\ntrains = ["mine.csv"]\n[over]\n"run.speed" = [50.0]\n'
    )
    Path("deeper").mkdir()
    monkeypatch.chdir("deeper")
    assert command(capsys, "sweep", "../study.toml", "--out", "o")[0] == 0


def alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    stat = Path(f"/proc/{process}/stat")
    return not stat.exists() or stat.read_text().rpartition(")")[2].split()[0] != "Z"


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs /proc")
def test_processes_end_with_a_killed_parent(here):
    Path("study.toml").write_text(STUDY.replace("step = 1.0", "step = 0.01"))
    arguments = [sys.executable, "-m", "railbridge", *SWEEP, "o", "--workers", "2"]
    with subprocess.Popen(arguments, stdout=subprocess.DEVNULL) as program:
        while len(blocks("o")) < 3 and program.poll() is None:
            time.sleep(0.002)
        own = Path(f"/proc/{program.pid}/task/{program.pid}/children").read_text().split()
        program.kill()
    assert len(own) >= 2
    end = time.monotonic() + 30.0
    while any(alive(int(process)) for process in own):
        assert time.monotonic() < end
        time.sleep(0.02)


def test_a_missing_extra_is_said_in_words(here, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    code, _, err = command(capsys, *SWEEP, "o")
    assert code == 2
    assert "the package xarray is missing" in err
    assert 'pip install "railbridge[study]"' in err


def test_the_package_opens_without_the_packages_of_studies():
    heavy = "xarray", "zarr", "dask", "distributed", "pandas", "tqdm"
    program = f"import sys, railbridge as r; r.sweep; print({heavy} & sys.modules.keys())"
    program = program.replace(str(heavy), str(set(heavy)))
    found = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (found.stdout.strip(), found.stderr) == ("set()", "")


def test_speeds_without_a_step_are_chosen_and_found_again(tmp_path, capsys):
    out = tmp_path / "out"
    words = ["envelope", "viaduct36", "--trains", "HSLM-A1", "--speeds", "150:300km/h"]
    assert cli.main([*words, "--out", str(out)]) == 0
    first = (out / "envelope.csv").read_bytes()
    said = re.search(r"at least (\d+) crossings .*several times as many", capsys.readouterr().out)
    assert int(said[1]) > 121
    with xr.open_dataset(out / "envelope.nc") as found:
        assert found.sizes["speed"] >= int(said[1]) and "0.5 %" in found.attrs["title"]
        assert float(found.speed[0]) == pytest.approx(150 / 3.6)
    assert cli.main([*words, "--out", str(out)]) == 0
    assert "known already" in capsys.readouterr().out
    assert (out / "envelope.csv").read_bytes() == first
    assert cli.main([*words, "--out", str(tmp_path / "b"), "--measure", "wheel_unloading"]) == 2
    assert "speeds are chosen by quantities" in capsys.readouterr().err
    assert not (tmp_path / "b").exists()


def test_all_ten_trains_of_the_family(tmp_path):
    out = tmp_path / "out"
    words = ["envelope", "viaduct36", "--trains", "HSLM-A", "--speeds", "50,60"]
    assert cli.main([*words, "--out", str(out), "-q"]) == 0
    rows = (out / "envelope.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == 21 and rows[1].startswith("HSLM-A1,50,18,")
    assert rows[0].startswith("train,speed (m/s),x (m),displacement_z (m),acceleration_z (m/s2),")


def test_a_cluster_that_does_not_answer_leaves_nothing_behind(here, capsys):
    """A client that never connected must not be asked for locks when results are written."""
    distributed = pytest.importorskip("distributed")
    code, _, err = command(capsys, *SWEEP, "o", "--cluster", "nonsense")
    assert code == 2 and "--cluster" in err
    with pytest.raises(ValueError, match="client found"):
        distributed.get_client()
    assert command(capsys, *SWEEP, "o")[0] == 0


def test_doubts_are_said_before_work_starts(here, capsys):
    deck = Path("deck.toml").read_text()
    Path("soft.toml").write_text(deck.replace("5e9", "5e6"))
    more = ("--trains", "HSLM-A1", "--speeds", "50,60", "--out", "e")
    code, out, err = command(capsys, "envelope", "soft.toml", *more, "--dry-run")
    assert (code, len(out.splitlines()), len(err.splitlines())) == (0, 1, 1)
    assert err.startswith("railbridge: warning: deck.bending_stiffness_vertical gives a first")
    code, _, err = command(capsys, "envelope", "deck.toml", *more, "--dry-run")
    assert (code, err) == (0, "")
    fast = ("--trains", "HSLM-A1", "--speeds", "50,150", "--out", "e", "--dry-run")
    assert "warning: --speeds = 150 m/s" in command(capsys, "envelope", "deck.toml", *fast)[2]
    light = 'case = "case.toml"\n[over]\n"deck.mass" = [7.0, 8.0, 8000.0]\n"run.speed" = [40.0]\n'
    Path("study.toml").write_text(light)
    code, out, err = command(capsys, *SWEEP, "o", "--dry-run")
    assert (code, len(err.splitlines())) == (0, 1)
    assert "warning: deck.mass = 7 kg/m" in err


def test_the_largest_values_are_said_in_the_units_that_were_asked_for(here, capsys):
    more = ["--trains", "HSLM-A1,HSLM-A2", "--speeds", "150:200:25km/h", "--points", "3,6"]
    _, out, _ = command(capsys, "envelope", "deck.toml", *more, "--out", "e")
    lines = out.splitlines()
    for name, unit in (("displacement_z", "m"), ("acceleration_z", "m/s2")):
        with xr.open_dataset("e/envelope.nc") as found:
            best = found[name].where(found[name] == found[name].max(), drop=True)
        where = f"{best.train.item()}, speed {3.6 * best.speed.item():.5g} km/h, x 6 m"
        want = f"deck: {name} is largest, {best.item():.4g} {unit}, at {where}"
        assert want in lines
    assert lines[-1] == "written to e/envelope.nc and envelope.csv"
    _, out, _ = command(capsys, "envelope", "deck.toml", *more[:3], "42,56", "--out", "m")
    assert re.search(r"speed (42|56) m/s", out)


def test_a_peak_at_the_end_of_the_range_is_said(here, capsys):
    measure = ("--measure", "acceleration_z")

    def said(speeds, out):
        more = ("--trains", "HSLM-A1,HSLM-A2", "--speeds", speeds, *measure, "--out", out)
        return command(capsys, "envelope", "viaduct36", *more)[1]

    # HSLM-A1 meets the first mode at 3.307 Hz * 18 m = 214.3 km/h, HSLM-A2 at 226.2 km/h.
    end = "acceleration_z is largest at the end of the range of speeds for"
    assert f"{end} HSLM-A2: look above 220 km/h" in said("205:220:2.5km/h", "a")
    both = said("190:205:5km/h", "b")
    assert f"{end} HSLM-A1 and HSLM-A2: look above 205 km/h" in both
    assert "at the end" not in said("205:235:2.5km/h", "c")
    assert f"{end} HSLM-A1: look below 217.5 km/h" in said("217.5:235:2.5km/h", "d")
    assert "at the end" not in said("220km/h", "e")


def test_the_last_speed_is_run(here, capsys):
    more = ("--trains", "HSLM-A1", "--speeds", "150:300:70km/h", "--out", "e")
    assert command(capsys, "envelope", "deck.toml", *more)[0] == 0
    with xr.open_dataset("e/envelope.nc") as found:
        assert 3.6 * found.speed.values == pytest.approx([150.0, 220.0, 290.0, 300.0])


def test_axles_that_cannot_unload_are_said(here, capsys):
    more = ("--speeds", "50,60", "--measure", "wheel_unloading", "--out", "e")
    code, out, err = command(capsys, "envelope", "deck.toml", "--trains", "HSLM-A1", *more)
    assert code == 0 and "wheel_unloading is 0 everywhere" in out
    assert err.count("\n") == 1 and "wheel_unloading is 0 for HSLM-A1: bare axle loads" in err
    Path("study.toml").write_text(
        'case = "case.toml"\nmeasure = ["wheel_unloading"]\n[over]\n"run.speed" = [40.0]\n'
    )
    assert command(capsys, *SWEEP, "o", "--dry-run")[2] == ""


def test_another_bridge_into_the_same_folder_is_said(here, capsys):
    more = ("--trains", "HSLM-A1", "--speeds", "50,60", "--out", "e")
    assert command(capsys, "envelope", "deck.toml", *more)[2] == ""
    assert command(capsys, "envelope", "deck.toml", *more)[2] == ""
    Path("other.toml").write_text(Path("deck.toml").read_text().replace("8000", "9000"))
    _, _, err = command(capsys, "envelope", "other.toml", *more)
    assert err.count("\n") == 1
    assert "e holds the results of other crossings; its envelope.nc and envelope.csv" in err


def test_a_study_begins_with_a_file_that_runs(here, capsys):
    code, out, _ = command(capsys, "new", "--study", "mine.toml")
    assert code == 0 and "railbridge sweep mine.toml" in out
    text = Path("mine.toml").read_text()
    with pytest.raises(SystemExit):
        cli.main(["sweep", "--help"])
    shown = capsys.readouterr().out
    for line in text.splitlines():
        assert line.replace("mine.toml", "study.toml") in shown
    Path("mine.toml").write_text(text.replace("10.0, to = 80.0", "70.0, to = 80.0"))
    code, out, _ = command(capsys, "sweep", "mine.toml", "--out", "o", "--dry-run")
    assert code == 0 and "12 crossings (3 speed x 4 wavelength)" in out


def test_help_shows_speeds_that_are_chosen(capsys):
    for words in (["--help"], ["envelope", "--help"]):
        with pytest.raises(SystemExit):
            cli.main(words)
        assert "--trains HSLM-A --speeds 150:300km/h --out" in capsys.readouterr().out
