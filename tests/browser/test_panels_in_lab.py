"""Every notebook with something that moves, in JupyterLab: opened, run, and used as somebody before
the screen would."""

import re

import pytest
from chromium import leaves
from labpage import NotebookOnPage
from layout import faults, nameless
from moving import AnimationOnPage
from panel import PanelOnPage
from served import notebooks_with_animations, notebooks_with_panels
from visit import WINDOW, visiting

PANELS = notebooks_with_panels()
MOVING = notebooks_with_animations()
# A case of one's own, as a student writes it: with a step of 5 ms, 62 m/s leave ten samples in
# waves of 3.1 m, and not in 3 m.
OWN_CASE = """import railbridge as rb
waves = {f"track.{way}.wavelength": 4.0 for way in ("vertical", "lateral")}
run = {"run.time_step": 5e-3, "run.speed": 62.0, "train.cars": 2}
rb.panels.fixed_point(rb.case("paper").replace({**run, **waves}))"""


COUNT = "from ipywidgets.widgets import widget\nlen(widget._instances)"


def displacement_at_iteration(said, w, t):
    return f" m is {1e3 * w:.2f} mm at iteration " in said


def largest_displacement(said, w, t):
    return f" m are {1e3 * w:.2f} mm (t = {t:.2f} s)" in said


def forcing_frequency(said, f):
    return f"forcing frequency {f:.3f} Hz" in said


def mode(said, f, ratio):
    return f"{f:.3f} Hz, damping {100 * ratio:.2f} %" in said


def steady_bounce(said, force):
    """What is left of the run-up makes the largest force of a run larger than the steady one, by
    one per cent."""
    return float(re.search(r"steady bounce ([\d.]+) kN", said).group(1)) == pytest.approx(
        force / 1e3, rel=0.015
    )


def displacement_of_the_dot(said, w, t):
    return f" m {1e3 * w:.2f} mm, " in said


# Whether the summary says what the last line of the panel's code gives.
def largest_acceleration(said, value):
    return f"{value:.2f} m/s2" in said


def rarely_exceeded(said, value):
    return f"one crossing in twenty exceeds {value:.2f} m/s2" in said


SAID = {
    "00_start_here": displacement_at_iteration,
    "02_irregularities": forcing_frequency,
    "03_rigid_deck_forces": steady_bounce,
    "04_deck_modes": mode,
    "05_deck_response": largest_displacement,
    "06_fixed_point_iteration": displacement_at_iteration,
    "07_speed_and_wavelength": displacement_of_the_dot,
    "10_random_track": rarely_exceeded,
    "11_your_own_bridge": largest_acceleration,
    "13_beyond_the_paper": largest_acceleration,
}


# ---- one page for all tests of a notebook


@pytest.fixture(scope="module")
def name(request):
    return request.param


@pytest.fixture(scope="module")
def visited(name, browser, lab):
    with visiting(browser, lab) as visit:
        yield visit
    for session in lab.ask("api/sessions"):
        lab.ask(f"api/sessions/{session['id']}", method="DELETE")


@pytest.fixture(scope="module")
def notebook(visited, name):
    shown = NotebookOnPage(visited.page, visited.server, name)
    shown.run_all()
    assert shown.complaints() == []
    return shown


@pytest.fixture(scope="module")
def panel(notebook):
    (root,) = notebook.page.locator(".rb-panel").all()
    return PanelOnPage(root)


@pytest.fixture(scope="module")
def start(panel):
    """What a panel shows first."""
    return panel.begun()


def of(*names):
    return pytest.mark.parametrize("name", names, indirect=True)


@of(*PANELS)
def test_panel_follows_its_controls(visited, notebook, panel, start):
    panel.try_controls(panel.restored(start))
    assert notebook.complaints() == visited.complaints() == []


@of(*PANELS)
def test_the_whole_panel_is_seen_on_one_screen(visited, panel, start):
    """In JupyterLab with its side bar open; the lowest of the windows is a laptop's, less what the
    browser itself takes."""
    try:
        for width, height in ((1366, 650), (1366, 768), (1920, 1080)):
            visited.page.set_viewport_size({"width": width, "height": height})
            panel.settled()
            assert faults(panel.root) == [], (width, height)
    finally:
        visited.page.set_viewport_size(WINDOW)


