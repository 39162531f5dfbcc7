"""The command: what it writes, what it refuses and how it says so; never a traceback."""

import csv
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

import railbridge as rb
from railbridge.cases import pages, shelf
from railbridge.commands import command as cli
from railbridge.commands import speech

SCHEMA = pages.schema()
VALID = Draft202012Validator(SCHEMA)

CASE = (Path(__file__).parents[1] / "quick_case.toml").read_text(encoding="utf-8")
FILES = {
    "summary.json", "points.csv", "wheels.csv", "cars.csv", "reactions.csv", "iterations.csv",
}  # fmt: skip


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("case.toml").write_text(CASE, encoding="utf-8")
    return tmp_path


def command(capsys, *arguments):
    """Exit code, lines on stdout, lines on stderr."""
    code = cli.main(list(arguments))
    shown = capsys.readouterr()
    return code, shown.out.splitlines(), shown.err.splitlines()


def refused(capsys, *arguments):
    """The one line of a refusal."""
    code, out, err = command(capsys, *arguments)
    assert (code, out, len(err)) == (2, [], 1)
    return err[0]


def changed(before, after):
    assert before in CASE
    Path("case.toml").write_text(CASE.replace(before, after), encoding="utf-8")


def test_run_writes_all_results_and_nothing_else(here, capsys):
    code, out, err = command(capsys, "run", "case.toml", "--out", "deep/results")
    assert (code, out, len(err)) == (0, [], 1)
    assert "converged in" in err[0]
    assert set(os.listdir("deep/results")) == FILES
    assert set(os.listdir()) == {"case.toml", "deep"}
    summary = json.loads(Path("deep/results/summary.json").read_text(encoding="utf-8"))
    assert summary == rb.case("case.toml").summary()
    for name in FILES - {"summary.json"}:
        rows = list(csv.reader(Path("deep/results", name).read_text(encoding="utf-8").splitlines()))
        assert rows[0][0] == "t"
        assert len(rows) == 1 + summary["run"]["samples"]


def test_quiet_says_nothing_and_old_results_are_replaced(here, capsys):
    Path("results").mkdir()
    for name in ("summary.json", "wheels.csv", "mine.txt"):
        Path("results", name).write_text("old")
    assert command(capsys, "run", "case.toml", "--out", "results", "-q", "--no-histories") == (
        0,
        [],
        [],
    )
    assert set(os.listdir("results")) == {"summary.json", "mine.txt"}
    assert Path("results/mine.txt").read_text() == "old"
    assert json.loads(Path("results/summary.json").read_text())["converged"]


def test_keys_can_be_changed_on_the_command_line(here, capsys):
    changes = ["--set", "run.speed=20", "--set", "run.interaction=rigid", "--set", "train.cars = 2"]
    code, _, _ = command(capsys, "run", "case.toml", "--out", "r", *changes)
    summary = json.loads(Path("r/summary.json").read_text())
    assert (code, summary["run"]["speed"], summary["run"]["interaction"], summary["converged"]) == (
        0,
        20.0,
        "rigid",
        None,
    )
    assert "--set" in refused(capsys, "run", "case.toml", "--out", "r", "--set", "run.speed")
    assert "run.sped" in refused(capsys, "run", "case.toml", "--out", "r", "--set", "run.sped=3")


def test_a_starter_is_written_runs_and_is_left_alone(here, capsys):
    code, out, err = command(capsys, "new", "mine.toml")
    assert (code, err) == (0, []) and "railbridge run mine.toml" in out[0]
    text = Path("mine.toml").read_text(encoding="utf-8")
    assert all(
        "#" in line or "=" in line or line.startswith("[") or not line for line in text.splitlines()
    )
    VALID.validate(tomllib.loads(text))
    assert (
        command(
            capsys,
            "run",
            "mine.toml",
            "--out",
            "r",
            "-q",
            "--set",
            "run.time_step=4e-3",
            "--set",
            "run.tolerance=1e-3",
        )[0]
        == 0
    )
    assert "exists already" in refused(capsys, "new", "mine.toml")
    assert Path("mine.toml").read_text(encoding="utf-8") == text
    assert ".toml" in refused(capsys, "new", "mine.txt")
    assert "cannot be written" in refused(capsys, "new", "no/such/folder.toml")


