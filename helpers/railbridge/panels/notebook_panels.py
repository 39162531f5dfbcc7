"""The panels of the notebooks: which controls, which pictures and which words each has."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from .. import plots
from ..cases.definition import Case
from ..cases.opening import open_study
from ..damping import rayleigh
from ..decks import Deck
from ..errors import Remark
from ..plots.drawing import reuses_artists
from ..plots.forces import car_components, mark_instant
from ..plots.maps import mark_point
from ..plots.scene import arrow_force, axle_forces, comfortable_exaggeration, crossing_at
from ..plots.speeds import force_over_speed, frequency_met, speeds_in_step
from ..plots.style import mode_in_words
from ..results import Crossing
from ..steady import steady_forces
from ..tracks import Track
from ..trains import AnyTrain
from .control import Control
from .panel import DPI, Panel
from .shared import (
    FREQUENCIES,
    ITERATED,
    LOADS,
    LONGEST,
    RIGID,
    SPEED_GRID,
    SPEEDS,
    Values,
    amplitude_control,
    cars_control,
    conditions_in_words,
    forcing_frequency,
    iteration_control,
    loads_control,
    name_of_start,
    speed_control,
    starting_case,
    wavelength_control,
)

__all__ = [
    "deck_modes", "deck_response", "fixed_point", "irregularities", "map_and_crossing", "overview",
    "rigid_forces",
]  # fmt: skip

ALMOST_ZERO = 0.01  # of a car's weight: below, a force is no measure for another
_NOTHING = "the rigid-deck force is almost zero here, so a per cent figure says nothing"

Stages = Mapping[int, Crossing]
"""A run as it stood at each iteration."""


# ---- words and numbers that several panels share


def _by_iteration(case: Case, progress: Callable[[str], None] | None = None) -> Stages:
    """Run a case and return it as it stood at each iteration.

    What each of them works out on demand is kept with it.
    """
    run = case.compute(progress)
    return {i: run.at(i) for i in range(run.iterations + 1)}


def _sag_in_words(stages: Stages, case: Case, values: Values, how: str = "") -> str:
    """Say the largest displacement at an iteration and at iteration 0."""
    x, i, last = case.points[0], values["iteration"], stages[max(stages)]
    w, first = (
        1e3 * stages[number].displacement(x).extreme("displacement_z")[0] for number in (i, 0)
    )
    sag = f"displacement at x = {x:g} m is {w:.2f} mm at iteration {i} of {last.iterations}"
    loads = LOADS[last.settings.loads] + how
    return f"{conditions_in_words(values)}{sag} ({loads}), {first:.2f} mm at iteration 0; "


def _bounce(run: Crossing) -> np.ndarray:
    """Return the vertical force of the first car over time, without its weight, N."""
    return run.car_forces(1, static=False)["force_z"]


def _is_almost_zero(rigid: Crossing) -> bool:
    """Return whether a car hardly bounces on the rigid deck, so that Eq. 3 divides by nothing."""
    weight = -rigid.train.car(1).static_forces[:, 1].sum()
    return bool(np.abs(_bounce(rigid)).max() < ALMOST_ZERO * weight)


def _change_from_nothing(stages: Stages, i: int) -> str:
    """Say in kN what a per cent figure could not say."""
    change = np.abs(_bounce(stages[i]) - _bounce(stages[0])).max() / 1e3
    return f"{_NOTHING}: it changes by {change:.1f} kN"


class _Story(NamedTuple):
    """What the explorer shows: a run by iteration, and forces by iteration, as they are asked for.

    A run would keep the forces of all of its wheels, ten times as much.
    """

    stages: Stages
    forces: dict[int, tuple[np.ndarray, float]]

    def axles(self, i: int) -> tuple[np.ndarray, float]:
        """Return the forces of the axles over time, and the largest extra force of a wheel, N."""
        if i not in self.forces:
            run = replace(self.stages[i])  # forgotten below, with the forces of its wheels
            at_rest = np.array([wheel.static_load for wheel in run.train.wheels])
            extra = float((-run.wheel_forces[:, 1].min(axis=1) - at_rest).max())
            self.forces[i] = axle_forces(run).astype(np.float32), extra
        return self.forces[i]


def _iteration_in_words(stages: Stages, case: Case, values: Values) -> str:
    """Say the displacement, and how far it has settled."""
    i, last = values["iteration"], stages[max(stages)]
    change = "rigid-deck forces"
    if i > 0:
        deviation = last.deviations.from_rigid[i - 1]
        change = f"deviation from the rigid deck {deviation:+.3f} % (Eq. 3)"
        if _is_almost_zero(stages[0]):
            change = _change_from_nothing(stages, i)
        change += f", change of this iteration {last.changes[i - 1]:.1e}"
    return f"{_sag_in_words(stages, case, values, ', fixed number of iterations')}{change}."


def _story_in_words(story: _Story, case: Case, values: Values) -> str:
    """Say displacement and forces to someone who has not met Eq. 3."""
    i, stages = values["iteration"], story.stages
    last, extra = stages[max(stages)], story.axles(i)[1] / 1e3
    bounce = float(np.abs(_bounce(stages[i])).max()) / 1e3
    force = f"largest extra wheel force {extra:.1f} kN; bounce force of car 1 (its wheels "
    force += f"together, without its weight) up to {bounce:.1f} kN"
    change = "; rigid-deck forces"
    if i > 0:
        change = f", {last.deviations.from_rigid[i - 1]:+.1f} % against a rigid deck (Eq. 3)"
        if _is_almost_zero(stages[0]):
            change = f"; {_change_from_nothing(stages, i)}"
        size = 100 * last.changes[i - 1]
        change += f"; the wheel forces changed by {size:.2g} % in this iteration"
    sag = _sag_in_words(stages, case, values)
    return f"{sag}{force}{change}; forcing {forcing_frequency(values):.3f} Hz."


def _draw_deviations(ax: Any, stages: Stages) -> None:
    nothing = _NOTHING.replace(", so", ",\nso") if _is_almost_zero(stages[0]) else ""
    plots.deviations(stages[max(stages)], ax, instead=nothing)


def _of_last(case: Case, stages: Stages) -> list[Remark]:
    """Return the remarks on a run that is shown by iteration: those on its last one."""
    return case.remarks(stages[max(stages)])


_SAG_CODE = 'run.displacement(x={x}).extreme("displacement_z")  # m, s'
_FORCES_CODE = 'rb.plots.car_forces(run, components=["force_z", "moment_y"])\n'


# ---- the panels


def irregularities(case: Case | None = None) -> Panel:
    """Panel of notebook 02: the waves under the train, what two wheels meet, the forcing."""

    def draw(axes, case, result, values):
        plots.irregularity(case.track, -40.0, 50.0, ax=axes["track"], deck=case.deck)
        plots.wheels_on_track(case.train, case.track, case.deck.length / 2, axes["track"])
        plots.wheel_paths(case.train, case.track, values["speed"], ax=axes["paths"])
        met = SPEED_GRID, values["wavelength"], values["speed"], FREQUENCIES
        frequency_met(case.train.vehicles[0], *met, axes["frequencies"])

    def say(case, result, values):
        modes, forcing = case.train.vehicles[0].modes(), forcing_frequency(values)
        near = int(np.argmin(np.abs(modes.frequencies_hz - forcing)))
        name = mode_in_words(modes.names[near])
        nearest = f"nearest vehicle frequency {modes.frequencies_hz[near]:.3f} Hz ({name})"
        return f"{conditions_in_words(values)}forcing frequency {forcing:.3f} Hz, {nearest}."

    return Panel(
        starting_case(case, RIGID),
        [speed_control(), wavelength_control(), amplitude_control()],
        [["track"], ["paths"], ["frequencies"]],
        draw,
        say,
        compute=lambda case, _: None,
        code="rb.plots.irregularity(case.track, deck=case.deck)\n"
        "forcing = {speed} / {wavelength}  # Hz\n"
        'rb.plots.frequencies(case.train.vehicles[0], {{"forcing": forcing}})\n'
        "forcing",
        size=(9.0, 6.4),
        heights=[1.0, 1.0, 2.0],
        behind={"track": ["vertical"], "paths": ["1 1"], "frequencies": ["met"]},
        start_name=name_of_start(case),
    )


def rigid_forces(case: Case | None = None) -> Panel:
    """Panel of notebook 03: one car on a rigid deck.

    Its bounce and pitch, with the steady amplitude, a wheel's force, and the steady bounce over the
    speed.
    """

    def compute(case, progress):
        steady = _steady_components(case.train, case.track, case.options["speed"])
        return case.compute(progress), steady

    def draw(axes, case, result, values):
        run, steady = result
        modes = run.train.vehicles[0].modes()
        bounce = dict(zip(modes.names, modes.frequencies_hz, strict=True)).get("car z")
        marks = {} if bounce is None else {"car bounce": bounce * values["wavelength"]}
        over_speed = _bounce_over_speed(run.train, case.track)
        now = values["speed"], steady["force_z"]
        force_over_speed(SPEED_GRID, over_speed, now, marks, axes["over_speed"])
        names = ("force_z", "moment_y")
        plots.car_forces(run, axes=[axes[n] for n in names], steady=steady, components=names)
        plots.wheel_force(run, ax=axes["wheel"])

    def say(case, result, values):
        run, steady = result
        bounce, pitch = steady["force_z"] / 1e3, steady["moment_y"] / 1e3
        return (
            f"{conditions_in_words(values)}steady bounce {bounce:.1f} kN, pitch {pitch:.1f} kN m; "
            f"forcing {forcing_frequency(values):.3f} Hz; "
            f"worst wheel unloading {float(run.wheel_unloading.max()):.3f}."
        )

    return Panel(
        starting_case(case, {**RIGID, "train.cars": 1}),
        [speed_control(), wavelength_control(), amplitude_control()],
        [["over_speed", "force_z"], ["wheel", "moment_y"]],
        draw,
        say,
        compute=compute,
        remarks=lambda case, result: case.remarks(result[0]),
        code=f"run = case.run()\n{_FORCES_CODE}rb.plots.wheel_force(run)\n"
        'max(abs(run.car_forces(1, static=False)["force_z"]))  # N, bounce',
        size=(9.0, 5.0),
        rough=True,
        behind={
            "over_speed": ["over speed"],
            "force_z": ["force_z"],
            "moment_y": ["moment_y"],
            "wheel": ["force_z"],
        },
        start_name=name_of_start(case),
    )


def _steady_components(train: AnyTrain, track: Track, speed: float) -> dict[str, float]:
    """Return the steady amplitudes of the first car's five components, N and N m."""
    steady = train.car(1).condensed(steady_forces(train.vehicles[0], track, speed))
    return {name: float(np.abs(amplitude)) for name, amplitude in steady.items()}


