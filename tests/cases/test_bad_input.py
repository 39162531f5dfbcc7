"""Every bad input gets a message that names the field, the value, the range and what to try, before
anything runs."""

import re
import shutil

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import railbridge as rb
from railbridge import crossing
from railbridge.cases import shelf
from railbridge.coupling import prepare

PAPER = rb.case("paper").content
CAR_TABLE = shelf.data_file("vehicles", "xia2000").read_text(encoding="utf-8")
DECK_TABLE = shelf.data_file("decks", "viaduct36").read_text(encoding="utf-8")
SPRUNG = shelf.data_file("vehicles", "sprung_mass").read_text(encoding="utf-8")
NOTCH = {"wheels": [[1, 1]], "circumference": 2.8, "offset": 0.0, "depth": 1e-3, "length": 0.05}
WAVE = {"kind": "harmonic", "amplitude": 1e-3, "wavelength": 10.0}
OWN_DECK = {
    "length": 36.0,
    "bending_stiffness_vertical": 8.8e10,
    "mass": 1e4,
    "damping": {"modal": 0.01},
    "modes": 5,
}
PIER = {
    "height": 12.0, "youngs_modulus": 33e9, "area": 4.0, "second_moment_along": 2.0,
    "second_moment_across": 5.0,
}  # fmt: skip


@pytest.fixture(autouse=True)
def _nothing_is_computed(monkeypatch):
    """A refusal comes before the first force is computed."""
    monkeypatch.setattr(
        crossing, "prepare", lambda *_: pytest.fail("computed before it was refused")
    )


def refused(make, *words):
    with pytest.raises(rb.InputError) as error:
        make()
    message = str(error.value)
    for word in words:
        assert re.search(word, message), f"{word!r} not in {message!r}"
    assert (error.value.field or error.value.source) and error.value.allowed
    return error.value


def paper(path, value):
    return lambda: rb.Case(PAPER).replace({path: value}).run()