def test_every_choice_that_the_starter_leaves_out_is_valid(here):
    text = pages.starter("x.toml")
    tried, table = set(), ""
    for line in text.splitlines():
        table = line[1 : line.index("]")] if line.startswith("[") else table
        if not (table and re.match(r"# \w+ = ", line)):
            continue
        key, value = next(iter(tomllib.loads(line[2:]).items()))
        tried.add(key)
        content = tomllib.loads(text)
        content[table][key] = value
        if key in ("torsional_stiffness", "polar_inertia"):
            content["deck"].update(torsional_stiffness=3e10, polar_inertia=5e4)
        if key in ("axles", "loads") and table == "train":
            content["train"] = {"axles": [0.0, 3.0, 11.0, 14.0], "loads": [2e5] * 4} | {key: value}
        VALID.validate(content)
        rb.Case(content)
    assert {
        "time_step",
        "loads",
        "axles",
        "lateral",
        "relaxation",
        "tracks",
        "polar_inertia",
    } <= tried


def test_help_shows_examples_files_and_exit_codes(capsys):
    with pytest.raises(SystemExit) as stop:
        cli.main(["--help"])
    text = capsys.readouterr().out
    assert stop.value.code == 0
    for word in ("railbridge new", "railbridge run", "summary.json", *FILES, "exit codes", "SI"):
        assert word in text
    with pytest.raises(SystemExit) as stop:
        cli.main([])
    assert stop.value.code == 2


def test_lists_and_schema(capsys):
    code, out, _ = command(capsys, "list")
    assert code == 0 and {"vehicles", "trains", "decks", "spectra", "cases"} <= set(out)
    assert any(line.startswith("  xia2000 ") for line in out)
    assert "  german-low          German railways, low disturbance" in out
    code, out, _ = command(capsys, "list", "trains")
    assert code == 0 and out[0] == "trains"
    assert "  HSLM-A1             50 axles, 397.5 m, 8500 kN" in out
    assert any(line.startswith("  ICE2 ") for line in out)
    code, out, _ = command(capsys, "list", "decks")
    said = {line.split()[0]: line for line in out[1:]}
    assert set(said) == set(shelf.data_names("decks"))  # a name stands apart from what is said
    assert "bridge at Antoing" in said["antoing50"]
    code, out, _ = command(capsys, "schema")
    assert json.loads("\n".join(out)) == SCHEMA
    code, out, _ = command(capsys, "check", "paper")
    assert code == 0 and "64 wheels" in out[0]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"not TOML [", "not a valid TOML file"),
        (b"\x7fELF\x00\xff\xfe", "case.toml: is not text"),
        (b"", "deck: is missing"),
        (b"[deck]\n[train]\n", "run: is missing"),
        (b"deck = 3\ntrain = 4\nrun = 5", "deck = 3: must be a table"),
    ],
)
def test_what_is_no_case_file_is_refused(here, capsys, content, words):
    Path("case.toml").write_bytes(content)
    assert words in refused(capsys, "run", "case.toml", "--out", "r")
    assert os.listdir() == ["case.toml"]


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("speed = 40.0", "sped = 40.0", "run.sped: unknown key. Did you mean 'speed'?"),
        ("speed = 40.0", 'speed = "fast"', "run.speed = 'fast': must be a finite number above 0"),
        ("speed = 40.0", "speed = -40.0", "run.speed = -40.0"),
        ("speed = 40.0", "", "run.speed: is missing"),
        ("[run]", "[ruin]", "ruin: unknown key"),
        ("mass = 8000.0", "mass = 0", "deck.mass = 0"),
        ("length = 12.0", 'length = "12"', "deck.length = '12'"),
        ("modal = 0.02", "modal = 7", "deck.damping.modal = 7"),
        ("modes = 3", 'bearing = [{ x = 0.0, fixed = "z" }]', "deck.bearing = "),
        ("length = 12.0", 'file = "viaduct36"', "deck.bending_stiffness_vertical"),
        (
            'vehicle = "xia2000_planar"',
            'vehicle = "xia2000_planer"',
            "train.vehicle = 'xia2000_planer': no such vehicle",
        ),
        (
            'vehicle = "xia2000_planar"',
            'vehicle = "cars/mine.csv"',
            "train.vehicle = 'cars/mine.csv': no such file",
        ),
        ("[train]", "[[train]]", "several trains"),
        ("wavelength = 10.0", "wavelength = 0.0", "track.vertical.wavelength = 0.0"),
        ('"harmonic"', '"harmonc"', "track.vertical.kind = 'harmonc'"),
        ("points = [6.0]", "points = [6.0, 60.0]", "output.points[2] = 60.0"),
        ("time_step = 4e-3", "time_step = 4e-9", "GB"),
        ("speed = 40.0", "speed = 1e-6", "run.speed = 1e-06: this run"),
    ],
)
def test_a_bad_case_is_refused_with_the_path_of_the_key(here, capsys, before, after, words):
    changed(before, after)
    line = refused(capsys, "run", "case.toml", "--out", "r")
    assert words in line
    assert os.listdir() == ["case.toml"]


