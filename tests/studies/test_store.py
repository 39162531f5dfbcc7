"""Finished rows on disk: found again, never half, never somebody else's."""

import json

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies.engine import Row
from railbridge.studies.store import BLOCK, MemoryStore, Store

COLUMNS = ["a", "b", "c"]


def key(i):
    return f"{i + 1:032x}"


def rows(numbers, message=""):
    return [Row(np.array([i, 2.0 * i, np.nan]), message) for i in numbers]


@pytest.mark.parametrize("kind", ["memory", "disk"])
def test_rows_come_back_as_they_were(kind, tmp_path):
    store = MemoryStore() if kind == "memory" else Store(tmp_path / "s.zarr", COLUMNS)
    store.add([key(0), key(1)], rows([0, 1]))
    store.add([key(2)], rows([2], "not converged: ü, Δ, 橋"))
    assert key(1) in store and key(7) not in store
    found = store.get([key(2), key(7), key(0), key(2)])
    assert found[1] is None
    assert np.array_equal(found[0].values, [2.0, 4.0, np.nan], equal_nan=True)
    assert found[0].message == found[3].message == "not converged: ü, Δ, 橋"
    assert found[2].message == ""


def test_another_program_goes_on_with_it(tmp_path):
    first = Store(tmp_path / "s.zarr", COLUMNS)
    for start in range(0, 300, 70):
        numbers = range(start, min(start + 70, 300))
        first.add([key(i) for i in numbers], rows(numbers))
    again = Store(tmp_path / "s.zarr", COLUMNS)
    assert len(again) == 300
    found = again.get([key(i) for i in range(300)])
    assert [row.values[0] for row in found] == list(range(300))
    again.add([key(300)], rows([300]))
    assert len(Store(tmp_path / "s.zarr", COLUMNS)) == 301


def test_a_chunk_never_touches_the_blocks_of_another(tmp_path):
    """What is written is finished: a program that dies later cannot spoil it."""
    store = Store(tmp_path / "s.zarr", COLUMNS)
    store.add([key(0)], rows([0]))
    before = {p: p.read_bytes() for p in (tmp_path / "s.zarr").rglob("c/*/*") if p.is_file()}
    store.add([key(i) for i in range(1, BLOCK)], rows(range(1, BLOCK)))
    assert before and all(p.read_bytes() == content for p, content in before.items())


def test_a_chunk_whose_fingerprints_are_missing_was_not_finished(tmp_path):
    store = Store(tmp_path / "s.zarr", COLUMNS)
    store.add([key(0)], rows([0]))
    store.add([key(1)], rows([1]))
    last = sorted(p for p in (tmp_path / "s.zarr/fingerprints").rglob("*") if p.is_file())
    newest = max((p for p in last if "c" in p.parts), key=lambda p: int(p.parts[-2]))
    newest.unlink()
    again = Store(tmp_path / "s.zarr", COLUMNS)
    assert key(0) in again and key(1) not in again
    again.add([key(1)], rows([1]))
    assert Store(tmp_path / "s.zarr", COLUMNS).get([key(1)])[0].values[0] == 1.0


@pytest.mark.parametrize("cut", [0, 1, 7])
def test_half_a_file_is_an_unfinished_chunk(tmp_path, cut):
    store = Store(tmp_path / "s.zarr", COLUMNS)
    store.add([key(0)], rows([0]))
    store.add([key(1)], rows([1]))
    files = [p for p in (tmp_path / "s.zarr/fingerprints").rglob("*") if p.is_file()]
    newest = max((p for p in files if "c" in p.parts), key=lambda p: int(p.parts[-2]))
    newest.write_bytes(newest.read_bytes()[:cut])
    again = Store(tmp_path / "s.zarr", COLUMNS)
    assert key(0) in again and key(1) not in again


@pytest.mark.parametrize("name", ["text", "empty", "json", "other"])
def test_what_is_no_study_is_left_alone(tmp_path, name):
    path = tmp_path / "s.zarr"
    if name == "text":
        path.write_text("hello", encoding="utf-8")
    else:
        path.mkdir()
    if name == "json":
        (path / "zarr.json").write_text("{", encoding="utf-8")
    if name == "other":
        import zarr

        zarr.open_group(path, mode="w").create_array("x", shape=(3,), dtype="f8")
    before = sorted(p.name for p in path.rglob("*")) if path.is_dir() else path.read_text()
    with pytest.raises(rb.InputError, match=r"--out.*no study.*another folder"):
        Store(path, COLUMNS)
    after = sorted(p.name for p in path.rglob("*")) if path.is_dir() else path.read_text()
    assert before == after


def test_other_columns_are_another_study(tmp_path):
    Store(tmp_path / "s.zarr", COLUMNS)
    with pytest.raises(rb.InputError, match="holds other quantities"):
        Store(tmp_path / "s.zarr", ["a", "b"])


def test_a_store_of_an_older_kind_is_refused(tmp_path):
    Store(tmp_path / "s.zarr", COLUMNS)
    meta = tmp_path / "s.zarr" / "zarr.json"
    content = json.loads(meta.read_text())
    content["attributes"]["format"] = "railbridge study 0"
    meta.write_text(json.dumps(content))
    with pytest.raises(rb.InputError, match="no study of this program"):
        Store(tmp_path / "s.zarr", COLUMNS)


def test_long_messages_are_cut_and_stay_readable(tmp_path):
    store = Store(tmp_path / "s.zarr", COLUMNS)
    store.add([key(0)], rows([0], "ü" * 1000))
    text = store.get([key(0)])[0].message
    assert set(text) == {"ü"} and 100 < len(text) <= 400
