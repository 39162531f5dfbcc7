"""Deck files: what the keys mean, and how they are refused."""

import copy
import dataclasses
import tomllib

import numpy as np
import pytest

import railbridge as rb
from railbridge import exchange
from railbridge.beams.bearings import Bearing
from railbridge.cases import objects as decks
from railbridge.cases import shelf
from railbridge.errors import InputError
from railbridge.exchange.tables import read_columns

SECTION = {
    "youngs_modulus": 35e9, "poisson_ratio": 0.2, "density": 2500.0, "area": 4.8,
    "second_moment_vertical": 2.553, "second_moment_lateral": 25.53, "torsion_constant": 5.59,
}  # fmt: skip
EI, EA, G = 35e9 * 2.553, 35e9 * 4.8, 35e9 / 2.4
TABLE = {
    "length": 36.0,
    "section": SECTION,
    "damping": {"modal": 0.02},
    "width": 9.6,
    "bearing": [
        {"x": 0.0, "y": 1.5, "z": -1.3, "fixed": "y z", "stiffness": {"x": 6e9}},
        {"x": 0.0, "y": -1.5, "z": -1.3, "fixed": "z"},
        {"x": 36.0, "y": 1.5, "z": -1.3, "fixed": ["y", "z"]},
        {"x": 36.0, "y": -1.5, "z": -1.3, "stiffness": {"z": 2e9}},
    ],
}


def changed(**more):
    return {**copy.deepcopy(TABLE), **more}


def beam_of(deck):
    return deck.recovery.beam


def test_bearings_of_a_file_stand_where_it_says():
    deck = decks.deck_from_table("b", TABLE)
    assert deck.bearings == (
        (0.0, 1.5, -1.3),
        (0.0, -1.5, -1.3),
        (36.0, 1.5, -1.3),
        (36.0, -1.5, -1.3),
    )
    assert deck.supports == (0.0, 36.0)
    assert beam_of(deck).bearings[0] == Bearing(0.0, ("y", "z"), 1.5, -1.3, {"x": 6e9})
    assert [b.restrained for b in beam_of(deck).bearings] == [
        ("x", "y", "z"),
        ("z",),
        ("y", "z"),
        ("z",),
    ]
    same = rb.Beam(
        "b",
        (36.0,),
        12e3,
        EI,
        35e9 * 25.53,
        G * 5.59,
        EA,
        2500 * 28.083,
        bearings=beam_of(deck).bearings,
    )
    assert deck.frequencies_hz == pytest.approx(same.deck(20).frequencies_hz, rel=1e-12)


def test_switches_of_a_file_are_off_unless_given():
    usual = decks.deck_from_table("b", changed())
    assert (beam_of(usual).shear_stiffness_vertical, beam_of(usual).rotary_inertia_vertical) == (
        None,
        None,
    )
    assert (beam_of(usual).continuous, usual.track_height, beam_of(usual).centroid_height) == (
        True,
        0.0,
        0.0,
    )
    section = {**SECTION, "shear_area_vertical": 1.4, "shear_area_lateral": 3.0}
    deck = decks.deck_from_table(
        "b", changed(section=section, rotary_inertia=True, track_height=1.1, centroid_height=0.2)
    )
    beam = beam_of(deck)
    assert (beam.shear_stiffness_vertical, beam.shear_stiffness_lateral) == pytest.approx(
        (G * 1.4, G * 3.0)
    )
    assert (beam.rotary_inertia_vertical, beam.rotary_inertia_lateral) == pytest.approx(
        (2500 * 2.553, 2500 * 25.53)
    )
    assert (deck.track_height, beam.centroid_height) == (1.1, 0.2)
    assert deck.frequencies_hz[0] < usual.frequencies_hz[0]
    stiff = {
        "length": 30.0, "mass": 1e4, "bending_stiffness_vertical": 5e10, "damping": {"modal": 0.01},
        "shear_stiffness_vertical": 1e10, "rotary_inertia_vertical": 4e3,
    }  # fmt: skip
    assert beam_of(decks.deck_from_table("b", stiff)).shear_flexibility("vertical") == 5.0


