"""Waiting for something in a page to become true.

Playwright's own wait takes a promise for an answer, whatever it promises.
"""

PATIENCE = 60.0  # s, for one thing to happen; a notebook runs in 5 to 15 s on two cores
LOOK_EVERY = 50  # ms

LOOP = """async ([argument, patience, pause]) => {
    const end = performance.now() + patience;
    for (;;) {
        const found = await (CONDITION)(argument);
        if (found || performance.now() > end) return found || null;
        await new Promise(go => setTimeout(go, pause));
    }
}"""


def wait_in(page, condition, argument=None, what=""):
    """Return what a JavaScript function of one argument gives, a promise or not, once it is true.

    Raises
    ------
    TimeoutError
        Saying what was waited for.
    """
    found = page.evaluate(
        LOOP.replace("CONDITION", condition), [argument, 1e3 * PATIENCE, LOOK_EVERY]
    )
    if found is None:
        raise TimeoutError(f"not within {PATIENCE:g} s: {what or condition}")
    return found
