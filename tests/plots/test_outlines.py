"""Outlines are where the vehicle and the train say their parts are."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.plots.outlines import (
    VIEWS,
    WHEEL_RADIUS,
    Heights,
    VehicleOutline,
    drawn_length,
    is_long,
    mode_motion,
    train_outline,
    zigzag,
)

HEIGHTS = Heights(wheel=0.5, frame=1.0, floor=1.5, roof=4.0)


@pytest.fixture(scope="module")
def train():
    return rb.Train(rb.vehicle("xia2000"), 2, 22.5)


@pytest.fixture(scope="module")
def uneven():
    """A vehicle whose left and right wheels differ by rounding."""
    springs = [
        rb.Spring("body", "rail", (x, y, 0.5), (1e6, 2e6), (1e4, 2e4))
        for x, y in ((0.3, 0.8), (0.1 + 0.2, -0.8), (-3.0, 0.8), (-3.0, -0.8))
    ]
    body = rb.Body("body", 2e4, (1e4, 2e5, 2e5), (0.0, 0.0, 1.5))
    return rb.Vehicle("uneven", (body,), tuple(springs), 9.0)


def test_a_train_stands_behind_its_first_axle(train):
    outline = train_outline(train, 30.0)
    assert np.allclose(30.0 - outline.wheels, [0.0, 2.5, 15.6, 18.1, 22.5, 25.0, 38.1, 40.6])
    first, second = outline.cars
    assert np.allclose(second.ends, np.array(first.ends) - 22.5)
    assert np.mean(first.ends) == pytest.approx(30.0 - 9.05)
    front, rear = first.bogies
    assert np.allclose(np.unique(front), [27.5, 30.0]) and np.allclose(
        np.unique(rear), [11.9, 14.4]
    )


def test_bare_axle_loads_have_wheels_only():
    outline = train_outline(rb.AxleTrain([0.0, 5.0], [2e5, 1e5]), 1.0)
    assert outline.wheels.tolist() == [1.0, -4.0] and outline.cars == ()
    assert [len(x) for x, _ in outline.paths(HEIGHTS).values()] == [0, 0, 2]


def test_on_level_rails_all_parts_are_level(train):
    paths = train_outline(train).paths(HEIGHTS)
    assert np.all(paths["wheels"][1] == 0.5)
    assert set(paths["bogies"][1][np.isfinite(paths["bogies"][1])]) == {1.0}
    assert set(paths["cars"][1][np.isfinite(paths["cars"][1])]) == {1.5, 4.0}
    assert len(paths["cars"][0]) == 2 * 6 and len(paths["bogies"][0]) == 4 * 3


def test_on_a_slope_a_car_body_lies_as_its_bogies_do(train):
    paths = train_outline(train).paths(HEIGHTS, rail=lambda x: 0.1 * x)
    x, z = paths["wheels"]
    assert np.allclose(z, 0.1 * x + 0.5)
    x, z = (values.reshape(2, 6)[:, :5] for values in paths["cars"])
    assert np.allclose(z - 0.1 * x, [1.5, 1.5, 4.0, 4.0, 1.5])


def test_wheels_side_by_side_are_one_axle(uneven):
    outline = VehicleOutline(uneven)
    assert np.allclose(outline.wheels("side"), [-3.0, 0.3]) and outline.wheels("front") == [
        -0.8,
        0.8,
    ]
    assert len(train_outline(rb.Train(uneven, 3)).wheels) == 6
    texts = [text.get_text() for text in rb.plots.vehicle(uneven)[0].texts]
    assert "3.3 m" in texts
    run = rb.cross(rb.Train(uneven), rb.deck("viaduct36"), speed=20.0, time_step=4e-3)
    assert len(rb.plots.wheel_forces(run)) == 2


def test_a_vehicle_without_a_length_is_drawn_about_its_wheels():
    car = rb.vehicle("xia2000")
    bare = replace(car, length=None)
    assert drawn_length(car) == 22.5
    assert drawn_length(bare) == pytest.approx(2 * 9.05 + 2.0)
    assert is_long(bare)
    drawn = train_outline(rb.Train(bare, cars=2, car_spacing=22.5)).cars[0]
    assert drawn.ends[1] - drawn.ends[0] > 2 * 9.05
    rb.plots.vehicle(bare)


@pytest.mark.parametrize(("name", "scale"), [("xia2000", 0.65), ("sprung_mass", 0.35)])
@pytest.mark.parametrize("asked", [None, 0.2])
def test_the_largest_motion_of_a_mode_is_drawn_to_scale(name, scale, asked):
    car = rb.vehicle(name)
    outline = VehicleOutline(car)
    for mode in (1, len(car.modes().names)):
        modes, motion = mode_motion(car, mode, asked)
        size = []
        for body, box in outline.boxes.items():
            corners = np.concatenate([box.corners(plane) for plane in VIEWS.values()])
            size.append(np.linalg.norm(outline.moved(corners, body, motion) - corners, axis=1))
        assert max(map(np.max, size)) == pytest.approx(asked or scale)
        shape = dict(zip(modes.labels, modes.shapes[:, mode - 1], strict=True))
        body, freedom = max(shape, key=lambda label: abs(shape[label])).rsplit(" ", 1)
        leading = motion[body][["y", "z", "roll", "pitch", "yaw"].index(freedom)]
        assert leading > 0.0, "the mode is drawn the way its largest freedom counts"


def test_springs_stand_between_the_bodies_that_they_join():
    car = rb.vehicle("xia2000")
    outline = VehicleOutline(car)
    assert outline.levels == {"rail": 0, "front bogie": 1, "rear bogie": 1, "car": 2}
    _, motion = mode_motion(car, 1)
    for spring in car.springs:
        foot, head = outline.spring(spring, {})
        low, high = sorted((spring.from_, spring.to), key=outline.levels.get)
        above = outline.boxes[high]
        assert head[2] == pytest.approx(above.centre[2] - above.half[2]) and head[2] > foot[2]
        below = outline.boxes.get(low)
        ground = WHEEL_RADIUS if below is None else below.centre[2] + below.half[2]
        assert foot[2] == pytest.approx(ground)
        assert tuple(foot[:2]) == tuple(head[:2]) == tuple(spring.at[:2])
        # What moves takes its end of the spring with it; the rail stays.
        ends = outline.spring(spring, motion)
        assert ends[1] == pytest.approx(outline.moved(head[None], high, motion)[0])
        assert np.array_equal(ends[0], foot) == (low == "rail")
    for box in outline.boxes.values():
        assert np.all(np.abs(box.centre[:2]) + box.half[:2] <= outline.extent[:2] + 1e-12)
        assert box.centre[2] + box.half[2] <= outline.extent[2] + 1e-12


def test_a_zigzag_runs_from_end_to_end():
    foot, head = np.array([1.0, 2.0]), np.array([4.0, 6.0])
    line = zigzag(foot, head)
    assert line[0] == pytest.approx(foot) and line[-1] == pytest.approx(head)
    along = (line - foot) @ (head - foot) / 5.0
    across = (line - foot) @ np.array([-4.0, 3.0]) / 5.0
    assert np.all(np.diff(along) > 0.0) and along[-1] == pytest.approx(5.0)
    assert across.max() == pytest.approx(-across.min()) and across.max() > 0.0


@pytest.fixture(scope="module")
def shared():
    """Three coaches of 18 m on four bogies, on wheelsets with mass."""
    bodies, springs = [], []
    for i, x in enumerate((18.0, 0.0, -18.0), start=1):
        bodies.append(rb.Body(f"coach {i}", 24e3, (4e4, 6e5, 6e5), (x, 0.0, 1.8)))
    for i, x in enumerate((27.0, 9.0, -9.0, -27.0), start=1):
        bodies.append(rb.Body(f"bogie {i}", 3e3, (2e3, 4e3, 4e3), (x, 0.0, 0.6)))
        for y in (1.0, -1.0):
            for axle in (x + 1.2, x - 1.2):
                springs.append(
                    rb.Spring(f"bogie {i}", "rail", (axle, y, 0.0), (4e6, 1.2e6), (2e4, 2e4))
                )
            for coach in (i - 1, i):
                if 1 <= coach <= 3:
                    ends = f"coach {coach}", f"bogie {i}"
                    springs.append(rb.Spring(*ends, (x, y, 1.0), (3e5, 4e5), (2e4, 2e4)))
    plain = rb.Vehicle("articulated", tuple(bodies), tuple(springs), 57.0)
    return rb.with_wheelsets(plain, mass=1500.0, roll_inertia=900.0)


def test_coaches_that_share_bogies_stand_beside_each_other(shared):
    boxes = VehicleOutline(shared).boxes
    ends = [
        (boxes[f"coach {i}"].centre[0] - boxes[f"coach {i}"].half[0],
         boxes[f"coach {i}"].centre[0] + boxes[f"coach {i}"].half[0])
        for i in (1, 2, 3)
    ]  # fmt: skip
    for (rear, _), (_, front) in zip(ends[:-1], ends[1:], strict=True):
        assert 0.1 < rear - front < 0.5, "a gap, and no wide one"
    assert all(front - rear > 17.0 for rear, front in ends)
    # One body on bogies is as long as ever.
    assert VehicleOutline(rb.vehicle("xia2000")).boxes["car"].half[0] == pytest.approx(0.48 * 22.5)


def test_wheelsets_are_drawn_where_their_wheels_are(shared):
    outline, plain = VehicleOutline(shared), VehicleOutline(rb.vehicle("xia2000"))
    assert outline.levels["bogie 1 wheelset 1"] == 0 and outline.levels["bogie 1"] == 1
    for body in shared.wheelsets:
        box = outline.boxes[body.name]
        assert box.centre == pytest.approx([body.position[0], 0.0, WHEEL_RADIUS])
        assert box.half[1] == 0.75 and box.half[0] < WHEEL_RADIUS
    # All else stands as high as on massless wheels, and the stiff contacts are left out.
    assert outline.boxes["coach 1"].centre[2] == plain.boxes["car"].centre[2]
    assert len(outline.springs) == len(shared.springs) - 16
    foot, head = outline.spring(next(s for s in shared.springs if s.to == "bogie 1 wheelset 1"), {})
    assert foot[2] == WHEEL_RADIUS and head[2] > foot[2]


def test_a_train_of_coaches_has_each_of_them_and_every_bogie_once(shared):
    outline = train_outline(rb.Train(shared, 2))
    assert len(outline.cars) == 6 and len(outline.frames) == 8 and len(outline.wheels) == 16
    assert [len(car.bogies) for car in outline.cars] == [2] * 6
    middle = [np.mean([wheels.mean() for wheels in car.bogies]) for car in outline.cars]
    inside = [rear < x < front for (rear, front), x in zip(
        (car.ends for car in outline.cars), middle, strict=True)]  # fmt: skip
    assert all(inside) and np.all(np.diff(middle) < 0.0)
    # Each coach lies as its own bogies do.
    x, z = (v.reshape(6, 6)[:, :5] for v in outline.paths(HEIGHTS, lambda x: 1e-3 * x**2)["cars"])
    slopes = (z[:, 1] - z[:, 0]) / (x[:, 1] - x[:, 0])
    assert slopes == pytest.approx(2e-3 * np.array(middle), rel=1e-9)
    # Four coaches of a vehicle on two bogies each keep theirs apart.
    assert len(train_outline(rb.Train(rb.vehicle("xia2000"), 2, 22.5)).frames) == 4


def test_names_of_an_articulated_vehicle_do_not_cover_each_other(shared):
    axes = rb.plots.vehicle(shared)
    figure = axes[0].figure
    figure.canvas.draw()
    for ax in axes:
        boxes = [
            (t.get_text(), t.get_window_extent()) for t in (*ax.texts, ax.title) if t.get_text()
        ]
        for i, (name, box) in enumerate(boxes):
            for other, beside in boxes[i + 1 :]:
                assert not box.overlaps(beside), (name, other)
    texts = [t.get_text() for t in (*axes[0].texts, *axes[1].texts)]
    assert "coach 2\n24 t" in texts and "bogie 3\n3 t" in texts and "length 57 m" in texts
    assert not any("wheelset" in text for text in texts)
    assert axes[1].get_title(loc="left") == "from above; 8 wheelsets of 1.5 t"
    assert axes[0].get_window_extent().width > 0.7 * figure.bbox.width
    rb.plots.vehicle_mode(shared, 4)
    rb.plots.animate_vehicle_mode(shared, 4)
    rb.plots.train_on_deck(rb.Train(shared), rb.deck("viaduct36"))


def test_every_vehicle_with_wheelsets_is_drawn_and_rides():
    for name in ("manchester", "sprung_mass"):
        car = rb.with_wheelsets(rb.vehicle(name), mass=1500.0)
        rb.plots.vehicle(car)
        rb.plots.vehicle_mode(car, 1)
        rb.plots.animate_car_on_waves(car, rb.Harmonic(2e-3, wavelength=10.0), speed=20.0)
