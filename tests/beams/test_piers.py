"""Piers below bearings against hand formulas."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

import railbridge as rb
from railbridge.cautions.notices import remarks_before
from railbridge.settings import check

L, M, EI, EA, EIZ = 30.0, 12e3, 8.93e10, 1.7e11, 8.9e11
PIER = rb.Pier(12.0, 33e9, 4.0, 2.0, 5.0)


def on_pier(middle, spans=(L, L), **more):
    ends = [rb.Bearing(x, ("x", "y", "z") if x == 0.0 else ("y", "z")) for x in (0.0, 2 * L)]
    return rb.Beam("b", spans, M, EI, bearings=(ends[0], middle, ends[1]), **more)


def test_a_pier_is_a_column_and_a_cantilever():
    expected = {
        "x": 3 * 33e9 * 2.0 / 12.0**3, "y": 3 * 33e9 * 5.0 / 12.0**3, "z": 33e9 * 4.0 / 12.0,
    }  # fmt: skip
    assert PIER.stiffness == pytest.approx(expected)


def test_only_what_the_bearing_holds_gives_with_its_pier():
    bearing = rb.Bearing(30.0, ("y", "z", "roll"), pier=PIER)
    assert bearing.springs == pytest.approx({k: PIER.stiffness[k] for k in "yz"})
    assert bearing.rigid == ("roll",) and bearing.restrained == ("y", "z", "roll")
    soft = rb.Bearing(30.0, ("y", "pitch"), stiffness={"z": 2e9, "yaw": 1e8}, pier=PIER)
    series = 1 / (1 / 2e9 + 1 / PIER.stiffness["z"])
    assert soft.springs == pytest.approx({"y": PIER.stiffness["y"], "z": series, "yaw": 1e8})
    assert soft.rigid == ("pitch",) and soft.stiffness == {"z": 2e9, "yaw": 1e8}
    # Moving a bearing along the deck does not put it on its pier twice.
    assert replace(soft, x=29.0).springs == soft.springs
    assert rb.Bearing(30.0, pier=PIER).restrained == ("y", "z", "roll")
    plain = rb.Bearing(30.0, ("y", "z"), stiffness={"x": 1e6})
    assert plain.springs == {"x": 1e6} and plain.rigid == ("y", "z")


@pytest.mark.parametrize("elastomer", [None, 4e8])
def test_two_spans_on_a_pier_share_their_load_with_the_ends(elastomer):
    """A load P over the pier: the beam of 2 L alone is a spring 48 EI / (2 L)^3 beside it."""
    given = {"fixed": ("y", "z")} if elastomer is None else {"stiffness": {"z": elastomer}}
    beam = on_pier(rb.Bearing(L, pier=PIER, **given))
    k = PIER.stiffness["z"]
    k = k if elastomer is None else 1 / (1 / k + 1 / elastomer)
    alone = 48 * EI / (2 * L) ** 3
    recovery, place = beam.deck(5).recovery, np.array([L])
    held = [-recovery.reaction("force_z", x).influence(place)[0, 0, 1] for x in (0.0, L, 2 * L)]
    assert held[1] == pytest.approx(k / (k + alone), rel=1e-9)
    assert held[0] == held[2] == pytest.approx(alone / (k + alone) / 2, rel=1e-6)
    sag = recovery.section("displacement_z", L).influence(place)[0, 0, 1]
    assert sag == pytest.approx(1 / (k + alone), rel=1e-9)
    # The bearing's own line is the reaction; self-weight: 5 w (2L)^4 / 384 EI, less R / alone.
    assert -recovery.bearing(2, "force_z").influence(place)[0, 0, 1] == pytest.approx(held[1])
    w = M * 9.81
    whole = 5 * w * (2 * L) ** 4 / 384 / EI / (1 / alone + 1 / k)
    assert recovery.reaction("force_z", L).self_weight == pytest.approx(whole, rel=1e-9)


def test_two_spans_on_a_pier_solve_their_frequency_equation():
    """Symmetric modes about the pier: a span, pinned, whose inner end stays level on k / 2."""
    soft = replace(PIER, youngs_modulus=1e8)
    k = soft.stiffness["z"]

    def equation(a):
        b = a / L
        stiff = EI * b**3 * 2 * np.cos(a) * np.cosh(a)
        return stiff + (k / 2) * (np.sin(a) * np.cosh(a) - np.sinh(a) * np.cos(a))

    a = brentq(equation, np.pi / 2, 3.9266)
    symmetric = (a / L) ** 2 * np.sqrt(EI / M) / (2 * np.pi)
    found = on_pier(rb.Bearing(L, ("y", "z"), pier=soft)).modes.frequencies_hz
    assert np.min(np.abs(found / symmetric - 1)) < 1e-6
    # Modes with a node over the pier do not feel it.
    assert np.min(np.abs(found / (np.pi / 2 / L**2 * np.sqrt(EI / M)) - 1)) < 2e-5


def test_a_pier_gives_sideways_and_along_with_its_own_second_moments():
    ends = rb.Bearing(0.0, ("y", "z")), rb.Bearing(2 * L, ("y", "z"))
    middle = rb.Bearing(L, ("x", "y", "z"), pier=PIER)
    beam = rb.Beam("b", (L, L), M, EI, EIZ, axial_stiffness=EA, bearings=(ends[0], middle, ends[1]))
    recovery, place = beam.deck(5).recovery, np.array([L])
    alone = 48 * EIZ / (2 * L) ** 3
    sideways = recovery.section("displacement_y", L).influence(place)[0, 0, 0]
    assert sideways == pytest.approx(1 / (PIER.stiffness["y"] + alone), rel=1e-9)
    # Nothing else holds it lengthwise: as a whole on 3 E I / h^3.
    names, found = beam.modes.names, beam.modes.frequencies_hz
    rigid = np.sqrt(PIER.stiffness["x"] / (M * 2 * L)) / (2 * np.pi)
    assert found[names.index("axial 1")] == pytest.approx(rigid, rel=5e-3)


def test_wheels_that_step_onto_a_pier_are_told_of():
    def said(**own):
        ends = rb.Bearing(0.0, ("x", "y", "z"), **own), rb.Bearing(L, ("y", "z"), **own)
        deck = rb.Beam("b", (L,), M, EI, bearings=ends).deck(5, 0.01)
        train = rb.AxleTrain((0.0,), (1e5,))
        return remarks_before(train, deck, rb.Track(), check(train, deck, rb.Track(), speed=20.0))

    moving = [r for r in said(pier=rb.Pier(40.0, 33e9, 1.0, 0.2, 0.2)) if "moves" in r.text]
    assert len(moving) == 1 and "piers" in moving[0].text
    assert not any("moves" in r.text for r in said())


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"height": 0.0}, r"^height = 0.0: must be a finite number above 0 m\."),
        ({"area": -4.0}, r"^area = -4.0: .* above 0 m2\."),
        ({"second_moment_across": 0.0}, r"^second_moment_across = 0.0: .* above 0 m4\."),
    ],
)
def test_a_pier_that_cannot_be_is_refused(wrong, message):
    with pytest.raises(rb.InputError, match=message):
        replace(PIER, **wrong)


def test_what_is_no_pier_or_hardly_one_is_refused():
    with pytest.raises(rb.InputError, match="^pier = 12.0: must be a Pier"):
        rb.Bearing(0.0, pier=12.0)
    with pytest.raises(
        rb.InputError, match=r"^pier.second_moment_along = 2.0: .*along x than 1e\+16 N/m"
    ):
        rb.Bearing(0.0, pier=replace(PIER, height=1e-7))


def test_a_pier_that_holds_nothing_leaves_a_mechanism():
    ends = rb.Bearing(0.0, ("z",)), rb.Bearing(L, ("z",), pier=replace(PIER, youngs_modulus=1e-6))
    with pytest.raises(rb.InputError, match="^bearings = .*pitching, so it is a mechanism"):
        rb.Beam("b", (L,), M, EI, bearings=ends)


def test_a_pier_below_the_joint_of_simple_spans_must_say_which_span_it_carries():
    middle = rb.Bearing(L, ("x", "y", "z"), pier=PIER)
    with pytest.raises(rb.InputError, match=r"^bearings\[2\]\.span: is missing: two simple spans"):
        on_pier(middle, continuous=False)
    ends = rb.Bearing(0.0, ("x", "y", "z")), rb.Bearing(2 * L, ("y", "z"))
    own = rb.Bearing(L, ("y", "z"), span=1, pier=PIER), rb.Bearing(L, ("x", "z"), span=2, pier=PIER)
    beam = rb.Beam("b", (L, L), M, EI, continuous=False, bearings=(ends[0], *own, ends[1]))
    assert [b.span for b in beam.bearings] == [1, 1, 2, 2]


@pytest.mark.parametrize(
    ("field", "value", "word"),
    [
        ("height", 12e3, "given in mm"), ("youngs_modulus", 33.0, "given in GPa"),
        ("area", 4e4, "given in cm2"), ("second_moment_along", 2e4, "given in cm4 or dm4"),
        ("second_moment_across", 500.0, "radius of gyration of 11.2 m"),
    ],
)  # fmt: skip
def test_an_unlikely_pier_is_doubted_by_its_bearing(field, value, word):
    beam = on_pier(rb.Bearing(L, ("y", "z"), pier=replace(PIER, **{field: value})))
    (said,) = beam.remarks
    assert said.field == f"bearings[2].pier.{field}" and word in said.text
    assert on_pier(rb.Bearing(L, ("y", "z"), pier=PIER)).remarks == ()
