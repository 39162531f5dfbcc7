"""Which way a crossing of a study is computed, and what comes of one that fails."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.cautions import transient
from railbridge.studies import engine
from railbridge.studies.engine import NUMBERS, Asked, Job, asked_of, respond
from railbridge.studies.lanes import KNOWN
from railbridge.studies.outputs import outputs_at


@pytest.fixture(scope="module")
def case():
    return rb.case("paper").replace({"train.cars": 1, "run.loads": "wheels", "run.iterations": 2})


def job_of(case):
    return Job(case.train, case.track, case.settings)


def test_rows_come_in_the_order_of_the_jobs_whichever_way_they_went(case):
    loads = case.replace({"train": {"name": "HSLM-A1"}, "run.iterations": None})
    asked = asked_of(outputs_at(case.deck, ("displacement_z",), [18.0]), ("wheel_unloading",))
    jobs = [job_of(case), job_of(loads), job_of(case.replace({"run.speed": 30.0})), job_of(loads)]
    rows = respond(case.deck, jobs, asked)
    largest = [row.peaks(asked).largest[0, 0] for row in rows]
    assert largest[1] == largest[3] != largest[0]
    assert largest[0] == abs(case.compute().displacement(18.0).extreme("displacement_z")[0])
    assert rows[1].numbers(asked) == {"wheel_unloading": 0.0}
    assert rows[0].numbers(asked)["wheel_unloading"] > 0.1


@pytest.mark.parametrize("name", NUMBERS)
def test_numbers_are_those_of_the_run(case, name):
    run = case.compute()
    expected = {
        "wheel_unloading": run.wheel_unloading.max(),
        "wheel_force_z": -run.wheel_forces[:, 1].min(),
        "deviation_from_rigid": run.deviations.from_rigid[-1],
        "body_acceleration_z": np.abs(run.body_accelerations[:, :, 1]).max(),
        "iterations": 2,
        "left_open": run.changes[1] ** 2 / (run.changes[0] - run.changes[1]),
        "transient": transient(run),
    }
    (row,) = respond(case.deck, [job_of(case)], asked_of((), (name,)))
    assert row.numbers(asked_of((), (name,)))[name] == pytest.approx(expected[name], rel=1e-12)


def test_side_by_side_gives_what_one_by_one_does(case):
    asked = asked_of(
        outputs_at(case.deck, ("displacement_z", "acceleration_z"), [18.0]), tuple(KNOWN)
    )
    jobs = [
        job_of(case.replace({"run.speed": v, "track.vertical.wavelength": w}))
        for v in (20.0, 31.0)
        for w in (9.0, 14.4, 25.0)
    ]
    jobs = [Job(case.train, job.track, job.settings) for job in jobs]
    one, other = (
        np.array([row.values for row in respond(case.deck, jobs, asked, side)])
        for side in (False, True)
    )
    assert not np.array_equal(one, other), "they are sampled at other places"
    assert other[:, 0] == pytest.approx(one[:, 0], rel=1e-4)
    assert other[:, 1] == pytest.approx(one[:, 1], rel=3e-3), "accelerations: steps that differ"
    unloading, force, deviation, passes = other[:, -4:].T
    assert unloading == pytest.approx(one[:, -4], rel=1e-3)
    assert force == pytest.approx(one[:, -3], rel=1e-4)
    # Eq. 3 hangs on where the record ends, here within one sample: hundredths of a per cent.
    assert deviation == pytest.approx(one[:, -2], abs=0.05)
    assert passes.tolist() == one[:, -1].tolist()


def test_a_crossing_that_does_not_converge_is_a_row_with_its_message(case):
    never = case.replace({"run.iterations": None, "run.max_iterations": 2})
    asked = asked_of(outputs_at(case.deck, ("displacement_z",), [18.0]))
    bad, good = respond(case.deck, [job_of(never), job_of(case)], asked)
    assert np.isnan(bad.values).all() and "not converged" in bad.message
    assert np.isfinite(good.values).all() and good.message == ""


def test_what_is_not_finite_is_no_result(case, monkeypatch):
    whole = engine.peaks_of_run
    monkeypatch.setattr(engine, "peaks_of_run", lambda run, outputs: _spoiled(whole(run, outputs)))
    asked = asked_of(outputs_at(case.deck, ("displacement_z",), [18.0]))
    (row,) = respond(case.deck, [job_of(case)], asked)
    assert np.isnan(row.values).all() and "not finite" in row.message


def _spoiled(peaks):
    peaks.low[:] = np.inf
    return peaks


def test_more_numbers_come_from_the_whole_run(case):
    asked = Asked((), (), {"last change": lambda run: run.changes[-1]})
    (row,) = respond(case.deck, [job_of(case)], asked)
    assert row.numbers(asked) == {"last change": case.compute().changes[-1]}


def test_an_unknown_number_is_refused_with_the_nearest():
    with pytest.raises(rb.InputError, match="Did you mean 'wheel_unloading'"):
        asked_of((), ("wheel_unload",))


@pytest.mark.parametrize("interaction", ["direct", "rigid", "iterate"])
def test_passes_are_those_of_the_summary(case, interaction):
    case = case.replace({"run.interaction": interaction, "run.iterations": None, "run.tail": 0.0})
    told = case.summary(case.compute())["iterations"]
    (row,) = respond(case.deck, [job_of(case)], asked_of((), ("iterations",)))
    assert row.numbers(asked_of((), ("iterations",))) == {"iterations": told}
    assert (told > 2) == (interaction == "iterate")
