"""What a study is asked for, and what one run answers."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge import studies
from railbridge.studies import lanes
from railbridge.studies.engine import Job, asked_of, respond, row_of_run
from railbridge.studies.outputs import OUTPUTS, outputs_at, peaks_of_run, twist_at


@pytest.fixture(scope="module")
def run():
    case = rb.case("paper").replace({"train.cars": 1, "run.loads": "wheels", "run.iterations": 2})
    return case.compute()


def test_peaks_are_those_of_the_histories(run):
    outputs = outputs_at(run.deck, tuple(OUTPUTS), [18.0, 7.0])
    names = [(o.quantity, o.x) for o in outputs[:2]]
    assert names == [("displacement_y", 18.0), ("displacement_z", 18.0)]
    peaks = peaks_of_run(run, outputs)
    for i, output in enumerate(outputs):
        if output.quantity == "twist":
            left, right = (run.displacement(x)["rotation_x"] for x in (output.x, output.x + 3.0))
            twist = {"twist": 1.435 * (right - left)}
            history = rb.History(run.time, twist, {"twist": "m"})
        elif output.quantity.startswith("acceleration"):
            history = run.acceleration(output.x)
        elif output.quantity.startswith("displacement"):
            history = run.displacement(output.x)
        elif output.quantity.startswith("rotation"):
            history = run.rotations(output.x)
        else:
            history = run.section_forces(output.x)
        value, time = history.extreme(output.quantity)
        assert peaks.largest[0, i] == pytest.approx(abs(value), rel=1e-11)
        assert peaks.largest_time[0, i] == time
        values = tuple(v for v, _ in history.extremes(output.quantity))
        assert (peaks.low[0, i], peaks.high[0, i]) == pytest.approx(values, rel=1e-11)
    statics = np.isnan(peaks.static[0])
    assert [o.is_acceleration for o in outputs] == statics.tolist()


@pytest.mark.parametrize(
    ("quantities", "points", "said"),
    [
        (("displacment_z",), [18.0], r"Did you mean 'displacement_z'"),
        ((), [18.0], "at least one quantity"),
        (("torsion", "torsion"), [18.0], "named twice"),
        (("torsion",), [40.0], r"points.*at most 36"),
        (("torsion",), [], "points"),
    ],
)
def test_what_cannot_be_asked(run, quantities, points, said):
    with pytest.raises(rb.InputError, match=said):
        outputs_at(run.deck, quantities, points)


def test_what_a_deck_cannot_tell_is_refused_in_words():
    plain = rb.Beam("plain", (20.0,), 1e4, 1e10).deck(modes=2)
    with pytest.raises(rb.InputError, match="torsion.*no such stiffness.*Leave it out"):
        outputs_at(plain, ("torsion",), [10.0])
    with pytest.raises(rb.InputError, match="acceleration_y.*does not move that way"):
        outputs_at(plain, ("acceleration_y",), [10.0])
    assert outputs_at(plain, "displacement_z", [10.0])[0].quantity == "displacement_z"


# ---- which modes count in accelerations: every way agrees with `cross`

CUT = ("acceleration_z", "acceleration_y", "displacement_z", "rotation_y")
LIMIT = {"all": np.inf, 6.0: 6.0, "en1990": 30.0}
"""Hz, of the shipped deck; see `railbridge.cutoffs`."""
WAVES = {"train.cars": 2, "run.loads": "wheels", "run.iterations": 2, "run.time_step": 2e-3}


def from_modes(run, chosen, x=18.0):
    """The vertical acceleration at x from the modes up to a limit, put together here."""
    s, deck = run.state, run.deck
    omega = 2 * np.pi * deck.frequencies_hz[:, None]
    moved = s.modal_force - 2 * deck.damping_ratios[:, None] * omega * s.velocity - omega**2 * s.q
    kept = deck.frequencies_hz <= LIMIT[chosen]
    return deck.shapes(np.array([x]))[0, kept, 1] @ moved[kept]


@pytest.fixture(scope="module")
def crossings():
    """One case computed by `cross`, under every choice."""
    base = rb.case("paper").replace(WAVES)
    cases = {chosen: base.replace({"run.acceleration_modes": chosen}) for chosen in LIMIT}
    return {chosen: (case, case.compute()) for chosen, case in cases.items()}


def test_the_choice_matters_and_is_that_of_modes(crossings):
    sizes = []
    for chosen, (_, run) in crossings.items():
        known = from_modes(run, chosen)
        found = run.acceleration(18.0)["acceleration_z"]
        sizes.append(np.abs(known).max())
        assert found == pytest.approx(known, abs=1e-9 * sizes[-1])
    assert len({f"{size:.6g}" for size in sizes}) == 3


@pytest.mark.parametrize("chosen", LIMIT)
def test_lanes_and_mixtures_count_the_same_modes(crossings, chosen):
    case, run = crossings[chosen]
    asked = asked_of(outputs_at(case.deck, CUT, [18.0]))
    known = row_of_run(run, asked).peaks(asked)
    job = Job(case.train, case.track, case.settings)
    mixed = replace(job, mixed=True)
    (lane,) = respond(case.deck, [job], asked, side_by_side=True)
    (mixture,) = respond(case.deck, [mixed], asked)
    assert mixture.peaks(asked).largest == pytest.approx(known.largest, rel=1e-9)
    # A lane takes samples of its own.
    assert lane.peaks(asked).largest == pytest.approx(known.largest, rel=2e-2)
    jobs = [Job(c.train, c.track, c.settings) for c, _ in crossings.values()]
    together = respond(case.deck, jobs, asked, side_by_side=True)
    place = list(LIMIT).index(chosen)
    assert together[place].values == pytest.approx(lane.values, rel=1e-9, nan_ok=True)


@pytest.mark.parametrize("chosen", LIMIT)
def test_a_lane_at_its_own_samples_counts_the_same_modes(chosen):
    case = rb.case("paper").replace(WAVES | {"run.acceleration_modes": chosen})
    asked = asked_of(outputs_at(case.deck, CUT[:2], [18.0]))
    step = lanes.advance_of(case.settings) / case.settings.speed
    own = case.replace({"run.time_step": step})
    job = Job(case.train, case.track, replace(own.settings, time_step=step))
    found = lanes.run_lanes(case.deck, [job], asked.outputs, ())[0]
    known = row_of_run(own.compute(), asked).values
    assert found[:4] == pytest.approx(known[:4], rel=1e-6)


@pytest.mark.parametrize("chosen", LIMIT)
def test_constant_loads_count_the_same_modes(chosen):
    deck, train = rb.deck("viaduct36"), rb.train("HSLM-A1")
    found = studies.speed_envelope(
        deck, train, [40.0, 55.0], [18.0], CUT[:1], acceleration_modes=chosen
    )
    for speed in (40.0, 55.0):
        options = {"speed": speed, "time_step": 2.5e-4, "acceleration_modes": chosen}
        run = rb.cross(train, deck, **options)
        known = np.abs(from_modes(run, chosen)).max()
        assert float(found.acceleration_z.sel(speed=speed).item()) == pytest.approx(known, rel=2e-3)
    # What the deck and the trains alone say of resonance does not hang on it.
    plain = studies.speed_envelope(deck, train, [40.0, 55.0], [18.0], CUT[:1])
    assert ("signature" in found) == ("signature" in plain)
    if "signature" in plain:
        assert np.array_equal(found.signature, plain.signature)


@pytest.mark.parametrize("chosen", LIMIT)
def test_waves_of_unit_size_and_random_tracks_count_the_same_modes(chosen):
    case = rb.case("paper").replace(WAVES | {"run.iterations": None})
    options = {"speed": 30.0, "time_step": 2e-3, "acceleration_modes": chosen}
    track = rb.RandomTrack("german-low", band=(3, 100), seed=4, period=400.0)
    names = ("acceleration_z", "displacement_z")
    found = rb.random_response(case.train, case.deck, track, quantities=names, **options)
    own = rb.random_response(
        case.train, case.deck, track, quantities=names, **(options | {"acceleration_modes": "all"})
    )
    name = "acceleration_z at 18 m"
    run = rb.cross(case.train, case.deck, **options, interaction="direct")
    known = from_modes(run, chosen)
    assert found.mean(name) == pytest.approx(known, abs=1e-6 * np.abs(known).max())
    if chosen != "all":
        assert np.abs(found.sigma(name) - own.sigma(name)).max() > 1e-3 * own.sigma(name).max()
    same = "displacement_z at 18 m"
    assert np.array_equal(found.sigma(same), own.sigma(same))


@pytest.mark.parametrize("trains", [None, "HSLM-A1"], ids=["cars", "constant loads"])
def test_a_sweep_over_the_choice_gives_each_its_own(tmp_path, trains):
    case = rb.case("paper").replace(WAVES)
    over = {"run.acceleration_modes": list(LIMIT), "run.speed": [40.0]}
    asked = {"trains": trains, "measure": ["acceleration_z", "displacement_z"], "points": [18.0]}
    found = rb.sweep(case, over, **asked)
    assert not found.message.values.any()
    values = found.acceleration_z.values.ravel()
    for value, chosen in zip(values, LIMIT, strict=True):
        alone = rb.sweep(case.replace({"run.acceleration_modes": chosen}), {"run.speed": [40.0]},
                         **asked)  # fmt: skip
        assert value == pytest.approx(alone.acceleration_z.values.item(), rel=1e-9)
        if trains is None:
            run = case.replace({"run.speed": 40.0, "run.acceleration_modes": chosen}).compute()
            assert value == pytest.approx(np.abs(from_modes(run, chosen)).max(), rel=1e-9)
    assert len(set(values.tolist())) == 3
    assert len(set(found.displacement_z.values.ravel().tolist())) == 1


def test_a_store_filled_under_another_choice_is_not_taken(tmp_path):
    case = rb.case("paper").replace(WAVES)
    found = [
        rb.sweep(
            case.replace({"run.acceleration_modes": chosen}), {"run.speed": [20.0]},
            measure=["acceleration_z"], out=tmp_path / "study",
        ).acceleration_z.values.item()
        for chosen in (*LIMIT, "all")
    ]  # fmt: skip
    assert found[0] == found[3] and len(set(found)) == 3


def test_rotations_are_outputs_like_any_other():
    deck, train = rb.deck("viaduct36"), rb.train("HSLM-A1")
    found = studies.speed_envelope(deck, train, [50.0], [0.0, 18.0], ("rotation_y", "rotation_z"))
    run = rb.cross(train, deck, speed=50.0, time_step=2.5e-4)
    known = [abs(run.rotations(x).extreme("rotation_y")[0]) for x in (0.0, 18.0)]
    assert found.rotation_y.values.ravel() == pytest.approx(known, rel=1e-3)
    assert found.rotation_y.attrs["units"] == "rad"
    line = deck.recovery.section("rotation_y", 0.0)
    statics = np.abs(run.static_extremes(line)).max()
    assert found.rotation_y_static.values.ravel()[0] == pytest.approx(statics, rel=1e-3)


def test_twist_goes_across_the_ends_of_a_deck(run):
    deck = run.deck
    inner, before, behind = (twist_at(deck, x).line for x in (10.0, -2.0, 35.0))
    turned = {x: deck.recovery.section("rotation_x", x).modal for x in (10.0, 13.0, 1.0, 35.0)}
    assert inner.modal == pytest.approx(1.435 * (turned[13.0] - turned[10.0]))
    assert before.modal == pytest.approx(1.435 * turned[1.0])
    assert behind.modal == pytest.approx(-1.435 * turned[35.0])
    with pytest.raises(rb.InputError):
        twist_at(deck, -3.1)
    plain = rb.Beam("plain", (20.0,), 1e4, 1e10).deck(modes=2)
    with pytest.raises(rb.InputError, match="rigid in twist.*Leave it out"):
        outputs_at(plain, ("twist",), [10.0])
