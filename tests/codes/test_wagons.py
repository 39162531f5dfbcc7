"""Reference wagons of EN 15528 against the table, typed in a second time."""

import pytest

import railbridge as rb
from railbridge.codes import LINE_CATEGORIES, wagon_train

TABLE_A_1 = """
A 16 [1.8 6.20 1.8] 12.8
B1 18 [1.8 7.80 1.8] 14.4
B2 18 [1.8 4.65 1.8] 11.25
C2 20 [1.8 5.90 1.8] 12.5
C3 20 [1.8 4.50 1.8] 11.1
C4 20 [1.8 3.40 1.8] 10.0
D2 22.5 [1.8 7.45 1.8] 14.05
D3 22.5 [1.8 5.90 1.8] 12.5
D4 22.5 [1.8 4.65 1.8] 11.25
D5 22.5 [1.8 3.62 1.8] 10.22
E4 25 [1.8 5.90 1.8] 12.5
E5 25 [1.8 4.75 1.8] 11.35
"""
ROWS = [row.replace("[", "").replace("]", "").split() for row in TABLE_A_1.strip().splitlines()]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_a_train_repeats_its_wagon(row):
    name, (mass, first, inner, last, length) = row[0], map(float, row[1:])
    train = wagon_train(name, 3)
    wagon = [0.0, first, first + inner, first + inner + last]
    assert train.axles == pytest.approx([i * length + x for i in range(3) for x in wagon])
    assert train.loads == pytest.approx([mass * 9810.0] * 12)
    assert length == pytest.approx(sum((first, inner, last)) + 2 * 1.5)


def test_every_category_is_there_and_twenty_wagons_are_usual():
    assert list(LINE_CATEGORIES) == [row[0] for row in ROWS]
    assert len(wagon_train("D4").axles) == 80 and wagon_train("D4").name == "D4, 20 wagons"
    assert wagon_train("A", 1).name == "A, 1 wagon"


@pytest.mark.parametrize("wagons", [0, 1001, 2.5, "20", True, None])
def test_a_number_of_wagons_that_cannot_be_is_refused(wagons):
    with pytest.raises(
        rb.InputError, match=r"^wagons\b.*whole|^wagons\b.*at least 1 and at most 1000"
    ):
        wagon_train("D4", wagons)
