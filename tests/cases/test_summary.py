"""The summary says what the crossing holds, with place and time, and statics stands beside it."""

import csv
import dataclasses
import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases import summary
from railbridge.cases.summary import QUANTITIES, histories, summarize, to_json
from railbridge.results import ENVELOPE
from railbridge.settings import bytes_needed

KEYS = {
    "vehicle_frequencies_hz", "deck_frequencies_hz", "deck_mode_names", "remarks", "converged",
    "iterations", "windows", "changes", "deviation_percent", "run", "wheel_force_z",
    "wheel_force_y", "wheel_unloading", "points", "envelope", "reactions", "car_body", "cars",
    "self_weight",
}  # fmt: skip
COARSE = {
    "train.cars": 1,
    "run.loads": "wheels",
    "run.time_step": 4e-3,
    "run.tolerance": 1e-6,
    "run.tail": 0.3,
}


@pytest.fixture(scope="module")
def run():
    return rb.case("paper").replace(COARSE).run()


@pytest.fixture(scope="module")
def found(run):
    return summarize(run, [9.0, 18.0])


@pytest.fixture(scope="module")
def plain_deck():
    """A beam without lateral and torsional data, axle loads on it."""
    content = {
        "deck": {
            "length": 20.0,
            "bending_stiffness_vertical": 2e10,
            "mass": 9000.0,
            "damping": {"modal": 0.01},
            "modes": 6,
        },
        "train": {"axles": [0.0, 3.0], "loads": [2e5, 1e5]},
        "run": {"speed": 30.0, "time_step": 2e-3},
        "output": {"points": [10.0]},
    }
    return rb.Case(content)


def test_keys_are_stable_and_the_text_is_strict_json(found):
    assert set(found) == KEYS
    assert set(found["points"][0]) == {"x", *QUANTITIES}
    assert set(found["envelope"]) == set(ENVELOPE)
    assert [set(r) for r in found["reactions"]] == [
        {"x", "force_x", "force_y", "force_z", "moment_x"}
    ] * 2
    assert set(found["points"][0]["displacement_z"]) == {"min", "max", "static", "dynamic_factor"}
    assert json.loads(to_json(found)) == found


def test_extremes_are_those_of_the_histories_at_their_time(run, found):
    for point in found["points"]:
        history = run.displacement(point["x"])
        for name, pick in (("min", np.min), ("max", np.max)):
            entry = point["displacement_z"][name]
            assert entry["value"] == pick(history["displacement_z"])
            assert (
                history["displacement_z"][np.argmin(np.abs(run.time - entry["t"]))]
                == entry["value"]
            )
    moment = found["points"][1]["moment_vertical"]["min"]["value"]
    assert moment == pytest.approx(run.section_forces(18.0).extreme("moment_vertical")[0])
    wheel = found["wheel_force_z"]["max"]
    at = np.argmin(np.abs(run.time - wheel["t"]))
    assert (
        run.wheel_force(wheel["car"], wheel["wheel"])["force_z"][at]
        == wheel["value"]
        == run.wheel_forces[:, 1].max()
    )
    unloading = found["wheel_unloading"]["max"]
    assert unloading["value"] == pytest.approx(1 + wheel["value"] / run.train.wheels[0].static_load)
    assert 0.1 < unloading["value"] < 0.2


def test_envelope_meets_the_points_and_the_reactions(run, found):
    for name in ENVELOPE:
        entry = found["envelope"][name]
        stations = entry["stations"]
        assert len(stations["x"]) == len(stations["min"]) == 41
        assert min(stations["min"]) == entry["min"]["value"]
        assert stations["x"][int(np.argmax(stations["max"]))] == entry["max"]["x"]
        # 9 m and 18 m are stations.
        for point in found["points"]:
            at = stations["x"].index(point["x"])
            assert stations["min"][at] == pytest.approx(
                point[name]["min"]["value"], rel=1e-9, abs=1e-12
            )
    torque = found["envelope"]["torsion"]["stations"]
    ends = [r["moment_x"]["max"]["value"] for r in found["reactions"]]
    assert [-torque["min"][0], torque["max"][-1]] == pytest.approx(ends, rel=1e-6)


