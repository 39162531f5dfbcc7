"""Beams against textbook beams: frequencies, influence lines, reactions, what holds a deck up."""

import inspect
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import railbridge as rb
from railbridge.beams import Section

L, M, EI, EIZ, GJ, INERTIA = 36.0, 12e3, 8.93e10, 8.9e11, 8.15e10, 7.02e4
SIMPLE = rb.Beam("simple", (L,), M, EI, EIZ, GJ, polar_inertia=INERTIA)
TWO_SPANS = rb.Beam("two spans", (20.0, 30.0), M, EI, EIZ, GJ, polar_inertia=INERTIA)
SIMPLE_DECK = SIMPLE.deck(20)
TWO_SPAN_DECK = TWO_SPANS.deck(12)


def named(beam, kind):
    return np.array(
        [
            f
            for f, n in zip(beam.modes.frequencies_hz, beam.modes.names, strict=True)
            if n.startswith(kind)
        ]
    )


@pytest.mark.parametrize(
    ("kind", "first", "power"),
    [
        ("vertical bending", np.pi / 2 / L**2 * np.sqrt(EI / M), 2),
        ("lateral bending", np.pi / 2 / L**2 * np.sqrt(EIZ / M), 2),
        ("torsion", 0.5 / L * np.sqrt(GJ / INERTIA), 1),
    ],
)
def test_simply_supported_frequencies(kind, first, power):
    n = np.arange(1, 6)
    assert named(SIMPLE, kind)[:5] == pytest.approx(first * n**power, rel=2e-5)


def test_mode_names_count_within_each_kind():
    deck = rb.deck("viaduct36")
    expected = ["vertical bending 1", "lateral bending 1", "vertical bending 2", "torsion 1"]
    assert list(deck.mode_names[:4]) == expected
    assert deck.frequencies_hz[[0, 1, 2, 3]] == pytest.approx(
        [3.307, 10.46, 13.23, 14.97], rel=3e-3
    )
    assert not any(n.startswith("axial") for n in deck.mode_names)


def test_clamped_and_cantilever_frequencies():
    everything = ("x", "y", "z", "roll", "pitch", "yaw")
    unit = np.sqrt(EI / M) / (2 * np.pi * L**2)
    clamped = rb.Beam(
        "c", (L,), M, EI, bearings=(rb.Bearing(0.0, everything), rb.Bearing(L, everything))
    )
    assert named(clamped, "vertical")[:3] == pytest.approx(
        np.array([4.730041, 7.853205, 10.995608]) ** 2 * unit, rel=1e-5
    )
    cantilever = rb.Beam("c", (L,), M, EI, bearings=(rb.Bearing(0.0, everything),))
    assert named(cantilever, "vertical")[:3] == pytest.approx(
        np.array([1.875104, 4.694091, 7.854757]) ** 2 * unit, rel=1e-5
    )


def test_two_equal_spans_have_pinned_and_clamped_frequencies():
    beam = rb.Beam("c", (30.0, 30.0), M, EI)
    unit = np.sqrt(EI / M) / (2 * np.pi * 30.0**2)
    assert named(beam, "vertical")[:4] == pytest.approx(
        np.array([np.pi, 3.926602, 2 * np.pi, 7.068583]) ** 2 * unit, rel=1e-4
    )


def test_two_unequal_spans_solve_the_characteristic_equation():
    # Rotational stiffnesses of both spans about the middle support add to zero.
    def moment(k):
        return sum(1 / np.tan(k * a) - 1 / np.tanh(k * a) for a in (20.0, 30.0))

    k = brentq(moment, 1.001 * np.pi / 30, 0.999 * np.pi / 20)
    assert named(TWO_SPANS, "vertical")[0] == pytest.approx(
        k**2 * np.sqrt(EI / M) / (2 * np.pi), rel=1e-5
    )


def test_modes_are_mass_normalised_by_quadrature():
    deck = TWO_SPAN_DECK
    x, w = np.polynomial.legendre.leggauss(400)
    parts = [
        ((a + b) / 2 + (b - a) / 2 * x, w * (b - a) / 2) for a, b in ((0.0, 20.0), (20.0, 50.0))
    ]
    gram = sum(
        np.einsum("k,c,kmc,knc->mn", dx, [M, M, INERTIA], deck.shapes(at), deck.shapes(at))
        for at, dx in parts
    )
    assert gram == pytest.approx(np.eye(12), abs=1e-6)


