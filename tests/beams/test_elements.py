"""Shear flexibility, rotary inertia and a centroid off the axis against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railbridge as rb
from railbridge.beams.elements import matrices, rotation_powers, shape_matrices

L, M, EI, EIZ, GJ, EA, INERTIA = 36.0, 12e3, 8.93e10, 8.93e11, 8.15e10, 1.68e11, 7.02e4
KGA, ROTARY = 2.2e10, 6.4e3


def waves(mode, shear, rotary):
    """Angular frequency of a simple Timoshenko beam's mode: sine and cosine in both equations of
    motion give a 2 x 2 problem."""
    k = mode * np.pi / L
    if shear is None:
        return k**2 * np.sqrt(EI / (M + rotary * k**2))
    stiffness = np.array([[shear * k**2, -shear * k], [-shear * k, EI * k**2 + shear]])
    if not rotary:
        return np.sqrt((stiffness[0, 0] - stiffness[0, 1] ** 2 / stiffness[1, 1]) / M)
    return np.sqrt(np.linalg.eigvals(stiffness / np.array([[M], [rotary]])).real.min())


def simple(shear=None, rotary=None, elements=40):
    return rb.Beam(
        "b",
        (L,),
        M,
        EI,
        elements=elements,
        shear_stiffness_vertical=shear,
        rotary_inertia_vertical=rotary,
    )


@pytest.mark.parametrize("rotary", [None, ROTARY])
@pytest.mark.parametrize("shear", [None, KGA, 3e9])
def test_frequencies_of_a_simple_beam_with_and_without_the_switches(shear, rotary):
    expected = np.array([waves(n, shear, rotary or 0.0) for n in range(1, 7)]) / (2 * np.pi)
    coarse, fine = (simple(shear, rotary, n).modes.frequencies_hz[:6] for n in (40, 80))
    # Of fourth order; of second where the shear strain is constant in every element.
    order = 4 if shear is None else 2
    assert fine == pytest.approx(expected, rel=1e-4 if shear is None else 2.5e-3)
    assert (2**order * fine - coarse) / (2**order - 1) == pytest.approx(expected, rel=2e-5)


def test_lateral_switches_work_sideways_only():
    beam = rb.Beam("b", (L,), M, EI, EI, shear_stiffness_lateral=KGA, rotary_inertia_lateral=ROTARY)
    found = {
        n: f
        for n, f in zip(beam.modes.names, beam.modes.frequencies_hz, strict=True)
        if n.endswith(" 2")
    }
    assert found["lateral bending 2"] == pytest.approx(
        waves(2, KGA, ROTARY) / (2 * np.pi), rel=2e-4
    )
    assert found["vertical bending 2"] == pytest.approx(waves(2, None, 0.0) / (2 * np.pi), rel=1e-4)


@pytest.mark.parametrize("at", [18.0, 7.77, 0.4])
def test_modal_section_forces_of_a_timoshenko_beam(at):
    """w = A sin kx, psi = B cos kx with B = A (k - m omega^2 / (kGA k)), unit modal mass counting
    the turning too."""
    deck = simple(KGA, ROTARY, 240).deck(4)
    for mode in range(1, 5):
        k, omega = mode * np.pi / L, waves(mode, KGA, ROTARY)
        share = k - M * omega**2 / (KGA * k)
        size = 1 / np.sqrt((M + ROTARY * share**2) * L / 2)
        for quantity, expected in [
            ("displacement_z", size * np.sin(k * at)),
            ("moment_vertical", EI * share * k * size * np.sin(k * at)),
            ("shear_vertical", KGA * (k - share) * size * np.cos(k * at)),
        ]:
            # Up to its sign, which is the deck's own.
            sign = np.sign(deck.shapes(np.array([0.1]))[0, mode - 1, 1])
            scale = {
                "displacement_z": size,
                "moment_vertical": EI * share * k * size,
                "shear_vertical": KGA * k * size,
            }[quantity]
            assert sign * deck.recovery.section(quantity, at).modal[mode - 1] == pytest.approx(
                expected, abs=4e-5 * scale
            )


RECOVERIES = [simple(shear).deck(2).recovery for shear in (None, KGA)]


@settings(max_examples=40)
@given(at=st.floats(0.0, L), x=st.floats(0.0, L))
def test_influence_lines_of_a_beam_that_gives_in_shear(at, x):
    """Forces of a simple beam do not know of it; deflections are a (L - b) / (L kGA) larger."""
    place = np.array([x])
    a, b = min(x, at), max(x, at)

    def both(quantity):
        return [r.section(quantity, at).influence(place)[0, 0, 1] for r in RECOVERIES]

    if abs(x - at) > 1e-6:
        for quantity in ("moment_vertical", "shear_vertical"):
            without, given_ = both(quantity)
            assert given_ == pytest.approx(without, abs=1e-7)
    without, given_ = both("displacement_z")
    assert given_ - without == pytest.approx(a * (L - b) / (L * KGA), rel=1e-6, abs=1e-17)


def test_self_weight_and_two_spans_with_shear_flexibility():
    w = M * 9.81
    soft = simple(KGA).deck(2).recovery
    sag = 5 * w * L**4 / 384 / EI + w * L**2 / 8 / KGA
    assert soft.section("displacement_z", L / 2).self_weight == pytest.approx(-sag, rel=1e-9)
    # Force method: the middle reaction of two equal spans makes up for the sag of the simple beam.
    middle = sag / (L**3 / 48 / EI + L / 4 / KGA)
    two = rb.Beam("b", (L / 2, L / 2), M, EI, shear_stiffness_vertical=KGA).deck(2).recovery
    assert two.reaction("force_z", L / 2).self_weight == pytest.approx(middle, rel=1e-9)


@pytest.mark.parametrize("name", ["lateral", "torsion", "axial"])
@given(phi=st.floats(0.0, 50.0), h=st.floats(0.1, 10.0))
def test_elements_move_rigidly_without_force_and_weigh_what_they_should(name, phi, h):
    size, shear = np.array([h]), np.array([phi if name == "lateral" else 0.0])
    k, m = (a[0] for a in matrices(name, size, shear, 3.0, 2.0, 0.5))
    moved = [1.0, 0.0, 1.0, 0.0] if name == "lateral" else [1.0, 1.0, 1.0]
    assert np.abs(k @ moved).max() < 1e-9 * np.abs(k).max()
    assert moved @ m @ moved == pytest.approx(2.0 * h, rel=1e-9)
    assert np.allclose(k, k.T, rtol=1e-12) and np.allclose(m, m.T, rtol=1e-12)
    if name == "lateral":
        turned = np.array([0.0, 1.0, h, 1.0])
        assert np.abs(k @ turned).max() < 1e-9 * np.abs(k).max()
        assert turned @ m @ turned == pytest.approx(2.0 * h**3 / 3 + 0.5 * h, rel=1e-9)
        # psi at both ends is what the freedoms say.
        psi = rotation_powers(size, shear)[0] @ shape_matrices(name, size, shear)[0]
        assert psi[0] == pytest.approx([0, 1, 0, 0], abs=1e-9 * (1 + phi) / h)
        assert psi.sum(axis=0) == pytest.approx([0, 0, 0, 1], abs=1e-9 * (1 + phi) / h)


def test_a_centroid_off_the_axis_couples_lateral_bending_and_torsion():
    """Simple beam, each mode n: [EIz k^4, GJ k^2] against [[m, -m z], [-m z, I + m z^2]] (sines in
    both)."""
    z = 0.9
    ends = rb.Bearing(0.0, ("x", "y", "z", "roll")), rb.Bearing(L, ("y", "z", "roll"))
    beam = rb.Beam(
        "b",
        (L,),
        M,
        EI,
        EIZ,
        GJ,
        None,
        INERTIA,
        bearings=(rb.Bearing(0.0), rb.Bearing(L)),
        centroid_height=z,
    )
    whole = rb.Beam("b", (L,), M, EI, EIZ, GJ, EA, INERTIA, bearings=ends, centroid_height=z)
    expected = []
    for n in range(1, 5):
        k = n * np.pi / L
        mass = np.array([[M, -M * z], [-M * z, INERTIA + M * z**2]])
        expected += list(
            np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, np.diag([EIZ * k**4, GJ * k**2]))).real)
            / (2 * np.pi)
        )
    for deck in (beam, whole):
        sideways = np.flatnonzero(
            deck.modes.energies["lateral"] + deck.modes.energies["torsion"] > 0.5
        )[:5]
        assert deck.modes.frequencies_hz[sideways] == pytest.approx(np.sort(expected)[:5], rel=2e-4)
    # The bearing at the shear centre is 0.9 m below the centroid, so it also couples lengthwise and
    # vertical motion.
    assert whole.modes.frequencies_hz[0] < beam.modes.frequencies_hz[0]
    # Modal values by quadrature of the line itself, where the section cuts an element.
    deck = beam.deck(8)
    points, weights = np.polynomial.legendre.leggauss(6)
    for quantity in ("torsion", "moment_lateral", "displacement_y", "rotation_x", "shear_lateral"):
        line = deck.recovery.section(quantity, 11.3)
        edges = line.influence.edges
        x = (edges[:-1, None] + np.diff(edges)[:, None] * (points + 1) / 2).ravel()
        dx = (np.diff(edges)[:, None] * weights / 2).ravel()
        ours, shapes = line.influence(x)[:, 0], deck.shapes(x)
        inertia = M * (ours[:, :1] - z * ours[:, 2:]) * (shapes[..., 0] - z * shapes[..., 2])
        inertia += INERTIA * ours[:, 2:] * shapes[..., 2]
        expected = (2 * np.pi * deck.frequencies_hz) ** 2 * (dx @ inertia)
        assert line.modal == pytest.approx(expected, abs=1e-9 * np.abs(line.modal).max())


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"shear_stiffness_vertical": 0.0}, "shear_stiffness_vertical = 0"),
        ({"rotary_inertia_vertical": -1.0}, "rotary_inertia_vertical = -1"),
        ({"shear_stiffness_lateral": 1e10}, "bending_stiffness_lateral: is missing"),
        ({"rotary_inertia_lateral": 1e3}, "bending_stiffness_lateral: is missing"),
        ({"centroid_height": float("nan")}, "centroid_height"),
        ({"continuous": 1}, "continuous = 1: must be true or false"),
    ],
)
def test_wrong_switches_are_refused(wrong, message):
    with pytest.raises(rb.InputError, match=message):
        rb.Beam("b", (L,), M, EI, **wrong)
