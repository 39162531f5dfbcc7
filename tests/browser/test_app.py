"""The explorer as a web page: shown on one screen and used, without a line of code and without a request to elsewhere."""

import pytest
from panel import PanelOnPage
from served import app

COMPLAINTS = "[data-mime-type='application/vnd.jupyter.stderr'], [data-mime-type='application/vnd.jupyter.error']"


@pytest.fixture
def explorer(home):
    with app(home / "app") as server:
        yield server


def test_explorer_follows_its_sliders(page, record, explorer):
    page.goto(explorer.url)
    page.wait_for_selector(".rb-panel [role=slider]")
    (root,) = page.locator(".rb-panel").all()
    PanelOnPage(root).try_everything()
    assert page.locator(COMPLAINTS).count() == 0
    assert page.locator(".jp-InputArea-editor:visible, .jp-CodeMirrorEditor:visible").count() == 0
    assert record.left == []
    assert record.uncaught == []
    assert record.kernel == []
