"""Trains by name and from files: what they are, and how what cannot be is refused."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases import shelf
from railbridge.cases.axletrains import read_train, train_list

HEAD = "place (m), load (kN)\n"


def written(folder, text, name="mine.csv"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_names_of_standards_are_their_trains():
    for i in range(1, 11):
        assert rb.train(f"HSLM-A{i}").name == f"HSLM-A{i}"
    assert rb.train("HSLM-B", n=10, d=3.0) == rb.hslm_b(10, 3.0)
    assert len(rb.train("D4", wagons=7).axles) == 28 and len(rb.train("D4").axles) == 80


# First to last axle (m), number of axles, all of them (kN), and one place and load inside.
SHIPPED = {
    "ICE2": (350.52, 56, 6936.0, (19.31, 112.0)),
    "Talgo350": (356.05, 40, 6800.0, (67.52, 170.0)),
    "AVE-S100": (393.31, 52, 8429.2, (200.15, 172.1)),
    "KTX": (380.16, 46, 7820.0, (38.98, 170.0)),
}


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_axle_lists(name):
    length, axles, weight, (place, load) = SHIPPED[name]
    train = rb.train(name)
    assert (train.length, train.weight) == pytest.approx((length, 1e3 * weight))
    assert len(train.axles) == axles
    assert train.loads[train.axles.index(pytest.approx(place))] == pytest.approx(1e3 * load)


def test_shipped_axle_lists_run_both_ways():
    for name in SHIPPED:  # double and symmetric units
        axles = np.array(rb.train(name).axles)
        if name != "Talgo350":  # its halves are not coupled as they end
            assert axles == pytest.approx(axles[-1] - axles[::-1], abs=0.011)


@pytest.mark.parametrize(
    "text",
    [
        HEAD + "0,220\n1.8,220\n6.45,225\n",
        "# name: mine\n# source: a, b\nload (kN),place (m)\n220,0\n220,1.8\n225,6.45\n",
        "place [mm],load [N],note\n1000,220e3,a\n2800,220000,\n7450,225000,c\n",
        "spacing (m),load (kN)\n0,220\n1.8,220\n4.65,225\n",
        "spacing (m);load (kN)\n;220,0\n1,8;220\n4,65;225\n",
        "place (cm)\tload (MN)\n0\t0.22\n180\t0.22\n645\t0.225\n",
        "place(m),load(kN)\r\n0,220\r\n1.8,220\r\n\r\n6.45,225\r\n",
    ],
)
def test_files_that_say_the_same_are_the_same_train(tmp_path, text):
    train = rb.train(written(tmp_path, text))
    assert train.axles == pytest.approx((0.0, 1.8, 6.45), abs=1e-12)
    assert train.loads == pytest.approx((220e3, 220e3, 225e3))
    assert train.name == "mine"


def test_a_mass_is_multiplied_by_g(tmp_path):
    for unit, mass in (("t", "22.5"), ("kg", "22500")):
        train = read_train(written(tmp_path, f"place (m),load ({unit})\n0,{mass}\n"))
        assert train.loads == pytest.approx((22.5 * 9810.0,))


def test_a_name_in_the_file_goes_before_the_name_of_the_file(tmp_path):
    given = written(tmp_path, "# name: my train, empty\n" + HEAD + "0,50\n", "other.csv")
    assert rb.train(str(given)).name == "my train, empty"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "column load: is missing"),
        (HEAD, "rows: there are none below the header"),
        ("a,b\n1,2\n", "header: has none of the columns"),
        ("place (m), load (kN), laod (kN)\n0,1,1\n", "column laod: unknown .* 'load'"),
        ("load (kN)\n220\n", "columns place and spacing: are both missing or blank. Give either"),
        ("place (m),spacing (m),load (kN)\n0,0,220\n", "columns place and spacing: are both given"),
        ("place,load (kN)\n0,220\n", r"column place: has no unit. Write place \(m\) in the header"),
        ("place (m),load\n0,220\n", r"column load: has no unit. Write load \(kN\)"),
        ("place (yd),load (kN)\n0,2\n", r"column place \(unit\) = 'yd': must be one of m, mm"),
        ("place (m),load (Pa)\n0,2\n", r"column load \(unit\) = 'Pa': must be a force .* mass \("),
        ("place (m),load (kN)\n0,abc\n", "line 2: load = 'abc': must be a finite number"),
        (HEAD + "0,220\n1.8,\n", "line 3: load = '': is blank"),
        (HEAD + "0,220\n,220\n", "line 3: place = '': is blank"),
        (HEAD + "0,220\n1.8,nan\n", "line 3: load = 'nan': must be a finite number"),
        (HEAD + "0,220\n1.8,0\n", "line 3: load = '0': must be above 0 kN. Loads are down"),
        (HEAD + "0,220\n1.8,-220\n", "line 3: load = '-220': must be above 0 kN"),
        (HEAD + "0,220\n\n3,220\n1.8,220\n", "line 5: place = '1.8': must be above 3 m.* line 4"),
        (HEAD + "0,220\n0,220\n", "line 3: place = '0': must be above 0 m.* one axle, add them up"),
        ("spacing (m),load (kN)\n3,220\n1.8,220\n", "line 2: spacing = '3': must be 0 or blank"),
        ("spacing (mm),load (kN)\n0,220\n0,220\n", "line 3: spacing = '0': must be above 0 mm"),
        ("spacing (mm),load (kN)\n0,220\n,220\n", "line 3: spacing = '': is blank"),
        (HEAD + "0,220,1\n", r"line 2 = '0,220,1': must have 2 cells, it has 3"),
    ],
)  # fmt: skip
def test_a_bad_file_is_refused_with_line_and_remedy(tmp_path, text, words):
    path = written(tmp_path, text)
    with pytest.raises(rb.InputError, match=r"^mine\.csv: " + words):
        rb.train(path)


def test_names_that_are_none_are_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for source, words in [
        ("HSLM-A11", "train = 'HSLM-A11': no such train. Did you mean 'HSLM-A1'"),
        ("ICE3", "train = 'ICE3': no such train. Did you mean 'ICE2'"),
        ("", "train = '': must be a name or a path"),
        (None, "train: must be a name or a path"),
        ("mine.csv", "train = 'mine.csv': no such file"),
        ("mine.toml", "train = 'mine.toml': train files must end in .csv"),
    ]:
        with pytest.raises(rb.InputError) as error:
            rb.train(source)
        assert str(error.value).startswith(words)


def test_options_of_other_trains_are_refused():
    for source, options, field in [
        ("HSLM-A1", {"wagons": 3}, "wagons"),
        ("ICE2", {"n": 3}, "n"),
        ("D4", {"d": 3.0}, "d"),
        (["D4"], {"wagons": 3}, "wagons"),
        ("HSLM-B", {"n": 3}, "d"),
        ("D4", {"wagons": 0}, "wagons"),
    ]:
        with pytest.raises(rb.InputError) as error:
            rb.train(source, **options)
        assert error.value.field == field


def test_a_file_with_the_name_of_a_rule_is_ambiguous(tmp_path, monkeypatch):
    monkeypatch.setenv("RAILBRIDGE_DATA", str(tmp_path))
    (tmp_path / "trains").mkdir()
    written(tmp_path / "trains", HEAD + "0,220\n", "D4.csv")
    written(tmp_path / "trains", HEAD + "0,220\n3,220\n", "mine.csv")
    with pytest.raises(rb.InputError, match="train = 'D4': is the name of a standard's train and"):
        rb.train("D4")
    assert rb.train("mine").length == 3.0  # a file of one's own on the shelf


def test_the_list_shows_every_train():
    listed = train_list()
    assert listed.names[:10] == tuple(f"HSLM-A{i}" for i in range(1, 11))
    assert set(listed.names) >= {"A", "D4", "E5", *shelf.data_names("trains")}
    assert len(listed) == len(set(listed.names)) == 10 + 12 + 4 and "HSLM-B" not in listed.names
    for row in listed:
        train = rb.train(row.name)
        assert (row.length, row.weight, row.axles) == (
            train.length, train.weight, len(train.axles),
        )  # fmt: skip
        assert row.largest_load == max(train.loads) and len(row.source) > 10
    frame = rb.train_list().to_frame()
    assert frame.loc["HSLM-A2", ["length (m)", "weight (kN)", "axles"]].tolist() == [
        398.525,
        9600,
        48,
    ]
    assert frame.loc["AVE-S100", "largest axle load (kN)"] == pytest.approx(172.1)
    assert "<table" in listed._repr_html_()