def triangle(x, at):
    return np.where(x <= at, x * (L - at), at * (L - x)) / L


@settings(max_examples=40)
@given(at=st.floats(0.0, L), loads=st.lists(st.floats(0.0, L), min_size=1, max_size=6))
def test_influence_lines_of_a_simple_beam(at, loads):
    x = np.array(
        [p for p in loads if abs(p - at) > 1e-6] or [L / 3 if abs(at - L / 3) > 1 else L / 2]
    )
    recovery = SIMPLE_DECK.recovery

    def line(quantity):
        return recovery.section(quantity, at).influence(x)[:, 0]

    zero = pytest.approx(np.zeros((len(x), 2)), abs=1e-6)
    # A load +1 upwards: the bending moment on the +x face is hogging, positive by M_y = -EI w''.
    assert line("moment_vertical")[:, 1] == pytest.approx(triangle(x, at), abs=1e-6)
    assert line("moment_vertical")[:, [0, 2]] == zero
    assert line("moment_lateral")[:, 0] == pytest.approx(-triangle(x, at), abs=1e-6)
    face = max(
        at, 1e-9
    )  # shear on the face just before the section; at the very start just after it
    shear = np.where(x < face, -x / L, 1 - x / L)
    assert line("shear_vertical")[:, 1] == pytest.approx(shear, abs=1e-6)
    assert line("shear_lateral")[:, 0] == pytest.approx(shear, abs=1e-6)
    assert line("torsion")[:, 2] == pytest.approx(shear, abs=1e-6)
    a, b = np.minimum(x, at), np.maximum(x, at)
    deflection = a * (L - b) * (2 * b * L - b**2 - a**2) / (6 * L)
    assert line("displacement_z")[:, 1] == pytest.approx(deflection / EI, rel=1e-6, abs=1e-15)
    assert line("displacement_y")[:, 0] == pytest.approx(deflection / EIZ, rel=1e-6, abs=1e-15)
    assert line("rotation_x")[:, 2] == pytest.approx(a * (L - b) / L / GJ, rel=1e-6, abs=1e-15)


@pytest.mark.parametrize("x", [18.0, 18.0 + 1e-7, 18.00001, 18.001, 17.99999])
def test_a_section_beside_a_node_is_as_good_as_any(x):
    line = SIMPLE_DECK.recovery.section("moment_vertical", x)
    assert line.self_weight == pytest.approx(-M * 9.81 * x * (L - x) / 2, rel=1e-9)
    # Modal moment: M_y = -EI phi'' of the first sine.
    assert line.modal[0] == pytest.approx(
        EI * (np.pi / L) ** 2 * np.sqrt(2 / M / L) * np.sin(np.pi * x / L), rel=1e-6
    )


def test_self_weight():
    w = M * 9.81
    recovery = SIMPLE_DECK.recovery
    assert recovery.section("displacement_z", L / 2).self_weight == pytest.approx(
        -5 * w * L**4 / 384 / EI, rel=1e-6
    )
    assert recovery.section("shear_vertical", 9.0).self_weight == pytest.approx(
        -w * L / 4, rel=1e-6
    )
    assert [recovery.reaction("force_z", x).self_weight for x in (0.0, L)] == pytest.approx(
        [w * L / 2] * 2, rel=1e-9
    )
    assert recovery.section("moment_lateral", 9.0).self_weight == pytest.approx(0.0, abs=1e-6 * w)
    # -28.82 mm for the shipped deck, whatever its mass.
    assert rb.deck("viaduct36").recovery.section(
        "displacement_z", 18.0
    ).self_weight == pytest.approx(-28.82e-3, rel=1e-3)


