"""A panel as somebody before the screen meets it: sliders to move, a picture and a sentence that follow."""

import json

# The picture by its bytes: its address changes with every update, whether or not the picture does.
STATE = """async root => {
    const frame = root.querySelector('.rb-picture');
    const image = frame.matches('img') ? frame : frame.querySelector('img');
    const summary = root.querySelector('.rb-summary').innerText.trim();
    const error = root.querySelector('.rb-error')?.innerText.trim() ?? '';
    try {
        const bytes = await (await fetch(image.src)).arrayBuffer();
        const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
        return {picture: Array.from(digest.slice(0, 8)).join('.'), width: image.naturalWidth, summary, error};
    } catch (gone) {  // replaced between reading its address and fetching it
        return null;
    }
}"""
# A state counts once it has stood for QUIET milliseconds: while a slider is dragged there may be coarser ones before it.
QUIET = 300
SETTLED = f"""async ([root, accept]) => {{
    const now = await ({STATE})(root);
    if (now === null) return false;
    const text = JSON.stringify(now);
    if (text !== root.rbText) [root.rbText, root.rbSince] = [text, performance.now()];
    return performance.now() - root.rbSince > {QUIET} && eval(accept)(now) && now;
}}"""


class PanelOnPage:
    """One panel in a page.

    Parameters
    ----------
    root : playwright Locator
        The element of class ``rb-panel``.
    """

    def __init__(self, root):
        self.root = root
        self.page = root.page
        root.scroll_into_view_if_needed()
        self.sliders = root.get_by_role("slider")

    def settled(self, accept="() => true"):
        """Wait until what is shown stands still and `accept`, a JavaScript function of it, is true; return it."""
        found = self.page.wait_for_function(SETTLED, arg=[self.root.element_handle(), accept], polling=50)
        return found.json_value()

    def changed(self, before):
        """Wait until both the picture and the summary differ from an earlier state, and the picture can be seen."""
        old = json.dumps(before)
        return self.settled(
            f"now => now.picture !== {old}.picture && now.summary !== {old}.summary && now.width > 0 && now.error === ''"
        )

    def back(self, before):
        """Wait until the summary is again that of an earlier state."""
        return self.settled(f"now => now.summary === {json.dumps(before)}.summary && now.error === ''")

    def press(self, slider, key):
        slider.focus()
        self.page.keyboard.press(key)

    def away(self, slider):
        """The arrow key that moves a slider off its place, and the one that brings it back."""
        at_end = slider.get_attribute("aria-valuenow") == slider.get_attribute("aria-valuemax")
        return ("ArrowLeft", "ArrowRight") if at_end else ("ArrowRight", "ArrowLeft")

    def drag(self, slider, share):
        """Take a slider's knob with the mouse to a share of its track, in small moves as a hand does."""
        knob = slider.bounding_box()
        track = slider.locator("xpath=ancestor::*[contains(@class, 'noUi-base')]").bounding_box()
        y = knob["y"] + knob["height"] / 2
        self.page.mouse.move(knob["x"] + knob["width"] / 2, y)
        self.page.mouse.down()
        self.page.mouse.move(track["x"] + share * track["width"], y, steps=8)
        self.page.mouse.up()

    def try_everything(self):
        """Move every slider one step and back with the arrow keys, then drag the first one; picture and summary follow."""
        start = self.settled("now => now.width > 0 && now.summary !== ''")
        sliders = self.sliders.all()
        assert sliders
        for slider in sliders:
            there, back = self.away(slider)
            self.press(slider, there)
            self.changed(start)
            self.press(slider, back)
            self.back(start)
        said = sliders[0].get_attribute("aria-valuetext")
        self.drag(sliders[0], 0.7)
        self.changed(start)
        assert sliders[0].get_attribute("aria-valuetext") != said