def test_spans_that_do_not_run_through():
    table = {k: v for k, v in TABLE.items() if k not in ("length", "bearing")}
    deck = decks.deck_from_table("b", {**table, "spans": [20.0, 20.0], "continuous": False})
    alone = decks.deck_from_table("b", {**table, "length": 20.0})
    assert deck.frequencies_hz[:2] == pytest.approx([alone.frequencies_hz[0]] * 2, rel=1e-3)
    assert len(deck.bearings) == 4
    own = [
        {"x": 0.0, "fixed": "x y z roll"},
        {"x": 20.0, "fixed": "y z roll", "span": 1},
        {"x": 20.0, "fixed": "x y z roll", "span": 2},
        {"x": 40.0, "fixed": "y z roll"},
    ]
    told = decks.deck_from_table(
        "b", {**table, "spans": [20.0, 20.0], "continuous": False, "bearing": own}
    )
    assert told.frequencies_hz == pytest.approx(deck.frequencies_hz, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"bearing": {"x": 0.0}}, r"deck b: bearing = .*must be a list of tables"),
        ({"bearing": [{"fixed": "z"}]}, r"deck b: bearing\[1\]\.x: is missing"),
        ({"bearing": [{"x": 0.0}]}, r"deck b: bearing\[1\]\.fixed: is missing"),
        (
            {"bearing": [{"x": 0.0, "fixed": 3}]},
            r"bearing\[1\]\.fixed = 3: must list some of x y z",
        ),
        ({"bearing": [{"x": 0.0, "fixed": "x w"}]}, r"bearing\[1\]\.fixed = 'w'"),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "y": 5.0}]},
            r"bearing\[1\]\.y = 5.0: is off the deck, half width 4.8 m",
        ),
        ({"bearing": [{"x": 0.0, "fixed": "z", "z": -1300.0}]}, r"bearing\[1\]\.z = -1300.0"),
        ({"bearing": [{"x": 40.0, "fixed": "z"}]}, r"bearing\[1\]\.x = 40.0"),
        ({"bearing": [{"x": 0.0, "stiffness": {"z": -1.0}}]}, r"bearing\[1\]\.stiffness.z = -1.0"),
        (
            {"bearing": [{"x": 0.0, "stiffness": 6e9}]},
            r"bearing\[1\]\.stiffness = 6000000000.0: must be a table",
        ),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "stifness": {}}]},
            r"bearing\[1\]\.stifness: unknown key",
        ),
        ({"bearing": TABLE["bearing"][1:]}, r"deck b: bearing = .*sliding along x"),
        (
            {"bearing": [*TABLE["bearing"], TABLE["bearing"][0]]},
            r"given to two bearings in one place",
        ),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "span": 1}]},
            r"bearing\[1\]\.span = 1: is only for simple spans",
        ),
        ({"continuous": "no"}, r"continuous = 'no': must be true or false"),
        ({"rotary_inertia": 3.0}, r"rotary_inertia = 3.0: must be true or false"),
        (
            {"rotary_inertia_vertical": 3.0},
            r"rotary_inertia_vertical = 3.0: a section is given too",
        ),
        ({"track_height": 1800.0}, r"track_height = 1800.0"),
        ({"centroid_height": "low"}, r"centroid_height = 'low'"),
        (
            {"section": {**SECTION, "shear_area_vertical": 0.0}},
            r"section.shear_area_vertical = 0.0",
        ),
    ],
    ids=str,
)
def test_bad_decks_are_refused_by_name(change, message):
    with pytest.raises(rb.InputError, match=message):
        decks.deck_from_table("b", changed(**change))


def test_rotary_inertia_needs_a_section_or_numbers():
    table = {
        "length": 30.0,
        "mass": 1e4,
        "bending_stiffness_vertical": 5e10,
        "damping": {"modal": 0.01},
        "rotary_inertia": True,
    }
    with pytest.raises(
        rb.InputError, match="rotary_inertia = True: follows from a section only"
    ) as error:
        decks.deck_from_table("b", table)
    assert "rotary_inertia_vertical" in error.value.remedy


