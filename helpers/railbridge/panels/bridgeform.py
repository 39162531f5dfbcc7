"""A form that asks for the numbers of a bridge and writes a case file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from html import escape
from pathlib import Path
from typing import Any

import ipywidgets as widgets

from ..cases.simplebridge import KINDS, SimpleBridge
from ..errors import InputError
from .control import Control
from .looks import refusal
from .panel import CLOSED, FALLBACK
from .standing import stands_here

__all__ = ["BridgeForm"]

_NUMBERS = {
    "span": Control("span", "span (m)", (), 2.0, 200.0, 0.1),
    "mass": Control("mass", "mass (t/m)", (), 100.0, 1e5, 100.0, 1e-3),
    "bending_stiffness": Control("bending_stiffness", "E I (GN m²)", (), 1e7, 1e14, 1e7, 1e-9),
    "youngs_modulus": Control("youngs_modulus", "E (GPa)", (), 1e9, 4e11, 1e8, 1e-9),
    "second_moment": Control("second_moment", "I (m⁴)", (), 1e-4, 1e4, 1e-3),
    "frequency": Control("frequency", "first frequency (Hz)", (), 0.1, 100.0, 0.01),
    "damping": Control("damping", "damping ratio (%)", (), 0.0, 0.5, 1e-4, 100.0),
    "line_speed": Control("line_speed", "speed of the line (km/h)", (), 1.0, 200.0, 1.0, 3.6),
    "track_spacing": Control("track_spacing", "between the tracks (m)", (), 0.1, 20.0, 0.1),
}
"""Fields that hold a number, in the units that people use."""
_CHOICES = {"kind": KINDS, "track": ("ballasted", "direct fastening"), "tracks": (1, 2)}
_LABELS = {
    "name": "name of the bridge", "stiffness": "stiffness by", "kind": "kind of bridge",
    "track": "track", "tracks": "number of tracks", "file": "case file",
}  # fmt: skip
_STIFFNESS = {
    "E I": ("bending_stiffness",),
    "E and I": ("youngs_modulus", "second_moment"),
    "first frequency": ("frequency",),
}
_ORDER = (
    "span", "mass", "stiffness", "bending_stiffness", "youngs_modulus", "second_moment",
    "frequency", "kind", "damping", "line_speed", "track", "tracks", "track_spacing",
)  # fmt: skip
_START = {
    "span": 20.0, "mass": 12000.0, "bending_stiffness": 3.0e10, "youngs_modulus": 35e9,
    "second_moment": 0.85, "frequency": 6.2, "line_speed": 200 / 3.6, "track_spacing": 4.0,
    "kind": "prestressed concrete", "track": "ballasted", "tracks": 1,
}  # fmt: skip
_LOWER_BOUND = "empty: the lower bound of the kind"


class BridgeForm:
    """Fields for a bridge of one span, what follows from them, and a button that writes the file.

    Parameters
    ----------
    path : str or Path
        File that is proposed.
    train : mapping, optional
        Table ``train`` of the case; see `SimpleBridge.content`.

    Notes
    -----
    Only the button writes, and never over a file that is there.
    """

    def __init__(
        self, path: str | Path = "my_bridge.toml", train: Mapping[str, Any] | None = None
    ) -> None:
        self._train, self._closed = train, False
        fields = {"name": _text("my bridge"), **{name: _field(name) for name in _ORDER}}
        fields["file"] = _text(str(path))
        self.fields = {name: _labelled(name, field) for name, field in fields.items()}
        self.fields["damping"].placeholder = _LOWER_BOUND
        self.words, self.trouble = widgets.HTML(), widgets.HTML()
        self.button = widgets.Button(
            description="Write the case file",
            tooltip="Writes a new file; one that is there is left alone",
            layout=widgets.Layout(width="auto"),
        )
        self.button.on_click(lambda _: self.write())
        for field in self.fields.values():
            field.observe(lambda _: self._follow(), names="value")
        self.widget = widgets.VBox(
            [*self.fields.values(), self.button, self.words, self.trouble]
        ).add_class("rb-form")
        self.error: Exception | None = None
        self._follow()
        stands_here(self)

    @property
    def bridge(self) -> SimpleBridge:
        """What the fields say.

        Raises
        ------
        InputError
            A field without such a number, in the words of its label; or what the bridge refuses.
        """
        given: dict[str, Any] = {"name": self.fields["name"].value}
        shown = self._shown()
        for name in _ORDER:
            if name in _CHOICES:
                given[name] = self.fields[name].value
            elif name in _NUMBERS and name in shown:
                text = self.fields[name].value.strip()
                if text or name != "damping":
                    given[name] = _NUMBERS[name].read(text)
        return SimpleBridge(**given)

    def set(self, **values: Any) -> BridgeForm:
        """Fill in fields, as by hand: numbers in SI units, choices and texts as they are.

        Raises
        ------
        InputError
            No such field.
        """
        for name, value in values.items():
            if name not in self.fields:
                raise InputError("field", name, "must be one of " + ", ".join(self.fields))
            own = _NUMBERS.get(name)
            self.fields[name].value = value if own is None else own.written(value)
        return self

    def write(self) -> Path | None:
        """Write the file that the form names; None, and the reason below it, if it cannot be."""
        return self._said(self._write)

    def close(self) -> None:
        """Free the form's widgets."""
        if not self._closed:
            for field in self.fields.values():
                field.unobserve_all()
            self.widget.close()
            self._closed = True

    def _write(self) -> Path:
        path = self.bridge.write(self.fields["file"].value, self._train)
        name = escape(str(path))
        page = escape(path.with_suffix(".html").name)
        self.words.value = (
            f"<span role=status>{name} is written. In a terminal: <code>railbridge report {name} "
            f"--out {page}</code>; here: <code>rb.case(&quot;{name}&quot;)</code>.</span>"
        )
        return path

    def _shown(self) -> set[str]:
        """Return the names of the fields that count now."""
        hidden = {n for names in _STIFFNESS.values() for n in names}
        hidden -= set(_STIFFNESS[self.fields["stiffness"].value])
        if self.fields["tracks"].value == 1:
            hidden.add("track_spacing")
        return set(self.fields) - hidden

    def _follow(self) -> None:
        shown = self._shown()
        for name, field in self.fields.items():
            field.layout.display = "flex" if name in shown else "none"
        self._said(self._describe)

    def _describe(self) -> None:
        bridge = self.bridge
        ratio, f1 = 100 * bridge.damping_ratio, bridge.first_frequency
        self.words.value = (
            f"<span role=status>E I = {bridge.stiffness / 1e9:.4g} GN m², first frequency "
            f"{f1:.4g} Hz, damping {ratio:.3g} %, {3.6 * bridge.line_speed:.4g} km/h = "
            f"{bridge.line_speed:.4g} m/s.</span>"
        )

    def _said(self, action: Callable[[], Any]) -> Any:
        """Do something; say what stands in its way."""
        try:
            found = action()
        except InputError as error:
            self.error = error
            self.trouble.value = refusal(error)
            return None
        self.error, self.trouble.value = None, ""
        return found

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        """Show the widget, or a sentence where there are no widgets."""
        if self._closed:
            return {"text/plain": CLOSED}
        stands_here(self)
        bundle = self.widget._repr_mimebundle_(include=include, exclude=exclude) or {}
        return {**bundle, "text/plain": FALLBACK}


def _text(value: str) -> widgets.Text:
    return widgets.Text(value, continuous_update=False)


def _field(name: str) -> widgets.Widget:
    """Return the field of a name, with its label."""
    if name in _NUMBERS:
        start = _START.get(name)
        field = _text("" if start is None else _NUMBERS[name].written(start))
    elif name in _CHOICES:
        field = widgets.Dropdown(options=_CHOICES[name], value=_START[name])
    else:
        field = widgets.Dropdown(options=tuple(_STIFFNESS))
    return field


def _labelled(name: str, field: widgets.Widget) -> widgets.Widget:
    """Give a field its label and its width."""
    field.description = _NUMBERS[name].label if name in _NUMBERS else _LABELS[name]
    field.style.description_width = "13em"
    field.layout.width = "31em"
    return field
