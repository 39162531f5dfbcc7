"""Moving pictures show what was computed, say how much they exaggerate, and play by keyboard."""

import json
import re
import shutil
from base64 import b64decode
from html import unescape
from xml.etree import ElementTree

import numpy as np
import pytest
from IPython.core.formatters import DisplayFormatter

import railbridge as rb
from railbridge.plots import (
    animate_car_on_waves,
    animate_crossing,
    animate_rigid_and_flexible,
    animate_vehicle_mode,
)

NAMESPACE = "{http://www.w3.org/2000/svg}"
FILE_BYTES = 150_000


def data(animation):
    """The numbers that move the picture."""
    return json.loads(re.search(r"const D = (\{.*\});\n", animation.html).group(1))


def words(animation):
    return unescape(re.search(r'<img alt="([^"]*)"', animation.html).group(1))


def picture(animation):
    return ElementTree.fromstring(
        b64decode(re.search(r"base64,([^\"]+)\"", animation.html).group(1)).decode("ascii")
    )


def texts(animation):
    return [item.text for item in picture(animation).iter(f"{NAMESPACE}text")]


@pytest.fixture(scope="module")
def car():
    return rb.vehicle("xia2000")


@pytest.fixture(scope="module")
def run():
    return (
        rb.case("paper")
        .replace(
            {"run.time_step": 4e-3, "run.iterations": 1, "train.cars": 2, "run.loads": "wheels"}
        )
        .run()
    )


@pytest.fixture(scope="module")
def crossing(run):
    return animate_crossing(run)


@pytest.fixture(scope="module")
def animations(car, crossing):
    return [
        animate_vehicle_mode(car, 1),
        animate_vehicle_mode(rb.vehicle("sprung_mass"), 1),
        crossing,
    ]


def test_the_plain_text_says_what_it_is(car, crossing):
    """nbval compares it: it must not depend on which of two equal bogies a program names."""
    assert repr(animate_vehicle_mode(car, 4)) == "Animation: mode 4, bounce, 1.334 Hz, 24 frames"
    assert (
        repr(animate_vehicle_mode(car, 8, frames=12))
        == "Animation: mode 8, pitch, 11.72 Hz, 12 frames"
    )
    assert repr(crossing).startswith("Animation: 2 cars over viaduct36 at 20 m/s, displacement ")


def test_a_notebook_gets_text_and_html(crossing):
    shown, _ = DisplayFormatter().format(crossing)
    assert shown == {"text/plain": repr(crossing), "text/html": crossing.html}


def test_files_are_small_and_ask_for_nothing(animations):
    for animation in animations:
        assert len(animation.html) < FILE_BYTES
        asked = re.findall(
            r"(?:src|href)=\"(?!data:)|url\(|@import|https?://|fetch\(|require\(", animation.html
        )
        assert asked == []


def test_the_paper_case_is_small_too():
    assert len(animate_crossing(rb.paper.run("paper", "condensed", iterations=1)).html) < FILE_BYTES


def test_the_words_below_a_crossing_are_its_numbers(run, crossing):
    """Who cannot see the picture reads them; speed, load and sag are those of the run."""
    sag, moment = run.displacement(18.0).extreme("displacement_z")
    said = words(crossing)
    assert "viaduct36, 36 m, at 20 m/s (72 km/h)" in said
    assert f"At x = 18 m the largest displacement is {1e3 * sag:.2f} mm at {moment:.2f} s." in said
    axle = max(axle.static_load for axle in run.train.placed_axles)
    assert f"{axle / 1e3:.4g} kN at rest" in said
    assert f"{axle / 1e3:.4g} kN, an axle at rest" in texts(crossing)
    drawn = data(crossing)
    when = np.array(drawn["time"])
    known = 1e3 * run.displacement(18.0)["displacement_z"]
    assert np.interp(when, run.time, known) == pytest.approx(drawn["value"], abs=0.02)
    elsewhere = animate_crossing(run, x=9.0, frames=10)
    assert "At x = 9 m the largest displacement is" in words(elsewhere)


def test_the_same_input_gives_the_same_page(car):
    assert animate_vehicle_mode(car, 1).html == animate_vehicle_mode(rb.vehicle("xia2000"), 1).html


def test_a_mode_moves_bodies_as_its_shape_says():
    """The sprung mass has one freedom, up.

    Every corner rises by what the picture says it is drawn as, and no wheel moves.
    """
    animation = animate_vehicle_mode(rb.vehicle("sprung_mass"), 1)
    d, scale = data(animation), 60.0  # px per m, the largest used
    side, *_ = (np.reshape(m, (-1, 2)) for m in d["move"] if len(m) == 8)
    assert np.allclose(side, [0.0, -0.35 * scale], atol=0.06)
    assert "more than 0.35 m" in words(animation)
    spring = np.reshape(next(m for m in d["move"] if len(m) == 16), (-1, 2))
    assert np.allclose(spring[[0, -1]], [[0.0, 0.0], [0.0, -0.35 * scale]], atol=0.06)


