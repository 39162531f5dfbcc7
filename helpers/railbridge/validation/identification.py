r"""Which box could Figure 6 have shown? Dimensions whose shell comes closest to the printed frequencies.

The only place of the suite where numbers are fitted; the search itself is in `fitting`. Figure 6 (section and properties) is
missing; the deck's 15 natural frequencies are printed (Table 2), and Table 4 fixes the mass per metre within about 10 %.
Sixteen numbers cannot fix sixteen unknowns that act alike, so the result is *one box that fits*, identified and not known; the
singular values of the sensitivities say which combinations of dimensions the data fix and which they leave open.

*Pairing.* By shape, not by order: five modes of the deck as a whole are found by how much of their kinetic energy is a
sine of half waves (first vertical, lateral, torsion, second vertical) or a uniform motion along the deck (axial-bending),
and carry the printed frequencies of `HYPOTHESES`. About the shapes of the other ten the paper says nothing; they are
paired in ascending order.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import errors
from ..boxes.comparison import pairs, shell_against_beam
from ..boxes.girder import Box, BoxMesh, Pads
from ..boxes.motions import ShellModes
from ..boxes.pads import Pad
from ..boxes.shell import Shell
from ..cases import shelf
from ..errors import InputError
from .paper import TABLE2_DECK

__all__ = [
    "COARSE", "FAMILIES", "HYPOTHESES", "MASS", "SINGLE", "UNKNOWNS", "Fit", "Unknown", "beam_frequencies", "bearing_study",
    "box_of", "evaluate", "families", "identified", "solved", "stored", "table",
]  # fmt: skip

MASS = 12000.0
"""Mass per metre that Table 4's self-weight asks for, kg/m, within about 10 %."""

SINGLE = "viaduct36_identified"
"""Name of the deck file that the identification writes."""

FAMILIES = ("vertical 1", "lateral 1", "vertical 2", "torsion 1", "axial-bending 1")
"""The modes of the deck as a whole that are recognised by their shapes."""

HYPOTHESES = {
    "as ordered": (0, 1, 2, 3, 4),
    "lateral above second vertical": (0, 2, 1, 3, 4),
    "torsion third, second vertical fourth": (0, 1, 3, 2, 4),
}
"""Place in Table 2 of each of `FAMILIES`, from 0."""

COARSE = BoxMesh(24, 3, 6, 3)
"""Mesh of the search; its frequencies are 0.5 to 2 % above the limit. The default mesh polishes."""

_EXTRA = 5  # modes beyond the printed ones, so that one that moves down is seen


@dataclass(frozen=True)
class Unknown:
    """A dimension to be found, within bounds that an engineer would accept.

    Attributes
    ----------
    name : str
        Of `Box`; or ``bottom share`` (web spacing at the bottom over that at the slab), ``log10 stiffness`` (of each of the
        two pads that hold lengthwise, N/m) or ``drop`` of all pads.
    low, high : float
    unit : str
    why : str
        Reason of the bounds.
    """

    name: str
    low: float
    high: float
    unit: str
    why: str

    def rounded(self, value: float) -> float:
        """Return a value as one would write it into a drawing: mm, 0.1 GPa, kg/m."""
        return round(value, {"m": 3, "Pa": -8, "kg/m": 0, "-": 3, "N/m": 2}[self.unit]) + 0.0


UNKNOWNS = (
    Unknown("slab_width", 8.6, 11.0, "m", "two tracks 2.4 m off the axis with clearance; walkways"),
    Unknown("slab_thickness", 0.18, 0.40, "m", "railway slabs: at least about 0.2"),
    Unknown("root_thickness", 0.20, 0.50, "m", "cantilever at the web"),
    Unknown("edge_thickness", 0.15, 0.30, "m", "least cover and steel at the edge"),
    Unknown("depth", 1.6, 2.6, "m", "span / 22 to span / 14"),
    Unknown("web_thickness", 0.20, 0.60, "m", "room for tendons; the box alone carries shear"),
    Unknown("web_spacing", 4.0, 6.2, "m", "webs under the tracks"),
    Unknown("bottom share", 0.65, 1.0, "-", "webs upright or leaning, never farther apart at the bottom"),
    Unknown("bottom_thickness", 0.12, 0.40, "m", "usual bottom plates"),
    Unknown("diaphragm_thickness", 0.15, 1.0, "m", "plate or solid end block"),
    Unknown("inner_diaphragm_thickness", 0.15, 0.40, "m", "thin plates; without effect where there are none"),
    Unknown("youngs_modulus", 25e9, 38e9, "Pa", "concretes of the time, static to dynamic modulus"),
    Unknown("track_mass", 0.0, 3000.0, "kg/m", "none to slab tracks; between the webs"),
    Unknown("edge_mass", 0.0, 1500.0, "kg/m", "none to parapets; both edges together"),
    Unknown("log10 stiffness", 8.5, 11.0, "N/m", "of each lengthwise fixed pad: elastomer to nearly rigid"),
    Unknown("drop", 0.0, 0.4, "m", "of the bearing's point of rotation below the box"),
)


