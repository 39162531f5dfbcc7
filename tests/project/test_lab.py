"""`make lab`: JupyterLab opens on copies; the suite's own files stay as they are."""

import os
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from urllib.error import HTTPError

import pytest
from served import Server, answers, port_in, running, wait_until

import lab
from railbridge.commands import copies as lessons

ROOT = Path(__file__).resolve().parents[2]
FIRST = "00_start_here.ipynb"
TOKEN = "of-this-test-only"


@contextmanager
def opened(home, *options):
    """JupyterLab as `make lab` starts it, with everything that it stores below one folder."""
    server_options = ("--no-browser", "--ServerApp.port=0", "--ServerApp.allow_root=True")
    token = f"--IdentityProvider.token={TOKEN}"
    command = [sys.executable, ROOT / "tools" / "lab.py", *options, *server_options, token]
    with running(command, home, home) as (process, log):
        note = home / "runtime" / f"jpserver-{process.pid}.json"
        wait_until(note.exists, process, log)
        url = f"http://127.0.0.1:{wait_until(lambda: port_in(note), process, log)}"
        wait_until(lambda: answers(f"{url}/api/status", TOKEN), process, log)
        yield Server(url, TOKEN, log)


@pytest.fixture(scope="module")
def mine(tmp_path_factory):
    """The folder of a student who started it once."""
    return tmp_path_factory.mktemp("lab") / "mine"


@pytest.fixture(scope="module")
def server(mine):
    with opened(mine.parent / "home", "--folder", str(mine)) as server:
        yield server


def test_the_first_page_opens(server):
    assert answers(f"{server.url}/lab/tree/{FIRST}", TOKEN)
    page = server.ask(f"api/contents/{FIRST}")
    assert page["type"] == "notebook" and page["writable"]
    assert f"/lab/tree/{FIRST}" in server.said()


def test_only_copies_can_be_reached(server, mine):
    names = {entry["name"] for entry in server.ask("api/contents")["content"]}
    assert {FIRST, "data", "README.md"} <= names
    assert "helpers" not in names and "notebooks" not in names
    for outside in ("../notebooks", "notebooks", "helpers"):
        with pytest.raises(HTTPError):
            server.ask(f"api/contents/{outside}")


def test_what_is_saved_goes_into_the_copy_and_is_kept_by_the_next_start(server, mine):
    before = {path: path.read_bytes() for path in (ROOT / "notebooks").iterdir() if path.is_file()}
    page = server.ask(f"api/contents/{FIRST}")
    page["content"]["cells"][0]["source"] = "# My own title"
    server.ask(f"api/contents/{FIRST}", {k: page[k] for k in ("type", "format", "content")}, "PUT")
    assert "My own title" in (mine / FIRST).read_text(encoding="utf-8")
    assert {p: p.read_bytes() for p in (ROOT / "notebooks").iterdir() if p.is_file()} == before
    assert [line for line in lab.copies(mine) if FIRST in line] == [f"kept      {FIRST}"]
    assert "My own title" in (mine / FIRST).read_text(encoding="utf-8")


def test_nobody_is_asked_about_news_and_nothing_is_fetched(server):
    """The question would stand in front of the first page; an update is the suite's business."""
    plugin = server.ask("lab/api/settings/@jupyterlab/apputils-extension:notification")
    asks = plugin["schema"]["properties"]
    assert (asks["fetchNews"]["default"], asks["checkForUpdates"]["default"]) == ("false", False)


def told(monkeypatch):
    """Let lab.py start nothing; return what JupyterLab would have been told."""
    said = []
    monkeypatch.setattr(lab, "open_jupyterlab", said.extend)
    return said


