"""The panel itself: controls, one picture that follows them, and the same in words.

While a control is moved, a crossing is computed with a coarser time step, with as many iterations
as the exact one; when the control has rested, the exact one is computed beside it, so that the next
move need not wait. The panel says which it shows. Before that, the step that would go on as the
last one did is computed ahead.
"""

from __future__ import annotations

import asyncio
import threading
from base64 import b64encode
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from html import escape
from types import MappingProxyType
from typing import Any

import ipywidgets as widgets
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .. import errors
from ..cases.definition import Case
from ..errors import InputError, Remark
from ..plots.drawing import FIGURE_WIDTH, keep_limits, leave_behind, reuse_artists
from ..plots.picture import Picture
from ..results import Crossing
from ..settings import default_time_step
from .code import case_lines
from .control import Control, change_at, for_case
from .looks import boxed, class_of, looks, refusal
from .standing import stands_here

__all__ = ["DPI", "FALLBACK", "Panel"]

FALLBACK = (
    "Interactive panel: open this notebook in JupyterLab and run this cell to move its sliders."
)
CLOSED = "This panel is closed: its cell was run again, and what it made then has replaced it."
DPI = 100
REST = 0.3  # s without a move, after which the exact crossing is computed
ROUGH_STEP = 8e-3  # s, at most, while a control is moved
PAUSE = 0.02  # s after a move, in which its picture leaves; then the next one is computed ahead
RESULTS_KEPT = 3  # the coarse one, that of the next step, and the exact one, which may hold 50 MB

