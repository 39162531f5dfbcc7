"""Random tracks: realisations of a track below the paper's train of eight cars.

200 realisations, drawn from one computation of all waves, beside single runs of `cross` on one of
them, in this one run; seconds belong to the machine, whose own product of matrices and pass through
memory stand first. `python benchmarks/drawn.py`, alone on the machine.
"""

import os
import time
import warnings

os.environ["OMP_NUM_THREADS"] = "1"  # before NumPy is loaded

import railbridge as rb
from bench import best, machine

REALISATIONS = 200
COMPONENTS = {"vertical only": ("vertical",), "all four components": None}
OPTIONS = {"speed": 20.0, "time_step": 1e-3, "track_offset": 2.4}
ASKED = ("displacement_z", "acceleration_z")


def one_run(train, deck, track):
    """One realisation by `cross`, with the extremes of the same histories."""
    run = rb.cross(train, deck, track, interaction="direct", **OPTIONS)
    run.displacement(18.0).extreme("displacement_z")
    run.acceleration(18.0).extreme("acceleration_z")


def main():
    warnings.simplefilter("ignore")
    machine()
    train, deck = rb.Train(rb.vehicle("xia2000"), cars=8, car_spacing=22.5), rb.deck("viaduct36")
    for words, components in COMPONENTS.items():
        track = rb.RandomTrack("german-low", components=components)
        start = time.perf_counter()
        response = rb.random_response(train, deck, track, quantities=ASKED, **OPTIONS)
        waves = time.perf_counter() - start
        start = time.perf_counter()
        response.ensemble(REALISATIONS)
        drawn = time.perf_counter() - start
        one = best(one_run, train, deck, track, repeats=3)
        count = len(track.wavenumbers) * len(track.components)
        print(
            f"\n{words}, {count} waves: {waves:.1f} s, {drawn:.2f} s for "
            f"{REALISATIONS} realisations   one run {one:.2f} s, as many "
            f"{REALISATIONS * one / (waves + drawn):.1f} times as long; waves {waves / one:.0f} "
            f"runs, a further realisation {one * REALISATIONS / drawn:.0f} times as fast"
        )


if __name__ == "__main__":
    main()
