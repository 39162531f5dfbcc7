"""Studies that are shipped: opened by name, computed again in part, and the rule read off them."""

import sys

import numpy as np
import pytest

import map as maps
import railbridge as rb

xr = pytest.importorskip("xarray")

FLOAT32 = 3e-7


@pytest.fixture(scope="module")
def study():
    return rb.open_study("speed_wavelength")


@pytest.fixture(scope="module")
def masses():
    return rb.open_study("deck_mass")


def ratio(found):
    return found.attrs["car_mass"] / (found.deck_mass * found.attrs["deck_length"])


def test_a_study_says_what_it_is_in_which_units(study):
    assert dict(study.sizes) == {"speed": 50, "wavelength": 50}
    for name in study.data_vars:
        assert study[name].attrs["units"] and study[name].attrs["long_name"], name
        assert np.isfinite(study[name].values).all(), name
    assert study.speed.attrs["units"] == "m/s" and study.wavelength.attrs["units"] == "m"
    assert study.attrs["deck_frequency_hz"] == pytest.approx(3.3074, rel=1e-4)
    assert study.attrs["car_frequency_hz"] == pytest.approx(1.3345, rel=1e-3)
    assert 10.4 in np.round(study.attrs["filter_zeros"], 6)
    assert study.attrs["car_mass"] == pytest.approx(59.71e3, rel=1e-3)


def test_shipped_studies_are_small(study):
    for path in (rb.data_root() / "studies").glob("*.nc"):
        assert path.stat().st_size < 400e3, path.name


def test_a_dozen_points_are_what_the_command_computes_today(study):
    speeds, waves = study.speed.values[[3, 8, 28, 49]], study.wavelength.values[[5, 23, 40]]
    now = maps.study(maps.base_case(), maps.PASSES, speeds, waves)
    kept = study.sel(speed=speeds, wavelength=waves)
    for name in kept.data_vars:
        atol = 1e-4 if name.startswith("deviation") else 0.0  # per cent, a difference
        assert np.allclose(kept[name], now[name], rtol=1e-6, atol=atol), name


def test_the_map_over_masses_is_what_the_command_computes_today(masses):
    speeds, waves = masses.speed.values[[3, 16]], masses.wavelength.values[[8, 12]]
    now = maps.study(maps.with_mass(maps.base_case(), 6e3), maps.SETTLED, speeds, waves)
    kept = masses.sel(deck_mass=6e3, speed=speeds, wavelength=waves)
    for name in kept.data_vars:
        atol = 1e-4 if name.startswith("deviation") else 0.0
        assert np.allclose(kept[name], now[name], rtol=1e-6, atol=atol), name


def test_coordinates_are_those_of_the_command(study, masses):
    assert np.allclose(study.speed, maps.SPEEDS) and np.allclose(study.wavelength, maps.WAVELENGTHS)
    assert np.allclose(masses.deck_mass, maps.DECK_MASSES)


# ---- the rule of thirds (notebook 07)


def test_sag_and_force_change_by_less_than_a_third_of_the_mass_ratio(study, masses):
    R = study.attrs["car_mass"] / (12e3 * 36.0)
    for found, own in (study, R), (masses, ratio(masses)):
        for name in ("displacement_z", "wheel_force_z"):
            assert float((abs(found[f"deviation_{name}"]) / 100 / own).max()) < 1 / 3, name
        assert float((abs(found.deviation_acceleration_z) / 100 / own).max()) < 1.5


def test_the_rule_is_no_empty_bound(masses):
    """Force comes within a tenth of it for every mass, and sag within a half."""
    share = abs(masses.deviation_wheel_force_z).max(("speed", "wavelength")) / 100 / ratio(masses)
    assert (share > 0.9 / 3).all()
    share = abs(masses.deviation_displacement_z).max(("speed", "wavelength")) / 100 / ratio(masses)
    assert (share > 0.4 / 3).all()