WITHOUT = ("symbol", "source", "note")


def car_table(
    tmp_path, separator=",", decimal=".", columns=("name", "value", "unit"), drop=(), **add
):
    """Write the paper's car in another way, and return the path."""
    table = read_columns(shelf.data_file("vehicles", "xia2000"), ["name", "value", "unit"], WITHOUT)
    rows = zip(*(table.cells[c] for c in ("name", "value", "unit")), strict=True)
    rows = [*(row for row in rows if row[0] not in drop), *((k, *v) for k, v in add.items())]
    rows = [dict(zip(("name", "value", "unit"), row, strict=True)) for row in rows]
    lines = [separator.join(row[c].replace(".", decimal) for c in columns) for row in rows]
    path = tmp_path / "mine.csv"
    path.write_text("\n".join([separator.join(columns), *lines]), encoding="utf-8")
    return path


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_car_s_table_needs_names_values_and_units_only(tmp_path, separator):
    usual = rb.vehicle("xia2000")
    decimal = "." if separator == "," else ","
    for columns in (("name", "value", "unit"), ("unit", "value", "name")):
        found = rb.vehicle(car_table(tmp_path, separator, decimal, columns))
        assert found.bodies == usual.bodies and found.springs == usual.springs
        assert found.length == usual.length == 22.5


def test_static_wheelsets_of_a_car_s_table_weigh_on_the_rail(tmp_path):
    usual = rb.vehicle("xia2000")
    found = rb.vehicle(car_table(tmp_path, static_wheelset_mass=("1.78", "t")))
    assert found.static_wheelset_mass == 1780.0 and found.wheelsets == ()
    assert found.weight == pytest.approx(usual.weight + 4 * 1780.0 * 9.81)
    more = [
        b.static_load - a.static_load for a, b in zip(usual.contacts, found.contacts, strict=True)
    ]
    assert more == pytest.approx([1780.0 * 9.81 / 2] * 8)
    assert found.modes().frequencies_hz == pytest.approx(usual.modes().frequencies_hz)
    with pytest.raises(InputError, match="wheelset_mass = -1.0: must be a finite number at least"):
        rb.vehicle(car_table(tmp_path, static_wheelset_mass=("-1", "kg")))


def test_wheelsets_of_a_car_s_table_are_bodies_on_contact_springs(tmp_path):
    rows = {
        "wheelset_mass": ("1.78", "t"), "wheelset_roll_inertia": ("1.0", "t m2"),
        "gauge": ("1500", "mm"), "contact_stiffness": ("1400", "MN/m"),
    }  # fmt: skip
    found = rb.vehicle(car_table(tmp_path, **rows))
    assert [b.name for b in found.wheelsets] == [
        "front wheelset 1", "front wheelset 2", "rear wheelset 1", "rear wheelset 2",
    ]  # fmt: skip
    assert {b.mass for b in found.wheelsets} == {1780.0}
    assert {b.inertia for b in found.wheelsets} == {(1000.0, 0.0, 0.0)}
    assert {b.freedoms for b in found.wheelsets} == {("y", "z", "roll")}
    assert {abs(c.y) for c in found.contacts} == {0.75} and found.static_wheelset_mass == 0.0
    assert found.contact_stiffness[:, 1] == pytest.approx(1.4e9)
    static = rb.vehicle(car_table(tmp_path, static_wheelset_mass=("1.78", "t")))
    loads = [c.static_load for c in static.contacts]
    assert [c.static_load for c in found.contacts] == pytest.approx(loads)
    assert found.weight == pytest.approx(static.weight)
    # Steel wheels on steel rails where nothing is said of the contact: by Hertz.
    rows = {name: rows[name] for name in ("wheelset_mass", "wheelset_roll_inertia")}
    hertz = rb.vehicle(car_table(tmp_path, **rows)).contact_stiffness
    assert hertz[:, 1] == pytest.approx(1.33739e9 * np.cbrt(np.array(loads) / 80e3), rel=1e-6)
    assert hertz[:, 0] == pytest.approx(1.4 / 1.7 * hertz[:, 1])
    massless = rb.vehicle(car_table(tmp_path, wheelset_mass=("0", "kg")))
    assert massless.springs == rb.vehicle("xia2000").springs


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        (
            {"wheelset_mass": ("1", "t"), "static_wheelset_mass": ("1", "t")},
            "wheelset_mass = 1000.0: static_wheelset_mass is given too, never both",
        ),
        ({"gauge": ("1.5", "m")}, "gauge = 1.5: has no meaning without wheelset_mass"),
        (
            {"primary_longitudinal_stiffness": ("10", "MN/m")},
            "primary_longitudinal_stiffness = 10000000.0: has no meaning without wheelset_mass",
        ),
        (
            {"wheelset_mass": ("1", "t")},
            "wheelset_roll_inertia: is missing. Give it, kg m2; for the weight alone call the mass "
            "static_wheelset_mass",
        ),
        ({"wheelset_mas": ("1", "t")}, "row wheelset_mas: unknown parameter. Did you mean"),
        (
            {"wheelset_mass": ("1", "t"), "gauge": ("0", "m")},
            "gauge = 0.0: must be a finite number above 0 and at most 5 m",
        ),
        (
            {"wheelset_mass": ("1", "t"), "contact_stiffness": ("10", "N/m")},
            "contact_stiffness = 10.0: must be a finite number at least 1000000 and",
        ),
    ],
)
def test_wheelsets_that_cannot_be_are_refused_by_their_rows(tmp_path, rows, says):
    with pytest.raises(InputError) as refused:
        rb.vehicle(car_table(tmp_path, **rows))
    assert says in str(refused.value)


