"""Rails that spread loads: the kernel, the record before t = 0, and a program with a real rail."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import cumulative_trapezoid, quad
from tests.independent.rail_on_bed import RailOverDeck

import railbridge as rb
from railbridge.contacts import rails
from railbridge.guideways import PiecewiseCubic
from railbridge.results import ENVELOPE

BED = rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
SLEEPERS = rb.Rail(spread=0.6)
DECK = rb.deck("viaduct36")
CAR = rb.vehicle("xia2000")
WAVES = rb.Track(
    vertical=rb.Harmonic(5e-3, wavelength=14.4),
    lateral=rb.Harmonic(2e-3, wavelength=14.4, phase=np.pi / 2),
)


def elastic(length=36.0, rail=None, spring=2e9):
    """A deck like viaduct36 on springs."""
    bearings = tuple(rb.Bearing(x, ("y", "roll"), stiffness={"z": spring}) for x in (0.0, length))
    damping = rb.rayleigh(0.03, (3.307, 16.3))
    return rb.Beam("soft", (length,), 12e3, 8.9355e10, bearings=bearings).deck(
        None, damping, rail=rail
    )


def random_function(seed, edges=(0.0, 2.0, 5.0, 5.5, 10.0)):
    """Of three functions of two components, that jump at every edge."""
    rng = np.random.default_rng(seed)
    return PiecewiseCubic(np.array(edges), rng.normal(size=(len(edges) - 1, 4, 3, 2)))


def under(rail, function):
    return PiecewiseCubic(*rail.under(function.edges, function.coefficients))


# ---- what a rail may be


@pytest.mark.parametrize(
    ("given", "field", "words"),
    [
        ({}, "spread", "is missing. Give the distance of sleepers"),
        ({"spread": 0.0}, "spread", "above 0 and at most 5 m"),
        ({"spread": 600.0}, "spread", "above 0 and at most 5 m"),
        ({"spread": True}, "spread", "must be a finite number"),
        ({"bending_stiffness": 1.28e7}, "foundation", "is missing"),
        ({"foundation": 1e8}, "bending_stiffness", "is missing"),
        ({"spread": 0.6, "foundation": 1e8}, "foundation", "give either spread, or bending"),
        ({"bending_stiffness": -1.0, "foundation": 1e8}, "bending_stiffness", "above 0 N m2"),
        ({"bending_stiffness": 1.28e7, "foundation": np.nan}, "foundation", "above 0 N/m2"),
        ({"bending_stiffness": 1.28e7, "foundation": 100.0}, "foundation", "length is 26.7 m"),
        ({"bending_stiffness": 1.0, "foundation": 1e8}, "foundation", "length is 0.0141 m"),
    ],
)
def test_a_rail_that_cannot_be_is_refused(given, field, words):
    with pytest.raises(rb.InputError, match=words) as refused:
        rb.Rail(**given)
    assert refused.value.field == field


def test_a_rail_that_spreads_over_a_third_of_the_deck_is_refused():
    short = rb.Beam("culvert", (3.0,), 12e3, 1e9)
    short.deck(5, rail=rb.Rail(spread=1.0))
    with pytest.raises(rb.InputError, match=r"rail.spread = 1.1: .* third of the deck, 1 m"):
        short.deck(5, rail=rb.Rail(spread=1.1))
    with pytest.raises(rb.InputError, match=r"rail.foundation = .* third of the deck, 1 m"):
        short.deck(5, rail=rb.Rail(bending_stiffness=1.28e7, foundation=1e7))
    with pytest.raises(rb.InputError, match="rail"):
        replace(DECK, rail=0.6)


# ---- the kernel


def test_the_whole_load_arrives_and_a_millionth_of_it_beyond_the_reach():
    assert 2 * quad(BED.kernel, 0.0, 60.0, limit=200)[0] == pytest.approx(1.0, abs=1e-12)
    assert abs(quad(BED.kernel, BED.reach, 60.0)[0]) < 1e-6
    assert sum(share for _, share in SLEEPERS.parts) == 1.0
    with pytest.raises(rb.InputError, match="parts"):
        SLEEPERS.kernel(0.0)


def test_the_kernel_is_the_pressure_below_a_beam_on_an_elastic_foundation():
    """EI w'''' + k w = 0 beside the load, whose half is the shear force there; p = k w."""
    b = (BED.foundation / (4 * BED.bending_stiffness)) ** 0.25
    h = 1e-2
    s = h * np.arange(-2, 3)
    for at in (0.3, 1.0, 2.5):
        pressure = BED.kernel(at + s)
        fourth = pressure @ [1, -4, 6, -4, 1] / h**4
        assert fourth == pytest.approx(-4 * b**4 * BED.kernel(at), abs=5e-4)
    # EI w''' = 1/2 at the load, with w = K / k.
    third = BED.kernel(1e-3 * np.arange(1, 5)) @ [-1, 3, -3, 1] / 1e-9
    assert BED.bending_stiffness / BED.foundation * third == pytest.approx(0.5, rel=5e-3)


