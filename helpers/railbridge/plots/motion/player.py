"""A moving picture in a page: a vector drawing, the numbers that move it, and a player of a few lines.

An `Animation` is a piece of HTML. It needs no program, no network and no server, is some tens of kilobytes, and starts paused.
Where scripts are not run (an untrusted notebook, a page on a forge) its first picture stands still. With reduced motion asked
for, the player steps instead of playing.
"""

from __future__ import annotations

import hashlib
import json
import re
from base64 import b64encode
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from html import escape
from importlib import resources
from pathlib import Path

import numpy as np

from ...errors import InputError

__all__ = ["INK", "WIDE", "Animation", "Drawing", "attributes", "corners", "mark", "page", "rounded"]

WIDE = 900  # px, as the other figures
INK = "#222222"



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
    html: str = field(repr=False)

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
        head = f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>{escape(self.title)}</title>\n'
        Path(path).write_text(head + self.html + "\n</html>\n", encoding="utf-8")


class Drawing:
    """A vector drawing as wide as the other figures.

    Attributes
    ----------
    height : float
        px.
    items : list of str
        Its marks, the last on top.
    """

    def __init__(self, height: float) -> None:
        self.height, self.items = height, []

    def add(self, name: str, **given) -> None:
        """Add a mark by its SVG name and attributes."""
        self.items.append(mark(name, **given))

    def write(self, x: float, y: float, text: str, anchor: str = "start", size: int = 12) -> None:
        """Add a line of text at x, y (px)."""
        look = {"x": float(x), "y": float(y), "fill": INK, "font-size": size, "text-anchor": anchor}
        self.items.append(f"<text {attributes(look)}>{escape(text)}</text>")

    def svg(self) -> str:
        """Return the picture in ASCII, so that it survives ``atob``."""
        head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {self.height:.0f}" width="{WIDE}" '
            f'height="{self.height:.0f}" role="img" font-family="sans-serif" style="max-width:100%;height:auto;display:block">'
            f'<rect width="{WIDE}" height="{self.height:.0f}" fill="white"/>'
        )
        return (head + "".join(self.items) + "</svg>").encode("ascii", "xmlcharrefreplace").decode("ascii")


def attributes(given: Mapping) -> str:
    """Return the attributes of a mark as SVG has them, numbers with six digits."""
    shown = {k: f"{v:.6g}" if isinstance(v, (float, np.floating)) else v for k, v in given.items()}
    return " ".join(f'{k}="{escape(str(v))}"' for k, v in shown.items())


def mark(name: str, **given) -> str:
    """Return a mark by its SVG name and attributes."""
    return f"<{name} {attributes(given)}/>"


def corners(points: Iterable) -> str:
    """Return the corners of a line, pairs of px."""
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)


def rounded(values: np.ndarray, digits: int = 1) -> list:
    """Return numbers for the page, with few digits."""
    # Adding zero turns -0.0 into 0.0, so that what is stored does not hang on the sign of nothing.
    return (np.round(np.asarray(values, dtype=float), digits) + 0.0).tolist()


@cache
def _script(name: str) -> str:
    """Return a script that stands beside this file, without the comment on top."""
    text = resources.files(__package__).joinpath(f"{name}.js").read_text(encoding="utf-8")
    return "\n" + re.sub(r"\A(//.*\n)+", "", text)


def page(drawing: Drawing, title: str, words: str, data: dict, draw: str) -> str:
    """Put picture, words and player together.

    Parameters
    ----------
    drawing : Drawing
        The first picture.
    title, words : str
        Name of the animation, and what it shows in full sentences.
    data : dict
        What moves it: ``frames``, the first one shown (``start``), ``loop``, ``seconds`` a run, ``slider`` (its label), and what
        `draw` needs.
    draw : str
        Name of the script beside this file that defines ``draw``; see ``player.js``.
    """
    svg = drawing.svg()
    numbers = json.dumps(data, separators=(",", ":")).replace(".0,", ",").replace(".0]", "]").replace("<", "\\u003c")
    key = hashlib.sha256((svg + numbers).encode()).hexdigest()[:10]
    script = _script("player").replace("__DRAW__", _script(draw)).replace("__KEY__", key).replace("__DATA__", numbers)
    picture = b64encode(svg.encode("ascii")).decode("ascii")
    box = f"max-width:{WIDE}px;background:#fff;color:{INK};font:13px/1.4 sans-serif;border:1px solid #ccc"
    return (
        f'<div data-animation="{key}" role="group" aria-label="Animation: {escape(title)}" style="{box}">\n'
        f'<img alt="{escape(words)}" src="data:image/svg+xml;base64,{picture}" style="max-width:100%;display:block">\n'
        f'<p style="margin:4px 10px 8px">{escape(words)}</p>\n'
        '<p data-still style="margin:4px 10px 8px">A still picture: run this cell to play it.</p>\n'
        f"<script>{script}</script>\n</div>"
    )
