"""Spectra by name and from files; the shipped files are complete."""

import re
import subprocess
import sys
import tomllib

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases import shelf
from railbridge.errors import InputError
from railbridge.irregularities import COMPONENTS, GRADES, spectrum_names
from railbridge.irregularities.formulas import FORMULAS

NAMES = sorted(
    ["german-low", "german-high", "chinese-ballastless", "sncf-good", "sncf-poor"]
    + [f"fra-{family}-{i}" for family in ("aar", "fryba") for i in range(1, 7)]
)
FILES = {p.stem: p for p in (rb.data_root() / "spectra").glob("*")}
GERMAN = FILES["german-low"].read_text(encoding="utf-8")


def test_the_shipped_names():
    assert spectrum_names() == NAMES == sorted(FILES) == shelf.data_names("spectra")


@pytest.mark.parametrize("name", NAMES)
def test_every_file_says_all_that_must_be_known(name):
    text = FILES[name].read_text(encoding="utf-8")
    content, spectrum = tomllib.loads(text), rb.spectrum(name)
    assert text.startswith("# ") and content["one_sided"] is True
    # A band that no source prints is called our choice.
    printed = name.startswith(("chinese", "sncf"))
    assert content["band_source"].startswith("printed" if printed else "the suite's choice")
    four = not name.startswith(("sncf", "fra-fryba"))
    assert spectrum.components == (COMPONENTS if four else ("vertical",))
    assert (spectrum.name, spectrum.family) == (name, content["family"])
    assert spectrum.band == tuple(content["band"])
    for component in spectrum.components:
        own = content[component]
        assert own["grade"] == spectrum.grade(component) != "own"
        assert own["source"].startswith(own["grade"] + ":")
        is_angle = name.startswith("german") and component == "cross_level"
        assert own["quantity"] == ("angle" if is_angle else "height")
        for key in FORMULAS[content["formula"]][component].constants:
            assert key in {**content.get("constants", {}), **own}


def test_grades_are_those_of_the_sources():
    def grades(name):
        return [rb.spectrum(name).grade(c) for c in rb.spectrum(name).components]

    assert grades("german-high") == grades("chinese-ballastless") == ["two"] * 4
    assert grades("fra-aar-2") == ["two", "memory", "memory", "memory"]
    assert grades("fra-fryba-4") == grades("sncf-poor") == ["one"]


def constants(name):
    parts = rb.spectrum(name).parts
    return {key: part.density.constants for key, part in parts.items()}


def test_constants_of_the_classes():
    classes = [constants(f"fra-aar-{i}") for i in range(1, 7)]
    a_v = [1.2107, 1.0181, 0.6816, 0.5376, 0.2095, 0.0339]
    a_a = [3.3634, 1.2107, 0.4128, 0.3027, 0.0762, 0.0339]
    w_s = [0.6046, 0.9308, 0.8520, 1.1312, 0.8209, 0.4380]
    for i, each in enumerate(classes):
        assert 1e4 * each["alignment"]["A"] == pytest.approx(a_a[i], rel=1e-12)
        for name in ("vertical", "cross_level", "gauge"):
            assert 1e4 * each[name]["A"] == pytest.approx(a_v[i], rel=1e-12)
        assert each["gauge"]["W_s"] == each["cross_level"]["W_s"] == w_s[i]
    fryba = [1e8 * float(constants(f"fra-fryba-{i}")["vertical"]["A"]) for i in range(1, 7)]
    assert fryba == pytest.approx([15.53, 8.85, 4.92, 2.75, 1.57, 0.98], rel=1e-12)


@pytest.mark.parametrize("name", ["fra", "FRA", "fra-5", "fra5", "FRA 5"])
def test_two_families_are_called_fra(name):
    with pytest.raises(InputError, match="names two families.*fra-aar-.* or fra-fryba-"):
        rb.spectrum(name)


