"""The fixed point with somebody else's deck, against our own iteration."""

import re
from dataclasses import replace

import numpy as np
import pytest
from nodal import ARM, AXIS, OPTIONS, PAIR, TRACK, TRAIN, answer, line_of, rms
from opensees import viaduct36_in_mm

import railbridge as rb
from railbridge.exchange import staggered


@pytest.fixture(scope="module")
def ours():
    return rb.cross(TRAIN, rb.deck("viaduct36"), TRACK, iterations=3, **OPTIONS)


def write_motion(path, line, time, moved):
    rows = np.array(
        [
            [t, int(label), *moved[:, n, k]]
            for n, label in enumerate(line.nodes)
            for k, t in enumerate(time)
        ]
    )
    np.savetxt(
        path,
        rows,
        delimiter=",",
        header="time,node,uy,uz,rx",
        comments="",
        fmt=["%.9g", "%d", *["%.12g"] * 3],
    )


# ---- against another program


def test_the_fixed_point_with_another_program_is_ours(ours, tmp_path):
    """Three passes, files in between: the paper's procedure with a deck we did not write."""
    deck, line = viaduct36_in_mm(36), line_of(36)
    step = staggered.begin(TRAIN, TRACK, line, **OPTIONS)
    assert np.array_equal(step.wheel_forces, ours.at(0).wheel_forces)
    for iteration in (1, 2, 3):
        loads = staggered.export_loads(step, tmp_path / "loads.csv")
        write_motion(tmp_path / "motion.csv", line, loads.time, answer(deck, loads))
        step = staggered.next_forces(step, staggered.read_motion(tmp_path / "motion.csv", line))
        assert step.iteration == iteration
        assert step.changes[-1] == pytest.approx(ours.changes[iteration - 1], rel=0.02)
        added, own = step.passes[-1][0], ours.passes[iteration][0]
        # The deck's share of the forces, itself a few per cent of their dynamic part.
        assert rms(added[:, 1] - own[:, 1]) < 0.015 * rms(own[:, 1])
        dynamic = ours.wheel_forces[:, 1] - ours.wheel_forces[:, 1].mean(axis=1, keepdims=True)
        assert rms(step.wheel_forces[:, 1] - ours.at(iteration).wheel_forces[:, 1]) < 1e-3 * rms(
            dynamic
        )
    assert step.changes[2] < step.changes[0] / 100


# ---- with our own deck as the other program: every difference is ours


def motion_of(run, line):
    """Our own deck's displacements at the nodes of a line, as another program would give them."""
    values = [run.displacement(min(x, 36.0), kept_only=True).values for x in line.x]
    y, z, roll = (np.repeat([v[n] for v in values], line.y.shape[1], axis=0) for n in values[0])
    arm_y, arm_z = line.y.ravel()[:, None], line.z.ravel()[:, None]
    return staggered.NodeMotion(run.time, y - arm_z * roll, z + arm_y * roll, roll)


@pytest.mark.parametrize("line", [AXIS, ARM, PAIR], ids=["axis", "arm", "pair"])
def test_displacements_of_our_own_deck_give_our_own_next_forces(ours, line):
    step = staggered.begin(TRAIN, TRACK, line, **OPTIONS)
    for iteration in (1, 2):
        step = staggered.next_forces(step, motion_of(ours.at(iteration - 1), line))
        added, own = step.passes[-1][0], ours.passes[iteration][0]
        # Velocities come from a spline through 2 ms, places from a spline through 1.5 m.
        assert rms(added[:, 1] - own[:, 1]) < 5e-3 * rms(own[:, 1])
    assert np.max(np.abs(step.wheel_forces - ours.at(2).wheel_forces)) < 0.01 * np.max(
        np.abs(ours.passes[2][0])
    )


