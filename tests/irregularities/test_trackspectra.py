"""Spectra of irregularities: sigma, scaling, tables, and the errors of public code."""

import pickle

import numpy as np
import pytest
from scipy.integrate import quad, trapezoid

import railbridge as rb
from railbridge.errors import InputError
from railbridge.irregularities import D1, D2, D3, TrackSpectrum, spectrum_names

# component, band (m), sigma (mm or mrad) as printed, in the order of the sources
PRINTED = [
    ("german-low", "vertical", D1, 0.9843),
    ("german-low", "alignment", D1, 0.7135),
    ("german-low", "cross_level", D1, 0.91201),
    ("german-low", "gauge", D1, 0.2485),
    ("german-low", "vertical", (3, 150), 2.8633),
    ("german-low", "alignment", (3, 150), 2.0758),
    ("german-low", "cross_level", (3, 150), 1.21582),
    ("german-low", "gauge", (3, 150), 0.3312),
    ("german-high", "vertical", D1, 1.6109),
    ("german-high", "alignment", D1, 1.2131),
    ("german-high", "cross_level", D1, 1.49263),
    ("german-high", "gauge", D1, 0.3461),
    ("fra-aar-1", "vertical", D1, 8.5407),
    ("fra-aar-2", "vertical", D1, 7.8320),
    ("fra-aar-3", "vertical", D1, 6.4083),
    ("fra-aar-4", "vertical", D1, 5.6912),
    ("fra-aar-5", "vertical", D1, 3.5528),
    ("fra-aar-6", "vertical", D1, 1.4291),
    ("fra-fryba-1", "vertical", D1, 1.647),
    ("fra-fryba-6", "vertical", D1, 0.4138),
    ("chinese-ballastless", "vertical", (2, 200), 1.2203),
    ("chinese-ballastless", "alignment", (2, 200), 0.6678),
    ("chinese-ballastless", "cross_level", (2, 200), 0.5235),
    ("chinese-ballastless", "gauge", (2, 200), 0.3437),
    ("sncf-good", "vertical", (2, 40), 1.2837),
    ("sncf-poor", "vertical", (2, 40), 2.4073),
]


@pytest.mark.parametrize(("name", "component", "band", "printed"), PRINTED)
def test_sigma_is_the_printed_one(name, component, band, printed):
    digits = len(f"{printed}".partition(".")[2])
    found = 1e3 * rb.spectrum(name).sigma(component, band)
    assert found == pytest.approx(printed, abs=0.51 * 10.0**-digits)


@pytest.mark.parametrize("name", spectrum_names())
def test_sigma_is_the_integral_of_the_density(name):
    spectrum = rb.spectrum(name).scaled(7e-4)
    for component in spectrum.components:
        for band in (D1, (5.3, 38.0), spectrum.band):
            # In the logarithm of the wave number, in steps too fine to miss a kink.
            ends = np.log(2 * np.pi / np.array(band[::-1]))
            t = np.linspace(*ends, 40001)
            density = np.exp(t) * spectrum.density(component, np.exp(t))
            by_hand = np.sqrt(trapezoid(density, t))
            assert spectrum.sigma(component, band) == pytest.approx(by_hand, rel=2e-6)


def test_a_cross_level_that_is_an_angle_is_a_height_over_one_and_a_half_metres():
    spectrum = rb.spectrum("german-low")
    assert 1e3 * spectrum.sigma("cross_level", D1, height=True) == pytest.approx(1.3680, abs=5e-5)
    wavenumber = np.array([[0.1, 0.5], [1.0, 2.0]])
    angle = spectrum.density("cross_level", wavenumber)
    height = spectrum.density("cross_level", wavenumber, height=True)
    assert height == pytest.approx(2.25 * angle, rel=1e-14) and angle.shape == (2, 2)
    assert spectrum.unit("cross_level") == "rad2/(rad/m)"
    assert spectrum.unit("cross_level", height=True) == "m2/(rad/m)"
    # What is a height already stays as it is.
    chinese = rb.spectrum("chinese-ballastless")
    for name in ("cross_level", "vertical"):
        same = chinese.density(name, wavenumber, height=True)
        assert np.array_equal(same, chinese.density(name, wavenumber))
        assert chinese.unit(name) == chinese.unit(name, height=True) == "m2/(rad/m)"
    assert chinese.sigma("cross_level", D1, height=True) == chinese.sigma("cross_level", D1)