def test_without_a_word_it_is_the_folder_that_git_does_not_see(monkeypatch, capsys):
    said, asked = told(monkeypatch), []
    monkeypatch.setattr(lab, "copies", lambda folder: asked.append(folder) or [])
    lab.main(["--no-browser", "--port=8899"])
    assert asked == [ROOT / "my-notebooks"] == [lab.FOLDER]
    assert f"--ServerApp.root_dir={lab.FOLDER}" in said
    assert f"--LabApp.default_url=/lab/tree/{FIRST}" in said
    assert said[-2:] == ["--no-browser", "--port=8899"], "what is not ours goes on to JupyterLab"
    assert str(lab.FOLDER) in capsys.readouterr().out
    assert "my-notebooks/" in (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines()


def test_a_folder_is_named_from_where_one_stands(monkeypatch, tmp_path):
    said = told(monkeypatch)
    monkeypatch.chdir(tmp_path)
    lab.main(["--folder", "course"])
    assert (tmp_path / "course" / FIRST).read_bytes() == lessons.contents()[FIRST]
    assert f"--ServerApp.root_dir={tmp_path / 'course'}" in said


def test_who_changes_the_suite_opens_its_own_files(monkeypatch):
    said = told(monkeypatch)
    monkeypatch.setattr(lab, "copies", lambda folder: pytest.fail("nothing is to be copied"))
    lab.main(["--tracked"])
    assert f"--ServerApp.root_dir={ROOT}" in said
    assert f"--LabApp.default_url=/lab/tree/notebooks/{FIRST}" in said


def test_a_folder_that_will_not_do_is_said_before_anything_opens(monkeypatch, tmp_path, capfd):
    monkeypatch.setattr(lab, "open_jupyterlab", lambda _: pytest.fail("nothing is to be opened"))
    (tmp_path / "a.txt").touch()
    with pytest.raises(SystemExit) as ended:
        lab.main(["--folder", str(tmp_path / "a.txt")])
    assert ended.value.code == 2 and "is a file, not a folder" in capfd.readouterr().err


def test_kept_copies_are_explained(monkeypatch, tmp_path, capsys):
    told(monkeypatch)
    lab.main(["--folder", str(tmp_path)])
    assert "Kept" not in capsys.readouterr().out
    (tmp_path / FIRST).write_text("mine", encoding="utf-8")
    lab.main(["--folder", str(tmp_path)])
    out = capsys.readouterr().out
    assert f"kept      {FIRST}" in out and "delete it" in out and "Ctrl+C" in out


def bare_python(monkeypatch, environment):
    """A Python without the suite; return the commands that lab.py starts in another one."""
    started = []

    class Bootstrap:
        Environment = lambda: environment  # noqa: E731

        @staticmethod
        def main(arguments):
            started.append(("bootstrap", *arguments))

    monkeypatch.setattr(lab, "find_spec", lambda name: None)
    monkeypatch.setattr(lab, "bootstrap", Bootstrap)
    monkeypatch.setattr(lab, "in_another_python", lambda *c: started.append(c) or 0)
    return started


def test_a_bare_python_makes_the_environment_and_goes_on_in_it(monkeypatch, tmp_path):
    class Made:
        path, python = tmp_path, tmp_path / "python"

    started = bare_python(monkeypatch, Made)
    with pytest.raises(SystemExit) as ended:
        lab.main(["--no-browser"])
    assert ended.value.code == 0
    assert started == [("bootstrap",), (Made.python, ["--no-browser"])]


def test_an_environment_that_lacks_the_suite_is_not_gone_round_in_circles(monkeypatch):
    class Incomplete:
        path, python = Path(sys.prefix), Path(sys.executable)

    started = bare_python(monkeypatch, Incomplete)
    with pytest.raises(SystemExit, match="Start again.*clean.py"):
        lab.main([])
    assert started == [("bootstrap",)]


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_it_ends_with_what_it_started(name, tmp_path):
    """Ctrl+C reaches both; who stops this program alone stops the other one too."""
    lasting = "import time; print('up', flush=True); time.sleep(60)"
    program = (
        f"import sys; sys.path.insert(0, {str(ROOT / 'tools')!r}); import lab, signal, os\n"
        f"lab.__file__ = {str(tmp_path / 'lasting.py')!r}\n"
        "sys.exit(lab.in_another_python(sys.executable, []))"
    )
    (tmp_path / "lasting.py").write_text(lasting, encoding="utf-8")
    with subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, start_new_session=True
    ) as process:
        assert process.stdout.readline() == b"up\n"
        if name == "SIGINT":
            os.killpg(process.pid, lab.signal.SIGINT)
        else:
            process.terminate()
        assert process.wait(20) != 0
        assert process.stdout.read() == b"", "the pipe is closed: nothing is left running"