def test_the_two_families_differ_by_as_much_as_is_said():
    ratios = [
        rb.spectrum(f"fra-aar-{i}").sigma("vertical")
        / rb.spectrum(f"fra-fryba-{i}").sigma("vertical")
        for i in range(1, 7)
    ]
    with pytest.raises(InputError) as refused:
        rb.spectrum("fra")
    least, most = map(float, re.search(r"by ([\d.]+) to (\d+) times", str(refused.value)).groups())
    assert least == pytest.approx(min(ratios), abs=0.1) and most == pytest.approx(
        max(ratios), abs=0.5
    )


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("german-lo", "no such spectrum. Did you mean 'german-low'"),
        ("fra-aar-7", "no such spectrum. Did you mean 'fra-aar-"),
        ("", "must be a name or a path. Shipped: chinese-ballastless, "),
        (None, "must be a name or a path"),
        (5, "must be a name or a path"),
        ("mine.toml", "mine.toml: no such file"),
        ("nowhere/mine", "mine: no such file"),
    ],
)
def test_names_that_are_refused(source, message):
    with pytest.raises(InputError, match=message):
        rb.spectrum(source)


def spoiled(tmp_path, old, new):
    assert old in GERMAN
    path = tmp_path / "mine.toml"
    path.write_text(GERMAN.replace(old, new, 1), encoding="utf-8")
    return path


def test_a_file_of_your_own(tmp_path):
    path = spoiled(tmp_path, "value = 4.032e-7", "value = 8.064e-7")
    mine, low = rb.spectrum(path), rb.spectrum("german-low")
    assert mine.name == "mine" and rb.spectrum(str(path)).name == "mine"
    assert mine.sigma("vertical") / low.sigma("vertical") == pytest.approx(2**0.5, rel=1e-12)
    path.write_text("\ufeff" + GERMAN, encoding="utf-8")  # Notepad's byte order mark
    assert rb.spectrum(path).sigma("gauge") == low.sigma("gauge")


def test_a_density_of_both_signs_of_the_wave_number_is_doubled(tmp_path):
    path = spoiled(tmp_path, "one_sided = true", "one_sided = false")
    mine, low = rb.spectrum(path), rb.spectrum("german-low")
    for component in COMPONENTS:
        ratio = mine.density(component, 0.3) / low.density(component, 0.3)
        assert float(ratio) == pytest.approx(2.0, rel=1e-14)
        ratio = mine.sigma(component) / low.sigma(component)
        assert ratio == pytest.approx(2**0.5, rel=1e-14)


def test_another_unit_gives_the_same(tmp_path):
    path = spoiled(
        tmp_path, 'value = 4.032e-7, unit = "m2 rad/m"', 'value = 0.4032, unit = "mm2 rad/m"'
    )
    low = rb.spectrum("german-low")
    assert rb.spectrum(path).sigma("vertical") == pytest.approx(low.sigma("vertical"), rel=1e-12)


def test_another_gauge_makes_other_heights_of_angles(tmp_path):
    path = spoiled(tmp_path, "[constants]", "base = 1.06\n[constants]")
    mine = rb.spectrum(path)
    ratio = mine.sigma("cross_level", height=True) / mine.sigma("cross_level")
    assert ratio == pytest.approx(1.06, rel=1e-14)