ROLLING = {"wheelset_mass": ("1.8", "t"), "wheelset_roll_inertia": ("1", "t m2")}


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        (
            {"contact_stiffness": ("1e9", "N/m"), "wheel_radius": ("0.5", "m")},
            "wheel_radius = 0.5: contact_stiffness is given too, never both",
        ),
        (
            {"wheelset_yaw_inertia": ("1", "t m2")},
            "wheelset_yaw_inertia = 1000.0: nothing holds the wheelset in yaw",
        ),
        (
            {"primary_longitudinal_stiffness": ("1e7", "N/m")},
            "wheelset_yaw_inertia: is missing",
        ),
        (
            {"primary_longitudinal_damping": ("1e4", "N s/m")},
            "primary_longitudinal_damping = 10000.0: needs a stiffness along",
        ),
    ],
)
def test_parts_of_wheelsets_that_do_not_go_together_are_refused(tmp_path, rows, says):
    with pytest.raises(InputError) as refused:
        rb.vehicle(car_table(tmp_path, **ROLLING, **rows))
    assert says in str(refused.value)


def test_wheelsets_held_along_the_track_yaw(tmp_path):
    rows = {
        "wheelset_yaw_inertia": ("1", "t m2"), "primary_longitudinal_stiffness": ("10", "MN/m"),
        "secondary_longitudinal_stiffness": ("0.2", "MN/m"),
    }  # fmt: skip
    found = rb.vehicle(car_table(tmp_path, **ROLLING, **rows))
    assert {b.freedoms for b in found.wheelsets} == {("y", "z", "roll", "yaw")}
    along = {(s.to, s.longitudinal_stiffness) for s in found.springs if s.from_ == "car"}
    assert along == {("front bogie", 2e5), ("rear bogie", 2e5)}
    # The two wheelsets of a bogie yaw against each other; the bogie stands still between.
    yaws = np.sqrt(2 * 1e7 * 0.98**2 / 1000.0) / (2 * np.pi)
    assert np.sum(np.abs(found.modes().frequencies_hz / yaws - 1) < 1e-8) == 2


