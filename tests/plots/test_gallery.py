"""All pictures of a run: which there are, what is in them, and that files come out alike."""

import io
import sys
from dataclasses import replace

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

import railbridge as rb
from railbridge.plots import gallery
from railbridge.plots.drawing import FIGURE_WIDTH
from railbridge.results import ENVELOPE

DECK = rb.deck("viaduct36")
CASE = rb.case("paper").replace({"train.cars": 2, "run.time_step": 4e-3, "run.iterations": 2})
POINTS = (9.0, 18.5)


@pytest.fixture(scope="module")
def run():
    return CASE.compute()


@pytest.fixture(scope="module")
def bare():
    return rb.cross(rb.AxleTrain([0.0, 3.0], [1e5, 2e5]), DECK, speed=40.0, time_step=4e-3)


def pieces(run, points=POINTS, cars=(1,), kinds=tuple(gallery.KINDS)):
    return {piece.name: piece for piece in gallery.figures_of(run, points, cars, kinds)}


def curves(figure):
    """Per axes its label along y and its curves by name."""
    return {
        ax.get_ylabel().replace("\n", " "): {line.get_gid(): line.get_xydata() for line in ax.lines}
        for ax in figure.axes
    }


def test_names_are_known_before_anything_is_computed(run):
    names = gallery.file_names(POINTS, (1, 2))
    assert list(pieces(run, cars=(1, 2))) == names
    assert names == [
        "train", "displacement_at_9m", "displacement_at_18.5m", "acceleration_at_9m",
        "acceleration_at_18.5m", "section_forces_at_9m", "section_forces_at_18.5m", "envelope",
        "reactions", "wheels_1", "wheels_2", "cars_1", "cars_2", "spectrum", "iterations",
        "convergence",
    ]  # fmt: skip
    some = ("wheels", "train", "wheels")
    assert gallery.file_names(POINTS, (2,), some) == ["train", "wheels_2"]
    assert [piece.kind for piece in pieces(run, cars=(2,), kinds=some).values()] == [
        "train", "wheels",
    ]  # fmt: skip


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", gallery.file_names(POINTS))
def test_every_picture_is_drawn_and_belongs_to_nobody(run, name):
    before = dict(mpl.rcParams)
    piece = pieces(run)[name]
    figure = piece.draw()
    file = io.BytesIO()
    gallery.write(figure, file, dpi=50, title=piece.about)
    image = Image.open(file)
    assert image.format == "PNG" and image.width == 50 * FIGURE_WIDTH
    assert image.info["Title"] == piece.about and "Software" not in image.info
    assert plt.get_fignums() == [] and dict(mpl.rcParams) == before
    # Something is drawn, nothing crowds it out, and what is at the edge is whole.
    for ax in figure.axes:
        assert ax.lines and ax.get_position().height > 0.05
        box = ax.get_tightbbox()
        assert box.x0 > -1.0 and box.x1 < figure.bbox.x1 + 1.0
        assert box.y0 > -1.0 and box.y1 < figure.bbox.y1 + 1.0


def test_what_is_drawn_is_what_the_run_says(run):
    drawn = curves(pieces(run)["displacement_at_18.5m"].draw())
    assert list(drawn) == [
        "vertical displacement (mm)", "lateral displacement (mm)", "twist (mrad)",
    ]  # fmt: skip
    history = run.displacement(18.5)
    for (label, lines), name in zip(drawn.items(), history.values, strict=False):
        name = {"v": "displacement_z", "l": "displacement_y", "t": "rotation_x"}[label[0]]
        (line,) = lines.values()
        assert np.allclose(line[:, 1], 1e3 * history[name])
    forces = curves(pieces(run)["section_forces_at_9m"].draw())
    (line,) = forces["vertical shear (kN)"].values()
    assert np.allclose(line[:, 1], 1e-3 * run.section_forces(9.0)["shear_vertical"])
    assert len(forces) == len(run.section_forces(9.0).values) >= 5
    assert len(pieces(run)["envelope"].draw().axes) == len(ENVELOPE)
    upper, lower = pieces(run)["iterations"].draw().axes
    assert np.allclose(
        upper.lines[0].get_ydata(), 1e3 * run.at(0).displacement(9.0)["displacement_z"]
    )
    titles = [ax.get_title(loc="left") for ax in pieces(run)["spectrum"].draw().axes]
    assert [title[:5] for title in titles] == ["i = 0", "i = 1", "i = 2"]


def test_wheel_forces_stand_vertical_beside_lateral_and_reactions_vertical_first(run):
    wheels = pieces(run, cars=(2,))["wheels_2"].draw()
    assert len(wheels.axes) == 8
    words = [ax.get_ylabel().split()[0] for ax in wheels.axes]
    assert words == ["vertical", "lateral"] * 4
    assert np.allclose(wheels.axes[3].lines[0].get_ydata(), 1e-3 * run.wheel_force(2, 3)["force_y"])
    labels = [label.split()[0] for label in curves(pieces(run)["reactions"].draw())]
    assert labels == ["vertical", "lateral", "reaction"]


