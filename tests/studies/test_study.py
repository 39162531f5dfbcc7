"""A study carried out: known points are looked up, the rest is computed."""

import numpy as np
import pytest

from railbridge.studies.engine import Row
from railbridge.studies.store import MemoryStore
from railbridge.studies.study import Point, carry_out, remaining


def points(numbers):
    return [Point(f"{i:032x}", i) for i in numbers]


def rows(tasks):
    return [Row(np.array([10.0 * i])) for i in tasks]


def test_rows_come_in_the_order_of_the_points_and_refusals_stay():
    wanted = [*points([3, 1]), Point("", refusal="too fast"), *points([2])]
    found = carry_out(wanted, rows, MemoryStore(), chunk=2)
    assert found[2] == "too fast"
    assert [row.values[0] for row in (found[0], found[1], found[3])] == [30.0, 10.0, 20.0]


def test_what_is_known_and_what_is_twice_is_computed_once():
    store, asked = MemoryStore(), []
    store.add([f"{1:032x}"], rows([1]))

    def task(tasks):
        asked.extend(tasks)
        return rows(tasks)

    found = carry_out(points([1, 2, 2, 3]), task, store)
    assert sorted(asked) == [2, 3] and [r.values[0] for r in found] == [10.0, 20.0, 20.0, 30.0]
    assert not remaining(points([1, 2, 3]), store)


def test_progress_counts_what_was_known():
    store, seen = MemoryStore(), []
    store.add([f"{1:032x}"], rows([1]))
    carry_out(
        points([1, 2, 3, 4]), rows, store, chunk=2, progress=lambda *numbers: seen.append(numbers)
    )
    assert seen == [(1, 4), (3, 4), (4, 4)]


def test_groups_are_computed_together():
    wanted = [Point(f"{i:032x}", i, group=i % 2) for i in range(6)]
    chunks = []
    carry_out(wanted, lambda tasks: chunks.append(tasks) or rows(tasks), MemoryStore(), chunk=10)
    assert chunks == [[0, 2, 4], [1, 3, 5]]


def test_what_was_computed_before_a_fault_is_kept():
    store = MemoryStore()

    def task(tasks):
        if 2 in tasks:
            raise KeyboardInterrupt
        return rows(tasks)

    with pytest.raises(KeyboardInterrupt):
        carry_out(points([0, 1, 2]), task, store, chunk=1)
    assert len(remaining(points([0, 1, 2]), store)) == 1
