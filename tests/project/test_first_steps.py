"""The first steps of the README, for those who have never used a terminal: their order, their
commands, and the words that they say one will see."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import bootstrap

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
STEPS = re.search(r"^## First steps\n(.*?)(?=^## )", README, re.MULTILINE | re.DOTALL).group(1)
SAYS = "\n".join(
    (ROOT / "tools" / name).read_text(encoding="utf-8") for name in ("bootstrap.py", "lab.py")
)


def test_the_readme_begins_with_the_first_steps():
    headings = re.findall(r"^## (.*)$", README, re.MULTILINE)
    assert headings[:2] == ["First steps", "Start"]
    assert len(README[: README.index("## First steps")].split()) < 60, "who reads on comes to it"


def test_they_are_short_and_in_order():
    titles = re.findall(r"^\d\. \*\*(.*?)\*\*", STEPS, re.MULTILINE)
    assert [title.split()[0] for title in titles] == ["Get", "Get", "Open", "Type"]
    assert 400 < len(STEPS.split()) < 800
    for system in ("Windows", "macOS", "Linux"):
        assert STEPS.count(system) >= 3, system


def test_commands_are_two_and_name_files_that_exist():
    shown = re.findall(r"`((?:py -3\.13|py|python3\.13|python3) [^`]+)`", STEPS)
    assert {command.split()[0] for command in shown} == {"py", "python3", "python3.13"}
    table = re.search(r"^\| Windows .*?\n\n", STEPS, re.MULTILINE | re.DOTALL).group()
    assert re.findall(r"`py(?:thon3)? (.*?)`", table) == ["--version"] * 2 + ["tools/lab.py"] * 2
    assert {command.split()[-1] for command in shown} == {
        "--version", "tools/lab.py", "tools/clean.py",
    }  # fmt: skip
    for name in re.findall(r"tools/\w+\.py", STEPS):
        assert (ROOT / name).is_file()


def test_pythons_it_names_are_those_that_are_tested():
    named = set(re.findall(r"\b3\.\d+\b", STEPS))
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert named == set(re.findall(r"Python :: (3\.\d+)", project))
    assert min(named, key=lambda v: int(v[2:])) == bootstrap.OLDEST_PYTHON


@pytest.mark.parametrize(
    "words",
    [
        "creating .venv ...",
        "Your notebooks are in",
        "this command failed with code",
        "railbridge needs Python",
        "This Python has no",
    ],
)
def test_what_one_sees_is_what_the_tools_say(words):
    assert words in STEPS and words in SAYS


def test_what_python_says_in_the_wrong_folder(tmp_path):
    done = subprocess.run(
        [sys.executable, "tools/lab.py"], cwd=tmp_path, capture_output=True, text=True
    )
    assert "can't open file" in done.stderr and "can't open file" in STEPS


def test_disk_is_what_the_teachers_page_says():
    page = (ROOT / "docs" / "teaching.md").read_text(encoding="utf-8")
    assert "1500 MB of disk" in page and "1.5 GB of disk" in STEPS


def test_test_command_stands_as_it_did():
    """CI takes it from here."""
    start = README[README.index("\n## Start\n") :]
    assert re.search(r"```\nmake lab .*\nmake test .*\n```", start)


def test_cleaning_keeps_the_notebooks(tmp_path):
    for name in (".venv/lib/x.py", "my-notebooks/00_start_here.ipynb", "build/site/index.html"):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).touch()
    (tmp_path / "tools").mkdir()
    shutil.copy(ROOT / "tools" / "clean.py", tmp_path / "tools")
    subprocess.run([sys.executable, tmp_path / "tools" / "clean.py"], check=True)
    assert (tmp_path / "my-notebooks" / "00_start_here.ipynb").is_file()
    assert not (tmp_path / ".venv").exists()
    assert "deletes `.venv` and keeps your notebooks" in STEPS
