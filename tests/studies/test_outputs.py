"""What a study is asked for, and what one run answers."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies.outputs import OUTPUTS, outputs_at, peaks_of_run


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
        if output.quantity.startswith("acceleration"):
            history = run.acceleration(output.x)
        elif output.quantity.startswith("displacement"):
            history = run.displacement(output.x)
        elif output.quantity.startswith("rotation"):
            history = run.rotations(output.x)
        else:
            history = run.section_forces(output.x)
        value, time = history.extreme(output.quantity)
        assert peaks.largest[0, i] == abs(value) and peaks.largest_time[0, i] == time
        values = tuple(v for v, _ in history.extremes(output.quantity))
        assert (peaks.low[0, i], peaks.high[0, i]) == values
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
