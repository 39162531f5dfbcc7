"""The identification: its stored result, its pairing, its derivatives, and what it refuses."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.boxes.girder import BoxMesh
from railbridge.errors import InputError
from railbridge.validation import candidates, published
from railbridge.validation import identification as ident

TINY = BoxMesh(12, 2, 4, 2)


@pytest.fixture(scope="module")
def fit():
    return ident.identified()


@pytest.fixture(scope="module")
def best():
    return ident.stored()["best"]


def middle():
    return {u.name: (u.low + u.high) / 2 for u in candidates.UNKNOWNS}


def test_the_stored_box_is_solved_again(fit, best):
    """One solution gives the frequencies that are stored."""
    assert fit.frequencies_hz == pytest.approx(best["frequencies_hz"], abs=2e-4)
    assert fit.rms() == pytest.approx(best["rms_first_ten_percent"], abs=1e-3)
    assert list(fit.names) == best["names"]


def test_it_reaches_what_was_asked(fit):
    """Below 4 % over the first ten; mass per metre within 10 % of Table 4's; within the bounds."""
    assert fit.rms() < 4.0
    assert fit.mass == pytest.approx(published.MASS, rel=0.1)
    for unknown in candidates.UNKNOWNS:
        assert unknown.low - 1e-9 <= fit.values[unknown.name] <= unknown.high + 1e-9, unknown.name


def test_deck_file_is_the_stored_box(best):
    drawn = rb.box(candidates.DECK_NAME)
    fitted = candidates.box_of(best["values"], best["inner_diaphragms"])
    for key in (
        "spans", "tracks", "density", "poisson_ratio", "inner_diaphragms", "slab_width", "depth",
        "web_spacing",
    ):  # fmt: skip
        assert getattr(drawn, key) == getattr(fitted, key)
    assert drawn.bottom_spacing == pytest.approx(fitted.bottom_spacing)
    for ours, theirs in zip(drawn.bearings, fitted.bearings, strict=True):
        assert ours.stiffness == pytest.approx(theirs.stiffness, rel=1e-5)
        assert (ours.fixed, ours.drop) == (theirs.fixed, theirs.drop)


def test_identified_deck_crosses_and_says_what_it_is():
    deck = rb.deck(candidates.DECK_NAME)
    text = (rb.data_root() / "decks" / f"{candidates.DECK_NAME}.toml").read_text()
    assert "identified, not known" in text
    assert deck.recovery is not None and deck.tracks == {"left": 2.4, "right": -2.4}
    run = rb.cross(rb.AxleTrain((0.0,), (150e3,)), deck, speed=20.0, track_offset="left")
    sag = np.abs(run.displacement(18.0)["displacement_z"]).max()
    assert 1e-4 < sag < 1e-2


def test_reproduction_deck_is_untouched():
    assert rb.deck("viaduct36").frequencies_hz[0] == pytest.approx(3.307, abs=1e-3)


def test_stored_result_tells_spread_and_what_is_open():
    result = ident.stored()
    assert result["label"] == "identified, not known"
    values = np.array(result["singular_values"])
    assert np.all(np.diff(values) <= 0) and values[0] > 100 * values[-1]
    directions = np.array([list(d.values()) for d in result["directions"]])
    assert directions @ directions.T == pytest.approx(np.eye(len(candidates.UNKNOWNS)), abs=0.01)
    assert len(result["coarse"]) >= 4 and {f["inner_diaphragms"] for f in result["coarse"]} == {
        0,
        2,
    }
    assert min(f["rms_first_ten_percent"] for f in result["alternatives"]) > 0


def test_modes_are_paired_by_shape():
    """Each family finds its own mode, also where a deep, narrow box bends sideways first."""
    box = candidates.box_of(middle() | {"slab_width": 8.6, "depth": 2.6, "web_spacing": 4.0})
    shell = box.shell(TINY)
    modes = shell.modes(20)
    found = candidates.families(shell, modes, 36.0)
    assert set(found) == set(candidates.FAMILIES) and len(set(found.values())) == 5
    for kind in ("vertical", "lateral", "torsion"):
        assert modes.shares[kind][found[f"{kind} 1"]] > 0.5
    for hypothesis, places in candidates.HYPOTHESES.items():
        _, which = candidates.paired_modes(box, hypothesis, TINY)
        assert len(set(which.tolist())) == len(published.TABLE2_DECK)
        assert [which[p] for p in places] == [found[f] for f in candidates.FAMILIES]


def test_lengthwise_bearing_makes_the_pair():
    """Softer lengthwise bearings lower the axial-bending mode, and leave the first bending mode."""
    study = ident.bearing_study(rb.box(candidates.DECK_NAME), TINY)
    fitted, soft, rigid = study["as identified"], study["soft (1 MN/m)"], study["rigid"]
    assert soft["vertical 2"] > fitted["vertical 2"] + 0.5
    assert rigid["axial-bending 1"] >= fitted["axial-bending 1"] - 1e-6
    assert soft["vertical 1"] == pytest.approx(fitted["vertical 1"], rel=0.03)


def test_table_shows_shell_and_beam(fit):
    beam = ident.beam_frequencies(rb.box(candidates.DECK_NAME))
    frame = ident.table(fit, beam)
    assert len(frame) == 15 and frame["beam (Hz)"].notna().sum() == 5
    frequency, likeness = beam["vertical 1"]
    assert frequency == pytest.approx(fit.frequencies_hz[0], rel=0.05) and likeness > 0.95


