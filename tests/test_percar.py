"""Every car by itself: extremes of its wheels and bodies."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import percar

DECK = rb.deck("viaduct36")
TRACK = rb.Track(
    vertical=rb.Harmonic(3e-3, wavelength=14.4), lateral=rb.Harmonic(2e-3, wavelength=11)
)
MIXED = rb.cross(
    rb.Train((rb.vehicle("xia2000"), rb.vehicle("xia2000_planar"), rb.vehicle("xia2000"))),
    DECK, TRACK, speed=25.0, time_step=4e-3, tolerance=1e-3,
)  # fmt: skip


def test_a_row_of_the_frame_is_what_its_wheels_and_body_have():
    frame = MIXED.per_car.to_frame()
    assert frame.index.tolist() == [1, 2, 3] and frame.index.name == "car"
    assert frame["vehicle"].tolist() == ["xia2000", "xia2000_planar", "xia2000"]
    for number in (1, 2, 3):
        row = frame.loc[number]
        own = [i for i, wheel in enumerate(MIXED.train.wheels) if wheel.car == number]
        y, z = MIXED.wheel_forces[own].transpose(1, 0, 2)
        on = MIXED.on_deck[own]
        assert row["wheel_force_z min (N)"] == z.min() and row["wheel_force_z max (N)"] == z.max()
        assert row["wheel_force_z max on deck (N)"] == z[on].max()
        assert row["wheel_unloading max on deck (-)"] == MIXED.wheel_unloading[own][on].max()
        body = MIXED.body_accelerations[number - 1]
        assert row["acceleration_z min (m/s2)"] == body[:, 1].min()
        if number == 2:
            lateral = [c for c in frame.columns if "_y " in c or c.startswith("lateral")]
            assert len(lateral) == 8 and row[lateral].isna().all()
            continue
        assert row["wheel_force_y min on deck (N)"] == y[on].min()
        assert row["lateral_over_vertical max (-)"] == pytest.approx((np.abs(y) / np.abs(z)).max())
        assert row["acceleration_y max (m/s2)"] == body[:, 0].max()


def test_the_largest_ratio_is_of_one_wheel_at_one_instant_while_it_presses():
    (car, *_), time = MIXED.train.formation, np.arange(4.0)
    forces = np.zeros((8, 2, 4))
    forces[:, 1] = -1e5
    forces[4, 0], forces[4, 1, 1] = [1e3, -6e3, 2e3, 0.0], -2e4
    # One wheel pulls, another hangs free: neither has a ratio.
    forces[6, :, 2], forces[7, :, 3] = (9e4, 1e4), (9e4, 0.0)
    on_deck = np.ones((8, 4), dtype=bool)
    on_deck[4, 1] = False
    still = rb.History(
        time, {"front acceleration_y": time * np.nan, "front acceleration_z": time}, {}
    )
    found = percar.of_car(car, forces, np.zeros((8, 4)), on_deck, still).extremes
    ratio = found["lateral_over_vertical"]
    assert ratio["max"] == {"value": pytest.approx(0.3), "t": 1.0, "wheel": 5}
    assert ratio["on_deck"] == {"max": {"value": pytest.approx(0.02), "t": 2.0, "wheel": 5}}
    assert "min" not in ratio and "min" not in found["wheel_unloading"]
    assert found["wheel_force_y"]["min"] == {"value": -6e3, "t": 1.0, "wheel": 5}
    assert found["acceleration_y"] is None
    assert found["acceleration_z"]["max"] == {"value": 3.0, "t": 3.0, "place": "front"}


def test_wheels_of_planar_cars_and_bare_loads_are_not_held_sideways():
    held = [percar.held_sideways(car).tolist() for car in MIXED.train.formation]
    assert held == [[True] * 8, [False] * 4, [True] * 8]
    (bare,) = rb.AxleTrain([0.0, 3.0], [1e5, 1e5]).formation
    assert percar.held_sideways(bare).tolist() == [False, False]


def test_bare_loads_are_no_cars_and_their_table_is_empty():
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), DECK, speed=20.0, time_step=4e-3)
    assert run.per_car.cars == ()
    frame = run.per_car.to_frame()
    assert frame.empty and list(frame.columns) == list(MIXED.per_car.to_frame().columns)
    assert len(frame.columns) == 17


def test_what_is_nowhere_finite_has_no_extremes():
    assert percar.extremes(np.full((2, 3), np.nan), np.arange(3.0), "N", [{}, {}]) is None
    values = np.array([[np.nan, 4.0, np.inf], [-1.0, np.nan, 4.0]])
    told = percar.extremes(values, np.array([0.0, 0.1, 0.2]), "N", [{"wheel": 1}, {"wheel": 2}])
    assert told["max"] == {"value": 4.0, "t": 0.1, "wheel": 1}
    assert told["min"] == {"value": -1.0, "t": 0.0, "wheel": 2}