def test_too_large_a_run_is_refused_with_the_estimate(here, capsys):
    line = refused(
        capsys,
        "run",
        "case.toml",
        "--out",
        "r",
        "--set",
        "run.time_step=2e-6",
        "--set",
        "train.cars=2",
    )
    assert re.search(r"run\.time_step = 2e-06: .*about [\d.]+ GB", line)
    assert os.listdir() == ["case.toml"]


def test_missing_case_and_unwritable_folder_are_refused_before_computing(here, capsys, monkeypatch):
    monkeypatch.setattr(
        rb.Case, "run", lambda *_: pytest.fail("computed before the folder was tried")
    )
    assert "no such file" in refused(capsys, "run", "nothing.toml", "--out", "r")
    assert "Known: paper" in refused(capsys, "run", "nothing", "--out", "r")
    for out in ("case.toml", "case.toml/r", "/proc/r/r", "r\0r", "", "r" * 300):
        assert "--out" in refused(capsys, "run", "case.toml", "--out", out)
    assert os.listdir() == ["case.toml"]


def test_no_convergence_is_told_and_written(here, capsys):
    code, _, err = command(
        capsys, "run", "case.toml", "--out", "r", "--set", "run.max_iterations=1"
    )
    assert (code, len(err)) == (3, 1)
    assert "run.max_iterations" in err[0]
    summary = json.loads(Path("r/summary.json").read_text())
    assert (summary["converged"], summary["iterations"], len(summary["changes"])) == (False, 1, 1)
    assert set(os.listdir("r")) == FILES


@pytest.mark.parametrize("existing", [True, False])
@pytest.mark.parametrize(
    ("error", "code"),
    [
        (KeyboardInterrupt(), 130),
        (MemoryError(), 1),
        (OSError(28, "No space left on device", "wheels.csv"), 1),
    ],
)
def test_what_stops_in_the_middle_leaves_nothing(here, capsys, monkeypatch, error, code, existing):
    def broken(run, points):
        yield next(whole(run, points))
        raise error

    whole = cli.histories
    monkeypatch.setattr(cli, "histories", broken)
    if existing:
        Path("r").mkdir()
        Path("r/summary.json").write_text("old")
    stopped, out, err = command(capsys, "run", "case.toml", "--out", "r" if existing else "new/r")
    assert (stopped, out, len(err)) == (code, [], 1)
    assert set(os.listdir()) == {"case.toml"} | ({"r"} if existing else set())
    if existing:
        assert [(p.name, p.read_text()) for p in Path("r").iterdir()] == [("summary.json", "old")]


@pytest.mark.skipif(os.name == "nt", reason="signals differ")
@pytest.mark.parametrize(
    ("number", "code", "words"),
    [
        (signal.SIGINT, 130, "interrupted; nothing was written"),
        (signal.SIGTERM, 143, "stopped; nothing was written"),
    ],
)
def test_who_is_stopped_leaves_nothing(here, number, code, words):
    long = [
        "--set",
        "train.cars=40",
        "--set",
        "run.time_step=1e-3",
        "--set",
        "run.interaction=direct",
    ]
    program = [sys.executable, "-m", "railbridge", "run", "case.toml", "--out", "r", *long]

    def listen():
        # A shell that starts the tests in the background has SIGINT ignored, and children inherit
        # that.
        signal.signal(number, signal.SIG_DFL)

    with subprocess.Popen(
        program, stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=listen
    ) as process:
        deadline = time.monotonic() + 60
        while (
            not any(p.name.startswith(".railbridge-") for p in here.iterdir())
            and time.monotonic() < deadline
        ):
            time.sleep(0.05)
        time.sleep(0.3)
        process.send_signal(number)
        _, err = process.communicate(timeout=60)
    assert process.returncode == code
    assert err.splitlines()[-1] == f"railbridge: {words}" and "Traceback" not in err
    assert os.listdir() == ["case.toml"]


def shell(line):
    """Code, output and complaints of the command in a shell; its streams are what matters here."""
    command = f"{shlex.quote(sys.executable)} -m railbridge {line}"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.skipif(os.name == "nt", reason="needs a shell of Unix")
@pytest.mark.parametrize("streams", ["2>&-", ">&- 2>&-", "2>/dev/full", ">/dev/full"])
def test_results_do_not_need_somebody_who_listens(here, streams):
    code, out, _ = shell(f"run case.toml --out r --set run.lead_in=5 {streams}")
    assert (code, out) == (0, "")
    assert set(os.listdir("r")) == FILES