def test_self_weight_of_two_spans():
    # Three-moment equation: M_B (l1 + l2) / 3 = -w (l1^3 + l2^3) / 24, hogging, positive here.
    w = M * 9.81
    hogging = w * (20.0**3 + 30.0**3) / 8 / 50.0
    recovery = TWO_SPAN_DECK.recovery
    assert recovery.section("moment_vertical", 20.0).self_weight == pytest.approx(hogging, rel=1e-9)
    reactions = [w * 10 - hogging / 20, w * 25 + hogging * (1 / 20 + 1 / 30), w * 15 - hogging / 30]
    assert [
        recovery.reaction("force_z", x).self_weight for x in (0.0, 20.0, 50.0)
    ] == pytest.approx(reactions, rel=1e-9)


@settings(max_examples=40)
@given(x=st.floats(0.0, 50.0), at=st.floats(0.1, 49.9))
def test_two_spans_are_in_equilibrium(x, at):
    recovery = TWO_SPAN_DECK.recovery
    load = np.array([x])
    reactions = {
        s: recovery.reaction("force_z", s).influence(load)[0, 0, 1] for s in (0.0, 20.0, 50.0)
    }
    assert sum(reactions.values()) == pytest.approx(-1.0, abs=1e-9)
    assert sum(s * r for s, r in reactions.items()) == pytest.approx(-x, abs=1e-7)
    if min(abs(x - at), abs(at - 20.0)) > 1e-6:
        moment = sum(r * (at - s) for s, r in reactions.items() if s < at) + max(at - x, 0.0)
        shear = -sum(r for s, r in reactions.items() if s < at) - (1.0 if x < at else 0.0)
        assert recovery.section("moment_vertical", at).influence(load)[0, 0, 1] == pytest.approx(
            -moment, abs=1e-7
        )
        assert recovery.section("shear_vertical", at).influence(load)[0, 0, 1] == pytest.approx(
            shear, abs=1e-7
        )


def test_displacement_influence_is_symmetric():
    recovery = TWO_SPAN_DECK.recovery
    for quantity, component in [("displacement_y", 0), ("displacement_z", 1), ("rotation_x", 2)]:
        there = recovery.section(quantity, 7.3).influence(np.array([33.1]))[0, 0, component]
        back = recovery.section(quantity, 33.1).influence(np.array([7.3]))[0, 0, component]
        assert there == pytest.approx(back, rel=1e-9)


def test_modal_values_add_up_to_the_influence_line():
    # sum_m S_m phi_m(x) / omega_m^2 tends to the influence line.
    deck = SIMPLE.deck(60)
    x = np.array([5.0, 14.0, 29.0])
    for quantity, component, rel in [
        ("displacement_z", 1, 1e-4),
        ("moment_vertical", 1, 0.02),
        ("torsion", 2, 0.03),
    ]:
        line = deck.recovery.section(quantity, 11.0)
        modal = deck.shapes(x)[:, :, component] @ (
            line.modal / (2 * np.pi * deck.frequencies_hz) ** 2
        )
        exact = line.influence(x)[:, 0, component]
        assert modal == pytest.approx(exact, abs=rel * np.abs(exact).max())


@pytest.mark.parametrize(
    ("bearings", "free"),
    [
        ([rb.Bearing(0.0, ("x", "y", "z", "roll"))], "yawing"),
        ([rb.Bearing(0.0, ("x", "z", "roll")), rb.Bearing(L, ("z",))], "moving along y"),
        ([rb.Bearing(0.0, ("x", "y", "z")), rb.Bearing(L, ("y", "z"))], "rolling"),
        ([rb.Bearing(0.0, ("x", "y", "roll")), rb.Bearing(L, ("y", "z"))], "pitching"),
    ],
)
def test_a_mechanism_is_refused_with_the_way_it_moves(bearings, free):
    with pytest.raises(rb.InputError, match=free) as error:
        rb.Beam("loose", (L,), M, EI, EIZ, GJ, polar_inertia=INERTIA, bearings=tuple(bearings))
    assert "bearings" in error.value.field and error.value.remedy


def test_rigid_where_no_stiffness_is_given():
    deck = rb.Beam("vertical only", (L,), M, EI).deck(5)
    assert deck.has == {"y": False, "z": True, "roll": False}
    assert deck.recovery.section("torsion", 3.0) is None
    assert deck.recovery.reaction("force_y", 0.0) is None