@pytest.mark.parametrize(
    "value", [0.0, -20.0, float("nan"), float("inf"), 500.0, "20", True, [20.0], 1e-320]
)
def test_speed(value):
    error = refused(
        paper("run.speed", value), "run.speed", "above 0 and at most 200 m/s", "72 km/h is 20"
    )
    assert error.field == "run.speed"


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("run.time_step", 0.0, ["run.time_step = 0", "above 0"]),
        ("run.time_step", -1e-3, ["run.time_step = -0.001", "above 0"]),
        ("run.time_step", float("nan"), ["run.time_step", "finite"]),
        (
            "run.time_step",
            0.08,
            ["run.time_step = 0.08", "fewer than 10 samples in 14.4 m", "at most 0.072 s", "Leave"],
        ),
        ("run.time_step", 1e-12, ["run.time_step", "too m(any|uch)", "larger step"]),
        ("run.lead_in", -1.0, ["run.lead_in = -1", "at least 0", "level track"]),
        ("run.lead_in", 1e9, ["run.lead_in", "at most"]),
        ("run.tail", -1.0, ["run.tail = -1", "at least 0"]),
        ("run.tolerance", 0.0, ["run.tolerance = 0", "above 0"]),
        ("run.max_iterations", 0, ["run.max_iterations = 0", "at least 1"]),
        ("run.iterations", 1.5, ["run.iterations = 1.5", "whole"]),
        ("run.relaxation", 0.0, ["run.relaxation = 0", "above 0 and at most 1", "aitken"]),
        ("run.relaxation", 1.5, ["run.relaxation = 1.5"]),
        ("run.relaxation", "atken", ["run.relaxation", "aitken"]),
        (
            "run.loads",
            "wheel",
            ["run.loads = 'wheel'", "wheels, bogies, condensed", "Did you mean 'wheels'"],
        ),
        ("run.interaction", "iterat", ["run.interaction", "Did you mean 'iterate'"]),
        ("run.excitation", "bogie", ["run.excitation"]),
        ("run.feedback", "none", ["run.feedback"]),
        ("track.vertical.wavelength", 0.0, ["track.vertical.wavelength = 0", "above 0 m"]),
        ("track.vertical.wavelength", -14.4, ["track.vertical.wavelength = -14.4", "above 0 m"]),
        ("track.vertical.wavelength", None, ["track.vertical.wavelength", "either"]),
        ("track.vertical.half_waves", 5, ["track.vertical.wavelength", "either"]),
        ("track.vertical.amplitude", float("nan"), ["track.vertical.amplitude = nan", "finite"]),
        (
            "track.vertical.amplitude",
            -1e-3,
            ["track.vertical.amplitude", "at least 0", "phase by pi"],
        ),
        ("track.vertical.kind", "harmonc", ["track.vertical.kind", "Did you mean 'harmonic'"]),
        (
            "track.vertical",
            {"kind": "table", "x": [0, 1], "r": [0]},
            ["track.vertical.r", "must hold 2"],
        ),
        (
            "track.vertical",
            {"kind": "table", "x": [0, 0], "r": [0, 1]},
            ["track.vertical.x", "ascend", "Sort"],
        ),
        (
            "track.vertical",
            {"kind": "table", "x": [0], "r": [0]},
            ["track.vertical.x", "two points"],
        ),
        (
            "track.vertical",
            {"left": WAVE, "rigth": WAVE},
            ["track.vertical.rigth", "Did you mean 'right'"],
        ),
        (
            "track.vertical",
            [WAVE, {"kind": "none", "amplitude": 1}],
            [r"track.vertical\[2\].amplitude", "belongs to kind = 'harmonic'"],
        ),
        ("track.vertical", 5e-3, ["track.vertical = 0.005", "table"]),
        ("train.cars", 0, ["train.cars = 0", "at least 1"]),
        ("train.cars", -3, ["train.cars = -3"]),
        ("train.cars", 1e6, ["train.cars", "at most 1000"]),
        ("train.cars", 2.5, ["train.cars = 2.5", "whole"]),
        ("train.car_spacing", -22.5, ["train.car_spacing = -22.5", "above 0 m"]),
        (
            "train.car_spacing",
            5.0,
            ["train.car_spacing = 5", "cars 1 and 2 overlap", "more than 18.1 m"],
        ),
        ("train.vehicle", "xia200", ["xia200", "Did you mean 'xia2000'"]),
        ("train.vehicle", "x" * 5000, ["vehicle", "Known"]),
        ("train.vehicle", "nowhere/my.csv", ["nowhere/my.csv", "no such file"]),
        ("train.vehicle", "my.txt", ["vehicle"]),
        ("train.vehicle", 5, ["vehicle = 5", "Shipped"]),
        ("deck.file", "viaduct63", ["viaduct63", "Did you mean 'viaduct36'"]),
        ("deck.modes", 0, ["modes = 0", "at least 1"]),
        ("deck.modes", 500, ["modes = 500", "elements"]),
        ("train.track", 4.5, ["train.track = 4.5", "off the deck", "half width 4.8"]),
        ("train.track", -7.0, ["train.track = -7", "at least -4.8"]),
        ("train.track", "middle", ["train.track = 'middle'", "left, right"]),
        (
            "train.notch",
            [{**NOTCH, "wheels": [[1, 9]]}],
            [r"train.notch\[1\].wheels", r"\(1, 9\)", "cars 1 to 8"],
        ),
        (
            "train.notch",
            [{**NOTCH, "wheels": [[1.5, 1]]}],
            [r"notch\[1\].wheels\[1\] = 1.5", "whole"],
        ),
        ("train.notch", [{**NOTCH, "wheels": []}], ["notch.*wheels", "pairs"]),
        ("train.notch", [{**NOTCH, "length": 3.0}], ["notch.*length = 3", "at most 2.8"]),
        ("train.notch", [{**NOTCH, "depth": -1e-3}], ["notch.*depth", "at least 0"]),
        ("train.notch", [{**NOTCH, "circumference": 0.0}], ["notch.*circumference", "above 0"]),
        ("train.notch", [{**NOTCH, "before_entrance": "no"}], ["before_entrance", "true or false"]),
        ("train.notch", NOTCH, ["train.notch", r"\[\[train.notch\]\]"]),
        (
            "train.notch",
            [NOTCH],
            ["run.time_step = 0.001", "fewer than 10 samples in 0.05 m", "0.00025 s"],
        ),
        ("output.points", [40.0], [r"output.points\[1\] = 40", "at most 36 m"]),
        ("output.points", [], ["output.points", "must hold"]),
    ],
)
def test_what_a_case_may_not_hold(path, value, words):
    refused(paper(path, value), *words)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"length": 0.0}, ["length|spans", "above 0"]),
        ({"length": -36.0}, ["-36", "above 0"]),
        ({"mass": 0.0}, ["mass = 0", "above 0"]),
        ({"mass": float("inf")}, ["mass = inf", "finite"]),
        ({"bending_stiffness_vertical": -1.0}, ["bending_stiffness_vertical = -1", "above 0"]),
        ({"spans": [20.0]}, ["either length or spans"]),
        ({"section": {}}, ["never both"]),
        ({"torsional_stiffness": 1e10}, ["polar_inertia", "missing"]),
        ({"damping": {"modal": -0.01}}, ["damping.modal = -0.01", "at least 0"]),
        (
            {"damping": {"ratio": -0.01, "frequencies_hz": [1, 2]}},
            ["damping.ratio = -0.01", "at least 0"],
        ),
        ({"damping": {"ratio": 0.01, "frequencies_hz": [2, 2]}}, ["two different"]),
        ({"damping": 0.03}, ["damping = 0.03", "table"]),
        ({"damping": {"alpha": -1.0}}, ["damping.alpha = -1", "at least 0 1/s"]),
        ({"damping": {"alpha": 1.0, "beta": "1 ms"}}, ["damping.beta = '1 ms'", "at least 0 s"]),
        (
            {"damping": {"beta": 1e-3, "modal": 0.01}},
            ["damping.beta = 0.001: cannot stand beside modal"],
        ),
        ({"damping": {}}, ["damping.ratio: is missing"]),
        ({"damping": {"per_mode": []}}, ["damping.per_mode = ", "at least one ratio"]),
        ({"damping": {"per_mode": 0.01}}, ["damping.per_mode = 0.01", "list of numbers"]),
        (
            {"damping": {"per_mode": [0.01, 1.0]}},
            [r"damping.per_mode\[2\] = 1", "at most 0.5"],
        ),
        ({"point_mass": {"x": 3.0, "mass": 1e3}}, [r"\[\[point_mass\]\]"]),
        ({"point_mass": [{"x": 3.0}]}, [r"point_mass\[1\].mass: is missing"]),
        ({"point_mass": [{"x": 3.0, "mass": -1.0}]}, [r"point_mass\[1\].mass = -1", "above 0 kg"]),
        ({"point_mass": [{"x": 37.0, "mass": 1.0}]}, [r"point_mass\[1\].x = 37", "at most 36 m"]),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "pier": {"height": 3.0}}]},
            [r"bearing\[1\].pier.youngs_modulus: is missing"],
        ),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "pier": PIER | {"height": 0.0}}]},
            [r"bearing\[1\].pier.height = 0", "above 0 m"],
        ),
        (
            {"bearing": [{"x": 0.0, "fixed": "z", "pier": PIER | {"height": 1e-7}}]},
            [r"bearing\[1\].pier.second_moment_along = 2", "stiffer"],
        ),
        ({"bearing": [{"x": 0.0, "pier": PIER}]}, [r"bearing\[1\].fixed: is missing"]),
        ({"width": -3.0}, ["width = -3", "above 0"]),
        ({"tracks": {"left": 3.0}, "width": 4.0}, ["tracks.left = 3", "at most 2"]),
        ({"elements": 10**6}, ["elements", "at most"]),
        ({"spans": [1.0] * 1000, "length": None}, ["spans", "1 to 30"]),
        (
            {"bearing": [{"x": 0.0, "fixed": "z"}]},
            ["bearing = ", "pitching", "mechanism", "Hold one more"],
        ),
        ({"bearing": [{"x": 40.0, "fixed": "z"}]}, [r"bearing\[1\].x = 40", "at most 36"]),
        ({"bearing": [{"x": 0.0, "fixed": "zz"}]}, ["fixed = 'zz'", "Did you mean 'z'|Known"]),
        ({"bearing": 5}, [r"\[\[bearing\]\]"]),
        ({"masss": 5.0}, ["masss", "Did you mean 'mass'"]),
    ],
)
def test_what_a_deck_may_not_be(change, words):
    table = {k: v for k, v in {**OWN_DECK, **change}.items() if v is not None}
    refused(lambda: rb.deck_from_table("mine", table), "deck|damping", *words)
    refused(lambda: rb.Case({**PAPER, "deck": table}), *words)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("car_body_mass,50990", "car_body_mass,0", ["car", "mass = 0", "above 0"]),
        ("car_body_mass,50990", "car_body_mass,-1", ["mass = -1"]),
        ("car_body_mass,50990", "car_body_mass,nan", ["car_body_mass = .nan.", "finite"]),
        (
            "car_body_mass,50990",
            'car_body_mass,"50,99"',
            ["'50,99'", "has a decimal comma", "point as decimal mark"],
        ),
        ("car_body_mass,50990,kg", "car_body_mass,50990,kN", ["unit", "kN", "kg, t"]),
        ("car_body_mass,50990,kg", "car_body_mass,50990,Kg", ["unit", "Kg"]),
        ("car_body_mass", "car_bodymass", ["row car_bodymass", "Did you mean 'car_body_mass'"]),
        ("bogie_mass", "car_body_mass", ["row car_body_mass", "more than once"]),
        (
            "primary_vertical_damping,15",
            "primary_vertical_damping,-15",
            ["damping", "-15000", "at least 0"],
        ),
        (
            "primary_vertical_stiffness,2976",
            "primary_vertical_stiffness,0",
            ["held by no spring", "mechanism"],
        ),
        ("secondary_lateral_stiffness,460", "secondary_lateral_stiffness,0", ["held by no spring"]),
        ("length,22.5", "length,-22.5", ["length = -22.5", "above 0"]),
        ("primary_half_width,0.98", "primary_half_width,0", ["primary_half_width = 0"]),
        ("symbol,name,value", "symbol,name,valeu", ["column valeu", "Did you mean 'value'"]),
        ("symbol,name,value", "name,name,value", ["column name", "more than once"]),
    ],
)
def test_a_car_s_table(tmp_path, old, new, words):
    path = tmp_path / "mine.csv"
    assert old in CAR_TABLE
    path.write_text(CAR_TABLE.replace(old, new, 1), encoding="utf-8")
    refused(lambda: rb.vehicle(path), "mine", *words)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("mass = 5750.0", "mass = 0", ["mass = 0", "above 0"]),
        ("mass = 5750.0", 'mass = "5750"', ["mass = '5750'", "number"]),
        ("mass = 5750.0", "mass = nan", ["mass = nan", "finite"]),
        ("mass = 5750.0", "weight = 5750.0", ["weight", "unknown key"]),
        ("mass = 5750.0", "", ["mass", "missing"]),
        (
            "stiffness = [0.0, 1595e3]",
            "stiffness = [0.0, 0.0]",
            [r"spring\[1\].stiffness", "both zero"],
        ),
        (
            "stiffness = [0.0, 1595e3]\ndamping = [0.0, 0.0]",
            "stiffness = [0, 0]\ndamping = [0, 5.0]",
            ["held by no spring"],
        ),
        (
            "stiffness = [0.0, 1595e3]",
            "stiffness = [0.0, -1595e3]",
            ["stiffness", "-1595000", "at least 0"],
        ),
        ("damping = [0.0, 0.0]", "damping = [0.0, -1.0]", ["damping", "-1", "at least 0"]),
        ("stiffness = [0.0, 1595e3]", "stiffness = 1595e3", ["stiffness = 1595000", "list"]),
        ('to = "rail"', 'to = "rial"', ["'rial'", "Did you mean 'rail'"]),
        ('to = "rail"', 'to = "mass"', ["differ"]),
        ('freedoms = ["z"]', 'freedoms = ["z", "roll"]', ["inertia in roll = 0", "above 0"]),
        ('freedoms = ["z"]', 'freedoms = ["z", "z"]', ["freedoms", "at most once"]),
        ('freedoms = ["z"]', 'freedoms = ["x"]', ["freedoms = 'x'"]),
        ("at = [0.0, 0.0, 0.0]", "at = [5.0, 0.0, 0.0]", ["one side of x = 0", "mid-length"]),
        ("at = [0.0, 0.0, 0.0]", "at = [0.0, 0.0]", ["at", "3 numbers"]),
        ("length = 10.0", "length = 0", ["length = 0"]),
        ("[[spring]]", "[spring]", [r"\[\[spring\]\]"]),
    ],
)
def test_a_vehicle_of_bodies_and_springs(tmp_path, old, new, words):
    path = tmp_path / "mine.toml"
    assert old in SPRUNG
    path.write_text(SPRUNG.replace(old, new, 1), encoding="utf-8")
    refused(lambda: rb.vehicle(path), "mine", *words)


