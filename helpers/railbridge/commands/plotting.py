"""The command ``railbridge plot``: a case in, pictures of its crossing out.

Matplotlib is loaded when something is drawn, so that other commands start without it.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

from .. import errors
from ..cases import staging
from ..cautions import unsettled
from ..crossing import NotConvergedError
from . import changing
from .speech import say

__all__ = ["add_command"]

_EXAMPLES = """\
examples:
  railbridge plot case.toml --out pictures
  railbridge plot case.toml --out pictures --format svg --only displacement wheels --cars 1,8
  railbridge plot paper --out fast --set run.speed=30

what is drawn, by the names of --only (a name is that of a file; those of points and cars end with
theirs, as in displacement_at_18m.png and wheels_1.png):
%s
What a deck or a train does not have, and a direction in which nothing happens, is left out. Files
of these names in the folder of --out are replaced, others are left alone.
"""


def add_command(add: Callable[..., argparse.ArgumentParser], case: argparse.ArgumentParser) -> None:
    """Add the command to a parser; `case` is the parent of all that take one."""
    parser = add(
        "plot", _plot, "run a case and draw pictures of it",
        parents=[case], formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument(
        "--out", metavar="DIR", required=True,
        help="folder for the pictures; made if it does not exist",
    )  # fmt: skip
    parser.add_argument(
        "--format", metavar="FORMAT", default="png",
        help="png, svg or pdf (default %(default)s)",
    )  # fmt: skip
    parser.add_argument(
        "--only", metavar="NAME", nargs="+", action="extend", default=[],
        help="what is drawn, some of the names below (default all)",
    )  # fmt: skip
    parser.add_argument(
        "--cars", metavar="N,N", default="1",
        help="cars whose wheel forces and bodies are drawn, from 1 (default %(default)s)",
    )  # fmt: skip
    parser.add_argument(
        "--dpi", type=int, default=120, metavar="N",
        help="of png: the pictures are 9 inches wide (default %(default)s)",
    )  # fmt: skip
    parser.add_argument(
        "-q", "--quiet", action="store_true", help="no progress, no line at the end; errors only"
    )
    plain = parser.format_help

    def with_names() -> str:
        from ..plots import gallery

        names = "".join(f"  {kind:<16}{about}\n" for kind, about in gallery.KINDS.items())
        parser.epilog = _EXAMPLES % names
        return plain()

    parser.format_help = with_names


def _plot(given: argparse.Namespace) -> int:
    from ..plots import gallery

    form = errors.choice("--format", given.format, gallery.FORMATS)
    kinds = [errors.choice("--only", name, gallery.KINDS) for name in given.only or gallery.KINDS]
    dpi = errors.integer("--dpi", given.dpi, least=30, most=1200)
    cars = changing.car_numbers("--cars", given.cars)
    loaded = changing.changed_case(given)
    with errors.within(names={"car": "--cars"}):
        for car in cars:
            loaded.train.car(car)
    begun = changing.begun(given, loaded)
    if begun is None:
        return 2
    progress, message = begun.progress, ""
    names = [f"{name}.{form}" for name in gallery.file_names(loaded.points, cars, kinds)]
    drawn = 0
    with staging.files(given.out, "--out", names) as folder:
        try:
            run = loaded.compute(progress)
        except NotConvergedError as error:
            run, message = error.run, str(error)
        for piece in gallery.figures_of(run, loaded.points, cars, kinds):
            progress(f"drawing {piece.name}.{form}")
            path = folder / f"{piece.name}.{form}"
            gallery.write(piece.draw(), path, form, dpi, piece.about)
            drawn += 1
    begun.end(loaded.remarks(run))
    if message:
        say(f"{message} What there is was drawn all the same.")
    if not given.quiet:
        for kind, reason in gallery.absent(run, kinds).items():
            say(f"left out: {kind} ({reason})")
        say(f"{drawn} picture{'s' * (drawn != 1)} written to {given.out}")
    # A run that has not settled is said in words by the remark that was printed as a warning.
    return 3 if message or unsettled(run) else 0
