"""Sums of cosines, against the sum written out and against differences."""

import numpy as np
import pytest

from railbridge.errors import InputError
from railbridge.irregularities import Cosines


@pytest.fixture(scope="module")
def track():
    draw = np.random.default_rng(3)
    sizes = draw.normal(size=40) + 1j * draw.normal(size=40)
    return Cosines(np.sort(draw.uniform(0.04, 2.0, 40)), 1e-3 * sizes)


def written_out(track, x):
    pairs = zip(track.wavenumbers, track.amplitudes, strict=True)
    return sum(abs(a) * np.cos(w * x + np.angle(a)) for w, a in pairs)


@pytest.mark.parametrize("count", [1, 2, 3, 1000, 16_384, 16_385, 40_000])
def test_even_places(track, count):
    x = -150.0 + 0.0137 * np.arange(count)
    assert track.value(x) == pytest.approx(written_out(track, x), abs=1e-13)


def test_uneven_places_in_any_shape(track):
    x = np.random.default_rng(1).uniform(-500.0, 500.0, (7, 11))
    assert track.value(x).shape == (7, 11)
    assert track.value(x) == pytest.approx(written_out(track, x), abs=1e-13)


def test_no_places(track):
    assert track.value(np.empty(0)).shape == (0,)


def test_slope_by_differences(track):
    x, d = np.linspace(-40.0, 40.0, 997), 1e-4
    differences = (track.value(x + d) - track.value(x - d)) / (2 * d)
    assert track.slope(x) == pytest.approx(differences, abs=1e-9)


def test_shortest_is_that_of_waves_that_move():
    assert Cosines([1.0, 2.0], [1e-3, 0.0]).shortest == pytest.approx(2 * np.pi)
    assert Cosines([1.0, 2.0], [0.0, 0.0]).shortest == np.inf


@pytest.mark.parametrize(
    ("waves", "sizes", "field"),
    [
        ([0.0, 1.0], [1.0, 1.0], "wavenumbers"),
        ([1.0, 2.0], [1.0], "amplitudes"),
        ([1.0], [np.nan], "amplitudes"),
    ],
)
def test_refusals(waves, sizes, field):
    with pytest.raises(InputError) as refusal:
        Cosines(waves, sizes)
    assert refusal.value.field.startswith(field)
