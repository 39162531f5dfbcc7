"""What is only rounding is told as zero, wherever a crossing is asked."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.commands.findings import largest
from railbridge.decks import History
from railbridge.units import ROUND_OFF, without_rounding

SIDEWAYS = ("displacement_y", "rotation_x", "moment_lateral", "torsion", "rotation_z")


@pytest.fixture(scope="module")
def run():
    """Two spatial cars on the axis of the paper's viaduct: nothing goes sideways."""
    case = rb.case("paper").replace({
        "train.track": None, "train.cars": 2, "run.loads": "wheels", "run.lead_in": 0.0,
        "run.time_step": 2e-3, "track.lateral": None,
    })  # fmt: skip
    return case.compute()


def numbers(found, path=""):
    items = found.items() if isinstance(found, dict) else enumerate(found)
    for key, value in items:
        if isinstance(value, (dict, list)):
            yield from numbers(value, f"{path}.{key}")
        elif isinstance(value, float):
            yield f"{path}.{key}", value


def test_a_history_that_is_only_rounding_is_zero():
    time = np.linspace(0.0, 1.0, 5)
    tiny, small = np.array([0.0, 1e-19, -1e-18, 0.0, np.nan]), np.array([0.0, 1e-19, 1e-9, 0, 0])
    found = History(time, {"y": tiny, "z": small}, {"y": "m", "z": "m"})
    np.testing.assert_array_equal(found["y"], [0.0, 0.0, 0.0, 0.0, np.nan])
    # What is small now and then in a history that is not is left as it is.
    assert found["z"] is small and found.extremes("y") == ((0.0, 0.0), (0.0, 0.0))


def test_jumps_that_are_only_rounding_are_zero():
    time = np.linspace(0.0, 1.0, 3)
    jumps = lambda name: (np.array([0.3]), np.array([1e-10]))  # noqa: E731
    found = History(time, {"torsion": np.zeros(3)}, {"torsion": "N m"}, jumps=jumps)
    assert found.extremes("torsion")[1][0] == 0.0


@pytest.mark.parametrize("unit", ROUND_OFF)
def test_every_kind_has_its_own_rounding(unit):
    least = ROUND_OFF[unit]
    np.testing.assert_array_equal(without_rounding(np.array([[0.9], [1.1]]) * least, unit),
                                  [[0.0], [1.1 * least]])  # fmt: skip
    assert without_rounding(np.array([least]), "Hz")[0] == least


def test_nothing_goes_sideways_where_all_is_symmetric(run):
    for name in SIDEWAYS[:2]:
        assert not run.displacement(18.0)[name].any()
    for name in SIDEWAYS[2:4]:
        assert run.section_forces(18.0).extremes(name) == ((0.0, 0.0), (0.0, 0.0))
    assert not run.rotations(18.0)["rotation_z"].any()
    assert not run.wheel_force()["force_y"].any()
    assert not run.car_accelerations()["front acceleration_y"].any()
    assert run.envelope("torsion").at(3).extremes("value") == ((0.0, 0.0), (0.0, 0.0))
    assert not run.envelope("displacement_z").values[0].any()
    assert run.displacement(18.0).extreme("displacement_z")[0] < -1e-4


def test_a_summary_tells_no_rounding(run):
    told = rb.cases.summarize(run, [18.0])
    left = {k: v for k, v in told.items() if k not in ("changes", "deviation_percent")}
    tiny = [path for path, v in numbers(left) if 0.0 < abs(v) < 1e-10]
    assert not tiny
    assert told["points"][0]["displacement_y"]["max"]["value"] == 0.0
    assert told["cars"][0]["lateral_over_vertical"]["max"]["value"] == 0.0
    frame = run.per_car.to_frame()
    assert not frame["wheel_force_y max (N)"].any()


def test_studies_tell_no_rounding_either(run):
    quantities = ("displacement_y", "displacement_z", "torsion")
    trains = {"cars": run.train, "loads": rb.train("HSLM-A1")}
    found = rb.speed_envelope(run.deck, trains, [40.0], [18.0], quantities, lead_in=0.0)
    for name in ("displacement_y", "torsion"):
        assert not found[name].any()
        assert largest(found, [name]) == [f"{name} is 0 everywhere"]
    assert float(found.displacement_z.min()) > 1e-4
