"""What would take minutes and gigabytes is refused before it is meshed, and its field is named."""

import os
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.boxes.boxshell import node_count
from railbridge.boxes.section import MOST_TRIANGLES, section_properties, triangles_needed
from railbridge.boxes.shell import shell_bytes

BOX = rb.box("viaduct36_identified")


def refused(words, function, *arguments, **options):
    start = time.monotonic()
    with pytest.raises(rb.InputError, match=words) as error:
        function(*arguments, **options)
    assert time.monotonic() - start < 15.0
    return error.value


@pytest.mark.parametrize("name", ["slab", "root", "edge", "web", "bottom"])
@pytest.mark.parametrize("thickness", [2e-5, 1e-9])
def test_plates_thinner_than_a_sheet_are_refused(name, thickness):
    field = f"{name}_thickness"
    refused(f"^{field} = {thickness}: .* at least 0.0001", replace, BOX, **{field: thickness})


@pytest.mark.parametrize("field", ["web_thickness", "bottom_thickness"])
def test_a_plate_too_thin_to_mesh_is_refused_before_it_is_meshed(field):
    words = f"^{field} = 0.0002: is so thin that about .* triangles"
    refused(words, lambda: replace(BOX, **{field: 2e-4}).section)
    refused(words, lambda: replace(BOX, **{field: 2e-4}).beam_deck())


def test_the_plate_is_named_as_in_the_file():
    content = {
        "length": 36.0, "damping": {"modal": 0.02},
        "box": {
            "slab_width": 10.0, "slab_thickness": 0.25, "depth": 2.0, "web_thickness": 0.2,
            "web_spacing": 5.0, "bottom_thickness": 2e-4, "youngs_modulus": 35e9,
        },
    }  # fmt: skip
    refused(r"^deck d: box\.bottom_thickness = 0\.0002", rb.deck_from_table, "d", content)
    content["box"]["bottom_thickness"] = 0.2
    shell = content | {"model": "shell"}
    mesh = {"mesh": {"along": 400, "web": 50, "slab": 100, "cantilever": 50}}
    refused(r"^deck d: mesh\.slab = 100: gives the shell", rb.deck_from_table, "d", shell | mesh)
    sliding = {"bearing": [{"x": 0.0, "fixed": "z"}, {"x": 36.0, "fixed": "z"}]}
    refused(r"^deck d: bearing = .*mechanism", rb.deck_from_table, "d", shell | sliding)
    refused(r"^deck d: bearing = .*mechanism", rb.deck_from_table, "d", content | sliding)


@pytest.mark.parametrize(
    "changes",
    [
        {"bottom_thickness": 0.02},
        {"bottom_thickness": 0.002},
        {"web_thickness": 0.001},
        {"slab_thickness": 0.005, "root_thickness": 0.005, "edge_thickness": 0.005},
    ],
)
def test_triangles_are_foreseen(changes):
    geometry = pytest.importorskip("sectionproperties.pre").Geometry
    polygon = pytest.importorskip("shapely").Polygon
    box = replace(BOX, **changes)
    shape = polygon(box.outline, [box.hole])
    made = geometry(shape)
    made.create_mesh([shape.area / 500])
    count = len(made.mesh["triangles"])
    foreseen = triangles_needed(box.outline, (box.hole,))
    assert foreseen < 1.7 * count and count < foreseen + 800


def test_no_usual_box_comes_near_the_limit():
    for thickness in (0.15, 0.01):
        plates = ("slab", "root", "edge", "web", "bottom")
        box = replace(BOX, **{f"{plate}_thickness": thickness for plate in plates})
        assert triangles_needed(box.outline, (box.hole,)) < MOST_TRIANGLES / 2


def test_outlines_of_ones_own_are_bounded_likewise():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    refused("^largest: asks for", section_properties, square, largest=1e-9)
    hole = square * 0.999998 + 1e-6
    refused("^outline: has parts so thin that", section_properties, square, (hole,))
    turn = np.linspace(0.0, 2 * np.pi, 5001)[:-1]
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    refused("^outline = 5000: must list at most 500 corners", section_properties, circle)


def test_corners_closer_than_a_millimetre_are_two():
    wide = np.array([[0.0, 0.0], [90.0, 0.0], [90.0, 0.5], [89.9995, 0.5], [0.0, 0.5]])
    assert section_properties(wide).area == pytest.approx(45.0)


@pytest.mark.parametrize(
    ("mesh", "field"),
    [
        (rb.BoxMesh(400, 50, 100, 50), r"mesh\.slab = 100"),
        (rb.BoxMesh(80, 50, 100, 3), r"mesh\.slab = 100"),
        (rb.BoxMesh(400, 4, 6, 50), r"mesh\.cantilever = 50"),
    ],
)
def test_a_mesh_that_would_not_fit_into_memory_is_refused(mesh, field):
    refused(f"^{field}: gives the shell .*the limit is 2 GB", BOX.shell, mesh)


def test_diaphragms_and_bearings_count_too():
    many = replace(BOX, spans=(36.0,) * 30, bearings=(), inner_diaphragms=20)
    refused(r"^inner_diaphragms = 20: gives the shell", many.shell)
    lines = (rb.Pads(0.0, ("x", "y", "z")), *(rb.Pads(0.01 * i) for i in range(1, 3000)))
    refused(r"^bearings = 3000: gives the shell", replace(BOX, bearings=lines).shell)


@pytest.mark.parametrize("mesh", [rb.BoxMesh(), rb.BoxMesh(20, 3, 4, 2), rb.BoxMesh(100, 4, 8, 3)])
def test_nodes_are_counted_before_they_are_made(mesh):
    pytest.importorskip("pyfe3d")
    for box in (BOX, replace(BOX, inner_diaphragms=0, overhang=0.0)):
        assert node_count(box, mesh) == len(box.shell(mesh).nodes)


def test_more_modes_than_fit_into_memory_are_refused():
    pytest.importorskip("pyfe3d")
    shell = BOX.shell(rb.BoxMesh(100, 10, 20, 10))
    refused("^modes = 3000: so many would need about .* GB", shell.modes, 3000)


def test_the_memory_of_a_shell_is_foreseen():
    """Of a process that does nothing else: factors are out of sight of Python's own counting."""
    pytest.importorskip("pyfe3d")
    if not os.path.exists("/proc/self/status"):
        pytest.skip("needs Linux")
    program = (
        "import re\nimport railbridge as rb\n"
        "def peak():\n"
        "    return int(re.search(r'VmHWM:\\s+(\\d+)', open('/proc/self/status').read())[1])\n"
        "box = rb.box('viaduct36_identified')\nbox.shell(rb.BoxMesh(10, 1, 2, 1)).modes(2)\n"
        "before = peak()\nshell = box.shell(rb.BoxMesh(80, 8, 12, 6))\nshell.modes(15)\n"
        "print((peak() - before) * 1024, 6 * len(shell.nodes))"
    )
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True).stdout
    used, freedoms = map(int, said.split())
    assert 0.6 * used < shell_bytes(freedoms, 15) - 1.2e8 < 2.0 * used
