"""A case is data: it goes through replace, get, code and files unchanged, and runs like the objects
it stands for."""

import os

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases import shelf

PAPER = rb.case("paper")
SMALL = {
    "deck": {
        "length": 30.0,
        "bending_stiffness_vertical": 5e10,
        "mass": 1e4,
        "damping": {"modal": 0.01},
        "modes": 6,
    },
    "train": {"vehicle": "xia2000_planar"},
    "run": {"speed": 30.0, "time_step": 4e-3, "iterations": 1},
}


def changed(**tables):
    return rb.Case({**SMALL, **{k: {**SMALL.get(k, {}), **v} for k, v in tables.items()}})


def test_the_paper_s_case_is_its_objects():
    run = PAPER.replace({"train.cars": 2, "run.iterations": 3}).run()
    track = rb.Track(
        rb.Harmonic(5e-3, wavelength=14.4), rb.Harmonic(2e-3, wavelength=14.4, phase=np.pi / 2)
    )
    train = rb.Train(rb.vehicle("xia2000"), cars=2, car_spacing=22.5)
    own = rb.cross(
        train,
        rb.deck("viaduct36"),
        track,
        speed=20.0,
        loads="condensed",
        time_step=1e-3,
        track_offset="left",
        iterations=3,
    )
    assert np.array_equal(run.wheel_forces, own.wheel_forces)
    assert np.array_equal(
        run.displacement(18.0)["displacement_z"], own.displacement(18.0)["displacement_z"]
    )
    assert PAPER.train.cars == 8 and PAPER.points.tolist() == [18.0]


def test_replace_and_get():
    case = PAPER.replace(
        {
            "run.speed": 22.0,
            "track.vertical.wavelength": 15.0,
            "run.lead_in": 300.0,
            "track.lateral": None,
        }
    )
    assert case.get("run.speed") == 22.0 and case.options["speed"] == 22.0
    assert case.track.vertical.wavelength == 15.0
    assert case.get("track.lateral") is None and case.get("no.such.path") is None
    assert (
        PAPER.get("run.speed") == 20.0 and PAPER.track.lateral is not None
    )  # the old one is untouched
    old = {
        p: PAPER.get(p)
        for p in ("run.speed", "track.vertical.wavelength", "run.lead_in", "track.lateral")
    }
    back = case.replace(old)
    assert back.content == PAPER.content
    taken = PAPER.get("track")
    taken["vertical"]["wavelength"] = 1.0
    assert PAPER.get("track.vertical.wavelength") == 14.4  # a copy, not the thing itself


def test_content_given_is_not_kept_by_reference():
    content = {k: dict(v) for k, v in SMALL.items()}
    case = rb.Case(content)
    content["run"]["speed"] = -1.0
    assert case.get("run.speed") == 30.0


@pytest.mark.parametrize(
    "case",
    [
        PAPER.replace({"train.cars": 1, "run.iterations": 1, "run.time_step": 4e-3}),
        changed(
            train={"cars": np.int64(2), "car_spacing": np.float32(23.0)},
            run={"speed": np.float64(25.0)},
        ),
        changed(output={"points": np.array([3.0, 15.0])}),
    ],
)
def test_code_builds_the_same_case(case):
    names: dict = {}
    exec(case.code(), names)
    assert names["case"].content == case.content
    assert np.array_equal(names["run"].wheel_forces, case.run().wheel_forces)


def test_every_kind_of_track():
    table = {"kind": "table", "x": [0.0, 5.0, 9.0], "r": [0.0, 1e-3, 0.0]}
    wave = {"kind": "harmonic", "amplitude": 1e-3, "length": 36.0, "half_waves": 5}
    case = changed(
        track={"vertical": {"left": [table, wave], "right": {"kind": "none"}}, "lateral": wave}
    )
    x = np.array([2.5])
    rail = case.track.rail("vertical", "left")
    assert rail.value(x) == pytest.approx(5e-4 + 1e-3 * np.sin(2 * np.pi * 2.5 / 14.4))
    assert case.track.rail("vertical", "right").value(x) == 0.0
    assert case.run().wheel_forces.shape == (4, 2, len(case.run().time))


