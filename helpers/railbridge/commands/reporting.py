"""The command ``railbridge report``: a calculation as a page that can be handed to a checker."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import errors, studies
from ..cases import shelf, staging
from ..cases.definition import Case
from ..cases.sweeping import Plan
from ..cautions import unsettled
from ..crossing import NotConvergedError
from ..errors import InputError
from . import changing, studying
from .speech import say, tell

if TYPE_CHECKING:
    import xarray as xr

    from ..checks import Assessment
    from ..reports import Report

__all__ = ["add_command"]

NOT_SETTLED = 3
"""Exit code where the numbers of the report are no solution."""
_EXAMPLES = """\
examples:
  railbridge report case.toml --out bridge.html
      one crossing: inputs, modes, extremes, histories, verdicts, assumptions, receipt
  railbridge report case.toml --speeds 100:300km/h --out bridge.html
      the case's own train over speeds; with --trains others instead
  railbridge report deck.toml --trains HSLM-A,ICE2 --speeds 150:300km/h --out bridge.html
      trains over a deck, as railbridge envelope has them
  railbridge report study.toml --out study.html --excel study.xlsx
      a case over its keys, as railbridge sweep has it; all numbers as a workbook

The page is one file without scripts, to be read or printed. Made again from the same input it is
the same but for the date. A report that is there is replaced, another file only with --force.
"""


def add_command(add: Callable[..., argparse.ArgumentParser], case: argparse.ArgumentParser) -> None:
    """Add the command to a parser; `case` is the parent of all that take one."""
    parser = add(
        "report", _report, "write a calculation as a page for a checker: one HTML file",
        parents=[case], formatter_class=argparse.RawDescriptionHelpFormatter, epilog=_EXAMPLES,
    )  # fmt: skip
    parser.add_argument(
        "--out", metavar="FILE", required=True, help="the page, a file that ends in .html"
    )
    parser.add_argument(
        "--excel", metavar="FILE", help="the numbers, too: a workbook that ends in .xlsx"
    )
    parser.add_argument(
        "--force", action="store_true", help="replace files that are no reports of railbridge"
    )
    parser.add_argument("--title", help="of the page; default from the name of the deck")
    studying.add_envelope_options(parser, required=False)
    parser.add_argument(
        "--workers", type=int, default=1, metavar="N",
        help="processes for many crossings (default %(default)s)",
    )  # fmt: skip
    parser.add_argument(
        "--results", metavar="DIR",
        help="folder of railbridge sweep or envelope: crossings that it holds are not computed "
        "again, others are added",
    )  # fmt: skip
    parser.add_argument(
        "-q", "--quiet", action="store_true", help="no progress, no line at the end; errors only"
    )


def _report(given: argparse.Namespace) -> int:
    # Loads matplotlib, which no other command waits for.
    from .. import reports

    reports.needed("jinja2", *["openpyxl"] * (given.excel is not None))
    # Before anything is computed, and once more when it is written.
    reports.refuse_foreign("--out", given.out, ".html", given.force)
    if given.excel is not None:
        reports.refuse_foreign("--excel", given.excel, ".xlsx", given.force)
    if given.title is not None:
        errors.text("--title", given.title)
    errors.integer("--workers", given.workers, least=1, most=256)
    if _is_study(given.case):
        _refuse(given, "a study says these itself", "trains", "speeds", "points", "set")
        return _of_study(given)
    if changing.is_deck(given.case):
        _refuse(given, f"changes keys of a case, and {given.case} is a deck", "set")
        for name in ("trains", "speeds"):
            if getattr(given, name) is None:
                allowed = f"is missing, and {given.case} is a deck"
                remedy = "For instance --trains HSLM-A --speeds 150:300km/h"
                raise InputError(f"--{name}", None, allowed, remedy)
        given.deck = given.case
        return _over_speeds(given, None)
    loaded = changing.changed_case(given)
    if given.speeds is not None:
        given.deck = given.case
        return _over_speeds(given, loaded)
    _refuse(given, "is for trains over speeds", "trains", "points", "results")
    return _of_run(given, loaded)


def _is_study(name: str) -> bool:
    """Whether a name is the path of a file with the keys of a study's."""
    if not shelf.is_path(name) or Path(name).suffix != ".toml":
        return False
    keys = shelf.read_toml(shelf.data_file("cases", name, ".toml")).keys()
    return "deck" not in keys and bool(keys & {"case", "over"})


