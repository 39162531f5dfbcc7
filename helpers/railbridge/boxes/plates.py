r"""Prismatic plates: a section carried along stations, its elements, matrices and inertias.

A section is points (y, z) joined by strips; carried along stations x it becomes a mesh of four-node
shell elements (`pyfe3d`: Mindlin plate with reduced shear, membrane with drilling rotations after
Allman). All elements of a strip that are equally long are equal, so each is computed once. Plates
across the deck (diaphragms) stand at stations.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array, diags_array

from ..errors import InputError, brief

__all__ = ["Plate", "PlateModel", "Strip", "freedoms_of"]


@dataclass(frozen=True)
class Strip:
    """A plate between two points of the section.

    Attributes
    ----------
    start, end : int
        Points of the section.
    thickness : float
        m.
    part : str
        Name of what it belongs to: slab, left web ...
    added : float
        Mass it carries besides its own, kg/m2.
    counted : bool
        False where the strip lies inside another one: it then carries shear and forces across, but
        no mass and no stress along the deck, which the other one has already.
    """

    start: int
    end: int
    thickness: float
    part: str
    added: float = 0.0
    counted: bool = True


@dataclass(frozen=True, eq=False)
class Plate:
    """A plate across the deck at x (m).

    Attributes
    ----------
    x : float
        m; a station.
    thickness : float
        m.
    points : ndarray, shape (rows, columns, 2)
        y and z of its grid, m. The outer rows and columns must be points of the section.
    """

    __repr__ = brief

    x: float
    thickness: float
    points: np.ndarray


def _fem():
    """Load pyfe3d, or say how to get it."""
    try:
        import pyfe3d
        from pyfe3d.shellprop_utils import isotropic_plate
    except ImportError:
        raise InputError(
            "shell", None, "the package pyfe3d is missing", 'Run: pip install -e ".[fem]"'
        ) from None
    return pyfe3d, isotropic_plate


def _element(corners: np.ndarray, prop) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and mass of a four-node element in global axes, shape (24, 24) each.

    Its corners have the shape (4, 3).
    """
    pyfe3d, _ = _fem()
    sizes = pyfe3d.Quad4Data()
    element = pyfe3d.Quad4(pyfe3d.Quad4Probe())
    element.c1, element.c2, element.c3, element.c4 = 0, 6, 12, 18
    # The drilling rotation by Allman's enrichment: a penalty would leave the webs too stiff in
    # their plane.
    element.drilling_model = 0
    x = np.ascontiguousarray(corners, dtype=float).ravel()
    element.update_rotation_matrix(x)
    element.update_probe_xe(x)
    result = []
    for size, update in (
        (sizes.KC0_SPARSE_SIZE, element.update_KC0),
        (sizes.M_SPARSE_SIZE, element.update_M),
    ):
        rows, columns, values = (
            np.zeros(size, dtype=pyfe3d.INT),
            np.zeros(size, dtype=pyfe3d.INT),
            np.zeros(size),
        )
        update(rows, columns, values, prop)
        matrix = np.zeros((24, 24))
        np.add.at(matrix, (rows, columns), values)
        result.append((matrix + matrix.T) / 2)
    return result[0], result[1]


def freedoms_of(quads: np.ndarray) -> np.ndarray:
    """Return the freedoms of elements from their corner nodes, shape (e, 24)."""
    return (6 * quads[:, :, None] + np.arange(6)).reshape(-1, 24)


