"""Pictures are the same whenever they are made, and show names letter by letter."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.reports import pictures

NAME = r"$x_2$ \alpha <b> & $"


def test_a_picture_is_svg_without_time_or_maker(quick):
    (first, *_) = pictures.sketches(quick[0].train, quick[0].deck)
    (again, *_) = pictures.sketches(quick[0].train, quick[0].deck)
    assert first == again
    root = ET.fromstring(first.svg)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert "<dc:date>" not in first.svg and "Matplotlib" not in first.svg
    assert first.width == pytest.approx(864.0)


def shown_texts(monkeypatch, make):
    """What matplotlib draws as texts, and which of them it takes for formulas."""
    from matplotlib.backends.backend_svg import RendererSVG

    seen = []

    def draw_text(self, gc, x, y, s, prop, angle, ismath=False, mtext=None):
        seen.append((s, ismath))

    monkeypatch.setattr(RendererSVG, "draw_text", draw_text)
    list(make())
    return seen


def test_dollars_in_names_begin_no_formula(quick, monkeypatch):
    case, run = quick
    car = replace(case.train.vehicle, name=NAME)
    deck = replace(case.deck, name=NAME, mode_names=(NAME,) * 3)
    train = replace(case.train, vehicle=car)

    def make():
        yield from pictures.sketches(train, deck)
        yield pictures.modes(deck)

    seen = shown_texts(monkeypatch, make)
    named = [text for text, _ in seen if "alpha" in text]
    assert len(named) >= 4
    assert all(NAME in text for text in named)
    assert not [text for text, formula in seen if formula and "alpha" in text]


def test_names_of_trains_over_speeds_are_letters(monkeypatch):
    deck = rb.deck("viaduct36")
    found = rb.speed_envelope(deck, {NAME: rb.train("ICE2")}, [40.0, 50.0, 60.0])
    make = lambda: [pictures.over_speeds(found, "acceleration_z", 18.0, deck, 3.5, NAME)]  # noqa: E731
    seen = shown_texts(monkeypatch, make)
    named = [(text, formula) for text, formula in seen if "alpha" in text]
    assert len(named) >= 3 and not any(formula for _, formula in named)


def test_pictures_of_a_run_are_those_of_the_gallery(quick):
    case, run = quick
    titles = [picture.title for picture in pictures.of_run(run, [3.0, 6.0])]
    assert "Smallest and largest values along the deck, without self-weight" in titles
    assert titles[0] == "Displacement of the deck at x = 3 m, without self-weight"
    assert titles[-1] == "How the iteration settles" and "Wheel forces on the deck, car 1" in titles
    again = list(pictures.of_run(run, [3.0, 6.0]))
    assert list(pictures.of_run(run, [3.0, 6.0])) == again
    assert not [p for p in again if "Matplotlib" in p.svg or "<dc:date>" in p.svg]
    most = [p.title for p in pictures.of_run(run, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0])]
    assert sum("Displacement" in title for title in most) == 4


def test_constant_loads_on_a_deck_of_modes_have_fewer_pictures(quick):
    modes_only = replace(quick[0].deck, recovery=None)
    bare = rb.cross(rb.AxleTrain([0.0], [1e5]), modes_only, rb.Track(), speed=40.0)
    titles = [picture.title for picture in pictures.of_run(bare, [6.0])]
    assert [title.split(" ")[0] for title in titles] == ["Displacement", "Acceleration", "Smallest"]


def test_one_thing_that_varies_is_a_line_and_words_stand_below_it():
    case = rb.case(rb.case("paper").content)
    base = case.replace({"run.interaction": "rigid", "track": None, "run.loads": "wheels"})
    found = rb.sweep(base, {"run.loads": ["wheels", "bogies"]}, measure=["displacement_z"])
    assert pictures.over_one(found, "displacement_z", 18.0, "loads", "t") is not None
    nothing = found.assign(displacement_z=found.displacement_z * np.nan)
    assert pictures.over_one(nothing, "displacement_z", 18.0, "loads", "t") is None
    assert pictures.over_two(found, "displacement_z", 18.0, "t") is None
