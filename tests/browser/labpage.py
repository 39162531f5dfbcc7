"""A notebook in JupyterLab: opened, run, asked what it shows."""

from waiting import wait_in

# The notebook by its path: which widget is the current one changes while the page puts itself
# together.
FIND = """window.rbNotebook = path => [...(window.jupyterapp?.shell.widgets('main') ?? [])]
    .find(widget => widget.context?.path === path && !widget.isDisposed);
window.rbCode = path => window.rbNotebook(path)?.content.widgets.map(cell => cell.model)
    .filter(model => model.type === 'code') ?? [];"""
# The page has put itself together and shows the notebook; menus and commands do nothing before.
OPENED = """async path => {
    await window.jupyterapp?.restored;
    const notebook = window.rbNotebook(path);
    if (!notebook?.content?.widgets?.length) return false;
    await Promise.all([notebook.context.ready, notebook.revealed, notebook.sessionContext.ready]);
    return true;
}"""
CURRENT = "path => window.jupyterapp.shell.currentWidget?.context?.path === path"
# Both the server and the page must say so: each is ahead of the other at times, and the badge
# "idle" says it too early.
CONNECTED = """async path => {
    const sessions = await (await fetch('/api/sessions')).json();
    const there = sessions.find(session => session.path === path)?.kernel;
    const here = window.rbNotebook(path)?.sessionContext.session?.kernel;
    return there?.execution_state === 'idle' && there.connections === 1
        && here?.id === there.id && here.connectionStatus === 'connected' && here.status === 'idle';
}"""
# Every cell has its number, or one has failed and the rest were not run.
ALL_RUN = """path => {
    const code = window.rbCode(path);
    const outputs = model => Array.from(
        {length: model.outputs.length}, (_, i) => model.outputs.get(i));
    return window.rbNotebook(path)?.sessionContext.session?.kernel?.status === 'idle'
        && (code.every(model => model.executionCount !== null)
            || code.some(model => outputs(model).some(output => output.type === 'error')));
}"""
OUTPUTS = "path => window.rbCode(path).flatMap(model => model.outputs.toJSON())"
# The cell that was run last has its number and what it shows: either may come first.
RESULT = """path => {
    const {model} = window.rbNotebook(path).content.activeCell;
    return model.executionCount !== null && model.outputs.length
        && {source: model.sharedModel.getSource(), outputs: model.outputs.toJSON()};
}"""
# The cell that is the current one was run.
DONE = """path => {
    const {model} = window.rbNotebook(path).content.activeCell;
    return model.executionCount !== null
        && window.rbNotebook(path).sessionContext.session.kernel.status === 'idle';
}"""
STATE = """path => `${window.rbNotebook(path)?.sessionContext.kernelDisplayStatus}, cells run: `
    + window.rbCode(path).map(model => model.executionCount ?? '-').join(' ')"""


class NotebookOnPage:
    """One notebook, open in a page with no other beside it, its kernel there: what is run before
    that is dropped.

    Parameters
    ----------
    page : playwright Page
    lab : Server
    name : str
        File name without ending.
    """

    def __init__(self, page, lab, name):
        self.page = page
        self.path = f"notebooks/{name}.ipynb"
        # The kernel is started here: a page that starts its own sometimes starts two and loses the
        # one that it holds.
        lab.ask(
            "api/sessions",
            {"path": self.path, "name": name, "type": "notebook", "kernel": {"name": "python3"}},
        )
        page.add_init_script(FIND)
        page.goto(f"{lab.url}/lab/workspaces/{name}/tree/{self.path}?token={lab.token}")
        self._wait(OPENED)
        # Menus are for the notebook in which somebody has clicked.
        page.locator(".jp-NotebookPanel:visible .jp-Cell").first.click(position={"x": 5, "y": 5})
        self._wait(CURRENT)
        self._wait(CONNECTED)

    def _wait(self, condition):
        try:
            return wait_in(self.page, condition, self.path)
        except TimeoutError as error:
            error.add_note(f"{self.path}: kernel {self.page.evaluate(STATE, self.path)}")
            raise

    def run_all(self):
        """Run all cells from the menu; wait until each has run or one has failed."""
        self.page.get_by_role("menuitem", name="Run", exact=True).click()
        self.page.get_by_role("menuitem", name="Run All Cells", exact=True).click()
        self._wait(ALL_RUN)

    def run_new_cell(self, above, write):
        """Make a cell below the one that holds the element `above`, let `write()` fill it by
        keyboard, and run it.

        Returns
        -------
        dict
            `source` and `outputs` of the new cell.
        """
        cell = above.locator(
            "xpath=ancestor::*[contains(concat(' ', @class, ' '), ' jp-CodeCell ')]"
        )
        cell.locator(".cm-content").click()
        for key in ("Escape", "b", "Enter"):
            self.page.keyboard.press(key)
        write()
        self.page.keyboard.press("Control+Enter")
        return self._wait(RESULT)

    def answer(self, variable, code):
        """Write an answer into its cell by keyboard, run it and the check below.

        Returns
        -------
        str
            What the check shows.
        """
        cell = self.page.locator(".jp-CodeCell").filter(has_text=f"{variable} = ").first
        cell.locator(".cm-content").click()
        self.page.keyboard.press("Control+A")
        self.page.keyboard.insert_text(f"{variable} = {code}")
        self.page.keyboard.press("Control+Enter")
        self._wait(DONE)
        for key in ("Escape", "ArrowDown", "Control+Enter"):
            self.page.keyboard.press(key)
        asked = f"check cell of {variable}"
        assert variable in self._wait(RESULT)["source"], asked
        self._wait(DONE)
        shown = self.page.locator(".jp-CodeCell.jp-mod-active .rb-verdict")
        return shown.inner_text()

    def run_again(self, inside):
        """Run the cell that shows the element `inside` once more, and wait until it has."""
        cell = inside.locator(
            "xpath=ancestor::*[contains(concat(' ', @class, ' '), ' jp-CodeCell ')]"
        )
        number = cell.locator(".jp-InputPrompt").inner_text()
        cell.locator(".cm-content").click()
        self.page.keyboard.press("Control+Enter")
        wait_in(
            self.page,
            "([cell, number]) => { const now = cell.querySelector('.jp-InputPrompt').innerText; "
            "return now !== number && /\\d/.test(now); }",
            [cell.element_handle(), number],
            "a cell that was run again",
        )

    def complaints(self):
        """What cells raised or warned, and what panels refuse."""
        outputs = self.page.evaluate(OUTPUTS, self.path)
        raised = [
            f"{out['ename']}: {out['evalue']}" for out in outputs if out["output_type"] == "error"
        ]
        warned = ["".join(out["text"]) for out in outputs if out.get("name") == "stderr"]
        return (
            raised
            + warned
            + [text for text in self.page.locator(".rb-error").all_inner_texts() if text.strip()]
        )
