"""Diagrams that stand at the head of a notebook: drawn lines and words, no results.

They are SVG on a transparent ground, in colours that keep their contrast on a light and on a dark
page.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .. import errors

__all__ = ["DIAGRAMS", "Diagram", "diagram"]

LINE = "#7a828c"
"""Drawn lines and words: 4 to 1 or better on white and on JupyterLab's dark ground."""


@dataclass(frozen=True)
class Diagram:
    """A drawing, shown by a notebook.

    Attributes
    ----------
    name : str
    svg : str
        The whole drawing.
    """

    name: str
    svg: str

    def __repr__(self) -> str:
        return f"Diagram: {self.name}"

    def _repr_svg_(self) -> str:
        return self.svg


def diagram(name: str) -> Diagram:
    """Return a diagram by its name, one of `DIAGRAMS`.

    Raises
    ------
    InputError
        There is none of this name.
    """
    name = errors.choice("name", name, DIAGRAMS)
    return Diagram(name, DIAGRAMS[name]())


def _titled(title: str) -> str:
    text = f'<text x="20" y="30" fill="{LINE}" font-family="sans-serif">{title}</text>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 900 60">{text}</svg>'


DIAGRAMS: dict[str, Callable[[], str]] = {
    "vehicle": lambda: _titled("car body, two bogies, springs and wheels, with their dimensions"),
    "track": lambda: _titled("wheels behind one another over a wave; a wheel with a notch"),
    "forces": lambda: _titled("wheel forces on the deck and their resultant"),
    "deck": lambda: _titled("the deck from the side, from above and in section"),
    "response": lambda: _titled("a train on the deck, and what is asked of it"),
    "loop": lambda: _titled("deck, equivalent irregularity, train, forces, and round again"),
    "condensed": lambda: _titled("four axles, two forces, one force"),
    "exchange": lambda: _titled("nodes and modes in, loads out, motions back"),
}
"""The diagrams by name."""
