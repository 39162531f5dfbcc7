"""The command ``railbridge``: case files in, results out.

Exit codes: 0 all is well; 1 the computer failed (disk, memory); 2 the case file or a path is wrong,
with one line that names the key, or a value is doubted and ``--strict`` given; 3 the iteration did
not converge or settle, results written all the same; 130 interrupted (128 and its number for other
signals), nothing half-written.
"""

from __future__ import annotations

import argparse
import json
import shlex
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from ..cases import pages, shelf, staging
from ..cases.axletrains import train_list
from ..cases.definition import Case, case
from ..cases.summary import histories, to_json
from ..cautions import unsettled
from ..crossing import NotConvergedError
from ..decks import Deck
from ..errors import InputError, InputWarning, integer, printable, within
from ..lessons import exercises, marking
from ..results import Crossing
from ..settings import bytes_needed
from . import changing, copies, drawing, plotting, reporting, studying
from .speech import Progress, nowhere, say, tell

__all__ = ["main"]

FILES = ("points.csv", "wheels.csv", "cars.csv", "reactions.csv", "iterations.csv", "summary.json")
KINDS = ("vehicles", "trains", "decks", "spectra", "cases")

DESCRIPTION = """\
What a train does to a railway bridge: case files in, results out.

A case file is TOML with five tables: [deck], [train], [track],
[run] and [output]; all numbers are SI (m, kg, s, N).
"""
EXAMPLES = """\
examples:
  railbridge new case.toml                   write a commented case file that runs as it is
  railbridge check case.toml                 say whether it can be run and how large the run is
  railbridge run case.toml --out results     run it; results/summary.json has the numbers
  railbridge run paper --out paper           run a shipped case by its name
  railbridge run case.toml --out fast --set run.speed=30 --set train.cars=4
  railbridge plot case.toml --out pictures   run it and draw displacements, forces, car bodies
  railbridge check deck.toml                 the check for a deck file, with its frequencies
  railbridge envelope deck.toml --trains HSLM-A --speeds 150:300km/h --out envelope
                                             the largest response to ten trains over speeds
  railbridge new --study study.toml          write a commented study file
  railbridge sweep study.toml --out study    a case over values of any of its keys
  railbridge ensemble case.toml --realisations 200 --out drawn
                                             a case whose track is random, drawn many times
  railbridge report case.toml --out bridge.html
                                             a page for a checker: inputs, results, verdicts
  railbridge list                            vehicles, decks and cases that are shipped
  railbridge copy-notebooks my-course        the lessons as copies of your own; done again, it
                                             renews those that are not edited
  railbridge copy-notebooks class --student  what to hand out: no outputs, no solutions
  railbridge mark handed-in --out marks.csv  run what a class handed in: a row per student
  railbridge schema > case.schema.json       for editors that complete and check TOML files

results (in the folder of --out; files of these names in it are replaced):
  summary.json     extremes with time and place, static values, dynamic factors, envelope,
                   reactions, wheels, car bodies, and every car by itself
  points.csv       displacement, acceleration and section forces at output.points
  wheels.csv       lateral and vertical force of every wheel on the deck
  cars.csv         accelerations of every car's body, front, middle and rear
  reactions.csv    forces of every bearing line on the deck
  iterations.csv   displacement of the first point after every iteration
  The first column of every CSV file is t, in s; the names of the others end with their unit.

exit codes:
  0 done    1 out of memory or disk    2 bad case file or path, or doubts with --strict
  3 not converged, or not settled by run.iterations (results are written)
  130 interrupted    143 stopped
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit code."""
    try:
        _open_streams()
        with staging.stopping():
            return _guarded(arguments)
    except KeyboardInterrupt:
        say("interrupted; nothing was written")
        return 130
    except staging.Stopped as stopped:
        say("stopped; nothing was written")
        return 128 + stopped.number


