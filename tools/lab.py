"""Open JupyterLab on notebooks of one's own: copies, never the files of the suite.

    python tools/lab.py                    copies in my-notebooks, made or renewed first
    python tools/lab.py --folder course    copies in another folder
    python tools/lab.py --tracked          the suite's own notebooks, to change them
    python tools/lab.py --no-browser       what is not ours goes on to JupyterLab

Any Python >= 3.11 runs this file: where the suite is not installed, it makes the environment
`.venv` (tools/bootstrap.py) and goes on in that. Copies that were edited or run are left alone.
"""

import argparse
import os
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import bootstrap

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "my-notebooks"
FIRST = "00_start_here.ipynb"
# The folder labconfig says how JupyterLab starts: it does not ask about news on the first page, nor
# look for updates elsewhere. What a user sets in JupyterLab counts more.
SETTINGS = Path(__file__).resolve().parent


def copies(folder):
    """Copy the notebooks into a folder, or renew them; return the command's lines on single files.

    The command's own process: what it loads need not stay beside the server.
    """
    command = [sys.executable, "-m", "railbridge", "copy-notebooks", str(folder)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(done.returncode)
    return [line for line in done.stdout.splitlines() if line.startswith(("updated ", "kept  "))]


def open_jupyterlab(options):
    """In this very process: who stops it stops the server."""
    from jupyterlab.labapp import main as jupyterlab

    others = os.environ.get("JUPYTER_CONFIG_PATH")
    os.environ["JUPYTER_CONFIG_PATH"] = os.pathsep.join(filter(None, [others, str(SETTINGS)]))
    jupyterlab(options)


def in_another_python(python, arguments):
    """Run this file with another Python; return its exit code.

    Ctrl+C reaches both, and the other one asks before it ends: this one waits for it.
    """
    signal.signal(signal.SIGINT, lambda *_: None)
    other = subprocess.Popen([str(python), __file__, *arguments])
    signal.signal(signal.SIGTERM, lambda *_: other.terminate())
    return other.wait()


def main(arguments):
    if not (find_spec("jupyterlab") and find_spec("railbridge")):
        environment = bootstrap.Environment()
        bootstrap.main([])
        if Path(sys.prefix).resolve() == environment.path:
            sys.exit(
                "The environment was not complete. Start again; if that does not help, delete it "
                "first: python tools/clean.py"
            )
        sys.exit(in_another_python(environment.python, arguments))
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0], allow_abbrev=False)
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--folder", type=Path, default=FOLDER, help="default: my-notebooks")
    where.add_argument("--tracked", action="store_true", help="the suite's own, to change them")
    given, others = parser.parse_known_args(arguments)
    root, page = (ROOT, f"notebooks/{FIRST}") if given.tracked else (given.folder.absolute(), FIRST)
    if not given.tracked:
        lines = copies(root)
        print("\n".join([f"Your notebooks are in {root}", *lines]))
        if any(line.startswith("kept") for line in lines):
            print("Kept are those you changed or ran. For a new copy, delete it and start again.")
    print("They open in your browser. To end: press Ctrl+C twice in this window.", flush=True)
    open_jupyterlab(
        [f"--ServerApp.root_dir={root}", f"--LabApp.default_url=/lab/tree/{page}", *others]
    )


if __name__ == "__main__":
    main(sys.argv[1:])
