"""Load models against formulas by hand and against brute force on influence lines known in closed
form."""

import subprocess
import sys

import numpy as np
import pytest

import railbridge as rb
from railbridge.codes import LOAD_MODELS, load_model
from railbridge.codes.loadmodels import LoadModel

FORCES, GROUP = np.array([0.8, 2.4, 4.0, 5.6]), 6.4


def simple(length, **more):
    return rb.Beam("simple", (length,), 1e4, 5e9, **more).deck(4, 0.01)


def mid_span(length):
    """The moment in the middle of a simple span under 1 N, sagging positive."""
    return lambda x: np.where((x < 0) | (x > length), 0.0, np.minimum(x, length - x) / 2)


def over_support(span):
    """The hogging moment over the middle of two equal spans under 1 N, by three moments."""

    def eta(x):
        x = np.where(x > span, 2 * span - x, x)
        return np.where((x < 0) | (x > span), 0.0, x * (span**2 - x**2) / (4 * span**2))

    return eta


def shear_at(place, length):
    """Shear just behind a section of a simple span under 1 N."""

    def eta(x):
        there = np.where(x < place, -x / length, 1.0 - x / length)
        return np.where((x < 0) | (x > length), 0.0, there)

    return eta


def brute(eta, length, lines=(), q=0.0, forces=False, step=0.01, aside=1e-9):
    """Try every place of the pattern, on a grid; loads per metre as sums over cells."""
    x = (np.arange(round(length / step)) + 0.5) * step
    values = eta(x)
    best = 0.0
    for front in np.arange(0.0, length + 60.0, step):
        if forces:  # LM71
            beside = (x < front - GROUP) | (x > front)
            total = q * step * np.maximum(values, 0.0)[beside].sum()
            total += 250e3 * np.maximum(eta(front - FORCES + aside), 0.0).sum()
        else:
            inside = np.zeros(len(x), dtype=bool)
            for a, b in lines:
                inside |= (x > front - b) & (x < front - a)
            total = q * step * values[inside].sum()
        best = max(best, total)
    return best


SW = {"SW/0": (((0, 15), (20.3, 35.3)), 133e3), "SW/2": (((0, 25), (32, 57)), 150e3)}


@pytest.mark.parametrize("length", [10.0, 20.0, 36.0])
def test_lm71_in_the_middle_of_a_span_by_hand(length):
    """The second force in the middle; all four lie on the slopes of one triangle."""
    forces = 250e3 * (length - (1.6 + 1.6 + 3.2) / 2)
    per_metre = 80e3 * ((length / 2 - 2.4) ** 2 + (length / 2 - 4.0) ** 2) / 4
    found = load_model("LM71").worst(simple(length), "moment_vertical", at=length / 2)
    assert found.value == pytest.approx(-(forces + per_metre), rel=1e-9)  # sagging is negative
    assert found.value == found.least.value and found.unit == "N m"
    assert found.largest.value == 0.0 and found.largest.forces == ()
    places = sorted(x for x, _ in found.least.forces)
    assert np.diff(places) == pytest.approx([1.6] * 3)
    assert min(abs(np.array(places) - length / 2)) < 1e-6
    (_, before, q), (behind, _, _) = found.least.stretches
    assert (places[0] - before, behind - places[-1], q) == pytest.approx((0.8, 0.8, 80e3), abs=1e-5)


def test_lm71_at_a_bearing_by_hand():
    length = 20.0
    found = load_model("LM71").worst(simple(length), "force_z", at=0.0)
    forces = 250e3 * (4 * length - 1.6 * 6) / length
    per_metre = 80e3 * (length - 5.6) ** 2 / (2 * length)
    assert found.value == pytest.approx(forces + per_metre, rel=1e-6)


def test_the_unloaded_train_is_a_load_per_metre():
    found = load_model("unloaded train").worst(simple(24.0), "moment_vertical", at=12.0)
    assert found.value == pytest.approx(-10e3 * 24.0**2 / 8, rel=1e-9)
    assert found.least.stretches == (pytest.approx((0.0, 24.0, 10e3)),)


def test_lm71_loads_one_span_where_the_other_relieves():
    deck = rb.Beam("two", (20.0, 20.0), 1e4, 5e9).deck(4, 0.01)
    found = load_model("LM71").worst(deck, "moment_vertical", at=8.0)
    assert max(b for _, b, _ in found.least.stretches) == pytest.approx(20.0)
    assert min(a for a, _, _ in found.largest.stretches) == pytest.approx(20.0)
    line = deck.influence("moment_vertical", at=8.0, places=(np.arange(4000) + 0.5) * 0.01)
    relieved = load_model("unloaded train").worst(deck, "moment_vertical", at=8.0)
    assert relieved.largest.value == pytest.approx(10e3 * 0.01 * -line[line < 0].sum(), rel=1e-4)


