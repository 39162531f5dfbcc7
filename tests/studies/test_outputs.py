"""What a study is asked for, and what one run answers."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies.outputs import OUTPUTS, outputs_at, peaks_of_run, twist_at


@pytest.fixture(scope="module")
def run():
    case = rb.case("paper").replace({"train.cars": 1, "run.loads": "wheels", "run.iterations": 2})
    return case.compute()


def test_peaks_are_those_of_the_histories(run):
    outputs = outputs_at(run.deck, tuple(OUTPUTS), [18.0, 7.0])
    names = [(o.quantity, o.x) for o in outputs[:2]]
    assert names == [("displacement_y", 18.0), ("displacement_z", 18.0)]
    peaks = peaks_of_run(run, outputs)
    for i, output in enumerate(outputs):
        if output.quantity == "twist":
            left, right = (run.displacement(x)["rotation_x"] for x in (output.x, output.x + 3.0))
            twist = {"twist": 1.435 * (right - left)}
            history = rb.History(run.time, twist, {"twist": "m"})
        elif output.quantity.startswith("acceleration"):
            history = run.acceleration(output.x)
        elif output.quantity.startswith(("displacement", "rotation")):
            history = run.displacement(output.x)
        else:
            history = run.section_forces(output.x)
        value, time = history.extreme(output.quantity)
        assert peaks.largest[0, i] == pytest.approx(abs(value), rel=1e-11)
        assert peaks.largest_time[0, i] == time
        values = tuple(v for v, _ in history.extremes(output.quantity))
        assert (peaks.low[0, i], peaks.high[0, i]) == pytest.approx(values, rel=1e-11)
    statics = np.isnan(peaks.static[0])
    assert [o.is_acceleration for o in outputs] == statics.tolist()


@pytest.mark.parametrize(
    ("quantities", "points", "said"),
    [
        (("displacment_z",), [18.0], r"Did you mean 'displacement_z'"),
        ((), [18.0], "at least one quantity"),
        (("torsion", "torsion"), [18.0], "named twice"),
        (("torsion",), [40.0], r"points.*at most 36"),
        (("torsion",), [], "points"),
    ],
)
def test_what_cannot_be_asked(run, quantities, points, said):
    with pytest.raises(rb.InputError, match=said):
        outputs_at(run.deck, quantities, points)


def test_what_a_deck_cannot_tell_is_refused_in_words():
    plain = rb.Beam("plain", (20.0,), 1e4, 1e10).deck(modes=2)
    with pytest.raises(rb.InputError, match="torsion.*no such stiffness.*Leave it out"):
        outputs_at(plain, ("torsion",), [10.0])
    with pytest.raises(rb.InputError, match="acceleration_y.*does not move that way"):
        outputs_at(plain, ("acceleration_y",), [10.0])
    assert outputs_at(plain, "displacement_z", [10.0])[0].quantity == "displacement_z"


def test_twist_goes_across_the_ends_of_a_deck(run):
    deck = run.deck
    inner, before, behind = (twist_at(deck, x).line for x in (10.0, -2.0, 35.0))
    turned = {x: deck.recovery.section("rotation_x", x).modal for x in (10.0, 13.0, 1.0, 35.0)}
    assert inner.modal == pytest.approx(1.435 * (turned[13.0] - turned[10.0]))
    assert before.modal == pytest.approx(1.435 * turned[1.0])
    assert behind.modal == pytest.approx(-1.435 * turned[35.0])
    with pytest.raises(rb.InputError):
        twist_at(deck, -3.1)
    plain = rb.Beam("plain", (20.0,), 1e4, 1e10).deck(modes=2)
    with pytest.raises(rb.InputError, match="rigid in twist.*Leave it out"):
        outputs_at(plain, ("twist",), [10.0])
