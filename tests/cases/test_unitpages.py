"""Tables of the page on units: every number of every table, result and row has its place."""

import re

import pytest

import railbridge as rb
from railbridge.cases import unitpages
from railbridge.cases.cars import CAR_PARAMETERS
from railbridge.cases.tables import TABLES
from railbridge.cases.tabletypes import measured, named_numbers, number, table, text, unit_of
from railbridge.studies.engine import NUMBERS


def names_of(lines):
    """{unit: names} of a table by unit."""
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]
    return {unit: re.findall("`(.+?)`", names) for unit, names in cells}


def test_keys_stand_under_the_unit_that_their_type_checks():
    found = names_of(unitpages.key_rows())
    assert found["m/s"] == ["speed", "line_speed"] and found["1/s"] == ["alpha"]
    assert {"beta", "time_step"} <= set(found["s"]) and "tracks" in found["m"]
    # Names that mean different things are told with their tables.
    assert found["kg"].count("mass") == found["kg/m"].count("mass") == 1
    lines = "\n".join(unitpages.key_rows())
    assert "| kg/m | `mass` (deck), " in lines
    assert "`mass` (deck.point_mass, body, wheelset)" in lines
    assert "| N/m or N m/rad | `stiffness` (deck.bearing) |" in lines
    every = {name for names in found.values() for name in names}
    numbers = {
        field.alias or name
        for own in TABLES.values()
        for name, field in own.model_fields.items()
        if unit_of(field) is not None
    }
    assert every == numbers and len(every) > 90


def test_numbers_without_a_unit_stand_last():
    last = unitpages.key_rows()[-1]
    assert last.startswith("| none: a share") and "`poisson_ratio`" in last and "`modes`" in last


@pytest.mark.parametrize(
    ("kind", "unit"),
    [
        (number(above=0.0, unit="kg"), "kg"), (number(), ""), (named_numbers(unit="m"), "m"),
        (measured(text(), "s"), "s"), (text(), None),
    ],
)  # fmt: skip
def test_a_type_tells_its_unit(kind, unit):
    made = table("Made", "A table.", own=(kind, ...))
    assert unit_of(made.model_fields["own"]) == unit


def test_every_row_of_a_car_has_its_unit():
    found = names_of(unitpages.car_rows())
    assert sum(len(names) for names in found.values()) == len(CAR_PARAMETERS)
    for unit, names in found.items():
        assert {CAR_PARAMETERS[name].unit for name in names} == {"" if "none" in unit else unit}


def test_units_of_results_are_those_that_a_run_says():
    cells = [line.strip("|").split("|") for line in unitpages.result_rows()[2:]]
    told = {where.strip(): dict(re.findall(r"`(\w+)` ([^,|]+)", said)) for where, said in cells}
    told = {where: {n: u.strip() for n, u in units.items()} for where, units in told.items()}
    case = rb.Case({
        "deck": {"file": "viaduct36", "modes": 4},
        "train": {"vehicle": "xia2000"},
        "run": {"speed": 60.0, "time_step": 5e-3, "interaction": "rigid", "tail": 0.1},
    })  # fmt: skip
    run = case.run()
    for where, history in {
        "at a bearing line": run.reactions()[0.0],
        "at one bearing": run.bearing_forces()[1],
        "of a wheel": run.wheel_force(1, 1),
    }.items():
        assert {n: u for n, u in history.units.items() if n in told[where]} == told[where], where
    here = {**run.displacement(x=18.0).units, **run.section_forces(x=18.0).units}
    here |= {**run.acceleration(x=18.0).units, **run.rotations(x=18.0).units}
    assert {name: here[name] for name in told["at a point of the deck"]} == told[
        "at a point of the deck"
    ]


def test_measures_of_studies_are_all_told():
    rows = unitpages.study_rows()[2:]
    assert [re.match(r"\| `(\w+)` \| (\S+) \|", row).groups() for row in rows] == [
        (name, unit) for name, (unit, *_) in NUMBERS.items()
    ]
