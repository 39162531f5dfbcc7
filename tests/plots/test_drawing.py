"""Axes end at round numbers that hide nothing; curves and texts of a reused figure are moved."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure

from railbridge.errors import InputError
from railbridge.plots import drawing
from railbridge.plots.drawing import (
    PLACE_LABEL,
    curve,
    keep_limits,
    label_axes,
    numbers_up_to,
    reuse_artists,
    round_down,
    round_up,
    shade,
    vertical_lines,
)


def reused(scale="linear"):
    ax = Figure(figsize=(9.0, 3.0)).add_subplot()
    ax.set_xscale(scale)
    ax.set_yscale(scale)
    reuse_artists(ax.figure)
    return ax


@pytest.mark.parametrize(
    ("value", "up", "down"),
    [
        (1.0, 1.0, 1.0), (1.01, 1.5, 1.0), (2.0, 2.5, 2.0), (2.6, 4.0, 2.0), (0.041, 0.06, 0.03),
        (6.1, 10.0, 5.0), (99.0, 100.0, 50.0), (3e-7, 4e-7, 3e-7), (1.5e4, 1.5e4, 1e4),
    ],
)  # fmt: skip
def test_round_numbers_above_and_below(value, up, down):
    assert round_up(value) == pytest.approx(up) and round_down(value) == pytest.approx(down)


@pytest.mark.parametrize("low", [-7.3, -0.02, 0.0, 0.4, 5.9])
@pytest.mark.parametrize("size", [1e-3, 0.7, 9.0, 1e5])
def test_fitted_limits_hold_all_data_and_do_not_lose_them(low, size):
    ax = reused()
    x, y = np.linspace(0.0, size, 50), np.linspace(low, low + size, 50)
    curve(ax, "a", x, y)
    curve(ax, "b", x, np.full(50, np.nan))
    label_axes(ax, "x", "y")
    for (start, stop), values in ((ax.get_xlim(), x), (ax.get_ylim(), y)):
        assert start <= values.min() and stop >= values.max()
        reach = np.ptp([0.0, values.min(), values.max()])
        assert stop - start <= 3.6 * reach
    if low > 100.0 * size:  # a weight and a little force on it: not all the way from zero
        assert ax.get_ylim()[1] - ax.get_ylim()[0] <= 6.0 * size


def test_on_logarithmic_axes_limits_are_whole_decades():
    ax = reused("log")
    curve(ax, "a", [0.03, 4.0], [0.0, 20.0])
    label_axes(ax, "x", "y")
    assert ax.get_xlim() == pytest.approx((0.01, 10.0))
    assert ax.get_ylim() == pytest.approx((10.0, 100.0)), "zero has no place there"


def test_places_along_the_track_end_where_they_end():
    ax = reused()
    curve(ax, "a", [-3.7, 41.3], [1.0, 2.0])
    label_axes(ax, PLACE_LABEL, "y")
    assert ax.get_xlim() == (-3.7, 41.3)


def test_kept_limits_stay_while_the_data_can_be_seen_in_them():
    ax = reused()

    def shown(*y):
        curve(ax, "a", [0.0, 1.0], y)
        label_axes(ax, "x", "y")
        return ax.get_ylim()

    first = shown(-2.0, 5.0)
    keep_limits(ax.figure, True)
    assert shown(-1.0, 3.0) == first
    wider = shown(-2.0, 9.0)
    assert wider[1] >= 9.0 * 1.2 and wider[0] <= -2.0 * 1.2, "with room for the next"
    assert shown(-2.0, 9.9) == wider
    assert shown(0.0, 0.5)[1] < 1.5, "a small curve is not lost in large limits"
    keep_limits(ax.figure, False)
    assert shown(-2.0, 5.0) == first


def test_a_reused_axes_moves_its_curve_shade_and_names():
    ax = reused()
    for start, name in ((1.0, "one"), (2.0, "two")):
        curve(ax, "a", [0.0, start], [0.0, 1.0], label=name)
        shade(ax, "deck", start, start + 3.0, "deck")
        label_axes(ax, "x", "y")
        count = len(ax.get_children())
    assert len(ax.lines) == 1 and ax.lines[0].get_xdata() == [0.0, 2.0]
    (box,) = ax.patches
    assert (box.get_x(), box.get_width()) == (2.0, 3.0)
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["two", "deck"]
    curve(ax, "a", [0.0, 1.0], [0.0, 1.0], label="three")
    label_axes(ax, "x", "y")
    assert len(ax.get_children()) == count


def test_a_line_at_a_frequency_is_named_with_its_value_where_it_stays():
    ax = Figure().add_subplot()
    vertical_lines(ax, {"forcing": 1.3334, "wheel": 7.4})
    assert [line.get_label() for line in ax.lines] == ["forcing 1.333 Hz", "wheel 7.4 Hz"]
    ax = reused()
    vertical_lines(ax, {"forcing": 1.3334})
    assert ax.lines[0].get_label() == "forcing" and list(ax.lines[0].get_xdata()) == [1.3334] * 2
    vertical_lines(ax, None)
    assert len(ax.lines) == 1


def test_a_long_label_beside_a_low_axes_puts_its_unit_below():
    low, high = Figure(figsize=(9.0, 1.5)).add_subplot(), Figure(figsize=(9.0, 9.0)).add_subplot()
    for ax, label in (
        (low, "vertical bending moment\n(kN m)"),
        (high, "vertical bending moment (kN m)"),
    ):
        assert label_axes(ax, "x", "vertical bending moment (kN m)").get_ylabel() == label


def test_numbers_that_exist_are_kept_and_none_or_lower_ones_refused():
    assert numbers_up_to("modes", range(1, 9), 1, 3) == [1, 2, 3]
    assert numbers_up_to("which", (0, 1, 4), 0, 4) == [0, 1, 4]
    for wrong in ((), (4, 5), (0, 1)):
        with pytest.raises(InputError, match=r"^modes = \[.*\]: must name some of 1 to 3"):
            numbers_up_to("modes", wrong, 1, 3)


def test_small_multiples_leave_no_empty_axes_to_be_seen():
    axes = drawing.small_multiples(None, 4, 3, 0.4, 2.3)
    figure = axes[0].figure
    assert len(axes) == 4 and len(figure.axes) == 6
    assert [ax.axison for ax in figure.axes] == [True] * 4 + [False] * 2
    assert figure.get_figheight() == pytest.approx(0.4 + 2 * 2.3)
    alone = drawing.small_multiples(None, 2, 3, 0.4, 2.3)
    assert len(alone[0].figure.axes) == 2
    plt.close("all")
