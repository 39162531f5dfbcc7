"""The steady state on harmonic rails: the paper's waves, Newton's law, what is refused."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.steady import steady_motion

CAR = rb.vehicle("xia2000")
V = 20.0


def waves(wavelength, **lateral):
    return rb.Track(vertical=rb.Harmonic(5e-3, wavelength=wavelength), **lateral)


def bounce(forces):
    return abs(forces[:, 1].sum())


def pitch(forces):
    return abs(sum(-c.x * f for c, f in zip(CAR.contacts, forces[:, 1], strict=True)))


@pytest.mark.parametrize(
    ("wavelength", "with_delays", "in_phase"), [(14.4, 75.8e3, 91.8e3), (15.0, 81.0e3, 94.2e3)]
)
def test_bounce_amplitude_of_the_paper_s_waves(wavelength, with_delays, in_phase):
    assert bounce(rb.steady_forces(CAR, waves(wavelength), V)) == pytest.approx(
        with_delays, rel=1e-3
    )
    assert bounce(rb.steady_forces(CAR, waves(wavelength), V, "car")) == pytest.approx(
        in_phase, rel=1e-3
    )
    # Delays act as the wheelbase filter.
    filtered = abs(np.cos(2 * np.pi * 7.8 / wavelength) * np.cos(2 * np.pi * 1.25 / wavelength))
    assert with_delays / in_phase == pytest.approx(filtered, rel=2e-3)


def test_short_waves_leave_pitch_and_no_bounce():
    forces = rb.steady_forces(
        CAR, rb.Track(vertical=rb.Harmonic(5e-3, length=36.0, half_waves=11.7)), V
    )
    assert bounce(forces) == pytest.approx(0.58e3, rel=0.02)
    assert pitch(forces) == pytest.approx(52.6e3, rel=2e-3)
    in_phase = rb.steady_forces(
        CAR, rb.Track(vertical=rb.Harmonic(5e-3, length=36.0, half_waves=11.7)), V, "car"
    )
    assert bounce(in_phase) == pytest.approx(18e3, rel=0.03)


def test_worst_unloading():
    forces = rb.steady_forces(
        CAR, waves(14.4, lateral=rb.Harmonic(2e-3, wavelength=14.4, phase=np.pi / 2)), V
    )
    assert np.abs(forces[:, 1]).max() / CAR.contacts[0].static_load == pytest.approx(
        0.149, abs=1e-3
    )


def test_steady_state_needs_one_wavelength():
    track = rb.Track(
        vertical=rb.Harmonic(5e-3, wavelength=14.4), lateral=rb.Harmonic(5e-3, wavelength=12.0)
    )
    for wrong in (track, rb.Track(), rb.Track(vertical=rb.Table([0, 10.0], [0, 1e-3]))):
        with pytest.raises(rb.InputError, match="one wavelength"):
            rb.steady_forces(CAR, wrong, V)


def test_two_rails_given_as_a_list_are_told_of_rails():
    mirrored = [rb.Harmonic(5e-3, wavelength=14.4, phase=psi) for psi in (0.0, np.pi)]
    with pytest.raises(rb.InputError, match=r"Rails\(left=\.\.\., right=\.\.\.\)"):
        rb.steady_forces(CAR, rb.Track(vertical=mirrored), V)
    with pytest.raises(rb.InputError) as caught:
        rb.steady_forces(CAR, rb.Track(), V)
    assert "Rails" not in str(caught.value)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"vehicle": rb.Train(rb.vehicle("xia2000"))}, "^vehicle = .*must be a Vehicle"),
        ({"track": rb.Harmonic(1e-3, wavelength=10.0)}, "^track = .*must be a Track"),
        ({"track": rb.Track()}, "^track.*one wavelength"),
        ({"speed": -20.0}, "^speed = -20.0: .*above 0"),
        ({"excitation": "wheel"}, "^excitation = 'wheel'.*wheels"),
    ],
)
def test_what_has_no_steady_forces(change, said):
    good = {
        "vehicle": rb.vehicle("xia2000"),
        "track": rb.Track(rb.Harmonic(1e-3, wavelength=10.0)),
        "speed": 20.0,
    }
    with pytest.raises(rb.InputError, match=said):
        rb.steady_forces(**good | change)


def test_steady_motion_obeys_newton():
    """What the wheels press on the deck is what the bodies' masses ask for."""
    motion, s = steady_motion(CAR, waves(14.4), V), 2j * np.pi * V / 14.4
    force = rb.steady_forces(CAR, waves(14.4), V)[:, 1].sum()
    inertia = sum(body.mass * s**2 * motion[f"{body.name} z"] for body in CAR.bodies)
    assert list(motion) == list(CAR.labels) and force == pytest.approx(-inertia)
