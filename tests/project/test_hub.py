"""The page for those who run a hub, and its image: what they say exists and fits together."""

import importlib
import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest

import site_pages
from railbridge.commands import copies as lessons

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "hub.md").read_text(encoding="utf-8")
DOCKERFILE = (ROOT / "docker" / "Dockerfile").read_text(encoding="utf-8")
START = ROOT / "docker" / "start-railbridge"
NUMBERS = sorted(path.name[:2] for path in (ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))


def instructions():
    """[(name, what follows)] of the Dockerfile."""
    lines = [line for line in DOCKERFILE.splitlines() if line and not line.startswith("#")]
    return [tuple(line.split(" ", 1)) for line in lines]


class Settings:
    """Stands for `c` of a Jupyter configuration: keeps what is set."""

    def __getattr__(self, name):
        setattr(self, name, SimpleNamespace())
        return getattr(self, name)


@pytest.fixture(scope="module")
def settings():
    """What the page's lines for jupyterhub_config.py set."""
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    c = Settings()
    exec(compile(code, "jupyterhub_config.py", "exec"), {"c": c})
    return c


def test_every_page_was_measured():
    rows = re.findall(r"^\| (\d\d) \|(.*)\|$", PAGE, re.MULTILINE)
    assert [number for number, _ in rows] == NUMBERS
    for number, rest in rows:
        then, most, run, panel = (cell.strip() for cell in rest.split("|"))
        (path,) = (ROOT / "notebooks").glob(f"{number}_*.ipynb")
        assert int(then) <= int(most) and float(run) > 0
        assert (panel == "-") == ("rb.panels." not in path.read_text(encoding="utf-8"))


def test_limits_leave_room_for_what_was_measured(settings):
    server = int(re.search(r"holds another (\d+) MB", PAGE).group(1))
    most = {n: int(m) for n, m in re.findall(r"^\| (\d\d) \| \d+ \| (\d+) \|", PAGE, re.MULTILINE)}
    assert "1 GB is enough for 00 to 05, 2 GB for every page" in PAGE
    assert max(most[n] for n in NUMBERS if n <= "05") + server < 1000
    assert 1000 < max(most.values()) + server < 2000
    assert (settings.Spawner.mem_guarantee, settings.Spawner.mem_limit) == ("1G", "2G")
    teachers = (ROOT / "docs" / "teaching.md").read_text(encoding="utf-8")
    said = "1 GB of memory per student for 00 to 05, 2 GB from 06 on: a page keeps up to "
    kept = re.search(re.escape(said) + r"([\d.]+) GB", teachers).group(1)
    assert float(kept) == round(max(most.values()) / 1000, 1)


def test_seconds_of_a_class_are_those_of_the_table():
    spent = dict(re.findall(r"^\| (\d\d) \|.*\| ([\d.]+) \| [\d.-]+ \|$", PAGE, re.MULTILINE))
    told = re.search(r"00 is ready after (\d+) s and 06 after (\d+) s", " ".join(PAGE.split()))
    for number, seconds in zip(("00", "06"), told.groups(), strict=True):
        assert abs(30 * float(spent[number]) / 8 - int(seconds)) < 1.0


def test_options_of_the_server_are_known_to_jupyter(settings):
    for option in settings.Spawner.args:
        owner, name, value = re.fullmatch(r"--(\w+)\.(\w+)=(\w+)", option).groups()
        place = {
            "MappingKernelManager": "jupyter_server.services.kernels.kernelmanager",
            "ServerApp": "jupyter_server.serverapp",
        }[owner]
        trait = getattr(importlib.import_module(place), owner).class_traits()[name]
        trait.validate(None, trait.from_string(value))