def test_other_instants_and_units_do_not_matter(ours, tmp_path):
    motion = motion_of(ours.at(0), AXIS)
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    fine = staggered.next_forces(step, motion)
    moved = np.array([motion.y * 1e3, motion.z * 1e3, motion.roll])
    write_motion(tmp_path / "motion.csv", AXIS, motion.time, moved)
    from_file = staggered.next_forces(step, staggered.read_motion(tmp_path / "motion.csv", AXIS))
    assert rms(from_file.passes[1][0] - fine.passes[1][0]) < 1e-6 * rms(fine.passes[1][0])
    thin = staggered.NodeMotion(
        motion.time[::2], motion.y[:, ::2], motion.z[:, ::2], motion.roll[:, ::2]
    )
    coarse = staggered.next_forces(step, thin)
    assert rms(coarse.passes[1][0][:, 1] - fine.passes[1][0][:, 1]) < 0.02 * rms(
        fine.passes[1][0][:, 1]
    )


UP_IS_Y = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


@pytest.mark.parametrize(("said", "metres"), [("# units: in", 0.0254), ("# units: m, t", 1.0)])
def test_a_motion_file_may_be_in_other_units_axes_and_order(tmp_path, said, metres):
    """The model has y up; the file says its own unit, and holds nodes that are not on the line."""
    line = replace(line_of(3), turn=UP_IS_Y)
    time, labels = np.arange(5) / 10, [*line.nodes, "77"]
    rng = np.random.default_rng(2)
    known = {(label, t): rng.normal(size=6) for label in labels for t in time}
    rows = [f"{t},{label}," + ",".join(map(repr, v.tolist())) for (label, t), v in known.items()]
    text = "\n".join([said, "time,node,ux,uy,uz,rx,ry,rz", *rng.permutation(rows)])
    (tmp_path / "motion.csv").write_text(text, encoding="utf-8")
    found = staggered.read_motion(tmp_path / "motion.csv", line)
    assert found.time.tolist() == time.tolist()
    for n, label in enumerate(line.nodes):
        for k, t in enumerate(time):
            _, uy, uz, rx, _, _ = known[label, t]
            assert found.y[n, k] == pytest.approx(-uz * metres)
            assert found.z[n, k] == pytest.approx(uy * metres)
            assert found.roll[n, k] == pytest.approx(rx)


def test_a_motion_file_lacks_a_column_by_the_name_that_the_model_has_for_it(tmp_path):
    line = replace(line_of(3), turn=UP_IS_Y)
    (tmp_path / "motion.csv").write_text("time,node,uy\n0,1,0\n", encoding="utf-8")
    with pytest.raises(rb.InputError) as error:
        staggered.read_motion(tmp_path / "motion.csv", line)
    assert str(error.value) == (
        "motion.csv: column uz: is missing: the lateral displacement. Write zeros if none."
    )


def test_relaxation_takes_a_share(ours):
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    motion = motion_of(ours.at(0), AXIS)
    whole, half = (
        staggered.next_forces(step, motion),
        staggered.next_forces(step, motion, share=0.5),
    )
    assert half.passes[1][0] == pytest.approx(0.5 * whole.passes[1][0])
    assert half.changes == whole.changes


def test_relaxation_goes_from_the_last_pass_towards_the_next(ours):
    """Not from the rigid deck: the second pass keeps half of the first."""
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    first = staggered.next_forces(step, motion_of(ours.at(0), AXIS))
    motion = motion_of(ours.at(1), AXIS)
    whole, part = (staggered.next_forces(first, motion, share) for share in (1.0, 0.3))
    expected = 0.7 * first.passes[1][0] + 0.3 * whole.passes[2][0]
    assert rms(part.passes[2][0] - expected) < 1e-12 * rms(expected)
    assert rms(expected - 0.3 * whole.passes[2][0]) > 0.1 * rms(expected)
    assert part.changes == whole.changes


