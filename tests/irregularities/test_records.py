"""Measured tracks: rails from columns, value and slope, what the band takes out."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.irregularities import RecordedRail, record_of

X = 0.25 * np.arange(4001)


def wave(length, amplitude=1e-3, phase=0.0, x=X):
    return amplitude * np.sin(2 * np.pi * x / length + phase)


def test_a_recorded_rail_is_smooth_and_met_between_its_samples():
    rail = RecordedRail(-50.0, 0.25, wave(5.0, x=X - 50.0), 3.0)
    assert rail.extent == (-50.0, 950.0) and rail.shortest == 3.0
    x = np.random.default_rng(0).uniform(-45.0, 945.0, 3000)
    assert rail.value(x) == pytest.approx(wave(5.0, x=x), abs=1e-7)
    k = 2 * np.pi / 5.0
    assert rail.slope(x) == pytest.approx(1e-3 * k * np.cos(k * x), abs=2e-6)
    h = 1e-5
    central = (rail.value(x + h) - rail.value(x - h)) / (2 * h)
    assert rail.slope(x) == pytest.approx(central, abs=1e-8)
    nodes = rail.extent[0] + 0.25 * np.arange(1, 4000)
    jump = rail.slope(nodes + 1e-9) - rail.slope(nodes - 1e-9)
    assert np.abs(jump).max() < 1e-9


def test_beyond_its_ends_a_recorded_rail_is_level():
    rail = RecordedRail(0.0, 0.5, np.array([1.0, 2.0, 4.0, 3.0, 5.0]) * 1e-3, 3.0)
    out = np.array([-9.0, 2.5, 70.0])
    assert rail.value(out) == pytest.approx([1e-3, 5e-3, 5e-3]) and not rail.slope(out).any()
    assert rail.slope(np.array([0.0, 2.0])) == pytest.approx(rail._spline(np.array([0.0, 2.0]), 1))


def test_left_is_mean_plus_half_the_difference():
    columns = {
        "vertical": wave(10.0), "cross_level": wave(15.0), "alignment": wave(20.0),
        "gauge": wave(25.0),
    }  # fmt: skip
    record = record_of("r", X, columns, band="all")
    expected = {
        "vertical_left": wave(10.0) + wave(15.0) / 2, "lateral_left": wave(20.0) + wave(25.0) / 2,
        "vertical_right": wave(10.0) - wave(15.0) / 2, "lateral_right": wave(20.0) - wave(25.0) / 2,
    }  # fmt: skip
    assert set(record.rails) == set(expected)
    for name, r in expected.items():
        assert record.rails[name] == pytest.approx(r, abs=1e-18)
        direction, side = name.split("_")
        rail = record.track.rail(direction, side)
        assert rail.value(X) == pytest.approx(r, abs=1e-15)
    assert isinstance(record.vertical, rb.Rails) and isinstance(record.lateral, rb.Rails)


def test_a_direction_that_was_not_recorded_is_level_and_rails_that_agree_are_one():
    record = record_of("r", X, {"vertical": wave(10.0)}, band="all")
    assert record.lateral is None and isinstance(record.vertical, RecordedRail)
    assert record.track.rail("vertical", "left") is record.track.rail("vertical", "right")
    assert record.vertical.shortest == pytest.approx(2.5)
    only = record_of("r", X, {"cross_level": wave(10.0)}, band="all")
    assert only.rails["vertical_right"] == pytest.approx(-wave(10.0) / 2)


def test_the_origin_is_the_bridge_entrance():
    record = record_of("r", X + 12000.0, {"vertical": wave(10.0)}, band="all", origin=12300.0)
    assert record.vertical.extent == pytest.approx((-300.0, 700.0))
    assert record.x[0] == pytest.approx(-300.0)
    x = np.array([0.0, 33.3])
    assert record.vertical.value(x) == pytest.approx(wave(10.0, x=x + 300.0), abs=1e-7)


def test_the_band_says_what_it_takes_out():
    # Amplitudes 3, 1, 2 mm: variances 4.5, 0.5 and 2 mm2; only the first is within the band.
    r = wave(20.0, 3e-3) + wave(1.25, 1e-3) + wave(500.0, 2e-3)
    record = record_of("r", X, {"vertical": r}, band=(3.0, 100.0))
    (loss,) = record.losses
    assert loss.before == pytest.approx(7.0e-6, rel=1e-3)
    # At the ends what lies beyond is not known, which costs 3 %.
    assert loss.after == pytest.approx(4.5e-6, rel=0.03)
    assert loss.share == pytest.approx(1 - loss.after / loss.before)
    assert record.report == (
        f"vertical: variance {1e6 * loss.before:.4g} mm2, of it {1e6 * loss.after:.4g} mm2 within "
        f"3 to 100 m, {100 * loss.share:.3g} % lost"
    )
    assert record.vertical.shortest == 3.0
    whole = record_of("r", X, {"vertical": r}, band="all")
    assert whole.losses[0].share == 0.0 and "all wavelengths kept" in whole.report


def test_what_was_done_is_told_with_the_results_once_a_direction():
    r = wave(20.0)
    r[50:52] = np.nan
    columns = {"vertical": r, "cross_level": wave(30.0), "gauge": wave(8.0)}
    record = record_of("mine", X, columns, repair=["gap"], origin=300.0)
    run = rb.cross(rb.Train(rb.vehicle("xia2000")), rb.deck("viaduct36"), record.track, speed=20.0)
    told = [str(text) for text in rb.remarks(run) if "Measured" in str(text)]
    assert len(told) == 2
    assert told[0].startswith("Measured track mine, vertical: gap: 0.75 m at 12.25 m of vertical")
    assert "cross_level: variance" in told[0] and "gauge" not in told[0]
    assert told[1].startswith("Measured track mine, lateral: gap:") and "gauge: var" in told[1]


def test_a_measured_wave_gives_the_forces_of_the_wave():
    train, deck = rb.Train(rb.vehicle("xia2000")), rb.deck("viaduct36")
    exact = rb.Track(vertical=rb.Harmonic(5e-3, wavelength=14.4))
    x = 0.25 * np.arange(4000) - 400.0
    columns = {"vertical": exact.vertical.value(x)}
    record = record_of("r", x, columns, band=(3.0, 150.0))
    runs = [rb.cross(train, deck, t, speed=20.0, time_step=1e-3) for t in (exact, record.track)]
    forces = [run.wheel_forces[:, 1] for run in runs]
    dynamic = np.ptp(forces[0])
    assert forces[1] == pytest.approx(forces[0], abs=1e-3 * dynamic)


@pytest.mark.parametrize(
    ("columns", "options", "words"),
    [
        ({}, {}, "columns: there are none besides place"),
        ({"vertical_left": X}, {}, "column vertical_right: is missing. Give both rails"),
        (
            {"lateral_left": 0 * X, "lateral_right": 0 * X, "gauge": 0 * X}, {},
            "column gauge: stands beside lateral_left and lateral_right, never both",
        ),
        ({"verticl": X}, {}, "columns = 'verticl': .*Did you mean 'vertical'"),
        ({"gauge": 0 * X + 1.435}, {}, "gauge: reaches 1.435 m, .*wider than the nominal one"),
        ({"vertical": 0 * X}, {"band": (0.9, 9)}, "band = .*less than 4 samples, 0.25 m apart"),
        ({"vertical": 0 * X}, {"band": (9, 3)}, "band = .*must ascend. Shortest"),
        ({"vertical": 0 * X}, {"band": "none"}, 'band = .none.: must be two wavelengths, m, or'),
        ({"vertical": 0 * X}, {"band": None}, "band: must be two wavelengths"),
        ({"vertical": 0 * X}, {"origin": -1.0}, "origin = -1.0: .*at least 0 and at most 1000 m"),
        ({"vertical": 0 * X}, {"largest_step": 0}, "largest_step = 0: must be .* above 0 m"),
        ({"vertical": 0 * X}, {"largest_drift": 0}, "largest_drift = 0: must be .* above 0 m"),
        ({"vertical": 9e-3 * (X > 20)}, {}, "vertical at 20 m: jumps by 9 mm"),
    ],
)  # fmt: skip
def test_what_cannot_be_used_is_refused(columns, options, words):
    with pytest.raises(rb.InputError, match=words):
        record_of("r", X, columns, **options)


def test_limits_can_be_widened():
    columns = {"vertical": 9e-3 * (X > 20.0)}
    record_of("r", X, columns, largest_step=0.01)
    with pytest.raises(rb.InputError, match="drifts"):
        record_of("r", X, {"vertical": 3e-5 * X})
    assert record_of("r", X, {"vertical": 3e-5 * X}, largest_drift=0.05).repairs == ()


def test_a_frame_of_the_rails():
    frame = record_of("r", X, {"vertical": wave(10.0)}, band="all", origin=100.0).to_frame()
    assert list(frame.columns) == ["vertical_left (mm)", "vertical_right (mm)"]
    assert frame.index.name == "x (m)" and frame.index[0] == -100.0
    assert frame.iloc[10, 0] == pytest.approx(1e3 * wave(10.0)[10])


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_few_rows_are_refused_in_words(count):
    # One row was a failure of linear algebra.
    with pytest.raises(rb.InputError, match="at least four samples"):
        record_of("few", X[:count], {"vertical": wave(5.0)[:count]})


def test_a_band_far_longer_than_the_record_is_refused():
    # 1e9 m asked for 128 GiB.
    with pytest.raises(rb.InputError, match="10 times the record, 1000 m"):
        record_of("long", X, {"vertical": wave(5.0)}, band=(3.0, 1e9))
