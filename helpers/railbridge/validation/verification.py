"""What is known without this package, beside what the package says.

Each row takes *theirs* from `references`, a closed form or differential equations written down
anew, and *ours* from `crossings`, through the package as any user calls it. Nothing is fitted.
``python -m railbridge.validation`` prints the table.
"""

from __future__ import annotations

from functools import cache

from .beams_and_bars import damping_rows, torsion_rows, two_span_rows
from .crossings import (
    ConvergenceRow,
    convergence_with_modes,
    run_car,
    run_force,
    run_yang_yau,
)
from .moving_cars import car_rows, rose_rows, sprung_mass_rows, standing_car_rows
from .moving_forces import axle_train_rows, moving_force_rows
from .rows import Layout, Row

__all__ = [
    "ConvergenceRow", "cases", "convergence_with_modes", "frame", "main", "report", "run_car",
    "run_force", "run_yang_yau",
]  # fmt: skip

_LAYOUT = Layout("theirs", "ours", ".5g", quantity_width=48, difference_width=10, sources=True)
report, frame = _LAYOUT.report, _LAYOUT.frame


@cache
def cases() -> tuple[Row, ...]:
    """Return every row; about ten seconds the first time."""
    return (
        *moving_force_rows(),
        *sprung_mass_rows(),
        *car_rows(),
        *rose_rows(),
        *axle_train_rows(),
        *standing_car_rows(),
        *two_span_rows(),
        *torsion_rows(),
        *damping_rows(),
    )


def main() -> None:
    """Print the table, and how results settle with the number of modes."""
    print(report(cases()))
    print("\nForce at half the critical speed, no damping: largest values by number of modes")
    print("modes  up to (Hz)  displacement (mm)  moment (kN m)  acceleration (m/s2)")
    for row in convergence_with_modes():
        print(
            f"{row.modes:>5} {row.cut_off:>11.1f} {1e3 * row.displacement:>18.3f}"
            f" {row.moment / 1e3:>14.1f} {row.acceleration:>20.2f}"
        )
