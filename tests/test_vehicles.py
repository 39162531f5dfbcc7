"""The car against the paper's Table 2, against statics by hand, and against rigid-body motion."""

from dataclasses import replace

import numpy as np
import pytest
from forcebased import by_forces
from hypothesis import given, settings
from hypothesis import strategies as st

import railbridge as rb
from railbridge import planar_car, two_bogie_car
from railbridge.vehicles import Body, Spring, Vehicle

CAR = rb.vehicle("xia2000")
PARAMETERS = rb.car_parameters("xia2000")
NATURAL = [
    0.6451, 1.2138, 1.2298, 1.3345, 1.6768, 9.0444, 9.0552, 11.7201, 11.7201, 15.4791, 15.4824,
    21.9588, 21.9589, 24.9903, 24.9903,
]  # fmt: skip
PRINTED = [
    0.645,
    1.215,
    1.230,
    1.334,
    1.667,
    9.044,
    9.055,
    11.72,
    11.72,
    15.48,
    15.48,
    21.96,
    21.96,
    24.99,
    24.99,
]
DAMPED = [
    (0.648, 0.067), (1.217, 0.244), (1.227, 0.211), (1.338, 0.103), (1.684, 0.129), (9.016, 0.252),
    (9.021, 0.248), (11.72, 0.186), (11.72, 0.186), (15.485, 0.494), (15.494, 0.494), (21.90,
    0.100), (21.90, 0.100), (24.99, 0.059), (24.99, 0.059),
]  # fmt: skip


def test_natural_frequencies():
    found = CAR.modes().frequencies_hz
    assert found == pytest.approx(NATURAL, rel=1e-4)
    pitch = 4
    for i, (ours, printed) in enumerate(zip(found, PRINTED, strict=True)):
        assert ours == pytest.approx(printed, rel=6e-3 if i == pitch else 1.1e-3), i
    assert CAR.modes().names[3] == "car z" and CAR.modes().names[pitch] == "car pitch"


def test_damped_modes():
    modes = CAR.damped_modes()
    assert modes.frequencies_hz == pytest.approx([f for f, _ in DAMPED], rel=1e-3)
    assert modes.damping_ratios == pytest.approx([z for _, z in DAMPED], abs=6e-4)


def test_matrices_are_symmetric_and_definite():
    for matrix in (CAR.mass_matrix, CAR.damping_matrix, CAR.stiffness_matrix):
        assert matrix.shape == (15, 15)
        assert np.array_equal(matrix, matrix.T)
    assert np.linalg.eigvalsh(CAR.stiffness_matrix)[0] > 0
    assert np.linalg.eigvalsh(CAR.mass_matrix)[0] > 0
    shapes = CAR.modes().shapes
    assert shapes.T @ CAR.mass_matrix @ shapes == pytest.approx(np.eye(15), abs=1e-9)


def test_weight_and_static_loads():
    assert CAR.weight == pytest.approx(585.76e3, rel=1e-5)
    assert [c.static_load for c in CAR.contacts] == pytest.approx([585.76e3 / 8] * 8, rel=1e-5)
    heavy = replace(CAR, static_wheelset_mass=1000.0)
    assert sum(c.static_load for c in heavy.contacts) == pytest.approx(CAR.weight + 4 * 9810.0)
    assert heavy.weight == pytest.approx(CAR.weight + 4 * 9810.0)


def test_where_the_inertia_of_wheelsets_would_matter():
    """What the docstring of `static_wheelset_mass` says, by Newton: a wheel that follows the rail's
    r sin(wt) presses on it by m w^2 r, as the whole car does far below its bounce."""

    def pressed(frequency, wheelsets=0.0):
        omega = 2 * np.pi * frequency
        return CAR.transfer(frequency)[:, 1, :, 1].sum() + wheelsets * omega**2

    assert pressed(0.05) == pytest.approx(CAR.weight / 9.81 * (2 * np.pi * 0.05) ** 2, rel=2e-3)
    for frequency, percent in (1.389, -0.3), (2.0, -14), (4.2, 64):
        change = 100 * abs(pressed(frequency, 4 * 1800.0)) / abs(pressed(frequency)) - 100
        assert change == pytest.approx(percent, abs=0.5 if abs(percent) > 1 else 0.1), frequency


