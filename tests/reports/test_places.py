"""Reports are written whole, and never over somebody else's file."""

import os

import pytest

from railbridge.errors import InputError
from railbridge.reports.places import refuse_foreign, written

OURS = b'<!DOCTYPE html>\n<head>\n<meta name="generator" content="railbridge report">'


def test_a_new_file_and_one_of_ours_will_do(tmp_path):
    place = tmp_path / "new.html"
    assert refuse_foreign("--out", str(place), ".html") == place
    place.write_bytes(OURS)
    assert refuse_foreign("--out", place, ".html") == place
    assert refuse_foreign("--out", tmp_path / "A.HTML", ".html").name == "A.HTML"


@pytest.mark.parametrize(
    "content",
    [b"", b"<html></html>", b"railbridge report", b" " * 1000 + OURS, b"\xff\xfe\x00" * 500],
)
def test_a_file_of_somebody_else_is_refused(tmp_path, content):
    place = tmp_path / "page.html"
    place.write_bytes(content)
    with pytest.raises(InputError, match=r"--out.*is no report of railbridge.*--force"):
        refuse_foreign("--out", place, ".html")
    assert refuse_foreign("--out", place, ".html", force=True) == place
    assert place.read_bytes() == content


def test_no_other_zip_passes_for_a_workbook(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    place = tmp_path / "book.xlsx"
    book = openpyxl.Workbook()
    book.properties.creator = "somebody"
    book.save(place)
    with pytest.raises(InputError, match="is no report of railbridge"):
        refuse_foreign("--excel", place, ".xlsx")
    place.write_bytes(b"PK\x03\x04 no zip at all")
    with pytest.raises(InputError, match="is no report of railbridge"):
        refuse_foreign("--excel", place, ".xlsx")
    book.properties.creator = "railbridge report"
    book.save(place)
    assert refuse_foreign("--excel", place, ".xlsx") == place


@pytest.mark.parametrize("name", ["page.htm", "page", "", "   ", "page.html.txt"])
def test_another_ending_is_refused(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=r"ends? in \.html"):
        refuse_foreign("--out", name, ".html")


def test_a_folder_and_a_broken_link_are_refused(tmp_path):
    (tmp_path / "folder.html").mkdir()
    with pytest.raises(InputError, match="is a folder"):
        refuse_foreign("--out", tmp_path / "folder.html", ".html")
    link = tmp_path / "link.html"
    link.symlink_to(tmp_path / "nowhere")
    with pytest.raises(InputError, match="cannot be written to"):
        refuse_foreign("--out", link, ".html")


def test_a_name_that_no_system_has_is_refused():
    with pytest.raises(InputError, match="cannot be written to"):
        refuse_foreign("--out", "a" * 300 + ".html", ".html")


def test_what_is_written_is_whole_and_leaves_nothing_beside(tmp_path):
    place = tmp_path / "a" / "b" / "page.html"
    assert written("--out", place, b"one") == place
    assert written("--out", place, b"two") == place
    assert place.read_bytes() == b"two"
    assert os.listdir(place.parent) == ["page.html"]


def test_what_cannot_be_written_leaves_all_as_it_was(tmp_path, monkeypatch):
    place = tmp_path / "page.html"
    place.write_bytes(b"before")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.replace", full)
    with pytest.raises(InputError, match="--out.*No space left"):
        written("--out", place, b"after")
    with pytest.raises(InputError, match="--out.*No space left"):
        written("--out", tmp_path / "new" / "page.html", b"after")
    assert place.read_bytes() == b"before"
    assert os.listdir(tmp_path) == ["page.html"]


def test_a_file_in_the_way_of_a_folder_is_told_of(tmp_path):
    (tmp_path / "file").write_text("x", encoding="utf-8")
    with pytest.raises(InputError, match="cannot be written to"):
        written("--out", tmp_path / "file" / "page.html", b"x")
