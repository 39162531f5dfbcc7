"""One server and one browser for all tests; what a failed test saw is kept in build/browser."""

import os
import secrets

import pytest
from chromium import NoBrowser, running
from served import NOTEBOOKS, copy_without_outputs, jupyterlab
from visit import Visit, visiting


@pytest.fixture(scope="session")
def browser():
    """The installed Chromium.

    Where there is none, tests are skipped, or fail if RAILBRIDGE_BROWSER=required.
    """
    started = running()
    try:
        found = started.__enter__()
    except NoBrowser as reason:
        if os.environ.get("RAILBRIDGE_BROWSER") == "required":
            pytest.fail(f"RAILBRIDGE_BROWSER=required, but {reason}")
        pytest.skip(str(reason))
    yield found
    started.__exit__(None, None, None)


@pytest.fixture(scope="session")
def home(browser, tmp_path_factory):
    """A folder with copies of the notebooks, in which the servers keep everything."""
    folder = tmp_path_factory.mktemp("browser")
    copy_without_outputs(NOTEBOOKS, folder / "notebooks")
    return folder


@pytest.fixture(scope="session")
def lab(home):
    with jupyterlab(home, secrets.token_hex(16)) as server:
        yield server


@pytest.fixture
def visit(browser):
    with visiting(browser) as visit:
        yield visit


@pytest.fixture
def page(visit):
    return visit.page


@pytest.fixture
def record(visit):
    return visit.record


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    if report.failed and report.when != "teardown":
        for visit in (value for value in item.funcargs.values() if isinstance(value, Visit)):
            visit.keep(item.name)
    return report
