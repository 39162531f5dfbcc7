"""Speeds that are chosen find peaks that an even grid of as many misses."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import studies
from railbridge.studies.refinement import SETTLED, Between, refined, starting_speeds


def test_a_narrow_peak_is_found_where_the_grid_only_touches_it():
    def curve(v):
        return np.stack([1 + 8 / (1 + ((v - 51.37) / 0.2) ** 2), 0.1 * v], axis=1)

    start = np.linspace(40.0, 60.0, 41)
    found = refined(curve, start)
    assert curve(found)[:, 0].max() == pytest.approx(9.0, rel=SETTLED)
    assert set(start) <= set(found.tolist()) and len(found) < 80
    away = found[(np.abs(found - 51.37) > 2.0) & (found > 41.0) & (found < 59.0)]
    assert set(away) <= {*start, *((start[:-1] + start[1:]) / 2)}, "refined there, not everywhere"


def test_points_that_failed_are_passed_over():
    def curve(v):
        return np.where(v[:, None] > 50.0, np.nan, v[:, None])

    found = refined(curve, np.linspace(40.0, 60.0, 11))
    assert 11 <= len(found) < 30


def test_the_start_holds_resonance_speeds_and_peaks_of_the_bound():
    deck = rb.Beam("simple", (25.0,), 15e3, 3.1e10).deck(modes=2, damping=0.01)
    train = rb.train("HSLM-A1")
    start = starting_speeds(deck, train, Between(30.0, 100.0))
    for speed in studies.resonance_speeds(deck, train, 30.0, 100.0):
        assert np.abs(start - speed).min() < 1e-6
    assert start[0] == 30.0 and start[-1] == 100.0 and np.all(np.diff(start) > 0)


def test_chosen_speeds_meet_the_peaks_of_a_hundred_times_finer_grid():
    deck = rb.Beam("simple", (25.0,), 15e3, 3.1e10).deck(modes=2, damping=0.01)
    trains = {name: rb.train(name) for name in ("HSLM-A1", "HSLM-A7")}
    names = ("displacement_z", "acceleration_z")
    chosen = studies.speed_envelope(deck, trains, Between(40.0, 90.0), quantities=names)
    fine = studies.speed_envelope(deck, trains, np.linspace(40.0, 90.0, 2001), quantities=names)
    for name in names:
        missed = fine[name].max("speed") / chosen[name].max("speed") - 1.0
        assert float(missed.max()) < SETTLED
    assert chosen.sizes["speed"] < 500 and "0.5 %" in chosen.attrs["title"]


@pytest.mark.parametrize(
    ("low", "high", "said"),
    [(50.0, 40.0, "lower to a higher"), (-1.0, 5.0, "above 0"), (10.0, 500.0, "at most 200")],
)
def test_what_is_no_span_of_speeds(low, high, said):
    with pytest.raises(rb.InputError, match=said):
        Between(low, high)
