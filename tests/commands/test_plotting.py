"""The command `plot`: which files it writes, what it says, and what it refuses in one line."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

import railbridge as rb
from railbridge.commands import command as cli
from railbridge.plots import gallery

CASE = (Path(__file__).parents[1] / "quick_case.toml").read_text(encoding="utf-8")
NAMES = {
    "train", "displacement_at_6m", "acceleration_at_6m", "section_forces_at_6m", "envelope",
    "reactions", "wheels_1", "cars_1", "spectrum", "iterations", "convergence",
}  # fmt: skip
FEW = ("--only", "convergence")
PAGE = (Path(__file__).resolve().parents[2] / "docs" / "case.md").read_text(encoding="utf-8")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("case.toml").write_text(CASE, encoding="utf-8")
    return tmp_path


def command(capsys, *arguments):
    code = cli.main(["plot", "case.toml", *arguments])
    shown = capsys.readouterr()
    return code, shown.out.splitlines(), shown.err.splitlines()


def test_all_pictures_are_written_and_nothing_else(here, capsys):
    code, out, err = command(capsys, "--out", "new/o", "--dpi", "40")
    assert (code, out) == (0, [])
    assert err[-1:] == ["railbridge: 11 pictures written to new/o"]
    assert set(os.listdir("new/o")) == {f"{name}.png" for name in NAMES}
    assert set(os.listdir()) == {"case.toml", "new"}
    for name in NAMES:
        with Image.open(f"new/o/{name}.png") as image:
            assert image.format == "PNG" and image.width == 360


def test_files_of_these_names_are_replaced_and_others_left(here, capsys):
    Path("o").mkdir()
    for name in ("convergence.svg", "convergence.png", "train.svg", "mine.txt"):
        Path("o", name).write_text("old")
    assert command(capsys, "--out", "o", *FEW, "--format", "svg", "-q") == (0, [], [])
    assert {p.name: p.read_text() == "old" for p in Path("o").iterdir()} == {
        "convergence.svg": False, "convergence.png": True, "train.svg": True, "mine.txt": True,
    }  # fmt: skip
    first = Path("o/convergence.svg").read_bytes()
    assert b"<svg" in first
    command(capsys, "--out", "p", *FEW, "--format", "svg", "-q")
    assert Path("p/convergence.svg").read_bytes() == first


def test_only_what_is_asked_for_is_drawn_of_the_cars_asked_for(here, capsys):
    asked = ("--only", "wheels", "train", "--cars", "3, 1", "--format", "pdf", "--dpi", "30")
    changed = ("--set", "train.cars=3", "--set", "output.points=[3.0]")
    code, _, err = command(capsys, "--out", "o", *asked, *changed)
    assert code == 0 and err == ["railbridge: 3 pictures written to o"]
    assert set(os.listdir("o")) == {"train.pdf", "wheels_1.pdf", "wheels_3.pdf"}
    assert Path("o/train.pdf").read_bytes().startswith(b"%PDF")
    # Written twice, the option counts both times.
    asked = ("--only", "displacement", "--only", "convergence")
    command(capsys, "--out", "p", *asked, *changed)
    assert set(os.listdir("p")) == {"displacement_at_3m.png", "convergence.png"}


def test_what_cannot_be_drawn_is_said(here, capsys):
    bare = CASE.replace('vehicle = "xia2000_planar"', "axles = [0.0, 3.0]\nloads = [2e5, 1e5]")
    Path("case.toml").write_text(bare.replace("tolerance = 1e-3\n", ""))
    asked = ("--only", "displacement", "wheels", "cars", "--dpi", "30")
    code, _, err = command(capsys, "--out", "o", *asked)
    assert code == 0 and set(os.listdir("o")) == {"displacement_at_6m.png"}
    assert err[-3:] == [
        "railbridge: left out: wheels (bare axle loads are constant)",
        "railbridge: left out: cars (bare axle loads have no bodies)",
        "railbridge: 1 picture written to o",
    ]
    # What stood there of an earlier train is gone, so that no picture shows another run.
    Path("o/wheels_1.png").write_text("old")
    assert command(capsys, "--out", "o", *asked, "-q")[0] == 0
    assert set(os.listdir("o")) == {"displacement_at_6m.png"}


def test_pictures_show_the_run_of_the_case(here, capsys, monkeypatch):
    shown = []
    original = gallery.figures_of

    def spied(run, *rest):
        shown.append((run, *rest))
        return original(run, *rest)

    monkeypatch.setattr(gallery, "figures_of", spied)
    command(capsys, "--out", "o", *FEW, "--set", "run.speed=30", "--dpi", "30")
    ((run, points, cars, kinds),) = shown
    assert (list(points), cars, kinds) == ([6.0], [1], ["convergence"])
    expected = rb.case("case.toml", {"run.speed": 30.0}).compute()
    assert run.changes == expected.changes


def test_a_run_that_does_not_converge_is_drawn_and_said(here, capsys):
    limit = ("--set", "run.max_iterations=1", "--dpi", "30")
    code, _, err = command(capsys, "--out", "o", *FEW, *limit)
    assert code == 3 and os.listdir("o") == ["convergence.png"]
    assert "run.max_iterations" in err[0] and err[0].endswith("drawn all the same.")


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("--only", "displacment"), "--only = 'displacment': .*Did you mean 'displacement'"),
        (("--format", "jpg"), "--format = 'jpg': must be one of png, svg, pdf"),
        (("--dpi", "29"), "--dpi = 29: .*at least 30"),
        (("--dpi", "1201"), "--dpi = 1201: .*at most 1200"),
        (("--cars", "2"), "--cars = 2: .*at most 1"),
        (("--cars", "0"), "--cars = 0: .*at least 1"),
        (("--cars", "1;2"), "--cars = '1;2': is no list of cars"),
        (("--set", "run.sped=3"), "run.sped"),
        (("--out", "case.toml"), "--out = 'case.toml': is a file"),
    ],
)
def test_slips_are_refused_before_anything_is_computed(here, capsys, monkeypatch, arguments, why):
    monkeypatch.setattr(rb.Case, "compute", lambda *_: pytest.fail("computed"))
    code, out, err = command(capsys, "--out", "o", *arguments)
    assert (code, out, len(err)) == (2, [], 1)
    assert re.search(why, err[0])
    assert os.listdir() == ["case.toml"]


def test_strict_refuses_doubts_and_draws_nothing(here, capsys):
    slip = ("--set", "run.speed=144", "--out", "o", *FEW)
    code, out, err = command(capsys, *slip, "--strict")
    assert (code, out, len(err), os.path.exists("o")) == (2, [], 1, False)
    code, _, err = command(capsys, *slip, "-q", "--dpi", "30")
    assert code == 0 and len(err) == 1 and "warning: run.speed" in err[0]


@pytest.mark.parametrize("existing", [True, False])
@pytest.mark.parametrize(
    ("error", "code"), [(KeyboardInterrupt(), 130), (MemoryError(), 1), (OSError(28, "full"), 1)]
)
def test_what_stops_in_the_middle_leaves_nothing(here, capsys, monkeypatch, error, code, existing):
    original = gallery.write

    def broken(figure, path, *rest):
        original(figure, path, *rest)
        raise error

    monkeypatch.setattr(gallery, "write", broken)
    if existing:
        Path("o").mkdir()
        Path("o/convergence.png").write_text("old")
    stopped, out, err = command(capsys, "--out", "o", *FEW)
    assert (stopped, out, len(err)) == (code, [], 1)
    if existing:
        assert [(p.name, p.read_text()) for p in Path("o").iterdir()] == [
            ("convergence.png", "old")
        ]
    else:
        assert os.listdir() == ["case.toml"]


def test_it_draws_without_a_screen_and_other_commands_do_without_matplotlib(here):
    """Whatever windows the user has chosen; and help names all that can be drawn."""
    script = (
        "import sys\nfrom railbridge.commands.command import main\n"
        "main(['check', 'case.toml'])\nassert 'matplotlib' not in sys.modules\n"
        "main(['plot', 'case.toml', '--out', 'o', '--only', 'train', '-q'])\n"
        "assert 'matplotlib.pyplot' not in sys.modules\nmain(['plot', '--help'])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True,
        env={**os.environ, "MPLBACKEND": "TkAgg", "DISPLAY": ""},
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    assert os.listdir("o") == ["train.png"]
    for name, about in gallery.KINDS.items():
        assert re.search(rf"^  {name} +{re.escape(about)}$", done.stdout, re.MULTILINE), name


def test_the_command_is_listed_and_the_page_on_cases_is_true(here, capsys):
    with pytest.raises(SystemExit):
        cli.main(["--help"])
    assert re.search(r"^ +plot +run a case and draw", capsys.readouterr().out, re.MULTILINE)
    with pytest.raises(SystemExit):
        cli.main(["plot", "--help"])
    said = capsys.readouterr().out
    chapter = PAGE.partition("## Pictures")[2].partition("\n## ")[0]
    for option in set(re.findall(r"(?<![-\w])--[a-z]+", chapter)):
        assert option in said, option
    lines = set(re.findall(r"^railbridge (plot .*?)(?: +#.*)?$", PAGE, re.MULTILINE))
    assert len(lines) == 2
    for line in lines:
        eight = ["--set", "train.cars=8", "--set", "run.interaction=rigid", "--dpi", "30", "-q"]
        assert cli.main([*shlex.split(line), *eight]) == 0
    found = set(os.listdir("pictures"))
    assert {"displacement_at_6m.svg", "wheels_8.svg", "train.png"} <= found
