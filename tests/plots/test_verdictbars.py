"""Bars of verdicts: as long as what is used, cut at twice the limit, and said in words."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import railbridge as rb
from railbridge import codes, plots
from railbridge.errors import InputError
from railbridge.plots.drawing import reuse_artists


def bars(ax):
    """Length of each bar by row, and its verdict."""
    found = {}
    for line in ax.lines:
        name, _, row = str(line.get_gid()).rpartition(" ")
        if row.isdigit() and np.isfinite(line.get_xdata()).all():
            found[int(row)] = (name, float(line.get_xdata()[1]))
    return found


def words(ax):
    return [text.get_text() for text in ax.texts]


def verdicts(*values):
    return codes.Verdicts([codes.judge(v, codes.acceleration_limit("ballasted")) for v in values])


def test_bars_are_as_long_as_what_is_used():
    ax = plots.utilisation(verdicts(1.75, 7.0, 35.0, None))
    assert bars(ax) == {
        0: ("met", pytest.approx(0.5)),
        1: ("not met", pytest.approx(2.0)),
        2: ("not met", pytest.approx(2.0)),
        3: ("cannot decide", 0.0),
    }
    assert words(ax) == [
        "met: 1.75, at most 3.5 m/s2", "not met: 7, at most 3.5 m/s2",
        "not met: 35, at most 3.5 m/s2", "cannot decide",
    ]  # fmt: skip
    plt.close(ax.figure)


@pytest.mark.parametrize(
    ("value", "limit", "said"),
    [
        (0.002, codes.twist_limit(40.0), "met: 2, at most 3 mm"),
        (7000.0, codes.horizontal_radius_limit(40.0), "met: 7000, at least 6000 m"),
        (-5e3, codes.uplift_limit(), "not met: -5, at least 0 kN"),
        (0.5, codes.wheel_unloading_limit(), "met: 0.5, at most 0.6"),
    ],
)
def test_units_are_those_of_people(value, limit, said):
    ax = plots.utilisation(codes.Verdicts([codes.judge(value, limit)]))
    assert words(ax) == [said]
    plt.close(ax.figure)


def test_in_a_panel_a_bar_changes_its_verdict():
    figure, ax = plt.subplots()
    plots.utilisation(verdicts(1.75), ax)
    reuse_artists(figure)
    plots.utilisation(verdicts(7.0), ax)
    assert bars(ax) == {0: ("not met", pytest.approx(2.0))}
    assert words(ax) == ["not met: 7, at most 3.5 m/s2"]
    plt.close(figure)


def test_nothing_to_show_is_refused():
    with pytest.raises(InputError, match="at least one"):
        plots.utilisation(codes.Verdicts())
    with pytest.raises(InputError, match="verdicts"):
        plots.utilisation(rb.codes.all_clauses())
