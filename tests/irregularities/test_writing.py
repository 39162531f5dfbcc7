"""Tracks as CSV files that are read back."""

import numpy as np
import pytest

import railbridge as rb

TRACK = rb.Track(
    vertical=rb.Rails(rb.Harmonic(5e-3, wavelength=14.4), rb.Dip(3e-3, 2.0, at=10.0)),
    lateral=rb.Harmonic(2e-3, wavelength=9.0),
)


def test_an_exported_track_comes_back(tmp_path):
    path = rb.export_track(TRACK, tmp_path / "own.csv", -50.0, 150.0, step=0.1)
    record = rb.track_record(path, band="all")
    assert record.x == pytest.approx(-50.0 + 0.1 * np.arange(2001), abs=1e-12)
    assert record.repairs == ()
    for direction in ("vertical", "lateral"):
        for side in ("left", "right"):
            expected = TRACK.rail(direction, side).value(record.x)
            # mm in the file: one rounding there, one back.
            found = record.rails[f"{direction}_{side}"]
            assert found == pytest.approx(expected, rel=1e-15, abs=2e-18)


def test_a_record_comes_back_as_it_was_kept(tmp_path):
    record = rb.track_record("example_record", origin=200.0)
    again = rb.track_record(record.to_csv(tmp_path / "kept.csv"), band="all")
    assert (again.first, again.step) == pytest.approx((record.first, record.step), rel=1e-12)
    for name, r in record.rails.items():
        assert again.rails[name] == pytest.approx(r, rel=1e-15, abs=1e-20)


def test_perfect_directions_are_left_out(tmp_path):
    track = rb.Track(lateral=rb.Rails(None, rb.Harmonic(2e-3, wavelength=9.0)))
    text = rb.export_track(track, tmp_path / "a.csv", 0.0, 10.0).read_text(encoding="utf-8")
    assert text.splitlines()[1] == "place (m),lateral_left (mm),lateral_right (mm)"
    assert len(text.splitlines()) == 2 + 41


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((rb.Track(), "a.csv", 0.0, 9.0), "track: is perfect"),
        ((5, "a.csv", 0.0, 9.0), "track = 5: must be a Track"),
        ((TRACK, "a.csv", 9.0, 9.0), "last = 9.0: must be .* above 9 m"),
        ((TRACK, "a.csv", 0.0, 9.0, 5.0), "step = 5.0: .*at most 3 m"),
        ((TRACK, "a.csv", 0.0, 9.0, 1e-9), "step = 1e-09: makes more than"),
        ((TRACK, "no/such/a.csv", 0.0, 9.0), "path = .*: cannot be written"),
    ],
)
def test_what_cannot_be_written_is_refused(arguments, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(rb.InputError, match=words):
        rb.export_track(*arguments)
    assert not list(tmp_path.iterdir())


def test_a_record_is_not_written_beyond_its_ends(tmp_path):
    # It was level there, at the value of its end, and read back as measured.
    track = rb.track_record("example_record").track
    first, last = track.rail("vertical", "left").extent
    rb.export_track(track, tmp_path / "whole.csv", first, last)
    for ends in ((first - 1.0, last), (first, last + 1.0)):
        with pytest.raises(rb.InputError, match="known from"):
            rb.export_track(track, tmp_path / "beyond.csv", *ends)
    assert not (tmp_path / "beyond.csv").exists()