def test_the_table_sets_each_mode_beside_the_printed_one():
    printed = np.array(published.TABLE2_DECK)
    names = tuple(f"mode {i}" for i in range(15))
    torsion_third = "torsion third, second vertical fourth"
    solved = printed * np.repeat([1.1, 0.8], [10, 5])
    made = candidates.Fit(middle(), 0, torsion_third, solved, names, 12e3)
    assert made.rms() == pytest.approx(10.0)
    assert made.rms(15) == pytest.approx(np.sqrt((10 * 10.0**2 + 5 * 20.0**2) / 15))
    frame = ident.table(made)
    columns = ["printed (Hz)", "shell (Hz)", "difference (%)", "mode of the shell"]
    assert list(frame.columns) == columns
    assert frame.index.name == "mode" and frame.index.tolist() == list(range(1, 16))
    assert frame["printed (Hz)"].tolist() == printed.tolist()
    assert frame["shell (Hz)"].tolist() == solved.tolist()
    assert frame["difference (%)"].tolist() == pytest.approx([10.0] * 10 + [-20.0] * 5)
    assert frame["mode of the shell"].tolist() == list(names)
    beam = {"torsion 1": (15.2, 0.9), "vertical 2": (13.5, 0.8)}
    frame = ident.table(made, beam)
    assert list(frame.columns) == [*columns, "beam (Hz)", "likeness of shell and beam"]
    known = frame[["beam (Hz)", "likeness of shell and beam"]].dropna()
    assert known.index.tolist() == [3, 4]
    assert known.to_numpy().tolist() == [[15.2, 0.9], [13.5, 0.8]]


@pytest.mark.parametrize(
    ("unit", "value", "written"),
    [
        ("m", 0.25049, 0.25), ("Pa", 34.26e9, 34.3e9), ("kg/m", 700.4, 700.0), ("-", 0.8756, 0.876),
        ("N/m", 9.876, 9.88), ("m", -1e-5, 0.0),
    ],
)  # fmt: skip
def test_dimensions_are_rounded_as_in_a_drawing(unit, value, written):
    found = candidates.Unknown("x", 0.0, 1.0, unit, "why").rounded(value)
    assert str(found) == str(written)


def made(hypothesis="as ordered", factor=1.0, tail=1.0):
    """A fit whose first ten frequencies are a factor off the printed ones, the others another."""
    printed = np.array(published.TABLE2_DECK)
    frequencies = printed * np.where(np.arange(15) < 10, factor, tail)
    names = tuple(f"mode {i}" for i in range(15))
    return candidates.Fit({"depth": 2.0}, 0, hypothesis, frequencies, names, 11234.56)


def test_a_fit_tells_how_far_it_is_off():
    fit = made(factor=1.02, tail=0.96)
    assert fit.differences == pytest.approx([2.0] * 10 + [-4.0] * 5)
    assert fit.rms() == pytest.approx(2.0)
    assert fit.rms(15) == pytest.approx(np.sqrt((10 * 4.0 + 5 * 16.0) / 15))
    kept = fit.to_dict()
    assert kept["rms_first_ten_percent"] == 2.0 and kept["mass"] == 11234.6
    assert kept["rms_all_percent"] == pytest.approx(2.828, abs=1e-3)
    assert kept["frequencies_hz"] == pytest.approx(fit.frequencies_hz, abs=5e-5)


@pytest.mark.parametrize("hypothesis", candidates.HYPOTHESES)
def test_the_beam_stands_in_the_row_of_the_printed_mode_it_is_paired_with(hypothesis):
    fit = made(hypothesis, factor=1.02)
    beam = {family: (float(i + 1), 0.9 - 0.1 * i) for i, family in enumerate(candidates.FAMILIES)}
    frame = ident.table(fit, beam)
    assert list(frame.columns) == [
        "printed (Hz)", "shell (Hz)", "difference (%)", "mode of the shell", "beam (Hz)",
        "likeness of shell and beam",
    ]  # fmt: skip
    assert list(frame.index) == list(range(1, 16)) and frame.index.name == "mode"
    places = candidates.HYPOTHESES[hypothesis]
    for place, (frequency, likeness) in zip(places, beam.values(), strict=True):
        row = frame.loc[place + 1]
        assert (row["beam (Hz)"], row["likeness of shell and beam"]) == (frequency, likeness)
    assert frame["beam (Hz)"].isna().sum() == 10
    assert frame["printed (Hz)"].tolist() == list(published.TABLE2_DECK)
    assert frame["shell (Hz)"].tolist() == fit.frequencies_hz.tolist()
    assert frame["difference (%)"].tolist() == pytest.approx([2.0] * 10 + [0.0] * 5)
    assert frame["mode of the shell"].tolist() == list(fit.names)
    assert list(ident.table(fit).columns) == list(frame.columns)[:4]


@pytest.mark.parametrize(
    ("name", "value", "written"),
    [
        ("depth", 2.13449, 2.134), ("youngs_modulus", 3.4761e10, 3.48e10),
        ("track_mass", 2323.4, 2323.0), ("bottom share", 0.87654, 0.877),
        ("log10 stiffness", 9.8765, 9.88), ("drop", -1e-5, 0.0),
    ],
)  # fmt: skip
def test_a_value_is_written_as_into_a_drawing(name, value, written):
    unknown = next(u for u in candidates.UNKNOWNS if u.name == name)
    assert unknown.rounded(value) == written and np.copysign(1.0, unknown.rounded(value)) == 1.0


def test_missing_result_names_the_command(monkeypatch, tmp_path):
    monkeypatch.setenv("RAILBRIDGE_DATA", str(tmp_path))
    with pytest.raises(InputError, match="make identify"):
        ident.stored()


def test_unknown_hypotheses_are_refused():
    with pytest.raises(InputError, match="as ordered"):
        candidates.evaluate(middle(), hypothesis="by order", mesh=TINY)
