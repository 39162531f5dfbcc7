"""The panel itself: controls, one picture that follows them, and the same in words.

While a control is moved, a crossing is computed with a coarser time step, with as many iterations as the exact one; when the
control has rested, the exact one is computed beside it, so that the next move need not wait. The panel says which it shows.
Before that, the step that would go on as the last one did is computed ahead.
"""

from __future__ import annotations

import asyncio
import threading
from base64 import b64encode
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from html import escape
from typing import Any

import ipywidgets as widgets
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .. import errors
from ..cases.definition import Case
from ..errors import InputError
from ..plots.drawing import WIDTH, hold, live
from ..plots.picture import Picture
from ..settings import default_time_step
from .control import Control, present, put, read

__all__ = ["FALLBACK", "Panel"]

FALLBACK = "Interactive panel: open this notebook in JupyterLab and run this cell to move its sliders."
DPI = 100
REST = 0.3  # s without a move, after which the exact crossing is computed
ROUGH_STEP = 8e-3  # s, at most, while a control is moved
PAUSE = 0.02  # s after a move, in which its picture leaves; then the next one is computed ahead
KEPT = 3  # results: the coarse one, that of the next step, and the exact one, which may hold 50 MB

Draw = Callable[[Mapping[str, Any], Case, Any, Mapping[str, Any]], None]
Go = Callable[[str], None]


class _StaleError(Exception):
    """The controls have moved on: what was being computed is no longer wanted."""