def test_rails_above_the_axis_move_sideways_as_the_deck_twists(ours):
    """By -h times the twist, in the forces and in the equivalent irregularity alike."""
    height, places = 1.5, (400, 700, 900)
    deck = replace(rb.deck("viaduct36"), track_height=height)
    high = rb.cross(TRAIN, deck, TRACK, iterations=1, **OPTIONS)
    step = staggered.begin(TRAIN, TRACK, AXIS, track_height=height, **OPTIONS)
    step = staggered.next_forces(step, motion_of(high.at(0), AXIS))
    added, own = step.passes[1][0][:, 0], high.passes[1][0][:, 0]
    assert rms(added - own) < 5e-2 * rms(own)
    assert rms(own - ours.passes[1][0][:, 0]) > 0.2 * rms(own), "the height matters here"
    met = staggered.equivalent_irregularity(step, car=1, wheel=3)
    for k in places:
        there = high.at(0).displacement(20.0 * met.time[k] - TRAIN.wheels[2].delay, kept_only=True)
        moved = there["displacement_y"][k] - height * there["rotation_x"][k]
        assert met["deck_y"][k] == pytest.approx(moved, rel=2e-2)


def test_the_equivalent_irregularity_is_track_plus_deck(ours):
    step = staggered.next_forces(
        staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS), motion_of(ours.at(0), AXIS)
    )
    met = staggered.equivalent_irregularity(step, car=1, wheel=3)
    assert met.where == "car 1, wheel 3" and set(met.units.values()) == {"m"}
    wheel = TRAIN.wheels[2]
    assert (wheel.number, wheel.side) == (3, "left")
    for k in (400, 700, 900):
        x = 20.0 * met.time[k] - wheel.delay
        assert 0.0 < x < 36.0
        deck = ours.at(0).displacement(x, kept_only=True)
        track = 5e-3 * np.sin(2 * np.pi * x / 14.4)
        own = deck["displacement_z"][k] + (2.4 + wheel.y) * deck["rotation_x"][k]
        assert met["track_z"][k] == pytest.approx(track, rel=1e-9)
        assert met["equivalent_z"][k] == pytest.approx(track + own, rel=1e-4)
        assert met["deck_y"][k] == pytest.approx(deck["displacement_y"][k], rel=1e-2, abs=1e-9)


def test_a_car_that_is_excited_as_one_meets_the_wave_of_its_middle():
    """Every wheel the same, as in the paper: no delay within the car."""
    options = {**OPTIONS, "excitation": "car"}
    step = staggered.begin(TRAIN, TRACK, AXIS, **options)
    met = [staggered.equivalent_irregularity(step, 1, wheel)["track_z"] for wheel in (1, 5, 8)]
    assert met[1] == pytest.approx(met[0], abs=1e-12) and met[2] == pytest.approx(met[0], abs=1e-12)
    wheel = TRAIN.wheels[0]
    x = 20.0 * step.time - wheel.delay + TRAIN.vehicles[0].length / 2 - wheel.x
    on = x > 0.0
    assert met[0][on] == pytest.approx(5e-3 * np.sin(2 * np.pi * x[on] / 14.4), abs=1e-9)


def test_without_twist_fed_back_a_wheel_meets_the_sag_of_the_axis_only(ours):
    step = staggered.begin(TRAIN, TRACK, AXIS, feedback="vertical", **OPTIONS)
    step = staggered.next_forces(step, motion_of(ours.at(0), AXIS))
    met = staggered.equivalent_irregularity(step, car=1, wheel=3)
    assert not met["deck_y"].any()
    for k in (400, 700, 900):
        there = ours.at(0).displacement(20.0 * met.time[k] - TRAIN.wheels[2].delay)
        assert abs(there["rotation_x"][k] * (2.4 + TRAIN.wheels[2].y)) > 1e-5
        assert met["deck_z"][k] == pytest.approx(there["displacement_z"][k], rel=1e-3)


# ---- bad input


