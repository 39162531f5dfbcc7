"""How a panel is laid out in a page, and the names that its parts have for screen readers.

Widgets cannot be given either from Python: a handle of a slider has no name, and a width cannot
depend on the page. The style that does both travels with the panel, in a widget that shows nothing;
the script runs when a page has loaded that style.
"""

from __future__ import annotations

from functools import cache
from html import escape
from importlib.resources import files

import ipywidgets as widgets

__all__ = ["boxed", "class_of", "looks", "refusal"]

# Readable on light and dark pages: ground, letters, edge.
_COLOURS = {"alert": ("#fdecea", "#7a0c17", "#b00020"), "note": ("#fff4d6", "#5c4300", "#b07d00")}


def class_of(width: float, height: float) -> str:
    """Return the class of what is laid out for a picture of this width and height, px."""
    return f"rb-by-{_name(width, height)}"


def looks(width: float, height: float) -> widgets.HTML:
    """Return the widget that lays out a panel with a picture of this width and height, px.

    It stands in the panel, an element of class ``rb-panel``.
    """
    style = f'<style onload="{escape(_text("panel.js"))}">{_style(width, height)}</style>'
    return widgets.HTML(style, layout=widgets.Layout(display="none"))


def boxed(words: str, role: str) -> str:
    """Return HTML in a box, an ``alert`` that is read out at once or a ``note``."""
    ground, letters, edge = _COLOURS[role]
    style = f"line-height:1.35;background:{ground};color:{letters};"
    style += f"border-left:4px solid {edge};padding:4px 10px"
    return f'<div role="{role}" style="{style}">{words}</div>'


def refusal(error: Exception, more: str = "") -> str:
    """Return in a box what is not possible, and why."""
    return boxed(f"<b>Not possible:</b> {escape(str(error))} {more}".rstrip(), "alert")


def _style(width: float, height: float) -> str:
    aspect = width / height
    # em, from where the picture is larger beside the controls than below them, on a screen 768 px
    # high: there it may be 34 em high, and the controls beside it are 20 em wide.
    beside = 34.0 * aspect + 21.0
    style = _text("panel.css")
    given = {"NAME": _name(width, height), "WIDTH": f"{width:.0f}", "ASPECT": f"{aspect:.3f}"}
    given |= {"BESIDE": f"{beside:.1f}", "ROOMY": f"{beside + 8.0:.1f}"}
    for key, value in given.items():
        style = style.replace(f"__{key}__", value)
    return style


def _name(width: float, height: float) -> str:
    return f"{width:.0f}-{height:.0f}"


@cache
def _text(name: str) -> str:
    """Return the text of a file that stands beside this one."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")