def test_wheels_are_ordered_front_to_back_left_before_right():
    places = [(c.x, c.y) for c in CAR.contacts]
    assert [x for x, _ in places] == pytest.approx(np.repeat([9.05, 6.55, -6.55, -9.05], 2))
    assert [y for _, y in places] == pytest.approx([0.98, -0.98] * 4)
    assert [c.body for c in CAR.contacts] == ["front bogie"] * 4 + ["rear bogie"] * 4


def test_off_centre_body_loads_the_near_side_more():
    body = replace(CAR.bodies[0], position=(0.5, 0.1, 1.41))
    loads = np.array([c.static_load for c in replace(CAR, bodies=(body, *CAR.bodies[1:])).contacts])
    x, y = (np.array([getattr(c, a) for c in CAR.contacts]) for a in ("x", "y"))
    assert loads.sum() == pytest.approx(CAR.weight)
    # Moments about the middle: only the car body stands off it.
    assert loads @ x == pytest.approx(0.5 * 50990 * 9.81)
    assert loads @ y == pytest.approx(0.1 * 50990 * 9.81)


def motion_of(car, translation=(0, 0), roll=0.0, pitch=0.0, yaw=0.0):
    """Freedoms and support motion when car and track move as one rigid body."""
    x = np.zeros(len(car.labels))
    for i, label in enumerate(car.labels):
        body, freedom = label.rsplit(" ", 1)
        px, py, pz = next(b.position for b in car.bodies if b.name == body)
        x[i] = {
            "y": translation[0] - roll * pz + yaw * px,
            "z": translation[1] + roll * py - pitch * px,
            "roll": roll, "pitch": pitch, "yaw": yaw,
        }[freedom]  # fmt: skip
    support = [
        (translation[0] + yaw * c.x, translation[1] + roll * c.y - pitch * c.x)
        for c in car.contacts
    ]  # wheels at rail level, z = 0
    return x, np.array(support)


@pytest.mark.parametrize(
    "motion",
    [{"translation": (1, 0)}, {"translation": (0, 1)}, {"roll": 1.0}, {"pitch": 1.0}, {"yaw": 1.0}],
)
def test_a_rigid_motion_of_car_and_track_stretches_nothing(motion):
    x, support = motion_of(CAR, **motion)
    rows, k = CAR.contact_stretch, CAR.contact_stiffness
    assert rows @ x == pytest.approx(support, abs=1e-12)
    pushed = np.einsum("wdn,wd->n", rows, k * support)
    assert CAR.stiffness_matrix @ x == pytest.approx(pushed, rel=1e-9, abs=1e-3)
    # Statically no force on the deck; the transfer function agrees at zero frequency.
    assert np.tensordot(CAR.transfer(0.0), support, 2) == pytest.approx(np.zeros((8, 2)), abs=1e-4)


def test_at_high_frequency_bodies_stand_still_and_the_primaries_answer():
    transfer = CAR.transfer(1e5).reshape(16, 16)
    k, c = CAR.contact_stiffness.ravel(), CAR.contact_damping.ravel()
    assert np.diag(transfer) == pytest.approx(-(k + 2j * np.pi * 1e5 * c), rel=1e-3)


def test_transfer_is_the_limit_of_the_sampled_response():
    f, h, n = 3.1, 2e-4, 100_000
    rng = np.random.default_rng(1)
    amplitude = (rng.normal(size=16) + 1j * rng.normal(size=16)).reshape(8, 2)
    k, c = CAR.contact_stiffness, CAR.contact_damping
    t = h * np.arange(n)
    wave = np.exp(2j * np.pi * f * t)
    u = (((k + 2j * np.pi * f * c) * amplitude)[..., None] * wave).imag
    force = CAR.sampled(h)(u)[..., -2000:]
    steady = (np.tensordot(CAR.transfer(f), amplitude, 2)[..., None] * wave[-2000:]).imag
    assert force == pytest.approx(steady, abs=1e-5 * np.abs(steady).max())


