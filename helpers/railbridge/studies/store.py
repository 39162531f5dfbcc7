"""Finished rows of a study on disk, found again by the fingerprint of what they depend on.

A Zarr store with three arrays along the points: values, messages, fingerprints. A chunk is written
into blocks of its own, fingerprints last, each with a check of its row: what a stopped program
leaves, or a damaged disk, is either a finished row or none. Rows are only ever added.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..errors import InputError
from .engine import Row
from .extras import needed

__all__ = ["BLOCK", "MemoryStore", "Store"]

BLOCK = 64
"""Rows that are written together."""
FORMAT = "railbridge study 2"
_MESSAGE = 400
"""Bytes of a message that are kept."""
_KEY, _CHECK = 16, 8
"""Bytes of a fingerprint, and of the check of a row behind it."""


class MemoryStore:
    """Finished rows of a study that is kept nowhere."""

    def __init__(self) -> None:
        self.rows: dict[str, Row] = {}

    def __contains__(self, key: str) -> bool:
        return key in self.rows

    def add(self, keys: Sequence[str], rows: Sequence[Row]) -> None:
        """Keep the rows of a chunk."""
        short = [Row(row.values, _shortened(row.message)) for row in rows]
        self.rows.update(zip(keys, short, strict=True))

    def get(self, keys: Sequence[str]) -> list[Row | None]:
        """Return rows by key, None where there is none yet."""
        return [self.rows.get(key) for key in keys]


class Store:
    """Finished rows in a folder.

    Parameters
    ----------
    path : Path
        Of the Zarr store; made if it is not there.
    columns : sequence of str
        What the numbers of a row are.

    Raises
    ------
    InputError
        Something else stands there, it is damaged, or its rows are of other columns.
    """

    def __init__(self, path: Path, columns: Sequence[str]) -> None:
        needed("zarr")
        import zarr

        self.path = Path(path)
        if self.path.exists():
            self._group = self._opened(list(columns))
        else:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            # Made aside and moved: a store is whole or not there.
            aside = self.path.with_name(self.path.name + ".new")
            _remove(aside)
            group = zarr.open_group(aside, mode="w")
            group.attrs.update({"format": FORMAT, "columns": json.dumps(list(columns))})
            for name, width, kind in (
                ("values", len(columns), "f8"), ("messages", _MESSAGE, "u1"),
                ("fingerprints", _KEY + _CHECK, "u1"),
            ):  # fmt: skip
                group.create_array(
                    name, shape=(0, width), chunks=(BLOCK, max(width, 1)), dtype=kind
                )
            aside.rename(self.path)
            self._group = zarr.open_group(self.path, mode="r+")
        self._places = self._read_places()

    def _opened(self, columns: list[str]):
        import zarr

        remedy = "Choose another folder, or move this one away"
        try:
            group = zarr.open_group(self.path, mode="r+")
            found, own = group.attrs.get("format"), json.loads(group.attrs.get("columns", "[]"))
            _ = [group[name].shape for name in ("values", "messages", "fingerprints")]
        except Exception as error:  # whatever a foreign or damaged folder makes the reader say
            allowed = f"is no study that can be read ({type(error).__name__})"
            raise InputError("--out", str(self.path), allowed, remedy) from None
        if found != FORMAT:
            raise InputError("--out", str(self.path), "is no study of this program", remedy)
        if own != columns:
            allowed = "holds other quantities or places than are asked for now"
            raise InputError("--out", str(self.path), allowed, remedy)
        return group

    def _read_places(self) -> dict[str, int]:
        prints, values = self._group["fingerprints"], self._group["values"]
        messages = self._group["messages"]
        places: dict[str, int] = {}
        for first in range(0, prints.shape[0], BLOCK):
            try:
                some = slice(first, first + BLOCK)
                block, numbers, texts = prints[some], values[some], messages[some]
            except Exception:  # half a block, damaged or of a program stopped while it wrote
                continue
            for i, row in enumerate(block[: min(len(numbers), len(texts))]):
                # A block whose file is gone reads as zeros: the check finds that out, too.
                if row.any() and row[_KEY:].tobytes() == _check(numbers[i], texts[i]):
                    places[row[:_KEY].tobytes().hex()] = first + i
        return places

    def __contains__(self, key: str) -> bool:
        return key in self._places

    def __len__(self) -> int:
        return len(self._places)

    def add(self, keys: Sequence[str], rows: Sequence[Row]) -> None:
        """Write the rows of a chunk."""
        if not keys:
            return
        start = -(-self._group["fingerprints"].shape[0] // BLOCK) * BLOCK
        stop = start + len(keys)
        messages = np.zeros((len(keys), _MESSAGE), dtype=np.uint8)
        for i, row in enumerate(rows):
            text = _shortened(row.message).encode("utf-8")
            messages[i, : len(text)] = np.frombuffer(text, dtype=np.uint8)
        numbers = np.array([row.values for row in rows], dtype=float)
        checks = [_check(*each) for each in zip(numbers, messages, strict=True)]
        both = [bytes.fromhex(key) + check for key, check in zip(keys, checks, strict=True)]
        prints = np.array([list(each) for each in both], dtype=np.uint8)
        for name, values in (
            ("values", numbers),
            ("messages", messages),
            ("fingerprints", prints),
        ):
            array = self._group[name]
            array.resize((stop, array.shape[1]))
            array[start:stop] = values
        self._places |= {key: start + i for i, key in enumerate(keys)}

    def get(self, keys: Sequence[str]) -> list[Row | None]:
        """Return rows by key, None where there is none yet."""
        values, messages = self._group["values"], self._group["messages"]
        found: list[Row | None] = [None] * len(keys)
        places = [self._places.get(key, -1) for key in keys]
        blocks: dict[int, list[int]] = {}
        for i, place in enumerate(places):
            if place >= 0:
                blocks.setdefault(place // BLOCK, []).append(i)
        for block, own in blocks.items():
            some = slice(block * BLOCK, (block + 1) * BLOCK)
            numbers, texts = values[some], messages[some]
            for i in own:
                row = places[i] - block * BLOCK
                text = texts[row].tobytes().rstrip(b"\0").decode("utf-8", errors="ignore")
                found[i] = Row(numbers[row], text)
        return found


def _check(values: np.ndarray, message: np.ndarray) -> bytes:
    data = np.ascontiguousarray(values, dtype="<f8").tobytes() + message.tobytes()
    return hashlib.blake2b(data, digest_size=_CHECK).digest()


def _shortened(message: str) -> str:
    """Return a message of at most so many bytes; one that was cut says so by its end."""
    data = message.encode("utf-8", errors="backslashreplace")
    if len(data) > _MESSAGE:
        data = data[: _MESSAGE - 4]
        return data.decode("utf-8", errors="ignore") + " ..."
    return data.decode("utf-8")


def _remove(path: Path) -> None:
    import shutil

    if path.exists():
        shutil.rmtree(path)
