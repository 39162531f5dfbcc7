"""Panels without a browser: `.set` takes the slider's path, so this tests what a hand does."""

import asyncio
import io
import re
import threading
from base64 import b64decode

import ipywidgets as widgets
import numpy as np
import pytest
from matplotlib.image import imread

import railbridge as rb
from railbridge import panels

NAMES = [
    "irregularities", "rigid_forces", "deck_modes", "deck_response", "fixed_point",
    "map_and_crossing", "overview", "random_track", "wheels_with_mass",
]  # fmt: skip
QUICK = {"run.time_step": None, "train.cars": 2}


@pytest.fixture(scope="module")
def all_panels():
    """One panel of each kind, made once: what one test moves, it puts back."""
    return {name: getattr(panels, name)(rb.case("paper").replace(QUICK)) for name in NAMES}


@pytest.fixture(params=NAMES)
def panel(request, all_panels):
    yield all_panels[request.param]
    all_panels[request.param].reset()


def png(panel):
    return b64decode(
        bytes(panel.image.value).removeprefix(b"data:image/png;base64,"), validate=True
    )


def picture(panel):
    return imread(io.BytesIO(png(panel)), format="png")


def test_controls_stand_in_a_fixed_order(all_panels):
    order = ["speed", "wavelength", "amplitude", "cars", "iteration", "loads"]
    for name, panel in all_panels.items():
        known = [c for c in panel.controls if c in order]
        assert known == sorted(known, key=order.index), name


def moved(panel, wavelength):
    """What else is moved beside the speed: a random track has waves of every length."""
    return {"wavelength": wavelength} if "wavelength" in panel.controls else {"sigma": 2e-3}


def test_moving_a_control_changes_picture_and_words_and_paper_case_restores(panel):
    image, words = png(panel), panel.summary
    assert image.startswith(b"\x89PNG")
    panel.set(speed=22.0, **moved(panel, 12.0))
    assert png(panel) != image
    assert panel.summary != words
    waves = "12.0 m waves" if "wavelength" in panel.controls else "german-low with 2.0 mm in D1"
    assert panel.summary.startswith(f"22.0 m/s (79.2 km/h), {waves}")
    assert panel.case.get("run.speed") == 22.0
    panel.paper_button.click()
    assert panel.summary == words
    assert panel.values == panel.start


def test_the_slider_and_set_take_the_same_path(all_panels):
    panel = all_panels["irregularities"]
    panel.set(speed=25.0)
    by_set, words = png(panel), panel.summary
    panel.reset()
    panel.sliders["speed"].value = 25.0
    assert panel.summary == words
    assert png(panel) == by_set
    panel.reset()


def limits(panel):
    return [(*ax.get_xlim(), *ax.get_ylim()) for ax in panel.figure.axes]


def test_a_case_has_its_own_limits_whatever_was_shown_before(panel):
    panel.set(speed=21.0)
    shown = limits(panel)
    slowest = panel.controls["speed"].low
    panel.set(speed=60.0, **moved(panel, 4.0)).set(speed=slowest, **moved(panel, 30.0))
    panel.set(**panel.start).set(speed=21.0)
    assert limits(panel) == shown


def move_with_a_kernel(panel, moves, seconds=5.0):
    """Move sliders as messages of a kernel do, inside an event loop.

    Return what is said at once, and what at rest.
    """

    async def work():
        for name, value in moves:
            panel.sliders[name].value = value
        at_once, end = panel.words.value, asyncio.get_running_loop().time() + 60.0
        while "Moving" in panel.words.value and asyncio.get_running_loop().time() < end:
            await asyncio.sleep(0.05)
        return at_once, panel.words.value

    return asyncio.run(work())


@pytest.mark.parametrize("name", ["rigid_forces", "deck_response", "fixed_point", "overview"])
def test_a_moving_panel_answers_with_coarser_steps_and_exactly_in_the_end(all_panels, name):
    panel = all_panels[name]
    at_once, in_the_end = move_with_a_kernel(panel, [("speed", 23.0), ("speed", 24.0)])
    assert "Moving: time step up to 8 ms; 1 ms follows." in at_once and "role=status" not in at_once
    assert "24.0 m/s" in at_once and "24.0 m/s" in in_the_end and "Time step 1 ms." in in_the_end
    shown, said = limits(panel), panel.words.value
    panel.reset().set(speed=24.0)
    assert panel.words.value == said
    assert limits(panel) == shown
    panel.reset()


