"""Masses at single places: frequencies by hand and by a frame program, weight, Newton's law."""

from dataclasses import replace

import numpy as np
import pytest
from frame import RIGID, Frame
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import railbridge as rb
from railbridge.beams.bearings import FIXITIES
from railbridge.beams.properties import MOST_MASSES

L, M, E, G = 36.0, 12e3, 35e9, 9.81
EI, EIZ, GJ, EA, INERTIA = E * 2.553, E * 25.53, E / 2.4 * 5.59, E * 4.8, 2500 * 28.083
USUAL = ("y", "z", "roll")
SIMPLE = rb.Beam("simple", (L,), M, EI, EIZ, GJ, EA, INERTIA)
VERTICAL = rb.Beam("vertical", (L,), M, EI)
FIELDS = ("axial", "lateral", "vertical", "torsion")


def loaded(beam, *masses):
    return replace(beam, point_masses=masses)


@pytest.mark.parametrize("share", [0.05, 0.5, 3.0])
def test_a_mass_at_mid_span_solves_the_frequency_equation(share):
    """Half the beam between a pin and the middle, which stays level and carries half the mass:
    shear EI w''' = -m omega^2 w / 2 gives tan a - tanh a = 4 M L / (m a L), a = b L / 2."""
    mass = share * M * L

    def equation(a):
        return share * a * (np.tan(a) - np.tanh(a)) - 2.0

    a = brentq(equation, 1e-3, np.pi / 2 - 1e-9)
    first = (2 * a / L) ** 2 * np.sqrt(EI / M) / (2 * np.pi)
    beam = loaded(VERTICAL, rb.PointMass(L / 2, mass))
    assert beam.modes.frequencies_hz[0] == pytest.approx(first, rel=1e-6)
    # Rayleigh's quotient with the deflection under a point load is an upper bound, near for a heavy
    # mass: 17/35 of the beam swings with it.
    bound = np.sqrt(48 * EI / L**3 / (mass + 17 / 35 * M * L)) / (2 * np.pi)
    assert first < bound < first * 1.01
    # Antisymmetric modes do not feel a mass without turning inertia.
    second = 4 * np.pi / 2 / L**2 * np.sqrt(EI / M)
    assert beam.modes.frequencies_hz[1] == pytest.approx(second, rel=2e-5)


def test_a_mass_in_front_of_torsion_is_a_turning_inertia_there():
    """Two halves in twist between held ends: G J k cot(k L / 2) = J omega^2 / 2."""
    roll = 2e6
    beam = loaded(SIMPLE, rb.PointMass(L / 2, 1.0, roll_inertia=roll))

    def equation(omega):
        k = omega * np.sqrt(INERTIA / GJ)
        return 2 * GJ * k * np.cos(k * L / 2) - roll * omega**2 * np.sin(k * L / 2)

    omega = brentq(equation, 1.0, 2 * np.pi * 0.999 * 0.5 / L * np.sqrt(GJ / INERTIA))
    place = beam.modes.names.index("torsion 1")
    assert beam.modes.frequencies_hz[place] == pytest.approx(omega / (2 * np.pi), rel=1e-5)


@st.composite
def masses(draw):
    places = draw(st.lists(st.integers(0, 36), min_size=1, max_size=3))
    return [
        rb.PointMass(
            float(x), 10.0 ** draw(st.floats(3.0, 5.5)), draw(st.floats(-4.0, 4.0)),
            draw(st.floats(-3.0, 3.0)), draw(st.sampled_from([0.0, 1e5])),
        )
        for x in places
    ]  # fmt: skip


def frame_of(beam, count=144):
    springs = [
        (b.x, b.y, b.z, {FIXITIES.index(f): b.springs.get(f, RIGID) for f in b.restrained})
        for b in beam.bearings
    ]
    own = [(m.x, m.y, m.z, m.mass, m.roll_inertia) for m in beam.point_masses]
    return Frame(
        beam.length, count, EA, EIZ, EI, GJ, M, INERTIA, centroid=beam.centroid_height,
        bearings=springs, masses=own,
    )  # fmt: skip


@settings(max_examples=12)
@given(own=masses(), centroid=st.sampled_from([0.0, 0.6]))
def test_frequencies_are_those_of_a_frame_program(own, centroid):
    beam = loaded(replace(SIMPLE, centroid_height=centroid), *own)
    assert beam.modes.frequencies_hz[:8] == pytest.approx(frame_of(beam).frequencies(8), rel=2e-3)


