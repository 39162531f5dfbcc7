"""What depends on the speed, over the speed, with a dot where one is."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import railbridge as rb
from railbridge.plots.speeds import force_over_speed, frequency_met, speeds_in_step

SPEEDS = np.linspace(5.0, 80.0, 16)


@pytest.fixture
def ax():
    yield plt.figure().add_subplot()
    plt.close("all")


def drawn(ax):
    return {line.get_gid(): line for line in ax.lines}


def test_a_force_over_speed_has_its_dot_at_the_present_speed(ax):
    force = 1e3 * SPEEDS
    force_over_speed(SPEEDS, force, (22.0, 21.5e3), {"car bounce": 19.2}, ax)
    lines = drawn(ax)
    assert np.allclose(lines["over speed"].get_data(), [SPEEDS, SPEEDS])
    assert np.allclose(lines["now"].get_data(), [[22.0], [21.5]]), "kN"
    assert np.allclose(lines["line at car bounce"].get_xdata(), 19.2)
    assert ax.get_xlim() == (5.0, 80.0)
    assert ax.get_xlabel() == "speed (m/s)" and "(kN)" in ax.get_ylabel()


def test_the_frequency_met_crosses_the_natural_frequencies(ax):
    car = rb.vehicle("xia2000")
    frequency_met(car, SPEEDS, 14.4, 20.0, (0.1, 40.0), ax)
    lines = drawn(ax)
    assert np.allclose(lines["met"].get_ydata(), SPEEDS / 14.4)
    assert np.allclose(lines["now"].get_data(), [[20.0], [20.0 / 14.4]])
    natural = lines["natural"].get_ydata()
    assert set(car.modes().frequencies_hz) == set(natural[np.isfinite(natural)])
    names = " ".join(text.get_text() for text in ax.texts)
    for name in ("car sway", "car bounce", "car pitch", "bogie bounce", "bogie yaw"):
        assert name in names
    heights = sorted(text.get_position()[1] for text in ax.texts)
    assert np.diff(heights).min() > 0.05, "names do not cover each other"
    assert ax.get_ylim() == (0.1, 40.0) and ax.get_yscale() == "log"


def test_speeds_in_step_are_named_and_the_dot_stands_at_the_present_one(ax):
    speeds_in_step({"cars": [74.4, 37.2], "waves": [47.6]}, 30.0, (5.0, 80.0), ax)
    lines = drawn(ax)
    x = lines["cars"].get_xdata()
    assert set(x[np.isfinite(x)]) == {74.4, 37.2}
    assert lines["now"].get_xdata() == [30.0]
    assert ax.get_xlim() == (5.0, 80.0)
    words = [text.get_text() for text in ax.get_legend().get_texts()]
    assert words == ["cars", "waves", "this speed"]
    assert [text.get_text() for text in ax.texts] == ["74.4", "37.2", "47.6"]