@pytest.mark.parametrize("place", [10.0, 6.3])
def test_lm71_shear_leaves_out_forces_that_relieve(place):
    eta, deck = shear_at(place, 20.0), simple(20.0)
    found = load_model("LM71").worst(deck, "shear_vertical", at=place)
    ahead = -deck.influence("shear_vertical", at=place, places=[place + 1.0])[0]
    effects = (found.largest.value, found.least.value)
    same, other = effects if ahead > 0.0 else effects[::-1]
    expected = brute(eta, 20.0, q=80e3, forces=True)
    relieving = brute(lambda x: -eta(x), 20.0, q=80e3, forces=True, aside=-1e-9)
    assert (abs(same), abs(other)) == pytest.approx((expected, relieving), rel=5e-4)


@pytest.mark.parametrize("place", [10.0, 6.3])
def test_lm71_shear_by_hand_with_the_first_force_just_beyond_the_section(place):
    length = 20.0
    found = load_model("LM71").worst(simple(length), "shear_vertical", at=place)
    forces = 250e3 * sum(1.0 - (place + 1.6 * k) / length for k in range(4))
    per_metre = 80e3 * max(length - place - 5.6, 0.0) ** 2 / (2 * length)
    assert abs(found.value) == pytest.approx(forces + per_metre, rel=1e-7)


def test_lm71_on_short_spans_leaves_out_forces_that_relieve():
    """The group is longer than a span, so some of its forces stand where they relieve."""
    deck = rb.Beam("short", (4.0, 4.0, 4.0), 1e4, 5e9).deck(4, 0.01)
    x = (np.arange(12_000) + 0.5) * 1e-3

    def eta(places):
        return -deck.influence("moment_vertical", at=2.0, places=places)

    values = eta(x)
    for sign in (-1.0, 1.0):
        positive = np.maximum(sign * values, 0.0)
        fronts = np.arange(0.0, 18.4, 0.01)
        expected = max(
            250e3 * np.maximum(sign * eta(front - FORCES), 0.0).sum()
            + 80e3 * 1e-3 * positive[(x < front - GROUP) | (x > front)].sum()
            for front in fronts
        )
        found = load_model("LM71").worst(deck, "moment_vertical", at=2.0)
        effect = found.largest if sign > 0.0 else found.least
        assert effect.value == pytest.approx(sign * expected, rel=1e-3)
        assert 0 < len(effect.forces) < 4


def test_the_worst_place_is_found_between_the_steps_of_the_search():
    deck = rb.Beam("two", (6.0, 9.0), 1e4, 5e9).deck(4, 0.01)
    lone = LoadModel("one force", places=(0.0,), force=1e5, span=1e-9)
    found = lone.worst(deck, "displacement_z", at=4.0).least
    ((place, force),) = found.forces
    slope = deck.influence("displacement_z", at=4.0, places=[place], derivative=1)[0]
    curvature = deck.influence("displacement_z", at=4.0, places=[place], derivative=2)[0]
    assert abs(slope / curvature) < 1e-5 and force == 1e5  # m from the very top


def test_rounding_of_an_influence_line_is_no_effect():
    row = rb.Beam("row", (20.0, 30.0), 1e4, 5e9, continuous=False).deck(6, 0.01)
    three = rb.Beam("three", (20.0, 30.0, 17.3), 1e4, 5e9).deck(6, 0.01)
    for deck, at in ((three, 0.0), (rb.deck("viaduct36"), 0.0), (row, 0.0), (row, 50.0)):
        for name in LOAD_MODELS:
            found = load_model(name).worst(deck, "moment_vertical", at=at)
            assert (found.value, found.least.stretches, found.largest.forces) == (0.0, (), ())
    # The other span of a row of simple spans does nothing.
    found = load_model("LM71").worst(row, "moment_vertical", at=35.0)
    assert found.largest.value == 0.0 and found.least.stretches[0][0] == pytest.approx(20.0)


@pytest.mark.parametrize("name", SW)
@pytest.mark.parametrize("span", [12.0, 30.0])
def test_sw_on_one_span_and_over_a_support(name, span):
    lines, q = SW[name]
    mid = load_model(name).worst(simple(span), "moment_vertical", at=span / 2)
    assert mid.value == pytest.approx(-brute(mid_span(span), span, lines, q), rel=2e-3)
    deck = rb.Beam("two", (span, span), 1e4, 5e9).deck(4, 0.01)
    hogging = load_model(name).worst(deck, "moment_vertical", at=span)
    expected = brute(over_support(span), 2 * span, lines, q)
    assert hogging.value == pytest.approx(expected, rel=2e-3)


