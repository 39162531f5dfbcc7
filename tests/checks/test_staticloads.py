"""Load models and clauses without trains, against statics by hand."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.checks.questions import Questions
from railbridge.checks.staticloads import StaticLoads
from railbridge.checks.structure import Structure

L, M, EI, GJ = 10.0, 1e4, 5e9, 2e9
PHI3 = 2.16 / (np.sqrt(L) - 0.2) + 0.73
MOMENT = 250e3 * (2.5 + 1.7 + 1.7 + 0.9) + 80e3 * (1.3 * 2.6 / 2 + 0.5 * 1.0 / 2)
"""N m: a force at mid-span, two before and one behind, the load per metre beside them."""


def loads(offset=0.0, spans=(L,), damping=0.01, tracks=None, properties=None, **needs):
    beam = rb.Beam("beam", spans, M, EI, **(properties or {}))
    own = Structure(
        beam.deck(6, damping, tracks=tracks), rb.Requirements(**({"line_speed": 50.0} | needs))
    )
    return StaticLoads(own, Questions(own), offset)


def test_the_moment_of_lm71_is_the_one_by_hand():
    (moment,) = loads().moments.values()
    assert moment == pytest.approx(MOMENT, rel=1e-9)
    (heavier,) = loads(alpha=1.21).moments.values()
    assert heavier == pytest.approx(1.21 * MOMENT, rel=1e-9)


def test_continuous_decks_bear_sw0_too():
    spans = (20.0, 20.0)
    for span, moment in loads(spans=spans).moments.items():
        of = loads(spans=spans).structure.deck
        models = [rb.load_model(name).worst(of, "moment_vertical", at=span.middle) for name in
                  ("LM71", "SW/0")]  # fmt: skip
        assert moment == pytest.approx(max(-worst.least.value for worst in models))


def deflection_by_hand(step=0.002):
    """Mid-span deflection under LM71 of a simple beam by trying all places of the pattern."""
    x = np.arange(step / 2, L, step)

    def eta(a):
        a = np.where(a > L / 2, L - a, a)
        return np.where(a < 0, 0.0, a * (3 * L**2 - 4 * a**2) / (48 * EI))

    best = 0.0
    for front in np.arange(0.0, L + 6.4, 0.01):
        free = (x < front - 6.4) | (x > front)
        total = 250e3 * eta(front - np.array([0.8, 2.4, 4.0, 5.6])).sum()
        best = max(best, total + 80e3 * step * eta(x)[free].sum())
    return best


def test_the_deflection_flips_at_its_limit():
    one = loads().deflection()
    assert one.value == pytest.approx(PHI3 * deflection_by_hand(), rel=1e-4)
    assert one.verdict.where == L / 2 and "Phi = 1.459" in one.verdict.when
    assert one.verdict.limit == L / 600
    # It goes with 1 / EI: just stiff enough, and just not.
    for share, verdict in ((1.0 + 1e-6, "met"), (1.0 - 1e-6, "not met")):
        stiff = EI * one.utilisation * share
        deck = rb.Beam("beam", (L,), M, stiff).deck(6, 0.01)
        own = Structure(deck, rb.Requirements(line_speed=50.0))
        assert StaticLoads(own, Questions(own), 0.0).deflection().verdict.verdict == verdict


def test_two_tracks_deflect_twice_as_much():
    tracks = {"left": 2.0, "right": -2.0}
    one, two = (loads(2.0, tracks=tracks, all_tracks=both).deflection() for both in (False, True))
    assert two.value == pytest.approx(2 * one.value)
    assert "1 of 2 tracks" in one.verdict.reason and "2 of 2 tracks" in two.verdict.reason


def test_without_phi_a_deflection_is_never_met():
    undecided = loads(simple=False).deflection()
    assert undecided.verdict.verdict == "cannot decide"
    assert "determinant_length" in undecided.verdict.reason
    assert undecided.value == pytest.approx(loads().deflection().value / PHI3)


def test_the_worst_span_is_told():
    own = loads(spans=(8.0, 12.0), properties={"continuous": False}).deflection()
    assert own.verdict.where == 14.0 and own.verdict.reason.startswith("span 2, 12 m")


def test_overhangs_are_not_judged():
    bearings = {"bearings": (rb.Bearing(0.0), rb.Bearing(8.0))}
    own = loads(properties=bearings, determinant_length=8.0).deflection()
    assert own.verdict.verdict != "met" and "hangs over" in own.verdict.reason


def test_the_twist_of_lm71_is_the_one_by_hand():
    """A couple T at a turns the places before it by T (1 - a / L) x / GJ."""
    e, step = 1.5, 0.002
    own = loads(e, properties={"torsional_stiffness": GJ, "polar_inertia": 4e4})

    def eta(a):
        turned = np.where(a < 3.0, a * (L - 3.0) / L, 3.0 * (1.0 - a / L))
        return np.where((a < 0) | (a > L), 0.0, 1.435 * e / GJ * turned)

    x, best = np.arange(step / 2, L, step), 0.0
    for front in np.arange(0.0, L + 6.4, 0.01):
        free = (x < front - 6.4) | (x > front)
        total = 250e3 * eta(front - np.array([0.8, 2.4, 4.0, 5.6])).sum()
        best = max(best, total + 80e3 * step * eta(x)[free].sum())
    assert own.twist.value == pytest.approx(PHI3 * best, rel=1e-3)
    assert own.twist.where in (0.0, L - 3.0) and not own.twist.missing
    assert loads(0.0, properties={"torsional_stiffness": GJ, "polar_inertia": 4e4}).twist.value < (
        1e-12
    )


@pytest.mark.parametrize(
    ("damping", "needs", "verdict", "said"),
    [
        (0.017, {"kind": "prestressed concrete"}, "met", "lower bound"),  # 1 % + 0.07 % x 10
        (0.0171, {"kind": "prestressed concrete"}, "not met", "lower bound"),
        (0.0171, {"kind": "prestressed concrete", "measured_damping": 0.02}, "met", "measured"),
        (0.0201, {"measured_damping": 0.02}, "not met", "measured"),
        (0.01, {}, "cannot decide", "kind of bridge"),
        (0.01, {"kind": "steel", "simple": False}, "cannot decide", "determinant_length"),
    ],
)
def test_more_damping_than_the_lower_bound_is_not_met(damping, needs, verdict, said):
    found = loads(damping=damping, **needs).damping()
    assert found.verdict.verdict == verdict and said in found.verdict.reason
    assert found.value == pytest.approx(damping)


def test_the_first_lateral_frequency_is_that_of_the_beam():
    stiff = {"bending_stiffness_lateral": EI}
    found = loads(properties=stiff).lateral_frequency()
    assert found.value == pytest.approx(np.pi / (2 * L**2) * np.sqrt(EI / M), rel=1e-4)
    assert found.verdict.verdict == "met"
    rigid = loads().lateral_frequency().verdict
    assert rigid.verdict == "cannot decide" and "rigid sideways" in rigid.reason
