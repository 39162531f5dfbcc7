"""Bearings off the axis, elastic ones and simple spans, against a frame program of its own and hand
formulas."""

from dataclasses import replace

import numpy as np
import pytest
from frame import RIGID, Frame
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import railbridge as rb
from railbridge.beams.bearings import FIXITIES, free_motions, null_space, on_deck

L, M, E = 36.0, 12e3, 35e9
EI, EIZ, GJ, EA, INERTIA = E * 2.553, E * 25.53, E / 2.4 * 5.59, E * 4.8, 2500 * 28.083
USUAL = ("y", "z", "roll")
QUANTITIES = {"force_x": 0, "force_y": 1, "force_z": 2, "moment_x": 3, "moment_y": 4, "moment_z": 5}


def deck_on(*bearings, length=L, **more):
    """The beam of viaduct36 on given bearings."""
    return rb.Beam("b", (length,), M, EI, EIZ, GJ, EA, INERTIA, bearings=bearings, **more)


def frame_of(beam, count=72):
    springs = [
        (
            b.x,
            b.y,
            b.z,
            {FIXITIES.index(f): b.stiffness.get(f, RIGID) for f in (*b.fixed, *b.stiffness)},
        )
        for b in beam.bearings
    ]
    return Frame(
        beam.length, count, EA, EIZ, EI, GJ, M, INERTIA, beam.shear_stiffness_lateral,
        beam.shear_stiffness_vertical,
        beam.rotary_inertia_lateral or 0.0, beam.rotary_inertia_vertical or 0.0,
        beam.centroid_height, springs,
    )  # fmt: skip


@st.composite
def arrangements(draw):
    """Two or three lines of two bearings, anywhere; lengthwise and sideways held at one of them at
    least."""
    lines = draw(st.sampled_from([(0.0, 36.0), (4.0, 30.0), (0.0, 16.0, 36.0), (2.5, 33.5)]))
    height = draw(st.floats(-2.0, 0.5))
    bearings = []
    for i, x in enumerate(lines):
        half = draw(st.floats(0.5, 3.0))
        for y in (half, -half):
            holds = (
                {"z"}
                | ({"x", "y"} if (i, y) == (0, half) else set())
                | ({"y"} if (i, y) == (1, half) else set())
            )
            holds |= set(draw(st.lists(st.sampled_from(FIXITIES), max_size=2)))
            soft = {f: draw(st.floats(8.0, 11.0)) for f in sorted(holds) if draw(st.booleans())}
            bearings.append(
                rb.Bearing(
                    x,
                    tuple(sorted(holds - set(soft))),
                    y,
                    height,
                    {f: 10.0**power for f, power in soft.items()},
                )
            )
    shear = draw(st.booleans())
    return deck_on(
        *bearings,
        centroid_height=draw(st.sampled_from([0.0, 0.6, -0.9])),
        shear_stiffness_vertical=2e10 if shear else None,
        shear_stiffness_lateral=3e10 if shear else None,
        rotary_inertia_vertical=2500 * 2.553 if shear else None,
        rotary_inertia_lateral=2500 * 25.53 if shear else None,
    )


@settings(max_examples=12)
@given(beam=arrangements())
def test_frequencies_are_those_of_a_frame_program(beam):
    ours, theirs = beam.modes.frequencies_hz[:8], frame_of(beam).frequencies(8)
    assert ours == pytest.approx(theirs, rel=4e-3)  # lumped masses


@settings(max_examples=15)
@given(
    beam=arrangements(),
    x=st.integers(0, 72),
    force=st.tuples(*[st.floats(-1.0, 1.0)] * 3),
    at=st.integers(1, 71),
)
def test_forces_and_displacements_are_those_of_a_frame_program(beam, x, force, at):
    """Elements are exact in statics, so only the very stiff springs of the other program differ
    from rigid bearings: they give, and a spring beside them (up to 4 m) takes some of the load."""
    x, at, load = x / 2, at / 2, np.array([1e5, 1e5, 3e5]) * force
    frame, recovery = frame_of(beam), beam.deck(3).recovery
    moved, forces = frame.under(x, [0.0, load[0], load[1], load[2], 0.0, 0.0])
    size = np.linalg.norm(force) * 1e5 + 1.0
    # A pair of bearings close together holds a load far away by forces larger than the load.
    size = max(size, *(abs(f) for (_, direction), f in forces.items() if direction < 3))

    def value(line):
        return float(line.influence(np.array([x]))[0, 0] @ load)

    for quantity, place in [("displacement_y", 1), ("displacement_z", 2), ("rotation_x", 3)]:
        theirs = moved[frame.at(at)][place]
        assert value(recovery.section(quantity, at)) == pytest.approx(
            theirs, abs=2e-5 * np.abs(moved).max() + 20 * size / RIGID
        )
    total = np.zeros(3)
    # Two bearings 1 m beside the axis hold yaw by springs of 2 RIGID, against up to 4e11 N m / rad
    # of the beam on both sides: 2e-5. What a spring 4 m beside a held roll takes of it goes with
    # the square of that distance.
    taken = (
        4.0**2 * max((k for b in beam.bearings for k in b.stiffness.values()), default=0.0) / RIGID
    )
    for i, b in enumerate(beam.bearings, start=1):
        for quantity, direction in QUANTITIES.items():
            line = recovery.bearing(i, quantity)
            assert (line is None) == (FIXITIES[direction] not in b.restrained)
            if line is not None:
                ours = value(line)
                assert ours == pytest.approx(
                    forces[i - 1, direction],
                    abs=(2.5e-5 + taken) * size * (1 if direction < 3 else 10),
                )
                total += ours * (direction == np.arange(3))
    # What the bearings exert holds the load, whatever the frame says.
    assert total == pytest.approx([0.0, -load[0], -load[1]], abs=1e-6 * size)


