"""The trains of a study: as names, files, tables or objects, each under a name."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..codes import HSLM_A
from ..errors import InputError
from ..trains import AnyTrain, AxleTrain
from .definition import Case

__all__ = ["FAMILY", "by_name", "train_changes", "trains_of_case"]

FAMILY = [f"HSLM-{name}" for name in HSLM_A]
"""What HSLM-A means: all ten."""


def by_name(trains: Any) -> dict[str, Any]:
    """Return trains as they were given, by name: a mapping as it is, others under their own names.

    Raises
    ------
    InputError
        No trains, or two of one name.
    """
    if isinstance(trains, Mapping):
        found = dict(trains)
    else:
        found = {}
        single = isinstance(trains, (str, AnyTrain))
        if not single and not isinstance(trains, (list, tuple)):
            allowed = "must be names of trains, files, tables, or AxleTrains"
            raise InputError("trains", trains, allowed)
        for i, train in enumerate([trains] if single else trains, 1):
            for one in FAMILY if isinstance(train, str) and train == "HSLM-A" else [train]:
                name = one if isinstance(one, str) else getattr(one, "name", None) or f"train {i}"
                name = Path(name).stem if name.endswith(".csv") else name
                if name in found:
                    remedy = "Give each once, or {name: train, ...}"
                    raise InputError("trains", name, "is named twice", remedy)
                found[name] = one
    if not found:
        raise InputError("trains", trains, "must name at least one train")
    return found


def trains_of_case(trains: Any) -> dict[str, dict[str, Any]]:
    """Return tables of trains by name, as a case has them under ``train``; none for None."""
    if trains is None:
        return {}
    return {name: _table_of(name, train) for name, train in by_name(trains).items()}


def _table_of(name: str, train: Any) -> dict[str, Any]:
    if isinstance(train, str):
        return {"file" if train.endswith(".csv") else "name": train}
    if isinstance(train, AxleTrain):
        return {"axles": list(train.axles), "loads": list(train.loads)}
    if isinstance(train, Mapping):
        return dict(train)
    allowed = "must be a name, a .csv file, a table as in a case, or an AxleTrain"
    raise InputError(f"trains[{name}]", train, allowed)


def train_changes(base: Case, table: dict[str, Any]) -> dict[str, Any]:
    """Return the changes that put another train in a case.

    Bare axle loads have no cars to condense and nothing to iterate: what the case says of that is
    left out for them.
    """
    bare = {"name", "file", "axles", "loads"} & table.keys()
    own = {"train": table}
    track = base.get("train.track")
    if track is not None and "track" not in table:
        own["train"] = {**table, "track": track}
    if bare:
        own |= {f"run.{key}": None for key in ("loads", "iterations", "relaxation")}
    return own
