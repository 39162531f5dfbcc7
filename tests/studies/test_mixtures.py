"""Waves of any size and phase from five crossings, against each crossing by itself."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.crossing import compute
from railbridge.studies import mixtures
from railbridge.studies.engine import Job, asked_of, respond, row_of_run
from railbridge.studies.lanes import KNOWN
from railbridge.studies.mixtures import mixture_key, run_mixtures
from railbridge.studies.outputs import outputs_at

NAMES = ("displacement_z", "acceleration_y", "moment_vertical", "torsion")
BASE = {"train.cars": 2, "run.loads": "wheels", "run.iterations": 2, "run.time_step": 2e-3}


def waves(count, seed=1):
    draw = np.random.default_rng(seed).uniform
    for _ in range(count):
        yield {
            "track.vertical.amplitude": draw(0.0, 5e-3),
            "track.vertical.phase": draw(-3.0, 3.0),
            "track.lateral.amplitude": draw(0.0, 3e-3),
            "track.lateral.phase": draw(-3.0, 3.0),
        }


def rails(left, right):
    wave = {"kind": "harmonic", "wavelength": 14.4}
    return {
        "left": {**wave, "amplitude": left[0], "phase": left[1]},
        "right": {**wave, "amplitude": right[0], "phase": right[1]},
    }


def compare(base, changes):
    cases = [base.replace(change) for change in changes]
    asked = asked_of(outputs_at(base.deck, NAMES, [18.0, 3.0]), tuple(KNOWN))
    jobs = [Job(base.train, case.track, case.settings) for case in cases]
    assert len({mixture_key(job, asked.numbers, False) for job in jobs}) == 1
    found = run_mixtures(base.deck, jobs, asked.outputs, asked.numbers)
    for job, values in zip(jobs, found, strict=True):
        run = compute(job.train, base.deck, job.track, job.settings)
        expected = row_of_run(run, asked).values
        assert values == pytest.approx(expected, rel=1e-9, abs=1e-12, nan_ok=True)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"run.loads": "condensed"},
        {"run.interaction": "rigid", "run.iterations": None},
        {"run.excitation": "car", "run.feedback": "vertical"},
        {"run.lead_in": 0.0},
    ],
    ids=["wheels", "condensed", "rigid", "in phase", "no run-up"],
)
def test_a_mixture_is_the_crossing_itself(changes):
    compare(rb.case("paper").replace(BASE | changes), list(waves(3)))


def test_rails_that_differ_make_nine():
    base = rb.case("paper").replace(BASE)
    changes = [{"track.vertical": rails((2e-3, 0.3), (5e-3, phase))} for phase in (0.0, 1.0, 2.0)]
    compare(base, changes)
    tracks, shares = mixtures._basis([base.replace(change).track for change in changes])
    assert len(tracks) == shares.shape[1] == 7
    assert shares.sum(axis=1) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "changes",
    [
        {"run.iterations": None},
        {"run.relaxation": 0.5},
        {"track": {}},
        {"track.vertical": {"kind": "table", "x": [0.0, 40.0], "r": [0.0, 1e-3]}},
        {"train": {"axles": [0.0, 2.5], "loads": [1e5, 1e5]}},
    ],
    ids=["to a tolerance", "relaxed", "level", "measured", "constant loads"],
)
def test_what_is_no_mixture(changes):
    case = rb.case("paper").replace(BASE | changes)
    assert mixture_key(Job(case.train, case.track, case.settings), (), False) is None


def test_another_speed_or_wavelength_is_no_mixture_of_this():
    base = rb.case("paper").replace(BASE)
    keys = set()
    for changes in ({}, {"run.speed": 21.0}, {"track.vertical.wavelength": 15.0}):
        case = base.replace(changes)
        keys.add(mixture_key(Job(base.train, case.track, case.settings), (), False))
    assert len(keys) == 3


def test_a_study_over_phases_computes_five(monkeypatch):
    """And gives what each crossing by itself gives."""
    case = rb.case("paper").replace(BASE | {"train.cars": 1})
    counted = []
    monkeypatch.setattr(mixtures, "compute", lambda *given: counted.append(1) or compute(*given))
    sizes = [1e-3, 5e-3]
    over = {"track.vertical.phase": np.linspace(0.0, 3.0, 7), "track.vertical.amplitude": sizes}
    found = rb.sweep(case, over, measure=("displacement_z", "wheel_unloading"))
    assert len(counted) == 5
    own = case.replace({"track.vertical.phase": 1.0, "track.vertical.amplitude": 5e-3}).compute()
    at = found.sel(phase=1.0, amplitude=5e-3)
    assert at.wheel_unloading.item() == pytest.approx(own.wheel_unloading.max(), rel=1e-9)
    w = abs(own.displacement(18.0).extreme("displacement_z")[0])
    assert at.displacement_z.item() == pytest.approx(w, rel=1e-9)
    counted.clear()
    rb.sweep(case, {"track.vertical.phase": [0.0, 1.0]})
    assert not counted, "two crossings are less than five"


def test_one_that_is_marked_but_cannot_be_mixed_is_computed_by_itself():
    case = rb.case("paper").replace(BASE | {"run.iterations": None, "train.cars": 1})
    asked = asked_of(outputs_at(case.deck, ("displacement_z",), [18.0]))
    (row,) = respond(case.deck, [Job(case.train, case.track, case.settings, True)], asked)
    assert not row.message and np.isfinite(row.values).all()


def test_crossings_on_a_deck_with_a_rail_are_mixed_too():
    """Eq. 3 counts from t = 0, which is not the first sample there."""
    bed = {"bending_stiffness": 1.28e7, "foundation": 1e8}
    compare(rb.case("paper").replace({**BASE, "deck.rail": bed}), list(waves(3)))
