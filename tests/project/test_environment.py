"""One set of asks: pyproject.toml, environment.yml, requirements.lock and installation agree."""

import importlib
import importlib.metadata
import json
import os
import pkgutil
import re
import subprocess
import sys
import tomllib
import types
import zipfile
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name
from packaging.version import Version

import railbridge as rb
from railbridge.commands import copies as lessons

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CONDA = yaml.safe_load((ROOT / "environment.yml").read_text(encoding="utf-8"))
LOCK = (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines()


def asks_of_pyproject():
    """{package: version range}"""
    extras = PROJECT["optional-dependencies"].values()
    asked = [Requirement(text) for text in sum(extras, start=[*PROJECT["dependencies"]])]
    return {canonicalize_name(ask.name): ask.specifier for ask in asked}


def asks_of_conda():
    """{package: version range}"""
    asks = [text for text in CONDA["dependencies"] if isinstance(text, str)] + CONDA[
        "dependencies"
    ][-1]["pip"]
    asked = [re.fullmatch(r"([\w.-]+)\s*(.*)", text).groups() for text in asks]
    return {canonicalize_name(name): SpecifierSet(versions) for name, versions in asked}


ASKS = asks_of_pyproject()
EXTRA_OF = {
    canonicalize_name(Requirement(text).name): extra
    for extra, asked in PROJECT["optional-dependencies"].items()
    for text in asked
}


def test_conda_and_pip_ask_for_the_same():
    conda = asks_of_conda()
    assert conda.pop("python") == SpecifierSet(PROJECT["requires-python"])
    assert conda.pop("pip") == SpecifierSet()
    assert conda == ASKS
    assert CONDA["channels"] == ["conda-forge"]


def test_every_ask_has_a_lower_bound():
    for name, versions in ASKS.items():
        assert any(version.operator in (">=", "~=", "==") for version in versions), name


@pytest.mark.parametrize("name", ASKS)
def test_lock_is_within_the_asked_range(name):
    locked = [Requirement(line) for line in LOCK]
    versions = [
        next(iter(lock.specifier)).version
        for lock in locked
        if canonicalize_name(lock.name) == name
    ]
    assert versions, f"not locked; run `make lock` after a change of pyproject.toml: {name}"
    assert all(ASKS[name].contains(version) for version in versions)


@pytest.mark.parametrize("name", ASKS)
def test_installed_version_is_within_the_asked_range(name):
    try:
        installed = importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        extra = EXTRA_OF.get(name, "test")
        if extra == "test" or os.environ.get("RAILBRIDGE_EXTRAS") == "required":
            raise
        pytest.skip(f"needs the extra {extra}: pip install -e .[{extra}]")
    assert ASKS[name].contains(Version(installed))


def test_lock_names_versions_and_nothing_else():
    """No addresses, hashes or options: every index serves it."""
    for line in LOCK:
        assert re.fullmatch(r"[a-z0-9.-]+==[0-9a-z.+!]+( ; [\w .<>='()!*]+)?", line), line
    names = [line.split("==")[0] for line in LOCK]
    assert names == sorted(names)


def test_lock_serves_other_platforms():
    text = "\n".join(LOCK)
    for line in ("colorama==", "pywinpty==", "appnope=="):
        assert line in text


def test_the_package_is_installed_in_place():
    import railbridge

    assert Path(railbridge.__file__).resolve().parent == ROOT / "helpers" / "railbridge"
    assert railbridge.__version__ == importlib.metadata.version("railbridge") == PROJECT["version"]


def test_import_is_light():
    """Plots, tables, panels and case files load what they need when they are used."""
    heavy = ("matplotlib", "pandas", "ipywidgets", "pydantic", "jsonschema", "PIL")
    code = f"import sys, railbridge; print([m for m in {heavy} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stdout + done.stderr


def test_no_module_shares_its_name_with_something_public():
    """Else ``import railbridge.x as m`` gives the function in place of the module."""
    modules = {m.name for m in pkgutil.iter_modules(rb.__path__)} - {"__main__"}
    rooms = {"boxes", "exchange", "lessons", "panels", "paper", "plots", "validation"}
    assert modules & set(rb.__all__) <= rooms
    for name in sorted(modules):
        assert isinstance(importlib.import_module(f"railbridge.{name}"), types.ModuleType)
        assert isinstance(getattr(rb, name, types), types.ModuleType), name


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A folder with the unpacked wheel: someone who installs it has no folders `data/` and
    `notebooks/` beside the package."""
    if subprocess.run([sys.executable, "-c", "import hatchling"], capture_output=True).returncode:
        pytest.skip("the build backend is not installed")
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    with zipfile.ZipFile(next(folder.glob("railbridge-*.whl"))) as wheel:
        wheel.extractall(folder / "site")
    return folder / "site"


def with_wheel(site, folder, *arguments):
    """What Python says, with the wheel in place of the checkout."""
    paths = {**os.environ, "PYTHONPATH": str(site)}
    done = subprocess.run(
        [sys.executable, *arguments], cwd=folder, env=paths, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_built_wheel_carries_the_data(site, tmp_path):
    carried = {
        path.relative_to(site / "railbridge")
        for path in (site / "railbridge" / "data").rglob("*.*")
    }
    assert carried == {path.relative_to(ROOT) for path in (ROOT / "data").rglob("*.*")}
    code = (
        "import railbridge as rb; print(rb.__file__); rb.vehicle('xia2000'); rb.deck('viaduct36')"
    )
    assert Path(with_wheel(site, tmp_path, "-c", code).strip()).is_relative_to(site.resolve())


def test_a_built_wheel_hands_out_the_same_notebooks_as_the_checkout(site, tmp_path):
    assert {path.name for path in site.iterdir()} == {
        "railbridge",
        "railbridge_command.py",
        next(site.glob("*.dist-info")).name,
    }
    carried = {path.name for path in (site / "railbridge" / "share" / "notebooks").iterdir()}
    assert carried == {path.name for path in (ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb")}
    said = with_wheel(site, tmp_path, "-m", "railbridge", "copy-notebooks", "mine")
    handed = {
        p.relative_to(tmp_path / "mine").as_posix(): p.read_bytes()
        for p in (tmp_path / "mine").rglob("*")
        if p.is_file()
    }
    record = handed.pop(lessons.MANIFEST)
    assert handed == lessons.contents()
    assert set(json.loads(record)) == set(handed)
    assert f"{len(handed)} copied" in said


def test_a_built_wheel_writes_reports(site, tmp_path):
    """The page and its style sheet are files of the package."""
    own = ROOT / "helpers" / "railbridge" / "reports"
    for file in (own / "page.html", own / "report.css"):
        carried = site / "railbridge" / "reports" / file.name
        assert carried.read_bytes() == file.read_bytes()
    pytest.importorskip("jinja2")
    code = "from railbridge.reports import Report; print(Report('t', 'a', ()).html()[:15])"
    assert with_wheel(site, tmp_path, "-c", code).strip() == "<!DOCTYPE html>"
