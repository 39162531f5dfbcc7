"""The paper's case: printed, ours, difference.

Amaral & Mazzilli, "The Influence of Deck Flexibility on the Dynamic Response of Railway Bridges", Revista Sul-Americana de
Engenharia Estrutural 13(3), 2016. Nothing here is tuned to its results. The deck's section (Figure 6) is missing and was
identified from Tables 2 and 4; see ``data/decks/viaduct36.toml``.

``python -m railbridge.paper`` prints every table and writes ``build/reproduction.json``.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .. import errors
from ..cases.definition import Case, case
from ..cases.objects import vehicle
from ..decks import rayleigh, rayleigh_ratio
from ..results import Crossing
from ..tracks import Harmonic, Track
from ..trains import LOADS, steady_forces

__all__ = [
    "READING", "SCENARIOS", "TABLE2_DECK", "TABLE2_VEHICLE", "TABLE3", "TABLE4", "Row", "bounce_amplitude", "compare", "frame",
    "mass_needed", "readings", "report", "reproduce", "run", "scenario", "table4",
]  # fmt: skip

TABLE2_VEHICLE = (0.645, 1.215, 1.230, 1.334, 1.667, 9.044, 9.055, 11.72, 11.72, 15.48, 15.48, 21.96, 21.96, 24.99, 24.99)
"""Natural frequencies of the vehicle, Hz, as printed."""

TABLE2_DECK = (3.307, 10.46, 10.56, 14.97, 16.30, 16.73, 17.41, 17.67, 18.16, 18.48, 18.83, 20.00, 21.60, 21.97, 22.62)
"""Natural frequencies of the deck's shell model, Hz, as printed, without names of modes."""

TABLE3 = {"from_rigid": (1.934, 1.883, 1.911, 1.911), "from_previous": (1.934, -0.051, 0.028, -0.001)}
"""Deviations of iterations 1 to 4, percent, as printed."""

TABLE4 = {
    "Torsion moment": ("kN m", -1222.52, -1256.62),
    "Horizontal bending moment": ("kN m", -64.04, -64.04),
    "Vertical bending moment": ("kN m", -24912.90, -24831.80),
    "Vertical displacement": ("mm", -38.13, -38.01),
    "Y-reaction in node 1": ("kN", 7.83, 7.83),
    "Y-reaction in node 2": ("kN", -8.80, -8.80),
    "Z-reaction in node 1": ("kN", 2851.86, 2857.16),
    "Z-reaction in node 2": ("kN", 2884.38, 2890.30),
}
"""Results for the structural model: unit (inferred), iteration 0, iteration 4, as printed. Self-weight is included."""

READING = {
    "run.excitation": "car",
    "run.feedback": "vertical",
    "track.vertical.wavelength": 15.0,
    "track.lateral.wavelength": 15.0,
}
"""A guess at what the paper did: the wheels of a car in phase, only vertical feedback, 15 m waves. Never the default."""

SCENARIOS: dict[str, tuple[str, dict[str, Any]]] = {
    "paper": ("n = 5 half-waves on l = 36 m: 14.4 m waves", {}),
    "l37.5": ("n = 5 half-waves on l = 37.5 m: 15 m waves, 1.33 Hz at 20 m/s", {"length": 37.5, "half_waves": 5.0}),
    "n11.7": ("n = 11.7 half-waves on l = 36 m: 3.25 Hz at 20 m/s", {"length": 36.0, "half_waves": 11.7}),
    "n11.7 l37.5": ("n = 11.7 half-waves on l = 37.5 m: 3.12 Hz at 20 m/s", {"length": 37.5, "half_waves": 11.7}),
    "notch": ("a notch of 1 mm by 50 mm on the first wheel, as in the paper: no wheel could follow it", {}),
    "one car": ("one car instead of eight", {"train.cars": 1}),
    "paper reading": ("a guess: wheels of a car in phase, vertical feedback only, 15 m waves", READING),
    "identified": ("on the beam of the box fitted to Table 2, see `identification`", {"deck.file": "viaduct36_identified"}),
}
"""Name: what it is and what it changes in the paper's case."""

