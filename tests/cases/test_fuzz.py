"""Hostile files and changes: whatever is typed is computed or refused in one line.

Seeded, so that a failure comes again. RAILBRIDGE_FUZZ multiplies how many are tried (1: a few
seconds), RAILBRIDGE_FUZZ_SEED chooses others.
"""

import json
import os
import shutil

import numpy as np
import pytest

from railbridge.cases import pages, shelf
from railbridge.commands import command as cli
from railbridge.errors import InputError
from railbridge.settings import bytes_needed

SIZE = float(os.environ.get("RAILBRIDGE_FUZZ", "1"))
SEED = int(os.environ.get("RAILBRIDGE_FUZZ_SEED", "20261128"))
LARGEST = 2e8
"""Bytes: runs that need more are checked only."""

CASES = {
    "own.toml": """
[deck]
spans = [12.1, 12.2]
continuous = false
bending_stiffness_vertical = 5e9
bending_stiffness_lateral = 5e10
torsional_stiffness = 3e9
polar_inertia = 2e4
axial_stiffness = 3e10
mass = 8000.0
damping = { ratio = 0.02, frequencies_hz = [3.0, 30.0] }
modes = 3
elements = 24
width = 6.0
tracks = { left = 1.5 }
[[deck.bearing]]
x = 0.0
fixed = "x z"
stiffness = { y = 2e9, roll = 1e9 }
y = 1.0
[[deck.bearing]]
x = 12.1
fixed = ["y", "z"]
[[deck.bearing]]
x = 24.3
fixed = "x y z roll"
[train]
cars = ["mine.csv", { vehicle = "planar.toml", count = 2 }]
car_spacing = 23.0
track = "left"
[[train.notch]]
wheels = [[1, 1]]
circumference = 2.8
offset = 0.0
depth = 1e-3
length = 1.5
[track]
vertical = { left = { kind = "table", x = [0.0, 5.0, 9.0], r = [0.0, 1e-3, 0.0] }, right = [{ \
kind = "harmonic", amplitude = 1e-3, wavelength = 10.0 }, { kind = "none" }] }
lateral = { kind = "harmonic", amplitude = 1e-3, length = 24.0, half_waves = 5.0 }
[run]
speed = 60.0
time_step = 2e-3
lead_in = 0.0
tail = 0.1
iterations = 1
relaxation = 0.5
[output]
points = [6.0, 24.3]
""",
    "bare.toml": """
[deck]
length = 20.0
section = { youngs_modulus = 34e9, poisson_ratio = 0.2, density = 2500.0, area = 6.6, \
second_moment_vertical = 0.66, second_moment_lateral = 19.8, torsion_constant = 2.3 }
damping = { modal = 0.01 }
modes = 4
[train]
axles = [0.0, 3.0, 11.0]
loads = [2e5, 2e5, 1e5]
[run]
speed = 60.0
time_step = 2e-3
interaction = "rigid"
tail = 0.1
""",
    "inline.toml": """
[deck]
modes = { nodes = "nodes.csv", modes = "modes.csv", masses = "masses.csv", units = ["mm", "t"], \
axes = ["x", "y", "z"], rail = { y = 0.0, z = 0.0, within = 0.01 }, axis = { y = 0.0, z = 0.0 }, \
supports = [0.0, 36.0], count = 4, unusual = false }
damping = { modal = 0.01 }
track_height = 0.5
[train]
vehicle = "planar.toml"
[run]
speed = 60.0
time_step = 2e-3
interaction = "rigid"
tail = 0.1
""",
    "listed.toml": """
[deck]
length = 12.0
bending_stiffness_vertical = 5e9
mass = 8000.0
damping = { per_mode = [0.02, 0.01] }
modes = 3
[[deck.point_mass]]
x = 4.0
mass = 5e3
y = 1.0
z = -0.5
roll_inertia = 1e3
[[deck.bearing]]
x = 0.0
fixed = "x z"
pier = { height = 8.0, youngs_modulus = 33e9, area = 2.0, second_moment_along = 0.5, \
second_moment_across = 0.5 }
[[deck.bearing]]
x = 12.0
fixed = "z"
[train]
file = "axles.csv"
track = 0.0
[run]
speed = 60.0
time_step = 2e-3
tail = 0.1
""",
    "named.toml": """
[deck]
length = 12.0
bending_stiffness_vertical = 5e9
mass = 8000.0
damping = { alpha = 0.5, beta = 1e-4 }
modes = 3
[train]
name = "D4"
wagons = 2
[run]
speed = 60.0
time_step = 2e-3
tail = 0.1
""",
    "foreign.toml": """
[deck]
file = "deck.toml"
[train]
vehicle = "planar.toml"
[run]
speed = 60.0
time_step = 2e-3
lead_in = 0.0
tail = 0.1
interaction = "direct"
""",
}
AXLES = """\
# name: two wagons
# source: a drawing
spacing (mm);load (t);note
;22,5;first
1800;22,5;
4650;20;
1800;20;last
"""
LETTERS = [
    '"', "'", ",", ";", "=", "[", "]", "{", "}", "\n", "\t", "#", ".", "-", "e", "0", "9", " ",
    "\x00", "\x1b[31m", "\ufeff", "\u202e", "\U0001f600", "$x^$", "nan", "1e308", "1,5", "\r",
]  # fmt: skip
VALUES = [
    0, -1, 1, 1e-30, 1e30, 1e300, -1e-300, 10**400, 0.5, 2.5, True, float("nan"), float("inf"), "",
    " ", "x", "\x00", "\x1b]0;x\x07", "\U0001f600", "a" * 5000, "../" * 2000 + "x.csv", "a\x00.csv",
    "a\x00.toml", "/", ".", "mine.csv", "planar.toml", "xia2000", "left", "z", [], "x y z roll",
    [[]], [0.0], [0.0, 0.0], [1.0, 0.0], [1, "a"], [[1, 1]], ["z", "z"], {}, {"": 1},
    {"modal": 0.02}, {"kind": "none"}, {"a\nb": {"c": 1}}, {"y": 1e9},
    {"x": 0.0, "y": 1.5, "z": -1.3, "fixed": "x y z"},
    [{"x": 0.0, "z": -1.3, "fixed": "z", "stiffness": {"y": 1e9}}, {"x": 20.0, "fixed": "z"}],
    [{"x": 0.0, "fixed": "z"}, {"x": 20.0, "fixed": "z", "stiffness": {"roll": 1e3, "x": 1e9}}],
    [{"x": 0.0, "fixed": "z pitch", "stiffness": {"yaw": 1e9}}], [{"x": 1.0}],
]  # fmt: skip
PATHS = [
    "run.speed", "train", "deck", "deck.bearing", "deck.bearing", "deck.modes", "track.vertical",
    "a" * 900, ".".join("a" * 900), "..", "x.",
]  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Cases with all kinds of files beside them."""
    place = tmp_path_factory.mktemp("fuzz")
    for name, text in CASES.items():
        (place / name).write_text(text, encoding="utf-8")
    (place / "starter.toml").write_text(pages.starter("starter.toml"), encoding="utf-8")
    (place / "axles.csv").write_text(AXLES, encoding="utf-8")
    vehicles = shelf.data_root() / "vehicles"
    shutil.copy(vehicles / "xia2000.csv", place / "mine.csv")
    shutil.copy(vehicles / "xia2000_planar.toml", place / "planar.toml")
    example = shelf.data_root() / "exchange" / "viaduct36_mm"
    for name in ("deck.toml", "nodes.csv", "modes.csv", "masses.csv"):
        shutil.copy(example / name, place / name)
    return place


def spoiled(random, text):
    """Return a file with a few slips of the hand in it."""
    for _ in range(random.integers(1, 4)):
        lines = text.split("\n")
        i, kind = int(random.integers(len(lines))), int(random.integers(7))
        at = int(random.integers(len(lines[i]) + 1))
        letter = LETTERS[random.integers(len(LETTERS))]
        if kind == 0:
            del lines[i]
        elif kind == 1:
            lines.insert(i, lines[int(random.integers(len(lines)))])
        elif kind == 2:
            lines[i] = lines[i][:at] + letter + lines[i][at:]
        elif kind == 3:
            lines[i] = lines[i][:at]
        elif kind == 4:
            lines[i] = lines[i].replace(str(random.integers(10)), letter)
        elif kind == 5:
            lines[i] = letter.join(lines[i].split(","))
        else:
            lines[i] = lines[i][:at] + letter * int(random.choice([2, 150_000])) + lines[i][at:]
        text = "\n".join(lines) or "\n"
    return text


def keys_of(tables, path=""):
    for key, value in tables.items():
        yield path + key
        if isinstance(value, dict):
            yield from keys_of(value, f"{path}{key}.")


def in_toml(value):
    if isinstance(value, str):
        return json.dumps(value).replace("\\u0000", "\x00")
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {in_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(in_toml, value)) + "]"
    return str(value).lower() if isinstance(value, bool) else repr(value)


def told(capsys, monkeypatch, *arguments):
    """Run the command: an answer or one line, and never a traceback."""
    ran = []

    def small(loaded, *_, **__):
        needed = bytes_needed(loaded.train, loaded.deck, loaded.settings, len(loaded.points))
        if needed > LARGEST:
            raise InputError("run", None, "is too large for a test")
        ran.append(True)
        return compute(loaded)

    compute = cli.Case.compute
    monkeypatch.setattr(cli.Case, "compute", small)
    code = cli.main(list(arguments))
    monkeypatch.undo()
    out, err = capsys.readouterr()
    said = [line for line in err.splitlines() if not line.startswith("railbridge: warning: ")]
    assert code in (0, 2, 3), err
    assert code == 0 or len(said) == 1, err
    for line in (out + err).splitlines():
        assert line.isprintable() and len(line) < 1000, ascii(line[:300])
    return code


def tried(capsys, monkeypatch, folder, case, *changes):
    given = [str(folder / case), *(part for c in changes for part in ("--set", c))]
    if told(capsys, monkeypatch, "check", *given) == 0:
        out = folder / "out"
        if told(capsys, monkeypatch, "run", *given, "--no-histories", "--out", str(out)) == 0:
            summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
            assert None not in summary["deck_frequencies_hz"]
        shutil.rmtree(out, ignore_errors=True)


@pytest.mark.parametrize("case", [*CASES, "starter.toml"])
def test_the_files_are_good_before_they_are_spoiled(case, folder, capsys, monkeypatch):
    assert told(capsys, monkeypatch, "check", str(folder / case)) == 0
    out = str(folder / "out")
    assert told(capsys, monkeypatch, "run", str(folder / case), "--out", out) == 0


@pytest.mark.parametrize("file", [*CASES, "axles.csv", "mine.csv", "planar.toml", "deck.toml",
                                  "nodes.csv", "modes.csv", "masses.csv",
                                  "starter.toml"])  # fmt: skip
def test_spoiled_files_are_computed_or_refused_in_one_line(file, folder, capsys, monkeypatch):
    random = np.random.default_rng([SEED, sum(file.encode())])
    case = file if file in (*CASES, "starter.toml") else None
    beside = {"mine.csv": "own.toml", "planar.toml": "own.toml", "axles.csv": "listed.toml"}
    case = case or beside.get(file, "foreign.toml")
    good = (folder / file).read_bytes()
    try:
        for _ in range(int(12 * SIZE)):
            text = spoiled(random, good.decode())
            (folder / file).write_bytes(text.encode("utf-8"))
            tried(capsys, monkeypatch, folder, case)
    finally:
        (folder / file).write_bytes(good)


@pytest.mark.parametrize("case", [*CASES, "starter.toml"])
def test_hostile_changes_are_computed_or_refused_in_one_line(case, folder, capsys, monkeypatch):
    random = np.random.default_rng([SEED, 1, sum(case.encode())])
    keys = [*keys_of(shelf.read_toml(folder / case)), *PATHS]
    for _ in range(int(40 * SIZE)):
        changes = []
        for _ in range(random.integers(1, 3)):
            value = VALUES[random.integers(len(VALUES))]
            changes.append(f"{keys[random.integers(len(keys))]}={in_toml(value)}")
        tried(capsys, monkeypatch, folder, case, *changes)


def test_ill_scaled_decks_are_computed_or_refused_in_one_line(folder, capsys, monkeypatch):
    random = np.random.default_rng([SEED, 2])
    numbers = ("bending_stiffness_vertical", "bending_stiffness_lateral", "torsional_stiffness",
               "polar_inertia", "axial_stiffness", "mass")  # fmt: skip
    given = shelf.read_toml(folder / "own.toml")["deck"]
    for _ in range(int(20 * SIZE)):
        chosen = random.choice(numbers, size=2, replace=False)
        scaled = (f"{k}={given[k] * 10 ** random.uniform(-14, 14)!r}" for k in chosen)
        tried(capsys, monkeypatch, folder, "own.toml", *(f"deck.{change}" for change in scaled))
