"""Pictures of random tracks show what their objects say."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import railbridge as rb
from railbridge.irregularities import TrackSpectrum
from railbridge.plots.drawing import band, reuse_artists

SAG, SHAKE = "displacement_z at 18 m", "acceleration_z at 18 m"


@pytest.fixture(scope="module")
def crossing():
    track = rb.RandomTrack("german-low", (10, 100), 3, ("vertical",), 400.0)
    train = rb.Train(rb.vehicle("xia2000_planar"))
    asked = {"quantities": ("displacement_z", "acceleration_z"), "wheels_of": (1,)}
    options = {"speed": 60.0, "time_step": 4e-3, "tail": 0.2}
    return rb.random_response(train, rb.deck("viaduct36"), track, **asked, **options)


def drawn(ax):
    return {line.get_gid(): line for line in ax.lines}


def words(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_spectra_stand_where_they_are_valid_in_mm2():
    ax = rb.plots.track_spectra(["german-low", "sncf-good"])
    lines = drawn(ax)
    for name, ends in (("german-low", (3.0, 150.0)), ("sncf-good", (2.0, 40.0))):
        waves, density = lines[name].get_data()
        assert (waves[0], waves[-1]) == pytest.approx(ends)
        wanted = 1e6 * rb.spectrum(name).density("vertical", 2 * np.pi / waves)
        assert density == pytest.approx(wanted)
    assert words(ax) == ["german-low", "sncf-good"]
    assert [text.get_text() for text in ax.texts] == ["D1", "D2", "D3"]
    assert ax.get_xscale() == ax.get_yscale() == "log"


def test_an_angle_of_cross_level_is_drawn_as_a_height():
    lines = drawn(rb.plots.track_spectra(["german-low"], "cross_level"))
    waves, density = lines["german-low"].get_data()
    angle = rb.spectrum("german-low").density("cross_level", 2 * np.pi / waves)
    assert density == pytest.approx(1e6 * 1.5**2 * angle)


def test_more_spectra_than_colours_differ_by_their_dashes():
    own = TrackSpectrum.from_table([0.1, 1.0], {"vertical": [1e-6, 1e-8]}, name="own $1")
    names = [f"fra-aar-{i}" for i in range(1, 7)]
    ax = rb.plots.track_spectra([*names, own])
    looks = [(line.get_color(), line.get_linestyle()) for line in ax.lines]
    assert len(set(looks)) == 7
    assert words(ax)[-1] == r"own \$1"


def test_mean_deviation_and_realisations_are_those_of_the_response(crossing):
    ax = rb.plots.random_response(crossing, SAG, seeds=(5, 9))
    lines = drawn(ax)
    mean, sigma = 1e3 * crossing.mean(SAG), 1e3 * crossing.sigma(SAG)
    for name, values in (
        ("mean", mean),
        ("mean - sigma", mean - sigma),
        ("mean + sigma", mean + sigma),
        ("track 0", 1e3 * crossing.history(SAG, 5)),
        ("track 1", 1e3 * crossing.history(SAG, 9)),
    ):
        assert np.array_equal(lines[name].get_xdata(), crossing.time(SAG)), name
        assert lines[name].get_ydata() == pytest.approx(values), name
    (filled,) = ax.patches
    corners = filled.get_xy()[:, 1]
    assert corners.min() == pytest.approx((mean - sigma).min())
    assert corners.max() == pytest.approx((mean + sigma).max())
    assert words(ax) == [
        "2 tracks of the spectrum",
        "mean ± standard deviation",
        "mean: level track",
    ]
    assert "vertical displacement" in ax.get_ylabel() and "(mm)" in ax.get_ylabel()


def test_a_wheel_force_is_drawn_in_kn(crossing):
    name = "wheel_force_z of car 1, wheel 2"
    ax = rb.plots.random_response(crossing, name)
    assert drawn(ax)["mean"].get_ydata() == pytest.approx(crossing.mean(name) / 1e3)
    assert ax.get_ylabel().replace("\n", " ") == "wheel force (kN)"


def test_a_band_is_moved_where_artists_are_reused():
    ax = plt.figure().add_subplot()
    x = np.arange(3.0)
    for low, reuse in ((0.0, False), (1.0, True)):
        if reuse:
            reuse_artists(ax.figure)
        band(ax, "b", x, low + 0 * x, low + 1 + 0 * x, "k", "words")
    (patch,) = ax.patches
    assert set(patch.get_xy()[:, 1]) == {1.0, 2.0} and patch.get_label() == "words"


@pytest.mark.parametrize("side", ["magnitude", "largest", "smallest"])
def test_extremes_are_counted_beside_what_is_predicted(crossing, side):
    ensemble, predicted = crossing.ensemble(300), crossing.extreme(SHAKE, side)
    ax = rb.plots.extremes(ensemble, SHAKE, predicted, side=side)
    values = ensemble.values(SHAKE, side)
    areas = [bar.get_width() * bar.get_height() for bar in ax.patches]
    assert sum(areas) == pytest.approx(1.0)
    assert ax.patches[0].get_x() == pytest.approx(values.min())
    line = drawn(ax)["predicted"]
    assert np.trapezoid(line.get_ydata(), line.get_xdata()) == pytest.approx(1.0, abs=0.01)
    beyond = drawn(ax)["rare"].get_xdata()[0]
    share = np.mean(values < beyond if side == "smallest" else values > beyond)
    assert 0.005 < share < 0.12
    low, high = ax.get_xlim()
    assert low <= values.min() and values.max() <= high


def test_unloading_has_no_unit(crossing):
    ax = rb.plots.extremes(crossing.ensemble(20), "wheel_unloading")
    assert ax.get_xlabel() == "extreme of the wheel unloading (-)"


def test_shares_of_waves_add_up_and_stand_over_their_lengths(crossing):
    time = crossing.time(SHAKE)[np.argmax(crossing.sigma(SHAKE))]
    ax = rb.plots.wave_shares(crossing, SHAKE, time, label="now")
    waves, share = drawn(ax)["now"].get_data()
    assert waves[0] == pytest.approx(10.0) and waves[-1] == pytest.approx(100.0)
    assert share[0] == 0.0 and share[-1] == pytest.approx(1.0) and (np.diff(share) >= 0).all()
    parts = crossing.spectrum_at(SHAKE, time)[0]
    shorter = 2 * np.pi / crossing.track.wavenumbers < waves[7]
    assert share[7] == pytest.approx(parts[shorter].sum() / parts.sum())
    assert words(ax) == ["now"]


def test_before_the_train_nothing_has_a_share(crossing):
    with pytest.raises(rb.InputError, match="before the track is felt"):
        rb.plots.wave_shares(crossing, SHAKE, crossing.time(SHAKE)[0])
