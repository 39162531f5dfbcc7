"""A deck and its trains against the clauses, held against closed forms of the tests' own."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.checks import assessment
from railbridge.units import G

L, M, EI = 20.0, 1e4, 4.1e9
NEEDS = rb.Requirements(line_speed=37.5, kind="steel")
"""Of which 45 m/s is 1.2 times."""
ROWS = (
    "deflection", "first lateral frequency of a span", "damping of the deck", "deck acceleration",
    "moment by dynamic analysis", "twist over 3 m", "total twist over 3 m",
    "horizontal rotation of a deck's end", "radius of a deck bent sideways", "comfort b_v",
    "wheel unloading", "least reaction of a bearing",
)  # fmt: skip


def deck(modes=6, damping=0.0, **properties):
    return rb.Beam("beam", (L,), M, EI, **properties).deck(modes, damping)


def rows(verdicts):
    return {row.clause.title: row for row in verdicts}


class Series:
    """A force P that crosses an undamped simple beam, in a series of modes; while it is on it."""

    def __init__(self, force, speed):
        self.speed, self.force = speed, force
        self.time = np.linspace(0.0, L / speed, 20001)

    def terms(self, modes):
        for n in range(1, modes + 1):
            k = n * np.pi / L
            omega, drive = k**2 * np.sqrt(EI / M), k * self.speed
            size = 2 * self.force / (M * L) / (omega**2 - drive**2)
            q = size * (np.sin(drive * self.time) - drive / omega * np.sin(omega * self.time))
            a = (
                size
                * drive
                * (omega * np.sin(omega * self.time) - drive * np.sin(drive * self.time))
            )
            yield k, q, a

    def acceleration(self, modes):
        """The largest at the 41 stations along the beam."""
        x = np.linspace(0.0, L, 41)
        total = sum(np.outer(np.sin(k * x), a) for k, _, a in self.terms(modes))
        return np.abs(total).max()

    def moment(self, modes=400):
        return max(sum(EI * k**2 * q * np.sin(k * L / 2) for k, q, _ in self.terms(modes)))


@pytest.fixture(scope="module")
def single():
    train = rb.AxleTrain((0.0,), (200e3,), name="one force")
    return rb.assess(deck(), train, [40.0, 45.0], NEEDS, tail=0.0)


def test_there_is_a_row_for_each_clause(single):
    assert tuple(row.clause.title for row in single.verdicts) == ROWS
    assert single.verdicts.to_frame()["what"].tolist() == list(ROWS)


def test_the_acceleration_is_that_of_the_series(single):
    row = rows(single.verdicts)["deck acceleration"]
    # f = 2.5, 10, 22.6, 40 Hz: three modes up to 30 Hz.
    assert row.reason == "modes 1-3 up to 30 Hz"
    by_speed = {v: Series(200e3, v).acceleration(3) for v in (40.0, 45.0)}
    assert row.value == pytest.approx(max(by_speed.values()), rel=1e-3)
    speed = max(by_speed, key=by_speed.get)
    assert row.when == f"one force at {speed:g} m/s ({3.6 * speed:g} km/h)"


def test_the_moment_is_that_of_the_series(single):
    row = rows(single.verdicts)["moment by dynamic analysis"]
    moving = max(Series(200e3, v).moment() for v in (40.0, 45.0))
    # n0 = 2.5 Hz is below Figure 6.10, so phi'' is not known.
    assert row.verdict == "cannot decide" and "phi'' left out" in row.reason
    found = single.per_train().loc[("one force", "moment by dynamic analysis"), "value"]
    assert found == pytest.approx(moving, rel=2e-3)
    assert moving > 1.1 * 200e3 * L / 4


def test_moments_count_the_unevenness_of_the_track():
    stiff = rb.Beam("beam", (L,), M, 2e10).deck(6, 0.0)
    train = rb.AxleTrain((0.0,), (200e3,))
    found = rb.assess(stiff, train, [45.0], NEEDS, tail=0.0)
    row = rows(found.verdicts)["moment by dynamic analysis"]
    n0, static = np.pi / (2 * L**2) * np.sqrt(2e10 / M), 200e3 * L / 4
    alpha, exp = 1.0, np.exp
    unevenness = alpha / 100 * (56 * exp(-4.0) + 50 * (L * n0 / 80 - 1) * exp(-1.0))
    own = Series(200e3, 45.0)
    own.terms = lambda modes: _terms_of(own, 2e10, modes)
    assert row.value == pytest.approx(own.moment() + unevenness / 2 * static, rel=2e-3)
    phi3 = 2.16 / (np.sqrt(L) - 0.2) + 0.73
    # LM71 on 20 m: a force at mid-span, the load per metre from 2.4 m before and 4 m behind it.
    lm71 = 250e3 * (5.0 + 4.2 + 4.2 + 3.4) + 80e3 * (7.6**2 / 4 + 6.0**2 / 4)
    assert row.limit == pytest.approx(phi3 * lm71, rel=1e-9)


def _terms_of(series, stiffness, modes):
    for n in range(1, modes + 1):
        k = n * np.pi / L
        omega, drive = k**2 * np.sqrt(stiffness / M), k * series.speed
        size = 2 * series.force / (M * L) / (omega**2 - drive**2) * stiffness / EI
        sines = np.sin(drive * series.time), np.sin(omega * series.time)
        yield k, size * (sines[0] - drive / omega * sines[1]), None


def test_the_verdict_flips_where_the_acceleration_reaches_its_limit(single):
    reached = 3.5 / rows(single.verdicts)["deck acceleration"].value
    for share, verdict in ((1.0 - 1e-6, "met"), (1.0 + 1e-6, "not met")):
        train = rb.AxleTrain((0.0,), (200e3 * reached * share,))
        found = rb.assess(deck(), train, [40.0, 45.0], NEEDS, tail=0.0)
        assert rows(found.verdicts)["deck acceleration"].verdict == verdict
        direct = replace(NEEDS, track="direct fastening")
        found = rb.assess(deck(), train, [40.0, 45.0], direct, tail=0.0)
        row = rows(found.verdicts)["deck acceleration"]
        assert row.limit == 5.0 and row.verdict == "met"


def test_speeds_that_do_not_cover_leave_nothing_met():
    train = rb.AxleTrain((0.0,), (50e3,))
    needs = replace(NEEDS, line_speed=45.0)
    found = rb.assess(deck(), train, [40.0, 45.0], needs)
    row = rows(found.verdicts)["deck acceleration"]
    assert row.verdict == "cannot decide" and "do not cover 40 to 54 m/s" in row.reason
    assert not bool(found.rules["speeds_covered"])
    heavy = rb.assess(deck(), rb.AxleTrain((0.0,), (2e6,)), [40.0, 45.0], needs)
    assert rows(heavy.verdicts)["deck acceleration"].verdict == "not met"


def test_modes_that_may_be_missing_leave_an_acceleration_open():
    for modes, verdict, said in (
        (3, "cannot decide", "last mode has 22.6"), (2, "cannot decide", "third frequency"),
        (4, "met", "modes 1-3"),
    ):  # fmt: skip
        train = rb.AxleTrain((0.0,), (20e3,))
        found = rb.assess(deck(modes), train, [40.0, 45.0], NEEDS)
        row = rows(found.verdicts)["deck acceleration"]
        assert row.verdict == verdict and said in row.reason


def test_a_couple_twists_the_track_as_by_hand():
    """P at a, e beside the axis, turns what is before it by P e (1 - a / L) x / GJ."""
    e, force, stiffness = 1.5, 2e6, 2e9
    own = deck(12, 0.05, torsional_stiffness=stiffness, polar_inertia=2e4)
    train = rb.AxleTrain((0.0,), (force,))
    found = rb.assess(own, train, [0.5], NEEDS, track_offset=e)
    row = rows(found.verdicts)["twist over 3 m"]
    by_hand = 1.435 * force * e * 3.0 * (1.0 - 3.0 / L) / stiffness
    values = found.per_train().loc["train 1", "value"]
    assert values["twist over 3 m"] == pytest.approx(by_hand, rel=5e-3)
    assert row.verdict == "not met" and row.where in (0.0, L - 3.0)
    total = rb.assess(own, train, [0.5], replace(NEEDS, track_twist=0.001), track_offset=e)
    assert total.per_train().loc[("train 1", "total twist over 3 m"), "value"] == pytest.approx(
        by_hand + 0.001, rel=5e-3
    )


@pytest.mark.parametrize(("share", "verdict"), [(0.998, "met"), (1.002, "not met")])
def test_the_far_end_of_two_spans_lifts_where_statics_say_so(share, verdict):
    """A force in the other span takes at most P / (6 sqrt 3) from an end; 3 w l / 8 is there."""
    own = rb.Beam("two", (L, L), M, 2e11).deck(8, 0.05)
    lifting = 3 / 8 * M * G * L * 6 * np.sqrt(3.0)
    train = rb.AxleTrain((0.0,), (lifting * share,))
    row = rows(rb.assess_run(rb.cross(train, own, speed=1.0), NEEDS))["least reaction of a bearing"]
    assert row.verdict == verdict and row.where[:9] in ("bearing 1", "bearing 3")
    assert row.value == pytest.approx((1.0 - share) * 3 / 8 * M * G * L, abs=1e-3 * M * G * L)


def test_a_line_that_holds_twist_hides_its_bearings():
    twisting = {"torsional_stiffness": 2e9, "polar_inertia": 2e4}
    train = rb.AxleTrain((0.0,), (100e3,))
    hidden = rb.assess(deck(**twisting), train, [40.0, 45.0], NEEDS, track_offset=1.0)
    row = rows(hidden.verdicts)["least reaction of a bearing"]
    assert row.verdict == "cannot decide" and "hides its single bearings" in row.reason
    apart = tuple(rb.Bearing(x, ("y", "z"), y=y) for x in (0.0, L) for y in (-2.0, 2.0))
    beside = deck(bearings=apart, **twisting)
    found = rb.assess(beside, train, [40.0, 45.0], NEEDS, track_offset=1.0)
    row = rows(found.verdicts)["least reaction of a bearing"]
    assert row.verdict == "met" and "y = " in row.where
    assert row.value < M * L * G / 4  # relieved by the couple


# ---- trains with cars


@pytest.fixture(scope="module")
def cars():
    case = rb.case("paper").replace({"train.cars": 2, "run.loads": "wheels"})
    options = {"track_offset": 2.4, "iterations": 2}
    needs = rb.Requirements(line_speed=40.0, kind="prestressed concrete", track_twist=1e-3)
    found = rb.assess(case.deck, {"two cars": case.train}, [40.0], needs, track=case.track,
                      **options)  # fmt: skip
    run = rb.cross(case.train, case.deck, case.track, speed=40.0, **options)
    return found, run, needs


def test_one_crossing_is_judged_alike_by_both(cars):
    found, run, needs = cars
    for one, other in zip(found.verdicts, rb.assess_run(run, needs), strict=True):
        assert one.clause is other.clause and one.verdict == other.verdict
        assert one.value == other.value and one.where == other.where
        assert one.reason == other.reason


def test_coaches_and_wheels_are_those_of_the_run(cars):
    found, run, _ = cars
    row = rows(found.verdicts)
    vertical = np.abs(run.body_accelerations[:, :, 1])
    car, place, _ = np.unravel_index(vertical.argmax(), vertical.shape)
    assert row["comfort b_v"].value == vertical.max()
    assert row["comfort b_v"].where == f"car {car + 1}, {('front', 'middle', 'rear')[place]}"
    assert row["wheel unloading"].value == run.wheel_unloading.max()
    assert row["wheel unloading"].where.startswith("car ")
    assert "phi'' left out: the track's irregularity" in row["moment by dynamic analysis"].reason


def test_sideways_nothing_is_met_by_trains_alone(cars):
    found, _, _ = cars
    for name in ("horizontal rotation of a deck's end", "radius of a deck bent sideways"):
        row = rows(found.verdicts)[name]
        assert row.verdict == "cannot decide" and "wind, nosing" in row.reason


def test_axle_loads_leave_coaches_open_beside_cars(cars):
    _, run, needs = cars
    trains = {"two cars": run.train, "force": rb.AxleTrain((0.0,), (1e5,))}
    found = rb.assess(run.deck, trains, [40.0], needs, track_offset=2.4, iterations=2)
    comfort = rows(found.verdicts)["comfort b_v"]
    assert comfort.verdict == "cannot decide" and "force: only axle loads" in comfort.reason
    per_train = found.per_train()
    assert per_train.loc[("two cars", "comfort b_v"), "verdict"] == "met"
    assert per_train.loc[("force", "comfort b_v"), "verdict"] == "cannot decide"
    assert per_train.loc[("two cars", "comfort b_v"), "speed"] == 40.0
    # Without irregularities a wheel keeps nearly all of its load, which says nothing.
    unloading = per_train.loc[("two cars", "wheel unloading")]
    assert unloading["verdict"] == "cannot decide" and 0.0 < unloading["value"] < 0.6


def test_comfort_is_asked_up_to_the_speed_of_the_line(cars):
    _, run, needs = cars
    faster = rb.assess(run.deck, {"two": run.train}, [40.0, 50.0], needs, iterations=2)
    assert "at 40 m/s" in rows(faster.verdicts)["comfort b_v"].when
    above = rb.assess(run.deck, {"two": run.train}, [50.0], needs, iterations=2)
    assert rows(above.verdicts)["comfort b_v"].verdict == "cannot decide"


# ---- the whole


def test_both_ways_agree_on_constant_loads():
    own, train = deck(6, 0.02), rb.train("HSLM-A1")
    found = rb.assess(own, train, [60.0], replace(NEEDS, line_speed=50.0))
    run = rb.cross(train, own, speed=60.0, time_step=2.5e-4)
    other = rows(rb.assess_run(run, replace(NEEDS, line_speed=50.0)))
    assert len(other) == len(ROWS)
    acceleration = rows(found.verdicts)["deck acceleration"]
    assert acceleration.verdict == "not met" == other["deck acceleration"].verdict
    assert other["deck acceleration"].value == pytest.approx(acceleration.value, rel=5e-3)
    moments = found.per_train().loc["HSLM-A1", "value"]
    assert "phi'' left out" in other["moment by dynamic analysis"].reason
    low = float(found.envelope.moment_vertical.sel(x=L / 2).squeeze())
    assert moments["moment by dynamic analysis"] == pytest.approx(low)


def test_the_worst_of_trains_and_speeds_is_in_the_table():
    trains = {"A1": rb.train("HSLM-A1"), "light": rb.AxleTrain((0.0,), (1e4,))}
    found = rb.assess(deck(4, 0.01), trains, [40.0, 50.0, 60.0], replace(NEEDS, line_speed=50.0))
    envelope = found.envelope.acceleration_z
    assert dict(found.envelope.sizes)["train"] == 2 and float(envelope.x.min()) == 0.0
    row = rows(found.verdicts)["deck acceleration"]
    assert row.value == pytest.approx(float(envelope.max()))
    place = envelope.stack(all=envelope.dims).idxmax("all").item()
    assert place[0] == "A1" and row.when.startswith(f"A1 at {place[1]:g} m/s")
    assert row.where == place[2]
    own = found.per_train()
    assert own.loc[("light", "deck acceleration"), "value"] < row.value
    assert own.loc[("A1", "deck acceleration"), "speed"] == place[1]
    assert found.verdict == "not met"
    assert "n0_within_bounds" in found.rules_frame().index


def test_chosen_speeds_find_the_peak():
    needs, train = replace(NEEDS, line_speed=50.0), rb.train("HSLM-A1")
    found = rb.assess(deck(4, 0.01), train, rb.studies.Between(40.0, 60.0), needs)
    assert len(found.envelope.speed) > 100 and bool(found.rules["speeds_covered"])
    fine = rb.assess(deck(4, 0.01), train, np.linspace(40.0, 60.0, 801), needs)
    both = [rows(f.verdicts)["deck acceleration"].value for f in (found, fine)]
    assert both[0] == pytest.approx(both[1], rel=1e-2)


def test_a_crossing_that_fails_leaves_a_gap():
    needs = replace(NEEDS, line_speed=50.0)
    found = rb.assess(deck(4), rb.train("HSLM-A1"), [40.0, 150.0], needs, time_step=0.01)
    row = rows(found.verdicts)["deck acceleration"]
    assert "1 of 2 crossings failed: HSLM-A1 at 150 m/s (540 km/h)" in row.reason or (
        row.verdict == "not met"
    )
    moment = rows(found.verdicts)["moment by dynamic analysis"]
    assert moment.verdict == "cannot decide" and "1 of 2 crossings failed" in moment.reason


def test_modes_alone_leave_forces_open():
    full = deck(6, 0.01)
    own = replace(full, recovery=None)
    found = rb.assess(own, rb.train("HSLM-A1"), [40.0, 60.0], replace(NEEDS, line_speed=50.0))
    row = rows(found.verdicts)
    for name in ("moment by dynamic analysis", "least reaction of a bearing"):
        assert row[name].verdict == "cannot decide" and "only its modes" in row[name].reason
    assert "modes alone" in row["deflection"].reason or row["deflection"].verdict == "not met"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"deck": 5}, "deck"),
        ({"needs": {"line_speed": 50.0}}, "needs.*must be a Requirements"),
        ({"speeds": []}, "speeds.*at least one"),
        ({"trains": []}, "trains.*at least one"),
        ({"track_offset": "left"}, "track_offset.*names no tracks"),
        ({"track": 3}, "track"),
        ({"speed": 30.0}, "speed.*is given by speeds"),
    ],
)
def test_bad_input_is_refused(changes, said):
    given = {
        "deck": deck(2), "trains": rb.train("HSLM-A1"), "speeds": [40.0], "needs": NEEDS,
    }  # fmt: skip
    with pytest.raises(rb.InputError, match=said):
        rb.assess(**(given | changes))


def test_the_names_are_offered_at_the_top():
    assert rb.assess is assessment.assess and rb.Assessment is assessment.Assessment


# ---- what options and speeds leave out


def test_no_option_takes_modes_from_the_acceleration_that_the_clause_counts():
    own, train = deck(6, 0.02), rb.train("HSLM-A1")
    plain = rows(rb.assess(own, train, [60.0], NEEDS).verdicts)["deck acceleration"]
    run = rb.cross(train, own, speed=60.0, acceleration_modes=5.0)
    of_run = rows(rb.assess_run(run, NEEDS))["deck acceleration"]
    whole = rb.assess_run(rb.cross(train, own, speed=60.0), NEEDS)
    assert of_run.value == rows(whole)["deck acceleration"].value
    coaches = rb.Train(rb.vehicle("xia2000"), cars=1)
    for moving in (train, coaches):
        values = [
            rows(rb.assess(own, moving, [60.0], NEEDS, **option).verdicts)["deck acceleration"]
            for option in ({}, {"acceleration_modes": 5.0}, {"acceleration_modes": "en1990"})
        ]
        known = [row.value if row.value is not None else row.reason for row in values]
        assert known[0] == known[1] == known[2]
    assert plain.reason == of_run.reason
    with pytest.raises(rb.InputError, match="acceleration_modes = 'few'"):
        rb.assess(own, train, [60.0], NEEDS, acceleration_modes="few")


def test_coaches_that_do_not_feel_the_deck_are_not_judged():
    coaches, own = rb.Train(rb.vehicle("xia2000"), cars=1), deck(6, 0.01)
    rough = rb.Track(vertical=rb.Harmonic(1e-4, wavelength=20.0))
    found = rb.assess(own, coaches, [40.0, 45.0], NEEDS, track=rough, interaction="rigid")
    run = rb.cross(coaches, own, rough, speed=37.5, interaction="rigid")
    for verdicts in (found.verdicts, rb.assess_run(run, NEEDS)):
        for name in ("comfort b_v", "wheel unloading"):
            row = rows(verdicts)[name]
            assert row.verdict == "cannot decide"
    assert "do not feel the deck" in rows(rb.assess_run(run, NEEDS))["comfort b_v"].reason


def test_crossings_slower_than_the_line_meet_nothing():
    # 5.32 Hz at 20 m is within Figure 6.10: no dynamic analysis is needed up to 200 km/h.
    stiff = rb.Beam("beam", (L,), 12e3, 2.2e10).deck(6, 0.01)
    coaches = rb.Train(rb.vehicle("xia2000"), cars=1)
    rough = rb.Track(vertical=rb.Harmonic(1e-3, wavelength=20.0))
    needs = replace(NEEDS, line_speed=50.0)
    own = ("deck acceleration", "moment by dynamic analysis", "comfort b_v", "wheel unloading")
    for speeds, met in (([5.0, 6.0], ()), ([5.0, 55.0], own[:2] + own[3:]), ([48.0, 50.0], own)):
        found = rows(rb.assess(stiff, coaches, speeds, needs, track=rough).verdicts)
        assert tuple(name for name in own if found[name].verdict == "met") == met
    slow = rows(rb.assess(stiff, coaches, [6.0], needs, track=rough).verdicts)
    assert "6 m/s does not reach the line's 50 m/s" in slow["comfort b_v"].reason


def test_a_deck_whose_ends_move_leaves_its_acceleration_open():
    soft = [
        rb.Bearing(x, held, stiffness={"z": 2e9}) for x, held in ((0.0, "x y roll"), (L, "y roll"))
    ]
    own = rb.Beam("beam", (L,), 12e3, 2.2e10, bearings=soft).deck(8, 0.005)
    train, needs = rb.train("HSLM-A1"), replace(NEEDS, line_speed=60.0)
    speeds = [*np.arange(40.0, 72.0, 5.0), 72.0]
    row = rows(rb.assess(own, train, speeds, needs).verdicts)["deck acceleration"]
    assert row.verdict == "cannot decide" and "an end of the deck moves" in row.reason
    on_bed = replace(own, rail=rb.Rail(bending_stiffness=1.28e7, foundation=1e8))
    row = rows(rb.assess(on_bed, train, speeds, needs).verdicts)["deck acceleration"]
    assert row.verdict == "met" and row.value < 2.5


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"stations": 9.5}, "stations = 9.5"),
        ({"store": "x"}, "store = 'x'"),
        ({"progress": 3}, "progress = 3"),
    ],
)
def test_what_is_no_store_and_no_function_is_refused(changes, said):
    with pytest.raises(rb.InputError, match=said):
        rb.assess(deck(2), rb.train("HSLM-A1"), [40.0], NEEDS, **changes)


def test_whole_numbers_that_are_floats_are_stations_too():
    train = rb.AxleTrain((0.0,), (1e5,))
    found = rb.assess(deck(4), train, [40.0], NEEDS, stations=9.0)
    assert len(found.envelope.x) == 9


def test_the_unevenness_goes_by_the_span_that_bends():
    own = rb.Beam("row", (20.0, 16.0), M, 2e10, continuous=False).deck(9, 0.01)
    run = rb.cross(rb.AxleTrain((0.0,), (200e3,)), own, speed=37.5)
    row = rows(rb.assess_run(run, NEEDS))["moment by dynamic analysis"]
    assert row.where == 28.0
    n0, static, exp = np.pi / (2 * 16.0**2) * np.sqrt(2e10 / M), 200e3 * 16.0 / 4, np.exp
    unevenness = (56 * exp(-(1.6**2)) + 50 * (16.0 * n0 / 80 - 1) * exp(-(0.8**2))) / 100
    moving = -run.section_forces(28.0).extremes("moment_vertical")[0][0]
    assert row.value == pytest.approx(moving + unevenness / 2 * static, rel=1e-4)


def test_a_track_that_is_level_vertically_is_perfect():
    coaches, wave = rb.Train(rb.vehicle("xia2000"), cars=1), rb.Harmonic(1e-3, wavelength=20.0)
    sideways = rb.Track(lateral=wave)
    flat = rb.Harmonic(0.0, wavelength=20.0)
    tracks = (sideways, rb.Track(vertical=flat), rb.Track(vertical=[flat, rb.Level()]))
    stiff = rb.Beam("beam", (L,), M, 2e10, bending_stiffness_lateral=2e11).deck(6, 0.01)
    for track, smooth in [(track, True) for track in tracks] + [(rb.Track(vertical=wave), False)]:
        row = rows(rb.assess_run(rb.cross(coaches, stiff, track, speed=37.5), NEEDS))
        assert ("perfect track" in row["wheel unloading"].reason) is smooth
        assert ("phi'' left out" in row["moment by dynamic analysis"].reason) is not smooth


def test_a_flat_spot_makes_no_rough_track():
    """phi'' stands for the rails all along the line, which one bad wheel says nothing of."""
    notch = rb.Notch(((1, 1),), circumference=2.9, offset=0.0, depth=1e-3, length=0.3)
    worn = rb.Train(rb.vehicle("xia2000"), cars=1, notches=[notch])
    stiff = rb.Beam("beam", (L,), M, 2e10).deck(6, 0.01)
    for found in (
        rb.assess(stiff, worn, [37.5], NEEDS).verdicts,
        rb.assess_run(rb.cross(worn, stiff, speed=37.5), NEEDS),
    ):
        row = rows(found)
        assert "phi'' left out" not in row["moment by dynamic analysis"].reason
        assert "on a perfect track" in row["comfort b_v"].reason
        assert "on a perfect track" in row["wheel unloading"].reason
        assert row["wheel unloading"].verdict != "met"


def test_what_is_asked_besides_is_that_of_an_envelope():
    own = deck(6, 0.02)
    trains = {"A1": rb.train("HSLM-A1"), "cars": rb.Train(rb.vehicle("xia2000"), cars=1)}
    outputs = rb.studies.outputs_at(own, ("acceleration_z", "moment_vertical"), [5.0, 8.0])
    asked = rb.studies.asked_of(outputs, ("wheel_force_z",))
    how = {"acceleration_modes": 15.0}
    found = rb.assess(own, trains, [40.0, 45.0], NEEDS, more=asked, **how)
    alone = rb.assess(own, trains, [40.0, 45.0], NEEDS, **how)
    envelope = rb.speed_envelope(
        own, trains, [40.0, 45.0], [5.0, 8.0], ("acceleration_z", "moment_vertical"),
        numbers=("wheel_force_z",), **how,
    )  # fmt: skip
    assert alone.more is None and found.more.identical(envelope)
    assert found.envelope.identical(alone.envelope)
    for one, other in zip(found.verdicts, alone.verdicts, strict=True):
        assert one.value == other.value and one.verdict == other.verdict
    with pytest.raises(rb.InputError, match="more.*functions of a crossing"):
        functions = rb.studies.Asked((), (), {"f": len})
        rb.assess(own, trains, [40.0], NEEDS, more=functions)
    with pytest.raises(rb.InputError, match="more = 5"):
        rb.assess(own, trains, [40.0], NEEDS, more=5)
