"""The one reader of CSV files: what it accepts, what it refuses and in which words."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import railbridge as rb
from railbridge.exchange.tables import labelled, read_columns

HEADER = "node,x,name\n"


def read(folder, text, **options):
    path = folder / "t.csv"
    path.write_bytes(text.encode("utf-8"))
    return read_columns(path, ["node", "x"], ["name"], **options)


@pytest.mark.parametrize(
    "text",
    [
        HEADER + "1,0.5,a\n2.0,1.5,b\n",
        "\ufeff" + HEADER + "1,0.5,a\n2,1.5,b",
        (HEADER + "1,0.5,a\n2,1.5,b\n").replace("\n", "\r\n"),
        "x,name,node\n.5,a,1\n1.5,b,2\n",
        "# a remark\n\n" + HEADER + ',,\n"",,\n;;\n 1 , 0.5 ,a\n # another "remark"\n2,15e-1,b\n',
    ],
)
def test_good_tables(tmp_path, text):
    table = read(tmp_path, text)
    assert table.labels("node") == table.unique_labels("node") == ["1", "2"]
    assert table.numbers("x").tolist() == [0.5, 1.5]
    assert table.cells["name"] == ["a", "b"] and table.name == "t.csv"


def test_columns_may_be_left_out_if_they_are_optional(tmp_path):
    assert read(tmp_path, "node,x\n1,2\n").cells == {"node": ["1"], "x": ["2"]}


def test_comments_say_units_and_rows_know_their_lines(tmp_path):
    table = read(
        tmp_path, "# Units: mm, t,,\n#pieces:cubic\n# no colon\n" + HEADER + "1,2,a\n\n#\n3,4,b\n"
    )
    assert table.units == ("mm", "t") and table.remarks["pieces"] == ("cubic",)
    assert table.lines == [5, 8]
    assert read(tmp_path, HEADER + "1,2,a\n").units is None


def test_a_cell_between_quotes_may_hold_commas_and_lines(tmp_path):
    table = read(tmp_path, HEADER + '1,2,"a, b"\n2,3,"first\n# second\n\n"\n3,4,c\n')
    assert table.cells["name"] == ["a, b", "first\n# second", "c"]
    assert table.lines == [2, 3, 7]


def test_labels_are_numbers_or_names():
    assert [labelled(v) for v in (12, 12.0, "12.0", np.int64(12), " rail 1 ", "1.5", "nan")] == [
        "12", "12", "12", "12", "rail 1", "1.5", "nan",
    ]  # fmt: skip


BAD = [
    ("", "column node", None, "is missing. Columns: node,x,name"),
    (HEADER, "rows", None, "there are none below the header"),
    ("node,name\n1,a\n", "column x", None, "is missing. Columns: node,x,name"),
    ("node,x,nam\n1,2,a\n", "column nam", None, "unknown column. Did you mean 'name'?"),
    ("node,x,x\n1,2,a\n", "column x", None, "appears more than once"),
    ("node x name\n1 2 a\n", "header", None, "Separate cells by commas or semicolons"),
    ("# said\n" + HEADER + "\n1,2\n", "line 4", "1,2", "must have 3 cells, it has 2"),
    (
        HEADER + "1,2,5,a\n",
        "line 2",
        "1,2,5,a",
        "it has 4. Use a point as decimal mark, and put cells that contain a comma between",
    ),
]


@pytest.mark.parametrize(("text", "field", "value", "words"), BAD)
def test_bad_tables_name_file_line_and_column(tmp_path, text, field, value, words):
    with pytest.raises(rb.InputError) as error:
        read(tmp_path, text)
    assert (error.value.source, error.value.field, error.value.value) == ("t.csv", field, value)
    assert words in str(error.value)


SHORT = [
    (HEADER + '1,2,"a\n2,3,b\n3,4,c\n', "line 2", "cannot be read.*a double quote not closed"),
    (HEADER + '1,2,a\n2,3,"b"c\n', "line 3", "cannot be read.*a double quote not closed"),
    (HEADER + "1,2,a\n2,3," + 200_000 * "b", "line 3", "cannot be read.*or a cell too long"),
    ("node;x;name\n1;2;3;a\n", "line 2", "it has 4. Put cells that contain a semicolon"),
]


@pytest.mark.parametrize(("text", "field", "words"), SHORT)
def test_what_is_no_row_names_the_line_where_it_starts(tmp_path, text, field, words):
    with pytest.raises(rb.InputError, match=words) as error:
        read(tmp_path, text)
    assert (error.value.source, error.value.field) == ("t.csv", field)
    assert len(str(error.value)) < 300


@pytest.mark.parametrize(
    "text",
    [
        "node;x;name\n1;0,5;a\n2;1,5;b\n",
        "sep=;\nnode;x;name\r\n1;,5;a\r\n2;15,e-1;b\r\n",
        'node\tx\tname\n1\t0.5\t"a"\n2\t1.5\tb\n',
        "# first; second\n\n;;\nnode;x;name\n1;0.5;a\n2;1.5;b\n",
    ],
)
def test_cells_between_semicolons_or_tabs(tmp_path, text):
    table = read(tmp_path, text)
    assert table.numbers("x").tolist() == [0.5, 1.5] and table.cells["name"] == ["a", "b"]


def test_comments_of_spreadsheets_are_comments(tmp_path):
    for line in ('"# units: mm, t";;', "# units: mm; t;;", "# units: mm t"):
        assert read(tmp_path, line + "\nnode;x\n1;2\n").units == ("mm", "t")
    assert read(tmp_path, "# units: in, lbf s2/in\nnode,x\n1,2\n").units == ("in", "lbf s2/in")


def test_optional_columns_that_are_blank_are_not_there(tmp_path):
    assert list(read(tmp_path, HEADER + "1,2,\n2,3, \n").cells) == ["node", "x"]
    assert read(tmp_path, HEADER + "1,2,\n2,3,b\n").cells["name"] == ["", "b"]


REMEDIES = {
    "": "is blank, must be a number",
    "nan": "must be a finite number. Use a point as decimal mark",
    "inf": "must be a finite number",
    "-1e999": "must be a finite number",
    "two": "must be a finite number",
    "1;5": "must be a finite number",
    "1.000.0": "may have a mark for thousands",
}


@pytest.mark.parametrize("cell", REMEDIES)
def test_what_is_no_number_is_named_with_its_line(tmp_path, cell):
    table = read(tmp_path, HEADER + f"1,2,a\n# one\n2,{cell},b\n")
    with pytest.raises(rb.InputError) as error:
        table.numbers("x")
    assert (error.value.source, error.value.field, error.value.value) == (
        "t.csv",
        "line 4: x",
        cell,
    )
    assert REMEDIES[cell] in str(error.value)


def test_a_label_that_is_given_twice_is_named_with_both_lines(tmp_path):
    with pytest.raises(rb.InputError, match="t.csv: node = '7': is given twice, in lines 2 and 5"):
        read(tmp_path, HEADER + "7,2,a\n8,2,a\n\n7.0,1,b\n").unique_labels("node")


def test_a_header_alone_will_do_where_it_may(tmp_path):
    assert read(tmp_path, HEADER, may_be_empty=True).cells == {"node": [], "x": [], "name": []}


def test_a_file_that_is_not_there_or_cannot_be_read(tmp_path):
    with pytest.raises(
        rb.InputError, match="path = 'no.csv': no such file. A path in a deck file is relative"
    ):
        read_columns(tmp_path / "no.csv", ["node"])
    with pytest.raises(rb.InputError, match="must be a regular file, not a folder"):
        read_columns(tmp_path, ["node"])
    (tmp_path / "t.csv").write_bytes("knoten,länge\n".encode("latin-1"))
    with pytest.raises(rb.InputError, match="path = 't.csv': is not text. Save it as UTF-8 text"):
        read_columns(tmp_path / "t.csv", ["node"])


@given(blob=st.binary(max_size=300))
def test_binary_rubbish_is_refused_in_words(tmp_path_factory, blob):
    path = tmp_path_factory.mktemp("rubbish") / "t.csv"
    for content in (blob, HEADER.encode() + b'1,2,"' + blob):
        path.write_bytes(content)
        try:
            table = read_columns(path, ["node", "x"], ["name"])
        except rb.InputError as error:
            assert "t.csv" in str(error)
        else:
            assert {len(column) for column in table.cells.values()} == {len(table.lines)}


def test_units_in_the_header_are_read_where_they_may_stand(tmp_path):
    path = tmp_path / "u.csv"
    for header in ("x (mm),note,y [kN s/m]", "x(mm);note;y [ kN s/m ]"):
        separator = ";" if ";" in header else ","
        text = "# source: a, b c\n" + header + "\n" + separator.join(["1", "", "2"]) + "\n"
        path.write_text(text, encoding="utf-8")
        table = read_columns(path, ["x"], ["y", "note"], units_in_header=True)
        assert table.column_units == {"x": "mm", "y": "kN s/m"} and table.cells["y"] == ["2"]
        assert table.notes == {"source": "a, b c"} and table.remarks == {"source": ("a", "b c")}
        with pytest.raises(rb.InputError, match=r"^u\.csv: "):
            read_columns(path, ["x"], ["y", "note"])
    path.write_text("x (mm);y (N)\n1,5;2\n", encoding="utf-8")
    table = read_columns(path, ["x"], ["y"], units_in_header=True)
    assert table.numbers("x").tolist() == [1.5]
    path.write_text("x (mm),x (m)\n1,2\n", encoding="utf-8")
    with pytest.raises(rb.InputError, match="column x: appears more than once"):
        read_columns(path, ["x"], units_in_header=True)