def test_a_car_s_length_may_be_left_out(tmp_path):
    path = car_table(tmp_path, drop=("length",))
    assert rb.vehicle(path).length is None
    tables = {**rb.case("paper").content, "train": {"vehicle": str(path), "cars": 2}}
    with pytest.raises(InputError, match=r"train.car_spacing: is missing. Give it, or the length"):
        rb.Case(tables)
    found = rb.Case({**tables, "train": {**tables["train"], "car_spacing": 22.5}})
    assert found.train.centres.tolist() == rb.Train(rb.vehicle("xia2000"), 2).centres.tolist()
    text = shelf.data_file("vehicles", "sprung_mass").read_text(encoding="utf-8")
    (tmp_path / "mine.toml").write_text(text.replace("length = 10.0", ""), encoding="utf-8")
    assert rb.vehicle(tmp_path / "mine.toml").length is None


def test_a_car_in_other_units_is_the_same_car(tmp_path):
    usual = rb.vehicle("xia2000")
    pound = 4.4482216152605
    other = {
        "bogie_mass": (4360 / (pound / 0.0254), "lbf s2/in"),
        "car_body_mass": (50.99e-3, "kN s2/mm"),
        "primary_vertical_stiffness": (2976 / (pound / 0.0254), "kip/in"),
        "secondary_vertical_damping": (30.0, "N s/mm"),
    }
    written = {name: (repr(value), unit) for name, (value, unit) in other.items()}
    found = rb.vehicle(car_table(tmp_path, drop=tuple(other), **written))
    assert found.modes().frequencies_hz == pytest.approx(usual.modes().frequencies_hz, rel=1e-12)
    assert found.damping_matrix == pytest.approx(usual.damping_matrix)


# ---- wheelsets, anti-roll bars and more in vehicle files

COACH = """
length = 20.0
[[body]]
name = "car"
mass = 30e3
inertia = [4e4, 1e6, 1e6]
position = [0.0, 0.0, 1.8]
freedoms = "y z roll pitch yaw"
[[wheelset]]
name = "front"
x = 6.0
mass = 1500.0
roll_inertia = 900.0
yaw_inertia = 1000.0
[[wheelset]]
name = "rear"
x = -6.0
mass = 1500.0
roll_inertia = 900.0
yaw_inertia = 1000.0
contact_stiffness = [1.0e9, 1.2e9]
height = 0.5
"""
for _place, _name in ((6.0, "front"), (-6.0, "rear")):
    for _y in (1.0, -1.0):
        COACH += f"""
[[spring]]
from = "car"
to = "{_name}"
at = [{_place}, {_y}, 0.8]
stiffness = [8e5, 9e5]
damping = [2e4, 3e4]
longitudinal_stiffness = 5e6
longitudinal_damping = 1e4
series_stiffness = [0.0, 4e6]
"""
COACH += """
[[anti_roll_bar]]
from = "car"
to = "front"
stiffness = 1e6
"""


def coach(tmp_path, *changes):
    text = COACH
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = tmp_path / "coach.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_vehicle_file_may_have_wheelsets_and_every_part(tmp_path):
    car = rb.vehicle(coach(tmp_path))
    assert [b.name for b in car.wheelsets] == ["front", "rear"]
    assert car.wheelsets[0].position == (6.0, 0.0, 0.46)
    assert car.wheelsets[1].position == (-6.0, 0.0, 0.5)
    assert car.wheelsets[0].freedoms == ("y", "z", "roll", "yaw")
    load = (30e3 / 4 + 1500 / 2) * 9.81
    # The springs along the track resist what little the car pitches on unequal contacts.
    assert [c.static_load for c in car.contacts] == pytest.approx([load] * 4, rel=1e-5)
    assert [c.y for c in car.contacts] == [0.75, -0.75] * 2
    hertz = 1.33739e9 * np.cbrt(load / 80e3)
    expected = [[1.4 / 1.7 * hertz, hertz]] * 2 + [[1.0e9, 1.2e9]] * 2
    assert car.contact_stiffness == pytest.approx(np.array(expected), rel=1e-6)
    assert car.anti_roll_bars == (rb.AntiRollBar("car", "front", 1e6),)
    held = {(s.longitudinal_stiffness, s.series_stiffness) for s in car.springs if not s.on_rail}
    assert held == {(5e6, (0.0, 4e6))}
    paper = rb.case("paper").replace({"run.loads": "wheels"}).content
    case = {**paper, "train": {"vehicle": str(coach(tmp_path)), "cars": 2}}
    assert len(rb.Case(case).train.wheels) == 8
    small = rb.vehicle(coach(tmp_path, ("mass = 1500.0", "mass = 1500.0\nwheel_radius = 0.42")))
    assert small.wheelsets[0].position[2] == 0.42


