"""The shell of a box girder.

Points and strips of its section, stations, diaphragms, pads under its webs.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from itertools import pairwise
from typing import Annotated

import numpy as np

from ..errors import Range, check_fields
from ..settings import MEMORY_LIMIT, refuse_bytes
from .dimensions import BoxDimensions
from .pads import Pad
from .plates import Plate, Strip
from .shell import Shell, shell_bytes

__all__ = ["BoxMesh", "node_count", "shell_of"]

_JOINS_NOTHING = "A web without elements across joins nothing"


@dataclass(frozen=True)
class BoxMesh:
    """Numbers of elements of a box's shell.

    Attributes
    ----------
    along : int
        Elements along each span.
    web : int
        Elements over a web's height.
    slab : int
        Elements between the webs, in slab and bottom.
    cantilever : int
        Elements over a cantilever.
    """

    along: Annotated[int, Range(least=4, most=400, whole=True)] = 40
    web: Annotated[int, Range(least=1, most=50, whole=True, remedy=_JOINS_NOTHING)] = 4
    slab: Annotated[int, Range(least=2, most=100, whole=True)] = 6
    cantilever: Annotated[int, Range(least=1, most=50, whole=True)] = 3

    def __post_init__(self) -> None:
        check_fields(self)

    def refined(self, factor: float) -> BoxMesh:
        """Return a mesh with `factor` times as many elements each way."""
        return BoxMesh(*(max(2, round(factor * getattr(self, f.name))) for f in fields(self)))

    @property
    def heads(self) -> tuple[int, int]:
        """Points of the section at the heads of the left and the right web."""
        return self.cantilever, self.cantilever + self.slab


def shell_of(box: BoxDimensions, mesh: BoxMesh) -> Shell:
    """Return the shell of a box.

    Plates lie in the middle planes; a cantilever's runs straight from the web's head to its edge.
    Where a web runs into the slab it would be counted twice: that strip carries shear only (see
    `Strip.counted`). At the bottom corners what is counted twice and what is left out are equal.
    What mass is still missing beside the drawing lies on the webs' heads.
    """
    _refuse_size(box, mesh)
    web, edge = box.web_spacing / 2, box.slab_width / 2
    y = np.concatenate(
        [
            np.linspace(edge, web, mesh.cantilever + 1),
            np.linspace(web, -web, mesh.slab + 1)[1:],
            np.linspace(-web, -edge, mesh.cantilever + 1)[1:],
        ]
    )
    top, low = box.depth - box.head_thickness / 2, box.bottom_thickness / 2
    outer = np.interp(np.abs(y), [web, edge], [top, box.depth - box.edge_thickness / 2])
    points = [
        np.column_stack([y, np.where(np.abs(y) > web, outer, box.depth - box.thickness(y) / 2)])
    ]
    heads = mesh.heads
    strips = []
    for i in range(len(y) - 1):
        part = "slab" if heads[0] <= i < heads[1] else "cantilevers"
        added = box.track_mass / box.web_spacing if part == "slab" else 0.0
        # The mean over the strip keeps the mass of cantilevers and haunches.
        share = (np.arange(20) + 0.5) / 20
        strips.append(
            Strip(
                i, i + 1, float(box.thickness(y[i] + share * (y[i + 1] - y[i])).mean()), part, added
            )
        )
    heights = np.linspace(low, box.depth - box.head_thickness, mesh.web + 1)
    feet, count = [], len(y)
    for side, head in zip((1, -1), heads, strict=True):
        points.append(np.column_stack([side * box.web(heights), heights]))
        ids = [*range(count, count + len(heights)), head]
        feet.append(count)
        count += len(heights)
        strips += [
            Strip(a, b, box.web_thickness, "webs") for a, b in zip(ids[:-2], ids[1:-1], strict=True)
        ]
        strips.append(Strip(ids[-2], ids[-1], box.web_thickness, "webs", counted=False))
    across = np.linspace(box.bottom_spacing / 2, -box.bottom_spacing / 2, mesh.slab + 1)
    points.append(np.column_stack([across[1:-1], np.full(mesh.slab - 1, low)]))
    ids = [feet[0], *range(count, count + mesh.slab - 1), feet[1]]
    strips += [
        Strip(a, b, box.bottom_thickness, "bottom") for a, b in zip(ids[:-1], ids[1:], strict=True)
    ]
    shell = Shell(
        np.concatenate(points),
        tuple(strips),
        _stations(box, mesh),
        box.youngs_modulus,
        box.poisson_ratio,
        box.density,
        plates=_diaphragms(box, np.concatenate(points), heads, np.append(heights, top)),
        pads=tuple(
            Pad(p.x, p.length, feet[0 if side > 0 else 1], low + p.drop, p.fixed, dict(p.stiffness))
            for p in box.bearings
            for side in p.sides
        ),
    )
    missing = box.concrete_mass + box.track_mass - shell.mass_per_metre
    masses = dict.fromkeys(heads, missing / 2) | dict.fromkeys((0, len(y) - 1), box.edge_mass / 2)
    return replace(shell, line_masses=masses)


def _refuse_size(box: BoxDimensions, mesh: BoxMesh) -> None:
    """Refuse a mesh that would not fit into memory, by the number of elements that is largest."""
    usual = BoxMesh()
    size = node_count(box, mesh)
    needed = shell_bytes(6 * size, 15)
    if needed <= MEMORY_LIMIT:
        return
    # What has too many spans or diaphragms is no fault of the mesh.
    if shell_bytes(6 * node_count(box, usual), 15) > MEMORY_LIMIT:
        inner, lines = box.inner_diaphragms * len(box.spans), len(box.bearings)
        field = "inner_diaphragms" if inner > lines else "bearings"
        value, remedy = box.inner_diaphragms if inner > lines else lines, "Use fewer"
    else:
        field = max(vars(mesh), key=lambda name: getattr(mesh, name) / getattr(usual, name))
        value, remedy, field = getattr(mesh, field), "Use fewer elements", f"mesh.{field}"
    refuse_bytes(field, value, needed, f"gives the shell {size} nodes, which", remedy)


def node_count(box: BoxDimensions, mesh: BoxMesh) -> int:
    """Return how many nodes the shell of a box has."""
    points = 2 * mesh.cantilever + 2 * mesh.slab + 2 * (mesh.web + 1)
    inner = mesh.web * (mesh.slab - 1) * len(_diaphragm_places(box))
    return points * len(_stations(box, mesh)) + inner


def _stations(box: BoxDimensions, mesh: BoxMesh) -> np.ndarray:
    places = [np.linspace(a, b, mesh.along + 1) for a, b in pairwise(box.span_ends)]
    ends = [[-box.overhang], [box.length + box.overhang]] if box.overhang else []
    return np.unique(np.round(np.concatenate([*places, *ends, _diaphragm_places(box)]), 9))


def _diaphragm_places(box: BoxDimensions) -> np.ndarray:
    """Bearing lines, which may lie inside a span, too, and inner diaphragms, m."""
    inner = [np.linspace(a, b, box.inner_diaphragms + 2)[1:-1] for a, b in pairwise(box.span_ends)]
    return np.unique(np.round(np.concatenate([_bearing_lines(box), *inner]), 9))


def _bearing_lines(box: BoxDimensions) -> np.ndarray:
    """Places of bearings, m."""
    return np.unique(np.round([p.x for p in box.bearings], 9))


def _diaphragms(
    box: BoxDimensions, points: np.ndarray, heads: tuple[int, int], heights: np.ndarray
) -> tuple[Plate, ...]:
    """Plates across; their grid joins the nodes of slab, webs and bottom."""
    slab = points[heads[0] : heads[1] + 1]
    low = heights[0]
    spacing = np.interp(heights, [low, heights[-1]], [box.bottom_spacing, box.web_spacing])
    share = np.linspace(0.5, -0.5, len(slab))
    # Straight lines from bottom to slab; the slab's middle plane need not be level.
    rise = (heights - low) / (heights[-1] - low)
    grid = np.stack(
        [spacing[:, None] * share, low + rise[:, None] * (slab[:, 1] - low)],
        axis=2,
    )
    lines, places = _bearing_lines(box), _diaphragm_places(box).tolist()
    thickness = [
        box.diaphragm_thickness if x in lines else box.inner_diaphragm_thickness for x in places
    ]
    return tuple(Plate(x, t, grid) for x, t in zip(places, thickness, strict=True) if t is not None)