@of(*PANELS)
def test_screen_readers_have_a_name_for_every_control(panel, start):
    for slider in panel.sliders.all():
        assert panel.root.get_by_role("slider", name=panel.label(slider), exact=True).count() == 1
    assert nameless(panel.root) == []


@of("00_start_here")
def test_the_player_says_what_its_buttons_do(panel, start):
    for names in (("Play", "Pause"), ("Pause", "Play")):
        now, then = (panel.button(f"{name}: first axle (m)") for name in names)
        assert then.count() == 0
        now.click()
        then.wait_for()
    panel.restored(start)


@of("06_fixed_point_iteration")
def test_a_panel_run_again_takes_the_place_of_the_old_one(visited, notebook, panel, start):
    """The cell's output is another panel; the old one's widgets are gone, and nobody complains."""
    now = panel.restored(start)
    before = notebook.run_new_cell(panel.root, lambda: panel.page.keyboard.insert_text(COUNT))
    notebook.run_again(panel.root)
    after = notebook.run_new_cell(panel.root, lambda: panel.page.keyboard.insert_text(COUNT))
    counts = [cell["outputs"][0]["data"]["text/plain"] for cell in (before, after)]
    assert counts[0] == counts[1]
    (root,) = notebook.page.locator(".rb-panel").all()
    own = PanelOnPage(root)
    again = own.begun()
    assert again["summary"] == now["summary"]
    own.press(own.sliders.first, "ArrowRight")
    own.changed(again)
    own.restored(start)
    assert notebook.complaints() == visited.complaints() == []


@of(*PANELS)
def test_the_code_gives_the_number_of_the_summary(visited, notebook, panel, start, name):
    area = panel.code_area
    assert not area.is_visible()
    now = panel.restored(start)
    panel.button("Show this as code").click()
    area.wait_for()
    code = area.input_value()
    assert code.startswith("import railbridge as rb")
    panel.press(panel.sliders.first, "ArrowRight")
    now = panel.changed(now)
    assert area.input_value() != code, "the code does not follow the controls"

    panel.copy(area)
    cell = notebook.run_new_cell(panel.root, lambda: panel.page.keyboard.press("Control+V"))
    assert cell["source"].strip() == area.input_value().strip() != ""
    (result,) = (out for out in cell["outputs"] if out["output_type"] == "execute_result")
    values = map(
        float, re.findall(r"(?<![\w.])-?\d[\d.]*(?:e[+-]?\d+)?", result["data"]["text/plain"])
    )
    assert SAID[name](now["summary"], *values), (
        f"{result['data']['text/plain']} is not in: {now['summary']}"
    )
    panel.button("Hide the code").click()
    area.wait_for(state="hidden")
    assert notebook.complaints() == visited.complaints() == []


@of("04_deck_modes")
def test_a_value_that_cannot_be_is_refused_in_words(visited, notebook, panel, start):
    """Rayleigh damping takes two frequencies: typing the second beside the first leaves one."""
    now = panel.restored(start)
    first, second = panel.slider("at first (Hz)"), panel.slider("and second (Hz)")
    panel.type_number(first, panel.number(second))
    refused = panel.refused(now)
    assert "Not possible" in refused["error"] and "two different frequencies" in refused["error"]
    panel.press(first, "ArrowRight")
    now = panel.changed(now)
    panel.press(first, "ArrowLeft")
    panel.refused(now)
    panel.restored(start)
    assert panel.alert.count() == 0
    assert notebook.complaints() == visited.complaints() == []


@of("03_rigid_deck_forces")
def test_a_comma_is_refused_and_a_point_is_read(visited, notebook, panel, start):
    """A browser reads 12,5 as 12; the panel says what is wrong, and the keyboard mends it."""
    now = panel.restored(start)
    speed = panel.slider("speed (m/s)")
    panel.type_number(speed, "12,5")
    refused = panel.refused(now)
    assert "12,5" in refused["error"] and "with a point: 12.5" in refused["error"]
    panel.type_number(speed, "12.5")
    assert "12.5 m/s" in panel.changed(now)["summary"]
    assert panel.number(speed) == "12.5" and panel.alert.count() == 0
    panel.restored(start)
    assert notebook.complaints() == visited.complaints() == []