def test_wheelsets_in_the_plane_have_one_contact_each(tmp_path):
    path = tmp_path / "wagon.toml"
    path.write_text(
        """
        [[body]]
        name = "car"
        mass = 20e3
        inertia = [0.0, 2e5, 0.0]
        position = [0.0, 0.0, 1.5]
        freedoms = ["z", "pitch"]
        """
        + "".join(
            f"""
            [[wheelset]]
            name = "{name}"
            x = {x}
            mass = 1200.0
            gauge = 0.0
            contact_stiffness = [0.0, 1.3e9]
            [[spring]]
            from = "car"
            to = "{name}"
            at = [{x}, 0.0, 0.8]
            stiffness = [0.0, 1.5e6]
            """
            for name, x in (("front", 4.0), ("rear", -4.0))
        ),
        encoding="utf-8",
    )
    car = rb.vehicle(path)
    assert car.labels == ("car z", "car pitch", "front z", "rear z")
    assert car.contact_stiffness.tolist() == [[0.0, 2.6e9]] * 2
    assert [c.carries for c in car.contacts] == ["car", "car"]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            "length",
            "static_wheelset_mass = 1.0\nlength",
            "static_wheelset_mass = 1.0: the wheelsets",
        ),
        ('to = "front"', 'to = "frnt"', "springs[1].to = 'frnt': must be one of car, front, rear"),
        ("x = 6.0", "x = 6.0\ngage = 1.5", "wheelset[1].gage: unknown key. Did you mean 'gauge'?"),
        ("roll_inertia = 900.0\n", "", "wheelset[1].roll_inertia: is needed"),
        (
            "mass = 1500.0",
            "mass = -1.0",
            "wheelset[1].mass = -1.0: must be a finite number above 0",
        ),
        (
            "height = 0.5",
            "wheel_radius = 0.4",
            "wheelset[2].wheel_radius = 0.4: contact_stiffness is given too, never both",
        ),
        ("1.2e9]", "1.2e5]", "wheelset[2].contact_stiffness[2] = 120000.0: must be a finite"),
        ('name = "rear"', 'name = "front"', "wheelset[1].name = 'front': must be unique"),
        ("longitudinal_stiffness = 5e6", "", "front: yaw"),
        ("= 1e6\n", "= -1e6\n", "anti_roll_bar[1].stiffness = -1000000.0: must be"),
        ('to = "front"\nstiffness = 1e6', 'to = "rail"\nstiffness = 1e6', "anti_roll_bar[1].to"),
        ("[0.0, 4e6]", "[1.0, -4e6]", "spring[1].series_stiffness[2] = -4000000.0: must be"),
        ("[[wheelset]]", "[wheelset]", "wheelset"),
    ],
)
def test_parts_of_vehicle_files_that_cannot_be_are_named(tmp_path, old, new, says):
    if "yaw" in says:
        path = coach(tmp_path, *[(old, new)] * 4)
    elif new == "[wheelset]":
        path = tmp_path / "coach.toml"
        whole = COACH.split("[[wheelset]]")
        path.write_text(whole[0] + "[wheelset]" + whole[1] + whole[2][whole[2].index("[["):],
                        encoding="utf-8")  # fmt: skip
    else:
        path = coach(tmp_path, (old, new))
    with pytest.raises(InputError) as refused:
        rb.vehicle(path)
    assert says in str(refused.value)


# ---- damping, masses and piers

PIER = {
    "height": 12.0, "youngs_modulus": 33e9, "area": 4.0, "second_moment_along": 2.0,
    "second_moment_across": 5.0,
}  # fmt: skip
IDENTIFIED = tomllib.loads(shelf.data_file("decks", "viaduct36_identified").read_text("utf-8"))


