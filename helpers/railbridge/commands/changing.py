"""What commands that take a case share: its keys changed on the command line, its doubts said."""

from __future__ import annotations

import argparse
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass

from .. import errors
from ..cases import shelf, tables
from ..cases.definition import Case, case
from ..errors import InputError, InputWarning, Remark
from .speech import Progress, say, warn

__all__ = ["Begun", "begun", "car_numbers", "changed_case", "doubted", "is_deck", "options"]


def options() -> argparse.ArgumentParser:
    """Return the parser of what these commands have alike, as a parent of theirs."""
    changes = argparse.ArgumentParser(add_help=False)
    changes.add_argument("case", help="a case file (.toml), or the name of a shipped case")
    changes.add_argument(
        "--set",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        help="change a key, as in run.speed=30; may be repeated; paths as in the file",
    )
    changes.add_argument(
        "--strict",
        action="store_true",
        help="refuse what is unlikely to be meant (exit code 2), instead of a warning",
    )
    return changes


def changed_case(given: argparse.Namespace) -> Case:
    """Return the case that was asked for, with the keys of ``--set``."""
    changes = {}
    for change in given.set:
        key, mark, value = change.partition("=")
        if not mark or not key.strip():
            raise InputError(
                "--set", change, "must be KEY=VALUE", "For instance --set run.speed=30"
            )
        try:
            changes[key.strip()] = tomllib.loads(f"value = {value}")["value"]
        except (ValueError, RecursionError):
            changes[key.strip()] = value.strip()  # a text without its quotes
    return case(given.case, changes)


@dataclass
class Begun:
    """What is told while a case is computed, and after it.

    Attributes
    ----------
    doubts : set of str
        What was said before.
    progress : Progress
    """

    doubts: set[str]
    progress: Progress

    def end(self, remarks: Iterable[Remark]) -> None:
        """Tell no more how far it is, and warn of what was not said before."""
        self.progress.end()
        warn(remark for remark in remarks if str(remark) not in self.doubts)


def begun(given: argparse.Namespace, loaded: Case) -> Begun | None:
    """Say what is unlikely to be meant, before work starts; None where that is refused."""
    doubts = _said_doubts(loaded, given.strict)
    return None if doubts and given.strict else Begun(doubts, Progress(given.quiet))


def doubted(given: argparse.Namespace, loaded: Case) -> bool:
    """Say what is unlikely to be meant; whether that is refused."""
    return bool(_said_doubts(loaded, given.strict)) and given.strict


def _said_doubts(loaded: Case, strict: bool) -> set[str]:
    """Print a line for whatever is unlikely to be meant, and return these lines."""
    doubts = [remark for remark in loaded.doubts if isinstance(remark, InputWarning)]
    if strict:
        for doubt in doubts:
            say(str(doubt))
    else:
        warn(doubts)
    return {str(doubt) for doubt in doubts}


def car_numbers(field: str, text: str) -> list[int]:
    """Return the cars of a list in words, ``1,8``, each once.

    Raises
    ------
    InputError
        With `field`, if it is no such list.
    """
    remedy = "Write their numbers, from 1, as in 1,8"
    found = []
    for part in text.split(","):
        if not part.strip().isdecimal():
            raise InputError(field, text, "is no list of cars", remedy)
        found.append(errors.integer(field, int(part), least=1, most=1000))
    return list(dict.fromkeys(found))


def is_deck(name: str) -> bool:
    """Whether a name is that of a shipped deck, or of a file with the keys of a deck's."""
    if not shelf.is_path(name):
        shipped = shelf.data_names("cases", ".toml")
        return name not in shipped and name in shelf.data_names("decks", ".toml")
    keys = shelf.read_toml(shelf.data_file("cases", name, ".toml")).keys()
    return not keys & tables.CASE.model_fields.keys() and bool(keys & tables.DECK_KEYS)
