"""Units: each declared once, and numbers converted to SI."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from railbridge import units
from railbridge.errors import InputError

EXAMPLES = [
    ("kN", "N", 1e3), ("mm", "m", 1e-3), ("km/h", "m/s", 1 / 3.6), ("t/m", "kg/m", 1e3),
    ("GPa", "Pa", 1e9), ("kN s/m", "N s/m", 1e3), ("t m2", "kg m2", 1e3), ("kN m2", "N m2", 1e3),
]  # fmt: skip


@given(value=st.floats(-1e6, 1e6), pair=st.sampled_from(EXAMPLES))
def test_units(value, pair):
    unit, si, factor = pair
    assert units.quantity("x", value, unit, si) == pytest.approx(
        value * factor, rel=1e-14, abs=1e-25
    )
    with pytest.raises(InputError, match="unit"):
        units.quantity("x", value, "s" if si != "s" else "m", si)


def test_a_unit_belongs_to_one_dimension_and_the_first_is_that_of_si():
    names = [name for family in units.UNITS.values() for name in family]
    assert len(names) == len(set(names))
    assert all(next(iter(family.values())) == 1.0 for family in units.UNITS.values())


IN, FT, LB = 0.0254, 0.3048, 0.45359237
LBF = LB * 9.80665  # one pound under standard gravity
KIP = 1000 * LBF
BOOK = {
    "number": {"": 1.0, "-": 1.0, "1": 1.0, "rad": 1.0, "mrad": 1 / 1000, "%": 1 / 100},
    "length": {"m": 1.0, "cm": 1 / 100, "mm": 1 / 1000, "km": 1000, "in": IN, "ft": FT},
    # The slug is the mass that one pound of force gives one foot/s2; likewise all force s2/length.
    "mass": {
        "kg": 1.0, "t": 1000, "lb": LB, "slug": LBF / FT, "N s2/mm": 1000, "kN s2/m": 1000,
        "kN s2/mm": 10**6, "lbf s2/in": LBF / IN, "kip s2/in": KIP / IN, "kip s2/ft": KIP / FT,
    },
    "area": {"m2": 1.0, "cm2": 1e-4, "mm2": 1e-6, "in2": IN**2, "ft2": FT**2},
    "second moment of area": {"m4": 1.0, "cm4": 1e-8, "mm4": 1e-12, "in4": IN**4, "ft4": FT**4},
    "mass per length": {"kg/m": 1.0, "t/m": 1000, "lb/ft": LB / FT},
    "density": {"kg/m3": 1.0, "t/m3": 1000, "t/mm3": 1e12, "lb/ft3": LB / FT**3},
    "moment of inertia": {
        "kg m2": 1.0, "t m2": 1000, "kg mm2": 1e-6, "t mm2": 1e-3, "kN s2 m": 1000,
        "lb ft2": LB * FT**2, "slug ft2": LBF * FT, "lbf s2 in": LBF * IN, "kip s2 in": KIP * IN,
    },
    "stiffness": {
        "N/m": 1.0, "kN/m": 1000, "MN/m": 10**6, "N/mm": 1000, "kN/mm": 10**6, "lbf/in": LBF / IN,
        "lbf/ft": LBF / FT, "kip/in": KIP / IN, "kip/ft": KIP / FT,
    },
    "damping": {
        "N s/m": 1.0, "kN s/m": 1000, "MN s/m": 10**6, "N s/mm": 1000, "kN s/mm": 10**6,
        "lbf s/in": LBF / IN, "lbf s/ft": LBF / FT, "kip s/in": KIP / IN,
    },
    "bending stiffness": {
        "N m2": 1.0, "kN m2": 1000, "MN m2": 10**6, "GN m2": 10**9, "N mm2": 1e-6, "kN mm2": 1e-3,
        "lbf in2": LBF * IN**2, "kip in2": KIP * IN**2, "kip ft2": KIP * FT**2,
    },
    "frequency": {"Hz": 1.0, "rad/s": 0.15915494309189535},
    "stress": {
        "Pa": 1.0, "kPa": 1000, "MPa": 10**6, "GPa": 10**9, "N/mm2": 10**6, "kN/m2": 1000,
        "psi": LBF / IN**2, "ksi": KIP / IN**2,
    },
    "force": {"N": 1.0, "kN": 1000, "MN": 10**6, "lbf": LBF, "kip": KIP},
    "speed": {"m/s": 1.0, "km/h": 1000 / 3600, "ft/s": FT, "mph": 5280 * FT / 3600},
    "time": {"s": 1.0, "ms": 1 / 1000},
}  # fmt: skip


def test_the_book_has_every_unit():
    """A new unit needs its line above."""
    assert {d: set(family) for d, family in units.UNITS.items()} == {
        d: set(family) for d, family in BOOK.items()
    }


@pytest.mark.parametrize(
    ("dimension", "unit"), [(name, unit) for name, family in BOOK.items() for unit in family]
)
def test_a_unit_is_worth_what_the_book_says(dimension, unit):
    si = units.units_of(dimension)[0]
    known = 3.0 * BOOK[dimension][unit]
    assert units.quantity("x", 3.0, unit, si) == pytest.approx(known, rel=1e-7)


def test_units_of_a_dimension_are_named():
    assert units.units_of("mass")[:4] == ("kg", "t", "lb", "slug")
    assert units.units_of("length") == ("m", "mm", "cm", "km", "in", "ft")
    with pytest.raises(InputError, match="^dimension = 'lenght'.*Did you mean 'length'"):
        units.units_of("lenght")


def test_whole_numbers_of_a_unit_make_a_metre():
    """Dividing by them rounds once: 1234.567 mm are the float nearest to 1.234567 m."""
    assert [units.per_metre(u) for u in ("m", "cm", "mm")] == [1.0, 100.0, 1000.0]
    assert units.per_metre("in") == 1 / 0.0254 and units.per_metre("ft") == 1 / 0.3048
    assert 1234.567 / units.per_metre("mm") == 1.234567 and units.per_metre("0.5") == 2.0


POUND, INCH, FOOT = 4.4482216152605, 0.0254, 0.3048
"""Of force, N; m: as they are defined."""


@pytest.mark.parametrize(
    ("value", "unit", "si", "expected"),
    [
        (3.0, "%", "", 0.03), (2.0, "-", "", 2.0), (25.0, "%", "1", 0.25),
        (5.0, "mm2", "m2", 5e-6), (5.0, "cm2", "m2", 5e-4), (2.0, "in2", "m2", 2 * INCH**2),
        (7.0, "cm4", "m4", 7e-8), (7.0, "mm4", "m4", 7e-12), (7.0, "in4", "m4", 7 * INCH**4),
        (1.0, "slug", "kg", POUND / FOOT), (1.0, "lbf s2/in", "kg", POUND / INCH),
        (1.0, "kip s2/in", "kg", 1000 * POUND / INCH), (1.0, "kN s2/mm", "kg", 1e6),
        (1.0, "N s2/mm", "kg", 1000.0), (1.0, "kN s2/m", "kg", 1000.0),
        (1.0, "kip s2/ft", "kg", 1000 * POUND / FOOT),
        (1.0, "t/mm3", "kg/m3", 1e12), (2.5, "t/m3", "kg/m3", 2500.0),
        (150.0, "lb/ft3", "kg/m3", 2402.769), (1.0, "t mm2", "kg m2", 1e-3),
        (1.0, "lbf s2 in", "kg m2", POUND * INCH), (1.0, "slug ft2", "kg m2", POUND * FOOT),
        (1.0, "lb ft2", "kg m2", 0.04214011), (1.0, "kip s2 in", "kg m2", 1000 * POUND * INCH),
        (1.0, "kip", "N", 1000 * POUND), (1.0, "lbf", "N", POUND),
        (1.0, "N/mm", "N/m", 1e3), (1.0, "kN/mm", "N/m", 1e6),
        (1.0, "lbf/in", "N/m", 175.12683524647636), (1.0, "kip/in", "N/m", 175126.83524647636),
        (1.0, "lbf/ft", "N/m", POUND / FOOT), (1.0, "kip/ft", "N/m", 1000 * POUND / FOOT),
        (1.0, "lbf s/in", "N s/m", POUND / INCH), (1.0, "kip s/in", "N s/m", 1000 * POUND / INCH),
        (1.0, "N s/mm", "N s/m", 1e3), (1.0, "MN s/m", "N s/m", 1e6),
        (1.0, "MN m2", "N m2", 1e6), (1.0, "GN m2", "N m2", 1e9), (1.0, "kN mm2", "N m2", 1e-3),
        (1.0, "kip in2", "N m2", 1000 * POUND * INCH**2), (1.0, "N mm2", "N m2", 1e-6),
        (1.0, "N/mm2", "Pa", 1e6), (1.0, "ksi", "Pa", 6894757.293168361),
        (1.0, "psi", "Pa", 6894.757),
        (60.0, "mph", "m/s", 26.8224), (1.0, "ft/s", "m/s", 0.3048),
        (6.283185307179586, "rad/s", "Hz", 1.0), (1.0, "lb/ft", "kg/m", 1.488164),
    ],
)  # fmt: skip
def test_what_a_unit_is(value, unit, si, expected):
    assert units.quantity("x", value, unit, si) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("unit", "found"),
    [
        ("kN*s/m", "kN s/m"), ("kN\u00b7s/m", "kN s/m"), ("kg m^2", "kg m2"),
        ("kg m\u00b2", "kg m2"),
        (" kN / m ", "kN/m"), ("mm\u2074", "mm4"), ("kg  m2", "kg m2"), ("-", "-"), ("%", "%"),
        ("kNs/m", "kNs/m"),
    ],
)  # fmt: skip
def test_units_are_known_however_their_powers_and_products_are_written(unit, found):
    assert units.spelled(unit) == found


def test_a_unit_without_a_name_is_a_number():
    assert units.factor_of("units[2]", "lbf s2/in", "mass") == pytest.approx(175.126835)
    assert units.factor_of("units[2]", "175.127", "mass") == 175.127
    assert units.factor_of("units[1]", 0.3048, "length") == 0.3048
    for bad in ("", "pound", 0.0, -1.0, "nan", None, True, [1.0]):
        with pytest.raises(InputError, match=r"^units\[2\]"):
            units.factor_of("units[2]", bad, "mass")


@pytest.mark.parametrize(
    ("text", "comma", "number"),
    [
        ("1.5", False, 1.5), ("-.5e-3", False, -5e-4), ("2.", False, 2.0), (" 7 ", True, 7.0),
        ("1,5", True, 1.5), ("-,5e-3", True, -5e-4), ("6,27841384e-21", True, 6.27841384e-21),
        ("2,", True, 2.0),
    ],
)  # fmt: skip
def test_numbers_as_people_write_them(text, comma, number):
    assert units.written("x", text, comma) == number


@pytest.mark.parametrize(
    ("text", "comma", "words"),
    [
        ("", False, "is blank, must be a number"), ("  ", True, "is blank"),
        ("1,5", False, "has a decimal comma. Use a point as decimal mark"),
        ("50,990", False, "may have a mark for thousands"),
        ("50 990", False, "may have a mark for thousands"),
        ("1.234,5", True, "may have a mark for thousands"),
        ("1,234.5", False, "may have a mark for thousands"),
        ("50'990", False, "may have a mark for thousands"),
        ("1.5", True, "has a point where other numbers of the file have a decimal comma"),
        ("1.5D-3", False, "has an exponent without e. Write it as 1.5e-3"),
        ("1.5-3", False, "has an exponent without e"),
        ("nan", False, "must be a finite number"), ("1e999", False, "must be a finite number"),
        ("1_000", False, "must be a finite number"), ("two", True, "must be a finite number"),
    ],
)  # fmt: skip
def test_texts_that_are_no_numbers_are_refused_for_what_they_are(text, comma, words):
    with pytest.raises(InputError) as error:
        units.written("x", text, comma)
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("value", "unit", "message"),
    [
        (1.0, "N", r"width \(unit\) = 'N': must be one of m, mm, cm, km, in, ft. Correct the unit"),
        (1.0, "", r"width \(unit\) = '': must be one of m, "),
        (1.0, ["m"], r"width \(unit\) = \['m'\]: must be one of m, "),
        ("two", "m", "width = 'two': must be a finite number. Use a point as decimal mark"),
        (None, "m", "width: must be a number"),
        (True, "m", "width = True: must be a number"),
        ([1.0], "m", r"width = \[1.0\]: must be a number"),
        (10**400, "m", "width = 1000.*: must be a finite number"),
        (float("nan"), "m", "width = nan: must be a finite number"),
        (-1.0, "mm", "width = -0.001: must be a finite number above 0 m"),
    ],
)
def test_quantities_that_cannot_be_used_are_refused(value, unit, message):
    with pytest.raises(InputError, match=message):
        units.quantity("width", value, unit, "m", above=0.0)
