"""Cars side by side, against the same crossings one by one."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.crossing import compute
from railbridge.studies import lanes
from railbridge.studies.engine import Job, asked_of, respond, row_of_run
from railbridge.studies.lanes import advance_of, eligible, run_lanes
from railbridge.studies.outputs import outputs_at

NAMES = ("displacement_z", "displacement_y", "rotation_x", "acceleration_z", "moment_vertical")
BASE = {"train.cars": 1, "run.loads": "wheels", "run.iterations": 3}


def job_of(case, train=None):
    return Job(case.train if train is None else train, case.track, case.settings)


def one_by_one(case, advance, asked):
    """The row of a crossing in the steps that a lane takes."""
    own = case.replace({"run.time_step": advance / case.settings.speed})
    run = compute(own.train, own.deck, own.track, own.settings)
    return row_of_run(run, asked).values


TWO_RAILS = {
    "left": {"kind": "harmonic", "amplitude": 3e-3, "wavelength": 9.0},
    "right": {"kind": "harmonic", "amplitude": 4e-3, "wavelength": 13.0, "phase": 1.0},
}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"train.cars": 3},
        {"run.iterations": 1},
        {"run.iterations": None, "run.interaction": "rigid"},
        {"run.lead_in": 0.0},
        {"run.lead_in": 40.0, "train.cars": 2},
        {"track.lateral": None, "run.tail": 0.2},
        {"track.vertical": TWO_RAILS},
    ],
    ids=["wheels", "cars", "one pass", "rigid", "no run-up", "short run-up", "level", "two rails"],
)
def test_a_lane_is_the_crossing_itself(changes):
    case = rb.case("paper").replace(BASE | changes)
    asked = asked_of(outputs_at(case.deck, NAMES, [18.0, 10.0]), tuple(lanes.KNOWN))
    others = [case.replace({"run.speed": v}) for v in (20.0, 20.3, 20.6)]
    jobs = [job_of(each, case.train) for each in others]
    assert all(eligible(case.deck, job, asked.outputs, False) for job in jobs)
    advance = advance_of(jobs[0].settings)
    assert all(advance_of(job.settings) == advance for job in jobs)
    found = run_lanes(case.deck, jobs, asked.outputs, asked.numbers)
    for each, values in zip(others, found, strict=True):
        expected = one_by_one(each, advance, asked)
        count = 6 * len(asked.outputs)
        six, known = values[:count].reshape(6, -1), expected[:count].reshape(6, -1)
        size = np.maximum(np.abs(known[0]), np.abs(known[1]))
        # For the moment a run also looks between the samples.
        slack = np.where([o.is_force for o in asked.outputs], 1e-3, 1e-7) * size + 1e-12
        assert np.all(np.abs(six[:2] - known[:2]) <= slack)
        assert np.allclose(six[4:], known[4:], rtol=1e-12, equal_nan=True)
        assert values[count:] == pytest.approx(expected[count:], rel=1e-6, abs=1e-7, nan_ok=True)


PARTS = """
[[body]]
name = "car"
mass = 30e3
inertia = [4e4, 1e6, 1e6]
position = [0.0, 0.0, 1.8]
freedoms = "y z roll pitch yaw"
"""
for _place, _name in ((6.0, "front"), (-6.0, "rear")):
    PARTS += f"""
[[wheelset]]
name = "{_name}"
x = {_place}
mass = 1500.0
roll_inertia = 900.0
yaw_inertia = 1000.0
[[anti_roll_bar]]
from = "car"
to = "{_name}"
stiffness = 1e6
"""
    for _y in (1.0, -1.0):
        PARTS += f"""
