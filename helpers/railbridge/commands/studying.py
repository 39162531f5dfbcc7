"""The commands ``railbridge sweep`` and ``railbridge envelope``: many crossings into one folder.

Finished points stand in the folder as they come; the same command goes on where it stopped.
"""

from __future__ import annotations

import argparse
import sys
import textwrap
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import errors, studies
from ..cases import pages, shelf, staging, sweeping
from ..cases.axletrains import train_list
from ..cases.definition import Case
from ..cases.ranges import unit_of, written_ends, written_range
from ..cases.studytrains import trains_of_case
from ..errors import InputError
from ..settings import MEMORY_LIMIT
from ..trains import AxleTrain
from . import findings
from .speech import say, tell

if TYPE_CHECKING:
    import xarray as xr

__all__ = [
    "FAILED", "Asking", "add_commands", "add_envelope_options", "crossings_told", "envelope_plan",
    "refuse_large", "say_remarks", "study_plan",
]  # fmt: skip

_ENVELOPE_EXAMPLES = """\
examples:
  railbridge envelope deck.toml --trains HSLM-A --speeds 150:300km/h --out envelope
      speeds chosen, finer beside each peak: the safe way to find the largest response
  railbridge envelope deck.toml --trains ICE2,my_train.csv --speeds 150:300:2.5km/h --out even
      equal steps; a sharp peak between two of them is missed. The last speed is always in
"""
_UNLOADS = "wheel_unloading"

SAMPLED = 2
"""Points that are computed to estimate how long the rest takes."""
HOURS = 12.0
FAILED = 3
"""Exit code where some points have no numbers."""
STUDY = ("case", "trains", "measure", "points", "over")


def add_commands(add: Callable[..., argparse.ArgumentParser]) -> None:
    """Add both commands to a parser; `add` takes name, function, and what it is about."""
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument(
        "--out", metavar="DIR", required=True,
        help="folder for the results; one with finished points is gone on with",
    )  # fmt: skip
    common.add_argument(
        "--dry-run", action="store_true", help="say how many crossings, how long and how large"
    )
    common.add_argument(
        "--workers", type=int, default=1, metavar="N", help="processes (default %(default)s)"
    )
    common.add_argument(
        "--cluster", metavar="ADDRESS", help="a running Dask scheduler, as tcp://host:8786"
    )
    common.add_argument(
        "--chunk", type=int, metavar="N",
        help="points computed together, lost at most when it is stopped (default: some seconds)",
    )  # fmt: skip
    common.add_argument(
        "--hours", type=float, default=HOURS,
        help="refuse what would take longer (default %(default)g)",
    )  # fmt: skip
    common.add_argument("-q", "--quiet", action="store_true", help="no progress; errors only")
    sweep = add(
        "sweep", _sweep, "run a case over values of its keys, as a study file says",
        parents=[common], formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="a study file (railbridge new --study study.toml writes it):\n\n"
        + textwrap.indent(pages.study_starter("study.toml"), "  "),
    )  # fmt: skip
    sweep.add_argument("study", help="a study file (.toml); see docs/studies.md")
    envelope = add(
        "envelope", _envelope, "find the largest response of a deck to trains over speeds",
        parents=[common], formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=_ENVELOPE_EXAMPLES,
    )  # fmt: skip
    envelope.add_argument("deck", help="a deck file, a case file, or the name of a shipped one")
    add_envelope_options(envelope, required=True)


def add_envelope_options(parser: argparse.ArgumentParser, required: bool) -> None:
    """Add to a parser which trains, speeds, places and quantities an envelope is of."""
    parser.add_argument(
        "--trains", required=required, metavar="A,B",
        help="names (railbridge list trains; HSLM-A means all ten) or .csv files",
    )  # fmt: skip
    parser.add_argument(
        "--speeds", required=required, metavar="RANGE",
        help="150:300km/h: chosen, finer beside each peak; 150:300:2.5km/h: in steps, the last "
        "speed is always in; or single values, 150,200km/h; m/s without a unit",
    )  # fmt: skip
    parser.add_argument(
        "--points", metavar="X,X", help="places along the deck, m; default mid-length"
    )
    parser.add_argument(
        "--measure", metavar="A,B", default=",".join(studies.QUANTITIES),
        help="quantities (default %(default)s)",
    )  # fmt: skip


def _sweep(given: argparse.Namespace) -> int:
    plan, _ = study_plan(given.study)
    return _carry_out(given, plan, Asking("sweep", Path(given.study).stem))


