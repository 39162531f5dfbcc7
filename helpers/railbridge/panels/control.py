"""Controls of a panel: what they change in a case, between which limits, and how they look."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import ipywidgets as widgets

from .. import errors
from ..cases.definition import Case
from ..errors import InputError

__all__ = ["Control", "change_at", "for_case"]


@dataclass(frozen=True)
class Control:
    """One control of a panel.

    Attributes
    ----------
    name : str
        As in `Panel.set`.
    label : str
        As displayed, with the unit displayed.
    paths : tuple of str
        Where its value goes in the case; a number as last part counts from 0 in a list. Empty: the
        value changes the view only.
    low, high, step : float
        Range in SI units. Whole numbers make a whole-number slider.
    factor : float
        From SI to the unit displayed.
    unit : str
        SI unit.
    start : float or str, optional
        First value; default the case's.
    choices : tuple of str
        Makes a drop-down list.
    aside : callable, optional
        Value to a text beside the slider.
    plays : bool
        Whether the slider can run by itself; only for whole numbers.
    """

    name: str
    label: str
    paths: tuple[str, ...] = ()
    low: float = 0.0
    high: float = 1.0
    step: float = 0.1
    factor: float = 1.0
    unit: str = ""
    start: Any = None
    choices: tuple[str, ...] = ()
    aside: Callable[[Any], str] | None = None
    plays: bool = False

    @property
    def is_whole(self) -> bool:
        """Whether it takes whole numbers."""
        return isinstance(self.step, int)

    def check(self, value: Any) -> Any:
        """Return a value that is within the range, in SI units.

        Raises
        ------
        InputError
            Naming the control, the value and the range.
        """
        if self.choices:
            return errors.choice(self.name, value, self.choices)
        limits = {"least": self.low, "most": self.high}
        if self.is_whole:
            return errors.integer(self.name, value, **limits)
        remedy = "Panels take SI units"
        return errors.number(self.name, value, **limits, unit=self.unit, remedy=remedy)

    def first_value(self, case: Case) -> Any:
        """Return the value that it starts from: its own, or the case's."""
        value = self.start if self.start is not None else _value_at(case, self.paths[0])
        return self.check(value)

    def widget(self, value: Any) -> widgets.Widget:
        """Make the slider or list, displaying a value given in SI units."""
        options = {"description": self.label}
        if self.choices:
            return widgets.Dropdown(options=self.choices, value=value, **options)
        value, low, high, step = map(self.displayed_value, (value, self.low, self.high, self.step))
        options |= {"min": low, "max": high, "step": step, "readout": False}
        return (widgets.IntSlider if self.is_whole else widgets.FloatSlider)(value, **options)

    def field(self, value: Any) -> widgets.Text | None:
        """Make the field for the slider's number; None beside a list.

        A slider's own would read 12,5 as 12 in the browser.
        """
        if self.choices:
            return None
        layout = widgets.Layout(flex="0 0 auto", width="4.8em")
        options = {"continuous_update": False, "tooltip": f"{self.label}, typed", "layout": layout}
        field = widgets.Text(self.written(value), **options)
        field.add_class("rb-number")
        return field

    def written(self, value: Any) -> str:
        """Return an SI value as its field shows it, with as many digits as it needs."""
        displayed = self.displayed_value(value)
        if self.is_whole:
            return str(displayed)
        text = f"{displayed:.{1 if self.displayed_value(self.step) >= 0.1 else 3}f}"
        return text if float(text) == displayed else f"{displayed:.9g}"

    def read(self, text: str) -> Any:
        """Return the SI value of what was typed into the field.

        Raises
        ------
        InputError
            No number, or one out of the slider's range; in the words of its label.
        """
        number = _number(text)
        if number is None:
            pointed = text.strip().replace(",", ".")
            remedy = "" if _number(pointed) is None else f"Write it with a point: {pointed}"
            raise InputError(self.label, text, "is no number", remedy)
        low, high = map(self.displayed_value, (self.low, self.high))
        if not low <= number <= high:
            raise InputError(self.label, text, f"must be between {low:g} and {high:g}")
        if self.is_whole and number != int(number):
            raise InputError(self.label, text, "must be a whole number")
        return int(number) if self.is_whole else self.si_value(number)

    def player(self, slider: widgets.Widget) -> tuple[widgets.Widget, widgets.Widget]:
        """Make the buttons that let a slider run by itself in the browser, and the link to it."""
        options = {"min": self.low, "max": self.high, "step": 2 * self.step, "interval": 100}
        play = widgets.Play(slider.value, show_repeat=False, **options)
        return play, widgets.jslink((play, "value"), (slider, "value"))

    def si_value(self, displayed: Any) -> Any:
        """Return the SI value of what the widget displays."""
        if self.choices or self.is_whole:
            return displayed
        return round(displayed / self.factor, 12)

    def displayed_value(self, value: Any) -> Any:
        """Return what the widget displays for an SI value."""
        return value if self.choices or self.is_whole else round(value * self.factor, 9)


def for_case(control: Control, case: Case) -> Control:
    """Leave out the paths that the case does not have: a level rail has no wavelength.

    Raises
    ------
    InputError
        The case has none of them.
    """
    if not control.paths:
        return control
    paths = tuple(path for path in control.paths if _value_at(case, path) is not None)
    if not paths:
        allowed = f"is missing in the case, and the panel's {control.name} needs it"
        raise InputError(control.paths[0], None, allowed, "Give it")
    return replace(control, paths=paths)


def change_at(changes: dict[str, Any], case: Case, path: str, value: Any) -> None:
    """Add a value to changes of a case.

    A number as last part of the path counts in a list of the case's.
    """
    parent, _, last = path.rpartition(".")
    if last.isdigit():
        values = changes.setdefault(parent, list(case.get(parent)))
        values[int(last)] = value
    else:
        changes[path] = value


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _value_at(case: Case, path: str) -> Any:
    parent, _, last = path.rpartition(".")
    return case.get(parent)[int(last)] if last.isdigit() else case.get(path)
