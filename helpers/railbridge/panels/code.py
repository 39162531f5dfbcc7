"""A case in a few lines of Python: the paper's with changes, or written out where it is another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..cases.definition import Case
from ..cases.definition import case as load_case
from .control import Control

__all__ = ["case_lines"]

_MOST_CHANGES = 6
"""More changes than these beside those of the controls, and a case is written out."""
_LONGEST = 80  # letters on a line of changes
_SHIPPED = "paper"


def case_lines(case: Case, controls: Iterable[Control]) -> str:
    """Return Python lines that make a case; a control's values stand on a line of their own."""
    values, shipped = _leaves(case.content), _leaves(load_case(_SHIPPED).content)
    lines, said = [], set()
    for control in controls:
        # A number as last part counts in a list, which is written as a whole.
        paths = [path.removesuffix(".0").removesuffix(".1") for path in control.paths]
        paths = [path for path in paths if path not in said]
        said.update(paths)
        if paths:
            unit = f"  # {control.unit}" if control.unit else ""
            lines.append(_entries({path: values[path] for path in paths}) + unit)
    changes = {
        path: values.get(path)
        for path in (*values, *shipped)
        if path not in said and values.get(path) != shipped.get(path)
    }
    if len(changes) > _MOST_CHANGES:
        return case.code().partition("\nrun = ")[0] + "\n"
    together = _entries(changes)
    apart = [_entries({path: value}) for path, value in changes.items()]
    lines += apart if len(together) > _LONGEST else [together]
    listed = "".join(f"    {line}\n" for line in lines if line)
    return f'import railbridge as rb\n\ncase = rb.case("{_SHIPPED}").replace({{\n{listed}}})\n'


def _entries(values: Mapping[str, Any]) -> str:
    return " ".join(f'"{path}": {_written(value)},' for path, value in values.items())


def _written(value: Any) -> str:
    return f'"{value}"' if isinstance(value, str) else repr(value)


def _leaves(tables: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """Return what is no table, by path."""
    found: dict[str, Any] = {}
    for key, value in tables.items():
        path = f"{above}{key}"
        found |= _leaves(value, f"{path}.") if isinstance(value, Mapping) else {path: value}
    return found
