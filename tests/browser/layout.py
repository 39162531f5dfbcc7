"""Whether what stands in a page can be seen and named: sizes, overlaps, what sticks out, names."""

import re

# What is wrong with the controls, in words.
FAULTS = """([root, slider]) => {
    const box = element => element.getBoundingClientRect(), bad = [];
    const filled = element => {  // a label is wider than its words
        const words = document.createRange();
        words.selectNodeContents(element);
        return element.matches('.widget-label') ? words.getBoundingClientRect() : box(element);
    };
    const name = element => element.getAttribute('aria-label') || element.innerText
        || element.className;
    const seen = selector => [...root.querySelectorAll(selector)].filter(e => box(e).width > 0);
    for (const track of seen('.noUi-target'))
        if (box(track).width < slider)
            bad.push(`a slider is ${Math.round(box(track).width)} px wide`);
    const cut = (e, spare) => e.scrollWidth > e.clientWidth + spare
        || e.scrollHeight > e.clientHeight + 1;
    for (const button of seen('button'))
        if (cut(button, 0)) bad.push(`${name(button)} is cut`);
    for (const text of seen('.rb-control .widget-label, .widget-readout'))
        if (text.scrollWidth > text.clientWidth + 1) bad.push(`${name(text)} is cut`);
    const parts = seen('button, select, .noUi-target, .widget-readout, .rb-control .widget-label, '
        + '.rb-picture, .rb-summary');
    parts.forEach((a, i) => parts.slice(i + 1).forEach(b => {
        const [p, q] = [filled(a), filled(b)];
        const across = Math.min(p.right, q.right) - Math.max(p.left, q.left);
        const down = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
        if (across > 1 && down > 1) bad.push(`${name(a)} lies on ${name(b)}`);
    }));
    return bad;
}"""
# Height of the part of the window in which the panel is seen, and of the panel with its words.
HEIGHTS = """root => {
    const view = root.closest('.jp-WindowedPanel-outer') ?? document.scrollingElement;
    const box = element => element.getBoundingClientRect();
    const page = view === document.scrollingElement;
    const seen = page ? innerHeight - box(root).top : view.clientHeight;
    const ends = ['.rb-side', '.rb-picture', '.rb-summary']
        .map(part => box(root.querySelector(part)).bottom);
    return [seen, Math.max(...ends) - box(root).top];
}"""
SIDEWAYS = """root => {
    const scrolls = [];
    for (let node = root; node; node = node.parentElement)
        if (node.scrollWidth > node.clientWidth + 1
            && /auto|scroll/.test(getComputedStyle(node).overflowX)) scrolls.push(node.className);
    if (document.scrollingElement.scrollWidth > innerWidth) scrolls.push('the page');
    return scrolls;
}"""
WIDTH_OF_A_SLIDER = 150  # px
NAMELESS = re.compile(r"^\s*- (?:slider|button|combobox|textbox|img|group)\b(?! \")", re.MULTILINE)


def faults(root):
    """What is wrong with the sizes and places of a panel's parts, in words."""
    found = root.evaluate(f"root => ({FAULTS})([root, {WIDTH_OF_A_SLIDER}])")
    found += [f"sideways: {name}" for name in root.evaluate(SIDEWAYS)]
    seen, needed = root.evaluate(HEIGHTS)
    if needed > seen:
        found.append(f"{needed:.0f} px high where {seen:.0f} can be seen")
    return found


def nameless(root):
    """The controls and pictures below an element that a screen reader cannot name."""
    return [line.strip() for line in NAMELESS.findall(root.aria_snapshot())]
