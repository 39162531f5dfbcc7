"""The largest response over the speed, a line a train."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import plots

xr = pytest.importorskip("xarray")

SPEEDS = np.array([40.0, 50.0, 60.0, 70.0])
A = np.array([[1.0, 2.0, 1.5, 1.0], [1.0, 1.5, 4.0, 2.0]])


def study(trains=("A1", "A2"), **more):
    values = np.resize(A, (len(trains), 4))
    own = {"units": "m/s2", "long_name": "largest vertical acceleration"}
    sag = {"units": "m", "long_name": "largest vertical displacement"}
    variables = {
        "acceleration_z": (("train", "speed", "x"), np.stack([values, 2 * values], -1), own),
        "displacement_z": (("train", "speed", "x"), np.stack([values, values], -1) / 1e3, sag),
        "displacement_z_static": (("train", "speed", "x"), np.full((*values.shape, 2), 5e-4), sag),
        "signature": (("train", "speed"), 0.9 * values, {"units": "m/s2"}),
        "distance": ("train", np.full(len(trains), 20.0)),
        **more,
    }
    return xr.Dataset(variables, {"train": list(trains), "speed": SPEEDS, "x": [10.0, 20.0]})


def drawn(ax):
    return {line.get_gid(): line for line in ax.lines}


def words(ax):
    return [text.get_text() for text in ax.texts]


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_line_for_each_train_and_the_worst_is_named_with_its_speed():
    ax = plots.envelope(study(), "acceleration_z")
    lines = drawn(ax)
    for i in range(2):
        assert np.allclose(lines[f"train {i + 1}"].get_data(), [SPEEDS, A[i]])
        assert np.allclose(lines[f"signature {i + 1}"].get_ydata(), 0.9 * A[i])
    assert "A2: 4 m/s² at 60 m/s, 216 km/h" in words(ax)
    assert np.allclose(lines["worst"].get_data(), [[60.0], [4.0]])
    assert lines["train 2"].get_linewidth() > lines["train 1"].get_linewidth()
    assert ax.get_ylabel() == "largest vertical acceleration (m/s²)"
    assert ax.get_xlabel() == "speed (m/s)" and ax.get_xlim() == (40.0, 70.0)


def test_the_place_is_chosen_and_units_are_those_of_pictures():
    ax = plots.envelope(study(), "acceleration_z", x=19.0)
    assert np.allclose(drawn(ax)["train 1"].get_ydata(), 2 * A[0])
    lines = drawn(plots.envelope(study(), "displacement_z"))
    assert np.allclose(lines["train 1"].get_ydata(), A[0]), "mm"
    assert np.allclose(lines["static 1"].get_ydata(), 0.5), "mm"
    assert lines["static 1"].get_linestyle() == "--"


def test_a_limit_is_a_line_of_its_own_inside_the_picture():
    ax = plots.envelope(study(), "acceleration_z", limit=6.0, limit_name="EN 1990")
    assert np.allclose(drawn(ax)["limit"].get_ydata(), 6.0)
    assert "EN 1990, 6 m/s²" in legend(ax)
    assert ax.get_ylim()[1] > 6.0


def test_resonances_of_the_worst_train_are_marked_within_the_range():
    span = {"length": 25.0, "mass": 15e3, "damping": {"modal": 0.01}, "modes": 2}
    span["bending_stiffness_vertical"] = 15e3 * (2 * np.pi * 5.0) ** 2 * (25 / np.pi) ** 4
    ax = plots.envelope(study(), "acceleration_z", deck=rb.deck_from_table("bridge", span))
    marks = {name: line for name, line in drawn(ax).items() if name.startswith("resonance")}
    assert [*marks] == ["resonance 2"], "5 Hz x 20 m / 2 = 50 m/s; 100 and 33 are outside"
    assert np.allclose(marks["resonance 2"].get_xdata(), 50.0, rtol=1e-3)
    assert "i = 2" in words(ax)


def test_of_many_trains_only_the_worst_has_its_signature():
    names = [f"A{i}" for i in range(1, 11)]
    ax = plots.envelope(study(names), "acceleration_z")
    lines = drawn(ax)
    assert [n for n in lines if n.startswith("signature")] == ["signature 2"]
    assert "signature of A2" in legend(ax)
    looks = {
        (lines[f"train {i}"].get_color(), lines[f"train {i}"].get_linestyle()) for i in range(1, 11)
    }
    assert len(looks) == 10, "colour and dashes together tell all trains apart"


def test_a_second_axis_shows_km_per_hour():
    ax = plots.envelope(study(), "acceleration_z")
    (second,) = ax.child_axes
    ax.figure.canvas.draw()
    assert second.get_xlabel() == "speed (km/h)" and np.allclose(second.get_xlim(), (144.0, 252.0))


def test_what_is_no_envelope_is_refused():
    with pytest.raises(rb.InputError, match="Did you mean 'acceleration_z'"):
        plots.envelope(study(), "acceleration")
    with pytest.raises(rb.InputError, match="over train, not over train and speed"):
        plots.envelope(study(), "distance")
    empty = {"units": "m"}
    nothing = study(moment=(("train", "speed"), np.full((2, 4), np.nan), empty))
    with pytest.raises(rb.InputError, match="has no numbers"):
        plots.envelope(nothing, "moment")
