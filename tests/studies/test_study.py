"""A study carried out: each key once, what is known is not computed again, chunks by group."""

import numpy as np

from railbridge.studies.engine import Row
from railbridge.studies.store import MemoryStore
from railbridge.studies.study import Point, carry_out, chunked, remaining


def test_each_key_is_computed_once_and_refusals_never():
    computed, told = [], []

    def task(tasks):
        computed.append(list(tasks))
        return [Row(np.array([float(each)])) for each in tasks]

    points = [Point(str(i % 3), i % 3) for i in range(5)] + [Point("", refusal="why")]
    store = MemoryStore()
    options = {"chunk": 2, "progress": lambda *each: told.append(each)}
    found = carry_out(points, task, store, **options)
    assert computed == [[0, 1], [2]]
    assert told == [(0, 3), (2, 3), (3, 3)]
    assert [row.values[0] for row in found[:-1]] == [0.0, 1.0, 2.0, 0.0, 1.0]
    assert found[-1] == "why"
    assert remaining(points, store) == []
    carry_out([*points, Point("9", 9)], task, store, **options)
    assert computed[2:] == [[9]]
    assert told[3:] == [(3, 4), (4, 4)]


def test_points_of_a_group_stand_together():
    points = [Point(str(i), i, group=i % 2) for i in range(6)]
    found = [[point.task for point in own] for own in chunked(points, 2)]
    assert found == [[0, 2], [4], [1, 3], [5]]
