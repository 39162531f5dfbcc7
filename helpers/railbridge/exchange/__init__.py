"""Other programs' models: their nodes and modes in, loads out, and the fixed point with a deck that they solve."""

from .files import deck_from_files, export_modes, read_modes
from .loads import NodalLoads, export_loads, nodal_loads
from .modal import ModalModel, Orthogonality, deck_from_modes
from .nodes import Nodes, RailLine, read_nodes

__all__ = [
    "ModalModel", "NodalLoads", "Nodes", "Orthogonality", "RailLine", "deck_from_files", "deck_from_modes", "export_loads",
    "export_modes", "nodal_loads", "read_modes", "read_nodes",
]  # fmt: skip
