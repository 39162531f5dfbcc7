"""The fixed point with somebody else's deck: loads to nodes, displacements back, against our own iteration."""

import re

import numpy as np
import pytest

import railbridge as rb
from opensees import viaduct36_in_mm
from railbridge import exchange, staggered
from railbridge.inputs import data_root

NODES = exchange.read_nodes(data_root() / "exchange" / "viaduct36_mm" / "nodes.csv")
AXIS = NODES.line({"y": 0.0, "z": 0.0})
ARM = NODES.line({"y": 3.38, "z": 1.3}, {"y": 0.0, "z": 0.0})
PAIR = NODES.line({"left": {"y": 3.38, "z": 1.3}, "right": {"y": 1.42, "z": 1.3}}, {"y": 0.0, "z": 0.0})
TRACK = rb.Track(vertical=rb.Harmonic(5e-3, wavelength=14.4), lateral=rb.Harmonic(2e-3, wavelength=14.4))
TRAIN = rb.Train(rb.vehicle("xia2000"), cars=1)
OPTIONS = {"speed": 20.0, "track_offset": 2.4, "time_step": 2e-3, "tail": 0.2, "lead_in": 0.0}


@pytest.fixture(scope="module")
def ours():
    return rb.cross(TRAIN, rb.deck("viaduct36"), TRACK, iterations=3, **OPTIONS)


def answer(deck, loads):
    """What OpenSeesPy, in N, mm, t, s, answers to loads on the axis nodes: mm and rad, shape (3, nodes, t)."""
    return deck.respond(loads.time, list(loads.functions()))


def write_motion(path, line, time, moved):
    rows = np.array([[t, int(label), *moved[:, n, k]] for n, label in enumerate(line.nodes) for k, t in enumerate(time)])
    np.savetxt(path, rows, delimiter=",", header="time,node,uy,uz,rx", comments="", fmt=["%.9g", "%d", *["%.12g"] * 3])


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


# ---- against another program


@pytest.mark.parametrize("couples", [True, False])
def test_nodal_loads_give_our_displacement_in_another_program(ours, couples):
    loads = staggered.nodal_loads(ours, _line(36), couples)
    moved = answer(viaduct36_in_mm(36), loads) * [[[1e-3]], [[1e-3]], [[1.0]]]
    # The middle of 36 elements is node 19. Twist has some 2 % of its energy in modes that nodal masses shift.
    for component, name, limit in ((1, "displacement_z", 2e-3), (0, "displacement_y", 5e-3), (2, "rotation_x", 5e-3)):
        other, own = moved[component, 18], ours.displacement(18.0)[name]
        assert np.max(np.abs(other)) == pytest.approx(np.max(np.abs(own)), rel=limit)
        assert rms(other) == pytest.approx(rms(own), rel=limit)
        assert rms(other - own) < 2 * limit * rms(own)


def _line(elements):
    places = np.zeros((elements + 1, 3))
    places[:, 0] = np.linspace(0.0, 36.0, elements + 1)
    return exchange.Nodes(tuple(str(i + 1) for i in range(elements + 1)), places, ("mm", "t")).line()


def test_the_fixed_point_with_another_program_is_ours(ours, tmp_path):
    """Three passes, files in between: the paper's procedure with a deck we did not write."""
    deck, line = viaduct36_in_mm(36), _line(36)
    step = staggered.begin(TRAIN, TRACK, line, **OPTIONS)
    assert np.array_equal(step.wheel_forces, ours.at(0).wheel_forces)
    for iteration in (1, 2, 3):
        loads = staggered.export_loads(step, tmp_path / "loads.csv")
        write_motion(tmp_path / "motion.csv", line, loads.time, answer(deck, loads))
        step = staggered.next_forces(step, staggered.read_motion(tmp_path / "motion.csv", line))
        assert step.shown == iteration
        assert step.changes[-1] == pytest.approx(ours.changes[iteration - 1], rel=0.02)
        added, own = step.passes[-1][0], ours.passes[iteration][0]
        # The deck's share of the forces, itself a few per cent of their dynamic part.
        assert rms(added[1::2] - own[1::2]) < 0.015 * rms(own[1::2])
        dynamic = ours.wheel_forces[:, 1] - ours.wheel_forces[:, 1].mean(axis=1, keepdims=True)
        assert rms(step.wheel_forces[:, 1] - ours.at(iteration).wheel_forces[:, 1]) < 1e-3 * rms(dynamic)
    assert step.changes[2] < step.changes[0] / 100


