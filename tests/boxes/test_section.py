"""Sections against formulas of the textbooks."""

import math

import numpy as np
import pytest

from railbridge.boxes.section import SectionProperties, refuse_crossing, section_properties
from railbridge.errors import InputError


def rectangle(width, height, y=0.0, z=0.0):
    return np.array([(y, z), (y + width, z), (y + width, z + height), (y, z + height)])


def test_solid_rectangle():
    """Area and second moments exactly; J by the series of Saint-Venant; 5/6 of the area in shear;
    centre in the middle."""
    b, h = 1.0, 2.0
    s = section_properties(rectangle(b, h, 3.0, 1.0), poisson_ratio=0.0)
    assert s.area == pytest.approx(b * h, rel=1e-9)
    assert s.second_moment_vertical == pytest.approx(b * h**3 / 12, rel=1e-9)
    assert s.second_moment_lateral == pytest.approx(h * b**3 / 12, rel=1e-9)
    series = sum(math.tanh(n * math.pi * h / (2 * b)) / n**5 for n in range(1, 30, 2))
    assert s.torsion_constant == pytest.approx(
        h * b**3 / 3 * (1 - 192 * b / (math.pi**5 * h) * series), rel=2e-3
    )
    assert (s.shear_area_vertical, s.shear_area_lateral) == pytest.approx(
        (5 / 6 * b * h, 5 / 6 * b * h), rel=1e-3
    )
    assert s.centroid == pytest.approx((3.5, 2.0), rel=1e-9)
    assert s.shear_centre == pytest.approx((3.5, 2.0), rel=1e-4)


def test_thin_box_is_bredt():
    """J = 4 A_m^2 / sum(s / t) for a thin closed cell; its solid corners stiffen it by less than t
    / height."""
    width, height, t = 2.0, 1.0, 0.04
    cell = rectangle(width - 2 * t, height - 2 * t, t, t)
    s = section_properties(rectangle(width, height), (cell,), poisson_ratio=0.0)
    a, b = width - t, height - t
    bredt = 4 * (a * b) ** 2 / (2 * (a + b) / t) + 2 * (a + b) * t**3 / 3
    assert bredt < s.torsion_constant < bredt * (1 + t / height)


def test_open_channel_has_its_shear_centre_outside():
    """Thin channel: shear centre at e = 3 b^2 / (h + 6 b) behind the web's middle line
    (Timoshenko)."""
    b, h, t = 0.5, 1.0, 0.02
    outline = [(0, 0), (b, 0), (b, t), (t, t), (t, h - t), (b, h - t), (b, h), (0, h)]
    s = section_properties(outline, poisson_ratio=0.0)
    bm, hm = b - t / 2, h - t
    assert s.shear_centre[0] == pytest.approx(t / 2 - 3 * bm**2 / (hm + 6 * bm), abs=0.01 * b)
    assert s.torsion_constant == pytest.approx((hm + 2 * bm) * t**3 / 3, rel=0.03)


def test_the_table_of_a_section_says_every_value_with_its_unit():
    frame = SectionProperties(
        area=4.8, second_moment_vertical=2.5, second_moment_lateral=25.0, product_moment=0.0,
        torsion_constant=5.6, shear_area_lateral=3.0, shear_area_vertical=1.4,
        centroid=(0.0, 1.5), shear_centre=(0.0, 1.2),
    ).to_frame()  # fmt: skip
    assert list(frame.columns) == ["value", "unit"]
    assert [(name, *row) for name, row in zip(frame.index, frame.to_numpy(), strict=True)] == [
        ("area A", 4.8, "m2"),
        ("second moment, vertical bending I_y", 2.5, "m4"),
        ("second moment, lateral bending I_z", 25.0, "m4"),
        ("torsion constant J", 5.6, "m4"),
        ("shear area, vertical", 1.4, "m2"),
        ("shear area, lateral", 3.0, "m2"),
        ("height of the centroid", 1.5, "m"),
        ("height of the shear centre", 1.2, "m"),
    ]


@pytest.mark.parametrize(
    ("outline", "holes", "says"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], (), "cross"),
        ([(0, 0), (1, 0)], (), "three corners"),
        ([(0, 0), (1, 0), (2, 0)], (), "cross|encloses"),
        ([(0, 0), (0, 0), (1, 0), (1, 1)], (), "twice"),
        ([(0, 0), (1, float("nan")), (1, 1)], (), "three corners"),
        ("square", (), "three corners"),
        (rectangle(1, 1), (rectangle(1, 0.5),), "holes\\[1\\].*inside"),
        (rectangle(1, 1), (rectangle(0.5, 0.5, 2.0),), "holes\\[1\\].*inside"),
    ],
)
def test_wrong_outlines_are_refused(outline, holes, says):
    with pytest.raises(InputError, match=says):
        section_properties(outline, holes)


def test_touching_itself_is_crossing():
    with pytest.raises(InputError, match="cross"):
        refuse_crossing("outline", np.array([(0, 0), (2, 0), (2, 1), (1, 0), (0, 1)], dtype=float))


CHANNEL = [(0, 0), (5, 0), (5, 1), (1, 1), (1, 9), (5, 9), (5, 10), (0, 10)]
# The upper flange turned down through the lower one.
FOLDED = [(0, 0), (5, 0), (5, 1), (1, 1), (1, 9), (3, 9), (3, -1), (0, 10)]


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("first", range(8))
def test_corners_may_go_round_either_way_from_any_of_them(way, first):
    turned = [
        np.roll(np.array(line, dtype=float)[::way], first, axis=0) for line in (CHANNEL, FOLDED)
    ]
    refuse_crossing("outline", turned[0])
    with pytest.raises(InputError, match="the edges that start at these corners cross"):
        refuse_crossing("outline", turned[1])


def test_missing_library_names_the_extra(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "sectionproperties.analysis", None)
    with pytest.raises(InputError, match=r"\[fem\]"):
        section_properties(rectangle(1, 1))
