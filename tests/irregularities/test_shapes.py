"""Dips, joints and welds: closed forms, slopes by differences, the force below a massless wheel."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.trains import Passage

SHAPES = [
    rb.Dip(3e-3, 1.0, at=5.0),
    rb.Dip(-1e-3, 2.0, at=-3.0, spacing=18.0, count=3),
    rb.Joint(0.01, 2.0, at=1.0, spacing=12.5),
    rb.Joint(0.02, 1.2, at=0.0, spacing=1.2, count=4),
    rb.Weld(5e-4, short_depth=1.5e-4, at=2.0, spacing=25.0),
    rb.Weld(-3e-4, 0.8, 1e-4, 0.05),
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
def test_the_slope_is_that_of_the_value(shape):
    x = np.random.default_rng(0).uniform(-40.0, 60.0, 4000)
    h = 1e-6
    central = (shape.value(x + h) - shape.value(x - h)) / (2 * h)
    near = np.abs(shape._from_middle(x)) < 2 * h  # the cusp of a joint
    near |= np.abs(np.abs(shape._from_middle(x)) - shape.length / 2) < 2 * h
    assert shape.slope(x)[~near] == pytest.approx(central[~near], abs=1e-8)
    assert np.abs(shape.slope(x)).max() > 1e-4


def test_a_dip_lowers_the_wheel_by_its_depth_and_ends_level():
    dip = rb.Dip(3e-3, 1.0, at=5.0)
    assert dip.value(np.array([4.4, 4.5, 4.75, 5.0, 5.25, 5.5, 9.0])) == pytest.approx(
        [0.0, 0.0, -1.5e-3, -3e-3, -1.5e-3, 0.0, 0.0], abs=1e-18
    )
    assert dip.slope(np.array([4.5, 4.75, 5.0, 5.25, 5.5])) == pytest.approx(
        [0.0, -3e-3 * np.pi, 0.0, 3e-3 * np.pi, 0.0], abs=1e-12
    )
    assert (dip.shortest, rb.Dip(0.0, 1.0).shortest) == (1.0, np.inf)


def test_the_slope_of_a_joint_jumps_by_its_angle():
    joint = rb.Joint(0.01, 2.0, at=1.0)
    assert joint.depth == pytest.approx(2.5e-3)
    assert joint.value(np.array([0.0, 0.5, 1.0, 1.5, 2.0])) == pytest.approx(
        [0.0, -2.5e-3 / 4, -2.5e-3, -2.5e-3 / 4, 0.0], abs=1e-18
    )
    before, after = joint.slope(np.array([1.0 - 1e-12, 1.0]))
    assert after - before == pytest.approx(0.01) and after == pytest.approx(0.005)
    assert joint.slope(np.array([0.0, 2.0, -5.0])) == pytest.approx(0.0, abs=1e-15)
    assert (joint.shortest, rb.Joint(0.0, 2.0).shortest) == (1.0, np.inf)


def test_a_weld_is_a_long_dip_and_a_short_one():
    weld = rb.Weld(5e-4, 1.0, 1.5e-4, 0.1, at=2.0)
    x = np.linspace(1.0, 3.0, 401)
    parts = rb.Dip(5e-4, 1.0, at=2.0).value(x) + rb.Dip(1.5e-4, 0.1, at=2.0).value(x)
    assert weld.value(x) == pytest.approx(parts, abs=1e-18)
    assert weld.value(np.array([2.0])) == pytest.approx(-6.5e-4)
    assert (weld.shortest, rb.Weld(5e-4).shortest, rb.Weld(0.0).shortest) == (0.1, 1.0, np.inf)


def test_faults_stand_as_often_as_said():
    at = -3.0 + 18.0 * np.arange(-2, 6)
    three = rb.Dip(1e-3, 2.0, at=-3.0, spacing=18.0, count=3).value(at)
    assert three == pytest.approx(np.where((at >= -3.0) & (at <= 33.0), -1e-3, 0.0), abs=1e-15)
    assert rb.Dip(1e-3, 2.0, at=-3.0, spacing=18.0).value(at) == pytest.approx(-1e-3)
    assert rb.Dip(1e-3, 2.0, at=-3.0, spacing=18.0).value(at + 9.0) == pytest.approx(0.0, abs=0)
    once = rb.Dip(1e-3, 2.0, at=-3.0, count=1).value(at)
    assert once == pytest.approx(np.where(at == -3.0, -1e-3, 0.0), abs=1e-15)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: rb.Dip(3.0, 1.0), "depth = 3.0: must be .* at most 0.1 m. Give it in m"),
        (lambda: rb.Dip(1e-3, 0.0), "length = 0.0: must be .* above 0 m"),
        (lambda: rb.Dip(1e-3, 1.0, count=2), "spacing: is missing, count is 2"),
        (lambda: rb.Dip(1e-3, 1.0, spacing=0.9), "spacing = 0.9: must be .* at least 1 m"),
        (lambda: rb.Dip(1e-3, 1.0, spacing=2.0, count=1.5), "count = 1.5: must be a whole"),
        (lambda: rb.Joint(10.0, 1.0), "angle = 10.0: .* at most 0.2 rad. Give it in rad"),
        (lambda: rb.Joint(-0.01, 1.0), "angle = -0.01: .* at least 0"),
        (lambda: rb.Weld(1e-3, 0.05), "short_length = 0.1: .* at most 0.05 m"),
    ],
)
def test_what_cannot_be_is_refused(make, words):
    with pytest.raises(rb.InputError, match=words):
        make()


@pytest.mark.parametrize("shape", SHAPES[:3], ids=lambda shape: type(shape).__name__)
def test_the_force_of_a_massless_wheel_below_an_endless_mass(shape):
    # A mass so heavy that it stays where it is: the wheel force is k r + c V r'.
    k, c, speed, h = 2e6, 3e4, 20.0, 1e-3
    body = rb.Body("mass", 1e12, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    spring = rb.Spring("rail", "mass", (0.0, 0.0, 0.0), (0.0, k), (0.0, c))
    train = rb.Train(rb.Vehicle("heavy", (body,), (spring,), 2.0))
    passage = Passage(speed, h, 3000, 40.0)
    force = train.rigid_forces(rb.Track(vertical=shape), passage)[0][0, 1]
    x = speed * h * np.arange(3000)
    expected = -(k * shape.value(x) + c * speed * shape.slope(x))
    assert np.abs(expected).max() > 500.0
    assert force == pytest.approx(expected, abs=1e-3 * np.abs(expected).max())


def test_a_joint_on_a_bridge_asks_for_a_step_that_meets_it():
    train = rb.Train(rb.vehicle("xia2000_planar"))
    track = rb.Track(vertical=rb.Joint(0.01, 1.0, at=18.0))
    run = rb.cross(train, rb.deck("viaduct36"), track, speed=20.0)
    assert 20.0 * run.settings.time_step <= 0.5 / 20 * (1 + 1e-9)
    with pytest.raises(rb.InputError, match="time_step = 0.01: leaves fewer than 10 samples"):
        rb.cross(train, rb.deck("viaduct36"), track, speed=20.0, time_step=0.01)
