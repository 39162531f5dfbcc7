"""The simulator of the campaign by itself: closed forms, Newton's law, its order; and with it the
torsion that condensed loading of a fast train gives, which no number of modes may change."""

import numpy as np
import pytest
from frame import Frame
from reference import car_parameters
from scipy.linalg import eigh
from scipy.sparse.linalg import spsolve
from simulator import Car, Simulator
from spaceframe import SIZE, SpaceFrame, even

import railbridge as rb

PAPER = car_parameters()
E, SHEAR = 35e9, 35e9 / 2.4
W1, W2 = 2 * np.pi * 3.307, 2 * np.pi * 16.30
VIADUCT = {
    "spans": [36.0],
    "continuous": True,
    "mass": 12e3,
    "polar": 2500 * (2.553 + 25.53),
    "axial": E * 4.8,
    "vertical": E * 2.553,
    "lateral": E * 25.53,
    "torsion": SHEAR * 5.59,
    "rayleigh": (0.06 * W1 * W2 / (W1 + W2), 0.06 / (W1 + W2)),
    "bearings": [
        {"x": x, "y": 0.0, "z": 0.0, "fixed": fixed, "springs": {}}
        for x, fixed in ((0.0, ["x", "y", "z", "roll"]), (36.0, ["y", "z", "roll"]))
    ],
}
"""The shipped deck `viaduct36` in plain numbers."""
SIDES = ("left", "right")
WAVES = {("vertical", s): [(5e-3, 14.4, 0.0)] for s in SIDES}
WAVES |= {("lateral", s): [(2e-3, 14.4, np.pi / 2)] for s in SIDES}
PAIRS = [
    {"x": x, "y": y, "z": -1.2, "fixed": held if rigid else [], "springs": {}}
    | ({} if rigid else {"springs": dict.fromkeys(held, 2e9)})
    for x in (0.0, 36.0)
    for y, held in ((2.0, ["x", "y", "z"] if x == 0.0 else ["y", "z"]), (-2.0, ["z"]))
    for rigid in (x == 0.0,)
]
"""Two bearings a line below the axis: rigid at the start, elastic at the end."""


def run(deck=VIADUCT, cars=1, car=PAPER, speed=40.0, step=1e-3, seconds=1.6, lead_in=20.0, **given):
    train = {"cars": cars, "spacing": 22.5, "offset": given.pop("offset", 2.4)}
    options = {"speed": speed, "step": step, "samples": round(seconds / step) + 1, "size": 2.0}
    waves = given.pop("waves", WAVES)
    return Simulator(deck, car, train, waves, options | {"lead_in": lead_in} | given)()


# The parts


def test_the_car_has_the_frequencies_of_table_2_and_stands_on_all_wheels():
    car = Car(PAPER)
    stiffness = car.stiffness + car.ends.T @ (car.k[:, None] * car.ends)
    found = np.sqrt(eigh(stiffness, car.mass, eigvals_only=True)) / (2 * np.pi)
    known = [0.6451, 1.2138, 1.2298, 1.3345, 1.6768, 9.0444, 9.0552, 11.7201, 11.7201]
    known += [15.4791, 15.4824, 21.9588, 21.9589, 24.9903, 24.9903]
    assert found == pytest.approx(known, rel=1e-5, abs=1e-4)
    assert 8 * car.wheel_load == pytest.approx(585.76e3, rel=1e-5)


def test_the_frame_has_the_frequencies_of_a_simple_beam():
    frame, n = SpaceFrame(VIADUCT, even([36.0], 1.0)), np.arange(1, 4)
    d = VIADUCT
    bending = (n[:, None] * np.pi / 36) ** 2 * np.sqrt([d["vertical"], d["lateral"]]) / 12e3**0.5
    known = np.concatenate(
        [
            bending.ravel(),
            n * np.pi / 36 * np.sqrt(d["torsion"] / d["polar"]),
            (n - 0.5) * np.pi / 36 * np.sqrt(d["axial"] / d["mass"]),
        ]
    )
    known = np.sort(known)[:6] / (2 * np.pi)
    assert frame.frequencies(6) == pytest.approx(known, rel=1e-4)


