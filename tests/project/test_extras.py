"""What needs an extra that is not installed is skipped, and says which; nothing else is."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# A fixture needs the extra; two tests need it themselves; one asks for another error; the last does
# without.
ASKED = (
    "tests/validation/test_identification.py::test_it_reaches_what_was_asked",
    "tests/boxes/test_section.py::test_solid_rectangle",
    "tests/boxes/test_shell.py::test_mass_is_that_of_the_plates",
    "tests/boxes/test_girder.py::test_mechanisms_are_refused_by_both_models",
    "tests/boxes/test_section.py::test_touching_itself_is_crossing",
)
# Stands in for an environment without the extra: no import finds its packages.
PLUGIN = """
import importlib.metadata, sys
sys.modules["sectionproperties"] = sys.modules["pyfe3d"] = None
known = importlib.metadata.version
def version(name):
    if name in ("sectionproperties", "pyfe3d"):
        raise importlib.metadata.PackageNotFoundError(name)
    return known(name)
importlib.metadata.version = version
"""


def counts(said):
    """{outcome: how many} of the closing line; other people's warnings left out."""
    found = re.findall(r"(\d+) (passed|failed|skipped|error)", said.strip().splitlines()[-1])
    return {outcome: int(count) for count, outcome in found}


@pytest.fixture(scope="module")
def run_without_fem(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plugin")
    (folder / "no_fem.py").write_text(PLUGIN, encoding="utf-8")

    def run(*asked, **variables):
        path = os.pathsep.join(filter(None, [str(folder), os.environ.get("PYTHONPATH")]))
        options = ["-q", "-p", "no_fem", "-p", "no:cacheprovider", "-p", "no:xdist"]
        return subprocess.run(
            [sys.executable, "-m", "pytest", *options, *asked],
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": path, "RAILBRIDGE_EXTRAS": "", **variables},
            capture_output=True,
            text=True,
        ).stdout

    return run


def test_a_test_without_its_extra_is_skipped_with_its_name(run_without_fem):
    said = run_without_fem(*ASKED)
    assert counts(said) == {"passed": 1, "skipped": 4}, said
    assert "needs the extra fem: pip install -e .[fem]" in said


def test_a_page_without_its_extra_is_skipped_as_a_whole(run_without_fem):
    said = run_without_fem("notebooks/08_paper_against_suite.ipynb")
    assert counts(said).keys() == {"skipped"}, said
    assert "needs the extra fem: pip install -e .[fem]" in said


def test_where_all_extras_are_asked_for_a_missing_one_is_a_failure(run_without_fem):
    said = run_without_fem(*ASKED, RAILBRIDGE_EXTRAS="required")
    assert counts(said) == {"failed": 3, "passed": 1, "error": 1}, said


@pytest.fixture
def conftest(pytestconfig):
    return pytestconfig.pluginmanager.get_plugin(str(ROOT / "conftest.py"))


def test_other_errors_are_no_excuse(conftest):
    from railbridge.errors import InputError

    says = 'Run: pip install -e ".[fem]"'
    assert conftest.extra_of_error(InputError("x", 1, "the package no_such is missing", says))
    # It is installed: then the fault lies elsewhere.
    assert conftest.extra_of_error(InputError("x", 1, "the package numpy is missing", says)) is None
    assert conftest.extra_of_error(InputError("x", 1, "too large", "Try less")) is None
    assert conftest.extra_of_error(ValueError("the package no_such is missing [fem]")) is None


@pytest.mark.parametrize(
    ("text", "extra"),
    [
        ("# 14 - Compare\n\nNeeds the extra `fem` from here on.\n\n**Why?**", "fem"),
        ("# 14 - Compare\n\n**Why?**\n\nNeeds the extra `fem`.", None),
        ("# 14 - Compare", None),
    ],
)
def test_a_page_names_its_extra_below_the_title(conftest, text, extra):
    assert conftest.extra_of_page([{"source": text}]) == extra
