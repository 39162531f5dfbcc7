"""Shapes along the deck, and the loads that travel over them."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import railbridge as rb
from railbridge import guideways
from railbridge.guideways import PiecewiseCubic

DECK = rb.deck("viaduct36")


@given(seed=st.integers(0, 999), at=st.floats(0.01, 9.99))
def test_piecewise_cubic_derivatives(seed, at):
    rng = np.random.default_rng(seed)
    edges = np.array([0.0, 2.0, 5.0, 10.0])
    function = PiecewiseCubic(edges, rng.normal(size=(3, 4, 2, 3)))
    h = 1e-4
    if np.min(np.abs(edges - at)) > 2 * h:
        x = np.array([at - h, at, at + h])
        f, f1, f2 = (function(x, d) for d in range(3))
        assert (f[2] - f[0]) / (2 * h) == pytest.approx(f1[1], abs=1e-6)
        assert (f[2] - 2 * f[1] + f[0]) / h**2 == pytest.approx(f2[1], abs=1e-4)
    assert not function(np.array([-0.1, 10.1])).any()


@given(
    speed=st.floats(5.0, 90.0),
    delays=st.lists(st.floats(0.0, 60.0), min_size=1, max_size=4),
    couples=st.booleans(),
    seed=st.integers(0, 99),
)
def test_modal_forces_and_motions_of_stations_are_those_of_the_shapes(speed, delays, couples, seed):
    """Against the shapes themselves, at the place of each load, one sample after the other.

    Not where a load stands on the end of an element: the twist's slope breaks there, and rounding
    decides which of both slopes is taken.
    """
    rng, step, samples = np.random.default_rng(seed), 5e-3, 400
    delays = np.array(delays)
    stations = DECK.stations(delays, speed, step, samples)
    loads = [rng.normal(size=(5 if couples else 3, count)) for count in stations.counts]
    modal = stations.modal_force(loads, DECK.coordinates, samples)
    q, velocity = rng.normal(size=(2, DECK.coordinates, samples))
    state = stations.ordered(q, velocity)
    k = int(rng.integers(0, samples))
    places = speed * k * step - delays
    assume(np.abs(places[:, None] - DECK.shapes.edges).min() > 1e-9)
    expected = np.zeros(DECK.coordinates)
    for group in stations.alike(np.arange(len(delays))):
        moved, rate = stations.motion(state, group)
        for place, s in enumerate(group):
            here = k - stations.starts[s]
            if not 0 <= here < stations.counts[s]:
                continue
            x = np.array([speed * k * step - delays[s]])
            shape, slope = DECK.shapes(x)[0], DECK.shapes(x, 1)[0]
            load = loads[s][:, here]
            expected += shape @ load[:3]
            if couples:
                expected += slope[:, 0] * load[4] - slope[:, 1] * load[3]
            assert moved[:, place, here] == pytest.approx(q[:, k] @ shape, abs=1e-9)
            total = velocity[:, k] @ shape + speed * (q[:, k] @ slope)
            assert rate[:, place, here] == pytest.approx(total, abs=1e-9 * speed)
    assert modal[:, k] == pytest.approx(expected, abs=1e-9)


def test_a_track_by_its_name_is_its_distance():
    assert DECK.track_offset("right") == -2.4
    assert DECK.track_offset(1.5) == 1.5
    with pytest.raises(rb.InputError, match=r"^track_offset = 'rigth'.*right"):
        DECK.track_offset("rigth")


def test_windows_never_describe_more_than_they_hold(monkeypatch):
    """A view of more than 2^31 bytes stops a 32-bit Python, even if nothing of it is made."""
    largest = []

    def watched(values, shape, strides, writeable):
        largest.append(int(np.prod([int(n) for n in shape])) * values.itemsize)
        return np.lib.stride_tricks.as_strided(values, shape, strides, writeable=writeable)

    monkeypatch.setattr(guideways, "as_strided", watched)
    values = np.arange(3 * 50.0).reshape(3, 50)
    for starts in ([0, 10, 20], [4], [0, 7, 9], [30, 45]):
        windows = guideways._windows(values, np.array(starts), 12)
        padded = np.pad(values, ((0, 0), (0, 20)))
        assert np.array_equal(windows, np.stack([padded[:, s : s + 12] for s in starts], axis=1))
    assert max(largest) == 3 * 3 * 12 * 8
    # A long train on a long deck: many windows of many samples, described a few at a time.
    monkeypatch.setattr(guideways, "_LARGEST", 200_000)
    largest.clear()
    train = rb.Train(rb.vehicle("xia2000"), cars=12, car_spacing=22.5)
    run = rb.cross(train, DECK, speed=30.0, iterations=1, time_step=3e-3)
    assert largest and max(largest) <= 200_000
    monkeypatch.undo()
    whole = rb.cross(train, DECK, speed=30.0, iterations=1, time_step=3e-3)
    assert np.array_equal(run.wheel_forces, whole.wheel_forces)


def test_a_function_is_the_same_between_more_edges():
    rng = np.random.default_rng(5)
    function = PiecewiseCubic(np.array([0.0, 2.0, 5.0, 10.0]), rng.normal(size=(3, 4, 2, 3)))
    finer = function.cut(np.array([0.0, 0.7, 2.0, 3.0, 3.5, 5.0, 10.0]))
    x = np.concatenate([rng.uniform(0.0, 10.0, 50), [0.0, 2.0, 3.0, 10.0]])
    for derivative in (0, 1, 2):
        assert finer(x, derivative) == pytest.approx(function(x, derivative), rel=1e-9, abs=1e-9)