@pytest.mark.skipif(os.name == "nt", reason="needs a shell of Unix")
def test_output_that_cannot_be_written_is_told_once(here):
    code, _, err = shell("list >/dev/full")
    assert (code, err) == (1, "railbridge: the output: No space left on device\n")
    assert shell("check case.toml >&-")[0] == 0
    code, out, err = shell("schema | head -n 1")
    assert (out, err) == ("{\n", "")


@pytest.mark.skipif(os.name == "nt", reason="limits differ")
def test_a_starter_that_finds_no_room_leaves_nothing(here):
    import resource  # Unix only

    def full():
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))

    done = subprocess.run(
        [sys.executable, "-B", "-m", "railbridge", "new", "mine.toml"],
        capture_output=True, text=True, preexec_fn=full,
    )  # fmt: skip
    assert done.returncode == 2
    assert "mine.toml': cannot be written (File too large)" in done.stderr
    assert os.listdir() == ["case.toml"]
    assert cli.main(["new", "mine.toml"]) == 0


@pytest.mark.parametrize("module", ["__init__", "commands/command"])
def test_ctrl_c_while_packages_are_loaded_is_one_line(tmp_path, module):
    """The program that is installed stands outside the package, which loads most of them."""
    root = Path(cli.__file__).parents[2]
    script = tomllib.loads((root.parent / "pyproject.toml").read_text(encoding="utf-8"))
    entry, _, function = script["project"]["scripts"]["railbridge"].partition(":")
    assert root.joinpath(f"{entry}.py").is_file()
    for name in ("__init__", "commands/__init__", "commands/command"):
        path = tmp_path / "railbridge" / f"{name}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("raise KeyboardInterrupt\n" if name == module else "")
    done = subprocess.run(
        [sys.executable, "-c", f"import sys\nfrom {entry} import {function}\nsys.exit(main())"],
        capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(root)])},
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "railbridge: interrupted; nothing was written\n"


def test_progress_is_one_line_in_a_terminal(monkeypatch, capsys):
    now = [0.0]
    monkeypatch.setattr(speech.time, "monotonic", lambda: now[0])
    progress = speech.Progress(quiet=False)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    for now[0] in (0.5, 2.0, 2.1, 3.0):
        progress(f"iteration {now[0]}")
    progress.end()
    shown = capsys.readouterr().err
    assert "\n" not in shown and shown.count("iteration") == 2 and shown.endswith("\r")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: False)
    for now[0] in (20.0, 21.0, 31.0):
        progress(f"iteration {now[0]}")
    assert (
        capsys.readouterr().err
        == "railbridge: iteration 20.0, 20 s\nrailbridge: iteration 31.0, 31 s\n"
    )


def test_a_warning_is_one_line(here, capsys):
    changed("lead_in = 0.0", "lead_in = 5.0")
    code, _, err = command(capsys, "run", "case.toml", "--out", "r", "-q")
    assert code == 0
    assert len(err) == 1
    assert err[0].startswith("railbridge: warning: run.lead_in")


SOFT = "deck.bending_stiffness_vertical gives a first vertical frequency of 0.273 Hz, bridges of 12"


def test_a_doubt_is_one_warning_before_it_is_computed_and_stands_in_the_summary(here, capsys):
    changed("5e9", "5e6")
    code, _, err = command(capsys, "run", "case.toml", "--out", "r", "-q")
    assert code == 0 and sum(SOFT in line for line in err) == 1
    assert err[0].startswith(f"railbridge: warning: {SOFT}") and "given in kN m2" in err[0]
    assert "pulls on the rail" in err[1], "what follows in the result is said after it"
    remarks = json.loads(Path("r/summary.json").read_text(encoding="utf-8"))["remarks"]
    assert f"railbridge: warning: {remarks[0]}" == err[0]
    both = ["--set", "run.lead_in=5.0"]
    code, _, err = command(capsys, "run", "case.toml", "--out", "r", "-q", *both)
    named = [line.split()[2] for line in err[:2]]
    assert named == ["deck.bending_stiffness_vertical", "run.lead_in"]


def test_a_doubt_is_said_where_nothing_converges(here, capsys):
    changed("5e9", "5e6")
    code, _, err = command(
        capsys, "run", "case.toml", "--out", "r", "--set", "run.max_iterations=1"
    )
    assert code == 3
    assert err[0].startswith(f"railbridge: warning: {SOFT}") and "not converged" in err[-1]
    with pytest.warns(rb.InputWarning, match="kN m2"), pytest.raises(rb.NotConvergedError):
        rb.case("case.toml", {"run.max_iterations": 1}).run()


def test_check_says_doubts_too(here, capsys):
    changed("5e9", "5e6")
    code, out, err = command(capsys, "check", "case.toml")
    assert (code, len(out), len(err)) == (0, 1, 1)
    assert "can be run" in out[0] and err[0].startswith(f"railbridge: warning: {SOFT}")