def test_the_same_name_as_csv_and_toml(tmp_path, monkeypatch):
    shutil.copytree(shelf.data_root(), tmp_path / "data")
    monkeypatch.setattr(shelf, "data_root", lambda: tmp_path / "data")
    (tmp_path / "data" / "vehicles" / "xia2000.toml").write_text(SPRUNG, encoding="utf-8")
    refused(lambda: rb.vehicle("xia2000"), "vehicle = 'xia2000'", "both CSV and TOML", "Remove one")


def test_condensed_loads_without_suspension():
    axles = {**PAPER, "train": {"axles": [0.0, 2.5], "loads": [1e5, 1e5]}}
    refused(lambda: rb.Case(axles), "run.loads = 'condensed'", "no cars to condense", "wheels")


@pytest.mark.parametrize(
    ("train", "words"),
    [
        ({"axles": [], "loads": []}, ["train.axles"]),
        ({"axles": [0.0, 0.0], "loads": [1e5, 1e5]}, ["train.axles", "ascend"]),
        ({"axles": [3.0, 5.0], "loads": [1e5, 1e5]}, ["train.axles", "from 0", "Subtract"]),
        ({"axles": [0.0, 2.0], "loads": [1e5]}, ["train.loads", "2 numbers"]),
        ({"axles": [0.0], "loads": [-1e5]}, [r"train.loads\[1\] = -100000", "above 0 N"]),
        ({"axles": [0.0]}, ["train.loads", "missing"]),
        ({"axles": [0.0], "loads": [1e5], "cars": 3}, ["train.cars", "beside axles and loads"]),
        ({"cars": []}, ["train"]),
        ({"cars": [{"vehicle": "xia2000", "count": 0}]}, ["count = 0", "at least 1"]),
        ({"cars": ["xia2000", 5]}, [r"cars\[2\]"]),
        ([], ["train"]),
        ("xia2000", ["train = 'xia2000'", "table"]),
    ],
)
def test_what_a_train_may_not_be(train, words):
    refused(lambda: rb.Case({**PAPER, "train": train, "run": {"speed": 20.0}}), *words)


