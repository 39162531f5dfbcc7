"""Shipped vehicles against frequencies and axle loads computed elsewhere, and against formulas."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases import shelf

# Bounce, pitch, then the bogies' pitch and bounce, Hz; static axle load, kN.
COMPUTED_ELSEWHERE = {
    "manchester": ([1.0725, 1.2973, 7.4187, 7.4255, 11.617, 11.617], 109.1),
    "shinkansen_s300": ([0.7229, 0.8949, 4.8752, 4.8752, 4.9195, 4.9262], 134.8),
    "chinese_star_power_car": ([1.1271, 1.1984, 7.169, 7.171, 7.594, 7.594], 191.3),
    "double_deck_coach_cn": ([1.0638, 1.1260, 8.03, 8.03, 8.66, 8.66], 99.6),
    "velaro_e": ([0.8037, 1.0898, 6.32, 6.32, 10.52, 10.52], 152.1),
    "eurostar_373_locomotive": (None, 153.8),
}
# kg, kg m2, m, N/m of the whole car in its plane: body, bogie, axle; typed in again.
PUBLISHED = {
    # body m, I; half bogie distance; bogie m, I; half wheelbase; wheelset; primary; secondary
    "manchester": (32000, 1.97e6, 9.5, 2615, 1476, 1.28, 1813, (2.4e6, 8e3), (8.6e5, 4e4)),
    "shinkansen_s300": (
        41750, 2.08e6, 8.75, 3040, 3930, 1.25, 1780, (1.18e6, 39.2e3), (5.3e5, 90.2e3)
    ),
    "chinese_star_power_car": (
        59364.2, 1.723e6, 5.73, 5630.8, 9487, 1.5, 1843.5,
        (2 * 2.3996e6, 2 * 30e3), (2 * 0.8858e6, 2 * 45e3),
    ),
    "double_deck_coach_cn": (
        29600, 2.139e6, 9.0, 1700, 1700, 1.2, 1900, (2 * 0.873e6, 60e3), (2 * 0.41e6, 217.4e3)
    ),
    "velaro_e": (47800, 1957888, 8.6875, 3500, 1715, 1.25, 1800, (2.4e6, 20e3), (7e5, 40e3)),
    "velaro_e_c45": (41200, 1687552, 8.6875, 3500, 1372, 1.25, 1800, (2.4e6, 20e3), (7e5, 40e3)),
    "eurostar_373_locomotive": (
        51500, 1.05e6, 7.0, 2200, 1900, 1.5, 1700, (2.6e6, 12e3), (3.26e6, 90e3)
    ),
    # Printed as half a car, one spring and one wheel.
    "nl_passenger_heavy": (
        2 * 19000, 2 * 1.15e6, 10.0, 2 * 1550, 2 * 1200, 1.25, 2 * 950,
        (2 * 1.2e6, 2 * 2.5e3), (2 * 3.5e5, 2 * 3.2e4),
    ),
    "nl_passenger_light": (
        2 * 14500, 2 * 0.9e6, 9.5, 2 * 1300, 2 * 1150, 1.28, 2 * 850,
        (2 * 7.4e5, 2 * 6.4e3), (2 * 4e5, 2 * 2.2e4),
    ),
}  # fmt: skip


def by_hand(name):
    """Six frequencies, Hz, of pairs of two by two problems: symmetric and antisymmetric motion."""
    m, i, l, mb, ib, a, _, (kp, _), (ks, _) = PUBLISHED[name]
    found = [np.sqrt(2 * kp * a**2 / ib)] * 2  # bogies pitch by themselves
    for stiffness, inertia in ((2 * ks, m), (2 * ks * l**2, i)):
        share = stiffness / 2 / ks  # of the body's freedom: 1, or l squared
        k = np.array([[stiffness, -stiffness], [-stiffness, stiffness + 4 * kp * share]])
        mass = np.array([inertia, 2 * mb * share])
        values = np.linalg.eigvals(k / mass[:, None])
        found += list(np.sqrt(values.real))
    return np.sort(found) / (2 * np.pi)


@pytest.mark.parametrize("name", COMPUTED_ELSEWHERE)
def test_frequencies_and_axle_loads_are_those_computed_elsewhere(name):
    expected, load = COMPUTED_ELSEWHERE[name]
    car = rb.vehicle(name)
    assert [c.static_load / 1e3 for c in car.contacts] == pytest.approx([load] * 4, abs=0.06)
    if expected is not None:
        assert car.modes().frequencies_hz == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("name", PUBLISHED)
def test_files_hold_what_was_published(name):
    m, i, l, mb, ib, a, mw, primary, secondary = PUBLISHED[name]
    car = rb.vehicle(name)
    body, *bogies = car.bodies
    assert (body.mass, body.inertia[1]) == (m, i)
    assert [(b.mass, b.inertia[1], b.position[0]) for b in bogies] == [(mb, ib, l), (mb, ib, -l)]
    assert [axle.x for axle in car.axles] == pytest.approx([l + a, l - a, a - l, -a - l])
    for spring in car.springs:
        expected = primary if spring.on_rail else secondary
        assert (spring.stiffness[1], spring.damping[1]) == pytest.approx(expected)
    assert car.static_wheelset_mass == mw
    assert car.modes().frequencies_hz == pytest.approx(by_hand(name), rel=1e-9)
    # Nobody published lateral data: none are made up.
    assert all(b.freedoms == ("z", "pitch") for b in car.bodies)


WHEELED = {"xia2000_wheelsets": {"roll_inertia": 1000.0}, "xia2000_planar_wheelsets": {}}


@pytest.mark.parametrize("name", WHEELED)
def test_the_papers_car_on_wheelsets_is_the_papers_car(name):
    car, plain = rb.vehicle(name), rb.vehicle(name.removesuffix("_wheelsets"))
    made = rb.with_wheelsets(plain, mass=1800.0, contact_damping=100e3, **WHEELED[name])
    for matrix in ("mass_matrix", "stiffness_matrix", "damping_matrix"):
        assert getattr(car, matrix) == pytest.approx(getattr(made, matrix), rel=1e-9)
    # By Hertz 1.33739e9 N/m at 80 kN a wheel; an axle in the plane has two.
    load = 585.76e3 / 8 + 900.0 * 9.81
    wheels = 2 if "planar" in name else 1
    expected = wheels * 1.33739e9 * np.cbrt(load / 80e3)
    assert car.contact_stiffness[:, 1] == pytest.approx(expected, rel=1e-5)
    assert car.contact_damping[:, 1] == pytest.approx(wheels * 100e3)
    assert car.weight == pytest.approx(plain.weight + 4 * 1800.0 * 9.81)


def test_every_shipped_file_says_its_source_and_is_held_by_a_test():
    known = {*PUBLISHED, "sprung_mass", "xia2000", "xia2000_planar", *WHEELED}
    assert set(shelf.data_names("vehicles")) == known
    for name in PUBLISHED:
        content = shelf.read_toml(shelf.data_file("vehicles", name))
        assert len(content["source"]) > 20
        assert "left and right together" in content["note"]
    for name in shelf.data_names("trains"):
        assert "# source: " in shelf.data_file("trains", name, ".csv").read_text(encoding="utf-8")
