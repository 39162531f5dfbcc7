"""Springs and anti-roll bars: what they may be, and what they do to a body by hand."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import AntiRollBar, Body, Spring, Vehicle

PLAIN = {"at": (0.0, 0.0, 1.0), "stiffness": (0.0, 1e6), "damping": (0.0, 1e4)}


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"longitudinal_stiffness": -1.0}, "longitudinal_stiffness = -1.0: must be a finite"),
        ({"longitudinal_damping": "much"}, "longitudinal_damping = 'much': must be a finite"),
        ({"series_stiffness": 1e6}, "series_stiffness = 1000000.0: must be a list of numbers"),
        ({"series_stiffness": (0.0, -1.0)}, "series_stiffness[2] = -1.0: must be a finite"),
        (
            {"series_stiffness": (1e6, 1e6)},
            "series_stiffness = [1000000.0, 1000000.0]: there is no damper in that direction",
        ),
    ],
)
def test_a_spring_names_the_part_that_cannot_be(changes, says):
    Spring("car", "bogie", **PLAIN)
    with pytest.raises(rb.InputError) as refused:
        Spring("car", "bogie", **PLAIN | changes)
    assert str(refused.value).startswith(says)


@pytest.mark.parametrize(
    "changes",
    [
        {"longitudinal_stiffness": 1e6},
        {"longitudinal_damping": 1e3},
        {"series_stiffness": (0.0, 1e6)},
    ],
)
@pytest.mark.parametrize("ends", [("car", "rail"), ("rail", "car")])
def test_a_contact_has_nothing_along_the_track_and_nothing_in_series(changes, ends):
    with pytest.raises(rb.InputError) as refused:
        Spring(*ends, **PLAIN | changes)
    assert refused.value.field == next(iter(changes)) and "at the rail" in str(refused.value)


def test_a_spring_along_the_track_alone_is_one():
    rod = Spring("car", "bogie", (0.0, 0.0, 1.0), (0.0, 0.0), (0.0, 0.0), 1e7)
    assert rod.stiffnesses == (0.0, 0.0, 1e7) and rod.straight_dampings == (0.0, 0.0, 0.0)
    with pytest.raises(rb.InputError, match="spring and damper are both zero"):
        Spring("car", "bogie", (0.0, 0.0, 1.0), (0.0, 0.0), (0.0, 0.0))


def test_dampers_act_straight_or_through_their_springs():
    spring = Spring(
        "car", "bogie", (0.0, 0.0, 1.0), (1e5, 1e6), (2e4, 3e4), 1e6, 4e4, (0.0, 5e6)
    )  # fmt: skip
    assert spring.straight_dampings == (2e4, 0.0, 4e4)
    assert spring.series == ((1, 5e6, 3e4),)


@pytest.mark.parametrize(
    ("ends", "values", "says"),
    [
        (("car", "car"), (1e6,), "to = 'car': must differ from the other end"),
        (("car", "rail"), (1e6,), "to = 'rail': must be a body"),
        (("rail", "car"), (1e6,), "from_ = 'rail': must be a body"),
        (("car", "bogie"), (0.0,), "stiffness = 0.0: must be a finite number above 0 N m/rad"),
        (("car", "bogie"), (1e6, -1.0), "damping = -1.0: must be a finite number at least 0"),
    ],
)
def test_an_anti_roll_bar_names_the_part_that_cannot_be(ends, values, says):
    with pytest.raises(rb.InputError) as refused:
        AntiRollBar(*ends, *values)
    assert str(refused.value).startswith(says)


def cart(bars=(), freedoms=("y", "z", "roll", "pitch", "yaw"), **more):
    """A body on four springs and a frame on four springs: roll by hand."""
    car = Body("car", 2e4, (3e4, 4e5, 4e5), (0.0, 0.0, 1.0), freedoms)
    frame = Body("frame", 4e3, (2e3, 4e3, 4e3), (0.0, 0.0, 1.0))
    springs = [
        Spring(
            lower, upper, (x, y, 1.0), (1e6, k), (1e4, 2e4), **(more if lower == "frame" else {})
        )
        for lower, upper, k in (("frame", "car", 1e6), ("rail", "frame", 4e6))
        for x in (3.0, -3.0)
        for y in (1.0, -1.0)
    ]
    return Vehicle("cart", (car, frame), tuple(springs), 10.0, anti_roll_bars=bars)


def test_the_roll_of_two_bodies_with_a_bar_by_hand():
    """All springs at the height of both centres, so roll is apart: [k1 -k1; -k1 k1+k2]."""
    bar = AntiRollBar("car", "frame", 2.5e6, 3e4)
    k1, k2 = 4 * 1e6 + 2.5e6, 4 * 4e6
    values = np.linalg.eigvals(np.array([[k1, -k1], [-k1, k1 + k2]]) / np.array([[3e4], [2e3]]))
    found = cart((bar,)).modes()
    for value in np.sqrt(values) / (2 * np.pi):
        assert np.min(np.abs(found.frequencies_hz - value)) < 1e-9 * value
    plain, turned = cart(), cart((AntiRollBar("frame", "car", 2.5e6, 3e4),))
    assert np.array_equal(turned.stiffness_matrix, cart((bar,)).stiffness_matrix)
    more = cart((bar,)).damping_matrix - plain.damping_matrix
    rolls = [plain.labels.index("car roll"), plain.labels.index("frame roll")]
    assert more[np.ix_(rolls, rolls)] == pytest.approx(np.array([[3e4, -3e4], [-3e4, 3e4]]))
    assert np.abs(more).sum() == pytest.approx(4 * 3e4)
    # Bounce and pitch know nothing of it.
    assert rb.planar_car(cart((bar,))).modes().frequencies_hz == pytest.approx(
        rb.planar_car(plain).modes().frequencies_hz
    )


def test_a_bar_joins_bodies_that_are_there_and_roll():
    with pytest.raises(rb.InputError, match=r"cart: anti_roll_bars\[1\]\.from = 'cra'.*'car'"):
        cart((AntiRollBar("cra", "frame", 1e6),))
    with pytest.raises(rb.InputError, match=r"anti_roll_bars\[1\]\.to = 'car': does not roll"):
        cart((AntiRollBar("frame", "car", 1e6),), freedoms=("z", "pitch"))
    with pytest.raises(rb.InputError, match=r"anti_roll_bars\[1\] = .*must be a AntiRollBar"):
        cart(("bar",))


def test_springs_along_the_track_couple_yaw_and_pitch_by_hand():
    """u_x = theta_y r_z - theta_z r_y: with r_z = 0 only yaw feels them, by y^2."""
    yaw_of = lambda car: [car.labels.index(f"{b} yaw") for b in ("car", "frame")]  # noqa: E731
    plain, held = cart(), cart(longitudinal_stiffness=3e5, longitudinal_damping=2e3)
    more = held.stiffness_matrix - plain.stiffness_matrix
    k = 4 * 3e5 * 1.0**2
    assert more[np.ix_(yaw_of(held), yaw_of(held))] == pytest.approx(np.array([[k, -k], [-k, k]]))
    assert np.abs(more).sum() == pytest.approx(4 * k)
    more = (held.damping_matrix - plain.damping_matrix)[np.ix_(yaw_of(held), yaw_of(held))]
    assert more == pytest.approx(np.array([[8e3, -8e3], [-8e3, 8e3]]))
    # A rod 0.4 m below one centre and 0.1 m above the other, on the middle line: only pitch.
    bodies = (
        Body("high", 1e4, (1e4, 2e4, 2e4), (0.0, 0.0, 1.4)),
        Body("low", 1e3, (1e3, 2e3, 2e3), (0.0, 0.0, 0.9)),
    )
    springs = [
        Spring(b, "rail", (x, y, 0.0), (1e6, 1e6), (0.0, 0.0))
        for b in ("high", "low")
        for x in (1.0, -1.0)
        for y in (0.7, -0.7)
    ]
    rod = Spring("low", "high", (0.3, 0.0, 1.0), (0.0, 0.0), (0.0, 0.0), 5e6)
    without, joined = (Vehicle("two", bodies, tuple(s)) for s in (springs, [*springs, rod]))
    more = joined.stiffness_matrix - without.stiffness_matrix
    i, j = (joined.labels.index(f"{b} pitch") for b in ("high", "low"))
    arms = np.zeros(len(joined.labels))
    arms[i], arms[j] = 1.0 - 1.4, -(1.0 - 0.9)
    assert more == pytest.approx(5e6 * np.outer(arms, arms), abs=1e-6)


def test_a_rod_off_the_middle_ties_pitch_to_yaw():
    """One rod at y = 0.5, 0.3 m above the centre: u_x = 0.3 theta_y - 0.5 theta_z."""
    car = Body("car", 1e4, (1e4, 2e4, 2e4), (0.0, 0.0, 1.0))
    post = Body("post", 1e4, (1e4, 2e4, 2e4), (0.0, 0.0, 1.3), ("z",))
    springs = [
        Spring(b, "rail", (x, y, 0.0), (1e6, 1e6), (0.0, 0.0))
        for b in ("car", "post")
        for x in (1.0, -1.0)
        for y in (0.7, -0.7)
    ]
    rod = Spring("post", "car", (0.0, 0.5, 1.3), (0.0, 0.0), (0.0, 0.0), 5e6)
    plain, held = (Vehicle("rod", (car, post), tuple(s)) for s in (springs, [*springs, rod]))
    arms = np.zeros(len(held.labels))
    arms[held.labels.index("car pitch")], arms[held.labels.index("car yaw")] = 0.3, -0.5
    more = held.stiffness_matrix - plain.stiffness_matrix
    assert more == pytest.approx(5e6 * np.outer(arms, arms), abs=1e-6)
