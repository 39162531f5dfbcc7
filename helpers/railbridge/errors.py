"""Refusals and remarks: what cannot be used, and what a reader should doubt.

Every refusal is one :class:`InputError`, raised before any number is computed, in the words of
whoever called: a function names its own argument. Who knows more of the way there (the table of a
case file, say) puts it in front; see `within`.

What can be used but is unlikely to be meant, or what must be known before a result is read, is a
`Remark`, in one sentence.

A path is written ``train.cars[2].vehicle``; places in lists count from 1, as cars, axles and wheels
do.

What a field of a dataclass may be stands in its type, as in ``speed: Annotated[float,
Range(above=0.0, unit="m/s")]``. `check_fields` holds the dataclass to it, and the tables of case
files are made from the same types.
"""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

__all__ = [
    "FieldType", "InputError", "InputWarning", "ROUNDED", "Range", "Remark", "ResultWarning",
    "boolean", "brief", "check_fields", "choice", "clipped", "counted", "did_you_mean",
    "field_types", "frozen", "instance", "instances", "integer", "is_list", "joined", "keys",
    "number", "numbers", "place", "places", "plain", "printable", "table", "text", "within",
    "written",
]  # fmt: skip


_Kind = TypeVar("_Kind")


class InputError(ValueError):
    """A value that cannot be used: names the field, the value, what is allowed and what to try.

    Parameters
    ----------
    field : str
        Path of the field in the caller's words, for instance ``speed``, or ``run.speed`` in a case.
    value : object
        The offending value; ``None`` where something is missing altogether.
    allowed : str
        What would be accepted.
    remedy : str
        What to try.
    source : str
        The file or the named table that holds the field.
    """

    def __init__(
        self, field: str, value: Any, allowed: str, remedy: str = "", source: str = ""
    ) -> None:
        place = ": ".join(clipped(part, 160) for part in (source, field) if part)
        given = "" if value is None else f" = {_short(value)}"
        advice = f" {remedy}" + "." * (not remedy.endswith("?")) if remedy else ""
        super().__init__(printable(f"{place}{given}: {clipped(allowed, 400)}.{advice}"))
        self.field, self.value, self.allowed, self.remedy = field, value, allowed, remedy
        self.source = source

    def moved(
        self, path: str = "", names: Mapping[str, str] | None = None, source: str = ""
    ) -> InputError:
        """Return the same refusal with the way there put in front; see `within`.

        Nothing stands in front of a file: what names its own is returned as it is.
        """
        if self.source:
            return self
        field = joined(path, _renamed(self.field, names or {}))
        return InputError(field, self.value, self.allowed, self.remedy, source)


class Remark(UserWarning):
    """What a reader should know or doubt, in one sentence; its two kinds are also warned of.

    Parameters
    ----------
    field : str
        Path of the field it is about, in the caller's words; empty if it is about none.
    text : str
        The sentence; after a field it goes on with the field's name.
    """

    warned = False
    """Whether it is also warned of."""

    def __init__(self, field: str, text: str) -> None:
        super().__init__(printable(f"{field} {text}" if field else text))
        self.field, self.text = field, text

    def moved(self, path: str = "", names: Mapping[str, str] | None = None) -> Remark:
        """Return the same remark with the way to its field put in front; see `within`."""
        if not self.field:
            return self
        return type(self)(joined(path, _renamed(self.field, names or {})), self.text)


class InputWarning(Remark):
    """A value that can be used, but is unlikely to be meant."""

    warned = True


class ResultWarning(Remark):
    """What must be known before a result is read."""

    warned = True


def _renamed(field: str, names: Mapping[str, str]) -> str:
    """Return a path with its first part called by another name."""
    head = field.partition(".")[0].partition("[")[0]
    return names.get(head, head) + field[len(head) :]


def joined(path: str, field: str) -> str:
    """Return the path of a field of what stands at `path`; either may be empty."""
    return f"{path}.{field}" if path and field and not field.startswith("[") else path + field


