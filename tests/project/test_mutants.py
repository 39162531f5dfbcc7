"""The tool that changes one thing at a time: it finds changes, tests them, and tells who is
alive."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.skipif(os.name == "nt", reason="processes are forked")


@pytest.fixture(scope="module")
def mutants():
    spec = importlib.util.spec_from_file_location("mutants", ROOT / "tools" / "mutants.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["mutants"] = module  # its dataclasses ask for it
    spec.loader.exec_module(module)
    yield module
    del sys.modules["mutants"]


def test_a_changed_module_is_tested_in_place_of_the_file():
    """In a Python that has not imported the package yet, as the tool does."""
    code = (
        "import mutants\n"
        "path = mutants.PACKAGE / 'units.py'; text = path.read_text(encoding='utf-8')\n"
        "home = [['tests/test_units.py'], []]\n"
        "for old, new in (('', ''), ('0.3048', '0.3'), ('G = 9.81', 'G = 1 / 0')):\n"
        "    assert old in text\n"
        "    print(mutants.tested('railbridge.units', path, text.replace(old, new), home))\n"
    )
    path = os.pathsep.join(filter(None, [str(ROOT / "tools"), os.environ.get("PYTHONPATH")]))
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
    )
    assert done.stdout.split() == ["alive", "killed", "killed"], done.stdout + done.stderr


def test_the_mirroring_file_comes_first_and_the_fastest_next(mutants):
    home = "tests/test_units.py"
    known = {
        "lines": {"units.py": {"3": [f"{home}::a", "t/b.py::slow", "t/b.py::fast"], "9": ["t::c"]}},
        "time": {"t/b.py::slow": 30.0, "t/b.py::fast": 0.1, "t::c": 20.0, f"{home}::a": 1.0},
    }
    assert mutants.tests_of(known, "units.py", 3, home) == [
        [home],
        ["t/b.py::fast", "t/b.py::slow"],
    ]
    # A line that is run when the module is imported: whoever uses the module, as time allows.
    assert mutants.tests_of(known, "units.py", 1, home) == [[home], ["t/b.py::fast", "t::c"]]


def test_every_module_of_the_spine_has_its_mirror(mutants):
    assert mutants.mirror("beams.mesh") == "tests/beams/test_mesh.py"
    assert (ROOT / mutants.mirror("units")).exists()


def test_a_change_is_shown_by_its_lines(mutants):
    found = mutants.as_mutant("a = 1\nb = a + 2\n", 2, "a = 1\nb = a - 2\n")
    assert (found.line, found.before, found.after) == (2, "b = a + 2", "b = a - 2")


SOURCE = '''
"""Not a word of this."""
import os

LIMIT: float = 4

@property
def f(x: "wide"):
    if x > 3:
        raise ValueError("too wide", 7)
    return escape(x) + float(x)
'''


def test_changes_are_made_where_the_program_does_something(mutants):
    pytest.importorskip("mutmut", reason="make mutants has it")
    texts = [text for _, text in mutants.changes(SOURCE)]
    for part in ("x >= 3", "x > 4", "return x + float", "escape(x) - float", "float = 5"):
        assert any(part in text for text in texts), part
    for part in ('"wide"', '"too wide", 7', "Not a word of this.", "import os", "@property"):
        assert all(part in text for text in texts), part
