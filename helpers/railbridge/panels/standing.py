"""In which cell of a notebook a panel stands, and its end when that cell is run again.

Widgets live in the kernel until somebody closes them, whether or not a page still shows them. A
panel is at home in the cell that made it, and in each other one that shows it. When all of these
were run again nobody can see it any more: it is closed. That of a deleted cell stays: the cell
may come back.

JupyterLab, Notebook and VS Code name their cells. Where cells have no names (nbclient, Voila) the
same text counts as the same cell; since it may stand in two cells of a page, what its last
`SPARE` other runs made is kept.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any, Protocol
from weakref import WeakKeyDictionary

from IPython import get_ipython

__all__ = ["SPARE", "stands_here"]

SPARE = 2


class Standing(Protocol):
    """What can stand in a cell: anything that can be closed."""

    def close(self) -> None:
        """Free everything."""


_stays: WeakKeyDictionary[Standing, dict[Hashable, str]] = WeakKeyDictionary()
"""For each panel the cells in which it stands, with the number of the run that put it there."""


def stands_here(panel: Standing) -> None:
    """Note that a panel stands in the cell that is running; outside of cells there is no such."""
    shell = get_ipython()
    running = _running_cell(shell)
    if running is None:
        return
    if _leave_cells not in shell.events.callbacks["post_run_cell"]:
        shell.events.register("post_run_cell", _leave_cells)
    cell, run = running
    _stays.setdefault(panel, {})[cell] = run


def _running_cell(shell: Any) -> tuple[Hashable, str] | None:
    """Return the cell that is running and the number of this run; None outside of notebooks."""
    request = getattr(shell, "parent_header", None) or {}
    if request.get("header", {}).get("msg_type") != "execute_request":
        return None
    cell = request.get("metadata", {}).get("cellId") or ("text", request["content"]["code"])
    return cell, request["header"]["msg_id"]


def _leave_cells(_: Any) -> None:
    """After a run of a cell: what stood there before has left it."""
    running = _running_cell(get_ipython())
    if running is None:
        return
    cell, run = running
    here = [panel for panel, stays in _stays.items() if stays.get(cell, run) != run]
    if isinstance(cell, tuple):
        runs = list(dict.fromkeys(_stays[panel][cell] for panel in here))
        here = [panel for panel in here if _stays[panel][cell] not in runs[-SPARE:]]
    for panel in here:
        stays = _stays[panel]
        del stays[cell]
        if not stays:
            del _stays[panel]
            panel.close()
