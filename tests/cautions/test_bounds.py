"""What numbers usually are, and what was probably done wrong where they are not."""

import pytest

from railbridge.cautions import bounds
from railbridge.cautions.bounds import BOUNDS, doubt, material, soft_bearing, worst

# A slip as people type it, and the question that is asked.
SLIPS = [
    ("youngs_modulus", 35e3, "given in MPa"),
    ("youngs_modulus", 210.0, "given in GPa"),
    ("youngs_modulus", 35e6, "given in kN/m2"),
    ("density", 2.5, "given in t/m3"),
    ("density", 25.0, "a weight in kN/m3"),
    ("density", 24500.0, "a weight in N/m3"),
    ("density", 2.5e6, "given in g/m3"),
    ("density", 250.0, "is its decimal point right"),
    ("steel_density", 77e3, "a weight in N/m3"),
    ("steel_density", 7.85e6, "given in g/m3"),
    ("area", 48e3, "given in cm2 or mm2"),
    ("area", 4.8e6, "given in mm2"),
    ("second_moment", 2.5e8, "given in cm4 or mm4"),
    ("second_moment", 2.5e12, "given in mm4"),
    ("second_moment", 25e3, "given in cm4 or dm4"),
    ("span", 36e3, "given in mm or cm"),
    ("span", 0.036, "given in km"),
    ("mass", 12.0, "given in t/m or a weight in kN/m"),
    ("mass", 88.0, "a weight in kN/m"),
    ("mass", 12e6, "given in g/m"),
    ("mass", 4e5, "a weight in N/m"),
    ("track_mass", 4.2, "given in t/m"),
    ("width", 9600.0, "given in mm"),
    ("width", 960.0, "given in cm"),
    ("height", 1200.0, "given in mm"),
    ("height", 120.0, "given in mm or cm"),
    ("bearing_shear", 2e3, "given in kN/m or MN/m"),
    ("bearing_shear", 2.0, "given in MN/m"),
    ("pier_height", 12e3, "given in mm or cm"),
    ("pier_height", 1200.0, "given in cm"),
    ("sleepers", 0.06, "is its decimal point right"),
    ("rail_stiffness", 1.28e4, "given in kN m2"),
    ("rail_stiffness", 12.8, "given in MN m2"),
    ("foundation", 1e5, "given in kN/m2"),
    ("foundation", 100.0, "given in MN/m2"),
    ("axle_load", 170.0, "given in kN"),
    ("axle_load", 17.0, "given in t"),
    ("axle_load", 17e3, "given in kg"),
    ("axle_load", 1.7e6, "ten times too large"),
    ("axle_gap", 2500.0, "given in mm or cm"),
    ("axle_gap", 250.0, "given in cm"),
    ("axle_gap", 0.2, "a hundred times too small"),
    ("axle_gap", 0.025, "a hundred times too small or given in km"),
    ("axle_gap", 0.0025, "given in km"),
    ("axle_reach", 15600.0, "given in mm"),
    ("axle_reach", 1560.0, "given in cm"),
    ("axle_pause", 30e3, "given in mm"),
    ("axle_pause", 450.0, "given in cm"),
    ("body_mass", 5.09, "given in t, or its thousands mark read as a decimal point"),
    ("body_mass", 50.99e6, "given in g"),
    ("wheelset_mass", 180.0, "ten times too light"),
    ("wheelset_mass", 18e3, "ten times too heavy"),
    ("car_load", 400.0, "masses given in t"),
    ("car_load", 2e8, "masses given in g"),
    ("half_gauge", 980.0, "given in mm"),
    ("half_gauge", 98.0, "given in cm"),
    ("half_gauge", 9.8, "ten times too far"),
    ("wheelset_radius", 0.0236, "its inertia given in t m2"),
    ("wheelset_radius", 745.0, "its inertia given in kg mm2"),
    ("wheelset_height", 460.0, "given in mm"),
    ("wheelset_height", 46.0, "given in cm"),
    ("contact_stiffness", 1.3e6, "given in N/mm or kN/m"),
    ("contact_stiffness", 1.3e3, "given in kN/mm"),
    ("contact_damping", 45.0, "a thousand times too large"),
    ("series_stiffness", 6e3, "given in kN/m or N/mm"),
    ("series_stiffness", 6.0, "given in kN/mm"),
    ("off_axis", 2400.0, "given in mm"),
    ("off_axis", -240.0, "given in cm"),
    ("off_axis", 24.0, "ten times too far"),
    ("amplitude", 5.0, "given in mm or cm"),
    ("wavelength", 14400.0, "given in mm or cm"),
    ("wavelength", 0.0144, "given in km"),
    ("notch_depth", 1.0, "given in mm"),
    ("notch_depth", 0.1, "given in mm or cm"),
    ("circumference", 2700.0, "given in mm"),
    ("circumference", 270.0, "given in cm"),
    ("slope", 0.5, "is its decimal point right"),
]


@pytest.mark.parametrize(("name", "value", "question"), SLIPS)
def test_what_was_probably_done_wrong_is_asked(name, value, question):
    (said,) = doubt(name, "deck.x", value)
    bound = BOUNDS[name]
    assert said.field == "deck.x"
    unit = f" {bound.unit}" if bound.unit else ""
    assert str(said) == f"deck.x = {value:g}{unit}, usual is {bound.range}: {question}?"


