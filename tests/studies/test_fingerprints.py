"""Equal contents have equal fingerprints, others have not."""

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies.engine import asked_of
from railbridge.studies.fingerprints import fingerprint, print_of_deck
from railbridge.studies.outputs import outputs_at


@dataclass(frozen=True)
class Thing:
    size: float
    label: str = field(default="", compare=False)


def test_the_same_in_other_clothes_is_the_same():
    assert fingerprint(20) == fingerprint(20.0) == fingerprint(np.float64(20.0))
    assert fingerprint([1, 2]) == fingerprint((1.0, 2.0))
    assert fingerprint({"a": 1, "b": 2}) == fingerprint({"b": 2.0, "a": 1.0})
    assert fingerprint(np.array([1, 2])) == fingerprint(np.array([1.0, 2.0]))
    assert fingerprint(Thing(1.0, "A")) == fingerprint(Thing(1, "B")), "names are for people"
    assert len(fingerprint(None)) == 32


def test_anything_else_differs():
    things = [
        None, "", "None", "20", 20, 20.000000000001, True, [20], [[20]], [20, None], {"a": 20},
        {"b": 20}, np.array([20.0]), np.array([[20.0]]), np.array([20j]), Thing(20.0),
        replace(Thing(20.0), size=21.0), ["ab", "c"], ["a", "bc"],
    ]  # fmt: skip
    assert len({fingerprint(thing) for thing in things}) == len(things)
    assert fingerprint(1, 2) != fingerprint(2, 1)


def test_what_it_does_not_understand_is_refused():
    with pytest.raises(TypeError, match="no fingerprint of a set"):
        fingerprint([{1, 2}])


def test_a_deck_that_was_used_is_still_the_same():
    """It keeps lines that were asked for; that must not make another deck of it."""
    deck, other = rb.deck("viaduct36"), rb.deck("viaduct36")
    asked = asked_of(outputs_at(deck, ("displacement_z",), [18.0]))
    before = print_of_deck(deck, asked)
    rb.cross(rb.train("HSLM-A1"), deck, speed=50.0).section_forces(7.0)
    deck.recovery.section("torsion", 3.0)
    assert print_of_deck(deck, asked) == before
    assert print_of_deck(other, asked_of(outputs_at(other, ("displacement_z",), [18.0]))) == before


@pytest.mark.parametrize(
    "changes", [{"deck.modes": 19}, {"deck.damping": {"modal": 0.02}}], ids=["modes", "damping"]
)
def test_another_deck_is_another(changes):
    case = rb.case("paper")
    decks = case.deck, case.replace(changes).deck
    prints = {print_of_deck(d, asked_of(outputs_at(d, ("displacement_z",), [18.0]))) for d in decks}
    assert len(prints) == 2


def test_what_is_asked_counts():
    deck = rb.deck("viaduct36")
    asked = [
        asked_of(outputs_at(deck, ("displacement_z",), [18.0])),
        asked_of(outputs_at(deck, ("displacement_z",), [17.0])),
        asked_of(outputs_at(deck, ("torsion",), [18.0])),
        asked_of(outputs_at(deck, ("displacement_z",), [18.0]), ("iterations",)),
    ]
    assert len({print_of_deck(deck, each) for each in asked}) == 4
