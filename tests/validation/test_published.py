"""What the paper prints, typed in a second time: tables row by row, as they stand there."""

from railbridge.validation import published

TABLE_2 = """
1 3.307 0.645
2 10.46 1.215
3 10.56 1.230
4 14.97 1.334
5 16.30 1.667
6 16.73 9.044
7 17.41 9.055
8 17.67 11.72
9 18.16 11.72
10 18.48 15.48
11 18.83 15.48
12 20.00 21.96
13 21.60 21.96
14 21.97 24.99
15 22.62 24.99
"""
TABLE_3 = "1.934 1.934 / 1.883 -0.051 / 1.911 0.028 / 1.911 -0.001"
TABLE_4 = """
Torsion moment: -1222.52 -1256.62
Horizontal bending moment: -64.04 -64.04
Vertical bending moment: -24912.90 -24831.80
Vertical displacement: -38.13 -38.01
Y-reaction in node 1: 7.83 7.83
Y-reaction in node 2: -8.80 -8.80
Z-reaction in node 1: 2851.86 2857.16
Z-reaction in node 2: 2884.38 2890.30
"""


def test_table_2_has_fifteen_frequencies_of_the_deck_and_of_the_vehicle():
    rows = [tuple(map(float, line.split())) for line in TABLE_2.strip().splitlines()]
    assert [deck for _, deck, _ in rows] == list(published.TABLE2_DECK)
    assert [vehicle for _, _, vehicle in rows] == list(published.TABLE2_VEHICLE)


def test_table_3_has_two_deviations_for_each_of_four_iterations():
    pairs = [tuple(map(float, part.split())) for part in TABLE_3.split("/")]
    assert tuple(a for a, _ in pairs) == published.TABLE3["from_rigid"]
    assert tuple(b for _, b in pairs) == published.TABLE3["from_previous"]


def test_table_4_has_the_first_and_the_last_iteration():
    rows = [line.split(": ") for line in TABLE_4.strip().splitlines()]
    printed = {name: tuple(map(float, values.split())) for name, values in rows}
    assert {name: row[1:] for name, row in published.TABLE4.items()} == printed
    units = {name.split()[-1 if "moment" in name or "disp" in name else 0]: row[0]
             for name, row in published.TABLE4.items()}  # fmt: skip
    assert units == {"moment": "kN m", "displacement": "mm", "Y-reaction": "kN", "Z-reaction": "kN"}


def test_what_the_text_says():
    assert published.FORCING == {5.0: 1.33, 11.7: 3.31}
    assert published.DAMPING == (0.03, (3.307, 16.30))
    assert (published.SPEED, published.SPAN) == (20.0, 36.0)
