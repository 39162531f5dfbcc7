"""All clauses of the room in one table, for pages and reports."""

from __future__ import annotations

from collections.abc import Callable

from . import damping, dynamicfactors, frequencies, limits, need, ride
from .clauses import Clause

__all__ = ["RULES", "all_clauses", "clauses_frame", "table"]

RULES: tuple[Callable, ...] = (
    need.dynamic_analysis_needed, need.analysis_speeds,
    frequencies.n0_bounds, frequencies.frequency_from_deflection,
    dynamicfactors.phi2, dynamicfactors.phi3, dynamicfactors.determinant_length,
    dynamicfactors.reduced_for_cover, dynamicfactors.phi_prime, dynamicfactors.phi_double_prime,
    dynamicfactors.real_train_factor, dynamicfactors.track_factor,
    dynamicfactors.dynamic_effect, dynamicfactors.dynamic_effect_limit,
    damping.damping_lower_bound, damping.additional_damping, damping.damping_ratio,
    damping.damping_limit,
    limits.acceleration_limit, limits.frequency_limit, limits.kept_modes, limits.twist_limit,
    limits.total_twist_limit, limits.deflection_limit, limits.horizontal_rotation_limit,
    limits.horizontal_radius_limit, limits.lateral_frequency_limit, limits.comfort_limit,
    limits.wheel_unloading_limit, limits.uplift_limit,
    ride.weighting, ride.weighted, ride.weighted_rms, ride.largest_running_rms,
    ride.sperling_weighting, ride.sperling, ride.ride_class_limit,
)  # fmt: skip
"""The functions that have a clause, in the order of a design."""


def all_clauses() -> dict[str, Clause]:
    """Return the clause of each rule, by the name of its function."""
    return {rule.__name__: rule.clause for rule in RULES}


def clauses_frame():
    """Return a pandas DataFrame of all clauses, a row for each function.

    Columns: what, clause, edition, unit, valid, source, grade.
    """
    import pandas as pd

    rows = {
        name: {
            "what": clause.title,
            "clause": clause.name,
            "edition": clause.edition,
            "unit": clause.unit,
            "valid": clause.validity,
            "source": clause.source,
            "grade": clause.grade,
        }
        for name, clause in all_clauses().items()
    }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("function")


def table() -> list[str]:
    """Return the lines of a Markdown table of all clauses."""
    lines = ["| function | gives | unit | clause | valid | source |", "|---|---|---|---|---|---|"]
    for name, clause in all_clauses().items():
        edition = "" if clause.code.startswith("EN 199") else f", {clause.edition}"
        what = f"{clause.title}{', ' + clause.sense if clause.sense else ''}"
        cells = [
            f"`{name}`", what, clause.unit or "-", clause.name + edition, clause.validity,
            clause.source,
        ]  # fmt: skip
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return lines