NOTCH = {"wheels": [[1, 1]], "circumference": 2.7, "offset": 9.0, "depth": 1e-3, "length": 0.05}
"""The notch scenario: 1 mm by 50 mm on the first wheel of the first car, meeting the rail 9 m behind the entrance."""


def scenario(name: str, **changes: Any) -> Case:
    """Return one of the paper's scenarios as a case.

    Parameters
    ----------
    name : str
        One of `SCENARIOS`.
    **changes : object
        Further keys of ``run``, for instance ``loads="wheels"``.
    """
    errors.choice("scenario", name, SCENARIOS)
    made = dict(SCENARIOS[name][1])
    if "half_waves" in made:
        wavelength = 2.0 * made["length"] / made["half_waves"]
        made = {"track.vertical.wavelength": wavelength, "track.lateral.wavelength": wavelength}
    if name == "notch":
        # Ten samples in 50 mm at 20 m/s ask for a quarter of the paper case's time step.
        made = {"train.notch": [NOTCH], "run.time_step": 2.5e-4}
    return case("paper").replace({**made, **{f"run.{k}": v for k, v in changes.items()}})


def run(name: str = "paper", loads: str = "condensed", iterations: int | None = None) -> Crossing:
    """Run a scenario once and keep the result; see `scenario`. Without `iterations` it runs until it has converged."""
    return _run(name, loads, iterations)


@cache
def _run(name: str, loads: str, iterations: int | None) -> Crossing:
    return scenario(name, loads=loads, iterations=iterations).run()


def table4(crossing: Crossing) -> dict[str, float]:
    """Return the rows of Table 4 in its units (kN m, mm, kN): the value of largest magnitude, self-weight included.

    Moments and displacement at mid-span, torsion at the bearing where it is largest.
    """
    middle, length = crossing.deck.length / 2, crossing.deck.length
    forces = crossing.section_forces(middle, self_weight=True)
    torsion = [crossing.section_forces(x).extreme("torsion")[0] for x in (0.0, length)]
    first, second = crossing.reactions(self_weight=True).values()
    return {
        "Torsion moment": max(torsion, key=abs) / 1e3,
        "Horizontal bending moment": forces.extreme("moment_lateral")[0] / 1e3,
        "Vertical bending moment": forces.extreme("moment_vertical")[0] / 1e3,
        "Vertical displacement": crossing.displacement(middle, self_weight=True).extreme("displacement_z")[0] * 1e3,
        "Y-reaction in node 1": first.extreme("force_y")[0] / 1e3,
        "Y-reaction in node 2": second.extreme("force_y")[0] / 1e3,
        "Z-reaction in node 1": first.extreme("force_z")[0] / 1e3,
        "Z-reaction in node 2": second.extreme("force_z")[0] / 1e3,
    }


def bounce_amplitude(wavelength: float, excitation: str = "wheels") -> float:
    """Return the steady amplitude of a car's vertical force on 5 mm waves at 20 m/s, N, in closed form."""
    forces = steady_forces(vehicle("xia2000"), Track(vertical=Harmonic(5e-3, wavelength)), 20.0, excitation)
    return float(np.abs(forces[:, 1].sum()))


