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


BOOK = {
    "number": {"": 1.0, "-": 1.0, "1": 1.0, "rad": 1.0, "%": 1 / 100},
    "length": {"m": 1.0, "cm": 1 / 100, "mm": 1 / 1000, "km": 1000, "in": 0.0254, "ft": 0.3048},
    # The slug is the mass that one pound of force (under standard gravity) gives one foot/s2.
    "mass": {"kg": 1.0, "t": 1000, "lb": 0.45359237, "slug": 0.45359237 * 9.80665 / 0.3048},
    "area": {"m2": 1.0},
    "second moment of area": {"m4": 1.0},
    "mass per length": {"kg/m": 1.0, "t/m": 1000},
    "density": {"kg/m3": 1.0},
    "moment of inertia": {"kg m2": 1.0, "t m2": 1000},
    "stiffness": {"N/m": 1.0, "kN/m": 1000, "MN/m": 10**6},
    "damping": {"N s/m": 1.0, "kN s/m": 1000},
    "bending stiffness": {"N m2": 1.0, "kN m2": 1000},
    "frequency": {"Hz": 1.0},
    "stress": {"Pa": 1.0, "kPa": 1000, "MPa": 10**6, "GPa": 10**9},
    "force": {"N": 1.0, "kN": 1000, "MN": 10**6},
    "speed": {"m/s": 1.0, "km/h": 1000 / 3600},
    "time": {"s": 1.0, "ms": 1 / 1000},
}


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
    assert units.units_of("mass") == ("kg", "t", "lb", "slug")
    with pytest.raises(InputError, match="^dimension = 'lenght'.*Did you mean 'length'"):
        units.units_of("lenght")


def test_whole_numbers_of_a_unit_make_a_metre():
    """Dividing by them rounds once: 1234.567 mm are the float nearest to 1.234567 m."""
    assert [units.PER_METRE[u] for u in ("m", "cm", "mm")] == [1.0, 100.0, 1000.0]
    assert units.PER_METRE["in"] == 1 / 0.0254 and units.PER_METRE["ft"] == 1 / 0.3048
    assert 1234.567 / units.PER_METRE["mm"] == 1.234567


@pytest.mark.parametrize(
    ("value", "unit", "message"),
    [
        (1.0, "N", r"width \(unit\) = 'N': must be one of m, mm, cm, km, in, ft. Correct the unit"),
        (1.0, "", r"width \(unit\) = '': must be one of m, "),
        (1.0, ["m"], r"width \(unit\) = \['m'\]: must be one of m, "),
        ("two", "m", "width = 'two': must be a number. Use a point as decimal mark"),
        (None, "m", "width: must be a number"),
        (float("nan"), "m", "width = nan: must be a finite number"),
        (-1.0, "mm", "width = -0.001: must be a finite number above 0 m"),
    ],
)
def test_quantities_that_cannot_be_used_are_refused(value, unit, message):
    with pytest.raises(InputError, match=message):
        units.quantity("width", value, unit, "m", above=0.0)