@settings(max_examples=10)
@given(beam=arrangements(), x=st.floats(0.0, L))
def test_line_reactions_are_sums_of_their_bearings_about_the_axis(beam, x):
    recovery, place = beam.deck(3).recovery, np.array([x])

    def value(line):
        return np.zeros(3) if line is None else line.influence(place)[0, 0]

    twist = np.zeros(3)
    for line in sorted({b.x for b in beam.bearings}):
        own = [(i, b) for i, b in enumerate(beam.bearings, start=1) if b.x == line]
        for quantity in ("force_x", "force_y", "force_z"):
            total = sum(value(recovery.bearing(i, quantity)) for i, _ in own)
            assert value(recovery.reaction(quantity, line)) == pytest.approx(total, abs=1e-7)
        couple = np.zeros(3)
        for i, b in own:
            sideways, up, twisting = (
                value(recovery.bearing(i, q)) for q in ("force_y", "force_z", "moment_x")
            )
            couple += twisting + b.y * up - b.z * sideways
        assert value(recovery.reaction("moment_x", line)) == pytest.approx(couple, abs=1e-6)
        twist += couple
    assert twist == pytest.approx([0.0, 0.0, -1.0], abs=1e-6)


@settings(max_examples=15)
@given(beam=arrangements(), here=st.floats(0.1, L - 0.1), there=st.floats(0.1, L - 0.1))
def test_every_displacement_answers_every_load_as_it_answers_back(beam, here, there):
    recovery = beam.deck(3).recovery
    quantities = ("displacement_y", "displacement_z", "rotation_x")

    def flexibility(a, b):
        return np.array([recovery.section(q, a).influence(np.array([b]))[0, 0] for q in quantities])

    forth, back = flexibility(here, there), flexibility(there, here)
    assert forth == pytest.approx(back.T, abs=1e-9 * np.abs(forth).max())


@settings(max_examples=6)
@given(beam=arrangements(), node=st.integers(2, 36))
def test_modal_values_add_up_to_the_static_lines(beam, node):
    """With all modes of the mesh, sum S_m phi_m / omega_m^2 is the influence line of a
    displacement, exactly so at the nodes."""
    count = int(np.sum(beam.modes.excitable))
    deck = beam.deck(count)
    x, at = beam.mesh.nodes[[4, 19, 33]], beam.mesh.nodes[node]
    lines = [
        deck.recovery.section(q, at) for q in ("displacement_y", "displacement_z", "rotation_x")
    ]
    for line in lines:
        modal = np.einsum(
            "kmc,m->kc", deck.shapes(x), line.modal / (2 * np.pi * deck.frequencies_hz) ** 2
        )
        exact = line.influence(x)[:, 0]
        assert modal == pytest.approx(exact, abs=1e-6 * np.abs(exact).max())
    # A spring's force follows from the mode's own shape, and all bearings together hold the mode's
    # inertia.
    kept, lifted = np.flatnonzero(beam.modes.excitable), np.zeros(count)
    for i, b in enumerate(beam.bearings, start=1):
        for quantity, direction in QUANTITIES.items():
            line, freedom = deck.recovery.bearing(i, quantity), FIXITIES[direction]
            if freedom in b.stiffness:
                here = beam.modes.vectors[6 * beam.mesh.node(b.x) :][:6, kept]
                theirs = -b.stiffness[freedom] * b.row(freedom, beam.centroid_height) @ here
                round_off = 1e-12 * b.stiffness[freedom] * np.abs(here).max()
                assert line.modal[:20] == pytest.approx(
                    theirs[:20], abs=1e-5 * np.abs(theirs[:20]).max() + round_off
                )
            lifted += line.modal if quantity == "force_z" else 0.0
    points = (np.arange(3600) + 0.5) / 100
    inertia = (
        M
        * deck.shapes(points)[:, :20, 1].sum(axis=0)
        / 100
        * (2 * np.pi * deck.frequencies_hz[:20]) ** 2
    )
    assert lifted[:20] == pytest.approx(-inertia, abs=1e-3 * np.abs(inertia).max())
    # Self-weight from the line itself.
    fine = (np.arange(7200) + 0.5) / 200
    for line in (lines[1], deck.recovery.reaction("force_z", beam.bearings[0].x)):
        weight = -M * 9.81 * line.influence(fine)[:, 0, 1].sum() / 200
        assert line.self_weight == pytest.approx(weight, rel=1e-4, abs=1e-9)


