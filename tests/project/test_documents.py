"""What the documents say about commands and files is true."""

import re
import tomllib
from pathlib import Path

import matplotlib.pyplot as plt
import nbformat
import pytest
import yaml

import railbridge as rb
from railbridge.cases import pages
from railbridge.cases.sweeping import planned
from railbridge.commands import command as cli
from railbridge.units import UNITS, factor_of

ROOT = Path(__file__).resolve().parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
TARGETS = dict(re.findall(r"^([a-z-]+):[^#\n]*## .*\n((?:\t.*\n)*)", MAKEFILE, re.MULTILINE))
DOCUMENTS = (
    "README.md", "CONTRIBUTING.md", "docs/map.md", "docs/case.md", "docs/hub.md", "docs/studies.md",
    "docs/spectra.md", "docs/codes.md", "docs/report.md", "docs/units.md",
)  # fmt: skip


def rows_of_commands(name):
    """[(make target, plain command)] from a document's tables."""
    text = (ROOT / name).read_text(encoding="utf-8")
    return re.findall(r"^\| `make ([a-z-]+)` \| `([^`]+)`", text, re.MULTILINE)


def test_readme_gives_a_plain_command_for_every_target():
    assert {target for target, _ in rows_of_commands("README.md")} == set(TARGETS) - {"help", "env"}


@pytest.mark.parametrize("name", DOCUMENTS)
def test_plain_commands_are_those_of_the_makefile(name):
    for target, command in rows_of_commands(name):
        recipe = (
            TARGETS[target]
            .replace("$(BIN)/", "")
            .replace("$(PYTHON)", "python")
            .replace(" $(ARGS)", "")
        )
        assert command in recipe, target


