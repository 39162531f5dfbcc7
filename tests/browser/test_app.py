"""The explorer as a web page: shown on one screen and used, without a line of code and without a
request to elsewhere."""

import pytest
from panel import PanelOnPage
from served import app
from visit import visiting

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
