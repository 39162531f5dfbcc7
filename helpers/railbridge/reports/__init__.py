"""Calculations as pages that can be handed to a checker, and their numbers as workbooks.

A page is one file without scripts, and nothing in it is fetched from elsewhere. Needs the extra
``report``.
"""

from .document import Report
from .extras import needed
from .judgements import judged_over_speeds, judged_run
from .making import (
    report,
    report_of_assessment,
    report_of_envelope,
    report_of_run,
    report_of_study,
)
from .parts import Column, Notes, Picture, Section, Table, Words
from .places import GENERATOR, refuse_foreign

__all__ = [
    "Column", "GENERATOR", "Notes", "Picture", "Report", "Section", "Table", "Words",
    "judged_over_speeds", "judged_run", "needed", "refuse_foreign", "report",
    "report_of_assessment", "report_of_envelope", "report_of_run", "report_of_study",
]  # fmt: skip