def study_plan(study: str) -> tuple[sweeping.Plan, dict[str, Any]]:
    """Return the plan of a study file, and what the file says, its paths as they can be opened."""
    path = Path(study)
    if path.suffix != ".toml":
        raise InputError("study", study, "must end in .toml")
    found = shelf.read_toml(path, STUDY)
    with errors.within(source=path.name):
        errors.keys("", found, STUDY, ["case"])
        source = found["case"]
        if isinstance(source, str) and shelf.is_path(source):
            source = (path.parent / source).absolute()
        measure = found.get("measure", sweeping.MEASURE)
        trains = _beside(found.get("trains"), path.parent)
        plan = sweeping.planned(source, found.get("over", {}), trains, measure, found.get("points"))
    return plan, found | {"trains": trains} if trains else found


def _beside(trains: Any, folder: Path) -> Any:
    """Make files of trains, relative to the study, paths that can be opened from here."""
    if isinstance(trains, str):
        trains = [trains]
    if isinstance(trains, list) and not any(isinstance(t, dict) for t in trains):
        return trains_of_case([_found(t, folder) if _is_file(t) else t for t in trains])
    if isinstance(trains, dict):
        return {name: _beside_table(train, folder) for name, train in trains.items()}
    return trains


def _beside_table(train: Any, folder: Path) -> Any:
    if isinstance(train, dict) and isinstance(train.get("file"), str):
        return {**train, "file": _found(train["file"], folder)}
    return train


def _found(file: str, folder: Path) -> str:
    # Whole, since a case looks for files beside itself.
    path = (folder / file).absolute()
    if not path.is_file():
        raise InputError("trains", file, "no such file")
    return str(path)


def _is_file(train: Any) -> bool:
    return isinstance(train, str) and train.endswith(".csv")


def _envelope(given: argparse.Namespace) -> int:
    return _carry_out(given, *envelope_plan(given))


def envelope_plan(
    given: argparse.Namespace, own: Case | None = None
) -> tuple[sweeping.Plan, Asking]:
    """Return the plan of trains over speeds, and what was asked for.

    Parameters
    ----------
    given : Namespace
        With deck, trains, speeds, points and measure; see `add_envelope_options`.
    own : Case, optional
        Instead of that of ``given.deck``: trains that are left out are its own one.
    """
    ends = written_ends("--speeds", given.speeds, "speed")
    speeds = np.array(ends) if ends else written_range("--speeds", given.speeds, "speed")
    with errors.within(names={"speeds": "--speeds"}):
        studies.checked_speeds(speeds)
    points = None
    if given.points is not None:
        points = written_range("--points", given.points, "length")
    if given.trains is None and own is not None:
        trains = {_name_of(own): own.content["train"]}
    else:
        trains = _trains_of(given.trains)
    measure = [name.strip() for name in given.measure.split(",")]
    first = next(iter(trains.values()))
    source = _case_of(given.deck, first, float(speeds[0])) if own is None else own
    names = {
        "over[run.speed]": "--speeds", "points": "--points", "measure": "--measure",
        "quantities": "--measure", "speeds": "--speeds",
    }  # fmt: skip
    unit = unit_of(given.speeds)
    with errors.within(names=names):
        between = studies.Between(*ends) if ends else None
        plan = sweeping.planned(source, {"run.speed": speeds.tolist()}, trains, measure, points)
        if between:
            if plan.asked.more or not plan.asked.outputs:
                allowed = "speeds are chosen by quantities at places, and paths are none"
                remedy = "Give the speeds a step, or measure displacement_z and the like"
                raise InputError("--measure", given.measure, allowed, remedy)
            # Those that are computed in any case; which follow is seen on the way.
            over = {"run.speed": plan.starting_speeds(between).tolist()}
            plan = sweeping.planned(source, over, trains, measure, points)
    return plan, Asking("envelope", plan.deck.name, between, unit)


def _trains_of(text: str | None) -> dict[str, dict[str, Any]]:
    """Return the tables of trains that are named on the command line."""
    listed = [name.strip() for name in (text or "").split(",") if name.strip()]
    if not listed:
        raise InputError("--trains", text, "must name at least one train")
    return trains_of_case([_listed(name) for name in listed])


def _name_of(own: Case) -> str:
    """Return what the train of a case is called."""
    kinds = own.train.kinds()
    if kinds:
        return " + ".join(f"{len(cars)} x {vehicle.name}" for vehicle, cars in kinds)
    return getattr(own.train, "name", None) or "train of the case"


def _listed(name: str) -> str:
    """Return a train of the command line, a file as its whole path; refuse one there is not."""
    if _is_file(name):
        return _found(name, Path())
    if name == "HSLM-B":
        allowed = "needs its n and d, and there is no option for them"
        remedy = 'Write trains = { b = { name = "HSLM-B", n = 10, d = 3.5 } } into a study file'
        raise InputError("--trains", name, allowed, f"{remedy}, for railbridge sweep")
    known = ["HSLM-A", *(t.name for t in train_list() if t.name != "HSLM-B")]
    if name not in known:
        near = errors.did_you_mean(name, known) + " " if len(name) > 1 else ""
        remedy = f"{near}Give HSLM-A (all ten), a name of railbridge list trains, or a .csv file"
        raise InputError("--trains", name, "no such train", remedy)
    return name