def test_what_a_run_does_not_have_is_left_out_with_a_reason(run, bare):
    assert gallery.absent(run) == {}
    assert set(gallery.absent(bare)) == {"wheels", "cars", "spectrum", "iterations", "convergence"}
    assert "bodies" in gallery.absent(bare)["cars"]
    assert gallery.absent(bare, ("cars", "train")).keys() == {"cars"}
    assert {p.kind for p in pieces(bare).values()} == set(gallery.KINDS) - set(gallery.absent(bare))
    modes = replace(DECK, recovery=None, supports=())
    train = rb.Train(rb.vehicle("xia2000_planar"))
    options = {"speed": 40.0, "time_step": 4e-3, "interaction": "direct", "loads": "wheels"}
    found = rb.cross(train, modes, rb.Track(vertical=rb.Harmonic(1e-3, 10.0)), **options)
    assert gallery.absent(found) == {
        "section_forces": modes.recovery.lacks, "reactions": modes.recovery.lacks,
        "iterations": "nothing was iterated", "convergence": "nothing was iterated",
    }  # fmt: skip
    drawn = pieces(found, (18.0,))
    assert list(drawn) == [
        "train", "displacement_at_18m", "acceleration_at_18m", "envelope", "wheels_1", "cars_1",
        "spectrum",
    ]  # fmt: skip
    (ax,) = drawn["spectrum"].draw().axes
    assert ax.get_ylabel() == "amplitude (kN)"
    assert len(drawn["cars_1"].draw().axes) == 1


def test_a_direction_in_which_nothing_happens_has_no_axes(bare):
    drawn = pieces(bare, (0.0, 18.0))
    assert list(curves(drawn["displacement_at_18m"].draw())) == ["vertical displacement (mm)"]
    assert list(curves(drawn["section_forces_at_18m"].draw())) == [
        "vertical bending moment (kN m)", "vertical shear (kN)",
    ]  # fmt: skip
    assert list(curves(drawn["section_forces_at_0m"].draw())) == ["vertical shear (kN)"]
    assert list(curves(drawn["reactions"].draw())) == ["vertical reaction (kN)"]
    # On a bearing nothing moves at all: a straight line, not round-off.
    (ax,) = drawn["displacement_at_0m"].draw().axes
    assert ax.get_ylim() == (-1.0, 1.0) and np.abs(ax.lines[0].get_ydata()).max() < 1e-9
    (ax,) = drawn["train"].draw().axes  # a level track is not drawn


def test_every_coach_of_an_articulated_car_has_its_axes():
    coaches = [
        rb.Body(f"${i}", 2e4, (0, 2e5, 0), (8.0 - 8.0 * i, 0, 1), ("z", "pitch")) for i in range(2)
    ]
    springs = [
        rb.Spring(c.name, "rail", (c.position[0] + x, 0.0, 0.0), (0.0, 1e6), (0.0, 2e4))
        for c in coaches
        for x in (3.0, -3.0)
    ]
    long = rb.Vehicle("long", tuple(coaches), tuple(springs), 24.0)
    track = rb.Track(vertical=rb.Harmonic(1e-3, 10.0))
    found = rb.cross(rb.Train(long), DECK, track, speed=40.0, time_step=4e-3, interaction="rigid")
    figure = pieces(found)["cars_1"].draw()
    gallery.write(figure, io.BytesIO(), dpi=30)
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert titles == [r"\$0 of car 1", r"\$1 of car 1"]
    middle = [line for line in figure.axes[1].lines if line.get_gid() == "middle"]
    assert np.array_equal(middle[0].get_ydata(), found.body_accelerations[0, 4, 1])


@pytest.mark.parametrize("form", gallery.FORMATS)
def test_the_same_run_gives_the_same_file_whatever_the_user_has_set(run, form, monkeypatch):
    piece = pieces(run)["convergence"]

    def written():
        file = io.BytesIO()
        gallery.write(piece.draw(), file, form, title=piece.about)
        return file.getvalue()

    first = written()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1000000000")
    with mpl.rc_context({"font.size": 30.0, "lines.linewidth": 9.0, "svg.hashsalt": "mine"}):
        assert written() == first
        assert mpl.rcParams["font.size"] == 30.0
    assert b"2001" not in first and b"CreationDate" not in first and b"dc:date" not in first


def test_pyplot_is_not_needed(run, monkeypatch):
    """A window system that is not there stops nothing."""
    piece = pieces(run)["train"]
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    gallery.write(piece.draw(), io.BytesIO(), dpi=30)


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        ({"kinds": ("displacment",)}, "Did you mean 'displacement'"),
        ({"points": (40.0,)}, r"points\[1\] = 40"),
        ({"cars": (3,)}, "car = 3"),
        ({"cars": (0,)}, "car = 0"),
    ],
)
def test_wrong_questions_are_refused(run, asked, why):
    with pytest.raises(rb.InputError, match=why):
        pieces(run, **asked)


def test_an_unknown_format_is_refused(run):
    with pytest.raises(rb.InputError, match="form = 'jpg'"):
        gallery.write(pieces(run)["convergence"].draw(), io.BytesIO(), "jpg")