def _guarded(arguments: Sequence[str] | None) -> int:
    """Run the command; say in one line what went wrong."""
    given = _parser().parse_args(arguments)
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("once")
            warnings.simplefilter("ignore", RuntimeWarning)
            warnings.showwarning = lambda message, *_, **__: say(f"warning: {message}")
            code = given.command(given)
            sys.stdout.flush()
            return code
    except InputError as error:
        say(str(error))
        return 2
    except BrokenPipeError:
        sys.stdout = nowhere()  # what is left in it would complain once more at the end
        return 1
    except MemoryError:
        say(
            "out of memory: use a larger run.time_step, fewer cars, or a shorter run.lead_in "
            "or run.tail"
        )
        return 1
    except OSError as error:
        say(f"{error.filename or 'the output'}: {error.strerror or error}")
        if not error.filename:
            sys.stdout = nowhere()
        return 1


def _open_streams() -> None:
    """Give the program somewhere to write where whoever started it closed its output."""
    if sys.stdout is None:
        sys.stdout = nowhere()
    if sys.stderr is None:
        sys.stderr = nowhere()
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that lacks a letter is no reason to stop
            stream.reconfigure(errors="backslashreplace")


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        super().error(printable(message))


def _parser() -> argparse.ArgumentParser:
    def add(name: str, command, about: str, **options: Any) -> argparse.ArgumentParser:
        made = commands.add_parser(
            name, help=about, description=about[0].upper() + about[1:] + ".", **options
        )
        made.set_defaults(command=command)
        return made

    raw = argparse.RawDescriptionHelpFormatter
    parser = _Parser("railbridge", description=DESCRIPTION, epilog=EXAMPLES, formatter_class=raw)
    commands = parser.add_subparsers(required=True, metavar="command")
    changes = changing.options()
    run = add(
        "run",
        _run,
        "run a case and write its results",
        parents=[changes],
        epilog=EXAMPLES,
        formatter_class=raw,
    )
    run.add_argument(
        "--out",
        metavar="DIR",
        required=True,
        help="folder for the results; made if it does not exist",
    )
    run.add_argument("--no-histories", action="store_true", help="write summary.json only")
    run.add_argument(
        "-q", "--quiet", action="store_true", help="no progress, no line at the end; errors only"
    )
    add(
        "check",
        _check,
        "say whether a case can be run, and how large the run is; or what a deck file makes",
        parents=[changes],
    )
    new = add("new", _new, "write a commented case file that runs as it is")
    new.add_argument("file", help="file to write; one that exists is left alone")
    new.add_argument("--study", action="store_true", help="a study file for railbridge sweep")
    listing = add("list", _list, "list shipped vehicles, trains, decks, spectra and cases")
    listing.add_argument("kind", nargs="?", choices=KINDS, help="all five if left out")
    copying = add(
        "copy-notebooks",
        _copy_notebooks,
        "copy the notebooks, and the data files they lead to, into a folder of your own",
    )
    copying.add_argument(
        "folder",
        metavar="DIR",
        help="made if it does not exist; copies that were edited or run are left alone",
    )
    copying.add_argument(
        "--force",
        action="store_true",
        help="replace edited copies too; yours is kept beside as NAME.edited-1",
    )
    editions = copying.add_mutually_exclusive_group()
    editions.add_argument(
        "--student",
        action="store_const",
        dest="edition",
        const="student",
        help="without outputs and solutions; what figures show is folded",
    )
    editions.add_argument(
        "--teacher",
        action="store_const",
        dest="edition",
        const="teacher",
        help="with every answer in its place, the teacher's page and sheets to print",
    )
    copying.set_defaults(edition="reader")
    mark = add(
        "mark",
        _mark,
        "run the notebooks of a class and write a table of marks, a row per student",
        epilog="The notebooks are programs of other people and run with your rights.",
    )
    mark.add_argument(
        "folder", metavar="DIR", help="holds a folder per student with the notebooks in it"
    )
    mark.add_argument(
        "--out", metavar="FILE", required=True, help="the table, a new file that ends in .csv"
    )
    mark.add_argument(
        "--only", metavar="NN", nargs="+", default=[], help="numbers of the notebooks to mark"
    )
    mark.add_argument(
        "--jobs", type=int, default=2, help="how many run at once (default %(default)s)"
    )
    studying.add_commands(add)
    drawing.add_command(add, changes)
    plotting.add_command(add, changes)
    reporting.add_command(add, changes)
    add(
        "schema",
        _schema,
        "print the JSON schema of case files, for editors that complete and check them",
    )
    return parser


