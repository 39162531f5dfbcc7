r"""Boxes that the paper's missing Figure 6 could have shown, and how each compares with Table 2.

Figure 6 has the section and the properties of the deck. The deck's 15 natural frequencies are
printed (Table 2), and Table 4 fixes the mass per metre within about 10 %. The search among the
boxes is in `fitting`, what it found in `identification`.

*Pairing.* By shape, not by order: five modes of the deck as a whole are found by how much of their
kinetic energy is a sine of half waves (first vertical, lateral, torsion, second vertical) or a
uniform motion along the deck (axial-bending), and carry the printed frequencies of `HYPOTHESES`.
About the shapes of the other ten the paper says nothing; they are paired in ascending order.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import errors
from ..boxes import Box, BoxMesh, Pads
from ..boxes.comparison import pairs
from ..boxes.motions import ShellModes
from ..boxes.shell import Shell
from . import published

__all__ = [
    "COARSE", "DECK_NAME", "FAMILIES", "HYPOTHESES", "MODES", "UNKNOWNS", "Fit", "Unknown",
    "box_of", "evaluate", "families", "paired_modes",
]  # fmt: skip

DECK_NAME = "viaduct36_identified"
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

MODES = len(published.TABLE2_DECK) + 5
"""Modes of a shell that are solved: more than are printed, so that one that moves down is seen."""


@dataclass(frozen=True)
class Unknown:
    """A dimension to be found, within bounds that an engineer would accept.

    Attributes
    ----------
    name : str
        Of `Box`; or ``bottom share`` (web spacing at the bottom over that at the slab),
        ``log10 stiffness`` (of each of the two pads that hold lengthwise, N/m) or ``drop`` of all
        pads.
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
        digits = {"m": 3, "Pa": -8, "kg/m": 0, "-": 3, "N/m": 2}
        return round(value, digits[self.unit]) + 0.0


UNKNOWNS = (
    Unknown("slab_width", 8.6, 11.0, "m", "two tracks 2.4 m off the axis with clearance; walkways"),
    Unknown("slab_thickness", 0.18, 0.40, "m", "railway slabs: at least about 0.2"),
    Unknown("root_thickness", 0.20, 0.50, "m", "cantilever at the web"),
    Unknown("edge_thickness", 0.15, 0.30, "m", "least cover and steel at the edge"),
    Unknown("depth", 1.6, 2.6, "m", "span / 22 to span / 14"),
    Unknown("web_thickness", 0.20, 0.60, "m", "room for tendons; the box alone carries shear"),
    Unknown("web_spacing", 4.0, 6.2, "m", "webs under the tracks"),
    Unknown(
        "bottom share", 0.65, 1.0, "-", "webs upright or leaning, never farther apart at the bottom"
    ),
    Unknown("bottom_thickness", 0.12, 0.40, "m", "usual bottom plates"),
    Unknown("diaphragm_thickness", 0.15, 1.0, "m", "plate or solid end block"),
    Unknown(
        "inner_diaphragm_thickness",
        0.15,
        0.40,
        "m",
        "thin plates; without effect where there are none",
    ),
    Unknown("youngs_modulus", 25e9, 38e9, "Pa", "concretes of the time, static to dynamic modulus"),
    Unknown("track_mass", 0.0, 3000.0, "kg/m", "none to slab tracks; between the webs"),
    Unknown("edge_mass", 0.0, 1500.0, "kg/m", "none to parapets; both edges together"),
    Unknown(
        "log10 stiffness",
        8.5,
        11.0,
        "N/m",
        "of each lengthwise fixed pad: elastomer to nearly rigid",
    ),
    Unknown("drop", 0.0, 0.4, "m", "of the bearing's point of rotation below the box"),
)


