"""Controls of a panel: what they change in a case, between which limits, and how they are shown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import ipywidgets as widgets

from .. import errors
from ..cases.definition import Case
from ..errors import InputError

__all__ = ["Control", "present", "put", "read"]

LABEL = "8.2em"  # room for the longest label: what does not fit is cut


@dataclass(frozen=True)
class Control:
    """One control of a panel.

    Attributes
    ----------
    name : str
        As in `Panel.set`.
    label : str
        As shown, with the unit shown.
    paths : tuple of str
        Where its value goes in the case; a number as last part counts from 0 in a list. Empty: the value changes the view only.
    low, high, step : float
        Range in SI units. Whole numbers make a whole-number slider.
    factor : float
        From SI to the unit shown.
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

    def check(self, value: Any) -> Any:
        """Return a value that is within the range, in SI units.

        Raises
        ------
        InputError
            Naming the control, the value and the range.
        """
        if self.choices:
            return errors.choice(self.name, value, self.choices)
        whole = isinstance(self.step, int)
        if whole:
            return errors.integer(self.name, value, least=self.low, most=self.high)
        return errors.number(self.name, value, least=self.low, most=self.high, unit=self.unit, remedy="Panels take SI units")

    def widget(self, value: Any) -> widgets.Widget:
        """Make the slider or list, showing a value given in SI units."""
        layout = widgets.Layout(flex="1 1 21em", min_width="0")
        shared = {"description": self.label, "style": {"description_width": LABEL}, "layout": layout}
        if self.choices:
            return widgets.Dropdown(options=self.choices, value=value, **shared)
        whole = isinstance(self.step, int)
        low, high, step, value = (v if whole else round(v * self.factor, 9) for v in (self.low, self.high, self.step, value))
        readout = "d" if whole else ".1f" if step >= 0.1 else ".3f"
        make = widgets.IntSlider if whole else widgets.FloatSlider
        return make(value, min=low, max=high, step=step, readout_format=readout, **shared)

    def player(self, slider: widgets.Widget) -> widgets.Widget:
        """Make the buttons that let a slider run by itself, in the browser."""
        play = widgets.Play(slider.value, min=self.low, max=self.high, step=2 * self.step, interval=100, show_repeat=False,
                            layout=widgets.Layout(flex="0 0 auto", width="5.5em"))  # fmt: skip
        widgets.jslink((play, "value"), (slider, "value"))
        return play

    def value(self, shown: Any) -> Any:
        """Return the SI value of what the widget shows."""
        return shown if self.choices or isinstance(self.step, int) else round(shown / self.factor, 12)

    def shown(self, value: Any) -> Any:
        """Return what the widget shows for an SI value."""
        return value if self.choices or isinstance(self.step, int) else round(value * self.factor, 9)


def present(control: Control, case: Case) -> Control:
    """Leave out the paths that the case does not have: a level rail has no wavelength."""
    if not control.paths:
        return control
    paths = tuple(p for p in control.paths if _get(case, p) is not None)
    if not paths:
        raise InputError(control.paths[0], None, f"is missing in the case, and the panel's {control.name} needs it", "Give it")
    return Control(**{**control.__dict__, "paths": paths})


def read(case: Case, control: Control) -> Any:
    """Return a control's first value."""
    return control.start if control.start is not None else _get(case, control.paths[0])


def _get(case: Case, path: str) -> Any:
    parent, _, last = path.rpartition(".")
    return case.get(parent)[int(last)] if last.isdigit() else case.get(path)


def put(changes: dict[str, Any], case: Case, path: str, value: Any) -> None:
    """Add a value to changes of a case; a number as last part of the path counts in a list of the case's."""
    parent, _, last = path.rpartition(".")
    if last.isdigit():
        values = changes.setdefault(parent, list(case.get(parent)))
        values[int(last)] = value
    else:
        changes[path] = value
