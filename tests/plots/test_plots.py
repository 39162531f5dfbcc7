"""Every figure is drawn, says its units, changes no settings; no legend hides anything."""

import inspect
import re
from dataclasses import replace
from functools import cache

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

import railbridge as rb
from railbridge import plots
from railbridge.plots.drawing import FIGURE_WIDTH, reuse_artists
from railbridge.plots.scene import crossing_at
from railbridge.plots.style import QUANTITY_STYLES, RUN_COLOURS, other_shade


@pytest.fixture(scope="module")
def case():
    return rb.case("paper").replace({"run.time_step": 4e-3, "run.iterations": 4, "train.cars": 2})


@pytest.fixture(scope="module")
def run(case):
    return case.run()


@cache
def box():
    return rb.Box(
        "box", (36.0,), 9.6, 0.25, 2.0, 0.35, 5.0, 0.2, 34e9, tracks={"left": 2.4, "right": -2.4}
    )


@cache
def shell_and_modes():
    shell = box().shell(rb.BoxMesh(16, 2, 4, 2))
    return shell, shell.modes(6)


def speeds_and_waves():
    xr = pytest.importorskip("xarray")

    values = np.array([[1.0, 2.0, 1.5], [1.0, 1.5, 4.0]])
    variables = {"acceleration_z": (("train", "speed"), values, {"units": "m/s2"})}
    return xr.Dataset(variables, {"train": ["A1", "A2"], "speed": [40.0, 50.0, 60.0]})


def judged():
    limit = rb.codes.acceleration_limit("ballasted")
    return rb.codes.Verdicts([rb.codes.judge(value, limit) for value in (1.0, 4.0, None)])


@pytest.fixture(scope="module")
def figures(case, run):
    """One call of every figure, by name."""
    car, deck, train, track = run.train.vehicles[0], run.deck, run.train, run.track
    notch = rb.Notch(((1, 1),), 2.7, 1.0, 1e-3, 0.05)
    drawn = rb.random_response(
        rb.Train(car), deck, rb.RandomTrack("german-low", (20, 60), components=("vertical",)),
        speed=40.0, time_step=4e-3,
    )  # fmt: skip
    sag = drawn.names[0]
    return {
        "acceleration": lambda: plots.acceleration(run, 18.0),
        "assurance": lambda: plots.assurance(np.eye(3), ("a", "b", "c"), ("d", "e", "f")),
        "box_section": lambda: plots.box_section(box(), box().section),
        "car_body": lambda: plots.car_body(run, 2),
        "car_forces": lambda: plots.car_forces(run, steady={"force_z": 75.8e3}),
        "convergence": lambda: plots.convergence(run),
        "damping": lambda: plots.damping(1.0364, 4.87e-4, {"second bending": 13.23}),
        "deck_envelope": lambda: plots.deck_envelope(run),
        "deck_mode": lambda: plots.deck_mode(deck, 3),
        "deck_modes": lambda: plots.deck_modes(deck),
        "deviations": lambda: plots.deviations({"condensed": run}),
        "displacement": lambda: plots.displacement(run, 18.0, self_weight=True),
        "envelope": lambda: plots.envelope(speeds_and_waves(), "acceleration_z", limit=1.0),
        "extremes": lambda: plots.extremes(drawn.ensemble(20), sag, drawn.extreme(sag)),
        "frequencies": lambda: plots.frequencies(car, {"second bending": 13.23}),
        "influence_line": lambda: plots.influence_line(deck, "moment_vertical", 18.0),
        "irregularity": lambda: plots.irregularity(track, -170.0, 50.0, lead_in=150.0, deck=deck),
        "iterations": lambda: plots.iterations(run, "displacement_z"),
        "load_modes": lambda: plots.load_modes({"condensed": run}, 18.0, "moment_vertical"),
        "map": lambda: plots.map(rb.open_study("speed_wavelength"), "acceleration_z"),
        "notch": lambda: plots.notch(notch, 0.0, 10.0),
        "random_response": lambda: plots.random_response(drawn, sag, seeds=(1, 2)),
        "reactions": lambda: plots.reactions(run),
        "section_force": lambda: plots.section_force(run, 18.0, "torsion"),
        "shell_mode": lambda: plots.shell_mode(*shell_and_modes(), 4),
        "shell_modes": lambda: plots.shell_modes(*shell_and_modes()),
        "slope": lambda: plots.slope(track, deck=36.0),
        "spectra": lambda: plots.spectra(run),
        "spectrum": lambda: plots.spectrum(run, mark={"second bending": 13.23}),
        "track_spectra": lambda: plots.track_spectra(["german-low", "fra-aar-4"]),
        "train_on_deck": lambda: plots.train_on_deck(train, deck),
        "vehicle": lambda: plots.vehicle(car),
        "vehicle_mode": lambda: plots.vehicle_mode(car, 4),
        "velocity": lambda: plots.velocity(run, 18.0),
        "utilisation": lambda: plots.utilisation(judged()),
        "wave_shares": lambda: plots.wave_shares(drawn, sag, 0.5),
        "wheel_force": lambda: plots.wheel_force(run),
        "wheel_forces": lambda: plots.wheel_forces(run, 2),
        "wheel_paths": lambda: plots.wheel_paths(train, track, 20.0),
        "wheels_on_track": lambda: plots.wheels_on_track(train, track),
    }


# What moves, and the diagrams, are no figures of Matplotlib.
FIGURES = [n for n in plots.__all__ if n != "diagram" and not n.startswith("animate_")]