def test_planar_car_of_the_data_file_is_the_car_s_plane():
    shipped, made = rb.vehicle("xia2000_planar"), rb.planar_car(CAR)
    assert shipped.modes().frequencies_hz == pytest.approx(made.modes().frequencies_hz, rel=1e-12)
    assert shipped.stiffness_matrix == pytest.approx(made.stiffness_matrix)
    assert shipped.damping_matrix == pytest.approx(made.damping_matrix)
    assert [c.static_load for c in shipped.contacts] == pytest.approx([CAR.weight / 4] * 4)
    # Its modes are the bounce and pitch modes of the whole car.
    for f in made.modes().frequencies_hz:
        assert np.min(np.abs(CAR.modes().frequencies_hz - f)) < 1e-9 * f
    assert rb.planar_car(rb.vehicle("sprung_mass")).labels == ("mass z",)


def test_a_planar_car_weighs_what_the_car_does_wheelsets_included():
    heavy = replace(CAR, static_wheelset_mass=1500.0)
    plane = planar_car(heavy)
    assert plane.static_wheelset_mass == 1500.0
    assert plane.weight == pytest.approx(heavy.weight) and heavy.weight > CAR.weight + 5e4
    assert [c.static_load for c in plane.contacts] == pytest.approx([heavy.weight / 4] * 4)
    assert plane.length == CAR.length and plane.name == f"{CAR.name} planar"


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("at", (0.0, 0.0)),
        ("at", (0.0, float("nan"), 0.0)),
        ("stiffness", (-1.0, 1e6)),
        ("stiffness", (1e6, 1e6, 1e6)),
        ("stiffness", 1e6),
        ("damping", (0.0, -1.0)),
        ("damping", (0.0, "much")),
    ],
)
def test_a_spring_names_the_field_that_cannot_be(field, value):
    good = {"at": (0.0, 0.0, 0.0), "stiffness": (0.0, 1e6), "damping": (0.0, 1e3)}
    rb.Spring("mass", "rail", **good)
    with pytest.raises(rb.InputError) as error:
        rb.Spring("mass", "rail", **{**good, field: value})
    assert error.value.field.startswith(field)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("mass", 0.0),
        ("mass", -5.0),
        ("mass", "heavy"),
        ("inertia", (1e4, -1.0, 1e4)),
        ("inertia", (1e4, 1e4)),
        ("position", (0.0, 0.0)),
        ("position", (0.0, float("inf"), 0.0)),
    ],
)
def test_a_body_names_the_field_that_cannot_be(field, value):
    good = {"mass": 1e3, "inertia": (1e4, 1e4, 1e4), "position": (0.0, 0.0, 1.0)}
    rb.Body("mass", **good)
    with pytest.raises(rb.InputError) as error:
        rb.Body("mass", **{**good, field: value})
    assert error.value.field.startswith(field)


def test_the_car_body_s_motion_is_taken_above_its_springs_and_in_its_middle():
    places = {place: x for body, place, x in CAR.body_places if body is CAR.body}
    assert places == pytest.approx({"front": 7.8, "middle": 0.0, "rear": -7.8})


def test_springs_in_series_by_hand():
    ks, kt, m = 4 * 1060e3, 8 * 2976e3, 50990.0
    assert np.sqrt(ks * kt / (ks + kt) / m) / 2 / np.pi == pytest.approx(1.337, abs=5e-4)
    assert np.sqrt(ks / m) / 2 / np.pi == pytest.approx(1.451, abs=5e-4)
    rigid_primary = two_bogie_car("stiff", **{**PARAMETERS, "primary_vertical_stiffness": 1e13})
    assert frequency_of(rigid_primary, "car z") == pytest.approx(1.451, abs=5e-4)


def frequency_of(car, name):
    modes = car.modes()
    return modes.frequencies_hz[modes.names.index(name)]


def test_exercises_with_checked_answers():
    heavier = {
        k: v * 1.3 if k.startswith("car_body") and "above" not in k else v
        for k, v in PARAMETERS.items()
    }
    car = two_bogie_car("heavier", **heavier)
    assert frequency_of(car, "car z") == pytest.approx(1.171, abs=6e-4)
    assert car.modes().frequencies_hz[0] == pytest.approx(0.566, abs=6e-4)
    swapped = {**PARAMETERS, "primary_half_width": 1.12, "secondary_half_width": 0.98}
    assert np.min(np.abs(two_bogie_car("swapped", **swapped).modes().frequencies_hz - 16.92)) < 0.01
    reversed_ = two_bogie_car("reversed", **{**PARAMETERS, "primary_below_bogie": -0.07})
    assert reversed_.modes().frequencies_hz[0] == pytest.approx(0.651, abs=6e-4)


