r"""One box that Figure 6 could have shown: what the search found and stored, and how it behaves.

The only place of the suite where numbers are fitted; `candidates` says what was sought and how a
box is compared, `fitting` how it was searched. Sixteen printed numbers cannot fix sixteen unknowns
that act alike, so the result is *one box that fits*, identified and not known; the singular values
of the sensitivities say which combinations of dimensions the data fix and which they leave open.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np

from ..boxes import Box, BoxMesh
from ..boxes.comparison import pairs, shell_against_beam
from ..boxes.pads import Pad
from ..boxes.shell import Shell
from ..cases import shelf
from ..errors import InputError
from . import published
from .candidates import (
    COARSE,
    DECK_NAME,
    FAMILIES,
    HYPOTHESES,
    MODES,
    Fit,
    evaluate,
    families,
)

__all__ = ["beam_frequencies", "bearing_study", "identified", "stored", "table"]


def stored() -> dict[str, Any]:
    """Return the stored identification: what `fitting.identify` returned.

    Raises
    ------
    InputError
        None stored, or not readable.
    """
    path = shelf.data_root() / "identification" / f"{DECK_NAME}.json"
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        problem = f"cannot be read ({type(error).__name__})"
        raise InputError("identification", path.name, problem, "Run: make identify") from None


def identified(mesh: BoxMesh | None = None) -> Fit:
    """Solve the stored box again, once, and compare it with Table 2."""
    best = stored()["best"]
    return evaluate(best["values"], best["inner_diaphragms"], best["hypothesis"], mesh)


def beam_frequencies(box: Box, mesh: BoxMesh = COARSE) -> dict[str, tuple[float, float]]:
    """Return the beam's mode that belongs to each of `FAMILIES` of the shell of the same box.

    Returns
    -------
    dict
        By family: the frequency, Hz, and the likeness of both shapes, 0 to 1.
    """
    shell, beam = box.shell(mesh), box.beam()
    modes = shell.modes(MODES)
    mode_of = families(shell, modes, box.length)
    height = shell.centre[1] - box.section.shear_centre[1]
    likeness = shell_against_beam(shell, modes, beam, height)
    partner = pairs(likeness[list(mode_of.values())], least=0.0)
    frequencies = beam.modes.frequencies_hz
    return {
        family: (float(frequencies[partner[row]]), float(likeness[mode, partner[row]]))
        for row, (family, mode) in enumerate(mode_of.items())
    }


def table(fit: Fit, beam: dict[str, tuple[float, float]] | None = None):
    """Return a pandas DataFrame: printed, shell, difference, and the beam where it has such a mode.

    Parameters
    ----------
    fit : Fit
    beam : dict, optional
        From `beam_frequencies` of the same box.
    """
    import pandas as pd

    count = len(published.TABLE2_DECK)
    columns: dict[str, Any] = {
        "printed (Hz)": published.TABLE2_DECK,
        "shell (Hz)": fit.frequencies_hz,
        "difference (%)": fit.differences,
        "mode of the shell": fit.names,
    }
    if beam is not None:
        place_of = dict(zip(FAMILIES, HYPOTHESES[fit.hypothesis], strict=True))
        for i, name in enumerate(("beam (Hz)", "likeness of shell and beam")):
            by_place = {place_of[family]: values[i] for family, values in beam.items()}
            columns[name] = [by_place.get(place, np.nan) for place in range(count)]
    return pd.DataFrame(columns, index=pd.RangeIndex(1, count + 1, name="mode"))


def bearing_study(box: Box, mesh: BoxMesh = COARSE) -> dict[str, dict[str, float]]:
    """Test what makes a vertical mode at 4.9 times the first: other lengthwise bearings at x = 0.

    Returns
    -------
    dict
        For each kind of bearing, the frequencies (Hz) of `FAMILIES` of the shell. ``in the axis``
        has the identified springs on the webs at the height of the centre of mass: second bending
        and the axial mode then no longer know of each other.
    """
    shell = box.shell(mesh)
    result = {}
    for kind in ("as identified", "rigid", "soft (1 MN/m)", "in the axis"):
        pads = tuple(p for pad in shell.pads for p in _changed_pad(shell, pad, kind))
        changed = replace(shell, pads=pads)
        modes = changed.modes(MODES)
        mode_of = families(changed, modes, box.length)
        result[kind] = {k: float(modes.frequencies_hz[i]) for k, i in mode_of.items()}
    return result


def _changed_pad(shell: Shell, pad: Pad, kind: str) -> tuple[Pad, ...]:
    """Return what stands for a pad; only those with a lengthwise spring change."""
    if "x" not in pad.stiffness or kind == "as identified":
        return (pad,)
    if kind == "rigid":
        return (replace(pad, fixed=("x", *pad.fixed), stiffness={}),)
    if kind == "soft (1 MN/m)":
        return (replace(pad, stiffness={"x": 1e6}),)
    # In the axis: on the web, at the node nearest to the height of the centre of mass.
    points = shell.points
    sideways = np.abs(points[:, 0] - points[pad.point, 0])
    node = int(np.argmin(np.abs(points[:, 1] - shell.centre[1]) + sideways))
    return replace(pad, stiffness={}), replace(pad, fixed=(), arm=0.0, point=node)