def _case_of(name: str, train: dict[str, Any], speed: float) -> Any:
    """Return a case of a deck file, or the case that a file is."""
    own = {"train": train, "run": {"speed": speed}}
    try:
        path = shelf.data_file("decks", name, ".toml")
    except InputError as no_deck:
        try:
            path = shelf.data_file("cases", name, ".toml")
        except InputError:
            raise no_deck from None
        return sweeping.case(path)
    if {"deck", "run"} <= shelf.read_toml(path).keys():
        return sweeping.case(path)
    return {"deck": {"file": str(path.absolute()) if shelf.is_path(name) else name}, **own}


@dataclass(frozen=True)
class Asking:
    """What a command was asked for, besides the plan.

    Attributes
    ----------
    name : {"sweep", "envelope"}
        Of the command and its files.
    title : str
        Said of the results.
    between : Between, optional
        Where speeds are chosen.
    speed_unit : str
        In which speeds are said; m/s if empty.
    """

    name: str
    title: str
    between: studies.Between | None = None
    speed_unit: str = ""


def _carry_out(given: argparse.Namespace, plan: sweeping.Plan, asking: Asking) -> int:
    errors.integer("--workers", given.workers, least=1, most=256)
    if given.chunk is not None:
        errors.integer("--chunk", given.chunk, least=1, most=100_000)
    errors.number("--hours", given.hours, above=0.0)
    studies.needed("xarray", "zarr", "netCDF4", "tqdm")
    if given.cluster:
        studies.needed("distributed")
    refuse_large(plan, asking)
    say_remarks(plan, asking)
    if given.dry_run and not (Path(given.out) / sweeping.STORE).exists():
        return _with_store(given, plan, asking, studies.MemoryStore())
    with staging.growing(given.out, "--out") as folder:
        return _with_store(given, plan, asking, plan.store(folder))


def refuse_large(plan: sweeping.Plan, asking: Asking) -> None:
    """Refuse a study whose results do not fit into memory."""
    memory = _bytes(plan)
    if memory > MEMORY_LIMIT:
        allowed = f"the results would need {memory / 1e9:.3g} GB of memory"
        remedy = "Use fewer points or quantities, or several studies"
        raise InputError(asking.name, len(plan.points), allowed, remedy)


def say_remarks(plan: sweeping.Plan, asking: Asking) -> None:
    """Print what is unlikely to be meant, and what cannot be found, before work starts."""
    speeds = {"run.speed": "--speeds"} if asking.name == "envelope" else {}
    for doubt in plan.doubts:
        say(f"warning: {speeds.get(doubt.field, doubt.field)} {doubt.text}")
    trains = plan.trains or {"the train": plan.like.train}
    bare = [name for name, train in trains.items() if isinstance(train, AxleTrain)]
    if _UNLOADS in plan.asked.numbers and bare:
        say(
            f"warning: {_UNLOADS} is 0 for {errors.counted(bare, 4)}: bare axle loads do not "
            "unload. Use a train of cars"
        )


def _with_store(given: argparse.Namespace, plan: sweeping.Plan, asking: Asking, store: Any) -> int:
    left = studies.remaining(plan.points, store)
    varied = " x ".join(f"{len(d.values)} {d.name}" for d in plan.dimensions)
    total, known = len(plan.points), _known(plan, store)
    try:
        seconds = _estimate(plan, left, store, given.dry_run)
        seconds /= 1 if given.cluster else given.workers
        least = "at least " * (asking.between is not None)
        said = f"{least}{total} crossings ({varied})" + f", {known} known already" * bool(known)
        said += ", and several times as many beside peaks" * bool(least)
        said += f"; {_bytes(plan) / 1e9:.2g} GB, {least or 'about '}{_spoken(seconds)}"
        if given.dry_run or not given.quiet:
            tell(said)
        if seconds > 3600 * given.hours:
            remedy = f"Use fewer points, more workers, or --hours {np.ceil(seconds / 3600):g}"
            raise InputError(
                "--hours",
                given.hours,
                f"it would take {least or 'about '}{_spoken(seconds)}",
                remedy,
            )
        if given.dry_run:
            return 0
        if not known and (Path(given.out) / f"{asking.name}.nc").exists():
            say(
                f"warning: {given.out} holds the results of other crossings; its {asking.name}.nc "
                f"and {asking.name}.csv will be replaced"
            )
        found = _computed(given, plan, store, asking.between)
    except (KeyboardInterrupt, staging.Stopped) as stop:
        done = _known(plan, store)
        kept = f"{done} of {total} crossings are kept in {given.out}; the same command goes on"
        say(f"stopped: {kept}")
        return 130 if isinstance(stop, KeyboardInterrupt) else 128 + stop.number
    except studies.WorkerDiedError as error:
        say(f"{error}. {_known(plan, store)} of {total} crossings are kept in {given.out}")
        return 1
    _write(found, given.out, asking.name)
    failed = [text for text in found.message.values.ravel().tolist() if text]
    if not given.quiet:
        outputs = list(dict.fromkeys(output.quantity for output in plan.asked.outputs))
        names = [*outputs, *plan.asked.numbers, *plan.asked.more]
        for line in findings.largest(found, names, asking.speed_unit):
            tell(f"{asking.title}: {line}")
        for line in findings.at_the_ends(found, outputs, asking.speed_unit):
            tell(line)
        tell(f"written to {given.out}/{asking.name}.nc and {asking.name}.csv")
    if failed:
        tell(
            f"{len(failed)} of {found.message.size} crossings have no numbers: {failed[0]} "
            "(see 'message')"
        )
    return FAILED if failed else 0