TIME, PLACE = "time since the first axle entered (s)", "x from the bridge entrance (m)"
HERTZ = "frequency (Hz)"
# What stands along x and along y, each once.
LABELS = {
    "acceleration": ([TIME], ["vertical acceleration (m/s²)"]),
    "assurance": (["mode of the beam (-)"], ["mode of the shell"]),
    "box_section": (["y, to the left (m)"], ["height above the underside (m)"]),
    "car_body": ([TIME], ["vertical acceleration (m/s²)", "lateral acceleration (m/s²)"]),
    "car_forces": ([TIME], ["lateral force (kN)", "vertical force (kN)", "roll moment (kN m)",
                            "pitch moment (kN m)", "yaw moment (kN m)"]),
    "convergence": (["iteration"], ["change of the wheel forces (-)"]),
    "damping": ([HERTZ], ["damping ratio (%)"]),
    "deck_envelope": ([PLACE], ["vertical displacement (mm)"]),
    "deck_mode": ([PLACE], ["shape (-)"]),
    "deck_modes": ([PLACE], ["shape (-)"]),
    "deviations": (["iteration"], ["deviation, Eq. 3 (%)"]),
    "displacement": ([TIME], ["vertical displacement (mm)"]),
    "envelope": (["speed (m/s)"], ["acceleration z (m/s²)"]),
    "extremes": (["extreme of the vertical displacement (mm)"], ["share per mm"]),
    "frequencies": ([HERTZ], []),
    "influence_line": (["place of the load, x (m)"], ["per unit upward load (m)"]),
    "irregularity": ([PLACE], ["irregularity r (mm)"]),
    "iterations": ([TIME], ["vertical displacement (mm)", "minus iteration 4 (mm)"]),
    "load_modes": ([TIME], ["vertical bending moment (kN m)"]),
    "map": (["speed (m/s)"], ["wavelength (m)"]),
    "notch": (["place of the wheel from the bridge entrance (m)"], ["r (mm)"]),
    "random_response": ([TIME], ["vertical displacement (mm)"]),
    "reactions": ([TIME], ["vertical reaction (kN)"]),
    "section_force": ([TIME], ["torsion (kN m)"]),
    "shell_mode": (["length 36.6 (m), motion drawn up to 1.2 (m)"], []),
    "shell_modes": (["length 36.6 (m), motion drawn up to 1.2 (m)"], []),
    "slope": ([PLACE], ["slope dr/dx (mm/m)"]),
    "spectra": ([HERTZ], ["amplitude (kN)"]),
    "spectrum": ([HERTZ], ["amplitude (kN)"]),
    "track_spectra": (["wavelength (m)"], ["vertical, density (mm² per rad/m)"]),
    "train_on_deck": ([PLACE], []),
    "vehicle": (["x (m)", "y (m)"], ["height, schematic", "y (m)"]),
    "vehicle_mode": (["x (m)", "y (m)"], ["height, schematic", "y (m)"]),
    "velocity": ([TIME], ["vertical velocity (mm/s)"]),
    "utilisation": (["utilisation, value / limit (-)"], []),
    "wave_shares": (["waves up to this length (m)"], ["share of the variance"]),
    "wheel_force": ([TIME], ["wheel force on the deck (kN)"]),
    "wheel_forces": ([TIME], ["force (kN)"]),
    "wheel_paths": ([TIME], ["r under the wheel (mm)"]),
    "wheels_on_track": ([PLACE], ["irregularity r (mm)"]),
}  # fmt: skip


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_has_its_labels_no_side_effects_and_a_legend_above_the_data(name, figures):
    before = dict(mpl.rcParams)
    axes = np.ravel(np.asarray(figures[name](), dtype=object))
    figure = axes[0].figure
    figure.canvas.draw()
    assert dict(mpl.rcParams) == before
    assert all(isinstance(ax, mpl.axes.Axes) for ax in axes)
    along, upright = zip(*((ax.get_xlabel(), ax.get_ylabel()) for ax in axes), strict=True)
    for labels, known in zip((along, upright), LABELS[name], strict=True):
        assert list(dict.fromkeys(x.replace("\n", " ") for x in labels if x)) == known
    assert figure.get_figwidth() == FIGURE_WIDTH
    # A legend stands above the data, or beside them.
    for ax in axes:
        if ax.get_legend() is not None:
            box, frame = ax.get_legend().get_window_extent(), ax.get_window_extent()
            assert box.y0 >= frame.y1 - 1.0 or box.x0 >= frame.x1 - 1.0
            assert box.x0 >= 0.0 and box.x1 <= figure.bbox.x1 + 1.0


def test_given_axes_are_used_and_returned(run):
    figure, (upper, lower) = plt.subplots(2, 1)
    assert plots.displacement(run, 18.0, ax=upper) is upper
    assert list(plots.iterations(run, ax=(upper, lower))) == [upper, lower]
    assert figure.axes == [upper, lower]
    assert plt.get_fignums() == [figure.number]


@pytest.mark.parametrize(
    ("vehicle", "modes"),
    [("xia2000", (1, 9, 15)), ("xia2000_planar", (1, 3)), ("sprung_mass", (1,))],
)
def test_any_vehicle_and_its_modes_can_be_sketched(vehicle, modes):
    v = rb.vehicle(vehicle)
    assert len(plots.vehicle(v)) == 3
    for mode in modes:
        axes = plots.vehicle_mode(v, mode)
        assert axes[0].get_title(loc="left").startswith(f"mode {mode}: ")
        plt.close("all")


def test_mode_titles_say_frequency_and_what_moves():
    car = rb.vehicle("xia2000")
    assert (
        plots.vehicle_mode(car, 4)[0]
        .get_title(loc="left")
        .startswith("mode 4: 1.334 Hz\nCar bounces (100 %)")
    )
    assert "Same frequency as mode 9" in plots.vehicle_mode(car, 8)[0].get_title(
        loc="left"
    ).replace("\n", " ")


def test_a_mode_moves_its_body_as_its_shape_says():
    axes = plots.vehicle_mode(rb.vehicle("sprung_mass"), 1, scale=0.2)
    rest, moved = (p.get_xy() for p in axes[0].patches if p.get_xy().shape == (5, 2))
    assert np.allclose(moved - rest, [0.0, 0.2])


def test_displays_are_in_kn_and_mm(run):
    def data(ax, name):
        return next(line for line in ax.lines if (line.get_gid() or "").strip() == name).get_ydata()

    mm = data(plots.displacement(run, 18.0), "displacement_z")
    assert np.allclose(mm, 1e3 * run.displacement(18.0)["displacement_z"])
    kn = data(plots.wheel_force(run, 2, 3), "force_z")
    assert np.allclose(kn, 1e-3 * run.wheel_force(2, 3)["force_z"])
    assert np.all(kn < 0)


def test_a_body_s_accelerations_stand_under_their_places(run):
    for ax, way in zip(plots.car_body(run, 2), "zy", strict=True):
        own = run.car_accelerations(2)
        lines = {line.get_gid(): line.get_ydata() for line in ax.lines}
        assert {name: list(y) for name, y in lines.items()} == {
            place: list(own[f"{place} acceleration_{way}"]) for place in ("front", "middle", "rear")
        }
    (ax,) = plots.car_body(run, 1, components=("acceleration_y",))
    assert "lateral" in ax.get_ylabel() and ax.get_xlabel() == TIME
    assert [t.get_text() for t in ax.get_legend().get_texts()] == [
        "car 1 on the deck", "front", "middle", "rear",
    ]  # fmt: skip


def test_a_planar_car_has_no_lateral_curves():
    track = rb.Track(vertical=rb.Harmonic(1e-3, 10.0))
    run = rb.cross(
        rb.Train(rb.vehicle("xia2000_planar")), rb.deck("viaduct36"), track, speed=40.0,
        time_step=4e-3, interaction="rigid",
    )  # fmt: skip
    (ax,) = plots.car_body(run)
    assert "vertical" in ax.get_ylabel()
    for ax in plots.wheel_forces(run):
        assert [line.get_gid() for line in ax.lines] == ["force_z left"]
    bare = rb.cross(rb.AxleTrain([0.0], [1e5]), run.deck, speed=20.0, time_step=4e-3)
    for wrong in (lambda: plots.car_body(bare), lambda: plots.car_body(run, 2)):
        with pytest.raises(rb.InputError, match="^car = "):
            wrong()
    with pytest.raises(rb.InputError, match="components = 'acceleration_x'"):
        plots.car_body(run, components=("acceleration_x",))


