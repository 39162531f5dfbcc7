"""Few modes of a long deck are the first of all its modes, and cost no dense matrix."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.beams import mesh
from railbridge.errors import InputError

E = 35e9


def viaduct(spans, right=-2.3, **more):
    """The section of viaduct36 on elastic pads beside and below its axis, which couple all its
    freedoms."""
    pads = tuple(
        rb.Bearing(36.0 * i, (), y, -1.3, {"z": 3e9, "y": 5e8, "x": 2e9 if i == 0 else 2e6})
        for i in range(spans + 1)
        for y in (2.5, right)
    )
    given = {"bearings": pads, "centroid_height": 0.3} | more
    return rb.Beam(
        "v",
        (36.0,) * spans,
        12e3,
        E * 2.553,
        E * 25.53,
        E / 2.4 * 5.59,
        E * 4.8,
        2500 * 28.083,
        **given,
    )


LONG = {
    "one group": viaduct(5),
    "two groups": viaduct(5, right=-2.5),
    "four groups": viaduct(8, bearings=(), centroid_height=0.0),
    "simple spans": viaduct(6, bearings=(), continuous=False, centroid_height=0.0),
}


@pytest.mark.parametrize("name", LONG)
@pytest.mark.parametrize("count", [3, 40])
def test_few_modes_are_the_first_of_all(name, count):
    beam = LONG[name]
    everything = beam.modes
    deck, wanted = beam.deck(count), np.flatnonzero(everything.excitable)[:count]
    assert beam.mesh.size > mesh.DENSE and len(deck.frequencies_hz) == count
    assert deck.frequencies_hz == pytest.approx(everything.frequencies_hz[wanted], rel=1e-9)
    # Neighbours that are nearly equal may be any mixture, and signs are free: what they do together
    # is the same.
    x = np.linspace(0.0, beam.length, 41)
    ours, theirs = deck.shapes(x), beam.mesh.interpolate(everything.vectors[:, wanted])(x)
    if name != "simple spans":
        assert deck.mode_names == tuple(everything.names[i] for i in wanted)
        gaps = (
            np.diff(everything.frequencies_hz[np.append(wanted, wanted[-1] + 1)])
            / deck.frequencies_hz
        )
        apart = np.minimum(gaps, np.append(1.0, gaps[:-1])) > 1e-3
        assert apart.sum() > count / 3
        assert np.abs(ours[:, apart] - theirs[:, apart]).max(axis=0) == pytest.approx(
            0.0, abs=1e-6 * np.abs(theirs).max()
        )


def test_all_modes_of_the_mesh_can_be_asked_for():
    beam = LONG["two groups"]
    count = int(beam.modes.excitable.sum())
    assert len(beam.deck(count).frequencies_hz) == count
    with pytest.raises(InputError, match=f"the mesh has {count} modes"):
        beam.deck(count + 1)


def test_a_long_viaduct_needs_no_dense_modes(monkeypatch):
    """Neither all modes nor dense matrices of all freedoms: cost grows with the number of spans."""

    def refuse(*matrices):
        raise AssertionError(f"dense matrices of {len(matrices[0])} freedoms")

    monkeypatch.setattr(mesh, "eigh", refuse)
    deck = viaduct(10).deck(20)
    # Equal spans swing against each other as simple ones would; pads that give, or hold lengthwise,
    # change it a little.
    simple = np.pi / 2 / 36.0**2 * np.sqrt(E * 2.553 / 12e3)
    assert deck.frequencies_hz[deck.mode_names.index("vertical bending 1")] == pytest.approx(
        simple, rel=0.03
    )


def test_a_mode_that_the_iteration_misses_is_found_all_the_same(monkeypatch):
    beam = viaduct(5)
    expected = beam.deck(10).frequencies_hz

    def forgetful(k, m, count):
        values, shapes = lowest(k, m, count + 1)
        return np.delete(values, 4), np.delete(shapes, 4, axis=1)

    lowest = mesh.lowest
    monkeypatch.setattr(mesh, "lowest", forgetful)
    assert beam.deck(10).frequencies_hz == pytest.approx(expected, rel=1e-9)


def test_more_modes_than_fit_into_memory_are_refused():
    """All modes of a beam of 9 000 coupled freedoms: full matrices of 4 GB."""
    lines = [rb.Bearing(x, ("x", "y", "z", "roll"), z=-1.0) for x in (0.0, 100.0)]
    lines += [rb.Bearing(x, ("z",), y=1.0, z=-1.0) for x in np.linspace(0.0, 100.0, 100)[1:-1]]
    beam = rb.Beam(
        "many", (100.0,), mass=1e4, bending_stiffness_vertical=1e10, bearings=tuple(lines),
        bending_stiffness_lateral=1e11, torsional_stiffness=1e10, polar_inertia=1e5,
        axial_stiffness=1e11, centroid_height=-0.5,
    )  # fmt: skip
    assert len(beam.deck(modes=5, damping=0.02).frequencies_hz) == 5
    with pytest.raises(rb.InputError, match=r"^modes: all modes of \d+ coupled .* limit is 2 GB"):
        beam.deck(modes=2500, damping=0.02)