[[spring]]
from = "car"
to = "{_name}"
at = [{_place}, {_y}, 0.8]
stiffness = [8e5, 9e5]
damping = [2e4, 3e4]
longitudinal_stiffness = 5e6
longitudinal_damping = 1e4
series_stiffness = [3e6, 4e6]
"""


@pytest.mark.parametrize("interaction", ["rigid", "iterate"])
def test_a_lane_of_wheelsets_and_dampers_in_series_is_the_crossing_itself(tmp_path, interaction):
    (tmp_path / "parts.toml").write_text(PARTS, encoding="utf-8")
    passes = 1 if interaction == "iterate" else None
    changes = {
        "train": {"vehicle": str(tmp_path / "parts.toml"), "cars": 1},
        "run.loads": "wheels", "run.iterations": passes, "run.interaction": interaction,
        "run.lead_in": 0.0,
    }  # fmt: skip
    case = rb.case("paper").replace(changes)
    asked = asked_of(outputs_at(case.deck, ("displacement_z",), [18.0]), tuple(lanes.KNOWN))
    jobs = [job_of(case, case.train)]
    assert eligible(case.deck, jobs[0], asked.outputs, False)
    (values,) = run_lanes(case.deck, jobs, asked.outputs, asked.numbers)
    expected = one_by_one(case, advance_of(jobs[0].settings), asked)
    assert values[:2] == pytest.approx(expected[:2], rel=1e-9)
    assert values[6:] == pytest.approx(expected[6:], rel=1e-9, nan_ok=True)


def test_lanes_do_not_depend_on_each_other():
    """Bit for bit: alone, among others, at another place."""
    case = rb.case("paper").replace(BASE | {"run.tail": 0.1})
    asked = asked_of(outputs_at(case.deck, NAMES, [18.0]), tuple(lanes.KNOWN))
    some = [
        job_of(case.replace({"run.speed": 60.0, "track.vertical.wavelength": w}), case.train)
        for w in np.linspace(12.0, 30.0, 70)
    ]
    together = run_lanes(case.deck, some, asked.outputs, asked.numbers)
    for i in (0, 33, 69):
        alone = run_lanes(case.deck, [some[i]], asked.outputs, asked.numbers)[0]
        assert np.array_equal(alone, together[i], equal_nan=True)


def test_the_ladder_is_never_coarser_than_the_crossing_itself():
    settings = rb.case("paper").settings
    for speed in np.linspace(3.0, 90.0, 200):
        own = replace(settings, speed=speed)
        step = advance_of(own) / speed
        assert own.time_step / 2**0.25 * (1 - 1e-9) <= step <= own.time_step * (1 + 1e-9)


@pytest.mark.parametrize(
    "changes",
    [
        {"run.loads": "condensed"},
        {"run.iterations": None},
        {"run.relaxation": 0.5},
        {"run.excitation": "car"},
        {"run.feedback": "vertical"},
        {"track.vertical": {"kind": "table", "x": [0.0, 40.0], "r": [0.0, 1e-3]}},
        {"train": {"axles": [0.0, 2.5], "loads": [1e5, 1e5]}},
    ],
)
def test_what_is_no_lane(changes):
    case = rb.case("paper").replace(BASE | changes)
    outputs = outputs_at(case.deck, ("displacement_z",), [18.0])
    assert not eligible(case.deck, job_of(case), outputs, False)


def test_what_jumps_or_needs_a_whole_run_is_no_lane():
    case = rb.case("paper").replace(BASE)
    jumps = outputs_at(case.deck, ("torsion",), [18.0])
    smooth = outputs_at(case.deck, ("displacement_z",), [18.0])
    assert not eligible(case.deck, job_of(case), jumps, False)
    assert eligible(case.deck, job_of(case), smooth, False)
    assert not eligible(case.deck, job_of(case), smooth, True)


def test_a_deck_with_a_rail_is_computed_one_crossing_after_the_other():
    bed = {"bending_stiffness": 1.28e7, "foundation": 1e8}
    found = {}
    for rail in (None, bed):
        case = rb.case("paper").replace({**BASE, "deck.rail": rail, "run.tail": 0.2})
        asked = asked_of(outputs_at(case.deck, NAMES, [18.0]))
        job = job_of(case)
        found[rail is None] = eligible(case.deck, job, asked.outputs, False)
    assert found == {True: True, False: False}
    (row,) = respond(case.deck, [job], asked, side_by_side=True)
    expected = row_of_run(compute(case.train, case.deck, case.track, case.settings), asked)
    assert np.array_equal(row.values, expected.values, equal_nan=True)
