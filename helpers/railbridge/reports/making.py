"""Reports of what was computed: a crossing, trains over speeds, a study."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import errors
from ..cases.definition import Case
from ..cautions import unsettled
from ..checks import Assessment
from ..codes import Answer, Verdicts
from ..crossing import NotConvergedError
from ..errors import InputError, Remark
from ..results import Crossing
from ..trains import AnyTrain
from .assumptions import left_out
from .document import Report
from .frame import (
    about_speeds,
    assumed,
    framed,
    in_short,
    inputs_section,
    key_table,
    modes_section,
    quiet,
    results_over_speeds,
    short_over_speeds,
    speed_in_words,
    train_in_words,
    trains_table,
)
from .inputs import resolved_deck
from .judgements import judged_run, requirements_table, verdicts_section
from .outcomes import key_results, tables_of_summary
from .overspeeds import failures, of_study, whole
from .parts import Notes, Section, Table, Words, shown
from .pictures import of_run, sketches
from .places import refuse_foreign
from .receipts import choices, inputs, made_in_python, names_only

if TYPE_CHECKING:
    import xarray as xr

__all__ = [
    "report", "report_of_assessment", "report_of_envelope", "report_of_run", "report_of_study",
]  # fmt: skip

_MOST_TRAINS = 3
"""Trains of an envelope that are sketched and shown with their numbers."""
_NOT_CONVERGED = "The iteration did not converge: these numbers are not a solution."
_NOT_SETTLED = "The iteration did not settle: these numbers are not a solution."


def report(
    case: Case | Assessment | Report,
    path: str | Path,
    *,
    run: Crossing | None = None,
    workbook: str | Path | None = None,
    force: bool = False,
    date: datetime.date | None = None,
    progress: Callable[[str], None] | None = None,
    **about: Any,
) -> Report:
    """Compute a case, if it was not yet, and write its report.

    Parameters
    ----------
    case : Case, Assessment or Report
        An assessment is reported as it is; of a report only the files are written.
    path : str or Path
        Of the page; ends in ``.html``.
    run : Crossing, optional
        Of this case, if there is one already.
    workbook : str or Path, optional
        Of the numbers; ends in ``.xlsx``.
    force : bool
        Whether files that are no reports of ours are replaced, too.
    date : datetime.date, optional
        When it was made; today if not given.
    progress : function of one text, optional
    **about
        ``verdicts``, ``rules``, ``title``: see `report_of_run`; ``trains``, ``title``: see
        `report_of_assessment`.

    Returns
    -------
    Report

    Raises
    ------
    InputError
        Before anything is computed: a file of somebody else, a wrong ending, a missing extra.
    """
    refuse_foreign("path", path, ".html", force)
    if workbook is not None:
        refuse_foreign("workbook", workbook, ".xlsx", force)
    if isinstance(case, Report):
        made = case
    elif isinstance(case, Assessment):
        made = report_of_assessment(case, **about)
    else:
        made = report_of_run(case, run, progress=progress, **about)
    made.write(path, force=force, date=date)
    if workbook is not None:
        made.write_workbook(workbook, force=force)
    return made


def report_of_run(
    case: Case,
    run: Crossing | None = None,
    *,
    verdicts: Verdicts | None = None,
    rules: Mapping[str, Answer] | None = None,
    title: str | None = None,
    progress: Callable[[str], None] | None = None,
) -> Report:
    """Return the report of a single crossing.

    Parameters
    ----------
    case : Case
    run : Crossing, optional
        Of this case; computed if not given. One that did not converge is reported as such.
    verdicts : Verdicts, optional
        On its results; those of the case's own ``[checks]`` if not given.
    rules : mapping of Answer, optional
        What else codes say, by name.
    title : str, optional
    progress : function of one text, optional

    Returns
    -------
    Report
    """
    errors.instance("case", case, Case)
    tell = progress or (lambda text: None)
    if run is None:
        try:
            run = case.compute(progress)
        except NotConvergedError as error:
            run = error.run
    errors.instance("run", run, Crossing)
    tell("extremes for the report")
    verdicts = judged_run(case, run) if verdicts is None else verdicts
    summary, remarks = case.summary(run), case.remarks(run)
    speed = case.settings.speed
    about = f"{train_in_words(case.train)} over {case.deck.name}, {case.deck.length:g} m, "
    about += f"at {speed_in_words(speed)}"
    trouble = ""
    if run.converged is False:
        given = run.settings.iterations is not None
        trouble = "" if given and not unsettled(run) else _NOT_SETTLED if given else _NOT_CONVERGED
    tell("pictures for the report")
    return framed(
        title or f"Train on a bridge: {case.deck.name}",
        about,
        short=in_short(key_table(key_results(summary), time="s"), remarks, trouble),
        verdicts=verdicts_section(verdicts, rules),
        inputs=inputs_section(case, {"": case.train}),
        modes=modes_section(case.deck, case.settings.accelerations_up_to_hz),
        results=(*tables_of_summary(summary), *of_run(run, case.points.tolist())),
        limits=assumed(case, case.train),
        receipt=(choices(run.settings, case.deck, case.content, run), inputs(case.content)),
        verdict="" if verdicts is None else verdicts.verdict,
    )


def report_of_envelope(
    case: Case,
    trains: Mapping[str, AnyTrain],
    found: xr.Dataset,
    *,
    tables: Mapping[str, Mapping[str, Any]] | None = None,
    assessment: Assessment | None = None,
    verdicts: Verdicts | None = None,
    rules: Mapping[str, Answer] | None = None,
    doubts: Sequence[Remark] = (),
    title: str | None = None,
) -> Report:
    """Return the report of trains over speeds.

    Parameters
    ----------
    case : Case
        With the deck, the track and the choices; its own train and speed do not count.
    trains : mapping of trains
        By name, as in `found`.
    found : xarray.Dataset
        Over ``train`` and ``speed``, as `speed_envelope` gives it.
    tables : mapping, optional
        Of the trains as a case has them, by name, for the receipt.
    assessment : Assessment, optional
        By the clauses of codes; None where no limits were asked for.
    verdicts : Verdicts, optional
        Instead of those of the assessment.
    rules : mapping of Answer, optional
        Likewise.
    doubts : sequence of Remark
        What is unlikely to be meant.
    title : str, optional

    Returns
    -------
    Report
    """
    errors.instance("case", case, Case)
    for dim in ("train", "speed"):
        if dim not in found.dims:
            allowed = f"is over {', '.join(map(str, found.dims))}, not over train and speed"
            raise InputError("found", None, allowed, "report_of_study takes other studies")
    speeds = found["speed"].values
    if assessment is not None:
        verdicts = assessment.verdicts if verdicts is None else verdicts
        rules = assessment.rules if rules is None else rules
    return framed(
        title or f"Trains on a bridge: {case.deck.name}",
        about_speeds(list(trains), case.deck, speeds),
        short=short_over_speeds(found, [*doubts, *quiet(case)]),
        verdicts=verdicts_section(verdicts, rules, assessment),
        inputs=inputs_section(case, trains, speeds=speeds, own_train=False),
        modes=modes_section(case.deck, case.settings.accelerations_up_to_hz),
        results=results_over_speeds(found, case.deck),
        limits=assumed(case, next(iter(trains.values()))),
        receipt=(
            choices(case.settings, case.deck, case.content), inputs(_content(case, tables)),
        ),
        verdict="" if verdicts is None else verdicts.verdict,
    )  # fmt: skip


def report_of_assessment(
    assessment: Assessment,
    *,
    trains: Mapping[str, AnyTrain] | None = None,
    title: str | None = None,
) -> Report:
    """Return the report of a deck and its trains that were judged without a case file.

    Parameters
    ----------
    assessment : Assessment
    trains : mapping of trains, optional
        By name, to be sketched and listed.
    title : str, optional

    Returns
    -------
    Report
    """
    errors.instance("assessment", assessment, Assessment)
    deck, found = assessment.deck, assessment.envelope
    given: list[Any] = [requirements_table(assessment.needs), resolved_deck(deck)]
    if trains:
        given += [trains_table(trains), *sketches(next(iter(trains.values())), deck)]
    own = [remark.moved("deck") for remark in deck.remarks]
    limits = (Words("Not in this calculation:"), Notes(tuple(left_out())))
    return framed(
        title or f"Trains on a bridge: {deck.name}",
        about_speeds(found["train"].values.tolist(), deck, found["speed"].values),
        short=short_over_speeds(found, own),
        verdicts=verdicts_section(assessment.verdicts, assessment.rules, assessment),
        inputs=Section("Inputs", tuple(given)),
        modes=modes_section(deck),
        results=results_over_speeds(found, deck),
        limits=Section("Limits", limits),
        receipt=(made_in_python(deck, trains),),
        verdict=assessment.verdict,
    )


def report_of_study(
    case: Case,
    found: xr.Dataset,
    *,
    trains: Mapping[str, AnyTrain] | None = None,
    study: Mapping[str, Any] | None = None,
    doubts: Sequence[Remark] = (),
    title: str | None = None,
) -> Report:
    """Return the report of a case over values of its keys.

    Parameters
    ----------
    case : Case
        The first of the study.
    found : xarray.Dataset
        As `sweep` gives it.
    trains : mapping of trains, optional
        By name, where there are several.
    study : mapping, optional
        The content of the study's file.
    doubts : sequence of Remark
        What is unlikely to be meant.
    title : str, optional

    Returns
    -------
    Report
    """
    errors.instance("case", case, Case)
    dims = [str(d) for d in found.sizes if d != "x"]
    many = " x ".join(f"{found.sizes[d]} {d}" for d in dims)
    about = f"{case.deck.name}, {case.deck.length:g} m: {found['message'].size} crossings, {many}"
    over = [(d, found.sizes[d], _ends(found, d), found[d].attrs.get("units", "")) for d in dims]
    varied = Table.of("varied", "What varies", ["key", "values", "from, to", "unit"], over)
    first, *rest = of_study(found)
    return framed(
        title or f"Study of a bridge: {case.deck.name}",
        about,
        short=in_short(
            None, [*doubts, *quiet(case)], more=[*failures(found), varied, first]
        ),
        verdicts=verdicts_section(None),
        inputs=inputs_section(case, trains or {"": case.train}, own_train=not trains),
        modes=modes_section(case.deck, case.settings.accelerations_up_to_hz),
        results=(*rest, whole(found)),
        limits=assumed(case, case.train),
        receipt=(
            choices(case.settings, case.deck, case.content), inputs(_studied(case, study)),
        ),
    )  # fmt: skip


# ---- what counts, and ends


def _content(case: Case, tables: Mapping[str, Mapping[str, Any]] | None) -> dict[str, Any]:
    """Return the content that counts in an envelope: the trains in place of the case's own."""
    content = {
        key: value for key, value in case.content.items() if tables is None or key != "train"
    }
    return content if tables is None else {**content, "trains": dict(tables)}


def _studied(case: Case, study: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return the content that counts in a study: the first case, its trains, and the study."""
    content = dict(case.content)
    if study:
        content["study"] = dict(study)
        if isinstance(study.get("trains"), Mapping):
            content["trains"] = study["trains"]
    return content


def _ends(found: xr.Dataset, dim: str) -> str:
    values = found[dim].values
    if values.dtype.kind in "fiu":
        return f"{shown(float(values.min()), 6)} to {shown(float(values.max()), 6)}"
    return errors.counted([str(names_only(v)) for v in values], 6)
