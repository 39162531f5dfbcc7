"""Measured tracks from CSV files: columns and units, and as a kind of a case's track."""

import json

import jsonschema
import numpy as np
import pytest

import railbridge as rb
from railbridge import studies
from railbridge.cases import pages, shelf

HEAD = "# name: mine\nplace (m),vertical (mm)\n"
CASE = {
    "deck": {
        "length": 12.0, "bending_stiffness_vertical": 5e9, "mass": 8000.0,
        "damping": {"modal": 0.02}, "modes": 2,
    },
    "train": {"vehicle": "xia2000_planar"},
    "run": {"speed": 20.0, "lead_in": 50.0, "tail": 0.5},
}  # fmt: skip


def rows(count=800, *columns):
    """Lines of a file with waves in mm, every 0.25 m."""
    x = 0.25 * np.arange(count)
    waves = [np.sin(x / (2 + i)) for i in range(max(len(columns), 1))]
    factors = columns or (1.0,)
    cells = zip(x, *(f * w for f, w in zip(factors, waves, strict=True)), strict=True)
    return "".join(",".join(f"{float(c)!r}" for c in row) + "\n" for row in cells)


def written(tmp_path, text, name="mine.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("unit", "metres"), [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("in", 0.0254), ("ft", 0.3048)]
)
def test_heights_in_any_unit(tmp_path, unit, metres):
    scale = 1e-3 / metres
    path = written(tmp_path, f"place (m),vertical [{unit}]\n" + rows(800, scale))
    record = rb.track_record(path, band="all")
    assert record.rails["vertical_left"] == pytest.approx(1e-3 * np.sin(record.x / 2), abs=1e-15)
    assert record.name == "mine" and record.lateral is None


def test_places_in_km_and_an_origin_in_m(tmp_path):
    lines = "".join(f"{12.0 + 0.00025 * i:.5f},{i % 3}\n" for i in range(400))
    path = written(tmp_path, "place (km),vertical (mm)\n" + lines)
    record = rb.track_record(path, band="all", origin=12050.0)
    assert (record.first, record.step) == pytest.approx((-50.0, 0.25))


@pytest.mark.parametrize(("unit", "metres"), [("mm", 1e-3), ("mrad", 1.5e-3), ("rad", 1.5)])
def test_a_cross_level_is_a_height_or_an_angle_over_1_5_m(tmp_path, unit, metres):
    scale = 1e-3 / metres  # 1 mm in all
    head = f"place (m),vertical (mm),cross_level ({unit})\n"
    record = rb.track_record(written(tmp_path, head + rows(800, 1.0, scale)), band="all")
    v, c = 1e-3 * np.sin(record.x / 2), 1e-3 * np.sin(record.x / 3)
    # The left rail higher is positive.
    assert record.rails["vertical_left"] == pytest.approx(v + c / 2, abs=1e-15)
    assert record.rails["vertical_right"] == pytest.approx(v - c / 2, abs=1e-15)


def test_semicolons_decimal_commas_and_blank_cells(tmp_path):
    lines = "".join(f"{0.25 * i:.2f};{0.1 * (i % 2):.1f}\n".replace(".", ",") for i in range(40))
    text = (
        ("place (m);gauge (mm)\n" + lines)
        .replace("5,00;0,0", "5,00;")
        .replace("6,00;0,0", "6,00;NaN")
    )
    path = written(tmp_path, text)  # fmt: skip
    with pytest.raises(rb.InputError, match="mine.csv: gauge at 4.75 m: has a gap of 0.5 m"):
        rb.track_record(path, band="all")
    record = rb.track_record(path, band="all", repair="gap")
    assert record.rails["lateral_left"][[20, 21, 24]] == pytest.approx([5e-5] * 3)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("place (m)\n0\n1\n", "mine.csv: columns: there are none besides place"),
        ("place,vertical (mm)\n0,0\n", r"column place \(unit\): has no unit.*place \(m\)"),
        ("place (m),vertical\n0,0\n", r"column vertical \(unit\): has no unit.*vertical \(mm\)"),
        ("place (m),vertical (mrad)\n0,0\n", r"column vertical \(unit\) = 'mrad': must be one of"),
        ("place (m),vertical (mm)\n0,0\n,1\n", "mine.csv: line 3: place: is missing"),
        ("place (m),vertical (mm)\n0,0\n1,x\n", "mine.csv: line 3: vertical = 'x': must be"),
        ("place (m),vertical (mm)\n0,0\n1,inf\n", "mine.csv: line 3: vertical = 'inf': must be"),
        ("place (m),vertical (mm)\n0,0\n1,0\n2,0\n", "mine.csv: rows = 3: must be at least four"),
        ("place (m),hight (mm)\n0,0\n", "mine.csv: column hight: unknown column"),
        (HEAD + rows(400) + "99.75,3\n", "mine.csv: place 99.75 m: is given twice"),
        (HEAD + rows(400) + "99.8,30\n", "mine.csv: vertical at 99.75 m: jumps by"),
    ],
)  # fmt: skip
def test_what_a_file_may_not_say(tmp_path, text, words):
    with pytest.raises(rb.InputError, match=words):
        rb.track_record(written(tmp_path, text))