class Panel:
    """Controls, a picture and a sentence that follow a case.

    Parameters
    ----------
    case : Case
        Where the panel starts, and what *Paper case* goes back to.
    controls : sequence of Control
    axes : list
        Layout of the picture, as for ``Figure.subplot_mosaic``.
    draw : callable
        ``draw(axes, case, result, values)`` draws or, in a live figure, moves the curves.
    say : callable
        ``say(case, result, values)`` returns the picture in one line.
    compute : callable
        ``compute(case, progress)`` returns the result of a case; pure, kept for the controls' last values. It calls
        `progress` now and then, which raises where the result is no longer wanted.
    code : str
        Last line of *Show this as code*, formatted with the values: the number that the summary gives.
    size : (float, float)
        Inches.
    heights : sequence of float, optional
        Relative heights of the rows.
    rough : bool
        Whether the result is a crossing, so that a coarser time step serves while a control is moved.
    dpi : float
        Dots per inch of the picture; more for a projector.

    Raises
    ------
    InputError
        A case that lacks a value for a control, or has one outside the control's range.
    """

    def __init__(
        self,
        case: Case,
        controls: Sequence[Control],
        axes: list[list[str]],
        draw: Draw,
        say: Callable[[Case, Any, Mapping[str, Any]], str],
        *,
        compute: Callable[[Case, Go | None], Any] = Case.run,
        code: str = "",
        size: tuple[float, float] = (WIDTH, 4.6),
        heights: Sequence[float] | None = None,
        rough: bool = False,
        dpi: float = DPI,
    ) -> None:
        self.controls = {c.name: present(c, case) for c in controls}
        self.start = {c.name: c.check(read(case, c)) for c in self.controls.values()}
        self.error: Exception | None = None
        self.summary = ""
        self.case = self._base = case
        self._draw, self._say, self._compute, self._line, self._rough = draw, say, compute, code, rough
        self._results: OrderedDict[tuple, tuple[Case, Any]] = OrderedDict()
        self._moves = 0
        self._later: list[asyncio.TimerHandle] = []
        self._held = self._called = self._coarse = False
        self._home = _running_loop(), threading.get_ident()
        self.figure = Figure(figsize=size, dpi=dpi, layout="constrained")
        FigureCanvasAgg(self.figure)
        self._axes = self.figure.subplot_mosaic(axes, height_ratios=heights)
        self._picture = Picture(self.figure)
        self._build()
        values = self.values
        self._draw(self._axes, *self._solve(values), values)
        live(self.figure)
        self._show()
        self._at = values

    def _build(self) -> None:
        self.sliders = {n: c.widget(self.start[n]) for n, c in self.controls.items()}
        beside = widgets.Layout(flex="0 0 auto", margin="0 0 0 2px")
        self._asides = {n: widgets.Label(layout=beside) for n, c in self.controls.items() if c.aside}
        for slider in self.sliders.values():
            slider.observe(lambda _: self._moved(), names="value")
        # As a data URL: from a blob's URL, which the widget would make of plain bytes, a browser shows it 15 ms later.
        self.image = widgets.Image(format="url", layout=widgets.Layout(width="100%"))
        self.image.add_class("rb-picture")
        self.words, self.trouble = widgets.HTML(), widgets.HTML()
        self.words.add_class("rb-summary")
        self.trouble.add_class("rb-error")
        natural = widgets.Layout(width="auto")
        self.paper_button = widgets.Button(
            description="Paper case", layout=natural, tooltip="All controls back to where they started"
        )
        self.paper_button.on_click(lambda _: self._put(self.start, self._moved))
        self.code_button = widgets.Button(
            description="Show this as code", layout=natural, tooltip="Python lines that compute this very case"
        )
        self.code_button.on_click(lambda _: self._show_code())
        self.code_area = widgets.Textarea(rows=14, layout=widgets.Layout(width="100%", max_width="900px", display="none"))
        wide = self.figure.get_figwidth() * DPI
        row = widgets.Layout(flex="1 1 28em", max_width="40em", flex_flow="row wrap", align_items="center")
        rows = [widgets.HBox([self.sliders[n], *self._beside(n)], layout=row) for n in self.controls]
        controls = widgets.HBox(rows, layout=widgets.Layout(flex_flow="row wrap", grid_gap="0 1em"))
        buttons = widgets.HBox([self.paper_button, self.code_button], layout=widgets.Layout(flex_flow="row wrap"))
        # Beside the picture where there is room, above it where there is not.
        side = widgets.VBox([controls, buttons], layout=widgets.Layout(flex="1 1 24em", min_width="0"))
        main = widgets.VBox(
            [self.image, self.words, self.trouble],
            layout=widgets.Layout(flex=f"6 1 {0.82 * wide:.0f}px", min_width="0", max_width=f"{wide:.0f}px"),
        )
        side.add_class("rb-side")
        main.add_class("rb-main")
        body = widgets.HBox([side, main], layout=widgets.Layout(flex_flow="row wrap", grid_gap="4px 1em"))
        self.widget = widgets.VBox([body, self.code_area])
        self.widget.add_class("rb-panel")

    def _beside(self, name: str) -> list[widgets.Widget]:
        beside = [self._asides[name]] if name in self._asides else []
        return beside + ([self.controls[name].player(self.sliders[name])] if self.controls[name].plays else [])

    @property
    def values(self) -> dict[str, Any]:
        """What the controls say, in SI units."""
        return {n: c.value(self.sliders[n].value) for n, c in self.controls.items()}

    @property
    def code(self) -> str:
        """Python lines that compute the present case, and the number that the summary gives."""
        return self.case.code() + (self._line.format(**self.values, x=self.case.points[0]) + "\n" if self._line else "")

    def set(self, **values: Any) -> Panel:
        """Move controls, as by hand: the picture and the summary follow, at once the exact ones.

        Parameters
        ----------
        **values
            New values by control, in SI units.

        Returns
        -------
        Panel
            Itself.

        Raises
        ------
        InputError
            An unknown control or a value out of range, before anything moves; or what the case says to the values.
        """
        for name in values:
            errors.choice("control", name, self.controls)
        self._put({n: self.controls[n].check(v) for n, v in values.items()}, self._show)
        if self.error is not None:
            raise self.error
        return self

    def reset(self) -> Panel:
        """Put all controls back to where they started, as *Paper case* does."""
        return self.set(**self.start)

    def _put(self, values: Mapping[str, Any], follow: Callable[[], None]) -> None:
        """Move several controls, and follow once."""
        self._held = True
        try:
            for name, value in values.items():
                self.sliders[name].value = self.controls[name].shown(value)
        finally:
            self._held = False
        follow()

    def _moved(self) -> None:
        """Follow a hand where the panel was made: a front end may hand its messages to several threads, in any order."""
        if self._held:
            return
        loop, thread = self._home
        if loop is None or loop.is_closed() or threading.get_ident() == thread:
            self._follow()
        elif not self._called:
            self._called = True
            loop.call_soon_threadsafe(self._follow)

    def _follow(self) -> None:
        """Show what the controls say now: roughly at once where that is quicker, exactly when they rest."""
        self._called = False
        loop, values = _running_loop(), self.values
        before, self._at = self._at, values
        # Without a kernel whose messages have to be answered there is nobody to keep waiting.
        if loop is None or not self._rough or self._key(values) in self._results:
            return self._show()
        self._show(rough=True)
        if self.error is None:
            self._later = [loop.call_later(REST, self._aside, loop, values, False)]
            ahead = self._expected(before, values)
            if ahead is not None:
                self._later.append(loop.call_later(PAUSE, self._aside, loop, ahead, True))

    def _expected(self, before: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return the values if the last step is followed by another like it; None where that cannot be said."""
        moved = [self.controls[n] for n in now if now[n] != before[n]]
        if len(moved) != 1 or moved[0].choices or not moved[0].paths:
            return None
        control, name = moved[0], moved[0].name
        value = round(2 * now[name] - before[name], 12)
        return {**now, name: value} if control.low <= value <= control.high else None

    def _aside(self, loop: asyncio.AbstractEventLoop, values: dict[str, Any], rough: bool) -> None:
        """Compute a result in a thread of its own; show the exact one if the controls still stand there."""
        move = self._moves

        def go_on(_: str = "") -> None:
            if move != self._moves:
                raise _StaleError

        def work() -> None:
            result = self._solve(values, rough, go_on)
            go_on()
            self._say(*result, values)  # works out what the picture needs, which results keep

        def done(task: asyncio.Future) -> None:
            stale = task.cancelled() or isinstance(task.exception(), _StaleError)
            if not (rough or stale) and move == self._moves:
                self._show()  # from the results kept; what went wrong goes wrong again, and is said

        loop.run_in_executor(None, work).add_done_callback(done)

    def _key(self, values: Mapping[str, Any], rough: bool = False) -> tuple:
        return (rough, *(values[n] for n, c in self.controls.items() if c.paths))

    def _solve(self, values: Mapping[str, Any], rough: bool = False, progress: Go | None = None) -> tuple[Case, Any]:
        """Return the case of some values and its result (that of a coarser one if rough), from those kept if it is there."""
        key = self._key(values, rough)
        found = self._results.get(key)
        if found is None:
            changes: dict[str, Any] = {}
            for name, control in self.controls.items():
                for path in control.paths:
                    put(changes, self._base, path, values[name])
            case = self._base.replace(changes)
            solved = _coarser(case) if rough else case
            self._results[key] = found = case, self._compute(solved, progress)
            while len(self._results) > KEPT:
                self._results.popitem(last=False)
        return found

    def _show(self, rough: bool = False) -> None:
        """Compute, draw, say; an error is said instead, and the picture stays as it was."""
        self._moves += 1
        for timer in self._later:
            timer.cancel()
        self._later = []
        values = self.values
        try:
            case, result = self._solve(values, rough)
            hold(self.figure, rough)
            self._draw(self._axes, case, result, values)
            summary = self._say(case, result, values)
        except (ValueError, RuntimeError, ArithmeticError) as error:
            self.error = error
            said = f"<b>Not possible:</b> {escape(str(error))} (The picture shows the last possible case.)"
            self.trouble.value = f'<div role="alert" style="{_ALERT}">{said}</div>'
            if self._coarse:  # nothing follows any more
                self._write(False, f"Time step up to {_ms(ROUGH_STEP)}.")
            self._tell_asides(values)
            return
        self.case, self.summary, self.error = case, summary, None
        self.image.value = b"data:image/png;base64," + b64encode(self._picture.png())
        note = ""
        if self._rough:
            exact = _ms(case.settings.time_step)
            moving = f"<i>Moving: time step up to {_ms(ROUGH_STEP)}; {exact} follows.</i>"
            note = moving if rough else f"Time step {exact}."
        self._write(rough, note)
        self.trouble.value = ""
        self._tell_asides(values)
        if self.code_area.layout.display != "none":
            self.code_area.value = self.code

    def _write(self, coarse: bool, note: str) -> None:
        """Write the summary, to be read out where it stays."""
        self._coarse = coarse
        said = f"<span{'' if coarse else ' role=status'}>{escape(self.summary)}</span> {note}"
        self.words.value = f'<div style="line-height:1.35">{said}</div>'

    def _tell_asides(self, values: Mapping[str, Any]) -> None:
        for name, label in self._asides.items():
            label.value = self.controls[name].aside(values[name])

    def _show_code(self) -> None:
        hidden = self.code_area.layout.display == "none"
        self.code_area.value = self.code
        self.code_area.layout.display = "flex" if hidden else "none"
        self.code_button.description = "Hide the code" if hidden else "Show this as code"

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        """Show the widget, or a sentence where there are no widgets."""
        bundle = self.widget._repr_mimebundle_(include=include, exclude=exclude) or {}
        return {**bundle, "text/plain": FALLBACK}


# Readable on light and dark pages.
_ALERT = "line-height:1.35;background:#fdecea;color:#7a0c17;border-left:4px solid #b00020;padding:4px 10px"


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.2g} ms"


def _running_loop() -> asyncio.AbstractEventLoop | None:
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None


def _coarser(case: Case) -> Case:
    """Return the case with the time step used while a control is moved; never finer than its own."""
    speed = case.settings.speed
    step = min(default_time_step(case.train, case.track, speed, ROUGH_STEP), case.deck.length / 20 / speed)
    if step <= case.settings.time_step:
        return case
    try:
        return case.replace({"run.time_step": step})
    except InputError:  # a lead-in or a notch that needs the case's own step
        return case
