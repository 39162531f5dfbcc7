"""What the suite is held against: the paper's printed numbers, published cases, closed forms, the fit of Figure 6."""

from .checks import compared

__all__ = ["compared"]
