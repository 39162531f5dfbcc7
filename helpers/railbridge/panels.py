"""Interactive panels: a case, a row of controls, one picture that follows them, and the same in words.

A panel keeps one matplotlib figure of its own and moves its curves; the picture goes into an image widget. Nothing physical is
computed here and nothing is styled: results come from the case, drawing from `plots`.

    panel = rb.panels.deck_response()
    panel                                      # in a notebook cell: the sliders
    panel.set(speed=22.0, wavelength=12.0)     # the same by hand; SI units
    panel.summary, panel.figure, panel.case    # what it shows, in words, as a figure, as a case
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from io import BytesIO
from typing import Any

import ipywidgets as widgets
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from . import inputs, plots
from .case import Case
from .case import case as load_case
from .crossing import Crossing
from .deck import rayleigh, rayleigh_ratio
from .inputs import InputError
from .plots.drawing import WIDTH, live
from .train import CONDENSED, steady_forces

__all__ = ["Control", "Panel", "deck_modes", "deck_response", "fixed_point", "irregularities", "overview", "rigid_forces"]

FALLBACK = "Interactive panel: open this notebook in JupyterLab and run this cell to move its sliders."
DPI = 90
LABEL = "9.5em"  # room for the longest label: what does not fit is cut
PASSES = 4
LOADS = {"condensed": "condensed loads", "bogies": "bogie loads", "wheels": "wheel loads"}


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

    def check(self, value: Any) -> Any:
        """Return a value that is within the range, in SI units.

        Raises
        ------
        InputError
            Naming the control, the value and the range.
        """
        if self.choices:
            return inputs.choice(self.name, value, self.choices)
        whole = isinstance(self.step, int)
        if whole:
            return inputs.integer(self.name, value, least=self.low, most=self.high)
        return inputs.number(self.name, value, least=self.low, most=self.high, unit=self.unit, remedy="Panels take SI units")

    def widget(self, value: Any, continuous: bool) -> widgets.Widget:
        """Make the slider or list, showing a value given in SI units."""
        if self.choices:
            return widgets.Dropdown(options=self.choices, value=value, description=self.label, style={"description_width": LABEL})
        whole = isinstance(self.step, int)
        low, high, step, value = (v if whole else round(v * self.factor, 9) for v in (self.low, self.high, self.step, value))
        options = {"readout_format": "d" if whole else ".1f" if step >= 0.1 else ".3f", "continuous_update": continuous}
        make = widgets.IntSlider if whole else widgets.FloatSlider
        layout = widgets.Layout(width="27em")
        style = {"description_width": LABEL}
        return make(value, min=low, max=high, step=step, description=self.label, layout=layout, style=style, **options)

    def value(self, shown: Any) -> Any:
        """Return the SI value of what the widget shows."""
        return shown if self.choices or isinstance(self.step, int) else round(shown / self.factor, 12)

    def shown(self, value: Any) -> Any:
        """Return what the widget shows for an SI value."""
        return value if self.choices or isinstance(self.step, int) else round(value * self.factor, 9)


Draw = Callable[[Mapping[str, Any], Case, Any, Mapping[str, Any]], None]


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
        Result of a case; pure, cached on the controls' values.
    code : str
        Last line of *Show this as code*, formatted with the values: the number that the summary gives.
    height : float
        Inches.
    heights : sequence of float, optional
        Relative heights of the rows.
    continuous : bool
        Whether the picture follows while a slider is dragged; only for panels that answer at once.

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
        compute: Callable[[Case], Any] = Case.run,
        code: str = "",
        height: float = 4.6,
        heights: Sequence[float] | None = None,
        continuous: bool = False,
    ) -> None:
        self.controls = {c.name: _present(c, case) for c in controls}
        self.start = {c.name: c.check(_read(case, c)) for c in self.controls.values()}
        self.error: Exception | None = None
        self.summary = ""
        self.case = self._base = case
        self._draw, self._say, self._line = draw, say, code
        self._solved = lru_cache(maxsize=4)(lambda *values: self._solve(compute, values))
        self.figure = Figure(figsize=(WIDTH, height), dpi=DPI, layout="constrained")
        FigureCanvasAgg(self.figure)
        self._axes = self.figure.subplot_mosaic(axes, height_ratios=heights)
        self._limits: list = []
        self._held = False
        self._build(continuous)
        self._refresh()
        if self.error is not None:
            raise self.error
        live(self.figure)

    def _build(self, continuous: bool) -> None:
        self.sliders = {n: c.widget(self.start[n], continuous) for n, c in self.controls.items()}
        self._asides = {n: widgets.Label() for n in self.controls}
        for slider in self.sliders.values():
            slider.observe(lambda _: self._refresh(), names="value")
        self.image = widgets.Image(format="png", layout=widgets.Layout(width="100%", max_width="900px"))
        self.image.add_class("rb-picture")
        self.words = widgets.HTML()
        self.words.add_class("rb-summary")
        self.trouble = widgets.HTML()
        self.trouble.add_class("rb-error")
        self.paper_button = widgets.Button(description="Paper case", tooltip="All controls back to where they started")
        self.paper_button.on_click(lambda _: self.reset())
        self.code_button = widgets.Button(description="Show this as code", tooltip="Python lines that compute this very case")
        self.code_button.on_click(lambda _: self._show_code())
        self.code_area = widgets.Textarea(rows=14, layout=widgets.Layout(width="100%", max_width="900px", display="none"))
        rows = [widgets.HBox([self.sliders[n], self._asides[n]]) for n in self.controls]
        half = -(-len(rows) // 2)
        beside = widgets.Layout(flex_flow="row wrap", grid_gap="0 1.5em")
        columns = widgets.HBox([widgets.VBox(rows[:half]), widgets.VBox(rows[half:])], layout=beside)
        self.busy = widgets.Label()
        buttons = widgets.HBox([self.paper_button, self.code_button, self.busy])
        self.widget = widgets.VBox([columns, self.image, self.words, self.trouble, buttons, self.code_area])
        self.widget.add_class("rb-panel")

    @property
    def values(self) -> dict[str, Any]:
        """What the controls say, in SI units."""
        return {n: c.value(self.sliders[n].value) for n, c in self.controls.items()}

    @property
    def code(self) -> str:
        """Python lines that compute the present case, and the number that the summary gives."""
        return self.case.code() + (self._line.format(**self.values, x=self.case.points[0]) + "\n" if self._line else "")

    def set(self, **values: Any) -> Panel:
        """Move controls, as by hand: the picture and the summary follow.

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
            inputs.choice("control", name, self.controls)
        checked = {n: self.controls[n].check(v) for n, v in values.items()}
        self._held = True
        try:
            for name, value in checked.items():
                self.sliders[name].value = self.controls[name].shown(value)
        finally:
            self._held = False
        self._refresh()
        if self.error is not None:
            raise self.error
        return self

    def reset(self) -> Panel:
        """Put all controls back to where they started, as *Paper case* does."""
        return self.set(**self.start)

    def _solve(self, compute: Callable[[Case], Any], values: tuple) -> tuple[Case, Any]:
        changes: dict[str, Any] = {}
        for control, value in zip((c for c in self.controls.values() if c.paths), values, strict=True):
            for path in control.paths:
                _put(changes, self._base, path, value)
        case = self._base.replace(changes)
        return case, compute(case)

    def _refresh(self) -> None:
        """Compute, draw, say; an error is said instead, and the picture stays as it was."""
        if self._held:
            return
        values = self.values
        for name, control in self.controls.items():
            self._asides[name].value = control.aside(values[name]) if control.aside else ""
        self.busy.value = "computing ..."
        try:
            case, result = self._solved(*(values[n] for n, c in self.controls.items() if c.paths))
            self._draw(self._axes, case, result, values)
            summary = self._say(case, result, values)
        except (ValueError, RuntimeError, ArithmeticError) as error:
            self.error = error
            said = f"<b>Not possible:</b> {escape(str(error))} (The picture shows the last possible case.)"
            self.trouble.value = f'<span role="alert" style="color:#b00020">{said}</span>'
            return
        finally:
            self.busy.value = ""
        self.case, self.summary, self.error = case, summary, None
        self.image.value = self._png()
        self.words.value = f'<span role="status">{escape(summary)}</span>'
        self.trouble.value = ""
        if self.code_area.layout.display != "none":
            self.code_area.value = self.code

    def _png(self) -> bytes:
        """Render; space for labels is shared out anew only when vertical limits have changed."""
        limits = [ax.get_ylim() for ax in self.figure.axes]
        self.figure.set_layout_engine("none" if limits == self._limits else "constrained")
        self._limits = limits
        buffer = BytesIO()
        self.figure.canvas.print_png(buffer, pil_kwargs={"compress_level": 1})
        return buffer.getvalue()

    def _show_code(self) -> None:
        hidden = self.code_area.layout.display == "none"
        self.code_area.value = self.code
        self.code_area.layout.display = "flex" if hidden else "none"
        self.code_button.description = "Hide the code" if hidden else "Show this as code"

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        """Show the widget, or a sentence where there are no widgets."""
        bundle = self.widget._repr_mimebundle_(include=include, exclude=exclude) or {}
        return {**bundle, "text/plain": FALLBACK}


