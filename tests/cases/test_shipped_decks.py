"""Shipped decks of real bridges against what was published of them, and against formulas."""

import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases import shelf

# Typed in again: span m, E I N m2, mass kg/m, damping, first frequency Hz, how well that is known.
PUBLISHED = {
    "antoing50": (50.0, 35e9 * 51.3, 69e3, 0.01, 3.205, "derived"),
    "korea40": (40.0, 6.9333e11, 33e3, 0.01, 4.5, "measured"),
}
GRADES = r"\[(two|one|memory|derived)\]"
RHYTHM = 18.7  # m between the bogies of a KTX
QUANTITIES = ("displacement_z", "acceleration_z")


def content(name):
    return tomllib.loads(shelf.data_file("decks", name).read_text(encoding="utf-8"))


def changed(name, stiffness=1.0, mass=1.0, **more):
    table = content(name) | more
    table["bending_stiffness_vertical"] *= stiffness
    table["mass"] *= mass
    return rb.deck_from_table(name, table)


def largest(deck, speeds):
    """Sag, mm, its static value, mm, and acceleration, m/s2, over speeds in km/h."""
    found = rb.speed_envelope(deck, "KTX", np.divide(speeds, 3.6), quantities=QUANTITIES)
    sag = 1e3 * np.ravel(found.displacement_z)
    return sag, 1e3 * np.ravel(found.displacement_z_static), np.ravel(found.acceleration_z)


@pytest.mark.parametrize("name", PUBLISHED)
def test_files_hold_what_was_published(name):
    span, bending, mass, damping, _, _ = PUBLISHED[name]
    table = content(name)
    assert table["spans"] == [span] and table["mass"] == mass
    assert table["bending_stiffness_vertical"] == pytest.approx(bending, rel=1e-12)
    assert table["damping"] == {"modal": damping}
    assert rb.deck(name).damping_ratios == pytest.approx([damping] * table["modes"])


@pytest.mark.parametrize("name", PUBLISHED)
def test_first_frequency_is_the_published_one(name):
    *_, first, _ = PUBLISHED[name]
    assert rb.deck(name).frequencies_hz[0] == pytest.approx(first, rel=2e-4)


@pytest.mark.parametrize("name", PUBLISHED)
def test_frequencies_follow_from_stiffness_and_mass(name):
    span, bending, mass, *_ = PUBLISHED[name]
    found = rb.deck(name).frequencies_hz
    orders = np.arange(1, len(found) + 1)
    closed = np.pi * orders**2 / (2 * span**2) * np.sqrt(bending / mass)
    assert found == pytest.approx(closed, rel=1e-4)


@pytest.mark.parametrize("name", PUBLISHED)
def test_each_number_bears_its_grade(name):
    text = shelf.data_file("decks", name).read_text(encoding="utf-8")
    for key in ("spans", "bending_stiffness_vertical", "mass", "damping"):
        (line,) = re.findall(rf"(?m)^{key} = .*$", text)
        assert re.search(GRADES, line), line
    assert re.search(rf"(?m)^#.*frequency.*{GRADES}|^#.*first bending.*{GRADES}", text)


@pytest.mark.parametrize("name", PUBLISHED)
def test_frequencies_are_those_of_bridges_and_all_that_count_are_kept(name):
    deck = rb.deck(name)
    bounds = rb.codes.n0_bounds(deck.length)
    assert bounds.lower.value < deck.frequencies_hz[0] < bounds.upper.value
    assert rb.codes.kept_modes(deck.frequencies_hz).complete


def test_a_ktx_has_the_rhythm_of_its_family_and_is_as_long_as_published():
    train, family = rb.train("KTX"), rb.train("AVE-S100")
    assert train.axles[-1] == pytest.approx(380.15, abs=0.02)  # Oh 2008
    assert np.diff(train.axles[4:42:2]) == pytest.approx([RHYTHM] * 18)
    assert train.axles[:22] == pytest.approx(family.axles[:22], abs=1e-9)
    assert np.diff(train.axles[-6:]) == pytest.approx(np.diff(family.axles[-6:]), abs=0.011)


def test_korean_span_does_under_a_ktx_what_was_measured():
    # 170 to 280 km/h hardly a change, about 300 a steep rise.
    sag, static, acceleration = largest(rb.deck("korea40"), [170.0, 280.0, 300.0, 315.0])
    assert sag[1] < 1.25 * sag[0] and sag[1] < 1.3 * static[1]
    assert sag[2] > 2 * sag[1] and acceleration[2] > 4 * acceleration[1]
    assert sag[3] < sag[2]


def test_resonance_is_at_the_frequency_times_the_distance_of_bogies():
    speeds = np.arange(290.0, 321.0)
    sag, *_ = largest(rb.deck("korea40"), speeds)
    assert speeds[sag.argmax()] == pytest.approx(3.6 * 4.5 * RHYTHM, rel=0.01)


def test_winter_moves_the_resonance_and_leaves_the_acceleration():
    # The stiffness that 5.3 Hz needs is the 39 % more that the article prints.
    stiffer = (5.3 / 4.5) ** 2
    assert stiffer == pytest.approx(1.39, abs=0.005)
    winter = changed("korea40", stiffness=stiffer)
    assert winter.frequencies_hz[0] == pytest.approx(5.3, rel=2e-4)
    summer, _, at_summer = largest(rb.deck("korea40"), [303.0])
    later, _, at_winter = largest(winter, [303.0 * 5.3 / 4.5])
    assert later == pytest.approx(summer / stiffer, rel=1e-3)
    assert at_winter == pytest.approx(at_summer, rel=1e-3)


def test_guessed_mass_scales_all_and_moves_no_speed():
    speeds = [250.0, 303.0]
    heavier = changed("korea40", stiffness=1.15, mass=1.15)
    for here, there in zip(
        largest(rb.deck("korea40"), speeds), largest(heavier, speeds), strict=True
    ):
        assert here / there == pytest.approx([1.15, 1.15], rel=1e-6)


def test_elastic_bearings_undo_the_cancellation_at_antoing():
    # 50 m are 2.67 times the distance of bogies: free vibrations of one bogie nearly end with it.
    rail = {"bending_stiffness": 1.28e7, "foundation": 1e8}
    bearings = [
        {"x": x, "fixed": fixed, "stiffness": {"z": 2e9}}
        for x, fixed in ((0.0, "x y roll"), (50.0, "y roll"))
    ]
    soft = changed("antoing50", bearing=bearings, rail=rail, modes=6)
    hard = replace(rb.deck("antoing50"), rail=soft.rail)
    gains = []
    for deck in (hard, soft):
        resonance = 3.6 * RHYTHM * deck.frequencies_hz[0]
        sag, static, _ = largest(deck, np.linspace(0.97, 1.03, 13) * resonance)
        gains.append((sag / static).max())
    assert gains[0] < 1.75 and gains[1] > 1.5 * gains[0]