def test_densities_at_one_wave_number_by_hand():
    # W = 1 rad/m, so n = 1 / (2 pi) 1/m and S(W) = S(n) / (2 pi)
    n = 1 / (2 * np.pi)
    german = 4.032e-7 * 0.8246**2 / ((1 + 0.0206**2) * (1 + 0.8246**2))
    fryba = 1.57e-8 * 0.131**2 * (n**2 + 0.0233**2) / (n**4 * (n**2 + 0.131**2)) * n
    sncf = 308e-6 * 0.509 / (1 + n / 0.0489) ** 3 * n
    chinese = 3.9488e-4 * 1e-6 / n**3.4516 * n
    for name, by_hand in (
        ("german-low", german), ("fra-fryba-5", fryba), ("sncf-good", sncf),
        ("chinese-ballastless", chinese),
    ):  # fmt: skip
        found = rb.spectrum(name).density("vertical", 1.0)
        assert found.shape == () and float(found) == pytest.approx(by_hand, rel=1e-12)
    across = 4 * 0.25 * 0.2095e-4 * 0.8245**2 / ((1 + 0.8245**2) * (1 + 0.8209**2))
    for name in ("cross_level", "gauge"):
        found = rb.spectrum("fra-aar-5").density(name, 1.0)
        assert float(found) == pytest.approx(across, rel=1e-12)


@pytest.mark.parametrize(
    ("component", "breaks", "gap"),
    [
        ("vertical", (0.0187, 0.0474, 0.1533), 4e-3),
        ("alignment", (0.0450, 0.1234), 1.3e-3),
        ("cross_level", (0.0258, 0.1163), 1.3e-3),
        ("gauge", (0.1090, 0.2938), 1.3e-3),
    ],
)
def test_the_chinese_pieces_meet(component, breaks, gap):
    spectrum = rb.spectrum("chinese-ballastless")
    for at in breaks:
        below, above = spectrum.density(component, 2 * np.pi * at * np.array([1 - 1e-9, 1 + 1e-9]))
        assert below != above  # two pieces
        assert above / below == pytest.approx(1.0, abs=gap)


# ---- errors found in public code: the number the wrong formula gives, and that ours is not it


def aar(x, a, k=0.25, corner=0.8245):
    return k * a * corner**2 / (x**2 * (x**2 + corner**2))


def waves(band=D1):
    return 2 * np.pi / band[1], 2 * np.pi / band[0]


def test_not_a_formula_without_k_in_cycles_with_waves_of_twice_the_height():
    """2 pi A W_c^2 / (...) as the density, and sqrt(4 S dW) as the height of a wave."""
    true = rb.spectrum("fra-aar-6").sigma("vertical") ** 2
    a = 0.0339e-4
    # A cosine of height h has the variance h^2 / 2.
    wrong = quad(lambda w: 4 * 2 * np.pi * aar(w, a, k=1.0) / 2, *waves())[0]
    assert wrong / true == pytest.approx(50.27, abs=5e-3)
    assert np.sqrt(wrong / true) == pytest.approx(7.09, abs=5e-3)
    right = quad(lambda w: 2 * aar(w, a) / 2, *waves())[0]
    assert right == pytest.approx(true, rel=1e-9)


def test_not_a_band_of_wave_numbers_where_one_of_wavelengths_is_meant():
    """ "2 to 500" read in 1/m is waves of half a metre to two millimetres."""
    spectrum = rb.spectrum("fra-aar-6")
    wrong = quad(lambda w: aar(w, 0.0339e-4), 2 * np.pi * 2, 2 * np.pi * 500)[0] ** 0.5
    assert 1e3 * wrong < 0.03 < 1e3 * spectrum.sigma("vertical")
    with pytest.raises(InputError, match="valid, 3 to 150 m"):
        spectrum.sigma("vertical", (1 / 500, 1 / 2))
    with pytest.raises(InputError, match="valid, 3 to 150 m"):
        spectrum.sigma("vertical", (2, 500))


