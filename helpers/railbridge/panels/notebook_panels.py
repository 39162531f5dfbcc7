"""The panels of the notebooks: which controls, which pictures and which words each has."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .. import plots
from ..cases.definition import Case
from ..cases.definition import case as load_case
from ..decks import rayleigh
from ..errors import Remark
from ..plots.forces import car_components, mark_instant
from ..plots.scene import crossing_at
from ..plots.style import mode_in_words
from ..results import Crossing
from ..trains import steady_forces
from .control import Control
from .panel import DPI, Panel

__all__ = [
    "deck_modes", "deck_response", "fixed_point", "irregularities", "overview", "rigid_forces",
]  # fmt: skip

ITERATIONS = 4
LOADS = {"condensed": "condensed loads", "bogies": "bogie loads", "wheels": "wheel loads"}

Values = Mapping[str, Any]
Stages = Mapping[int, Crossing]
"""A run as it stood at each iteration."""


# ---- the controls, in their fixed order


def _speed() -> Control:
    def in_km_h(v: float) -> str:
        return f"= {3.6 * v:.1f} km/h"

    return Control(
        "speed", "speed (m/s)", ("run.speed",), 5.0, 80.0, 0.5, unit="m/s", aside=in_km_h
    )


def _wavelength() -> Control:
    paths = ("track.vertical.wavelength", "track.lateral.wavelength")
    return Control("wavelength", "wavelength (m)", paths, 3.0, 40.0, 0.1, unit="m")


def _amplitude() -> Control:
    paths = ("track.vertical.amplitude",)
    return Control("amplitude", "amplitude (mm)", paths, 0.0, 0.010, 0.0005, 1e3, "m")


def _cars() -> Control:
    return Control("cars", "cars", ("train.cars",), 1, 16, 1)


def _iteration() -> Control:
    return Control("iteration", "iteration", (), 0, ITERATIONS, 1, start=ITERATIONS)


def _loads() -> Control:
    return Control("loads", "loads", ("run.loads",), choices=tuple(LOADS))


# ---- the cases they start from

_RIGID = {"run.interaction": "rigid", "run.iterations": None}
_ITERATED = {"run.iterations": ITERATIONS}


def _starting_case(case: Case | None, changes: Values) -> Case:
    """Return the given case, or the paper's, with changes.

    The paper's time step is left to be chosen, since it depends on speed and wavelength.
    """
    if case is None:
        case, changes = load_case("paper"), {"run.time_step": None, **changes}
    return case.replace(changes)


# ---- words and numbers that several panels share


def _conditions_in_words(values: Values) -> str:
    v, waves = values["speed"], f"{values['wavelength']:.1f} m waves"
    if "amplitude" in values:
        waves += f" of {1e3 * values['amplitude']:.1f} mm"
    if "cars" in values:
        waves += f", {values['cars']} car{'s' if values['cars'] > 1 else ''}"
    return f"{v:.1f} m/s ({3.6 * v:.1f} km/h), {waves}: "


def _forcing(values: Values) -> float:
    """Return the forcing frequency, Hz."""
    return values["speed"] / values["wavelength"]


def _by_iteration(case: Case, progress: Callable[[str], None] | None = None) -> Stages:
    """Run a case and return it as it stood at each iteration.

    What each of them works out on demand is kept with it.
    """
    run = case.compute(progress)
    return {i: run.at(i) for i in range(run.iterations + 1)}


def _iteration_in_words(stages: Stages, case: Case, values: Values, plain: bool = False) -> str:
    """Say the displacement, and how far it has settled.

    Plainly: in the words of someone who has not met Eq. 3.
    """
    x, i, last = case.points[0], values["iteration"], stages[max(stages)]
    w, first = (
        1e3 * stages[number].displacement(x).extreme("displacement_z")[0] for number in (i, 0)
    )
    if i == 0:
        change = "rigid-deck forces"
    else:
        deviation = last.deviations.from_rigid[i - 1]
        change = "no waves to measure Eq. 3 against"
        if np.isfinite(deviation):
            compared = "deviation from the rigid deck"
            if plain:
                compared = "the force of car 1 differs from that on a rigid deck by"
            change = f"{compared} {deviation:+.{1 if plain else 3}f} % (Eq. 3)"
        size = last.changes[i - 1]
        if plain:
            change += f"; the wheel forces changed by {100 * size:.2g} % in this iteration"
        else:
            change += f", change of this iteration {size:.1e}"
    loads = LOADS[last.settings.loads] + ("" if plain else ", fixed number of iterations")
    sag = f"displacement at x = {x:g} m is {w:.2f} mm at iteration {i} of {last.iterations}"
    before = f"{first:.2f} mm at iteration 0"
    return f"{_conditions_in_words(values)}{sag} ({loads}), {before}; {change}."


def _of_last(case: Case, stages: Stages) -> list[Remark]:
    """Return the remarks on a run that is shown by iteration: those on its last one."""
    return case.remarks(stages[max(stages)])


_SAG_CODE = ".displacement(x={x:g}).extreme('displacement_z')  # m, s"


# ---- the panels


def irregularities(case: Case | None = None) -> Panel:
    """Panel of notebook 02: the waves under the train, what two wheels meet, the forcing."""

    def draw(axes, case, result, values):
        plots.irregularity(case.track, -40.0, 50.0, ax=axes["track"], deck=case.deck)
        plots.wheels_on_track(case.train, case.track, case.deck.length / 2, axes["track"])
        plots.wheel_paths(case.train, case.track, values["speed"], ax=axes["paths"])
        forcing = {"forcing": _forcing(values)}
        plots.frequencies(case.train.vehicles[0], forcing, axes["frequencies"])

    def say(case, result, values):
        modes, forcing = case.train.vehicles[0].modes(), _forcing(values)
        near = int(np.argmin(np.abs(modes.frequencies_hz - forcing)))
        name = mode_in_words(modes.names[near])
        nearest = f"nearest vehicle frequency {modes.frequencies_hz[near]:.3f} Hz ({name})"
        return f"{_conditions_in_words(values)}forcing frequency {forcing:.3f} Hz, {nearest}."

    return Panel(
        _starting_case(case, _RIGID),
        [_speed(), _wavelength(), _amplitude()],
        [["track"], ["paths"], ["frequencies"]],
        draw,
        say,
        compute=lambda case, _: None,
        code="{speed} / {wavelength}  # Hz, forcing frequency",
        size=(9.0, 6.0),
    )


def rigid_forces(case: Case | None = None) -> Panel:
    """Panel of notebook 03: one car on a rigid deck.

    Its bounce and pitch, with the steady amplitude, and a wheel's force.
    """

    def compute(case, progress):
        return case.compute(progress), _steady_components(case)

    def draw(axes, case, result, values):
        run, steady = result
        names = ("force_z", "moment_y")
        plots.car_forces(run, axes=[axes[n] for n in names], steady=steady, components=names)
        plots.wheel_force(run, ax=axes["wheel"])

    def say(case, result, values):
        run, steady = result
        bounce, pitch = steady["force_z"] / 1e3, steady["moment_y"] / 1e3
        return (
            f"{_conditions_in_words(values)}steady bounce {bounce:.1f} kN, pitch {pitch:.1f} kN m; "
            f"forcing {_forcing(values):.3f} Hz; "
            f"worst wheel unloading {float(run.wheel_unloading.max()):.3f}."
        )

    return Panel(
        _starting_case(case, {**_RIGID, "train.cars": 1}),
        [_speed(), _wavelength(), _amplitude()],
        [["force_z"], ["moment_y"], ["wheel"]],
        draw,
        say,
        compute=compute,
        remarks=lambda case, result: case.remarks(result[0]),
        code="max(abs(run.car_forces(1, static=False)['force_z']))  # N, bounce",
        size=(9.0, 5.8),
        rough=True,
    )


def _steady_components(case: Case) -> dict[str, float]:
    """Return the steady amplitudes of the first car's five components, N and N m."""
    forces = steady_forces(case.train.vehicles[0], case.track, case.options["speed"])
    steady = case.train.car(1).condensed(forces)
    return {name: float(np.abs(amplitude)) for name, amplitude in steady.items()}