@lru_cache(maxsize=2)
def _bounce_over_speed(train: AnyTrain, track: Track) -> np.ndarray:
    """Return the steady bounce force of the first car at the speeds of the grid, N."""
    return np.array([_steady_components(train, track, v)["force_z"] for v in SPEED_GRID])


def deck_modes(case: Case | None = None) -> Panel:
    """Panel of notebook 04: a mode of the deck, Rayleigh damping, and where the forcing stands."""
    base = starting_case(case, RIGID)
    if base.get("deck.damping") is None:
        base = base.replace({"deck.damping": {"ratio": 0.03, "frequencies_hz": [3.307, 16.30]}})

    def compute(case, _):
        damping = case.get("deck.damping")
        return rayleigh(damping["ratio"], damping["frequencies_hz"])

    def draw(axes, case, coefficients, values):
        mode, forcing = values["mode"], {"forcing": forcing_frequency(values)}
        # Only modes have a ratio: the forcing is no mark of this curve.
        marks = {"the mode": case.deck.frequencies_hz[mode - 1]}
        plots.deck_mode(case.deck, mode, axes["mode"])
        plots.frequencies(case.deck, forcing, axes["frequencies"], most=60.0, least=0.1)
        plots.damping(*coefficients, marks, axes["damping"])

    def say(case, coefficients, values):
        i, deck, forcing = values["mode"] - 1, case.deck, forcing_frequency(values)
        frequency, ratio = deck.frequencies_hz[i], 100 * deck.damping_ratios[i]
        return (
            f"{conditions_in_words(values)}mode {i + 1}, {deck.mode_names[i]}, "
            f"{frequency:.3f} Hz, damping {ratio:.2f} %; "
            f"forcing {forcing:.3f} Hz."
        )

    anchor, damping = "deck.damping.frequencies_hz", ("deck.damping.ratio",)
    most = min(12, len(base.deck.mode_names))
    controls = [
        speed_control(),
        wavelength_control(),
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
        code="deck = case.deck\nrb.plots.deck_mode(deck, {mode})\n"
        "rayleigh = rb.rayleigh({damping_ratio}, [{first_frequency}, {second_frequency}])\n"
        "rb.plots.damping(*rayleigh)\n"
        "deck.frequencies_hz[{mode} - 1], deck.damping_ratios[{mode} - 1]  # Hz, -",
        size=(9.0, 6.8),
        heights=[1.0, 1.0, 1.3],
        behind={"damping": ["total"]},
        start_name=name_of_start(case),
    )


