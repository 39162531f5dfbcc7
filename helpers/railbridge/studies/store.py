"""Finished rows of a study on disk, found again by the fingerprint of what they depend on.

A Zarr store with three arrays along the points: values, messages, fingerprints. A chunk is written
into blocks of its own, fingerprints last: what a stopped program leaves is either a finished chunk
or nothing that is looked at. Rows are only ever added.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..errors import InputError
from .engine import Row

__all__ = ["BLOCK", "MemoryStore", "Store"]

BLOCK = 64
"""Rows that are written together."""
FORMAT = "railbridge study 1"
_MESSAGE = 400
"""Bytes of a message that are kept."""


class MemoryStore:
    """Finished rows of a study that is kept nowhere."""

    def __init__(self) -> None:
        self.rows: dict[str, Row] = {}

    def __contains__(self, key: str) -> bool:
        return key in self.rows

    def add(self, keys: Sequence[str], rows: Sequence[Row]) -> None:
        """Keep the rows of a chunk."""
        self.rows.update(zip(keys, rows, strict=True))

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
                ("fingerprints", 16, "u1"),
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
        prints = self._group["fingerprints"]
        places: dict[str, int] = {}
        for first in range(0, prints.shape[0], BLOCK):
            try:
                block = prints[first : first + BLOCK]
            except Exception:  # half a block, of a program that was stopped while it wrote
                continue
            for i, row in enumerate(block):
                if row.any():
                    places[row.tobytes().hex()] = first + i
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
            text = row.message.encode("utf-8")[:_MESSAGE]
            messages[i, : len(text)] = np.frombuffer(text, dtype=np.uint8)
        prints = np.array([list(bytes.fromhex(key)) for key in keys], dtype=np.uint8)
        for name, values in (
            ("values", np.array([row.values for row in rows])),
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


def _remove(path: Path) -> None:
    import shutil

    if path.exists():
        shutil.rmtree(path)
