"""What is said of an answer: right, or what kind of wrong, and never the answer itself.

A number may have the right digits and still be wrong, by a sign, by a power of ten, or by the
factor between two units. `number_reply` tells these apart from being too high or too low, since
that is what a learner can act on.
"""

from __future__ import annotations

import html
from dataclasses import dataclass
from typing import Any

import numpy as np

__all__ = ["Reply", "Verdict", "UNANSWERED", "list_reply", "number_reply"]

UNITS = (
    (2 * np.pi, "2 pi times off: is it rad/s where Hz is asked, or the other way round?"),
    (3.6, "3.6 times off: is a speed in km/h where m/s belongs, or the other way round?"),
    (9.81, "9.81 times off: is it a mass where a force is asked, or the other way round?"),
    (180 / np.pi, "57.3 times off: is it in degrees where radians are asked, or the other way?"),
    (np.sqrt(1e3), "the root of 1000 off: kN/m where N/m belongs, or t where kg belongs?"),
)
"""What a unit may be off by, and the question to ask."""

TWICE = (
    (2.0, "exactly twice or half of it: a factor of two is lost, or used twice."),
    (np.sqrt(2.0), "the root of two off: a factor of two is lost, or used twice, under a root."),
)
"""As `UNITS`, for what is a matter of the physics as often as a slip: a hint helps too."""

FOUR_DIGITS = 1e-3
"""An answer that must be nearer than this needs four digits; three do for others."""

ROUNDED = 0.03
"""How far off a number may be that is called rounded; farther off it is wrong."""


@dataclass(frozen=True)
class Reply:
    """What is said of one answer.

    Attributes
    ----------
    score : float
        Share of it that is right, 0 to 1.
    says : str
        A sentence or two; does not contain the answer.
    given : bool
        Whether there is an answer at all.
    hinted : bool
        Whether a hint on the matter helps: not after a slip of sign, unit or typing.
    """

    score: float
    says: str
    given: bool = True
    hinted: bool = False

    @property
    def right(self) -> bool:
        """Whether all of it is right."""
        return self.score == 1.0


UNANSWERED = Reply(0.0, "no answer yet. Put yours in place of the three dots.", given=False)


@dataclass(frozen=True)
class Verdict:
    """The reply to one exercise, as a notebook shows it.

    Attributes
    ----------
    exercise : str
        Number of the exercise, such as ``1.2``.
    reply : Reply
    """

    exercise: str
    reply: Reply

    @property
    def right(self) -> bool:
        """Whether all of it is right."""
        return self.reply.right

    @property
    def title(self) -> str:
        """What it is about: ``Exercise 1.2``, ``Guess 1``."""
        number, _, place = self.exercise.partition(".")
        return f"Guess {number}" if place == "guess" else f"Exercise {self.exercise}"

    def __repr__(self) -> str:
        return f"{self.title}: {self.reply.says}"

    def _repr_html_(self) -> str:
        kind = "right" if self.right else "wrong" if self.reply.given else "open"
        mark = {"right": "\N{CHECK MARK}", "wrong": "\N{MULTIPLICATION SIGN}", "open": "?"}[kind]
        # Colours that keep their contrast on a light and on a dark page.
        colour = {"right": "#1a8f4c", "wrong": "#c8601a", "open": "#7a7f87"}[kind]
        style = f"border-left: 5px solid {colour}; padding: 0.3em 0.8em; margin: 0.2em 0"
        head = f'<b style="color: {colour}">{mark}</b> <b>{self.title}</b>'
        return (
            f'<div class="rb-verdict" style="{style}">{head}: {html.escape(self.reply.says)}</div>'
        )


def is_open(given: Any) -> bool:
    """Whether nothing was put in place of the dots yet."""
    return given is None or given is Ellipsis


def number_reply(
    given: Any,
    expected: float,
    *,
    within: float = 5e-3,
    near: float = 0.0,
    unit: str = "",
    count: bool = False,
    component: bool = False,
) -> Reply:
    """Return the reply to a number.

    Parameters
    ----------
    given : object
        What the learner has put there.
    expected : float
    within : float
        Relative deviation that still is right.
    near : float
        Absolute deviation that still is right, in `unit`; for an answer of zero.
    unit : str
        The unit that is asked for.
    count : bool
        Whether it counts things: then no factor between units explains it.
    component : bool
        Whether it points along an axis: then its sign is part of it.
    """
    if is_open(given):
        return UNANSWERED
    value, fault = _as_number(given)
    if fault:
        return Reply(0.0, fault)
    slack = max(abs(expected) * within, near)
    if abs(value - expected) <= slack:
        return Reply(1.0, "right.")
    if expected == 0.0:
        return Reply(0.0, f"not right: its size is too large{_asked(unit)}.", hinted=True)
    ratio, about = value / expected, max(within, 2e-3)
    if abs(ratio + 1.0) <= about or abs(value + expected) <= slack:
        amount = ", or is it an amount, which has none" if expected > 0 and not component else ""
        asked = f"the size is right, the sign is not. Which way counts as positive{amount}?"
        return Reply(0.0, asked)
    if value == 0.0:
        return Reply(0.0, "it is not zero.", hinted=True)
    sign = "" if ratio > 0 else "the sign is wrong, and "
    if not count and (slip := _power_slip(abs(ratio), about, unit) or _asks(UNITS, ratio, about)):
        return Reply(0.0, sign + slip)
    if not count and (slip := _asks(TWICE, ratio, about)):
        return Reply(0.0, sign + slip, hinted=True)
    digits = 4 if within < FOUR_DIGITS else 3
    if not count and _is_rounded(value, expected, digits):
        asked = {3: "three", 4: "four"}[digits]
        return Reply(0.0, f"close, but rounded too much: give {asked} digits.")
    off = _too_much(abs(ratio), expected > 0 and ratio > 0)
    return Reply(0.0, f"{sign}{off}{_asked(unit)}.", hinted=True)


