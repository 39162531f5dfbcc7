"""Tables of files as types, made from the dataclasses that they become.

What a key may be, its unit, its default and its meaning stand once, at the field of the dataclass
(`railbridge.errors.field_types`, and the "Attributes" of its docstring). From there come here the
checks with the path of the key, the JSON Schema and the pages.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from functools import cache
from typing import Annotated, Any, ClassVar, Union

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    PlainValidator,
    Tag,
    TypeAdapter,
    ValidationError,
    WithJsonSchema,
    create_model,
    model_validator,
)
from pydantic.fields import FieldInfo

from .. import errors
from ..errors import FieldType, InputError, Range, did_you_mean, field_types, joined, written

__all__ = [
    "Key", "Table", "anything", "boolean", "by_key", "by_value", "checked", "fields_of", "key",
    "list_of", "meanings", "measured", "named_numbers", "number", "numbers", "switched", "table",
    "text", "unit_of",
]  # fmt: skip

_TAG = "~"
"""Sets the name of a kind apart from keys where pydantic tells the way to a value."""

Key = tuple[Any, Any]
"""Type and default of a key, as pydantic's ``create_model`` takes them."""


class Table(BaseModel):
    """A table of a file: text keys, none unknown, none missing."""

    model_config = ConfigDict(extra="forbid", arbitrary_types_allowed=True)

    unknown_key: ClassVar[tuple[str, str] | None] = None
    """What is said of a key that is not known, and the remedy; by default the nearest known one."""

    not_a_table: ClassVar[str] = ""
    """The remedy where something else than a table is given."""

    beside: ClassVar[str] = ""
    """Beside what keys of other kinds cannot stand, where no key of its own says it."""

    siblings: ClassVar[Mapping[str, type[Table]]] = {}
    """The other kinds that might stand in its place, by name; see `switched`."""

    @model_validator(mode="before")
    @classmethod
    def _refuse_keys(cls, value: Any) -> Any:
        if not isinstance(value, Mapping) or not all(isinstance(k, str) for k in value):
            raise InputError("", value, "must be a table of named values", cls.not_a_table)
        known = cls.known_keys()
        for given in value:
            if given not in known:
                cls._refuse_of_siblings(given, value)
                allowed, remedy = cls.unknown_key or ("unknown key", did_you_mean(given, known))
                said = value[given] if cls.unknown_key else None
                raise InputError(written(given), said, allowed, remedy)
        for name, f in cls.model_fields.items():
            if f.is_required() and (f.alias or name) not in value:
                missing = f.alias or name
                raise InputError(missing, None, "is missing", f"Add {missing}")
        cls.refuse_mixture(value)
        return value

    @classmethod
    def known_keys(cls) -> list[str]:
        """The keys of such a table."""
        return [f.alias or name for name, f in cls.model_fields.items()]

    @classmethod
    def _refuse_of_siblings(cls, given: str, value: Mapping[str, Any]) -> None:
        """Refuse a key that is one of another kind, and say beside what it cannot stand."""
        owners = {name: kind for name, kind in cls.siblings.items() if given in kind.known_keys()}
        if not owners or cls.unknown_key:
            return
        if "kind" in cls.known_keys():
            if "kind" not in value:
                return
            allowed = f"belongs to kind = {errors.counted([repr(n) for n in owners], 4)}, "
            allowed += f"and this is kind = {value['kind']!r}"
            raise InputError(written(given), value[given], allowed)
        shared = {name for kind in owners.values() for name in kind.known_keys()}
        own = [written(name) for name in value if name in cls.known_keys() and name not in shared]
        beside = cls.beside or (errors.counted(own, 3) if own else "")
        if beside:
            allowed = f"cannot stand beside {beside}"
            raise InputError(written(given), value[given], allowed, "Remove one")

    @classmethod
    def refuse_mixture(cls, given: Mapping[str, Any]) -> None:
        """Refuse keys that do not go together; by default all do."""

    @property
    def given(self) -> dict[str, Any]:
        """The values that were given, by field."""
        return {name: getattr(self, name) for name in type(self).model_fields if self.has(name)}

    def has(self, name: str) -> bool:
        """Whether a key was given."""
        return name in self.model_fields_set


