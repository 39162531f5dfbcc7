"""Verdicts and answers of codes as a section: coloured, and in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from ..cases.definition import Case
from ..cases.tabletypes import meanings
from ..checks import Assessment, Requirements, assess_run
from ..codes import Answer, Verdict, Verdicts
from ..plots.verdictbars import LONG, SHOWN
from ..results import Crossing
from ..studies import Between
from ..trains import AnyTrain
from .parts import Column, Picture, Section, Table, Words, exact, in_km_h, shown, sized
from .pictures import verdict_bars

__all__ = ["judged_over_speeds", "judged_run", "requirements_table", "verdicts_section"]

_UNITS = {**SHOWN, "m/s2": ("m/s²", 1.0)}
"""In which units a limit is shown."""
_HOW_TO_ASK = (
    "No limits of a code were asked for, so this report gives no verdicts. To have the results "
    "judged, add a table [checks] to the case file, with line_speed in m/s and, where they differ "
    "from the defaults, track, kind and the other keys of docs/case.md."
)


def judged_run(case: Case, run: Crossing) -> Verdicts | None:
    """Return the verdicts on a run by what the case asks for; None if it asks for nothing."""
    return None if case.requirements is None else assess_run(run, case.requirements)


def judged_over_speeds(
    case: Case, trains: Mapping[str, AnyTrain], speeds: Sequence[float] | Between, **how: Any
) -> Assessment | None:
    """Return the assessment of trains over speeds by what the case asks for; None for nothing.

    Parameters
    ----------
    case : Case
        With the deck, the track and the choices; its own train and speed do not count.
    trains : mapping of trains
    speeds : sequence of float, or Between
        m/s.
    **how
        ``more``, ``workers``, ``progress``: see `checks.assess`.
    """
    return None if case.requirements is None else case.assess(dict(trains), speeds, **how)


def verdicts_section(
    verdicts: Verdicts | None,
    rules: Mapping[str, Answer] | None = None,
    assessment: Assessment | None = None,
) -> Section:
    """Return the section of verdicts.

    Parameters
    ----------
    verdicts : Verdicts, optional
        None where no limits were asked for.
    rules : mapping of Answer, optional
        What else codes answer, by name.
    assessment : Assessment, optional
        For what each train comes to.
    """
    parts: list[Words | Table | Picture] = []
    if verdicts is None:
        parts.append(Words(_HOW_TO_ASK, "note"))
    elif not len(verdicts):
        parts.append(Words("No limit applies to what was computed.", "note"))
    else:
        parts += [_read(verdicts), verdict_bars(verdicts)]
        parts += [_numbers(verdicts), _sources(verdicts)]
    if assessment is not None and len(assessment.of_trains) > 1:
        parts.append(_of_trains(assessment))
    if rules:
        parts.append(_rules(rules))
    return Section("Verdicts", tuple(parts))


def _read(verdicts: Verdicts) -> Table:
    """Return verdicts as they are read: numbers with their units, places and times in a cell."""
    heads = ["what", Column("verdict", verdicts=True), "value", "limit",
             Column("utilisation", digits=3), "where, when", "remark"]  # fmt: skip
    rows = []
    for v in verdicts:
        unit, factor = _unit(v)
        value, limit = (_amount(n, factor, unit) for n in (v.value, v.limit))
        limit = None if limit is None else f"{v.clause.sense} {limit}"
        where = [text for text in (_placed(v.where, "m"), _placed(v.when, "s")) if text]
        rows.append((
            f"{v.clause.title} ({v.clause.name})", v.verdict, value, limit, v.utilisation,
            "; ".join(where) or None, v.reason or None,
        ))  # fmt: skip
    note = (
        "Utilisation is the share of what is allowed that is used: above 1 the limit is not met. "
        "A limit that is just reached is met."
    )
    return Table.of("verdicts", "Verdicts", heads, rows, note=note, in_workbook=False)


def _amount(number: float | None, factor: float, unit: str) -> str | None:
    return None if number is None else f"{shown(sized(factor * number), 3)} {unit}".strip()


def _numbers(verdicts: Verdicts) -> Table:
    """Return verdicts for a workbook, a thing a cell."""
    heads = ["what", "verdict", "value", "sense", "limit", "unit", "utilisation", "where", "when",
             "remark", "clause", "edition", "how well it is known"]  # fmt: skip
    rows = []
    for v in verdicts:
        unit, factor = _unit(v)
        value, limit = (None if n is None else sized(factor * n) for n in (v.value, v.limit))
        rows.append((
            v.clause.title, v.verdict, value, v.clause.sense, limit, unit or "-", v.utilisation,
            _placed(v.where, "m"), _placed(v.when, "s"), v.reason or None, v.clause.name,
            v.clause.edition, v.source,
        ))  # fmt: skip
    return Table.of("verdicts", "Verdicts", heads, rows, on_page=False)


def _unit(v: Verdict) -> tuple[str, float]:
    """Return in which unit a limit and its value are shown, and the factor to it from SI."""
    if v.clause.unit == "m" and v.limit is not None and v.limit >= LONG:
        return "m", 1.0
    return _UNITS.get(v.clause.unit, (v.clause.unit, 1.0))


def _placed(given: float | str | None, unit: str) -> str | None:
    if given is None or isinstance(given, str):
        return given
    return f"{'x = ' * (unit == 'm')}{'t = ' * (unit == 's')}{shown(float(given))} {unit}"


def _sources(verdicts: Verdicts) -> Table:
    """Return each clause once: its edition, its range, and how well it is known."""
    clauses = {}
    for v in verdicts:
        for clause in (v.clause, v.value_clause):
            if clause is not None:
                clauses.setdefault(clause, None)
    heads = ["clause", "about", "edition", "valid", "how well it is known"]
    rows = [(c.name, c.title, c.edition, c.validity.replace("`", ""), c.source) for c in clauses]
    note = "What rests on memory must be looked up in the code before it is relied on."
    title = "Clauses, editions and sources"
    return Table.of("clauses", title, heads, rows, note=note)


def _of_trains(assessment: Assessment) -> Table:
    """Return what each train comes to by the clauses that trains decide."""
    heads = ["train", "what", Column("verdict", verdicts=True), Column("value", digits=3), "unit",
             Column("utilisation", digits=3), ("speed", "m/s"), ("speed", "km/h")]  # fmt: skip
    rows = []
    for (train, what), row in assessment.per_train().iterrows():
        unit, factor = _UNITS.get(row["unit"], (row["unit"], 1.0))
        speed = float(row["speed"])
        utilisation = None if row["utilisation"] is None else float(row["utilisation"])
        value = sized(factor * float(row["value"]))
        unit = unit if np.isfinite(value) else ""
        rows.append((str(train), what, row["verdict"], value, unit or "-",
                     utilisation, speed, in_km_h(speed)))  # fmt: skip
    return Table.of("verdicts of trains", "What each train comes to", heads, rows)


def requirements_table(needs: Requirements) -> Table:
    """Return what the codes were told."""
    rows = [(f.name, exact(getattr(needs, f.name)), meanings(Requirements)[f.name].replace("`", ""))
            for f in fields(needs)]  # fmt: skip
    return Table.of("requirements", "What the codes were told", ["key", "value", "meaning"], rows)


def _rules(rules: Mapping[str, Answer]) -> Table:
    heads = ["rule", "answer", "unit", "reason", "clause", "edition", "how well it is known"]
    rows = [
        (
            name, "cannot decide" if answer.value is None else answer.value, answer.unit or "-",
            answer.reason or None, answer.clause.name, answer.clause.edition, answer.clause.source,
        )
        for name, answer in rules.items()
    ]  # fmt: skip
    return Table.of("rules", "What the codes say besides", heads, rows)
