"""Modes at another program's nodes, put under the rail."""

import dataclasses
import shutil
import warnings

import numpy as np
import pytest
from modal_files import EXAMPLE, change, crossing, differ, read

import railbridge as rb
from railbridge.cases.summary import summarize
from railbridge.exchange.modal import deck_from_modes


@pytest.fixture
def folder(tmp_path):
    """A copy of the example that a test may spoil."""
    return shutil.copytree(EXAMPLE, tmp_path / "model")


@pytest.mark.parametrize(
    "rail",
    [{"y": 3.38, "z": 1.3}, {"left": {"nodes": range(101, 126)}, "right": {"y": 1.42, "z": 1.3}}],
    ids=["arm", "pair"],
)
def test_nodes_beside_the_axis_move_it_as_a_rigid_section(rail):
    model = read(EXAMPLE)
    on_axis = deck_from_modes(model, model.nodes.line({"y": 0.0, "z": 0.0}))
    line = model.nodes.line(rail, {"y": 0.0, "z": 0.0})
    off, other = differ(deck_from_modes(model, line), on_axis), 10 * [0.0]
    assert len(other) == len(on_axis.mode_names)
    # One node has rotations, so the axis follows to round-off of the file; a pair has splines.
    assert off.max() < (1e-2 if line.paired else 1e-8)
    # Without `axis` the deck axis is at the rails themselves, which move sideways when the deck
    # twists about an axis below.
    raised = deck_from_modes(model, model.nodes.line(rail))
    twist = raised.mode_names.index("torsion 1") if "torsion 1" in raised.mode_names else 3
    above = raised.shapes(np.array([18.0]))[0, twist]
    assert above[0] == pytest.approx(-1.3 * above[2], rel=1e-6)


def test_displacements_alone_do_where_there_are_no_rotations(folder):
    """As solid elements: rotations are printed as zeros, or not at all."""
    whole = read(EXAMPLE)
    exact = deck_from_modes(whole, whole.nodes.line({"y": 0.0, "z": 0.0}))
    pair = {"left": {"y": 3.38, "z": 1.3}, "right": {"y": 1.42, "z": 1.3}}
    for edit in (
        lambda lines: [
            line if i < 2 else ",".join([*line.split(",")[:7], "0,0,0"])
            for i, line in enumerate(lines)
        ],
        lambda lines: [
            line if i < 1 else ",".join(line.split(",")[:7]) for i, line in enumerate(lines)
        ],
    ):
        change(folder / "modes.csv", edit)
        model = read(folder, masses=False)
        assert model.rotations == (False, False, False)
        deck = deck_from_modes(model, model.nodes.line(pair, {"y": 0.0, "z": 0.0}), count=6)
        assert differ(deck, dataclasses.replace(exact, shapes=_first(exact.shapes, 6))).max() < 2e-3
        single = deck_from_modes(model, model.nodes.line({"y": 0.0, "z": 0.0}))
        assert single.has == {"y": True, "z": True, "roll": False}
        # Pure torsion moves no rail of such a line.
        assert not any(name.startswith("torsion") for name in single.mode_names)


def _first(shapes, count):
    return dataclasses.replace(shapes, coefficients=shapes.coefficients[:, :, :count])