def test_wheel_forces_can_be_drawn_one_way_in_a_scale_of_their_own(run):
    for way, word in (("force_y", "lateral"), ("force_z", "vertical")):
        axes = plots.wheel_forces(run, 2, components=(way,))
        for ax, axle in zip(axes, run.train.car(2).axles, strict=True):
            assert ax.get_ylabel().replace("\n", " ") == f"{word} force (kN)"
            lines = {line.get_gid(): line.get_ydata() for line in ax.lines}
            assert list(lines) == [f"{way} left", f"{way} right"]
            for wheel in axle.wheels:
                drawn = lines[f"{way} {wheel.side}"]
                assert np.allclose(drawn, 1e-3 * run.wheel_force(2, wheel.number)[way])
    with pytest.raises(rb.InputError, match="components = 'force_x'"):
        plots.wheel_forces(run, components=("force_x",))


def test_the_envelope_along_a_deck_is_that_of_its_places(run):
    found = run.envelope("moment_vertical")
    ax = plots.deck_envelope(run, "moment_vertical")
    lines = {line.get_gid(): line for line in ax.lines}
    extremes = [found.at(i).extremes("value") for i in range(len(found.x))]
    for name, side in (("smallest", 0), ("largest", 1)):
        values = 1e-3 * np.array([each[side][0] for each in extremes])
        assert np.array_equal(lines[name].get_xdata(), found.x)
        assert lines[name].get_ydata() == pytest.approx(values)
        place = found.x[np.argmin(values) if side == 0 else np.argmax(values)]
        worst = values.min() if side == 0 else values.max()
        assert lines[name].get_label() == f"{name} {worst:.4g} kN m at x = {place:g} m"
    assert list(lines["bearings"].get_xdata()) == [0.0, 36.0]
    assert min(lines["smallest"].get_ydata()) < -4000
    bare = replace(run, deck=replace(run.deck, recovery=None, supports=()))
    with pytest.raises(rb.InputError, match="quantity = 'torsion'"):
        plots.deck_envelope(bare, "torsion")
    with pytest.raises(rb.InputError, match="Did you mean 'torsion'"):
        plots.deck_envelope(run, "torsoin")


@pytest.mark.filterwarnings("error")
def test_a_deck_without_bearing_lines_leaves_room_for_its_curves(run):
    deck = replace(run.deck, supports=())
    for ax in (plots.deck_mode(deck, 1), plots.deck_envelope(replace(run, deck=deck))):
        ax.figure.canvas.draw()
        assert ax.get_position().height > 0.4


def test_every_bearing_line_has_a_curve():
    spans = rb.deck_from_table("long", {
        "spans": [20.0] * 10, "bending_stiffness_vertical": 6e10, "mass": 11e3, "modes": 12,
        "damping": {"modal": 0.02},
    })  # fmt: skip
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), spans, speed=60.0, time_step=4e-3)
    drawn = [line.get_gid() for line in plots.reactions(run).lines]
    assert drawn == [f"bearing at {20 * i} m" for i in range(11)]


def test_steady_amplitudes_stand_around_the_weight_where_it_is_counted(run):
    weight = sum(wheel.static_load for wheel in run.train.car(1).wheels)
    for static, middle in ((False, 0.0), (True, -1e-3 * weight)):
        options = {"static": static, "steady": {"force_z": 75e3}, "components": ("force_z",)}
        (ax,) = plots.car_forces(run, **options)
        (line,) = (line for line in ax.lines if line.get_gid() == "steady")
        levels = line.get_ydata()[[0, 1, 3, 4]]
        assert np.allclose(levels, middle + np.array([75.0, 75.0, -75.0, -75.0]))


def test_a_deck_of_modes_alone_has_influence_lines_of_its_motion_only(run):
    known = (
        "name",
        "length",
        "shapes",
        "frequencies_hz",
        "damping_ratios",
        "mode_names",
        "supports",
    )
    deck = rb.Deck(**{name: getattr(run.deck, name) for name in known})
    line, other = (
        next(
            line
            for line in plots.influence_line(d, "displacement_z", 9.0).lines
            if line.get_gid() == "line"
        )
        for d in (deck, run.deck)
    )
    assert np.allclose(
        line.get_ydata(), other.get_ydata(), atol=2e-3 * np.abs(other.get_ydata()).max()
    )
    with pytest.raises(rb.InputError, match="only its modes are known"):
        plots.influence_line(deck, "moment_vertical", 9.0)


def test_spectra_titles_give_equation_3(run):
    titles = [ax.get_title(loc="left") for ax in plots.spectra(run)]
    assert titles[0] == "i = 0, rigid deck"
    assert titles[2] == f"i = 2, Eq. 3: {run.deviations.from_rigid[1]:+.3f} %"


def test_spectra_on_level_track_are_seen_whole_and_have_no_equation_3(run):
    """The rigid deck's force is constant there: the others stood cut off in its scale."""
    level = rb.cross(run.train, run.deck, speed=60.0, time_step=4e-3, iterations=2)
    axes = plots.spectra(level)
    assert [ax.get_title(loc="left") for ax in axes] == ["i = 0, rigid deck", "i = 1", "i = 2"]
    highest = 1e-3 * max(level.at(i).spectrum.amplitude.max() for i in (1, 2))
    assert highest > 0.1
    for ax in axes:
        assert ax.get_ylim()[0] == 0.0 and ax.get_ylim()[1] == pytest.approx(1.05 * highest)


def labelled(ax, label):
    return next(line for line in ax.lines if line.get_label() == label)


# From SI to what is drawn, by the unit that stands on the axis.
DRAWN = {"mm": 1e3, "kN": 1e-3, "kN m": 1e-3, "mrad": 1e3, "mm/s": 1e3, "mrad/s": 1e3, "mm/m": 1e3}
DRAWN |= {"m/s²": 1.0, "rad/s²": 1.0, "%": 100.0}
HISTORIES = [
    (lambda r: plots.displacement(r, 18.0), "displacement", "displacement_z", "vertical", "mm"),
    (
        lambda r: plots.displacement(r, 18.0, component="y"),
        "displacement",
        "displacement_y",
        "lateral",
        "mm",
    ),
    (
        lambda r: plots.displacement(r, 18.0, component="x"),
        "displacement",
        "rotation_x",
        "twist",
        "mrad",
    ),
    (lambda r: plots.velocity(r, 18.0), "velocity", "velocity_z", "vertical", "mm/s"),
    (
        lambda r: plots.velocity(r, 18.0, component="roll"),
        "velocity",
        "velocity_roll",
        "twist",
        "mrad/s",
    ),
    (lambda r: plots.acceleration(r, 18.0), "acceleration", "acceleration_z", "vertical", "m/s²"),
    (
        lambda r: plots.section_force(r, 18.0),
        "section_forces",
        "moment_vertical",
        "vertical bending moment",
        "kN m",
    ),
    (
        lambda r: plots.section_force(r, 18.0, "moment_lateral"),
        "section_forces",
        "moment_lateral",
        "lateral bending moment",
        "kN m",
    ),
    (
        lambda r: plots.section_force(r, 18.0, "torsion"),
        "section_forces",
        "torsion",
        "torsion",
        "kN m",
    ),
    (
        lambda r: plots.section_force(r, 9.0, "shear_vertical"),
        "section_forces",
        "shear_vertical",
        "vertical shear",
        "kN",
    ),
]


