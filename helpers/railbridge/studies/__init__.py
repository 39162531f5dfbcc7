"""Many crossings: speed envelopes, sweeps over any key of a case, on one machine or on a cluster.

Labelled arrays need the extra ``study`` (xarray); results on disk need zarr, clusters distributed.
"""

from .chunks import WorkerDiedError
from .datasets import Dimension, dataset, table
from .engine import NUMBERS, Asked, Job, Row, asked_of, respond, row_of_run
from .ensembles import Ensemble
from .envelopes import (
    QUANTITIES,
    checked_speeds,
    crossings,
    named_trains,
    signature,
    speed_envelope,
)
from .extras import needed, program_version
from .fingerprints import fingerprint, print_of_crossing, print_of_deck
from .lanes import WIDTH, advance_of, eligible
from .mixtures import WORTH, mixture_key
from .outputs import OUTPUTS, Output, of_modes_counted, outputs_at, twist_at
from .peakfactors import Extreme, PeakFactor, davenport, extreme, upcrossing_rate
from .randomresponse import RandomResponse, compute_response, random_response
from .refinement import Between, starting_speeds
from .resonance import repeated_distance, residual_acceleration, resonance_speeds
from .statistics import (
    Percentile,
    Share,
    Statistics,
    describe,
    exceedance,
    needed_for_mean,
    needed_for_percentile,
)
from .store import MemoryStore, Store
from .study import CHUNK, CHUNK_OF_LOADS, Point, carry_out, chunked, remaining
from .unitwaves import UnitWaves, unit_waves, wave_forces

__all__ = [
    "Asked", "Between", "CHUNK", "CHUNK_OF_LOADS", "Dimension", "Ensemble", "Extreme", "Job",
    "MemoryStore", "NUMBERS", "OUTPUTS", "Output", "PeakFactor", "Percentile", "Point",
    "QUANTITIES", "RandomResponse", "Row", "Share", "Statistics", "Store", "UnitWaves", "WIDTH",
    "WORTH", "WorkerDiedError", "advance_of", "asked_of", "carry_out", "checked_speeds", "chunked",
    "compute_response", "crossings", "dataset", "davenport", "describe", "eligible", "exceedance",
    "extreme", "fingerprint", "mixture_key", "named_trains", "needed", "needed_for_mean",
    "needed_for_percentile", "of_modes_counted", "outputs_at", "print_of_crossing", "print_of_deck",
    "program_version", "random_response", "remaining", "repeated_distance", "residual_acceleration",
    "resonance_speeds", "respond", "row_of_run", "signature", "speed_envelope", "starting_speeds",
    "table", "twist_at", "unit_waves", "upcrossing_rate", "wave_forces",
]  # fmt: skip