# ---- by hand


def test_load_on_a_deck_held_lengthwise_below_its_axis_makes_thrust():
    """Force method, released lengthwise: the end rotations under P, e below, against e^2 L / EI + L
    / EA + 1 / k per unit."""
    e, p = 1.3, 1e6
    for spring in (None, 4e8):
        far = (
            rb.Bearing(L, ("z", "y", "roll"), z=-e, stiffness={"x": spring})
            if spring
            else rb.Bearing(L, (*USUAL, "x"), z=-e)
        )
        recovery = deck_on(rb.Bearing(0.0, (*USUAL, "x"), z=-e), far).deck(3).recovery
        for a in (6.0, 18.0, 30.0):
            opening = e * p * a * (L - a) / (2 * EI)
            thrust = opening / (e**2 * L / EI + L / EA + (1 / spring if spring else 0.0))
            place = np.array([a])
            assert -p * recovery.reaction("force_x", 0.0).influence(place)[
                0, 0, 1
            ] == pytest.approx(thrust, rel=1e-9)
            assert -p * recovery.bearing(2, "force_x").influence(place)[0, 0, 1] == pytest.approx(
                -thrust, rel=1e-9
            )
            # The thrust hogs: the moment at mid-span is that of the simple beam less H e.
            simple = p * min(a, L - a) / 2
            moment = -p * recovery.section("moment_vertical", 18.0).influence(place)[0, 0, 1]
            assert moment == pytest.approx(-(simple - thrust * e), rel=1e-9)


def test_one_bearing_held_lengthwise_makes_no_thrust_but_couples_the_modes():
    beam = deck_on(rb.Bearing(0.0, (*USUAL, "x"), z=-1.3), rb.Bearing(L, USUAL, z=-1.3))
    recovery = beam.deck(3).recovery
    x = np.linspace(0.0, L, 19)
    assert np.abs(recovery.reaction("force_x", 0.0).influence(x)).max() < 1e-9
    assert recovery.reaction("force_x", L) is None
    assert recovery.section("displacement_z", 18.0).influence(x)[9, 0, 1] == pytest.approx(
        L**3 / 48 / EI, rel=1e-9
    )
    assert not any(n.startswith("axial ") for n in beam.deck(12).mode_names)


def test_second_bending_and_the_lengthwise_mode_form_a_pair():
    """A bearing 1.3 m below the axis, rigid and of 6e9 N/m: the second bending and the lengthwise
    mode share each other."""
    rigid = deck_on(rb.Bearing(0.0, (*USUAL, "x"), z=-1.3), rb.Bearing(L, USUAL, z=-1.3))
    soft = deck_on(
        rb.Bearing(0.0, USUAL, z=-1.3, stiffness={"x": 6e9}), rb.Bearing(L, USUAL, z=-1.3)
    )
    for beam, second, names in [
        (rigid, (12.33, 21.33), ("vertical bending 2", "axial-bending 1")),
        (soft, (11.60, 16.08), ("axial-bending 1", "axial-bending 2")),
    ]:
        modes = beam.modes
        found = dict(zip(modes.names, modes.frequencies_hz, strict=True))
        assert [found[n] for n in names] == pytest.approx(second, abs=0.01)
        theirs = frame_of(beam, 144).frequencies(6)
        assert modes.frequencies_hz[:6] == pytest.approx(theirs, rel=1e-3)
        share = modes.energies["axial"][[modes.names.index(n) for n in names]]
        assert np.all(share > 0.15) and np.all(share < 0.75)
    # With little shear area and rotary inertia the rigid bearing gives 11.5 and 19.8 Hz.
    shear = {"shear_stiffness_vertical": E / 2.4 * 1.0, "rotary_inertia_vertical": 2500 * 2.553}
    soft = deck_on(rb.Bearing(0.0, (*USUAL, "x"), z=-1.3), rb.Bearing(L, USUAL, z=-1.3), **shear)
    assert soft.modes.frequencies_hz[[0, 2, 4]] == pytest.approx([3.19, 11.49, 19.81], abs=0.01)
    assert soft.modes.frequencies_hz[:5] == pytest.approx(
        frame_of(soft, 144).frequencies(5), rel=1e-3
    )


