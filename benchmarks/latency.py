"""Time from a key press on a slider to the new picture, in a real JupyterLab and a real Chromium.

    python benchmarks/latency.py [PRESSES]

Panels of the suite beside the plain way, `ipywidgets.interact` around the same crossing and the
same figure, and beside pictures that are ready, which cost what browser, server and messages cost.
A press counts until the new picture is decoded and the browser paints its next frame. Panels are
pressed in three ways: step after step, 0.1 s after each picture (the panel has then computed the
next step ahead); by steps and leaps in turn, so that nothing computed ahead is of use; and after a
rest, in which the exact crossing has been computed.

Milliseconds belong to the machine and to what else it does: the last column is the ratio to the
plain way, in the same run.
"""

import os
import secrets
import sys
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"  # the matrices are small; before NumPy is loaded
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "browser"))

import nbformat
import numpy as np
from chromium import NoBrowser, running
from labpage import NotebookOnPage
from served import jupyterlab

import railbridge as rb
from railbridge.plots.drawing import keep_limits

PLAIN = """
import ipywidgets, matplotlib.pyplot as plt
import railbridge as rb

def show(speed):
    changes = {"run.iterations": 4, "run.time_step": None, "train.cars": CARS, "run.speed": speed}
    run = rb.case("paper").replace(changes).run()
    figure, axes = plt.subplots(2, 3, figsize=(11.0, 5.6), layout="constrained")
    rb.plots.train_on_deck(run.train, run.deck, axes[0, 0])
    rb.plots.car_forces(run, components=("force_z", "moment_y"), axes=axes[0, 1:])
    rb.plots.displacement(run, 18.0, ax=axes[1, 0])
    rb.plots.spectrum(run, ax=axes[1, 1])
    rb.plots.deviations(run, ax=axes[1, 2])
    plt.show()

ipywidgets.interact(show, speed=ipywidgets.FloatSlider(20.0, min=5.0, max=80.0, step=0.5));
"""
OURS = """
import railbridge as rb
rb.panels.PANEL(rb.case("paper").replace({"run.time_step": None, "train.cars": CARS}))
"""
READY = """
import ipywidgets
import railbridge as rb

case = rb.case("paper").replace({"run.time_step": None, "train.cars": CARS})
panel = rb.panels.rigid_forces(case)
ready = [panel.set(speed=speed).image.value for speed in (20.5, 21.0)]
image = ipywidgets.Image(format="url", value=ready[0], layout=panel.image.layout)
slider = ipywidgets.FloatSlider(20.0, min=5.0, max=80.0, step=0.5)

def show(change):
    image.value = ready[round(2 * change.new) % 2]

slider.observe(show, names="value")
ipywidgets.VBox([slider, image])
"""
CASES = {
    "plain way, eight cars": (PLAIN, 8),
    "plain way, one car": (PLAIN, 1),
    "two ready pictures in turn, nothing computed": (READY, 1),
    "explorer (00), eight cars, four iterations": (OURS.replace("PANEL", "overview"), 8),
    "explorer (00), one car, four iterations": (OURS.replace("PANEL", "overview"), 1),
    "fixed point (06), eight cars, four iterations": (OURS.replace("PANEL", "fixed_point"), 8),
    "fixed point (06), one car, four iterations": (OURS.replace("PANEL", "fixed_point"), 1),
    "deck response (05), eight cars, rigid": (OURS.replace("PANEL", "deck_response"), 8),
    "rigid forces (03), one car": (OURS.replace("PANEL", "rigid_forces"), 1),
}
# always to speeds that have not been shown yet
STEPS, LEAPS = ["ArrowRight"], ["ArrowRight", "PageUp"]
WAYS = {
    "step after step": (STEPS, 0.1),
    "steps and leaps": (LEAPS, 0.1),
    "after a rest": (LEAPS, 0.5),
}
REST = 0.3  # s; longer, and a panel computes the exact crossing
# Pictures that come without a press (the exact one after a rest) are not counted.
WATCH = """root => {
    window.rbTimes = [];
    window.rbCame = () => {};
    let pressed = null, last = root.querySelector('img').src;
    document.addEventListener('keydown', () => { pressed = performance.now(); }, true);
    new MutationObserver(() => {
        const image = root.querySelector('img');
        if (image === null || image.src === last) return;
        last = image.src;
        if (pressed === null) return;
        const start = pressed;
        pressed = null;
        image.decode().catch(() => null).then(
            () => requestAnimationFrame(() => {
                window.rbTimes.push(performance.now() - start);
                window.rbCame();
            }));
    }).observe(root, {subtree: true, childList: true, attributes: true, attributeFilter: ['src']});
}"""
# Waiting by asking again and again would cost the browser what is measured.
CAME = """count => new Promise(done => {
    window.rbCame = () => { if (window.rbTimes.length >= count) done(); };
    window.rbCame();
})"""


