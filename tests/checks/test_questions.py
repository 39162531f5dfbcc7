"""What is asked of a crossing, against statics by hand."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.checks.questions import Questions
from railbridge.checks.structure import Structure

L, EI, GJ = 20.0, 2e10, 3e9


def questions(modes=10, **more):
    known = {
        "bending_stiffness_lateral": EI, "torsional_stiffness": GJ, "polar_inertia": 4e4,
    } | more  # fmt: skip
    deck = rb.Beam("beam", (L,), 1e4, 1e10, **known).deck(modes, 0.01)
    return Questions(Structure(deck, rb.Requirements(line_speed=50.0)))


def test_ends_turn_as_a_beam_does_under_a_force_in_the_middle():
    first, last = questions().end_rotations
    turned = [o.line.influence(np.array([L / 2]))[0, 0, 0] for o in (first, last)]
    # F L^2 / (16 E I)
    assert turned == pytest.approx([L**2 / 16 / EI, -(L**2) / 16 / EI], rel=1e-9)


def test_the_bow_is_the_deflection_against_the_chord():
    ((span, bow),) = questions().bows
    assert span.length == L
    assert bow.line.influence(np.array([L / 2]))[0, 0, 0] == pytest.approx(L**3 / 48 / EI)


def test_only_the_modes_that_count_make_accelerations():
    own = questions()
    kept = len(own.kept.numbers)
    assert 0 < kept < 10 and own.kept.complete
    for output in own.accelerations[1:-1]:
        assert not np.any(output.modal[kept:])
    assert np.any(own.accelerations[20].modal[:kept])


def test_a_deck_of_few_modes_has_all_of_them():
    own = questions(modes=2)
    assert not own.kept.limit.decided
    assert len(own.accelerations) == 41


def test_twist_is_asked_across_the_ends_of_the_deck_too():
    places = [output.x for output in questions().twists]
    assert {-3.0, 0.0, L - 3.0, L} <= set(places) and min(places) == -3.0
    rigid = questions(torsional_stiffness=None, polar_inertia=None)
    assert rigid.twists == ()


def test_every_output_knows_its_number():
    own = questions()
    for i, output in enumerate(own.asked.outputs):
        assert own.number_of[id(output)] == i
    assert own.asked.outputs == tuple(sorted(own.asked.outputs, key=lambda o: o.x))
    watched = {own.asked.outputs[i].quantity for i in own.watched}
    assert watched == {"acceleration_z", "displacement_z", "moment_vertical"}
    shown = own.shown
    which = own.columns(shown)
    assert len(which) == shown.width and "rotation_z" not in {o.quantity for o in shown.outputs}


def test_a_force_at_the_tip_of_an_overhang_lifts_the_other_end():
    """Lines at 0 and 20 m under 26 m: P at the tip takes 6 / 20, the weight gives 7 / 20."""
    bearings = (rb.Bearing(0.0), rb.Bearing(20.0, ("y", "z", "roll")))
    deck = rb.Beam("overhang", (26.0,), 1e4, 1e10, bearings=bearings).deck(4, 0.01)
    own = Questions(Structure(deck, rb.Requirements(line_speed=50.0)))
    first, second = own.bearings
    assert first.words == "bearing 1 at x = 0, y = 0 m"
    assert first.output.line.influence(np.array([26.0]))[0, 0, 1] == pytest.approx(6 / 20)
    assert first.self_weight == pytest.approx(1e4 * 9.80665 * 26 * 7 / 20, rel=1e-3)
    assert not first.hides, "a deck that is rigid in twist has no couple to hold"
    assert second.self_weight == pytest.approx(1e4 * 9.80665 * 26 * 13 / 20, rel=1e-3)


def test_what_holds_the_twist_beside_single_bearings_hides_them():
    pads = tuple(rb.Bearing(x, ("y", "z"), y=y) for x in (0.0, L) for y in (-2.0, 2.0))
    assert [b.hides for b in questions(bearings=pads).bearings] == [False] * 4
    held = (*pads, rb.Bearing(L, ("roll",)))
    found = questions(bearings=held).bearings
    assert [b.words[:9] for b in found] == [f"bearing {n}" for n in (1, 2, 3, 4)]
    assert [b.hides for b in found] == [False, False, True, True]
    assert [b.hides for b in questions().bearings] == [True, True]
