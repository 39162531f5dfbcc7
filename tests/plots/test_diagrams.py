"""The drawings at the head of the notebooks: sound files, readable on light and on dark."""

import re
from xml.etree import ElementTree

import pytest

import railbridge as rb
from railbridge.errors import InputError
from railbridge.plots.diagrams import DIAGRAMS
from railbridge.plots.svg import GREY, MOVES, PUSHES, Drawing

SVG = "{http://www.w3.org/2000/svg}"


def numbers(text):
    return [float(n) for n in re.findall(r"-?\d+\.?\d*", text)]


@pytest.mark.parametrize("name", DIAGRAMS)
def test_a_diagram_is_a_sound_drawing_that_stays_on_its_ground(name):
    drawn = rb.plots.diagram(name)
    assert repr(drawn) == f"Diagram: {name}"
    root = ElementTree.fromstring(drawn._repr_svg_())
    width, height = float(root.get("width")), float(root.get("height"))
    assert root.find(f"{SVG}title").text.endswith("."), "words for those who do not see it"
    for line in root.iter(f"{SVG}polyline"):
        values = numbers(line.get("points"))
        assert all(-1 <= x <= width + 1 for x in values[::2])
        assert all(-1 <= y <= height + 1 for y in values[1::2])
    for words in root.iter(f"{SVG}text"):
        x, y = float(words.get("x")), float(words.get("y"))
        # 8.3 px is the mean width of a letter of 16 px in a wide sans-serif.
        long = 8.3 * len("".join(words.itertext()))
        left = x - {"start": 0.0, "middle": long / 2}[words.get("text-anchor")]
        assert left >= -2 and left + long <= width + 12, "".join(words.itertext())
        assert 12 <= y <= height


def luminance(colour):
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


@pytest.mark.parametrize("colour", [GREY, MOVES, PUSHES])
@pytest.mark.parametrize("ground", ["#ffffff", "#111111"])
def test_its_colours_can_be_read_on_a_light_and_on_a_dark_page(colour, ground):
    high, low = sorted((luminance(colour) + 0.05, luminance(ground) + 0.05), reverse=True)
    assert high / low > 3.4


def test_symbols_are_italic_and_have_subscripts():
    drawing = Drawing(100, 50, "Words.")
    drawing.text(5, 20, "2 l_x of *V* < 3")
    svg = drawing.svg()
    assert '<tspan font-style="italic">l</tspan>' in svg and ">x</tspan>" in svg
    assert '<tspan font-style="italic">V</tspan> &lt; 3' in svg


def test_an_unknown_diagram_is_refused():
    with pytest.raises(InputError, match="name = 'car'"):
        rb.plots.diagram("car")
