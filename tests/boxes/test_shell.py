"""Shells against plates, beams and boxes of the textbooks."""

import time

import numpy as np
import pytest

from railbridge.boxes.pads import Pad
from railbridge.boxes.plates import Plate, Strip
from railbridge.boxes.shell import Shell
from railbridge.errors import InputError

E, NU, RHO = 30e9, 0.2, 2500.0
G = E / (2 * (1 + NU))


def flat(width, length, thickness, across, along, pads=(), nu=NU):
    """A plate in the plane z = 0, its strips across y."""
    y = np.linspace(width / 2, -width / 2, across + 1)
    strips = tuple(Strip(i, i + 1, thickness, "plate") for i in range(across))
    return Shell(
        np.column_stack([y, 0 * y]),
        strips,
        np.linspace(0.0, length, along + 1),
        E,
        nu,
        RHO,
        pads=pads,
    )


def tube(width, height, thickness, length, along, sides=4, pads=(), plates=()):
    """A closed rectangular tube of middle lines width x height, corners first."""
    corners = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) * [width / 2, height / 2]
    points = np.concatenate(
        [np.linspace(corners[i], corners[(i + 1) % 4], sides + 1)[:-1] for i in range(4)]
    )
    strips = tuple(Strip(i, (i + 1) % len(points), thickness, "walls") for i in range(len(points)))
    return Shell(
        points, strips, np.linspace(0.0, length, along + 1), E, NU, RHO, plates=plates, pads=pads
    )


def short(x, count, fixed=("x", "y", "z")):
    """Pads so short that each holds one node."""
    return tuple(Pad(x, 1e-3, i, 0.0, fixed) for i in range(count))


def test_supported_square_plate():
    """Thin square plate held along all edges: f = pi/2 (m^2 + n^2) / a^2 sqrt(D / (rho h))."""
    a, h, n = 6.0, 0.06, 24
    stations = np.linspace(0.0, a, n + 1)
    edge = [(x, i) for x in (0.0, a) for i in range(n + 1)] + [
        (x, i) for x in stations[1:-1] for i in (0, n)
    ]
    # Two corners keep the plate in its plane besides.
    pads = tuple(
        Pad(
            x,
            1e-3,
            i,
            0.0,
            ("x", "y", "z")
            if x == 0.0 and i == 0
            else ("x", "z")
            if x == 0.0 and i == n
            else ("z",),
        )
        for x, i in edge
    )
    found = flat(a, a, h, n, n, pads).modes(4).frequencies_hz
    unit = np.pi / 2 / a**2 * np.sqrt(E * h**2 / (12 * (1 - NU**2) * RHO))
    assert found == pytest.approx(unit * np.array([2, 5, 5, 8]), rel=0.012)


def test_cantilever_box_bends_and_twists_as_a_beam():
    """A long thin tube, clamped at one end, plates at stations: bending 1.8751^2, torsion a quarter
    wave over Bredt's J."""
    b, h, t, length = 2.0, 1.6, 0.05, 30.0
    stiffeners = tuple(
        Plate(
            x,
            t,
            np.stack(
                np.meshgrid(np.linspace(b / 2, -b / 2, 5), np.linspace(h / 2, -h / 2, 5)), axis=2
            ),
        )
        for x in np.linspace(0.0, length, 11)
    )
    s = tube(b, h, t, length, 60, pads=short(0.0, 16), plates=stiffeners)
    modes = s.modes(8)
    names = dict(zip(modes.names, modes.frequencies_hz, strict=True))
    stiffener = RHO * t * b * h * 11 / length  # kg/m, spread
    mass = RHO * t * 2 * (b + h) + stiffener
    i_y = 2 * (b * t * (h / 2) ** 2 + t * h**3 / 12)
    i_z = 2 * (h * t * (b / 2) ** 2 + t * b**3 / 12)
    bend = 1.8751**2 / (2 * np.pi * length**2)
    assert names["vertical bending 1"] == pytest.approx(bend * np.sqrt(E * i_y / mass), rel=0.02)
    assert names["lateral bending 1"] == pytest.approx(bend * np.sqrt(E * i_z / mass), rel=0.02)
    j = 4 * (b * h) ** 2 / (2 * (b + h) / t)
    polar = RHO * (i_y + i_z) + stiffener * (b**2 + h**2) / 12
    assert names["torsion 1"] == pytest.approx(np.sqrt(G * j / polar) / (4 * length), rel=0.02)


def test_a_strip_bends_in_its_own_plane():
    """A deep web, one strip, held at both ends: the drilling freedoms let coarse elements bend
    (simple beam with shear)."""
    length, depth, t = 20.0, 1.0, 0.2
    z = np.linspace(depth / 2, -depth / 2, 5)
    strips = tuple(Strip(i, i + 1, t, "web") for i in range(4))
    pads = tuple(
        Pad(x, 1e-3, 2, 0.0, ("x", "y", "z") if x == 0 else ("y", "z")) for x in (0.0, length)
    )
    pads += tuple(Pad(x, 1e-3, i, 0.0, ("y",)) for x in (0.0, length) for i in (0, 4))
    modes = Shell(
        np.column_stack([0 * z, z]), strips, np.linspace(0, length, 21), E, NU, RHO, pads=pads
    ).modes(12)
    i = modes.names.index("vertical bending 1")
    i_y, area = t * depth**3 / 12, t * depth
    k = np.pi / length
    # Timoshenko's simple beam, first order in shear and rotary inertia.
    beam = (
        k**2
        * np.sqrt(E * i_y / (RHO * area))
        / (2 * np.pi)
        / np.sqrt(1 + k**2 * i_y / area * (1 + E / (5 / 6 * G)))
    )
    assert modes.frequencies_hz[i] == pytest.approx(beam, rel=0.01)