Draw = Callable[[Mapping[str, Any], Case, Any, Mapping[str, Any]], None]
Progress = Callable[[str], None]


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
        ``draw(axes, case, result, values)`` draws or, in a figure that reuses its artists, moves
        the curves.
    say : callable
        ``say(case, result, values)`` returns the picture in one line.
    compute : callable
        ``compute(case, progress)`` returns the result of a case; pure, kept for the controls' last
        values. It calls `progress` now and then, which raises where the result is no longer wanted.
    remarks : callable
        ``remarks(case, result)`` returns what must be known before the picture is read; what is
        warned of is shown with the exact picture. By default those on a crossing, or on the input
        where the result is something else.
    code : str
        Lines of *Show this as code* after those that make the case, formatted with the values: they
        draw, and the last one is the number that the summary gives.
    size : (float, float)
        Inches.
    heights : sequence of float, optional
        Relative heights of the rows.
    rough : bool
        Whether the result is a crossing, so that a coarser time step serves while a control is
        moved.
    preview : callable, optional
        ``preview(case, progress)`` returns what serves while a control is moved, where a coarser
        time step does not.
    preview_note : str
        How that is told apart from what follows, in a sentence.
    dpi : float
        Dots per inch of the picture; more for a projector.
    behind : mapping of sequence of str
        By axes, the names of curves that stay as they are at the start, in grey behind those that
        move.
    start_name : str
        What the legend calls them.

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
        compute: Callable[[Case, Progress | None], Any] = Case.compute,
        remarks: Callable[[Case, Any], Sequence[Remark]] | None = None,
        code: str = "run = case.run()",
        size: tuple[float, float] = (FIGURE_WIDTH, 4.6),
        heights: Sequence[float] | None = None,
        rough: bool = False,
        preview: Callable[[Case, Progress | None], Any] | None = None,
        preview_note: str = "",
        dpi: float = DPI,
        behind: Mapping[str, Sequence[str]] = MappingProxyType({}),
        start_name: str = "at the start",
    ) -> None:
        self.controls = {c.name: for_case(c, case) for c in controls}
        self.start = {c.name: c.first_value(case) for c in self.controls.values()}
        self.error: Exception | None = None
        self.summary = ""
        self.case = self._base = case
        self._draw, self._say, self._compute = draw, say, compute
        self._remarks = remarks or _usual_remarks
        self._code, self._rough = code, rough or preview is not None
        self._preview, self._preview_note = preview, preview_note
        self._results: OrderedDict[tuple, tuple[Case, Any]] = OrderedDict()
        self._links: list[widgets.Widget] = []
        self._moves = 0
        self._timers: list[asyncio.TimerHandle] = []
        self._ignores_sliders = self._will_follow = self._shows_rough = self._closed = False
        self._writes_numbers = False
        self._made_in = _running_loop(), threading.get_ident()
        self.figure = Figure(figsize=size, dpi=dpi, layout="constrained")
        FigureCanvasAgg(self.figure)
        self._axes = self.figure.subplot_mosaic(axes, height_ratios=heights)
        self._picture = Picture(self.figure)
        self._build_widgets()
        values = self.values
        self._draw(self._axes, *self._solve(values), values)
        for name, curves in behind.items():
            leave_behind(self._axes[name], curves, start_name)
        reuse_artists(self.figure)
        self._show()
        self._last_values = values
        stands_here(self)

    # ---- widgets

    def _build_widgets(self) -> None:
        self.sliders = {n: c.widget(self.start[n]) for n, c in self.controls.items()}
        for slider in self.sliders.values():
            slider.observe(lambda _: self._slider_moved(), names="value")
        fields = {n: c.field(self.start[n]) for n, c in self.controls.items()}
        self.fields = {n: field for n, field in fields.items() if field is not None}
        for name, field in self.fields.items():
            field.observe(lambda change, name=name: self._typed(name, change.new), names="value")
        self._asides = {n: widgets.Label() for n, c in self.controls.items() if c.aside}
        # As a data URL: from a blob's URL, which the widget would make of plain bytes, a browser
        # shows it 15 ms later.
        self.image = widgets.Image(format="url", layout=widgets.Layout(width="100%"))
        self.words, self.remarks, self.trouble = (widgets.HTML() for _ in range(3))
        tooltip = "All controls back to where they started"
        self.paper_button = _button("Paper case", tooltip)
        self.paper_button.on_click(lambda _: self._move(self.start, self._slider_moved))
        tooltip = "Python lines that compute this very case"
        self.code_button = _button("Show this as code", tooltip)
        self.code_button.on_click(lambda _: self._show_or_hide_code())
        layout = widgets.Layout(width="100%", max_width="900px", display="none")
        self.code_area = widgets.Textarea(layout=layout)
        self.widget = self._arranged()
        for widget, name in (
            (self.image, "picture"),
            (self.words, "summary"),
            (self.remarks, "remarks"),
            (self.trouble, "error"),
            (self.widget, "panel"),
        ):
            widget.add_class(f"rb-{name}")

    def _arranged(self) -> widgets.Widget:
        """Return everything in its place; `looks` says where that is in a page."""
        controls = _box("controls", [_box("control", self._row(name)) for name in self.controls])
        buttons = _box("buttons", [self.paper_button, self.code_button])
        side = _box("side", [controls, buttons, self.trouble, self.code_area], widgets.VBox)
        words = [self.words, self.remarks]
        main = _box("main", [self.image, *words], widgets.VBox)
        both = _box("both", [side, main])
        size = tuple(DPI * self.figure.get_size_inches())
        both.add_class(class_of(*size))
        return widgets.VBox([both, looks(*size)])

    def _row(self, name: str) -> list[widgets.Widget]:
        """Return a control and what stands beside it."""
        control, slider = self.controls[name], self.sliders[name]
        row = [slider]
        if name in self.fields:
            row.append(self.fields[name])
        if name in self._asides:
            row.append(self._asides[name])
        if control.plays:
            player, link = control.player(slider)
            row.append(player)
            self._links.append(link)
        return row

    # ---- what users ask

    @property
    def values(self) -> dict[str, Any]:
        """What the controls say, in SI units."""
        return {n: c.si_value(self.sliders[n].value) for n, c in self.controls.items()}

    @property
    def code(self) -> str:
        """Python lines that compute the present case, draw it, and give the summary's number."""
        lines = self._code.format(**self.values, x=self.case.points[0])
        return case_lines(self.case, self.controls.values()) + f"{lines}\n"

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
            An unknown control or a value out of range, before anything moves; or what the case says
            to the values.
        RuntimeError
            The panel is closed.
        """
        self._refuse_if_closed()
        for name in values:
            errors.choice("control", name, self.controls)
        self._move({n: self.controls[n].check(v) for n, v in values.items()}, self._show)
        if self.error is not None:
            raise self.error
        return self

    def reset(self) -> Panel:
        """Put all controls back to where they started, as *Paper case* does."""
        self._refuse_if_closed()
        return self.set(**self.start)

    def close(self) -> None:
        """Free all that the panel holds: its widgets, its picture, its results and its case.

        A panel whose cell is run again closes by itself, where no other cell shows it. What the
        notebook keeps of it in ``Out`` is then empty.
        """
        if self._closed:
            return
        self._stop()
        for widget in _with_parts([self.widget, *self._links]):
            widget.unobserve_all()
            widget.close()
        vars(self).clear()
        self._closed = True

    def _refuse_if_closed(self) -> None:
        if self._closed:
            raise RuntimeError(CLOSED)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(CLOSED if vars(self).get("_closed") else f"a panel has no {name}")

    # ---- following a hand

    def _move(self, values: Mapping[str, Any], follow: Callable[[], None]) -> None:
        """Move several controls, and follow once."""
        self._ignores_sliders = True
        try:
            for name, value in values.items():
                self.sliders[name].value = self.controls[name].displayed_value(value)
        finally:
            self._ignores_sliders = False
        follow()

    def _slider_moved(self) -> None:
        """Follow where the panel was made.

        A front end may hand its messages to several threads, in any order.
        """
        if self._ignores_sliders:
            return
        loop, thread = self._made_in
        if loop is None or loop.is_closed() or threading.get_ident() == thread:
            self._follow()
        elif not self._will_follow:
            self._will_follow = True
            loop.call_soon_threadsafe(self._follow)

    def _typed(self, name: str, text: str) -> None:
        """Move a slider to the number typed beside it, or refuse it in words."""
        if self._writes_numbers:
            return
        control, slider = self.controls[name], self.sliders[name]
        try:
            displayed = control.displayed_value(control.read(text))
        except InputError as error:
            self._stop()
            self._show_error(error)
            return
        if displayed == slider.value:
            self._slider_moved()
        slider.value = displayed

    def _write_numbers(self, values: Mapping[str, Any]) -> None:
        self._writes_numbers = True
        for name, field in self.fields.items():
            field.value = self.controls[name].written(values[name])
        self._writes_numbers = False

    def _follow(self) -> None:
        """Show what the controls say now: roughly if that is quicker, and exactly at rest."""
        self._will_follow = False
        if self._closed:
            return None
        loop, values = _running_loop(), self.values
        self._write_numbers(values)
        before, self._last_values = self._last_values, values
        # Without a kernel whose messages have to be answered there is nobody to keep waiting.
        if loop is None or not self._rough or self._key(values) in self._results:
            return self._show()
        self._show(rough=True)
        if self.error is None:
            exactly = self._compute_beside, loop, values, False
            self._timers = [loop.call_later(REST, *exactly)]
            following = self._expected_next(before, values)
            if following is not None:
                ahead = self._compute_beside, loop, following, True
                self._timers.append(loop.call_later(PAUSE, *ahead))

    def _expected_next(
        self, before: Mapping[str, Any], now: Mapping[str, Any]
    ) -> dict[str, Any] | None:
        """Return the values if the last step is followed by another like it.

        None where that cannot be said.
        """
        moved = [self.controls[n] for n in now if now[n] != before[n]]
        if len(moved) != 1 or moved[0].choices or not moved[0].paths:
            return None
        control, name = moved[0], moved[0].name
        value = round(2 * now[name] - before[name], 12)
        return {**now, name: value} if control.low <= value <= control.high else None

    def _compute_beside(
        self, loop: asyncio.AbstractEventLoop, values: dict[str, Any], rough: bool
    ) -> None:
        """Compute a result in a thread; show the exact one if the controls still stand there."""
        move = self._moves

        def stop_if_stale(_: str = "") -> None:
            if self._closed or move != self._moves:
                raise _StaleError

        def work() -> None:
            result = self._solve(values, rough, stop_if_stale)
            stop_if_stale()
            if not rough:
                self._remarks(*result)
            self._say(*result, values)  # works out what the picture needs, which results keep

        def done(task: asyncio.Future) -> None:
            stale = task.cancelled() or isinstance(task.exception(), _StaleError)
            if not (rough or stale or self._closed) and move == self._moves:
                self._show()  # from the results kept; what went wrong goes wrong again, and is said

        loop.run_in_executor(None, work).add_done_callback(done)

    # ---- computing and showing

    def _key(self, values: Mapping[str, Any], rough: bool = False) -> tuple:
        return (rough, *(values[n] for n, c in self.controls.items() if c.paths))

    def _solve(
        self, values: Mapping[str, Any], rough: bool = False, progress: Progress | None = None
    ) -> tuple[Case, Any]:
        """Return the case of some values and its result (that of a coarser one if rough).

        From the results kept if it is there.
        """
        key = self._key(values, rough)
        solved = self._results.get(key)
        if solved is None:
            changes: dict[str, Any] = {}
            for name, control in self.controls.items():
                for path in control.paths:
                    change_at(changes, self._base, path, values[name])
            case = self._base.replace(changes)
            if rough and self._preview is not None:
                result = self._preview(case, progress)
            else:
                result = self._compute(_coarser(case) if rough else case, progress)
            self._results[key] = solved = case, result
            while len(self._results) > RESULTS_KEPT:
                self._results.popitem(last=False)
        return solved

    def _stop(self) -> None:
        """Give up what is being computed for where the controls stood, and what is to come."""
        self._moves += 1
        for timer in self._timers:
            timer.cancel()
        self._timers = []

    def _show(self, rough: bool = False) -> None:
        """Compute, draw, say; an error is said instead, and the picture stays as it was."""
        self._stop()
        values = self.values
        try:
            case, result = self._solve(values, rough)
            keep_limits(self.figure, rough)
            self._draw(self._axes, case, result, values)
            summary = self._say(case, result, values)
            remarks = [] if rough else self._remarks(case, result)
        except (ValueError, RuntimeError, ArithmeticError) as error:
            self._show_error(error)
        else:
            self.case, self.summary, self.error = case, summary, None
            self._show_case(rough)
            self.remarks.value = _as_html(remarks)
        self._write_numbers(values)
        for name, label in self._asides.items():
            label.value = self.controls[name].aside(values[name])

    def _show_case(self, rough: bool) -> None:
        self.image.value = b"data:image/png;base64," + b64encode(self._picture.png())
        note = ""
        if self._preview is not None:
            note = f"<i>{self._preview_note}</i>" if rough else ""
        elif self._rough:
            exact = _ms(self.case.settings.time_step)
            note = f"Time step {exact}."
            if rough:
                note = f"<i>Moving: time step up to {_ms(ROUGH_STEP)}; {exact} follows.</i>"
        self._write_summary(rough, note)
        self.trouble.value = ""
        if self.code_area.layout.display != "none":
            self._write_code()

    def _show_error(self, error: Exception) -> None:
        self.error = error
        self.trouble.value = refusal(error, "(The picture shows the last possible case.)")
        if self._shows_rough:  # nothing follows any more
            told = self._preview_note or f"Time step up to {_ms(ROUGH_STEP)}."
            self._write_summary(False, told)

    def _write_summary(self, rough: bool, note: str) -> None:
        """Write the summary, to be read out where it stays."""
        self._shows_rough = rough
        words = f"<span{'' if rough else ' role=status'}>{escape(self.summary)}</span> {note}"
        self.words.value = f'<div style="line-height:1.35">{words}</div>'

    def _show_or_hide_code(self) -> None:
        hidden = self.code_area.layout.display == "none"
        self._write_code()
        self.code_area.layout.display = "flex" if hidden else "none"
        self.code_button.description = "Hide the code" if hidden else "Show this as code"

    def _write_code(self) -> None:
        """Write the code, and make room for all of its lines."""
        code = self.code
        self.code_area.value, self.code_area.rows = code, len(code.splitlines())

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        """Show the widget, or a sentence where there are no widgets."""
        if self._closed:
            return {"text/plain": CLOSED}
        stands_here(self)
        bundle = self.widget._repr_mimebundle_(include=include, exclude=exclude) or {}
        return {**bundle, "text/plain": FALLBACK}


REMARKS_SHOWN = 3


def _usual_remarks(case: Case, result: Any) -> Sequence[Remark]:
    """Return the remarks on a crossing, or on the input where the result is something else."""
    return case.remarks(result) if isinstance(result, Crossing) else case.doubts


def _as_html(remarks: Sequence[Remark]) -> str:
    """Return what is warned of as a box of a line each, the first few; nothing if there is none."""
    warned = (r for r in remarks if r.warned)
    lines = [escape(str(remark)) for remark in warned]
    if not lines:
        return ""
    more = len(lines) - REMARKS_SHOWN
    rest = [f"And {more} more; see the remarks of the summary."] if more > 0 else []
    words = "<br>".join(lines[:REMARKS_SHOWN] + rest)
    return boxed(words, "note")


def _with_parts(roots: Sequence[widgets.Widget]) -> list[widgets.Widget]:
    """Return widgets with all that belongs to them: what stands in them, layouts, styles."""
    found: dict[widgets.Widget, None] = {}
    waiting = list(roots)
    while waiting:
        widget = waiting.pop()
        if widget not in found:
            found[widget] = None
            values = [getattr(widget, key) for key in widget.keys]
            values += [part for value in values if isinstance(value, tuple) for part in value]
            waiting += [value for value in values if isinstance(value, widgets.Widget)]
    return list(found)


def _box(
    name: str, parts: Sequence[widgets.Widget], kind: type[widgets.Box] = widgets.HBox
) -> widgets.Box:
    """Put parts into a box of the class ``rb-`` and its name."""
    box = kind(parts)
    box.add_class(f"rb-{name}")
    return box


def _button(label: str, tooltip: str) -> widgets.Button:
    """Make a button as wide as its label."""
    layout = widgets.Layout(width="auto")
    return widgets.Button(description=label, tooltip=tooltip, layout=layout)


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.2g} ms"


def _running_loop() -> asyncio.AbstractEventLoop | None:
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None


def _coarser(case: Case) -> Case:
    """Return the case with the time step used while a control moves; never finer than its own."""
    speed = case.settings.speed
    step = default_time_step(case.train, case.track, speed, ROUGH_STEP)
    step = min(step, case.deck.length / 20 / speed)
    if step <= case.settings.time_step:
        return case
    try:
        return case.replace({"run.time_step": step})
    except InputError:  # a lead-in or a notch that needs the case's own step
        return case
