"""Other programs' models: nodes and modes in, loads out, and the fixed point with their deck."""

from .files import export_modes, read_modes
from .loads import NodalLoads, export_loads, nodal_loads
from .modal import ModalModel, Orthogonality, deck_from_modes
from .modes_table import ModesTable, beside, sources, stamps
from .nodes import Nodes, RailLine, read_nodes

__all__ = [
    "ModalModel", "ModesTable", "NodalLoads", "Nodes", "Orthogonality", "RailLine", "beside",
    "deck_from_modes", "export_loads", "export_modes", "nodal_loads", "read_modes", "read_nodes",
    "sources", "stamps",
]  # fmt: skip
