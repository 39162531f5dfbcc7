"""A study carried out: what is known already is looked up, the rest is computed chunk by chunk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..errors import InputError
from .chunks import completed, split
from .engine import Row
from .store import MemoryStore, Store

__all__ = ["CHUNK", "CHUNK_OF_LOADS", "Point", "carry_out", "chunked", "remaining"]

CHUNK = 64
"""Points of a chunk, if nothing else is asked for: of cars, each some hundredths of a second."""
CHUNK_OF_LOADS = 1024
"""The same of constant loads, each half a thousandth."""


@dataclass(frozen=True, eq=False)
class Point:
    """One crossing of a study.

    Attributes
    ----------
    key : str
        Fingerprint of what it depends on; empty where it was refused.
    task : object
        What the task of a chunk needs to compute it.
    refusal : str
        Why it cannot be computed.
    group : str or number
        Points of one group are computed together as far as may be.
    """

    key: str
    task: Any = None
    refusal: str = ""
    group: Any = ""


def remaining(points: Sequence[Point], store: Store | MemoryStore) -> list[Point]:
    """Return the points that are still to be computed, each key once."""
    left: dict[str, Point] = {}
    for point in points:
        if not point.refusal and point.key not in store:
            left.setdefault(point.key, point)
    return list(left.values())


def chunked(left: Sequence[Point], size: int) -> list[list[Point]]:
    """Return points in chunks, in the order in which they are computed."""
    by_group: dict[Any, list[Point]] = {}
    for point in left:
        by_group.setdefault(point.group, []).append(point)
    return [
        [group[i] for i in own] for group in by_group.values() for own in split(len(group), size)
    ]


def carry_out(
    points: Sequence[Point],
    task: Callable[[list[Any]], list[Row]],
    store: Store | MemoryStore,
    *,
    chunk: int = CHUNK,
    workers: int = 1,
    client: Any = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[Row | str]:
    """Compute what is missing, keep it as it comes, and return all.

    Parameters
    ----------
    points : sequence of Point
    task : callable
        From the tasks of a chunk's points to their rows; must be picklable for several processes.
    store : Store or MemoryStore
    chunk : int
        Points of a chunk: what is lost at most when the program is stopped.
    workers, client
        See `chunks.completed`.
    progress : function of (done, of how many), optional
        Points, those known before counted.

    Returns
    -------
    list of Row, or of a text where a point was refused
    """
    if not isinstance(store, (Store, MemoryStore)):
        raise InputError(
            "store", store, "must be a Store", "Make one with railbridge.studies.Store"
        )
    if progress is not None and not callable(progress):
        allowed = "must be a function of two numbers, done and of how many"
        raise InputError("progress", progress, allowed)
    left = remaining(points, store)
    chunks = chunked(left, chunk)
    known = len({point.key for point in points if not point.refusal}) - len(left)
    done, total = known, known + len(left)
    if progress is not None:
        progress(done, total)
    found = completed(
        task, [[p.task for p in own] for own in chunks], workers=workers, client=client
    )
    for number, rows in found:
        store.add([point.key for point in chunks[number]], rows)
        done += len(rows)
        if progress is not None:
            progress(done, total)
    keys = [point.key for point in points if not point.refusal]
    rows = iter(store.get(keys))
    return [point.refusal or next(rows) for point in points]