def written(key: str) -> str:
    """Return a key as it is written in a file: one that is empty or holds dots needs quotes."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key)


@contextmanager
def within(
    path: str = "", names: Mapping[str, str] | None = None, source: str = ""
) -> Iterator[None]:
    """Say of any `InputError` raised inside where its field stands.

    Parameters
    ----------
    path : str
        Put in front: ``x`` becomes ``track.vertical.x`` below ``track.vertical``.
    names : mapping, optional
        What the user calls a field that the code inside calls otherwise: {"bearings": "bearing"}.
    source : str
        The file or named table that holds it all. What is refused inside a file is found by that
        file's name: the path, names and source of whoever opened it are not added.
    """
    try:
        yield
    except InputError as error:
        raise error.moved(path, names, source) from None


def _short(value: Any) -> str:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray):
        value = value.tolist()
    try:
        text = repr(value)
    except Exception:  # a whole number of too many digits, or anybody's object
        text = f"<{type(value).__name__}>"
    return text if len(text) <= 60 else text[:57] + "..."


def printable(text: str) -> str:
    r"""Return a text whose control characters are shown, not obeyed: ``\x1b`` for an escape.

    A terminal would obey those in names that come from files.
    """
    if text.isprintable():
        return text
    shown = (c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
    return "".join(shown)


def clipped(text: str, most: int) -> str:
    """Return a text without its middle where it is longer than `most` letters."""
    half = (most - 5) // 2
    return text if len(text) <= most else f"{text[:half]} ... {text[-half:]}"


def brief(thing: Any) -> str:
    """Return a representation of a dataclass that fits into three lines.

    What is long is counted, arrays give their shape, and parts of parts are left out.
    """
    shown = [f for f in fields(thing) if f.repr]
    parts = ", ".join(f"{f.name}={_brief(getattr(thing, f.name))}" for f in shown)
    text = f"{type(thing).__name__}({parts})"
    return text if len(text) <= 240 else text[:235] + " ...)"


def _brief(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"<array {' x '.join(map(str, value.shape))}>"
    if is_dataclass(value) and not isinstance(value, type):
        name = getattr(value, "name", None)
        return type(value).__name__ + (f"({name!r})" if isinstance(name, str) else "(...)")
    if isinstance(value, (list, tuple, Mapping)) and len(value):
        inside = value.items() if isinstance(value, Mapping) else ((None, v) for v in value)
        parts = [("" if k is None else f"{k}: ") + _brief(v) for k, v in list(inside)[:7]]
        text = ", ".join(parts)
        return f"[{text}]" if len(value) <= 6 and len(text) <= 60 else f"<{len(value)} items>"
    return _short(value)


def counted(names: Sequence[str], most: int) -> str:
    """Return ``A, B and C``, or ``A, B, C and 4 more`` where there are more than `most`."""
    shown = [str(name) for name in names]
    if len(shown) > most:
        shown = [*shown[: most - 1], f"{len(shown) - most + 1} more"]
    return " and ".join(part for part in (", ".join(shown[:-1]), shown[-1]) if part)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return ``Did you mean 'x'?`` for the nearest known word, or the list of all known words."""
    known = sorted(known)
    near = difflib.get_close_matches(str(word), known, n=1, cutoff=0.5)
    return f"Did you mean '{near[0]}'?" if near else "Known: " + (", ".join(known) or "none")


# ---- numbers


@dataclass(frozen=True)
class Range:
    """What a number may be: finite, and within bounds.

    Attributes
    ----------
    above, least, most : float or None
        Exclusive lower bound, inclusive lower bound, inclusive upper bound.
    unit : str
    remedy : str
        What to try instead.
    whole : bool
        Whether only whole numbers will do.
    """

    above: float | None = None
    least: float | None = None
    most: float | None = None
    unit: str = ""
    remedy: str = ""
    whole: bool = False

    @property
    def allowed(self) -> str:
        """The range in words."""
        bounds = [("above", self.above), ("at least", self.least), ("at most", self.most)]
        words = " and ".join(f"{word} {bound:.9g}" for word, bound in bounds if bound is not None)
        unit = self.unit if words else self.unit and f"in {self.unit}"
        return " ".join(part for part in ("must be a finite number", words, unit) if part)

    def hold(self, values: np.ndarray) -> bool:
        """Whether all numbers of an array, shape (n,), are within the range."""
        size = np.abs(values)
        small = np.where(size < 1e-30, 0.0, values)
        inside = size <= 1e30
        for bound, holds in (
            (self.above, np.greater), (self.least, np.greater_equal), (self.most, np.less_equal),
        ):  # fmt: skip
            if bound is not None:
                inside &= holds(small, bound)
        return bool(np.all(inside)) and not (self.whole and np.any(small != np.trunc(small)))

    def checked(self, field: str, value: Any) -> float | int:
        """Return `value` as a float (an int if whole) within the range, or raise `InputError`."""
        # Only scalars: text, booleans and lists of one would pass float() too.
        numeric = isinstance(value, (int, float, np.integer, np.floating))
        try:
            result = float(value) if numeric and not isinstance(value, bool) else np.nan
        except OverflowError:
            result = np.nan
        if abs(result) < 1e-30:  # products of such numbers underflow, those beyond 1e30 overflow
            result = 0.0
        inside = (
            abs(result) <= 1e30
            and (self.above is None or result > self.above)
            and (self.least is None or result >= self.least)
            and (self.most is None or result <= self.most)
        )
        if not inside:
            raise InputError(field, value, self.allowed, self.remedy)
        if self.whole and result != int(result):
            raise InputError(field, value, "must be a whole number", self.remedy)
        return int(result) if self.whole else result


