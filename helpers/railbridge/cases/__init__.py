"""Cases as data: files and tables that become trains, decks and tracks, a crossing in numbers, and the command."""

from .definition import Case, case
from .objects import box, deck, deck_from_table, vehicle
from .shelf import data_root
from .summary import summarize

__all__ = ["Case", "box", "case", "data_root", "deck", "deck_from_table", "summarize", "vehicle"]