@dataclass(frozen=True)
class Row:
    """One printed number beside ours.

    Attributes
    ----------
    table, name, unit : str
    paper, suite : float
        In `unit`; `suite` is NaN where the suite has no such number.
    why : str
        The likely reason of a difference, or what was assumed.
    """

    table: str
    name: str
    unit: str
    paper: float
    suite: float
    why: str = ""

    @property
    def difference_percent(self) -> float:
        """Ours against the paper's in percent; in Table 4 of magnitudes, since the paper does not state its signs."""
        ours, theirs = (abs(self.suite), abs(self.paper)) if self.table.startswith("Table 4") else (self.suite, self.paper)
        return (ours - theirs) / abs(theirs) * 100

    @property
    def difference(self) -> str:
        """The difference as shown: percent, or percentage points where the number itself is in percent."""
        if np.isnan(self.suite):
            return "-"
        return f"{self.suite - self.paper:+.3f}" if self.unit == "%" else f"{self.difference_percent:+.2f} %"


_PITCH = "probably one wrong digit in print; nothing is tuned to it"
_RECORD = "depends on the record and on where the waves lie on the deck"
_MASS = "the deck's mass is identified, within about 10 %"
_PHASE = "near it only with all wheels of a car in phase"
_WHY4 = {
    "Torsion moment": "unknown: no reading explains it",
    "Horizontal bending moment": "E I_z is identified; the sign convention is not stated",
    "Vertical bending moment": _MASS,
    "Vertical displacement": "three quarters are self-weight sag, the same for any mass",
    "Y-reaction in node 1": _PHASE,
    "Y-reaction in node 2": _PHASE,
    "Z-reaction in node 1": _MASS,
    "Z-reaction in node 2": _MASS,
}


def compare(loads: str = "condensed", name: str = "paper") -> tuple[Row, ...]:
    """Return every printed number of the paper beside ours for one way of loading and one scenario."""
    crossing = run(name, loads)
    natural = vehicle("xia2000").modes().frequencies_hz
    rows = [
        Row("Table 2, vehicle", f"mode {i}", "Hz", p, float(s), _PITCH if i == 5 else "")
        for i, (p, s) in enumerate(zip(TABLE2_VEHICLE, natural, strict=True), start=1)
    ]
    rows += _deck_rows(crossing) + _text_rows()
    for key, label in (("from_rigid", "against iteration 0"), ("from_previous", "against the one before")):
        ours = getattr(crossing.deviations, key)
        for i, (p, s) in enumerate(zip(TABLE3[key], ours, strict=False), start=1):
            rows.append(Row(f"Table 3, {label}", f"iteration {i}", "%", p, float(s), _RECORD))
    for column, shown in enumerate((0, crossing.iterations), start=1):
        values = table4(crossing.at(shown))
        label = "iteration 0" if column == 1 else "iteration 4, ours converged"
        rows += [Row(f"Table 4, {label}", k, TABLE4[k][0], TABLE4[k][column], v, _WHY4[k]) for k, v in values.items()]
    return tuple(rows)


def _deck_rows(crossing: Crossing) -> list[Row]:
    """Pair the printed deck frequencies with the beam's named modes, as far as they can be."""
    ours = dict(zip(crossing.deck.mode_names, crossing.deck.frequencies_hz, strict=True))
    pairs = [
        (0, "vertical bending 1", "used: fixes E I_y / m"),
        (1, "lateral bending 1", "used: fixes E I_z"),
        (2, "vertical bending 2", "a plain beam has it at 4 f1; shear in thin webs lowers it"),
        (3, "torsion 1", "used: fixes G J; a shell's torsion is lower"),
    ]
    rows = [Row("Table 2, deck", f"mode {i + 1}: {n}", "Hz", TABLE2_DECK[i], float(ours[n]), why) for i, n, why in pairs]
    why = "not in a plain beam: axial-bending or local modes of the shell"
    rows += [Row("Table 2, deck", f"mode {i + 1}", "Hz", f, float("nan"), why) for i, f in enumerate(TABLE2_DECK) if i > 3]
    return rows


