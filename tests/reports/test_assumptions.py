"""What a report says of what was assumed is what was computed."""

from dataclasses import replace

import pytest

import railbridge as rb
from railbridge.reports.assumptions import assumptions, left_out


def said(case, **changes):
    case = case.replace(changes) if changes else case
    return " ".join(assumptions(case.train, case.deck, case.track, case.settings))


@pytest.fixture(scope="module")
def case():
    return rb.case("paper")


def test_the_papers_case(case):
    text = said(case)
    for words in ("20 lowest modes, up to 162.1 Hz", "Rayleigh", "massless", "permanent",
                  "one force and one couple below its middle, all at once", "fixed point",
                  "The track is uneven"):  # fmt: skip
        assert words in text, words
    for words in ("level", "in phase", "Hertz", "spread"):
        assert words not in text, words


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"run.loads": "wheels"}, "Every wheel loads the deck at its own place."),
        ({"run.loads": "bogies"}, "The wheel forces of a bogie"),
        ({"run.interaction": "rigid"}, "what its motion does to the train is left out"),
        ({"run.excitation": "car"}, "All wheels of a car meet the track in phase"),
        ({"run.feedback": "vertical"}, "without its twist"),
        ({"track": None}, "perfectly level"),
        ({"train.vehicle": "xia2000_wheelsets", "run.loads": "wheels"}, "Wheels have mass"),
        (
            {"train.vehicle": "xia2000_wheelsets", "run.loads": "wheels", "run.contact": "hertz"},
            "Hertz's law, and wheels can leave the rail",
        ),
        (
            {"deck.rail": {"bending_stiffness": 1.28e7, "foundation": 1e8}},
            "The rails spread each wheel's load",
        ),
        ({"train": {"name": "HSLM-A1"}, "run.loads": None}, "constant axle loads"),
    ],
)
def test_each_choice_has_its_words(case, changes, words):
    assert words in said(case, **changes)
    assert words not in said(case)


def test_a_deck_of_modes_alone_says_so(case):
    deck = replace(case.deck, recovery=None)
    text = " ".join(assumptions(case.train, deck, case.track, case.settings))
    assert "no section forces and reactions" in text


def test_what_is_left_out_is_said():
    text = " ".join(left_out())
    for words in ("Flanges", "creep", "Braking", "fatigue", "second train"):
        assert words in text