def notebook(folder, name, code):
    """Store a notebook of one cell."""
    folder.mkdir(exist_ok=True)
    nbformat.write(
        nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)]), folder / f"{name}.ipynb"
    )


def measured(page, presses, keys, rest):
    """Times of presses of the keys in turn on the first slider of the page, ms: `rest` seconds
    between picture and press."""
    root = page.locator(".jp-OutputArea").first
    root.locator("img").first.wait_for()
    root.first.evaluate(WATCH)
    slider = root.get_by_role("slider").first
    slider.focus()
    for count in range(1, presses + 1):
        page.keyboard.press(keys[count % len(keys)])
        page.evaluate(CAME, count)
        if rest > REST:  # first the words of this picture come, then the exact one
            for says in ("", "!"):
                moving = "document.querySelector('.rb-summary').innerText.includes('Moving')"
                condition = f"() => {says}{moving}"
                page.wait_for_function(condition, polling=50)
        time.sleep(rest)
    return np.array(page.evaluate("() => window.rbTimes"))


def budget(panel, cars):
    """Processor time of the parts of one answer in the kernel, ms: crossing, moving the curves and
    the words, picture."""
    panel = getattr(rb.panels, panel)(
        rb.case("paper").replace({"run.time_step": None, "train.cars": cars})
    )
    times = []
    for speed in 20.25 + 0.5 * np.arange(15):
        values, clock = panel.values | {"speed": float(speed)}, [time.process_time()]
        case, result = panel._solve(values, rough=True)
        keep_limits(panel.figure, True)
        clock.append(time.process_time())
        panel._draw(panel._axes, case, result, values)
        panel._say(case, result, values)
        clock.append(time.process_time())
        panel._picture.png()
        clock.append(time.process_time())
        times.append(np.diff(clock))
    return 1e3 * np.median(times, axis=0)


def load():
    return (
        f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
        if hasattr(os, "getloadavg")
        else ""
    )


def main(presses=30):
    print("processor time in the kernel, median, ms       crossing   curves and words   picture")
    for panel, cars in (("overview", 8), ("overview", 1), ("fixed_point", 8), ("fixed_point", 1)):
        parts = budget(panel, cars)
        print(
            f"  {panel:12} {cars} car{'s' if cars > 1 else ' '} {parts[0]:33.1f} "
            f"{parts[1]:18.1f} {parts[2]:9.1f}"
        )
    print(
        f"\nkey press to new picture, ms ({presses} presses each)                    median  "
        "  p90   median / plain way"
    )
    plain = {}
    with tempfile.TemporaryDirectory() as folder, running() as browser:
        home = Path(folder)
        for i, (code, cars) in enumerate(CASES.values()):
            notebook(home / "notebooks", f"case{i}", code.replace("CARS", str(cars)))
        with jupyterlab(home, secrets.token_hex(16)) as server:
            for i, (name, (code, cars)) in enumerate(CASES.items()):
                for how, (keys, rest) in (
                    {"step after step": (STEPS, 0.1)}.items()
                    if code in (PLAIN, READY)
                    else WAYS.items()
                ):
                    page = browser.new_context(viewport={"width": 1366, "height": 768}).new_page()
                    NotebookOnPage(page, server, f"case{i}").run_all()
                    times = measured(page, presses // 2 if code is PLAIN else presses, keys, rest)
                    page.context.close()
                    median, most = np.percentile(times, [50, 90])
                    plain.setdefault(cars, median)
                    label = f"{name}, {how}"
                    print(
                        f"  {label:62} {median:7.0f} {most:7.0f} "
                        f"{median / plain[cars]:12.2f}   {load()}",
                        flush=True,
                    )
                    for session in server.ask("api/sessions"):
                        server.ask(f"api/sessions/{session['id']}", method="DELETE")


if __name__ == "__main__":
    try:
        main(*map(int, sys.argv[1:]))
    except NoBrowser as reason:
        sys.exit(str(reason))
