"""What the rules say before any train runs: factors, bounds, and which speeds must be covered."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .. import codes
from ..codes import Answer, Clause
from ..codes.clauses import not_above
from .questions import Questions
from .structure import Structure

__all__ = ["COARSEST", "coverage", "line_gaps", "rules", "speed_gaps"]

COARSEST = 5.0
"""m/s between speeds; our own bound, for codes say only that they must be finer at resonance."""

_NEAR = 0.95
"""Share of the line's speed from which on a crossing stands for it in the coaches."""


def rules(structure: Structure, questions: Questions) -> dict[str, Answer]:
    """Return the answers of the rules for a deck and a line, by name.

    Parameters
    ----------
    structure : Structure
    questions : Questions

    Returns
    -------
    dict of Answer
        Undecided with a reason where something is not known. phi' and phi'' are those at the
        speed of the line.
    """
    needs, span = structure.needs, structure.longest
    v, n0, length = needs.line_speed, structure.n0, structure.length_of(span)
    missing = "" if n0 is not None else "the deck has no mode of vertical bending"
    missing = missing or ("" if length.decided else length.reason)

    def known(rule, *more, **options) -> Answer:
        if missing:
            return Answer(None, rule.clause, missing)
        return rule(float(length), n0, v, *more, **options)

    bounds = codes.n0_bounds
    lower, upper = (
        bounds(float(length)) if length.decided else [Answer(None, bounds.clause, missing)] * 2
    )
    if needs.kind is None or not length.decided:
        reason = "the kind of bridge is not given (kind)" if needs.kind is None else length.reason
        damping = Answer(None, codes.damping_lower_bound.clause, reason)
    else:
        damping = codes.damping_lower_bound(needs.kind, float(length))
    slowest, fastest = codes.analysis_speeds(v)
    maintained = {"maintained": needs.careful_track}
    return {
        "dynamic_analysis_needed": known(codes.dynamic_analysis_needed, simple=structure.simple),
        "n0_lower_bound": lower,
        "n0_upper_bound": upper,
        "n0_within_bounds": _within(lower, upper, n0, missing, bounds.clause),
        "slowest_analysis_speed": slowest,
        "fastest_analysis_speed": fastest,
        "determinant_length": length,
        "phi2" if needs.careful_track else "phi3": structure.phi_of(span),
        "phi_prime": known(codes.phi_prime),
        "phi_double_prime": known(codes.phi_double_prime),
        "real_train_factor": known(codes.real_train_factor, **maintained),
        "track_factor": known(codes.track_factor),
        "damping_lower_bound": damping,
        "frequency_limit": questions.kept.limit,
    }


def _within(lower: Answer, upper: Answer, n0: float | None, missing: str, clause: Clause) -> Answer:
    """Return whether the first frequency is within Figure 6.10."""
    if missing or not lower.decided:
        return Answer(None, clause, missing or lower.reason)
    inside = not_above(float(lower), n0) and not_above(n0, float(upper))
    return Answer(inside, clause, f"n0 = {n0:.4g} Hz")


def coverage(found: dict[str, Answer], speeds: Sequence[float], chosen: bool = False) -> Answer:
    """Return whether speeds cover a dynamic analysis: 40 m/s to 1.2 times the line's.

    In steps of at most `COARSEST`, where they were not chosen finer beside peaks. That a peak lies
    between two of them is not said by that: it may be narrower.

    Parameters
    ----------
    found : dict of Answer
        See `rules`.
    speeds : sequence of float
        m/s.
    chosen : bool
        Whether they are those of `studies.Between`.
    """
    slowest, fastest = found["slowest_analysis_speed"], found["fastest_analysis_speed"]
    clause, own = slowest.clause, f"{min(speeds):.4g} to {max(speeds):.4g} m/s"
    if len(speeds) == 1:
        own = f"only {speeds[0]:.4g} m/s"
    if not slowest.decided:
        return Answer(None, clause, slowest.reason)
    asked = f"{float(slowest):.4g} to {float(fastest):.4g} m/s"
    low = not_above(min(speeds), float(slowest))
    if low and not_above(float(fastest), max(speeds)):
        step = float(np.diff(np.sort(speeds)).max(initial=0.0))
        if not chosen and not not_above(step, COARSEST):
            reason = f"{own} in steps of up to {step:.3g} m/s pass over resonances"
            return Answer(False, clause, f"{reason}; at most {COARSEST:g} m/s, or Between")
        return Answer(True, clause, f"{len(speeds)} speeds, {own}, where {asked} are asked for")
    return Answer(False, clause, f"{own} do not cover {asked}")


def speed_gaps(
    found: dict[str, Answer], speeds: Sequence[float], line_speed: float
) -> tuple[str, ...]:
    """Return what the speeds leave out: of a dynamic analysis, if one is or may be needed.

    Else of those up to the line's, m/s, which they must reach.
    """
    need, covered = found["dynamic_analysis_needed"], found["speeds_covered"]
    if covered.decided and bool(covered):
        return ()
    if need.decided and not bool(need):
        if not_above(line_speed, max(speeds)):
            return ()
        return (f"speeds: {max(speeds):.4g} m/s does not reach the line's {line_speed:.4g} m/s",)
    return (f"speeds: {covered.reason}",)


def line_gaps(speeds: Sequence[float], line_speed: float) -> tuple[str, ...]:
    """Return what is missing where no crossing up to the line's speed (m/s) is near it."""
    up_to = [speed for speed in speeds if not_above(speed, line_speed)]
    if not up_to or not_above(_NEAR * line_speed, max(up_to)):
        return ()
    most = f"{max(up_to):.4g} m/s is the fastest up to the line's {line_speed:.4g} m/s"
    return (f"speeds: {most}, give one from {_NEAR * line_speed:.4g} m/s on",)
