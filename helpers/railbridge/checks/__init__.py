"""One table of verdicts for a deck and its trains: the clauses of `codes`, judged by `studies`.

Needs the extra ``study`` where trains are taken over speeds.
"""

from .assessment import Assessment, assess, assess_run, usual_speeds
from .requirements import Requirements

__all__ = ["Assessment", "Requirements", "assess", "assess_run", "usual_speeds"]
