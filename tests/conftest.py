"""How the tests of the package are run: without windows, and property tests with a known seed."""

import os
import random

import matplotlib
import pytest
from hypothesis import settings

# They need a browser and a minute or more: `make test-browser` names their folder, `make test`
# passes it by.
collect_ignore = ["browser"]

matplotlib.use("agg")  # figures are drawn into memory; no test opens a window

# No time limit for one example: the machine may be busy. "suite" takes the same examples in every
# run; "seeded" those of a seed, and remembers none from one run to the next.
settings.register_profile("suite", deadline=None, derandomize=True)
settings.register_profile("seeded", deadline=None, derandomize=False, database=None)

SEED = "RAILBRIDGE_SEED"


def seed_asked_for(option, variable):
    """The seed of the option `--hypothesis-seed`, else of the variable ("fresh" draws one), or
    None."""
    asked = option if option is not None else variable
    if asked == "fresh":
        return random.SystemRandom().randrange(2**32)
    return int(asked) if asked not in (None, "") else None


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config):
    """Before Hypothesis reads its seed, and before any test module is imported."""
    seed = seed_asked_for(config.getoption("--hypothesis-seed"), os.environ.get(SEED))
    config.option.hypothesis_seed = None if seed is None else str(seed)
    if seed is not None:
        os.environ[SEED] = str(seed)  # the processes of pytest-xdist take the same
    settings.load_profile("suite" if seed is None else "seeded")


def said(config):
    seed = config.option.hypothesis_seed
    if seed is None:
        return "property tests: the fixed examples"
    return f"property tests: seed {seed}, again with --hypothesis-seed={seed}"


def pytest_report_header(config):
    return said(config)


def pytest_terminal_summary(config):
    """At the end, too: `-q` has no header."""
    if config.option.hypothesis_seed is not None:
        config.get_terminal_writer().line(said(config))
