"""The bootstrap's decisions, without installing anything: what is right, what is mended, what is
started over."""

import importlib.util
import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tools" / "bootstrap.py"


@pytest.fixture(scope="module")
def bootstrap():
    spec = importlib.util.spec_from_file_location("bootstrap", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def environment(bootstrap, tmp_path):
    """A finished environment with a pretended Python."""
    environment = bootstrap.Environment(tmp_path)
    environment.lock.write_text("uv==1.0\nnumpy==2.0\n")
    (tmp_path / "pyproject.toml").write_text("[project]\n")
    environment.python.parent.mkdir(parents=True)
    environment.python.touch()
    site = environment.path / "lib" / "python3.11" / "site-packages"
    for name in ("numpy", "numpy-2.0.dist-info", "pip-24.0.dist-info", "__pycache__"):
        (site / name).mkdir(parents=True)
    stamp = environment.wanted() | {"installed": sorted(environment.installed())}
    environment.stamp.write_text(json.dumps(stamp))
    return environment


def test_a_stamped_environment_is_left_alone(environment):
    assert environment.is_right()
    assert not environment.must_start_over()


@pytest.mark.parametrize("name", ["requirements.lock", "pyproject.toml"])
def test_a_changed_input_is_installed_on_top(environment, name):
    (environment.root / name).write_text("something else\n")
    assert not environment.is_right()
    assert not environment.must_start_over()


def test_someone_elses_environment_is_kept(environment):
    environment.stamp.unlink()
    assert not environment.is_right()
    assert not environment.must_start_over()


def test_an_unreadable_stamp_is_no_stamp(environment):
    environment.stamp.write_text("{")
    assert environment.stamped() == {}
    assert not environment.is_right()


def test_an_interrupted_install_is_started_over(environment):
    environment.unfinished.touch()
    environment.stamp.unlink()
    assert environment.must_start_over()


def test_a_lost_python_is_started_over(environment):
    environment.python.unlink()
    assert not environment.is_right()
    assert environment.must_start_over()


def test_a_moved_folder_is_started_over(environment, bootstrap, tmp_path):
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    for name in (".venv", "requirements.lock", "pyproject.toml"):
        (tmp_path / name).rename(moved / name)
    moved = bootstrap.Environment(moved)
    assert not moved.is_right()
    assert moved.must_start_over()


def fake_install(environment, bootstrap, monkeypatch, works):
    """Let `make` run without installing; return the log of its steps."""
    steps = []

    def run(command, **_):
        steps.append(command[-2])
        environment.python.parent.mkdir(parents=True, exist_ok=True)
        environment.python.touch()

    def install(anew):
        steps.append("install anew" if anew else "install")
        assert environment.unfinished.exists()
        assert not environment.stamp.exists(), "the stamp must be the last thing written"
        if not works:
            raise KeyboardInterrupt

    monkeypatch.setattr(bootstrap, "run", run)
    monkeypatch.setattr(
        bootstrap.subprocess, "run", lambda *a, **k: subprocess.CompletedProcess(a, 0)
    )
    monkeypatch.setattr(environment, "has_uv", lambda anew: False)
    monkeypatch.setattr(environment, "install_with_pip", install)
    return steps


def test_an_interruption_is_noticed_and_repaired(environment, bootstrap, monkeypatch):
    environment.lock.write_text("uv==2.0\n")
    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        fake_install(environment, bootstrap, patch, works=False)
        environment.make()
    assert not environment.is_right()
    half_made = environment.path / "half-made-package"
    half_made.touch()
    steps = fake_install(environment, bootstrap, monkeypatch, works=True)
    environment.make()
    assert environment.is_right()
    assert steps == ["venv", "install"]
    assert not half_made.exists()


@pytest.mark.parametrize("gone", ["numpy", "numpy-2.0.dist-info"])
def test_a_package_that_was_deleted_is_put_back(environment, bootstrap, monkeypatch, gone):
    """Its metadata alone would make an installer believe that it is there: all is made anew."""
    (environment.path / "lib" / "python3.11" / "site-packages" / gone).rmdir()
    assert environment.missing() == {gone}
    assert not environment.is_right()
    assert not environment.must_start_over()
    steps = fake_install(environment, bootstrap, monkeypatch, works=True)
    environment.make()
    assert steps == ["install anew"]
    assert environment.is_right()


def test_packages_of_ones_own_and_a_newer_pip_are_left_alone(environment):
    site = environment.path / "lib" / "python3.11" / "site-packages"
    (site / "mine").mkdir()
    (site / "pip-24.0.dist-info").rename(site / "pip-26.0.dist-info")
    (site / "__pycache__").rmdir()
    assert environment.is_right()


def test_an_environment_of_before_that_lists_nothing_is_brought_up_to_date(environment):
    environment.stamp.write_text(json.dumps(environment.wanted()))
    assert not environment.is_right()
    assert not environment.must_start_over()


def test_installers_are_told_to_install_anew(environment, bootstrap, monkeypatch):
    commands = []

    def run(command, **_):
        commands.append(list(map(str, command)))
        return subprocess.CompletedProcess(command, 0, stdout="", stderr="")

    monkeypatch.setattr(bootstrap.subprocess, "run", run)
    for anew in (False, True):
        commands.clear()
        assert environment.has_uv(anew) and environment.install_with_uv(anew)
        environment.install_with_pip(anew)
        flags = [bool({"--reinstall", "--force-reinstall"} & set(c)) for c in commands]
        locked = ["uv==1.0" in c or str(environment.lock) in c for c in commands]
        assert flags == [anew and own for own in locked] and sum(locked) == 3


@pytest.mark.parametrize("missing", ["venv", "ensurepip"])
def test_a_missing_module_is_named_in_one_line(tmp_path, missing):
    (tmp_path / missing).mkdir()
    (tmp_path / missing / "__init__.py").write_text("raise ImportError('not packaged')\n")
    for name in ("requirements.lock", "pyproject.toml"):
        (tmp_path / name).touch()
    tools = tmp_path / "tools"
    tools.mkdir()
    (tools / "bootstrap.py").write_text(SCRIPT.read_text(encoding="utf-8"), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, tools / "bootstrap.py"],
        env={"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert f"'{missing}'" in done.stderr and "-venv" in done.stderr
    assert not (tmp_path / ".venv").exists()


def test_an_old_python_is_told_so_in_one_line(bootstrap):
    with pytest.raises(
        SystemExit, match=r"^railbridge needs Python 3\.11 or newer; this is Python 3\.9\.$"
    ):
        bootstrap.require_python((3, 9, 2))
    bootstrap.require_python((3, 11, 0))


def test_pip_settings_become_uv_settings(bootstrap, monkeypatch):
    listing = r"""
        :env:.find-links='/wheels'
        global.cert='/certificates.pem'
        global.extra-index-url='\nmirror-a\nmirror-b'
        global.find-links='/other'
        global.timeout='15'
        install.timeout='60'
        freeze.timeout='1'
        """
    monkeypatch.setattr(
        bootstrap.subprocess,
        "run",
        lambda *a, **k: subprocess.CompletedProcess(a, 0, stdout=listing, stderr=""),
    )
    monkeypatch.setattr(bootstrap.os, "environ", {"SSL_CERT_FILE": "/mine.pem", "PATH": "/bin"})
    environment = bootstrap.uv_environment(bootstrap.pip_settings("python"))
    assert environment["UV_FIND_LINKS"] == "/wheels"
    assert environment["UV_INDEX"] == "mirror-a mirror-b"
    assert environment["UV_HTTP_TIMEOUT"] == "60"
    assert environment["SSL_CERT_FILE"] == "/mine.pem", "what the user set for uv wins"
    assert environment["PATH"] == "/bin"
    assert "UV_DEFAULT_INDEX" not in environment


def test_a_right_environment_costs_nothing(bootstrap):
    """Every make target calls the bootstrap first."""
    if not bootstrap.Environment().is_right():
        pytest.skip("these tests run in an environment that the bootstrap did not make")
    start = time.perf_counter()
    done = subprocess.run([sys.executable, SCRIPT], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "")
    assert time.perf_counter() - start < 2.0
