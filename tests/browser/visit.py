"""A visit to a page: everything that happened on it, and what is kept of it when a test fails."""

import re
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from chromium import Record
from served import ROOT
from waiting import PATIENCE

KEPT = ROOT / "build" / "browser"
WINDOW = {"width": 1280, "height": 900}


@dataclass(frozen=True)
class Visit:
    """A page, the record of what it does, and the server behind it, if any, with the length of its
    log at the beginning."""

    page: Any
    record: Record
    server: Any = None
    log_begins: int = 0

    def complaints(self):
        """Requests that left the machine, and what the page, its kernel and the server complained
        of so far."""
        said = self.server.said()[self.log_begins :].splitlines() if self.server else []
        return [
            *self.record.left,
            *self.record.uncaught,
            *self.record.kernel,
            *(s for s in said if "Traceback" in s),
        ]

    def keep(self, name):
        """Store what can be seen and what was written."""
        KEPT.mkdir(parents=True, exist_ok=True)
        name = re.sub(r"[^\w-]+", "_", name).strip("_")
        self.page.screenshot(path=KEPT / f"{name}.png")
        lines = []
        for what in ("console", "uncaught", "kernel", "requests"):
            lines += [f"{what}:", *getattr(self.record, what), ""]
        if self.server:
            lines += [f"server {self.server.url}:", self.server.said()]
        (KEPT / f"{name}.log").write_text("\n".join(lines) + "\n", encoding="utf-8")


@contextmanager
def visiting(browser, server=None):
    """A fresh page that shares nothing with those before it."""
    record, context = Record(), browser.new_context(viewport=WINDOW)
    context.set_default_timeout(1e3 * PATIENCE)
    record.follow(context)
    try:
        yield Visit(context.new_page(), record, server, len(server.said()) if server else 0)
    finally:
        context.close()
