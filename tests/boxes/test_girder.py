"""Boxes: section by hand, the beam, what is refused, and deck files."""

import re
from dataclasses import fields, replace

import numpy as np
import pytest
from box_tables import PLAIN, box

import railbridge as rb
from railbridge.boxes import Pads
from railbridge.cases.objects import box_from_table
from railbridge.errors import InputError


@pytest.fixture(scope="module")
def plain():
    return box()


def parts(rectangles):
    """Area, height of the centroid, I_y and I_z of rectangles (width, height, middle y, middle z),
    by Steiner."""
    a = np.array([w * h for w, h, _, _ in rectangles])
    y, z = np.array([(y, z) for *_, y, z in rectangles]).T
    centroid = a @ z / a.sum()
    own_y = sum(w * h**3 / 12 for w, h, *_ in rectangles)
    own_z = sum(h * w**3 / 12 for w, h, *_ in rectangles)
    return a.sum(), centroid, own_y + a @ (z - centroid) ** 2, own_z + a @ y**2


def thin_walled_shear_area():
    """I^2 / sum of int S^2 / t ds over one half of the box, whose flow is zero in the planes of
    symmetry and at the edge.

    Level plates give way between the faces of the webs only.
    """
    zs, zb = 1.875, 0.1
    lengths, heights, t = (
        np.array([2.3, 2.5, 2.5, 1.775]),
        np.array([zs, zs, zb, 0.9875]),
        np.array([0.25, 0.25, 0.2, 0.35]),
    )
    area = lengths * t
    centre = area @ heights / area.sum()
    inertia = 2 * (area @ (heights - centre) ** 2 + 0.35 * 1.775**3 / 12)

    def flow_squared(length, height, thickness):
        # S grows evenly along a level plate that starts without flow.
        return thickness * (height - centre) ** 2 * length**3 / 3

    total = sum(flow_squared(*p) for p in ((2.125, zs, 0.25), (2.325, zs, 0.25), (2.325, zb, 0.2)))
    z, step = np.linspace(zs, zb, 2001, retstep=True)
    start = 0.25 * (zs - centre) * (2.3 + 2.5)
    flow = start + 0.35 * np.concatenate(
        [[0.0], np.cumsum(((z[1:] + z[:-1]) / 2 - centre) * -step)]
    )
    total += np.sum(flow**2) * -step / 0.35
    return inertia**2 / (2 * total)


def test_section_by_hand(plain):
    """Four rectangles; J by Bredt's formula on middle lines plus b t^3 / 3 of the cantilevers."""
    area, centroid, i_y, i_z = parts(
        [
            (9.6, 0.25, 0, 1.875),
            (5.35, 0.2, 0, 0.1),
            (0.35, 1.55, 2.5, 0.975),
            (0.35, 1.55, -2.5, 0.975),
        ]
    )
    s = plain.section
    assert s.area == pytest.approx(area, rel=1e-9)
    assert s.centroid == pytest.approx((0.0, centroid), abs=1e-9)
    assert s.second_moment_vertical == pytest.approx(i_y, rel=1e-9)
    assert s.second_moment_lateral == pytest.approx(i_z, rel=1e-9)
    height = 2.0 - 0.125 - 0.1
    bredt = (
        4 * (5.0 * height) ** 2 / (5.0 / 0.25 + 5.0 / 0.2 + 2 * height / 0.35)
        + 2 * 2.125 * 0.25**3 / 3
    )
    assert bredt < s.torsion_constant < 1.06 * bredt
    assert s.shear_area_vertical == pytest.approx(thin_walled_shear_area(), rel=0.005)
    assert 0.0 < s.shear_centre[1] < 2.0 and s.shear_centre[0] == pytest.approx(0.0, abs=1e-3)
    assert plain.concrete_mass == pytest.approx(2500 * area)


def test_leaning_webs_and_haunches_have_the_drawn_area():
    """The section's area, by the library, is that of the outline by the shoelace formula, and of
    the parts by hand."""
    b = box(bottom_spacing=4.0, root_thickness=0.45, edge_thickness=0.18, haunch_length=1.0)
    assert b.section.area == pytest.approx(b.concrete_mass / 2500, rel=1e-9)
    # Slab in the middle, cantilevers and haunches as trapezia between the webs' middle planes;
    # webs; bottom.
    slab = 3.0 * 0.25 + 2 * 1.0 * 0.35 + 2 * 2.3 * (0.45 + 0.18) / 2
    lean = 0.5 / (2.0 - 0.225 - 0.1)
    webs = 2 * 0.35 * np.hypot(1, lean) * (2.0 - 0.45 - 0.2)
    bottom = 0.2 * (4.0 + 0.35 * np.hypot(1, lean))
    assert b.section.area == pytest.approx(slab + webs + bottom, rel=0.01)