def test_lower_sway_turns_the_body_about_an_axis_below_it(car):
    """Looking forward, left is left.

    A lean to the left lowers the left side and moves its top furthest.
    """
    d = data(animate_vehicle_mode(car, 1))
    corners = [
        (np.reshape(r, (-1, 2)), np.reshape(m, (-1, 2)))
        for r, m in zip(d["rest"], d["move"], strict=True)
        if len(r) == 8
    ]
    # Nine polygons: side, top and front, each with the car body last.
    rest, move = corners[8]
    left, top = rest[:, 0] < rest[:, 0].mean(), rest[:, 1] < rest[:, 1].mean()
    assert np.all(move[:, 0] < 0.0)  # all to the left ...
    assert abs(move[top, 0]).min() > abs(move[~top, 0]).max()  # ... the top furthest
    assert np.all(move[left, 1] > 0.0) and np.all(move[~left, 1] < 0.0)  # y is down on a screen


def test_equal_pairs_are_said(car):
    shown = animate_vehicle_mode(car, 8)
    assert "Same frequency as mode 9: any mix of them is a mode as well" in words(shown)
    assert any("one of many shapes" in t for t in texts(shown))
    assert not any("one of many shapes" in t for t in texts(animate_vehicle_mode(car, 4)))


def test_the_deck_is_where_the_run_says_times_the_stated_factor(run, crossing):
    d = data(crossing)
    factor = float(
        re.search(r"drawn ([\d.e+]+) times too large", " ".join(texts(crossing))).group(1)
    )
    assert f"drawn {factor:g} times too large" in words(crossing)
    middle = run.displacement(18.0)["displacement_z"]
    expected = -factor * d["span"] / 36.0 * np.interp(d["time"], run.time, middle)
    assert np.allclose([frame[12] for frame in d["deck"]], expected, atol=0.06)
    assert 5.0 < np.max(d["deck"]) <= 26.0  # px: seen, and clear of what stands below
    assert np.allclose(d["value"], 1e3 * np.interp(d["time"], run.time, middle), atol=6e-4)


def test_the_train_is_where_its_speed_brings_it(run, crossing):
    d = data(crossing)
    metre = d["span"] / 36.0
    assert np.allclose(d["head"], d["left"] + metre * 20.0 * np.array(d["time"]), atol=0.1)
    assert np.allclose(
        np.array(d["delay"]) / metre, [0.0, 2.5, 15.6, 18.1, 22.5, 25.0, 38.1, 40.6], atol=0.01
    )
    assert d["time"][0] == 0.0 and np.isclose(d["time"][-1], (36.0 + 40.6) / 20.0 + 1.0, atol=5e-3)


def test_bars_are_axle_forces_while_the_axle_is_on_the_deck():
    """Bare axles are constant forces.

    All bars are as long as the legend's, and stand from x = 0 to L.
    """
    run = rb.cross(
        rb.AxleTrain([0.0, 5.0], [2e5, 2e5]), rb.deck("viaduct36"), speed=20.0, time_step=4e-3
    )
    shown = animate_crossing(run, frames=200)
    d = data(shown)
    for delay, (first, bar) in zip((0.0, 5.0), d["force"], strict=True):
        assert np.allclose(bar, 30.0)
        assert np.isclose(d["time"][first], delay / 20.0, atol=0.03)
        assert np.isclose(d["time"][first + len(bar) - 1], (delay + 36.0) / 20.0, atol=0.03)
    assert "200 kN, an axle at rest" in texts(shown)
    assert repr(shown).startswith("Animation: 2 axles over viaduct36")


def test_with_a_rail_the_animation_still_begins_when_the_first_axle_enters():
    rail = rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
    train = rb.AxleTrain([0.0, 5.0], [2e5, 2e5])
    run = rb.cross(train, rb.deck("viaduct36", rail=rail), speed=20.0, time_step=4e-3)
    assert run.time[0] < -0.5
    d = data(animate_crossing(run, frames=200))
    assert d["time"][0] == 0.0
    for delay, (first, bar) in zip((0.0, 5.0), d["force"], strict=True):
        assert np.isclose(d["time"][first], delay / 20.0, atol=0.03)
        assert np.isclose(d["time"][first + len(bar) - 1], (delay + 36.0) / 20.0, atol=0.03)


