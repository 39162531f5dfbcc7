"""What the suite is held against: theirs, ours, difference, why.

The paper's printed numbers (`published`, `scenarios`, `paper`), published cases and closed forms
(`references`, `crossings`, `verification`), the fit of the missing Figure 6 (`identification`,
`fitting`), and one line that compares two numbers (`compared`).
"""

from .rows import compared

__all__ = ["compared"]