def _refuse(given: argparse.Namespace, why: str, *names: str) -> None:
    """Refuse options that have no meaning here."""
    for name in names:
        value = getattr(given, name)
        if value:
            shown = value[0] if isinstance(value, list) else value
            remedy = "Leave it out" if name == "set" else "Give --speeds, too, or leave it out"
            raise InputError(f"--{name}", shown, why, remedy)


# ---- one crossing


def _of_run(given: argparse.Namespace, loaded: Case) -> int:
    from .. import reports

    begun = changing.begun(given, loaded)
    if begun is None:
        return 2
    progress, code = begun.progress, 0
    try:
        run = loaded.compute(progress)
    except NotConvergedError as error:
        run, code = error.run, NOT_SETTLED
        say(str(error))
    if unsettled(run):
        code = NOT_SETTLED
    made = reports.report_of_run(loaded, run, title=given.title, progress=progress)
    begun.end(loaded.remarks(run))
    _write(given, made)
    return code


# ---- many


def _over_speeds(given: argparse.Namespace, loaded: Case | None) -> int:
    from .. import reports

    if loaded is not None and changing.doubted(given, loaded):
        return 2
    plan, asking = studying.envelope_plan(given, loaded)
    if loaded is None and not _sure(given, plan, asking):
        return 2
    found, judged = _judged(given, plan, asking)
    made = reports.report_of_envelope(
        plan.like, plan.trains, found, tables=plan.tables, assessment=judged, doubts=plan.doubts,
        title=given.title,
    )  # fmt: skip
    _write(given, made)
    return studying.FAILED if any(found.message.values.ravel().tolist()) else 0


def _judged(
    given: argparse.Namespace, plan: Plan, asking: studying.Asking
) -> tuple[xr.Dataset, Assessment | None]:
    """Return what is asked of the crossings and their verdicts, from one pass where it can be.

    A folder of results holds what is asked alone: beside it the verdicts take a second one.
    """
    from .. import reports

    how = {"workers": given.workers}
    if plan.like.requirements is None or given.results is not None or plan.asked.more:
        found = _computed(given, plan, asking)
        with studying.crossings_told(given.quiet) as how["progress"]:
            return found, reports.judged_over_speeds(
                plan.like, plan.trains, found.speed.values, **how
            )
    _ready(given, plan, asking)
    speeds = asking.between or plan.speeds
    with studying.crossings_told(given.quiet) as how["progress"]:
        judged = reports.judged_over_speeds(plan.like, plan.trains, speeds, more=plan.asked, **how)
    return judged.more, judged


def _of_study(given: argparse.Namespace) -> int:
    from .. import reports

    plan, content = studying.study_plan(given.case)
    asking = studying.Asking("sweep", Path(given.case).stem)
    if not _sure(given, plan, asking):
        return 2
    found = _computed(given, plan, asking)
    made = reports.report_of_study(
        plan.like, found, trains=plan.trains, study=content, doubts=plan.doubts, title=given.title
    )
    _write(given, made)
    return studying.FAILED if any(found.message.values.ravel().tolist()) else 0


def _sure(given: argparse.Namespace, plan: Plan, asking: studying.Asking) -> bool:
    """Say what is doubted; whether to go on."""
    if plan.doubts and given.strict:
        for doubt in plan.doubts:
            say(str(doubt))
        return False
    studying.say_remarks(plan, asking)
    return True


def _ready(given: argparse.Namespace, plan: Plan, asking: studying.Asking) -> None:
    """Refuse what cannot be computed."""
    studies.needed("xarray", *["zarr"] * (given.results is not None), "tqdm")
    studying.refuse_large(plan, asking)


def _computed(given: argparse.Namespace, plan: Plan, asking: studying.Asking) -> xr.Dataset:
    _ready(given, plan, asking)
    folder: Any = nullcontext()
    if given.results is not None:
        folder = staging.growing(given.results, "--results")
    with folder as place, studying.crossings_told(given.quiet) as progress:
        store = studies.MemoryStore() if place is None else plan.store(place)
        options = {"workers": given.workers, "progress": progress}
        if asking.between:
            return plan.chosen(store, asking.between, **options)
        return plan.carried_out(store, **options)


# ---- what is written


def _write(given: argparse.Namespace, made: Report) -> None:
    with errors.within(names={"path": "--out"}):
        made.write(given.out, force=given.force)
    written = given.out
    if given.excel is not None:
        with errors.within(names={"path": "--excel"}):
            made.write_workbook(given.excel, force=given.force)
        written += f" and {given.excel}"
    if not given.quiet:
        verdict = f"verdict: {made.verdict}; " if made.verdict else ""
        tell(f"{made.title}: {verdict}written to {written}")