def _present(control: Control, case: Case) -> Control:
    """Leave out the paths that the case does not have: a level rail has no wavelength."""
    if not control.paths:
        return control
    paths = tuple(p for p in control.paths if _get(case, p) is not None)
    if not paths:
        raise InputError(control.paths[0], None, f"is missing in the case, and the panel's {control.name} needs it", "Give it")
    return Control(**{**control.__dict__, "paths": paths})


def _read(case: Case, control: Control) -> Any:
    return control.start if control.start is not None else _get(case, control.paths[0])


def _get(case: Case, path: str) -> Any:
    parent, _, last = path.rpartition(".")
    return case.get(parent)[int(last)] if last.isdigit() else case.get(path)


def _put(changes: dict[str, Any], case: Case, path: str, value: Any) -> None:
    parent, _, last = path.rpartition(".")
    if last.isdigit():
        values = changes.setdefault(parent, list(case.get(parent)))
        values[int(last)] = value
    else:
        changes[path] = value


# ---- the controls, in their fixed order


def _speed() -> Control:
    return Control(
        "speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5, unit="m/s", aside=lambda v: f"= {3.6 * v:.1f} km/h"
    )  # fmt: skip


def _wavelength() -> Control:
    paths = ("track.vertical.wavelength", "track.lateral.wavelength")
    return Control("wavelength", "wavelength (m)", paths, 3.0, 40.0, 0.1, unit="m")


