"""What a slider does is seen as its size: scales that stay, and the start in grey behind."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import panels

QUICK = {"run.time_step": None, "train.cars": 2}
GREY = "#8a8a8a"
# What each panel leaves behind, by axes, and what moves it.
BEHIND = {
    "irregularities": {"track": "vertical", "paths": "1 1"},
    "rigid_forces": {"force_z": "force_z", "moment_y": "moment_y", "wheel": "force_z"},
    "deck_modes": {"damping": "total"},
    "deck_response": {
        "displacement": "displacement_z ", "moment": "moment_vertical ",
    },
    "fixed_point": {"force": "rank 1", "displacement": "rank 1", "deviations": "rigid None"},
    "map_and_crossing": {"force": "rank 1", "displacement": "displacement_z "},
    "wheels_with_mass": {"force": "force_z", "acceleration": "acceleration_z deck"},
    "random_track": {"displacement": "mean", "acceleration": "mean + sigma"},
    "overview": {"forces": "force_z", "moments": "moment_y", "displacement": "displacement_z "},
}  # fmt: skip


@pytest.fixture(scope="module")
def all_panels():
    """One panel of each kind, made once: what one test moves, it puts back."""
    return {name: getattr(panels, name)(rb.case("paper").replace(QUICK)) for name in BEHIND}


@pytest.fixture(params=BEHIND)
def panel(request, all_panels):
    yield all_panels[request.param]
    all_panels[request.param].reset()


def line(ax, name):
    return next(line for line in ax.lines if line.get_gid() == name)


def limits(panel):
    return {name: (*ax.get_xlim(), *ax.get_ylim()) for name, ax in panel._axes.items()}


def words_of_legends(panel):
    legends = [ax.get_legend() for ax in panel.figure.axes if ax.get_legend() is not None]
    return {text.get_text() for legend in legends for text in legend.get_texts()}


def move(panel):
    if "damping_ratio" in panel.controls:
        return panel.set(damping_ratio=0.02)
    if "sigma" in panel.controls:
        return panel.set(speed=40.0, sigma=2e-4)
    if "amplitude" not in panel.controls:
        return panel.set(speed=40.0, wavelength=9.0)
    return panel.set(speed=40.0, amplitude=1e-3)


def test_the_start_stays_in_grey_behind_what_moves(panel, request):
    curves = BEHIND[request.node.callspec.params["panel"]]
    pairs = {
        name: (line(panel._axes[name], f"{gid} left behind"), line(panel._axes[name], gid))
        for name, gid in curves.items()
    }
    assert "at the start" in words_of_legends(panel)
    first = {}
    for name, (left, now) in pairs.items():
        first[name] = left.get_ydata().copy()
        at_start = np.interp(left.get_xdata(), now.get_xdata(), now.get_ydata())
        assert at_start == pytest.approx(first[name], rel=0.01, abs=1e-9), name
        assert left.get_color() == GREY and left.get_zorder() < now.get_zorder()
    move(panel)
    for name, (left, now) in pairs.items():
        assert np.array_equal(left.get_ydata(), first[name]), name
        assert not np.array_equal(now.get_ydata(), first[name]), name


def test_the_start_of_the_shipped_case_is_called_the_paper_case():
    words = words_of_legends(panels.irregularities())
    assert "paper case" in words and "at the start" not in words


def test_a_smaller_curve_is_drawn_smaller(panel):
    """The scales of the start are never left for finer ones."""
    start = limits(panel)
    for values in ({}, {"wavelength": 6.2}, {"speed": 80.0}):
        move(panel).set(**{name: v for name, v in values.items() if name in panel.controls})
        for name, now in limits(panel).items():
            first = start[name]
            assert now[0] <= first[0] and now[1] >= first[1], name
            assert now[2] <= first[2] and now[3] >= first[3], name


def test_scales_grow_in_steps_when_a_curve_would_leave_them(all_panels):
    panel = all_panels["rigid_forces"]
    shown = []
    for amplitude in (1e-3, 5e-3, 6e-3, 7e-3, 10e-3):
        panel.set(amplitude=amplitude)
        shown.append(panel._axes["force_z"].get_ylim())
    panel.reset()
    assert shown == [(-100.0, 100.0)] * 3 + [(-150.0, 150.0), (-250.0, 250.0)]


@pytest.mark.parametrize(
    ("name", "axes"),
    [("deck_modes", "frequencies"), ("overview", "spectrum")],
)
def test_axes_of_frequency_stay_whatever_the_speed(all_panels, name, axes):
    panel, shown = all_panels[name], set()
    for speed, wavelength in ((20.0, 14.4), (5.0, 40.0), (80.0, 3.0)):
        panel.set(speed=speed, wavelength=wavelength)
        ax, forcing = panel._axes[axes], speed / wavelength
        shown.add(ax.get_xlim())
        assert ax.get_xlim()[0] < forcing < ax.get_xlim()[1]
    panel.reset()
    assert len(shown) == 1


# ---- over the slider's own quantity


def test_the_bounce_force_over_speed_shows_where_it_is_largest(all_panels):
    panel = all_panels["rigid_forces"]
    ax = panel._axes["over_speed"]
    speed, force = line(ax, "over speed").get_data()
    assert speed[0] == 5.0 and speed[-1] == 80.0
    best = float(speed[np.argmax(force)])
    assert best == 19.5 and line(ax, "line at car bounce").get_xdata()[0] == pytest.approx(
        19.217, abs=1e-3
    )
    panel.set(speed=best)
    assert line(ax, "now").get_data()[0] == [best]
    assert line(ax, "now").get_data()[1] == pytest.approx([force.max()])
    assert f"steady bounce {force.max():.1f} kN" in panel.summary
    panel.set(speed=30.0)
    assert f"steady bounce {line(ax, 'now').get_ydata()[0]:.1f} kN" in panel.summary
    assert np.array_equal(line(ax, "over speed").get_ydata(), force), "of the other settings"
    panel.set(amplitude=2.5e-3)
    assert line(ax, "over speed").get_ydata() == pytest.approx(force / 2)
    assert line(ax, "over speed left behind").get_ydata() == pytest.approx(force)
    panel.reset()


def test_the_curve_over_speed_is_computed_once_for_the_other_settings(all_panels, monkeypatch):
    from railbridge.panels import notebook_panels

    panel, asked = all_panels["rigid_forces"].set(wavelength=11.0), []
    steady = notebook_panels.steady_forces
    monkeypatch.setattr(
        notebook_panels, "steady_forces", lambda *a: asked.append(a[2]) or steady(*a)
    )
    panel.set(speed=31.0).set(speed=32.0)
    assert asked == [31.0, 32.0]
    panel.set(wavelength=12.5)
    assert len(asked) > 100
    panel.reset()


def test_resonance_speeds_stand_along_the_speed(all_panels):
    panel = all_panels["deck_response"]
    ax = panel._axes["in_step"]
    waves = line(ax, "waves in step")
    cars = line(ax, "cars in step")
    f = 3.307
    assert waves.get_xdata()[0] == pytest.approx(f * 14.4, rel=1e-3)
    assert np.allclose(cars.get_xdata()[::3], f * 22.5 / np.arange(1, 5), rtol=1e-3)
    panel.set(speed=33.0, wavelength=10.0)
    assert line(ax, "now").get_xdata() == [33.0]
    assert waves.get_xdata()[0] == pytest.approx(f * 10.0, rel=1e-3)
    panel.set(cars=1)
    assert not np.isfinite(cars.get_xdata()).any(), "one car has no spacing"
    panel.reset()


# ---- the sketch


def test_the_sketch_keeps_its_scales_while_there_is_room(all_panels):
    panel = all_panels["overview"]
    ax, drawn = panel._axes["train"], {}
    for amplitude in (5e-3, 1e-3, 10e-3):
        panel.set(amplitude=amplitude)
        words = " ".join(text.get_text() for text in ax.texts)
        assert "drawn 200 times too large" in words and "this long: 150 kN" in words
        x, rail = line(ax, "rail").get_data()
        drawn[amplitude] = rail[x < 0.0].max()
    assert drawn[1e-3] == pytest.approx(0.2, rel=0.01), "200 times 1 mm"
    assert drawn[10e-3] == pytest.approx(2.0, rel=0.01)
    panel.reset()


# ---- words where a per cent figure would say nothing


@pytest.mark.parametrize("name", ["fixed_point", "overview"])
def test_a_per_cent_figure_of_almost_nothing_is_put_into_words(all_panels, name):
    """At 6.2 m the wheels push against each other: Eq. 3 would say +652 %."""
    panel = all_panels[name].set(wavelength=6.2)
    run = panel.case.run()
    at, rigid = (run.at(i).car_forces(1)["force_z"] for i in (4, 0))
    words = "the rigid-deck force is almost zero here, so a per cent figure says nothing: "
    words += f"it changes by {np.abs(at - rigid).max() / 1e3:.1f} kN"
    assert words in panel.summary and "(Eq. 3)" not in panel.summary
    ax = panel._axes["deviations"]
    assert not np.isfinite(line(ax, "rigid None").get_ydata()).any()
    assert "says nothing" in " ".join(text.get_text() for text in ax.texts)
    panel.reset()
    assert "(Eq. 3)" in panel.summary and "says nothing" not in panel.summary
    assert np.isfinite(line(ax, "rigid None").get_ydata()).all()
    assert "says nothing" not in " ".join(text.get_text() for text in ax.texts)


def test_level_rails_leave_a_force_that_is_all_the_decks(all_panels):
    panel = all_panels["overview"].set(amplitude=0.0)
    assert "almost zero here" in panel.summary and "nan" not in panel.summary
    panel.reset()


def test_the_forces_are_named_at_iteration_0_too(all_panels):
    panel = all_panels["overview"].set(iteration=0)
    assert "largest extra wheel force" in panel.summary
    assert "kN; rigid-deck forces; forcing" in panel.summary
    panel.reset()


def test_the_explorer_keeps_no_forces_of_single_wheels(all_panels):
    """They are ten times as much as what is shown of them."""
    panel = all_panels["overview"].set(iteration=2)
    for _, story in panel._results.values():
        assert "wheel_forces" not in vars(story.stages[2])
        (forces, _), samples = story.axles(2), len(story.stages[2].time)
        assert forces.shape == (8, samples) and forces.dtype == np.float32
    panel.reset()
