"""The installed Chromium, and what its pages do: every request, every console line."""

import os
import re
import shutil
from contextlib import contextmanager
from dataclasses import dataclass, field
from urllib.parse import urlsplit

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
HOME = ("127.0.0.1", "localhost")
INSIDE = ("data", "blob", "about")  # schemes that reach no server
# Names other than this machine's cannot be resolved: what a page asks for elsewhere fails, and it
# is recorded that it asked.
FLAGS = (
    "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
)  # fmt: skip


class NoBrowser(Exception):
    """Why no browser can be started on this machine."""


def installed():
    """Path of the browser; RAILBRIDGE_CHROMIUM names one that is not on the PATH."""
    path = os.environ.get("RAILBRIDGE_CHROMIUM") or next(
        filter(None, map(shutil.which, NAMES)), None
    )
    if path is None:
        raise NoBrowser(
            f"no browser is installed: none of {', '.join(NAMES)} is on the PATH (Debian: "
            "apt-get install chromium)"
        )
    return path


@contextmanager
def running():
    """A headless browser that reaches this machine only."""
    try:
        from playwright.sync_api import Error, sync_playwright
    except ImportError as error:
        raise NoBrowser(f"playwright cannot be used: {error} (pip install -e .[test])") from None
    path = installed()
    # Chromium refuses its sandbox to root, and containers often refuse it to everybody; pages here
    # are our own.
    boxed = getattr(os, "geteuid", lambda: 1)() != 0 and not os.environ.get("CI")
    flags = [*FLAGS] if boxed else [*FLAGS, "--no-sandbox"]
    with sync_playwright() as playwright:
        try:
            browser = playwright.chromium.launch(executable_path=path, args=flags)
        except Error as error:
            raise NoBrowser(f"{path} does not start: {str(error).splitlines()[0]}") from None
        try:
            yield browser
        finally:
            browser.close()


# What a kernel says of a callback that raises or warns reaches no cell; it is in the messages that
# the page receives.
COMPLAINT = re.compile(
    rb'"name":\s*"stderr",\s*"text":\s*"((?:[^"\\]|\\.)*)"|"ename":\s*"((?:[^"\\]|\\.)*)"'
)
# JupyterLab greets the widgets of a kernel that has not loaded ipywidgets yet.
HARMLESS = "No such comm"


@dataclass
class Record:
    """What a page asked for, what it wrote, and what kernels complained of."""

    requests: list = field(default_factory=list)
    kernel: list = field(default_factory=list)
    console: list = field(default_factory=list)
    uncaught: list = field(default_factory=list)

    def follow(self, context):
        context.on("request", lambda request: self.requests.append(request.url))
        context.on(
            "console", lambda message: self.console.append(f"{message.type}: {message.text}")
        )
        context.on("weberror", lambda error: self.uncaught.append(str(error.error)))
        context.on("page", lambda page: page.on("websocket", self._listen))

    def _listen(self, socket):
        self.requests.append(socket.url)
        socket.on("framereceived", self._read)

    def _read(self, frame):
        frame = frame if isinstance(frame, bytes) else frame.encode()
        texts = [
            (said or raised).decode(errors="replace") for said, raised in COMPLAINT.findall(frame)
        ]
        self.kernel += [text for text in texts if not text.startswith(HARMLESS)]

    @property
    def left(self):
        """Requests to anywhere but this machine."""
        return [url for url in self.requests if leaves(url)]


def leaves(url):
    """True if this address is not on this machine."""
    parts = urlsplit(url)
    return parts.scheme not in INSIDE and parts.hostname not in HOME