def test_bearings_stand_where_the_pads_are(plain):
    found = {(b.x, round(b.y, 9)) for b in plain.beam().bearings}
    assert found == {(0.0, 2.5), (0.0, -2.5), (0.0, 0.0), (36.0, 2.5), (36.0, -2.5)}
    assert {round(b.z, 9) for b in plain.beam().bearings} == {
        round(-plain.section.shear_centre[1], 9)
    }
    # Held lengthwise under both webs, a beam would be clamped in plan; a box is not.
    clamped = dict(
        zip(
            (b := plain.beam(clamped_in_plan=True)).modes.names, b.modes.frequencies_hz, strict=True
        )
    )
    free = dict(zip((b := plain.beam()).modes.names, b.modes.frequencies_hz, strict=True))
    assert clamped["lateral bending 1"] > 1.25 * free["lateral bending 1"]
    # Lengthwise held below the centroid: second bending and axial motion form a pair.
    names = plain.beam().modes.names
    assert any(n.startswith("axial-bending") for n in names[:8])


def test_pads_lower_and_softer_are_bearings_lower_and_softer(plain):
    """Lengthwise the two springs of a line become one of both in the middle."""
    given = (
        Pads(0.0, ("y", "z"), stiffness={"x": 3e8}, drop=0.3),
        Pads(36.0, ("y", "z"), drop=0.2),
    )
    soft = box(bearings=given)
    centre = soft.section.shear_centre[1]
    found = {(b.x, b.y): b for b in soft.beam().bearings}
    assert {(x, round(b.z + centre, 9)) for (x, _), b in found.items()} == {
        (0.0, -0.3),
        (36.0, -0.2),
    }
    assert dict(found[0.0, 0.0].stiffness) == {"x": 6e8}
    assert not any("x" in b.restrained for place, b in found.items() if place != (0.0, 0.0))
    apart = soft.beam(clamped_in_plan=True).bearings
    assert [dict(b.stiffness) for b in apart if b.x == 0.0] == [{"x": 3e8}] * 2


def test_the_centroid_stands_where_the_section_has_it(plain):
    """The beam's axis runs through the shear centre; heights count from the underside."""
    height = plain.beam().centroid_height
    assert abs(height) > 0.05
    assert height + plain.section.shear_centre[1] == pytest.approx(plain.section.centroid[1])


def test_masses_of_track_and_edges_turn_with_the_section(plain):
    """Track over the width between the webs, edges at the ends of the slab, both on its middle
    plane."""
    track, edge = 4000.0, 1500.0
    bare, loaded = box().beam(), box(track_mass=track, edge_mass=edge).beam()
    lever = 2.0 - 0.25 / 2 - plain.section.centroid[1]
    about_y = (track + edge) * lever**2
    about_z = track * 5.0**2 / 12 + edge * 4.8**2
    assert loaded.mass - bare.mass == pytest.approx(track + edge)
    for name, more in (
        ("rotary_inertia_vertical", about_y),
        ("rotary_inertia_lateral", about_z),
        ("polar_inertia", about_y + about_z),
    ):
        assert getattr(loaded, name) - getattr(bare, name) == pytest.approx(more), name


def test_rails_stand_on_the_slab_whatever_the_model_s_axis(plain):
    """Both heights lead to the same place, 2 m above the bottom's underside."""
    beam = plain.beam_deck(2)
    assert beam.track_height + plain.section.shear_centre[1] == pytest.approx(plain.depth)
    # The shell's line is the middle plane of the slab where the webs meet it.
    shell = plain.shell_deck(2, mesh=rb.BoxMesh(16, 2, 4, 2))
    assert shell.track_height == pytest.approx(plain.slab_thickness / 2)
    haunched = box(root_thickness=0.45)
    shell = haunched.shell_deck(2, mesh=rb.BoxMesh(16, 2, 4, 2))
    assert shell.track_height == pytest.approx(haunched.head_thickness / 2)
    assert haunched.head_thickness > haunched.slab_thickness


