"""Random tracks against their spectrum: variance, Welch's estimate, coherence, independence."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from scipy.signal import coherence, welch

import railbridge as rb
from railbridge.irregularities import COMPONENTS, PAIRS, TrackSpectrum, phases

PHASES = {
    "vertical": [5.013097119972429, 0.3335987071777463, 3.7155686524197566],
    "gauge": [6.172116180011827, 0.38296860399109905, 0.07361399115717338],
}
LEFT = [0.00112605986303801, 0.00488352616219653, 0.004295808397281]
"""Of seed 7: what any machine must give."""


@pytest.fixture(scope="module")
def long_track():
    # Few realisations of a period are as good as one of many: the same statistics, less to compute.
    return [rb.RandomTrack("german-low", seed=seed, period=4000.0) for seed in range(12)]


@pytest.mark.parametrize("name", ["german-high", "fra-aar-5", "chinese-ballastless", "sncf-poor"])
def test_variance_of_the_waves_is_that_of_the_spectrum(name):
    spectrum = rb.spectrum(name)
    band = (3.0, min(100.0, spectrum.band[1]))
    track = rb.RandomTrack(spectrum, band=band, period=700.0)
    for component in spectrum.components:
        sigma = spectrum.sigma(component, band, height=True)
        assert np.sqrt(track.powers[component].sum()) == pytest.approx(sigma, rel=1e-9)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_variance_over_a_whole_period_hangs_on_no_seed(seed):
    track = rb.RandomTrack("german-low", seed=seed, period=4000.0)
    r = track.component("vertical").value(np.arange(0.0, track.length, 0.25))
    # Differences of wave numbers fit into the period, sums do not quite.
    assert np.sqrt(np.mean(r**2)) == pytest.approx(
        track.spectrum.sigma("vertical", track.band), rel=0.01
    )


def test_welch_estimate_lies_within_chi_square_bounds(long_track):
    step, size = 0.5, 2048
    for component in COMPONENTS:
        found = []
        for track in long_track:
            x = np.arange(0.0, 4000.0, step)
            r = track.component(component).value(x)
            n, density = welch(r, fs=1 / step, nperseg=size, noverlap=0, window="hann")
            found.append(density)
        segments = len(long_track) * (len(x) // size)
        # Inside the band, away from its ends by the window's width.
        waves = 2 * np.pi * n
        inside = (waves > 2 * np.pi / 150 + 0.02) & (waves < 2 * np.pi / 3 - 0.02)
        known = long_track[0].spectrum.density(component, waves[inside], height=True) * 2 * np.pi
        ratio = np.mean(found, axis=0)[inside] / known
        low, high = stats.chi2.ppf([0.005, 0.995], 2 * segments) / (2 * segments)
        within = np.mean((ratio > low) & (ratio < high))
        assert within > 0.97, component
        assert ratio.mean() == pytest.approx(1.0, abs=4 / np.sqrt(segments * len(ratio)) + 0.01)


def test_coherence_of_the_rails(long_track):
    step, size = 0.5, 512
    x = np.arange(0.0, 4000.0, step)
    rails = [
        np.concatenate([getattr(track.vertical, side).value(x) for track in long_track])
        for side in ("left", "right")
    ]
    n, found = coherence(*rails, fs=1 / step, nperseg=size, noverlap=size // 2)
    waves = 2 * np.pi * n
    inside = (waves > 0.1) & (waves < 2.0)
    spectrum = long_track[0].spectrum
    level, cross = (
        spectrum.density(c, waves[inside], height=True) for c in ("vertical", "cross_level")
    )
    # scipy's coherence is the square of the ratio of spectra.
    known = ((level - cross / 4) / (level + cross / 4)) ** 2
    segments = len(rails[0]) / size
    scatter = np.sqrt(2 / segments) * (1 - known) * np.sqrt(known)
    # Each segment that joins two tracks is none of either; they are one in thirty.
    assert np.abs(found[inside] - known).mean() < 0.05
    assert np.mean(np.abs(found[inside] - known) < 4 * scatter + 0.05) > 0.97


def test_left_rail_higher_is_positive_roll():
    track = rb.RandomTrack("german-low", seed=5)
    x = np.linspace(0.0, 100.0, 301)
    for direction, (both, apart) in PAIRS.items():
        left, right = (track.rail(direction, side).value(x) for side in ("left", "right"))
        assert (left + right) / 2 == pytest.approx(track.component(both).value(x), abs=1e-15)
        assert left - right == pytest.approx(track.component(apart).value(x), abs=1e-15)


def test_german_cross_level_is_an_angle_made_a_height_over_one_and_a_half_metres():
    track = rb.RandomTrack("german-low", band=(3.0, 25.0))
    assert np.sqrt(track.powers["cross_level"].sum()) == pytest.approx(1.3680e-3, rel=1e-4)


def test_seed_gives_the_same_track_on_every_machine():
    assert phases(7, "vertical", 3) == pytest.approx(PHASES["vertical"], abs=1e-12)
    assert phases(7, "gauge", 3) == pytest.approx(PHASES["gauge"], abs=1e-12)
    track = rb.RandomTrack("german-low", seed=7)
    found = track.rail("vertical", "left").value(np.array([0.0, 12.5, 100.0]))
    assert found == pytest.approx(LEFT, abs=1e-12)


def test_components_do_not_change_each_other():
    whole = rb.RandomTrack("german-low", seed=3)
    alone = rb.RandomTrack("german-low", seed=3, components=("alignment",))
    x = np.linspace(0.0, 50.0, 101)
    assert np.array_equal(whole.component("alignment").value(x), alone.lateral.value(x))
    assert alone.vertical is None


def test_components_are_independent():
    own = [phases(11, name, 20_000) for name in COMPONENTS]
    for i, a in enumerate(own):
        for b in own[:i]:
            assert abs(np.mean(np.cos(a - b))) < 4 / np.sqrt(2 * 20_000)


def test_waves_that_the_step_cannot_resolve_are_refused():
    train, deck = rb.Train(rb.vehicle("xia2000")), rb.deck("viaduct36")
    track = rb.RandomTrack("german-low", seed=1)
    with pytest.raises(rb.InputError, match="time_step"):
        rb.cross(train, deck, track, speed=20.0, time_step=0.02)


def test_a_track_that_repeats_itself_under_the_train_is_refused():
    train, deck = rb.Train(rb.vehicle("xia2000")), rb.deck("viaduct36")
    with pytest.raises(rb.InputError, match="repeats after"):
        rb.cross(train, deck, rb.RandomTrack("german-low", period=100.0), speed=20.0)


def test_a_long_track_is_met_in_bounded_memory():
    import tracemalloc

    track = rb.RandomTrack("german-low", seed=1, period=300.0).component("vertical")
    x = np.arange(0.0, 20_000.0, 0.05)
    tracemalloc.start()
    track.value(x)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 4 * x.nbytes


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"spectrum": "german-lwo"}, "spectrum"),
        ({"spectrum": "fra"}, "spectrum"),
        ({"band": (1.0, 150.0)}, "band"),
        ({"band": (150.0, 3.0)}, "band"),
        ({"band": (3.0, 3.0)}, "band"),
        ({"seed": 1.5}, "seed"),
        ({"seed": -1}, "seed"),
        ({"seed": "7"}, "seed"),
        ({"seed": None}, "seed"),
        ({"period": 0.0}, "period"),
        ({"period": 1e7}, "period"),
        ({"components": ()}, "components"),
        ({"components": ("twist",)}, "components"),
        ({"spectrum": "sncf-good", "band": (3, 40), "components": ("gauge",)}, "components"),
    ],
)
def test_refusals(options, field):
    with pytest.raises(rb.InputError) as refusal:
        rb.RandomTrack(**{"spectrum": "german-low"} | options)
    assert refusal.value.field.startswith(field)


def test_a_seed_that_would_be_rounded_to_another_is_refused():
    # 2**53 + 1 is no floating-point number: it gave the track of 2**53.
    with pytest.raises(rb.InputError, match="seed"):
        rb.RandomTrack("german-low", seed=2**53 + 2)
    assert rb.RandomTrack("german-low", seed=2**53 - 1, band=(30, 60)).seed == 2**53 - 1


def test_tracks_of_equal_contents_are_equal():
    one, other = (rb.RandomTrack("german-low", seed=3, period=300.0) for _ in range(2))
    assert one == other and hash(one) == hash(other) and len({one, other}) == 1
    assert one.spectrum == other.spectrum and one.spectrum is not other.spectrum
    spectra = [one.spectrum.scaled(sigma) for sigma in (1e-3, 1e-3, 2e-3)]
    scaled = [rb.RandomTrack(own, seed=3, period=300.0) for own in spectra]
    assert scaled[0] == scaled[1] != scaled[2] and scaled[0] != one
    others = {"seed": 4, "period": 310.0, "components": ("vertical",), "band": (4.0, 150.0)}
    for name, value in others.items():
        assert replace(one, **{name: value}) != one
    assert one != rb.Track(one.vertical, one.lateral) and rb.Track() != one


def test_powers_are_found_once_for_all_seeds(monkeypatch):
    first = rb.RandomTrack("german-low", seed=1, period=431.0)
    monkeypatch.setattr(TrackSpectrum, "sigma", None)  # which nobody may ask for again
    again = rb.RandomTrack("german-low", seed=2, period=431.0)
    for name in first.components:
        assert again.powers[name] is first.powers[name]
    with pytest.raises(TypeError):
        rb.RandomTrack("german-low", seed=1, period=432.0)
