"""Tables of many crossings hold the numbers of the study, with speed and place."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.reports import Picture, Table
from railbridge.reports.overspeeds import failures, key_peaks, of_study, peaks, pictures, whole

SPEEDS = [40.0, 50.0, 62.5]


@pytest.fixture(scope="module")
def envelope():
    trains = {name: rb.train(name) for name in ("ICE2", "HSLM-A2")}
    quantities = ["displacement_z", "acceleration_z"]
    return rb.speed_envelope("viaduct36", trains, SPEEDS, [9.0, 18.0], quantities)


@pytest.fixture(scope="module")
def study():
    case = rb.case("paper").replace({"run.interaction": "rigid", "train.cars": 1})
    over = {"run.speed": [20.0, 30.0], "track.vertical.wavelength": [10.0, 20.0]}
    return rb.sweep(case, over, measure=["displacement_z", "wheel_unloading"])


def test_peaks_of_each_train(envelope):
    first, second = peaks(envelope)
    assert [column.head for column in first.columns] == [
        "train", "largest (mm)", "speed (m/s)", "speed (km/h)", "x (m)", "at (s)", "static (mm)",
        "dynamic factor",
    ]  # fmt: skip
    row = dict(zip([c.name for c in first.columns], first.rows[1], strict=True))
    own = envelope.displacement_z.sel(train="HSLM-A2")
    assert first.rows[1][0] == "HSLM-A2"
    assert row["largest"] == pytest.approx(1e3 * float(own.max()))
    assert first.rows[1][2:5] == (62.5, pytest.approx(225.0), 18.0)
    at = envelope.sel(train="HSLM-A2", speed=62.5, x=18.0)
    assert row["at"] == pytest.approx(float(at.displacement_z_time))
    assert row["static"] == pytest.approx(1e3 * float(at.displacement_z_static))
    assert row["dynamic factor"] == pytest.approx(row["largest"] / row["static"])
    assert "static" not in [column.name for column in second.columns]


def test_key_peaks_name_train_place_and_speed(envelope):
    rows = key_peaks(envelope)
    assert rows[0][0] == "largest vertical displacement"
    assert rows[0][3] == "HSLM-A2, x = 18 m, 62.5 m/s, 225 km/h"


def test_a_picture_for_each_quantity(envelope):
    found = list(pictures(envelope, rb.deck("viaduct36")))
    assert [p.title for p in found] == [
        "Largest vertical displacement at x = 18 m over the speed",
        "Largest vertical acceleration at x = 18 m over the speed",
    ]


def test_a_train_without_numbers_leaves_gaps(envelope):
    gaps = envelope.copy(deep=True)
    for name in gaps.data_vars:
        if gaps[name].dtype.kind == "f" and "train" in gaps[name].dims:
            gaps[name].loc[{"train": "ICE2"}] = np.nan
    gaps["message"] = gaps["message"].astype("U20")
    gaps["message"].loc[{"train": "ICE2"}] = "too long"
    table = next(iter(peaks(gaps)))
    assert table.rows[0] == ("ICE2", *[None] * 7)
    words, notes = failures(gaps)
    assert words.text == "3 of 6 crossings have no numbers:" and notes.items == ("too long",)
    assert failures(envelope) == []


def test_all_numbers_are_in_the_workbook_alone(envelope):
    table = whole(envelope)
    assert not table.on_page and len(table.rows) == 2 * 3 * 2
    heads = [column.head for column in table.columns]
    assert heads[:4] == ["train", "speed (m/s)", "x (m)", "displacement_z (m)"]
    largest = max(row[3] for row in table.rows)
    assert largest == pytest.approx(float(envelope.displacement_z.max()))


def test_a_study_of_two_keys_has_maps_and_values(study):
    largest, *found, values = of_study(study)
    assert all(isinstance(part, Picture) for part in found) and len(found) == 2
    assert isinstance(values, Table) and values.on_page and len(values.rows) == 4
    heads = [column.head for column in values.columns]
    assert heads[:3] == ["speed (m/s)", "wavelength (m)", "x (m)"]
    assert heads[3] == "largest vertical displacement (mm)"
    most = max(row[3] for row in values.rows)
    assert most == pytest.approx(1e3 * float(study.displacement_z.max()))
    assert largest.rows[0][1] == pytest.approx(most)
    own = study.displacement_z.sel(speed=largest.rows[0][3], wavelength=largest.rows[0][4])
    assert 1e3 * float(own.squeeze()) == pytest.approx(most) and largest.rows[0][5] == 18.0
    unloading = dict(zip([c.name for c in largest.columns], largest.rows[1], strict=True))
    assert unloading["x"] is None and 0.0 < unloading["largest"] < 1.0


def test_a_study_of_one_key_has_lines(study):
    _, *found, _ = of_study(study.isel(wavelength=[0]))
    assert len(found) == 2


def test_a_study_without_numbers_says_so(study):
    empty = study.copy(deep=True)
    for name in ("displacement_z", "wheel_unloading"):
        empty[name][:] = np.nan
    largest, values = of_study(empty)
    assert [row[1] for row in largest.rows] == [None, None]
