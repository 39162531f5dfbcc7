"""A drawing of lines and words as SVG: what the diagrams are made of.

The ground is transparent. Three colours, each with nearly the same contrast on white and on
JupyterLab's dark ground: grey for what is there, blue for what moves, orange for what pushes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from html import escape

import numpy as np

__all__ = ["GREY", "MOVES", "PUSHES", "Drawing", "attributes", "element", "points_text"]

GREY, MOVES, PUSHES = "#737b85", "#3f83c8", "#c4741c"
SIZE = 16  # px, of words
HEAD = 9.0  # px, length of an arrow's head
Point = tuple[float, float]


class Drawing:
    """A picture that grows by calls; x to the right, y *down*, in px.

    Parameters
    ----------
    width, height : float
    words : str
        What is to be seen, for those who do not see it.
    """

    def __init__(self, width: float, height: float, words: str) -> None:
        self.width, self.height, self.words = width, height, words
        self.parts: list[str] = []

    def svg(self) -> str:
        """Return the whole file."""
        head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width:g} {self.height:g}" '
            f'width="{self.width:g}" height="{self.height:g}" role="img" font-size="{SIZE}" '
            'font-family="Helvetica, Arial, sans-serif" fill="none" stroke-linecap="round">'
        )
        return "\n".join([head, f"<title>{escape(self.words)}</title>", *self.parts, "</svg>"])

    def line(
        self, *points: Point, colour: str = GREY, width: float = 1.6, dashed: bool = False
    ) -> None:
        """Draw a line through points."""
        look = {"stroke": colour, "stroke-width": width}
        if dashed:
            look["stroke-dasharray"] = "5 5"
        self.parts.append(element("polyline", points=points_text(points), **look))

    def box(self, x: float, y: float, width: float, height: float, colour: str = GREY) -> None:
        """Draw a rectangle with its upper left corner at x, y."""
        look = {**_outline(colour), "fill": colour, "fill-opacity": "0.10"}
        self.parts.append(element("rect", x=x, y=y, width=width, height=height, rx=3, **look))

    def circle(self, x: float, y: float, radius: float, colour: str = GREY) -> None:
        """Draw a circle."""
        self.parts.append(element("circle", cx=x, cy=y, r=radius, **_outline(colour)))

    def dot(self, x: float, y: float, colour: str = GREY) -> None:
        """Mark a point."""
        self.parts.append(element("circle", cx=x, cy=y, r=3.5, fill=colour))

    def arrow(self, start: Point, end: Point, colour: str = GREY, width: float = 1.8) -> None:
        """Draw a line with a head at its end."""
        self.line(start, end, colour=colour, width=width)
        self._head(start, end, colour)

    def turn(self, x: float, y: float, radius: float, colour: str = PUSHES) -> None:
        """Draw a couple or a twist, right-handed about an axis that points into the page."""
        r = radius
        arc = f"M {x - r:g} {y:g} A {r:g} {r:g} 0 1 1 {x:g} {y + r:g}"
        self.parts.append(element("path", d=arc, **_outline(colour)))
        self._head((x + 6, y + r - 2), (x - 3, y + r), colour)

    def spring(self, x: float, top: float, bottom: float, half: float = 6.0) -> None:
        """Draw a spring that stands upright."""
        ends = (bottom - top) * 0.16
        step = (bottom - top - 2 * ends) / 6
        zig = [(x + half * (-1) ** i, top + ends + step * (i + 0.5)) for i in range(6)]
        self.line((x, top), (x, top + ends), *zig, (x, bottom - ends), (x, bottom))

    def damper(self, x: float, top: float, bottom: float, half: float = 6.0) -> None:
        """Draw a damper that stands upright."""
        middle = (top + bottom) / 2
        self.line((x, top), (x, middle - 2))
        self.line((x - half + 2, middle - 2), (x + half - 2, middle - 2))
        cup = [(x - half, middle - 8), (x - half, middle + 5), (x + half, middle + 5)]
        self.line(*cup, (x + half, middle - 8))
        self.line((x, middle + 5), (x, bottom))

    def measure(self, start: Point, end: Point, words: str, side: float = -7.0) -> None:
        """Draw a dimension between two points, with its words beside the middle.

        `side` is how far the words stand from a level line, or to the right of an upright one.
        """
        self.arrow(start, end, width=1.0)
        self._head(end, start, GREY)
        x, y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
        if abs(end[0] - start[0]) > abs(end[1] - start[1]):
            self.text(x, y + side + (SIZE * 0.75 if side > 0 else 0.0), words, anchor="middle")
        else:
            self.text(x + abs(side), y + SIZE / 3, words)

    def text(
        self, x: float, y: float, words: str, colour: str = GREY, anchor: str = "start"
    ) -> None:
        """Write words from a point on; ``k_s`` is italic with a subscript, as ``2 l_x`` is."""
        place = attributes({"x": x, "y": y, "fill": colour, "text-anchor": anchor})
        self.parts.append(f"<text {place}>{_spans(words)}</text>")

    def wheel_set(self, x: float, rail: float, radius: float = 11.0) -> None:
        """Draw a wheel that stands on a rail."""
        self.circle(x, rail - radius, radius)
        self.dot(x, rail - radius)

    def ground(self, points: Sequence[Point], colour: str = GREY) -> None:
        """Draw the upper edge of something firm."""
        self.line(*points, colour=colour, width=2.2)

    def _head(self, start: Point, end: Point, colour: str) -> None:
        dx, dy = end[0] - start[0], end[1] - start[1]
        long = (dx * dx + dy * dy) ** 0.5 or 1.0
        ux, uy = dx / long, dy / long
        back = (end[0] - HEAD * ux, end[1] - HEAD * uy)
        wing = HEAD * 0.38
        corners = [end, (back[0] - wing * uy, back[1] + wing * ux)]
        corners.append((back[0] + wing * uy, back[1] - wing * ux))
        self.parts.append(element("polygon", points=points_text(corners), fill=colour))


SYMBOL = re.compile(r"([A-Za-z\u03b1-\u03c9\u0394~]{1,2})_(\w+)|\*(\w+)\*")


def _outline(colour: str) -> dict[str, str]:
    return {"stroke": colour, "stroke-width": "1.8"}


def _spans(words: str) -> str:
    """Return words with symbols in italics: ``k_s`` with its subscript, ``*V*`` without one."""

    def written(found: re.Match) -> str:
        base, below, alone = found.groups()
        if alone:
            return f'<tspan font-style="italic">{alone}</tspan>'
        back = '<tspan dy="-4">\u200b</tspan>'  # an empty letter: what follows stands level again
        small = f'<tspan dy="4" font-size="{SIZE * 0.72:g}">{below}</tspan>{back}'
        return f'<tspan font-style="italic">{base}</tspan>{small}'

    return SYMBOL.sub(written, escape(words, quote=False))


# ---- elements, of diagrams and of moving pictures


def attributes(given: Mapping) -> str:
    """Return the attributes of an element as SVG has them, numbers with six digits."""
    texts = {
        name: f"{value:.6g}" if isinstance(value, (float, np.floating)) else str(value)
        for name, value in given.items()
    }
    return " ".join(f'{name}="{escape(text)}"' for name, text in texts.items())


def element(name: str, **given) -> str:
    """Return an element by its SVG name and attributes."""
    return f"<{name} {attributes(given)}/>"


def points_text(points: Iterable) -> str:
    """Return the corners of a line, pairs of px, as SVG has them."""
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