def box_of(values: dict[str, float], inner_diaphragms: int = 0, name: str = SINGLE) -> Box:
    """Return the box of given unknowns: one span of 36 m, held lengthwise by springs at x = 0, density 2500, nu 0.2."""
    dimensions = dict(values)
    spring, drop = float(10 ** dimensions.pop("log10 stiffness")), dimensions.pop("drop")
    dimensions["bottom_spacing"] = dimensions.pop("bottom share") * dimensions["web_spacing"]
    held = Pads(0.0, ("y", "z"), {"x": spring}, drop=drop), Pads(36.0, ("y", "z"), drop=drop)
    tracks = {"left": 2.4, "right": -2.4}
    return Box(name, (36.0,), **dimensions, inner_diaphragms=inner_diaphragms, bearings=held, tracks=tracks)


def families(shell: Shell, modes: ShellModes, length: float) -> dict[str, int]:
    """Find the modes of `FAMILIES` by their shapes.

    Returns
    -------
    dict
        Number of the mode, from 0, by family: the best assignment of modes to shapes, each shape measured by the share of
        kinetic energy it takes up.
    """
    x, weight = shell.stations, shell.tributary
    waves = {1: np.sin(np.pi * x / length), 2: np.sin(2 * np.pi * x / length), 0: np.ones_like(x)}
    rows = []
    for component, wave in ((2, 1), (1, 1), (2, 2), (3, 1), (0, 0)):
        shape, inertia = waves[wave], shell.inertias[component]
        part = (weight * shape) @ modes.motions[:, component]
        rows.append(inertia * part**2 / ((weight * shape) @ shape))
    found = pairs(np.array(rows), least=0.0)
    return {FAMILIES[row]: mode for row, mode in found.items()}


@dataclass(frozen=True, eq=False)
class Fit:
    """One box and how it compares.

    Attributes
    ----------
    values : dict of float
        By name of the unknown, in SI.
    inner_diaphragms : int
    hypothesis : str
    frequencies_hz : ndarray, shape (15,)
        Of the shell, in the order of the printed ones they are paired with.
    names : tuple of str
        What those modes are.
    mass : float
        kg/m.
    """

    values: dict[str, float]
    inner_diaphragms: int
    hypothesis: str
    frequencies_hz: np.ndarray
    names: tuple[str, ...]
    mass: float

    @property
    def differences(self) -> np.ndarray:
        """Percent of the printed frequency, shape (15,)."""
        return 100 * (self.frequencies_hz / np.array(TABLE2_DECK) - 1)

    def rms(self, count: int = 10) -> float:
        """Root mean square of the first differences, percent."""
        return float(np.sqrt(np.mean(self.differences[:count] ** 2)))

    def to_dict(self) -> dict[str, Any]:
        """Return what is stored, plain numbers and texts."""
        return {
            "values": self.values,
            "inner_diaphragms": self.inner_diaphragms,
            "hypothesis": self.hypothesis,
            "frequencies_hz": [round(float(f), 4) for f in self.frequencies_hz],
            "names": list(self.names),
            "mass": round(self.mass, 1),
            "rms_first_ten_percent": round(self.rms(), 3),
            "rms_all_percent": round(self.rms(len(TABLE2_DECK)), 3),
        }


def stored() -> dict[str, Any]:
    """Return the stored identification.

    Raises
    ------
    InputError
        None stored, or not readable.
    """
    path = shelf.data_root() / "identification" / f"{SINGLE}.json"
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError("identification", path.name, f"cannot be read ({type(error).__name__})", "Run: make identify") from None


def solved(box: Box, hypothesis: str = "as ordered", mesh: BoxMesh = COARSE) -> tuple[ShellModes, np.ndarray]:
    """Return the modes of a box's shell, and which of them (from 0) belongs to each printed frequency, shape (15,)."""
    places = HYPOTHESES[errors.choice("hypothesis", hypothesis, HYPOTHESES)]
    shell = box.shell(mesh)
    modes = shell.modes(len(TABLE2_DECK) + _EXTRA)
    found = families(shell, modes, box.length)
    which = np.full(len(TABLE2_DECK), -1)
    for family, place in zip(FAMILIES, places, strict=True):
        which[place] = found[family]
    rest = [m for m in range(len(modes.names)) if m not in which]
    which[which < 0] = rest[: int(np.sum(which < 0))]
    return modes, which