def shares(length, frequency, mass, damping, speed, wavelength, cars=1):
    """What passes change in largest force and sag, over the mass ratio."""
    deck = {"length": length, "mass": mass, "damping": {"modal": damping}, "modes": 12}
    stiffness = mass * (2 * np.pi * frequency) ** 2 * (length / np.pi) ** 4
    deck["bending_stiffness_vertical"] = stiffness
    own = {"deck": deck, "train.track": 0.0, "train.cars": cars, "output.points": [length / 2]}
    case = maps.base_case().replace(own)
    found = maps.study(case, maps.SETTLED, [speed], [wavelength])
    R = 59.71e3 / (mass * length)
    names = ("deviation_wheel_force_z", "deviation_displacement_z")
    return [abs(float(found[name].item())) / 100 / R for name in names]


@pytest.mark.parametrize(
    "deck",
    [
        (36.0, 3.307, 12e3, 0.01, 64.0, 20.4),
        (36.0, 6.0, 12e3, 0.03, 92.0, 10.2),
        (25.0, 4.5, 15e3, 0.01, 76.0, 10.2),
        (20.0, 6.0, 12e3, 0.02, 92.0, 7.2),
        (15.0, 4.76, 17e3, 0.011, 68.4, 14.11),
    ],
)
def test_the_rule_holds_on_other_decks_where_it_is_nearest_to_failing(deck):
    assert max(shares(*deck)) < 1 / 3


def test_the_rule_fails_on_soft_decks_and_for_cars_in_step():
    force, _ = shares(36.0, 2.0, 12e3, 0.03, 92.0, 28.8)
    assert force > 1.0, "a frequency 1.5 times the car's"
    force, _ = shares(60.0, 2.0, 15e3, 0.03, 92.0, 20.4)
    assert force > 1.0
    _, sag = shares(36.0, 3.307, 12e3, 0.03, 76.0, 40.7, cars=8)
    assert 0.8 < sag < 1.2


def test_the_rule_fails_on_short_spans_at_speed_and_where_bogies_meet_the_deck():
    force, _ = shares(14.0, 4.25, 8e3, 0.019, 91.5, 35.44)
    assert force > 0.4, "V / (f L) = 1.5"
    _, sag = shares(21.0, 9.91, 13e3, 0.016, 31.0, 3.55)
    assert sag > 0.4, "the bogies bounce at 9 Hz"


def test_eq_3_obeys_no_such_rule(study):
    assert float(study.deviation_from_rigid.max()) > 1000.0
    place = study.where(study.deviation_from_rigid == study.deviation_from_rigid.max(), drop=True)
    assert abs(float(place.deviation_wheel_force_z.item())) < 5.0


# ---- what is refused


def test_an_unknown_study_is_refused_with_the_nearest(tmp_path):
    with pytest.raises(rb.InputError, match=r"no such study. Did you mean 'speed_wavelength'\?"):
        rb.open_study("speed_wavelenght")
    with pytest.raises(rb.InputError, match=r"must end in \.nc"):
        rb.open_study(tmp_path / "study.toml")
    with pytest.raises(rb.InputError, match="no such file"):
        rb.open_study(tmp_path / "study.nc")
    with pytest.raises(rb.InputError, match="Shipped: deck_mass, speed_wavelength"):
        rb.open_study(3)
    (tmp_path / "broken.nc").write_bytes(b"no numbers")
    with pytest.raises(rb.InputError, match=r"broken\.nc.*cannot be opened"):
        rb.open_study(tmp_path / "broken.nc")


def test_what_a_sweep_has_written_is_opened_again(tmp_path):
    found = rb.sweep(maps.base_case(), {"run.speed": [20.0, 30.0]})
    found.to_netcdf(tmp_path / "sweep.nc")
    again = rb.open_study(tmp_path / "sweep.nc")
    assert np.array_equal(again.displacement_z, found.displacement_z)


def test_without_the_extra_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(rb.InputError, match=r"xarray is missing.*railbridge\[study\]"):
        rb.open_study("speed_wavelength")