def test_a_varied_car_has_its_parameters_multiplied():
    same = rb.varied_car("xia2000")
    assert np.array_equal(same.stiffness_matrix, CAR.stiffness_matrix)
    assert np.array_equal(same.mass_matrix, CAR.mass_matrix)
    heavier = rb.varied_car("xia2000", car_body_mass=1.3, secondary_vertical_damping=0.5)
    assert heavier.bodies[0].mass == pytest.approx(1.3 * 50990)
    assert heavier.bodies[1:] == CAR.bodies[1:] and heavier.name == "xia2000 varied"
    halved = {s.damping[1] for s in heavier.springs if not s.on_rail}
    assert halved == {15e3} and {s.damping[1] for s in heavier.springs if s.on_rail} == {15e3}
    assert rb.varied_car("xia2000", secondary_lateral_damping=0.0).springs[0].damping[0] == 0.0


@pytest.mark.parametrize(
    ("factors", "says"),
    [
        (
            {"car_mass": 1.3},
            "xia2000: car_mass = 1.3: is no parameter of this car. Did you mean 'car_body_mass'?",
        ),
        ({"car_body_mass": -1}, "car_body_mass = -1: must be a finite number at least 0."),
        ({"car_body_mass": "30 %"}, "car_body_mass = '30 %': must be a finite number"),
        ({"car_body_mass": 0}, "vehicle xia2000 varied: car_body_mass = 0.0: must be a finite"),
    ],
)
def test_a_car_is_not_varied_in_what_it_does_not_have(factors, says):
    with pytest.raises(rb.InputError) as refused:
        rb.varied_car("xia2000", **factors)
    assert str(refused.value).startswith(says)


def test_sprung_mass_closed_form():
    mass, stiffness, damping = 5750.0, 1.595e6, 2e4
    car = rb.sprung_mass("m", mass, stiffness, damping)
    w = np.sqrt(stiffness / mass)
    assert car.modes().frequencies_hz == pytest.approx([w / 2 / np.pi])
    assert car.damped_modes().damping_ratios == pytest.approx([damping / 2 / mass / w])
    s = 2j * np.pi * 2.0
    z = stiffness + damping * s
    assert car.transfer(2.0)[0, 1, 0, 1] == pytest.approx(z**2 / (mass * s**2 + z) - z)
    assert car.transfer(2.0)[0, 1, 0, 1] == pytest.approx(-mass * s**2 * z / (mass * s**2 + z))
    assert rb.vehicle("sprung_mass").contacts[0].static_load == pytest.approx(5750 * 9.81)


def test_a_damper_can_overdamp_a_mode():
    car = rb.sprung_mass("m", 100.0, 1e4, 5e3)
    modes = car.damped_modes()
    assert modes.damping_ratios == pytest.approx([1.0, 1.0])
    roots = np.sort(np.abs(np.roots([100.0, 5e3, 1e4]))) / 2 / np.pi
    assert modes.frequencies_hz == pytest.approx(roots)