def deck_response(case: Case | None = None) -> Panel:
    """Panel of notebook 05: displacement and moment at mid-span under rigid-deck forces.

    Below, the speeds at which cars or waves keep step with the deck.
    """

    def draw(axes, case, run, values):
        plots.displacement(run, case.points[0], axes["displacement"])
        plots.section_force(run, case.points[0], "moment_vertical", axes["moment"])
        in_step = _speeds_in_step(case.train, case.deck, values["wavelength"])
        speeds_in_step(in_step, values["speed"], SPEEDS, axes["in_step"])

    def say(case, run, values):
        x = case.points[0]
        w, w_time = run.displacement(x).extreme("displacement_z")
        m, m_time = run.section_forces(x).extreme("moment_vertical")
        return (
            f"{conditions_in_words(values)}largest at x = {x:g} m are "
            f"{1e3 * w:.2f} mm (t = {w_time:.2f} s) and {m / 1e3:.0f} kN m (t = {m_time:.2f} s), "
            f"{LOADS[run.settings.loads]} under rigid-deck forces."
        )

    return Panel(
        starting_case(case, RIGID),
        [
            speed_control(),
            wavelength_control(),
            amplitude_control(),
            cars_control(),
            loads_control(),
        ],
        [["displacement"], ["moment"], ["in_step"]],
        draw,
        say,
        code="run = case.run()\nrb.plots.displacement(run, x={x})\n"
        f"rb.plots.section_force(run, x={{x}})\n{_SAG_CODE}",
        size=(9.0, 5.4),
        heights=[1.0, 1.0, 0.35],
        rough=True,
        behind={"displacement": ["displacement_z "], "moment": ["moment_vertical "]},
        start_name=name_of_start(case),
    )


