"""The call below an exercise."""

from __future__ import annotations

import os
from typing import Any

from .answer_tables import exercise
from .replies import Verdict

__all__ = ["WrongAnswer", "check"]


class WrongAnswer(AssertionError):
    """An answer is wrong or missing, and a grading program is reading."""


def check(name: str, given: Any = None) -> Verdict | float:
    """Say of an answer whether it is right, or what kind of wrong it is.

    Nothing is sent anywhere, and the answer is not shown.

    Parameters
    ----------
    name : str
        Number of the exercise, as in its heading: ``"1.2"``.
    given : float, sequence of float, str or callable
        What the exercise asks for: a number, numbers in their order, a letter, or a function.

    Returns
    -------
    Verdict
        Shown by a notebook below the cell. While nbgrader marks or validates, the marks earned, as
        it reads them.

    Raises
    ------
    InputError
        There is no such exercise.
    WrongAnswer
        Only while nbgrader marks or validates: nothing of the answer is right.
    """
    asked = exercise(name)
    verdict = Verdict(name, asked.reply(given))
    if os.environ.get("NBGRADER_EXECUTION") and asked.marks:
        if not verdict.reply.score:
            raise WrongAnswer(str(verdict))
        print(verdict)
        return round(asked.marks * verdict.reply.score, 2)
    return verdict