@pytest.mark.parametrize(
    ("table", "damping"),
    [
        ({"alpha": 1.0364, "beta": 4.87e-4}, (1.0364, 4.87e-4)),
        ({"alpha": 1.0}, (1.0, 0.0)),
        ({"beta": 1e-3}, (0.0, 1e-3)),
        ({"per_mode": [0.03, 0.02]}, rb.ModalDamping((0.03, 0.02))),
        ({"modal": 0.01}, 0.01),
        ({"ratio": 0.03, "frequencies_hz": [3.307, 16.3]}, rb.rayleigh(0.03, [3.307, 16.3])),
    ],
)
def test_every_maker_of_decks_takes_every_damping(table, damping, tmp_path):
    folder = exchange.export_modes(rb.deck("viaduct36"), tmp_path)
    plain = tomllib.loads(folder.read_text("utf-8"))
    files = exchange.beside(plain, folder.parent)["modes"]
    box = decks.box_from_table("box", IDENTIFIED)
    section = rb.deck("viaduct36").recovery.beam
    mesh = {"along": 8, "web": 2, "slab": 2, "cantilever": 1}
    shell = {**IDENTIFIED, "model": "shell", "mesh": mesh, "modes": 4, "damping": table}
    for made, alike in [
        (rb.deck_from_table("b", changed(damping=table)), beam_of(
            rb.deck_from_table("b", TABLE)).deck(damping=damping)),
        (rb.case("paper").replace({"deck.damping": table}).deck, section.deck(20, damping)),
        (rb.deck_from_table("box", {**IDENTIFIED, "model": "beam", "damping": table}),
         box.beam_deck(IDENTIFIED.get("modes"), damping)),
        (rb.deck_from_table("s", shell), box.shell_deck(4, damping, rb.BoxMesh(**mesh))),
        (rb.deck_from_table("m", {"modes": files, "damping": table}),
         exchange.ModesTable(**files).deck(damping)),
    ]:  # fmt: skip
        assert made.damping_ratios == pytest.approx(alike.damping_ratios, rel=1e-9)
        assert made.internal_damping == alike.internal_damping
        if isinstance(damping, rb.ModalDamping):
            assert made.damping_ratios[:3].tolist() == [0.03, 0.02, 0.02]
    only_beams_know_where = 0.0 if not isinstance(damping, tuple) else damping[1]
    assert rb.deck_from_table("b", changed(damping=table)).internal_damping == only_beams_know_where


def test_point_masses_of_a_file_stand_where_it_says():
    own = [{"x": 9.0, "mass": 4e4, "y": 1.0, "z": -0.5, "roll_inertia": 2e4}, {"x": 20, "mass": 1}]
    deck = rb.deck_from_table("b", changed(point_mass=own))
    expected = (rb.PointMass(9.0, 4e4, 1.0, -0.5, 2e4), rb.PointMass(20.0, 1.0))
    assert beam_of(deck).point_masses == expected
    plain = rb.deck_from_table("b", TABLE)
    assert deck.frequencies_hz[0] < 0.99 * plain.frequencies_hz[0]
    weights = [
        sum(d.recovery.reaction("force_z", x).self_weight for x in d.supports)
        for d in (deck, plain)
    ]
    assert weights[0] - weights[1] == pytest.approx(40001.0 * 9.81, rel=1e-6)


def test_a_box_takes_point_masses_as_a_beam_only():
    own = {"point_mass": [{"x": 18.0, "mass": 3e4, "y": 2.0}]}
    deck = rb.deck_from_table("box", {**IDENTIFIED, "model": "beam", **own})
    assert beam_of(deck).point_masses == (rb.PointMass(18.0, 3e4, 2.0),)
    with pytest.raises(InputError, match="box: point_mass: belongs to the beam model"):
        rb.deck_from_table("box", {**IDENTIFIED, "model": "shell", **own})
    with pytest.raises(InputError, match=r"box: point_mass\[1\]\.x = 37.0: must be"):
        far = {"point_mass": [{"x": 37.0, "mass": 3e4}]}
        rb.deck_from_table("box", {**IDENTIFIED, "model": "beam", **far})
    heavy = rb.deck_from_table(
        "box", {**IDENTIFIED, "model": "beam", "point_mass": [{"x": 18.0, "mass": 3e7}]}
    )
    assert "point_mass[1].mass" in [remark.field for remark in heavy.remarks]


