"""What an exercise asks for, and what is right: the tables of ``answers/``, one file a notebook.

A table is one of these kinds, told by the key that holds the answer::

    ["1.1"]                          ["1.2"]                        ["1.3"]
    number = 1.337                   numbers = [1.171, 0.566]       choice = "b"
    unit = "Hz"                      names = ["bounce", "lowest"]   of = "abcd"
    within = 0.003                   unit = "Hz"                    [ "1.3".replies ]
    [[ "1.1".slips ]]                                               a = "..."
    number = 1.451
    says = "..."                     ["1.5"]
                                     function = "frequencies"       (a name in `trials`)

``right`` is said after a right answer, and ``hint`` after any wrong one; several numbers may have
``hints``, one for each. What counts things has ``count = true``: no unit explains it. The numbers
are those of the solutions in the notebooks: a test runs each of these and checks it.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError, did_you_mean
from . import trials
from .replies import UNANSWERED, Reply, is_open, list_reply, number_reply

__all__ = ["Choice", "Exercise", "Number", "Numbers", "Slip", "Written", "exercise", "exercises"]

ANSWERS = Path(__file__).with_name("answers")


@dataclass(frozen=True)
class Slip:
    """A wrong number that is often given, and what is said to it."""

    number: float
    says: str


@dataclass(frozen=True)
class Number:
    """One number is asked for.

    Attributes
    ----------
    number : float
    unit : str
    within : float
        Relative deviation that still is right.
    near : float
        Absolute deviation that still is right.
    count : bool
        Whether it counts things; it then has no unit.
    slips : tuple of Slip
    """

    number: float
    unit: str = ""
    within: float = 5e-3
    near: float = 0.0
    count: bool = False
    slips: tuple[Slip, ...] = ()

    def reply(self, given: Any) -> Reply:
        """Return what is said of an answer."""
        limits = {"within": self.within, "near": self.near}
        reply = number_reply(given, self.number, unit=self.unit, count=self.count, **limits)
        if reply.right or not reply.given:
            return reply
        says = _said_of_slip(self.slips, given, **limits)
        return Reply(0.0, says) if says else reply


@dataclass(frozen=True)
class Numbers:
    """Several numbers are asked for, in a given order; `within`, `near`, `count` as in `Number`.

    `hints` are said of the wrong ones, each of its own; a slip's words take their place.
    """

    numbers: tuple[float, ...]
    names: tuple[str, ...] = ()
    hints: tuple[str, ...] = ()
    unit: str = ""
    within: float = 5e-3
    near: float = 0.0
    count: bool = False
    slips: tuple[Slip, ...] = ()

    def reply(self, given: Any) -> Reply:
        """Return what is said of an answer."""
        limits = {"within": self.within, "near": self.near}
        hints = list(self.hints or ("",) * len(self.numbers))
        if isinstance(given, Sequence | np.ndarray) and len(given) == len(hints):
            slips = [_said_of_slip(self.slips, each, **limits) for each in given]
            hints = [slip or hint for slip, hint in zip(slips, hints, strict=True)]
        options = {"unit": self.unit, "count": self.count, "hints": tuple(hints)}
        return list_reply(given, self.numbers, self.names, **limits, **options)


def _said_of_slip(slips: tuple[Slip, ...], given: Any, **limits: float) -> str:
    """Return what is said of a number that is often given, or nothing."""
    for slip in slips:
        if number_reply(given, slip.number, **limits).right:
            return slip.says
    return ""


@dataclass(frozen=True)
class Choice:
    """One letter is asked for.

    Attributes
    ----------
    choice : str
        The right letter.
    of : str
        All letters.
    replies : dict
        What is said to each wrong letter.
    """

    choice: str
    of: str
    replies: dict[str, str]

    def reply(self, given: Any) -> Reply:
        """Return what is said of an answer."""
        if is_open(given) or (isinstance(given, str) and not given):
            return UNANSWERED
        letter = given.strip().strip("()").lower() if isinstance(given, str) else ""
        if len(letter) != 1 or letter not in self.of:
            return Reply(0.0, f"give one of the letters {', '.join(self.of)} in quotes.")
        if letter == self.choice:
            return Reply(1.0, "right.")
        return Reply(0.0, self.replies.get(letter, "not right."), hinted=True)


@dataclass(frozen=True)
class Written:
    """A function is asked for; it is tried on the cases of `trials`."""

    function: str

    def reply(self, given: Any) -> Reply:
        """Return what is said of a function."""
        return trials.reply(self.function, given)


KINDS = {"number": Number, "numbers": Numbers, "choice": Choice, "function": Written}


@dataclass(frozen=True)
class Exercise:
    """One exercise of a notebook.

    Attributes
    ----------
    name : str
        Its number, such as ``1.2``, or ``1.guess``.
    asks : Number, Numbers, Choice or Written
    right : str
        Said after a right answer.
    hint : str
        Said after a wrong one.
    marks : int
        What it is worth; a guess is worth nothing, whichever way it goes.
    """

    name: str
    asks: Number | Numbers | Choice | Written
    right: str = ""
    hint: str = ""
    marks: int = 1

    @property
    def page(self) -> str:
        """Number of its notebook as in its name, without a leading zero: ``1`` of ``1.2``."""
        return self.name.partition(".")[0]

    @property
    def variable(self) -> str:
        """The name that its answer bears in the notebook: ``answer_1_2``, ``guess_1``."""
        if isinstance(self.asks, Written):
            return self.asks.function
        place = self.name.removeprefix(f"{self.page}.")
        return f"guess_{self.page}" if place == "guess" else f"answer_{self.page}_{place}"

    def reply(self, given: Any) -> Reply:
        """Return what is said of an answer, with what is added to it."""
        reply = self.asks.reply(given)
        added = self.right if reply.right else self.hint if reply.hinted else ""
        return replace(reply, says=f"{reply.says} {added}".strip())


@cache
def exercises() -> dict[str, Exercise]:
    """Return every exercise of the suite by its name, in the order of the notebooks."""
    found: dict[str, Exercise] = {}
    for path in sorted(ANSWERS.glob("[0-9][0-9].toml")):
        for name, table in tomllib.loads(path.read_text(encoding="utf-8")).items():
            found[name] = _exercise(name, dict(table))
    return found


def _exercise(name: str, table: dict[str, Any]) -> Exercise:
    (key,) = KINDS.keys() & table.keys()
    added = {k: table.pop(k) for k in ("right", "hint", "marks") if k in table}
    if name.endswith(".guess"):
        added["marks"] = 0
    for listed in ("numbers", "names", "hints"):
        if listed in table:
            table[listed] = tuple(table[listed])
    if "slips" in table:
        table["slips"] = tuple(Slip(**slip) for slip in table["slips"])
    if key == "choice":
        table.setdefault("replies", {})
    return Exercise(name, KINDS[key](**table), **added)


def exercise(name: Any) -> Exercise:
    """Return one exercise.

    Raises
    ------
    InputError
        There is none of this name.
    """
    known = exercises()
    if isinstance(name, (int, float)):
        allowed = "must be text: the number of the exercise in quotes"
        raise InputError("exercise", name, allowed, f'Write rb.check("{name}", ...)')
    guess = re.fullmatch(r"guess_?(\d+)", name) if isinstance(name, str) else None
    if guess:
        raise InputError("exercise", name, "is no exercise", f"Did you mean '{guess[1]}.guess'?")
    if not isinstance(name, str) or name not in known:
        raise InputError("exercise", name, "is no exercise", did_you_mean(str(name), known))
    return known[name]