def test_check_shows_the_modes_of_the_deck(here, capsys):
    _, out, _ = command(capsys, "check", "paper")
    assert out[0].endswith("deck: 20 modes, f1 = 3.307 Hz, up to 162.1 Hz")


def test_check_takes_a_deck_file(here, capsys):
    deck = (here / "case.toml").read_text(encoding="utf-8").split("[deck]")[1].split("[train]")[0]
    (here / "deck.toml").write_text(deck, encoding="utf-8")
    made = rb.deck("deck.toml")
    code, out, err = command(capsys, "check", "deck.toml")
    assert (code, len(out), err) == (0, 1, [])
    modes = (
        f"{made.length:g} m; {made.frequencies_hz.size} modes, f1 = {made.frequencies_hz[0]:.4g}"
    )
    assert modes in out[0] and "railbridge envelope deck.toml --trains" in out[0]
    assert command(capsys, "check", "viaduct36")[1][0].startswith("viaduct36: a deck that can be")
    (here / "deck.toml").write_text(deck.replace("5e9", "5e6"), encoding="utf-8")
    code, out, err = command(capsys, "check", "deck.toml")
    assert (code, len(out), len(err)) == (0, 1, 1)
    assert err[0].startswith("railbridge: warning: bending_stiffness_vertical gives a first")
    code, out, err = command(capsys, "check", "deck.toml", "--strict")
    assert (code, out) == (2, []) and err[0].startswith("railbridge: bending_stiffness_vertical")
    assert "--set" in refused(capsys, "check", "deck.toml", "--set", "mass=9e3")
    (here / "deck.toml").write_text(deck.replace("5e9", "-5e9"), encoding="utf-8")
    assert "bending_stiffness_vertical" in refused(capsys, "check", "deck.toml")
    (here / "other.toml").write_text("answer = 42", encoding="utf-8")
    assert "none of the keys" in refused(capsys, "check", "other.toml")


def test_damping_as_a_number_is_answered_by_how_it_is_written(here, capsys):
    changed("damping = { modal = 0.02 }", "damping = 0.015")
    line = refused(capsys, "check", "case.toml")
    assert "deck.damping = 0.015: must be a table" in line and "{ modal = 0.015 }" in line


def test_strict_refuses_doubts_and_computes_nothing(here, capsys, monkeypatch):
    changed("5e9", "5e6")
    monkeypatch.setattr(rb.Case, "compute", lambda *_: pytest.fail("computed"))
    for arguments in (("run", "case.toml", "--out", "deep/r"), ("check", "case.toml")):
        line = refused(capsys, *arguments, "--strict")
        assert line.startswith(f"railbridge: {SOFT}")
    assert os.listdir() == ["case.toml"]
    two = ["--set", "run.speed=118"]
    code, out, err = command(capsys, "check", "case.toml", "--strict", *two)
    assert (code, out, len(err)) == (2, [], 2) and "424.8 km/h" in err[1]


def test_strict_lets_pass_what_is_not_doubted(here, capsys):
    code, out, err = command(capsys, "check", "case.toml", "--strict")
    assert (code, len(out), err) == (0, 1, [])
    assert command(capsys, "run", "case.toml", "--out", "r", "-q", "--strict") == (0, [], [])


def test_files_of_a_case_are_found_beside_it(here, capsys, monkeypatch):
    vehicles = shelf.data_file("vehicles", "xia2000_planar").read_text(encoding="utf-8")
    deck = (
        "length = 12.0\nbending_stiffness_vertical = 5e9\nmass = 8000.0\nmodes = 3\ndamping "
        "= { modal = 0.02 }\n"
    )
    Path("job/parts").mkdir(parents=True)
    Path("job/parts/mine.toml").write_text(vehicles, encoding="utf-8")
    Path("job/bridge.toml").write_text(deck)
    text = f'[deck]\nfile = "bridge.toml"\n{CASE[CASE.index("[train]") :]}'
    mixed = (
        'cars = ["parts/mine.toml", { vehicle = "parts/mine.toml", count = 2 }, "xia2000_planar"]'
    )
    Path("job/case.toml").write_text(text.replace('vehicle = "xia2000_planar"', mixed))
    Path("elsewhere").mkdir()
    monkeypatch.chdir("elsewhere")
    code, out, err = command(capsys, "check", "../job/case.toml")
    assert (code, err) == (0, [])
    assert "16 wheels" in out[0]
    case = rb.case(Path("..") / "job" / "case.toml")
    assert len(case.train.vehicles) == 4
    assert case.replace({"run.speed": 20.0}).deck is case.deck


# ---- the schema


