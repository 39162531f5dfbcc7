"""The shell of a box: mass, meshes, diaphragms, cantilevers."""

import numpy as np
import pytest
from box_tables import PLAIN, box

import railbridge as rb
from railbridge.boxes.boxshell import BoxMesh
from railbridge.errors import InputError

COARSE = BoxMesh(20, 2, 4, 2)


def test_shell_weighs_what_the_drawing_says():
    b = box(
        root_thickness=0.4,
        edge_thickness=0.2,
        bottom_spacing=4.4,
        track_mass=700.0,
        edge_mass=500.0,
    )
    s = b.shell(COARSE)
    assert s.mass_per_metre == pytest.approx(b.mass_per_metre)
    moved = np.zeros((len(s.nodes), 6))
    moved[:, 2] = 1.0
    cell = 4.7 * (2.0 - 0.2 - 0.1)  # mean width and height of a diaphragm, between middle planes
    expected = b.mass_per_metre * 36.6 + 2 * 2500 * 0.3 * cell
    assert moved.ravel() @ (s.matrices[1] @ moved.ravel()) == pytest.approx(expected, rel=2e-3)


def test_mesh_converges_at_fixed_pads():
    """Each refinement moves the lowest modes less, and the default mesh is within 2.5 % of the
    finest for 15 modes."""
    found = box().convergence((0.5, 1.0, 2.0))
    assert list(found.columns) == ["20 x 2 x 3 x 2", "40 x 4 x 6 x 3", "80 x 8 x 12 x 6"]
    assert found.index.name == "mode" and found.index.tolist() == list(range(1, 16))
    table = found.to_numpy()
    steps = np.abs(np.diff(table[:6], axis=1))
    assert np.all(steps[:, 1] < steps[:, 0])
    assert np.abs(table[:, 1] / table[:, 2] - 1).max() < 0.025


def test_more_diaphragms_stiffen_torsion():
    one, more = (box(inner_diaphragms=n).shell(COARSE).modes(6) for n in (0, 2))
    assert (
        more.frequencies_hz[more.names.index("torsion 1")]
        > 1.03 * one.frequencies_hz[one.names.index("torsion 1")]
    )


def test_thin_cantilevers_flap_locally():
    """A thin cantilever is a clamped plate: its ladder of local modes starts below that of a thick
    one."""
    modes = box(root_thickness=0.18, edge_thickness=0.12).shell(COARSE).modes(12)
    local = [i for i, n in enumerate(modes.names) if n.startswith("local plate")]
    assert len(local) >= 3 and all(modes.parts[i] == "cantilevers" for i in local)
    clamped = (
        3.516 / (2 * np.pi) / (2.3 - 0.175) ** 2 * 0.15 * np.sqrt(34e9 / (12 * (1 - 0.04) * 2500))
    )
    assert 0.6 * clamped < modes.frequencies_hz[local[0]] < 1.1 * clamped
    assert set(modes.symmetric[local].tolist()) == {True, False}


def test_a_continuous_box_has_diaphragms_over_every_line():
    two = rb.Box("two", (20.0, 20.0), **PLAIN)
    modes = two.shell(BoxMesh(10, 2, 4, 2)).modes(4)
    single = rb.Box("one", (20.0,), **PLAIN).shell(BoxMesh(10, 2, 4, 2)).modes(1)
    assert len(two.shell(BoxMesh(10, 2, 4, 2)).plates) == 3
    assert modes.frequencies_hz[0] == pytest.approx(single.frequencies_hz[0], rel=0.15)


@pytest.mark.parametrize(
    ("mesh", "says"),
    [
        ({"web": 0}, "across joins nothing"),
        ({"along": 2}, "along"),
        ({"slab": 1}, "slab"),
        ({"cantilever": 0}, "cantilever"),
    ],
)
def test_meshes_without_elements_are_refused(mesh, says):
    with pytest.raises(InputError, match=says):
        BoxMesh(**mesh)


def test_pads_stand_under_the_feet_of_the_webs_they_name():
    shell = box(
        bearings=(rb.Pads(0.0, ("x", "y", "z"), drop=0.2), rb.Pads(36.0, under="left"))
    ).shell(COARSE)
    feet = [(pad.x, *shell.points[pad.point]) for pad in shell.pads]
    assert np.allclose(feet, [(0.0, 2.5, 0.1), (0.0, -2.5, 0.1), (36.0, 2.5, 0.1)])
    assert [pad.arm for pad in shell.pads] == pytest.approx([0.3, 0.3, 0.1])
    assert shell.stations[[0, -1]].tolist() == [-0.3, 36.3] and {0.0, 36.0} <= set(
        shell.stations.tolist()
    )
    heads = shell.points[list(COARSE.heads)]
    assert np.allclose(heads, [(2.5, 1.875), (-2.5, 1.875)])