@pytest.mark.parametrize(("name", "place"), [("train", 0), ("deck", 1), ("track", 2)])
def test_things_in_the_wrong_place(name, place):
    given = [rb.Train(rb.vehicle("xia2000")), rb.deck("viaduct36"), rb.Track()]
    given[place] = rb.Harmonic(1e-3, wavelength=5.0)
    refused(lambda: rb.cross(*given, speed=20.0), f"^{name}", f"must be a {name.title()}")


def test_non_convergence_is_an_error_with_what_to_try(monkeypatch):
    monkeypatch.setattr(crossing, "prepare", prepare)
    deck = rb.deck_from_table("light", {**OWN_DECK, "mass": 1e3})
    with pytest.raises(
        rb.NotConvergedError,
        match=r"^max_iterations = 2: .* interaction = 'direct', relaxation = 0.5 or 'aitken', or",
    ) as error:
        rb.cross(
            rb.Train(rb.vehicle("xia2000_planar")),
            deck,
            speed=30.0,
            time_step=2e-3,
            max_iterations=2,
        )
    assert error.value.run.iterations == 2


@pytest.mark.parametrize("run", [{}, {"feedback": "vertical"}, {"loads": "bogies"}])
def test_the_direct_solution_is_named_first(monkeypatch, run):
    monkeypatch.setattr(crossing, "prepare", prepare)
    options = {"speed": 30.0, "time_step": 2e-3, "max_iterations": 2, "lead_in": 0.0, **run}
    tables = {"deck": {**OWN_DECK, "mass": 1e3}, "train": {"vehicle": "xia2000_planar"}}
    with pytest.raises(rb.NotConvergedError) as error:
        rb.Case({**tables, "run": options}).run()
    words = "Try run.interaction = 'direct', run.relaxation = 0.5 or 'aitken', or more run.max"
    assert words in str(error.value)