def test_options_are_refused_in_the_caller_s_words(tmp_path):
    path = written(tmp_path, HEAD + rows())
    for options, words in [
        ({"band": (0.3, 9.0)}, r"^band = "), ({"origin": 900.0}, r"^origin = 900.0"),
        ({"repair": "all"}, r"^repair = 'all'"), ({"band": (3.0, "a")}, r"^band\[2\] = 'a'"),
    ]:  # fmt: skip
        with pytest.raises(rb.InputError, match=words):
            rb.track_record(path, **options)
    with pytest.raises(rb.InputError, match="no such track. Did you mean 'example_record'"):
        rb.track_record("exampel_record")


def test_the_shipped_record_is_labelled_and_of_the_class_it_says():
    text = shelf.data_file("tracks", "example_record", ".csv").read_text(encoding="utf-8")
    assert "synthetic, not measured" in text
    # The standard deviations of the German low spectrum within 3 to 25 m; one record of 600 m
    # is off by a tenth or two.
    record = rb.track_record("example_record", band=(3.0, 25.0))
    expected = {"vertical": 0.984e-3, "cross_level": 1.368e-3, "alignment": 0.714e-3,
                "gauge": 0.249e-3}  # fmt: skip
    found = {loss.column: np.sqrt(loss.after) for loss in record.losses}
    for name, sigma in expected.items():
        assert found[name] == pytest.approx(sigma, rel=0.25), name


# ---- in cases


def made(**track):
    return rb.Case(CASE | {"track": track})


def test_a_case_takes_the_direction_and_the_rail_that_it_names(tmp_path):
    head = "place (m),vertical_left (mm),vertical_right (mm),alignment (mm)\n"
    path = str(written(tmp_path, head + rows(800, 1.0, 2.0, 3.0)))
    own = {"kind": "file", "file": path, "band": "all", "origin": 60.0}
    record = rb.track_record(path, band="all", origin=60.0)
    x = np.linspace(-50.0, 30.0, 333)
    dip = {"kind": "dip", "depth": 1e-3, "length": 2.0}

    def rail(case, direction, side):
        return case.track.rail(direction, side).value(x)

    left, right = record.vertical.left.value(x), record.vertical.right.value(x)
    both = made(vertical=own, lateral=own)
    assert np.array_equal(rail(both, "vertical", "left"), left)
    assert np.array_equal(rail(both, "vertical", "right"), right)
    assert np.array_equal(rail(both, "lateral", "right"), record.lateral.value(x))
    lateral = both.track
    assert lateral.rail("lateral", "left") is lateral.rail("lateral", "right")
    summed = made(vertical=[own, dip])
    assert rail(summed, "vertical", "left") == pytest.approx(left + rb.Dip(1e-3, 2.0).value(x))
    assert rail(summed, "vertical", "right") == pytest.approx(right + rb.Dip(1e-3, 2.0).value(x))
    one = made(vertical={"right": own})
    assert not rail(one, "vertical", "left").any()
    assert np.array_equal(rail(one, "vertical", "right"), right)


def test_a_case_says_what_was_done(tmp_path):
    text = (HEAD + rows()).replace("\n10.25,", "\n10.25,NaN#").splitlines()
    lines = [line.partition("#")[0] for line in text[2:]]
    path = written(tmp_path, HEAD + "\n".join(lines))
    own = {"kind": "file", "file": str(path), "origin": 60.0}
    with pytest.raises(rb.InputError, match="^mine.csv: vertical at 10 m: has a gap of 0.5 m"):
        made(vertical=own)
    case = made(vertical=own | {"repair": ["gap"], "band": [3, 50]})
    (told,) = [text for text in case.summary()["remarks"] if "Measured" in text]
    assert "gap: 0.5 m at 10 m of vertical filled" in told and "within 3 to 50 m" in told