def test_a_beam_on_springs_solves_its_characteristic_equation():
    """Symmetric modes between equal springs k: w = cosh a cos b x + cos a cosh b x about the
    middle, a = b L / 2."""
    for k in (1e6, 1e8, 1e10):

        def shear(a, k=k):
            b = 2 * a / L
            return EI * b**3 * (np.cosh(a) * np.sin(a) + np.cos(a) * np.sinh(a)) - 2 * k * np.cos(
                a
            ) * np.cosh(a)

        a = brentq(shear, 1e-6, np.pi / 2)
        ends = [rb.Bearing(x, ("y", "roll"), stiffness={"z": k}) for x in (0.0, L)]
        beam = rb.Beam("b", (L,), M, EI, bearings=tuple(ends))
        symmetric = (2 * a / L) ** 2 * np.sqrt(EI / M) / (2 * np.pi)
        assert np.min(np.abs(beam.modes.frequencies_hz / symmetric - 1)) < 1e-6
    # On the softest ones it is a rigid body: sqrt(2 k / m L).
    soft = rb.Beam(
        "b", (L,), M, EI, bearings=tuple(rb.Bearing(x, (), stiffness={"z": 1e6}) for x in (0.0, L))
    )
    assert soft.modes.frequencies_hz[0] == pytest.approx(
        np.sqrt(2e6 / M / L) / (2 * np.pi), rel=1e-2
    )
    assert soft.modes.names[0] == "vertical bending 1"


def test_springs_in_the_axis_only_lift_the_whole_deck():
    k = 5e8
    ends = [rb.Bearing(x, ("y", "roll"), stiffness={"z": k}) for x in (0.0, L)]
    recovery = rb.Beam("b", (L,), M, EI, bearings=tuple(ends)).deck(4).recovery
    middle = np.array([L / 2])
    assert recovery.section("displacement_z", L / 2).influence(middle)[0, 0, 1] == pytest.approx(
        L**3 / 48 / EI + 1 / (2 * k), rel=1e-9
    )
    assert [recovery.reaction("force_z", x).self_weight for x in (0.0, L)] == pytest.approx(
        [M * 9.81 * L / 2] * 2, rel=1e-9
    )
    assert recovery.section("moment_vertical", L / 2).self_weight == pytest.approx(
        -M * 9.81 * L**2 / 8, rel=1e-9
    )


def test_a_spring_does_nothing_where_the_deck_is_rigid():
    springs = {"x": 6e9, "y": 6e9, "roll": 1e9, "yaw": 1e9}
    ends = rb.Bearing(0.0, ("z",), stiffness=springs), rb.Bearing(L, ("z",), stiffness=springs)
    plane = rb.Beam("b", (L,), M, EI, bearings=ends)
    assert plane.modes.frequencies_hz == pytest.approx(
        rb.Beam("b", (L,), M, EI).modes.frequencies_hz
    )
    recovery = plane.deck(3).recovery
    assert [recovery.bearing(1, q) for q in ("force_x", "force_y", "moment_x", "moment_z")] == [
        None
    ] * 4


def test_overhangs_tip_as_in_the_book():
    a, span = 6.0, 24.0
    beam = deck_on(rb.Bearing(a, (*USUAL, "x")), rb.Bearing(a + span, USUAL))
    recovery = beam.deck(6).recovery
    tip = np.array([0.0])
    assert recovery.section("displacement_z", 0.0).influence(tip)[0, 0, 1] == pytest.approx(
        a**2 * (a + span) / (3 * EI), rel=1e-9
    )
    assert recovery.reaction("force_z", a).influence(tip)[0, 0, 1] == pytest.approx(
        -(1 + a / span), rel=1e-9
    )
    assert recovery.reaction("force_z", a + span).influence(tip)[0, 0, 1] == pytest.approx(
        a / span, rel=1e-9
    )
    assert recovery.section("moment_vertical", a).influence(tip)[0, 0, 1] == pytest.approx(
        -a, rel=1e-9
    )
    assert recovery.section("moment_vertical", a).self_weight == pytest.approx(
        M * 9.81 * a**2 / 2, rel=1e-9
    )