def _run(given: argparse.Namespace) -> int:
    loaded = changing.changed_case(given)
    begun = changing.begun(given, loaded)
    if begun is None:
        return 2
    with staging.files(given.out, "--out", FILES) as folder:
        code = 0
        try:
            run = loaded.compute(begun.progress)
        except NotConvergedError as error:
            run, code, message = error.run, 3, str(error)
        _write(folder, loaded, run, begun.progress, not given.no_histories)
    begun.end(loaded.remarks(run))
    if code:
        say(f"{message} What there is was written to {given.out}.")
    elif unsettled(run):
        # Said in words by the remark that was printed as a warning.
        code = 3
        say(f"not settled: {_headline(loaded, run)}; written to {given.out}")
    elif not given.quiet:
        say(f"{_headline(loaded, run)}; written to {given.out}")
    return code


def _headline(loaded: Case, run: Crossing) -> str:
    passes = f"{run.iterations} iteration{'s' * (run.iterations != 1)}"
    solved = f"solved ({run.settings.interaction})"
    if run.converged is not None:
        solved = f"converged in {passes}"
        if run.windows is not None:
            solved = f"converged in {len(run.windows.stops)} windows in time"
        if not run.converged:
            solved = f"{passes}, last change {run.changes[-1]:.2g}"
    x, value = _worst(loaded, run)
    if len(loaded.points) > 1:
        return f"{solved}, displacement is largest at x = {x:g} m, {value * 1e3:.4g} mm"
    return f"{solved}, displacement at x = {x:g} m is {value * 1e3:.4g} mm"


def _worst(loaded: Case, run: Crossing) -> tuple[float, float]:
    """Return the point that moves most and its displacement, m; the vertical one if there is any.

    Signed.
    """
    name = "displacement_z" if run.deck.has["z"] else "displacement_y"
    found = [(x, run.displacement(x).extreme(name)[0]) for x in loaded.points]
    return max(found, key=lambda each: abs(each[1]))


def _write(
    folder: Path, loaded: Case, run: Crossing, progress: Progress, with_histories: bool
) -> None:
    if with_histories:
        for table in histories(run, loaded.points):
            done = 0
            with (folder / f"{table.name}.csv").open("w", encoding="utf-8", newline="") as file:
                for rows in table.rows():
                    file.write(rows)
                    done += 1
                    progress(f"writing {table.name}.csv, {done} 000 rows")
    progress("writing summary.json")
    (folder / "summary.json").write_text(to_json(loaded.summary(run)), encoding="utf-8")


def _check(given: argparse.Namespace) -> int:
    if changing.is_deck(given.case):
        return _check_deck(given)
    loaded = changing.changed_case(given)
    if changing.doubted(given, loaded):
        return 2
    needed = bytes_needed(loaded.train, loaded.deck, loaded.settings, len(loaded.points))
    s = loaded.settings
    seconds = (loaded.deck.length + loaded.train.length) / s.speed + s.tail
    wheels = len(loaded.train.wheels)
    tell(
        f"{given.case}: can be run; {wheels} wheels, {seconds:.3g} s in steps of "
        f"{s.time_step:.3g} s, {needed / 1e9:.2g} GB; deck: {_modes(loaded.deck)}"
    )
    return 0


def _check_deck(given: argparse.Namespace) -> int:
    if given.set:
        allowed = f"changes keys of a case, and {given.case} is a deck"
        raise InputError("--set", given.set[0], allowed, "Change the file itself")
    file = str(Path(given.case).absolute()) if shelf.is_path(given.case) else given.case
    # Under a usual train at a usual speed, so that what is doubted is the deck.
    train, run = {"name": "HSLM-A1"}, {"speed": 30.0}
    with within(names={"deck": ""}):
        loaded = case({"deck": {"file": file}, "train": train, "run": run})
    doubts = [r for r in loaded.doubts if isinstance(r, InputWarning)]
    for doubt in doubts:
        say("warning: " * (not given.strict) + f"{doubt.field.removeprefix('deck.')} {doubt.text}")
    if doubts and given.strict:
        return 2
    tell(
        f"{given.case}: a deck that can be used, {loaded.deck.length:g} m; {_modes(loaded.deck)}; "
        f"next: railbridge envelope {shlex.quote(given.case)} --trains HSLM-A "
        "--speeds 150:300km/h --out envelope"
    )
    return 0