@settings(max_examples=12)
@given(own=masses(), centroid=st.sampled_from([0.0, 0.6]))
def test_modes_are_mass_normalised_and_their_energies_add_up(own, centroid):
    """With the motion of each mass by hand: u + theta x r about the centroid and the axis."""
    beam = loaded(replace(SIMPLE, centroid_height=centroid), *own)
    modes, mesh = beam.modes, beam.mesh
    count = 10
    x, w = np.polynomial.legendre.leggauss(6)
    h = np.diff(mesh.edges)
    at = (mesh.edges[:-1, None] + h[:, None] * (x + 1) / 2).ravel()
    dx = (h[:, None] * w / 2).ravel()
    v, vertical, twist = np.moveaxis(mesh.interpolate(modes.vectors)(at)[:, :count], -1, 0)
    sideways = v - centroid * twist
    parts = [(M, vertical, dx), (M, sideways, dx), (INERTIA, twist, dx)]
    gram = sum(m * np.einsum("k,km,kn->mn", weight, a, a) for m, a, weight in parts)
    # Lengthwise: quadratic between nodes, so by the mesh's own element matrices.
    axial = modes.vectors[mesh.freedoms["axial"], :count]
    gram += np.einsum("eim,eij,ejn->mn", axial, mesh.element_matrices["axial"][1], axial)
    for m in beam.point_masses:
        u, v, w, roll, yaw, minus_pitch = modes.vectors[6 * mesh.node(m.x) :][:6, :count]
        motions = [
            u - minus_pitch * (m.z - centroid) - yaw * m.y, v - roll * m.z, w + roll * m.y
        ]  # fmt: skip
        gram += sum(m.mass * np.outer(a, a) for a in motions) + m.roll_inertia * np.outer(
            roll, roll
        )
    assert gram == pytest.approx(np.eye(count), abs=1e-6)
    assert sum(modes.energies.values())[:count] == pytest.approx(np.ones(count))
    assert all(np.all(modes.energies[name] > -1e-9) for name in FIELDS)


def test_a_mass_in_the_axis_moves_in_each_direction_alone():
    modes = loaded(SIMPLE, rb.PointMass(18.0, 3e5, roll_inertia=1e5)).modes
    shares = np.array([modes.energies[name][:8] for name in FIELDS])
    assert shares.max(axis=0) == pytest.approx(np.ones(8))
    found = dict(zip(modes.names, modes.frequencies_hz, strict=True))
    ratio = found["lateral bending 1"] / found["vertical bending 1"]
    # The mesh has eigenvalues up to 1.6e9 times the first: seven digits of it are sure, whatever
    # processor does the sums.
    assert ratio == pytest.approx(np.sqrt(EIZ / EI), rel=1e-7)


def test_names_and_kept_modes_of_a_beam_that_is_rigid_lengthwise():
    beam = loaded(VERTICAL, rb.PointMass(9.0, 5e4, y=2.0, z=1.5))
    assert beam.modes.names[:3] == tuple(f"vertical bending {i}" for i in (1, 2, 3))
    assert beam.modes.energies["vertical"] == pytest.approx(np.ones(len(beam.modes.names)))
    assert beam.deck(3).frequencies_hz == pytest.approx(beam.modes.frequencies_hz[:3])


def test_self_weight_of_a_mass_beside_the_axis():
    mass, at, y = 4e4, 9.0, 2.0
    recovery = loaded(SIMPLE, rb.PointMass(at, mass, y, -1.0)).deck(3).recovery
    w, p = M * G, mass * G
    reactions = [w * L / 2 + p * (1 - at / L), w * L / 2 + p * at / L]
    found = [recovery.reaction("force_z", x).self_weight for x in (0.0, L)]
    assert found == pytest.approx(reactions, rel=1e-9)
    couples = [recovery.reaction("moment_x", x).self_weight for x in (0.0, L)]
    assert couples == pytest.approx([p * y * (1 - at / L), p * y * at / L], rel=1e-9)
    moment = recovery.section("moment_vertical", L / 2).self_weight
    assert moment == pytest.approx(-(w * L**2 / 8 + p * at / 2), rel=1e-9)
    sag = 5 * w * L**4 / 384 + p * at * (3 * L**2 - 4 * at**2) / 48
    assert recovery.section("displacement_z", L / 2).self_weight == pytest.approx(
        -sag / EI, rel=1e-6
    )
    # Shear and torsion jump at the mass; at its place they are those just before it.
    for beside, load in ((at, w * at), (at + 1e-3, w * (at + 1e-3) + p)):
        shear = recovery.section("shear_vertical", beside).self_weight
        assert shear == pytest.approx(load - reactions[0], rel=1e-9)
    before, behind = (recovery.section("torsion", x).self_weight for x in (at, at + 1e-3))
    assert (before, behind) == pytest.approx((-couples[0], couples[1]), rel=1e-9)