def evaluate(
    values: dict[str, float], inner_diaphragms: int = 0, hypothesis: str = "as ordered", mesh: BoxMesh | None = None
) -> Fit:
    """Solve the shell of given unknowns once and compare it with Table 2."""
    box = box_of(values, inner_diaphragms)
    modes, which = solved(box, hypothesis, mesh or BoxMesh())
    names = tuple(modes.names[i] for i in which)
    return Fit(dict(values), inner_diaphragms, hypothesis, modes.frequencies_hz[which], names, box.mass_per_metre)


def identified(mesh: BoxMesh | None = None) -> Fit:
    """Solve the stored box again, once, and compare it with Table 2."""
    best = stored()["best"]
    return evaluate(best["values"], best["inner_diaphragms"], best["hypothesis"], mesh)


def beam_frequencies(box: Box, mesh: BoxMesh = COARSE) -> dict[str, tuple[float, float]]:
    """Return frequency (Hz) and likeness (0 to 1) of the beam's mode that belongs to each of `FAMILIES` of the shell."""
    shell, beam = box.shell(mesh), box.beam()
    modes = shell.modes(len(TABLE2_DECK) + _EXTRA)
    found = families(shell, modes, box.length)
    criterion = shell_against_beam(shell, modes, beam, shell.centre[1] - box.section.shear_centre[1])
    like = pairs(criterion[list(found.values())], least=0.0)
    return {
        family: (float(beam.modes.frequencies_hz[like[row]]), float(criterion[mode, like[row]]))
        for row, (family, mode) in enumerate(found.items())
    }


def table(fit: Fit, beam: dict[str, tuple[float, float]] | None = None):
    """Return a pandas DataFrame: printed, shell, difference and, where it has such a mode, the beam of the same box.

    Parameters
    ----------
    fit : Fit
    beam : dict, optional
        From `beam_frequencies`.
    """
    import pandas as pd

    columns: dict[str, Any] = {"printed (Hz)": TABLE2_DECK, "shell (Hz)": fit.frequencies_hz, "difference (%)": fit.differences}
    columns["mode of the shell"] = fit.names
    if beam is not None:
        places = HYPOTHESES[fit.hypothesis]
        for i, name in enumerate(("beam (Hz)", "likeness of shell and beam")):
            by_place = {places[FAMILIES.index(k)]: value[i] for k, value in beam.items()}
            columns[name] = [by_place.get(p, np.nan) for p in range(len(TABLE2_DECK))]
    return pd.DataFrame(columns, index=pd.RangeIndex(1, len(TABLE2_DECK) + 1, name="mode"))


def bearing_study(box: Box, mesh: BoxMesh = COARSE) -> dict[str, dict[str, float]]:
    """Test what makes a vertical mode at 4.9 times the first: the shell with other lengthwise bearings at x = 0.

    Returns
    -------
    dict
        For each kind of bearing, the frequencies (Hz) of `FAMILIES`. ``in the axis`` has the identified springs on the
        webs at the height of the centre of mass: second bending and the axial mode then no longer know of each other.
    """
    shell = box.shell(mesh)

    def held(pad: Pad, kind: str) -> tuple[Pad, ...]:
        if "x" not in pad.stiffness:
            return (pad,)
        if kind == "rigid":
            return (replace(pad, fixed=("x", *pad.fixed), stiffness={}),)
        if kind == "soft (1 MN/m)":
            return (replace(pad, stiffness={"x": 1e6}),)
        if kind == "in the axis":
            # On the web, at the node nearest to that height.
            height = np.abs(shell.points[:, 1] - shell.centre[1]) + np.abs(shell.points[:, 0] - shell.points[pad.point, 0])
            return replace(pad, stiffness={}), replace(pad, fixed=(), arm=0.0, point=int(np.argmin(height)))
        return (pad,)

    result = {}
    for kind in ("as identified", "rigid", "soft (1 MN/m)", "in the axis"):
        changed = replace(shell, pads=tuple(p for pad in shell.pads for p in held(pad, kind)))
        modes = changed.modes(len(TABLE2_DECK) + _EXTRA)
        result[kind] = {k: float(modes.frequencies_hz[i]) for k, i in families(changed, modes, box.length).items()}
    return result