def test_every_slip_that_is_known_has_an_example():
    for name, bound in BOUNDS.items():
        asked = " ".join(question for slip, _, question in SLIPS if slip == name)
        for _, words in bound.slips:
            assert words.removeprefix("given in ") in asked


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("youngs_modulus", "1e+09 to 4e+11 Pa"), ("track_mass", "at least 20 kg/m"),
        ("speed", "at most 117 m/s"), ("phase", "at most 6.28 rad"), ("slope", "at most 0.1"),
        ("damping_ratio", "at most 0.2"),
    ],
)  # fmt: skip
def test_bounds_are_told_in_words(name, words):
    assert BOUNDS[name].range == words


LENGTHS = (
    "amplitude axle_gap axle_pause axle_reach bearing_sag bending_radius circumference half_gauge "
    "height notch_depth off_axis overhang pier_height pier_radius polar_radius sleepers span "
    "wavelength wheelset_height wheelset_radius width"
)
UNITS = {
    "m": LENGTHS, "m2": "area", "m4": "second_moment", "m/s": "speed", "Hz": "vehicle_frequency",
    "rad": "phase", "Pa": "youngs_modulus", "N": "axle_load car_load",
    "N/m": "bearing_shear contact_stiffness series_stiffness",
    "kg": "body_mass wheelset_mass", "kg/m": "mass track_mass", "kg/m3": "density steel_density",
    "N m2": "rail_stiffness", "N/m2": "foundation",
    "": "contact_damping damping_frequency damping_ratio live_sag point_mass shear_share slope",
}  # fmt: skip


def test_every_bound_has_its_unit():
    assert {name: bound.unit for name, bound in BOUNDS.items()} == {
        name: unit for unit, names in UNITS.items() for name in names.split()
    }


def test_of_several_values_the_one_farthest_off_is_named():
    loads = [170e3, 5e3, 12e6, 100e3]
    assert worst("axle_load", loads) == 12e6
    assert worst("axle_load", [170e3, 500.0, 12e6]) == 500.0
    assert worst("axle_load", [170e3, 0.0, 12e6]) == 0.0
    assert worst("axle_load", [170e3, 40e3]) == 40e3  # nearest to its bound, 27 kN
    assert worst("off_axis", [2.4, -240.0, 20.0]) == -240.0


def test_a_material_is_doubted_in_stiffness_and_density():
    assert material(35e9, 2500.0) == material(2.1e11, 7850.0) == material(2.1e11, 4e4) == []
    assert [(w.field, w.text[:9]) for w in material(35e3, 25.0)] == [
        ("youngs_modulus", "= 35000 P"), ("density", "= 25 kg/m"),
    ]  # fmt: skip
    (heavy,) = material(2.1e11, 8e4)
    assert heavy.text == ("= 80000 kg/m3, usual is 300 to 75000 kg/m3: a weight in N/m3?")
    (light,) = material(2.1e11, 2.5)
    assert light.text == "= 2.5 kg/m3, usual is 300 to 20000 kg/m3: given in t/m3?"


@pytest.mark.parametrize(
    ("direction", "stiffness", "text"),
    [
        ("z", 2e9, ""),
        ("z", 1e7, ""),  # gives way by 0.1 m, the most that passes
        ("z", 2e6, "= 2e+06 N/m gives way by 0.5 m under the deck's own weight: given in kN/m?"),
        ("z", 2e3, "= 2000 N/m gives way by 500 m under the deck's own weight: given in MN/m?"),
        ("z", 2.0, "= 2 N/m gives way by 5e+05 m under the deck's own weight: "
                   "given in another unit?"),
        ("x", 5e3, "= 5000 N/m, usual is at least 20000 N/m: given in kN/m or MN/m?"),
        ("y", 5.0, "= 5 N/m, usual is at least 20000 N/m: given in MN/m?"),
        ("y", 5e6, ""), ("roll", 5.0, ""), ("pitch", 5.0, ""), ("yaw", 5.0, ""),
    ],
)  # fmt: skip
def test_soft_springs_of_bearings_are_doubted_by_their_unit(direction, stiffness, text):
    """Below a share of 1 MN of the deck's weight."""
    found = soft_bearing("bearing[1].stiffness", direction, stiffness, 1e6)
    assert [str(w) for w in found] == ([f"bearing[1].stiffness {text}"] if text else [])


def test_the_table_of_the_documents_tells_every_bound_with_its_reason():
    head, rule, *rows = bounds.table()
    assert head == "| what | passes | because |" and rule == "|---|---|---|"
    assert len(rows) == len(BOUNDS) + 2
    assert rows[0] == (
        "| first vertical frequency | up to 3 times below and 2.5 times above Figure 6.10, "
        "longest span | EN 1991-2, 6.4.4; arches are slower, portal frames faster |"
    )
    assert "| at least 0.2 and 0.12 |" in rows[1]
    assert "| speed of more than one axle | at most 117 m/s |" in "".join(rows)