def _is_rounded(value: float, expected: float, digits: int) -> bool:
    """Whether a number is the right one with fewer than `digits` digits.

    One is not: who gives it for a ratio says that there is no difference.
    """
    near = value != 1.0 and abs(value / expected - 1.0) <= ROUNDED
    return near and any(value == float(f"{expected:.{few}g}") for few in range(1, digits))


def _power_slip(ratio: float, about: float, unit: str) -> str:
    """Return what is said of a size that is off by a power of ten, or nothing."""
    power = round(np.log10(ratio))
    if not power or abs(ratio / 10.0**power - 1.0) > about:
        return ""
    asked = "; look at its unit" if unit in ("", "-") else f"; asked: {unit}"
    return f"the digits are right, but a power of ten is not{asked}."


def _asks(factors: tuple[tuple[float, str], ...], ratio: float, about: float) -> str:
    """Return the question that belongs to a size `ratio` times the right one, or nothing."""
    for factor, question in factors:
        if min(abs(abs(ratio) / factor - 1.0), abs(abs(ratio) * factor - 1.0)) <= about:
            return question
    return ""


def _too_much(ratio: float, positive: bool) -> str:
    far = "far " if not 0.5 < ratio < 2.0 else "a little " if 0.95 < ratio < 1.05 else ""
    if positive:
        return f"{far}too {'high' if ratio > 1.0 else 'low'}"
    return f"its size is {far}too {'large' if ratio > 1.0 else 'small'}"


def _asked(unit: str) -> str:
    return f" (asked: {unit})" if unit not in ("", "-") else ""


def _as_number(given: Any) -> tuple[float, str]:
    """Return a number and nothing, or anything and why it is none."""
    if isinstance(given, str):
        point = ", with a point before the decimals" if "," in given else ""
        return np.nan, f"this is text: write the number without quotes{point}."
    if isinstance(given, tuple) and len(given) == 2:
        return np.nan, "these are two numbers: write 12.5 with a point, not with a comma."
    if isinstance(given, bool) or callable(given):
        return np.nan, f"one number is asked for, this is {_kind(given)}."
    try:
        values = np.asarray(given, dtype=complex).ravel()
    except (TypeError, ValueError, OverflowError):
        return np.nan, f"one number is asked for, this is {_kind(given)}."
    if values.size != 1:
        return np.nan, f"one number is asked for, these are {values.size}."
    if values[0].imag:
        return np.nan, "this number is complex: is its size asked for, or its real part?"
    value = float(values[0].real)
    if not np.isfinite(value):
        return np.nan, "this number is not finite: something was divided by zero, or left empty."
    return value, ""


def _kind(given: Any) -> str:
    if isinstance(given, bool):
        return "True or False"
    return "a function: call it" if callable(given) else f"a {type(given).__name__}"


def list_reply(
    given: Any,
    expected: tuple[float, ...],
    names: tuple[str, ...] = (),
    *,
    within: float = 5e-3,
    near: float = 0.0,
    unit: str = "",
    count: bool = False,
    hints: tuple[str, ...] = (),
) -> Reply:
    """Return the reply to several numbers; its score is the share of them that are right.

    Parameters
    ----------
    given : object
        A list, tuple or array, in the order asked for.
    expected : tuple of float
    names : tuple of str
        What each of them is; "number 2" where there is no name.
    within, near, unit, count
        As for `number_reply`.
    hints : tuple of str
        Said of each wrong number that a hint on the matter helps.
    """
    if is_open(given):
        return UNANSWERED
    if isinstance(given, (str, dict, set)) or callable(given) or not hasattr(given, "__iter__"):
        return Reply(0.0, f"{len(expected)} numbers are asked for, in a list: [ ... , ... ].")
    values = list(np.asarray(given).ravel()) if isinstance(given, np.ndarray) else list(given)
    if all(is_open(value) for value in values):
        return UNANSWERED
    if len(values) != len(expected):
        return Reply(0.0, f"{len(expected)} numbers are asked for, these are {len(values)}.")
    options = {"within": within, "near": near, "unit": unit, "count": count}
    replies = [number_reply(v, e, **options) for v, e in zip(values, expected, strict=True)]
    good = sum(reply.right for reply in replies)
    if good == len(replies):
        return Reply(1.0, "right.")
    called = names or tuple(f"number {i}" for i in range(1, len(expected) + 1))
    if _is_another_order(values, expected, options):
        order = ", ".join(called) if names else "that of the question"
        return Reply(0.0, f"the numbers are right, but their order is not. Asked: {order}.")
    parts = zip(called, replies, hints or ("",) * len(called), strict=True)
    wrong = [
        f"{name}: {reply.says} {hint * reply.hinted}".strip()
        for name, reply, hint in parts
        if not reply.right
    ]
    says = f"{good} of {len(replies)} right. " + " ".join(wrong)
    return Reply(good / len(replies), says, hinted=any(reply.hinted for reply in replies))


def _is_another_order(values: list[Any], expected: tuple[float, ...], options: dict) -> bool:
    """Whether each right number is there, at another place."""
    left = list(values)
    for right in expected:
        found = [i for i, value in enumerate(left) if number_reply(value, right, **options).right]
        if not found:
            return False
        del left[found[0]]
    return True
