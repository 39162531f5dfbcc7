"""Which modes count in a deck's accelerations."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.cautions import notices
from railbridge.cutoffs import counted, different, en1990_limit
from railbridge.errors import ResultWarning
from railbridge.settings import check

LOAD = rb.AxleTrain([0.0, 3.0], [1e5, 2e5])


def beam(spans=(20.0,), stiffness=8e9):
    return rb.Beam("spans", spans, 1e4, stiffness)


@pytest.mark.parametrize(
    ("frequencies", "known"),
    [
        ([], []),
        ([3.0], [3.0]),
        ([3.0, 3.0, 3.0], [3.0]),
        ([3.0, 3.00002, 3.00004, 4.0], [3.00004, 4.0]),  # each equals the one before it
        ([3.0, 3.0001], [3.0, 3.0001]),
        ([9.0, 3.0, 9.0], [3.0, 9.0]),
    ],
)
def test_of_equal_frequencies_the_highest_counts(frequencies, known):
    assert different(frequencies).tolist() == known


@pytest.mark.parametrize(
    ("frequencies", "limit"),
    [
        ([3.3, 5.0, 13.2], 30.0),
        ([21.0, 22.0, 23.0], 31.5),
        ([8.0, 20.0, 45.0, 45.0002], 45.0002),  # the limit does not cut a group
        ([8.0, 8.0, 8.0, 20.0, 20.0, 20.0, 45.0], 45.0),
        ([8.0, 8.0, 8.0, 20.0], None),
        ([8.0, 20.0], None),
        ([], None),
    ],
)
def test_the_limit_is_the_largest_of_three(frequencies, limit):
    assert en1990_limit(frequencies) == limit


def test_a_mode_on_the_limit_counts():
    assert counted([1.0, 30.0, 30.0002, 30.001], 30.0).tolist() == [True, True, True, False]
    assert counted([1.0, 1e9], np.inf).all()


def test_the_viaduct_keeps_what_lies_below_thirty_hertz():
    deck = rb.deck("viaduct36")
    assert deck.frequencies_hz[0] == pytest.approx(3.307, abs=5e-4)
    run = rb.cross(LOAD, deck, speed=20.0, time_step=2e-3, acceleration_modes="en1990")
    assert run.settings.accelerations_up_to_hz == 30.0
    assert run.acceleration_modes.tolist() == (deck.frequencies_hz <= 30.0).tolist()
    assert 0 < run.acceleration_modes.sum() < len(deck.frequencies_hz)
    told = rb.summarize(run, [18.0])["run"]["acceleration_modes"]
    kept = int((deck.frequencies_hz <= 30.0).sum())
    assert told == {"up_to_hz": 30.0, "kept": kept, "of": len(deck.frequencies_hz)}


def test_all_modes_count_if_nothing_is_said():
    run = rb.cross(LOAD, beam().deck(4), speed=20.0, time_step=2e-3)
    assert run.acceleration_modes.all() and run.settings.acceleration_modes == "all"
    told = rb.summarize(run, [10.0])["run"]["acceleration_modes"]
    assert told == {"up_to_hz": None, "kept": 4, "of": 4}


def test_accelerations_are_those_of_a_deck_with_fewer_modes_and_nothing_else_changes():
    """Constant loads move each mode for itself: the first three of six are a deck of three."""
    whole, few = beam().deck(6, 0.02), beam().deck(3, 0.02)
    same = {"speed": 40.0, "time_step": 5e-4}
    limit = float(few.frequencies_hz[2])
    run = rb.cross(LOAD, whole, **same, acceleration_modes=limit)
    plain, known = rb.cross(LOAD, whole, **same), rb.cross(LOAD, few, **same)
    ours, theirs = (r.acceleration(7.0)["acceleration_z"] for r in (run, known))
    size = np.abs(theirs).max()
    assert ours == pytest.approx(theirs, abs=1e-9 * size)
    assert np.abs(plain.acceleration(7.0)["acceleration_z"] - theirs).max() > 0.1 * size
    places = [0.0, 7.0, 13.0]
    ours, theirs = (r.envelope("acceleration_z", places).values for r in (run, known))
    assert ours == pytest.approx(theirs, abs=1e-9 * size)
    for ask in (
        lambda r: r.displacement(7.0)["displacement_z"],
        lambda r: r.velocity(7.0)["velocity_z"],
        lambda r: r.rotations(7.0)["rotation_y"],
        lambda r: r.section_forces(7.0)["moment_vertical"],
    ):
        assert np.array_equal(ask(run), ask(plain))
    assert run.settings.time_step == plain.settings.time_step


def test_the_train_feels_all_modes():
    case = rb.case("paper").replace({"train.cars": 1, "run.time_step": 2e-3, "run.iterations": 2})
    run, plain = (case.replace({"run.acceleration_modes": m}).run() for m in (6.0, "all"))
    assert np.array_equal(run.wheel_forces, plain.wheel_forces)
    assert np.array_equal(run.body_accelerations, plain.body_accelerations)
    own = plain.state
    moved = plain.deck.acceleration(own.q, own.velocity, own.modal_force)
    kept = plain.deck.frequencies_hz <= 6.0
    shape = plain.deck.shapes(np.array([18.0]))[0, :, 1]
    expected = shape[kept] @ moved[kept]
    found = run.acceleration(18.0)["acceleration_z"]
    assert found == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


def test_of_three_equal_spans_the_third_frequency_is_that_of_the_third_shape():
    """f, 4 f, 9 f of a simple span, each three times: three of them are no third frequency."""
    row = rb.Beam("row", (20.0,) * 3, 1e4, 8e9, continuous=False)
    one = np.pi / 2 / 20.0**2 * np.sqrt(8e9 / 1e4)
    same = {"speed": 40.0, "time_step": 1e-3, "acceleration_modes": "en1990"}
    run = rb.cross(LOAD, row.deck(12), **same)
    assert run.settings.accelerations_up_to_hz == pytest.approx(9 * one, rel=1e-3)
    assert 9 * one > 30.0 and run.acceleration_modes.tolist() == [True] * 9 + [False] * 3
    with pytest.raises(rb.InputError, match="of its 6 modes only 2 differ in frequency"):
        rb.cross(LOAD, row.deck(6), **same)


def test_too_few_frequencies_are_refused_with_the_way_out():
    refused = r"^acceleration_modes = 'en1990'.*2 modes only 2 differ.*more modes, or .* in Hz"
    with pytest.raises(rb.InputError, match=refused):
        rb.cross(LOAD, beam().deck(2), speed=20.0, acceleration_modes="en1990")
    with pytest.raises(rb.InputError, match=r"^run\.acceleration_modes = 1\.0: leaves no mode"):
        rb.case("paper").replace({"run.acceleration_modes": 1.0})


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ("EN1990", "Did you mean 'en1990'"),
        (0.0, "above 0 Hz"),
        (-30.0, "above 0 Hz"),
        (np.nan, "finite"),
        (True, "must be"),
        (None, "must be"),
        ([30.0], "must be"),
        (1e-3, "leaves no mode: the first has"),
    ],
)
def test_what_no_mode_can_be_chosen_by(wrong, said):
    with pytest.raises(rb.InputError, match=f"^acceleration_modes.*{said}"):
        rb.cross(LOAD, beam().deck(4), speed=20.0, acceleration_modes=wrong)


def remarked(deck, chosen):
    track = rb.Track()
    settings = check(LOAD, deck, track, speed=20.0, time_step=2e-3, acceleration_modes=chosen)
    found = notices.remarks_before(LOAD, deck, track, settings)
    return [remark for remark in found if remark.field == "acceleration_modes"]


def test_a_deck_whose_modes_end_below_the_limit_is_told_of():
    short = beam(stiffness=1e9).deck(3)
    assert short.frequencies_hz[-1] < 30.0
    (remark,) = remarked(short, "en1990")
    assert isinstance(remark, ResultWarning)
    assert "up to 30 Hz" in str(remark) and "has only 3, up to" in str(remark)
    assert "deck.modes" in str(remark)
    assert not remarked(short, "all")
    last = float(short.frequencies_hz[-1])
    assert not remarked(short, last) and remarked(short, last * (1 + 1e-4))
    with pytest.warns(ResultWarning, match="acceleration_modes = en1990: modes up to 30 Hz"):
        run = rb.cross(LOAD, short, speed=20.0, acceleration_modes="en1990")
    assert run.acceleration_modes.all()  # what is there counts


def test_modes_in_any_order_are_counted_by_frequency():
    deck = beam().deck(3)
    turned = replace(
        deck,
        frequencies_hz=deck.frequencies_hz[::-1],
        shapes=replace(deck.shapes, coefficients=deck.shapes.coefficients[:, :, ::-1]),
        recovery=None,
    )
    limit = float(deck.frequencies_hz[1])
    same = {"speed": 30.0, "time_step": 1e-3, "acceleration_modes": limit}
    ours, theirs = (
        rb.cross(LOAD, d, **same).acceleration(8.0)["acceleration_z"] for d in (turned, deck)
    )
    assert ours == pytest.approx(theirs, abs=1e-9 * np.abs(theirs).max())
