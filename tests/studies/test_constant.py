"""Constant loads at many speeds, against a closed form that knows nothing of the suite."""

import numpy as np
import pytest
from constant_force import SimpleBeam

import railbridge as rb
from railbridge.studies import constant
from railbridge.studies.constant import constant_loads, place_step
from railbridge.studies.outputs import OUTPUTS, outputs_at, peaks_of_run, twist_at
from railbridge.units import without_rounding

L, MU, EI = 25.0, 15e3, 3.1e10
RATIO = 0.012
QUANTITIES = ("displacement_z", "acceleration_z")


def deck(modes=3, damping=RATIO):
    return rb.Beam("simple", (L,), MU, EI).deck(modes=modes, damping=damping)


def exact_peaks(train, speed, x, modes=3, tail=1.0, finest=5e-5):
    """Largest displacement and acceleration at x, by the closed form on a very fine grid."""
    beam = SimpleBeam(L, MU, EI, [RATIO] * modes)
    time = np.arange(0.0, (L + train.axles[-1]) / speed + tail, finest)
    w, a = beam.response(time, x, train.axles, train.loads, speed)
    return np.abs(w).max(), np.abs(a).max()


@pytest.mark.parametrize("speed", [31.0, 66.6, 81.9])
@pytest.mark.parametrize("x", [L / 2, 8.0])
def test_accelerations_are_those_of_the_closed_form(speed, x):
    train = rb.train("HSLM-A4")
    found = constant_loads(deck(), train, [speed], outputs_at(deck(), QUANTITIES, [x]))
    w, a = exact_peaks(train, speed, x)
    assert found.largest[0, 1] == pytest.approx(a, rel=5e-4)
    # The closed form has no share of the modes left out: 1 / 4^4 of the first and less.
    assert found.largest[0, 0] == pytest.approx(w, rel=3e-3)


@pytest.mark.parametrize("modes", [1, 3])
def test_displacements_are_those_of_the_closed_form_with_all_modes(modes):
    """Few modes and the static share of the rest, against forty modes in closed form."""
    own = deck(modes=modes)
    train = rb.AxleTrain((0.0, 3.0, 14.0, 17.0), (170e3,) * 4)
    output = outputs_at(own, ("displacement_z",), [L / 2])
    for speed in (20.0, 40.0):
        found = constant_loads(own, train, [speed], output)
        w, _ = exact_peaks(train, speed, L / 2, modes=40, tail=0.2)
        assert found.largest[0, 0] == pytest.approx(w, rel=1e-4 if modes == 3 else 1e-3)


def test_equal_axles_pile_up_at_resonance():
    """Axles d apart at v = f d: undamped, each adds the same."""
    own = deck(modes=1, damping=0.0)
    f = own.frequencies_hz[0]
    output = outputs_at(own, ("acceleration_z",), [L / 2])

    def largest(count, speed):
        train = rb.AxleTrain(tuple(20.0 * np.arange(count)), (100e3,) * count)
        return constant_loads(own, train, [speed], output, tail=2.0).largest[0, 0]

    assert largest(16, 20.0 * f) == pytest.approx(4 * largest(4, 20.0 * f), rel=0.06)
    assert largest(16, 20.0 * f) > 8 * largest(16, 20.0 * f / 1.5)


def test_a_passage_cancels_itself():
    """What one force leaves behind vanishes where cos(pi f L / v) does, v = 2 L f / 3."""
    own = deck(modes=1, damping=0.0)
    f = own.frequencies_hz[0]
    output = outputs_at(own, ("acceleration_z",), [L / 2])

    def left_behind(speed):
        """The train's second axle is too far behind and too light to matter while one waits."""
        train = rb.AxleTrain((0.0,), (100e3,))
        whole = constant_loads(own, train, [speed], output, tail=3.0).largest[0, 0]
        on_deck = constant_loads(own, train, [speed], output, tail=0.0).largest[0, 0]
        beam = SimpleBeam(L, MU, EI, [1e-12])
        after = np.linspace(L / speed * 1.0001, L / speed + 3.0, 20_000)
        _, a = beam.response(after, L / 2, [0.0], [100e3], speed)
        assert whole == pytest.approx(max(on_deck, np.abs(a).max()), rel=5e-4)
        return np.abs(a).max()

    assert left_behind(2 * L * f / 3) < 1e-3 * left_behind(2 * L * f / 2.0)


