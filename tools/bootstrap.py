"""Create or update the project's environment in `.venv`, and do nothing when it is already right.

    python3 tools/bootstrap.py            create or update `.venv`
    python3 tools/bootstrap.py --lock     write requirements.lock from pyproject.toml
    python3 tools/bootstrap.py --lock --upgrade     the same with newer versions

Any Python >= 3.11 with its standard library runs this file. It installs the versions of
requirements.lock with uv, which is several times faster than pip and byte-compiles in parallel, and
falls back to pip where uv cannot be had or cannot reach the package index. The stamp
`.venv/railbridge-stamp.json` is written last, so an interrupted run is noticed and repaired. It
also lists what was installed: a package that was removed or exchanged since is put back.
"""

import ast
import contextlib
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
OLDEST_PYTHON = "3.11"
EXTRAS = ("fem", "study", "fast", "report", "app", "site", "test", "dev")

# Those who keep their installers new have done nothing wrong.
NOT_OURS = re.compile(r"__pycache__|(pip|setuptools|wheel)-.*")

# pip's settings -> uv's environment variables: uv does not read pip's configuration, where people
# name their mirrors.
UV_NAME = {
    "index-url": "UV_DEFAULT_INDEX",
    "extra-index-url": "UV_INDEX",
    "find-links": "UV_FIND_LINKS",
    "no-index": "UV_NO_INDEX",
    "trusted-host": "UV_INSECURE_HOST",
    "cert": "SSL_CERT_FILE",
    "proxy": "ALL_PROXY",
    "timeout": "UV_HTTP_TIMEOUT",
    "default-timeout": "UV_HTTP_TIMEOUT",
}