@pytest.mark.parametrize(("figure", "call", "quantity", "words", "unit"), HISTORIES)
def test_a_history_is_drawn_as_it_is_in_the_unit_of_its_axis(
    run, figure, call, quantity, words, unit
):
    x = 9.0 if quantity == "shear_vertical" else 18.0
    ax = figure(run)
    line = next(line for line in ax.lines if line.get_gid().startswith(quantity))
    assert np.array_equal(line.get_xdata(), run.time)
    assert np.allclose(line.get_ydata(), DRAWN[unit] * getattr(run, call)(x)[quantity])
    assert ax.get_ylabel().replace("\n", " ").startswith(words)
    assert (
        f"({unit})" in ax.get_ylabel()
        and ax.get_xlabel().startswith("time")
        and ("(s)" in ax.get_xlabel())
    )
    assert f"x = {x:g} m" in line.get_label()


@pytest.mark.parametrize("name", QUANTITY_STYLES)
def test_a_quantity_s_factor_is_that_of_its_unit(name):
    style = QUANTITY_STYLES[name]
    assert style.factor == DRAWN[style.unit]
    for direction, mark in (("vertical", ("_z", "vertical")), ("lateral", ("_y", "lateral"))):
        if name.endswith(mark) and not name.startswith(("moment_", "rotation_")):
            assert style.words.startswith(direction), name


@pytest.mark.parametrize(
    ("quantity", "unit"), [("force_z", "kN"), ("force_y", "kN"), ("moment_x", "kN m")]
)
def test_reactions_stand_under_the_name_of_their_bearing(run, quantity, unit):
    ax = plots.reactions(run, quantity=quantity)
    for x, history in run.reactions().items():
        drawn = labelled(ax, f"bearing at {x:g} m").get_ydata()
        assert np.allclose(drawn, 1e-3 * history[quantity])
    assert f"({unit})" in ax.get_ylabel()


def test_forces_of_a_car_stand_under_their_own_names(run):
    for ax, name in zip(plots.car_forces(run, 2), rb.trains.CONDENSED, strict=True):
        line = next(line for line in ax.lines if line.get_gid() == name)
        assert np.allclose(line.get_ydata(), 1e-3 * run.car_forces(2, "track", False)[name])
        assert QUANTITY_STYLES[name].words in ax.get_ylabel().replace("\n", " ")
    forces, moments = plots.forces.car_components(run)
    for ax, labels, kind in (
        (forces, {"lateral": "force_y", "vertical": "force_z"}, "force (kN)"),
        (moments, {"roll": "moment_x", "pitch": "moment_y", "yaw": "moment_z"}, "moment (kN m)"),
    ):
        for label, name in labels.items():
            own = 1e-3 * run.car_forces(1, static=False)[name]
            assert np.allclose(labelled(ax, label).get_ydata(), own)
        assert ax.get_ylabel() == f"car 1, {kind}"


def test_wheels_of_an_axle_stand_under_their_rail(run):
    axes = plots.wheel_forces(run, 2)
    assert [ax.get_title(loc="left") for ax in axes] == [f"axle {n}" for n in (1, 2, 3, 4)]
    for number, ax in enumerate(axes):
        drawn = {line.get_gid(): line.get_ydata() for line in ax.lines}
        for side, wheel in (("left", 2 * number + 1), ("right", 2 * number + 2)):
            history = run.wheel_force(2, wheel)
            for name in ("force_y", "force_z"):
                assert np.allclose(drawn[f"{name} {side}"], 1e-3 * history[name])
    shown = {line.get_label() for line in axes[0].lines if line.get_label()[0] != "_"}
    assert shown >= {f"{w} force, {s}" for w in ("lateral", "vertical") for s in ("left", "right")}


def test_spectra_convergence_and_damping_are_drawn_as_computed(run):
    line = next(x for x in plots.spectrum(run).lines if x.get_gid().endswith("heads"))
    assert np.allclose(line.get_ydata(), 1e-3 * run.spectrum.amplitude)
    assert np.array_equal(line.get_xdata(), run.spectrum.frequency)
    ax = plots.convergence({"condensed": run})
    assert np.allclose(labelled(ax, "condensed").get_ydata(), run.changes)
    alpha, beta = 1.0364, 4.87e-4
    ax = plots.damping(alpha, beta)
    for label, a, b in (
        ("mass part", alpha, 0.0),
        ("stiffness part", 0.0, beta),
        ("damping ratio", alpha, beta),
    ):
        f, shown = labelled(ax, label).get_data()
        assert np.allclose(shown, 100 * (a / (4 * np.pi * f) + b * np.pi * f))


def sketch(run, position, **scales):
    ax = crossing_at(run, position, plt.figure().add_subplot(), **scales)
    words = " ".join(text.get_text() for text in ax.texts)
    return {line.get_gid(): line.get_data() for line in ax.lines}, words


def test_the_train_rides_on_the_waves_and_on_the_deck_as_they_are_drawn(run):
    """On the rail before and behind, on the bent deck between, at the places of its wheels."""
    drawn, words = sketch(run, 60.0)
    factor = float(re.search(r"drawn (\S+) times", words)[1])
    x, z = drawn["wheels"]
    assert np.allclose(np.sort(x), np.sort([60.0 - a.delay for a in run.train.placed_axles]))
    off = (x < 0.0) | (x > 36.0)
    assert off.any() and not off.all()
    waves = factor * 5e-3 * np.sin(2 * np.pi * x / 14.4)
    assert np.abs(waves).max() > 0.3, "they can be seen"
    assert np.allclose(z[off], waves[off] + 0.35)
    along, deck = drawn["deck"]
    low = deck[0]
    assert np.allclose(z[~off], np.interp(x[~off], along, deck - low) + waves[~off] + 0.35)
    sample = round(60.0 / 20.0 / run.settings.time_step)
    shown = [run.displacement(place, kept_only=True) for place in along]
    known = [history["displacement_z"][sample] for history in shown]
    assert np.allclose(deck - low, factor * np.array(known), atol=1e-9)
    x, rail = drawn["rail"]
    assert np.allclose(np.interp(drawn["wheels"][0], x, rail), z - 0.35, atol=0.02)


def test_the_rail_is_level_before_its_run_up(case):
    run = case.replace({"run.lead_in": 20.0}).compute()
    x, rail = sketch(run, 30.0)[0]["rail"]
    assert not rail[x < -20.0].any() and rail[x > -10.0].any()


