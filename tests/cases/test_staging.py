"""Folders of results appear as a whole; who else wants to write there is told at the start."""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from railbridge.cases import staging
from railbridge.commands import command as cli
from railbridge.errors import InputError

NAMES = ("a.csv", "b.csv", "summary.json")
locks = pytest.mark.skipif(staging.fcntl is None, reason="no locks on folders there")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def written(folder, text, names=NAMES):
    for name in names:
        Path(folder, name).write_text(text)


def found(folder):
    return {p.name: p.read_text() for p in Path(folder).iterdir() if p.is_file()}


@pytest.mark.parametrize("existing", [True, False])
def test_files_appear_together_and_others_stay(here, existing):
    if existing:
        Path("r").mkdir()
        written("r", "old", [*NAMES, "mine.txt"])
    with staging.files("r", "--out", NAMES) as scratch:
        written(scratch, "new", ["a.csv", "summary.json"])
        assert (
            found("r") == dict.fromkeys([*NAMES, "mine.txt"], "old")
            if existing
            else (not Path("r").exists())
        )
    assert found("r") == {"a.csv": "new", "summary.json": "new"} | (
        {"mine.txt": "old"} if existing else {}
    )
    assert os.listdir() == ["r"]


@locks
@pytest.mark.parametrize("existing", [True, False])
def test_the_second_is_told_at_its_start_and_the_first_keeps_all(here, existing):
    if existing:
        Path("r").mkdir()
    with staging.files("r", "--out", NAMES) as scratch:
        written(scratch, "first")
        for out in ("r", "./r/", str(here / "r")):
            with pytest.raises(InputError, match="another railbridge is writing into this folder"):
                staging.folder(out, "--out").__enter__()
    assert found("r") == dict.fromkeys(NAMES, "first")
    assert os.listdir() == ["r"]
    with staging.files("r", "--out", NAMES) as scratch:
        written(scratch, "later")
    assert found("r") == dict.fromkeys(NAMES, "later")


@locks
def test_a_crowd_in_threads_writes_one_after_the_other(here):
    """Whoever is let in writes all its files; nobody who was let in loses them."""
    done, refused = [], []

    def run(mark):
        try:
            with staging.files("r", "--out", NAMES) as scratch:
                written(scratch, mark)
                time.sleep(0.002)
            done.append(mark)
        except InputError:
            refused.append(mark)

    crowd = [threading.Thread(target=run, args=(str(i),)) for i in range(40)]
    for each in crowd:
        each.start()
    for each in crowd:
        each.join()
    assert len(done) + len(refused) == 40 and done
    assert set(found("r")) == set(NAMES)
    assert len(set(found("r").values())) == 1
    assert os.listdir() == ["r"]


@locks
@pytest.mark.parametrize("existing", [True, False])
def test_what_a_killed_run_left_stands_in_nobodys_way(here, existing):
    if existing:
        Path("r").mkdir()
    program = (
        "import os\nfrom railbridge.cases import staging\n"
        "with staging.files('r', '--out', ['a.csv']) as scratch:\n"
        "    (scratch / 'half').write_text('x')\n    (scratch / 'deep').mkdir()\n"
        "    os.kill(os.getpid(), 9)\n"
    )
    subprocess.run([sys.executable, "-c", program])
    assert any(p.name.startswith(".railbridge-") for p in here.rglob("*"))
    with staging.files("r", "--out", NAMES) as scratch:
        assert os.listdir(scratch) == []
        written(scratch, "new")
    assert found("r") == dict.fromkeys(NAMES, "new")
    assert os.listdir() == ["r"] and set(os.listdir("r")) == set(NAMES)


@pytest.mark.parametrize("content", [{}, {"a.csv": "theirs", "mine.txt": "mine"}])
def test_a_folder_that_appears_meanwhile_costs_nothing(here, content):
    with staging.files("r", "--out", NAMES) as scratch:
        written(scratch, "new")
        Path("r").mkdir()
        for name, text in content.items():
            Path("r", name).write_text(text)
    assert found("r") == content | dict.fromkeys(NAMES, "new")
    assert os.listdir() == ["r"]


@pytest.mark.parametrize("broken", range(6))
def test_what_cannot_be_replaced_leaves_all_as_it_was(here, monkeypatch, broken):
    Path("r").mkdir()
    written("r", "old")
    whole, moves = Path.replace, []

    def replace(self, target):
        moves.append(self)
        if len(moves) == broken + 1:
            raise PermissionError(13, "in use", str(self))
        return whole(self, target)

    with pytest.raises(PermissionError), staging.files("r", "--out", NAMES) as scratch:
        written(scratch, "new")
        monkeypatch.setattr(Path, "replace", replace)
    monkeypatch.undo()
    os.chdir(here)
    assert len(moves) > broken
    assert found("r") == dict.fromkeys(NAMES, "old")


def test_a_folder_where_a_result_goes_is_refused_at_the_start(here):
    Path("r", "b.csv").mkdir(parents=True)
    with pytest.raises(InputError, match=r"--out = 'r': holds a folder named b\.csv"):
        staging.files("r", "--out", NAMES).__enter__()


def test_without_locks_everybody_has_a_folder_of_their_own(here, monkeypatch):
    """As on Windows: nobody is told, nobody loses anything, and files do not mix."""
    monkeypatch.setattr(staging, "fcntl", None)
    with staging.files("r", "--out", NAMES) as first, staging.files("r", "--out", NAMES) as second:
        written(first, "first")
        written(second, "second")
    assert found("r") == dict.fromkeys(NAMES, "first")
    assert os.listdir() == ["r"]


@pytest.mark.skipif(os.name == "nt", reason="signals differ")
def test_nothing_disturbs_what_must_not_be_left_half_done(here):
    with staging.undisturbed():
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            os.kill(os.getpid(), number)
    with pytest.raises(KeyboardInterrupt):
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(1.0)


@pytest.mark.skipif(os.name == "nt", reason="signals differ")
def test_who_must_end_cleans_up_first_and_nohup_is_respected(here):
    before = signal.getsignal(signal.SIGHUP), signal.getsignal(signal.SIGTERM)
    try:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        with (
            pytest.raises(staging.Stopped) as stopped,
            staging.stopping(),
            staging.files("new/r", "--out", NAMES) as scratch,
        ):
            written(scratch, "half")
            os.kill(os.getpid(), signal.SIGHUP)
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(1.0)
        assert stopped.value.number == signal.SIGTERM
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    finally:
        signal.signal(signal.SIGHUP, before[0])
        signal.signal(signal.SIGTERM, before[1])
    assert os.listdir() == []


def test_the_command_refuses_before_it_computes(here, capsys, monkeypatch):
    if staging.fcntl is None:
        pytest.skip("no locks on folders there")
    monkeypatch.setattr(cli.Case, "run", lambda *_: pytest.fail("it computes"))
    with staging.files("r", "--out", NAMES):
        assert cli.main(["run", "paper", "--out", "r"]) == 2
    assert "--out = 'r': another railbridge is writing" in capsys.readouterr().err