@given(seed=st.integers(0, 99), spread=st.floats(0.05, 4.0))
def test_sleepers_give_the_sum_of_shifted_functions(seed, spread):
    function, x = random_function(seed), np.linspace(-5.0, 15.0, 301) + 1e-7
    spread_out = under(rb.Rail(spread=spread), function)
    for derivative in (0, 1, 2):
        expected = (
            function(x - spread, derivative) / 4 + function(x, derivative) / 2
            + function(x + spread, derivative) / 4
        )  # fmt: skip
        # Not where an edge of the one is an edge of the other but for rounding.
        moved = np.concatenate([function.edges + d for d in (-spread, 0.0, spread)])
        clear = np.abs(x[:, None] - moved).min(axis=1) > 1e-6
        scale = np.abs(expected).max()
        found = spread_out(x, derivative)
        assert np.abs(found - expected)[clear].max() < 1e-9 * scale


@given(
    seed=st.integers(0, 30), length=st.floats(0.2, 3.0),
    cut=st.sampled_from([1e-9, 1e-4, 0.3]),
)  # fmt: skip
def test_a_bed_gives_the_integral_of_kernel_times_function(seed, length, cut):
    """At the pieces' ends, against Gauss's rule between edges; also with a very short piece."""
    function = random_function(seed, (0.0, 2.0, 2.0 + cut, 5.0, 10.0))
    rail = rb.Rail(bending_stiffness=1e7, foundation=4e7 / length**4)
    found = under(rail, function)
    points, weights = np.polynomial.legendre.leggauss(60)
    for x in found.edges[:: max(len(found.edges) // 7, 1)]:
        expected = 0.0
        cuts = np.unique(np.concatenate([function.edges, np.clip([x], 0.0, 10.0)]))
        fine = np.unique(np.concatenate([cuts, np.linspace(0.0, 10.0, 41)]))
        for start, end in zip(fine[:-1], fine[1:], strict=True):
            s = (start + end) / 2 + (end - start) / 2 * points
            own = function(s) * (weights * (end - start) / 2 * rail.kernel(x - s))[:, None, None]
            expected = expected + own.sum(axis=0)
        assert found(np.array([x]))[0] == pytest.approx(expected, abs=1e-9)


def test_between_its_edges_a_bed_is_as_exact_as_it_says(monkeypatch):
    function = random_function(3)
    coarse = under(BED, function)
    monkeypatch.setattr(rails, "_MESH", 0.01)
    fine, x = under(BED, function), np.linspace(-12.0, 22.0, 20_001)
    difference = np.abs(function(x) - fine(x)).max()
    off, slope_off = (np.abs(coarse(x, d) - fine(x, d)).max() for d in (0, 1))
    assert 2e-7 * difference < off < 1.1e-6 * difference
    assert slope_off * BED.length < 3.3e-5 * difference


@pytest.mark.parametrize(
    "rail", [rb.Rail(spread=1e-4), rb.Rail(bending_stiffness=1.0, foundation=4 / 0.05**4)]
)
def test_a_rail_that_hardly_spreads_changes_hardly_anything(rail):
    """Deck on rigid bearings, where nothing steps on an end that moves."""
    train = rb.Train(CAR, cars=2, car_spacing=22.5)
    options = {"speed": 40.0, "tail": 0.2, "track_offset": 2.4}
    bare, found = (rb.cross(train, replace(DECK, rail=r), WAVES, **options) for r in (None, rail))
    before = found.settings.before
    assert before == np.ceil(rail.reach / found.settings.passage.advance) > 0
    same = slice(before, before + len(bare.time))
    assert found.time[same][: len(bare.time)] == pytest.approx(bare.time, abs=1e-12)
    for x in (9.0, 18.0):
        for name in ("displacement_z", "displacement_y", "rotation_x"):
            ours, theirs = found.displacement(x)[name][same], bare.displacement(x)[name]
            assert np.abs(ours - theirs).max() < 1e-3 * np.abs(theirs).max()
    # The corner that a wheel meets at the deck's end is rounded: half a per cent of its weight.
    assert found.wheel_forces[:, :, same] == pytest.approx(bare.wheel_forces, abs=360.0)
    assert np.array_equal(found.on_deck[:, same], bare.on_deck)
    assert found.spectrum.amplitude == pytest.approx(bare.spectrum.amplitude, abs=30.0)


# ---- reciprocity


@pytest.mark.parametrize("rail", [None, SLEEPERS, BED])
@pytest.mark.parametrize("speed", [20.0, 33.3])
def test_force_and_motion_do_the_same_work(rail, speed):
    """Loads times what wheels meet are modal forces times coordinates, to rounding."""
    rng, samples, step = np.random.default_rng(1), 4000, 2e-3
    deck = replace(DECK, rail=rail)
    stations = deck.stations(np.array([0.0, 2.5, 17.3]), speed, step, samples, before=400)
    loads = [rng.normal(size=(3, count)) for count in stations.counts]
    force = stations.modal_force(loads, deck.coordinates, samples)
    q = rng.normal(size=force.shape)
    state = stations.ordered(q, np.zeros_like(q))
    work = 0.0
    for s, load in enumerate(loads):
        moved, _ = stations.motion(state, np.array([s]))
        work += np.sum(load * moved[:, 0])
    assert work == pytest.approx(np.sum(force * q), rel=1e-12)


def test_what_a_wheel_climbs_is_the_slope_of_what_it_meets():
    deck, speed, step = replace(DECK, rail=BED), 30.0, 1e-4
    stations = deck.stations(np.zeros(1), speed, step, 20_000, before=5000)
    q = np.repeat(np.arange(1.0, deck.coordinates + 1)[:, None], 20_000, axis=1)
    moved, rate = stations.motion(stations.ordered(q, np.zeros_like(q)), np.array([0]))
    rates = (moved[:, 0, 2:] - moved[:, 0, :-2]) / (2 * step)
    scale = np.abs(rates).max(axis=1, keepdims=True)
    assert np.abs(rates - rate[:, 0, 1:-1]).max() < 2e-4 * scale.max()
    # Nothing jumps where the rail begins and ends to feel the deck.
    assert np.abs(moved[:, 0, [0, -1]]).max() < 2e-6 * np.abs(moved).max()


@pytest.mark.parametrize("loads", ["bogies", "condensed"])
def test_couples_of_a_condensed_load_act_on_the_slope_of_the_spread_shapes(loads):
    """One car as forces and couples is two near pairs of forces at each of its points."""
    deck = replace(DECK, rail=BED)
    run = rb.cross(rb.Train(CAR), deck, WAVES, speed=30.0, loads=loads, interaction="rigid")
    psi, coupling = deck.under_rail(deck.shapes), run.coupling
    expected = np.zeros_like(run.state.modal_force)
    arm = 1e-3
    for delay, start, load in zip(
        coupling.load_delays, coupling.loads.starts, coupling.station_loads(run.passes[0]),
        strict=True,
    ):  # fmt: skip
        when = np.arange(start, start + load.shape[1])
        x = run.settings.speed * run.time[when] - delay
        here, ahead, behind = psi(x), psi(x + arm), psi(x - arm)
        expected[:, when] += np.einsum("kmc,ck->mk", here, load[:3])
        turn = (ahead - behind) / (2 * arm)
        expected[:, when] += (turn[:, :, 0] * load[4][:, None] - turn[:, :, 1] * load[3][:, None]).T
    scale = np.abs(expected).max()
    assert np.abs(run.state.modal_force - expected).max() < 1e-5 * scale


# ---- the record


def test_time_is_zero_when_the_first_axle_is_at_the_deck_and_starts_before():
    train = rb.Train(CAR, cars=2, car_spacing=22.5)
    options = {"speed": 20.0, "interaction": "rigid"}
    bare, found = (rb.cross(train, replace(DECK, rail=r), WAVES, **options) for r in (None, BED))
    step, before = found.settings.time_step, found.settings.before
    assert bare.settings.before == 0 and bare.time[0] == 0.0
    assert found.time[before] == 0.0
    assert found.time[0] == pytest.approx(-BED.reach / 20.0, abs=step)
    # On a rigid deck the wheels do not know of the rail.
    same = slice(before, before + len(bare.time))
    assert found.wheel_forces[..., same] == pytest.approx(bare.wheel_forces, abs=1e-6)
    assert found.body_accelerations[..., same] == pytest.approx(bare.body_accelerations, abs=1e-9)
    assert found.spectrum.amplitude == pytest.approx(bare.spectrum.amplitude, abs=1e-6)
    assert found.time[-1] == pytest.approx(bare.time[-1] + BED.reach / 20.0, abs=2 * step)
    # The deck moves before the first axle is on it.
    early = found.displacement(18.0)["displacement_z"][:before]
    assert np.abs(early).max() > 1e-6


def test_a_short_run_up_that_starts_within_the_approach_is_level_before():
    train, options = rb.Train(CAR), {"speed": 20.0, "lead_in": 5.0, "interaction": "rigid"}
    run = rb.cross(train, replace(DECK, rail=BED), WAVES, **options)
    x = 20.0 * run.time - train.placed_axles[0].delay
    dynamic = run.wheel_forces - run.wheel_forces[..., :1]
    assert not dynamic[:2, :, x < -5.0].any() and dynamic[:2, :, x > 0.0].any()
    bare = rb.cross(train, DECK, WAVES, **options)
    same = slice(run.settings.before, run.settings.before + len(bare.time))
    assert run.wheel_forces[..., same] == pytest.approx(bare.wheel_forces, abs=1e-6)


@pytest.mark.parametrize("rail", [SLEEPERS, BED])
def test_hertzian_contacts_load_the_deck_before_a_run_up_that_starts_late(rail):
    car = rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=1000.0)
    train, deck = rb.Train(car, cars=2, car_spacing=22.5), replace(DECK, rail=rail)
    options = {"speed": 40.0, "contact": "hertz", "time_step": 1e-3, "tail": 0.2}
    # On level track nothing depends on where a run-up begins.
    long, none = (rb.cross(train, deck, lead_in=x, **options) for x in (60.0, 0.0))
    assert none.state.q == pytest.approx(long.state.q, abs=1e-9 * np.abs(long.state.q).max())
    assert none.wheel_forces == pytest.approx(long.wheel_forces, abs=1e-2)
    for name in ("car z", "front wheelset 1 z"):
        assert none.car_motion(2)[name] == pytest.approx(long.car_motion(2)[name], abs=1e-10)


@pytest.mark.parametrize("rail", [SLEEPERS, BED])
def test_direct_is_the_limit_of_the_iteration(rail):
    train, deck = rb.Train(CAR, cars=2, car_spacing=22.5), elastic(rail=rail)
    runs = [
        rb.cross(train, deck, WAVES, speed=40.0, interaction=way, tail=0.1)
        for way in ("iterate", "direct")
    ]
    iterated, direct = (run.displacement(18.0)["displacement_z"] for run in runs)
    assert np.abs(iterated - direct).max() < 1e-6 * np.abs(direct).max()
    assert runs[0].wheel_forces == pytest.approx(runs[1].wheel_forces, abs=10.0)


# ---- statics


def test_bearings_carry_what_arrives_on_the_deck():
    """Standing loads: the sum of reactions is the kernel's integral over the deck."""
    train = rb.AxleTrain([0.0, 2.5], [1.5e5, 1e5])
    for rail in (SLEEPERS, BED):
        run = rb.cross(train, replace(DECK, rail=rail), speed=20.0)
        lines = [DECK.recovery.reaction("force_z", x) for x in (0.0, 36.0)]
        found = sum(run.static(line) for line in lines)
        expected = np.zeros_like(found)
        s = np.linspace(-60.0, 60.0, 240_001)
        for delay, size in zip(train.axles, train.loads, strict=True):
            x = 20.0 * run.time - delay
            if rail is BED:
                share = cumulative_trapezoid(BED.kernel(s), s, initial=0.0)
                on = np.interp(x, s, share) - np.interp(x - 36.0, s, share)
            else:
                on = sum(
                    share * ((x + offset >= -1e-9) & (x + offset <= 36.0 + 1e-9))
                    for offset, share in rail.parts
                )
            expected += size * on
        # Not where rounding decides whether a sleeper stands on the end.
        off = np.abs(found - expected) > 1e-4 * max(train.loads)
        assert off.sum() <= (12 if rail is SLEEPERS else 0)


@pytest.mark.parametrize("rail", [SLEEPERS, BED])
def test_newtons_law_holds_for_the_whole_deck_at_every_instant(rail):
    """Reactions plus what arrives of the loads are mass times acceleration, and outer damping."""
    train = rb.AxleTrain([0.0, 2.5], [1.5e5, 1e5])
    length, mass, alpha, beta = 36.0, 12e3, 0.8, 5e-4
    beam = rb.Beam("b", (length,), mass, 8.9e10, elements=40)
    deck = beam.deck(38, (alpha, beta), rail=rail)
    run = rb.cross(train, deck, speed=40.0, time_step=5e-4, tail=0.1)
    total = sum(history["force_z"] for history in run.reactions().values())
    x = np.linspace(0.0, length, 721)
    q, v, p = run.state.q, run.state.velocity, run.state.modal_force
    shape = deck.shapes(x)[:, :, 1]
    whole = mass * np.trapezoid(shape, x, axis=0)
    inertia = whole @ (deck.acceleration(q, v, p) + alpha * v)
    ones = PiecewiseCubic(np.array([0.0, length]), np.eye(4)[:1, :, None, None] * [[[1.0]]])
    arriving = PiecewiseCubic(*rail.under(ones.edges, ones.coefficients))
    loads = sum(
        -size * arriving(40.0 * run.time - delay)[:, 0, 0]
        for delay, size in zip(train.axles, train.loads, strict=True)
    )
    off = np.abs(total + loads - inertia)
    # The inertia of the modes left out, which are not in the sum, is small.
    assert np.quantile(off, 0.99) < 0.01 * max(train.loads)


@pytest.mark.parametrize("loads", ["bogies", "condensed"])
@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_newtons_laws_hold_where_a_bogie_s_couple_is_spread(loads):
    """Force, and moment about x = 0, on a deck whose ends give; the kernel is written out here.

    A couple M on the rail acts on the slope of what the load is spread over: - M psi'.
    """
    length, mass, alpha, beta = 18.0, 9e3, 0.6, 4e-4
    bearings = tuple(rb.Bearing(x, ("y", "roll"), stiffness={"z": 4e8}) for x in (0.0, length))
    beam = rb.Beam("b", (length,), mass, 5e9, elements=24, bearings=bearings)
    deck = beam.deck(12, (alpha, beta), rail=BED)
    train, speed = rb.Train(rb.planar_car(CAR)), 45.0
    options = {"time_step": 5e-4, "lead_in": 30.0, "tail": 0.1, "interaction": "rigid"}
    waves = rb.Track(vertical=rb.Harmonic(3e-3, wavelength=9.0))
    run = rb.cross(train, deck, waves, speed=speed, loads=loads, **options)
    some = slice(None, None, 11)
    s = np.linspace(0.0, length, 1801)
    groups = [[0, 1], [2, 3]] if loads == "bogies" else [[0, 1, 2, 3]]
    arriving = np.zeros((2, len(run.time[some])))
    for group in groups:
        wheels = [train.wheels[i] for i in group]
        middle = np.mean([wheel.x for wheel in wheels])
        force = run.wheel_forces[group, 1][:, some]
        couple = -sum((w.x - middle) * f for w, f in zip(wheels, force, strict=True))
        at = speed * run.time[some] - train.formation[0].centre + middle
        away = (at[:, None] - s) / BED.length
        fade = np.exp(-np.abs(away)) / BED.length
        kernel = fade * (np.cos(away) + np.sin(np.abs(away))) / 2.0
        slope = -fade * np.sin(away) / BED.length
        for own, arm in zip(arriving, (np.ones_like(s), s), strict=True):
            own += np.trapezoid(kernel * arm, s, axis=1) * force.sum(axis=0)
            own -= np.trapezoid(slope * arm, s, axis=1) * couple
    held = {x: history["force_z"][some] for x, history in run.reactions().items()}
    found = np.array([sum(held.values()), sum(x * force for x, force in held.items())])
    q, v, p = run.state.q, run.state.velocity, run.state.modal_force
    moving = (deck.acceleration(q, v, p) + alpha * v)[:, some]
    shape = deck.shapes(s)[:, :, 1]
    inertia = mass * np.trapezoid(np.stack([shape, s[:, None] * shape]), s, axis=1) @ moving
    wrong = np.abs(found + arriving - inertia).max(axis=1)
    assert np.abs(couple).max() > 5e3
    assert np.all(np.abs(inertia).max(axis=1) > 0.1 * np.abs(arriving).max(axis=1))
    assert np.all(wrong < 1e-5 * np.abs(arriving).max(axis=1))


@pytest.mark.parametrize("rail", [SLEEPERS, BED])
@pytest.mark.parametrize("quantity", ["moment_vertical", "shear_vertical", "displacement_z"])
@pytest.mark.parametrize("spans", [(36.0,), (20.0, 16.0)])
def test_static_extremes_are_those_of_brute_force(rail, quantity, spans):
    """The influence line folded with the kernel on a grid of 5 mm, axles moved over it."""
    train = rb.AxleTrain([0.0, 2.4, 7.0], [1.5e5, 1e5, 2e5])
    deck, at, h = rb.Beam("spans", spans, 12e3, 3e10).deck(10, rail=rail), 12.3, 5e-3
    run = rb.cross(train, deck, speed=20.0, interaction="rigid")
    line = deck.recovery.section(quantity, at)
    s, totals = np.arange(-8000, 16_000) * h, []
    for side in (-1e-9, 1e-9):  # just before all that jumps, and just behind
        bare = line.influence(s + side)[:, 0, 1]
        if rail is BED:
            # The mean of both sides, as a sum of strips takes it.
            bare = (bare + line.influence(s - side)[:, 0, 1]) / 2
            spread = np.convolve(bare, BED.kernel(np.arange(-3000, 3001) * h) * h, "same")
        else:
            shift = round(0.6 / h)
            spread = bare / 2 + (np.roll(bare, shift) + np.roll(bare, -shift)) / 4
        each = zip(train.axles, train.loads, strict=True)
        totals += [-sum(size * np.roll(spread, round(delay / h)) for delay, size in each)]
    low, high = run.static_extremes(line)
    scale = np.abs(totals).max()
    assert low == pytest.approx(np.min(totals), abs=2e-4 * scale)
    assert high == pytest.approx(np.max(totals), abs=2e-4 * scale)


@pytest.mark.parametrize("rail", [SLEEPERS, BED])
def test_a_slow_crossing_gives_the_static_extremes(rail):
    """What jumps between samples is met too, on both sides of each sleeper."""
    train = rb.AxleTrain([0.0, 2.4, 7.0], [1.5e5, 1e5, 2e5])
    deck = replace(DECK, rail=rail)
    run = rb.cross(train, deck, speed=0.5, time_step=0.05, tail=0.0)
    history = run.section_forces(12.3)
    for name in ("moment_vertical", "shear_vertical"):
        low, high = run.static_extremes(deck.recovery.section(name, 12.3))
        (found_low, _), (found_high, _) = history.extremes(name)
        scale = max(-low, high)
        assert found_low == pytest.approx(low, abs=5e-3 * scale)
        assert found_high == pytest.approx(high, abs=5e-3 * scale)


@pytest.mark.parametrize("rail", [SLEEPERS, BED])
def test_what_jumps_is_met_on_both_sides(rail):
    """At every instant at which a sleeper steps on or passes, against steps of 10 us.

    Of few modes, so that what jumps between samples is the load, not they. Their state is late or
    early by up to half a sample of each step, as without a rail; that falls with the sample and is
    1.3e-3 here.
    """
    train, found = rb.AxleTrain([0.0, 2.5], [1e5, 6e4]), []
    beam = elastic().recovery.beam
    deck = beam.deck(4, (1.0, 4e-4), rail=rail)
    for step in (1.25e-4, 1e-5):
        run = rb.cross(train, deck, speed=30.0, time_step=step, tail=0.0)
        found.append({"shear_vertical": run.section_forces(12.3), "force_z": run.reactions()[0.0]})
    coarse, fine = found
    for name in coarse:
        time, values = coarse[name].jumps(name)
        t = fine[name].time
        assert time[0] == pytest.approx(-rail.reach / 30.0, abs=1e-6)
        # A sample of the fine run before each instant, and one behind it.
        before, behind = time[::2] - 1.2e-5, time[1::2] + 1.2e-5
        inside = (before > t[0]) & (behind < t[-1])
        for instants, own in ((before, values[::2]), (behind, values[1::2])):
            exact = np.interp(instants[inside], t, fine[name][name])
            assert np.abs(own[inside] - exact).max() < 2e-3 * np.abs(values).max(), name
        jumped = np.abs(values[1::2] - values[::2]) > 0.1 * 6e4
        # Two axles on three sleepers each pass the section, or step on and off; a bed is smooth.
        assert jumped.sum() >= 6 if rail is SLEEPERS else not jumped.any()


def test_the_public_influence_line_is_that_of_the_deck_itself():
    places = np.linspace(0.0, 36.0, 37)
    bare, found = (
        replace(DECK, rail=r).influence("moment_vertical", at=18.0, places=places)
        for r in (None, BED)
    )
    assert np.array_equal(bare, found)
    line = DECK.recovery.section("moment_vertical", 18.0)
    assert DECK.under_load(line) is line
    deck = replace(DECK, rail=BED)
    spread = deck.under_load(line)
    assert abs(spread.influence(np.array([18.0]))[0, 0, 1]) < 0.99 * np.abs(bare).max()
    # Kept, and made anew for another rail.
    assert deck.under_load(line).influence is spread.influence
    assert replace(DECK, rail=SLEEPERS).under_load(line).influence is not spread.influence
    assert list(line.influence.under_rails) == [SLEEPERS]


# ---- ends that move


def test_on_a_bed_a_train_comes_smoothly_onto_ends_that_move():
    """The paper's train at 20 m/s on level track: 1.17 m/s2 at mid-span, 0.07 is right."""
    train = rb.Train(CAR, cars=8, car_spacing=22.5)
    found = {}
    for name, rail in (("bare", None), ("sleepers", SLEEPERS), ("bed", BED)):
        with pytest.warns(rb.ResultWarning) if rail is not BED else nullcontext():
            run = rb.cross(train, elastic(rail=rail), speed=20.0)
        found[name] = np.abs(run.acceleration(18.0)["acceleration_z"]).max()
    rigid = rb.cross(train, DECK, speed=20.0).acceleration(18.0)["acceleration_z"]
    assert found["bare"] == pytest.approx(1.17, rel=0.01)
    assert found["sleepers"] == pytest.approx(0.69, rel=0.01)
    assert found["bed"] == pytest.approx(0.072, rel=0.02)
    assert found["bed"] == pytest.approx(np.abs(rigid).max(), rel=0.05)


@pytest.mark.parametrize("modes", [10, 20, 40])
def test_an_axle_that_steps_onto_a_moving_end_throws_it_with_every_mode(modes):
    """At that instant mode m of unit mass is pushed by P phi_m(0): without a rail the end's
    acceleration is P times the sum of phi_m^2(0), which grows with each mode."""
    damping, load = rb.rayleigh(0.03, (3.307, 16.3)), 1.464e5
    deck = elastic().recovery.beam.deck(modes, damping)
    with pytest.warns(rb.ResultWarning):
        run = rb.cross(rb.AxleTrain([0.0], [load]), deck, speed=20.0, lead_in=0.0)
    thrown = load * np.sum(deck.shapes(np.array([0.0]))[0, :, 1] ** 2)
    assert np.abs(run.envelope("acceleration_z").values).max() == pytest.approx(thrown, rel=1e-6)


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
@pytest.mark.parametrize(
    ("length", "mass", "first"), [(36.0, 12e3, 3.307), (20.0, 10e3, 6.0), (10.0, 8e3, 12.0)]
)
@pytest.mark.parametrize("speed", [20.0, 80.0])
def test_a_rail_changes_sag_and_moment_of_plain_spans_by_two_per_cent_at_most(
    length, mass, first, speed
):
    """The last table of notebook 13; accelerations it makes smaller, on 10 m many times."""
    content = {
        "length": length,
        "mass": mass,
        "modes": 10,
        "bending_stiffness_vertical": mass * (2 * np.pi * first) ** 2 * (length / np.pi) ** 4,
        "damping": {"ratio": 0.03, "frequencies_hz": [first, 5 * first]},
    }
    deck, train = rb.deck_from_table("plain", content), rb.Train(rb.vehicle("xia2000_planar"))
    found = []
    for rail in (None, BED):
        run = rb.cross(train, replace(deck, rail=rail), speed=speed, lead_in=0.0)
        sag = run.displacement(length / 2).extreme("displacement_z")[0]
        moment = run.section_forces(length / 2).extreme("moment_vertical")[0]
        found.append((sag, moment, np.abs(run.envelope("acceleration_z").values).max()))
    bare, laid = np.array(found)
    assert laid[:2] == pytest.approx(bare[:2], rel=0.02)
    assert bare[2] / 9 < laid[2] < bare[2]


def test_a_moving_end_is_remarked_on_unless_the_rail_lies_on_a_bed():
    train = rb.AxleTrain([0.0], [1e5])

    def said(rail):
        run = rb.cross(train, elastic(rail=rail), speed=30.0)
        return [str(r) for r in rb.remarks(run) if str(r).startswith("An end of the deck")]

    (bare,), (sleepers,) = said(None), said(SLEEPERS)
    assert "at full weight" in bare and "deck.rail = { bending_stiffness" in bare
    assert "quarters and halves" in sleepers
    assert said(BED) == []


# ---- a program with a real rail

LENGTH, MASS, BENDING, ALPHA, BETA = 20.0, 9000.0, 2.2e10, 0.6, 4e-4
PLACES, STEP = (10.0, 4.0), 2.5e-4


def both(bearing, scale, **mass):
    """Ours and the program's displacements and accelerations, and forces, of one crossing.

    `scale` makes rail and bed softer alike, which leaves the kernel as it is.
    """
    stiffness = {} if bearing is None else {"stiffness": {"z": bearing}}
    fixed = ("z",) if bearing is None else ()
    bearings = tuple(rb.Bearing(x, fixed, **stiffness) for x in (0.0, LENGTH))
    beam = rb.Beam("b", (LENGTH,), MASS, BENDING, bearings=bearings, elements=40)
    deck = beam.deck(25, (ALPHA, BETA), rail=BED)
    if mass:
        car = rb.sprung_mass("mass", mass["mass"], mass["spring"])
        train, way = rb.Train(car), {"interaction": "direct"}
        loads = [(0.0, car.contacts[0].static_load)]
    else:
        train, way = rb.AxleTrain([0.0, 2.5], [1.5e5, 1e5]), {}
        loads = list(zip(train.axles, train.loads, strict=True))
    run = rb.cross(train, deck, speed=50.0, time_step=STEP, tail=0.3, **way)
    fem = RailOverDeck(
        LENGTH, MASS, BENDING, bearing, scale * BED.bending_stiffness, scale * BED.foundation,
        ALPHA, BETA,
    )  # fmt: skip
    moved, rates, force = fem.crossing(
        PLACES, loads, 50.0, STEP, len(run.time), run.time[0], **mass
    )
    ours = [run.displacement(x)["displacement_z"] for x in PLACES]
    second = [run.acceleration(x)["acceleration_z"] for x in PLACES]
    return (ours, moved), (second, rates), (run.wheel_forces[0, 1], force)


def off(pair):
    ours, theirs = map(np.asarray, pair)
    return np.abs(ours - theirs).max() / np.abs(theirs).max()


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("bearing", [None, 1e9])
def test_a_soft_rail_over_a_deck_loads_it_as_the_kernel_says(bearing):
    """A rail so soft stiffens neither the deck nor its ends: what is left is the kernel."""
    displacements, accelerations, _ = both(bearing, 0.01)
    assert off(displacements) < 1e-4 and off(accelerations) < 1e-3


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(("bearing", "limits"), [(None, (0.005, 0.02)), (1e9, (0.008, 0.065))])
def test_what_a_real_rail_adds_is_small(bearing, limits):
    """Its own stiffness over the deck's ends, which is not counted: 0.4 to 0.7 % and 2 to 6 %."""
    displacements, accelerations, _ = both(bearing, 1.0)
    assert off(displacements) < limits[0] and off(accelerations) < limits[1]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("bearing", [None, 1e9])
def test_a_mass_on_a_spring_feels_what_the_rail_follows_of_the_deck(bearing):
    mass = {"mass": 15e3, "spring": 2e6, "give": False}
    displacements, accelerations, forces = both(bearing, 0.01, **mass)
    assert off(displacements) < 2e-4 and off(accelerations) < 2e-3
    weight = 15e3 * 9.80665
    ours, theirs = forces
    dynamic = np.abs(theirs + weight).max()
    assert np.abs(ours - theirs).max() < 3e-3 * dynamic


@pytest.mark.filterwarnings("ignore")
def test_the_rails_own_give_below_a_wheel_changes_its_force_by_some_per_cent():
    displacements, accelerations, forces = both(1e9, 1.0, mass=15e3, spring=2e6)
    assert off(displacements) < 0.01 and off(accelerations) < 0.06
    ours, theirs = forces
    assert 0.02 < np.abs(ours - theirs).max() / np.abs(theirs + 15e3 * 9.80665).max() < 0.05


def test_envelopes_of_a_deck_with_a_rail_are_finite():
    run = rb.cross(rb.Train(CAR), replace(DECK, rail=SLEEPERS), speed=40.0)
    for quantity in ENVELOPE:
        found = run.envelope(quantity, [0.0, 12.0, 36.0])
        assert np.isfinite(found.values).all()
        assert np.isfinite(found.at(1).extremes("value")).all()
