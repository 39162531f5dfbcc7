"""A drawing whose parts are moved by numbers of the frame; see riding.js."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import contextmanager

import numpy as np

from ..style import GREY
from .player import INK, WIDTH, Drawing, points_text, rounded

__all__ = ["Stage", "Weights", "round_ticks"]

Weights = list[tuple[int, np.ndarray]]
"""Which numbers move points up, by their place in `Stage.numbers`, each with a weight a point."""


class Stage(Drawing):
    """A drawing, shown first in one of its frames, with the data that move it.

    Attributes
    ----------
    frame : int
        The one shown first.
    numbers : list of ndarray, shape (frames,)
        How far what hangs on them moves up, px.
    data : dict
        For the script: ``H`` (the numbers), ``parts``, ``lines``, ``along``, ``axes`` and ``said``.
    """

    def __init__(self, height: float, frame: int, numbers: Sequence[np.ndarray]) -> None:
        super().__init__(height)
        self.frame, self.numbers = frame, numbers
        self.data = {"H": [rounded(n) for n in numbers], "parts": [], "lines": []}

    def add_part(self, shape: str, points: np.ndarray, by: Weights, **given) -> None:
        """Add a part with its corners at rest, px, shape (n, 2), and what moves each of them."""
        x, y = points.T
        now = y - sum(self.numbers[h][self.frame] * weights for h, weights in by)
        moved = points_text(zip(x, now, strict=True))
        self.add(shape, points=moved, **{"data-part": "", **given})
        by = [[h, rounded(weights, 3)] for h, weights in by]
        self.data["parts"].append({"x": rounded(x), "y": rounded(y), "by": by})

    def add_line(self, x: np.ndarray, y: np.ndarray, up: str, **given) -> None:
        """Add a line that rests at x, y (px); ``data[up]`` has for each frame how far it is up."""
        now = y - np.array(self.data[up][self.frame])
        line = {"data-line": "", "fill": "none", "points": points_text(zip(x, now, strict=True))}
        self.add("polyline", **line, **given)
        self.data["lines"].append({"x": rounded(x), "y": rounded(y), "rows": up})

    def set_along(self, start: float, step: float) -> None:
        """Say where groups along the track are in the first frame, px, and how far each goes on."""
        self.data["along"] = [round(float(start), 3), round(float(step), 5)]

    @contextmanager
    def along(self):
        """Collect what is added in a group that moves along the track."""
        start, step = self.data["along"]
        place = f"translate({start + step * self.frame:.1f} 0)"
        self.items.append(f'<g data-along="" transform="{place}">')
        yield
        self.items.append("</g>")

    def add_curves(
        self, top: float, time: np.ndarray, curves: Mapping[str, tuple[str, np.ndarray, str]],
        below: str,
    ) -> None:  # fmt: skip
        """Draw curves over time with a dot each, 100 px high, from `top` on.

        Parameters
        ----------
        top : float
            px.
        time : ndarray, shape (n,)
            s, evenly spaced; one for each frame, or one more, at which all begins again.
        curves : dict of (str, ndarray, str)
            By what is written above: the name beside the slider, the values, mm, the colour.
        below : str
            What is written below.
        """
        left, right, bottom = 62.0, WIDTH - 20.0, top + 100.0
        values = np.concatenate([v for _, v, _ in curves.values()])
        low, high = min(0.0, values.min()), max(0.0, values.max())
        per_second, per_mm = (right - left) / (time[-1] - time[0]), 100.0 / (high - low or 1.0)
        zero = bottom + per_mm * low
        step = (time[1] - time[0]) * per_second
        self.data["axes"] = [round(float(v), 5) for v in (left, step, zero, per_mm)]
        self.data["said"] = []
        self.add("line", x1=left, x2=right, y1=zero, y2=zero, stroke=GREY)
        ink = {"stroke": INK}
        for tick in round_ticks(low, high, 4):
            y = zero - per_mm * tick
            self.add("line", x1=left - 4, x2=left, y1=y, y2=y, **ink)
            self.write(left - 7, y + 4, f"{tick:g}", anchor="end")
        for tick in round_ticks(time[0], time[-1], 8):
            x = left + per_second * (tick - time[0])
            self.add("line", x1=x, x2=x, y1=bottom + 4, y2=bottom + 8, **ink)
            self.write(x, bottom + 22, f"{tick:g}", anchor="middle")
        self.add("line", x1=left, x2=right, y1=bottom + 4, y2=bottom + 4, **ink)
        self.add("line", x1=left, x2=left, y1=top, y2=bottom, **ink)
        self.write((left + right) / 2, bottom + 38, below, anchor="middle", size=13)
        self.write(left, top - 12, "up (mm)", size=13)
        x = left + per_second * (time - time[0])
        above = left + 80.0
        for words, (name, own, colour) in curves.items():
            line = {"x1": above, "x2": above + 22.0, "y1": top - 16, "y2": top - 16}
            self.add("line", **line, stroke=colour, **{"stroke-width": 2})
            self.write(above + 28.0, top - 12, words, size=13)
            above += 56.0 + 6.6 * len(words)
            y = zero - per_mm * own
            curve = {"fill": "none", "stroke": colour, "stroke-width": 1.6}
            self.add("polyline", points=points_text(zip(x, y, strict=True)), **curve)
            self.data["said"].append({"name": name, "mm": rounded(own, 2)})
        for _, own, colour in curves.values():
            place = {"cx": float(x[self.frame]), "cy": float(zero - per_mm * own[self.frame])}
            self.add("circle", **place, r=5, fill=colour, stroke="white", **{"data-dot": ""})


def round_ticks(low: float, high: float, most: int) -> np.ndarray:
    """Return round numbers from low to high, at most so many steps."""
    steps = (s * 10.0**p for p in range(-12, 13) for s in (1, 2, 5))
    step = next(step for step in steps if (high - low) / step <= most)
    first, last = np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9)
    return step * np.arange(first, last + 1) + 0.0
