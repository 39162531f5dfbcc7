"""The search for a box: derivatives, a known answer, refusals, and the command around it."""

import json

import numpy as np
import pytest

import railbridge as rb
from railbridge.boxes.girder import BoxMesh
from railbridge.errors import InputError
from railbridge.validation import candidates, fitting, published
from railbridge.validation.candidates import UNKNOWNS

TINY = BoxMesh(12, 2, 4, 2)
HALF = np.full(len(UNKNOWNS), 0.5)


def middle():
    return {u.name: (u.low + u.high) / 2 for u in UNKNOWNS}


def test_derivatives_are_those_of_full_solutions():
    """Rayleigh's quotients give what central differences of solved frequencies give."""
    problem = fitting.Problem(0, "as ordered", TINY)
    u = np.full(len(UNKNOWNS), 0.45)
    jacobian = problem.jacobian(u)
    for name in (
        "depth", "web_thickness", "youngs_modulus", "track_mass", "log10 stiffness", "drop",
        "bottom_thickness",
    ):  # fmt: skip
        j = [x.name for x in UNKNOWNS].index(name)
        step = np.zeros(len(u))
        step[j] = 2e-3
        # The modes of the deck as a whole, and the mass: modes of the plates may cross.
        rows = [0, 1, 2, 3, 4, 15]
        central = (problem.residuals(u + step) - problem.residuals(u - step))[rows] / 4e-3
        room = 0.05 * np.abs(central).max()
        assert jacobian[rows, j] == pytest.approx(central, rel=0.05, abs=room)


def test_residuals_weigh_the_first_ten_modes_most():
    problem = fitting.Problem(0, "as ordered", TINY)
    printed, mass = np.array(published.TABLE2_DECK), published.MASS
    assert problem._residuals(printed, mass) == pytest.approx(np.zeros(16), abs=1e-12)
    off = problem._residuals(printed * np.exp(0.01), mass * np.exp(-0.01))
    assert off == pytest.approx([1.0] * 10 + [0.5] * 5 + [-0.5])


def test_unknowns_run_from_their_lower_to_their_upper_bound():
    problem = fitting.Problem(0, "as ordered", TINY)
    for share, bound in ((0.0, "low"), (1.0, "high")):
        known = {u.name: getattr(u, bound) for u in UNKNOWNS}
        assert problem.values(np.full(len(UNKNOWNS), share)) == pytest.approx(known)
    box = problem.box(HALF)
    assert box.depth == pytest.approx(middle()["depth"])
    assert box.bottom_spacing / box.web_spacing == pytest.approx(middle()["bottom share"])
    pads = box.bearings
    assert pads[0].stiffness == pytest.approx({"x": 10 ** middle()["log10 stiffness"]})
    assert [p.drop for p in pads] == pytest.approx([middle()["drop"]] * 2)


@pytest.mark.parametrize(("mass", "more"), [(1.0, 0.0), (1.1, 0.0), (1.13, 3.0), (0.85, 5.0)])
def test_a_mass_costs_what_it_is_more_than_ten_per_cent_off(mass, more):
    printed = np.array(published.TABLE2_DECK)
    fit = candidates.Fit({}, 0, "as ordered", 1.02 * printed, (), mass * published.MASS)
    assert fitting._cost(fit) == pytest.approx(2.0 + more)


def test_search_recovers_a_box_whose_frequencies_are_given(monkeypatch):
    """Fitted to the frequencies of a box of our own, the residual falls to nearly nothing."""
    truth = candidates.evaluate(middle(), mesh=TINY)
    monkeypatch.setattr(published, "TABLE2_DECK", tuple(truth.frequencies_hz.tolist()))
    monkeypatch.setattr(published, "MASS", truth.mass)
    start = HALF.copy()
    start[[0, 4, 5, 12]] += [0.08, -0.08, 0.08, 0.05]
    fit, _ = fitting.search(start, mesh=TINY, steps=15)
    assert fit.rms(15) < 0.3 and fit.mass == pytest.approx(truth.mass, rel=0.01)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: fitting.search(np.zeros(3)), r"^start = .* must hold 16 numbers"),
        (lambda: fitting.search(np.full(16, 2.0)), r"^start\[1\] = .*at most 1"),
        (lambda: fitting.search(HALF, hypothesis="by order"), "^hypothesis = .*as ordered"),
        (lambda: fitting.search(HALF, inner_diaphragms=-1), "^inner_diaphragms = -1"),
        (lambda: fitting.identify(starts=0), "^starts = 0"),
        (lambda: fitting.identify(workers=0), "^workers = 0"),
    ],
)
def test_wrong_calls_are_refused(call, says):
    with pytest.raises(InputError, match=says):
        call()


def test_the_command_writes_a_deck_file_that_loads(monkeypatch, tmp_path, capsys):
    import identify

    best = candidates.evaluate(middle(), mesh=TINY).to_dict()
    quick = {"label": "identified, not known", "best": best}
    monkeypatch.setattr(identify.fitting, "identify", lambda *args, **options: quick)
    monkeypatch.setattr("sys.argv", ["identify.py", "--to", str(tmp_path)])
    identify.main()
    assert "stored" in capsys.readouterr().out
    name = candidates.DECK_NAME
    stored = json.loads((tmp_path / "identification" / f"{name}.json").read_text())
    assert stored["best"] == best
    assert rb.box(tmp_path / "decks" / f"{name}.toml").depth == middle()["depth"]
