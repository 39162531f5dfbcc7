"""Servers for the browser tests: started in a folder of their own, stopped by process id.

Nothing of the user's is read or written: settings, workspaces, kernels' files and the notebooks
themselves are in a temporary folder. Each server finds a free port by itself.
"""

import json
import os
import re
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.error import URLError
from urllib.request import Request, urlopen

import nbformat

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = ROOT / "notebooks"
STARTS_WITHIN = 60.0  # s; a busy machine of two cores needs 10
STOPS_WITHIN = 15.0  # s
ANSWERS_WITHIN = 30.0  # s
# JupyterLab asks on its first start whether it may fetch news: a question that would stand in front
# of the notebook.
NO_NEWS = {"fetchNews": "false", "checkForUpdates": False}


def notebooks_with_panels(folder=NOTEBOOKS):
    """Names of the notebooks in which a cell makes a panel."""
    paths = sorted(folder.glob("[0-9][0-9]_*.ipynb"))
    return [
        path.stem for path in paths if any("rb.panels." in cell.source for cell in code_cells(path))
    ]


def notebooks_with_animations(folder=NOTEBOOKS):
    """Names of the notebooks in which a cell shows something that moves."""
    paths = sorted(folder.glob("[0-9][0-9]_*.ipynb"))
    return [
        path.stem
        for path in paths
        if any("rb.plots.animate_" in cell.source for cell in code_cells(path))
    ]


def code_cells(path):
    return [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]


def copy_without_outputs(folder, target):
    """Copy the notebooks; what they show in the browser was then computed there."""
    target.mkdir(parents=True)
    for path in sorted(folder.glob("[0-9][0-9]_*.ipynb")):
        notebook = nbformat.read(path, as_version=4)
        for cell in notebook.cells:
            if cell.cell_type == "code":
                cell.update(outputs=[], execution_count=None)
        nbformat.write(notebook, target / path.name)


def environment(home):
    """Variables under which a Jupyter server keeps everything it writes below one folder."""
    settings = home / "settings" / "@jupyterlab" / "apputils-extension"
    settings.mkdir(parents=True, exist_ok=True)
    (settings / "notification.jupyterlab-settings").write_text(
        json.dumps(NO_NEWS), encoding="utf-8"
    )
    own = {
        "JUPYTER_CONFIG_DIR": home / "config",
        "JUPYTER_DATA_DIR": home / "data",
        "JUPYTER_RUNTIME_DIR": home / "runtime",
        "JUPYTERLAB_SETTINGS_DIR": home / "settings",
        "JUPYTERLAB_WORKSPACES_DIR": home / "workspaces",
        "IPYTHONDIR": home / "ipython",
    }
    return {
        **os.environ,
        **{name: str(folder) for name, folder in own.items()},
        "OMP_NUM_THREADS": "1",
    }


@dataclass(frozen=True)
class Server:
    """A running server: its address without a slash at the end, its token and its log file."""

    url: str
    token: str
    log: Path

    def ask(self, path, content=None, method=None):
        """Send a request, with content a POST; return the decoded JSON, or None where there is
        none."""
        data = None if content is None else json.dumps(content).encode()
        request = Request(
            f"{self.url}/{path}", data, {"Authorization": f"token {self.token}"}, method=method
        )
        with urlopen(request, timeout=ANSWERS_WITHIN) as reply:
            body = reply.read()
        return json.loads(body) if body else None

    def said(self):
        """What the server and its kernels have written so far."""
        return self.log.read_text(encoding="utf-8", errors="replace")


@contextmanager
def running(command, home, cwd):
    """Start a program with its log in the folder `home`; stop it, and nothing else, at the end."""
    home.mkdir(exist_ok=True)
    log = home / "server.log"
    with log.open("w", encoding="utf-8") as stream:
        process = subprocess.Popen(
            command,
            cwd=cwd,
            env=environment(home),
            stdout=stream,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
        )
    try:
        yield process, log
    finally:
        process.terminate()
        try:
            process.wait(STOPS_WITHIN)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def wait_until(ready, process, log):
    """Return what `ready()` gives as soon as it gives something; raise if the program ends or takes
    too long."""
    end = time.monotonic() + STARTS_WITHIN
    while time.monotonic() < end:
        if process.poll() is not None:
            raise RuntimeError(
                "the server ended with "
                f"{process.returncode}:\n{log.read_text(encoding='utf-8')[-2000:]}"
            )
        found = ready()
        if found:
            return found
        time.sleep(0.1)
    raise TimeoutError(
        f"the server did not answer within {STARTS_WITHIN:g} "
        f"s:\n{log.read_text(encoding='utf-8')[-2000:]}"
    )


def answers(url, token=""):
    """True if something at this address answers with a page."""
    try:
        with urlopen(
            Request(url, headers={"Authorization": f"token {token}"}), timeout=5.0
        ) as reply:
            return reply.status == 200
    except (URLError, ConnectionError, TimeoutError):
        return False


@contextmanager
def jupyterlab(home, token):
    """JupyterLab on the copied notebooks of `home`, listening on this machine only."""
    command = [
        sys.executable, "-m", "jupyterlab", "--no-browser", "--ServerApp.ip=127.0.0.1",
        "--ServerApp.port=0",
        f"--IdentityProvider.token={token}", f"--ServerApp.root_dir={home}",
        "--ServerApp.allow_root=True",
        # Lets a test ask the page about its cells and its kernel.
        "--LabApp.expose_app_in_browser=True",
    ]  # fmt: skip
    with running(command, home, home) as (process, log):
        note = home / "runtime" / f"jpserver-{process.pid}.json"
        wait_until(note.exists, process, log)
        port = wait_until(lambda: port_in(note), process, log)
        url = f"http://127.0.0.1:{port}"
        wait_until(lambda: answers(f"{url}/api/status", token), process, log)
        yield Server(url, token, log)


def port_in(note):
    """Port that a Jupyter server has written down, or None while it is still writing."""
    try:
        return json.loads(note.read_text(encoding="utf-8"))["port"]
    except ValueError:
        return None


@contextmanager
def app(home):
    """The explorer of notebook 00 as a web page, as `make app` shows it."""
    command = [sys.executable, ROOT / "tools" / "app.py", "--no-browser"]
    with running(command, home, home) as (process, log):
        found = wait_until(
            lambda: re.search(r"http://[\d.:]+", log.read_text(encoding="utf-8")), process, log
        )
        yield Server(found.group(), "", log)