def box_of(values: dict[str, float], inner_diaphragms: int = 0, name: str = DECK_NAME) -> Box:
    """Return the box of given unknowns.

    One span of 36 m, held lengthwise by springs at x = 0, density 2500 kg/m3, Poisson's ratio 0.2.

    Parameters
    ----------
    values : dict of float
        By name of `UNKNOWNS`, in SI.
    inner_diaphragms : int
    name : str
    """
    dimensions = dict(values)
    spring, drop = float(10 ** dimensions.pop("log10 stiffness")), dimensions.pop("drop")
    dimensions["bottom_spacing"] = dimensions.pop("bottom share") * dimensions["web_spacing"]
    return Box(
        name,
        (published.SPAN,),
        **dimensions,
        inner_diaphragms=inner_diaphragms,
        bearings=(
            Pads(0.0, ("y", "z"), {"x": spring}, drop=drop),
            Pads(published.SPAN, ("y", "z"), drop=drop),
        ),
        tracks={"left": 2.4, "right": -2.4},
    )


def families(shell: Shell, modes: ShellModes, length: float) -> dict[str, int]:
    """Find the modes of `FAMILIES` by their shapes.

    Returns
    -------
    dict
        Number of the mode, from 0, by family: the best assignment of modes to shapes, each shape
        measured by the share of kinetic energy it takes up.
    """
    x, weight = shell.stations, shell.tributary
    waves = {0: np.ones_like(x)} | {n: np.sin(n * np.pi * x / length) for n in (1, 2)}
    shares = []
    for component, half_waves in ((2, 1), (1, 1), (2, 2), (3, 1), (0, 0)):
        shape, inertia = waves[half_waves], shell.inertias[component]
        part = (weight * shape) @ modes.motions[:, component]
        shares.append(inertia * part**2 / ((weight * shape) @ shape))
    assigned = pairs(np.array(shares), least=0.0)
    return {FAMILIES[row]: mode for row, mode in assigned.items()}


@dataclass(frozen=True, eq=False)
class Fit:
    """One box and how it compares.

    Attributes
    ----------
    values : dict of float
        By name of the unknown, in SI.
    inner_diaphragms : int
    hypothesis : str
        Of `HYPOTHESES`.
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
        return 100 * (self.frequencies_hz / np.array(published.TABLE2_DECK) - 1)

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
            "rms_all_percent": round(self.rms(len(published.TABLE2_DECK)), 3),
        }


def paired_modes(
    box: Box, hypothesis: str = "as ordered", mesh: BoxMesh = COARSE
) -> tuple[ShellModes, np.ndarray]:
    """Return the modes of a box's shell, and which of them belongs to each printed frequency.

    Parameters
    ----------
    box : Box
    hypothesis : str
        One of `HYPOTHESES`.
    mesh : BoxMesh

    Returns
    -------
    ShellModes, and ndarray of int, shape (15,)
        Modes are numbered from 0.

    Raises
    ------
    InputError
        Unknown hypothesis.
    """
    places = HYPOTHESES[errors.choice("hypothesis", hypothesis, HYPOTHESES)]
    shell = box.shell(mesh)
    modes = shell.modes(MODES)
    mode_of = families(shell, modes, box.length)
    which = np.full(len(published.TABLE2_DECK), -1)
    for family, place in zip(FAMILIES, places, strict=True):
        which[place] = mode_of[family]
    rest = [mode for mode in range(len(modes.names)) if mode not in which]
    which[which < 0] = rest[: int(np.sum(which < 0))]
    return modes, which


def evaluate(
    values: dict[str, float],
    inner_diaphragms: int = 0,
    hypothesis: str = "as ordered",
    mesh: BoxMesh | None = None,
) -> Fit:
    """Solve the shell of given unknowns once and compare it with Table 2.

    Parameters
    ----------
    values, inner_diaphragms
        See `box_of`.
    hypothesis : str
        One of `HYPOTHESES`.
    mesh : BoxMesh, optional
        Without, the default mesh.
    """
    box = box_of(values, inner_diaphragms)
    modes, which = paired_modes(box, hypothesis, mesh or BoxMesh())
    return Fit(
        dict(values),
        inner_diaphragms,
        hypothesis,
        modes.frequencies_hz[which],
        tuple(modes.names[i] for i in which),
        box.mass_per_metre,
    )
