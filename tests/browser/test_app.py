"""The explorer as a web page: shown on one screen and used, without a line of code and without a
request to elsewhere."""

import pytest
from layout import faults, nameless
from panel import PanelOnPage
from served import app
from visit import WINDOW, visiting

COMPLAINTS = (
    "[data-mime-type='application/vnd.jupyter.stderr'], "
    "[data-mime-type='application/vnd.jupyter.error']"
)


@pytest.fixture(scope="module")
def visited(browser, home):
    with app(home / "app") as server, visiting(browser, server) as visit:
        visit.page.goto(server.url)
        visit.page.wait_for_selector(".rb-panel [role=slider]")
        yield visit


@pytest.fixture(scope="module")
def panel(visited):
    (root,) = visited.page.locator(".rb-panel").all()
    return PanelOnPage(root)


@pytest.fixture(scope="module")
def start(panel):
    return panel.begun()


@pytest.mark.parametrize("size", [(1024, 768), (1366, 768), (1920, 1080)])
def test_all_of_it_is_seen_on_one_screen(visited, panel, start, size):
    """Sliders long enough to be moved, no text cut, nothing on top of anything, no scroll bar."""
    try:
        visited.page.set_viewport_size(dict(zip(("width", "height"), size, strict=True)))
        panel.settled()
        assert faults(panel.root) == []
    finally:
        visited.page.set_viewport_size(WINDOW)


def test_screen_readers_have_a_name_for_every_control(panel, start):
    assert nameless(panel.root) == []


def test_explorer_follows_its_controls(visited, panel, start):
    panel.try_controls(panel.restored(start))
    assert visited.page.locator(COMPLAINTS).count() == 0
    assert (
        visited.page.locator(".jp-InputArea-editor:visible, .jp-CodeMirrorEditor:visible").count()
        == 0
    )
    assert visited.complaints() == []


def test_the_train_runs_by_itself(visited, panel, start):
    panel.try_player(panel.restored(start))
    assert visited.complaints() == []