def test_section_file_and_stiffnesses_make_the_same_deck():
    e, g = 35e9, 35e9 / 2.4
    common = {"length": 36.0, "damping": {"ratio": 0.03, "frequencies_hz": [3.307, 16.30]}}
    common["modes"] = 20
    stiff = rb.deck_from_table("a", {
        **common, "mass": 12e3, "bending_stiffness_vertical": e * 2.553,
        "bending_stiffness_lateral": e * 25.53,
        "torsional_stiffness": g * 5.59, "axial_stiffness": e * 4.8,
        "polar_inertia": 2500 * (2.553 + 25.53),
    })  # fmt: skip
    shipped = rb.deck("viaduct36")
    assert len(shipped.frequencies_hz) == len(stiff.frequencies_hz) == 20
    assert stiff.frequencies_hz == pytest.approx(shipped.frequencies_hz, rel=1e-12)
    assert stiff.damping_ratios == pytest.approx(shipped.damping_ratios, rel=1e-12)


CONCRETE = Section(35e9, 0.2, 2500.0, 4.8, 2.553, 25.53, 5.59, shear_area_vertical=1.2)


def test_a_section_says_what_a_beam_needs():
    g = 35e9 / 2.4
    expected = {
        "mass": 12e3, "bending_stiffness_vertical": 35e9 * 2.553, "axial_stiffness": 35e9 * 4.8,
        "bending_stiffness_lateral": 35e9 * 25.53, "torsional_stiffness": g * 5.59,
        "polar_inertia": 2500 * 28.083, "shear_stiffness_vertical": g * 1.2,
    }  # fmt: skip
    assert CONCRETE.of_beam() == pytest.approx(expected, rel=1e-12)
    turning = {"rotary_inertia_vertical": 2500 * 2.553, "rotary_inertia_lateral": 2500 * 25.53}
    assert CONCRETE.of_beam(rotary_inertia=True) == pytest.approx(expected | turning, rel=1e-12)
    beam = rb.Beam("b", (L,), **CONCRETE.of_beam(True))
    assert beam.fields == ("axial", "lateral", "vertical", "torsion")


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"poisson_ratio": 0.6}, r"^poisson_ratio = 0.6: must be .* above -1 and at most 0.5\."),
        ({"area": 0.0}, r"^area = 0.0: must be a finite number above 0 m2\."),
        ({"shear_area_lateral": -1.0}, r"^shear_area_lateral = -1.0: .* above 0 m2\."),
    ],
)
def test_wrong_sections_are_refused(wrong, message):
    with pytest.raises(rb.InputError, match=message):
        replace(CONCRETE, **wrong)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"name": ""}, r"^name = ''"),
        ({"spans": ()}, r"^spans = \[\]: must hold 1 to 30 spans"),
        ({"spans": (20.0, -1.0)}, r"^spans\[2\] = -1.0: must be a finite number above 0 m\."),
        ({"mass": 0.0}, r"^mass = 0.0: must be a finite number above 0 kg/m\."),
        ({"torsional_stiffness": None}, r"^torsional_stiffness: is missing\. Twist needs"),
        ({"elements": 1}, r"^elements = 1: must be .* at least 2 and at most 400"),
    ],
)
def test_a_beam_names_its_own_arguments(wrong, message):
    with pytest.raises(rb.InputError, match=message):
        replace(SIMPLE, **wrong)


def test_help_on_a_beam_says_what_every_field_means():
    attributes = inspect.getdoc(rb.Beam).split("Attributes\n")[1].split("Raises\n")[0]
    assert [line.split(" : ")[0] for line in attributes.splitlines() if " : " in line] == [
        field.name for field in fields(rb.Beam)
    ]


@pytest.mark.parametrize("short", [0.065, 0.1, 0.2])
def test_a_very_short_span_beside_a_long_one_clamps_it(short):
    """Very short elements once spoilt the lowest frequency by a fifth, or made it no number."""
    clamped = 3.926602**2 * np.sqrt(EI / M) / (2 * np.pi * 60.0**2)
    frequency = named(rb.Beam("b", (short, 60.0), M, EI), "vertical")[0]
    # The short span gives way like a spring 3 E I / short, which is as good as a third of it more
    # length.
    assert frequency == pytest.approx(clamped * (1 + short / 3 / 60.0) ** -2, rel=2e-5)