SECTION = {
    "youngs_modulus": 35e9, "poisson_ratio": 0.2, "density": 2500.0, "area": 4.8,
    "second_moment_vertical": 2.5, "second_moment_lateral": 25.0, "torsion_constant": 5.6,
}  # fmt: skip
NOTCH = {"wheels": [[1, 1]], "circumference": 2.7, "offset": 1.0, "depth": 1e-3, "length": 0.5}
HARMONIC = {"kind": "harmonic", "amplitude": 1e-3, "wavelength": 10.0}


def test_the_headline_names_the_point_that_moves_most(here, capsys):
    given = ("run", "case.toml", "--out", "out", "--set", "output.points=[1.0, 6.0, 11.0]")
    code, _, err = command(capsys, *given)
    points = json.loads(Path("out/summary.json").read_text())["points"]
    worst = min(points, key=lambda p: p["displacement_z"]["min"]["value"])
    value = worst["displacement_z"]["min"]["value"] * 1e3
    assert code == 0 and worst["x"] == 6.0
    assert f"displacement is largest at x = 6 m, {value:.4g} mm" in err[-1]


def test_the_headline_of_a_point_at_the_support_says_so(here, capsys):
    given = ("run", "case.toml", "--out", "out", "--set", "output.points=[0.0]")
    assert ", displacement at x = 0 m is 0 mm" in command(capsys, *given)[2][-1]


def test_paths_of_changes_are_relative_to_the_case_like_those_in_it(here, capsys, monkeypatch):
    planar = shelf.data_file("vehicles", "xia2000_planar").read_text(encoding="utf-8")
    (here / "cases" / "cars").mkdir(parents=True)
    (here / "cases" / "cars" / "mine.toml").write_text(planar, encoding="utf-8")
    (here / "cases" / "case.toml").write_text(CASE, encoding="utf-8")
    case, change = "cases/case.toml", "train.vehicle=cars/mine.toml"
    code, out, _ = command(capsys, "check", case, "--set", change)
    assert code == 0 and "can be run" in out[0]
    found = rb.case(case, {"train.vehicle": "cars/mine.toml"})
    assert found.get("train.vehicle") == str(Path("cases/cars/mine.toml"))
    line = refused(capsys, "check", case, "--set", "train.vehicle=cases/cars/mine.toml")
    assert "no such file" in line
    absolute = f"train.vehicle={here / 'cases' / 'cars' / 'mine.toml'}"
    assert command(capsys, "check", case, "--set", absolute)[0] == 0
    # A shipped case stands nowhere that the user knows: there it is the folder one is in.
    monkeypatch.chdir(here / "cases")
    assert command(capsys, "check", "paper", "--set", "train.vehicle=cars/mine.toml")[0] == 0


HOSTILE = "\\u001b[31mred\\u0007\\u009b2J\\u202e"
"""In TOML: a colour, a bell, clearing of the screen and a change of direction."""


@pytest.mark.parametrize(
    "content",
    [
        CASE.replace("[train]", f'"{HOSTILE}" = 1\n[train]'),
        CASE.replace('"xia2000_planar"', f'"{HOSTILE}"'),
        CASE.replace('"xia2000_planar"', f'"{HOSTILE}.csv"'),
        CASE.replace("tail = 0.1", f'tail = "{HOSTILE}"'),
        CASE.replace('vehicle = "xia2000_planar"', f'vehicle = "xia2000"\ntrack = "{HOSTILE}"'),
        CASE.replace('"harmonic"', f'"{HOSTILE}"'),
    ],
)
def test_escapes_in_names_are_shown_not_obeyed(here, capsys, content):
    Path("case.toml").write_text(content, encoding="utf-8")
    line = refused(capsys, "check", "case.toml")
    # In a key as JSON writes it, in a value as Python does.
    assert line.isprintable() and re.search(r"\\(x1b|u001b)\[31m", line)


def test_escapes_in_names_of_files_are_shown_not_obeyed(here, capsys):
    name = "a\x1b[2Jb.toml"
    Path("case.toml").rename(name)
    code, out, err = command(capsys, "check", name)
    assert code == 0 and out[0].startswith("a\\x1b[2Jb.toml: can be run") and not err
    code, out, err = command(capsys, "run", name, "--out", "o\x07")
    assert code == 0 and err[-1].endswith("written to o\\x07") and err[-1].isprintable()
    with pytest.raises(SystemExit):
        cli.main(["check", name, "--\x1b[31m"])
    assert "\x1b" not in capsys.readouterr().err


def test_a_terminal_that_lacks_a_letter_is_told_all_the_same(here):
    Path("case.toml").rename("brücke \U0001f600.toml")
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    given = [sys.executable, "-m", "railbridge", "check", "brücke \U0001f600.toml"]
    done = subprocess.run(given, capture_output=True, env=environment)
    assert done.returncode == 0 and done.stdout.startswith(b"br\\xfccke \\U0001f600.toml: can be")