def test_a_measured_track_can_be_crossed():
    rng = np.random.default_rng(0)
    x = np.linspace(-50, 60, 300)
    run = changed(
        track={"vertical": {"kind": "table", "x": x, "r": 1e-3 * rng.normal(size=300)}},
        run={"time_step": 1e-3},
    ).run()
    assert (
        np.abs(run.wheel_forces).max() > 1.15 * rb.vehicle("xia2000_planar").contacts[0].static_load
    )


def test_trains_of_all_kinds():
    mixed = dict(SMALL)
    mixed["train"] = {
        "cars": ["xia2000_planar", {"vehicle": "sprung_mass", "count": 2}, "xia2000_planar"]
    }
    assert [v.name for v in rb.Case(mixed).train.vehicles] == [
        "xia2000_planar",
        "sprung_mass",
        "sprung_mass",
        "xia2000_planar",
    ]
    mixed["train"] = {"axles": [0.0, 2.5], "loads": [1e5, 1e5], "track": 0.5}
    case = rb.Case(mixed)
    assert isinstance(case.train, rb.AxleTrain) and case.options["track_offset"] == 0.5


def test_trains_by_name_and_from_files(tmp_path):
    def made(**train):
        return rb.Case(dict(SMALL) | {"train": train})

    case = made(name="HSLM-A1", track=0.5)
    assert case.train == rb.train("HSLM-A1") and case.options["track_offset"] == 0.5
    assert made(name="D4", wagons=3).train == rb.train("D4", wagons=3)
    assert made(name="HSLM-B", n=4, d=3.5).train == rb.hslm_b(4, 3.5)
    assert case.replace({"train.name": "ICE2"}).train.length == 350.52
    (tmp_path / "mine.csv").write_text("place (m),load (t)\n0,20\n1.8,20\n", encoding="utf-8")
    path = tmp_path / "own.toml"
    content = made(name="ICE2").content | {"train": {"file": "mine.csv"}}
    deck, run = content["deck"], content["run"]
    path.write_text("[train]\nfile = 'mine.csv'\n", encoding="utf-8")
    own = rb.case(path, {"deck": deck, "run": run})  # found beside the case, wherever one is
    assert own.train.name == "mine" and own.train.loads == (196.2e3, 196.2e3)
    again: dict = {}
    exec(own.code(), again)
    assert again["case"].train == own.train
    assert np.isfinite(own.summary()["points"][0]["displacement_z"]["min"]["value"])


