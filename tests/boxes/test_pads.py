"""Pads: means over linear fields, what is eliminated, and rigid bodies that stay free."""

import numpy as np
import pytest

from railbridge.boxes.pads import Pad, elimination, free_motion_count, support_rows

STATIONS = np.array([0.0, 0.5, 1.2, 2.0, 3.0])
POINTS = 2  # of the section
SIZE = 6 * POINTS * len(STATIONS)


def field(function, freedom, point=1):
    """A displacement of one point of the section along the deck; all else is zero."""
    moved = np.zeros((len(STATIONS), POINTS, 6))
    moved[:, point, freedom] = function(STATIONS)
    return moved.ravel()


@pytest.mark.parametrize(
    ("x", "length"), [(1.0, 0.3), (1.0, 1.5), (2.0, 0.6), (0.1, 0.6), (3.0, 1.0)]
)
def test_a_pad_holds_the_mean_over_its_length_on_the_deck(x, length):
    """Of a linear field that is its value at the middle of what lies under the deck."""
    (row, stiffness), *_ = support_rows([Pad(x, length, 1, fixed=("z",))], STATIONS, POINTS, SIZE)
    a, b = max(x - length / 2, 0.0), min(x + length / 2, 3.0)
    assert np.isinf(stiffness)
    assert (row @ field(lambda s: 2.0 + 3.0 * s, 2))[0] == pytest.approx(2.0 + 1.5 * (a + b))
    assert (row @ field(lambda s: 2.0 + 3.0 * s, 2, point=0))[0] == 0.0


def test_a_pad_below_the_point_moves_as_the_foot_turns():
    """w = c x turns the foot by -c about y, so a point `arm` below it moves along x by c arm; roll
    moves it along y."""
    (along, first), (across, second) = support_rows(
        [Pad(1.0, 1.5, 1, 0.4, ("y",), {"x": 5e6})], STATIONS, POINTS, SIZE
    )
    assert (first, second) == (5e6, np.inf)
    assert (along @ field(lambda s: 0.01 * s, 2))[0] == pytest.approx(0.01 * 0.4)
    assert (across @ field(lambda s: 0.02 + 0.0 * s, 3))[0] == pytest.approx(0.02 * 0.4)


def test_what_is_left_keeps_every_condition():
    """Overlapping pads: any motion of the freedoms that are left satisfies all rows, and none but
    the conditions is lost."""
    rows = support_rows(
        [Pad(1.0, 1.5, 1), Pad(1.4, 1.5, 1), Pad(2.0, 0.1, 0, 0.3, ("x", "z"))],
        STATIONS,
        POINTS,
        SIZE,
    )
    turn, left = elimination(rows, SIZE)
    assert turn.shape == (SIZE, SIZE - 4) and np.linalg.matrix_rank(turn.toarray()) == SIZE - 4
    assert np.abs(np.vstack([(row @ turn).toarray() for row, _ in rows])).max() < 1e-14
    assert np.array_equal(turn[left].toarray(), np.eye(SIZE - 4))


def test_springs_eliminate_nothing():
    turn, left = elimination(
        support_rows([Pad(1.0, 0.5, 1, fixed=(), stiffness={"z": 1e8})], STATIONS, POINTS, SIZE),
        SIZE,
    )
    assert np.array_equal(turn.toarray(), np.eye(SIZE)) and left.tolist() == list(range(SIZE))


def test_ways_to_move_are_counted():
    """None held: six. Two pads that hold z under one web: heave and pitch are held, four remain."""
    nodes = np.array([(x, y, 0.0) for x in STATIONS for y in (1.0, -1.0)])
    ends = [0.25, 2.75]
    for pads, free in (
        ([], 6),
        ([Pad(x, 0.5, 1) for x in ends], 4),
        ([Pad(x, 0.5, p, 0.0, ("y", "z")) for x in ends for p in (0, 1)], 1),
        ([Pad(x, 0.5, p, 0.0, ("x", "y", "z")) for x in ends for p in (0, 1)], 0),
    ):
        assert free_motion_count(support_rows(pads, STATIONS, POINTS, SIZE), nodes, 3.0) == free