def test_sw_stands_whole_whether_it_relieves_or_not():
    deck = rb.Beam("two", (20.0, 20.0), 1e4, 5e9).deck(4, 0.01)
    found = load_model("SW/0").worst(deck, "moment_vertical", at=8.0).least
    lengths = [b - a for a, b, _ in found.stretches]
    assert len(lengths) <= 2 and max(lengths) <= 15.0 + 1e-9
    along = (np.arange(4000) + 0.5) * 0.01
    line = -deck.influence("moment_vertical", at=8.0, places=along)
    total = sum(q * 0.01 * line[(along > a) & (along < b)].sum() for a, b, q in found.stretches)
    assert found.value == pytest.approx(total, rel=2e-3)


def test_what_is_reported_to_stand_there_gives_the_value():
    deck = rb.Beam("three", (20.0, 30.0, 20.0), 1e4, 5e9).deck(4, 0.01)
    along = (np.arange(70_000) + 0.5) * 0.001
    for quantity, at in (("displacement_z", 35.0), ("moment_vertical", 20.0), ("force_z", 50.0)):
        line = -deck.influence(quantity, at=at, places=along)
        for name in LOAD_MODELS:
            found = load_model(name).worst(deck, quantity, at=at)
            for effect in (found.least, found.largest):
                total = sum(p * np.interp(x, along, line) for x, p in effect.forces)
                for a, b, q in effect.stretches:
                    total += q * 0.001 * line[(along > a) & (along < b)].sum()
                assert effect.value == pytest.approx(total, rel=1e-3), (quantity, name)


def test_alpha_multiplies_lm71_and_sw0_only():
    deck = simple(20.0)
    for name in ("LM71", "SW/0"):
        one, more = (load_model(name, a).worst(deck, "moment_vertical", at=9.0) for a in (1, 1.21))
        assert more.value == pytest.approx(1.21 * one.value)
        assert [q for _, _, q in more.least.stretches] == pytest.approx(
            [1.21 * q for _, _, q in one.least.stretches]
        )
    for name in ("SW/2", "unloaded train"):
        with pytest.raises(rb.InputError, match="alpha = 1.21: must be 1"):
            load_model(name, 1.21)
    with pytest.raises(rb.InputError, match=r"alpha = 1\.2: must be one of 0\.75, 0\.83"):
        load_model("LM71", 1.2)


def test_a_track_beside_the_axis_twists():
    deck = simple(20.0, torsional_stiffness=4e9, polar_inertia=5e4)
    beside = [load_model("LM71").worst(deck, "torsion", at=5.0, track=y) for y in (0.0, 1.0, 2.0)]
    assert beside[0].value == 0.0 and beside[0].least.forces == ()
    assert beside[2].value == pytest.approx(2 * beside[1].value) != 0.0
    named = rb.load_model("LM71").worst(rb.deck("viaduct36"), "torsion", at=9.0, track="left")
    assert abs(named.value) > 1e5


def test_a_model_of_ones_own_keeps_its_loads_inside_its_pattern():
    own = LoadModel("mine", places=(0.0, 2.0), force=1e5, span=2.0)
    found = own.worst(simple(20.0), "moment_vertical", at=10.0)
    assert found.value == pytest.approx(-1e5 * (20.0 / 4 + 20.0 / 4 - 1.0), rel=1e-6)
    for wrong in ({"places": (0.0, 2.0)}, {"stretches": ((0.0, 3.0),), "span": 2.0}):
        with pytest.raises(rb.InputError, match="span = .*: must reach to"):
            LoadModel("mine", **wrong)
    with pytest.raises(rb.InputError, match="stretches"):
        LoadModel("mine", stretches=(3.0,), span=9.0)


def test_refusals_and_tables():
    assert isinstance(rb.load_model("LM71"), LoadModel) and rb.LoadModel is LoadModel
    with pytest.raises(rb.InputError, match="Did you mean 'LM71'"):
        load_model("LM72")
    with pytest.raises(rb.InputError, match="deck = 5: must be a Deck"):
        load_model("LM71").worst(5, "moment_vertical", at=1.0)
    with pytest.raises(rb.InputError, match="at = 21"):
        load_model("LM71").worst(simple(20.0), "moment_vertical", at=21.0)
    frame = load_model("LM71").worst(simple(20.0), "moment_vertical", at=10.0).to_frame()
    assert list(frame.index) == ["least", "largest"] and "moment_vertical (N m)" in frame


def test_the_room_opens_without_pandas_and_pydantic():
    code = (
        "import sys, railbridge as rb; rb.load_model('LM71'); rb.hslm_b(3, 3.0); "
        "print([m for m in ('pandas', 'pydantic', 'matplotlib') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr
