"""Time the paper's case, how it grows with the number of cars, and a plain integration of the same
equations beside it.

Four planar crossings stand beside OpenSeesPy (`planar`), where that can be loaded. Everything is
printed as a ratio within this one run, since seconds belong to the machine, whose own product of
matrices and pass through memory stand first. `python benchmarks/bench.py`.
"""

import dataclasses
import os
import subprocess
import sys
import time

os.environ["OMP_NUM_THREADS"] = "1"  # the matrices are small; before NumPy is loaded

import numpy as np
from scipy.integrate import solve_ivp

import railbridge as rb
from planar import opensees, problems
from railbridge.coupling import prepare
from railbridge.direct.plans import plan
from railbridge.direct.solution import has_compiler
from railbridge.direct.stepping import march
from railbridge.direct.windows import in_windows

PEAK = """
import pathlib, resource, sys
status = pathlib.Path("/proc/self/status")
if status.exists():
    # The other number begins with what the program had that started this one.
    lines = status.read_text().splitlines()
    print(next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM")))
else:
    unit = 1024.0 if sys.platform != "darwin" else 1024.0**2
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit)
"""
MEMORY = f"""
import os
os.environ["OMP_NUM_THREADS"] = "1"
import railbridge as rb
run = rb.case("paper").replace({{"run.iterations": 4}}).run()
run.displacement(18.0), run.section_forces(18.0), run.reactions(), run.wheel_forces
{PEAK}"""
IMPORT = """
import sys, time
start = time.perf_counter()
import railbridge
took = time.perf_counter() - start
print(took, *[m for m in ("matplotlib", "pandas", "ipywidgets", "IPython") if m in sys.modules])
"""

NEEDED = """
import time
start = time.perf_counter()
import numpy, scipy.linalg, scipy.signal, scipy.sparse.csgraph
print(time.perf_counter() - start)
"""


def best(run, *arguments, repeats=7):
    """Return the shortest processor time of several runs, s: other programs on the machine count
    least in it."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        run(*arguments)
        times.append(time.process_time() - start)
    return min(times)


def fresh(code, repeats=1):
    """Run lines in a new Python; return its printed words, those of the smallest first number if
    repeated."""
    answers = [
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        for _ in range(repeats)
    ]
    return min((a.stdout.split() for a in answers), key=lambda words: float(words[0]))


def solve(case):
    """Run a case up to the deck's motion under the last forces."""
    return case.run().state


def coupled(case):
    """Return a function that integrates one car on the deck as one system of equations, as a
    textbook would write it."""
    car, deck, s = case.train.vehicle, case.deck, case.run().settings
    m, c, k = car.mass_matrix, car.damping_matrix, car.stiffness_matrix
    rows = car.contact_stretch.reshape(-1, len(car.labels))
    kc, cc = car.contact_stiffness.ravel(), car.contact_damping.ravel()
    inverse, n, modes = np.linalg.inv(m), len(m), len(deck.frequencies_hz)
    omega, y = (
        2 * np.pi * deck.frequencies_hz,
        np.array([w.y for w in case.train.wheels]) + s.track_offset,
    )
    delays, static = (
        np.array([w.delay for w in case.train.wheels]),
        case.train.car(1).static_forces.ravel(),
    )
    rails = [
        (case.track.rail("lateral", w.side), case.track.rail("vertical", w.side))
        for w in case.train.wheels
    ]
    stop = (deck.length + case.train.length) / s.speed

    def rate(t, state):
        x, v, q, dq = np.split(state, [n, 2 * n, 2 * n + modes])
        place = s.speed * t - delays
        on = ((place >= 0) & (place <= deck.length))[:, None]
        value, slope = deck.shapes(place) * on[..., None], deck.shapes(place, 1) * on[..., None]
        shape = np.stack(
            [value[:, :, 0], value[:, :, 1] + y[:, None] * value[:, :, 2]], axis=1
        ).reshape(-1, modes)
        tilt = np.stack(
            [slope[:, :, 0], slope[:, :, 1] + y[:, None] * slope[:, :, 2]], axis=1
        ).reshape(-1, modes)
        r = np.array(
            [[i.value(p) for i in pair] for pair, p in zip(rails, place, strict=True)]
        ).ravel()
        dr = (
            np.array(
                [[i.slope(p) for i in pair] for pair, p in zip(rails, place, strict=True)]
            ).ravel()
            * s.speed
        )
        r, dr = r + shape @ q, dr + shape @ dq + s.speed * (tilt @ q)
        force = kc * (rows @ x - r) + cc * (rows @ v - dr)
        load = force + static
        acceleration = inverse @ (rows.T @ (kc * r + cc * dr) - c @ v - k @ x)
        return np.concatenate(
            [
                v,
                acceleration,
                dq,
                shape.T @ load - 2 * deck.damping_ratios * omega * dq - omega**2 * q,
            ]
        )

    start = np.zeros(2 * (n + modes))
    return lambda: solve_ivp(
        rate, (0.0, stop), start, method="RK45", rtol=1e-4, atol=1e-8, max_step=5e-3
    )


def machine():
    """Print what the machine itself does: a product of matrices, and a pass through memory."""
    a, b, long = np.ones((512, 512)), np.ones((512, 512)), np.ones(2**24)
    product, memory = best(lambda: a @ b), best(lambda: np.add(long, 1.0, out=long))
    print(
        f"this machine, one thread: products of matrices {2e-9 * 512**3 / product:.0f} GFlop/s, "
        f"memory {2e-9 * long.nbytes / memory:.1f} GB/s read and written\n"
    )


def beside_opensees(unit):
    """Print the planar crossings beside those of OpenSeesPy with a step loop."""
    ops = opensees()
    print("\nplanar, mid-span sag            / paper's case   OpenSeesPy / ours   sags differ")
    for name, (ours, theirs) in problems().items():
        took = best(ours)
        line = f"  {name:34s} {took / unit:10.3f}"
        if ops is not None:
            other = best(theirs, ops, repeats=2)
            line += f" {other / took:19.0f} {abs(ours() / theirs(ops) - 1):13.1e}"
        print(line, flush=True)
    if ops is None:
        print("  OpenSeesPy cannot be loaded here")


def wheelsets(unit):
    """Print the ways to solve eight cars on wheelsets with mass, 1 ms, 20 modes."""
    changes = {"train.vehicle": "xia2000_wheelsets", "run.loads": "wheels", "run.time_step": 1e-3}
    case = rb.case("paper").replace({**changes, "run.interaction": "direct"})
    coupling = prepare(case.train, case.deck, case.track, case.settings)
    steps = plan(coupling)
    numpy = best(march, steps, repeats=2)
    print(
        f"\neight cars on wheelsets, {steps.samples} samples: the loop in NumPy {numpy / unit:.2f}"
    )
    if has_compiler():
        from railbridge.direct import compiled

        compiled.march(steps)
        fast = best(compiled.march, steps)
        times = f"the loop in NumPy takes {numpy / fast:.0f} times as long"
        print(f"  compiled {fast / unit:.2f} ({fast:.3f} s): {times}")
    print(f"  the whole crossing {best(solve, case, repeats=3) / unit:.2f}", end="")
    print(f", in windows of time {best(in_windows, coupling, repeats=1) / unit:.2f}")


def main():
    machine()
    paper = rb.case("paper").replace({"run.iterations": 4})
    solve(paper)
    unit = best(solve, paper, repeats=15)
    print(
        f"paper's case: 8 cars, 5 deck-and-train solves, 1 ms       1.00   ({unit:.3f} s of "
        "processor time)"
    )
    print("\ncars   time / paper's case   time per car / that of one car   (condensed, the same)")
    first = None
    for cars in (1, 2, 4, 8, 16):
        took = best(solve, paper.replace({"train.cars": cars}))
        first = first or took
        print(f"{cars:4d}   {took / unit:19.2f}   {took / cars / first:29.2f}")
    print("\nloads, 8 cars     passes of the iteration alike")
    for loads in ("condensed", "bogies", "wheels"):
        print(f"  {loads:12s} {best(solve, paper.replace({'run.loads': loads})) / unit:6.2f}")
    print("\nwheels, to 1e-8     iterated   solved together at every step   together / iterated")
    for cars in (1, 8):
        case = rb.case("paper").replace({"train.cars": cars, "run.loads": "wheels"})
        iterated, together = (
            best(solve, case, repeats=2),
            best(solve, case.replace({"run.interaction": "direct"}), repeats=2),
        )
        print(
            f"  {cars} cars {iterated / unit:18.2f} {together / unit:31.2f} "
            f"{together / iterated:21.1f}"
        )
    one = rb.case("paper").replace(
        {
            "train.cars": 1,
            "run.loads": "wheels",
            "run.lead_in": 0.0,
            "run.tail": 0.0,
            "track.lateral.phase": 0.0,
        }
    )
    converged, plain = best(solve, one), best(coupled(one), repeats=1)
    print(f"\none car, wheels, to 1e-8: suite                            {converged / unit:.2f}")
    print(
        f"the same by scipy.integrate.solve_ivp (RK45, 1e-4)       {plain / unit:.1f}   "
        f"{plain / converged:.0f} times the suite's"
    )
    wheelsets(unit)
    beside_opensees(unit)
    took = best(lambda: dataclasses.replace(rb.deck("viaduct36").recovery.beam).modes, repeats=15)
    print(
        f"\nbeam modes of the paper's deck, mesh built anew: {took / unit:.2f}   "
        f"({took * 1e3:.0f} ms, to stay below 50)"
    )
    print(
        f"\npeak memory of the paper's case, with its results: {float(fresh(MEMORY)[0]):.0f} "
        "MB (to stay below 200)"
    )
    took, *loaded = fresh(IMPORT, 3)
    print(
        f"import railbridge: {float(took) / float(fresh(NEEDED, 3)[0]):.2f} times the import "
        "of what it needs of numpy and scipy"
    )
    print(f"plots, tables and widgets it loads: {', '.join(loaded) or 'none'}")


if __name__ == "__main__":
    main()
