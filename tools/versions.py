"""Run the tests in an environment of their own: the oldest packages allowed, or another Python.

    python tools/versions.py oldest [pytest arguments]    the minima of pyproject.toml, Python 3.11
    python tools/versions.py 3.13 [pytest arguments]      the locked packages under that Python

The second takes a path of an interpreter, too. What is direct is as old as pyproject.toml allows;
what only comes along with it is new, as pip would take it. The environments stand in build/ and
are used again as long as what they were made from is unchanged.
"""

import hashlib
import os
import re
import shutil
import subprocess
import sys

from bootstrap import EXTRAS, OLDEST_PYTHON, ROOT, pip_settings, uv_environment

OLDEST = "oldest"
LOCK = "requirements.lock"


def environment_of(which, root=ROOT):
    """Where the environment of "oldest", of a Python version or of an interpreter stands."""
    return root / "build" / ("env-" + re.sub(r"[^\w.]+", "-", which).strip("-"))


def installing(which, more=(), root=ROOT):
    """uv's commands, each a list, that fill a new environment.

    `which` is "oldest", a Python, or any other name with `more` packages beside the locked ones.
    """
    folder = environment_of(which, root)
    python = sys.executable if more else OLDEST_PYTHON if which == OLDEST else which
    how = ["--resolution", "lowest-direct"] if which == OLDEST else ["-c", str(root / LOCK)]
    package = f"{root}[{','.join(EXTRAS)}]"
    return [
        ["venv", "--quiet", "--python", python, str(folder)],
        ["pip", "install", "--quiet", "--python", str(folder), *how, "-e", package, *more],
    ]


def inputs(which, root=ROOT):
    """A digest of what the environment is made from."""
    files = [root / "pyproject.toml", *([] if which == OLDEST else [root / LOCK])]
    return hashlib.sha256(b"\0".join(file.read_bytes() for file in files)).hexdigest()


def make(which, more=(), root=ROOT):
    """The environment's Python; made anew if its inputs have changed."""
    folder = environment_of(which, root)
    stamp, wanted = folder / "railbridge-stamp", inputs(which, root)
    if not stamp.exists() or stamp.read_text(encoding="utf-8") != wanted:
        shutil.rmtree(folder, ignore_errors=True)
        settings = uv_environment(pip_settings(sys.executable))
        for command in installing(which, more, root):
            if subprocess.run([sys.executable, "-m", "uv", *command], env=settings).returncode:
                sys.exit(f"The environment could not be made: uv {' '.join(command)}")
        stamp.write_text(wanted, encoding="utf-8")
    return folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def main(arguments):
    if not arguments or arguments[0].startswith("-"):
        sys.exit(__doc__)
    which, *asked = arguments
    python = make(which)
    # A package somewhere else on the path would be tested in place of the installed one.
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    clean |= {"OMP_NUM_THREADS": "1", "RAILBRIDGE_EXTRAS": "required"}
    parallel = ["-n", "2", "--dist", "loadscope", "-p", "no:cacheprovider"]
    command = [python, "-m", "pytest", *parallel, *asked]
    sys.exit(subprocess.run(command, cwd=ROOT, env=clean).returncode)


if __name__ == "__main__":
    main(sys.argv[1:])