# ---- with our own deck as the other program: every difference is ours


def motion_of(run, line):
    """Our own deck's displacements at the nodes of a line, as another program would give them."""
    values = [run.displacement(min(x, 36.0)).values for x in line.x]
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
        assert rms(added[1::2] - own[1::2]) < 5e-3 * rms(own[1::2])
    assert np.max(np.abs(step.wheel_forces - ours.at(2).wheel_forces)) < 0.01 * np.max(np.abs(ours.passes[2][0]))


def test_other_instants_and_units_do_not_matter(ours, tmp_path):
    motion = motion_of(ours.at(0), AXIS)
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    fine = staggered.next_forces(step, motion)
    moved = np.array([motion.y * 1e3, motion.z * 1e3, motion.roll])
    write_motion(tmp_path / "motion.csv", AXIS, motion.time, moved)
    from_file = staggered.next_forces(step, staggered.read_motion(tmp_path / "motion.csv", AXIS))
    assert rms(from_file.passes[1][0] - fine.passes[1][0]) < 1e-6 * rms(fine.passes[1][0])
    thin = staggered.NodeMotion(motion.time[::2], motion.y[:, ::2], motion.z[:, ::2], motion.roll[:, ::2])
    coarse = staggered.next_forces(step, thin)
    assert rms(coarse.passes[1][0][1::2] - fine.passes[1][0][1::2]) < 0.02 * rms(fine.passes[1][0][1::2])


def test_relaxation_takes_a_share(ours):
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    motion = motion_of(ours.at(0), AXIS)
    whole, half = staggered.next_forces(step, motion), staggered.next_forces(step, motion, share=0.5)
    assert half.passes[1][0] == pytest.approx(0.5 * whole.passes[1][0])
    assert half.changes == whole.changes


def test_the_equivalent_irregularity_is_track_plus_deck(ours):
    step = staggered.next_forces(staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS), motion_of(ours.at(0), AXIS))
    met = staggered.equivalent_irregularity(step, car=1, wheel=3)
    wheel = TRAIN.wheels[2]
    assert (wheel.number, wheel.side) == (3, "left")
    for k in (400, 700, 900):
        x = 20.0 * met.time[k] - wheel.delay
        assert 0.0 < x < 36.0
        deck = ours.at(0).displacement(x)
        track = 5e-3 * np.sin(2 * np.pi * x / 14.4)
        own = deck["displacement_z"][k] + (2.4 + wheel.y) * deck["rotation_x"][k]
        assert met["track_z"][k] == pytest.approx(track, rel=1e-9)
        assert met["equivalent_z"][k] == pytest.approx(track + own, rel=1e-4)
        assert met["deck_y"][k] == pytest.approx(deck["displacement_y"][k], rel=1e-2, abs=1e-9)


# ---- statics of the distribution


