"""A panel as somebody before the screen meets it: controls to move, a picture and a sentence that
follow."""

import json

from waiting import wait_in

# The picture by its bytes: its address changes with every update, whether or not the picture does.
STATE = """async root => {
    const frame = root.querySelector('.rb-picture');
    const image = frame.matches('img') ? frame : frame.querySelector('img');
    const words = root.querySelector('.rb-summary');
    const summary = words.innerText.trim();
    // while a hand moves there are coarser results before it
    const exact = words.querySelector('[role=status]') !== null;
    const error = root.querySelector('.rb-error')?.innerText.trim() ?? '';
    const controls = [...root.querySelectorAll('.rb-number input')].map(number => number.value)
        .concat([...root.querySelectorAll('select')].map(list => list.value)).join(', ');
    try {
        const bytes = await (await fetch(image.src)).arrayBuffer();
        const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
        return {picture: Array.from(digest.slice(0, 8)).join('.'), width: image.naturalWidth,
        summary, exact, error, controls};
    } catch (gone) {  // replaced between reading its address and fetching it
        return null;
    }
}"""
# A state counts once it is exact and has stood for some milliseconds.
QUIET, LONG = 150, 1500
SETTLED = f"""async ([root, accept, quiet]) => {{
    const now = await ({STATE})(root);
    if (now === null) return false;
    const text = JSON.stringify(now);
    if (text !== root.rbText) [root.rbText, root.rbSince] = [text, performance.now()];
    return now.exact && performance.now() - root.rbSince > quiet && eval(accept)(now) && now;
}}"""
# Whether one step of a slider is in the sentence. The train's place is not: the sentence is
# about the whole crossing. A thousandth of a hertz may be below its last digit, though it moves
# the curves by a part of a pixel.
SAYS = {"first axle (m)": False, "at first (Hz)": None}
# Playing: the slider goes on by itself, and each picture is another.
PLAYED = f"""async ([root, slider, least, pictures]) => {{
    const now = await ({STATE})(root);
    root.rbSeen ??= new Set();
    if (now !== null) root.rbSeen.add(now.picture);
    return root.rbSeen.size >= pictures && +slider.getAttribute('aria-valuenow') >= least;
}}"""
FAR = 8  # m, four steps
# Ten beats of the player without a step.
STOPPED = """([slider]) => {
    const now = slider.getAttribute('aria-valuenow');
    if (now !== slider.rbAt) [slider.rbAt, slider.rbSince] = [now, performance.now()];
    return performance.now() - slider.rbSince > 1000;
}"""


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
        self.lists = root.get_by_role("combobox")
        self.alert = root.get_by_role("alert")
        self.code_area = root.locator("textarea")

    # ---- what it shows

    def settled(self, accept="() => true", quiet=QUIET):
        """Wait until what is shown stands still and `accept`, a JavaScript function of it, is true;
        return it."""
        what = f"a panel that stands still with {accept}"
        return wait_in(self.page, SETTLED, [self.root.element_handle(), accept, quiet], what)

    def begun(self):
        """Wait until there is a picture with its sentence."""
        return self.settled("now => now.width > 0 && now.summary !== '' && now.error === ''")

    def changed(self, before, summary=True):
        """Wait until the picture differs from an earlier one and can be seen.

        The summary has to differ as well (True), to be the same (False), or is left open (None).
        """
        said = (
            "true"
            if summary is None
            else f"(now.summary !== {json.dumps(before['summary'])}) === {json.dumps(summary)}"
        )
        picture = f"now.picture !== {json.dumps(before['picture'])} && now.width > 0"
        return self.settled(f"now => {said} && {picture} && now.error === ''")

    def back(self, start, away):
        """Wait until the picture is not that of `away` any more, and the summary is that of
        `start`.

        The picture need not be that of `start` to the bit: margins may stay wider.
        """
        said = f"now.summary === {json.dumps(start['summary'])}"
        return self.settled(
            f"now => {said} && now.picture !== {json.dumps(away['picture'])} && now.error === ''"
        )

    def refused(self, before):
        """Wait until a value is refused: words where a screen reader hears them, picture and
        summary as they were."""
        same = " && ".join(
            f"now.{what} === {json.dumps(before[what])}" for what in ("picture", "summary")
        )
        now = self.settled(f"now => now.error !== '' && {same} && now.width > 0")
        assert self.alert.inner_text().strip() == now["error"]
        assert self.alert.evaluate("alert => alert.closest('.rb-error') !== null")
        buttons, said = self.button("Paper case").bounding_box(), self.alert.bounding_box()
        below = said["y"] - (buttons["y"] + buttons["height"])
        assert said["height"] > 10 and 0 <= below < 30, "the words stand below the buttons"
        return now

    # ---- its controls

    def row(self, control):
        """The element that holds a slider or a list, its label and its number."""
        return control.locator("xpath=ancestor::*[contains(@class, 'widget-inline-hbox')]")

    def label(self, control):
        """What stands beside a control."""
        return self.row(control).locator(".widget-label").inner_text()

    def number(self, slider):
        """The number beside a slider, as written."""
        return self.field(slider).input_value()

    def field(self, slider):
        """The field for the number beside a slider."""
        return self.row(slider).locator("xpath=..").locator(".rb-number input")

    def slider(self, label):
        """The slider with this label."""
        (found,) = (slider for slider in self.sliders.all() if self.label(slider) == label)
        return found

    def button(self, name):
        return self.root.get_by_role("button", name=name, exact=True)

    def press(self, control, key):
        control.focus()
        self.page.keyboard.press(key)

    def copy(self, text_area):
        """Put the text of an area into the clipboard."""
        text_area.focus()
        for key in ("Control+A", "Control+C"):
            self.page.keyboard.press(key)

    def type_number(self, slider, text):
        self.field(slider).click()
        for key in ("Control+A", *text, "Enter"):
            self.page.keyboard.press(key)

    def there_and_back(self, slider):
        """Two keys: one moves a slider off its place, the other brings it back."""
        at_end = slider.get_attribute("aria-valuenow") == slider.get_attribute("aria-valuemax")
        return ("ArrowLeft", "ArrowRight") if at_end else ("ArrowRight", "ArrowLeft")

    def drag(self, slider, share):
        """Take a slider's knob with the mouse to a share of its track, in small moves as a hand
        does."""
        slider.scroll_into_view_if_needed()
        knob = slider.bounding_box()
        track = slider.locator("xpath=ancestor::*[contains(@class, 'noUi-base')]").bounding_box()
        y = knob["y"] + knob["height"] / 2
        self.page.mouse.move(knob["x"] + knob["width"] / 2, y)
        self.page.mouse.down()
        self.page.mouse.move(track["x"] + share * track["width"], y, steps=8)
        self.page.mouse.up()

    # ---- what is tried with it

    def restored(self, start):
        """Press *Paper case*, unless it is there, and wait until controls and summary are those of
        `start`."""
        if self.settled()["controls"] != start["controls"]:
            self.button("Paper case").click()
        same = " && ".join(
            f"now.{what} === {json.dumps(start[what])}" for what in ("controls", "summary")
        )
        return self.settled(f"now => {same} && now.error === ''")

    def try_controls(self, start):
        """Move every slider by keyboard, choose every line of lists, take all back with *Paper
        case*, drag the first slider.

        Picture and summary follow each time; what the summary does not say is known by the picture,
        which also comes back.
        """
        sliders, lists = self.sliders.all(), self.lists.all()
        shown = self.root.locator(
            ".rb-side .widget-inline-hbox:has(.widget-label)"
            ":not(.widget-label, .rb-number, .widget-textarea, .widget-html)"
        ).count()
        assert len(sliders) + len(lists) == shown > 0, (
            "a control that is neither a slider nor a list"
        )
        now = start
        for slider in sliders:
            there, back = self.there_and_back(slider)
            number, says = self.number(slider), SAYS.get(self.label(slider), True)
            self.press(slider, there)
            before, now = now, self.changed(now, summary=says)
            assert self.number(slider) != number
            if not says:
                self.press(slider, back)
                self.settled(f"now => now.picture === {json.dumps(before['picture'])}")
                self.press(slider, there)
                self.changed(before, summary=says)
        for each in lists:
            now = self.try_list(each, now)
        self.restored(start)
        restored = self.back(start, now)
        number = self.number(sliders[0])
        self.drag(sliders[0], 0.7)
        self.changed(restored)
        assert self.number(sliders[0]) != number

    def try_in_a_hurry(self, start):
        """Move every slider without waiting for any answer and press *Paper case* at once: the last
        word counts."""
        for slider in self.sliders.all():
            there, _ = self.there_and_back(slider)
            self.press(slider, {"ArrowRight": "End", "ArrowLeft": "Home"}[there])
        self.button("Paper case").click()
        same = " && ".join(
            f"now.{what} === {json.dumps(start[what])}" for what in ("controls", "summary")
        )
        self.settled(f"now => {same} && now.error === ''", quiet=LONG)

    def try_list(self, chosen, now):
        """Choose each line of a list in turn; each has a picture and a sentence of its own.

        Return the state at its end.
        """
        said, count = {now["summary"]}, chosen.locator("option").count()
        assert count > 1
        for line in range(1, count):
            chosen.select_option(
                index=line
            )  # as by mouse: JupyterLab takes the arrow keys of a list for its own
            now = self.changed(now)
            said.add(now["summary"])
        assert len(said) == count
        return now

    def try_player(self, start):
        """Let a slider run by itself, pause it and stop it: pictures follow, the sentence on the
        whole crossing stays."""
        (player,) = self.root.locator(".widget-play").all()
        go, stop = player.locator("button:visible").all()
        slider = player.locator("xpath=..").get_by_role("slider")
        low, at, high = (
            float(slider.get_attribute(f"aria-value{what}")) for what in ("min", "now", "max")
        )
        assert low < at < high - FAR
        assert go.locator("i.fa-play").is_visible()
        go.click()
        wait_in(
            self.page,
            PLAYED,
            [self.root.element_handle(), slider.element_handle(), at + FAR, 4],
            "a slider that plays",
        )
        go.locator("i.fa-pause").click()
        wait_in(self.page, STOPPED, [slider.element_handle()], "a slider that pauses")
        assert float(slider.get_attribute("aria-valuenow")) < high, (
            "it was not paused: it ran to its end"
        )
        paused = self.changed(start, summary=False)
        stop.click()
        self.changed(paused, summary=False)
        assert float(slider.get_attribute("aria-valuenow")) == low