@pytest.mark.parametrize(
    ("train", "words"),
    [
        ({"name": "HSLM-A11"}, "train.name = 'HSLM-A11': no such train. Did you mean 'HSLM-A1'"),
        ({"name": 5}, "train.name = 5: must be a name"),
        ({"name": "ICE2", "wagons": 3}, "train.wagons = 3: is the number of wagons of a line"),
        ({"name": "HSLM-B", "n": 4}, "train.d: is missing.*Figure 6.14"),
        ({"name": "D4", "wagons": 0}, "train.wagons = 0: must be .* at least 1"),
        ({"name": "D4", "vehicle": "xia2000"}, "train.vehicle = .* cannot stand beside train.name"),
        ({"name": "D4", "file": "a.csv"}, "train.file = .* cannot stand beside train.name"),
        ({"file": "a.csv", "loads": [1]}, "train.loads = .* cannot stand beside train.file"),
        ({"file": "mine"}, "train.file = 'mine': is no path of a file. Write its ending"),
        ({"name": "a.csv"}, "train.name = 'a.csv': is the path of a file. Write train.file"),
        ({"file": "none.csv"}, "train.file = 'none.csv': no such file"),
    ],
)
def test_trains_by_name_that_cannot_be_are_refused(train, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(rb.InputError, match=words):
        rb.Case(dict(SMALL) | {"train": train})


def test_what_is_doubted_of_a_named_train_is_said_of_its_name_or_file(tmp_path):
    path = tmp_path / "light.csv"
    path.write_text("place (m),load (N)\n0,220\n3,220\n", encoding="utf-8")
    (doubt,) = rb.Case(dict(SMALL) | {"train": {"file": str(path)}}).doubts
    assert doubt.field == "train.file" and "kN" in doubt.text


def test_notches():
    notch = {
        "wheels": [[1, 1], [1, 3]],
        "circumference": 2.8,
        "offset": 1.0,
        "depth": 1e-3,
        "length": 0.2,
    }
    content = {
        **SMALL,
        "train": {**SMALL["train"], "notch": [notch]},
        "run": {"speed": 30.0, "iterations": 1},
    }
    case = rb.Case(content)
    assert case.train.notches[0].wheels == ((1, 1), (1, 3))
    assert case.run().settings.time_step <= 0.2 / 20 / 30.0 * (1 + 1e-12)


def test_files(tmp_path):
    path = tmp_path / "my case.toml"
    path.write_text(
        '[deck]\nfile = "viaduct36"\nmodes = 5\n[train]\nvehicle = "xia2000"\n[run]\nspeed = 30\n',
        encoding="utf-8",
    )
    case = rb.case(path)
    assert len(case.deck.frequencies_hz) == 5 and case.points.tolist() == [18.0]
    assert rb.case(str(path)).content == case.content


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("run.sped", 20.0, "run.sped: unknown key. Did you mean 'speed'"),
        ("rnu", {}, "rnu: unknown key. Did you mean 'run'"),
        ("deck.mode", 5, "deck.mode"),
        ("train.spacing", 5.0, "train.spacing: unknown key. Did you mean 'car_spacing'"),
        ("deck.", 5.0, 'deck."" = 5.0: cannot stand beside deck.file'),
        ("deck.mass", 9e3, "deck.mass = 9000.0: cannot stand beside deck.file.* write the deck"),
        ("run.", 5.0, 'run."": unknown key'),
        ("run.a b", 5.0, 'run."a b": unknown key'),
        ("track.vertical.wave", 1.0, "track.vertical.wave: unknown key"),
        ("track.vertikal", {"kind": "none"}, "Did you mean 'vertical'"),
        ("output.point", [1.0], "Did you mean 'points'"),
        ("run.speed.value", 3.0, "leads nowhere"),
        ("run", None, "run: is missing"),
        ("run.speed", None, "run.speed: is missing"),
        ("train", [{"vehicle": "xia2000"}] * 2, "several trains .* not supported"),
        ("train.cars", ["xia2000"], "either vehicle"),
        ("output.points", [40.0], r"output.points\[1\] = 40.0"),
    ],
)
def test_unknown_keys_and_wrong_tables(path, value, message):
    with pytest.raises(rb.InputError, match=message):
        PAPER.replace({path: value})


def test_cases_compare_by_their_content():
    two = {"output.points": [9.0, 18.0]}
    assert rb.case("paper").replace(two) == rb.case("paper").replace(two) != rb.case("paper")


def test_code_of_a_point_at_the_very_end_runs():
    tables = {
        "deck": {
            "length": 33.33337,
            "bending_stiffness_vertical": 8e10,
            "mass": 1e4,
            "damping": {"modal": 0.01},
            "modes": 3,
        },
        "train": {"axles": [0.0], "loads": [1e5]},
        "run": {"speed": 20.0},
        "output": {"points": [33.33337]},
    }
    exec(rb.case(tables).code(), {})


def test_a_vehicle_file_of_the_same_name_elsewhere_is_another_vehicle(tmp_path, monkeypatch):
    text = shelf.data_file("vehicles", "sprung_mass").read_text(encoding="utf-8")
    for folder, length in (("a", 11.0), ("b", 12.0)):
        place = tmp_path / folder
        place.mkdir()
        file = place / "own.toml"
        lines = [f"length = {length}" if x.startswith("length") else x for x in text.splitlines()]
        file.write_text("\n".join(lines), encoding="utf-8")
        os.utime(file, (1e9, 1e9))
        monkeypatch.chdir(place)
        changes = {"train.vehicle": "own.toml", "train.cars": 1, "run.loads": "wheels"}
        assert rb.case("paper").replace(changes).train.vehicle.length == length


