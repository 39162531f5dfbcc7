"""The panel of random tracks: its words are numbers of the response, and spectra cost nothing."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import panels
from railbridge.panels import randomtrack

SAG, SHAKE = "displacement_z at 18 m", "acceleration_z at 18 m"


@pytest.fixture(scope="module")
def made():
    return panels.random_track()


@pytest.fixture
def panel(made):
    yield made
    made.reset()


def expected(panel, **changes):
    values = {**panel.values, **changes}
    rough = rb.spectrum(values["spectrum"]).scaled(values["sigma"])
    track = rb.RandomTrack(rough, components=("vertical",))
    asked = {"quantities": ("displacement_z", "acceleration_z"), "points": [18.0]}
    return rb.random_response(
        panel.case.train, panel.case.deck, track, **asked, **panel.case.options
    )


def words(run):
    w, a = (np.abs(run.mean(name)).max() for name in (SAG, SHAKE))
    return (
        f"level track {1e3 * w:.2f} mm and {a:.2f} m/s2; standard deviation on the rough one "
        f"{1e3 * run.sigma(SAG).max():.2f} mm and "
        f"{run.sigma(SHAKE).max():.3f} m/s2; one crossing in twenty exceeds "
        f"{run.extreme(SHAKE).percentile(95):.2f} m/s2."
    )


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"speed": 75.0, "sigma": 2.5e-3},
        {"spectrum": "chinese-ballastless"},
        {"interaction": "rigid", "speed": 80.0},
    ],
)
def test_the_words_are_those_of_the_response(panel, values):
    panel.set(**values)
    assert words(expected(panel)) in panel.summary


def test_each_control_changes_words_and_picture(panel):
    said, shown = panel.summary, panel.image.value
    for values in (
        {"speed": 61.0},
        {"sigma": 1.1e-3},
        {"spectrum": "chinese-ballastless"},
        {"spectrum": "fra-fryba-4"},
        {"interaction": "rigid"},
    ):
        panel.reset().set(**values)
        assert panel.summary != said and panel.image.value != shown, values


def test_another_spectrum_asks_for_no_other_crossing(panel, monkeypatch):
    computed = []
    crossed = randomtrack._crossed
    monkeypatch.setattr(
        randomtrack, "_crossed", lambda *given: computed.append(1) or crossed(*given)
    )
    panel.set(speed=50.0)
    before = len(computed)
    panel.set(sigma=2e-3).set(spectrum="fra-fryba-4").set(sigma=3e-3)
    assert len(computed) == before == 1
    panel.set(speed=51.0)
    assert len(computed) == 2


def test_the_code_gives_what_is_rarely_exceeded(panel):
    panel.set(speed=72.0, sigma=1.5e-3)
    *lines, last = panel.code.strip().splitlines()
    scope = {}
    exec("\n".join(lines), scope)
    assert f"exceeds {eval(last, scope):.2f} m/s2" in panel.summary


def test_a_case_keeps_its_own_track_and_others_are_given_one():
    own = {"kind": "random", "spectrum": "sncf-good", "band": [3.0, 30.0]}
    near = {"track.vertical": own, "train.cars": 1, "run.time_step": None, "run.speed": 60.0}
    kept = panels.random_track(rb.case("paper").replace(near))
    assert kept.values["spectrum"] == "sncf-good" and kept.values["sigma"] == 1e-3
    assert "(3.0, 30.0)" in kept.code and "sncf-good" in kept.summary
    given = panels.random_track(rb.case("paper").replace({"run.time_step": None, "train.cars": 1}))
    assert given.values["spectrum"] == "german-low"
    assert given.case.get("track.vertical.kind") == "random"
    for own in (kept, given):
        own.close()
