"""How many modes are kept where nobody says it."""

import re
from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.beams.selection import A_SPAN, AT_LEAST, CEILING, REACH
from railbridge.decks import whole_group

TRAIN = rb.AxleTrain([0.0, 2.5, 17.5, 20.0], [150e3] * 4)


def spans(count, continuous=False, **options):
    return rb.Beam("v", (30.0,) * count, 36e3, 2.5e11, continuous=continuous, **options)


def kinds(deck):
    return {name: sum(n.startswith(name) for n in deck.mode_names) for name in A_SPAN}


def test_every_one_of_many_simple_spans_answers_alike():
    """With the twenty lowest of 25 equal modes the last spans stood still, and the moment was 27 %
    low."""
    deck = spans(25).deck(damping=0.02)
    assert len(deck.frequencies_hz) == 75 and deck.remarks == ()
    run = rb.cross(TRAIN, deck, speed=75.0, interaction="rigid")
    middles = 15.0 + 30.0 * np.arange(25)
    sag = [run.displacement(x)["displacement_z"].min() for x in middles]
    assert sag == pytest.approx([-1.0422e-3] * 25, rel=1e-4)
    one = rb.cross(TRAIN, spans(1).deck(3, 0.02), speed=75.0, interaction="rigid")
    moment = [run.section_forces(x).extreme("moment_vertical")[0] for x in middles[::6]]
    assert moment == pytest.approx([one.section_forces(15.0).extreme("moment_vertical")[0]] * 5,
                                   rel=2e-3)  # fmt: skip
    assert moment[0] == pytest.approx(-2825.8e3, rel=1e-3)


def test_a_long_continuous_viaduct_has_a_dynamic_factor_above_one():
    """Twenty modes of thirty spans gave 0.92 where enough of them give 1.05."""
    deck = spans(30, continuous=True).deck(damping=0.02)
    run = rb.cross(TRAIN, deck, speed=75.0, interaction="rigid")
    finer = rb.cross(TRAIN, spans(30, True).deck(200, 0.02), speed=75.0, interaction="rigid")
    for x in (15.0, 435.0, 885.0):
        sags = [r.displacement(x).extreme("displacement_z")[0] for r in (run, finer)]
        assert sags[0] == pytest.approx(sags[1], rel=2e-3)
    summary = rb.summarize(run, [435.0])["points"][0]["displacement_z"]
    assert 1.0 < summary["dynamic_factor"] < 1.1


def test_the_default_reaches_thirty_hertz_and_every_direction():
    beam = spans(3, bending_stiffness_lateral=2e12, torsional_stiffness=1.5e11, polar_inertia=2e5)
    deck = beam.deck()
    found, frequencies = kinds(deck), beam.deck(len(deck.frequencies_hz) + 1).frequencies_hz
    assert frequencies[-1] > REACH and len(deck.frequencies_hz) >= AT_LEAST
    assert all(found[name] >= 3 * least for name, least in A_SPAN.items())
    assert deck.remarks == ()


def test_a_vertical_mode_is_there_however_many_others_come_first():
    """Soft sideways and in twist: the first vertical mode is the seventh or later."""
    soft = spans(
        2, bending_stiffness_lateral=2e8, torsional_stiffness=1e7, polar_inertia=2e5, elements=60
    )
    deck = soft.deck(damping=0.01)
    assert kinds(deck)["vertical"] >= 6 and deck.has["z"]
    few = "^modes = 3: none of so few moves up and down. Take"
    with pytest.raises(rb.InputError, match=f"{few} more, or leave modes out"):
        soft.deck(3)
    soft = replace(soft, elements=10)  # all its modes are known, so also the first that would do
    with pytest.raises(rb.InputError, match=few) as said:
        soft.deck(3)
    least = int(re.search(r"Take at least (\d+), or leave modes out\.", str(said.value))[1])
    assert least >= 7 and soft.deck(least).has["z"]
    with pytest.raises(rb.InputError, match=f"Take at least {least}, "):
        soft.deck(least - 1)


def test_more_modes_than_the_mesh_has_are_refused_with_their_number():
    beam = spans(1, elements=4)
    most = len(beam.modes.names)
    assert len(beam.deck(most).frequencies_hz) == most
    with pytest.raises(rb.InputError, match=rf"^modes = {most + 1}: the mesh has {most} modes tha"):
        beam.deck(most + 1)


def test_few_modes_of_a_short_stiff_deck_do():
    """Twenty modes in the plane of a 10 m deck would reach 3 kHz."""
    deck = rb.Beam("short", (10.0,), 10e3, 4e9).deck()
    assert len(deck.frequencies_hz) == 3 and deck.frequencies_hz[1] < CEILING


def test_a_deck_far_stiffer_sideways_is_left_to_statics_there():
    stiff = rb.Beam(
        "stiff", (30.0,), 10e3, 5e10, 5e15, torsional_stiffness=5e10, polar_inertia=1e5
    ).deck()
    assert not stiff.has["y"] and stiff.has["roll"]
    run = rb.cross(TRAIN, stiff, speed=30.0, track_offset=1.0, interaction="rigid")
    assert np.all(run.displacement(15.0)["displacement_y"] == 0.0)


@pytest.mark.parametrize("modes", [20, 40])
def test_a_number_that_cuts_a_group_or_leaves_spans_still_is_remarked(modes):
    deck = spans(25).deck(modes, 0.02)
    cut, *lost = map(str, deck.remarks)
    assert cut.startswith(f"modes = {modes} cuts a group of equal frequencies, ")
    assert cut.endswith(f"Take {25 if modes == 20 else 50}.")
    if modes == 20:
        assert lost[0].startswith("modes = 20: the modes left out hold 100% of the deck's flex")
        with pytest.warns(UserWarning, match=r"deck\.modes = 20: .* up and down at x = "):
            rb.cross(TRAIN, deck, speed=75.0, interaction="rigid")
    else:
        assert lost == []  # the first of every span are there, the second not all
    assert spans(25).deck(50, 0.02).remarks == ()


def test_groups_of_equal_frequencies_are_whole():
    f = np.array([1.0, 2.0, 2.0, 2.0 * (1 + 1e-7), 3.0, 3.0])
    assert [whole_group(f, n) for n in range(7)] == [0, 1, 4, 4, 4, 6, 6]
