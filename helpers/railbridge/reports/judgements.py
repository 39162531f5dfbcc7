"""Verdicts and answers of codes as a section: coloured, and in words."""

from __future__ import annotations

from collections.abc import Mapping

from ..codes import Answer, Verdict, Verdicts
from ..codes.clauses import GRADES
from ..codes.verdicts import CANNOT_DECIDE
from .parts import Column, Notes, Section, Table, Words, shown

__all__ = ["verdicts_section"]

_UNITS = {
    "m": ("mm", 1e3), "N": ("kN", 1e-3), "N m": ("kN m", 1e-3), "rad": ("mrad", 1e3),
    "m/s2": ("m/s²", 1.0),
}  # fmt: skip
"""In which units a limit is shown."""
_RADII = 100.0
"""m from which on a length stays in m: a radius is no deflection."""
_HOW_TO_ASK = (
    "No limits of a code were asked for, so this report gives no verdicts. Add a table [checks] to "
    "the case, with the speed of the line and the kind of track, to have the results judged."
)


def verdicts_section(
    verdicts: Verdicts | None, rules: Mapping[str, Answer] | None = None
) -> Section:
    """Return the section of verdicts.

    Parameters
    ----------
    verdicts : Verdicts, optional
        None where no limits were asked for.
    rules : mapping of Answer, optional
        What else codes answer, by name.
    """
    parts: list[Words | Notes | Table] = []
    if verdicts is None:
        parts.append(Words(_HOW_TO_ASK, "note"))
    elif not len(verdicts):
        parts.append(Words("No limit applies to what was computed.", "note"))
    else:
        parts += [_table(verdicts), _sources(verdicts)]
        undecided = [_undecided(v) for v in verdicts if v.verdict == CANNOT_DECIDE]
        if undecided:
            parts += [Words("Not decided:"), Notes(tuple(undecided))]
    if rules:
        parts.append(_rules(rules))
    return Section("Verdicts", tuple(parts))


def _table(verdicts: Verdicts) -> Table:
    heads = [
        "what", Column("verdict", verdicts=True), Column("value", digits=3), "sense",
        Column("limit", digits=3), "unit", Column("utilisation", digits=3), "where", "when",
        "remark", "clause",
    ]  # fmt: skip
    rows = [_row(v) for v in verdicts]
    note = (
        "Utilisation is the share of what is allowed that is used: above 1 the limit is not met. "
        "A limit that is just reached is met."
    )
    return Table.of("verdicts", "Verdicts", heads, rows, note=note)


def _row(v: Verdict) -> tuple:
    unit, factor = _UNITS.get(v.clause.unit, (v.clause.unit, 1.0))
    if v.clause.unit == "m" and v.limit is not None and v.limit >= _RADII:
        unit, factor = "m", 1.0
    value = None if v.value is None else factor * v.value
    limit = None if v.limit is None else factor * v.limit
    return (
        v.clause.title, v.verdict, value, v.clause.sense, limit, unit or "-", v.utilisation,
        _placed(v.where, "m"), _placed(v.when, "s"), v.reason or None, v.clause.name,
    )  # fmt: skip


def _placed(given: float | str | None, unit: str) -> str | None:
    if given is None or isinstance(given, str):
        return given
    return f"{shown(float(given))} {unit}"


def _undecided(v: Verdict) -> str:
    return f"{v.clause.title} ({v.clause.name}): {v.reason}"


def _sources(verdicts: Verdicts) -> Table:
    """Return each clause once: its edition, its range, and how well it is known."""
    clauses = {}
    for v in verdicts:
        for clause in (v.clause, v.value_clause):
            if clause is not None:
                clauses.setdefault(clause, None)
    heads = ["clause", "about", "edition", "valid", "how well it is known"]
    rows = [(c.name, c.title, c.edition, c.validity, c.source) for c in clauses]
    note = f"What is known {GRADES['memory']} must be looked up in the code before it is relied on."
    title = "Clauses, editions and sources"
    return Table.of("clauses", title, heads, rows, note=note)


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