def test_the_still_picture_is_the_frame_of_the_deepest_sag(browser, tmp_path, crossing):
    """Where no script runs it is all there is; the player starts from it and moves nothing."""
    page, _ = opened(browser, tmp_path, crossing)
    names = {
        "data-deck": ("points",),
        "data-train": ("transform",),
        "data-dot": ("cx", "cy"),
        "data-wheel": ("cx", "cy"),
        "data-bar": ("x1", "y1", "x2", "y2"),
    }
    for name, keys in names.items():
        still = [
            [e.get(k) for k in keys] for e in picture(crossing).iter() if e.get(name) is not None
        ]
        played = page.eval_on_selector_all(
            f"[{name}]", "(all, keys) => all.map(e => keys.map(k => e.getAttribute(k)))", list(keys)
        )
        for a, b in zip(still, played, strict=True):
            assert np.allclose(
                *([float(v) for v in re.findall(r"-?[\d.]+", " ".join(s))] for s in (a, b)),
                atol=0.11,
            ), name
    d = data(crossing)
    assert d["start"] == np.argmin(d["value"])
    page.close()


def test_a_given_exaggeration_and_place_are_used(run):
    shown = animate_crossing(run, x=9.0, exaggeration=50.0, frames=40)
    d = data(shown)
    assert "vertical displacement drawn 50 times too large" in texts(shown)
    assert "vertical displacement at x = 9 m (mm)" in texts(shown)
    quarter = np.interp(d["time"], run.time, run.displacement(9.0)["displacement_z"])
    assert np.allclose([f[6] for f in d["deck"]], -50.0 * d["span"] / 36.0 * quarter, atol=0.06)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda car, run: animate_vehicle_mode(car, 16), "mode = 16"),
        (lambda car, run: animate_vehicle_mode(car, 1, frames=3), "frames = 3"),
        (lambda car, run: animate_crossing(run, frames=10_000), "frames = 10000"),
        (lambda car, run: animate_crossing(run, x=40.0), "x = 40"),
        (lambda car, run: animate_crossing(run, exaggeration=0.0), "exaggeration = 0"),
        (lambda car, run: animate_crossing(run, exaggeration=-2.0), "exaggeration = -2"),
        (lambda car, run: animate_crossing(run).save("movie.mp4"), "path = 'movie.mp4'"),
    ],
)
def test_what_cannot_be_shown_is_refused(car, run, call, message):
    with pytest.raises(rb.InputError, match=re.escape(message)):
        call(car, run)


def test_names_of_users_do_not_become_markup(tmp_path):
    deck = rb.Beam("</script><b>&", (20.0,), 9e3, 2e10).deck(modes=2)
    shown = animate_crossing(
        rb.cross(rb.AxleTrain([0.0], [1e5]), deck, speed=20.0, time_step=4e-3), frames=20
    )
    assert shown.html.count("</script>") == 1 and "<b>" not in shown.html
    shown.save(tmp_path / "page.html")
    assert "<title>1 axle over &lt;/script&gt;&lt;b&gt;&amp; at" in (
        tmp_path / "page.html"
    ).read_text(encoding="utf-8")


# ---- in a browser


@pytest.fixture(scope="module")
def browser():
    program = next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
    )
    if program is None:
        pytest.skip("no Chromium is installed")
    sync_api = pytest.importorskip("playwright.sync_api")
    with sync_api.sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=program, args=["--no-sandbox", "--disable-gpu"]
        )
        yield started
        started.close()


def opened(browser, folder, *animations, **options):
    """A page with these animations, and the list of what went wrong on it."""
    (folder / "page.html").write_text(
        "<!doctype html><title>t</title>" + "".join(a.html for a in animations), encoding="utf-8"
    )
    page = browser.new_page(**options)
    wrong = []
    page.on("pageerror", lambda error: wrong.append(str(error)))

    def asked(request):
        if not request.url.startswith(("file:", "data:")):
            wrong.append(request.url)

    page.on("request", asked)
    page.goto((folder / "page.html").as_uri())
    return page, wrong


