"""Numbers typed beside a slider: read as they stand, or refused in words."""

import asyncio

import pytest

import railbridge as rb
from railbridge import panels

QUICK = {"run.time_step": None, "train.cars": 2}


@pytest.fixture(scope="module")
def made():
    return panels.deck_response(rb.case("paper").replace(QUICK))


@pytest.fixture
def panel(made):
    yield made
    made.reset()


def test_a_number_stands_beside_each_slider_and_follows_it(panel):
    assert {name: field.value for name, field in panel.fields.items()} == {
        "speed": "20.0", "wavelength": "14.4", "amplitude": "5.0", "cars": "2"
    }  # fmt: skip
    panel.sliders["amplitude"].value = 4.5
    panel.set(cars=3, speed=22.25)
    assert panel.fields["amplitude"].value == "4.5" and panel.fields["cars"].value == "3"
    assert panel.fields["speed"].value == "22.25", "no digit is hidden"
    assert all(not slider.readout for name, slider in panel.sliders.items() if name != "loads")


def test_a_typed_number_moves_the_slider(panel):
    panel.fields["speed"].value = " 31 "
    assert panel.values["speed"] == 31.0 and "31.0 m/s" in panel.summary
    assert panel.fields["speed"].value == "31.0"
    panel.fields["amplitude"].value = "2.5"
    assert panel.values["amplitude"] == 2.5e-3, "in the unit of its label"
    panel.fields["cars"].value = "4"
    assert panel.values["cars"] == 4


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("speed", "12,5", "speed (m/s) = '12,5': is no number. Write it with a point: 12.5."),
        ("speed", "1.000,5", "speed (m/s) = '1.000,5': is no number."),
        ("speed", "fast", "speed (m/s) = 'fast': is no number."),
        ("speed", "", "speed (m/s) = '': is no number."),
        ("speed", "nan", "speed (m/s) = 'nan': must be between 5 and 80."),
        ("speed", "500", "speed (m/s) = '500': must be between 5 and 80."),
        ("amplitude", "11", "amplitude (mm) = '11': must be between 0 and 10."),
        ("cars", "2.5", "cars = '2.5': must be a whole number."),
        ("cars", "2,5", "cars = '2,5': is no number. Write it with a point: 2.5."),
    ],
)
def test_what_cannot_be_read_is_refused_in_words(panel, name, text, words):
    image, said, values = panel.image.value, panel.summary, panel.values
    panel.fields[name].value = text
    assert words in str(panel.error)
    assert "Not possible" in panel.trouble.value and 'role="alert"' in panel.trouble.value
    assert (panel.image.value, panel.summary, panel.values) == (image, said, values)
    assert panel.fields[name].value == text, "what was typed stays to be mended"
    panel.fields[name].value = "6"
    assert panel.error is None and panel.trouble.value == ""


def test_typing_the_present_number_takes_a_refusal_back(panel):
    panel.fields["speed"].value = "20,0"
    assert panel.error is not None
    panel.fields["speed"].value = "20"
    assert panel.error is None and panel.trouble.value == ""
    assert panel.fields["speed"].value == "20.0"


def test_a_refusal_stays_when_an_exact_crossing_was_on_its_way():
    async def work():
        panel = panels.deck_response(rb.case("paper").replace(QUICK))
        panel.sliders["speed"].value = 25.0
        panel.fields["speed"].value = "12,5"
        await asyncio.sleep(2.0)
        assert "12,5" in panel.trouble.value and panel.fields["speed"].value == "12,5"
        panel.fields["speed"].value = "26"
        assert panel.trouble.value == "" and "26.0 m/s" in panel.words.value

    asyncio.run(work())


def test_a_field_waits_for_enter_and_has_a_name(panel):
    for name, field in panel.fields.items():
        assert field.continuous_update is False
        assert field.tooltip == f"{panel.controls[name].label}, typed"


def test_writing_a_number_computes_nothing():
    speeds = []

    def compute(case, progress):
        speeds.append(case.settings.speed)
        if case.settings.speed > 30.0:
            raise RuntimeError("too fast")

    control = panels.Control("speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5)
    case = rb.case("paper").replace({"run.time_step": None})
    panel = panels.Panel(case, [control], [["a"]], lambda *_: None, lambda *_: "", compute=compute)
    for value in (31.0, 32.0):
        panel.sliders["speed"].value = value
    assert speeds == [20.0, 31.0, 32.0]