def test_weight_is_the_influence_line_times_the_masses():
    own = rb.PointMass(7.0, 3e4, y=1.5), rb.PointMass(25.0, 5e4, y=-2.0)
    beam = loaded(SIMPLE, *own)
    for quantity, at in (("displacement_z", 11.0), ("moment_vertical", 7.0), ("rotation_x", 20.0)):
        with_masses, without = (b.deck(3).recovery.section(quantity, at) for b in (beam, SIMPLE))
        more = sum(
            -m.mass * G * (with_masses.influence(np.array([m.x]))[0, 0] @ [0.0, 1.0, m.y])
            for m in own
        )
        assert with_masses.self_weight - without.self_weight == pytest.approx(more, rel=1e-9)


@settings(max_examples=8)
@given(own=masses(), at=st.floats(0.5, 35.5), node=st.integers(2, 30))
def test_modal_values_are_the_static_effect_of_the_modes_own_inertia(own, at, node):
    """The forces omega^2 m phi of beam and masses, on the influence lines."""
    beam = loaded(SIMPLE, *own)
    deck = beam.deck(6)
    omega2 = (2 * np.pi * deck.frequencies_hz) ** 2
    mesh, kept = beam.mesh, np.flatnonzero(beam.modes.excitable)[:6]
    x, w = np.polynomial.legendre.leggauss(8)
    for quantity in ("displacement_z", "moment_vertical", "shear_vertical", "torsion"):
        line = deck.recovery.section(quantity, at)
        edges = line.influence.edges
        h = np.diff(edges)
        places = (edges[:-1, None] + h[:, None] * (x + 1) / 2).ravel()
        weight = (h[:, None] * w / 2).ravel()
        lines, shapes = line.influence(places)[:, 0], deck.shapes(places)
        inertia = [M, M, INERTIA]
        expected = omega2 * np.einsum("k,kc,c,kmc->m", weight, lines, inertia, shapes)
        for m in beam.point_masses:
            here = line.influence(np.array([m.x]), 0)[0, 0]
            if abs(m.x - at) < 1e-3:
                return
            v, _, roll = deck.shapes(np.array([m.x]))[0].T
            u, _, w_, _, yaw, pitch = beam.modes.vectors[6 * mesh.node(m.x) :][:6, kept]
            sideways, up = m.mass * (v - roll * m.z), m.mass * (w_ + roll * m.y)
            expected += omega2 * (
                here @ [sideways, up, m.roll_inertia * roll + m.y * up - m.z * sideways]
            )
            # Its inertia along the deck, which bends and turns the section.
            along = m.mass * (u - pitch * m.z - yaw * m.y)
            slope = line.influence(np.array([m.x]), 1)[0, 0]
            expected += omega2 * along * (-m.z * slope[1] - m.y * slope[0])
        assert line.modal == pytest.approx(expected, abs=2e-5 * np.abs(expected).max())


def test_bearings_hold_loads_and_the_inertia_of_deck_and_masses():
    """Newton's law for the whole deck in a crossing: reactions + loads = sum of m times a."""
    own = rb.PointMass(9.0, 6e4, y=2.5, z=1.0), rb.PointMass(23.0, 3e4, y=-1.0)
    deck = loaded(SIMPLE, *own).deck(24)
    run = rb.cross(rb.AxleTrain((0.0, 6.0), (2e5, 2e5)), deck, speed=60.0, time_step=1e-3, tail=0.5)
    held = sum(own["force_z"] for own in run.reactions().values())
    x, w = np.polynomial.legendre.leggauss(40)
    pieces = [(a, a + 6.0) for a in np.arange(0.0, L, 6.0)]
    inertia = sum(
        M * w[i] * 3.0 * run.acceleration(x=(a + b) / 2 + 3.0 * x[i])["acceleration_z"]
        for a, b in pieces
        for i in range(40)
    )
    for m in own:
        found = run.acceleration(x=m.x)
        inertia = inertia + m.mass * (found["acceleration_z"] + m.y * found["acceleration_roll"])
    places = run.time[:, None] * 60.0 - [0.0, 6.0]
    loads = -2e5 * np.sum((places >= 0.0) & (places <= L), axis=1)
    inside = np.all(np.abs(places) > 0.1, axis=1) & np.all(np.abs(places - L) > 0.1, axis=1)
    off = held + loads - inertia
    assert np.abs(off[inside]).max() < 2e-3 * 2e5
    alone = np.abs(sum(m.mass * run.acceleration(x=m.x)["acceleration_z"] for m in own)).max()
    assert alone > 0.02 * 2e5  # it would be missed


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"mass": 0.0}, r"^mass = 0.0: must be a finite number above 0 kg\."),
        ({"roll_inertia": -1.0}, r"^roll_inertia = -1.0: .* at least 0 kg m2\."),
        ({"y": 50.1}, r"^y = 50.1: .* at most 50 m\. It is counted from the deck axis"),
        ({"z": float("nan")}, r"^z = nan"),
    ],
)
def test_a_mass_that_cannot_be_is_refused(wrong, message):
    with pytest.raises(rb.InputError, match=message):
        rb.PointMass(**{"x": 1.0, "mass": 1e3, **wrong})


