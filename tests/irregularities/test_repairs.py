"""Faults of a record: refused with place and size, or mended where that is asked for."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.irregularities.repairs import REPAIRS, Samples, checked_repairs, mended

X = 0.25 * np.arange(400)
R = 1e-3 * np.sin(2 * np.pi * X / 20.0)


def mend(place, r, *repair):
    return mended(Samples(place, {"vertical": np.array(r)}), repair, 5e-3, 0.02)


def refused(place, r, *repair):
    with pytest.raises(rb.InputError) as caught:
        mend(place, r, *repair)
    return str(caught.value)


def test_a_good_record_stays_as_it_is():
    found = mend(X, R, *REPAIRS)
    assert found.done == () and np.array_equal(found.columns["vertical"], R)
    assert np.array_equal(found.place, X)


def test_repeated_places():
    place, r = np.insert(X, 41, X[40]), np.insert(R, 41, 7e-3)
    words = refused(place, r)
    assert words.startswith("place 10 m: is given twice.") and '["repeated"]' in words
    found = mend(place, r, "repeated")
    assert np.array_equal(found.columns["vertical"], R)
    assert found.done == ("repeated: 1 samples dropped whose place does not ascend, the first at "
                          "10 m",)  # fmt: skip


def test_places_that_go_back():
    place = np.concatenate([X[:41], X[38:]])
    r = np.concatenate([R[:41], R[38:]])
    assert refused(place, r).startswith("place 9.5 m: goes back by 0.5 m.")
    found = mend(place, r, "repeated")
    assert np.array_equal(found.place, X) and np.array_equal(found.columns["vertical"], R)
    assert "too many to drop" in refused(np.tile(X[:50], 3), np.tile(R[:50], 3), "repeated")


def test_a_record_of_the_other_way_is_never_turned():
    words = refused(X[::-1], R, *REPAIRS)
    assert (
        words.startswith("place from 99.75 m to 0 m: descends") and "swap left and right" in words
    )


def test_missing_samples():
    r = R.copy()
    r[100:104] = np.nan
    words = refused(X, r)
    assert words.startswith("vertical at 24.75 m: has a gap of 1.25 m.") and '["gap"]' in words
    found = mend(X, r, "gap")
    line = np.interp(X[100:104], X[[99, 104]], R[[99, 104]])
    assert found.columns["vertical"][100:104] == pytest.approx(line, abs=1e-15)
    assert np.array_equal(found.columns["vertical"][:100], R[:100])
    assert found.done == ("gap: 1.25 m at 24.75 m of vertical filled by a straight line",)
    r[100:130] = np.nan
    assert "has a gap of 7.75 m; at most 5 m can be filled" in refused(X, r, "gap")


def test_missing_ends_are_cut_off():
    r = R.copy()
    r[:3], r[-2:] = np.nan, np.nan
    assert refused(X, r).startswith("vertical at 0 m: is missing at an end of the record.")
    r[:3] = R[:3]
    assert refused(X, r).startswith("vertical at 99.75 m: is missing at an end")
    r[:3] = np.nan
    found = mend(X, r, "gap")
    assert np.array_equal(found.place, X[3:-2]) and "5 samples cut off" in found.done[0]
    assert "no sample at which all" in refused(X, np.full(400, np.nan), "gap")


def test_missing_places():
    keep = np.r_[0:100, 104:400]
    words = refused(X[keep], R[keep])
    assert words.startswith("place at 24.75 m: has a gap of 1.25 m.")
    found = mend(X[keep], R[keep], "gap")
    assert found.place == pytest.approx(X, abs=1e-12)
    assert np.array_equal(found.columns["vertical"][104:], R[104:])
    line = np.interp(X[100:104], X[[99, 104]], R[[99, 104]])
    assert found.columns["vertical"][100:104] == pytest.approx(line, abs=1e-15)
    assert mend(np.delete(X, 100), np.delete(R, 100)).done == ()  # one alone is uneven, no gap


def test_steps():
    r = R + np.where(X >= 30.0, 8e-3, 0.0)
    words = refused(X, r)
    assert words.startswith("vertical at 29.75 m: jumps by ") and "at most 5 mm" in words
    assert float(words.split("jumps by ")[1].split()[0]) == pytest.approx(
        8.0 + 1e3 * (R[120] - R[119]), abs=1e-3
    )
    found = mend(X, r, "step")
    # The true change between the neighbours is known from those beside them only.
    assert found.columns["vertical"] == pytest.approx(R, abs=1e-5)
    assert "one of vertical taken out" in found.done[0]
    spike = R.copy()
    spike[200] += 20e-3
    assert mend(X, spike, "step").columns["vertical"] == pytest.approx(R, abs=1e-5)


def test_drift():
    r = R + 4e-4 * X
    rise = 1e3 * np.polyfit(X, r, 1)[0] * X[-1]
    words = refused(X, r)
    assert words.startswith(f"column vertical: drifts by {rise:.4g} mm over 99.75 m, at most 20 mm")
    found = mend(X, r, "drift").columns["vertical"]
    assert np.polyfit(X, found, 1)[0] == pytest.approx(0.0, abs=1e-12)
    assert found.mean() == pytest.approx(r.mean())
    assert mend(X, R + 1e-4 * X).done == ()


def test_words_for_repairs():
    assert checked_repairs("gap step") == ("gap", "step") == checked_repairs(["gap", "step"])
    with pytest.raises(rb.InputError, match="repair = 'gaps': .*Did you mean 'gap'"):
        checked_repairs(["gaps"])
    with pytest.raises(rb.InputError, match="repair = True: must list some of repeated"):
        checked_repairs(True)
