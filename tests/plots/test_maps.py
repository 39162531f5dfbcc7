"""A study over two things that vary, as a map."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.contour import ContourSet

import railbridge as rb
from railbridge import plots
from railbridge.plots.drawing import reuse_artists
from railbridge.plots.maps import mark_point
from railbridge.plots.picture import Picture

xr = pytest.importorskip("xarray")

SPEEDS = np.linspace(10.0, 100.0, 10)
WAVES = np.geomspace(3.0, 48.0, 9)
SAG = 1e-4 * SPEEDS[:, None] + 1e-5 * WAVES
ATTRIBUTES = {
    "deck_frequency_hz": 3.3, "car_frequency_hz": 1.3, "filter_zeros": [31.2, 10.4, 2.0],
    "paper_speed": 20.0, "paper_wavelength": 14.4,
}  # fmt: skip


def study():
    along = ("speed", "wavelength")
    variables = {
        "displacement_z": (along, SAG, {"units": "m", "long_name": "largest sag"}),
        "change": (along, 100 * (SAG - SAG.mean()), {"units": "%", "long_name": "change"}),
        "at_places": ((*along, "x"), np.stack([SAG, 2 * SAG], -1), {"units": "m"}),
        "flat": (along, np.full_like(SAG, 2.0), {"units": "-"}),
        "single": ("speed", SPEEDS, {"units": "m"}),
    }
    coordinates = {"speed": ("speed", SPEEDS, {"units": "m/s"}), "x": [10.0, 20.0]}
    coordinates["wavelength"] = ("wavelength", WAVES, {"units": "m"})
    return xr.Dataset(variables, coordinates, ATTRIBUTES)


def drawn(ax):
    return {line.get_gid(): line for line in ax.lines}


def areas(ax):
    return next(a for a in ax.collections if isinstance(a, ContourSet) and a.filled)


def bar(ax):
    return next(a for a in ax.figure.axes if a is not ax)


def test_a_map_has_its_units_and_both_speeds():
    ax = plots.map(study(), "displacement_z")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("speed (m/s)", "wavelength (m)")
    assert bar(ax).get_ylabel() == "largest sag (mm)"
    assert ax.get_xlim() == (10.0, 100.0) and ax.get_ylim() == pytest.approx((3.0, 48.0))
    assert (ax.get_xscale(), ax.get_yscale()) == ("linear", "log")
    levels = areas(ax).levels
    assert 1.0 <= levels[0] < 3.0 and 9.0 < levels[-1] < 12.0, "mm"
    ax.figure.canvas.draw()
    assert np.allclose(ax.child_axes[0].get_xlim(), (36.0, 360.0))


def test_colours_of_changes_are_symmetric_about_zero_and_those_of_sizes_are_not():
    levels = areas(plots.map(study(), "change")).levels
    assert np.allclose(levels, -levels[::-1])
    assert areas(plots.map(study(), "change")).get_cmap().name == "PuOr_r"
    assert areas(plots.map(study(), "displacement_z")).get_cmap().name == "cividis"


def test_lines_of_resonance_are_speed_over_frequency():
    lines = drawn(plots.map(study(), "displacement_z"))
    for name, f in ("deck", 3.3), ("car", 1.3):
        V, wave = lines[f"resonance of the {name}"].get_data()
        assert len(V) > 10 and np.allclose(V, f * wave)
        assert V.min() >= 10.0 and V.max() <= 100.0
    assert "resonance of the deck" not in drawn(plots.map(study(), "change", resonances=False))


def test_given_objects_take_the_place_of_attributes():
    data = study().drop_attrs(deep=False)
    assert not any("resonance" in str(n) for n in drawn(plots.map(data, "change")))
    car, deck = rb.vehicle("xia2000_planar"), rb.deck("viaduct36")
    lines = drawn(plots.map(data, "change", deck=deck, vehicle=car))
    V, wave = lines["resonance of the deck"].get_data()
    assert np.allclose(V / wave, 3.3074, rtol=1e-4)
    V, wave = lines["resonance of the car"].get_data()
    assert np.allclose(V / wave, 1.3345, rtol=1e-3)


def test_the_papers_point_zeros_and_limits_are_marked():
    ax = plots.map(study(), "displacement_z", filter_zeros=True, limits=[5e-3])
    lines = drawn(ax)
    assert np.allclose(lines["paper"].get_data(), [[20.0], [14.4]])
    assert {lines[n].get_ydata()[0] for n in lines if str(n).startswith("zero")} == {31.2, 10.4}
    (limit,) = [a for a in ax.collections if isinstance(a, ContourSet) and not a.filled]
    assert limit.levels.tolist() == [5.0], "mm"
    plain = drawn(plots.map(study(), "displacement_z", paper=False))
    assert "paper" not in plain and not any(str(n).startswith("zero") for n in plain)


def test_axes_can_be_swapped_and_places_chosen():
    ax = plots.map(study(), "at_places", x=20.0, over=("wavelength", "speed"))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("wavelength (m)", "speed (m/s)")
    wave, V = drawn(ax)["resonance of the deck"].get_data()
    assert np.allclose(V, 3.3 * wave)
    assert np.isclose(areas(ax).zmax, 2 * SAG.max()), "the second place"


def test_a_constant_study_is_drawn_and_what_is_no_map_is_refused():
    plots.map(study(), "flat")
    with pytest.raises(rb.InputError, match="is over speed; a map needs two"):
        plots.map(study(), "single")
    with pytest.raises(rb.InputError, match="Did you mean 'displacement_z'"):
        plots.map(study(), "displacement")
    data = study()
    data["nothing"] = data.change * np.nan
    with pytest.raises(rb.InputError, match="has no numbers"):
        plots.map(data, "nothing")


def test_the_picture_of_a_panel_shows_the_colours_and_only_the_dot_moves():
    from io import BytesIO

    from matplotlib.image import imread

    figure = plt.figure(figsize=(6.0, 4.0), layout="constrained")
    ax = figure.add_subplot()
    plots.map(study(), "change", ax)
    mark_point(ax, "now", 30.0, 10.0)
    reuse_artists(figure)
    picture = Picture(figure)
    first = imread(BytesIO(picture.png()))
    mark_point(ax, "now", 70.0, 20.0)
    second = imread(BytesIO(picture.png()))
    # Orange and violet are there, and little of the picture has changed.
    assert ((first[..., 0] > first[..., 2] + 0.3).mean() > 0.05) and (
        (first[..., 2] > first[..., 1] + 0.15).mean() > 0.05
    )
    assert 0.0 < (first != second).any(axis=-1).mean() < 0.02