def number(field: str, value: Any, **limits: Any) -> float:
    """Return `value` as a finite float within limits (see `Range`), or raise `InputError`."""
    return Range(**limits).checked(field, value)


def integer(field: str, value: Any, *, least: int = 0, **limits: Any) -> int:
    """Return `value` as an int within limits (see `Range`), or raise `InputError`."""
    return Range(least=least, whole=True, **limits).checked(field, value)


def numbers(field: str, values: Any, *, count: int | None = None, **limits: Any) -> np.ndarray:
    """Return `values` as a 1-D float array, each within limits, or raise `InputError`."""
    if not is_list(values):
        length = f" of length {count}" if count else ""
        raise InputError(field, values, f"must be a list of numbers{length}")
    bounds = Range(**limits)
    plain = isinstance(values, np.ndarray) and values.ndim == 1 and values.dtype.kind in "iuf"
    if plain and bounds.hold(values):
        result = np.where(np.abs(values) < 1e-30, 0.0, values).astype(float)
        if count in (None, len(result)):
            return result
    result = [bounds.checked(f"{field}[{i}]", v) for i, v in enumerate(values, start=1)]
    if count is not None and len(result) != count:
        raise InputError(field, values, f"must hold {count} numbers, it holds {len(result)}")
    return np.array(result, dtype=float)


ROUNDED = 1e-6
"""Share of a length by which a place may miss an end where people or programs round: 99.9999."""


def place(
    field: str, value: Any, ends: Sequence[float], *, slack: float = 1e-9, remedy: str = ""
) -> float:
    """Return a place between the first and the last of some ends, or raise `InputError`.

    A place that misses an end by rounding only is that end: 12.1 + 12.2 + 12.3 is not 36.6.

    Parameters
    ----------
    field : str
    value : float
        m.
    ends : sequence of float
        m, ascending; those between the first and the last attract places likewise.
    slack : float
        Share of the whole length (of a metre where that is shorter) that is rounding.
    remedy : str
    """
    value = number(field, value, unit="m", remedy=remedy)
    least, most = float(ends[0]), float(ends[-1])
    nearest = float(min(ends, key=lambda end: abs(end - value)))
    if abs(value - nearest) <= slack * max(most - least, 1.0):
        return nearest
    return number(field, value, least=least, most=most, unit="m", remedy=remedy)


def places(
    field: str, values: Any, ends: Sequence[float], *, slack: float = 1e-9, remedy: str = ""
) -> np.ndarray:
    """Return several places as a 1-D array, m; see `place`."""
    given = numbers(field, values, unit="m").tolist()
    named = ((f"{field}[{i}]", value) for i, value in enumerate(given, start=1))
    return np.array([place(*each, ends, slack=slack, remedy=remedy) for each in named])


# ---- other kinds of values


