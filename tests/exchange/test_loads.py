"""Loads on another program's nodes: its answers against ours, statics, and the files."""

import csv
import re
from dataclasses import replace

import numpy as np
import pytest
from nodal import ARM, AXIS, NODES, OPTIONS, PAIR, TRACK, TRAIN, answer, line_of, rms
from opensees import viaduct36_in_mm

import railbridge as rb
from railbridge import exchange
from railbridge.exchange.loads import export_loads, nodal_loads
from railbridge.exchange.staggered import begin
from railbridge.guideways import PiecewiseCubic


@pytest.fixture(scope="module")
def ours():
    return rb.cross(TRAIN, rb.deck("viaduct36"), TRACK, iterations=3, **OPTIONS)


@pytest.mark.parametrize("couples", [True, False])
def test_nodal_loads_give_our_displacement_in_another_program(ours, couples):
    loads = nodal_loads(ours, line_of(36), couples)
    moved = answer(viaduct36_in_mm(36), loads) * [[[1e-3]], [[1e-3]], [[1.0]]]
    # The middle of 36 elements is node 19. Twist has some 2 % of its energy in modes that nodal
    # masses shift.
    for component, name, limit in (
        (1, "displacement_z", 2e-3),
        (0, "displacement_y", 5e-3),
        (2, "rotation_x", 5e-3),
    ):
        other, own = moved[component, 18], ours.displacement(18.0)[name]
        assert np.max(np.abs(other)) == pytest.approx(np.max(np.abs(own)), rel=limit)
        assert rms(other) == pytest.approx(rms(own), rel=limit)
        assert rms(other - own) < 2 * limit * rms(own)