def test_arrows_are_as_long_as_the_forces_of_the_axles(run):
    drawn, words = sketch(run, 60.0)
    x, y = drawn["forces"]
    sample = round(60.0 / 20.0 / run.settings.time_step)
    force = -run.wheel_forces[:, 1, sample].reshape(-1, 2).sum(axis=1)
    assert np.allclose(x[::3], [60.0 - axle.delay for axle in run.train.placed_axles])
    length = y[::3] - y[1::3]
    assert np.allclose(length / length[0], force / force[0])
    assert np.ptp(force) > 0.1 * force.mean()
    scale = float(re.search(r"this long: (\S+) kN", words)[1])
    (low, high) = sorted(drawn["scale of the forces"][1])
    assert force[0] / length[0] == pytest.approx(1e3 * scale / (high - low))
    rest = drawn["forces at rest"][1]
    assert np.allclose((y[0] - rest[0]) / length[0], 146.44e3 / force[0], rtol=1e-3)


def test_the_scales_of_the_sketch_stay_while_there_is_room(run, case):
    _, words = sketch(run, 60.0, exaggeration=50.0, force=500e3)
    assert "drawn 50 times" in words and "this long: 500 kN" in words
    deep = case.replace({"track.vertical.amplitude": 10e-3}).compute()
    assert "drawn 100 times" in sketch(deep, 60.0)[1]
    assert "drawn 200 times" in sketch(deep, 60.0, exaggeration=200.0)[1]
    deep = case.replace({"track.vertical.amplitude": 30e-3}).compute()
    _, words = sketch(deep, 60.0, exaggeration=200.0, force=1e3)
    assert "drawn 50 times" in words and "this long: 250 kN" in words


TRACK = rb.Track(
    vertical=rb.Rails(rb.Harmonic(5e-3, 14.4), rb.Harmonic(3e-3, 9.0)),
    lateral=rb.Harmonic(2e-3, 7.0),
)
RAILS = {
    "vertical, left rail": ("vertical", "left"),
    "vertical, right rail": ("vertical", "right"),
    "lateral": ("lateral", "left"),
}


def test_rails_and_their_slopes_stand_under_their_names():
    for figure, part, label in (
        (plots.irregularity, "value", "irregularity r (mm)"),
        (plots.slope, "slope", "slope dr/dx (mm/m)"),
    ):
        ax = figure(TRACK, -60.0, 40.0, lead_in=50.0)
        assert ax.get_ylabel() == label
        for name, (direction, side) in RAILS.items():
            x, shown = labelled(ax, name).get_data()
            faded = rb.tracks.FadeIn(TRACK.rail(direction, side), 50.0)
            assert np.allclose(shown, 1e3 * getattr(faded, part)(x)), name
            assert not shown[x < -50.0].any() and shown.any()


def test_a_track_that_is_level_sideways_has_no_lateral_curve():
    shown = [line.get_label() for line in plots.irregularity(rb.Track(TRACK.vertical)).lines]
    assert shown and not any("lateral" in label for label in shown)
    for curves in (plots.irregularity(rb.Track()), plots.irregularity(TRACK)):
        assert any("vertical" in line.get_label() for line in curves.lines)
    assert any("lateral" in line.get_label() for line in plots.irregularity(TRACK).lines)


def test_each_wheel_path_has_dashes_of_its_own(run):
    wheels = [(1, 1), (1, 5), (2, 1)]
    ax = plots.wheel_paths(run.train, TRACK, 20.0, wheels)
    assert len({line.get_linestyle() for line in ax.lines}) == len(wheels)


def test_wheels_stand_behind_the_first_axle_and_meet_the_wave_later(run):
    train = run.train
    x, r = labelled(plots.wheels_on_track(train, TRACK, 18.0), "wheels of the train").get_data()
    left = [wheel.delay for wheel in train.wheels if wheel.side == "left"]
    assert np.allclose(x, 18.0 - np.array(left))
    assert np.allclose(r, 1e3 * TRACK.rail("vertical", "left").value(x))
    ax = plots.wheel_paths(train, TRACK, 20.0, [(1, 1), (1, 6)])
    for number, side in ((1, "left"), (6, "right")):
        t, r = labelled(ax, f"car 1, wheel {number}").get_data()
        met = 20.0 * t - train.wheels[number - 1].delay
        assert np.allclose(r, 1e3 * TRACK.rail("vertical", side).value(met))


def test_a_force_at_rest_and_the_time_on_the_deck_are_marked(run):
    wheel = run.train.car(2).wheels[2]
    ax = plots.wheel_force(run, 2, 3)
    assert np.allclose(labelled(ax, "at rest").get_ydata(), -1e-3 * wheel.static_load)
    for shaded, axles in (
        (ax, run.train.car(2).axles),
        (plots.displacement(run, 18.0), run.train.placed_axles),
    ):
        box = next(patch for patch in shaded.patches if patch.get_gid() == "on deck")
        start, stop = axles[0].delay / 20.0, (axles[-1].delay + 36.0) / 20.0
        assert [box.get_x(), box.get_x() + box.get_width()] == pytest.approx([start, stop])


def test_bodies_are_named_with_their_mass():
    axes = np.ravel(np.asarray(plots.vehicle(rb.vehicle("xia2000")), dtype=object))
    shown = {text.get_text() for ax in axes for text in ax.texts}
    assert "car\n50.99 t" in shown, shown


def test_a_mode_is_drawn_in_its_directions_and_called_by_its_numbers(run):
    deck = run.deck
    for mode, name in enumerate(deck.mode_names[:6], start=1):
        ax = plots.deck_mode(deck, mode)
        f, ratio = deck.frequencies_hz[mode - 1], 100 * deck.damping_ratios[mode - 1]
        title = f"mode {mode}: {name}, {f:.4g} Hz, damping {ratio:.1f} %"
        assert ax.get_title(loc="left") == title
        way = {"l": "lateral", "v": "vertical", "t": "twist, at the edge"}[name[0]]
        shown = [line.get_label() for line in ax.lines if line.get_label()[0] != "_"]
        assert shown == [way], name