def test_switches_soften_the_beam(plain):
    stiff = plain.beam(shear=False, rotary_inertia=False).modes.frequencies_hz[0]
    assert (
        plain.beam().modes.frequencies_hz[0]
        < plain.beam(rotary_inertia=False).modes.frequencies_hz[0]
        < stiff
    )


FILE = {
    "spans": [36.0], "box": PLAIN, "damping": {"modal": 0.02}, "tracks": {"left": 2.4},
    "bearing": [{"x": 0.0, "fixed": "x y z"}, {"x": 36.0, "fixed": "y z"}],
}  # fmt: skip


def test_deck_files_give_a_beam_or_a_shell():
    beam = rb.deck_from_table("test", FILE | {"modes": 8})
    shell = rb.deck_from_table(
        "test", FILE | {"model": "shell", "modes": 8, "mesh": {"along": 20, "web": 2, "slab": 4}}
    )
    for made in (beam, shell):
        assert (made.name, made.length, made.supports) == ("test", 36.0, (0.0, 36.0))
        assert (made.tracks, made.width) == ({"left": 2.4}, 9.6)
        assert made.damping_ratios.tolist() == [0.02] * 8
        assert made.mode_names[0] == "vertical bending 1" and len(made.mode_names) == 8
    assert beam.mass_per_metre == pytest.approx(shell.mass_per_metre)
    assert beam.recovery.lacks == "" and "only its modes" in shell.recovery.lacks
    assert shell.frequencies_hz[0] == pytest.approx(beam.frequencies_hz[0], rel=0.03)
    x = np.array([9.0, 18.0, 30.0])
    ours, theirs = np.abs(shell.shapes(x)[:, 0, 1]), np.abs(beam.shapes(x)[:, 0, 1])
    assert ours == pytest.approx(theirs, rel=0.03)
    slope = (shell.shapes(x + 1e-5)[:, 0] - shell.shapes(x - 1e-5)[:, 0]) / 2e-5
    assert shell.shapes(x, 1)[:, 0] == pytest.approx(slope, rel=1e-4, abs=1e-9)


def test_both_models_of_a_box_warn_of_the_same(plain):
    odd = box(youngs_modulus=34e6, track_mass=0.7)
    vars(odd)["section"] = plain.section  # the same concrete
    shell = odd.shell_deck(mesh=rb.BoxMesh(8, 1, 2, 1), damping=(0.5, 1e-3))
    beam = odd.beam_deck(2)
    for found in (odd.remarks, shell.remarks, beam.remarks):
        assert [remark.field for remark in found[:2]] == ["youngs_modulus", "track_mass"]
    assert list(map(str, shell.remarks)) == list(map(str, odd.remarks))
    # Fifteen modes of a span where no number is given, damped as Rayleigh has it.
    omega = 2 * np.pi * shell.frequencies_hz
    assert len(omega) == 15
    assert shell.damping_ratios == pytest.approx(0.25 / omega + 5e-4 * omega)


