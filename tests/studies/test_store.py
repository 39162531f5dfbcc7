"""The store: finished rows come back bit for bit; damage makes a row one that is not there."""

import shutil

import numpy as np
import pytest

from railbridge.errors import InputError
from railbridge.studies.engine import Row
from railbridge.studies.fingerprints import fingerprint
from railbridge.studies.store import BLOCK, MemoryStore, Store

pytest.importorskip("zarr")

COLUMNS = ["a", "b"]
KEYS = [fingerprint(i) for i in range(BLOCK + 3)]
ROWS = [Row(np.array([(i + 1) / 3.0, -i * 1e-300])) for i in range(len(KEYS))]
for failed in (5, BLOCK + 1):
    ROWS[failed] = Row(np.full(2, np.nan), f"why {failed}")


@pytest.fixture
def path(tmp_path):
    store = Store(tmp_path / "points.zarr", COLUMNS)
    store.add(KEYS[:BLOCK], ROWS[:BLOCK])
    store.add(KEYS[BLOCK:], ROWS[BLOCK:])
    return store.path


def blocks(path, name):
    return sorted(p for p in (path / name).rglob("*") if p.is_file() and p.name != "zarr.json")


def test_rows_come_back_bit_for_bit_in_any_order(path):
    found = Store(path, COLUMNS).get([KEYS[65], fingerprint("no"), KEYS[1]])
    assert found[1] is None
    for i, row in ((65, found[0]), (1, found[2])):
        assert row.values.tobytes() == ROWS[i].values.tobytes()
        assert row.message == ROWS[i].message


@pytest.mark.parametrize("text", ["ä" * 500, "x" * 400, "", "\udcff lone", "zero\0 inside"])
def test_messages_are_kept_the_same_on_disk_and_in_memory(tmp_path, text):
    disk, memory = Store(tmp_path / "s", COLUMNS), MemoryStore()
    for store in (disk, memory):
        store.add([KEYS[0]], [Row(np.full(2, np.nan), text)])
    one, two = (store.get([KEYS[0]])[0].message for store in (Store(disk.path, COLUMNS), memory))
    assert one == two
    assert len(one.encode()) <= 400
    assert one.endswith(" ...") == (len(text) > 400)


@pytest.mark.parametrize("name", ["values", "messages", "fingerprints"])
@pytest.mark.parametrize("how", ["gone", "cut", "empty", "other"])
def test_a_damaged_block_is_computed_again_and_not_believed(path, name, how):
    own = blocks(path, name)[0]
    data = own.read_bytes()
    if how == "gone":
        own.unlink()
    elif how == "other":
        shutil.copy(blocks(path, name)[1], own)
    else:
        own.write_bytes(data[: len(data) // 2] if how == "cut" else b"")
    store = Store(path, COLUMNS)
    assert len(store) < len(KEYS)
    lost = [i for i, key in enumerate(KEYS) if key not in store]
    store.add([KEYS[i] for i in lost], [ROWS[i] for i in lost])
    for found, row in zip(Store(path, COLUMNS).get(KEYS), ROWS, strict=True):
        assert (found.values.tobytes(), found.message) == (row.values.tobytes(), row.message)


def test_a_stop_between_two_arrays_leaves_no_row(path):
    store = Store(path, COLUMNS)
    store._group["values"].resize((5 * BLOCK, 2))  # values written, fingerprints not
    store._group["values"][2 * BLOCK :] = 7.0
    again = Store(path, COLUMNS)
    assert len(again) == len(KEYS)
    again.add([fingerprint("new")], [Row(np.array([1.0, 2.0]))])
    assert Store(path, COLUMNS).get([fingerprint("new")])[0].values.tolist() == [1.0, 2.0]


def test_what_is_no_study_is_refused_and_left_alone(tmp_path, path):
    import zarr

    with pytest.raises(InputError, match="other quantities"):
        Store(path, ["a", "c"])
    zarr.open_group(tmp_path / "foreign", mode="w")
    (tmp_path / "file").write_text("mine")
    (tmp_path / "folder").mkdir()
    (path / "values" / "zarr.json").write_text("{")
    for name in ("foreign", "file", "folder", path.name):
        with pytest.raises(InputError, match="is no study"):
            Store(tmp_path / name, COLUMNS)
    assert (tmp_path / "file").read_text() == "mine"