@pytest.mark.parametrize("loads", ["wheels", "bogies", "condensed"])
@pytest.mark.parametrize("couples", [True, False])
@pytest.mark.parametrize("line", [AXIS, ARM, PAIR], ids=["axis", "arm", "pair"])
def test_nodal_loads_are_statically_equivalent_at_every_instant(line, couples, loads):
    run = rb.cross(TRAIN, rb.deck("viaduct36"), TRACK, loads=loads, interaction="rigid", **OPTIONS)
    found = nodal_loads(run, line, couples)
    places = np.stack([np.repeat(line.x, line.y.shape[1]), line.y.ravel(), line.z.ravel()], axis=1)
    force = found.values[:, :3].sum(axis=0)
    moment = (
        found.values[:, 3:].sum(axis=0)
        + np.cross(places[:, None], found.values[:, :3].transpose(0, 2, 1)).sum(axis=0).T
    )
    want = np.zeros((6, len(run.time)))
    coupling = run.coupling
    for delay, start, load in zip(
        coupling.load_delays,
        coupling.loads.starts,
        coupling.station_loads(run.passes[0]),
        strict=True,
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


def test_a_component_has_a_name(ours):
    loads = nodal_loads(ours, line_of(36))
    names = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")
    for k, name in enumerate(names):
        assert np.array_equal(loads.component(name), loads.values[:, k])
    with pytest.raises(rb.InputError, match="force_w"):
        loads.component("force_w")


def test_the_load_table_holds_what_was_computed(ours, tmp_path):
    loads = export_loads(ours, tmp_path / "loads.csv", AXIS, every=5)
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
    nodes = exchange.Nodes(
        AXIS.nodes, NODES.places[:25], ("m", "t"), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    )
    plain = nodal_loads(ours, AXIS).values
    values, unit = nodal_loads(ours, nodes.line()).of_model()
    assert unit == "kN"
    assert values[:, 1] == pytest.approx(plain[:, 2] / 1e3)
    assert values[:, 2] == pytest.approx(-plain[:, 1] / 1e3)
    assert values[:, 4] == pytest.approx(plain[:, 5] / 1e3)


POUND = 4.4482216152605  # N
AXLE = rb.cross(
    rb.AxleTrain([0.0], [1e5]), rb.deck("viaduct36"), speed=20.0, time_step=0.05, track_offset=2.4,
    interaction="rigid",
)  # fmt: skip


@pytest.mark.parametrize(
    ("units", "name", "newtons", "metres"),
    [
        (("m", "kg"), "N", 1.0, 1.0), (("mm", "t"), "N", 1.0, 1e-3), (("m", "t"), "kN", 1e3, 1.0),
        (("ft", "slug"), "lbf", POUND, 0.3048), (("in", "lbf s2/in"), "lbf", POUND, 0.0254),
        (("ft", "kip s2/ft"), "kip", 1e3 * POUND, 0.3048), (("m", "kN s2/m"), "kN", 1e3, 1.0),
        (("in", "kip s2/in"), "kip", 1e3 * POUND, 0.0254), (("mm", "kg"), "kg mm/s2", 1e-3, 1e-3),
    ],
)  # fmt: skip
def test_loads_are_in_the_unit_of_force_that_the_model_s_masses_ask_for(
    tmp_path, units, name, newtons, metres
):
    """Force is mass times length per second squared in every consistent set."""
    loads = nodal_loads(AXLE, replace(AXIS, units=units))
    values, unit = loads.of_model()
    assert unit == name
    assert values[:, :3] == pytest.approx(loads.values[:, :3] / newtons, rel=1e-9)
    assert values[:, 3:] == pytest.approx(loads.values[:, 3:] / newtons / metres, rel=1e-9)
    export_loads(AXLE, tmp_path / "x.csv", loads.line)
    names = (tmp_path / "x.csv").read_text(encoding="utf-8").partition("\n")[0].split(",")
    assert f"node 13 force_z ({name})" in names
    assert f"node 13 moment_x ({name} {units[0]})" in names
    export_loads(AXLE, tmp_path / "x.inp", loads.line, form="abaqus")
    for file in ("x.inp", "x_loads.inp"):
        head = (tmp_path / file).read_text(encoding="ascii").splitlines()[:2]
        assert head == [
            f"** railbridge: forces in {name}, couples in {name} {units[0]}, for a model in "
            f"{units[0]}, {units[1]}, s",
            "** step time 0: the first axle is at the first node",
        ]


def test_the_abaqus_files_say_the_same(ours, tmp_path):
    loads = export_loads(ours, tmp_path / "rail.inp", AXIS, form="abaqus", instance="DECK-1")
    text = (tmp_path / "rail.inp").read_text(encoding="ascii")
    blocks = dict(re.findall(r"\*AMPLITUDE, NAME=(\w+)\n((?:[^*]+\n)+)", text))
    functions = {
        f"RB_{node}_{component + 1}": values for node, component, values in loads.functions()
    }
    assert set(blocks) == set(functions)
    for name in ("RB_13_3", "RB_13_4", "RB_2_5"):
        lines = blocks[name].splitlines()
        assert max(line.count(",") for line in lines) == 7, "four pairs a line"
        pairs = np.array(", ".join(lines).split(", "), dtype=float).reshape(-1, 2)
        assert np.all(np.diff(pairs[:, 0]) > 0)
        back = np.interp(loads.time, pairs[:, 0], pairs[:, 1], left=0.0, right=0.0)
        assert back == pytest.approx(
            functions[name], rel=1e-7, abs=1e-7 * np.abs(functions[name]).max()
        )
    applied = re.findall(
        r"\*CLOAD, AMPLITUDE=(\w+)\n([\w.-]+), (\d), 1.0\n",
        (tmp_path / "rail_loads.inp").read_text(encoding="ascii"),
    )
    assert {name for name, _, _ in applied} == set(functions)
    assert ("RB_13_3", "DECK-1.13", "3") in applied
    assert max(len(line) for line in text.splitlines()) <= 256


SHORT = {
    "length": 30.0,
    "bending_stiffness_vertical": 8e10,
    "mass": 12e3,
    "damping": {"modal": 0.02},
}


def test_other_refusals_name_the_field(ours, tmp_path):
    with pytest.raises(rb.InputError, match="line: is missing"):
        nodal_loads(ours)
    with pytest.raises(rb.InputError, match="as long as the deck"):
        nodal_loads(
            rb.cross(TRAIN, rb.deck_from_table("d", SHORT), interaction="rigid", speed=20.0), AXIS
        )
    with pytest.raises(rb.InputError, match="form = 'nastran'"):
        export_loads(ours, tmp_path / "x.csv", AXIS, form="nastran")
    with pytest.raises(rb.InputError, match="its folder does not exist"):
        export_loads(ours, tmp_path / "no" / "x.csv", AXIS)


@pytest.mark.parametrize("label", ["Tr\u00e4ger", "a b", "1,2", "x\ny"])
def test_nodes_that_an_abaqus_file_cannot_name_are_refused(ours, tmp_path, label):
    named = replace(AXIS, labels=tuple((f"{label}{i}",) for i in range(len(AXIS.x))))
    with pytest.raises(rb.InputError, match="cannot name a node in an Abaqus file"):
        export_loads(ours, tmp_path / "x.inp", named, form="abaqus")
    export_loads(ours, tmp_path / "x.csv", named)
    with (tmp_path / "x.csv").open(encoding="utf-8", newline="") as file:
        assert f"node {label}" in next(csv.reader(file))[1]


def test_bare_axles_go_out_too():
    step = begin(rb.AxleTrain([0.0, 3.0], [1e5, 2e5]), rb.Track(), AXIS, speed=30.0)
    total = nodal_loads(step).values[:, 2].sum(axis=0)
    assert total.min() == pytest.approx(-3e5) and total[0] == pytest.approx(-1e5)


def test_loads_that_would_not_fit_into_memory_are_refused(ours, tmp_path):
    with pytest.raises(rb.InputError, match=r"^line = 20001: loads of so many nodes at .* 2 GB"):
        nodal_loads(ours, long_line(tmp_path, 20_000))
    with pytest.raises(rb.InputError, match=r"^line = 4001: shapes of so many nodes .* 2 GB"):
        begin(TRAIN, TRACK, long_line(tmp_path, 4000), **OPTIONS)


def long_line(folder, elements):
    rows = (f"{i},{36.0 * i / elements!r},0,0\n" for i in range(elements + 1))
    path = folder / "nodes.csv"
    path.write_text("# units: m, kg\nnode,x,y,z\n" + "".join(rows))
    return exchange.read_nodes(path).line()


RAILS = [rb.Rail(spread=0.6), rb.Rail(bending_stiffness=1.28e7, foundation=1e8)]


def test_step_time_of_the_abaqus_files_begins_with_the_record(tmp_path):
    """What a rail brings onto the deck before t = 0 is not lost before the step's start."""
    deck = rb.deck("viaduct36", rail=RAILS[1])
    run = rb.cross(TRAIN, deck, TRACK, interaction="rigid", **OPTIONS)
    loads = export_loads(run, tmp_path / "x.inp", AXIS, form="abaqus")
    text = (tmp_path / "x.inp").read_text(encoding="ascii")
    late = -loads.time[0]
    assert f"** step time {late:.9g}: the first axle is at the first node" in text
    block = re.search(r"NAME=RB_1_3\n((?:[^*]+\n)+)", text)[1]
    pairs = np.array(", ".join(block.splitlines()).split(", "), dtype=float).reshape(-1, 2)
    assert pairs[0, 0] == 0.0 and late > 0.5
    back = np.interp(loads.time + late, pairs[:, 0], pairs[:, 1], left=0.0, right=0.0)
    function = loads.component("force_z")[0]
    assert back == pytest.approx(function, abs=1e-7 * np.abs(function).max())


@pytest.mark.parametrize("rail", RAILS, ids=["sleepers", "bed"])
@pytest.mark.parametrize("couples", [True, False])
@pytest.mark.parametrize("line", [AXIS, PAIR], ids=["axis", "pair"])
def test_a_rail_spreads_loads_over_the_nodes(rail, couples, line):
    """The sums over all nodes: what arrives on the deck, and its moments about x = 0."""
    deck = rb.deck("viaduct36", rail=rail)
    run = rb.cross(TRAIN, deck, TRACK, loads="bogies", interaction="rigid", **OPTIONS)
    found = nodal_loads(run, line, couples)
    assert np.array_equal(found.time, run.time) and found.time[0] < 0.0
    places = np.stack([np.repeat(line.x, line.y.shape[1]), line.y.ravel(), line.z.ravel()], axis=1)
    moment = (
        found.values[:, 3:].sum(axis=0)
        + np.cross(places[:, None], found.values[:, :3].transpose(0, 2, 1)).sum(axis=0).T
    )
    # One and x along the deck, cubics of one piece.
    one, along = np.eye(4)[0], np.array([0.0, 36.0, 0.0, 0.0])
    known = PiecewiseCubic(np.array([0.0, 36.0]), np.array([one, along]).T[None, :, :, None])
    under, want, coupling = deck.under_rail(known), np.zeros((6, len(run.time))), run.coupling
    for delay, start, load in zip(
        coupling.load_delays, coupling.loads.starts, coupling.station_loads(run.passes[0]),
        strict=True,
    ):  # fmt: skip
        window = slice(start, start + load.shape[1])
        x = 20.0 * run.time[window] - delay
        (share, arm), (share_turn, turn) = under(x)[:, :, 0].T, under(x, 1)[:, :, 0].T
        want[1, window] += share * load[0] + share_turn * load[4]
        want[2, window] += share * load[1] - share_turn * load[3]
        want[3, window] += share * load[2]
        want[4, window] += turn * load[3] - arm * load[1]
        want[5, window] += turn * load[4] + arm * load[0]
    force = found.values[:, :3].sum(axis=0)
    # Not where a sleeper stands on the deck's end, which rounding decides.
    clear = np.abs(moment - want[3:]).max(axis=0) < 1e-6 * np.abs(want[4]).max()
    assert np.mean(clear) > (0.98 if rail.spread else 0.9999)
    assert force[:, clear] == pytest.approx(want[:3, clear], abs=1e-6 * np.abs(want[2]).max())
    assert np.abs(want[2, clear]).max() > 585e3  # the whole car, and what the waves add


def test_a_rail_gives_our_displacement_in_another_program():
    ours = rb.cross(TRAIN, rb.deck("viaduct36", rail=RAILS[1]), TRACK, iterations=2, **OPTIONS)
    loads = nodal_loads(ours, line_of(36))
    moved = answer(viaduct36_in_mm(36), loads)[1, 18] * 1e-3
    own = ours.displacement(18.0)["displacement_z"]
    assert rms(moved - own) < 4e-3 * rms(own)
