"""How notebooks are tested: nbval runs every cell; those marked `# NBVAL_CHECK_OUTPUT` must print
what is stored."""

import os

# Before NumPy is loaded here or in a kernel: the matrices are small, threads only cost time.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import pytest

# Differ from one machine or version to the next, and are looked at by people: never compared.
NOT_COMPARED = ("text/html", "image/svg+xml", "stderr")
OUTPUT_TIMEOUT = 60  # s; nbval waits 5 s for a printed line, too short for a busy machine


def is_notebook_cell(item):
    return hasattr(item, "cell") and hasattr(item, "output_timeout")


def has_stored_text(cell):
    """True if the cell was run before it was stored and printed something that can be compared."""
    texts = [out.get("text") or out.get("data", {}).get("text/plain") for out in cell.outputs]
    return cell.execution_count is not None and any(texts)


def pytest_configure(config):
    # nbval opens this file relative to the current folder; make `pytest` work from any folder.
    config.option.nbval_sanitize_with = str(config.rootpath / config.option.nbval_sanitize_with)


def pytest_collection_modifyitems(items):
    for item in filter(is_notebook_cell, items):
        item.output_timeout = OUTPUT_TIMEOUT
        item.parent.skip_compare = tuple({*item.parent.skip_compare, *NOT_COMPARED})


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    result = yield
    if is_notebook_cell(item) and item.options["check"] and not has_stored_text(item.cell):
        # nbval lets such a cell pass, as if an empty page agreed with every print.
        item.raise_cell_error(
            "Marked for comparison, but stored without output: run `make notebooks`.", ""
        )
    return result
