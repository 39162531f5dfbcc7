"""Interactive panels: a case, a row of controls, one picture that follows them, and the same in words.

A panel keeps one matplotlib figure of its own and moves its curves; the picture goes into an image widget. Nothing physical is
computed here and nothing is styled: results come from the case, drawing from `plots`.

    panel = rb.panels.deck_response()
    panel                                      # in a notebook cell: the sliders
    panel.set(speed=22.0, wavelength=12.0)     # the same by hand; SI units
    panel.summary, panel.figure, panel.case    # what it shows, in words, as a figure, as a case
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import plots
from ..cases.definition import Case
from ..cases.definition import case as load_case
from ..decks import rayleigh, rayleigh_ratio
from ..plots.drawing import in_words
from ..plots.scene import car_components, crossing_at, mark_now
from ..results import Crossing
from ..trains import CONDENSED, steady_forces
from .control import Control
from .panel import DPI, FALLBACK, Panel

__all__ = [
    "FALLBACK", "Control", "Panel", "deck_modes", "deck_response", "fixed_point", "irregularities", "overview", "rigid_forces",
]  # fmt: skip

PASSES = 4
LOADS = {"condensed": "condensed loads", "bogies": "bogie loads", "wheels": "wheel loads"}


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
        nearest = f"nearest vehicle frequency {f.frequencies_hz[near]:.3f} Hz ({in_words(f.names[near])})"
        return _begin(case, values) + f"forcing frequency {_forcing(values):.3f} Hz, {nearest}."

    return Panel(
        _based(case, _RIGID), [_speed(), _wavelength(), _amplitude()], [["track"], ["paths"], ["frequencies"]], draw, say,
        compute=lambda case, _: None, code="{speed} / {wavelength}  # Hz, forcing frequency", size=(9.0, 6.0),
    )  # fmt: skip


def _steady(case: Case) -> dict[str, float]:
    """Steady amplitudes of the first car's five components."""
    forces = steady_forces(case.train.vehicles[0], case.track, case.options["speed"])
    resultant = np.tensordot(case.train.car(1).condensation("condensed").matrix[0], forces, 2)
    return dict(zip(CONDENSED, np.abs(resultant).tolist(), strict=True))


def rigid_forces(case: Case | None = None) -> Panel:
    """Panel of notebook 03: bounce and pitch of one car on a rigid deck, with the steady amplitude, and a wheel's force."""

    def compute(case, progress):
        return case.run(progress), _steady(case)

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
        [["force_z"], ["moment_y"], ["wheel"]], draw, say, compute=compute, code=line, size=(9.0, 5.8), rough=True,
    )  # fmt: skip


def deck_modes(case: Case | None = None) -> Panel:
    """Panel of notebook 04: a mode of the deck, Rayleigh damping, and where the forcing frequency stands."""
    base = _based(case, _RIGID)
    if base.get("deck.damping") is None:
        base = base.replace({"deck.damping": {"ratio": 0.03, "frequencies_hz": [3.307, 16.30]}})

    def compute(case, _):
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
    return Panel(base, controls, axes, draw, say, compute=compute, code=line, size=(9.0, 6.8), heights=[1.0, 1.0, 1.3])


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
    axes = [["displacement"], ["moment"]]
    return Panel(_based(case, _RIGID), controls, axes, draw, say, code=line, size=(9.0, 5.0), rough=True)


def _stages(case: Case, progress: Any = None) -> dict[int, Crossing]:
    """Run a case and return it as it stood at each iteration; what each works out on demand is kept."""
    run = case.run(progress)
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
        settled = f"the wheel forces changed by {100 * last.changes[i - 1]:.2g} % in this iteration"
        change += f"; {settled}" if plain else f", change of this iteration {last.changes[i - 1]:.1e}"
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
    size, heights = (9.0, 6.4), [1.3, 1.0, 1.1]
    return Panel(base, controls, axes, draw, say, compute=_stages, code=line, size=size, heights=heights, rough=True)


def overview(case: Case | None = None, dpi: float = DPI) -> Panel:
    """Panel of notebook 00, the explorer: the train on the moving bridge, five forces, mid-span, spectrum, deviation.

    `dpi`: dots per inch of the picture; more for a projector.
    """
    base = _based(case, _ITERATED)
    reach = int(np.ceil((base.deck.length + base.train.length) / 10)) * 10

    def draw(axes, case, stages, values):
        x, here, last = case.points[0], stages[values["iteration"]], stages[max(stages)]
        now = values["place"] / values["speed"]
        crossing_at(here, values["place"], axes["train"])
        car_components(here, (axes["forces"], axes["moments"]), now=now)
        plots.displacement(here, x, axes["displacement"])
        mark_now(axes["displacement"], now)
        plots.spectrum(here, axes["spectrum"], mark={"forcing": _forcing(values)})
        plots.deviations(last, axes["deviations"])

    def say(case, stages, values):
        return _said(stages, case, values, plain=True).removesuffix(".") + f"; forcing {_forcing(values):.3f} Hz."

    axes = [["train"] * 6, ["forces"] * 2 + ["moments"] * 2 + ["displacement"] * 2, ["spectrum"] * 3 + ["deviations"] * 3]
    place = Control("place", "first axle (m)", (), 0, reach, 1, start=min(100, reach), plays=True)
    controls = [_speed(), _wavelength(), _amplitude(), _cars(), _iteration(), place]
    line = "run.at({iteration}).displacement(x={x:g}).extreme('displacement_z')  # m, s"
    return Panel(
        base, controls, axes, draw, say,
        compute=_stages, code=line, size=(11.0, 5.6), heights=[0.75, 1.2, 1.0], rough=True, dpi=dpi,
    )  # fmt: skip