@pytest.mark.parametrize("loads", ["wheels", "bogies", "condensed"])
@pytest.mark.parametrize("couples", [True, False])
@pytest.mark.parametrize("line", [AXIS, ARM, PAIR], ids=["axis", "arm", "pair"])
def test_nodal_loads_are_statically_equivalent_at_every_instant(line, couples, loads):
    run = rb.cross(TRAIN, rb.deck("viaduct36"), TRACK, loads=loads, interaction="rigid", **OPTIONS)
    found = staggered.nodal_loads(run, line, couples)
    places = np.stack([np.repeat(line.x, line.y.shape[1]), line.y.ravel(), line.z.ravel()], axis=1)
    force = found.values[:, :3].sum(axis=0)
    moment = found.values[:, 3:].sum(axis=0) + np.cross(places[:, None], found.values[:, :3].transpose(0, 2, 1)).sum(axis=0).T
    want = np.zeros((6, len(run.time)))
    coupling = run.coupling
    for delay, start, load in zip(
        coupling.load_delays, coupling.loads.starts, coupling.station_loads(run.passes[0]), strict=True
    ):
        window = slice(start, start + load.shape[1])
        x = 20.0 * run.time[window] - delay
        load = np.concatenate([load, np.zeros((5 - len(load), load.shape[1]))])
        want[1:3, window] += load[:2]
        want[3, window] += load[2]
        want[4, window] += load[3] - x * load[1]
        want[5, window] += load[4] + x * load[0]
    assert force == pytest.approx(want[:3], abs=1e-9 * np.abs(want[2]).max())
    assert moment == pytest.approx(want[3:], abs=1e-9 * np.abs(want[4]).max())
    if line.paired and not couples:
        assert not found.values[:, 3:].any(), "solid elements take no couples"


# ---- files


def test_the_load_table_holds_what_was_computed(ours, tmp_path):
    loads = staggered.export_loads(ours, tmp_path / "loads.csv", AXIS, every=5)
    header, *rows = (tmp_path / "loads.csv").read_text(encoding="utf-8").splitlines()
    names = header.split(",")
    table = np.array([row.split(",") for row in rows], dtype=float)
    assert names[0] == "t (s)" and table[:, 0] == pytest.approx(loads.time[::5])
    assert len(names) == len(set(names)) == table.shape[1]
    column = names.index("node 13 force_z (N)")
    assert table[:, column] == pytest.approx(loads.values[12, 2, ::5], rel=1e-8)
    # Couples in N mm, as the model has them.
    column = names.index("node 13 moment_x (N mm)")
    assert table[:, column] == pytest.approx(1e3 * loads.values[12, 3, ::5], rel=1e-8)
    assert not any("force_x" in name for name in names)


def test_loads_follow_the_axes_of_the_model(ours):
    """y up: the model's y is our z, and its z our -y."""
    nodes = exchange.Nodes(AXIS.nodes, NODES.places[:25], ("m", "t"), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]))
    plain = staggered.nodal_loads(ours, AXIS).values
    values, unit = staggered.nodal_loads(ours, nodes.line()).of_model()
    assert unit == "kN"
    assert values[:, 1] == pytest.approx(plain[:, 2] / 1e3)
    assert values[:, 2] == pytest.approx(-plain[:, 1] / 1e3)
    assert values[:, 4] == pytest.approx(plain[:, 5] / 1e3)


def test_the_abaqus_files_say_the_same(ours, tmp_path):
    loads = staggered.export_loads(ours, tmp_path / "rail.inp", AXIS, form="abaqus", instance="DECK-1")
    text = (tmp_path / "rail.inp").read_text(encoding="ascii")
    blocks = dict(re.findall(r"\*AMPLITUDE, NAME=(\w+)\n((?:[^*]+\n)+)", text))
    functions = {f"RB_{node}_{component + 1}": values for node, component, values in loads.functions()}
    assert set(blocks) == set(functions)
    for name in ("RB_13_3", "RB_13_4", "RB_2_5"):
        lines = blocks[name].splitlines()
        assert max(line.count(",") for line in lines) == 7, "four pairs a line"
        pairs = np.array(", ".join(lines).split(", "), dtype=float).reshape(-1, 2)
        assert np.all(np.diff(pairs[:, 0]) > 0)
        back = np.interp(loads.time, pairs[:, 0], pairs[:, 1], left=0.0, right=0.0)
        assert back == pytest.approx(functions[name], rel=1e-7, abs=1e-7 * np.abs(functions[name]).max())
    applied = re.findall(
        r"\*CLOAD, AMPLITUDE=(\w+)\n([\w.-]+), (\d), 1.0\n", (tmp_path / "rail_loads.inp").read_text(encoding="ascii")
    )
    assert {name for name, _, _ in applied} == set(functions)
    assert ("RB_13_3", "DECK-1.13", "3") in applied
    assert max(len(line) for line in text.splitlines()) <= 256


