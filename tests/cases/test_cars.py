"""Vehicles from a few parameters: what each parameter may be, and what is built of them."""

import pytest

import railbridge as rb
from railbridge.cases.cars import CAR_PARAMETERS, two_bogie_car

PARAMETERS = {"wheelset_mass": 0.0, **rb.car_parameters("xia2000")}


RADIUS = "at least 0.05 and at most 5 m"
CONTACT = "at least 1000000 and at most 1e+12 N/m. Steel on steel has about 1.3e9 N/m a wheel"
SPECIAL = {
    "wheelset_mass": "at least 0 kg", "static_wheelset_mass": "at least 0 kg",
    "gauge": "above 0 and at most 5 m", "wheel_radius": RADIUS, "rail_head_radius": RADIUS,
    "contact_stiffness": CONTACT, "contact_lateral_stiffness": CONTACT,
    "contact_modulus": "at least 1e+09 and at most 1e+12 Pa",
    "contact_poisson": "at least 0 and at most 0.499",
}  # fmt: skip


def allowed(name):
    """What a parameter of Table 1 may be, by its name; each kind has one unit."""
    if name in SPECIAL:
        return SPECIAL[name]
    kinds = {
        "mass": "above 0 kg", "inertia": "above 0 kg m2", "stiffness": "at least 0 N/m",
        "damping": "at least 0 N s/m", "length": "above 0 m", "spacing": "above 0 m",
        "width": "above 0 m",
    }  # fmt: skip
    return kinds.get(name.rpartition("_")[2], "in m")  # a height may have either sign


@pytest.mark.parametrize("name", CAR_PARAMETERS)
def test_a_parameter_out_of_range_is_refused_by_its_name_and_unit(name):
    if allowed(name) == "in m":
        assert two_bogie_car("c", **{**PARAMETERS, name: -0.01}).name == "c"
        wrong = [float("nan"), "high"]
    else:
        wrong = [-0.01, float("inf")] + [0.0] * allowed(name).startswith("above")
    for value in wrong:
        with pytest.raises(rb.InputError) as error:
            two_bogie_car("c", **{**PARAMETERS, name: value})
        said = f"vehicle c: {name} = {value!r}: must be a finite number {allowed(name)}."
        assert str(error.value) == said


def test_a_sprung_mass_from_numbers_is_the_shipped_one():
    shipped, made = rb.vehicle("sprung_mass"), rb.sprung_mass("sprung_mass", 5750.0, 1595e3)
    assert (made.bodies, made.springs) == (shipped.bodies, shipped.springs)
    assert made.length == shipped.length == 10.0
    damped = rb.sprung_mass("mass", 5750.0, 1595e3, 2e4, 12.0)
    assert damped.length == 12.0 and damped.damping_matrix.tolist() == [[2e4]]
