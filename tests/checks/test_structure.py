"""A deck as the clauses see it."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.checks.structure import Structure


def structure(deck, **more):
    return Structure(deck, rb.Requirements(**({"line_speed": 50.0} | more)))


def beam(spans, **more):
    return rb.Beam("beam", spans, 1e4, 2e10, **more).deck(8, 0.01)


def modes_only(supports):
    deck = beam((20.0,))
    return rb.Deck(
        name="modes", length=20.0, shapes=deck.shapes, frequencies_hz=deck.frequencies_hz,
        damping_ratios=deck.damping_ratios, mode_names=deck.mode_names, supports=supports,
    )  # fmt: skip


def test_simple_spans_in_a_row_are_told_from_one_that_runs_through():
    row, through = structure(beam((20.0, 30.0), continuous=False)), structure(beam((20.0, 30.0)))
    assert [(s.number, s.start, s.end) for s in row.spans] == [(1, 0.0, 20.0), (2, 20.0, 50.0)]
    assert row.continuous is False and row.simple and row.longest.number == 2
    assert through.continuous is True and not through.simple
    assert float(row.length_of(row.spans[0])) == 20.0
    # 1.2 times the mean of two spans; the longest is 30 m.
    assert float(through.length_of(through.spans[0])) == pytest.approx(30.0)
    assert float(structure(beam((30.0, 30.0))).length_of(row.spans[0])) == pytest.approx(36.0)


def test_bearing_lines_of_a_pier_make_no_span():
    bearings = tuple(rb.Bearing(x, ("y", "z", "roll")) for x in (19.5, 20.5, 40.0))
    own = structure(beam((20.0, 20.0), bearings=(rb.Bearing(0.0), *bearings)))
    assert [(s.number, s.start, s.end) for s in own.spans] == [(1, 0.0, 19.5), (2, 20.5, 40.0)]


def test_an_overhang_makes_no_simple_structure():
    own = structure(beam((26.0,), bearings=(rb.Bearing(0.0), rb.Bearing(20.0))))
    assert own.overhangs and not own.simple and len(own.spans) == 1
    assert "determinant_length" in own.length_of(own.longest).reason


def test_the_determinant_length_that_is_given_counts():
    skew = structure(beam((20.0,)), simple=False)
    assert "not a simple one" in skew.length_of(skew.longest).reason
    assert skew.phi_of(skew.longest).value is None
    own = structure(beam((20.0,)), simple=False, determinant_length=20.0)
    assert float(own.phi_of(own.longest)) == pytest.approx(2.16 / (np.sqrt(20.0) - 0.2) + 0.73)


def test_phi_goes_by_the_track_and_the_cover():
    careful, covered = {"careful_track": True}, {"cover": 2.5}
    own = structure(beam((10.0,)), **careful)
    assert float(own.phi_of(own.longest)) == pytest.approx(1.3061, abs=1e-4)
    own = structure(beam((10.0,)), **covered)
    assert float(own.phi_of(own.longest)) == pytest.approx(1.4592 - 0.15, abs=1e-4)


def test_what_modes_alone_do_not_tell():
    own = structure(modes_only(()))
    assert own.spans == () and own.longest is None
    assert "no lines of bearings" in own.length_of(None).reason
    two = structure(modes_only((0.0, 10.0, 20.0)))
    assert two.continuous is None and not two.simple
    assert "only modes" in two.length_of(two.spans[0]).reason
    assert structure(modes_only((0.0, 20.0))).simple


def test_first_frequencies_are_those_of_their_direction():
    own = structure(rb.deck("viaduct36"))
    names = own.deck.mode_names
    assert names[own.first_vertical] == "vertical bending 1"
    assert names[own.first_lateral] == "lateral bending 1"
    assert own.n0 == pytest.approx(3.307, abs=1e-3)
    assert structure(beam((20.0,))).first_lateral is None


def test_each_of_unlike_spans_in_a_row_has_its_own_first_frequency():
    own = structure(rb.Beam("row", (20.0, 16.0, 20.0), 1e4, 2e10, continuous=False).deck(9, 0.01))
    expected = [np.pi / (2 * length**2) * np.sqrt(2e10 / 1e4) for length in (20.0, 16.0, 20.0)]
    assert [own.n0_of(span) for span in own.spans] == pytest.approx(expected, rel=1e-5)
    few = structure(rb.Beam("row", (20.0, 8.0), 1e4, 2e10, continuous=False).deck(2, 0.01))
    assert few.n0_of(few.spans[1]) is None
    runs = structure(rb.Beam("on", (20.0, 16.0), 1e4, 2e10).deck(6, 0.01))
    assert [runs.n0_of(span) for span in runs.spans] == [runs.n0] * 2