# ---- bad input


def test_histories_that_cannot_be_used_are_refused(ours, tmp_path):
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    good = motion_of(ours.at(0), AXIS)
    spoiled = {
        "must cover the crossing": staggered.NodeMotion(good.time[:500], good.y[:, :500], good.z[:, :500], good.roll[:, :500]),
        "is not at rest at the start": staggered.NodeMotion(good.time, good.y, good.z - 0.03, good.roll),
        "must be finite": staggered.NodeMotion(good.time, good.y, good.z * np.nan, good.roll),
        "must have 25 nodes": staggered.NodeMotion(good.time, good.y, good.z[:20], good.roll),
        "must ascend": staggered.NodeMotion(good.time[::-1], good.y, good.z, good.roll),
    }
    for message, motion in spoiled.items():
        with pytest.raises(rb.InputError, match=message):
            staggered.next_forces(step, motion)
    with pytest.warns(UserWarning, match="are the units right"):
        staggered.next_forces(step, staggered.NodeMotion(good.time, 1e3 * good.y, 1e3 * good.z, 1e3 * good.roll))
    path = tmp_path / "motion.csv"
    moved, instants = np.array([good.y, good.z, good.roll])[:, :, ::50], good.time[::50]
    for edit, message in [
        (lambda lines: [x for x in lines if x.split(",")[1] != "7"], "node = '7': of the rail line is missing"),
        (lambda lines: lines[:-1], "node 25: has not the instants of node 1"),
        (lambda lines: [",".join(x.split(",")[:3]) for x in lines], "column uz: is missing: the vertical displacement"),
        (lambda lines: [lines[0], lines[1] + "x", *lines[2:]], "line 2: rx"),
    ]:
        write_motion(path, AXIS, instants, moved)
        path.write_text("\n".join(edit(path.read_text(encoding="utf-8").splitlines())), encoding="utf-8")
        with pytest.raises(rb.InputError, match=re.escape(message)):
            staggered.read_motion(path, AXIS)


def test_other_refusals_name_the_field(ours, tmp_path):
    with pytest.raises(rb.InputError, match="line: is missing"):
        staggered.nodal_loads(ours)
    with pytest.raises(rb.InputError, match="as long as the deck"):
        staggered.nodal_loads(rb.cross(TRAIN, rb.deck_from_table("d", SHORT), interaction="rigid", speed=20.0), AXIS)
    with pytest.raises(rb.InputError, match="form = 'nastran'"):
        staggered.export_loads(ours, tmp_path / "x.csv", AXIS, form="nastran")
    with pytest.raises(rb.InputError, match="its folder does not exist"):
        staggered.export_loads(ours, tmp_path / "no" / "x.csv", AXIS)
    with pytest.raises(rb.InputError, match="run.tolerance: unknown key"):
        staggered.begin(TRAIN, TRACK, AXIS, speed=20.0, tolerance=1e-3)
    step = staggered.begin(TRAIN, TRACK, AXIS, **OPTIONS)
    with pytest.raises(rb.InputError, match="wheel"):
        staggered.equivalent_irregularity(step, car=2)


SHORT = {"length": 30.0, "bending_stiffness_vertical": 8e10, "mass": 12e3, "damping": {"modal": 0.02}}


def test_bare_axles_go_out_too():
    train = rb.AxleTrain([0.0, 3.0], [1e5, 2e5])
    step = staggered.begin(train, rb.Track(), AXIS, speed=30.0)
    total = staggered.nodal_loads(step).values[:, 2].sum(axis=0)
    assert total.min() == pytest.approx(-3e5) and total[0] == pytest.approx(-1e5)
    still = staggered.NodeMotion(step.time, *np.zeros((3, 25, len(step.time))))
    assert staggered.next_forces(step, still).changes == (0.0,)