def _amplitude() -> Control:
    return Control("amplitude", "amplitude (mm)", ("track.vertical.amplitude",), 0.0, 0.010, 0.0005, 1e3, "m")


def _cars() -> Control:
    return Control("cars", "cars", ("train.cars",), 1, 16, 1)


def _iteration(start: int = PASSES) -> Control:
    return Control("iteration", "iteration", (), 0, PASSES, 1, start=start)


def _loads() -> Control:
    return Control("loads", "loads", ("run.loads",), choices=tuple(LOADS))


# ---- the cases they start from


def _based(case: Case | None, changes: Mapping[str, Any]) -> Case:
    """Return the case to start from; the time step is left to be chosen, since it depends on speed and wavelength."""
    if case is None:
        changes = {"run.time_step": None, **changes}
    return (load_case("paper") if case is None else case).replace(changes)


_RIGID = {"run.interaction": "rigid", "run.iterations": None}
_ITERATED = {"run.iterations": PASSES}


def _begin(case: Case, values: Mapping[str, Any]) -> str:
    v, wavelength = values["speed"], values["wavelength"]
    waves = f"{wavelength:.1f} m waves" + (f" of {1e3 * values['amplitude']:.1f} mm" if "amplitude" in values else "")
    cars = values.get("cars")
    train = "" if cars is None else f", {cars} car{'s' if cars > 1 else ''}"
    return f"{v:.1f} m/s ({3.6 * v:.1f} km/h), {waves}{train}: "


def _forcing(values: Mapping[str, Any]) -> float:
    return values["speed"] / values["wavelength"]


def irregularities(case: Case | None = None) -> Panel:
    """Panel of notebook 02: the waves under the train, what two wheels meet, and the forcing frequency."""

    def draw(axes, case, result, values):
        plots.irregularity(case.track, -40.0, 50.0, ax=axes["track"], deck=case.deck)
        plots.wheels_on_track(case.train, case.track, case.deck.length / 2, axes["track"])
        plots.wheel_paths(case.train, case.track, values["speed"], ax=axes["paths"])
        plots.frequencies(case.train.vehicles[0], {"forcing": _forcing(values)}, axes["frequencies"])

    def say(case, result, values):
        f = case.train.vehicles[0].modes()
        near = int(np.argmin(np.abs(f.frequencies_hz - _forcing(values))))
        nearest = f"nearest vehicle frequency {f.frequencies_hz[near]:.3f} Hz ({f.names[near]})"
        return _begin(case, values) + f"forcing frequency {_forcing(values):.3f} Hz, {nearest}."

    return Panel(
        _based(case, _RIGID), [_speed(), _wavelength(), _amplitude()], [["track"], ["paths"], ["frequencies"]], draw, say,
        compute=lambda case: None, code="{speed} / {wavelength}  # Hz, forcing frequency", height=6.2, continuous=True,
    )  # fmt: skip