def test_a_mass_off_the_deck_at_a_joint_or_too_near_is_refused_by_its_number():
    fine = rb.PointMass(18.0, 1e3)
    for wrong, words in [
        (rb.PointMass(36.1, 1e3), "x = 36.1: must be .* at most 36 m"),
        (rb.PointMass(18.01, 1e3), r"x = 18.01: is 0.01 m beside another .* Put it at x = 18 m"),
        (rb.PointMass(0.02, 1e3), "x = 0.02: is 0.02 m beside .* Put it at x = 0 m"),
    ]:
        with pytest.raises(rb.InputError, match=r"^point_masses\[2\]\." + words):
            loaded(SIMPLE, fine, wrong)
    spans = rb.Beam("two", (20.0, 20.0), M, EI, continuous=False)
    with pytest.raises(rb.InputError, match=r"^point_masses\[1\]\.x = 20.0: is where two simple"):
        loaded(spans, rb.PointMass(20.0, 1e3))
    many = [rb.PointMass(18.0, 1.0)] * (MOST_MASSES + 1)
    with pytest.raises(rb.InputError, match=r"^point_masses = 201: must be at most 200"):
        loaded(SIMPLE, *many)
    assert len(loaded(SIMPLE, *many[1:]).point_masses) == MOST_MASSES
    with pytest.raises(rb.InputError, match=r"^point_masses\[1\] = 5: must be a PointMass"):
        loaded(SIMPLE, 5)


def test_masses_stand_on_nodes_and_those_that_miss_one_by_rounding_are_put_there():
    spans = rb.Beam("b", (12.1, 12.2, 12.3), M, EI, point_masses=(rb.PointMass(12.1 + 12.2, 1e3),))
    assert spans.point_masses[0].x == spans.required_nodes[2]
    inner = tuple(rb.Bearing(x, ("z",)) for x in (0.0, 10.1 + 10.2, L))
    beside = rb.Beam("b", (L,), M, EI, bearings=inner, point_masses=(rb.PointMass(20.3, 1e3),))
    assert 20.3 != 10.1 + 10.2 == beside.point_masses[0].x
    own = loaded(replace(SIMPLE, elements=4), rb.PointMass(5.0, 1e3), rb.PointMass(5.3, 1e3))
    assert {5.0, 5.3} <= set(own.mesh.nodes)
    assert len(SIMPLE.mesh.h) == len(loaded(SIMPLE, rb.PointMass(18.0, 1.0)).mesh.h) == 40


def test_two_masses_at_one_place_are_their_sum():
    two = loaded(SIMPLE, rb.PointMass(12.0, 1e4, 1.0), rb.PointMass(12.0, 1e4, 1.0))
    one = loaded(SIMPLE, rb.PointMass(12.0, 2e4, 1.0))
    assert two.modes.frequencies_hz[:9] == pytest.approx(one.modes.frequencies_hz[:9], rel=1e-9)


def test_a_mass_heavier_than_the_deck_is_doubted():
    beam = loaded(SIMPLE, rb.PointMass(18.0, 1e3), rb.PointMass(9.0, 5e5))
    (said,) = beam.remarks
    assert said.field == "point_masses[2].mass" and "432000 kg" not in said.text.split("own")[0]
    assert said.text.startswith("= 500000 kg is more than the deck's own 4.32e+05 kg")