@pytest.mark.parametrize("damping", [(0.8, 4e-4), 0.02, 0.0])
def test_forces_and_displacements_are_those_of_cross(damping):
    """Section forces with the modes left out, viscosity, and jumps below the axles."""
    own = rb.Beam("simple", (L,), MU, EI, torsional_stiffness=2e10, polar_inertia=8e4).deck(
        modes=6, damping=damping
    )
    train = rb.AxleTrain((0.0, 3.0, 14.0, 17.0, 40.0, 43.0), (170e3,) * 6)
    names = ("displacement_z", "rotation_x", "moment_vertical", "shear_vertical", "torsion")
    outputs = outputs_at(own, names, [L / 2, 6.0])
    found = constant_loads(own, train, [50.0], outputs, track_offset=2.0)
    run = rb.cross(train, own, speed=50.0, track_offset=2.0, time_step=2.5e-4, interaction="rigid")
    expected = peaks_of_run(run, outputs)
    assert found.largest[0] == pytest.approx(expected.largest[0], rel=2e-3)
    assert found.largest[0, 0] == pytest.approx(expected.largest[0, 0], rel=1e-4)
    # Undamped twist swings at up to 100 Hz beside its static value: the tip of a parabola there.
    assert found.largest[0, 1] == pytest.approx(expected.largest[0, 1], rel=5e-4)
    assert found.static[0] == pytest.approx(expected.static[0], rel=3e-3)
    assert found.largest_time[0, 0] == pytest.approx(expected.largest_time[0, 0], abs=2e-3)


@pytest.mark.parametrize("damping", [(0.8, 4e-4), 0.02])
def test_twist_of_the_track_is_that_of_cross(damping):
    """A difference of rotations 3 m apart, with the modes left out; also across an end."""
    own = rb.Beam("simple", (L,), MU, EI, torsional_stiffness=2e10, polar_inertia=8e4).deck(
        modes=6, damping=damping
    )
    train = rb.AxleTrain((0.0, 3.0, 14.0, 17.0), (170e3,) * 4)
    outputs = (twist_at(own, 0.0), twist_at(own, 18.0), twist_at(own, -1.0))
    found = constant_loads(own, train, [50.0], outputs, track_offset=2.0)
    run = rb.cross(train, own, speed=50.0, track_offset=2.0, time_step=5e-5, interaction="rigid")
    expected = peaks_of_run(run, outputs)
    assert found.largest[0] == pytest.approx(expected.largest[0], rel=1e-3)
    assert found.static[0] == pytest.approx(expected.static[0], rel=3e-3)


def test_speeds_do_not_depend_on_each_other():
    own, train = deck(), rb.train("HSLM-A2")
    outputs = outputs_at(own, (*QUANTITIES, "moment_vertical"), [L / 2])
    speeds = [30.0, 45.0, 46.0, 80.0]
    together = constant_loads(own, train, speeds, outputs)
    for i, speed in enumerate(speeds):
        alone = constant_loads(own, train, [speed], outputs)
        for name in vars(alone):
            both = getattr(together, name)[i], getattr(alone, name)[0]
            assert np.array_equal(*both, equal_nan=True), name


def test_steps_form_a_ladder_that_resolves_the_highest_mode():
    own, speeds = deck(), np.linspace(5.0, 120.0, 50)
    steps = [place_step(own, speed) for speed in speeds]
    assert len(set(steps)) < 8 and sorted(steps) == steps
    turns = 2 * np.pi * own.frequencies_hz[-1] * np.array(steps) / speeds
    assert np.all(turns <= constant.LARGEST_TURN * (1 + 1e-9))


def overdamped():
    own = rb.Beam("heavy", (L,), MU, EI).deck(modes=4, damping=(0.0, 8e-3))
    assert own.damping_ratios.max() > 1.0
    return own