def _steady(case: Case) -> dict[str, float]:
    """Steady amplitudes of the first car's five components."""
    forces = steady_forces(case.train.vehicles[0], case.track, case.options["speed"])
    return dict(zip(CONDENSED, np.abs(case.train.condensation(0, "condensed").matrix[0] @ forces).tolist(), strict=True))


def rigid_forces(case: Case | None = None) -> Panel:
    """Panel of notebook 03: bounce and pitch of one car on a rigid deck, with the steady amplitude, and a wheel's force."""

    def compute(case):
        return case.run(), _steady(case)

    def draw(axes, case, result, values):
        run, steady = result
        shown = ("force_z", "moment_y")
        plots.car_forces(run, axes=[axes[name] for name in shown], steady=steady, components=shown)
        plots.wheel_force(run, ax=axes["wheel"])

    def say(case, result, values):
        run, steady = result
        static = np.array([w.static_load for w in run.train.wheels])
        unloading = float(np.max(1.0 + run.wheel_forces[:, 1] / static[:, None]))
        forces = f"steady bounce {steady['force_z'] / 1e3:.1f} kN, pitch {steady['moment_y'] / 1e3:.1f} kN m"
        return _begin(case, values) + f"{forces}; forcing {_forcing(values):.3f} Hz; worst wheel unloading {unloading:.3f}."

    line = "max(abs(run.car_forces(1, static=False)['force_z']))  # N, bounce"
    return Panel(
        _based(case, {**_RIGID, "train.cars": 1}), [_speed(), _wavelength(), _amplitude()],
        [["force_z"], ["moment_y"], ["wheel"]], draw, say, compute=compute, code=line, height=6.0,
    )  # fmt: skip


def deck_modes(case: Case | None = None) -> Panel:
    """Panel of notebook 04: a mode of the deck, Rayleigh damping, and where the forcing frequency stands."""
    base = _based(case, _RIGID)
    if base.get("deck.damping") is None:
        base = base.replace({"deck.damping": {"ratio": 0.03, "frequencies_hz": [3.307, 16.30]}})

    def compute(case):
        given = case.get("deck.damping")
        return rayleigh(given["ratio"], given["frequencies_hz"])

    def draw(axes, case, result, values):
        mode = values["mode"]
        f = case.deck.frequencies_hz[mode - 1]
        plots.deck_mode(case.deck, mode, axes["mode"])
        plots.frequencies(case.deck, {"forcing": _forcing(values)}, axes["frequencies"], most=60.0)
        plots.damping(*result, {"forcing": _forcing(values), "the mode": f}, axes["damping"])

    def say(case, result, values):
        i, deck = values["mode"] - 1, case.deck
        mode = (
            f"mode {i + 1}, {deck.mode_names[i]}, {deck.frequencies_hz[i]:.3f} Hz, damping {100 * deck.damping_ratios[i]:.2f} %"
        )
        ratio = 100 * float(rayleigh_ratio(*result, _forcing(values)))
        return _begin(case, values) + f"{mode}; forcing {_forcing(values):.3f} Hz, where damping would be {ratio:.2f} %."

    anchor = "deck.damping.frequencies_hz"
    most = min(12, len(base.deck.mode_names))
    controls = [
        _speed(), _wavelength(), Control("mode", "mode", (), 1, most, 1, start=1),
        Control("damping_ratio", "damping (%)", ("deck.damping.ratio",), 0.005, 0.1, 0.001, 100.0),
        Control("first_frequency", "at first (Hz)", (f"{anchor}.0",), 0.5, 20.0, 0.001, unit="Hz"),
        Control("second_frequency", "and second (Hz)", (f"{anchor}.1",), 5.0, 60.0, 0.1, unit="Hz"),
    ]  # fmt: skip
    line = "case.deck.frequencies_hz[{mode} - 1], case.deck.damping_ratios[{mode} - 1]"
    axes = [["mode"], ["frequencies"], ["damping"]]
    return Panel(base, controls, axes, draw, say, compute=compute, code=line, height=7.2, heights=[1.0, 1.0, 1.3])


