"""The shelf of data files: found, and read."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from railbridge.cases import shelf
from railbridge.errors import InputError


def test_shipped_data_is_found_and_files_by_path(tmp_path):
    names = shelf.data_names("vehicles")
    assert names == sorted(names) and {"sprung_mass", "xia2000", "xia2000_planar"} <= set(names)
    assert shelf.data_file("decks", "viaduct36").name == "viaduct36.toml"
    mine = tmp_path / "mine.toml"
    mine.write_text("\ufeffa = 1\n", encoding="utf-8")  # Notepad's byte order mark
    assert shelf.read_toml(shelf.data_file("decks", mine)) == {"a": 1}


HEADER = "symbol,name,value,unit,source,note\n"


@pytest.mark.parametrize(
    "text",
    [
        HEADER + "m,mass,2,t,,\n",
        "\ufeff" + HEADER + "m,mass,2,t,,\n",
        (HEADER + "m,mass,2000,kg,,\n").replace("\n", "\r\n"),
        "name,value,unit,symbol,note,source\nmass,2,t,m,,\n\n,,,,,\n",
        HEADER + 'm,"mass",2e0,t,"a, b",\n"","",,,,\n',
        HEADER + 'm,mass,2,t,"two\n# lines",\n',
        "name,value,unit\nmass,2,t\n",
        "name;value;unit\nmass;2,0;t\n",
        HEADER.replace(",", ";") + 'm;mass;2000,0;kg;"a; b";\n',
        HEADER + "m,load,2,t,,\n",
        "# mine\n" + HEADER + "m,mass,2,t,,\n# m,mass,3,t,,\n",
    ],
)
def test_good_parameter_tables(tmp_path, text):
    path = tmp_path / "p.csv"
    path.write_bytes(text.encode())
    expected = {"mass": "kg", "width": "m"}
    assert shelf.read_parameters(path, expected, ["width"], {"load": "mass"}) == {"mass": 2000.0}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "column name: is missing"),
        ("\n\n", "column name: is missing"),
        (HEADER, "row mass: is missing"),
        ("symbol,name,value,source,note\nm,mass,2,,\n", "column unit: is missing"),
        ("symbol,name,value,value,unit,source,note\n", "column value: appears more than once"),
        ("symbol,name,valeu,unit,source,note\n", "Did you mean 'value'"),
        (
            HEADER + "m,mass,2,t,,\n\nm,mass,2,t,,\n",
            "line 4: row mass: appears more than once. Remove",
        ),
        (HEADER + "m,mas,2,t,,\n", "line 2: row mas: unknown parameter. Did you mean 'mass'"),
        (HEADER + "m,mass,2,kN,,\n", r"line 2: mass \(unit\) = 'kN': must be one of kg, t"),
        (HEADER + "m,mass,2,,,\n", r"line 2: mass \(unit\) = '': must be one of kg, t"),
        (
            HEADER + "# m,mass,2,t,,\nm,mass,nan,t,,\n",
            "line 3: mass = .nan.: must be a finite number",
        ),
        (HEADER + "m,mass,inf,t,,\n", "mass = .inf.: must be a finite number"),
        (HEADER + "m,mass,1e400,t,,\n", "mass = .1e400.: must be a finite number"),
        (HEADER + "m,mass,two,t,,\n", "mass = 'two': must be a finite number"),
        (HEADER + "m,mass,1.000.0,t,,\n", "mass = '1.000.0': may have a mark for thousands"),
        (
            HEADER + 'm,mass,"2,5",t,,\n',
            "mass = '2,5': has a decimal comma. Use a point as decimal mark",
        ),
        (
            HEADER + "m,mass,2,5,t,,\n",
            "line 2 = 'm,mass,2,5,t,,': must have 6 cells, it has 7. Use a point as decimal mark",
        ),
        (HEADER + "m,mass,2,t\n", "line 2 = .*must have 6 cells, it has 4"),
        (HEADER + 'm,mass,"50,990",kg,,\n', "mass = '50,990': may have a mark for thousands"),
        (
            HEADER.replace(",", " ") + "m mass 2 t\n",
            "has none of the columns of such a table. Separate cells by commas",
        ),
        (HEADER + "m,mass,,t,,\n", "mass = '': is blank, must be a number"),
    ],
)
def test_bad_parameter_tables(tmp_path, text, message):
    path = tmp_path / "p.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message) as error:
        shelf.read_parameters(path, {"mass": "kg"})
    assert error.value.source == "p.csv" and str(error.value).startswith("p.csv: ")


@given(blob=st.binary(max_size=300))
def test_binary_rubbish_is_refused_in_words(tmp_path_factory, blob):
    folder = tmp_path_factory.mktemp("rubbish")
    (folder / "p.csv").write_bytes(blob)
    (folder / "p.toml").write_bytes(blob)
    with pytest.raises(InputError, match="p.csv"):
        shelf.read_parameters(folder / "p.csv", {"mass": "kg"})
    try:
        shelf.read_toml(folder / "p.toml")
    except InputError as error:
        assert "p.toml" in str(error)


@pytest.mark.parametrize(
    "text",
    [
        "a = 1\na = 2",
        "[a",
        "a = 1979-13-45",
        "a = " + "[" * 5000,
        "a = " + "9" * 5000,
        "a: 1",
        "a = 1,5",
    ],
)
def test_what_is_no_toml(tmp_path, text):
    path = tmp_path / "p.toml"
    path.write_text(text)
    with pytest.raises(InputError, match="not a valid TOML"):
        shelf.read_toml(path)
