"""Every notebook with a panel, in JupyterLab: opened, run, its sliders moved by keyboard and by mouse."""

import pytest
from chromium import leaves
from labpage import NotebookOnPage
from panel import PanelOnPage
from served import notebooks_with_panels


@pytest.fixture
def clean_lab(lab):
    """JupyterLab without running kernels after the test."""
    yield lab
    for session in lab.ask("api/sessions"):
        lab.ask(f"api/sessions/{session['id']}", method="DELETE")


@pytest.mark.parametrize("name", notebooks_with_panels())
def test_panel_follows_its_sliders(name, page, record, clean_lab):
    written = len(clean_lab.said())
    notebook = NotebookOnPage(page, clean_lab, name)
    notebook.run_all()
    assert notebook.complaints() == []
    panels = [PanelOnPage(root) for root in page.locator(".rb-panel").all()]
    assert panels, "no panel is shown"
    for panel in panels:
        panel.try_everything()
    assert notebook.complaints() == []
    assert record.left == []
    assert record.uncaught == []
    assert record.kernel == []
    assert "Traceback" not in clean_lab.said()[written:]


def test_guard_sees_a_request_that_leaves_the_machine(page, record):
    page.goto("about:blank")
    page.evaluate("() => fetch('https://example.org/x.js', {mode: 'no-cors'}).catch(() => null)")
    assert record.left == ["https://example.org/x.js"]
    assert leaves("wss://example.org/x") and not leaves("ws://127.0.0.1:8888/x") and not leaves("data:image/png;base64,AAAA")