def table(
    title: str,
    about: str,
    /,
    *,
    unknown_key: tuple[str, str] | None = None,
    beside: str = "",
    schema: dict[str, Any] | None = None,
    base: type[Table] = Table,
    **keys: Key,
) -> type[Table]:
    """Return the type of a table.

    Parameters
    ----------
    title : str
    about : str
        What the table says.
    unknown_key : tuple of str, optional
    beside : str
        See `Table`.
    schema : dict, optional
        What the JSON Schema says besides the keys: which of them exclude each other.
    base : type
        With checks of several keys together.
    **keys
        See `key`, `fields_of`.
    """
    made = create_model(title, __base__=base, __doc__=about, **keys)
    made.unknown_key, made.beside = unknown_key, beside
    made.model_config = {**made.model_config, "json_schema_extra": schema or {}}
    made.model_rebuild(force=True)
    return made


# ---- keys


def key(
    kind: Any, about: str, default: Any = None, *, required: bool = False, alias: str | None = None
) -> Key:
    """Return a key of any type with its meaning."""
    shown = {} if default is None else {"default": default}
    extra = {"json_schema_extra": {**shown, "description": about}, "description": about}
    return kind, Field(... if required else default, alias=alias, **extra)


def number(**limits: Any) -> Any:
    """Return the type of a number; see `railbridge.errors.Range`."""
    return _annotated(FieldType("number", Range(**limits)))


def numbers(count: int | None = None, **limits: Any) -> Any:
    """Return the type of a list of numbers."""
    return _annotated(FieldType("numbers", Range(**limits), count))


def text() -> Any:
    """Return the type of a text."""
    return _annotated(FieldType("text"))


def boolean() -> Any:
    """Return the type of true or false."""
    return _annotated(FieldType("boolean"))


def named_numbers(names: tuple[str, ...] | None = None, **limits: Any) -> Any:
    """Return the type of a table of numbers, of any names if none are given."""
    kind = FieldType("number", Range(**limits))

    def check(value: Any) -> dict[str, float]:
        given = errors.table("", value)
        for name in given:
            errors.choice("", name, names or given)
        return {name: kind.checked(written(name), v) for name, v in given.items()}

    schema: dict[str, Any] = {"type": "object", "additionalProperties": _schema(kind)}
    if names is not None:
        properties = dict.fromkeys(names, _schema(kind))
        schema |= {"properties": properties, "additionalProperties": False}
    return Annotated[anything(schema, check), kind]


def anything(schema: dict[str, Any], check: Callable[[Any], Any] = lambda value: value) -> Any:
    """Return the type of a value that a function checks and a JSON Schema describes."""
    return Annotated[Any, PlainValidator(check), WithJsonSchema(schema)]


def list_of(kind: Any, brackets: str) -> Any:
    """Return the type of a list of tables, written with two brackets in TOML."""

    def refuse_single(value: Any) -> Any:
        if not isinstance(value, (list, tuple)):
            remedy = f"Write [[{brackets}]] with two brackets"
            raise InputError("", value, "must be a list of tables", remedy)
        return value

    return Annotated[list[kind], BeforeValidator(refuse_single)]


def switched(choose: Callable[[Any], str], kinds: Mapping[str, Any]) -> Any:
    """Return the type of a value of one of several kinds.

    Parameters
    ----------
    choose : callable
        From the value as given to the name of its kind.
    kinds : mapping
        Types by name. A key of one table that stands in another one is refused by what it cannot
        stand beside.
    """
    tables = {
        name: kind
        for name, kind in kinds.items()
        if isinstance(kind, type) and issubclass(kind, Table)
    }
    for own in tables.values():
        own.siblings = {name: kind for name, kind in tables.items() if kind is not own}
    tagged = tuple(Annotated[kind, Tag(_TAG + name)] for name, kind in kinds.items())
    either = Union[tagged]  # noqa: UP007 - from a tuple
    return Annotated[either, Discriminator(lambda value: _TAG + choose(value))]


def by_key(value: Any, names: tuple[str, ...], otherwise: str) -> str:
    """Return the first of some keys that a table has, for `switched`."""
    here = [name for name in names if isinstance(value, Mapping) and name in value]
    return here[0] if here else otherwise


def by_value(value: Any, name: str, values: tuple[str, ...], otherwise: str) -> str:
    """Return what a table says under a key, if it is one of `values`, for `switched`."""
    said = value.get(name) if isinstance(value, Mapping) else None
    return said if isinstance(said, str) and said in values else otherwise


