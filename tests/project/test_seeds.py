"""Property tests: the same examples each time, or those of a seed that is said."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEST = "tests/test_spectra.py::test_scaling_and_shifting_a_record"


def run(*options, seed=""):
    """What pytest says, and the examples that it tried."""
    command = [sys.executable, "-m", "pytest", TEST, "-q", "-s", "--hypothesis-verbosity=verbose"]
    said = subprocess.run(
        [*command, "-p", "no:cacheprovider", "-p", "no:xdist", *options],
        cwd=ROOT,
        env={**os.environ, "RAILBRIDGE_SEED": seed},
        capture_output=True,
        text=True,
    ).stdout
    assert "1 passed" in said, said
    return said, re.findall(r"scale=\S+\s+shift=\S+\s+seed=\S+", said)


def seed_said(text):
    return re.search(r"property tests: seed (\d+), again with --hypothesis-seed=\1$", text, re.M)


def test_a_fresh_seed_is_said_and_gives_the_same_examples_again():
    said, fresh = run(seed="fresh")
    again = run(f"--hypothesis-seed={seed_said(said).group(1)}")[1]
    assert fresh == again and len(set(fresh)) > 20
    said, fixed = run()
    assert fixed != fresh and not seed_said(said)


@pytest.mark.parametrize(
    ("option", "variable", "seed"),
    [(None, None, None), (None, "", None), ("7", "8", 7), (None, "8", 8), ("0", None, 0)],
)
def test_the_option_goes_before_the_variable(pytestconfig, option, variable, seed):
    conftest = pytestconfig.pluginmanager.get_plugin(str(ROOT / "tests" / "conftest.py"))
    assert conftest.seed_asked_for(option, variable) == seed
