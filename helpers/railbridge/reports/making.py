"""Reports of what was computed: a crossing, trains over speeds, a study."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import errors
from ..cases.definition import Case
from ..cautions import unsettled
from ..checks import Assessment
from ..codes import Answer, Verdicts
from ..crossing import NotConvergedError
from ..decks import Deck
from ..errors import InputError, Remark
from ..results import Crossing
from ..trains import AnyTrain
from .assumptions import assumptions, left_out
from .document import Report
from .inputs import file_tables, modes_table, resolved_deck, resolved_train, tables_of_case
from .judgements import judged_run, requirements_table, verdicts_section
from .outcomes import key_results, tables_of_summary
from .overspeeds import failures, key_peaks, of_study, peaks, pictures, whole
from .parts import Column, Notes, Section, Table, Words, in_km_h, shown
from .pictures import modes, of_run, sketches, track_picture
from .places import refuse_foreign
from .receipts import choices, input_files, inputs, made_in_python, names_only, programs

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
    about = (
        f"{_train(case.train)} over {case.deck.name}, {case.deck.length:g} m, at {_speed(speed)}"
    )
    trouble = ""
    if run.converged is False:
        given = run.settings.iterations is not None
        trouble = "" if given and not unsettled(run) else _NOT_SETTLED if given else _NOT_CONVERGED
    key = _key_table(key_results(summary), time="s")
    tell("pictures for the report")
    sections = [
        _in_short(key, remarks, trouble),
        verdicts_section(verdicts, rules),
        _inputs(case, {"": case.train}),
        _modes(case.deck, case.settings.accelerations_up_to_hz),
        Section("Results", (
            *tables_of_summary(summary), *of_run(run, case.points.tolist()),
        )),
        _assumed(case, case.train),
        Section("Receipt", (
            choices(run.settings, case.deck, case.content, run), inputs(case.content), programs(),
        )),
    ]  # fmt: skip
    verdict = "" if verdicts is None else verdicts.verdict
    return Report(title or f"Train on a bridge: {case.deck.name}", about, tuple(sections), verdict)


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
    names = errors.counted(list(trains), 4)
    about = f"{names} over {case.deck.name}, {case.deck.length:g} m, "
    about += f"at {len(speeds)} speeds from {_speed(speeds[0])} to {_speed(speeds[-1])}"
    if assessment is not None:
        verdicts = assessment.verdicts if verdicts is None else verdicts
        rules = assessment.rules if rules is None else rules
    key = _key_table(key_peaks(found))
    content = _content(case, tables)
    sections = [
        _in_short(key, [*doubts, *_quiet(case)], "", failures(found)),
        verdicts_section(verdicts, rules, assessment),
        _inputs(case, trains, speeds=speeds, own_train=False),
        _modes(case.deck, case.settings.accelerations_up_to_hz),
        Section("Results", (*peaks(found), *pictures(found, case.deck), whole(found))),
        _assumed(case, next(iter(trains.values()))),
        Section("Receipt", (
            choices(case.settings, case.deck, case.content), inputs(content), programs(),
        )),
    ]  # fmt: skip
    verdict = "" if verdicts is None else verdicts.verdict
    return Report(title or f"Trains on a bridge: {case.deck.name}", about, tuple(sections), verdict)


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
    speeds = found["speed"].values
    names = errors.counted([str(name) for name in found["train"].values], 4)
    about = f"{names} over {deck.name}, {deck.length:g} m, "
    about += f"at {len(speeds)} speeds from {_speed(speeds[0])} to {_speed(speeds[-1])}"
    given: list[Any] = [requirements_table(assessment.needs), resolved_deck(deck)]
    if trains:
        given += [_trains(trains), *sketches(next(iter(trains.values())), deck)]
    own = [remark.moved("deck") for remark in deck.remarks]
    sections = [
        _in_short(_key_table(key_peaks(found)), own, "", failures(found)),
        verdicts_section(assessment.verdicts, assessment.rules, assessment),
        Section("Inputs", tuple(given)),
        _modes(deck),
        Section("Results", (*peaks(found), *pictures(found, deck), whole(found))),
        Section("Limits", (Words("Not in this calculation:"), Notes(tuple(left_out())))),
        Section("Receipt", (made_in_python(deck, trains), programs())),
    ]
    title = title or f"Trains on a bridge: {deck.name}"
    return Report(title, about, tuple(sections), assessment.verdict)


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
    short = [varied, first]
    sections = [
        _in_short(None, [*doubts, *_quiet(case)], "", [*failures(found), *short]),
        verdicts_section(None),
        _inputs(case, trains or {"": case.train}, own_train=not trains),
        _modes(case.deck, case.settings.accelerations_up_to_hz),
        Section("Results", (*rest, whole(found))),
        _assumed(case, case.train),
        Section("Receipt", (
            choices(case.settings, case.deck, case.content),
            inputs(_studied(case, study)), programs(),
        )),
    ]  # fmt: skip
    return Report(title or f"Study of a bridge: {case.deck.name}", about, tuple(sections))


# ---- parts of all of them


def _train(train: AnyTrain) -> str:
    kinds = train.kinds()
    if not kinds:
        name = getattr(train, "name", None)
        return name or f"A train of {len(train.formation[0].axles)} axles"
    counts = [f"{len(cars)} x {vehicle.name}" for vehicle, cars in kinds]
    return errors.counted(counts, 4)


def _speed(speed: float) -> str:
    return f"{shown(float(speed))} m/s ({shown(in_km_h(speed))} km/h)"


def _key_table(rows: Sequence[tuple[Any, ...]], time: str = "") -> Table:
    heads = ["what", "value", "unit", "where", *([("at", time)] if time else [])]
    rows = rows if time else [row[:-1] for row in rows]
    note = "The deck's own weight is not in these numbers."
    return Table.of("in short", "The largest values", heads, rows, note=note)


def _quiet(case: Case) -> list[Remark]:
    """Return what a deck says of itself, which no warning is."""
    return [remark.moved("deck") for remark in case.deck.remarks if not remark.warned]


def _in_short(
    key: Table | None, remarks: Sequence[Remark], trouble: str, more: Sequence[Any] = ()
) -> Section:
    parts: list[Any] = [Words(trouble, "warning")] if trouble else []
    warned = list(dict.fromkeys(str(r) for r in remarks if r.warned))
    others = list(dict.fromkeys(str(r) for r in remarks if not r.warned))
    if warned:
        parts += [Words("Doubts and warnings:"), Notes(tuple(warned), "warning")]
    if key is not None:
        parts.append(key)
    parts += more
    if others:
        parts += [Words("To be known when reading the numbers:"), Notes(tuple(others))]
    if not remarks and not trouble:
        parts.append(Words("Nothing about the input or the numbers was found doubtful.", "note"))
    return Section("In short", tuple(parts))


def _inputs(
    case: Case,
    trains: Mapping[str, AnyTrain],
    *,
    speeds: Sequence[float] | None = None,
    own_train: bool = True,
) -> Section:
    given = dict(case.content)
    hidden = [] if speeds is None else ["run.speed"]
    if not own_train:  # those of the envelope instead
        given.pop("train", None)
        hidden.append("train")
    parts: list[Any] = [*tables_of_case(case.content, hidden)]
    if speeds is not None:
        rows = [(i, float(v), in_km_h(v)) for i, v in enumerate(speeds, start=1)]
        heads = ["number", ("speed", "m/s"), ("speed", "km/h")]
        parts.append(Table.of("speeds", "Speeds", heads, rows, on_page=False))
    parts += [resolved_deck(case.deck), *file_tables(given)]
    if not own_train:
        parts.append(_trains(trains))
    first = next(iter(trains.values()))
    if own_train:
        files = [path for role, path in input_files(given) if role == "vehicle"]
        known = bool(files) and all(path.suffix == ".csv" for path in files)
        parts += resolved_train(first, known)
    parts += sketches(first, case.deck)
    if not case.track.level:
        parts.append(track_picture(case.track, case.deck, case.settings.lead_in))
    return Section("Inputs", tuple(parts))


def _trains(trains: Mapping[str, AnyTrain]) -> Table:
    heads = [
        "train",
        "axles",
        ("length", "m"),
        ("heaviest axle", "kN"),
        ("all axles", "kN"),
        "kind",
    ]
    rows = []
    for name, train in trains.items():
        loads = [axle.static_load for car in train.formation for axle in car.axles]
        kind = "cars with suspension" if train.kinds() else "constant axle loads"
        length, most, weight = float(train.length), max(loads) / 1e3, sum(loads) / 1e3
        rows.append((name, len(loads), length, most, weight, kind))
    return Table.of("trains", "Trains", [Column(*h) if isinstance(h, tuple) else h for h in heads],
                    rows, note="Length: first to last axle.")  # fmt: skip


def _modes(deck: Deck, up_to_hz: float = np.inf) -> Section:
    return Section("Modes of the deck", (modes_table(deck, up_to_hz), modes(deck)))


def _assumed(case: Case, train: AnyTrain) -> Section:
    held = assumptions(train, case.deck, case.track, case.settings)
    parts = (Notes(tuple(held)), Words("Not in this calculation:"), Notes(tuple(left_out())))
    return Section("Assumptions and limits", parts)


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