@dataclass(frozen=True, eq=False)
class PlateModel:
    """A prismatic shell without its bearings.

    Attributes
    ----------
    points : ndarray, shape (p, 2)
        y and z of the section's points, m.
    strips : tuple of Strip
    stations : ndarray, shape (s,)
        x of the rows of nodes, m, ascending.
    youngs_modulus, poisson_ratio, density : float
        Pa, -, kg/m3.
    plates : tuple of Plate
    line_masses : dict of float
        Mass per metre (kg/m) carried at a point of the section.
    """

    __repr__ = brief

    points: np.ndarray
    strips: tuple[Strip, ...]
    stations: np.ndarray
    youngs_modulus: float
    poisson_ratio: float
    density: float
    plates: tuple[Plate, ...] = ()
    line_masses: dict[int, float] = field(default_factory=dict)

    # ---- geometry

    @cached_property
    def nodes(self) -> np.ndarray:
        """All nodes, shape (n, 3), m: station by station, then the inner nodes of the plates."""
        section = np.broadcast_to(self.points, (len(self.stations), *self.points.shape))
        x = np.broadcast_to(self.stations[:, None, None], (*section.shape[:2], 1))
        inner = [
            np.column_stack([np.full(len(p), plate.x), p])
            for plate in self.plates
            for p in [plate.points[1:-1, 1:-1].reshape(-1, 2)]
        ]
        return np.concatenate([np.concatenate([x, section], axis=2).reshape(-1, 3), *inner])

    @cached_property
    def quads(self) -> np.ndarray:
        """Corner nodes of all elements, shape (e, 4).

        Strip by strip along the deck, then the plates.
        """
        return np.concatenate([self._strip_quads.reshape(-1, 4), *self._plate_quads])

    @cached_property
    def _strip_quads(self) -> np.ndarray:
        """Corner nodes, shape (strips, stations - 1, 4)."""
        first = len(self.points) * np.arange(len(self.stations) - 1)
        i, j = np.array([[s.start, s.end] for s in self.strips]).T[:, :, None]
        step = len(self.points)
        return np.stack([first + i, first + i + step, first + j + step, first + j], axis=2)

    @cached_property
    def _plate_quads(self) -> list[np.ndarray]:
        result, inner = [], len(self.points) * len(self.stations)
        for number, plate in enumerate(self.plates, start=1):
            station = int(np.argmin(np.abs(self.stations - plate.x)))
            if abs(self.stations[station] - plate.x) > 1e-9:
                raise InputError(f"plates[{number}].x", plate.x, "is not at a station of the mesh")
            grid = np.empty(plate.points.shape[:2], dtype=int)
            grid[1:-1, 1:-1] = inner + np.arange(grid[1:-1, 1:-1].size).reshape(
                grid[1:-1, 1:-1].shape
            )
            inner += grid[1:-1, 1:-1].size
            for r, c in np.ndindex(grid.shape):
                if r in (0, grid.shape[0] - 1) or c in (0, grid.shape[1] - 1):
                    away = np.linalg.norm(self.points - plate.points[r, c], axis=1)
                    if away.min() > 1e-9:
                        raise InputError(
                            f"plates[{number}].points",
                            plate.points[r, c],
                            "its edge is not a point of the section",
                        )
                    grid[r, c] = station * len(self.points) + int(np.argmin(away))
            result.append(
                np.stack(
                    [grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2
                ).reshape(-1, 4)
            )
        return result

    # ---- matrices

    def _property(self, thickness: float, added: float = 0.0, counted: bool = True):
        _, isotropic_plate = _fem()
        prop = isotropic_plate(
            thickness, self.youngs_modulus, self.poisson_ratio, rho=self.density if counted else 0.0
        )
        prop.intrho += added
        if not counted:
            # Element x runs along the deck: no stress that way, all the rest.
            prop.A22 *= 1.0 - self.poisson_ratio**2
            prop.A12, prop.A11 = 0.0, 1e-3 * prop.A22
        return prop

    @cached_property
    def _elements(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Equal elements together.

        Their stiffness and mass, shape (24, 24), and corner nodes, shape (e, 4).
        """
        result = []
        lengths = np.round(np.diff(self.stations), 9)
        for strip, row in zip(self.strips, self._strip_quads, strict=True):
            prop = self._property(strip.thickness, strip.added, strip.counted)
            for length in np.unique(lengths):
                same = row[lengths == length]
                result.append((*_element(self.nodes[same[0]], prop), same))
        # Plates of one drawing at several stations have equal elements, too.
        alike: dict[tuple, list[np.ndarray]] = {}
        for plate, corners in zip(self.plates, self._plate_quads, strict=True):
            alike.setdefault((plate.thickness, plate.points.tobytes()), []).append(corners)
        for (thickness, _), grids in alike.items():
            prop = self._property(thickness)
            for same in np.stack(grids, axis=1):
                result.append((*_element(self.nodes[same[0]], prop), same))
        return result

    @cached_property
    def _point_inertia(self) -> np.ndarray:
        """Mass of the lines at every freedom, kg, shape (6 nodes,)."""
        extra = np.zeros((len(self.nodes), 6))
        for point, mass in self.line_masses.items():
            extra[point : len(self.points) * len(self.stations) : len(self.points), :3] += (
                mass * self.tributary[:, None]
            )
        return extra.ravel()

    @cached_property
    def matrices(self) -> tuple[csr_array, csr_array]:
        """K and M over all freedoms (six a node), bearings not yet applied, sparse."""
        freedoms = np.concatenate([freedoms_of(quads) for *_, quads in self._elements])
        rows, columns = np.repeat(freedoms, 24, axis=1).ravel(), np.tile(freedoms, (1, 24)).ravel()
        size = 6 * len(self.nodes)
        result = []
        for which in (0, 1):
            values = np.concatenate([np.tile(e[which].ravel(), len(e[2])) for e in self._elements])
            result.append(csr_array((values, (rows, columns)), shape=(size, size)))
        return result[0], result[1] + diags_array(self._point_inertia).tocsr()

    @cached_property
    def tributary(self) -> np.ndarray:
        """Length along the deck that belongs to each station, m."""
        half = np.diff(self.stations) / 2
        return np.concatenate([[0.0], half]) + np.concatenate([half, [0.0]])

    # ---- inertia

    @cached_property
    def point_masses(self) -> np.ndarray:
        """Mass per metre at each point of the section, kg/m, shape (p,).

        Plates across the deck are not in it.
        """
        result = np.zeros(len(self.points))
        for s in self.strips:
            length = np.linalg.norm(self.points[s.end] - self.points[s.start])
            mass = length * (self.density * s.thickness * s.counted + s.added) / 2
            result[[s.start, s.end]] += mass
        for point, mass in self.line_masses.items():
            result[point] += mass
        return result

    @property
    def mass_per_metre(self) -> float:
        """kg/m, without plates across."""
        return float(self.point_masses.sum())

    @property
    def centre(self) -> np.ndarray:
        """Centre of mass of the section, y and z, m."""
        return self.point_masses @ self.points / self.point_masses.sum()

    @cached_property
    def inertias(self) -> np.ndarray:
        """Inertia per metre of the section's rigid motions: x y z (kg/m), roll pitch yaw (kg m)."""
        y, z = (self.points - self.centre).T
        m = self.point_masses
        return np.array([m.sum()] * 3 + [m @ (y**2 + z**2), m @ z**2, m @ y**2])