def _modes(deck: Deck) -> str:
    first, *_, last = [deck.frequencies_hz[0], *deck.frequencies_hz]
    return f"{_count(len(deck.frequencies_hz), 'mode')}, f1 = {first:.4g} Hz, up to {last:.4g} Hz"


def _new(given: argparse.Namespace) -> int:
    path = Path(given.file)
    if path.suffix != ".toml":
        raise InputError("file", given.file, "must end in .toml")
    try:
        make = pages.study_starter if given.study else pages.starter
        staging.new_file(path, make(path.name))
    except FileExistsError:
        raise InputError(
            "file", given.file, "exists already and is left alone", "Choose another name"
        ) from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InputError("file", given.file, f"cannot be written ({why})") from None
    way = "sweep" if given.study else "run"
    tell(f"{given.file} written; run it with: railbridge {way} {given.file} --out results")
    return 0


def _list(given: argparse.Namespace) -> int:
    for kind in [given.kind] if given.kind else KINDS:
        print(kind)
        if kind == "trains":
            for t in train_list():
                said = f"{t.axles} axles, {t.length:.4g} m, {t.weight / 1e3:.5g} kN"
                tell(f"  {t.name:<20}{said}")
            continue
        names = shelf.data_names(kind)
        width = max([20, *(len(name) + 1 for name in names)])
        for name in names:
            tell(f"  {name:<{width}}{_about(shelf.data_file(kind, name))}".rstrip())
    return 0


def _about(path: Path) -> str:
    """Return the first line of comment in a data file, or what the file is."""
    first = path.read_text(encoding="utf-8").partition("\n")[0]
    return (
        first.lstrip("# ").strip()
        if first.startswith("#")
        else "a two-bogie car, 15 freedoms" * (path.suffix == ".csv")
    )


def _schema(given: argparse.Namespace) -> int:
    print(json.dumps(pages.schema(), indent=2))
    return 0


def _copy_notebooks(given: argparse.Namespace) -> int:
    folder = Path(given.folder)
    with staging.folder(given.folder, "DIR") as staged:
        planned = copies.plan(folder, given.force, given.edition)
        copies.stage(planned, folder, staged.scratch)
        if staged.existed or not staged.become():
            copies.place(planned, folder, staged.scratch)
    for copy in planned:
        if copy.action in ("updated", "kept", "replaced"):
            tell(
                f"{copy.action:10}{copy.name}"
                + f"  (yours is now {copy.backup})" * bool(copy.backup)
            )
    count = {
        a: sum(c.action == a for c in planned)
        for a in ("copied", "updated", "replaced", "unchanged", "kept")
    }
    tell(f"{given.folder}: " + ", ".join(f"{n} {action}" for action, n in count.items() if n))
    if count["kept"]:
        print(
            "kept: changed since they were copied; --force replaces them and keeps yours "
            "beside under another name"
        )
    tell(f"open them with: python -m jupyterlab {shlex.quote(given.folder)}")
    return 0


def _mark(given: argparse.Namespace) -> int:
    jobs = integer("--jobs", given.jobs, least=1, most=64)
    if Path(given.out).suffix != ".csv":
        raise InputError("--out", given.out, "must end in .csv")
    if Path(given.out).exists():
        remedy = "Choose another name, or move it away"
        raise InputError("--out", given.out, "exists already and is left alone", remedy)
    handed_in = marking.submissions(Path(given.folder), given.only)
    pages = {each.page for each in handed_in}
    asked = [e for e in exercises().values() if e.page in pages]
    progress = Progress(quiet=False)
    rows = marking.marked(handed_in, jobs, progress=progress)
    progress.end()
    staging.new_file(Path(given.out), marking.table(rows, asked))
    for row in rows:
        for remark in row.remarks:
            tell(f"{row.student}: {remark}")
    read = f"{_count(len(rows), 'student')}, {_count(len(handed_in), 'notebook')}"
    tell(f"{read}; written to {given.out}")
    return 0


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}" + "s" * (number != 1)


if __name__ == "__main__":
    sys.exit(main())