def _annotated(kind: FieldType) -> Any:
    if kind.kind == "other":
        raise TypeError("a field whose type does not say what a file may hold needs one here")
    return Annotated[anything(_schema(kind), lambda value: kind.checked("", value)), kind]


def measured(kind: Any, unit: str = "") -> Any:
    """Return the type of numbers that a function checks, with the unit they have."""
    return Annotated[kind, FieldType("numbers", Range(unit=unit))]


def unit_of(field: FieldInfo) -> str | None:
    """Return the unit of a table's field, empty of a mere number, None of what is no number."""
    kinds = (note for note in field.metadata if isinstance(note, FieldType))
    return next((kind.range.unit for kind in kinds if kind.kind.startswith("number")), None)


def _schema(kind: FieldType) -> dict[str, Any]:
    """Return the JSON Schema of a field's type."""
    if kind.kind == "text":
        return {"type": "string", "minLength": 1}
    if kind.kind == "boolean":
        return {"type": "boolean"}
    if kind.kind == "choice":
        return {"enum": list(kind.choices)}
    bounds = kind.range
    single: dict[str, Any] = {"type": "integer" if bounds.whole else "number"}
    for name, bound in [
        ("exclusiveMinimum", bounds.above), ("minimum", bounds.least), ("maximum", bounds.most),
    ]:  # fmt: skip
        if bound is not None:
            single[name] = bound
    if kind.kind == "number":
        return single
    if kind.kind == "number or choice":
        return {"anyOf": [single, {"enum": list(kind.choices)}]}
    several = {"type": "array", "items": single}
    if kind.count is not None:
        several |= {"minItems": kind.count, "maxItems": kind.count}
    return several


# ---- from dataclasses


def fields_of(
    kind: type,
    *,
    omit: tuple[str, ...] = (),
    only: tuple[str, ...] | None = None,
    optional: tuple[str, ...] = (),
    required: tuple[str, ...] = (),
    **other: Any,
) -> dict[str, Key]:
    """Return the keys of a table that becomes a dataclass: one for each of its fields.

    Parameters
    ----------
    kind : dataclass
    omit, only : tuple of str
        Fields without a key; fields that have one.
    optional : tuple of str
        Fields without a default that a file may leave out all the same.
    required : tuple of str
        Fields with a default that a file must give all the same.
    **other
        Types of fields whose own type does not say enough for a file.
    """
    said, types, result = meanings(kind), field_types(kind), {}
    for f in fields(kind):
        if f.name in omit or not f.init or (only is not None and f.name not in only):
            continue
        needed = f.default is MISSING and f.default_factory is MISSING
        needed = (needed and f.name not in optional) or f.name in required
        default = None if f.default is MISSING else f.default
        made = other[f.name] if f.name in other else _annotated(types[f.name])
        alias = f.name.rstrip("_") if f.name.endswith("_") else None
        result[f.name] = key(made, said[f.name], default, required=needed, alias=alias)
    return result


@cache
def meanings(kind: type) -> dict[str, str]:
    """Return what the docstring of a dataclass says of each of its fields ("Attributes")."""
    result: dict[str, str] = {}
    for parent in reversed(kind.__mro__):
        doc = inspect.cleandoc(parent.__doc__ or "")
        section = re.search(r"^Attributes\n-+\n(.*?)(?=\n\n\w[^\n]*\n-+\n|\Z)", doc, re.S | re.M)
        if section is None:
            continue
        for entry in re.split(r"\n(?=\S)", section.group(1)):
            head, _, body = entry.partition("\n")
            words = " ".join(line.strip() for line in body.splitlines()).replace("``", "`")
            for name in head.partition(" : ")[0].split(","):
                result[name.strip()] = words
    return result


# ---- checking


def checked(kind: Any, value: Any, path: str = "") -> Any:
    """Return a value as its type, or raise `InputError` with the path of the key that is wrong.

    Parameters
    ----------
    kind : type or TypeAdapter
    value : object
        Tables, lists, texts, numbers and booleans.
    path : str
        Where the value stands.
    """
    adapter = kind if isinstance(kind, TypeAdapter) else TypeAdapter(kind)
    try:
        return adapter.validate_python(value)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
    way = [part for part in first["loc"] if not str(part).startswith(_TAG)]
    for part in way:
        path = joined(path, f"[{part + 1}]" if isinstance(part, int) else part)
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        raise cause.moved(path)
    raise InputError(path, first["input"], first["msg"])