def test_paths_are_relative_to_the_case_and_a_changed_file_is_another_track(tmp_path):
    (tmp_path / "own").mkdir()
    written(tmp_path / "own", HEAD + rows())
    file = written(
        tmp_path / "own",
        'track.vertical = [{ kind = "file", file = "mine.csv", origin = 60.0 }]\n'
        'track.lateral.left = { kind = "none" }\n',
        "case.toml",
    )
    changes = {name: CASE[name] for name in ("deck", "train", "run")}
    first = rb.case(file, changes)
    again: dict = {}
    exec(first.code(), again)
    assert studies.fingerprint(again["case"].track) == studies.fingerprint(first.track)
    assert (
        rb.case(file, changes).track.rail("vertical", "left").parts[0]
        is (first.track.rail("vertical", "left").parts[0])
    )  # read once
    written(tmp_path / "own", HEAD + rows(801))
    assert studies.fingerprint(rb.case(file, changes).track) != studies.fingerprint(first.track)


@pytest.mark.parametrize(
    ("track", "words"),
    [
        ({"vertical": {"kind": "file"}}, "track.vertical.file: is missing"),
        ({"vertical": {"kind": "file", "file": "no.csv"}}, "track.vertical.file = 'no.csv': no s"),
        (
            {"lateral": [{"kind": "file", "file": "mine.csv", "origin": 60.0}]},
            r"track.lateral\[1\].file = 'mine.csv': holds no columns of this direction",
        ),
        (
            {"vertical": {"kind": "file", "file": "mine.csv"}},
            "track.vertical: is known from x = 0 m to 199.75 m, and wheels need it from -50 m",
        ),
        (
            {"vertical": {"right": {"kind": "file", "file": "mine.csv", "origin": 190.0}}},
            "track.vertical.right: is known from x = -190 m to 9.75 m",
        ),
        (
            {"vertical": {"kind": "file", "file": "mine.csv", "origin": 60, "band": [0.5, 9]}},
            "track.vertical.band = .*less than 4 samples",
        ),
        (
            {"vertical": {"kind": "file", "file": "mine.csv", "repair": ["gaps"]}},
            "track.vertical.repair = 'gaps': must be one of",
        ),
        ({"vertical": {"kind": "joint", "angle": 10, "length": 1}}, "track.vertical.angle = 10"),
        ({"vertical": {"kind": "weld", "depth": 1e-3, "length": 0.01}}, "vertical.short_length"),
    ],
)  # fmt: skip
def test_a_case_refuses_by_its_keys(tmp_path, monkeypatch, track, words):
    written(tmp_path, HEAD + rows())
    monkeypatch.chdir(tmp_path)
    with pytest.raises(rb.InputError, match=words):
        made(**track)


def test_the_schema_knows_the_kinds():
    schema = json.loads(json.dumps(pages.schema()))
    valid = jsonschema.Draft202012Validator(schema)
    for good in [
        {"kind": "file", "file": "a.csv", "band": [3, 70], "repair": ["gap"], "origin": 5.0},
        {"kind": "file", "file": "a.csv", "band": "all", "largest_step": 0.01},
        {"kind": "dip", "depth": 1e-3, "length": 1.0, "at": 5.0, "spacing": 12.0, "count": 3},
        {"kind": "joint", "angle": 0.01, "length": 2.0},
        {"kind": "weld", "depth": 5e-4, "short_depth": 1e-4},
    ]:
        valid.validate(CASE | {"track": {"vertical": good}})
        for bad in [good | {"no_such_key": 1}, good | {"kind": "hole"}]:
            assert not valid.is_valid(CASE | {"track": {"vertical": bad}})
    for bad in [
        {"kind": "file"}, {"kind": "file", "file": "a.csv", "band": [3]},
        {"kind": "file", "file": "a.csv", "repair": ["gaps"]}, {"kind": "dip", "depth": 1e-3},
        {"kind": "joint", "angle": -1.0, "length": 2.0},
    ]:  # fmt: skip
        assert not valid.is_valid(CASE | {"track": {"lateral": bad}})


def test_faults_of_a_case():
    at = {"at": 5.0, "spacing": 20.0, "count": 2}
    x = np.linspace(-10.0, 40.0, 777)
    for kind, shape, keys in [
        ("dip", rb.Dip, {"depth": 3e-3, "length": 1.0}),
        ("joint", rb.Joint, {"angle": 0.01, "length": 2.0}),
        ("weld", rb.Weld, {"depth": 3e-4, "short_depth": 1e-4}),
    ]:
        case = made(vertical={"kind": kind} | keys | at)
        assert case.track.vertical == shape(**keys, **at)
        assert case.track.vertical.value(x).min() < -1e-4
    assert np.isfinite(case.summary()["wheel_force_z"]["min"]["value"])
