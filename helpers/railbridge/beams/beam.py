"""Beams in three dimensions: from their properties to a mesh, its modes, and a `Deck`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import errors
from ..contacts import Rail
from ..damping import Damping, checked_damping, damping_ratios, viscosity
from ..decks import Deck, cut_group
from ..errors import InputError, Remark, brief
from .influence import BeamRecovery
from .mesh import DENSE, BeamModes, Mesh
from .properties import BeamProperties, span_ends
from .selection import left_out, needed

__all__ = ["Beam"]


@dataclass(frozen=True)
class Beam(BeamProperties):  # noqa: D101
    # What its fields mean is written once, and read by whoever asks for help on a beam.
    __doc__ = BeamProperties.__doc__

    __repr__ = brief

    @cached_property
    def mesh(self) -> Mesh:
        """The finite-element mesh of modes and histories."""
        wanted = self.elements or 40
        required = self.required_nodes
        edges = [required[:1]]
        for start, end in zip(required[:-1], required[1:], strict=True):
            share = (end - start) / self.length
            # Very short elements among long ones would cost the lowest modes their digits.
            least = 12 if self.elements is None and share > 0.01 else 2
            count = max(least, round(wanted * share))
            masses = [m.x for m in self.point_masses if start < m.x < end]
            parts = np.unique([start, *masses, end])
            for a, b in zip(parts[:-1], parts[1:], strict=True):
                own = max(1, round(count * (b - a) / (end - start)))
                edges.append(np.linspace(a, b, own + 1)[1:])
        return Mesh(self, np.concatenate(edges))

    @cached_property
    def modes(self) -> BeamModes:
        """All modes of the mesh with names, ascending.

        The upper half of them is only the mesh's own.
        """
        return self.mesh.modes()

    def deck(
        self,
        modes: int | None = None,
        damping: Damping = 0.0,
        tracks: dict[str, float] | None = None,
        width: float | None = None,
        track_height: float = 0.0,
        rail: Rail | None = None,
    ) -> Deck:
        """Return the modal deck of the lowest modes that loads can excite.

        Purely axial modes are left out.

        Parameters
        ----------
        modes : int, optional
            How many; chosen if not given, see `selection.needed`.
        damping : float, tuple of float, or ModalDamping
            One ratio for every mode; (alpha, beta) of Rayleigh, 1/s and s; or a ratio for each.
        tracks, width, track_height, rail
            See `Deck`.

        Raises
        ------
        InputError
            More modes than the mesh has, none that moves up and down, or no damping.
        """
        damping = checked_damping(damping)
        natural, kept = self._chosen() if modes is None else self._lowest(modes)
        tracks = {} if tracks is None else errors.table("tracks", tracks)
        frequencies, vectors = natural.frequencies_hz[kept], natural.vectors[:, kept]
        recovery = BeamRecovery(self.mesh, frequencies, vectors)
        return Deck(
            name=self.name,
            length=self.length,
            frequencies_hz=frequencies,
            damping_ratios=damping_ratios(damping, frequencies),
            mode_names=tuple(natural.names[i] for i in kept),
            shapes=self.mesh.interpolate(vectors),
            supports=tuple(sorted({b.x for b in self.bearings})),
            bearings=tuple((b.x, b.y, b.z) for b in self.bearings),
            recovery=recovery,
            tracks=tracks,
            width=width,
            track_height=track_height,
            rail=rail,
            mass_per_metre=self.mass,
            internal_damping=viscosity(damping),
            remarks=(*self.remarks, *self._left_out(modes, natural, recovery)),
        )

    def _chosen(self) -> tuple[BeamModes, list[int]]:
        """Return modes, and which of them are kept where no number is given."""
        spans, asked = len(self.spans), 20 + 8 * len(self.spans)
        while True:
            natural = self.modes if self.mesh.size <= DENSE else self.mesh.modes(asked)
            excitable = np.flatnonzero(natural.excitable)
            whole = len(natural.names) >= self.mesh.basis.shape[1]
            count = needed(natural, excitable, self.fields, spans, whole)
            if count is not None:
                return natural, excitable[:count].tolist()
            asked *= 2

    def _lowest(self, modes: int) -> tuple[BeamModes, list[int]]:
        """Return modes, and which of them are the so many lowest that loads can excite."""
        wanted = errors.integer("modes", modes, least=1)
        natural = self.modes if self.mesh.size <= DENSE else self.mesh.modes(wanted)
        excitable = np.flatnonzero(natural.excitable).tolist()
        if wanted > len(excitable):
            allowed = f"the mesh has {len(excitable)} modes that loads excite"
            raise InputError("modes", modes, allowed, "Use more elements")
        moving = [natural.energies["vertical"][i] > 1e-6 for i in excitable]
        if not any(moving[:wanted]):
            allowed = "none of so few moves up and down"
            first = f"Take at least {moving.index(True) + 1}" if any(moving) else "Take more"
            raise InputError("modes", modes, allowed, f"{first}, or leave modes out")
        return natural, excitable[:wanted]

    def _left_out(
        self, modes: int | None, natural: BeamModes, recovery: BeamRecovery
    ) -> list[Remark]:
        """Return what a given number of modes costs; a chosen one costs nothing worth a remark."""
        if modes is None:
            return []
        known, edges = natural.frequencies_hz[natural.excitable], span_ends(self.spans)
        found = cut_group("modes", known, modes)
        return found + left_out(recovery, known[:modes], (edges[1:] + edges[:-1]) / 2)
