"""*Show this as code*: about ten plain lines that compute what the panel shows, and draw it."""

import matplotlib.pyplot as plt
import pytest

import railbridge as rb
from railbridge import panels
from railbridge.panels.code import case_lines

NAMES = [
    "irregularities", "rigid_forces", "deck_modes", "deck_response", "fixed_point",
    "map_and_crossing", "overview", "random_track", "wheels_with_mass",
]  # fmt: skip


@pytest.fixture(scope="module")
def all_panels():
    return {name: getattr(panels, name)() for name in NAMES}


@pytest.fixture(autouse=True)
def close():
    yield
    plt.close("all")


@pytest.mark.parametrize("name", NAMES)
def test_the_code_is_short_and_plain_and_draws(all_panels, name):
    code = all_panels[name].code
    lines = [line for line in code.splitlines() if line.strip()]
    # One that starts far from the paper's case is written out, a table a line.
    far = "rb.Case({" in code
    assert 8 <= len(lines) <= 14 and max(map(len, lines)) <= (100 if far else 88)
    assert far == (name in ("random_track", "wheels_with_mass"))
    assert lines[0] == "import railbridge as rb"
    assert far or 'rb.case("paper").replace({' in code
    assert "rb.plots." in code
    before = len(plt.get_fignums())
    scope = {}
    exec(code, scope)
    assert len(plt.get_fignums()) > before
    assert scope["case"].content == all_panels[name].case.content


def test_the_code_says_what_the_controls_say(all_panels):
    panel = all_panels["rigid_forces"].set(speed=22.5, wavelength=12.0, amplitude=4e-3)
    assert '    "run.speed": 22.5,  # m/s\n' in panel.code
    waves = '"track.vertical.wavelength": 12.0, "track.lateral.wavelength": 12.0,  # m\n'
    assert f"    {waves}" in panel.code
    assert '    "track.vertical.amplitude": 0.004,  # m\n' in panel.code
    panel.reset()


def test_a_case_of_ones_own_is_written_out_where_it_is_far_from_the_papers():
    near = rb.case("paper").replace({"train.vehicle": "xia2000", "run.tail": 2.0})
    assert 'rb.case("paper").replace({' in case_lines(near, ())
    deck = {
        "length": 30.0, "bending_stiffness_vertical": 8.8e10, "mass": 1e4,
        "damping": {"ratio": 0.03, "frequencies_hz": [3.3, 13.2]}, "modes": 10, "width": 9.0,
    }  # fmt: skip
    far = rb.case("paper").replace({"deck": deck, "train.track": 0.0, "output.points": [15.0]})
    code = case_lines(far, ())
    assert "rb.Case({" in code and "paper" not in code
    scope = {}
    exec(code, scope)
    assert scope["case"].content == far.content


def test_the_code_of_a_deck_with_a_rail_makes_it_again():
    for rail in ({"spread": 0.6}, {"bending_stiffness": 1.28e7, "foundation": 1e8}):
        case, scope = rb.case("paper").replace({"deck.rail": rail}), {}
        exec(f"import railbridge as rb\n{case_lines(case, ())}", scope)
        assert scope["case"].content == case.content
        assert scope["case"].deck.rail == rb.Rail(**rail)


def test_the_code_opens_below_its_button_as_tall_as_it_is(all_panels):
    panel = all_panels["deck_response"]
    side = next(w for w in panel.widget.children[0].children if "rb-side" in w._dom_classes)
    buttons, refusal, area = side.children[-3:]
    assert panel.code_button in buttons.children and area is panel.code_area
    assert refusal is panel.trouble
    panel.code_button.click()
    assert area.layout.display != "none"
    assert area.rows == len(area.value.splitlines())
    panel.code_button.click()
    assert area.layout.display == "none"