def _speeds_in_step(train: AnyTrain, deck: Deck, wavelength: float) -> dict[str, list[float]]:
    """Return the speeds at which cars and waves keep step with the first vertical mode, m/s.

    Those of the cars for 1 to 4 swings from one car to the next (Eq. 5.4 of notebook 05); one car
    alone has none.
    """
    named = zip(deck.mode_names, deck.frequencies_hz, strict=True)
    first = next((f for name, f in named if name.startswith("vertical")), deck.frequencies_hz[0])
    spacing = train.car(2).centre - train.car(1).centre if len(train.formation) > 1 else np.nan
    cars = [float(first * spacing / i) for i in (1, 2, 3, 4)]
    return {"cars in step": cars, "waves in step": [float(first * wavelength)]}


def fixed_point(case: Case | None = None) -> Panel:
    """Panel of notebook 06: an iteration against the rigid deck, and how the changes die out."""

    def draw(axes, case, stages, values):
        which, last = (0, values["iteration"]), stages[max(stages)]
        force, sag = ((axes[n], axes[f"{n} minus"]) for n in ("force", "displacement"))
        plots.iterations(stages, "force_z", which, force)
        plots.iterations(stages, "displacement_z", which, sag, case.points[0])
        plots.convergence(last, axes["changes"])
        _draw_deviations(axes["deviations"], stages)

    def say(case, stages, values):
        return _iteration_in_words(stages, case, values)

    return Panel(
        starting_case(case, ITERATED),
        [
            speed_control(),
            wavelength_control(),
            amplitude_control(),
            cars_control(),
            iteration_control(),
            loads_control(),
        ],
        [
            ["force", "displacement"],
            ["force minus", "displacement minus"],
            ["changes", "deviations"],
        ],
        draw,
        say,
        compute=_by_iteration,
        remarks=_of_last,
        code="run = case.run()\nrb.plots.convergence(run)\n"
        'rb.plots.iterations(run, "force_z", which=(0, {iteration}))\n'
        f"run = run.at({{iteration}})\n{_SAG_CODE}",
        size=(9.0, 6.4),
        heights=[1.3, 1.0, 1.1],
        rough=True,
        behind={
            "force": ["rank 1"],
            "force minus": ["rank 0"],
            "displacement": ["rank 1"],
            "displacement minus": ["rank 0"],
            "changes": ["changes None"],
            "deviations": ["rigid None", "previous None"],
        },
        start_name=name_of_start(case),
    )