def test_two_bearings_carry_an_eccentric_load_by_the_lever_and_one_lifts():
    half = 1.5
    fixed = {
        (0.0, half): ("x", "y", "z"),
        (0.0, -half): ("z",),
        (L, half): ("y", "z"),
        (L, -half): ("z",),
    }
    deck = deck_on(*(rb.Bearing(x, f, y, -1.0) for (x, y), f in fixed.items())).deck(6)
    x, e, p = 9.0, 2.4, 1e6
    load = np.array([0.0, -p, -p * e])
    values = [
        float(deck.recovery.bearing(i, "force_z").influence(np.array([x]))[0, 0] @ load)
        for i in (1, 2, 3, 4)
    ]
    # About the far bearing of each line; torsion brings the couple to both lines by their distance,
    # as the load itself.
    near, far = p * (1 - x / L) * (half + e) / (2 * half), p * (1 - x / L) * (half - e) / (2 * half)
    assert values[:2] == pytest.approx([near, far], rel=1e-9)
    assert far < 0 and sum(values) == pytest.approx(p, rel=1e-9)
    with pytest.raises(rb.InputError, match=r"^number = 5: must be .* at most 4"):
        deck.recovery.bearing(5, "force_z")
    run = rb.cross(rb.AxleTrain([0.0], [p]), deck, speed=20.0, track_offset=e, time_step=5e-3)
    forces, lines = run.bearing_forces(), run.reactions()
    assert list(forces) == [1, 2, 3, 4] and "y = -1.5" in forces[2].where
    assert forces[1]["force_z"] + forces[2]["force_z"] == pytest.approx(
        lines[0.0]["force_z"], abs=1e-6 * p
    )
    assert forces[2]["force_z"].min() < -0.25 * p
    assert np.isnan(forces[2]["force_y"]).all() and np.isnan(forces[4]["force_x"]).all()
    weight = run.bearing_forces(self_weight=True)[2]["force_z"] - forces[2]["force_z"]
    assert weight == pytest.approx(M * 9.81 * L / 4, rel=1e-9)
    own = replace(deck, bearings=())
    with pytest.raises(rb.InputError, match="no single bearings"):
        rb.cross(rb.AxleTrain([0.0], [p]), own, speed=20.0).bearing_forces()


def test_rigid_bearings_that_share_a_force_share_it_as_equally_stiff_ones():
    """Both hold y on one section: statics cannot say who takes how much."""
    pair = [
        rb.Bearing(x, ("x", "y", "z") if x == 0.0 else ("y", "z"), y, -1.0)
        for x in (0.0, L)
        for y in (2.0, -2.0)
    ]
    deck = deck_on(*pair).deck(4)
    sideways = [
        deck.recovery.bearing(i, "force_y").influence(np.array([12.0]))[0, 0, 0]
        for i in (1, 2, 3, 4)
    ]
    assert sideways[0] == pytest.approx(sideways[1], rel=1e-12) and sum(sideways) == pytest.approx(
        -1.0, rel=1e-9
    )


# ---- simple spans


def test_a_row_of_simple_spans_is_so_many_beams():
    row = rb.Beam("row", (20.0, 30.0, 20.0), M, EI, EIZ, GJ, EA, INERTIA, continuous=False)
    single = {
        s: rb.Beam("one", (s,), M, EI, EIZ, GJ, EA, INERTIA, elements=n)
        for s, n in ((20.0, 12), (30.0, 17))
    }
    alone = np.sort(
        np.concatenate([single[s].modes.frequencies_hz[:6] for s in (20.0, 20.0, 30.0)])
    )[:8]
    assert row.modes.frequencies_hz[:8] == pytest.approx(alone, rel=1e-8)
    assert row.deck(4).supports == (0.0, 20.0, 50.0, 70.0) and len(row.bearings) == 6
    recovery, one = row.deck(4).recovery, single[30.0].deck(4).recovery
    x = np.linspace(20.01, 49.99, 23)
    for quantity in (
        "moment_vertical",
        "shear_vertical",
        "torsion",
        "displacement_z",
        "displacement_y",
        "rotation_x",
        "shear_lateral",
    ):
        ours, theirs = recovery.section(quantity, 31.7), one.section(quantity, 11.7)
        assert ours.influence(x) == pytest.approx(
            theirs.influence(x - 20.0), abs=1e-9 * np.abs(theirs.influence(x - 20.0)).max()
        )
        outside = ours.influence(np.array([5.0, 19.99, 50.01, 60.0]))
        assert np.abs(outside).max() < 1e-12 * np.abs(ours.influence(x)).max()
        assert ours.self_weight == pytest.approx(theirs.self_weight, rel=1e-9, abs=1e-6)
    # The pier carries both spans, each of its bearings one.
    pier = recovery.reaction("force_z", 20.0)
    assert pier.self_weight == pytest.approx(M * 9.81 * 25.0, rel=1e-9)
    assert pier.influence(np.array([15.0, 35.0]))[:, 0, 1] == pytest.approx([-0.75, -0.5], rel=1e-9)
    assert [b.span for b in row.bearings] == [1, 1, 2, 2, 3, 3]
    assert recovery.bearing(2, "force_z").influence(np.array([15.0, 35.0]))[
        :, 0, 1
    ] == pytest.approx([-0.75, 0.0], abs=1e-9)
    assert recovery.section("moment_vertical", 20.0).self_weight == pytest.approx(0.0, abs=1e-3)


