"""Rigid motions of sections, shares of energy and names, for motions that are known."""

from dataclasses import replace

import numpy as np
import pytest

from railbridge.boxes.motions import KINDS, described, section_motions
from railbridge.boxes.pads import Pad
from railbridge.boxes.plates import Strip
from railbridge.boxes.shell import Shell

CORNERS = np.array([(1.0, 0.8), (-1.0, 0.8), (-1.0, -0.8), (1.0, -0.8)])
PARTS = ("top", "right", "bottom", "left")
TUBE = Shell(
    CORNERS,
    tuple(Strip(i, (i + 1) % 4, 0.1, part) for i, part in enumerate(PARTS)),
    np.linspace(0.0, 20.0, 21),
    30e9,
    0.2,
    2500.0,
    pads=tuple(Pad(x, 1.0, i, 0.0, ("x", "y", "z")) for x in (1.0, 19.0) for i in range(4)),
)
WAVE = np.sin(np.pi * TUBE.stations / 20.0)


def moving(x=0.0, y=0.0, z=0.0):
    """A motion of the section's points times a half sine along the deck, shape (nodes, 6, 1)."""
    section = np.stack(np.broadcast_arrays(x, y, z, 0.0, 0.0, 0.0), axis=-1) * np.ones((4, 6))
    return (WAVE[:, None, None] * section).reshape(-1, 6, 1)


Y, Z = CORNERS.T
RIGID = {
    0: {"x": 1.0},
    1: {"y": 1.0},
    2: {"z": 1.0},
    3: {"y": -Z, "z": Y},
    4: {"x": Z},
    5: {"x": -Y},
}


@pytest.mark.parametrize("way", RIGID)
def test_a_rigid_motion_is_found_as_itself(way):
    found = section_motions(TUBE, moving(**RIGID[way]))[..., 0]
    expected = np.zeros((21, 6))
    expected[:, way] = WAVE
    assert found == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(
    ("motion", "kind", "name"),
    [
        (RIGID[2], "vertical", "vertical bending 1"),
        (RIGID[1], "lateral", "lateral bending 1"),
        (RIGID[3], "torsion", "torsion 1"),
        (RIGID[0], "axial", "axial 1"),
        ({"x": 1.0, "z": 1.0}, "axial", "axial-bending 1"),
        ({"y": Z, "z": Y}, "local", "local plate 1"),  # the diagonals change length: distortion
    ],
)
def test_modes_are_named_by_what_moves(motion, kind, name):
    modes = described(TUBE, np.array([3.0]), moving(**motion))
    assert modes.names == (name,) and modes.shares[kind][0] > 0.49
    assert sum(modes.shares[k][0] for k in KINDS) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("axial", "vertical", "lateral", "local", "name"),
    [
        (0.0, 0.45, 0.0, 0.55, "local plate 1"),
        (0.0, 0.55, 0.0, 0.45, "vertical bending 1"),
        (0.0, 0.3, 0.22, 0.48, "vertical bending 1"),  # local only above a half
        (0.2, 0.8, 0.0, 0.0, "vertical bending 1"),
        (0.3, 0.7, 0.0, 0.0, "axial-bending 1"),
        (0.7, 0.3, 0.0, 0.0, "axial-bending 1"),
        (0.8, 0.2, 0.0, 0.0, "axial 1"),
        (0.27, 0.27, 0.46, 0.0, "axial-bending 1"),  # together more than the rest
        (0.23, 0.23, 0.54, 0.0, "lateral bending 1"),
    ],
)
def test_names_follow_the_shares_of_the_kinetic_energy(axial, vertical, lateral, local, name):
    """All four motions have the same mass; that across grows with y and moves no section."""
    x, z, y, across = np.sqrt([axial, vertical, lateral, local])
    modes = described(TUBE, np.array([3.0]), moving(x=x, y=y + across * Y, z=z))
    assert modes.names == (name,)
    found = [modes.shares[kind][0] for kind in ("axial", "vertical", "lateral", "torsion", "local")]
    assert found == pytest.approx([axial, vertical, lateral, 0.0, local], abs=1e-12)
    assert min(found) >= 0.0


@pytest.mark.parametrize(
    ("motion", "alike"),
    [
        (RIGID[0], True), (RIGID[1], False), (RIGID[2], True), (RIGID[3], False),
        (RIGID[4], True), (RIGID[5], False), ({"y": Y}, True), ({"z": Y}, False),
    ],
)  # fmt: skip
def test_left_and_right_move_alike_where_a_mirror_shows_the_same(motion, alike):
    assert described(TUBE, np.array([1.0]), moving(**motion)).symmetric.tolist() == [alike]
    # Without its own mirror image a section has no such modes, and all count as alike.
    leaning = replace(TUBE, points=CORNERS + [[0.3, 0.0], [0.3, 0.0], [0.0, 0.0], [0.0, 0.0]])
    assert described(leaning, np.array([1.0]), moving(**motion)).symmetric.tolist() == [True]


def test_the_table_of_modes_gives_shares_of_energy_in_percent():
    vectors = np.concatenate([moving(**RIGID[2]), moving(x=1.0, z=1.0)], axis=2)
    frame = described(TUBE, np.array([3.0, 4.5]), vectors).to_frame()
    assert frame.index.name == "mode" and frame.index.tolist() == [1, 2]
    shares = [f"{kind} (%)" for kind in KINDS]
    assert list(frame.columns) == ["frequency (Hz)", "name", "most local in", *shares]
    assert frame["frequency (Hz)"].tolist() == [3.0, 4.5]
    assert frame["name"].tolist() == ["vertical bending 1", "axial-bending 1"]
    assert set(frame["most local in"]) <= set(PARTS)
    assert frame[shares].to_numpy() == pytest.approx(
        np.array([[100.0, 0.0, 0.0, 0.0, 0.0], [50.0, 0.0, 0.0, 50.0, 0.0]]), abs=1e-9
    )


def test_names_are_numbered_within_their_kind_and_mirrors_are_told():
    vectors = np.concatenate([moving(**RIGID[w]) for w in (2, 3, 2)], axis=2)
    modes = described(TUBE, np.array([1.0, 2.0, 3.0]), vectors)
    assert modes.names == ("vertical bending 1", "torsion 1", "vertical bending 2")
    assert modes.symmetric.tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("part", "points"), [("top", (0, 1)), ("bottom", (2, 3)), ("left", (3, 0))]
)
def test_the_liveliest_part_is_named(part, points):
    """A part whose two points move, its neighbours' one each."""
    assert described(TUBE, np.array([1.0]), moving(z=np.isin(range(4), points))).parts == (part,)