@pytest.mark.parametrize(
    ("width", "lever", "word"), [(9.6, 4.8, "twist, at the edge"), (None, 1.0, "twist")]
)
def test_twist_is_drawn_as_the_rise_of_the_edge(width, lever, word):
    """On soft bearings held sideways below the axis every lateral mode twists, too."""
    pads = [
        rb.Bearing(x, ("y",) if y > 0.0 else (), y, -3.0, {"z": 5e8})
        for x in (0.0, 36.0)
        for y in (2.0, -2.0)
    ]
    beam = rb.Beam("b", (36.0,), 12e3, 9e10, 9e11, 8e10, polar_inertia=7e4, bearings=pads)
    deck = beam.deck(8, 0.02, width=width)
    v, _, twist = np.abs(deck.shapes(np.linspace(0.0, 36.0, 301))).max(axis=0).T
    mode = int(np.argmax(np.minimum(v, lever * twist)))
    ax = plots.deck_mode(deck, mode + 1)
    drawn = {name: np.abs(labelled(ax, name).get_ydata()).max() for name in ("lateral", word)}
    assert drawn[word] / drawn["lateral"] == pytest.approx(lever * twist[mode] / v[mode])
    assert max(drawn.values()) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("quantity", "load", "factor", "unit"),
    [
        ("displacement_z", 1, 1e9, "mm per MN"),
        ("displacement_y", 0, 1e9, "mm per MN"),
        ("rotation_x", 2, 1e9, "mrad per MN m"),
        ("rotation_y", 1, 1e9, "mrad per MN"),
        ("rotation_z", 0, 1e9, "mrad per MN"),
        ("moment_vertical", 1, 1.0, "m"),
        ("moment_lateral", 0, 1.0, "m"),
        ("shear_vertical", 1, 1.0, "-"),
        ("torsion", 2, 1.0, "-"),
    ],
)
def test_an_influence_line_is_that_of_the_load_named_below_it(run, quantity, load, factor, unit):
    ax = plots.influence_line(run.deck, quantity, 12.0)
    x, shown = next(line for line in ax.lines if line.get_gid() == "line").get_data()
    known = run.deck.recovery.section(quantity, 12.0).influence(x)[:, 0, load]
    assert np.allclose(shown, factor * known) and np.abs(shown).max() > 0.0
    way = ("lateral", "upward", "roll")[load]
    assert ax.get_ylabel().replace("\n", " ") == f"per unit {way} load ({unit})"
    assert QUANTITY_STYLES[quantity].words in next(
        line.get_label() for line in ax.lines if line.get_gid() == "line"
    )


def test_deviations_are_drawn_under_their_own_names(run):
    known = run.deviations
    assert not np.allclose(known.from_rigid[1:], known.from_previous[1:])
    for runs, before in ((run, ""), ({"condensed": run}, "condensed, ")):
        ax = plots.deviations(runs)
        assert np.allclose(labelled(ax, f"{before}from rigid").get_ydata(), known.from_rigid)
        assert np.allclose(labelled(ax, f"{before}from previous").get_ydata(), known.from_previous)
        assert labelled(ax, f"{before}from rigid").get_xdata().tolist() == [1, 2, 3, 4]


def test_a_run_that_settles_is_drawn_with_its_tolerance(case):
    run = case.replace({"run.iterations": None, "run.tolerance": 1e-3}).run()
    ax = plots.convergence(run)
    x, shown = labelled(ax, "tolerance 0.001").get_data()
    assert list(shown) == [1e-3, 1e-3] and x[0] < 1.0 and x[-1] > len(run.changes)
    assert ax.get_yscale() == "log"
    rigid = case.replace({"run.interaction": "rigid"}).run()
    with pytest.raises(rb.InputError, match=r"^run: has no iterations: .*interaction='iterate'"):
        plots.convergence(rigid)


def test_ways_of_loading_stand_under_their_names(run, case):
    runs = {"condensed": run, "wheels": case.replace({"run.loads": "wheels"}).run(), "own": run}
    for quantity, call in (
        ("moment_vertical", "section_forces"), ("acceleration_z", "acceleration"),
        ("displacement_z", "displacement"), ("rotation_x", "displacement"),
        ("rotation_y", "rotations"),
    ):  # fmt: skip
        ax = plots.load_modes(runs, 12.0, quantity)
        assert ax.get_title(loc="left") == "x = 12 m"
        factor = QUANTITY_STYLES[quantity].factor
        for name, one in runs.items():
            known = factor * getattr(one, call)(12.0)[quantity]
            assert np.allclose(labelled(ax, name).get_ydata(), known)


def test_the_rigid_deck_s_spectrum_stands_behind_every_iteration(run):
    rigid = run.at(0).spectrum
    for i, ax in enumerate(plots.spectra(run)):
        behind = [line for line in ax.lines if line.get_gid() == "rigid"]
        assert len(behind) == (i > 0)
        for line in behind:
            assert np.allclose(line.get_ydata(), 1e-3 * rigid.amplitude)
        own = next(line for line in ax.lines if line.get_gid().endswith("heads"))
        assert np.allclose(own.get_ydata(), 1e-3 * run.at(i).spectrum.amplitude)


def test_a_spectrum_s_marks_say_their_names_and_places(run):
    ax = plots.spectrum(run, mark={"second bending": 13.23})
    assert labelled(ax, "second bending 13.23 Hz").get_xdata().tolist() == [13.23, 13.23]
    assert ax.get_xlim()[0] == ax.get_ylim()[0] == 0.0


def test_a_way_in_which_the_deck_is_rigid_is_said(run):
    deck = rb.Beam("vertical only", (36.0,), 12e3, 9e10).deck(4, 0.02)
    stiff = rb.cross(run.train, deck, speed=20.0, time_step=8e-3, interaction="rigid")
    ax = plots.displacement(stiff, 18.0, component="y")
    assert [text.get_text() for text in ax.texts] == ["the deck has no stiffness given this way"]
    assert not plots.displacement(stiff, 18.0).texts
    with pytest.raises(rb.InputError, match="the deck has no such stiffness or bearing there"):
        plots.influence_line(deck, "torsion", 9.0)


@pytest.mark.parametrize(
    ("quantity", "load", "way"),
    [("force_z", 1, "upward"), ("force_y", 0, "lateral"), ("moment_x", 2, "roll")],
)
def test_an_influence_line_of_a_bearing_says_which(run, quantity, load, way):
    ax = plots.influence_line(run.deck, quantity, 36.0)
    line = next(line for line in ax.lines if line.get_gid() == "line")
    x, shown = line.get_data()
    assert x[0] == 0.0 and x[-1] == 36.0
    known = run.deck.recovery.reaction(quantity, 36.0).influence(x)[:, 0, load]
    assert np.allclose(shown, known) and shown[-1] == pytest.approx(-1.0)
    assert ax.get_ylabel().replace("\n", " ") == f"per unit {way} load (-)"
    assert line.get_label() == f"{QUANTITY_STYLES[f'reaction_{quantity[-1]}'].words} at x = 36 m"


def test_a_notch_is_drawn_where_the_wheel_is():
    notch = rb.Notch(((1, 1),), 2.7, 1.0, 1e-3, 0.05)
    (line,) = plots.notch(notch, -1.0, 10.0).lines
    x, shown = line.get_data()
    assert (x[0], x[-1]) == (-1.0, 10.0) and np.allclose(shown, 1e3 * notch.value(x))
    # A sag of 1 mm at every turn of the wheel, and none is missed between two points.
    assert shown.min() == pytest.approx(-1.0, abs=1e-3) and np.diff(x).max() <= 0.05 / 8


def test_only_wheels_within_a_picture_are_marked_in_it(run):
    ax = plots.irregularity(TRACK, -5.0, 10.0)
    plots.wheels_on_track(run.train, TRACK, 18.0, ax=ax)
    left = np.array([18.0 - wheel.delay for wheel in run.train.wheels if wheel.side == "left"])
    expected = left[(left >= -5.0) & (left <= 10.0)]
    assert 0 < len(expected) < len(left)
    assert labelled(ax, "wheels of the train").get_xdata() == pytest.approx(expected)


