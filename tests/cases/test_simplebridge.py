"""A bridge by the numbers at hand: three ways to say its stiffness, one case, one file."""

import math
import tomllib

import pytest

import railbridge as rb
from railbridge.cases.simplebridge import KINDS, SimpleBridge
from railbridge.errors import InputError

GIVEN = {"span": 20.0, "mass": 12000.0, "kind": "prestressed concrete", "line_speed": 55.5}


def bridge(**more):
    return SimpleBridge(**{**GIVEN, "bending_stiffness": 3e10, **more})


def test_stiffness_is_said_in_one_of_three_ways():
    stiff = bridge()
    product = SimpleBridge(**GIVEN, youngs_modulus=30e9, second_moment=1.0)
    # pi / (2 L^2) sqrt(E I / m) of a simple beam, by hand.
    f1 = math.pi / (2 * 400.0) * math.sqrt(3e10 / 12000.0)
    measured = SimpleBridge(**GIVEN, frequency=f1)
    assert stiff.first_frequency == pytest.approx(f1, rel=1e-14)
    assert product.stiffness == 3e10
    assert measured.stiffness == pytest.approx(3e10, rel=1e-12)
    # And the deck that is made of it swings at that frequency.
    assert stiff.case().deck.frequencies_hz[0] == pytest.approx(f1, rel=1e-6)


@pytest.mark.parametrize(
    ("more", "field"),
    [
        ({}, "bending_stiffness"),
        ({"bending_stiffness": 3e10, "frequency": 6.0}, "bending_stiffness"),
        ({"youngs_modulus": 30e9}, "bending_stiffness"),
        ({"bending_stiffness": 3e10, "span": 0.0}, "span"),
        ({"bending_stiffness": 3e10, "mass": 12.0}, "mass"),
        ({"bending_stiffness": 3e10, "kind": "wood"}, "kind"),
        ({"bending_stiffness": 3e10, "tracks": 3}, "tracks"),
        ({"bending_stiffness": 3e10, "line_speed": 300.0}, "line_speed"),
        ({"bending_stiffness": 3e10, "torsional_stiffness": 1e10}, "polar_inertia"),
        ({"bending_stiffness": 3e10, "name": " "}, "name"),
        ({"bending_stiffness": 3e10, "damping": 1.0}, "damping"),
    ],
)
def test_what_is_wrong_is_named(more, field):
    with pytest.raises(InputError) as found:
        SimpleBridge(**{**GIVEN, **more})
    assert found.value.field == field


@pytest.mark.parametrize(
    ("kind", "span", "ratio"),
    [
        ("steel", 20.0, 0.005),
        ("composite", 10.0, 0.005 + 0.00125 * 10),
        ("prestressed concrete", 10.0, 0.017),
        ("reinforced concrete", 30.0, 0.015),
    ],
)
def test_damping_is_the_lower_bound_unless_measured(kind, span, ratio):
    own = bridge(kind=kind, span=span)
    assert own.damping_ratio == pytest.approx(ratio, rel=1e-12)
    assert own.case().deck.damping_ratios == pytest.approx(ratio)
    measured = bridge(kind=kind, span=span, damping=0.023)
    assert measured.damping_ratio == 0.023
    assert measured.content()["checks"]["measured_damping"] == 0.023
    assert "measured_damping" not in own.content()["checks"]


def test_a_train_runs_on_the_left_of_two_tracks():
    twice = {"tracks": 2, "track_spacing": 4.4, "torsional_stiffness": 1e10, "polar_inertia": 3e4}
    case = bridge(**twice).case({"name": "HSLM-A4"}, speed=40.0)
    assert case.settings.track_offset == 2.2
    assert case.settings.speed == 40.0
    assert bridge().case().settings.track_offset == 0.0
    own = bridge(**twice).case({"name": "HSLM-A4", "track": "right"})
    assert own.settings.track_offset == -2.2


@pytest.mark.parametrize("kind", KINDS)
def test_the_file_is_the_case(tmp_path, kind):
    named = 'a "bridge" \\ of\n two lines'
    own = bridge(kind=kind, name=named, tracks=2, damping=0.01)
    path = own.write(tmp_path / "mine.toml", {"vehicle": "xia2000", "cars": 2})
    written = path.read_text(encoding="utf-8")
    assert "bending_stiffness_vertical = 3.0e+10 " in written
    assert not [line for line in written.splitlines() if "#" in line[1:] and " # " not in line]
    content = tomllib.loads(written)
    assert content == own.content({"vehicle": "xia2000", "cars": 2})
    assert rb.case(str(path)) == own.case({"vehicle": "xia2000", "cars": 2})
    assert "# kg/m" in written


def test_a_file_that_is_there_is_left_alone(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="is there already"):
        bridge().write(path)
    assert path.read_text(encoding="utf-8") == "mine"
    with pytest.raises(InputError, match=r"must end in \.toml"):
        bridge().write(tmp_path / "mine.txt")
    with pytest.raises(InputError, match="cannot be written"):
        bridge().write(tmp_path / "nowhere" / "mine.toml")
    with pytest.raises(InputError, match=r"train\.name"):
        bridge().write(tmp_path / "other.toml", {"name": "no train"})
    assert [p.name for p in tmp_path.iterdir()] == ["mine.toml"]


@pytest.mark.parametrize(
    ("frequency", "more"),
    [(0.5, {}), (1.0, {}), (6.0, {}), (14.0, {}),
     (4.0, {"torsional_stiffness": 3e10, "polar_inertia": 4e4})],
)  # fmt: skip
def test_the_deck_has_all_modes_that_accelerations_are_asked_of(frequency, more):
    deck = SimpleBridge(**GIVEN, frequency=frequency, **more).case().deck
    kept = rb.codes.kept_modes(deck.frequencies_hz)
    assert kept.complete and kept.limit.decided


@pytest.mark.parametrize("name", ["a\x7fb", 'Brücke "Süd" $x_1$ <b>\\ \t\x07', "tab\x1f"])
def test_a_written_name_is_read_again(tmp_path, name):
    assert rb.case(bridge(name=name).write(tmp_path / "a.toml")).content["deck"]["name"] == name


def test_a_name_that_is_no_text_of_a_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="name"):
        bridge(name="half of a pair \ud83d").write(tmp_path / "a.toml")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("path", [None, 3, "a\0b.toml"])
def test_what_is_no_path_is_refused(path):
    with pytest.raises(InputError, match="path"):
        bridge().write(path)


def test_a_train_is_a_table():
    with pytest.raises(InputError, match="train = 'HSLM-A1'.*must be a table"):
        bridge().case("HSLM-A1")


def test_no_damping_is_refused_by_its_own_name():
    with pytest.raises(InputError, match="^damping = 0"):
        bridge(damping=0.0)


def test_comments_stand_apart_from_long_numbers(tmp_path):
    text = bridge(bending_stiffness=2.2e10).write(tmp_path / "a.toml").read_text(encoding="utf-8")
    assert " # E I, N m2" in text
