"""What a check must be told, and what is refused."""

import pytest

import railbridge as rb


def test_what_is_left_out_is_on_the_safe_side():
    needs = rb.Requirements(line_speed=50.0)
    assert needs.track == "ballasted"  # the lower limit
    assert not needs.careful_track and needs.comfort == "very good"
    assert needs.kind is None and needs.track_twist is None and needs.measured_damping is None


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"line_speed": 0.0}, r"line_speed.*above 0.*3\.6"),
        ({"line_speed": 300.0}, "line_speed.*at most 200"),
        ({"kind": "stone"}, "kind.*stone"),
        ({"track": "slab"}, "track.*slab"),
        ({"comfort": "fine"}, "comfort.*fine"),
        ({"alpha": 1.2}, "alpha.*one of 0.75.*1.21"),
        ({"simple": 1}, "simple"),
        ({"determinant_length": 0.04}, "determinant_length.*above 0.04"),
        ({"measured_damping": 1.0}, "measured_damping.*at most 0.5"),
        ({"track_twist": 3.0}, "track_twist.*at most 0.1 m"),
        ({"cover": -1.0}, "cover.*at least 0"),
    ],
)
def test_bad_values_are_refused_by_name(given, said):
    with pytest.raises(rb.InputError, match=said):
        rb.Requirements(**({"line_speed": 50.0} | given))