def is_list(value: Any) -> bool:
    """Whether a value lists others: no text, no mapping, and no array of one number."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable):
        return False
    return not isinstance(value, np.ndarray) or value.ndim > 0


def instance(field: str, value: Any, kind: type[_Kind]) -> _Kind:
    """Return `value` if it is of a kind (``Vehicle``, ``Deck``), or raise `InputError`."""
    if not isinstance(value, kind):
        raise InputError(field, value, f"must be a {kind.__name__}")
    return value


def instances(field: str, values: Any, kind: type[_Kind]) -> tuple[_Kind, ...]:
    """Return a list of objects of one kind as a tuple, or raise `InputError`."""
    if not is_list(values):
        raise InputError(field, values, f"must be a list of {kind.__name__} objects")
    return tuple(instance(f"{field}[{i}]", v, kind) for i, v in enumerate(values, start=1))


def boolean(field: str, value: Any) -> bool:
    """Return `value` if it is true or false, or raise `InputError`."""
    if not isinstance(value, bool):
        raise InputError(field, value, "must be true or false")
    return value


def text(field: str, value: Any) -> str:
    """Return `value` if it is non-empty text, or raise `InputError`."""
    if not isinstance(value, str) or not value.strip():
        raise InputError(field, value, "must be a text between quotes")
    return value


def choice(field: str, value: Any, allowed: Iterable[str]) -> str:
    """Return `value` if it is one of `allowed`, or raise `InputError` that suggests the nearest."""
    allowed = list(allowed)
    if not isinstance(value, str) or value not in allowed:
        near = did_you_mean(value, allowed).rstrip(".")
        raise InputError(field, value, "must be one of " + ", ".join(allowed), near)
    return value


def table(field: str, value: Any) -> dict[str, Any]:
    """Return `value` if it is a table (a mapping with text keys), or raise `InputError`."""
    if not isinstance(value, Mapping) or not all(isinstance(k, str) for k in value):
        raise InputError(field, value, "must be a table of named values")
    return dict(value)


def keys(
    field: str, given: Mapping[str, Any], allowed: Iterable[str], required: Iterable[str] = ()
) -> None:
    """Refuse unknown keys of a table, with the nearest known one, and missing required keys."""
    allowed = [*allowed, *(k for k in required if k not in allowed)]
    for key in given:
        if key not in allowed:
            name = joined(field, written(key))
            raise InputError(name, None, "unknown key", did_you_mean(key, allowed))
    for key in required:
        if key not in given:
            remedy = f"Add {key} to {field or 'the file'}"
            raise InputError(joined(field, key), None, "is missing", remedy)


def plain(field: str, value: Any, depth: int = 0) -> Any:
    """Return a copy made of tables, lists, texts, numbers and booleans only.

    NumPy's numbers and arrays become Python's.
    """
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, (str, bool, int, float)):
        return value
    if depth < 20:
        if isinstance(value, Mapping):
            named = table(field, value).items()
            return {k: plain(joined(field, written(k)), v, depth + 1) for k, v in named}
        if isinstance(value, (list, tuple)):
            return [plain(f"{field}[{i}]", v, depth + 1) for i, v in enumerate(value, start=1)]
    allowed = "must be a number, a text, true or false, or a list or table of them"
    raise InputError(field, value, allowed)


def frozen(array: np.ndarray) -> np.ndarray:
    """Return the same array, read-only from now on: it is kept and handed out again."""
    array.setflags(write=False)
    return array


# ---- fields of dataclasses


@dataclass(frozen=True)
class FieldType:
    """What a field of a dataclass may be, read from its type.

    Attributes
    ----------
    kind : {"number", "numbers", "choice", "number or choice", "boolean", "text", "other"}
    range : Range
        Of a number, or of each of several.
    count : int or None
        Of numbers; None for any.
    choices : tuple of str
    optional : bool
        Whether None will do.
    """

    kind: str
    range: Range = Range()
    count: int | None = None
    choices: tuple[str, ...] = ()
    optional: bool = False

    def checked(self, field: str, value: Any) -> Any:
        """Return the value as the dataclass keeps it, or raise `InputError`."""
        if (value is None and self.optional) or self.kind == "other":
            return value
        if self.kind == "number" or (
            self.kind == "number or choice" and not isinstance(value, str)
        ):
            return self.range.checked(field, value)
        if self.kind == "numbers":
            found = numbers(field, value, count=self.count, **vars(self.range))
            return tuple(found.tolist())
        if self.choices:
            return choice(field, value, self.choices)
        return (boolean if self.kind == "boolean" else text)(field, value)


@cache
def field_types(kind: type) -> dict[str, FieldType]:
    """Return what each field of a dataclass may be.

    Understood are ``Annotated[float, Range(...)]``, ``Annotated[tuple[float, ...], Range(...)]``
    (or ``tuple[float, float]`` for two), ``Literal["a", "b"]``, ``bool``, ``str``, and ``| None``
    of each; what is none of these is left alone.
    """
    hints = get_type_hints(kind, include_extras=True)
    return {f.name: _field_type(hints[f.name]) for f in fields(kind)}


def _field_type(hint: Any) -> FieldType:
    optional = False
    if get_origin(hint) in (Union, UnionType):
        parts = [part for part in get_args(hint) if part is not NoneType]
        optional = len(parts) < len(get_args(hint))
        kinds = sorted((_field_type(part) for part in parts), key=lambda k: k.kind, reverse=True)
        if [k.kind for k in kinds] == ["number", "choice"]:
            range_, choices = kinds[0].range, kinds[1].choices
            return FieldType("number or choice", range_, choices=choices, optional=optional)
        if len(parts) > 1:
            return FieldType("other", optional=optional)
        hint = parts[0]
    if get_origin(hint) is Annotated:
        inner, *notes = get_args(hint)
        bounds = next((note for note in notes if isinstance(note, Range)), None)
        if bounds is not None:
            inside = get_args(inner)
            several = get_origin(inner) is tuple or inner is np.ndarray
            count = len(inside) if inside and inside[-1] is not Ellipsis else None
            kind = "numbers" if several else "number"
            return FieldType(kind, bounds, count, optional=optional)
    if get_origin(hint) is Literal:
        return FieldType("choice", choices=get_args(hint), optional=optional)
    return FieldType({bool: "boolean", str: "text"}.get(hint, "other"), optional=optional)


def check_fields(thing: Any) -> None:
    """Hold a dataclass to the types of its fields, numbers as floats; for its ``__post_init__``.

    Raises
    ------
    InputError
        Naming the field.
    """
    for name, kind in field_types(type(thing)).items():
        object.__setattr__(thing, name, kind.checked(name, getattr(thing, name)))
