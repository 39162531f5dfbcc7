"""One server and one browser for all tests, a fresh page for each; what a failed test saw is kept in build/browser."""

import os
import re
import secrets

import pytest
from chromium import NoBrowser, Record, running
from served import NOTEBOOKS, ROOT, copy_without_outputs, jupyterlab
from waiting import PATIENCE

KEPT = ROOT / "build" / "browser"
WINDOW = {"width": 1280, "height": 900}


@pytest.fixture(scope="session")
def browser():
    """The installed Chromium. Where there is none, tests are skipped, or fail if RAILBRIDGE_BROWSER=required."""
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
def record():
    return Record()


@pytest.fixture
def page(browser, record, request):
    context = browser.new_context(viewport=WINDOW)
    context.set_default_timeout(1e3 * PATIENCE)
    record.follow(context)
    page = context.new_page()
    yield page
    if getattr(request.node, "went_wrong", False):
        keep(request.node, page, record)
    context.close()


def keep(test, page, record):
    """Store what can be seen, and what was written, when a test failed."""
    KEPT.mkdir(parents=True, exist_ok=True)
    name = re.sub(r"[^\w-]+", "_", test.name).strip("_")
    page.screenshot(path=KEPT / f"{name}.png")
    lines = [*record.console, "", "uncaught:", *record.uncaught, "", "kernel:", *record.kernel, "", "requests:", *record.requests]
    for server in (value for value in test.funcargs.values() if hasattr(value, "said")):
        lines += ["", f"server {server.url}:", server.said()]
    (KEPT / f"{name}.log").write_text("\n".join(lines) + "\n", encoding="utf-8")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    if report.when == "call":
        item.went_wrong = report.failed
    return report