def test_a_bearing_beside_a_place_of_the_regular_mesh():
    def first(x):
        bearings = (rb.Bearing(0.0, ("z",)), rb.Bearing(x, ("z",)), rb.Bearing(40.0, ("z",)))
        return named(rb.Beam("b", (40.0,), M, EI, bearings=bearings), "vertical")[0]

    assert first(1.0000001) == pytest.approx(first(1.0), rel=1e-6)
    assert first(1.0001) == pytest.approx(first(1.0), rel=1e-4)


def test_bearings_and_spans_too_close_are_refused():
    ends = rb.Bearing(0.0, ("z",)), rb.Bearing(L, ("z",))
    with pytest.raises(rb.InputError, match=r"bearings\[3\]\.x = 36.0: is given to two"):
        rb.Beam("b", (L,), M, EI, bearings=(*ends, rb.Bearing(L, ("z", "pitch"))))
    with pytest.raises(rb.InputError, match=r"behind x = 20 m is too short"):
        rb.Beam(
            "b", (L,), M, EI, bearings=(*ends, rb.Bearing(20.0, ("z",)), rb.Bearing(20.001, ("z",)))
        )
    with pytest.raises(rb.InputError, match=r"spans = .*0.001 m behind x = 0 m is too short"):
        rb.Beam("b", (1e-3, 1000.0), M, EI)


@pytest.mark.parametrize("damping", [-0.1, float("nan"), (1.0, -1e-3), (1.0,)])
def test_damping_of_a_deck_is_checked(damping):
    with pytest.raises(rb.InputError, match=r"^damping"):
        SIMPLE.deck(3, damping)


@given(
    lengths=st.lists(st.integers(50, 600), min_size=1, max_size=6),
    continuous=st.booleans(),
)
@settings(max_examples=60, deadline=None)
def test_spans_in_decimals_end_where_their_sum_is_written(lengths, continuous):
    """12.1 + 12.2 + 12.3 is 36.599999999999994 in the computer, and 36.6 for everybody else."""
    ends = [sum(lengths[:i]) / 10 for i in range(len(lengths) + 1)]
    bearings = tuple(rb.Bearing(x) for x in ends)
    spans = tuple(length / 10 for length in lengths)
    beam = rb.Beam("decimals", spans, 12e3, 1.2e10, bearings=bearings, continuous=continuous)
    assert beam.length == pytest.approx(ends[-1], rel=1e-15)
    assert sorted({b.x for b in beam.bearings}) == beam.required_nodes.tolist()
    assert beam.mesh.edges[-1] == beam.length
    assert len(beam.mesh.nodes) - len(beam.mesh.edges) == len(beam.joints)


@pytest.mark.parametrize(
    "given",
    [
        {"bending_stiffness_vertical": 2.05e7, "torsional_stiffness": 2.47e18, "mass": 1e4,
         "polar_inertia": 7e4, "axial_stiffness": 1.19e20, "rotary_inertia_vertical": 1.29e5,
         "centroid_height": 1.6},
        {"bending_stiffness_vertical": 2.9e18, "mass": 1.89e13, "bending_stiffness_lateral": 8.8e11,
         "torsional_stiffness": 8e10, "polar_inertia": 87.0, "axial_stiffness": 9.9e8,
         "shear_stiffness_vertical": 1e10},
    ],
)  # fmt: skip
def test_a_deck_whose_modes_are_lost_in_round_off_is_refused(given):
    """Squares of frequencies came out negative, matrices singular."""
    beam = rb.Beam("ill", (L,), **given)
    with pytest.raises(rb.InputError, match="so far from the deck's mass.*round-off spoils"):
        beam.deck(3, 0.01)


def test_a_deck_of_unusual_but_sound_numbers_keeps_its_modes():
    for factor in (1e-6, 1e6):
        beam = rb.Beam("odd", (L,), M * factor, EI * factor, EIZ * factor)
        assert beam.deck(3, 0.01).frequencies_hz == pytest.approx(SIMPLE_FREQUENCIES, rel=1e-6)


SIMPLE_FREQUENCIES = rb.Beam("simple", (L,), M, EI, EIZ).deck(3).frequencies_hz
