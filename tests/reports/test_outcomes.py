"""Results of a crossing as tables: the numbers of its summary, in the units of pictures."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.reports.outcomes import key_results, tables_of_summary


@pytest.fixture(scope="module")
def found(quick):
    case, run = quick
    summary = case.summary(run)
    return case, run, summary, {table.name: table for table in tables_of_summary(summary)}


def row_of(table, *first):
    (row,) = [row for row in table.rows if row[: len(first)] == first]
    return row


def test_extremes_at_a_point_are_those_of_the_run(found):
    case, run, _, tables = found
    row = row_of(tables["extremes"], 6.0, "vertical displacement", "mm")
    (low, low_time), (high, high_time) = run.displacement(6.0).extremes("displacement_z")
    assert row[3:7] == pytest.approx((1e3 * low, low_time, 1e3 * high, high_time))
    line = case.deck.recovery.section("displacement_z", 6.0)
    static = min(run.static_extremes(line))
    assert row[7:] == pytest.approx((1e3 * static, low / static))
    acceleration = row_of(tables["extremes"], 6.0, "vertical acceleration", "m/s²")
    assert acceleration[7:] == (None, None)


def test_the_envelope_has_places_and_stands_whole_in_the_workbook(found):
    _, run, summary, tables = found
    row = row_of(tables["envelope"], "vertical bending moment", "kN m")
    entry = summary["envelope"]["moment_vertical"]["min"]
    assert row[2:5] == pytest.approx((entry["value"] / 1e3, entry["x"], entry["t"]))
    along = tables["along the deck"]
    heads = [column.head for column in along.columns]
    assert heads[:3] == ["x (m)", "smallest vertical displacement (mm)",
                         "largest vertical displacement (mm)"]  # fmt: skip
    places, values = (np.array([row[i] for row in along.rows]) for i in (0, 1))
    assert not along.on_page
    own = run.envelope("displacement_z", places).values.min(axis=1)
    assert values == pytest.approx(1e3 * own, abs=1e-9)


def test_reactions_balance_the_deck(found):
    tables = found[3]
    row = row_of(tables["reactions"], 0.0, "vertical reaction", "kN")
    summary = found[2]["reactions"][0]["force_z"]
    assert row[5] == pytest.approx(summary["max"]["value"] / 1e3)
    assert {row[1] for row in tables["reactions"].rows} == {"vertical reaction"}


def test_wheels_of_the_whole_record_and_on_the_deck(found):
    _, run, _, tables = found
    row = row_of(tables["wheels"], "whole record", "heaviest wheel force", "kN")
    assert row[3] == pytest.approx(run.wheel_forces[:, 1].min() / 1e3)
    most = row_of(tables["wheels"], "on the deck", "largest unloading, 1 - force / static", "-")
    assert most[3] == pytest.approx(np.nanmax(np.where(run.on_deck, run.wheel_unloading, np.nan)))
    assert most[5] in (1,) and 1 <= most[6] <= 8


def test_the_deck_weighs_on_its_bearings(found):
    case, _, _, tables = found
    loads = [row[3] for row in tables["self-weight"].rows if row[1] == "vertical reaction"]
    assert sum(loads) == pytest.approx(8000.0 * 12.0 * 9.81 / 1e3)


def test_passes_are_in_the_workbook(found):
    _, run, _, tables = found
    assert [row[1] for row in tables["passes"].rows] == pytest.approx(list(run.changes))
    assert not tables["passes"].on_page


def test_a_deck_of_which_only_modes_are_known_and_bare_loads(quick):
    from dataclasses import replace

    case, _ = quick
    deck = replace(case.deck, recovery=None)
    run = rb.cross(rb.AxleTrain([0.0, 3.0], [1e5, 1e5]), deck, rb.Track(), speed=40.0)
    summary = rb.summarize(run, [6.0])
    tables = {table.name: table for table in tables_of_summary(summary)}
    assert "reactions" not in tables and "car bodies" not in tables
    assert [row[0] for row in key_results(summary)][:2] == [
        "largest vertical displacement", "largest vertical acceleration",
    ]  # fmt: skip


def test_key_results_are_the_largest(found):
    summary = found[2]
    rows = {row[0]: row[1:] for row in key_results(summary)}
    low = summary["envelope"]["displacement_z"]["min"]
    assert rows["largest vertical displacement"] == (
        pytest.approx(1e3 * low["value"]), "mm", f"x = {low['x']:.4g} m", low["t"],
    )  # fmt: skip
    assert rows["largest wheel unloading"][1] == "-"
    assert rows["largest vertical acceleration of a car body"][2].startswith("car 1, ")


def test_round_off_is_no_result():
    # On the axis of the deck and level rails: nothing pushes sideways.
    run = {"speed": 40.0, "interaction": "rigid", "lead_in": 0.0, "tail": 0.1}
    train = {"vehicle": "xia2000", "cars": 1}
    case = rb.case({"deck": {"file": "viaduct36"}, "train": train, "run": run})
    summary = case.summary(case.compute())
    ends = summary["points"][0]["torsion"]
    assert ends["min"]["value"] == ends["max"]["value"] == 0.0
    tables = {table.name: table for table in tables_of_summary(summary)}
    for words, unit in (("twist", "mrad"), ("torsion", "kN m")):
        row = row_of(tables["extremes"], 18.0, words, unit)
        assert (row[3], row[5], *row[7:]) == (0.0, 0.0, None, None)
    assert not [row for row in tables["reactions"].rows if row[1] != "vertical reaction"]
    assert row_of(tables["envelope"], "torsion", "kN m")[2] == 0.0
    assert [row[3] for row in tables["cars"].rows] == [0.0]
