"""Elements of a drawing, and the page that plays it: what a browser must be able to read."""

import json
import re
from base64 import b64decode
from xml.etree import ElementTree

import numpy as np
import pytest

from railbridge.errors import InputError
from railbridge.plots.motion.player import Animation, Drawing, element, page, points_text, rounded

NAMED = 'über "a" & <b>'
DATA = {
    "frames": 2,
    "start": 0,
    "loop": True,
    "seconds": 1.0,
    "slider": "</script>",
    "rest": [[0.0, 10.0]],
}


def drawn():
    drawing = Drawing(40)
    drawing.add("line", x1=1 / 3, x2=np.float64(20.0), y1=0, y2=5, **{"data-part": 0})
    drawing.write(10, 20, NAMED)
    return drawing


def test_a_drawing_is_ascii_that_reads_back():
    text = drawn().svg()
    root = ElementTree.fromstring(text)
    line, words = root[1], root[2]
    assert text.isascii() and root.get("viewBox") == "0 0 900 40"
    assert line.attrib == {"x1": "0.333333", "x2": "20", "y1": "0", "y2": "5", "data-part": "0"}
    assert words.text == NAMED and words.get("x") == "10"


def test_numbers_are_short_and_have_no_negative_zero():
    assert points_text([(0.04, 1.26), (2, 3)]) == "0.0,1.3 2.0,3.0"
    assert json.dumps(rounded([-0.01, 1.26, 3])) == "[0.0, 1.3, 3.0]"
    assert element("circle", r=5, fill='"') == '<circle r="5" fill="&quot;"/>'


def test_a_page_holds_picture_words_and_numbers_as_given():
    html = page(drawn(), NAMED, "What <moves>.", DATA, "const draw = f => 'x';")
    assert (
        b64decode(re.search(r"base64,([^\"]+)\"", html).group(1)).decode("ascii") == drawn().svg()
    )
    assert json.loads(re.search(r"const D = (\{.*\});\n", html).group(1)) == DATA
    assert (
        html.count("</script>") == 1
        and "&lt;moves&gt;" in html
        and "const draw = f => 'x';" in html
    )
    other = page(drawn(), NAMED, "What <moves>.", DATA | {"start": 1}, "")
    keys = {re.search(r'data-animation="(\w+)"', text).group(1) for text in (html, other)}
    assert len(keys) == 2, "each animation moves its own picture"


def test_it_is_saved_as_a_page_of_its_own(tmp_path):
    animation = Animation("a <title>", 2, "<p>x</p>")
    animation.save(tmp_path / "a.html")
    text = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert (
        text.startswith("<!doctype html>")
        and "<title>a &lt;title&gt;</title>" in text
        and "<p>x</p>" in text
    )
    with pytest.raises(InputError, match=r"must end in \.html"):
        animation.save(tmp_path / "a.png")