def test_schema_is_a_schema_and_every_shipped_case_fits_it():
    Draft202012Validator.check_schema(SCHEMA)
    for name in shelf.data_names("cases", ".toml"):
        VALID.validate(shelf.read_toml(shelf.data_file("cases", name)))
    VALID.validate(tomllib.loads(CASE))


@pytest.mark.parametrize(
    "change",
    [
        {"deck.file": "viaduct36"}, {"deck.length": None}, {"deck.spans": [6.0, 6.0]},
        {"deck.mass": None}, {"deck.mass": -1.0},
        {"deck.section": SECTION}, {"deck.damping": None}, {"deck.damping": 0.02},
        {"deck.damping.ratio": 0.1}, {"deck.mas": 1},
        {"train.vehicle": None}, {"train.axles": [0.0]}, {"train.cars": ["xia2000"]},
        {"train.cars": 0}, {"train.cars": "two"},
        {"train.notch": [{**NOTCH, "deep": 1}]}, {"track.vertical.kind": "x"},
        {"track.vertical.half_waves": 3.0},
        {"track.up": HARMONIC}, {"run.speed": None}, {"run.speed": 0.0}, {"run.speed": True},
        {"run.loads": "wheel"},
        {"run.relaxation": "newton"}, {"run.sped": 1.0}, {"output.points": []},
        {"output.point": [1.0]}, {"extra": {"a": 1}},
    ],
    ids=str,
)  # fmt: skip
def test_schema_and_loader_refuse_alike(change):
    content = _changed(tomllib.loads(CASE), change)
    assert not VALID.is_valid(content)
    with pytest.raises(rb.InputError):
        rb.Case(content)


def _changed(content, change):
    for path, value in change.items():
        *parents, last = path.split(".")
        place = content
        for parent in parents:
            place = place[parent]
        if value is None:
            place.pop(last)
        else:
            place[last] = value
    return content


# ---- anything at all

WORDS = st.sampled_from(
    sorted(
        {
            *SCHEMA["properties"],
            *(p for d in SCHEMA["$defs"].values() for p in d.get("properties", {})),
            "kind",
            "x",
        }
    )
)
LEAVES = (
    st.sampled_from(
        [
            "xia2000_planar",
            "viaduct36",
            "harmonic",
            "none",
            "table",
            "direct",
            "rigid",
            "wheels",
            "left",
            "",
            "a/b.toml",
        ]
    )
    | st.integers(-3, 60)
    | st.floats(allow_nan=True, allow_infinity=True)
    | st.sampled_from([0.0, 1e-3, 0.02, 1.0, 12.0, 5e9, 8000.0, 1e300])
    | st.booleans()
)
VALUES = st.recursive(
    LEAVES, lambda v: st.lists(v, max_size=3) | st.dictionaries(WORDS, v, max_size=4), max_leaves=8
)


@st.composite
def mutated(draw):
    """A valid case with some of its values, keys or tables replaced, added or taken away."""
    content = tomllib.loads(CASE)
    for _ in range(draw(st.integers(1, 3))):
        place = content
        while True:
            key = draw(st.sampled_from(sorted(place)))
            if not isinstance(place[key], dict) or not place[key] or draw(st.integers(0, 3)) == 0:
                break
            place = place[key]
        what = draw(st.integers(0, 3))
        if what == 0:
            del place[key]
            if not content:
                break
        elif what == 1:
            place[draw(WORDS)] = draw(VALUES)
        else:
            place[key] = draw(VALUES)
        if not place:
            break
    return content


def loaded_or_refused(content):
    try:
        case = rb.Case(content)
    except rb.InputError as error:
        assert str(error)
        return None
    return case


@settings(max_examples=250, suppress_health_check=list(HealthCheck))
@given(mutated())
def test_mutated_cases_are_loaded_or_refused_in_words(content):
    case = loaded_or_refused(content)
    if case is not None:
        # The schema is never stricter than the loader.
        assert VALID.is_valid(case.content), list(VALID.iter_errors(case.content))


@settings(max_examples=60, suppress_health_check=list(HealthCheck))
@given(st.dictionaries(WORDS | st.text(max_size=5), VALUES, max_size=5))
def test_random_tables_are_refused_in_words(content):
    loaded_or_refused(content)


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.binary(max_size=200)
    | st.text(max_size=200).map(str.encode)
    | st.sampled_from([CASE.encode()[:n] for n in range(0, 500, 9)])
)
def test_random_files_never_give_a_traceback(tmp_path, data):
    path = tmp_path / "case.toml"
    path.write_bytes(data)
    assert cli.main(["check", str(path)]) in (0, 2)