def test_natural_frequencies_are_ticks_with_names_up_to_where_they_end(run):
    deck = run.deck
    ax = plots.frequencies(deck, {"axles": 8.0}, most=20.0)
    ticks = next(line for line in ax.lines if line.get_gid() == "natural").get_xdata()
    below = deck.frequencies_hz[deck.frequencies_hz <= 20.0]
    assert np.array_equal(ticks[::3], below)
    assert [text.get_text().strip() for text in ax.texts] == list(deck.mode_names[: len(below)])
    assert [text.get_position()[0] for text in ax.texts] == pytest.approx(below)
    assert labelled(ax, "axles 8 Hz").get_xdata().tolist() == [8.0, 8.0]
    assert ax.get_xlim()[0] < below[0] and ax.get_xlim()[1] == 20.0
    words = [t.get_text().split(" \n") for t in plots.frequencies(run.train.vehicles[0]).texts]
    assert words[:3] == [["car sway "], ["car yaw", "car roll "], ["car bounce "]]
    far = plots.frequencies(deck, {"far": 500.0})
    assert far.get_xlim()[1] > 500.0, "a mark beyond the last frequency is still seen"


def test_marked_frequencies_of_damping_are_points_with_names():
    alpha, beta, marks = 1.0364, 4.87e-4, {"second": 13.23, "beside": 13.5, "far": 90.0}
    ax = plots.damping(alpha, beta, marks)
    x, shown = next(line for line in ax.lines if line.get_gid() == "points").get_data()
    assert x == pytest.approx(list(marks.values()))
    assert shown == pytest.approx(100 * (alpha / (4 * np.pi * x) + beta * np.pi * x))
    assert {t.get_text().strip(): t.get_position()[0] for t in ax.texts} == {
        f"{name}, {f:g} Hz": f for name, f in marks.items()
    }
    assert ax.get_xlim()[0] < 0.5 and ax.get_xlim()[1] > 90.0 and ax.get_ylim()[1] > max(shown)


def test_dimensions_and_masses_of_a_car_are_its_own():
    side, above, front = (
        [text.get_text() for text in ax.texts if text.get_text()]
        for ax in plots.vehicle(rb.vehicle("xia2000"))
    )
    assert side == ["car\n50.99 t", "2.5 m", "13.1 m", "2.5 m", "length 22.5 m"]
    assert above == ["front bogie\n4.36 t", "rear bogie\n4.36 t"] and front == ["1.96 m"]


def test_what_moves_is_said_in_words():
    car = rb.vehicle("xia2000")
    modes = car.modes()
    words = "Car sways (56 %) and rolls (43 %) - shares of the kinetic energy."
    assert plots.sketches.what_moves(car, modes, 1) == words
    # A pair of equal frequency is any mixture: one is taken in which the front bogie rests.
    front = modes.labels.index("front bogie pitch")
    a, b = modes.shapes[:, 7], modes.shapes[:, 8]
    shapes = modes.shapes.copy()
    shapes[:, 7] = (b[front] * a - a[front] * b) / np.hypot(a[front], b[front])
    words = "Rear bogie pitches (100 %) - shares of the kinetic energy. Same frequency as mode 9: "
    words += "any mix of them is a mode as well."
    assert plots.sketches.what_moves(car, replace(modes, shapes=shapes), 8) == words


def test_a_train_at_rest_stands_where_it_is_said_to(run):
    """With bare axles their loads stand above them."""
    for train, place in ((run.train, 40.0), (rb.AxleTrain([0.0, 3.0], [1e5, 2e5]), None)):
        ax = plots.train_on_deck(train, run.deck, position=place)
        drawn = {line.get_gid(): line.get_xdata() for line in ax.lines}
        stand = sorted((place or 0.0) - axle.delay for axle in train.placed_axles)
        assert sorted(drawn["wheels"]) == pytest.approx(stand)
        assert list(drawn["bearings"]) == [0.0, 36.0] and list(drawn["deck"]) == [0.0, 36.0]
        assert ("loads" in drawn) == (place is None)
        if place is None:
            assert sorted(drawn["loads"][::3]) == pytest.approx(stand)
        low, high = ax.get_xlim()
        assert low < min(stand) and high > max(36.0, *stand)
        assert [text.get_text() for text in ax.texts] == ["viaduct36, 36 m"]


def test_a_box_is_drawn_with_its_own_dimensions_and_left_is_left():
    own = replace(box(), root_thickness=0.31, edge_thickness=0.18, bottom_spacing=4.4)
    ax = plots.box_section(own, box().section)
    shown = [text.get_text() for text in ax.texts if text.get_text()]
    assert shown == [
        "left track\ny = 2.4 m", "right track\ny = -2.4 m", "9.60 m", "5.00 m", "4.40 m", "2.00 m",
        "0.18", "0.31", "0.25", "0.20", "0.35",
    ]  # fmt: skip
    left, right = ax.get_xlim()
    assert left > 4.8 and right < -4.8, "seen along the track: the left track stands on the left"
    drawn = {line.get_gid(): line.get_xydata() for line in ax.lines}
    assert drawn["centroid"][0] == pytest.approx(box().section.centroid)
    assert drawn["shear centre"][0] == pytest.approx(box().section.shear_centre)
    for side, y in (("left", 2.4), ("right", -2.4)):
        assert drawn[f"rails {side}"][:, 0].mean() == pytest.approx(y)
        assert np.ptp(drawn[f"rails {side}"][:, 0]) == pytest.approx(1.435)


def test_a_mode_of_plates_says_which_and_how_both_sides_move():
    shell, _ = shell_and_modes()
    modes = shell.modes(10)
    for number, name in enumerate(modes.names, start=1):
        title = f"{number}: {name}, {modes.frequencies_hz[number - 1]:.2f} Hz"
        if name.startswith("local"):
            alike = "alike" if modes.symmetric[number - 1] else "opposite"
            title += f", {modes.parts[number - 1]}, left and right {alike}"
        if number in (1, 8, 10):
            assert plots.shell_mode(shell, modes, number).get_title(loc="left") == title
    assert modes.symmetric[7] != modes.symmetric[9]
    ax = plots.shell_mode(shell, modes, 1, scale=0.5)
    assert ax.get_xlabel() == "length 36.6 (m), motion drawn up to 0.5 (m)"
    for wrong in ({"mode": 11}, {"mode": 1, "scale": 0.0}):
        with pytest.raises(rb.InputError, match=f"^{list(wrong)[-1]} = "):
            plots.shell_mode(shell, modes, **wrong)


def test_likeness_stands_in_the_row_and_column_of_its_modes():
    criterion = [[0.98, 0.04, 0.06], [0.02, 0.75, 0.5]]
    ax = plots.assurance(criterion, ("a", "b"), ("d", "e", "f"), what=("box", "bar"))
    shown = {text.get_position(): text.get_text() for text in ax.texts}
    assert shown == {(0, 0): "0.98", (2, 0): "0.06", (1, 1): "0.75", (2, 1): "0.50"}
    assert [label.get_text() for label in ax.get_xticklabels()] == ["d", "e", "f"]
    assert [label.get_text() for label in ax.get_yticklabels()] == ["a", "b"]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("mode of the bar (-)", "mode of the box")
    with pytest.raises(
        rb.InputError, match=r"^criterion = \(2, 3\): must have a row and a column "
    ):
        plots.assurance(criterion, ("a", "b", "c"), ("d", "e", "f"))