def _known(plan: sweeping.Plan, store: Any) -> int:
    """Return how many crossings have been computed; those that were refused are none."""
    return sum(not point.refusal and point.key in store for point in plan.points)


def _bytes(plan: sweeping.Plan) -> float:
    """Return about how much memory the results need, bytes, besides the program."""
    return 8.0 * len(plan.columns) * len(plan.points) * 6 + 2e8


def _estimate(plan: sweeping.Plan, left: list[studies.Point], store: Any, dry_run: bool) -> float:
    """Return about how long the rest takes, s, from two of its points or its first chunk."""
    if not left:
        return 0.0
    if plan.chunk == studies.CHUNK:
        chosen = [left[0], left[len(left) // 2]][: min(SAMPLED, len(left))]
    else:  # computed together: a few would take as long, and make other chunks of the rest
        chosen = studies.chunked(left, plan.chunk)[0]
    start = time.perf_counter()
    rows = plan.task([point.task for point in chosen])
    each = (time.perf_counter() - start) / len(chosen)
    if not dry_run:
        store.add([point.key for point in chosen], rows)
    return each * len(left)


def _computed(
    given: argparse.Namespace, plan: sweeping.Plan, store: Any, between: studies.Between | None
) -> xr.Dataset:
    client = None
    if given.cluster:
        from distributed import Client

        try:
            # No default: one that cannot be reached would stand in the way of whatever asks for it.
            client = Client(given.cluster, timeout=10, set_as_default=False)
        except (OSError, ValueError) as error:
            allowed = f"no scheduler answers there ({error})"
            raise InputError("--cluster", given.cluster, allowed) from None
    try:
        with crossings_told(given.quiet) as progress:
            options = {"chunk": given.chunk, "workers": given.workers, "client": client}
            if between:
                return plan.chosen(store, between, progress=progress, **options)
            return plan.carried_out(store, progress=progress, **options)
    finally:
        if client is not None:
            client.close()


@contextmanager
def crossings_told(quiet: bool) -> Iterator[Callable[[int, int], None] | None]:
    """Tell how far it is and how long it takes: a bar in a terminal, else a line in ten seconds."""
    if quiet:
        yield None
    elif sys.stderr.isatty():
        from tqdm import tqdm

        with tqdm(total=0, unit="crossing", leave=False) as bar:

            def show(done: int, of: int) -> None:
                if not bar.total:
                    bar.initial = done  # found in the folder: says nothing about the time
                bar.total, bar.n = of, done
                bar.refresh()

            yield show
    else:
        start = last = time.monotonic()
        first: int | None = None

        def line(done: int, of: int) -> None:
            nonlocal first, last
            first, now = done if first is None else first, time.monotonic()
            if now - last >= 10.0 and done > first:
                last = now
                rest = (now - start) / (done - first) * (of - done)
                say(f"{done} of {of} crossings, {_spoken(rest)} left")

        yield line


def _write(found: xr.Dataset, out: str, name: str) -> None:
    folder = Path(out)
    parts = [folder / f".{name}.nc", folder / f".{name}.csv"]
    found.to_netcdf(parts[0])
    findings.spreadsheet(found).to_csv(parts[1], index=False, float_format="%.9g")
    with staging.undisturbed():
        for part in parts:
            part.replace(folder / part.name[1:])


def _spoken(seconds: float) -> str:
    if seconds < 90:
        return f"{max(seconds, 1):.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