def map_and_crossing(
    case: Case | None = None, study: Any = None, quantity: str = "deviation_wheel_force_z"
) -> Panel:
    """Panel of notebook 07: a dot on the map of speed and wavelength, and the crossing it is.

    Parameters
    ----------
    case : Case, optional
        Of which one car crosses, with true wheel loads and four iterations.
    study : xarray.Dataset, optional
        The map; default that of the paper's car and deck.
    quantity : str
        Variable of the study.
    """
    study = open_study("speed_wavelength") if study is None else study
    planar = {"train.vehicle": "xia2000_planar"} if case is None else {}
    alone = {**planar, **ITERATED, "train.cars": 1, "run.loads": "wheels"}
    # The dot reaches all of the map, in whole steps of the sliders.
    fastest, longest = float(study.speed.max()), float(study.wavelength.max())
    fastest = max(SPEEDS[1], np.floor(2.0 * fastest) / 2.0)
    longest = max(LONGEST, np.floor(10.0 * longest) / 10.0)

    def draw(axes, case, stages, values):
        if not reuses_artists(axes["map"]):
            plots.map(study, quantity, axes["map"])
        mark_point(axes["map"], "now", values["speed"], values["wavelength"])
        which = (0, max(stages))
        plots.iterations(stages, "force_z", which, (axes["force"], axes["force minus"]))
        plots.displacement(stages[max(stages)], case.points[0], axes["displacement"])

    def say(case, stages, values):
        x, heaviest, sags = case.points[0], [], []
        for i in (0, max(stages)):
            heaviest.append(-stages[i].wheel_forces[:, 1].min() / 1e3)
            sags.append(1e3 * stages[i].displacement(x).extreme("displacement_z")[0])
        return (
            f"{conditions_in_words(values)}forcing {forcing_frequency(values):.3f} Hz; "
            f"heaviest wheel or axle {heaviest[1]:.1f} kN, {heaviest[0]:.1f} kN on a rigid deck "
            f"({100 * (heaviest[1] / heaviest[0] - 1):+.1f} %); displacement at x = {x:g} m "
            f"{sags[1]:.2f} mm, {sags[0]:.2f} mm under rigid-deck forces "
            f"({100 * (sags[1] / sags[0] - 1):+.1f} %)."
        )

    right = ["force", "force minus", "displacement"]
    return Panel(
        starting_case(case, alone),
        [speed_control((SPEEDS[0], fastest)), wavelength_control(longest)],
        [["map", name] for name in right],
        draw,
        say,
        compute=_by_iteration,
        remarks=_of_last,
        code="run = case.run()\nrb.plots.iterations(run, which=(0, 4))\n"
        f'rb.plots.map(rb.open_study("speed_wavelength"), "{quantity}")\n{_SAG_CODE}',
        size=(11.0, 5.6),
        heights=[1.4, 1.0, 1.4],
        rough=True,
        behind={
            "force": ["rank 1"],
            "force minus": ["rank 0"],
            "displacement": ["displacement_z "],
        },
        start_name=name_of_start(case),
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
    base = starting_case(case, ITERATED)
    reach = int(np.ceil((base.deck.length + base.train.length) / 10)) * 10
    scales: dict[str, float] = {}  # of the sketch at the start: it never magnifies more

    def compute(case, progress):
        return _Story(_by_iteration(case, progress), {})

    def draw(axes, case, story, values):
        x, stages, now = case.points[0], story.stages, values["place"] / values["speed"]
        run, (forces, _) = stages[values["iteration"]], story.axles(values["iteration"])
        if not scales:
            scales.update(exaggeration=comfortable_exaggeration(run), force=arrow_force(forces))
        crossing_at(run, values["place"], axes["train"], forces=forces, **scales)
        car_components(run, (axes["forces"], axes["moments"]), now=now)
        plots.displacement(run, x, axes["displacement"])
        mark_instant(axes["displacement"], now)
        plots.spectrum(
            run, axes["spectrum"], mark={"forcing": forcing_frequency(values)}, most=30.0
        )
        _draw_deviations(axes["deviations"], stages)

    def say(case, story, values):
        return _story_in_words(story, case, values)

    place = Control("place", "first axle (m)", (), 0, reach, 1, start=min(100, reach), plays=True)
    return Panel(
        base,
        [
            speed_control(),
            wavelength_control(),
            amplitude_control(),
            cars_control(),
            iteration_control(),
            place,
        ],
        [
            ["train"] * 6,
            ["forces"] * 2 + ["moments"] * 2 + ["displacement"] * 2,
            ["spectrum"] * 3 + ["deviations"] * 3,
        ],
        draw,
        say,
        compute=compute,
        remarks=lambda case, story: _of_last(case, story.stages),
        code="run = case.run().at({iteration})\nrb.plots.displacement(run, x={x})\n"
        f"{_FORCES_CODE}{_SAG_CODE}",
        size=(11.0, 5.6),
        heights=[1.45, 1.2, 1.0],
        rough=True,
        dpi=dpi,
        behind={
            "forces": ["force_z"],
            "moments": ["moment_y"],
            "displacement": ["displacement_z "],
            "spectrum": ["spectrum  heads"],
            "deviations": ["rigid None", "previous None"],
        },
        start_name=name_of_start(case),
    )
