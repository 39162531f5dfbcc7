"""The fixed point in windows of time is the coupled solution, where passes over the record grow."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.coupling import grows, prepare
from railbridge.direct.windows import in_windows
from railbridge.settings import check

CAR = rb.planar_car(rb.vehicle("xia2000"))
TRACK = rb.Track(vertical=rb.Harmonic(3e-3, wavelength=11.0))


def light(mass):
    return rb.Beam("light", (36.0,), mass, 8.8e10 * mass / 11850).deck(8, 0.01)


def apart(run, other):
    size = np.max(np.abs(other.wheel_forces - other.coupling.cars[0].static[0, 1]))
    return np.max(np.abs(run.wheel_forces - other.wheel_forces)) / size


def solved(train, deck, way, **options):
    chosen = {"speed": 20.0, "time_step": 2e-3, "tail": 0.1, "lead_in": 40.0} | options
    return rb.cross(train, deck, TRACK, interaction=way, **chosen)


@pytest.mark.parametrize("mass", [3e3, 1.2e3, 200.0])
def test_light_decks_converge_to_the_direct_solution(mass):
    train = rb.Train(CAR, cars=6)
    run = solved(train, light(mass), "iterate")
    assert run.converged and run.windows is not None
    assert apart(run, solved(train, light(mass), "direct")) < 1e-8


@pytest.mark.parametrize("loads", ["bogies", "condensed"])
def test_so_do_other_ways_of_loading(loads):
    train = rb.Train(CAR, cars=6)
    run = solved(train, light(1.5e3), "iterate", loads=loads)
    assert run.windows is not None
    assert apart(run, solved(train, light(1.5e3), "direct", loads=loads)) < 1e-8


def test_wheels_on_stiff_contacts():
    train = rb.Train(rb.with_wheelsets(CAR, mass=1800.0), cars=2)
    deck = light(6e3)
    run = solved(train, deck, "iterate", time_step=1e-3)
    assert run.windows is not None
    assert apart(run, solved(train, deck, "direct", time_step=1e-3)) < 1e-8


def test_windows_grow_and_shrink_and_are_told_of():
    run = solved(rb.Train(CAR, cars=6), light(1.2e3), "iterate")
    sizes = np.diff(np.concatenate([[0], run.windows.stops]))
    assert sizes.sum() == len(run.time) and sizes.max() > 2 * np.min(sizes[1:-1])
    assert run.windows.passes.max() < 50 and np.all(run.windows.changes < 1e-8)
    (remark,) = [str(r) for r in rb.remarks(run) if "windows" in str(r)]
    assert f"cut into {len(sizes)} windows in time" in remark
    assert f"in {run.windows.passes.max()} passes at most" in remark


def test_what_settles_over_the_whole_record_is_left_alone():
    run = solved(rb.Train(CAR, cars=2), light(12e3), "iterate")
    assert run.windows is None and run.iterations > 3
    settings = check(run.train, run.deck, TRACK, speed=20.0, time_step=2e-3, tail=0.1, lead_in=40.0)
    found = in_windows(prepare(run.train, run.deck, TRACK, settings))
    assert np.max(np.abs(found.state.q - run.state.q)) < 1e-8 * np.max(np.abs(run.state.q))


@pytest.mark.parametrize("tolerance_of", ["forces", "displacement"])
def test_what_settles_too_slowly_is_cut_into_windows_too(tolerance_of):
    """Passes that fall all the way, and are not at their end when as many as allowed are done."""
    train, deck = rb.Train(CAR, cars=4), light(8e3)
    options = {"tolerance_of": tolerance_of, "tolerance": 1e-10}
    assert solved(train, deck, "iterate", **options).iterations > 12
    run = solved(train, deck, "iterate", max_iterations=10, **options)
    assert run.converged and run.windows is not None
    assert apart(run, solved(train, deck, "direct")) < 1e-8
    (remark,) = [str(r) for r in rb.remarks(run) if "windows" in str(r)]
    assert "did not settle over the whole record" in remark
    # Who allows only a few passes means them.
    with pytest.raises(rb.NotConvergedError):
        solved(train, deck, "iterate", max_iterations=9, **options)


def test_given_passes_and_relaxation_stay_what_they_are():
    train, deck = rb.Train(CAR, cars=4), light(2e3)
    assert solved(train, deck, "iterate", iterations=6).windows is None
    assert solved(train, deck, "iterate", relaxation=0.4, max_iterations=200).windows is None


def test_the_motion_of_cars_and_bodies_is_that_of_the_direct_solution():
    train, deck = rb.Train(CAR, cars=6), light(1.5e3)
    run, other = (solved(train, deck, way) for way in ("iterate", "direct"))
    assert run.windows is not None
    for asked in ("body_accelerations", "wheel_unloading"):
        a, b = getattr(run, asked), getattr(other, asked)
        assert np.max(np.abs(a - b)) < 1e-7 * np.max(np.abs(b))


@pytest.mark.parametrize(
    ("changes", "answer"),
    [
        ([1.0, 0.5, 0.2], False),
        ([0.2, 0.5, 0.3], False),
        ([0.2, 0.3], False),
        ([1.0, 0.2, 0.3, 0.5], True),
        ([1.0, 1e-12, 2e-12, 3e-12], False),
    ],
)
def test_growth_is_two_rises_in_a_row_above_round_off(changes, answer):
    assert grows(changes) is answer