def test_modes_are_orthogonal_and_repeatable():
    s = tube(2.0, 1.6, 0.1, 20.0, 20, pads=short(0.0, 16))
    modes, again = s.modes(6), s.modes(6)
    k, m = s.matrices
    v = modes.vectors.reshape(-1, 6)
    assert v.T @ (m @ v) == pytest.approx(np.eye(6), abs=1e-8)
    omega2 = (2 * np.pi * modes.frequencies_hz) ** 2
    assert v.T @ (k @ v) == pytest.approx(np.diag(omega2), abs=1e-6 * omega2.max())
    assert np.array_equal(modes.vectors, again.vectors)
    assert sum(modes.shares.values()) == pytest.approx(np.ones(6))


def test_mass_is_that_of_the_plates():
    s = tube(2.0, 1.6, 0.1, 20.0, 10, pads=short(0.0, 16))
    v = np.zeros((len(s.nodes), 6))
    v[:, 1] = 1.0
    assert v.ravel() @ (s.matrices[1] @ v.ravel()) == pytest.approx(RHO * 0.1 * 7.2 * 20.0)
    assert s.mass_per_metre == pytest.approx(RHO * 0.1 * 7.2)


def test_held_pads_do_not_move_and_turn_freely():
    """The mean displacement over each pad is zero, while the foot over it is inclined."""
    pads = tuple(
        Pad(x, 1.3, i, 0.1, ("x", "y", "z") if x == 1 else ("y", "z"))
        for x in (1.0, 19.0)
        for i in (8, 12)
    )
    s = tube(2.0, 1.6, 0.1, 20.0, 40, pads=pads)
    first = s.modes(3).vectors.reshape(-1, 3)
    for row, _ in s._support_rows:
        assert np.abs(row @ first).max() < 1e-12 * np.abs(first).max() * 1e3
    w = first.reshape(len(s.nodes), 6, 3)[np.arange(41) * len(s.points) + 8, 2]
    assert np.ptp(w[1:4, :], axis=0).max() > 1e-3 * np.abs(w).max()


def test_stiff_springs_are_rigid_bearings():
    def first(kind):
        hold = (
            {"fixed": ("x", "y", "z")}
            if kind == "rigid"
            else {"fixed": (), "stiffness": dict.fromkeys("xyz", kind)}
        )
        pads = tuple(Pad(x, 0.6, i, 0.0, **hold) for x in (1.0, 19.0) for i in (8, 12))
        return tube(2.0, 1.6, 0.1, 20.0, 20, pads=pads).modes(5).frequencies_hz

    assert first(1e14) == pytest.approx(first("rigid"), rel=1e-4)
    assert np.all(first(1e8) < first(1e9)) and np.all(first(1e9) < first("rigid"))


def test_pads_have_a_mesh_limit():
    """Frequencies on pads settle as the mesh is refined: the last doubling moves them less than the
    one before."""

    def found(along):
        pads = tuple(
            Pad(x, 0.8, i, 0.0, ("x", "y", "z"))
            for x in (0.4, 9.6)
            for i in (along // 5 * 2, along // 5 * 3)
        )
        s = tube(2.0, 1.6, 0.2, 10.0, along, sides=max(along // 5, 1), pads=pads)
        return s.modes(1).frequencies_hz[0]

    a, b, c = found(10), found(20), found(40)
    assert abs(c - b) < 0.6 * abs(b - a)


@pytest.mark.parametrize(
    "pads",
    [
        (),
        (Pad(1.0, 0.5, 8, 0.0, ("x", "y", "z")),),
        tuple(Pad(x, 0.5, i, 0.0, ("y", "z")) for x in (1.0, 9.0) for i in (8, 12)),
    ],
)
def test_mechanisms_are_refused(pads):
    with pytest.raises(InputError, match="mechanism"):
        tube(2.0, 1.6, 0.1, 10.0, 10, pads=pads)


def test_pads_and_plates_off_the_shell_are_refused():
    with pytest.raises(InputError, match="off the deck"):
        tube(2.0, 1.6, 0.1, 10.0, 10, pads=(Pad(11.0, 0.5, 8),))
    with pytest.raises(InputError, match="length"):
        tube(2.0, 1.6, 0.1, 10.0, 10, pads=(Pad(1.0, 0.0, 8),))
    grid = np.stack(np.meshgrid(np.linspace(1, -1, 5), np.linspace(0.8, -0.8, 5)), axis=2)
    for plate, says in (
        (Plate(0.123, 0.1, grid), "station"),
        (Plate(0.0, 0.1, 0.9 * grid), "not a point"),
    ):
        with pytest.raises(InputError, match=says):
            _ = tube(2.0, 1.6, 0.1, 10.0, 10, pads=short(0.0, 16), plates=(plate,)).quads
    with pytest.raises(InputError, match="modes"):
        tube(2.0, 1.6, 0.1, 10.0, 10, pads=short(0.0, 16)).modes(0)


def test_missing_library_names_the_extra(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "pyfe3d", None)
    with pytest.raises(InputError, match=r"\[fem\]"):
        tube(2.0, 1.6, 0.1, 10.0, 10, pads=short(0.0, 16)).modes(1)


def test_speed():
    """Fifteen modes of a deck-sized shell within the five seconds that were asked for, of the
    processor."""
    s = tube(
        5.0,
        2.0,
        0.3,
        36.0,
        60,
        sides=6,
        pads=tuple(Pad(x, 0.6, i, 0.0, ("x", "y", "z")) for x in (0.3, 35.7) for i in (12, 18)),
    )
    begin = time.process_time()
    s.modes(15)
    assert time.process_time() - begin < 5.0
