"""An animation in a page: paused, playing, moved by hand."""

from waiting import wait_in

# The drawing as it stands, and the words beside it.
DRAWN = (
    "root => [root.querySelector('svg').outerHTML, "
    "root.querySelector('input').getAttribute('aria-valuetext')].join('|')"
)
# The same drawing over FRAMES pictures of the browser, half a second on a calm machine.
FRAMES = 30
STANDS = f"""async root => {{
    const drawn = {DRAWN}, before = drawn(root);
    for (let frame = 0; frame < {FRAMES}; frame++) {{
        await new Promise(go => requestAnimationFrame(go));
        if (drawn(root) !== before) return false;
    }}
    return true;
}}"""
SEVERAL = f"""([root, least]) => {{
    root.rbSeen ??= new Set();
    root.rbSeen.add(({DRAWN})(root));
    return root.rbSeen.size >= least;
}}"""


class AnimationOnPage:
    """One animation in a page.

    Parameters
    ----------
    root : playwright Locator
        The element with the attribute ``data-animation``.
    """

    def __init__(self, root):
        self.root, self.page = root, root.page
        root.locator("svg").wait_for()
        root.scroll_into_view_if_needed()

    def stands(self):
        """True if nothing moves by itself."""
        return self.root.evaluate(STANDS)

    def drawn(self):
        return self.root.evaluate(DRAWN)

    def button(self, name):
        return self.root.get_by_role("button", name=f"{name} animation", exact=True)

    def try_everything(self):
        """It waits to be played, plays, pauses, and follows its slider by keyboard."""
        assert self.button("Pause").count() == 0
        assert self.stands(), "it plays before anybody asked it to"
        self.button("Play").click()
        wait_in(self.page, SEVERAL, [self.root.element_handle(), 10], "an animation that plays")
        self.button("Pause").click()
        assert self.stands(), "it is not paused"
        assert self.button("Play").is_visible()
        before = self.drawn()
        self.root.get_by_role("slider").focus()
        self.page.keyboard.press("Home")
        first = self.drawn()
        self.page.keyboard.press("ArrowRight")
        second = self.drawn()
        assert len({before, first, second}) == 3, "it does not follow its slider"
        self.page.keyboard.press("ArrowLeft")
        assert self.drawn() == first