def test_one_spring_object_may_be_used_twice():
    leg = rb.Spring("mass", "rail", (0.0, 0.0, 0.0), (0.0, 1e5), (0.0, 0.0))
    body = rb.Body("mass", 100.0, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    car = rb.Vehicle("twice", (body,), (leg, leg), 5.0)
    assert [c.static_load for c in car.contacts] == pytest.approx([490.5, 490.5])
    assert car.modes().frequencies_hz == pytest.approx([np.sqrt(2e5 / 100) / 2 / np.pi])


def test_the_ends_of_a_spring_may_be_given_either_way():
    turned = tuple(rb.Spring(s.to, s.from_, s.at, s.stiffness, s.damping) for s in CAR.springs)
    other = replace(CAR, springs=turned)
    assert other.stiffness_matrix == pytest.approx(CAR.stiffness_matrix)
    assert other.transfer(3.0) == pytest.approx(CAR.transfer(3.0))
    assert other.contacts == CAR.contacts


@given(factor=st.floats(0.1, 10.0), seed=st.integers(0, 99))
@settings(max_examples=20)
def test_forces_scale_with_the_car(factor, seed):
    """Masses, springs and dampers all times a factor: the same frequencies, forces times the
    factor."""
    scaled = {
        k: v * factor if any(w in k for w in ("mass", "inertia", "stiffness", "damping")) else v
        for k, v in PARAMETERS.items()
    }
    car = two_bogie_car("scaled", **scaled)
    assert car.modes().frequencies_hz == pytest.approx(NATURAL, rel=2e-4)
    r = np.random.default_rng(seed).normal(size=(8, 2))
    ours, theirs = (np.tensordot(v.transfer(2.0), r, 2) for v in (car, CAR))
    assert ours == pytest.approx(factor * theirs, rel=1e-6)


def test_frames_have_units():
    assert list(CAR.modes().to_frame().columns) == ["frequency (Hz)", "damping ratio", "moves most"]
    assert len(CAR.damped_modes().to_frame()) == 15


def test_a_vehicle_that_tips_over_is_refused():
    body = Body("mass", 1e4, (1e4, 1e5, 1e5), (6.0, 0.0, 1.0), ("z", "pitch"))
    springs = tuple(
        Spring("mass", "rail", (x, 0.0, 0.0), (0.0, 1e6), (0.0, 1e3)) for x in (3.0, -3.0)
    )
    with pytest.raises(rb.InputError, match=r"wheel at x = -3, y = 0 m.*tips over"):
        Vehicle("eccentric", (body,), springs, 10.0)


def test_planar_car_leaves_lateral_springs_out():
    bumper = Spring("car", "rail", (0.0, 0.0, 0.5), (1e5, 0.0), (0.0, 0.0))
    with_bumper = replace(CAR, springs=(*CAR.springs, bumper))
    assert planar_car(with_bumper).modes().frequencies_hz == pytest.approx(
        planar_car(CAR).modes().frequencies_hz
    )


def test_matrices_are_kept_and_cannot_be_changed():
    for matrix in (
        CAR.mass_matrix,
        CAR.stiffness_matrix,
        CAR.damping_matrix,
        CAR.contact_stiffness,
        CAR.contact_damping,
    ):
        with pytest.raises(ValueError, match="read-only"):
            matrix[0, 0] = 1.0


def test_wheels_that_rounding_sets_apart_share_an_axle():
    """0.1 + 0.2 is not 0.3: the wheelset would weigh twice."""
    body = Body("mass", 1e4, (1e4, 1e4, 1e4), (0.0, 0.0, 1.0), ("z", "roll", "pitch"))
    places = [(0.3, 0.8), (0.1 + 0.2, -0.8), (-0.3, 0.8), (-0.3, -0.8)]
    springs = tuple(Spring("mass", "rail", (x, y, 0.0), (0.0, 1e6), (0.0, 1e3)) for x, y in places)
    car = Vehicle("cart", (body,), springs, 2.0, static_wheelset_mass=1000.0)
    assert [axle.wheels for axle in car.axles] == [(0, 1), (2, 3)]
    assert [contact.y for contact in car.contacts] == [0.8, -0.8, 0.8, -0.8]
    assert car.weight == pytest.approx((1e4 + 2 * 1000.0) * 9.81)
    assert sum(contact.static_load for contact in car.contacts) == pytest.approx(car.weight)
    train = rb.Train(car, cars=2)
    assert [axle.delay for axle in train.placed_axles] == pytest.approx([0.0, 0.6, 2.0, 2.6])
    run = rb.cross(train, rb.deck("viaduct36"), speed=20.0, interaction="rigid")
    assert len(run.coupling.axles.starts) == 4


def articulated(coaches=3, hung=()):
    """Coaches of 18 m on shared bogies, with 2 t on each bogie, and what hangs in some of them."""
    half = 9.0 * coaches
    bodies, springs = [], []
    for i in range(coaches):
        x = half - 9.0 - 18.0 * i
        bodies.append(rb.Body(f"coach {i + 1}", 24e3 - 4e3 * i, (4e4, 6e5, 6e5), (x, 0.0, 1.8)))
    for i in range(coaches + 1):
        x = half - 18.0 * i
        bodies.append(rb.Body(f"bogie {i + 1}", 3e3, (2e3, 4e3, 4e3), (x, 0.0, 0.6)))
        for axle in (x + 1.2, x - 1.2):
            for y in (1.0, -1.0):
                at, stiffness = (axle, y, 0.0), (4e6, 1.2e6)
                springs.append(rb.Spring(f"bogie {i + 1}", "rail", at, stiffness, (2e4, 2e4)))
        for coach in (i, i + 1):
            if 1 <= coach <= coaches:
                for y in (1.0, -1.0):
                    ends = f"coach {coach}", f"bogie {i + 1}"
                    springs.append(rb.Spring(*ends, (x, y, 1.0), (3e5, 4e5), (2e4, 2e4)))
    for body in hung:
        bodies.append(
            rb.Body(f"under {body}", 4e3, (1e3, 1e3, 1e3), (half - 9.0, 0.0, 0.9), ("z",))
        )
        at = (half - 9.0, 0.0, 1.2)
        springs.append(rb.Spring(body, f"under {body}", at, (0.0, 1e6), (0.0, 1e4)))
    return rb.Vehicle("articulated", tuple(bodies), tuple(springs), 18.0 * coaches + 3.0)


def test_every_coach_of_an_articulated_train_is_a_car_body():
    train = articulated(3, hung=("coach 1",))
    assert [b.name for b in train.car_bodies] == ["coach 1", "coach 2", "coach 3"]
    assert train.body.name == "coach 1"
    places = [(b.name, place, x) for b, place, x in train.body_places]
    assert places[3:6] == [("coach 2", "front", 9.0), ("coach 2", "middle", 0.0),
                           ("coach 2", "rear", -9.0)]  # fmt: skip
    assert [b.name for b in CAR.car_bodies] == ["car"]
    assert [(place, x) for _, place, x in CAR.body_places] == [
        ("front", 7.8), ("middle", 0.0), ("rear", -7.8),
    ]  # fmt: skip
    assert [b.name for b in rb.vehicle("sprung_mass").car_bodies] == ["mass"]


def test_motion_of_a_mass_on_a_spring_is_the_textbook_s():
    mass, k, c, f = 5e3, 1.2e6, 3e4, 2.0
    car, s = rb.sprung_mass("m", mass, k, c), 2j * np.pi * f
    assert car.motion(f).shape == (1, 1, 2)
    assert car.motion(f)[0, 0, 1] == pytest.approx((c * s + k) / (mass * s**2 + c * s + k))
    assert CAR.motion(0.0)[CAR.labels.index("car z"), :, 1].sum() == pytest.approx(1.0)


def on_one_spring(**changes):
    given = {"from_": "mass", "to": "rail", "at": (0.0, 0.0, 0.0)}
    spring = rb.Spring(**given | changes, stiffness=(0.0, 1e6), damping=(0.0, 0.0))
    body = rb.Body("mass", 1e3, (1.0, 1.0, 1.0), (0.0, 0.0, 1.0), ("z",))
    return rb.Vehicle("small", (body,), (spring,))


@pytest.mark.parametrize("place", [0.3, -0.3, 4.0])
def test_wheels_on_one_side_of_mid_length_are_refused(place):
    assert len(on_one_spring().contacts) == 1
    with pytest.raises(rb.InputError, match="all wheels are on one side of x = 0"):
        on_one_spring(at=(place, 0.0, 0.0))


@pytest.mark.parametrize(("changes", "field"), [({"from_": "mas"}, "from"), ({"to": "rial"}, "to")])
def test_an_end_of_a_spring_that_is_no_body_is_named_as_in_files(changes, field):
    with pytest.raises(rb.InputError, match=rf"vehicle small: springs\[1\]\.{field} = "):
        on_one_spring(**changes)


def test_a_frequency_that_is_none_is_refused_with_its_unit():
    for ask in (on_one_spring().transfer, on_one_spring().motion):
        with pytest.raises(rb.InputError, match=r"^frequency_hz.* in Hz"):
            ask("fast")


# ---- anti-roll bars, springs along the track, dampers in series with a spring


def on_maxwell(mass=5e3, k=1.2e6, c=3e4, ks=4e6, top=2e4, kc=3e6):
    """A mass on a spring with a damper that acts through another, on a frame on the rail."""
    bodies = (
        Body("mass", mass, (0.0, 0.0, 0.0), (0.0, 0.0, 2.0), ("z",)),
        Body("frame", top, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",)),
    )
    springs = (
        Spring("mass", "frame", (0.0, 0.0, 1.5), (0.0, k), (0.0, c), series_stiffness=(0.0, ks)),
        Spring("frame", "rail", (0.0, 0.0, 0.0), (0.0, kc), (0.0, 1e4)),
    )
    return Vehicle("maxwell", bodies, springs)


@pytest.mark.parametrize("frequency", [0.0, 0.3, 2.0, 9.0, 60.0])
def test_a_damper_through_a_spring_in_closed_form(frequency):
    mass, k, c, ks, top, kc = 5e3, 1.2e6, 3e4, 4e6, 2e4, 3e6
    s = 2j * np.pi * frequency
    z = k + ks * c * s / (ks + c * s)
    above = mass * s**2 * z / (mass * s**2 + z)
    contact = kc + 1e4 * s
    whole = top * s**2 + above
    expected = -contact * whole / (whole + contact)
    car = on_maxwell()
    assert car.transfer(frequency)[0, 1, 0, 1] == pytest.approx(expected, rel=1e-9, abs=1e-6)
    frame = contact / (whole + contact)
    moved = z / (mass * s**2 + z) * frame
    assert car.motion(frequency)[:, 0, 1] == pytest.approx([moved, frame], rel=1e-9)


def test_a_damper_through_a_stiff_spring_acts_straight_and_through_a_soft_one_not_at_all():
    straight = replace(on_maxwell().springs[0], series_stiffness=None)
    none = replace(straight, damping=(0.0, 0.0))
    car = on_maxwell()
    for spring, ks in ((straight, 1e12), (none, 1e-2)):
        other = replace(car, springs=(spring, car.springs[1]))
        assert on_maxwell(ks=ks).transfer(2.0) == pytest.approx(other.transfer(2.0), rel=1e-5)


def test_poles_of_a_damper_through_a_spring_are_the_roots_of_its_polynomial():
    """Both masses and the damper's force: (m s2 + z)(M s2 + z + kc + cc s) = z2, times ks + c s."""
    mass, k, c, ks, top, kc = 5e3, 1.2e6, 3e4, 4e6, 2e4, 3e6
    P = np.polynomial.Polynomial
    through = P([k * ks, (k + ks) * c])  # z (ks + c s)
    series, s2 = P([ks, c]), P([0, 0, 1])
    upper, lower = mass * s2 * series + through, (top * s2 + P([kc, 1e4])) * series + through
    whole = (upper * lower - through**2) // series
    roots = whole.roots()
    modes = on_maxwell().damped_modes()
    kept = roots[roots.imag >= -1e-9]
    kept = kept[np.argsort(np.abs(kept))]
    assert len(kept) == 3  # two that swing and one that creeps
    assert modes.frequencies_hz == pytest.approx(np.abs(kept) / 2 / np.pi, rel=1e-9)
    assert modes.damping_ratios == pytest.approx(-kept.real / np.abs(kept), rel=1e-8)
    assert modes.shapes.shape == (2, 3) and len(modes.names) == 3
    assert len(on_maxwell().modes().frequencies_hz) == 2


def with_everything():
    """A small car on one bogie with a part of every kind."""
    bodies = (
        Body("car", 2e4, (2e4, 8e4, 8e4), (0.1, 0.0, 1.7)),
        Body("bogie", 3e3, (1.5e3, 3e3, 4e3), (0.0, 0.0, 0.7)),
    )
    springs = [
        Spring("car", "bogie", (0.0, y, 1.1), (3e5, 6e5), (2e4, 3e4), 2e5, 5e3, (2e6, 3e6))
        for y in (1.0, -1.0)
    ] + [Spring("car", "bogie", (x, 0.0, 1.0), (1e5, 4e5), (1e4, 2e4)) for x in (2.0, -2.0)]
    primary = [
        Spring("bogie", "rail", (x, y, 0.3), (4e6, 1.5e6), (1e4, 2e4))
        for x in (1.3, -1.3)
        for y in (1.0, -1.0)
    ]
    bars = (rb.AntiRollBar("car", "bogie", 8e5, 6e3),)
    car = Vehicle("all", bodies, (*springs, *primary), 10.0, anti_roll_bars=bars)
    return rb.with_wheelsets(
        car, mass=1500.0, roll_inertia=800.0, yaw_inertia=900.0, height=0.46, gauge=1.5,
        contact_stiffness=2e7, longitudinal_stiffness=5e6, longitudinal_damping=1e4,
    )  # fmt: skip


def test_a_vehicle_with_every_part_against_an_ode_of_its_own():
    """`forcebased` pushes every body by every spring, without rows or matrices."""
    car, h = with_everything(), 5e-4
    t = h * np.arange(1601)
    amplitude = 1e-3 * np.random.default_rng(3).normal(size=(4, 2))

    def rail(time):  # smooth from rest, so that sampling costs little
        return amplitude * (np.sin(2 * np.pi * 3.0 * time) ** 3 + time * np.sin(40 * time))

    k = car.contact_stiffness[..., None]
    u = k * np.moveaxis(np.array([rail(time) for time in t]), 0, -1)
    expected = by_forces(car, rail, t)
    ours = car.sampled_motion(h)(u)[:, 0]
    for label, row in zip(car.labels, ours, strict=True):
        size = np.abs(expected.motion[label]).max()
        assert size > 1e-5 and row == pytest.approx(expected.motion[label], abs=1e-4 * size), label
    forces = car.sampled(h)(u)
    assert forces == pytest.approx(expected.forces, abs=4e-3 * np.abs(expected.forces).max())
    places = car.sampled_body(h)(u)
    assert places == pytest.approx(expected.body, abs=2e-3 * np.abs(expected.body).max())


@pytest.mark.parametrize("frequency", [1.1, 7.0])
def test_with_every_part_transfer_is_the_limit_of_time_stepping(frequency):
    car, h, n = with_everything(), 1e-4, 300_000
    rng = np.random.default_rng(5)
    amplitude = rng.normal(size=(4, 2)) + 1j * rng.normal(size=(4, 2))
    wave = np.exp(2j * np.pi * frequency * h * np.arange(n))
    u = ((car.contact_stiffness * amplitude)[..., None] * wave).imag
    steady = np.tensordot(car.transfer(frequency), amplitude, 2)[..., None] * wave[-2000:]
    force = car.sampled(h)(u)[..., -2000:]
    assert force == pytest.approx(steady.imag, abs=2e-4 * np.abs(steady).max())
    moved = np.tensordot(car.motion(frequency), amplitude, 2)[:, None] * wave[-2000:]
    motion = car.sampled_motion(h)(u)[:, 0, -2000:]
    assert motion == pytest.approx(moved.imag, abs=1e-5 * np.abs(moved).max())


def test_with_every_part_the_plane_is_that_of_the_whole():
    """Bounce and pitch of a car that is alike left and right are a car of their own."""
    car, plane = with_everything(), planar_car(with_everything())
    ways = np.array([[1, 1, 0, 0], [0, 0, 1, 1]])  # both wheels of an axle
    whole = np.einsum("aw,wv,bv->ab", ways, car.transfer(6.0)[:, 1, :, 1], ways)
    assert plane.transfer(6.0)[:, 1, :, 1] == pytest.approx(whole, rel=1e-9)
    assert [c.static_load for c in plane.contacts] == pytest.approx(
        [2 * c.static_load for c in car.contacts[::2]]
    )


def test_in_the_plane_dampers_add_up_that_relax_alike():
    """Left and right as one where k/c is the same; else side by side."""
    car = with_everything()
    assert len([s for s in planar_car(car).springs if s.series_stiffness]) == 1
    left = replace(car.springs[0], series_stiffness=(2e6, 9e6))
    plane = planar_car(replace(car, springs=(left, *car.springs[1:])))
    own = [(s.damping[1], s.series_stiffness[1]) for s in plane.springs if s.series_stiffness]
    assert sorted(own) == [(3e4, 3e6), (3e4, 9e6)]


def test_with_every_part_direct_solution_and_iteration_agree():
    train = rb.Train(with_everything())
    deck = rb.deck("viaduct36")
    options = {"speed": 30.0, "time_step": 1e-3}
    direct = rb.cross(train, deck, interaction="direct", **options)
    iterated = rb.cross(train, deck, tolerance=1e-10, **options)
    assert direct.wheel_forces == pytest.approx(
        iterated.wheel_forces, abs=1e-6 * np.abs(direct.wheel_forces).max()
    )
