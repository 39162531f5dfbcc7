"""Train and deck together: solved at every step, or by the fixed point in windows of time."""

from .plans import CarSteps, Plan, plan
from .solution import Direct, has_compiler, on_rigid_deck, solve_directly
from .stepping import march
from .windows import FEW, Windows, in_windows

__all__ = [
    "CarSteps", "Direct", "FEW", "Plan", "Windows", "has_compiler", "in_windows", "march",
    "on_rigid_deck", "plan", "solve_directly",
]  # fmt: skip
