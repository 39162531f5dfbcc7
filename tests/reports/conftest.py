"""A small case, its run and its report, made once for all tests of reports."""

import pytest
from pageparts import QUICK

import railbridge as rb


@pytest.fixture(scope="session")
def quick():
    """A case that is computed in no time, and its run."""
    case = rb.case(QUICK)
    return case, case.compute()


@pytest.fixture(scope="session")
def quick_report(quick):
    case, run = quick
    return rb.reports.report_of_run(case, run)
