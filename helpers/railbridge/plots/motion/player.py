"""A moving picture in a page: a vector drawing, the numbers that move it, and a short player.

An `Animation` is a piece of HTML. It needs no program, no network and no server, is some tens of
kilobytes, and starts paused. Where scripts are not run (an untrusted notebook, a page on a forge)
its first picture stands still. With reduced motion asked for, the player steps instead of playing.
"""

from __future__ import annotations

import hashlib
import json
from base64 import b64encode
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from pathlib import Path

import numpy as np

from ...errors import InputError
from ..svg import attributes, element, points_text

__all__ = [
    "FEWEST", "INK", "MOST", "WIDTH", "Animation", "Drawing", "attributes", "element",
    "pace_in_words", "page", "points_text", "rounded", "script",
]  # fmt: skip

WIDTH = 900  # px, as the other figures
INK = "#222222"
FEWEST, MOST = 4, 600
"""Frames of an animation."""


@dataclass(frozen=True)
class Animation:
    """A moving picture that a notebook shows and plays; paused at first.

    Attributes
    ----------
    title : str
        What is shown, with its number of frames.
    frames : int
        Positions of the slider.
    html : str
        The picture, its numbers and its player; stands alone in any page.
    """

    title: str
    frames: int
    html: str

    def __repr__(self) -> str:
        return f"Animation: {self.title}, {self.frames} frames"

    def _repr_html_(self) -> str:
        return self.html

    def save(self, path: str | Path) -> None:
        """Write a page of its own, for projecting or sending; `path` ends in ``.html``.

        Raises
        ------
        InputError
            Another ending.
        """
        if Path(path).suffix != ".html":
            raise InputError("path", str(path), "must end in .html")
        head = f'<meta charset="utf-8">\n<title>{escape(self.title)}</title>\n'
        text = f'<!doctype html>\n<html lang="en">\n{head}{self.html}\n</html>\n'
        Path(path).write_text(text, encoding="utf-8")


class Drawing:
    """A vector drawing as wide as the other figures.

    Attributes
    ----------
    height : float
        px.
    items : list of str
        Its elements, the last on top.
    """

    def __init__(self, height: float) -> None:
        self.height, self.items = height, []

    def add(self, name: str, **given) -> None:
        """Add an element by its SVG name and attributes."""
        self.items.append(element(name, **given))

    def write(self, x: float, y: float, text: str, anchor: str = "start", size: int = 12) -> None:
        """Add a line of text at x, y (px)."""
        font = {"fill": INK, "font-size": size, "text-anchor": anchor}
        place = {"x": float(x), "y": float(y)}
        self.items.append(f"<text {attributes({**place, **font})}>{escape(text)}</text>")

    def svg(self) -> str:
        """Return the picture in ASCII, so that it survives ``atob``."""
        text = (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {self.height:.0f}" '
            f'width="{WIDTH}" height="{self.height:.0f}" role="img" font-family="sans-serif" '
            'style="max-width:100%;height:auto;display:block">'
            f'<rect width="{WIDTH}" height="{self.height:.0f}" fill="white"/>'
            f"{''.join(self.items)}</svg>"
        )
        return text.encode("ascii", "xmlcharrefreplace").decode("ascii")


def rounded(values: np.ndarray, digits: int = 1) -> list:
    """Return numbers for the page, with few digits."""
    # Adding zero turns -0.0 into 0.0: what is stored does not depend on the sign of nothing.
    return (np.round(np.asarray(values, dtype=float), digits) + 0.0).tolist()


def pace_in_words(ratio: float) -> str:
    """Return how fast it plays, from seconds shown in a second."""
    if 0.99 < ratio < 1.01:
        return "It plays at true speed."
    if ratio > 1.0:
        return f"It plays {ratio:.2g} times too fast."
    return f"It plays {1 / ratio:.2g} times too slowly."


def script(name: str) -> str:
    """Return the text of a ``.js`` file that stands beside this one."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def page(drawing: Drawing, title: str, words: str, data: dict, draw: str) -> str:
    """Put picture, words and player together.

    Parameters
    ----------
    drawing : Drawing
        The first picture.
    title, words : str
        Name of the animation, and what it shows in full sentences.
    data : dict
        What moves it: ``frames``, the first one shown (``start``), ``loop``, ``seconds`` a run,
        ``slider`` (its label), and what `draw` needs. The scripts call it ``D``.
    draw : str
        A script that defines ``draw(f)``: it moves the drawing to frame f, which need not be whole,
        and returns what to say about it. ``all(selector)`` gives it elements of the drawing.
    """
    svg = drawing.svg()
    numbers = json.dumps(data, separators=(",", ":")).replace(".0,", ",").replace(".0]", "]")
    numbers = numbers.replace("<", "\\u003c")
    key = hashlib.sha256((svg + numbers).encode()).hexdigest()[:10]
    player = script("player.js").replace("__DRAW__", f"\n{draw}")
    player = player.replace("__KEY__", key).replace("__DATA__", numbers)
    picture = b64encode(svg.encode("ascii")).decode("ascii")
    box = (
        f"max-width:{WIDTH}px;background:#fff;color:{INK};"
        "font:13px/1.4 sans-serif;border:1px solid #ccc"
    )
    return (
        f'<div data-animation="{key}" role="group" aria-label="Animation: {escape(title)}" '
        f'style="{box}">\n'
        f'<img alt="{escape(words)}" src="data:image/svg+xml;base64,{picture}" '
        'style="max-width:100%;display:block">\n'
        f'<p style="margin:4px 10px 8px">{escape(words)}</p>\n'
        '<p data-still style="margin:4px 10px 8px">'
        "A still picture: run this cell to play it.</p>\n"
        f"<script>\n{player}</script>\n</div>"
    )