def test_a_pier_of_a_file_stands_below_its_bearing():
    bearing = [{**TABLE["bearing"][0], "pier": PIER}, *TABLE["bearing"][1:]]
    deck = rb.deck_from_table("b", changed(bearing=bearing))
    first = beam_of(deck).bearings[0]
    assert first.pier == rb.Pier(12.0, 33e9, 4.0, 2.0, 5.0)
    along = 3 * 33e9 * 2.0 / 12.0**3
    assert first.springs["x"] == pytest.approx(1 / (1 / 6e9 + 1 / along))
    bearing[0]["pier"] = {**PIER, "height": 400.0}
    doubts = rb.deck_from_table("b", changed(bearing=bearing)).remarks
    assert [r.field for r in doubts] == ["bearing[1].pier.height"]


BED = {"bending_stiffness": 1.28e7, "foundation": 1e8}


@pytest.mark.parametrize("rail", [{"spread": 0.6}, BED])
def test_every_maker_of_decks_takes_a_rail(rail, tmp_path):
    plain = rb.deck("viaduct36")
    folder = exchange.export_modes(dataclasses.replace(plain, rail=rb.Rail(**rail)), tmp_path)
    shipped = tomllib.loads(shelf.data_file("decks", "viaduct36_identified").read_text("utf-8"))
    for name, deck in {
        "beam": rb.deck_from_table("b", changed(rail=rail)),
        "box": rb.deck_from_table("box", {**shipped, "rail": rail}),
        "modes": rb.deck(folder),
        "beside a file": rb.case("paper").replace({"deck.rail": rail}).deck,
        "in Python": rb.deck("viaduct36", rail=rb.Rail(**rail)),
    }.items():
        assert deck.rail == rb.Rail(**rail), name
    assert plain.rail is None and rb.case("paper").deck.rail is None


@pytest.mark.parametrize(
    ("rail", "words"),
    [
        ({"spread": 600.0}, "deck.rail.spread = 600.0: must be .* at most 5 m"),
        ({"spread": 0.6, "foundation": 1e8}, "deck.rail.foundation .* give either"),
        ({"foundation": 1e8}, "deck.rail.bending_stiffness: is missing"),
        ({}, "deck.rail.spread: is missing"),
        ({"sprad": 0.6}, "deck.rail.sprad: unknown key. Did you mean 'spread'"),
        (0.6, "deck.rail = 0.6: must be a table"),
        (BED | {"foundation": 100.0}, "deck.rail.foundation .* elastic length is 26.7 m"),
    ],
)
def test_a_rail_of_a_table_is_refused_by_its_key(rail, words):
    # Beside a file, too, which is not at fault.
    for deck in (changed(rail=rail), {"file": "viaduct36", "rail": rail}):
        case = {"deck": deck, "train": {"vehicle": "xia2000"}, "run": {"speed": 20.0}}
        with pytest.raises(InputError, match=f"^{words}"):
            rb.Case(case)


def test_a_rail_too_wide_for_the_deck_is_refused_by_its_key():
    table = changed(length=3.0, bearing=[], rail={"spread": 1.2})
    case = {"deck": table, "train": {"vehicle": "xia2000"}, "run": {"speed": 20.0}}
    with pytest.raises(InputError, match=r"deck.rail.spread = 1.2: spreads a load over 1.2 m"):
        rb.Case(case)


def test_a_rail_in_another_unit_is_doubted():
    soft = changed(rail={"bending_stiffness": 1.28e4, "foundation": 1e5})
    case = {"deck": soft, "train": {"vehicle": "xia2000"}, "run": {"speed": 20.0}}
    said = " ".join(map(str, rb.Case(case).doubts))
    assert "deck.rail.bending_stiffness = 12800 N m2" in said and "given in kN m2?" in said
    assert "deck.rail.foundation = 100000 N/m2" in said and "given in kN/m2?" in said