def test_not_constants_in_radians_at_cycles():
    """Right for long waves, (2 pi)^2 = 39 times too much for short ones."""
    a, two_pi = 0.0339e-4, 2 * np.pi
    wrong = quad(lambda n: aar(n, a) / two_pi, 1 / 25, 1 / 3)[0] ** 0.5
    assert 1e3 * wrong == pytest.approx(1.7066, abs=5e-5)
    spectrum = rb.spectrum("fra-aar-6")
    assert 1e3 * spectrum.sigma("vertical") == pytest.approx(1.4291, abs=1e-4)
    for n, ratio in ((1e-4, 1.0), (1e3, 39.48)):
        true = two_pi * float(spectrum.density("vertical", two_pi * n))
        assert aar(n, a) / two_pi / true == pytest.approx(ratio, rel=1e-3)


def test_not_a_scaled_low_spectrum_by_another_name():
    """A "German high speed" is the low spectrum scaled to 0.4 mm: we say so, and by how much."""
    scaled = rb.spectrum("german-low").scaled(0.4e-3)
    assert scaled.factor == pytest.approx(0.165, abs=5e-4)
    assert "german-low" in repr(scaled) and "0.9843 -> 0.4 mm" in repr(scaled)
    with pytest.raises(InputError, match="no such spectrum"):
        rb.spectrum("german-high-speed")


def test_not_an_angle_called_a_height():
    """Without b^2 the cross-level is off by 0.75 as an angle and by 2 as a height over 1.5 m."""
    spectrum = rb.spectrum("german-low")

    def without_b(w):
        level = 4.032e-7 * 0.8246**2 / ((w**2 + 0.0206**2) * (w**2 + 0.8246**2))
        return level * w**2 / (w**2 + 0.438**2)

    wrong = quad(without_b, *waves(), epsrel=1e-11)[0] ** 0.5
    assert 1e3 * wrong == pytest.approx(0.6840, abs=5e-5)
    assert spectrum.sigma("cross_level") / wrong == pytest.approx(4 / 3, rel=1e-8)
    assert spectrum.sigma("cross_level", height=True) / wrong == pytest.approx(2.0, rel=1e-8)


