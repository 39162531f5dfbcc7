"""Irregularities of whole tracks: measured ones, from recording cars."""

from .records import Loss, RecordedRail, TrackRecord, record_of
from .writing import export_track

__all__ = ["Loss", "RecordedRail", "TrackRecord", "export_track", "record_of"]