def test_histories_that_cannot_be_used_are_refused(ours, tmp_path):
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    good = motion_of(ours.at(0), AXIS)
    spoiled = {
        "must cover the crossing": staggered.NodeMotion(
            good.time[:500], good.y[:, :500], good.z[:, :500], good.roll[:, :500]
        ),
        "is not at rest at the start": staggered.NodeMotion(
            good.time, good.y, good.z - 0.03, good.roll
        ),
        "must be finite": staggered.NodeMotion(good.time, good.y, good.z * np.nan, good.roll),
        "must have 25 nodes": staggered.NodeMotion(good.time, good.y, good.z[:20], good.roll),
        "and less than 1e6 m": staggered.NodeMotion(good.time, good.y * 1e308, good.z, good.roll),
        "must ascend": staggered.NodeMotion(good.time[::-1], good.y, good.z, good.roll),
    }
    for message, motion in spoiled.items():
        with pytest.raises(rb.InputError, match=message):
            staggered.next_forces(step, motion)
    with pytest.warns(UserWarning, match="are the units right"):
        staggered.next_forces(
            step, staggered.NodeMotion(good.time, 1e3 * good.y, 1e3 * good.z, 1e3 * good.roll)
        )
    path = tmp_path / "motion.csv"
    moved, instants = np.array([good.y, good.z, good.roll])[:, :, ::50], good.time[::50]
    for edit, message in [
        (
            lambda lines: [x for x in lines if x.split(",")[1] != "7"],
            "node = '7': of the rail line is missing",
        ),
        (lambda lines: lines[:-1], "node 25: has not the instants of node 1"),
        (
            lambda lines: [",".join(x.split(",")[:3]) for x in lines],
            "column uz: is missing: the vertical displacement",
        ),
        (lambda lines: [lines[0], lines[1] + "x", *lines[2:]], "line 2: rx"),
        (lambda lines: [lines[0], lines[1].rsplit(",", 1)[0] + ",1e308", *lines[2:]], "line 2: rx"),
    ]:
        write_motion(path, AXIS, instants, moved)
        path.write_text(
            "\n".join(edit(path.read_text(encoding="utf-8").splitlines())), encoding="utf-8"
        )
        with pytest.raises(rb.InputError, match=re.escape(message)):
            staggered.read_motion(path, AXIS)


def test_other_refusals_name_the_field():
    with pytest.raises(rb.InputError, match="^tolerance: unknown key"):
        staggered.begin(TRAIN, TRACK, AXIS, speed=20.0, tolerance=1e-3)
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    with pytest.raises(rb.InputError, match="wheel"):
        staggered.equivalent_irregularity(step, car=2)


def test_bare_axles_on_a_deck_at_rest_feel_nothing():
    step = staggered.begin(rb.AxleTrain([0.0, 3.0], [1e5, 2e5]), rb.Track(), AXIS, speed=30.0)
    still = staggered.NodeMotion(step.time, *np.zeros((3, 25, len(step.time))))
    assert staggered.next_forces(step, still).changes == (0.0,)


def test_displacements_of_our_own_deck_with_a_rail_give_our_own_next_forces():
    rail = rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
    ours = rb.cross(TRAIN, rb.deck("viaduct36", rail=rail), TRACK, iterations=2, **OPTIONS)
    line = line_of(36)
    step = staggered.begin(TRAIN, TRACK, line, rail=rail, **OPTIONS)
    assert np.array_equal(step.time, ours.time) and step.time[0] < 0.0
    step = staggered.next_forces(step, motion_of(ours.at(0), line))
    added, own = step.passes[-1][0], ours.passes[1][0]
    assert rms(added[:, 1] - own[:, 1]) < 5e-3 * rms(own[:, 1])
    met = staggered.equivalent_irregularity(step)
    before = met["deck_z"][ours.settings.before - 1]
    assert 0.0 != abs(before) < 0.1 * np.abs(met["deck_z"]).max()
