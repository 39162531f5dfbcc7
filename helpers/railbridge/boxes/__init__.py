"""Single-cell box girders from their dimensions (extra ``fem``).

Section, beam and shell come from the same data.
"""

from .boxshell import BoxMesh
from .comparison import beam_motions, mac, pairs, shell_against_beam
from .dimensions import BoxDimensions, Pads
from .girder import Box
from .motions import ShellModes
from .section import SectionProperties, section_properties
from .shell import Shell

__all__ = [
    "Box", "BoxDimensions", "BoxMesh", "Pads", "SectionProperties", "Shell", "ShellModes",
    "beam_motions", "mac", "pairs", "section_properties", "shell_against_beam",
]  # fmt: skip
