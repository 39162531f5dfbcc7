"""Clauses that trains decide: accelerations, moments, twist, coaches, wheels, bearings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import codes
from ..cautions import ends_move
from ..codes import Answer
from ..codes.clauses import not_above
from ..codes.verdicts import NOT_MET
from ..errors import counted
from ..studies import Output
from .judging import Finding, Point, Points, finding, undecided
from .questions import Questions
from .staticloads import StaticLoads
from .structure import Span, Structure
from .trust import ACCELERATION, ALL, UNLOADING, Trust

__all__ = ["TrainClauses"]

_NO_CROSSING = "no crossing was computed"
_SIDEWAYS = "rigid sideways in this model: give the deck a lateral bending stiffness"
_OTHER_LOADS = "of the trains' own forces only: wind, nosing and centrifugal forces are not in it"
_PERFECT = "on a perfect track: give its irregularity"
_MOVING_END = (
    "an end of the deck moves and wheels step on or off there, which shakes it more than a real "
    "one: give the deck a rail on a bed"
)
_UNFELT = "the cars do not feel the deck (interaction = 'rigid')"
_STRAIGHT = 1e-9
"""1/m: a deck bent less has a radius of no interest."""


@dataclass(frozen=True, eq=False)
class TrainClauses:
    """What decides over trains besides their crossings.

    Attributes
    ----------
    structure : Structure
    questions : Questions
    loads : StaticLoads
        The load models on the trains' track.
    trust : Trust
        Which crossings' numbers may decide.
    smooth : bool
        Whether the rails are level, whatever the wheels are.
    gaps : tuple of str
        What the speeds leave out of a dynamic analysis.
    slow : tuple of str
        What they leave out below the speed of the line.
    unfelt : bool
        Whether the cars run as on a rigid deck.
    """

    structure: Structure
    questions: Questions
    loads: StaticLoads
    trust: Trust
    smooth: bool = True
    gaps: tuple[str, ...] = ()
    slow: tuple[str, ...] = ()
    unfelt: bool = False

    def findings(self, points: Points) -> list[Finding]:
        """Return a verdict for each clause, the worst of some crossings."""
        own = {self.acceleration: ACCELERATION, self.unloading: UNLOADING}
        clauses = (
            self.acceleration, self.moment, self.twist, self.total_twist, self.end_rotation,
            self.radius, self.comfort, self.unloading, self.uplift,
        )  # fmt: skip
        return [self._trusted(clause, points, own.get(clause, ALL)) for clause in clauses]

    def _trusted(self, clause: Callable[[Points], Finding], points: Points, judged: str) -> Finding:
        """Return a verdict to which crossings that are not to be trusted add nothing but doubt.

        What the others do not meet already is not met.
        """
        found, doubts = clause(points), self.trust.doubts(points, judged)
        if not any(doubts):
            return found
        sure = clause(points.only([not doubt for doubt in doubts]))
        if sure.verdict.verdict == NOT_MET:
            return sure
        own = [(p, doubt) for p, doubt in zip(points.points, doubts, strict=True) if doubt]
        point, why = own[0]
        if len(points) > 1:
            why = f"{len(own)} of {len(points)} crossings, as {point.words}: {why}"
        return undecided(found, why)

    # ---- deck

    def acceleration(self, points: Points) -> Finding:
        """Judge the largest vertical acceleration of the deck, of the modes kept."""
        kept, limit = self.questions.kept, codes.acceleration_limit(self.structure.needs.track)
        frequencies = self.structure.deck.frequencies_hz
        gaps, reason = self._gaps(points), ""
        if not kept.limit.decided:
            gaps.append(f"of all {len(frequencies)} modes: {kept.limit.reason}")
        else:
            numbers = "1" if len(kept.numbers) == 1 else f"1-{len(kept.numbers)}"
            reason = f"modes {numbers} up to {float(kept.limit):.4g} Hz"
            if not kept.complete:
                gaps.append(f"the deck's last mode has {frequencies.max():.4g} Hz: modes may miss")
        if not len(points):
            return finding(None, limit, gaps, reason=_NO_CROSSING)
        value, output, point = self._largest(points, self.questions.accelerations)
        if ends_move(self.structure.deck):
            words = "; ".join(
                [f"{value:.4g} m/s2 as computed", _MOVING_END, *filter(None, [reason])]
            )
            found = finding(None, limit, gaps, point=point, where=output.x, reason=words)
            return replace(found, value=value)
        return finding(value, limit, gaps, point=point, where=output.x, reason=reason)

    def moment(self, points: Points) -> Finding:
        """Judge moments at mid-span by dynamic analysis beside Phi times the load models.

        Of several spans the one of largest utilisation.
        """
        if not self.questions.moments:
            lacks = self.structure.deck.recovery.lacks or "the deck knows no lines of bearings"
            return finding(None, Answer(None, codes.dynamic_effect_limit.clause, lacks))
        found = [
            self._moment(points, point, k, span, output)
            for span, output in self.questions.moments
            for k, point in enumerate(points.points)
        ]
        if not found:
            limit = Answer(None, codes.dynamic_effect_limit.clause, _NO_CROSSING)
            return finding(None, limit, self._gaps(points))
        # Where the limit is not known the largest value is shown.
        return max(found, key=lambda one: (np.nan_to_num(one.utilisation), one.value or 0.0))

    def _moment(self, points: Points, point: Point, k: int, span: Span, output: Output) -> Finding:
        i = self.questions.number_of[id(output)]
        moving, static = -float(points.peaks.low[k, i]), -float(points.peaks.static_low[k, i])
        limit = codes.dynamic_effect_limit(self.loads.moments[span], self.structure.phi_of(span))
        gaps, reason = self._gaps(points), f"static moment of the train {static:.4g} N m"
        track = self._track_factor(span, point.speed)
        if not self.smooth and point.cars:
            track = Answer(1.0, track.clause)
            reason += "; phi'' left out: the track's irregularity is in the analysis"
        if static <= 0.0:
            return finding(max(moving, 0.0), limit, gaps, point=point, where=span.middle)
        value = codes.dynamic_effect(static, max(moving / static, 0.0) - 1.0, track)
        if not value.decided:
            gaps.append(f"phi'' left out: {value.reason}")
            return finding(moving, limit, gaps, point=point, where=span.middle, reason=reason)
        return finding(value, limit, gaps, point=point, where=span.middle, reason=reason)

    def _track_factor(self, span: Span, speed: float) -> Answer:
        """Return 1 + phi''/2 of a span."""
        length, n0 = self.structure.length_of(span), self.structure.n0_of(span)
        if not length.decided:
            return Answer(None, codes.track_factor.clause, length.reason)
        if n0 is None:
            reason = f"the deck has no mode of vertical bending of span {span.number}"
            return Answer(None, codes.track_factor.clause, reason)
        return codes.track_factor(float(length), n0, speed)

    def twist(self, points: Points) -> Finding:
        """Judge the twist over 3 m under the trains, and under LM71 with Phi."""
        return self._twist(points, codes.twist_limit(self.structure.needs.line_speed), 0.0, [])

    def total_twist(self, points: Points) -> Finding:
        """Judge it with the twist that the track has without a train."""
        own = self.structure.needs.track_twist
        gaps = ["the track's own twist is not given (track_twist)"] if own is None else []
        return self._twist(points, codes.total_twist_limit(), own or 0.0, gaps)

    def _twist(self, points: Points, limit: Answer, own: float, gaps: list[str]) -> Finding:
        gaps, centred = [*self._gaps(points), *gaps], not self.loads.offset
        if not self.questions.twists:
            if centred and not any(point.cars for point in points.points):
                words = "axle loads over the deck's axis do not twist it"
                return finding(own, limit, gaps, reason=words)
            words = "rigid in twist in this model: give the deck torsional stiffness"
            return finding(None, limit, reason=words)
        model = self.loads.twist
        if model.missing:
            gaps.append(model.missing)
        reason = "the track is over the deck's axis" if centred else ""
        if len(points):
            value, output, point = self._largest(points, self.questions.twists)
            if value >= model.value:
                return finding(value + own, limit, gaps, point=point, where=output.x, reason=reason)
        return finding(
            model.value + own, limit, gaps, where=model.where, when=model.words, reason=reason
        )

    def end_rotation(self, points: Points) -> Finding:
        """Judge the rotation of the deck's ends about the vertical."""
        limit = codes.horizontal_rotation_limit(self.structure.needs.line_speed)
        if not self.questions.end_rotations:
            return finding(None, limit, reason=_SIDEWAYS)
        gaps = [*self._gaps(points), _OTHER_LOADS]
        if not len(points):
            return finding(None, limit, gaps, reason=_NO_CROSSING)
        value, output, point = self._largest(points, self.questions.end_rotations)
        return finding(value, limit, gaps, point=point, where=output.x)

    def radius(self, points: Points) -> Finding:
        """Judge L^2 / (8 d), d the lateral displacement of mid-span against the span's chord."""
        spans, count = self.questions.bows, max(len(self.structure.spans), 1)
        limit = codes.horizontal_radius_limit(self.structure.needs.line_speed, count)
        if not spans:
            bends = self.structure.deck.has["y"]
            reason = "the deck knows no lines of bearings" if bends else _SIDEWAYS
            return finding(None, limit, reason=reason)
        gaps = [*self._gaps(points), _OTHER_LOADS]
        if not len(points):
            return finding(None, limit, gaps, reason=_NO_CROSSING)
        own = [self.questions.number_of[id(output)] for _, output in spans]
        squares = np.array([span.length**2 for span, _ in spans])
        curvature = 8.0 * points.peaks.largest[:, own] / squares
        k, i = np.unravel_index(np.argmax(curvature), curvature.shape)
        if curvature[k, i] < _STRAIGHT:
            return finding(None, limit, gaps, reason="the trains do not bend it sideways")
        value, where = 1.0 / float(curvature[k, i]), spans[i][0].middle
        return finding(value, limit, gaps, point=points.points[k], where=where)

    # ---- coaches and wheels

    def comfort(self, points: Points) -> Finding:
        """Judge the vertical acceleration of the car bodies, up to the speed of the line."""
        needs = self.structure.needs
        limit = codes.comfort_limit(needs.comfort)
        slow = points.only([not_above(p.speed, needs.line_speed) for p in points.points])
        reason = "up to the speed of the line" + ", on a perfect track" * self.smooth
        return self._of_cars(slow, "body_acceleration_z", limit, reason, self.slow)

    def unloading(self, points: Points) -> Finding:
        """Judge by which share of its static load a wheel is unloaded.

        Never met on a perfect track: what unloads wheels most is the track's irregularity.
        """
        limit = codes.wheel_unloading_limit()
        perfect = [_PERFECT] if self.smooth and any(p.cars for p in points.points) else []
        return self._of_cars(points, "wheel_unloading", limit, "", perfect)

    def _of_cars(
        self, points: Points, name: str, limit: Answer, reason: str, more: Sequence[str] = ()
    ) -> Finding:
        gaps = [*self._gaps(points), *more]
        if self.unfelt and any(point.cars for point in points.points):
            gaps.append(_UNFELT)
        bare = list(dict.fromkeys(point.train for point in points.points if not point.cars))
        if bare:
            gaps.append(f"{counted(bare, 4)}: only axle loads, no cars")
        own = points.only([point.cars for point in points.points])
        if not len(own):
            return finding(None, limit, gaps, reason="" if gaps else f"{_NO_CROSSING} {reason}")
        values = own.number(name)
        if not np.isfinite(values).any():
            return finding(None, limit, gaps, reason="the cars give no number")
        k = int(np.nanargmax(values))
        return finding(float(values[k]), limit, gaps, point=own.points[k], reason=reason)

    # ---- bearings

    def uplift(self, points: Points) -> Finding:
        """Judge the least force of a bearing, the deck's own weight counted."""
        limit, bearings = codes.uplift_limit(), self.questions.bearings
        if not bearings:
            reason = self.structure.deck.recovery.lacks or "the deck knows no bearings"
            return finding(None, limit, reason=reason)
        gaps = self._gaps(points)
        if not len(points):
            return finding(None, limit, gaps, reason=_NO_CROSSING)
        own = [self.questions.number_of[id(bearing.output)] for bearing in bearings]
        least = points.peaks.low[:, own] + [bearing.self_weight for bearing in bearings]
        aside = self.loads.offset != 0.0
        rolls = self.structure.deck.has["roll"]
        twisted = aside or any(point.cars for point in points.points)
        if (twisted and any(bearing.hides for bearing in bearings)) or (aside and not rolls):
            gaps.append(
                "a line that holds the deck against twist hides its single bearings: give each "
                "its place beside the axis"
            )
        k, i = np.unravel_index(np.argmin(least), least.shape)
        return finding(
            float(least[k, i]), limit, gaps, point=points.points[k], where=bearings[i].words
        )

    # ---- common

    def _gaps(self, points: Points) -> list[str]:
        return [*points.gaps, *self.gaps]

    def _largest(self, points: Points, outputs: Sequence[Output]) -> tuple[float, Output, Point]:
        """Return the largest magnitude of some outputs, which it is, and in which crossing."""
        own = [self.questions.number_of[id(output)] for output in outputs]
        largest = points.peaks.largest[:, own]
        k, i = np.unravel_index(np.argmax(largest), largest.shape)
        return float(largest[k, i]), outputs[i], points.points[k]