def test_iterations_are_drawn_under_their_own_numbers(run):
    upper, lower = plots.iterations(run, "displacement_z", (0, 1, 4), x=18.0)
    values = {i: 1e3 * run.at(i).displacement(18.0)["displacement_z"] for i in (0, 1, 4)}
    assert np.allclose(labelled(upper, "rigid deck (0)").get_ydata(), values[0])
    assert np.allclose(labelled(upper, "iteration 1").get_ydata(), values[1])
    assert np.allclose(labelled(upper, "iteration 4").get_ydata(), values[4])
    differences = [line for line in lower.lines if (line.get_gid() or "").startswith("rank")]
    assert [np.abs(line.get_ydata()).max() for line in differences] == pytest.approx(
        [np.abs(values[i] - values[4]).max() for i in (0, 1)]
    )
    assert lower.get_ylabel() == "minus iteration 4\n(mm)"


def test_no_two_quantities_look_alike():
    lines = [
        (v.colour, v.line)
        for k, v in QUANTITY_STYLES.items()
        if k not in ("slope_vertical", "slope_lateral", "damping")
    ]
    assert len(set(lines)) == len(lines)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda run: plots.vehicle_mode(run.train.vehicles[0], 16), "mode = 16"),
        (lambda run: plots.deck_mode(run.deck, 0), "mode = 0"),
        (
            lambda run: plots.deck_modes(run.deck, [99]),
            r"modes = \[99\]: must name some of 1 to",
        ),
        (
            lambda run: plots.spectra(run, [7, 8]),
            r"iterations = \[7, 8\]: must name some of 0 to 4",
        ),
        (lambda run: plots.wheel_force(run, 1, 9), r"wheel = \(1, 9\)"),
        (lambda run: plots.car_forces(run, 3), "car = 3"),
        (lambda run: plots.wheel_forces(run, 3), "car = 3"),
        (lambda run: plots.section_force(run, 18.0, "moment_verticle"), "moment_verticle"),
        (lambda run: plots.influence_line(run.deck, "moment_vertcal", 18.0), "moment_vertical"),
        (lambda run: plots.iterations(run, which=(9,)), "which"),
        (lambda run: plots.load_modes({"a": run}, 18.0, "displacment_z"), "displacement_z"),
        (lambda run: plots.wheel_paths(run.train, run.track, 20.0, [(9, 1)]), "wheels"),
    ],
)
def test_wrong_questions_are_refused(run, call, message):
    with pytest.raises(rb.InputError, match=message):
        call(run)


def test_a_figure_that_reuses_its_artists_moves_its_curves(run):
    ax = plots.displacement(run, 18.0)
    reuse_artists(ax.figure)
    count = len(ax.get_children())
    before = ax.lines[0].get_ydata().copy()
    plots.displacement(run.at(0), 18.0, ax=ax)
    assert len(ax.get_children()) == count
    assert not np.array_equal(before, ax.lines[0].get_ydata())


def test_own_drawings_of_a_notebook_take_the_colours_of_the_suite():
    with mpl.style.context(plots.STYLE):
        ax = mpl.figure.Figure().add_subplot()
        for i, colour in enumerate(RUN_COLOURS):
            assert ax.plot([0, 1], [0, i])[0].get_color() == colour
        assert not ax.spines["top"].get_visible()


def test_other_shades_can_be_told_from_the_first():
    for colour in {v.colour for v in QUANTITY_STYLES.values()}:
        first, other = (np.array(mpl.colors.to_rgb(c)) for c in (colour, other_shade(colour)))
        assert np.abs(first - other).max() > 0.25, colour
        assert (
            np.array_equal(np.argsort(first)[[0, -1]], np.argsort(other)[[0, -1]])
            or len(set(first)) == 1
        ), colour


NAMES = ["$$", "$x^$", "a $\\frac$ b", "1 $", "\\$", "plain"]


@pytest.mark.parametrize("name", NAMES)
def test_names_from_files_are_drawn_as_they_are(name, run):
    """A dollar sign begins no formula: `$x^$` is none, and stopped the picture."""
    usual = rb.vehicle("sprung_mass")
    body, spring = replace(usual.bodies[0], name=name), replace(usual.springs[0], from_=name)
    car = rb.Vehicle(name, (body,), (spring,), 10.0)
    deck = replace(run.deck, name=name, mode_names=(name,) * len(run.deck.mode_names))
    box = rb.Box(name, (36.0,), 9.6, 0.25, 2.0, 0.35, 5.0, 0.2, 34e9, tracks={name: 2.4})
    drawn = [
        plots.vehicle(car)[0], plots.vehicle_mode(car, 1)[0], plots.deck_mode(deck, 1),
        plots.deck_modes(deck)[0], plots.frequencies(car), plots.frequencies(deck),
        plots.train_on_deck(run.train, deck), plots.box_section(box, box.section),
    ]  # fmt: skip
    for ax in drawn:
        ax.figure.canvas.draw()
        texts = [t.get_text() for t in ax.figure.findobj(mpl.text.Text)]
        if name == "$$":
            assert any(name.replace("$", r"\$") in text for text in texts)


def test_public_functions_take_axes():
    for name in FIGURES:
        assert {"ax", "axes"} & set(inspect.signature(getattr(plots, name)).parameters), name


def test_the_change_is_named_after_what_the_tolerance_is_of():
    case = rb.case("paper").replace({"train.cars": 1, "run.loads": "wheels"})
    forces = case.compute()
    motion = case.replace({"run.tolerance_of": "displacement", "run.tolerance": 1e-4}).compute()
    labels = [
        rb.plots.convergence(runs).get_ylabel().replace("\n", " ")
        for runs in (forces, motion, {"forces": forces, "motion": motion})
    ]
    assert labels == [
        "change of the wheel forces (-)", "change of the deck's motion (-)", "change (-)",
    ]  # fmt: skip
    plt.close("all")


def test_a_crossing_with_a_rail_is_drawn_at_the_place_that_is_asked_for():
    rail = rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
    run = rb.cross(rb.AxleTrain([0.0], [2e5]), rb.deck("viaduct36", rail=rail), speed=20.0)
    k = np.argmin(np.abs(20.0 * run.time - 9.0))
    along = np.linspace(0.0, 36.0, 49)
    moved = run.deck.shapes(along)[:, :, 1] @ run.state.q[:, k]
    ax = crossing_at(run, 9.0, plt.figure().add_subplot(), exaggeration=100.0)
    (line,) = [line for line in ax.lines if line.get_gid() == "deck"]
    drawn = line.get_ydata() - line.get_ydata()[0]
    assert drawn / np.abs(drawn).max() == pytest.approx(moved / np.abs(moved).max(), abs=1e-6)