def test_it_waits_then_plays_and_pauses_by_keyboard(browser, tmp_path, crossing):
    page, wrong = opened(browser, tmp_path, crossing)
    button, slider = page.get_by_role("button"), page.get_by_role("slider")
    assert (
        button.get_attribute("aria-label") == "Play animation"
        and slider.get_attribute("aria-label") == "Time of the crossing"
    )
    # JupyterLab asks the focused element itself whether to leave it keys such as the arrows.
    assert (
        button.get_attribute("data-lm-suppress-shortcuts")
        == slider.get_attribute("data-lm-suppress-shortcuts")
        == "true"
    )
    start = slider.input_value()
    page.wait_for_timeout(250)
    assert slider.input_value() == start, "paused at first"
    deck = page.locator("[data-deck]")
    before = deck.get_attribute("points")
    slider.focus()
    page.keyboard.press("Home")
    assert deck.get_attribute("points") != before and slider.get_attribute(
        "aria-valuetext"
    ).startswith("t = 0.00 s")
    page.keyboard.press("ArrowRight")
    assert slider.input_value() == "1"
    page.keyboard.press("Shift+Tab")
    # A busy machine answers a key a moment later.
    pause, play = (page.locator(f"[aria-label='{word} animation']") for word in ("Pause", "Play"))
    page.keyboard.press("Space")
    pause.wait_for()
    page.wait_for_timeout(400)
    page.keyboard.press("Space")
    play.wait_for()
    stopped = int(slider.input_value())
    assert stopped > 5
    page.wait_for_timeout(250)
    assert int(slider.input_value()) == stopped
    assert wrong == []
    page.close()


POINTS = """() => {
    const moving = '[data-part], [data-line], [data-dot], [data-along]';
    const told = e => ['points', 'cx', 'cy', 'transform'].map(name => e.getAttribute(name) ?? '');
    return [...document.querySelectorAll(moving)].map(e => told(e).join(' '));
}"""


@pytest.mark.parametrize("kind", ["riding", "twice"])
def test_the_script_draws_its_first_frame_as_it_was_stored_and_each_one_differently(
    browser, tmp_path, car, run, kind
):
    if kind == "riding":
        animation = animate_car_on_waves(car, rb.Harmonic(5e-3, 14.4), 20.0, frames=12)
    else:
        animation = animate_rigid_and_flexible(run, frames=12)
    stored = [
        " ".join(item.get(name, "") for name in ("points", "cx", "cy", "transform"))
        for item in picture(animation).iter()
        if any(f"data-{what}" in item.attrib for what in ("part", "line", "dot", "along"))
    ]
    page, wrong = opened(browser, tmp_path, animation)
    drawn = page.evaluate(POINTS)
    assert len(stored) == len(drawn) > 10
    for one, other in zip(stored, drawn, strict=True):
        pair = [list(map(float, re.findall(r"-?[\d.]+", text))) for text in (one, other)]
        assert pair[0] == pytest.approx(pair[1], abs=0.26)
    seen, slider = set(), page.get_by_role("slider")
    slider.focus()
    page.keyboard.press("Home")
    for _ in range(12):
        seen.add(str(page.evaluate(POINTS)) + slider.get_attribute("aria-valuetext"))
        page.keyboard.press("ArrowRight")
    assert len(seen) == 12 and "mm" in slider.get_attribute("aria-valuetext")
    page.get_by_role("button").click()
    page.wait_for_timeout(300)
    assert wrong == []
    page.close()


def test_a_crossing_ends_and_a_mode_goes_round(browser, tmp_path, car, run):
    short = animate_crossing(run, frames=10)
    page, wrong = opened(browser, tmp_path, short, animate_vehicle_mode(car, 1))
    crossing_, mode = (page.locator("[data-animation]").nth(i) for i in (0, 1))
    crossing_.get_by_role("slider").focus()
    page.keyboard.press("End")
    page.keyboard.press("ArrowLeft")
    for animation in (crossing_, mode):
        animation.get_by_role("button").click()
    page.wait_for_timeout(2900)
    assert (
        crossing_.get_by_role("button").inner_text() == "Play"
        and crossing_.get_by_role("slider").input_value() == "9"
    )
    assert mode.get_by_role("button").inner_text() == "Pause", "a mode goes on"
    assert wrong == []
    page.close()


def test_with_reduced_motion_it_steps_and_never_runs(browser, tmp_path, car):
    page, wrong = opened(browser, tmp_path, animate_vehicle_mode(car, 4), reduced_motion="reduce")
    button, slider = page.get_by_role("button"), page.get_by_role("slider")
    assert button.inner_text() == "Step"
    before = int(slider.input_value())
    button.click()
    page.wait_for_timeout(250)
    assert int(slider.input_value()) == before + 1
    assert wrong == []
    page.close()


def test_without_scripts_the_first_picture_stands_with_its_words(browser, tmp_path, crossing):
    page, _ = opened(browser, tmp_path, crossing, java_script_enabled=False)
    assert page.locator("img").bounding_box()["height"] > 300
    assert page.get_by_text("A still picture: run this cell to play it.").is_visible()
    page.close()


def test_the_same_animation_twice_has_two_players(browser, tmp_path, car):
    shown = animate_vehicle_mode(car, 4)
    page, wrong = opened(browser, tmp_path, shown, shown)
    assert page.get_by_role("button").count() == page.get_by_role("slider").count() == 2
    assert wrong == []
    page.close()