def test_static_value_is_statics(found, plain_deck):
    # One car on one span: the worst place of four equal axles of two bogies for the displacement at
    # mid-span, by hand.
    length, stiffness = 36.0, 35e9 * 2.553
    load = 585.76e3 / 4

    def sag(x):
        x = np.minimum(x, length - x)
        return np.where(x > 0, x * (3 * length**2 - 4 * x**2) / (48 * stiffness), 0.0)

    first = np.linspace(0, 60, 6001)
    axles = np.array([0.0, 2.5, 15.6, 18.1])
    by_hand = -load * max(sum(sag(f - a) for a in axles) for f in first)
    assert found["points"][1]["displacement_z"]["static"] == pytest.approx(by_hand, rel=1e-4)
    # Axle loads of 200 and 100 kN 3 m apart on 20 m: the moment at mid-span peaks with the heavy
    # one there.
    summary = plain_deck.summary()
    assert summary["points"][0]["moment_vertical"]["static"] == pytest.approx(
        -(2e5 * 5.0 + 1e5 * 3.5), rel=1e-9
    )
    # The reaction peaks as the second axle enters, or as the first leaves: at the far end the heavy
    # one alone counts fully.
    near, far = (r["force_z"]["static"] for r in summary["reactions"])
    assert [near, far] == pytest.approx([1e5 + 2e5 * 17 / 20, 2e5 + 1e5 * 17 / 20], rel=1e-6)


def test_continuous_deck_and_places_where_nothing_can_be(plain_deck):
    case = plain_deck.replace(
        {"deck.length": None, "deck.spans": [20.0, 20.0]} | {"output.points": [8.0, 0.0, 40.0]}
    )
    summary = case.summary()
    # Two equal spans: the middle bearing carries more than an end, and the moment at an end is
    # nothing.
    near, middle, far = (r["force_z"]["static"] for r in summary["reactions"])
    assert middle > max(near, far) and near == pytest.approx(262.67e3, rel=1e-4)
    for end in summary["points"][1:]:
        assert (end["moment_vertical"]["static"], end["moment_vertical"]["dynamic_factor"]) == (
            0.0,
            None,
        )
        assert end["shear_vertical"]["dynamic_factor"] == pytest.approx(1.0, abs=0.1)
    assert summary["points"][0]["moment_vertical"]["static"] < 0.0


def test_a_deck_of_modes_only_has_no_section_forces():
    whole = rb.deck("viaduct36")
    bare = dataclasses.replace(whole, recovery=None, supports=())
    train = rb.Train(rb.vehicle("xia2000_planar"))
    options = {"speed": 20.0, "time_step": 4e-3, "interaction": "rigid", "track_offset": "left"}
    found = [summarize(rb.cross(train, deck, **options), [18.0]) for deck in (whole, bare)]
    statics = [
        [f["points"][0][n]["static"] for n in ("displacement_z", "rotation_x")] for f in found
    ]
    assert statics[1] == pytest.approx(statics[0], rel=5e-3)
    assert found[1]["points"][0]["moment_vertical"] is None
    assert found[1]["reactions"] == []
    assert found[1]["self_weight"]["displacement_z"] == [None]


def test_a_slow_train_gives_a_dynamic_factor_of_one(plain_deck):
    summary = plain_deck.replace(
        {"run.speed": 0.5, "run.time_step": 0.02, "deck.damping.modal": 0.2}
    ).summary()
    for name in ("displacement_z", "moment_vertical", "rotation_y"):
        assert summary["points"][0][name]["dynamic_factor"] == pytest.approx(1.0, abs=2e-3)


def test_what_is_not_there_is_null_not_zero(plain_deck):
    summary = plain_deck.summary()
    point = summary["points"][0]
    for name in (
        "displacement_y", "rotation_x", "rotation_z", "acceleration_y", "moment_lateral", "torsion"
    ):  # fmt: skip
        assert point[name] is None
    assert point["acceleration_z"]["static"] == 0.0
    assert point["acceleration_z"]["dynamic_factor"] is None
    assert summary["envelope"]["torsion"] is None
    assert summary["reactions"][0]["force_y"] is None
    assert summary["car_body"] == {"acceleration_z": None, "acceleration_y": None}
    assert summary["vehicle_frequencies_hz"] == []
    assert summary["wheel_unloading"]["max"]["value"] == 0.0
    assert summary["wheel_force_y"] is None and summary["cars"] == []
    tables = {t.name: t for t in histories(plain_deck.run(), [10.0])}
    assert tables["cars"].columns == ["t"]
    lines = "".join(tables["cars"].rows()).splitlines()
    assert lines[0] == "t" and len(lines) == 1 + summary["run"]["samples"]