def deck_response(case: Case | None = None) -> Panel:
    """Panel of notebook 05: displacement and moment at mid-span under rigid-deck forces."""

    def draw(axes, case, run, values):
        plots.displacement(run, case.points[0], axes["displacement"])
        plots.section_force(run, case.points[0], "moment_vertical", axes["moment"])

    def say(case, run, values):
        x = case.points[0]
        w, t = run.displacement(x).extreme("displacement_z")
        m, at = run.section_forces(x).extreme("moment_vertical")
        where = f"largest at x = {x:g} m are {1e3 * w:.2f} mm (t = {t:.2f} s) and {m / 1e3:.0f} kN m (t = {at:.2f} s)"
        return _begin(case, values) + f"{where}, {LOADS[run.settings.loads]} under rigid-deck forces."

    line = "run.displacement(x={x:g}).extreme('displacement_z')  # m, s"
    controls = [_speed(), _wavelength(), _amplitude(), _cars(), _loads()]
    return Panel(_based(case, _RIGID), controls, [["displacement"], ["moment"]], draw, say, code=line, height=5.0)


def _stages(case: Case) -> dict[int, Crossing]:
    """Run a case and return it as it stood at each iteration; what each works out on demand is kept."""
    run = case.run()
    return {i: run.at(i) for i in range(run.iterations + 1)}


def _said(stages: Mapping[int, Crossing], case: Case, values: Mapping[str, Any], plain: bool = False) -> str:
    """Say the displacement and how far it has settled; plainly, the force against the rigid deck's is all that is said of it."""
    x, i, last = case.points[0], values["iteration"], stages[max(stages)]
    w, first = (1e3 * stages[j].displacement(x).extreme("displacement_z")[0] for j in (i, 0))
    if i == 0:
        change = "rigid-deck forces"
    else:
        deviation = last.deviations.from_rigid[i - 1]
        change = "no waves to measure Eq. 3 against"
        if np.isfinite(deviation):
            compared = "the force of car 1 differs from that on a rigid deck by" if plain else "deviation from the rigid deck"
            change = f"{compared} {deviation:+.{1 if plain else 3}f} % (Eq. 3)"
        change += "" if plain else f", change of this iteration {last.changes[i - 1]:.1e}"
    how = LOADS[last.settings.loads] + ("" if plain else ", fixed number of iterations")
    here = f"displacement at x = {x:g} m is {w:.2f} mm at iteration {i} of {last.iterations} ({how})"
    return _begin(case, values) + f"{here}, {first:.2f} mm at iteration 0; {change}."


def fixed_point(case: Case | None = None) -> Panel:
    """Panel of notebook 06: force and displacement at an iteration against the rigid deck's, and how the changes die out."""

    def draw(axes, case, stages, values):
        which, last = (0, values["iteration"]), stages[max(stages)]
        plots.iterations(stages, "force_z", which, (axes["force"], axes["force minus"]))
        plots.iterations(stages, "displacement_z", which, (axes["displacement"], axes["displacement minus"]), case.points[0])
        plots.convergence(last, axes["changes"])
        plots.deviations(last, axes["deviations"])

    def say(case, stages, values):
        return _said(stages, case, values)

    axes = [["force", "displacement"], ["force minus", "displacement minus"], ["changes", "deviations"]]
    controls = [_speed(), _wavelength(), _amplitude(), _cars(), _iteration(), _loads()]
    line = "run.at({iteration}).displacement(x={x:g}).extreme('displacement_z')  # m, s"
    base = _based(case, _ITERATED)
    return Panel(base, controls, axes, draw, say, compute=_stages, code=line, height=6.6, heights=[1.3, 1.0, 1.1])


def overview(case: Case | None = None) -> Panel:
    """Panel of notebook 00: train on the bridge, force, mid-span displacement, spectrum and deviation, in one picture."""

    def draw(axes, case, stages, values):
        x, here, last = case.points[0], stages[values["iteration"]], stages[max(stages)]
        _, t = here.displacement(x).extreme("displacement_z")
        plots.train_on_deck(here.train, here.deck, axes["train"], values["speed"] * t)
        plots.car_forces(here, axes=[axes["force"]], components=("force_z",))
        plots.displacement(here, x, axes["displacement"])
        plots.spectrum(here, axes["spectrum"], mark={"forcing": _forcing(values)})
        plots.deviations(last, axes["deviations"])

    def say(case, stages, values):
        return _said(stages, case, values, plain=True)

    axes = [["train", "train"], ["force", "displacement"], ["spectrum", "deviations"]]
    controls = [_speed(), _wavelength(), _amplitude(), _cars(), _iteration()]
    line = "run.at({iteration}).displacement(x={x:g}).extreme('displacement_z')  # m, s"
    base = _based(case, _ITERATED)
    return Panel(base, controls, axes, draw, say, compute=_stages, code=line, height=6.2, heights=[0.7, 1.2, 1.2])
