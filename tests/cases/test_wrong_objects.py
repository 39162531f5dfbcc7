"""Objects of the wrong kind, given in Python, are refused by the name of the argument."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import exchange
from railbridge.beams import Bearing
from railbridge.cases.cars import two_bogie_car
from railbridge.cases.objects import box_from_table
from railbridge.cases.summary import summarize

CAR = rb.vehicle("xia2000")
CASE = rb.Case(
    {
        "deck": {"length": 20.0, "bending_stiffness_vertical": 5e9, "mass": 1e4, "modes": 2,
                 "damping": {"modal": 0.01}},
        "train": {"axles": [0.0], "loads": [1e5]},
        "run": {"speed": 20.0, "interaction": "rigid", "time_step": 5e-3},
    }
)  # fmt: skip
WAVES = rb.Track(rb.Harmonic(1e-3, wavelength=10.0))
WRONG = [
    None, 5, "x", "y z", [], {}, object(), [None], ["x"], np.zeros(3), np.nan, 1e308, np.inf, True,
    3j, b"b", (), len, {1: 2}, [[1, 2]], "\0", np.array([[1.0]]), np.array("x"), 10**5000,
]  # fmt: skip
CALLS = {
    "Bearing x": Bearing,
    "Bearing fixed": lambda v: Bearing(0.0, v),
    "Bearing stiffness": lambda v: Bearing(0.0, stiffness=v),
    "Bearing span": lambda v: Bearing(0.0, span=v),
    "Beam name": lambda v: rb.Beam(v, (10.0,), 1e4, 1e9),
    "Beam spans": lambda v: rb.Beam("b", v, 1e4, 1e9),
    "Beam bearings": lambda v: rb.Beam("b", (10.0,), 1e4, 1e9, bearings=v),
    "Beam continuous": lambda v: rb.Beam("b", (10.0,), 1e4, 1e9, continuous=v),
    "Body name": lambda v: rb.Body(v, 1.0, (1, 1, 1), (0, 0, 0)),
    "Body inertia": lambda v: rb.Body("b", 1.0, v, (0, 0, 0)),
    "Body freedoms": lambda v: rb.Body("b", 1.0, (1, 1, 1), (0, 0, 0), v),
    "Spring at": lambda v: rb.Spring("a", "rail", v, (1.0, 1.0), (1.0, 1.0)),
    "Vehicle name": lambda v: rb.Vehicle(v, CAR.bodies, CAR.springs),
    "Vehicle bodies": lambda v: rb.Vehicle("v", v, CAR.springs),
    "Vehicle springs": lambda v: rb.Vehicle("v", CAR.bodies, v),
    "planar_car": rb.planar_car,
    "Train": rb.Train,
    "AxleTrain": lambda v: rb.AxleTrain(v, [1e5]),
    "train": rb.train,
    "train wagons": lambda v: rb.train("D4", wagons=v),
    "hslm_b": lambda v: rb.hslm_b(v, v),
    "load_model": rb.load_model,
    "Requirements": rb.Requirements,
    "assess deck": lambda v: rb.assess(v, CASE.train, [20.0], rb.Requirements(40.0)),
    "assess needs": lambda v: rb.assess(CASE.deck, CASE.train, [20.0], v),
    "assess_run": lambda v: rb.assess_run(v, rb.Requirements(40.0)),
    "Case": rb.Case,
    "case": rb.case,
    "case changes": lambda v: rb.case("paper", v),
    "replace": CASE.replace,
    "replace a value": lambda v: CASE.replace({"run.speed": v}),
    "replace a table": lambda v: CASE.replace({"deck": v}),
    "get": CASE.get,
    "summary": CASE.summary,
    "summarize": lambda v: summarize(v, [10.0]),
    "summarize points": lambda v: summarize(CASE.compute(), v),
    "rayleigh_ratio alpha": lambda v: rb.rayleigh_ratio(v, 0.1, [1.0]),
    "rayleigh_ratio f": lambda v: rb.rayleigh_ratio(0.1, 0.1, v),
    "Beam.deck tracks": lambda v: rb.Beam("b", (10.0,), 1e4, 1e9).deck(2, tracks=v),
    "deck_from_table": lambda v: rb.deck_from_table("d", v),
    "vehicle": rb.vehicle,
    "deck": rb.deck,
    "read_nodes": exchange.read_nodes,
    "read_modes": lambda v: exchange.read_modes(v, v),
    "read_modes modes": lambda v: exchange.read_modes("nodes.csv", v),
    "ModesTable units": lambda v: exchange.ModesTable("a", "b", units=v),
    "ModesTable rail": lambda v: exchange.ModesTable("a", "b", rail=v),
    "export_modes units": lambda v: exchange.export_modes(CASE.deck, "out", v),
    "export_modes deck": lambda v: exchange.export_modes(v, "out"),
    "steady_forces vehicle": lambda v: rb.steady_forces(v, WAVES, 20.0),
    "steady_forces track": lambda v: rb.steady_forces(CAR, v, 20.0),
    "steady_forces speed": lambda v: rb.steady_forces(CAR, WAVES, v),
    "transfer": CAR.transfer,
    "amplitude_spectrum step": lambda v: rb.amplitude_spectrum(np.ones(9), v),
    "amplitude_spectrum signal": lambda v: rb.amplitude_spectrum(v, 0.1),
    "cross train": lambda v: rb.cross(v, CASE.deck, speed=20.0),
    "cross speed": lambda v: rb.cross(CASE.train, CASE.deck, speed=v),
}


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("call", CALLS)
def test_what_is_of_the_wrong_kind_is_refused_in_words(call):
    refused = 0
    for value in WRONG:
        try:
            CALLS[call](value)
        except rb.InputError as error:
            refused += 1
            assert str(error) and "\n" not in str(error) and len(str(error)) < 1000
    assert refused >= len(WRONG) / 2


def test_a_path_of_keys_as_long_as_one_likes_is_refused():
    for path in (".".join("a" * 900), "run." + ".".join("a" * 5000)):
        with pytest.raises(rb.InputError, match="leads more than 20 tables deep"):
            CASE.replace({path: 1})


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (rb.Case, "case = 5: must be a table"),
        (rb.case, "case = 5: must be a name or a path"),
        (lambda v: rb.case("paper", v), "changes = 5: must be a table of new values by path"),
        (lambda v: rb.case({}, v), "changes = 5: must be a table of new values by path"),
        (CASE.replace, "changes = 5: must be a table of new values by path"),
        (lambda v: CASE.replace({v: 1}), "path of a change = 5: must be a text"),
        (CASE.get, "path = 5: must be a text"),
        (CASE.summary, "run = 5: must be a Crossing"),
        (lambda v: summarize(v, [10.0]), "run = 5: must be a Crossing"),
        (lambda v: rb.deck_from_table(v, {}), "name = 5: must be a text"),
        (lambda v: rb.deck_from_table("d", v), "deck d = 5: must be a table"),
        (lambda v: box_from_table(v, {}), "name = 5: must be a text"),
        (two_bogie_car, "name = 5: must be a text"),
    ],
)
def test_what_is_of_the_wrong_kind_is_refused_by_its_name(call, named):
    with pytest.raises(rb.InputError) as error:
        call(5)
    assert str(error.value).startswith(named)