def test_lateral_wheel_forces_have_their_car_and_wheel(run, found):
    forces = run.wheel_forces[:, 0]
    told = found["wheel_force_y"]
    for side, pick in (("min", np.min), ("max", np.max)):
        one = told[side]
        wheel, sample = one["wheel"] - 1, np.argmin(np.abs(run.time - one["t"]))
        assert one["value"] == pick(forces) == forces[wheel, sample] and one["car"] == 1
        assert told["on_deck"][side]["value"] == pick(forces[run.on_deck])
    assert abs(told["min"]["value"]) > 100.0


def test_the_worst_of_all_cars_is_the_worst_of_one():
    case = rb.case("paper").replace({**COARSE, "train.cars": 3})
    summary = case.summary()
    assert [entry["car"] for entry in summary["cars"]] == [1, 2, 3]
    assert {entry["vehicle"] for entry in summary["cars"]} == {"xia2000"}
    for name in ("wheel_force_z", "wheel_force_y"):
        for key in (None, "on_deck"):
            whole = summary[name][key] if key else summary[name]
            own = [e[name][key] if key else e[name] for e in summary["cars"]]
            for side, pick in (("min", min), ("max", max)):
                worst = pick(own, key=lambda each: each[side]["value"])[side]
                expected = {**worst, "car": 1 + [o[side] for o in own].index(worst)}
                assert {k: whole[side][k] for k in ("value", "t", "car", "wheel")} == expected
    for name in ("acceleration_z", "acceleration_y"):
        for side, pick in (("min", min), ("max", max)):
            values = [entry[name][side]["value"] for entry in summary["cars"]]
            told = summary["car_body"][name][side]
            assert told["value"] == pick(values)
            assert told["car"] == 1 + values.index(told["value"])
            own = summary["cars"][told["car"] - 1][name][side]
            assert told == {**own, "car": told["car"]}


@pytest.mark.parametrize("interaction", ["rigid", "direct"])
def test_only_an_iteration_converges(interaction):
    summary = rb.case("paper").replace({**COARSE, "run.interaction": interaction}).summary()
    assert (summary["converged"], summary["iterations"], summary["changes"]) == (None, 0, None)
    assert summary["deviation_percent"]["from_rigid"] == [] or interaction == "direct"


def test_self_weight_stands_apart(found):
    weight = 12000.0 * 9.81
    assert found["self_weight"]["displacement_z"][1] == pytest.approx(
        -5 * weight * 36**4 / (384 * 35e9 * 2.553), rel=1e-6
    )
    assert found["self_weight"]["moment_vertical"][1] == pytest.approx(
        -weight * 36**2 / 8, rel=1e-6
    )
    assert found["self_weight"]["force_z"] == pytest.approx([weight * 18] * 2, rel=1e-6)


def test_car_body_acceleration_is_newton():
    train = rb.Train(rb.vehicle("sprung_mass"), cars=2, car_spacing=12.0)
    track = rb.Track(vertical=rb.Harmonic(1e-3, wavelength=10.0))
    run = rb.cross(train, rb.deck("viaduct36"), track, speed=30.0, time_step=2e-3, tolerance=1e-4)
    mass = run.train.wheels[0].static_load / 9.81
    force = -run.wheel_forces[:, 1] - mass * 9.81
    assert np.allclose(run.body_accelerations[:, 1, 1], force / mass, atol=1e-9)
    found = summarize(run, [18.0])["car_body"]
    assert found["acceleration_y"] is None
    assert found["acceleration_z"]["max"]["value"] == pytest.approx((force / mass).max())
    assert found["acceleration_z"]["max"]["place"] in ("front", "middle", "rear")


def test_the_middle_of_a_car_body_moves_as_the_mean_of_its_ends(run):
    front, middle, rear = run.body_accelerations[0]
    assert np.allclose(middle, (front + rear) / 2, atol=1e-9)
    assert np.abs(middle[1]).max() > 0.5