def deck_modes(case: Case | None = None) -> Panel:
    """Panel of notebook 04: a mode of the deck, Rayleigh damping, and where the forcing stands."""
    base = _starting_case(case, _RIGID)
    if base.get("deck.damping") is None:
        base = base.replace({"deck.damping": {"ratio": 0.03, "frequencies_hz": [3.307, 16.30]}})

    def compute(case, _):
        damping = case.get("deck.damping")
        return rayleigh(damping["ratio"], damping["frequencies_hz"])

    def draw(axes, case, coefficients, values):
        mode, forcing = values["mode"], {"forcing": _forcing(values)}
        # Only modes have a ratio: the forcing is no mark of this curve.
        marks = {"the mode": case.deck.frequencies_hz[mode - 1]}
        plots.deck_mode(case.deck, mode, axes["mode"])
        plots.frequencies(case.deck, forcing, axes["frequencies"], most=60.0)
        plots.damping(*coefficients, marks, axes["damping"])

    def say(case, coefficients, values):
        i, deck, forcing = values["mode"] - 1, case.deck, _forcing(values)
        frequency, ratio = deck.frequencies_hz[i], 100 * deck.damping_ratios[i]
        return (
            f"{_conditions_in_words(values)}mode {i + 1}, {deck.mode_names[i]}, "
            f"{frequency:.3f} Hz, damping {ratio:.2f} %; "
            f"forcing {forcing:.3f} Hz."
        )

    anchor, damping = "deck.damping.frequencies_hz", ("deck.damping.ratio",)
    most = min(12, len(base.deck.mode_names))
    controls = [
        _speed(),
        _wavelength(),
        Control("mode", "mode", (), 1, most, 1, start=1),
        Control("damping_ratio", "damping (%)", damping, 0.005, 0.1, 0.001, 100.0),
        Control("first_frequency", "at first (Hz)", (f"{anchor}.0",), 0.5, 20.0, 0.001, unit="Hz"),
        Control("second_frequency", "and second (Hz)", (f"{anchor}.1",), 5.0, 60.0, 0.1, unit="Hz"),
    ]
    return Panel(
        base,
        controls,
        [["mode"], ["frequencies"], ["damping"]],
        draw,
        say,
        compute=compute,
        code="case.deck.frequencies_hz[{mode} - 1], case.deck.damping_ratios[{mode} - 1]",
        size=(9.0, 6.8),
        heights=[1.0, 1.0, 1.3],
    )