def test_a_train_crosses_simple_spans_one_after_the_other():
    row = rb.Beam("row", (20.0, 20.0), M, EI, EIZ, GJ, EA, INERTIA, continuous=False).deck(20, 0.02)
    one = rb.Beam("one", (20.0,), M, EI, EIZ, GJ, EA, INERTIA).deck(10, 0.02)
    train, common = (
        rb.AxleTrain([0.0, 2.5], [1e5, 1e5]),
        {"speed": 20.0, "time_step": 1e-3, "track_offset": 1.0},
    )
    both, single = rb.cross(train, row, **common), rb.cross(train, one, **common)
    shift = 1000
    for q in ("displacement_z", "rotation_x"):
        first, second, alone = (
            both.displacement(9.0)[q],
            both.displacement(29.0)[q],
            single.displacement(9.0)[q],
        )
        count = min(len(alone), len(first) - shift)
        size = np.abs(alone).max()
        # A load at the very joint stands on one span at one sample, on rigid bearings.
        assert first[:count] == pytest.approx(alone[:count], abs=2e-4 * size)
        assert second[shift : shift + count] == pytest.approx(alone[:count], abs=2e-4 * size)
        assert np.abs(second[: shift - 5]).max() < 1e-12 * size


def test_bearings_of_simple_spans_may_be_told_apart():
    def bearings(*middle):
        return (
            rb.Bearing(0.0, ("z", "y", "roll", "x")),
            *middle,
            rb.Bearing(50.0, ("z", "y", "roll")),
        )

    both = (rb.Bearing(20.0, USUAL, span=1), rb.Bearing(20.0, (*USUAL, "x"), span=2))
    row = rb.Beam(
        "row", (20.0, 30.0), M, EI, EIZ, GJ, EA, INERTIA, bearings=bearings(*both), continuous=False
    )
    assert [b.span for b in row.bearings] == [1, 1, 2, 2]
    shared = rb.Beam(
        "row", (20.0, 30.0), M, EI, bearings=bearings(rb.Bearing(20.0, ("z",))), continuous=False
    )
    assert [b.span for b in shared.bearings] == [1, 1, 2, 2]
    # The given list is counted, not the bearings that it makes.
    twice = bearings(rb.Bearing(20.0, USUAL), rb.Bearing(20.0, USUAL, span=2))
    with pytest.raises(rb.InputError, match=r"^bearings\[3\]\.x = 20.0: is given to two bearings"):
        rb.Beam("row", (20.0, 30.0), M, EI, bearings=twice, continuous=False)
    with pytest.raises(rb.InputError, match="span 2 from sliding along x"):
        rb.Beam(
            "row",
            (20.0, 30.0),
            M,
            EI,
            EIZ,
            GJ,
            EA,
            INERTIA,
            bearings=bearings(rb.Bearing(20.0, USUAL)),
            continuous=False,
        )
    with pytest.raises(rb.InputError, match=r"bearings\[2\]\.span = 3: must be 1 or 2"):
        rb.Beam(
            "row",
            (20.0, 30.0),
            M,
            EI,
            bearings=bearings(rb.Bearing(20.0, span=3)),
            continuous=False,
        )
    with pytest.raises(rb.InputError, match=r"bearings\[2\]\.span = 1: is only for simple spans"):
        rb.Beam("row", (20.0, 30.0), M, EI, bearings=bearings(rb.Bearing(20.0, span=1)))


# ---- refusals


@pytest.mark.parametrize(
    ("bearings", "free"),
    [
        (
            [rb.Bearing(0.0, ("y", "z", "roll"), z=-1.0), rb.Bearing(L, USUAL, z=-1.0)],
            "sliding along x",
        ),
        ([rb.Bearing(0.0, ("x", "y", "z")), rb.Bearing(L, ("y", "z"))], "rolling"),
        ([rb.Bearing(0.0, ("x", "y", "z"), y=2.0), rb.Bearing(L, ("y", "z"), y=2.0)], "rolling"),
        ([rb.Bearing(0.0, ("x", "y", "z", "roll")), rb.Bearing(L, ("z",))], "yawing"),
        ([rb.Bearing(0.0, ("x", "y", "roll"), stiffness={"z": 1e9})], "pitching or yawing"),
        (
            [rb.Bearing(0.0, ("x", *USUAL)), rb.Bearing(L, ("y",), stiffness={"z": 1e-6})],
            "pitching",
        ),
    ],
)
def test_a_mechanism_is_refused_with_the_way_it_moves(bearings, free):
    with pytest.raises(rb.InputError, match=f"from {free}, so") as error:
        deck_on(*bearings)
    assert "bearings" in error.value.field and error.value.remedy