def on_springs():
    """Shapes that are not zero where axles enter."""
    bearings = [
        rb.Bearing(x, fixed=("y", "roll") + ("x",) * (x == 0.0), stiffness={"z": 3e8})
        for x in (0.0, L)
    ]
    return rb.Beam("soft", (L,), MU, EI, bearings=tuple(bearings)).deck(modes=4, damping=0.01)


@pytest.mark.parametrize("make", [overdamped, on_springs])
def test_modes_that_do_not_swing_and_loads_that_jump(make):
    own, train = make(), rb.AxleTrain((0.0, 3.0, 14.0, 17.0), (170e3,) * 4)
    outputs = outputs_at(own, QUANTITIES, [L / 2])
    found = constant_loads(own, train, [50.0], outputs)
    run = rb.cross(train, own, speed=50.0, time_step=1e-4, interaction="rigid")
    w, a = peaks_of_run(run, outputs).largest[0]
    assert found.largest[0, 0] == pytest.approx(w, rel=3e-4)
    # Where loads step on at once, accelerations jump between the samples of both.
    assert found.largest[0, 1] == pytest.approx(a, rel=4e-3)


RAILS = {
    "sleepers": rb.Rail(spread=0.6),
    "bed": rb.Rail(bending_stiffness=1.28e7, foundation=1e8),
}


def told(values, outputs):
    """Values of outputs without rounding, as a row of a study has them."""
    units = [OUTPUTS[output.quantity] for output in outputs]
    return np.array(
        [without_rounding(v, unit)[0] for v, unit in zip(values[:, None], units, strict=True)]
    )


@pytest.mark.parametrize("name", RAILS)
@pytest.mark.parametrize("spans", [(L,), (20.0, 16.0)])
def test_loads_that_a_rail_spreads_are_those_of_whole_crossings(name, spans):
    """One crossing after the other, in time, at a step so fine that it no longer matters."""
    own = rb.Beam("rail", spans, MU, EI).deck(None, (0.5, 4e-4), rail=RAILS[name])
    train, speeds = rb.train("HSLM-A3"), [38.0, 71.0]
    outputs = outputs_at(own, (*QUANTITIES, "moment_vertical", "shear_vertical"), [0.0, 8.0, 12.5])
    found = constant_loads(own, train, speeds, outputs, tail=0.5)
    for i, speed in enumerate(speeds):
        run = rb.cross(train, own, speed=speed, time_step=1e-4, tail=0.5)
        exact = peaks_of_run(run, outputs)
        scale = np.maximum(exact.largest[0], 1e-9)
        for side in ("low", "high", "static_low", "static_high"):
            ours, theirs = (told(getattr(p, side)[k], outputs) for p, k in ((found, i), (exact, 0)))
            assert np.nanmax(np.abs(ours - theirs) / scale) < 1.5e-3, side
        clear = np.abs(told(found.low[i], outputs)) > 0.5 * scale
        assert found.low_time[i][clear] == pytest.approx(exact.low_time[0][clear], abs=2e-3)


def test_sleepers_that_step_on_an_end_that_moves_are_mended_one_by_one():
    """The impulse of each, against steps of 0.5 mm: without it 3e-4, or 1.5e-4 if mended as one."""
    bearings = tuple(rb.Bearing(x, (), stiffness={"z": 1e9}) for x in (0.0, L))
    beam = rb.Beam("soft", (L,), MU, EI, bearings=bearings)
    own = beam.deck(4, 0.02, rail=RAILS["sleepers"])
    outputs = outputs_at(own, ("displacement_z",), [L / 2])
    train = rb.AxleTrain((0.0, 3.1, 14.0), (170e3,) * 3)
    found = constant_loads(own, train, [50.0], outputs, tail=0.5)
    run = rb.cross(train, own, speed=50.0, time_step=1e-5, tail=0.5)
    assert found.low[0, 0] == pytest.approx(peaks_of_run(run, outputs).low[0, 0], rel=1e-5)
