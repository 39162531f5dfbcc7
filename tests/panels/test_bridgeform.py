"""The form: it says what follows, refuses in the words of its labels, and writes one new file."""

import pytest

import railbridge as rb
from railbridge.cases.simplebridge import SimpleBridge
from railbridge.errors import InputError
from railbridge.panels import BridgeForm


@pytest.fixture
def form(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return BridgeForm()


def test_what_follows_is_said_at_once(form):
    assert form.error is None
    f1 = form.bridge.first_frequency
    assert f"first frequency {f1:.4g} Hz" in form.words.value
    form.set(span=10.0, kind="composite")
    assert "damping 1.75 %" in form.words.value
    assert f"first frequency {4 * f1:.4g} Hz" in form.words.value


def test_only_the_fields_that_count_are_shown_and_read(form):
    def shown():
        return {name for name, field in form.fields.items() if field.layout.display == "flex"}

    assert "bending_stiffness" in shown() and "frequency" not in shown()
    form.fields["frequency"].value = "no number"
    assert form.error is None
    form.set(stiffness="first frequency", frequency=7.5, tracks=2)
    assert {"frequency", "track_spacing"} <= shown() and "bending_stiffness" not in shown()
    assert form.bridge.frequency == 7.5
    assert form.bridge.bending_stiffness is None


@pytest.mark.parametrize(
    ("field", "text", "said"),
    [
        ("mass", "12,5", "Write it with a point: 12.5"),
        ("mass", "", "mass (t/m) = &#x27;&#x27;: is no number"),
        ("span", "1", "must be between 2 and 200"),
        ("line_speed", "fast", "speed of the line (km/h)"),
        ("damping", "60", "must be between 0 and 50"),
        ("name", " ", "name"),
    ],
)
def test_a_slip_is_refused_beside_the_form(form, tmp_path, field, text, said):
    form.fields[field].value = text
    assert said in form.trouble.value
    assert form.write() is None
    assert list(tmp_path.iterdir()) == []
    form.fields[field].value = {"mass": "12.0", "span": "20", "line_speed": "200"}.get(field, "")
    if field != "name":
        assert form.trouble.value == "" and form.error is None


def test_units_of_the_fields_are_those_of_people(form):
    form.set(mass=12500.0, bending_stiffness=2e10, line_speed=50.0, damping=0.012)
    own = form.bridge
    assert form.fields["mass"].value == "12.5"
    assert form.fields["line_speed"].value == "180.0"
    assert (own.mass, own.bending_stiffness, own.line_speed, own.damping) == (
        12500.0, 2e10, 50.0, 0.012,
    )  # fmt: skip
    with pytest.raises(InputError, match="must be one of"):
        form.set(width=3.0)


def test_the_button_writes_a_case_and_never_over_a_file(form, tmp_path):
    form.button.click()
    path = tmp_path / "my_bridge.toml"
    assert "my_bridge.toml is written" in form.words.value
    assert rb.case(str(path)) == form.bridge.case()
    before = path.read_bytes()
    form.set(span=30.0)
    form.button.click()
    assert "is there already" in form.trouble.value
    assert path.read_bytes() == before
    form.set(file="<b>other</b>.toml").button.click()
    assert "<b>other" not in form.words.value + form.trouble.value


def test_it_starts_with_a_bridge_that_can_be_run(form):
    assert isinstance(form.bridge, SimpleBridge)
    assert form.bridge.case().deck.frequencies_hz[0] == pytest.approx(form.bridge.first_frequency)


def test_a_closed_form_says_so(form):
    assert "text/plain" in form._repr_mimebundle_()
    form.close()
    form.close()
    assert form._repr_mimebundle_() == {"text/plain": rb.panels.panel.CLOSED}