@pytest.mark.parametrize("x", [0.0, 12.0])
@pytest.mark.parametrize(
    ("freedom", "motion"),
    [
        ("x", "sliding along x"), ("y", "moving along y"), ("z", "moving along z"),
        ("roll", "rolling"), ("pitch", "pitching"), ("yaw", "yawing"),
    ],
)  # fmt: skip
def test_one_bearing_that_holds_all_but_one_freedom_leaves_that_motion(freedom, motion, x):
    held = tuple(name for name in FIXITIES if name != freedom)
    every = ("axial", "lateral", "vertical", "torsion")
    assert free_motions([rb.Bearing(x, held)], every, 36.0, 0.4, {}) == [motion]
    assert free_motions([rb.Bearing(x, FIXITIES)], every, 36.0, 0.4, {}) == []


def test_two_bearings_abreast_keep_the_deck_from_rolling_and_a_lengthwise_pair_from_yawing():
    pair = [
        rb.Bearing(0.0, ("x", "y", "z"), y=1.0),
        rb.Bearing(0.0, ("x", "z"), y=-1.0),
        rb.Bearing(L, ("z",), y=1.0),
    ]
    beam = deck_on(*pair)
    assert beam.modes.frequencies_hz[0] > 0.1
    theirs = frame_of(beam).frequencies(6)
    assert beam.modes.frequencies_hz[:6] == pytest.approx(theirs, rel=2e-3)


@pytest.mark.parametrize(
    ("bearing", "message"),
    [
        ({"x": 40.0}, r"bearings\[2\]\.x = 40.0"),
        ({"y": 1500.0}, r"^y = 1500.0"),
        ({"z": float("nan")}, r"^z = nan"),
        ({"x": "end"}, r"^x = 'end'"),
        ({"fixed": ("up",)}, r"^fixed = 'up'"),
        ({"fixed": 3}, r"^fixed = 3: must list some of x y z .* Write them as a list"),
        ({"fixed": ("z",), "stiffness": {"z": 1e9}}, r"^stiffness.z = 1000000000.0: is fixed, too"),
        ({"stiffness": {"z": 0.0}}, r"^stiffness.z = 0"),
        ({"stiffness": {"z": 1e20}}, r"^stiffness.z = 1e\+20"),
        ({"stiffness": {"up": 1e9}}, r"^stiffness = 'up'"),
        ({"stiffness": 1e9}, r"^stiffness = 1000000000.0: must be a table"),
        ({"span": 1.5}, r"^span = 1.5: must be a whole number"),
        ({"x": 0.0, "fixed": ("z",)}, r"bearings\[2\]\.x = 0.0: is given to two bearings in one"),
    ],
)
def test_bad_bearings_are_refused(bearing, message):
    with pytest.raises(rb.InputError, match=message):
        deck_on(rb.Bearing(0.0, ("x", *USUAL)), rb.Bearing(**{"x": L} | bearing))


def test_a_bearing_beside_the_axis_asks_for_the_stiffness_it_needs():
    """Else it would clamp the deck's turning: the deck could not give lengthwise or sideways."""
    low = rb.Bearing(0.0, ("x", "z"), z=-1.0), rb.Bearing(L, ("z",), z=-1.0)
    says = r"^bearings\[1\]\.fixed = 'x z': holds x off .* could not pitch\. Give axial_stiffness"
    with pytest.raises(rb.InputError, match=says):
        rb.Beam("b", (L,), M, EI, bearings=low)
    soft = rb.Bearing(L, ("z",), z=-1.0, stiffness={"x": 5e8})
    says = r"^bearings\[2\]\.stiffness\.x = 500000000.0: holds x off .* could not pitch\."
    with pytest.raises(rb.InputError, match=says):
        rb.Beam("b", (L,), M, EI, bearings=(rb.Bearing(0.0, ("x", "z")), soft))
    side = rb.Bearing(0.0, USUAL, z=-1.0), rb.Bearing(L, USUAL, z=-1.0)
    says = r"^bearings\[1\]\.fixed = .* holds y .* not roll\. Give bending_stiffness_lateral"
    with pytest.raises(rb.InputError, match=says):
        rb.Beam("b", (L,), M, EI, torsional_stiffness=GJ, polar_inertia=INERTIA, bearings=side)
    # Without twist a bearing may stand anywhere below a plane beam.
    plane = rb.Beam(
        "b",
        (L,),
        M,
        EI,
        bearings=(rb.Bearing(0.0, ("z",), 2.0, -1.0), rb.Bearing(L, ("z",), -2.0, -1.0)),
    )
    assert plane.modes.frequencies_hz[0] == pytest.approx(3.307, rel=1e-3)