def _text_rows() -> list[Row]:
    """Return the numbers that the paper states in its text."""
    speed = 20.0
    alpha, beta = rayleigh(0.03, (3.307, 16.30))
    rows = [
        Row("Section 2.4", f"damping at {f:.2f} Hz", "%", 3.0, float(100 * rayleigh_ratio(alpha, beta, np.array([f]))[0]), why)
        for f, why in [(3.31, "asked at 3.307 Hz"), (16.30, "")]
    ]
    forcing = [
        (5.0, 36.0, 1.33, "the deck's 36 m; or the line of 1.33 Hz in a record of 3 s"),
        (5.0, 37.5, 1.33, "agrees, but no length of 37.5 m is printed"),
        (11.7, 36.0, 3.31, "3.31 needs l = 35.35 m"),
    ]
    rows += [Row("Section 3", f"forcing, n = {n:g}, l = {l:g} m", "Hz", f, speed * n / (2 * l), why) for n, l, f, why in forcing]
    return rows


def readings() -> list[tuple[dict[str, Any], float]]:
    """Return the first deviation of Eq. 3, percent, for 64 ways to read the paper: what each changes, and what it gives.

    One force a car or true wheel loads, all ways of excitation and of feedback, two wavelengths and four places of
    the waves relative to the deck. Three cars are enough: a fourth comes when the first has left the record that Eq. 3 uses.
    """
    options = {
        "run.loads": ("condensed", "wheels"),
        "run.excitation": ("wheels", "car"),
        "run.feedback": ("all", "vertical"),
        "wavelength": (14.4, 15.0),
        "phase": (0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi),
    }
    base = case("paper").replace({"train.cars": 3, "run.tail": 0.0, "run.iterations": 1})
    result = []
    for values in itertools.product(*options.values()):
        reading = dict(zip(options, values, strict=True))
        changes = {k: v for k, v in reading.items() if k.startswith("run.")}
        for direction, ahead in (("vertical", 0.0), ("lateral", np.pi / 2)):
            changes[f"track.{direction}.wavelength"] = reading["wavelength"]
            changes[f"track.{direction}.phase"] = reading["phase"] + ahead
        result.append((reading, float(base.replace(changes).run().deviations.from_rigid[0])))
    return result


def mass_needed(crossing: Crossing, column: int = 1) -> dict[str, float]:
    """Return the deck mass (kg/m) with which each vertical row of Table 4 would be met exactly.

    Parameters
    ----------
    crossing : Crossing
        As it stands at the iteration that belongs to the column.
    column : int
        1 for the paper's iteration 0, 2 for its iteration 4.

    Notes
    -----
    The live part of moment and reactions is taken not to depend on the mass, that of the displacement to go with its inverse,
    since the first frequency fixes E I_y / m. An estimate: the live part changes a little with the mass.
    """
    deck, mass = crossing.deck, crossing.deck.mass_per_metre
    middle = deck.length / 2
    lines = {
        "Vertical bending moment": (deck.recovery.section("moment_vertical", middle), 1e3),
        "Vertical displacement": (deck.recovery.section("displacement_z", middle), 1e-3),
        "Z-reaction in node 1": (deck.recovery.reaction("force_z", deck.supports[0]), 1e3),
        "Z-reaction in node 2": (deck.recovery.reaction("force_z", deck.supports[-1]), 1e3),
    }
    ours, result = table4(crossing), {}
    for row, (line, unit) in lines.items():
        weight = line.self_weight / unit
        live, printed = ours[row] - weight, TABLE4[row][column]
        result[row] = mass * (live / (printed - weight) if row == "Vertical displacement" else (printed - live) / weight)
    return result