def test_not_a_variance_on_both_halves_of_the_plane():
    """Coefficients N sqrt(S dW) at positive and negative waves double the variance."""
    spectrum = rb.spectrum("german-low")
    count, step = 4096, 2 * np.pi / 1000.0
    k = np.arange(40, 333)  # waves of 25 to 3 m
    density, phase = spectrum.density("vertical", k * step), np.exp(1j * k**2)
    half = np.zeros(count // 2 + 1, dtype=complex)
    variance = spectrum.sigma("vertical", (1000 / 332.5, 1000 / 39.5)) ** 2
    half[k] = count * np.sqrt(density * step) * phase
    assert np.var(np.fft.irfft(half)) / variance == pytest.approx(2.0, rel=1e-3)
    half[k] = count * np.sqrt(density * step / 2) * phase
    assert np.var(np.fft.irfft(half)) / variance == pytest.approx(1.0, rel=1e-3)


def test_not_a_roughness_ten_times_another():
    """A_v wandered by factors of ten through the years; it is 0.0339 cm2 rad/m in class 6."""
    spectrum = rb.spectrum("fra-aar-6")
    for wandered, times in ((3.365e-5, 9.93), (3.365e-6, 0.993), (2.095e-5, 6.18)):
        wrong = quad(lambda w, a=wandered: aar(w, a), *waves())[0]
        assert wrong / spectrum.sigma("vertical") ** 2 == pytest.approx(times, rel=1e-3)
    ours = {i: rb.spectrum(f"fra-aar-{i}").parts["vertical"].density.constants["A"] for i in (5, 6)}
    assert ours[5] == pytest.approx(2.095e-5) and ours[6] == pytest.approx(3.39e-6)


# ---- scaling


def test_scaling_multiplies_all_components_and_remembers_both_numbers():
    spectrum = rb.spectrum("german-low")
    scaled = spectrum.scaled(1.2e-3, "alignment", D2)
    assert scaled.sigma("alignment", D2) == pytest.approx(1.2e-3, rel=1e-12)
    for name in spectrum.components:
        ratio = scaled.density(name, 0.7) / spectrum.density(name, 0.7)
        assert float(ratio) == pytest.approx(scaled.factor, rel=1e-12)
    assert scaled.scaling.before == pytest.approx(spectrum.sigma("alignment", D2), rel=1e-12)
    assert (scaled.scaling.wanted, scaled.scaling.band) == (1.2e-3, D2)
    assert spectrum.factor == 1.0 and spectrum.scaling is None
    assert "1.197 -> 1.2 mm (25-70 m)" in scaled.describe()


def test_scaling_twice_is_scaling_once_from_what_is_printed():
    spectrum = rb.spectrum("german-high")
    twice, once = spectrum.scaled(0.5e-3).scaled(2e-3), spectrum.scaled(2e-3)
    assert twice.factor == pytest.approx(once.factor, rel=1e-12)
    assert twice.scaling.before == pytest.approx(spectrum.sigma("vertical"), rel=1e-12)


def test_an_angle_is_scaled_in_radians():
    scaled = rb.spectrum("german-low").scaled(1e-3, "cross_level")
    assert scaled.sigma("cross_level") == pytest.approx(1e-3, rel=1e-12)
    assert "0.912 -> 1 mrad" in repr(scaled)


# ---- what it says


def test_constants_with_fewer_than_two_sources_are_remarked():
    (remark,) = rb.spectrum("fra-aar-3").remarks
    assert remark.field == "alignment, cross_level, gauge"
    assert "fra-aar-3: constants remembered by one source, the original not seen" in remark.text
    (remark,) = rb.spectrum("sncf-good").remarks
    assert str(remark) == "vertical of the spectrum sncf-good: constants from one source only"
    assert rb.spectrum("german-low").remarks == ()
    assert str(remark) in rb.spectrum("sncf-good").describe()


def test_a_description_says_band_and_sigma_where_valid():
    text = rb.spectrum("sncf-good").describe()
    assert "2 to 40 m (printed beside the constants" in text
    assert "D1 1.047 mm" in text and "D2" not in text
    assert "D3 0.3953 mrad" in rb.spectrum("german-low").describe()
    assert repr(rb.spectrum("sncf-good")) == "TrackSpectrum('sncf-good', vertical)"


def test_a_frame_has_a_row_a_component():
    frame = rb.spectrum("german-low").to_frame()
    assert list(frame.index) == ["vertical", "alignment", "cross_level", "gauge"]
    assert frame.loc["cross_level", "sigma unit"] == "mrad"
    assert frame.loc["cross_level", "unit"] == "rad2/(rad/m)"
    assert frame.loc["vertical", "sigma D1"] == pytest.approx(0.9843, abs=5e-5)
    assert rb.spectrum("sncf-good").to_frame()["sigma D2"].isna().all()


def test_a_spectrum_goes_to_other_processes():
    spectrum = rb.spectrum("chinese-ballastless").scaled(4e-4)
    again = pickle.loads(pickle.dumps(spectrum))
    assert again.sigma("gauge", D3) == spectrum.sigma("gauge", D3)


# ---- tables


def test_a_table_is_a_power_between_its_points():
    wavenumber = np.array([0.05, 0.4, 2.5])
    spectrum = TrackSpectrum.from_table(wavenumber, {"vertical": 3e-7 / wavenumber**3})
    fine = np.geomspace(0.05, 2.5, 17)
    assert spectrum.density("vertical", fine) == pytest.approx(3e-7 / fine**3, rel=1e-12)
    exact = np.sqrt(1.5e-7 * (1 / waves()[0] ** 2 - 1 / waves()[1] ** 2))
    assert spectrum.sigma("vertical") == pytest.approx(exact, rel=1e-12)
    assert spectrum.band == pytest.approx((2 * np.pi / 2.5, 2 * np.pi / 0.05))
    assert spectrum.sigma("vertical", spectrum.band) > 0 and spectrum.grade("vertical") == "own"
    with pytest.raises(InputError, match="must be inside the band"):
        spectrum.sigma("vertical", D3)


def test_a_table_of_a_shipped_spectrum_is_that_spectrum():
    german = rb.spectrum("german-low")
    wavenumber = 2 * np.pi / np.geomspace(150, 3, 800)
    densities = {name: german.density(name, wavenumber) for name in german.components}
    own = TrackSpectrum.from_table(wavenumber, densities, angle=True)
    for name in german.components:
        assert own.unit(name) == german.unit(name)
        for height in (False, True):
            found = own.sigma(name, D2, height=height)
            assert found == pytest.approx(german.sigma(name, D2, height=height), rel=1e-5)
    heights = TrackSpectrum.from_table(wavenumber, densities)
    assert heights.unit("cross_level") == "m2/(rad/m)"


X = [0.1, 0.2, 0.4]


@pytest.mark.parametrize(
    ("wavenumber", "densities", "message"),
    [
        (X, {"vertical": [1e-6, -1e-6, 1e-6]}, r"vertical\[2\] = -1e-06: .*above 0"),
        (X, {"vertical": [1e-6, 1e-6, np.nan]}, r"vertical\[3\] = nan"),
        (X, {"vertical": [0.0, 1e-6, 1e-6]}, r"vertical\[1\] = 0.0"),
        (X, {"vertical": [1e-6, 1e-6]}, "must hold 3 numbers, it holds 2"),
        (X, {"cant": [1e-6] * 3}, "component = 'cant': must be one of vertical"),
        (X, {}, "must hold at least one of vertical"),
        (X, [1e-6] * 3, "must be a table"),
        ([0.1, 0.4, 0.2], {"vertical": [1e-6] * 3}, r"wavenumber\[3\] = 0.2: must be above the"),
        ([0.0, 0.2, 0.4], {"vertical": [1e-6] * 3}, r"wavenumber\[1\] = 0.0: .*above 0"),
        ([0.1], {"vertical": [1e-6]}, "at least two numbers"),
    ],
)
def test_tables_that_cannot_be_used(wavenumber, densities, message):
    with pytest.raises(InputError, match=message):
        TrackSpectrum.from_table(wavenumber, densities)


# ---- bad input


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (0.0, "wavenumber = 0.0: .*above 0 rad/m"),
        (-1.0, "wavenumber = -1.0"),
        (np.nan, "wavenumber = nan"),
        ([0.1, 0.0], r"wavenumber\[2\] = 0.0"),
        ([[0.1, 0.2], [0.3, np.inf]], r"wavenumber\[4\] = inf"),
        ([[0.1, 0.2], [0.3]], "must be a number or an array"),
        ("0.1", "wavenumber = '0.1'"),
        (None, "wavenumber: must be a finite number"),
    ],
)
def test_wave_numbers_that_are_refused(value, message):
    with pytest.raises(InputError, match=message):
        rb.spectrum("german-low").density("vertical", value)