@pytest.mark.parametrize(
    "deck",
    [
        {"spans": [12.1, 12.2, 12.3]},
        {
            "spans": [12.1, 12.2, 12.3],
            "bearing": [{"x": x, "fixed": "y z"} for x in (0.0, 12.1, 24.3, 36.6)],
        },
        {"spans": [12.1, 12.2, 12.3], "continuous": False},
    ],
)
def test_spans_that_no_computer_adds_up_exactly_run_to_their_end(deck):
    own = {"bending_stiffness_vertical": 1.2e10, "mass": 12e3, "damping": {"modal": 0.02}}
    tables = {
        "deck": {**own, **deck},
        "train": {"axles": [0.0, 2.5], "loads": [150e3, 150e3]},
        "run": {"speed": 40.0, "interaction": "rigid"},
        "output": {"points": [0.0, 36.6]},
    }
    found = rb.Case(tables)
    summary = found.summary()
    assert found.points[-1] == found.deck.length
    assert [r["x"] for r in summary["reactions"]] == pytest.approx([0.0, 12.1, 24.3, 36.6])
    stations = summary["envelope"]["displacement_z"]["stations"]
    assert stations["x"][-1] == pytest.approx(36.6) and stations["max"][-1] == pytest.approx(0.0)


def test_wheels_and_tracks_at_the_very_edge_of_a_deck_are_on_it():
    """1.1 + 2.2 is more than 3.3 in the computer."""
    edge = 1.1 + 2.2
    tables = {"width": 6.6, "tracks": {"edge": edge}}
    assert edge > 3.3
    for track in ("edge", edge):
        found = changed(deck=tables, train={"vehicle": "sprung_mass", "track": track})
        assert found.settings.track_offset == pytest.approx(3.3)
    with pytest.raises(rb.InputError, match=r"deck\.tracks\.edge = 3\.30001.*at most 3\.3 m"):
        changed(deck={"width": 6.6, "tracks": {"edge": 3.30001}})


def test_many_places_count_for_the_size_of_a_run():
    """A run that just fits does not with the histories of a hundred places."""
    fixed = 1.2e8
    needed = rb.settings.bytes_needed(PAPER.train, PAPER.deck, PAPER.settings)
    step = PAPER.settings.time_step * (needed - fixed) / (1.8e9 - fixed)
    fits = PAPER.replace({"run.time_step": step})
    with pytest.raises(rb.InputError, match=r"^output\.points = 100: a run with so many places"):
        fits.replace({"output.points": [0.36 * i for i in range(100)]})


def test_the_table_of_checks_becomes_what_the_clauses_are_told():
    assert PAPER.requirements is None
    given = {"line_speed": 44.4, "kind": "steel", "comfort": "good", "alpha": 1.21}
    case = changed(checks=given)
    assert case.requirements == rb.Requirements(**given)
    assert case.replace({"run.speed": 30.0}).requirements == case.requirements
    assert case.replace({"checks": None}).requirements is None


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, r"^checks\.line_speed: is missing"),
        ({"line_speed": 160}, None),
        ({"line_speed": 400}, r"^checks\.line_speed = 400: .*at most 200 m/s"),
        ({"line_speed": 40, "kind": "stone"}, r"^checks\.kind = 'stone'"),
        ({"line_speed": 40, "alpha": 1.2}, r"^checks\.alpha = 1\.2: must be one of 0\.75"),
        ({"line_speed": 40, "speed": 3}, r"^checks\.speed: unknown key"),
    ],
)
def test_checks_are_refused_by_their_keys(given, said):
    if said is None:
        assert changed(checks=given).requirements.line_speed == 160.0
        return
    with pytest.raises(rb.InputError, match=said):
        changed(checks=given)


@pytest.mark.parametrize(
    ("train", "words"),
    [
        ({"name": "HSLM-A3"}, "HSLM-A3"),
        ({"vehicle": "xia2000_planar", "cars": 2}, "2 x xia2000_planar"),
        ({"axles": [0.0, 3.0], "loads": [1e5, 1e5]}, "the train"),
    ],
)
def test_a_deck_and_a_train_are_called_by_their_names(train, words):
    pytest.importorskip("xarray")
    own = rb.SimpleBridge(
        span=15.0, mass=1e4, kind="composite", line_speed=40.0, frequency=6.0, name="A 12, km 7"
    ).case(train)
    assert own.deck.name == "A 12, km 7"
    found = own.assess(speeds=2, stations=5)
    assert found.envelope.train.values.tolist() == [words]