def reproduce() -> dict[str, Any]:
    """Compute everything that ``build/reproduction.json`` holds; keys are stable. SI, except Table 4 in its own units."""
    runs = {(n, loads): run(n, loads) for n in ("paper", "one car") for loads in LOADS}
    deck = runs["paper", "condensed"].deck

    def deviations(crossing: Crossing) -> dict[str, list[float]]:
        return {k: getattr(crossing.deviations, k).tolist() for k in ("from_rigid", "from_previous")}

    def tables(crossing: Crossing) -> dict[str, dict[str, float]]:
        return {"rigid": table4(crossing.at(0)), "converged": table4(crossing)}

    def largest(name: str) -> dict[str, float]:
        middle = deck.length / 2
        return {loads: runs[name, loads].displacement(middle).extreme("displacement_z")[0] for loads in LOADS}

    reading = run("paper reading", "condensed")
    return {
        "vehicle_frequencies_hz": vehicle("xia2000").modes().frequencies_hz.tolist(),
        "deck_frequencies_hz": dict(zip(deck.mode_names, deck.frequencies_hz.tolist(), strict=True)),
        "rayleigh": dict(zip(("alpha", "beta"), rayleigh(0.03, (3.307, 16.30)), strict=True)),
        "bounce_force_amplitude_n": {f"{w:.1f}": bounce_amplitude(w) for w in (14.4, 15.0)},
        "deviation_percent": {loads: deviations(runs["paper", loads]) for loads in LOADS},
        "table4": {loads: tables(runs["paper", loads]) for loads in LOADS},
        "table4_units": {k: v[0] for k, v in TABLE4.items()},
        "midspan_displacement_m": {"one_car": largest("one car"), "eight_cars": largest("paper")},
        "paper_reading": {"deviation_percent": deviations(reading), "table4": tables(reading)},
    }


def report(rows: Iterable[Row]) -> str:
    """Return rows as text, a block for each table: printed, ours, difference, why. A reason is given once where it repeats."""
    lines, table, said = [], None, ""
    for row in rows:
        if row.table != table:
            table, said = row.table, ""
            lines += ["", f"{table:<38} {'paper':>11} {'suite':>11} {'difference':>11}"]
        ours = "-" if np.isnan(row.suite) else f"{row.suite:.3f}"
        why = '  "' if row.why and row.why == said else row.why
        said = row.why
        lines.append(
            f"  {row.name + ' (' + row.unit + ')':<36} {row.paper:>11.3f} {ours:>11} {row.difference:>11}  {why}".rstrip()
        )
    return "\n".join(lines[1:])


def frame(rows: Iterable[Row]):
    """Return rows as a pandas DataFrame of text, as `report` rounds them: paper, suite, difference, why."""
    import pandas as pd

    rows = tuple(rows)
    columns = {
        "": [f"{r.name} ({r.unit})" for r in rows],
        "paper": [f"{r.paper:.3f}" for r in rows],
        "suite": ["-" if np.isnan(r.suite) else f"{r.suite:.3f}" for r in rows],
        "difference": [r.difference for r in rows],
        "why": [r.why for r in rows],
    }
    return pd.DataFrame(columns)


def main() -> None:
    """Print the tables and write ``build/reproduction.json``."""
    for title, name, loads in [
        ("ONE FORCE A CAR (the paper's procedure)", "paper", "condensed"),
        ("TWO FORCES A CAR (one per bogie)", "paper", "bogies"),
        ("TRUE WHEEL LOADS (the coupled solution)", "paper", "wheels"),
        (
            "A GUESS AT THE PAPER'S READING: wheels of a car in phase, vertical feedback only, 15 m waves",
            "paper reading",
            "condensed",
        ),
    ]:
        rows = compare(loads, name)
        if (name, loads) != ("paper", "condensed"):
            rows = [r for r in rows if r.table.startswith(("Table 3", "Table 4"))]
        print(f"\n{title}\n{'=' * len(title)}\n{report(rows)}")
    path = Path("build") / "reproduction.json"
    path.parent.mkdir(exist_ok=True)
    scratch = path.with_suffix(".tmp")
    scratch.write_text(json.dumps(reproduce(), indent=1) + "\n", encoding="utf-8")
    scratch.replace(path)
    print(f"\nThe deck is identified, not known: its section (Figure 6) is missing.\nWritten: {path}")


if __name__ == "__main__":
    main()