@pytest.mark.parametrize(
    ("band", "message"),
    [
        ((25, 3), "Turn it round"),
        ((3, 3), "Turn it round"),
        ((0, 25), r"band\[1\] = 0"),
        ((-3, 25), r"band\[1\] = -3"),
        ((3, np.nan), r"band\[2\] = nan"),
        ((2.9, 25), "must be inside the band for which german-low is valid, 3 to 150 m"),
        ((3, 151), "must be inside the band for which german-low is valid, 3 to 150 m"),
        (25, "must be a list of numbers"),
        ((3, 10, 25), "must hold 2 numbers"),
    ],
)
def test_bands_that_are_refused(band, message):
    spectrum = rb.spectrum("german-low")
    with pytest.raises(InputError, match=message):
        spectrum.sigma("vertical", band)
    with pytest.raises(InputError, match=message):
        spectrum.scaled(1e-3, band=band)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda s: s.sigma("alignment", D1), "is not known of sncf-good. It has vertical"),
        (lambda s: s.density("vertcal", 0.1), "Did you mean 'vertical'"),
        (lambda s: s.grade("gauge"), "is not known of sncf-good"),
        (lambda s: s.unit(1), "must be one of vertical"),
        (lambda s: s.sigma("vertical", height=1), "must be true or false"),
        (lambda s: s.scaled(0.0), "sigma = 0.0: .*above 0 m"),
        (lambda s: s.scaled(np.nan), "sigma = nan"),
        (lambda s: s.scaled(-1e-3), "sigma = -0.001"),
    ],
)
def test_questions_that_are_refused(ask, message):
    with pytest.raises(InputError, match=message):
        ask(rb.spectrum("sncf-good"))
