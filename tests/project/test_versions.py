"""Environments beside the project's own: what is installed into them, and when they are used
again."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def versions():
    spec = importlib.util.spec_from_file_location("versions", ROOT / "tools" / "versions.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def root(tmp_path):
    (tmp_path / "pyproject.toml").write_text("[project]\n")
    (tmp_path / "requirements.lock").write_text("numpy==2.0\n")
    return tmp_path


def test_the_oldest_are_those_of_pyproject_and_not_of_the_lock(versions, root):
    venv, install = versions.installing("oldest", root=root)
    assert venv[venv.index("--python") + 1] == "3.11"
    assert install[install.index("--resolution") + 1] == "lowest-direct"
    assert not any("lock" in word for word in install)
    assert install[-1] == f"{root}[fem,study,fast,report,app,site,test,dev]"


def test_another_python_gets_the_locked_packages(versions, root):
    venv, install = versions.installing("3.13", root=root)
    assert venv[venv.index("--python") + 1] == "3.13"
    assert install[install.index("-c") + 1] == str(root / "requirements.lock")
    assert "--resolution" not in install


def test_a_tool_s_packages_come_beside_the_locked_ones(versions, root):
    venv, install = versions.installing("mutants", ["mutmut>=3.8"], root)
    assert venv[venv.index("--python") + 1] == sys.executable
    assert install[install.index("-c") + 1] == str(root / "requirements.lock")
    assert install[-1] == "mutmut>=3.8"


def test_environments_stand_beside_each_other_in_build(versions, root):
    asked = ["oldest", "3.12", "3.13", "/opt/python3.13/bin/python"]
    places = {versions.environment_of(which, root) for which in asked}
    assert len(places) == len(asked)
    assert all(place.parent == root / "build" for place in places)


def test_an_environment_is_made_once_and_again_when_its_inputs_change(versions, root, monkeypatch):
    made = []

    def pretend(command, env):
        made.append(command[3])
        versions.environment_of("oldest", root).mkdir(parents=True, exist_ok=True)
        return subprocess.CompletedProcess(command, 0)

    monkeypatch.setattr(versions.subprocess, "run", pretend)
    monkeypatch.setattr(versions, "pip_settings", lambda python: {})
    for _ in range(2):
        versions.make("oldest", root=root)
    assert made == ["venv", "pip"]
    (root / "requirements.lock").write_text("numpy==2.1\n")
    versions.make("oldest", root=root)
    assert made == ["venv", "pip"], "the lock has no part in the oldest"
    (root / "pyproject.toml").write_text("[project]\nname = 'x'\n")
    versions.make("oldest", root=root)
    assert made == ["venv", "pip"] * 2


def test_a_failed_installation_leaves_no_stamp(versions, root, monkeypatch):
    def fail(command, env):
        versions.environment_of("3.13", root).mkdir(parents=True, exist_ok=True)
        return subprocess.CompletedProcess(command, 1)

    monkeypatch.setattr(versions.subprocess, "run", fail)
    monkeypatch.setattr(versions, "pip_settings", lambda python: {})
    with pytest.raises(SystemExit, match="could not be made: uv venv"):
        versions.make("3.13", root=root)
    assert not [*root.rglob("railbridge-stamp")]
