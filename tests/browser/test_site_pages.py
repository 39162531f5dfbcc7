"""The static site, opened from disk: nothing is fetched, nothing is broken, formulas are drawn,
nothing sticks out."""

import re

import pytest
from moving import AnimationOnPage
from served import ROOT, notebooks_with_animations

SITE = ROOT / "build" / "site"
PAGES = sorted(path.relative_to(SITE).as_posix() for path in SITE.rglob("*.html"))
LOADED = re.compile(
    r"""<(?:script|img|iframe|source|video|link)\b[^>]*?\b(?:src|href)=["']?(https?:)?//""",
    re.IGNORECASE,
)
pytestmark = pytest.mark.skipif(not PAGES, reason="the site is not built: make site")
WIDTHS = (1280, 420)  # px: a desktop, a telephone
# Formulas are drawn, pictures are there; then what is wrong with the page, in words.
FAULTS = """async () => {
    await window.MathJax?.startup?.promise;
    document.querySelectorAll('img').forEach(image => image.loading = 'eager');
    await Promise.all([...document.images].map(image => image.decode().catch(() => null)));
    const bad = [...document.querySelectorAll('[data-mjx-error]')]
        .map(node => 'formula: ' + node.dataset.mjxError);
    for (const image of document.images) {
        if (!image.naturalWidth) bad.push('picture: ' + image.src);
        if (!image.alt || image.alt.endsWith('.png')) bad.push('no text for: ' + image.src);
    }
    const text = document.querySelector('article')?.innerText ?? '';
    if (/\\$\\$|\\\\\\[/.test(text)) bad.push('a formula was left as it is written');
    return bad;
}"""
# The theme hides what sticks out at the side, so the page's own width says nothing. What scrolls in
# a box of its own is right.
TOO_WIDE = """() => {
    const scrolls = node => node.tagName !== 'ARTICLE'
        && (/auto|scroll/.test(getComputedStyle(node).overflowX) || scrolls(node.parentElement));
    const boxed = node => node.closest('svg, mjx-assistive-mml') || scrolls(node.parentElement);
    return [...document.querySelectorAll('article *')]
        .filter(node => node.getBoundingClientRect().right > window.innerWidth + 1 && !boxed(node))
        .map(node => `${node.tagName.toLowerCase()}.${node.className} sticks out of `
            + `${window.innerWidth} px`).slice(0, 3);
}"""


def test_pages_are_whole_without_network(page, record):
    faults = {}
    for name in PAGES:
        page.set_viewport_size({"width": WIDTHS[0], "height": 900})
        page.goto((SITE / name).as_uri())
        found = page.evaluate(FAULTS)
        for width in WIDTHS:
            page.set_viewport_size({"width": width, "height": 900})
            found += page.evaluate(TOO_WIDE)
        if found:
            faults[name] = found
    assert faults == {}
    assert [line for line in record.console if line.startswith(("error", "warning"))] == []
    assert record.uncaught == []
    assert [url for url in record.requests if not url.startswith(("file:", "data:"))] == []


def test_faults_are_found(page):
    page.set_viewport_size({"width": WIDTHS[1], "height": 900})
    page.goto((SITE / "index.html").as_uri())
    page.evaluate("""() => document.querySelector('article').insertAdjacentHTML('beforeend', `
        <div style="width: 900px">x</div>
        <div style="overflow-x: auto"><div style="width: 900px">y</div></div>
        <img src="gone.png" alt="gone"><p>$$ x $$</p>`)""")
    assert page.evaluate(TOO_WIDE) == [f"div. sticks out of {WIDTHS[1]} px"]
    found = page.evaluate(FAULTS)
    assert [fault.partition(":")[0] for fault in found] == [
        "picture",
        "a formula was left as it is written",
    ]


def test_pages_name_nothing_to_be_loaded_from_elsewhere():
    assert [
        name for name in PAGES if LOADED.search((SITE / name).read_text(encoding="utf-8"))
    ] == []
    styles = [
        path.name
        for path in SITE.rglob("*.css")
        if re.search(r"(?:url\(|@import)\s*[\"']?(?:https?:)?//", path.read_text())
    ]
    assert styles == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_can_be_read_on_its_ground(scheme, page):
    page.emulate_media(color_scheme=scheme)
    page.goto((SITE / "index.html").as_uri())
    ground, text = page.evaluate(
        "() => [getComputedStyle(document.body).backgroundColor, "
        "getComputedStyle(document.body).color]"
    )
    dark = [sum(map(int, re.findall(r"\d+", colour)[:3])) < 3 * 128 for colour in (ground, text)]
    assert dark == [scheme == "dark", scheme == "light"]


@pytest.mark.parametrize("name", notebooks_with_animations())
def test_animations_play_from_disk(name, page, record):
    page.goto((SITE / "notebooks" / f"{name}.html").as_uri())
    (root,) = page.locator("[data-animation]").all()
    AnimationOnPage(root).try_everything()
    assert record.uncaught == []
    assert [url for url in record.requests if not url.startswith(("file:", "data:"))] == []


def test_a_picture_of_the_gallery_leads_to_its_figure(page):
    page.goto((SITE / "gallery.html").as_uri())
    page.locator(".rb-gallery a").first.click()
    page.wait_for_url("**/notebooks/00_start_here.html#figure-0-1")
    assert page.locator("#figure-0-1").count() == 1
    assert page.locator(".rb-still").inner_text().startswith("Interactive panel")