def test_nodes_too_few_for_the_waves_of_a_mode_are_warned_of():
    """Without rotations only displacements tell the shape: two nodes a half wave do not do."""
    model = dataclasses.replace(read(EXAMPLE), rotations=(False, False, False))
    with pytest.warns(UserWarning) as seen:
        deck_from_modes(model, model.nodes.line({"nodes": range(1, 26, 4)}))
    assert [str(warning.message) for warning in seen] == [
        "modes: the 7 nodes of the rail are few for uz of mode 9, which changes sign 3 times. "
        "Use a finer line, fewer modes, or write rotations too."
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        deck_from_modes(model, model.nodes.line({"nodes": range(1, 26, 3)}))
        with_rotations = read(EXAMPLE)
        deck_from_modes(with_rotations, with_rotations.nodes.line({"nodes": range(1, 26, 4)}))


def test_masses_show_how_orthogonal_the_modes_are():
    found = read(EXAMPLE).orthogonality()
    assert found.known_masses and found.worst < 1e-8
    assert found.own == pytest.approx(np.ones(10), rel=1e-6)
    guess = read(EXAMPLE, masses=False).orthogonality()
    assert not guess.known_masses and np.isnan(guess.own).all()


def test_what_modes_cannot_give_is_null_and_said():
    deck = rb.deck(EXAMPLE / "deck.toml")
    summary = summarize(crossing(deck, interaction="rigid", iterations=None), [18.0])
    point = summary["points"][0]
    assert [
        point[n] for n in ("moment_vertical", "moment_lateral", "torsion", "shear_vertical")
    ] == [None] * 4
    assert point["displacement_z"]["min"]["value"] < -1e-3
    assert summary["reactions"] == [] and summary["self_weight"]["moment_vertical"] == [None]
    assert "Only modes of this deck are known" in summary["remarks"][0]
    assert (
        summarize(crossing(rb.deck("viaduct36"), interaction="rigid", iterations=None), [18.0])[
            "remarks"
        ]
        == []
    )
    with pytest.raises(rb.InputError, match="only its modes are known"):
        crossing(deck, interaction="rigid", iterations=None).section_forces(18.0)


def test_too_few_modes_of_a_viaduct_are_remarked(tmp_path):
    """Six simple spans alike have six equal frequencies: four of them leave spans standing still,
    five leave one half of what moves."""
    beam = rb.Beam("six", (30.0,) * 6, 36e3, 2.5e11, continuous=False)
    whole = rb.deck(rb.exchange.export_modes(beam.deck(12, 0.02), tmp_path / "whole"))
    assert whole.remarks == ()
    content = tmp_path / "whole"
    few = rb.case(
        {
            "deck": {"file": str(content / "deck.toml"), "modes": 4},
            "train": {"axles": [0.0], "loads": [1e5]},
            "run": {"speed": 40.0, "interaction": "rigid"},
        }
    )
    texts = [str(doubt) for doubt in few.doubts]
    assert any(t.startswith("deck.modes.count = 4 cuts a group of equal") for t in texts)
    # Written by a program that was asked for three modes, the file itself cannot tell.
    short = rb.deck(rb.exchange.export_modes(beam.deck(3, 0.02), tmp_path / "short"))
    (remark,) = short.remarks
    assert str(remark).startswith("modes move nothing up and down from x = ")
    assert "other span" in str(remark) or "m: too few" in str(remark)


@pytest.mark.parametrize(
    ("modes", "others"), [(1, ", nor in 2 other spans"), (2, ", nor in 1 other span"), (3, "")]
)
def test_spans_that_stand_still_are_counted(tmp_path, modes, others):
    """The longest span moves first, so each mode leaves one span less."""
    beam = rb.Beam("four", (30.0, 27.0, 25.0, 23.0), 36e3, 2.5e11, continuous=False)
    (remark,) = rb.deck(rb.exchange.export_modes(beam.deck(modes, 0.02), tmp_path / "m")).remarks
    start, end = np.cumsum([0.0, 30.0, 27.0, 25.0, 23.0])[modes : modes + 2]
    assert str(remark) == (
        f"modes move nothing up and down from x = {start:g} to {end:g} m{others}: "
        "too few modes were written."
    )


def test_modes_that_move_nothing_up_and_down_are_remarked(tmp_path):
    sideways = rb.Beam("deck", (30.0,), 36e3, 2.5e11, 5e10).deck(2, 0.02)
    only = dataclasses.replace(
        sideways, shapes=_first(sideways.shapes, 1), frequencies_hz=sideways.frequencies_hz[:1],
        damping_ratios=sideways.damping_ratios[:1], mode_names=sideways.mode_names[:1],
        recovery=None,
    )  # fmt: skip
    assert not only.has["z"]
    (remark,) = rb.deck(rb.exchange.export_modes(only, tmp_path / "only")).remarks
    assert str(remark) == "modes move nothing up and down: vertical results are null."


def test_a_rail_that_stands_still_and_damping_that_is_none_are_refused():
    model = read(EXAMPLE)
    line = model.nodes.line({"y": 0.0, "z": 0.0})
    for damping in (-0.1, "little", (1.0,)):
        with pytest.raises(rb.InputError, match="damping"):
            deck_from_modes(model, line, damping=damping)
    still = dataclasses.replace(model, shapes=0.0 * model.shapes)
    with pytest.raises(rb.InputError, match="line: stands still in every mode"):
        deck_from_modes(still, line)


def test_modes_that_are_left_out_take_their_damping_with_them():
    """A mode in the middle that does not move the rail: the others keep their own ratios."""
    model = read(EXAMPLE)
    line = model.nodes.line({"y": 0.0, "z": 0.0})
    shapes = np.array(model.shapes)
    shapes[2] = 0.0
    own = np.linspace(0.01, 0.1, len(shapes))
    still = dataclasses.replace(model, shapes=shapes, damping_ratios=own)
    kept = np.delete(np.arange(len(shapes)), 2)
    alpha, beta = rb.rayleigh(0.03, (3.3, 16.3))
    omega = 2 * np.pi * model.frequencies_hz[kept]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # masses do not fit a mode of zeros
        decks = [deck_from_modes(still, line, damping=d) for d in (None, (alpha, beta), 0.02)]
    by_rayleigh = alpha / (2 * omega) + beta * omega / 2
    for deck, ratios in zip(decks, (own[kept], by_rayleigh, 0.02), strict=True):
        assert deck.frequencies_hz == pytest.approx(model.frequencies_hz[kept])
        assert deck.damping_ratios == pytest.approx(ratios * np.ones(len(kept)))
    few = deck_from_modes(still, line, damping=(alpha, beta), count=4)
    assert few.damping_ratios == pytest.approx(by_rayleigh[:4])
