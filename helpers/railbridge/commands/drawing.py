"""The command ``railbridge ensemble``: a case whose track is random, drawn many times.

Mean and standard deviation are exact and hold for all realisations; extremes are given twice, by
probability (for Gaussian answers) and as the realisations have them. What stands in summary.json is
described in ``docs/studies.md``.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from .. import errors
from ..cases import staging
from ..cases.drawn import Drawn
from ..cases.ranges import written_range
from ..cases.summary import to_json
from ..errors import InputError
from . import changing
from .speech import Progress, tell

__all__ = ["add_command"]

FILES = ("histories.csv", "realisations.csv", "statistics.csv", "summary.json")
MEASURE = ("displacement_z", "acceleration_z")
_EXAMPLES = """\
examples:
  railbridge ensemble case.toml --realisations 200 --out drawn
  railbridge ensemble case.toml --set track.vertical.seed=1000 --out others
  railbridge ensemble case.toml --measure acceleration_z --points 9,18 --wheels-of 1,8 --out wheels

The track of the case holds kind = "random" below vertical, lateral or both: the same spectrum,
band, seed and period. Its seed is the first of the realisations. What else is in the track (waves,
dips, a record) is certain.

results (in the folder of --out; files of these names in it are replaced):
  summary.json       of every history its exact sigma, its extremes, the seed of the worst
  statistics.csv     the same as a table, a row an extreme, with confidence intervals
  realisations.csv   smallest and largest value of every history, a row a seed
  histories.csv      exact mean and standard deviation of every history by time
"""


def add_command(add: Callable[..., argparse.ArgumentParser], case: argparse.ArgumentParser) -> None:
    """Add the command to a parser; `case` is the parent of all that take one."""
    parser = add(
        "ensemble", _ensemble, "cross a random track many times: sigma, extremes, worst seeds",
        parents=[case], epilog=_EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument(
        "--out", metavar="DIR", required=True,
        help="folder for the results; made if it does not exist",
    )  # fmt: skip
    parser.add_argument(
        "--realisations", type=int, default=200, metavar="N",
        help="how many are drawn, of the case's seed and those after it (default %(default)s)",
    )  # fmt: skip
    parser.add_argument(
        "--measure", metavar="A,B", default=",".join(MEASURE),
        help="quantities at the points (default %(default)s)",
    )  # fmt: skip
    parser.add_argument(
        "--points", metavar="X,X", help="places along the deck, m; default those of the case"
    )
    parser.add_argument(
        "--wheels-of", metavar="N,N",
        help="cars whose vertical wheel forces are kept, too, with the unloading; from 1",
    )  # fmt: skip
    parser.add_argument(
        "-q", "--quiet", action="store_true", help="no progress, no headlines; errors only"
    )


def _ensemble(given: argparse.Namespace) -> int:
    errors.integer("--realisations", given.realisations, least=2, most=1_000_000)
    points = None
    if given.points is not None:
        points = written_range("--points", given.points, "length").tolist()
    quantities = [name.strip() for name in given.measure.split(",") if name.strip()]
    if "wheel_unloading" in quantities:
        remedy = "Leave it out and give --wheels-of: wheel forces bring it along"
        raise InputError("--measure", given.measure, "wheel_unloading is of wheels", remedy)
    cars = [] if given.wheels_of is None else changing.car_numbers("--wheels-of", given.wheels_of)
    loaded = changing.changed_case(given)
    begun = changing.begun(given, loaded)
    if begun is None:
        return 2
    progress = begun.progress
    names = {"quantities": "--measure", "points": "--points", "car": "--wheels-of"}
    with staging.files(given.out, "--out", FILES) as folder:
        with errors.within(names=names):
            response = loaded.random_response(quantities, points, cars, progress)
        drawn = Drawn.of(loaded, response, given.realisations, progress)
        _write(folder, drawn, progress)
    begun.end(drawn.remarks)
    if not given.quiet:
        for line in drawn.headlines():
            tell(line)
        tell(f"written to {given.out}")
    return 0


def _write(folder: Path, drawn: Drawn, progress: Progress) -> None:
    for name, lines in drawn.tables():
        progress(f"writing {name}")
        with (folder / name).open("w", encoding="utf-8", newline="") as file:
            file.writelines(lines)
    (folder / "summary.json").write_text(to_json(drawn.summary()), encoding="utf-8")
