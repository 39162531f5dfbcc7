"""What the load models do that stand on a deck, and the clauses that need no train."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import codes
from ..codes import Answer
from .judging import Finding, finding
from .questions import Questions
from .structure import Span, Structure

__all__ = ["ModelTwist", "StaticLoads"]

_SHARES = (0.4, 0.45, 0.5, 0.55, 0.6)
"""Where in a span of several its deflection may be largest."""


@dataclass(frozen=True)
class ModelTwist:
    """The largest twist over 3 m under LM71 with Phi.

    Attributes
    ----------
    value : float
        m.
    where : float
        m along the deck.
    words : str
    missing : str
        What it leaves out; empty if nothing.
    """

    value: float
    where: float
    words: str
    missing: str


@dataclass(frozen=True, eq=False)
class StaticLoads:
    """The load models on a track of a deck.

    Attributes
    ----------
    structure : Structure
    questions : Questions
    offset : float
        m left of the deck axis: the trains' track.
    """

    structure: Structure
    questions: Questions
    offset: float

    def findings(self) -> list[Finding]:
        """Return the verdicts that need no train."""
        return [self.deflection(), self.lateral_frequency(), self.damping()]

    @cached_property
    def tracks(self) -> tuple[float, ...]:
        """Where LM71 stands at once, m left of the deck axis."""
        deck = self.structure.deck
        if self.structure.needs.all_tracks and len(deck.tracks) > 1:
            return tuple(deck.tracks.values())
        return (self.offset,)

    @cached_property
    def moments(self) -> dict[Span, float]:
        """Sagging moment of each mid-span, N m: LM71 or, on continuous decks, SW/0."""
        needs, found = self.structure.needs, {}
        names = ("LM71", "SW/0") if self.structure.continuous else ("LM71",)
        for span, output in self.questions.moments:
            line = codes.under_unit_load(output.line, self.offset)
            models = [codes.load_model(name, needs.alpha) for name in names]
            found[span] = max(-model.effects(line)[0].value for model in models)
        return found

    @cached_property
    def twist(self) -> ModelTwist:
        """The largest twist under LM71, with Phi of the longest span."""
        phi = self.structure.phi_of(self.structure.longest)
        model, best = codes.load_model("LM71", self.structure.needs.alpha), (0.0, 0.0)
        for output in self.questions.twists:
            lines = [codes.under_unit_load(output.line, y) for y in self.tracks]
            effects = np.array([[e.value for e in model.effects(line)] for line in lines])
            best = max(best, (float(np.abs(effects.sum(axis=0)).max()), output.x))
        factor = float(phi) if phi.decided else 1.0
        missing = "" if phi.decided else f"LM71 without Phi: {phi.reason}"
        return ModelTwist(factor * best[0], best[1], self._words(phi), missing)

    def _words(self, phi: Answer) -> str:
        factor = f" with Phi = {float(phi):.4g}" if phi.decided else ""
        count = f" on {len(self.tracks)} tracks" if len(self.tracks) > 1 else ""
        return f"LM71{count}{factor}"

    def deflection(self) -> Finding:
        """Judge the deflection of each span under LM71 with Phi and alpha; the worst is kept."""
        structure = self.structure
        if not structure.spans:
            reason = "the deck knows no lines of bearings"
            return finding(None, Answer(None, codes.deflection_limit.clause, reason))
        gaps = []
        if structure.deck.recovery.lacks:
            gaps.append("the deflection of the modes alone is too small")
        if structure.overhangs:
            gaps.append("what hangs over the outer bearings is not judged")
        found = [self._deflection(span, gaps) for span in structure.spans]
        return max(found, key=lambda one: one.utilisation)

    def _deflection(self, span: Span, gaps: list[str]) -> Finding:
        deck, model = self.structure.deck, codes.load_model("LM71", self.structure.needs.alpha)
        shares = _SHARES if self.structure.continuous is not False else (0.5,)
        found = []
        for share in shares:
            x = span.start + share * span.length
            worst = [model.worst(deck, "displacement_z", at=x, track=y) for y in self.tracks]
            found.append((-sum(one.least.value for one in worst), x))
        value, x = max(found)
        phi = self.structure.phi_of(span)
        if not phi.decided:
            gaps = [*gaps, f"without Phi: {phi.reason}"]
        factor = float(phi) if phi.decided else 1.0
        reason = f"span {span.number}, {span.length:g} m; LM71 on {len(self.tracks)} of "
        reason += f"{max(len(deck.tracks), 1)} tracks"
        return finding(
            factor * value, codes.deflection_limit(span.length), gaps, where=x,
            when=self._words(phi), reason=reason,
        )  # fmt: skip

    def lateral_frequency(self) -> Finding:
        """Judge the first frequency of lateral bending."""
        limit, mode = codes.lateral_frequency_limit(), self.structure.first_lateral
        if not self.structure.deck.has["y"]:
            reason = "rigid sideways in this model: give the deck a lateral bending stiffness"
            return finding(None, limit, reason=reason)
        if mode is None:
            return finding(None, limit, reason="none of the deck's modes is lateral: give it more")
        reason = f"mode {mode + 1}"
        return finding(float(self.structure.deck.frequencies_hz[mode]), limit, reason=reason)

    def damping(self) -> Finding:
        """Judge the damping of the first vertical mode: more than the lower bound is not safe."""
        structure, needs = self.structure, self.structure.needs
        length, mode = structure.length_of(structure.longest), structure.first_vertical
        clause = codes.damping_limit.clause
        if mode is None:
            reason = "the deck has no mode of vertical bending"
            return finding(None, Answer(None, clause, reason))
        value, reason = float(structure.deck.damping_ratios[mode]), f"mode {mode + 1}"
        if length.decided or needs.measured_damping is not None:
            span = float(length) if length.decided else structure.deck.length
            limit = codes.damping_limit(needs.kind, span, needs.measured_damping)
        else:
            limit = Answer(None, clause, length.reason)
        if limit.decided:
            reason += f", {limit.reason}"
        return finding(value, limit, reason=reason)