def test_a_power_law_needs_no_breaks(tmp_path):
    path = tmp_path / "power.toml"
    path.write_text(
        'family = "mine"\nformula = "power_pieces"\nwavenumber = "rad/m"\none_sided = true\n'
        'band = [1.0, 100.0]\nband_source = "measured"\nsource = "measured"\n[cross_level]\n'
        'quantity = "angle"\ngrade = "own"\nsource = "me"\nn = 3.0\n'
        'breaks = { value = [], unit = "rad/m" }\nA = { value = 2.0, unit = "mrad2/(rad/m)" }\n'
    )
    spectrum = rb.spectrum(path)
    assert float(spectrum.density("cross_level", 0.5)) == pytest.approx(16e-6, rel=1e-12)
    low, high = 2 * np.pi / 25, 2 * np.pi / 3
    exact = (1e-6 * (low**-2 - high**-2)) ** 0.5
    assert spectrum.sigma("cross_level") == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('family = "', 'famly = "', "famly: unknown key. Did you mean 'family'"),
        ('formula = "german"', 'formula = "germn"', "formula = 'germn'.*Did you mean 'german'"),
        ('wavenumber = "rad/m"', 'wavenumber = "rad"', "wavenumber = 'rad': must be one of rad/m"),
        ("one_sided = true", "one_sided = 1", "one_sided = 1: must be true or false"),
        ("one_sided = true\n", "", "one_sided: is missing. Add one_sided to the file"),
        ("band = [3.0, 150.0]", "band = [150.0, 3.0]", "band = .*Turn it round"),
        ("band = [3.0, 150.0]", "band = 3.0", "band = 3.0: must be a list"),
        ('band_source = "', 'band_source = "" # "', "band_source = '': must be a text"),
        ('unit = "rad/m" }', 'unit = "1/m" }', r"vertical.W_c.unit = '1/m': must be one of rad/m"),
        ('{ value = 0.8246, unit = "rad/m" }', "0.8246", "W_c = 0.8246: needs its unit. Write W_c"),
        ("value = 0.8246", "value = -0.8", "vertical.W_c = -0.8: .*above 0"),
        ("value = 0.8246, ", "", "vertical.W_c.value: is missing"),
        ("W_r = ", "W_q = ", "vertical.W_r: is missing. Add W_r, here or below constants"),
        ("W_c = ", "W_x = { value = 1.0, unit = 'rad/m' }\nW_c = ", "constants.W_x: unknown key"),
        ('grade = "two"', 'grade = "three"', "vertical.grade = 'three': must be one of two, one"),
        ('grade = "two"\n', "", "vertical.grade: is missing"),
        ('"height"', '"angle"', "vertical.quantity = 'angle': .*gives the height"),
        ('"angle"', '"height"', "cross_level.quantity = 'height': .*gives the angle"),
        ('unit = "m2 rad/m"', 'unit = "m2"', "vertical.A.unit = 'm2': must be one of m2 rad/m"),
        ("[vertical]", "[vertcal]", "vertcal: unknown key. Did you mean 'vertical'"),
        ("[constants]", "base = 0.0\n[constants]", "base = 0.0: .*above 0 m"),
        ("[constants]", "constants = 5\n[more]", "more: unknown key"),
        ("[vertical]", "[[vertical]]", "vertical = .*must be a table"),
        ("family", "= family", "is not a valid TOML file"),
    ],
)
def test_files_that_cannot_be_used(tmp_path, old, new, message):
    with pytest.raises(InputError, match=f"mine.toml: .*({message})") as refused:
        rb.spectrum(spoiled(tmp_path, old, new))
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[0.0187, 0.0474, 0.1533]", "[0.0474, 0.0187, 0.1533]", "vertical.breaks.*ascend"),
        ("[0.0187, 0.0474, 0.1533]", "[0.0474, 0.1533]", "vertical.A.*must hold 3 numbers"),
        ("[3.3891, 1.9271, 1.3643, 3.4516]", "[3.3891, 1.9271]", "vertical.n.*must hold 4"),
        ("1.0544e-5", "-1.0544e-5", "vertical.A.*must be above 0"),
        ('quantity = "height"', 'quantity = "angle"', "vertical.*(angle|mm2)"),
    ],
)
def test_pieces_that_cannot_be_used(tmp_path, old, new, message):
    path, text = tmp_path / "mine.toml", FILES["chinese-ballastless"].read_text(encoding="utf-8")
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=message):
        rb.spectrum(path)


def test_a_file_without_components_folders_and_large_files(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(GERMAN.partition("[constants]")[0], encoding="utf-8")
    with pytest.raises(InputError, match="vertical: is missing. Give at least one component"):
        rb.spectrum(path)
    path.write_text("#" * 1_000_001)
    with pytest.raises(InputError, match="mine.toml: is too large"):
        rb.spectrum(path)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="mine.toml: is not a valid TOML file"):
        rb.spectrum(path)
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(InputError, match="folder.toml: must be a regular file"):
        rb.spectrum(tmp_path / "folder.toml")


def test_data_may_stand_elsewhere(tmp_path, monkeypatch):
    (tmp_path / "spectra").mkdir()
    (tmp_path / "spectra" / "only.toml").write_text(GERMAN, encoding="utf-8")
    monkeypatch.setenv("RAILBRIDGE_DATA", str(tmp_path))
    assert spectrum_names() == ["only"] == shelf.data_names("spectra")
    assert rb.spectrum("only").name == "only"


def test_a_spectrum_loads_neither_pandas_nor_files_of_cases():
    code = (
        "import sys, railbridge as rb; rb.spectrum('german-low').sigma('vertical');"
        "print([m for m in ('pandas', 'matplotlib', 'pydantic', 'railbridge.cases')"
        " if m in sys.modules])"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_every_grade_has_its_words():
    assert set(GRADES) == {"two", "one", "memory", "own"}
