"""What a Binder or a container builds from: the files say what the suite needs, and their commands
give an installation that works from any folder.

`RAILBRIDGE_BINDER=required` also fetches all packages into a new environment, as a Binder does;
else those that are installed here stand in for them.
"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from railbridge.commands import copies as lessons

ROOT = Path(__file__).resolve().parents[2]
BINDER = ROOT / "binder"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
LINES = (BINDER / "requirements.txt").read_text(encoding="utf-8").splitlines()
FETCHED = os.environ.get("RAILBRIDGE_BINDER") == "required"
LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv", "build", "my-notebooks", "__pycache__", ".*_cache", ".hypothesis"
)


def names(asks):
    return {canonicalize_name(Requirement(ask).name) for ask in asks}


def test_it_asks_for_what_the_pages_and_the_build_need():
    asked = [line for line in LINES if line and line[0] not in "#-"]
    extras = PROJECT["project"]["optional-dependencies"]
    needed = [
        *PROJECT["project"]["dependencies"],
        *extras["fem"],
        *extras["study"],
        *PROJECT["build-system"]["requires"],
    ]
    assert names(asked) == names(needed) and len(asked) == len(names(asked))


def test_versions_are_those_of_the_lock():
    options = [line for line in LINES if line.startswith("-")]
    assert options == ["-c ../requirements.lock"]
    lock = (BINDER / options[0].split()[1]).resolve()
    assert lock == ROOT / "requirements.lock"
    locked = names(lock.read_text(encoding="utf-8").splitlines())
    assert names(line for line in LINES if line and line[0] not in "#-") <= locked


def test_python_is_one_that_is_tested():
    version = re.fullmatch(r"python-(3\.\d+)\n", (BINDER / "runtime.txt").read_text()).group(1)
    assert f"Programming Language :: Python :: {version}" in PROJECT["project"]["classifiers"]


def test_there_is_nothing_that_would_be_read_instead():
    """A Binder takes the first kind of file that it knows; ours are all."""
    assert {path.name for path in BINDER.iterdir()} == {
        "requirements.txt",
        "runtime.txt",
        "postBuild",
    }
    assert not (ROOT / ".binder").exists()


@pytest.mark.skipif(os.name == "nt", reason="a Binder is no Windows")
def test_post_build_can_be_run():
    path = BINDER / "postBuild"
    assert os.access(path, os.X_OK) and path.read_bytes().startswith(b"#!/bin/bash\n")
    assert b"\r" not in path.read_bytes()
    subprocess.run(["bash", "-n", path], check=True)


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A clean copy of the suite after what a Binder does, and the Python it did that with."""
    folder = tmp_path_factory.mktemp("binder")
    place, home = folder / "suite", folder / "environment"
    shutil.copytree(ROOT, place, ignore=LEFT_OUT)
    venv.create(home, with_pip=True)
    python = home / "bin" / "python"
    variables = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    variables["PATH"] = os.pathsep.join([str(python.parent), variables["PATH"]])

    def run(*command, cwd=place):
        done = subprocess.run(command, cwd=cwd, env=variables, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    if FETCHED:
        run(python, "-m", "pip", "install", "--quiet", "-r", "binder/requirements.txt")
    else:
        borrowed = next(path for path in sys.path if path.endswith("site-packages"))
        found = run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))")
        # A line of paths only: this suite, installed in place, is not found through it.
        Path(found.strip(), "borrowed.pth").write_text(borrowed + "\n", encoding="utf-8")
    said = run(place / "binder" / "postBuild")
    return place, said, lambda *arguments: run(python, *arguments, cwd=folder)


posix = pytest.mark.skipif(os.name == "nt", reason="a Binder is no Windows")


@posix
def test_after_it_the_suite_works_from_another_folder(built):
    place, _, python = built
    code = "import railbridge as rb; rb.case('paper'); print(rb.__file__)"
    found = Path(python("-c", code).strip())
    assert "site-packages" in found.parts and not found.is_relative_to(place)
    assert not found.is_relative_to(ROOT)


@posix
def test_after_it_copies_lie_where_the_address_leads(built):
    place, said, python = built
    copies = place / "my-notebooks"
    assert f"{len(lessons.contents())} copied" in said
    record = json.loads((copies / lessons.MANIFEST).read_text(encoding="utf-8"))
    assert set(record) == set(lessons.contents())
    page = (ROOT / "docs" / "hub.md").read_text(encoding="utf-8")
    (address,) = set(re.findall(r"/lab/tree/([\w./-]+)", page))
    assert (place / address).is_file()


@posix
def test_after_it_a_page_can_be_run(built):
    place, _, python = built
    page = place / "my-notebooks" / "02_irregularities.ipynb"
    run = ["nbconvert", "--to", "notebook", "--execute", "--stdout", "--log-level=ERROR", str(page)]
    assert '"cells"' in python("-m", *run)


@posix
def test_post_build_asks_no_network():
    commands = [
        shlex.split(line)
        for line in (BINDER / "postBuild").read_text(encoding="utf-8").splitlines()
        if line and not line.startswith(("#", "set "))
    ]
    for command in commands:
        assert "install" not in command or {"--no-index", "--no-build-isolation"} <= set(command)
        assert command[0] in ("python", "railbridge")