def deck_response(case: Case | None = None) -> Panel:
    """Panel of notebook 05: displacement and moment at mid-span under rigid-deck forces."""

    def draw(axes, case, run, values):
        plots.displacement(run, case.points[0], axes["displacement"])
        plots.section_force(run, case.points[0], "moment_vertical", axes["moment"])

    def say(case, run, values):
        x = case.points[0]
        w, w_time = run.displacement(x).extreme("displacement_z")
        m, m_time = run.section_forces(x).extreme("moment_vertical")
        return (
            f"{_conditions_in_words(values)}largest at x = {x:g} m are "
            f"{1e3 * w:.2f} mm (t = {w_time:.2f} s) and {m / 1e3:.0f} kN m (t = {m_time:.2f} s), "
            f"{LOADS[run.settings.loads]} under rigid-deck forces."
        )

    return Panel(
        _starting_case(case, _RIGID),
        [_speed(), _wavelength(), _amplitude(), _cars(), _loads()],
        [["displacement"], ["moment"]],
        draw,
        say,
        code=f"run{_SAG_CODE}",
        size=(9.0, 5.0),
        rough=True,
    )


def fixed_point(case: Case | None = None) -> Panel:
    """Panel of notebook 06: an iteration against the rigid deck, and how the changes die out."""

    def draw(axes, case, stages, values):
        which, last = (0, values["iteration"]), stages[max(stages)]
        force, sag = ((axes[n], axes[f"{n} minus"]) for n in ("force", "displacement"))
        plots.iterations(stages, "force_z", which, force)
        plots.iterations(stages, "displacement_z", which, sag, case.points[0])
        plots.convergence(last, axes["changes"])
        plots.deviations(last, axes["deviations"])

    def say(case, stages, values):
        return _iteration_in_words(stages, case, values)

    return Panel(
        _starting_case(case, _ITERATED),
        [_speed(), _wavelength(), _amplitude(), _cars(), _iteration(), _loads()],
        [
            ["force", "displacement"],
            ["force minus", "displacement minus"],
            ["changes", "deviations"],
        ],
        draw,
        say,
        compute=_by_iteration,
        remarks=_of_last,
        code=f"run.at({{iteration}}){_SAG_CODE}",
        size=(9.0, 6.4),
        heights=[1.3, 1.0, 1.1],
        rough=True,
    )


def overview(case: Case | None = None, dpi: float = DPI) -> Panel:
    """Panel of notebook 00, the explorer.

    The train on the moving bridge, five forces, mid-span, spectrum, deviation.

    Parameters
    ----------
    case : Case, optional
    dpi : float
        Dots per inch of the picture; more for a projector.
    """
    base = _starting_case(case, _ITERATED)
    reach = int(np.ceil((base.deck.length + base.train.length) / 10)) * 10

    def draw(axes, case, stages, values):
        x, run, last = case.points[0], stages[values["iteration"]], stages[max(stages)]
        now = values["place"] / values["speed"]
        crossing_at(run, values["place"], axes["train"])
        car_components(run, (axes["forces"], axes["moments"]), now=now)
        plots.displacement(run, x, axes["displacement"])
        mark_instant(axes["displacement"], now)
        plots.spectrum(run, axes["spectrum"], mark={"forcing": _forcing(values)})
        plots.deviations(last, axes["deviations"])

    def say(case, stages, values):
        words = _iteration_in_words(stages, case, values, plain=True)
        return words.removesuffix(".") + f"; forcing {_forcing(values):.3f} Hz."

    place = Control("place", "first axle (m)", (), 0, reach, 1, start=min(100, reach), plays=True)
    return Panel(
        base,
        [_speed(), _wavelength(), _amplitude(), _cars(), _iteration(), place],
        [
            ["train"] * 6,
            ["forces"] * 2 + ["moments"] * 2 + ["displacement"] * 2,
            ["spectrum"] * 3 + ["deviations"] * 3,
        ],
        draw,
        say,
        compute=_by_iteration,
        remarks=_of_last,
        code=f"run.at({{iteration}}){_SAG_CODE}",
        size=(11.0, 5.6),
        heights=[0.75, 1.2, 1.0],
        rough=True,
        dpi=dpi,
    )