# Hostile from here on: whatever comes, InputError or a sound case.

scalars = st.one_of(
    st.none(), st.booleans(), st.integers(-(10**3), 10**3), st.floats(), st.text(max_size=8),
    st.sampled_from([np.float64(3), np.int32(-1), np.nan, 1e300, -1e-300, 10**400, 3j, b"x",
    np.array([1.0, 2.0]), "xia2000"]),
)  # fmt: skip
garbage = st.recursive(
    scalars,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=6,
)


def leaves(tables, path=""):
    for key, value in tables.items():
        yield f"{path}{key}"
        if isinstance(value, dict):
            yield from leaves(value, f"{path}{key}.")


FULL = {
    "deck": {**OWN_DECK, "width": 9.0, "tracks": {"left": 2.4}, "name": "own",
             "bearing": [{"x": 0.0, "fixed": "x z"}, {"x": 36.0, "fixed": "z"}], "elements": 40},
    "train": {"vehicle": "xia2000_planar", "cars": 1, "car_spacing": 22.5, "track": "left",
    "notch": [NOTCH]},
    "track": {"vertical": WAVE, "lateral": {"left": {"kind": "table", "x": [0, 9], "r": [0, 1e-3]},
    "right": WAVE}},
    "run": {"speed": 20.0, "time_step": 2.5e-4, "loads": "wheels", "interaction": "iterate",
    "tolerance": 1e-6, "tolerance_of": "displacement", "lead_in": 10.0,
            "tail": 1.0, "max_iterations": 9, "iterations": 2, "relaxation": 0.5,
            "excitation": "wheels", "feedback": "all", "acceleration_modes": 60.0},
    "output": {"points": [18.0]},
    "checks": {"line_speed": 44.4, "track": "ballasted", "kind": "steel", "simple": True,
               "comfort": "good", "alpha": 1.21, "track_twist": 1e-3},
}  # fmt: skip