def test_every_coach_of_an_articulated_train_is_told():
    """Newton for all of them: masses times accelerations are what the wheels exert."""
    coaches = [rb.Body(f"c{i}", 2e4 - 5e3 * i, (0, 1, 0), (8.0 - 8.0 * i, 0, 1), ("z", "pitch"))
               for i in range(3)]  # fmt: skip
    coaches = tuple(replace(c, inertia=(0.0, 2e5, 0.0)) for c in coaches)
    springs = [
        rb.Spring(c.name, "rail", (c.position[0] + x, 0.0, 0.0), (0.0, 1e6), (0.0, 2e4))
        for c in coaches
        for x in (3.0, -3.0)
    ]
    springs.append(rb.Spring("c0", "c1", (4.0, 0.0, 1.0), (0.0, 1e6), (0.0, 1e4)))
    long = rb.Vehicle("long", coaches, tuple(springs), 24.0)
    train = rb.Train((long, rb.vehicle("sprung_mass")))
    track = rb.Track(vertical=rb.Harmonic(1e-3, wavelength=10.0))
    options = {"speed": 30.0, "time_step": 2e-3, "tolerance": 1e-6, "lead_in": 0.0}
    run = rb.cross(train, rb.deck("viaduct36"), track, **options)
    found = run.body_accelerations
    assert found.shape[:3] == (2, 9, 2) and np.isnan(found[1, 3:]).all()
    assert np.isfinite(found[0]).all()
    inertia = sum(c.mass * found[0, 3 * i + 1, 1] for i, c in enumerate(coaches))
    exerted = -(run.wheel_forces[:6, 1].sum(axis=0) + sum(c.mass for c in coaches) * 9.81)
    assert np.allclose(inertia, exerted, atol=1e-6 * np.abs(exerted).max())
    told = summarize(run, [18.0])["car_body"]["acceleration_z"]
    worst = np.unravel_index(np.nanargmax(found[:, :, 1]), (2, 9, len(run.time)))
    assert told["max"]["value"] == np.nanmax(found[:, :, 1])
    assert told["max"]["car"] == worst[0] + 1
    assert told["max"]["place"] == ("front", "middle", "rear")[worst[1] % 3]
    assert told["max"].get("body") == (f"c{worst[1] // 3}" if worst[0] == 0 else None)
    own = run.car_accelerations(1)
    assert list(own.values)[6:8] == ["c1 front acceleration_y", "c1 front acceleration_z"]
    assert np.array_equal(own["c2 rear acceleration_z"], found[0, 8, 1])
    assert np.isnan(own["c1 front acceleration_y"]).all()
    first, second = summarize(run, [18.0])["cars"]
    worst = int(np.argmax(found[0, :, 1].max(axis=1)))
    assert first["acceleration_z"]["max"]["body"] == f"c{worst // 3}"
    assert "body" not in second["acceleration_z"]["max"] and first["acceleration_y"] is None
    columns = next(t for t in histories(run, [18.0]) if t.name == "cars").columns
    assert columns[1] == "car 1 c0 front acceleration_z (m/s2)" and len(columns) == 1 + 9 + 3


def test_histories_start_with_t_and_name_their_units(run):
    tables = {t.name: t for t in histories(run, [9.0, 18.0])}
    assert list(tables) == ["points", "wheels", "cars", "reactions", "iterations"]
    for table in tables.values():
        assert table.columns[0] == "t"
        assert all(c.endswith(")") for c in table.columns[1:])
        assert len(table.columns) == len(set(table.columns)) == len(table.values)
        assert np.array_equal(table.values[0], run.time)
    points = tables["points"]
    assert points.columns[1 : 1 + len(QUANTITIES)] == [
        f"x=9 {name} ({unit})" for name, unit in QUANTITIES.items()
    ]
    turned = points.values[points.columns.index("x=9 rotation_y (rad)")]
    assert np.array_equal(turned, run.rotations(9.0)["rotation_y"])
    assert len(tables["wheels"].columns) == 1 + 2 * 8
    ways = [f"car 1 {place} acceleration_{way} (m/s2)"
            for place in ("front", "middle", "rear") for way in "yz"]  # fmt: skip
    assert tables["cars"].columns == ["t", *ways]
    assert np.array_equal(tables["cars"].values[1:], run.body_accelerations[0].reshape(6, -1))
    assert len(tables["iterations"].columns) == 2 + run.iterations
    assert np.allclose(tables["iterations"].values[-1], run.displacement(9.0)["displacement_z"])
    lines = "".join(tables["reactions"].rows(chunk=7)).splitlines()
    read = np.array([line.split(",") for line in lines[1:]], dtype=float)
    assert read.shape == (len(run.time), len(lines[0].split(",")))
    assert np.allclose(read[:, 2], tables["reactions"].values[2], rtol=1e-8)


def test_a_name_with_a_comma_stays_one_column():
    table = summary.HistoryTable("cars", ["t", 'car 1 a, "b" front (m/s2)'], [np.zeros(2)] * 2)
    rows = list(csv.reader("".join(table.rows()).splitlines()))
    assert rows == [table.columns, ["0", "0"], ["0", "0"]]


