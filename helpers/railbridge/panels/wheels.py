"""The panel of notebook 13: wheels with mass on short waves."""

from __future__ import annotations

from .. import plots
from ..cases.definition import Case
from .control import Control
from .panel import Panel
from .shared import (
    amplitude_control,
    conditions_in_words,
    forcing_frequency,
    speed_control,
    starting_case,
)

__all__ = ["wheels_with_mass"]

_SOLVED = {"run.loads": "wheels", "run.iterations": None}
_START = {
    "deck.rail": {"bending_stiffness": 1.28e7, "foundation": 1e8},
    "train.vehicle": "xia2000_planar_wheelsets",
    "train.cars": 1,
    "train.track": 0.0,
    "track.vertical.wavelength": 3.0,
    "track.vertical.amplitude": 5e-3,
    "track.lateral": {"kind": "none"},
    "run.speed": 60.0,
    "run.tail": 0.3,
}


def wheels_with_mass(case: Case | None = None) -> Panel:
    """Panel of notebook 13: the force of an axle with mass, and what the deck feels of it.

    Parameters
    ----------
    case : Case, optional
        With waves; Hertzian contacts ask for wheelsets with mass. If not given, one car of the
        paper on wheelsets, on short waves of a rail on a bed.
    """
    contact = "permanent" if case is None else case.options.get("contact", "permanent")
    changes = {**_SOLVED, "run.contact": contact, **({} if case else _START)}

    def draw(axes, case, run, values):
        plots.wheel_force(run, ax=axes["force"])
        plots.acceleration(run, case.points[0], axes["acceleration"], label="deck")

    def say(case, run, values):
        x, force = case.points[0], -run.wheel_forces[:, 1] / 1e3
        least = max(force.min(), 0.0) if run.parted.any() else force.min()
        largest = run.acceleration(x).extreme("acceleration_z")[0]
        flown = 1e3 * run.settings.time_step * int(run.parted.sum(axis=1).max())
        off = f"; an axle is off the rail for {flown:.0f} ms in all" if flown else ""
        return (
            f"{conditions_in_words(values)}{forcing_frequency(values):.1f} Hz; {values['contact']} "
            f"contact; axle forces from {least:.0f} to {force.max():.0f} kN, at rest "
            f"{run.train.wheels[0].static_load / 1e3:.0f} kN; largest acceleration at x = {x:g} m "
            f"{abs(largest):.2f} m/s2{off}."
        )

    waves = ("track.vertical.wavelength",)
    return Panel(
        starting_case(case, changes),
        [
            speed_control(),
            Control("wavelength", "wavelength (m)", waves, 1.5, 40.0, 0.1, unit="m"),
            amplitude_control(),
            Control("contact", "contact", ("run.contact",), choices=("permanent", "hertz")),
        ],
        [["force"], ["acceleration"]],
        draw,
        say,
        code="run = case.run()\nrb.plots.wheel_force(run)\nrb.plots.acceleration(run, x={x})\n"
        'abs(run.acceleration({x})["acceleration_z"]).max()  # m/s2',
        size=(9.0, 5.0),
        rough=True,
        behind={"force": ["force_z"], "acceleration": ["acceleration_z deck"]},
        start_name="at the start",
    )
