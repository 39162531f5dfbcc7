"""How tests are run.

Notebooks: nbval runs every cell; those tagged `nbval-check-output` must print what is stored.
What needs an extra that is not installed is skipped with the extra's name.
"""

import importlib.metadata
import importlib.util
import os
import re
import tomllib
from pathlib import Path

# Before NumPy is loaded here or in a kernel: the matrices are small, threads only cost time.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import pytest
from packaging.requirements import Requirement

from railbridge.errors import InputError

# Differ from one machine or version to the next, and are looked at by people: never compared.
NOT_COMPARED = ("text/html", "image/svg+xml", "stderr")
OUTPUT_TIMEOUT = 60  # s; nbval waits 5 s for a printed line, too short for a busy machine

# What a notebook says below its title.
PAGE_NEEDS = re.compile(r"\ANeeds the extra `(\w+)`")
# What the package says where it cannot go on without one.
CALL_NEEDS = re.compile(r"the package (\w+) is missing.*\[(\w+)\]")


ERRORS = (Exception, pytest.fail.Exception)


def is_notebook_cell(item):
    return hasattr(item, "cell") and hasattr(item, "output_timeout")


def has_stored_text(cell):
    """True if the cell was run before it was stored and printed something that can be compared."""
    texts = [out.get("text") or out.get("data", {}).get("text/plain") for out in cell.outputs]
    return cell.execution_count is not None and any(texts)


def extra_of_page(cells):
    """The extra that a notebook says it needs, or None; `cells` are its cells."""
    lines = [line for line in "".join(cells[0]["source"]).splitlines() if line.strip()]
    found = PAGE_NEEDS.match(lines[1]) if len(lines) > 1 else None
    return found and found.group(1)


def extra_of_error(error):
    """The extra whose package was found missing, or None if something else went wrong.

    The error itself says it, or the one that `pytest.raises` got instead of another.
    """
    while error is not None and not isinstance(error, InputError):
        error = error.__context__
    found = CALL_NEEDS.search(str(error))
    if found and importlib.util.find_spec(found.group(1)) is None:
        return found.group(2)
    return None


def missing_package(extra):
    """The first package of an extra of pyproject.toml that is not installed, or None."""
    project = Path(__file__).with_name("pyproject.toml").read_text(encoding="utf-8")
    for ask in tomllib.loads(project)["project"]["optional-dependencies"][extra]:
        name = Requirement(ask).name
        try:
            importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            return name
    return None


def without(extra):
    """Skip for want of an extra; RAILBRIDGE_EXTRAS=required makes that a failure, as CI does."""
    reason = f"needs the extra {extra}: pip install -e .[{extra}]"
    if os.environ.get("RAILBRIDGE_EXTRAS") == "required":
        pytest.fail(reason, pytrace=False)
    pytest.skip(reason)


def pytest_configure(config):
    # nbval opens this file relative to the current folder; make `pytest` work from any folder.
    config.option.nbval_sanitize_with = str(config.rootpath / config.option.nbval_sanitize_with)


def pytest_collection_modifyitems(items):
    for item in filter(is_notebook_cell, items):
        item.output_timeout = OUTPUT_TIMEOUT
        item.parent.skip_compare = tuple({*item.parent.skip_compare, *NOT_COMPARED})


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item):
    """Also where a fixture needs the extra, for each of the tests that share it."""
    if is_notebook_cell(item):
        extra = extra_of_page(item.parent.nb.cells)
        if extra and missing_package(extra):
            without(extra)
    try:
        return (yield)
    except ERRORS as error:
        if extra := extra_of_error(error):
            without(extra)
        raise


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    try:
        result = yield
    except ERRORS as error:
        if extra := extra_of_error(error):
            without(extra)
        raise
    if is_notebook_cell(item) and item.options["check"] and not has_stored_text(item.cell):
        # nbval lets such a cell pass, as if an empty page agreed with every print.
        item.raise_cell_error(
            "Marked for comparison, but stored without output: run `make notebooks`.", ""
        )
    return result
