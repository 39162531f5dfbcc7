"""Fingerprints: equal contents, equal texts; another content, another one."""

import numpy as np
import pytest

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


def test_another_version_of_the_program_is_another_crossing(monkeypatch):
    from railbridge.studies import fingerprints

    parts = "deck", "train", "track", None
    now = fingerprints.print_of_crossing(*parts)
    monkeypatch.setattr(fingerprints, "_program", lambda: "99.0")
    assert fingerprints.print_of_crossing(*parts) != now
