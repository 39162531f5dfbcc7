"""A finished report: the page, the workbook, and where they are written."""

from __future__ import annotations

import base64
import datetime
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from ..errors import InputError, printable
from .extras import needed
from .parts import Section, Table
from .places import GENERATOR, refuse_foreign, written
from .workbooks import workbook_bytes

__all__ = ["Report"]


@dataclass(frozen=True)
class Report:
    """A calculation as a page for a checker.

    Two reports of the same input are the same but for the date.

    Attributes
    ----------
    title : str
    about : str
        A sentence below the title.
    sections : tuple of Section
    verdict : str
        ``met``, ``not met``, ``cannot decide``; empty where no limits were asked for.
    """

    title: str
    about: str
    sections: tuple[Section, ...]
    verdict: str = ""

    @property
    def tables(self) -> list[Table]:
        """All tables of the workbook; those of the page alone are the same in other words."""
        tables = [p for s in self.sections for p in s.parts if isinstance(p, Table)]
        return [table for table in tables if table.in_workbook]

    def html(self, date: datetime.date | None = None) -> str:
        """Return the page.

        Parameters
        ----------
        date : datetime.date, optional
            When it was made; today if not given.

        Returns
        -------
        str
            One file: no scripts, nothing that is fetched from elsewhere.

        Raises
        ------
        InputError
            Without the extra ``report``.
        """
        needed("jinja2")
        from jinja2 import Environment, StrictUndefined
        from markupsafe import Markup

        room = files(__package__)
        environment = Environment(
            autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
        )
        environment.filters["printable"] = printable
        environment.filters["base64"] = _base64
        page = environment.from_string((room / "page.html").read_text(encoding="utf-8"))
        return page.render(
            report=self,
            generator=GENERATOR,
            date=_date(date).isoformat(),
            css=Markup((room / "report.css").read_text(encoding="utf-8")),
        )

    def write(
        self, path: str | Path, *, force: bool = False, date: datetime.date | None = None
    ) -> Path:
        """Write the page; a report that is there already is replaced.

        Parameters
        ----------
        path : str or Path
            Ends in ``.html``.
        force : bool
            Whether a file that is no report of ours is replaced, too.
        date : datetime.date, optional
            When it was made; today if not given.

        Returns
        -------
        Path

        Raises
        ------
        InputError
            Another ending, a file of somebody else, or a place that cannot be written to.
        """
        place = refuse_foreign("path", path, ".html", force)
        return written("path", place, self.html(date).encode())

    def write_workbook(self, path: str | Path, *, force: bool = False) -> Path:
        """Write all tables as a workbook, a sheet each, units in the heads.

        Parameters
        ----------
        path : str or Path
            Ends in ``.xlsx``.
        force : bool
            As for `write`.

        Returns
        -------
        Path

        Raises
        ------
        InputError
            As `write`; without the extra ``report``.
        """
        place = refuse_foreign("path", path, ".xlsx", force)
        return written("path", place, workbook_bytes(self.title, self.tables))


def _date(given: datetime.date | None) -> datetime.date:
    if given is None:
        return datetime.date.today()
    if not isinstance(given, datetime.date):
        raise InputError("date", given, "must be a datetime.date")
    return given


def _base64(text: str) -> str:
    return base64.b64encode(text.encode()).decode()
