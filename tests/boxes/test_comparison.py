"""Likeness of modes: by hand, and a box as shell beside the same box as beam."""

import numpy as np
import pytest
from box_tables import box

import railbridge as rb
from railbridge.boxes.comparison import beam_motions, mac, pairs, shell_against_beam
from railbridge.errors import InputError


def test_assurance_criterion():
    a = np.eye(4)[:, :3]
    assert mac(a, a) == pytest.approx(np.eye(3))
    mixed = np.column_stack([(a[:, 0] + a[:, 1]) * -7.0])
    assert mac(a, mixed)[:, 0] == pytest.approx([0.5, 0.5, 0.0])
    assert mac(a, mixed, [3.0, 1.0, 1.0, 1.0])[:, 0] == pytest.approx([0.75, 0.25, 0.0])
    assert pairs(np.array([[0.9, 0.6], [0.95, 0.1], [0.2, 0.3]])) == {1: 0, 0: 1}
    for bad in ((a, np.zeros((3, 2))), (a, np.zeros((4, 1)))):
        with pytest.raises(InputError):
            mac(*bad)


def test_shell_and_beam_agree_where_a_beam_holds():
    """First vertical bending within 2 %, first lateral within 6 %; each the other's mode; torsion
    lower, by distortion."""
    plain = box()
    s, beam = plain.shell(), plain.beam()
    modes = s.modes(8)
    criterion = shell_against_beam(s, modes, beam, s.centre[1] - plain.section.shear_centre[1])
    ours = dict(zip(modes.names, range(8), strict=True))
    for name, limit in (("vertical bending 1", 0.02), ("lateral bending 1", 0.06)):
        other = int(np.argmax(criterion[ours[name]]))
        assert criterion[ours[name], other] > 0.9 and beam.modes.names[other] == name
        assert modes.frequencies_hz[ours[name]] == pytest.approx(
            beam.modes.frequencies_hz[other], rel=limit
        )
    torsion = dict(zip(beam.modes.names, beam.modes.frequencies_hz, strict=True))["torsion 1"]
    assert modes.frequencies_hz[ours["torsion 1"]] < 0.9 * torsion
    assert np.all(criterion <= 1.0 + 1e-9) and np.all(criterion >= 0.0)


def test_a_section_turns_about_the_centroid_and_the_axis():
    """Vertical bending: the height moves along by minus the pitch times its distance from the
    centroid, and not sideways."""
    beam = rb.Beam("b", (20.0,), 10e3, 8e10, axial_stiffness=1e11, centroid_height=0.5)
    x = beam.mesh.nodes[3:9]
    low, high = beam_motions(beam, x, 0.5), beam_motions(beam, x, 1.5)
    bending = beam.modes.names.index("vertical bending 1")
    assert low[:, 4, bending] == pytest.approx(
        -beam.mesh.interpolate(beam.modes.vectors[:, bending])(x, 1)[:, 0, 1]
    )
    assert high[:, 0] - low[:, 0] == pytest.approx(low[:, 4])
    assert high[:, 2] == pytest.approx(low[:, 2]) and not high[:, 1].any()