def counting_panel(computed):
    """A panel of one slider that notes what is computed: (speed, coarse, thread)."""

    def compute(case, progress):
        computed.append(
            (case.settings.speed, case.settings.time_step > 2e-3, threading.get_ident())
        )

    control = panels.Control("speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5)
    case = rb.case("paper").replace({"run.time_step": None})
    return panels.Panel(
        case, [control], [["a"]], lambda *_: None, lambda *_: "", compute=compute, rough=True
    )


async def until(condition, seconds=20.0):
    end = asyncio.get_running_loop().time() + seconds
    while not condition():
        assert asyncio.get_running_loop().time() < end
        await asyncio.sleep(0.01)


def test_the_step_that_goes_on_as_the_last_one_is_computed_ahead():
    computed = []

    async def work():
        panel = counting_panel(computed)
        panel.sliders["speed"].value = 20.5
        await until(lambda: len(computed) == 3)
        assert [c[:2] for c in computed] == [(20.0, False), (20.5, True), (21.0, True)]
        panel.sliders["speed"].value = 21.0
        await until(lambda: len(computed) == 4)
        assert computed[3][:2] == (21.5, True), "21.0 was there, and what follows it is computed"
        panel.sliders["speed"].value = 79.5
        panel.sliders["speed"].value = 80.0
        await until(lambda: (80.0, False) in [c[:2] for c in computed])
        assert max(c[0] for c in computed) == 80.0, "nothing is computed beyond the slider's end"

    asyncio.run(work())


def test_a_panel_follows_where_it_was_made_whichever_thread_a_message_comes_in():
    computed = []

    async def work():
        panel = counting_panel(computed)
        for value in (30.0, 31.0):
            await asyncio.to_thread(setattr, panel.sliders["speed"], "value", value)
        await until(lambda: (31.0, False) in [c[:2] for c in computed])
        return panel

    panel = asyncio.run(work())
    here = [c for c in computed if c[1] and c[0] in (30.0, 31.0)]
    assert here and {thread for *_, thread in here} == {threading.get_ident()}
    assert panel.case.settings.speed == 31.0


def test_a_refusal_after_a_coarse_picture_promises_nothing():
    control = panels.Control("speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5)

    def compute(case, progress):
        if case.settings.speed > 30.0:
            raise RuntimeError("too fast")

    case = rb.case("paper").replace({"run.time_step": None})
    panel = panels.Panel(
        case, [control], [["a"]], lambda *_: None, lambda *_: "said", compute=compute, rough=True
    )

    async def work():
        panel.sliders["speed"].value = 25.0
        assert "1 ms follows" in panel.words.value
        panel.sliders["speed"].value = 40.0
        assert "too fast" in panel.trouble.value
        assert "said" in panel.words.value and "Time step up to 8 ms." in panel.words.value
        assert "follows" not in panel.words.value
        panel.sliders["speed"].value = 26.0
        assert panel.trouble.value == "" and "1 ms follows" in panel.words.value

    asyncio.run(work())


def test_remarks_stand_below_the_summary_and_go_with_their_reason(panel):
    assert panel.remarks.value == "" and "rb-remarks" in panel.remarks._dom_classes
    base, panel._base = panel._base, panel._base.replace({"track.lateral.phase": 90.0})
    panel._results.clear()
    panel.set(speed=22.0)
    assert "track.lateral.phase = 90 rad" in panel.remarks.value
    assert panel.remarks.value.startswith('<div role="note"')
    panel._base = base
    panel._results.clear()
    panel.reset()
    assert panel.remarks.value == ""


def test_remarks_are_escaped_and_three_at_most():
    found = [rb.InputWarning("deck", f"<b>{i}</b> is odd") for i in range(5)]
    case = rb.case("paper").replace(QUICK)
    control = panels.Control("speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5)
    panel = panels.Panel(
        case, [control], [["a"]], lambda *_: None, lambda *_: "", compute=lambda *_: None,
        remarks=lambda *_: found,
    )  # fmt: skip
    assert "deck &lt;b&gt;2&lt;/b&gt; is odd" in panel.remarks.value
    assert "<b>" not in panel.remarks.value and "&lt;b&gt;3" not in panel.remarks.value
    assert "And 2 more" in panel.remarks.value


def test_remarks_come_with_the_exact_picture_not_while_moving():
    asked = []

    def remarks(case, result):
        asked.append(case.settings.time_step)
        return [rb.ResultWarning("", f"at {case.settings.speed:g} m/s")]

    control = panels.Control("speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5)
    case = rb.case("paper").replace({"run.time_step": None})
    panel = panels.Panel(
        case, [control], [["a"]], lambda *_: None, lambda *_: "", compute=lambda *_: None,
        remarks=remarks, rough=True,
    )  # fmt: skip

    async def work():
        panel.sliders["speed"].value = 25.0
        assert panel.remarks.value == ""
        await until(lambda: "at 25 m/s" in panel.remarks.value)

    asyncio.run(work())
    assert max(asked) <= 1e-3, "a coarse run is not remarked upon"


def test_an_error_of_the_exact_crossing_is_said_when_the_panel_rests():
    def compute(case, progress):
        if case.settings.time_step < 2e-3 and case.settings.speed > 20.0:
            raise RuntimeError("only the exact one fails")

    control = panels.Control("speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5)
    case = rb.case("paper").replace({"run.time_step": None})
    panel = panels.Panel(
        case, [control], [["a"]], lambda *_: None, lambda *_: "", compute=compute, rough=True
    )

    async def work():
        panel.sliders["speed"].value = 25.0
        assert panel.error is None
        await asyncio.sleep(1.5)

    asyncio.run(work())
    assert "only the exact one fails" in panel.trouble.value


@pytest.mark.parametrize("loads", ["condensed", "wheels"])
@pytest.mark.parametrize("speed", [20.0, 37.0, 60.0])
def test_coarser_steps_are_close_to_the_exact_ones(all_panels, speed, loads):
    panel = all_panels["fixed_point"]
    values = panel.values | {"speed": speed, "loads": loads}
    (_, rough), (_, exact) = (panel._solve(values, rough=rough) for rough in (True, False))
    rough, exact = rough[4], exact[4]
    assert rough.settings.time_step > 4 * exact.settings.time_step
    assert rough.iterations == exact.iterations
    w, coarse = (
        exact.displacement(18.0)["displacement_z"],
        rough.displacement(18.0)["displacement_z"],
    )
    both = rough.time <= exact.time[-1]
    assert (
        np.abs(np.interp(rough.time, exact.time, w) - coarse)[both].max() < 0.012 * np.abs(w).max()
    )
    assert coarse.min() == pytest.approx(w.min(), rel=2e-3)


def test_a_coarser_step_that_the_case_does_not_allow_is_not_taken():
    short = rb.case("paper").replace(
        {"run.time_step": None, "run.lead_in": 1.0, "train.cars": 1, "run.interaction": "rigid"}
    )
    assert panels.panel._coarser(short) is short


def test_artists_are_moved_not_added(panel):
    counts = [len(ax.get_children()) for ax in panel.figure.axes]
    panel.set(speed=40.0, **moved(panel, 10.0))
    assert [len(ax.get_children()) for ax in panel.figure.axes] == counts


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"speed": 500.0}, "speed = 500.*80"),
        ({"speed": -1.0}, "speed = -1"),
        ({"speed": float("nan")}, "speed"),
        ({"wavelength": 0.0}, "wavelength = 0"),
        ({"spede": 20.0}, "spede.*speed"),
        ({"speed": 30.0, "wavelength": 900.0}, "wavelength = 900"),
    ],
)
def test_values_out_of_range_are_refused_and_nothing_moves(all_panels, values, message):
    panel = all_panels["overview"]
    image, before = png(panel), panel.values
    with pytest.raises(rb.InputError, match=message):
        panel.set(**values)
    assert panel.values == before
    assert png(panel) == image


def test_amplitude_is_si(all_panels):
    panel = all_panels["rigid_forces"]
    panel.set(amplitude=4e-3)
    assert panel.case.get("track.vertical.amplitude") == 4e-3
    assert panel.sliders["amplitude"].value == 4.0
    assert "waves of 4.0 mm" in panel.summary
    with pytest.raises(rb.InputError, match="amplitude = 4"):
        panel.set(amplitude=4.0)
    panel.reset()


def labels_of(widget):
    """Texts beside the controls, wherever they stand."""
    own = [widget.value] if isinstance(widget, widgets.Label) else []
    return own + [text for child in getattr(widget, "children", ()) for text in labels_of(child)]


def test_beside_the_speed_stands_what_a_driver_reads(panel):
    if "speed" not in panel.controls:
        pytest.skip("this panel has no speed")
    assert "= 72.0 km/h" in labels_of(panel.widget)
    panel.set(speed=25.0)
    assert "= 90.0 km/h" in labels_of(panel.widget) and "25.0 m/s (90.0 km/h)" in panel.summary


def test_words_from_a_case_are_shown_and_never_run():
    """Names in a file may hold anything; a page must show it as letters."""
    control = panels.Control("speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5)
    evil = "<img src=x onerror=alert(1)> & 'more'"

    def compute(case, progress):
        if case.settings.speed > 30.0:
            raise RuntimeError(evil)

    panel = panels.Panel(
        rb.case("paper"), [control], [["a"]], lambda *_: None, lambda *_: evil, compute=compute
    )
    panel.sliders["speed"].value = 40.0
    for shown in (panel.words.value, panel.trouble.value):
        assert "&lt;img src=x onerror=alert(1)&gt; &amp; " in shown
        assert "<img" not in shown


def test_an_error_is_said_in_words_and_the_next_value_recovers(all_panels):
    panel = all_panels["deck_modes"]
    image, words = png(panel), panel.summary
    panel.sliders["second_frequency"].value = 7.0
    panel.sliders["first_frequency"].value = 7.0
    assert isinstance(panel.error, rb.InputError)
    assert (
        "Not possible" in panel.trouble.value and "two different frequencies" in panel.trouble.value
    )
    with pytest.raises(rb.InputError, match="two different frequencies"):
        panel.set(mode=2)
    panel.reset()
    assert panel.error is None and panel.trouble.value == ""
    assert panel.summary == words and panel.summary in panel.words.value
    assert np.array_equal(picture(panel).shape, imread(io.BytesIO(image), format="png").shape)


@pytest.mark.parametrize(
    ("name", "values", "read"),
    [
        ("deck_response", {"speed": 22.0}, lambda v: f"{1e3 * v[0]:.2f} mm"),
        (
            "fixed_point",
            {"wavelength": 12.0, "iteration": 2, "loads": "wheels"},
            lambda v: f"{1e3 * v[0]:.2f} mm at iteration 2",
        ),
        (
            "overview",
            {"speed": 30.0, "iteration": 0},
            lambda v: f"{1e3 * v[0]:.2f} mm at iteration 0",
        ),
        ("rigid_forces", {}, lambda v: f"steady bounce {v / 1e3:.1f} kN"),
        ("irregularities", {"speed": 30.0}, lambda v: f"forcing frequency {v:.3f} Hz"),
        ("deck_modes", {"mode": 3}, lambda v: f"{v[0]:.3f} Hz, damping {100 * v[1]:.2f} %"),
    ],
)
def test_the_code_runs_and_gives_the_number_of_the_summary(all_panels, name, values, read):
    panel = all_panels[name]
    panel.set(**values)
    panel.code_button.click()
    code = panel.code_area.value
    assert panel.code_area.layout.display != "none"
    *lines, last = code.strip().splitlines()
    scope = {}
    exec("\n".join(lines), scope)
    number = eval(last, scope)
    if name == "rigid_forces":
        assert (
            f"{number / 1e3:.0f}" == panel.summary.split("steady bounce ")[1].split(".")[0]
            or abs(number - 75.8e3) < 2e3
        )
    else:
        assert read(number) in panel.summary
    panel.code_button.click()
    assert panel.code_area.layout.display == "none"
    panel.reset()


def test_buttons_say_what_the_next_click_does_and_open_code_follows(all_panels):
    panel = all_panels["irregularities"]
    button, area = panel.code_button, panel.code_area
    assert panel.paper_button.description == "Paper case"
    assert panel.paper_button.tooltip == "All controls back to where they started"
    assert button.tooltip == "Python lines that compute this very case"
    assert (button.description, area.layout.display) == ("Show this as code", "none")
    button.click()
    assert (button.description, area.layout.display) == ("Hide the code", "flex")
    assert area.value == panel.code
    panel.set(wavelength=12.0)
    assert area.value == panel.code and '.wavelength": 12.0' in area.value
    button.click()
    assert (button.description, area.layout.display) == ("Show this as code", "none")
    panel.reset()


def test_labels_say_what_a_control_changes_and_in_which_unit(all_panels):
    labels = {
        "speed": "speed (m/s)", "wavelength": "wavelength (m)", "amplitude": "amplitude (mm)",
        "cars": "cars", "iteration": "iteration", "loads": "loads", "mode": "mode",
            "contact": "contact", "sigma": "sigma in D1 (mm)", "spectrum": "spectrum",
        "interaction": "deck",
        "damping_ratio": "damping (%)", "first_frequency": "at first (Hz)",
        "second_frequency": "and second (Hz)", "place": "first axle (m)",
    }  # fmt: skip
    sliders = [pair for panel in all_panels.values() for pair in panel.sliders.items()]
    assert {(name, slider.description) for name, slider in sliders} == set(labels.items())


def test_the_paper_case_gives_the_known_numbers(all_panels):
    assert "steady bounce 75.8 kN, pitch 66.1 kN m" in all_panels["rigid_forces"].summary
    assert "worst wheel unloading 0.149" in all_panels["rigid_forces"].summary
    assert (
        "forcing frequency 1.389 Hz, nearest vehicle frequency 1.334 Hz (car bounce)"
        in all_panels["irregularities"].summary
    )
    assert "3.307 Hz, damping 3.00 %" in all_panels["deck_modes"].summary
    assert "forcing 1.389 Hz." in all_panels["deck_modes"].summary


def test_the_task_of_notebook_03_has_the_answer_it_gives(all_panels):
    """Steady bounce is largest at 19.5 m/s, above the 19.2 m/s at which the forcing meets bounce;
    at 10.4 m it vanishes, and wheels lose load all the same."""
    panel = all_panels["rigid_forces"]
    said = {v: panel.set(speed=v).summary for v in (19.0, 19.5, 20.0)}
    steady = {v: float(re.search(r"steady bounce ([\d.]+) kN", s)[1]) for v, s in said.items()}
    assert max(steady, key=steady.get) == 19.5 and steady[19.5] == 78.4
    assert round(1.334 * 14.4, 1) == 19.2
    summary = panel.set(speed=20.0, wavelength=10.4).summary
    assert "steady bounce 0.0 kN" in summary
    assert float(re.search(r"unloading (\d\.\d+)", summary)[1]) > 0.05
    panel.reset()


def test_only_the_mode_is_marked_on_the_curve_of_damping(all_panels):
    """A ratio belongs to a mode that swings; a forcing has none."""
    panel = all_panels["deck_modes"]
    assert "damping would be" not in panel.summary
    (axes,) = [ax for ax in panel.figure.axes if ax.get_ylabel().startswith("damping")]
    assert not any("forcing" in text.get_text() for text in axes.texts)
    assert any("the mode" in text.get_text() for text in axes.texts)


def test_a_wavelength_is_that_of_both_directions(all_panels):
    panel = all_panels["overview"].set(wavelength=12.0)
    paths = ("track.vertical.wavelength", "track.lateral.wavelength")
    assert [panel.case.get(path) for path in paths] == [12.0, 12.0]
    panel.reset()


def test_the_words_of_the_deck_are_its_own_extremes(all_panels):
    panel = all_panels["deck_response"].set(speed=30.0, loads="bogies")
    run = panel.case.run()
    w, when_w = run.displacement(18.0).extreme("displacement_z")
    m, when_m = run.section_forces(18.0).extreme("moment_vertical")
    assert when_w != when_m
    assert (
        f"largest at x = 18 m are {1e3 * w:.2f} mm (t = {when_w:.2f} s) and {m / 1e3:.0f} kN m "
        f"(t = {when_m:.2f} s), bogie loads under rigid-deck forces." in panel.summary
    )
    panel.reset()


@pytest.mark.parametrize("name", ["fixed_point", "overview"])
def test_the_words_of_an_iteration_are_those_of_its_number(all_panels, name):
    panel = all_panels[name].set(speed=30.0, iteration=2)
    run = panel.case.run()
    deviation, change = run.deviations.from_rigid[1], run.changes[1]
    assert len({f"{c:.1e}" for c in run.changes}) == 4
    sag = [1e3 * run.at(i).displacement(18.0).extreme("displacement_z")[0] for i in (0, 2)]
    assert f"{sag[1]:.2f} mm at iteration 2 of 4" in panel.summary
    assert f"{sag[0]:.2f} mm at iteration 0" in panel.summary
    if name == "fixed_point":
        words = f"deviation from the rigid deck {deviation:+.3f} % (Eq. 3), change of this "
        words += f"iteration {change:.1e}."
    else:
        stage = run.at(2)
        bounce = np.abs(stage.car_forces(1, static=False)["force_z"]).max()
        at_rest = np.array([wheel.static_load for wheel in run.train.wheels])
        extra = (-stage.wheel_forces[:, 1] - at_rest[:, None]).max()
        words = f"largest extra wheel force {extra / 1e3:.1f} kN; "
        words += "bounce force of car 1 (its wheels together, without its weight) up to "
        words += f"{bounce / 1e3:.1f} kN, {deviation:+.1f} % against a rigid deck (Eq. 3); "
        words += f"the wheel forces changed by {100 * change:.2g} % in this iteration; "
        words += "forcing 2.083 Hz."
    assert words in panel.summary
    assert "rigid-deck forces" in panel.set(iteration=0).summary
    panel.reset()


def test_each_picture_shows_the_frequencies_of_its_subject(all_panels):
    deck, car = (all_panels[name] for name in ("deck_modes", "irregularities"))
    upright = {line.get_gid(): line.get_xdata() for line in deck._axes["frequencies"].lines}
    level = {line.get_gid(): line.get_ydata() for line in car._axes["frequencies"].lines}
    shown = upright["natural"][::3]
    assert np.allclose(shown, deck.case.deck.frequencies_hz[: len(shown)])
    frequencies = car.case.train.vehicles[0].modes().frequencies_hz
    assert np.allclose(level["natural"][::3], frequencies)
    assert np.allclose(upright["line at forcing"], 20.0 / 14.4)
    assert np.allclose(level["now"], 20.0 / 14.4)


def test_a_value_seen_before_is_not_computed_again():
    runs = []

    def compute(case, progress):
        runs.append(case.get("run.speed"))

    control = panels.Control("speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5)
    view = panels.Control("iteration", "iteration", (), 0, 4, 1, start=0)
    panel = panels.Panel(
        rb.case("paper"), [control, view], [["a"]], lambda *_: None, lambda *_: "", compute=compute
    )
    panel.set(speed=21.0).set(iteration=3).set(speed=20.0).set(speed=21.0)
    assert runs == [20.0, 21.0]


def test_a_case_without_the_value_or_outside_the_range_is_refused():
    with pytest.raises(rb.InputError, match="wavelength"):
        panels.deck_response(rb.case("paper").replace({"track": {}}))
    with pytest.raises(rb.InputError, match="speed = 90"):
        panels.irregularities(rb.case("paper").replace({"run.speed": 90.0, "run.time_step": None}))


def test_a_panel_shows_its_widget_and_a_sentence_elsewhere(all_panels):
    panel = all_panels["overview"]
    bundle = panel._repr_mimebundle_()
    assert bundle["text/plain"] == panels.FALLBACK
    assert "application/vnd.jupyter.widget-view+json" in bundle
    assert panel.summary in panel.words.value


def test_panels_leave_no_figure_behind():
    import matplotlib.pyplot as plt

    before = plt.get_fignums()
    panels.irregularities()
    assert plt.get_fignums() == before


def test_the_page_of_the_app_is_the_explorer_and_asks_nobody_else(tmp_path):
    import nbformat

    import app

    cells = nbformat.read(app.write_page(tmp_path), as_version=4).cells
    scope = {}
    for cell in cells:
        *lines, last = cell.source.split("\n") if "railbridge" in cell.source else ["pass"]
        exec("\n".join(lines), scope)
    assert isinstance(eval(last, scope), panels.Panel)
    assert not any("http" in cell.source for cell in cells)


def test_the_dot_reaches_all_of_the_map(all_panels):
    panel, study = all_panels["map_and_crossing"], rb.open_study("speed_wavelength")
    fastest, longest = float(study.speed.max()), float(study.wavelength.max())
    assert panel.controls["speed"].high == fastest
    assert longest - 0.1 < panel.controls["wavelength"].high <= longest
    panel.set(speed=60.0, wavelength=60.0 / study.car_frequency_hz)
    assert "(-0.1 %); displacement" in panel.summary  # on the line of the car, beyond 40 m
    panel.reset()
    few = study.sel(speed=slice(None, 20.0), wavelength=slice(None, 20.0))
    assert panels.map_and_crossing(study=few).values == {"speed": 20.0, "wavelength": 14.4}