@of("04_deck_modes")
def test_a_hurried_hand_is_followed_in_order(visited, notebook, panel, start):
    """JupyterLab sends what sliders say to a thread of its own in the kernel, and what buttons say
    not always."""
    now = panel.restored(start)
    for _ in range(2):
        panel.try_in_a_hurry(now)
    assert notebook.complaints() == visited.complaints() == []


@of("06_fixed_point_iteration")
def test_a_crossing_that_is_refused_says_why(visited, notebook, panel):
    """A case of one's own may allow fewer values than its sliders: they are refused one by one, and
    the rest works."""
    notebook.run_new_cell(panel.root, lambda: panel.page.keyboard.insert_text(OWN_CASE))
    own = PanelOnPage(panel.page.locator(".rb-panel").nth(1))
    now = own.begun()
    wavelength = own.slider("wavelength (m)")
    own.press(wavelength, "Home")
    refused = own.refused(now)
    for words in ("run.time_step = 0.005", "3 m of irregularity", "Leave time_step out"):
        assert words in refused["error"]
    own.press(wavelength, "ArrowRight")
    assert "3.1 m waves" in own.changed(now)["summary"]
    assert own.alert.count() == 0
    assert notebook.complaints() == visited.complaints() == []


@of("06_fixed_point_iteration")
def test_two_panels_on_a_page_keep_their_own_layout(visited, notebook, panel, start):
    notebook.run_new_cell(
        panel.root, lambda: panel.page.keyboard.insert_text("rb.panels.overview()")
    )
    other = panel.page.locator(".rb-panel").nth(1)
    PanelOnPage(other).begun()
    try:
        visited.page.set_viewport_size({"width": 1366, "height": 768})
        for root in (panel.root, other):
            PanelOnPage(root).settled()
            assert faults(root) == []
        side, picture = (
            panel.root.locator(part).bounding_box() for part in (".rb-side", ".rb-picture")
        )
        assert side["x"] + side["width"] <= picture["x"], "controls stand beside the picture"
    finally:
        visited.page.set_viewport_size(WINDOW)


@of("11_your_own_bridge")
def test_the_form_writes_a_case_and_never_over_a_file(visited, notebook, panel):
    form = visited.page.locator(".rb-form")
    form.scroll_into_view_if_needed()
    span = form.get_by_label("span (m)")
    span.fill("2,5")
    span.press("Enter")
    form.get_by_role("alert").get_by_text("with a point: 2.5").wait_for()
    span.fill("25")
    span.press("Enter")
    # pi / (2 L^2) sqrt(E I / m) of 25 m, 12 t/m, 30 GN m2
    form.get_by_text("first frequency 3.974 Hz").wait_for()
    write = form.get_by_role("button", name="Write the case file")
    write.click()
    form.get_by_text("my_bridge.toml is written").wait_for()
    write.click()
    form.get_by_role("alert").get_by_text("is there already").wait_for()
    assert nameless(form) == []
    assert notebook.complaints() == visited.complaints() == []


@of("00_start_here")
def test_the_train_runs_by_itself(visited, notebook, panel, start):
    panel.try_player(panel.restored(start))
    assert notebook.complaints() == visited.complaints() == []


@of(*MOVING)
def test_the_animation_waits_plays_and_pauses(visited, notebook):
    (root,) = visited.page.locator("[data-animation]").all()
    AnimationOnPage(root).try_everything()
    assert nameless(root) == []
    assert notebook.complaints() == visited.complaints() == []


def test_guard_sees_a_request_that_leaves_the_machine(page, record):
    page.goto("about:blank")
    page.evaluate("() => fetch('https://example.org/x.js', {mode: 'no-cors'}).catch(() => null)")
    assert record.left == ["https://example.org/x.js"]
    assert (
        leaves("wss://example.org/x")
        and not leaves("ws://127.0.0.1:8888/x")
        and not leaves("data:image/png;base64,AAAA")
    )
