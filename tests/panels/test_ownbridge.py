"""The panel of a bridge by its numbers: what it says is what the case's assessment says."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import panels
from railbridge.cases.simplebridge import SimpleBridge
from railbridge.errors import InputError

pytest.importorskip("xarray")


@pytest.fixture(scope="module")
def panel():
    return panels.own_bridge()


def test_the_summary_is_that_of_the_code(panel):
    panel.reset()
    names = {}
    lines = panel.code.replace("rb.plots.", "0 and rb.plots.").splitlines()
    exec("\n".join(lines[:-1]), names)
    value = eval(lines[-1], names)
    assert f"largest acceleration {value:.2f} m/s2 (not met), limit 3.5" in panel.summary
    assert "Not met: deck acceleration; not decided: " in panel.summary


@pytest.mark.parametrize(
    "change",
    [
        {"line_speed": 40.0}, {"span": 30.0}, {"mass": 20e3}, {"stiffness": 6e10},
        {"damping": 0.02}, {"train": "ICE2"},
    ],
)  # fmt: skip
def test_every_control_changes_picture_and_words(panel, change):
    panel.reset()
    before = panel.image.value, panel.summary
    panel.set(**change)
    assert panel.image.value != before[0] and panel.summary != before[1]
    panel.reset()
    assert panel.summary == before[1]


def test_it_is_the_assessment_of_its_case(panel):
    panel.set(line_speed=75.0, train="HSLM-A4")
    found = panel.case.assess(stations=5)
    worst = next(row for row in found.verdicts if row.clause.title == "deck acceleration")
    assert f"largest acceleration {worst.value:.2f} m/s2" in panel.summary
    # To 1.2 times the speed of the line.
    assert found.envelope.speed.values[-1] == pytest.approx(90.0)
    panel.reset()


def test_a_bridge_of_ones_own_is_taken():
    own = SimpleBridge(
        span=12.0, mass=9e3, bending_stiffness=1e10, kind="composite", line_speed=50.0,
        track="direct fastening",
    )  # fmt: skip
    shown = panels.own_bridge(own.case({"name": "ICE2"}))
    assert "12.0 m, 9.0 t/m" in shown.summary and "limit 5.0" in shown.summary
    shown.close()
    with pytest.raises(InputError):
        panels.own_bridge(rb.case("paper"))


def test_a_case_without_checks_says_what_is_missing():
    with pytest.raises(InputError, match="line_speed") as found:
        rb.case("paper").assess()
    assert found.value.field == "checks"


def test_speeds_of_a_line_reach_beyond_its_own():
    speeds = rb.checks.usual_speeds(rb.Requirements(line_speed=50.0))
    assert (speeds[0], speeds[-1]) == (20.0, 60.0)
    assert np.diff(speeds).max() <= 0.5 + 1e-12
    assert len(rb.checks.usual_speeds(rb.Requirements(line_speed=50.0), 7)) == 7
    # A slow line is looked at to 40 m/s, a fast one from there.
    assert rb.checks.usual_speeds(rb.Requirements(line_speed=20.0))[-1] == 40.0
    assert rb.checks.usual_speeds(rb.Requirements(line_speed=110.0))[0] == 40.0


def test_an_acceleration_that_is_not_decided_is_told_as_far_as_known():
    own = SimpleBridge(
        span=20.0, mass=20000.0, bending_stiffness=5e10, kind="steel", line_speed=50.0, damping=0.03
    ).case({"name": "ICE2"}).replace({"deck.modes": 3})  # fmt: skip
    shown = panels.own_bridge(own)
    found = own.assess(stations=5)
    row = next(row for row in found.verdicts if row.clause.title == "deck acceleration")
    assert row.verdict == "cannot decide" and row.value is None
    known = found.envelope.acceleration_z.max().item()
    assert f"largest acceleration {known:.2f} m/s2 (cannot decide), limit 3.5" in shown.summary
    shown.close()
