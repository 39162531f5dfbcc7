"""Many crossings: constant loads over speeds, a map of speed and wavelength, several workers.

Everything is printed beside the same by one call of `cross` a point, in this one run; seconds
belong to the machine, whose own product of matrices and pass through memory stand first. `python
benchmarks/many.py`, alone on the machine; with `--workers` also points per second against workers.
"""

import os
import sys
import time
import warnings
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"  # before NumPy is loaded

import numpy as np

import railbridge as rb
from bench import PEAK, best, fresh, machine
from railbridge import studies

SPEEDS = np.linspace(100.0, 300.0, 101) / 3.6
EDGE = 50
MEMORY = """
import os, sys
os.environ["OMP_NUM_THREADS"] = "1"
sys.path.insert(0, "{folder}")
import many
many.map_of_speed_and_wavelength({edge})
{peak}"""


def bridge():
    """A simple span of 25 m with three modes."""
    return rb.Beam("simple", (25.0,), 15e3, 3.1e10).deck(modes=3, damping=0.01)


def ten_trains(deck):
    trains = {f"HSLM-A{i}": rb.train(f"HSLM-A{i}") for i in range(1, 11)}
    asked = ("displacement_z", "acceleration_z")
    return studies.speed_envelope(deck, trains, SPEEDS, quantities=asked)


def one_call_each(deck, every=40):
    """Processor time of all 1 010 crossings by `cross`, from every so-many-th of them, s."""
    points = [(i, v) for i in range(1, 11) for v in SPEEDS][::every]
    start = time.process_time()
    for i, speed in points:
        run = rb.cross(rb.train(f"HSLM-A{i}"), deck, speed=speed)
        run.displacement(12.5).extreme("displacement_z")
        run.acceleration(12.5).extreme("acceleration_z")
    return (time.process_time() - start) / len(points) * 1010


def one_car():
    changes = {"train.cars": 1, "run.loads": "wheels", "run.iterations": 4}
    return rb.case("paper").replace(changes)


def axes(edge):
    return {
        "run.speed": np.linspace(10.0, 60.0, edge),
        "track.vertical.wavelength": np.linspace(6.0, 40.0, edge),
    }


def map_of_speed_and_wavelength(edge, **options):
    asked = ("displacement_z", "acceleration_z", "wheel_unloading", "deviation_from_rigid")
    return rb.sweep(one_car(), axes(edge), measure=asked, **options)


def map_of_amplitude_and_phase(edge):
    over = {
        "track.vertical.amplitude": np.linspace(1e-3, 5e-3, edge),
        "track.vertical.phase": np.linspace(0.0, 6.0, edge),
    }
    return rb.sweep(one_car(), over, measure=("displacement_z", "acceleration_z"))


def one_call_each_of_the_map(edge, count=40):
    case, over = one_car(), axes(edge)
    chosen = np.random.default_rng(0).integers(edge, size=(count, 2))
    start = time.process_time()
    for i, j in chosen:
        changes = {path: float(over[path][k]) for path, k in zip(over, (i, j), strict=True)}
        run = case.replace(changes).run()
        run.displacement(18.0).extreme("displacement_z")
        run.acceleration(18.0).extreme("acceleration_z")
        run.wheel_unloading.max(), run.deviations.from_rigid[-1]
    return (time.process_time() - start) / count * edge**2


def against_workers(edge=30):
    """Points per second with one and two processes, and with a cluster of two workers here."""
    from distributed import Client, LocalCluster

    print("\nworkers        points per second")
    for workers in (1, 2):
        start = time.perf_counter()
        map_of_speed_and_wavelength(edge, workers=workers, chunk=128)
        rate = edge**2 / (time.perf_counter() - start)
        print(f"{workers} process{'es' * (workers > 1):8s} {rate:12.0f}")
    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
        ) as cluster,
        Client(cluster) as client,
    ):
        map_of_speed_and_wavelength(4, client=client)  # imports
        start = time.perf_counter()
        map_of_speed_and_wavelength(edge, client=client, chunk=128)
        print(f"2 by Dask      {edge**2 / (time.perf_counter() - start):12.0f}")
        start = time.perf_counter()
        client.gather([client.submit(abs, -i, pure=False) for i in range(200)])
        print(f"an empty task of Dask: {(time.perf_counter() - start) / 200 * 1e3:.1f} ms")


def main():
    warnings.simplefilter("ignore")
    machine()
    deck = bridge()
    ten_trains(deck)
    took, alone = best(ten_trains, deck, repeats=5), one_call_each(deck)
    print(
        f"\nHSLM-A1..A10 x 101 speeds x 3 modes: {took:.2f} s   {1e6 * took / 1010:.0f} us a "
        f"crossing   one cross call each {alone:.0f} s, {alone / took:.0f} times as long"
    )
    took, alone = best(map_of_speed_and_wavelength, EDGE, repeats=1), one_call_each_of_the_map(EDGE)
    print(
        f"{EDGE} x {EDGE} speeds and wavelengths, one car, 4 passes: {took:.1f} s   "
        f"{1e3 * took / EDGE**2:.1f} ms a lane   one call each {alone:.0f} s, "
        f"{alone / took:.1f} times as long"
    )
    took = best(map_of_amplitude_and_phase, EDGE, repeats=1)
    one = best(one_car().run, repeats=5)
    print(
        f"{EDGE} x {EDGE} amplitudes and phases at one speed, mixed from five: {took:.1f} s   "
        f"one call each {one * EDGE**2:.0f} s, {one * EDGE**2 / took:.0f} times as long"
    )
    for edge in (12, 24, 48):
        code = MEMORY.format(edge=edge, peak=PEAK, folder=Path(__file__).parent.as_posix())
        used = float(fresh(code)[0])
        print(f"peak memory of a map of {edge} x {edge}: {used:.0f} MB")
    if "--workers" in sys.argv:
        against_workers()


if __name__ == "__main__":
    main()
