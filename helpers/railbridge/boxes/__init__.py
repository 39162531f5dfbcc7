"""Single-cell box girders from their dimensions: section, beam and shell from the same data (extra ``fem``)."""

from .boxshell import BoxMesh
from .comparison import mac, pairs, shell_against_beam
from .girder import Box, Pads
from .section import SectionProperties, section_properties
from .shell import Shell, ShellModes

__all__ = [
    "Box", "BoxMesh", "Pads", "SectionProperties", "Shell", "ShellModes", "mac", "pairs", "section_properties",
    "shell_against_beam",
]  # fmt: skip
