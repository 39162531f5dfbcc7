"""Fingerprints: equal contents, equal texts; another content, another one."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies.fingerprints import fingerprint


def test_equal_contents_are_equal_and_others_are_not():
    assert fingerprint(20, {"b": 1, "a": 2}) == fingerprint(20.0, {"a": 2.0, "b": 1.0})
    assert fingerprint(np.float64(0.1)) == fingerprint(0.1)
    assert fingerprint(np.True_) == fingerprint(True)
    different = [
        None, True, False, 0, 1, "1", "", "None", 0.1, np.nextafter(0.1, 1), [], [[]], [1, 2],
        {"a": 1}, {"a": None}, np.zeros(2), np.zeros((2, 1)), np.zeros(2, dtype=complex),
    ]  # fmt: skip
    assert len({fingerprint(each) for each in different}) == len(different)


def test_texts_cannot_be_made_to_look_like_others():
    assert fingerprint("a", "b") != fingerprint("a;str:b")
    assert fingerprint(["a", "b"]) != fingerprint(["a;str:1:b"])
    assert fingerprint({"a": "x", "b": "y"}) != fingerprint({"a:": "x", "b": "y"})


def test_what_is_not_understood_is_no_fingerprint():
    with pytest.raises(TypeError, match="no fingerprint"):
        fingerprint(object())


def test_random_tracks_are_told_apart():
    """Their spectra hold formulas, functions of the suite; those of others are not understood."""

    def track(name, seed=1):
        return rb.RandomTrack(name, components=("vertical",), period=400.0, seed=seed)

    different = [track("german-low"), track("german-low", 2), track("german-high")]
    different += [track("fra-fryba-1"), track("fra-aar-1")]
    assert len({fingerprint(each) for each in different}) == len(different)
    assert fingerprint(track("german-low")) == fingerprint(track("german-low"))
    with pytest.raises(TypeError, match="no fingerprint"):
        fingerprint(track)


def test_trains_run_over_a_random_track_at_several_speeds():
    deck = rb.SimpleBridge(
        span=20.0, mass=12e3, bending_stiffness=3e10, kind="steel", line_speed=50.0
    ).case().deck  # fmt: skip
    track = rb.RandomTrack("german-low", components=("vertical",), period=800.0)
    train = rb.Train(rb.vehicle("xia2000_planar"))
    over = rb.speed_envelope(deck, train, [40.0, 50.0], track=track)
    run = rb.cross(train, deck, track, speed=50.0)
    at = over.displacement_z.sel(speed=50.0, x=10.0, method="nearest").item()
    assert at == pytest.approx(abs(run.displacement(10.0).extreme("displacement_z")[0]), rel=1e-6)


def test_another_version_of_the_program_is_another_crossing(monkeypatch):
    from railbridge.studies import fingerprints

    parts = "deck", "train", "track", None
    now = fingerprints.print_of_crossing(*parts)
    monkeypatch.setattr(fingerprints, "_program", lambda: "99.0")
    assert fingerprints.print_of_crossing(*parts) != now