def test_bearings_off_the_axis_are_those_of_another_frame():
    """Of lumped masses and stiff springs, which see a long deck's low modes only."""
    frame = SpaceFrame(VIADUCT | {"bearings": PAIRS}, even([36.0], 1.0))
    other = Frame(
        36.0,
        72,
        *(VIADUCT[n] for n in ("axial", "lateral", "vertical", "torsion", "mass", "polar")),
        bearings=[
            (
                b["x"],
                b["y"],
                b["z"],
                dict.fromkeys(["xyz".index(f) for f in b["fixed"]], 1e13)
                | {"xyz".index(f): k for f, k in b["springs"].items()},
            )
            for b in PAIRS
        ],
    )
    assert frame.frequencies(5) == pytest.approx(other.frequencies(5), rel=2e-3)


def at_rest(frame, x, load):
    """Displacements of all freedoms and section forces under (F_y, F_z, M_x) at x, nothing
    moving."""
    (e,), (value,), _ = frame.under(np.array([x]), np.array([0]))
    loads = np.zeros((frame.size, 1))
    loads[frame.freedoms[e], 0] = value.T @ load
    moved = frame.free @ spsolve(frame.stiffness.tocsc(), frame.free.T @ loads[:, 0])
    return moved[:, None], loads


@pytest.mark.parametrize("x", [9.3, 18.0])
def test_statics_are_those_of_a_simple_beam(x):
    frame = SpaceFrame(VIADUCT, even([36.0], 2.0))
    strain, loads = at_rest(frame, x, [3e4, -2e5, 5e5])
    here, rest = frame.node(12.0), np.zeros_like(loads)
    a, b = min(x, 12.0), 36.0 - max(x, 12.0)
    share = a * b / 36.0
    line = (36.0**2 - a**2 - b**2) / 6
    y, z, roll = strain[6 * here + 1 : 6 * here + 4, 0]
    assert z == pytest.approx(-2e5 * share * line / VIADUCT["vertical"], rel=1e-6)
    assert y == pytest.approx(3e4 * share * line / VIADUCT["lateral"], rel=1e-6)
    assert roll == pytest.approx(5e5 * share / VIADUCT["torsion"], rel=1e-9)
    before = 1.0 if x > 12.0 else 0.0  # whether the load lies behind the section
    face = frame.section(here, strain, rest, np.zeros((SIZE, 1)))
    end = (36.0 - x) / 36.0
    # What lies left of the section is in balance: bearing, load, and the face.
    assert face[2, 0] == pytest.approx(2e5 * (1.0 - before - end), rel=1e-6)
    assert face[3, 0] == pytest.approx(5e5 * (end - 1.0 + before), rel=1e-6)
    assert face[4, 0] == pytest.approx(-2e5 * share, rel=1e-6)
    assert face[5, 0] == pytest.approx(-3e4 * share, rel=1e-6)
    held = frame.supported(strain, rest, loads)
    assert held[0][2, 0] == pytest.approx(2e5 * end, rel=1e-6)
    assert held[frame.nodes - 1][3, 0] == pytest.approx(-5e5 * x / 36.0, rel=1e-6)


def test_loads_that_do_not_swing_move_over_a_beam_as_in_the_closed_form():
    """A car on springs without stiffness; each axle's series is Fryba's, undamped."""
    loose = {n: v * (1e-9 if n.startswith("primary_v") else 1.0) for n, v in PAPER.items()}
    found = run(VIADUCT | {"rayleigh": (0.0, 0.0)}, 1, loose, 60.0, 1e-3, 0.6, offset=0.0, waves={})
    force = -2 * Car(PAPER).wheel_load
    n = np.arange(1, 60)[:, None]
    omega = (n * np.pi / 36) ** 2 * np.sqrt(VIADUCT["vertical"] / 12e3)
    drive, total = n * np.pi * 60.0 / 36, 0.0
    for behind in (0.0, 2.5, 15.6, 18.1):
        t = np.maximum(found.time - behind / 60.0, 0.0)
        shape = (np.sin(drive * t) - drive / omega * np.sin(omega * t)) / (omega**2 - drive**2)
        total = total + (np.sin(n * np.pi / 2) * shape).sum(axis=0) * 2 * force / (12e3 * 36)
    error = np.abs(found.at(18.0)[1] - total) / np.abs(total).max()
    assert error.max() < 4e-5


# Newton's law