@pytest.mark.parametrize("freedom", FIXITIES)
def test_a_bearing_moves_as_a_point_of_the_rigid_section(freedom):
    """u + theta x r, for a section that moves and turns in every way."""
    centroid, y, z = 0.4, 1.7, -1.3
    u, v, w, roll, pitch, yaw = moved = np.array([0.3, -0.2, 0.5, 0.07, -0.05, 0.11])
    arm = np.array([0.0, y, z])
    about_axis = moved[:3] + np.cross(moved[3:], arm)
    # u is that of the centroid: a point above or below it moves lengthwise as the section pitches.
    about_axis[0] = u + pitch * (z - centroid) - yaw * y
    known = dict(zip(FIXITIES, [*about_axis, roll, pitch, yaw], strict=True))
    node = np.array([u, v, w, roll, yaw, -pitch])
    row = rb.Bearing(0.0, (freedom,), y, z).row(freedom, centroid)
    assert row @ node == pytest.approx(known[freedom], abs=1e-12)


def test_a_side_force_on_bearings_below_the_axis_is_carried_there():
    """Held sideways 1.3 m below the axis: the line takes half the force, and its couple about the
    axis, which upright pairs of forces balance."""
    pads = [
        rb.Bearing(x, fixed, y, -1.3)
        for x, fixed in ((0.0, "x y z"), (L, "y z"))
        for y, fixed in ((1.5, fixed), (-1.5, fixed.replace("x ", "").replace("y ", "")))
    ]
    deck = deck_on(*pads).deck(10, 0.02)
    middle = np.array([L / 2])
    for support in (0.0, L):
        # By unit loads at the axis: sideways (0), up (1), a couple (2).
        side = deck.recovery.reaction("force_y", support).influence(middle)[0, 0]
        couple = deck.recovery.reaction("moment_x", support).influence(middle)[0, 0]
        assert side[0] == pytest.approx(-0.5, rel=1e-9)
        # Nothing twists at mid-span by symmetry: all couples about the axis balance line by line.
        assert couple[0] == pytest.approx(0.0, abs=1e-9)
        assert couple[2] == pytest.approx(-0.5, rel=1e-9)
    # Line x = 0: the bearing that holds sideways pushes 1.3 m below the axis, the pair turns back.
    held, free = (deck.recovery.bearing(number, "force_z") for number in (1, 2))
    turned = [line.influence(middle)[0, 0, 0] * y for line, y in ((held, 1.5), (free, -1.5))]
    push = deck.recovery.bearing(1, "force_y").influence(middle)[0, 0, 0]
    assert push == pytest.approx(-0.5, rel=1e-9)
    assert sum(turned) == pytest.approx(-1.3 * push, rel=1e-9)


@given(rows=st.lists(st.tuples(*[st.sampled_from([0.0, 1.0, -1.0, 0.7, -2.2])] * 6), max_size=7))
def test_null_space_is_what_the_rows_leave_free(rows):
    rows = np.array(rows).reshape(-1, 6)
    free = null_space(rows)
    assert np.abs(rows @ free).max(initial=0.0) < 1e-9
    assert free.shape[1] == 6 - (np.linalg.matrix_rank(rows) if len(rows) else 0)
    # NumPy 1 knows no rank of an empty matrix.
    assert free.size == 0 or np.linalg.matrix_rank(free) == free.shape[1]


def test_modes_on_bearings_off_the_axis_converge_with_the_mesh():
    def frequencies(elements):
        pads = [rb.Bearing(0.0, "x y z", 1.5, -1.3), rb.Bearing(0.0, "z", -1.5, -1.3)]
        far = [rb.Bearing(L, "z", 1.5, -1.3), rb.Bearing(L, "z", -1.5, -1.3, {"y": 5e9})]
        return deck_on(*pads, *far, centroid_height=0.4, elements=elements).modes.frequencies_hz[:6]

    coarse, middle, fine = (frequencies(n) for n in (12, 24, 48))
    assert np.all(coarse >= middle) and np.all(middle >= fine)  # from above, as they must
    assert np.abs(middle - fine).max() < np.abs(coarse - middle).max() / 10
    assert middle == pytest.approx(fine, rel=2e-4)


def test_a_bearing_stands_on_the_end_it_misses_by_rounding():
    """On the end itself, not beside it, for beam and box alike; a millimetre off is another place,
    a metre off no deck's."""
    ends = np.array([0.0, 12.0, 36.0])
    assert [on_deck(x, ends) for x in (-1e-9, 12.0 + 1e-9, 36.0 + 3e-5)] == [0.0, 12.0, 36.0]
    assert on_deck(12.001, ends) == 12.001
    for wrong in ("far", float("nan"), -0.01):
        with pytest.raises(rb.InputError, match="^x = .* It must lie on the deck"):
            on_deck(wrong, ends)
    with pytest.raises(
        rb.InputError, match="^x = 37.0: .* least 0 and at most 36 m. It must lie on"
    ):
        on_deck(37.0, ends)
