"""How the body of a car accelerates while it rides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..results import Crossing
from .drawing import TIME_LABEL, axes_or_new_grid, label_axes, quantity_curve
from .forces import shade_car
from .style import GREY, literal, other_shade, style_of

__all__ = ["WAYS", "body_rows", "car_body"]

WAYS = ("acceleration_z", "acceleration_y")


def body_rows(
    run: Crossing, car: int = 1, components: Sequence[str] = WAYS
) -> list[tuple[str, str]]:
    """Return what `car_body` draws one below the other: a body and a quantity each.

    The body's name is empty where the car has but one.
    """
    history = run.car_accelerations(car)
    components = [errors.choice("components", way, WAYS) for way in components]
    bodies = [body.name for body in run.train.car(car).vehicle.car_bodies]
    return [
        (body, way)
        for body in (bodies if len(bodies) > 1 else [""])
        for way in components
        if not np.isnan(history[f"{body} front {way}".lstrip()]).all()
    ]


def car_body(
    run: Crossing,
    car: int = 1,
    axes: Sequence[Axes] | None = None,
    components: Sequence[str] = WAYS,
) -> np.ndarray:
    """Plot the accelerations of a car's body over time: front, middle and rear.

    Vertical above lateral, as far as the body can move; of an articulated car those of every coach,
    front to back.

    Parameters
    ----------
    run : Crossing
    car : int
        From 1.
    axes : sequence of Axes, optional
        As many as there are rows.
    components : sequence of {"acceleration_z", "acceleration_y"}

    Returns
    -------
    ndarray of Axes

    Raises
    ------
    InputError
        No such car, or bare axle loads, which have no bodies.
    """
    history, rows = run.car_accelerations(car), body_rows(run, car, components)
    axes = axes_or_new_grid(axes, len(rows), 1, 0.7 + 1.9 * len(rows), sharex=True)
    for ax, (body, way) in zip(axes, rows, strict=True):
        first, style = ax is axes[0], style_of(way)
        shade_car(run, car, ax, label=first)
        looks = (
            ("front", {"color": style.colour, "lw": 1.8}),
            ("middle", {"color": GREY, "lw": 1.2, "zorder": 2.5}),
            ("rear", {"color": other_shade(style.colour), "lw": 1.2}),
        )
        for place, look in looks:
            values = history[f"{body} {place} {way}".lstrip()]
            line = {"name": place, "label": place if first else None, "ls": "-", **look}
            quantity_curve(ax, way, run.time, values, **line)
        title = f"{literal(body)} of car {car}" if body else None
        label_axes(ax, TIME_LABEL if ax is axes[-1] else "", style.label, title)
    axes[0].figure.align_ylabels(axes)
    return axes
