"""Tables of the page on units, written from what checks, reads and writes the numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from ..decks import BEARING_QUANTITIES, REACTION_QUANTITIES, SECTION_QUANTITIES
from ..units import UNITS
from .cars import CAR_PARAMETERS
from .summary import QUANTITIES
from .tables import TABLES as FILE_TABLES
from .tabletypes import unit_of

__all__ = ["TABLES", "car_rows", "factor_rows", "key_rows", "result_rows", "study_rows"]

_NONE = "none: a share, a factor, a number of things"


def factor_rows() -> list[str]:
    """Return the lines of a Markdown table of all units and how many SI units each is."""
    lines = ["| quantity | SI | others, with how many SI units each is |", "|---|---|---|"]
    for dimension, family in UNITS.items():
        first, *others = (f"`{name}`" if name else "nothing" for name in family)
        factors = list(family.values())[1:]
        known = ", ".join(f"{n} {f:.9g}" for n, f in zip(others, factors, strict=True))
        lines.append(f"| {dimension} | {first} | {known} |")
    return lines


def key_rows() -> list[str]:
    """Return the lines of a Markdown table of the keys of files, by their unit.

    A key that bears one name in tables of different units is told with its table.
    """
    found: dict[str, dict[str, list[str]]] = {}
    for title, table in FILE_TABLES.items():
        for name, field in table.model_fields.items():
            unit = unit_of(field)
            if unit is not None:
                found.setdefault(field.alias or name, {}).setdefault(unit, []).append(title)
    by_unit: dict[str, list[str]] = {}
    for name, units in found.items():
        for unit, titles in units.items():
            where = f" ({', '.join(titles)})" if len(units) > 1 else ""
            by_unit.setdefault(unit, []).append(f"`{name}`{where}")
    return _by_unit("keys", by_unit)


def car_rows() -> list[str]:
    """Return the lines of a Markdown table of the rows of a car's CSV file, by their SI unit."""
    by_unit: dict[str, list[str]] = {}
    for name, bounds in CAR_PARAMETERS.items():
        by_unit.setdefault(bounds.unit, []).append(f"`{name}`")
    return _by_unit("rows", by_unit)


def _by_unit(what: str, by_unit: Mapping[str, Iterable[str]]) -> list[str]:
    lines = [f"| unit | {what} |", "|---|---|"]
    for unit in sorted(by_unit, key=lambda unit: (not unit, unit.lower())):
        lines.append(f"| {unit or _NONE} | {', '.join(by_unit[unit])} |")
    return lines


_PLACES = (
    ("at a point of the deck", QUANTITIES | SECTION_QUANTITIES),
    ("at a bearing line", REACTION_QUANTITIES),
    ("at one bearing", BEARING_QUANTITIES),
    ("of a wheel", {"force_y": "N", "force_z": "N"}),
    ("of a car body", {"acceleration_y": "m/s2", "acceleration_z": "m/s2"}),
)


def result_rows() -> list[str]:
    """Return the lines of a Markdown table of results and their units."""
    lines = ["| where | results, with their units |", "|---|---|"]
    for where, units in _PLACES:
        lines.append(f"| {where} | {', '.join(f'`{n}` {u}' for n, u in units.items())} |")
    return lines


def study_rows() -> list[str]:
    """Return the lines of a Markdown table of what a study asks of a whole crossing."""
    from ..studies.engine import NUMBERS

    lines = ["| measure | unit | meaning |", "|---|---|---|"]
    for name, (unit, meaning, _) in NUMBERS.items():
        lines.append(f"| `{name}` | {unit} | {meaning} |")
    return lines


TABLES: dict[str, Callable[[], list[str]]] = {
    "unit factors": factor_rows, "units of keys": key_rows, "units of cars": car_rows,
    "units of results": result_rows, "units of studies": study_rows,
}  # fmt: skip
"""What the page calls its tables, and what writes them."""
