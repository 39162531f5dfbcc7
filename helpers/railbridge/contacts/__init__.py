"""Between wheel and deck, where the paper has nothing: mass of wheels, their contacts, rails."""

from .hertz import HertzContact
from .rails import Rail
from .wheelsets import CONTACT_STIFFNESS, Wheelset, on_wheelsets, with_wheelsets

__all__ = [
    "CONTACT_STIFFNESS", "HertzContact", "Rail", "Wheelset", "on_wheelsets", "with_wheelsets",
]  # fmt: skip
