"""What a check must be told besides deck and trains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from ..codes import ALPHAS
from ..errors import InputError, Range, check_fields

__all__ = ["Requirements"]


@dataclass(frozen=True)
class Requirements:
    """What neither a deck nor its trains tell: of the line, its track and the kind of bridge.

    Attributes
    ----------
    line_speed : float
        Largest speed of the line, m/s; limits and the speeds of an analysis go by it.
    track : {"ballasted", "direct fastening"}
        How the track lies on the deck, ballasted or direct fastening; limits its acceleration.
    kind : str, optional
        Kind of bridge, for the lower bound of damping: steel, composite, prestressed concrete,
        filler beam or reinforced concrete. Left out: damping cannot be decided.
    simple : bool
        Whether the structure is a simple one: a beam or slab on two lines of bearings, not skew. A
        deck that runs through over several spans is none, whatever is said here.
    comfort : {"very good", "good", "acceptable"}
        Level of comfort in the coaches: very good, good or acceptable.
    careful_track : bool
        Whether the track is carefully maintained: Phi2 in place of Phi3.
    determinant_length : float, optional
        L_Phi, m. Left out: the span of a simple beam, and by the rule for beams over several spans.
    alpha : float
        Classification factor of LM71 and SW/0.
    cover : float
        m, from the structure to the top of the sleepers; above 1 m it reduces Phi.
    all_tracks : bool
        Whether LM71 stands on every named track of the deck at once, not on the trains' alone.
    measured_damping : float, optional
        Damping ratio of the first vertical mode that was measured on the bridge, a fraction.
    track_twist : float, optional
        Twist that the track has over 3 m without a train, as in a transition, m.
    """

    line_speed: Annotated[
        float, Range(above=0.0, most=200.0, unit="m/s", remedy="Divide km/h by 3.6")
    ]
    track: Literal["ballasted", "direct fastening"] = "ballasted"
    kind: (
        Literal["steel", "composite", "prestressed concrete", "filler beam", "reinforced concrete"]
        | None
    ) = None
    simple: bool = True
    comfort: Literal["very good", "good", "acceptable"] = "very good"
    careful_track: bool = False
    determinant_length: Annotated[float, Range(above=0.04, most=1e4, unit="m")] | None = None
    alpha: Annotated[float, Range(above=0.0)] = 1.0
    cover: Annotated[float, Range(least=0.0, most=100.0, unit="m")] = 0.0
    all_tracks: bool = False
    measured_damping: Annotated[float, Range(above=0.0, most=0.5)] | None = None
    track_twist: Annotated[float, Range(least=0.0, most=0.1, unit="m")] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        if self.alpha not in ALPHAS:
            allowed = "must be one of " + ", ".join(f"{a:g}" for a in ALPHAS)
            raise InputError("alpha", self.alpha, allowed, "These are the factors of EN 1991-2")