def test_a_run_that_blew_up_is_still_written():
    deck = {
        "length": 10.0,
        "bending_stiffness_vertical": 1e8,
        "mass": 40.0,
        "damping": {"modal": 0.0},
        "modes": 4,
    }
    options = {"speed": 20.0, "time_step": 4e-3, "max_iterations": 12, "relaxation": 1.0}
    case = rb.Case({"deck": deck, "train": {"vehicle": "xia2000"}, "run": options})
    with np.errstate(all="ignore"), pytest.raises(rb.NotConvergedError) as error:
        case.run()
    with np.errstate(all="ignore"):
        summary = summarize(error.value.run, [5.0])
    assert summary["converged"] is False
    to_json(summary)


def test_memory_grows_with_what_is_asked():
    case = rb.case("paper")
    needed = bytes_needed(case.train, case.deck, case.settings)
    assert 1e8 < needed < 6e8  # measured peak 0.27 GB
    finer = case.replace({"run.time_step": 2e-4, "run.iterations": 4})
    alike = case.replace({"run.iterations": 4})
    coarse = bytes_needed(alike.train, alike.deck, alike.settings)
    assert bytes_needed(finer.train, finer.deck, finer.settings) - 1.2e8 > 4.5 * (coarse - 1.2e8)
    assert math.isfinite(needed)


def test_the_papers_case_in_numbers():
    summary = rb.case("paper").replace({"run.time_step": 2e-3, "run.tolerance": 1e-4}).summary()
    point, envelope = summary["points"][0], summary["envelope"]
    assert point["displacement_z"]["min"]["value"] == pytest.approx(-7.23e-3, rel=0.01)
    assert point["moment_vertical"]["min"]["value"] == pytest.approx(-5.526e6, rel=0.01)
    assert point["moment_lateral"]["max"]["value"] == pytest.approx(62e3, rel=0.02)
    assert envelope["torsion"]["max"]["value"] == pytest.approx(2.071e6, rel=0.02)
    assert max(r["force_z"]["max"]["value"] for r in summary["reactions"]) == pytest.approx(
        865e3, rel=0.02
    )
    assert point["displacement_z"]["static"] == pytest.approx(-6.534e-3, rel=1e-3)


@pytest.mark.parametrize(
    ("statics", "extremes", "side", "factor"),
    [
        # Both sides alike but for round-off, as for shear at mid-span: the larger dynamic value.
        ((-100.000001, 100.0), (-103.0, 110.0), 100.0, 1.10),
        ((-100.0, 100.000001), (-115.0, 110.0), -100.0, 1.15),
        # Otherwise the side of the larger static value, whatever the dynamic ones.
        ((-50.0, 100.0), (-200.0, 90.0), 100.0, 0.9),
        ((-100.0, 50.0), (-90.0, 200.0), -100.0, 0.9),
        ((-99.9, 100.0), (-200.0, 90.0), 100.0, 0.9),
    ],
)
def test_the_dynamic_factor_is_that_of_the_side_with_the_larger_static_value(
    statics, extremes, side, factor
):
    run = SimpleNamespace(static_extremes=lambda line: statics)
    values = {"shear_vertical": np.array([0.0, extremes[0], extremes[1], 0.0])}
    history = {"shear_vertical": rb.History(np.arange(4.0), values, {"shear_vertical": "N"})}
    entry = summary._entries(run, history, {"shear_vertical": object()})["shear_vertical"]
    assert entry["static"] == pytest.approx(side, rel=1e-6)
    assert entry["dynamic_factor"] == pytest.approx(factor, rel=1e-6)


@pytest.mark.parametrize(
    "rail", [None, {"spread": 0.6}, {"bending_stiffness": 1.28e7, "foundation": 1e8}]
)
def test_the_rail_is_told_and_what_counts_from_before_t_0_stays_right(rail):
    case = rb.case("paper").replace({**COARSE, "deck.rail": rail})
    run = case.run()
    found = summarize(run, [18.0])
    assert found["run"]["rail"] == rail
    assert found["run"]["duration"] == pytest.approx(run.time[-1])
    tables = {table.name: table for table in histories(run, [18.0])}
    assert tables["points"].values[0][0] == pytest.approx(run.time[0])
    # A wheel is on the deck from x = 0 to x = L, wherever the rail reaches.
    whole = found["wheel_force_z"]["on_deck"]["min"]
    wheel = next(w for w in run.train.wheels if (w.car, w.number) == (whole["car"], whole["wheel"]))
    assert -0.1 <= 20.0 * whole["t"] - wheel.delay <= 36.1
    factor = found["points"][0]["displacement_z"]["dynamic_factor"]
    assert 0.9 < (factor["min"] if isinstance(factor, dict) else factor) < 1.5