@given(path=st.sampled_from(sorted(leaves(FULL))), value=garbage)
@settings(max_examples=250)
def test_any_rubbish_anywhere_in_a_case(path, value):
    content = rb.Case(FULL).content
    *parents, last = path.split(".")
    place = content
    for parent in parents:
        place = place[parent]
    place[last] = value
    try:
        case = rb.case(content)
    except rb.InputError as error:
        assert str(error)
    else:
        assert np.all(np.isfinite(case.deck.frequencies_hz)) and case.options["speed"] > 0


@given(content=garbage)
def test_any_rubbish_for_a_case(content):
    with pytest.raises(rb.InputError):
        rb.case(content)


@given(data=st.data(), kind=st.sampled_from(["vehicle.csv", "vehicle.toml", "deck.toml"]))
@settings(max_examples=120, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_files_with_a_mangled_line(tmp_path, data, kind):
    text = {"vehicle.csv": CAR_TABLE, "vehicle.toml": SPRUNG, "deck.toml": DECK_TABLE}[kind]
    lines = text.splitlines()
    i = data.draw(st.integers(0, len(lines) - 1))
    how = data.draw(st.sampled_from(["drop", "double", "swap", "cut", "insert", "number", "comma"]))
    line, odd = (
        lines[i],
        data.draw(st.sampled_from(["0", "-1", "nan", "inf", "1e400", "1e-9", "1e25"])),
    )
    cut = data.draw(st.integers(0, max(len(line) - 1, 0)))
    new = {
        "drop": [], "double": [line, line], "swap": [line[::-1]], "cut": [line[:cut]],
        "insert": [line[:cut] + data.draw(st.text(max_size=3)) + line[cut:]],
        "number": [re.sub(r"\d+\.?\d*", odd, line, count=1)],
        "comma": [line.replace(".", ",")],
    }[how]  # fmt: skip
    path = tmp_path / kind
    path.write_text("\n".join(lines[:i] + new + lines[i + 1 :]), encoding="utf-8", errors="replace")
    try:
        made = rb.deck(path) if kind == "deck.toml" else rb.vehicle(path)
    except rb.InputError as error:
        assert str(error)
    else:
        frequencies = made.frequencies_hz if kind == "deck.toml" else made.modes().frequencies_hz
        assert np.all(np.isfinite(frequencies))


@pytest.mark.parametrize(
    "blob",
    [b"", b"\x00\xff\xfe", b"PK\x03\x04", "ü".encode("latin-1"), b"\xef\xbb\xbf", b"a" * 200_000],
)
@pytest.mark.parametrize("suffix", ["csv", "toml"])
def test_files_that_are_something_else(tmp_path, blob, suffix):
    path = tmp_path / f"mine.{suffix}"
    path.write_bytes(blob)
    refused(lambda: rb.vehicle(path), "mine")
    if suffix == "toml":
        refused(lambda: rb.deck(path), "mine")
        refused(lambda: rb.case(path))
    else:
        refused(lambda: rb.deck(path), "TOML")
        refused(lambda: rb.case(path), "TOML")


def test_an_unknown_kind_of_irregularity_is_refused_with_the_near_ones():
    track = {"vertical": [{"kind": "harmonic", "amplitude": 1e-3, "wavelength": 9.0},
                          {"kind": "randomm", "spectrum": "german-low"}]}  # fmt: skip
    with pytest.raises(rb.InputError, match="Did you mean 'random'") as refused:
        _ = rb.case("paper").replace({"track": track}).track
    assert refused.value.field == "track.vertical[2].kind"