def links(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    return [
        target for target in re.findall(r"\]\(([^)#]+)\)", text) if not re.match(r"\w+:", target)
    ]


@pytest.mark.parametrize("name", DOCUMENTS)
def test_files_that_a_document_links_to_exist(name):
    folder = (ROOT / name).parent
    assert [target for target in links(name) if not (folder / target).exists()] == []


def test_readme_lists_every_notebook_with_its_title():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for path in sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb")):
        title = nbformat.read(path, as_version=4).cells[0].source.splitlines()[0].lstrip("# ")
        assert f"| [{path.stem}](notebooks/{path.name}) | {title} |" in text


def test_citation_can_be_read():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["authors"] == [{"name": "The railbridge contributors"}]
    assert citation["references"][0]["year"] == 2016
    version = re.search(
        r'^version = "(.*)"', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert str(citation["version"]) == version.group(1)


def map_rows():
    """[(question, call, figure, notebook, file)] of docs/map.md."""
    lines = (ROOT / "docs" / "map.md").read_text(encoding="utf-8").splitlines()
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in lines
        if line.startswith("|")
    ]
    return [tuple(row) for row in rows[2:]]


def last_of(call):
    """The name at the end of a call as the map writes it."""
    return call.strip("`").rpartition(".")[2]


SEARCHED = {
    "spectrum", "spectrum_names", "track_record", "export_track", "random_response", "assess",
    "assess_run", "Requirements", "report", "report_of_run", "with_wheelsets", "Rail",
}  # fmt: skip
"""Calls that a reader looks for, with a figure or without."""


def test_the_map_leaves_out_nothing_that_is_searched():
    assert SEARCHED - {last_of(call) for _, call, *_ in map_rows()} == set()


@pytest.mark.parametrize("row", map_rows(), ids=lambda row: row[1].strip("`"))
def test_the_map_names_what_there_is(row):
    question, call, figure, notebook, file = row
    assert question[0].isupper() or question.startswith("...")
    thing = rb
    for name in call.strip("`").split(".")[1:]:
        thing = getattr(thing, name)
    path = ROOT / "docs" / re.search(r"\((.*)\)", notebook).group(1)
    if figure == "-":
        assert path.suffix == ".md" and last_of(call) in path.read_text(encoding="utf-8")
    else:
        page = nbformat.read(path, as_version=4)
        assert any(f"**Figure {figure}.**" in cell.source for cell in page.cells), figure
    module = ROOT / "helpers" / "railbridge" / file.strip("`")
    last = last_of(call)
    declared = last == "Case" or re.search(
        rf"^\s*(def|class) {last}\b", module.read_text(encoding="utf-8"), re.M
    )
    assert declared, f"{last} is not in {file}"


def test_tables_of_the_case_page_are_those_of_the_types():
    text = (ROOT / "docs" / "case.md").read_text(encoding="utf-8")
    assert pages.with_tables(text) == text, "run `make pages`"
    assert len(re.findall("<!-- table: ", text)) >= 10


SPECTRA = (ROOT / "docs" / "spectra.md").read_text(encoding="utf-8")


def test_the_table_of_spectra_is_that_of_the_data():
    assert pages.with_tables(SPECTRA) == SPECTRA, "run `make pages`"
    shown = SPECTRA.partition("<!-- table: spectra -->")[2].partition("<!-- end -->")[0]
    assert re.findall(r"^\| `(.+?)` \|", shown, re.MULTILINE) == rb.irregularities.spectrum_names()
    assert "| vertical | m2/(rad/m) | two | 3 to 150 (ours) | 0.9843 mm |" in SPECTRA


def test_the_blocks_of_the_page_on_spectra_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (own,) = re.findall(r"```toml\n(.*?)```", SPECTRA, re.DOTALL)
    Path("my-track.toml").write_text(own, encoding="utf-8")
    scope = {}
    for block in re.findall(r"```python\n(.*?)```", SPECTRA, re.DOTALL):
        exec(block, scope)
    assert scope["mine"].sigma("vertical") > 0
    assert scope["measured"].components == ("vertical",)


def test_the_table_for_a_deck_and_its_trains_runs():
    pytest.importorskip("xarray")
    text = (ROOT / "docs" / "codes.md").read_text(encoding="utf-8")
    scope = {}
    exec(re.search(r"## One table.*?```python\n(.*?)```", text, re.DOTALL)[1], scope)
    found = scope["found"]
    assert found.verdict == "not met" and not bool(found.rules["dynamic_analysis_needed"])
    worst = found.verdicts.to_frame().set_index("what").loc["deck acceleration"]
    assert worst["verdict"] == "not met" and worst["when"].startswith("HSLM-A1 at 48 m/s")


def test_every_unit_is_on_the_case_page():
    text = (ROOT / "docs" / "case.md").read_text(encoding="utf-8")
    listed = text.partition("<!-- table: units -->")[2].partition("<!-- end -->")[0]
    for dimension, family in UNITS.items():
        row = next(x for x in listed.splitlines() if x.startswith(f"| {dimension} |"))
        assert re.findall("`(.+?)`", row) == [unit for unit in family if unit]


UNIT_PAGE = (ROOT / "docs" / "units.md").read_text(encoding="utf-8")


def test_tables_of_the_page_on_units_are_those_of_the_code():
    assert pages.with_tables(UNIT_PAGE) == UNIT_PAGE, "run `make pages`"
    assert len(re.findall("<!-- table: ", UNIT_PAGE)) == 5


def test_the_page_on_units_gives_every_unit_with_its_factor():
    listed = UNIT_PAGE.partition("<!-- table: unit factors -->")[2].partition("<!-- end -->")[0]
    for dimension, family in UNITS.items():
        row = next(x for x in listed.splitlines() if x.startswith(f"| {dimension} |"))
        found = re.findall(r"`([^`]+)` ([\d.e+-]+)", row)
        assert [unit for unit, _ in found] == list(family)[1:]
        for unit, factor in found:
            assert float(factor) == pytest.approx(factor_of("unit", unit, dimension), rel=1e-8)


STUDIES = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", STUDIES, re.DOTALL)


CASE = """
[deck]
file = "viaduct36"
[train]
vehicle = "xia2000"
[track]
vertical = { kind = "random", spectrum = "german-low", band = [20, 100], rails_differ = false }
[run]
speed = 40.0
time_step = 2e-3
[output]
points = [18.0]
"""


def test_the_python_of_the_page_on_studies_runs(tmp_path, monkeypatch):
    pytest.importorskip("xarray")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text(CASE)
    scope = {}
    for block in blocks("python"):
        exec(block, scope)
    assert scope["found"].sizes["wavelength"] == 2
    assert scope["seeds"]["wheel_unloading"].size == 20
    plt.close("all")


def test_the_study_file_of_the_page_on_studies_is_one():
    pytest.importorskip("xarray")
    (text,) = blocks("toml")
    study = tomllib.loads(text)
    plan = planned(study["case"], study["over"], None, study["measure"], study["points"])
    assert [len(d.values) for d in plan.dimensions] == [15, 4]


def test_options_of_the_page_on_studies_exist(capsys):
    for command in ("sweep", "envelope", "ensemble"):
        with pytest.raises(SystemExit):
            cli.main([command, "--help"])
    said = capsys.readouterr().out
    for option in set(re.findall(r"(?<![-\w])--[a-z][a-z-]+", STUDIES)):
        assert option in said, option


REPORTS = (ROOT / "docs" / "report.md").read_text(encoding="utf-8")


def test_the_python_of_the_page_on_reports_runs(tmp_path, monkeypatch):
    for name in ("jinja2", "openpyxl"):
        pytest.importorskip(name)
    monkeypatch.chdir(tmp_path)
    exec(re.search(r"```python\n(.*?)```", REPORTS, re.DOTALL)[1], {})
    assert {path.name for path in tmp_path.iterdir()} == {"bridge.html", "bridge.xlsx"}


def test_commands_of_the_page_on_reports_run(tmp_path, monkeypatch, capsys):
    for name in ("jinja2", "openpyxl", "xarray"):
        pytest.importorskip(name)
    monkeypatch.chdir(tmp_path)
    lines = re.search(r"```\n(railbridge report.*?)```", REPORTS, re.DOTALL)[1].splitlines()
    commands = [line.partition(" # ")[0].split()[1:] for line in lines]
    assert len(commands) == 5
    small = 'case = "paper"\nmeasure = ["displacement_z"]\n[over]\n"train.cars" = [1]\n'
    (tmp_path / "study.toml").write_text(small)
    for command in commands:
        assert cli.main([*command, "-q"]) == 0, capsys.readouterr().err
    made = {path.name for path in tmp_path.iterdir()} - {"study.toml"}
    assert made == {"paper.html", "paper.xlsx", "fast.html", "trains.html", "study.html"}


def test_options_of_the_page_on_reports_exist(capsys):
    with pytest.raises(SystemExit):
        cli.main(["report", "--help"])
    said = capsys.readouterr().out
    for option in set(re.findall(r"(?<![-\w])--[a-z][a-z-]+", REPORTS)):
        assert option in said, option