class Environment:
    """The environment of one working copy: where it is, whether it is right, how it is made so."""

    def __init__(self, root=ROOT):
        self.root = Path(root)
        self.path = self.root / ".venv"
        self.python = self.path / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
        self.lock = self.root / "requirements.lock"
        self.stamp = self.path / "railbridge-stamp.json"
        self.unfinished = self.path / "railbridge-unfinished"

    def wanted(self):
        """What a right environment's stamp says: the inputs it was made from and the place it was
        made for."""
        digest = hashlib.sha256()
        for file in (self.lock, self.root / "pyproject.toml", Path(__file__)):
            digest.update(file.read_bytes() + b"\0")
        return {"inputs": digest.hexdigest(), "root": str(self.root)}

    def stamped(self):
        """What the stamp says, {} without one."""
        try:
            return json.loads(self.stamp.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return {}

    def installed(self):
        """Names of all that stands where packages are installed, a folder or a file each; the
        folders of metadata bear the versions."""
        found = [*self.path.glob("lib/python*/site-packages"), self.path / "Lib" / "site-packages"]
        return {entry for folder in found if folder.is_dir() for entry in os.listdir(folder)}

    def missing(self):
        """What was installed and is not there any more."""
        gone = set(self.stamped().get("installed", ())) - self.installed()
        return {entry for entry in gone if not NOT_OURS.fullmatch(entry)}

    def is_right(self):
        stamp = self.stamped()
        same = all(stamp.get(name) == value for name, value in self.wanted().items())
        return same and "installed" in stamp and self.python.exists() and not self.missing()

    def must_start_over(self):
        """True if what stands there is half-made, moved from another folder, or has lost its
        Python."""
        if not self.path.exists():
            return True
        moved = self.stamped().get("root", str(self.root)) != str(self.root)
        return self.unfinished.exists() or moved or not self.python.exists()

    def make(self):
        """Create or update the environment; the stamp goes first and comes back last."""
        wanted = self.wanted()
        fresh = self.must_start_over()
        # What an installer left of a package would make it believe that all of it is there.
        anew = not fresh and bool(self.missing())
        if fresh:
            require_venv()
            if self.path.is_symlink():
                self.path.unlink()
            elif self.path.exists():
                shutil.rmtree(self.path)
            self.path.mkdir()
        self.unfinished.touch()
        self.stamp.unlink(missing_ok=True)
        if fresh:
            say("creating .venv ...")
            run([sys.executable, "-m", "venv", str(self.path)])
        elif subprocess.run([self.python, "-c", "import pip"], capture_output=True).returncode:
            run([self.python, "-m", "ensurepip"])
        if anew:
            say("packages are missing; installing all of them anew ...")
        else:
            say("installing the locked packages ...")
        if not (self.has_uv(anew) and self.install_with_uv(anew)):
            say("uv is not to be had; installing with pip, which takes longer ...")
            self.install_with_pip(anew)
        stamp = {**wanted, "installed": sorted(self.installed())}
        self.stamp.write_text(json.dumps(stamp), encoding="utf-8")
        self.unfinished.unlink()

    def has_uv(self, anew=False):
        """Put the locked uv into the environment; False where that fails."""
        locked = [line for line in self.locked_lines() if re.match(r"uv\s*==", line)]
        wheel_only = ["--only-binary=:all:", "--no-deps", "--no-compile", "--quiet"]
        command = [
            self.python,
            "-m",
            "pip",
            "--disable-pip-version-check",
            "install",
            *wheel_only,
            *["--force-reinstall"] * anew,
            *(locked or ["uv"]),
        ]
        return subprocess.run(command, capture_output=True).returncode == 0

    def locked_lines(self):
        return self.lock.read_text(encoding="utf-8").splitlines() if self.lock.exists() else []

    def install_with_uv(self, anew=False):
        uv = [
            self.python,
            "-m",
            "uv",
            "pip",
            "install",
            "--quiet",
            "--python",
            str(self.python),
            "--no-deps",
        ]
        environment = uv_environment(pip_settings(self.python))
        return all(
            subprocess.run([*uv, *what], cwd=self.root, env=environment).returncode == 0
            for what in (
                ["--compile-bytecode", *["--reinstall"] * anew, "-r", str(self.lock)],
                # After the lock: the build backend is now in the environment, so nothing is fetched
                # to build with.
                ["--no-build-isolation", "-e", "."],
            )
        )

    def install_with_pip(self, anew=False):
        pip = [
            self.python,
            "-m",
            "pip",
            "--disable-pip-version-check",
            "install",
            "--quiet",
            "--no-deps",
        ]
        run([*pip, *["--force-reinstall"] * anew, "-r", str(self.lock)], cwd=self.root)
        run([*pip, "--no-build-isolation", "-e", "."], cwd=self.root)

    def write_lock(self, *options):
        """Resolve pyproject.toml for every platform and write `name==version` lines."""
        if not self.python.exists():
            require_venv()
            run([sys.executable, "-m", "venv", str(self.path)])
        if not self.has_uv():
            sys.exit("The lock is made with uv, and uv could not be installed; see pip's settings.")
        command = [
            self.python,
            "-m",
            "uv",
            "pip",
            "compile",
            "pyproject.toml",
            "--universal",
            "--quiet",
        ]
        command += ["--python-version", OLDEST_PYTHON, "--no-annotate", "--no-header"]
        command += [option for extra in EXTRAS for option in ("--extra", extra)]
        run(
            [*command, "-o", str(self.lock), *options],
            cwd=self.root,
            env=uv_environment(pip_settings(self.python)),
        )


def pip_settings(python):
    """pip's settings as {name: [values]}; what stands in the environment wins over [install], that
    over [global]."""
    listing = subprocess.run(
        [python, "-m", "pip", "config", "list"], capture_output=True, text=True
    ).stdout
    ranked = {}
    for line in listing.splitlines():
        found = re.fullmatch(r"(global|install|:env:)\.([\w-]+)=(.*)", line.strip())
        if found:
            section, name, value = found.groups()
            with contextlib.suppress(ValueError, SyntaxError):
                ranked[("global", "install", ":env:").index(section), name] = str(
                    ast.literal_eval(value)
                ).split()
    return {name: values for (_, name), values in sorted(ranked.items())}


def uv_environment(settings):
    """The process environment plus uv's own names for pip's settings; names that are already set
    are left alone."""
    derived = {"UV_PYTHON_DOWNLOADS": "never", "UV_INDEX_STRATEGY": "unsafe-best-match"}
    for name, values in settings.items():
        if name in UV_NAME and values:
            derived[UV_NAME[name]] = ("," if name == "find-links" else " ").join(values)
    if derived.get("UV_NO_INDEX", "").lower() in ("0", "no", "off", "false"):
        del derived["UV_NO_INDEX"]
    return {**derived, **os.environ}


def require_python(version=sys.version_info):
    """One line and exit code 1 if this Python is too old."""
    if (version[0], version[1]) < tuple(map(int, OLDEST_PYTHON.split("."))):
        sys.exit(
            f"railbridge needs Python {OLDEST_PYTHON} or newer; this is Python "
            f"{version[0]}.{version[1]}."
        )


def require_venv():
    """One line and exit code 1 if this Python cannot make an environment."""
    for module in ("venv", "ensurepip"):
        try:
            __import__(module)
        except ImportError:
            name = f"python{sys.version_info[0]}.{sys.version_info[1]}-venv"
            sys.exit(
                f"This Python has no '{module}' module: install the package {name} (on Debian "
                "and Ubuntu: "
                f"apt install {name}), or run with another Python."
            )


@contextlib.contextmanager
def one_at_a_time():
    """Two runs in one folder: the second waits for the first."""
    try:
        import fcntl
    except ImportError:  # Windows
        yield
        return
    with open(__file__, "rb") as handle:
        with contextlib.suppress(OSError):  # a file system without locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield


def run(command, **options):
    code = subprocess.run(command, **options).returncode
    if code:
        words = " ".join(map(str, command))
        sys.exit(f"The environment is not complete: this command failed with code {code}: {words}")


def say(text):
    print(text, flush=True)


def main(arguments):
    require_python()
    environment = Environment()
    if arguments[:1] == ["--lock"]:
        environment.write_lock(*arguments[1:])
        return
    if arguments:
        sys.exit(__doc__)
    if environment.is_right():
        return
    with one_at_a_time():
        if not environment.is_right():
            start = time.monotonic()
            environment.make()
            say(f"environment ready in {time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit("interrupted; the next run starts over")