@settings(max_examples=25, suppress_health_check=list(HealthCheck))
@given(mutated())
def test_mutated_cases_that_load_also_run(tmp_path_factory, content):
    case = loaded_or_refused(content)
    if (
        case is None
        or len(case.train.wheels) > 40
        or (case.deck.length + case.train.length) / case.settings.speed > 20.0
    ):
        return
    if (
        case.settings.lead_in / case.settings.speed > 20.0
        or case.settings.tail > 20.0
        or case.settings.time_step < 1e-3
    ):
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            run = case.replace({"run.max_iterations": 3}).run()
        except rb.NotConvergedError as error:
            run = error.run
        cli.to_json(case.summary(run))


@settings(max_examples=60)
@given(
    st.lists(
        st.sampled_from(
            [
                "run",
                "new",
                "list",
                "check",
                "schema",
                "case.toml",
                "--out",
                "-q",
                "--set",
                "a=b",
                "",
                "\0",
                "é",
            ]
        ),
        max_size=4,
    )
)
def test_random_arguments_never_give_a_traceback(tmp_path_factory, arguments):
    if "new" in arguments[:1] or ("run" in arguments[:1] and "--out" in arguments):
        arguments = [*arguments, "--nothing"]  # only the parser is tried: no files
    try:
        assert cli.main(arguments) in (0, 2)
    except SystemExit as stop:
        assert stop.code == 2


# ---- what is said of a result


LIGHT = """
[deck]
length = 60.0
bending_stiffness_vertical = 3e10
mass = 3000.0
damping = { modal = 0.01 }
[train]
vehicle = "xia2000"
cars = 8
[run]
speed = 60.0
time_step = 4e-3
iterations = 8
"""


def test_passes_that_diverge_say_so_in_word_code_and_remarks(tmp_path, capsys):
    """They said "solved", and exit code 0, of a deck that sagged by metres."""
    (tmp_path / "light.toml").write_text(LIGHT)
    arguments = ["run", str(tmp_path / "light.toml"), "--out", str(tmp_path / "out")]
    assert cli.main([*arguments, "--no-histories"]) == 3
    err = capsys.readouterr().err
    assert "warning: run.iterations = 8: the last pass still changed" in err
    assert "railbridge: not settled: 8 iterations, last change " in err and "solved" not in err
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert any(text.startswith("run.iterations = 8: ") for text in summary["remarks"])
    assert summary["converged"] is False and summary["changes"][-1] > 0.01
    assert cli.main([*arguments, "--no-histories", "--set", "run.iterations=1"]) == 0
    assert "1 iteration, last change 1, " in capsys.readouterr().err


def test_wheel_forces_on_the_deck_stand_beside_those_of_the_whole_record(tmp_path):
    case = rb.case("paper").replace({"train.cars": 2, "run.time_step": 2e-3})
    run = case.compute()
    summary = case.summary(run)
    forces = run.wheel_forces[:, 1]
    on = np.array([
        (20.0 * run.time - w.delay > -1e-6) & (20.0 * run.time - w.delay < 36.0 + 1e-6)
        for w in run.train.wheels
    ])  # fmt: skip
    told = summary["wheel_force_z"]
    assert told["min"]["value"] == forces.min() <= told["on_deck"]["min"]["value"]
    assert told["on_deck"]["min"]["value"] == forces[on].min()
    assert told["on_deck"]["max"]["value"] == forces[on].max()
    unloading = summary["wheel_unloading"]
    assert unloading["on_deck"]["max"]["value"] == run.wheel_unloading[on].max()
    assert unloading["max"]["value"] >= unloading["on_deck"]["max"]["value"]


# ---- the page that describes it


def test_the_page_on_cases_names_every_key_and_its_example_runs():
    page = (Path(__file__).resolve().parents[2] / "docs" / "case.md").read_text(encoding="utf-8")
    words = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`\n]+)`", page))))
    wanted = {p for d in SCHEMA["$defs"].values() for p in d.get("properties", {})} | set(
        SCHEMA["properties"]
    )
    summary = (
        rb.case("paper")
        .replace({"train.cars": 1, "run.time_step": 4e-3, "run.interaction": "rigid"})
        .summary()
    )

    def names(value):
        if isinstance(value, dict):
            return set(value).union(*map(names, value.values()))
        return set().union(*map(names, value)) if isinstance(value, list) else set()

    assert (wanted | names(summary)) - words - {"count", "t"} == set()
    example = tomllib.loads(re.search(r"```toml\n(.*?)```", page, re.DOTALL).group(1))
    VALID.validate(example)
    rb.Case(example)