def test_image_and_settings_speak_of_the_same(settings):
    lines = instructions()
    (folders,) = settings.DockerSpawner.volumes.values()
    assert ("WORKDIR", folders) in lines and ("CMD", '["start-railbridge"]') in lines
    assert settings.Spawner.cmd == ["start-railbridge"]
    assert f"railbridge copy-notebooks {'~'}/my-notebooks --student" in PAGE
    copied = settings.Spawner.default_url.removeprefix("/lab/tree/my-notebooks/")
    assert copied in lessons.contents()
    shared = settings.DockerSpawner.read_only_volumes
    assert set(shared) == set(shared.values()) and f'rb.deck("{next(iter(shared))}/' in PAGE


def test_image_is_built_from_what_there_is():
    lines = instructions()
    assert lines[0][0] == "FROM" and "/" not in lines[0][1], "no host, no account"
    python = re.fullmatch(r"python:(3\.\d+)-slim", lines[0][1]).group(1)
    assert f"python-{python}\n" == (ROOT / "binder" / "runtime.txt").read_text(encoding="utf-8")
    known = {"FROM", "ARG", "WORKDIR", "COPY", "RUN", "ENV", "USER", "CMD"}
    assert {name for name, _ in lines} == known
    for name, rest in lines:
        for part in shlex.split(rest) if name == "RUN" else []:
            if "/" in part and not part.startswith("/"):
                assert (ROOT / part).is_file(), part
    post_build = (ROOT / "binder" / "postBuild").read_text(encoding="utf-8")
    installs = [rest for name, rest in lines if name == "RUN" and "--no-index" in rest]
    assert len(installs) == 1 and installs[0] in post_build, "as on a Binder, which is tested"
    where = dict(lines[i][1].split("=", 1) for i in range(len(lines)) if lines[i][0] == "ENV")
    place = Path(where["JUPYTER_CONFIG_PATH"]).relative_to("/opt/railbridge")
    assert (ROOT / place / "labconfig").is_dir()
    assert ("USER", "student") in lines[lines.index(("COPY", ". .")) :]


def test_image_leaves_out_what_git_does_not_see():
    left_out = (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    assert {".git", ".venv", "build", "my-notebooks"} <= set(left_out)
    for needed in ("docker", "binder", "tools", "data", "notebooks", "docs", "helpers"):
        assert needed not in left_out


@pytest.mark.skipif(os.name == "nt", reason="an image is no Windows")
@pytest.mark.parametrize("writable", [True, False])
def test_server_starts_with_copies_made_or_without(tmp_path, writable):
    """The hub's own program is played by one that says how it was called."""
    tools, home = tmp_path / "bin", tmp_path / "home"
    tools.mkdir(), home.mkdir()
    (tools / "jupyterhub-singleuser").write_text('#!/bin/sh\necho "started: $@"\n')
    (tools / "railbridge").write_text(
        '#!/bin/sh\nmkdir -p "$2" && touch "$2/made"\n' if writable else "#!/bin/sh\nexit 2\n"
    )
    for path in tools.iterdir():
        path.chmod(0o755)
    variables = {"PATH": f"{tools}{os.pathsep}{os.environ['PATH']}", "HOME": str(home)}
    assert os.access(START, os.X_OK)
    done = subprocess.run([START, "--a=b c"], env=variables, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "started: --a=b c\n")
    assert (home / "my-notebooks" / "made").exists() == writable
    assert ("not renewed" in done.stderr) != writable


def test_both_commands_for_marking_are_named_once():
    part = re.search(r"## Collecting and marking\n(.*?)\n## ", PAGE, re.DOTALL).group(1)
    for words in (
        "copy-notebooks DIR --student",
        "copy-notebooks DIR --teacher",
        "railbridge mark DIR",
    ):
        assert part.count(words) == 1


def test_links_of_the_documents_lead_somewhere_on_the_site(tmp_path):
    site_pages.lay_out(tmp_path / "site")
    pages = tmp_path / "site"
    assert "docs/hub" in (pages / "index.md").read_text(encoding="utf-8").splitlines()
    for page in (*pages.glob("*.md"), *pages.glob("docs/*.md")):
        for target in re.findall(r"\]\((?!\w+:)([^()#\s]+)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), (page.name, target)
    shutil.rmtree(pages)
