"""What a computation depends on, as a short text: equal contents give equal fingerprints.

A study recognises what it has computed already by this, not by names of files or by places in a
table.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from types import FunctionType
from typing import TYPE_CHECKING, Any

import numpy as np

from .extras import program_version

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..decks import Deck
    from .engine import Asked

__all__ = ["fingerprint", "print_of_crossing", "print_of_deck"]


def fingerprint(*contents: Any) -> str:
    """Return 32 hexadecimal digits that depend on every number and text of what is given.

    Numbers, texts, None, sequences, mappings, arrays and dataclasses of these are understood;
    20 and 20.0 are the same.

    Raises
    ------
    TypeError
        Anything else.
    """
    digest = hashlib.blake2b(digest_size=16)
    for content in contents:
        for part in _parts(content):
            digest.update(part)
    return digest.hexdigest()


def print_of_deck(deck: Deck, asked: Asked) -> str:
    """Return the fingerprint of a deck as far as it decides what is asked of it.

    How outputs follow from the deck's state counts for the outputs that are asked for: a deck keeps
    what it has worked out, and that must not make another one of it.
    """
    own = {f.name: getattr(deck, f.name) for f in fields(deck) if f.name not in _OF_PEOPLE}
    outputs = [(o.quantity, o.x, o.modal, o.line) for o in asked.outputs]
    more = {name: take if is_dataclass(take) else name for name, take in asked.more.items()}
    return fingerprint(own, outputs, asked.numbers, more)


def print_of_crossing(deck: str, train: str, track: str, settings: Any) -> str:
    """Return the fingerprint of a crossing from those of its deck, train and track.

    Another version of the program is another crossing.
    """
    return fingerprint(_program(), deck, train, track, settings)


_program = cache(program_version)

_PACKAGE = __name__.partition(".")[0] + "."
_OF_PEOPLE = ("name", "recovery", "remarks", "mode_names", "tracks")


def _parts(content: Any) -> Iterator[bytes]:
    if content is None or isinstance(content, (bool, str)):
        text = str(content).encode()
        yield f"{type(content).__name__}:{len(text)}:".encode() + text
    elif isinstance(content, np.bool_):
        yield from _parts(bool(content))
    elif isinstance(content, (int, float, np.number)):
        yield f"number:{float(content)!r};".encode()
    elif isinstance(content, np.ndarray):
        array = np.ascontiguousarray(content, dtype=complex if content.dtype.kind == "c" else float)
        yield f"array:{array.shape};".encode()
        yield array.tobytes()
    elif isinstance(content, Mapping):
        yield b"{"
        for key in sorted(content, key=str):
            yield from _parts(str(key))
            yield from _parts(content[key])
        yield b"}"
    elif isinstance(content, (list, tuple)):
        yield b"["
        for part in content:
            yield from _parts(part)
        yield b"]"
    elif is_dataclass(content):
        yield f"{type(content).__qualname__}(".encode()
        for own in fields(content):
            if not own.compare:  # names that people read
                continue
            yield f"{own.name}:".encode()
            yield from _parts(getattr(content, own.name))
        yield b")"
    elif isinstance(content, FunctionType) and content.__module__.startswith(_PACKAGE):
        # of the suite's own: the program's version says what they do
        yield from _parts(f"{content.__module__}.{content.__qualname__}")
    else:
        raise TypeError(f"no fingerprint of a {type(content).__qualname__}")