def test_a_car_crosses_the_shell():
    """Static sag under slow axles: shell deck (no static correction, 30 modes) and beam deck within
    5 %."""
    train = rb.AxleTrain((0.0, 2.5), (100e3, 100e3))
    peaks = []
    for model in (
        {"modes": 10},
        {
            "model": "shell",
            "modes": 30,
            "mesh": {"along": 20, "web": 2, "slab": 4, "cantilever": 2},
        },
    ):
        deck = rb.deck_from_table("test", FILE | model)
        run = rb.cross(train, deck, rb.Track(), speed=5.0)
        peaks.append(np.abs(run.displacement(18.0)["displacement_z"]).max())
    assert peaks[1] == pytest.approx(peaks[0], rel=0.05)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"slab_thickness": 0.0}, "slab_thickness.*at least 0.0001"),
        ({"web_thickness": -0.3}, "web_thickness.*at least 0.0001"),
        ({"bottom_thickness": float("nan")}, "bottom_thickness.*finite"),
        ({"diaphragm_thickness": 0.0}, "diaphragm_thickness.*at least 0.0001"),
        ({"web_spacing": 9.5}, "webs stand outside the slab"),
        ({"bottom_spacing": 9.5}, "bottom wider than the slab|outside the slab"),
        ({"web_spacing": 0.3}, "run into each other"),
        ({"bottom_spacing": 0.2}, "run into each other"),
        ({"depth": 0.5}, "leaves .* of height"),
        ({"edge_thickness": 1.9}, "leaves .* of height"),
        ({"root_thickness": 0.4, "haunch_length": 2.6}, "haunch_length"),
        ({"slab_width": "wide"}, "slab_width"),
        ({"slab_width": 9600.0}, "at most 100"),
        ({"track_mass": -1.0}, "track_mass"),
        ({"inner_diaphragms": 1, "diaphragm_thickness": None}, "inner_diaphragm_thickness"),
        ({"tracks": {"left": 5.0}}, "tracks.left"),
        ({"bearings": (Pads(0.0), Pads(40.0))}, r"bearings\[2\]\.x = 40.0.*lie on the deck"),
    ],
)
def test_wrong_boxes_are_refused(changes, says):
    with pytest.raises(InputError, match=says):
        box(**changes)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"fixed": ("w",)}, "fixed = 'w': must be one of x, y, z"),
        ({"fixed": 3}, "fixed = 3: must list some of x y z"),
        ({"fixed": ("x",), "stiffness": {"x": 1e6}}, "stiffness.x = 1000000.0: is fixed, too"),
        ({"stiffness": {"x": 0.0}}, "stiffness.x = 0"),
        ({"under": "middle"}, "under = 'middle': must be one of both, left, right"),
        ({"length": 0.0}, "length = 0.0: .*above 0"),
        ({"drop": -1.0}, "drop = -1.0: .*at least 0"),
    ],
)
def test_wrong_pads_are_refused(given, says):
    with pytest.raises(InputError, match=f"^{says}"):
        Pads(0.0, **given)


def test_mechanisms_are_refused_by_both_models():
    loose = box(bearings=(Pads(0.0, ("y", "z")), Pads(36.0, ("y", "z"))))
    for build in (loose.shell, loose.beam):
        with pytest.raises(InputError, match="mechanism"):
            build()


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"box": {k: v for k, v in PLAIN.items() if k != "depth"}}, "depth: is missing"),
        ({"box": PLAIN | {"dept": 2.0}}, "Did you mean 'depth'"),
        ({"box": 3.0}, "table"),
        ({"model": "solid"}, "beam, shell"),
        ({"mesh": {"web": 2}}, "belongs to the shell"),
        ({"model": "shell", "mesh": {"webs": 2}}, "Did you mean 'web'"),
        ({"model": "shell", "shear": True}, "switch of the beam"),
        ({"shear": "yes"}, "true or false"),
        ({"section": {}}, "section = {}: cannot stand beside box"),
        ({"bearing": [{"x": 0.0}]}, "fixed: is missing"),
        ({"bearing": {"x": 0.0}}, "list of tables"),
        ({"bearing": [{"x": 0.0, "fixed": 3}]}, "must list some"),
        ({"length": 36.0}, "either length or spans"),
    ],
)
def test_wrong_deck_files_are_refused(changes, says):
    with pytest.raises(InputError, match=says):
        rb.deck_from_table("test", FILE | changes)


def test_boxes_load_by_name(tmp_path):
    with pytest.raises(InputError, match=r"viaduct36.toml: box: this deck file has no such table"):
        rb.box("viaduct36")
    with pytest.raises(InputError, match="Did you mean"):
        rb.box("viaduct36_identifed")
    assert box_from_table("test", FILE) == replace(
        box(tracks={"left": 2.4}), bearings=(Pads(0.0, ("x", "y", "z")), Pads(36.0))
    )


def test_pads_that_miss_the_end_by_rounding_stand_on_it():
    pads = (Pads(0.0, ("x", "y", "z")), Pads(36.0 * (1 + 1e-10), ("y", "z")))
    assert replace(rb.box("viaduct36_identified"), bearings=pads).bearings[1].x == 36.0


@pytest.mark.parametrize("kind", [rb.Box, rb.Pads, rb.BoxMesh])
def test_help_says_what_every_field_means(kind):
    for f in fields(kind):
        assert re.search(rf"^ *(\w+, )*{f.name}(, \w+)* : ", kind.__doc__, re.MULTILINE), f.name
