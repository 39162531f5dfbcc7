"""HSLM: the rule's axles against a chain of spacings, and the totals of the ten trains."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.codes import hslm_a, hslm_b

TABLE_6_3 = """
A1 18 18 2.0 170 | A2 17 19 3.5 200 | A3 16 20 2.0 180 | A4 15 21 3.0 190 | A5 14 22 2.0 170
A6 13 23 2.0 180 | A7 13 24 2.0 190 | A8 12 25 2.5 190 | A9 11 26 2.0 210 | A10 11 27 2.0 210
"""
ROWS = [row.split() for line in TABLE_6_3.strip().splitlines() for row in line.split("|")]
TOTALS = {
    # first to last axle, m; all axles, kN
    "A1": (397.525, 8500), "A2": (398.525, 9600), "A3": (397.525, 8280), "A4": (394.525, 8360),
    "A5": (389.525, 7140), "A6": (382.525, 7200), "A7": (397.525, 7600), "A8": (387.525, 7220),
    "A9": (375.525, 7560), "A10": (388.525, 7560),
}  # fmt: skip


def chained(coaches, length, d):
    """Places from the distances between neighbouring axles, front to back."""
    power, gap = [3.0, 11.0, 3.0], 3.525
    end = [d, length + gap / 2 - gap - 1.5 * d]  # outer bogie, then to the first shared one
    shared = [d, length - d] * coaches + [d]
    spacings = [*power, gap, *end, *shared, *reversed(end), gap, *power]
    return np.concatenate([[0.0], np.cumsum(spacings)])


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_axles_follow_from_the_rule(row):
    name, coaches, length, d, force = row[0], int(row[1]), float(row[2]), float(row[3]), row[4]
    train = hslm_a(name)
    assert train.name == f"HSLM-{name}" and len(train.axles) == 2 * coaches + 14
    assert train.axles == pytest.approx(chained(coaches, length, d), abs=1e-11)
    assert set(train.loads) == {1e3 * float(force)}
    axles = np.array(train.axles)
    assert axles == pytest.approx(train.length - axles[::-1], abs=1e-11)  # it runs both ways
    # The bogies of power cars are 3 m long whatever d is.
    assert axles[[0, 1, 2, 3, 4]] == pytest.approx([0.0, 3.0, 14.0, 17.0, 20.525])
    assert axles[5] - axles[4] == pytest.approx(d)


@pytest.mark.parametrize("name", TOTALS)
def test_totals(name):
    train = hslm_a(name)
    assert (train.length, train.weight / 1e3) == pytest.approx(TOTALS[name], rel=1e-12)


def test_b_is_a_row_of_equal_forces():
    train = rb.hslm_b(12, 3.5)
    assert train.axles == tuple(3.5 * i for i in range(12)) and set(train.loads) == {170e3}
    assert train.name == "HSLM-B, 12 forces at 3.5 m" and rb.hslm_b(n=1, d=2.5).axles == (0.0,)


@pytest.mark.parametrize(
    ("given", "field"), [({}, "n"), ({"d": 3.0}, "n"), ({"n": 10}, "d"), ({"n": 0, "d": 3}, "n")]
)
def test_b_has_no_defaults(given, field):
    with pytest.raises(rb.InputError) as error:
        hslm_b(**given)
    assert error.value.field == field
    if field not in given:
        assert "Figure 6.14 of EN 1991-2" in str(error.value)


def test_another_name_is_refused():
    with pytest.raises(rb.InputError, match="name = 'A11': must be one of A1, A2"):
        hslm_a("A11")
