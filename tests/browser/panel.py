"""A panel as somebody before the screen meets it: sliders to move, a picture and a sentence that follow."""

import json

from waiting import wait_in

# The picture by its bytes: its address changes with every update, whether or not the picture does.
STATE = """async root => {
    const frame = root.querySelector('.rb-picture');
    const image = frame.matches('img') ? frame : frame.querySelector('img');
    const words = root.querySelector('.rb-summary');
    const summary = words.innerText.trim();
    const exact = words.querySelector('[role=status]') !== null;  // while a hand moves there are coarser results before it
    const error = root.querySelector('.rb-error')?.innerText.trim() ?? '';
    try {
        const bytes = await (await fetch(image.src)).arrayBuffer();
        const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
        return {picture: Array.from(digest.slice(0, 8)).join('.'), width: image.naturalWidth, summary, exact, error};
    } catch (gone) {  // replaced between reading its address and fetching it
        return null;
    }
}"""
# A state counts once it is exact and has stood for QUIET milliseconds.
QUIET = 150
SETTLED = f"""async ([root, accept]) => {{
    const now = await ({STATE})(root);
    if (now === null) return false;
    const text = JSON.stringify(now);
    if (text !== root.rbText) [root.rbText, root.rbSince] = [text, performance.now()];
    return now.exact && performance.now() - root.rbSince > {QUIET} && eval(accept)(now) && now;
}}"""
# What moves only the train in the picture: the sentence is about the whole crossing.
VIEW_ONLY = ("first axle (m)",)
# Whose one step is too small to be seen: these are moved by typing a number, the other way that the notebooks tell.
FINE = ("at first (Hz)",)


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
        return wait_in(self.page, SETTLED, [self.root.element_handle(), accept], f"a panel that stands still with {accept}")

    def changed(self, before, summary=True):
        """Wait until the picture, and the summary if asked for, differ from an earlier state, and the picture can be seen."""
        said = f"now.summary !== {json.dumps(before['summary'])} && " if summary else ""
        picture = f"now.picture !== {json.dumps(before['picture'])} && now.width > 0"
        return self.settled(f"now => {said}{picture} && now.error === ''")

    def back(self, start, away):
        """Wait until the picture is not that of `away` any more, and the summary is that of `start`.

        The picture need not be that of `start` to the bit: limits of its axes may stay wider.
        """
        said = f"now.summary === {json.dumps(start['summary'])}"
        return self.settled(f"now => {said} && now.picture !== {json.dumps(away['picture'])} && now.error === ''")

    def row(self, slider):
        """The element that holds a slider, its label and its number."""
        return slider.locator("xpath=ancestor::*[contains(@class, 'widget-hslider')]")

    def label(self, slider):
        """What stands beside a slider."""
        return self.row(slider).locator(".widget-label").inner_text()

    def press(self, slider, key):
        slider.focus()
        self.page.keyboard.press(key)

    def type_number(self, slider, text):
        self.row(slider).locator(".widget-readout").dblclick()
        for key in ("Control+A", *text, "Enter"):
            self.page.keyboard.press(key)

    def there_and_back(self, slider):
        """Two actions by keyboard: one moves a slider off its place, the other brings it back."""
        if self.label(slider) in FINE:
            number = self.row(slider).locator(".widget-readout").inner_text()
            return lambda: self.type_number(slider, f"{1.5 * float(number):.3f}"), lambda: self.type_number(slider, number)
        at_end = slider.get_attribute("aria-valuenow") == slider.get_attribute("aria-valuemax")
        keys = ("ArrowLeft", "ArrowRight") if at_end else ("ArrowRight", "ArrowLeft")
        return tuple(lambda key=key: self.press(slider, key) for key in keys)

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
        """Move every slider by keyboard and back, then drag the first one; picture and summary follow each time."""
        start = self.settled("now => now.width > 0 && now.summary !== ''")
        sliders = self.sliders.all()
        assert sliders
        now = start
        for slider in sliders:
            there, back = self.there_and_back(slider)
            there()
            moved = self.changed(now, summary=self.label(slider) not in VIEW_ONLY)
            back()
            now = self.back(start, moved)
        said = sliders[0].get_attribute("aria-valuetext")
        self.drag(sliders[0], 0.7)
        self.changed(now)
        assert sliders[0].get_attribute("aria-valuetext") != said