@pytest.mark.parametrize("damping", [{}, {"rayleigh": None, "ratio": 0.02}])
@pytest.mark.parametrize("bearings", [VIADUCT["bearings"], PAIRS])
def test_bearings_carry_loads_less_inertia_and_the_drag_from_outside(damping, bearings):
    """At every instant; the inertia is integrated from the nodes' motion, not from a matrix."""
    found = run(
        VIADUCT | damping | {"bearings": bearings, "height": 0.8}, 2, speed=60.0, seconds=0.9
    )
    frame = found.frame
    push = found.carried[1]
    w, turn = push[2 : 6 * frame.nodes : 6], -push[4 : 6 * frame.nodes : 6]
    v, yaw = push[1 : 6 * frame.nodes : 6], push[5 : 6 * frame.nodes : 6]
    h = frame.h[:, None]
    inertia = {
        name: VIADUCT["mass"]
        * (h / 2 * (u[:-1] + u[1:]) + h**2 / 12 * (s[:-1] - s[1:])).sum(axis=0)
        for name, u, s in (("y", v, yaw), ("z", w, turn))
    }
    on_deck = np.repeat(found.elements >= 0, 2, axis=1).reshape(len(found.time), 2, 4, 2)
    held = sum(found.reactions().values())
    by_one = {d: sum(b[d] for b in found.bearing_forces() if d in b) for d in "yz"}
    for i, d in ((0, "y"), (1, "z")):
        loads = (found.wheel_forces[..., i] * on_deck).sum(axis=(1, 2, 3))
        assert held[1 + i] + loads == pytest.approx(inertia[d], abs=1e-6 * np.abs(held[2]).max())
        assert by_one[d] == pytest.approx(held[1 + i], abs=1e-6 * np.abs(held[2]).max())
    assert np.abs(inertia["z"]).max() > 0.03 * np.abs(held[2]).max()


# Order


@pytest.mark.parametrize(
    ("least", "history"),
    [
        (2.8, lambda r: r.at(18.0)[1]),
        (2.4, lambda r: r.at(18.0)[2]),
        (2.5, lambda r: r.reactions()[36.0][2]),
        (1.9, lambda r: r.wheel_forces),
    ],
    ids=["displacement", "twist", "reaction", "wheels"],
)
def test_it_converges_with_the_third_power_of_the_step(halved, least, history):
    """Though axles enter and leave between samples, and elastic bearings let the deck jump.

    Wheels with the second: the run-up's end bends their rail, and no step is cut there.
    """
    one, two, three = (history(r) for r in halved)
    assert np.log2(np.std(one - two) / np.std(two - three)) > least


@pytest.fixture(scope="module")
def halved():
    deck = VIADUCT | {"bearings": PAIRS}
    return [run(deck, speed=50.0, step=2e-3, seconds=0.6, fine=n, size=9.0) for n in (1, 2, 4)]


# The torsion of a fast train


@pytest.fixture(scope="module")
def fast():
    """Four cars at 80 m/s, each loading the deck at one place; until the third has left."""
    return run(cars=4, speed=80.0, seconds=1.13, lead_in=100.0, condensed=True, size=1.0)


@pytest.mark.parametrize(("modes", "torsion"), [(20, 4e-3), (40, 3e-3), (80, 1.5e-3)])
def test_torsion_and_reaction_of_a_fast_train_close_in_on_those_of_the_unreduced_frame(
    fast, modes, torsion
):
    """The lag of the viscous part is counted, so more modes come nearer, not away.

    At samples of 1 ms, the last a centimetre before a car's middle leaves. The bend of the twist
    travels with the load and takes many modes; the force needs few.
    """
    change = {"train.cars": 4, "run.speed": 80.0, "deck.modes": modes}
    case = rb.case("paper").replace({**change, "run.time_step": 5e-4, "run.lead_in": 100.0})
    reaction = case.run().reactions()[36.0]
    count = len(fast.time)
    theirs = {n: reaction[n][::2][:count].max() for n in ("force_z", "moment_x")}
    ours = {n: fast.reactions()[36.0][i].max() for n, i in (("force_z", 2), ("moment_x", 3))}
    assert ours["moment_x"] == pytest.approx(2054e3, rel=5e-4)
    assert ours["force_z"] == pytest.approx(967.5e3, rel=5e-4)
    assert theirs["moment_x"] == pytest.approx(ours["moment_x"], rel=torsion)
    assert theirs["force_z"] == pytest.approx(ours["force_z"], rel=5e-4)
