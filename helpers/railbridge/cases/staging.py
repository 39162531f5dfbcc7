"""Folders that are written as a whole: what is made appears together, or not at all.

Files are written into a temporary folder and moved when all is well. Whoever writes into a folder
holds a lock, so that a second one is told at its start. The system takes the lock back when a
program ends, however it ends: a lock that was left behind never stands in the way, and what its
holder left behind is cleared away by the next one.
"""

from __future__ import annotations

import hashlib
import os
import secrets
import shutil
import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError

try:
    import fcntl
except ImportError:  # Windows: nobody is told, but everybody has a temporary folder of their own
    fcntl = None

__all__ = [
    "Staged", "Stopped", "files", "folder", "growing", "new_file", "stopping", "undisturbed",
]  # fmt: skip

_PREFIX = ".railbridge-"
_REPLACED = "replaced"
_SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)


class Stopped(BaseException):
    """The system asked the program to end.

    Parameters
    ----------
    number : int
        Of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


@contextmanager
def stopping() -> Iterator[None]:
    """Raise `Stopped` where the program is asked to end, so that nothing half-made is left.

    Signals that whoever started the program has switched off (`nohup`) stay so.
    """

    def stop(number: int, _) -> None:
        signal.signal(number, signal.SIG_IGN)
        raise Stopped(number)

    with _handled([n for n in _SIGNALS[1:] if signal.getsignal(n) is signal.SIG_DFL], stop):
        yield


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let nothing stop what takes but a moment and must not be left half-done."""
    with _handled([n for n in _SIGNALS if signal.getsignal(n) is not None], lambda *_: None):
        yield


@contextmanager
def _handled(numbers: Sequence[int], handler) -> Iterator[None]:
    """Handle some signals otherwise for a while; only a program's main thread can."""
    before = {}
    with suppress(ValueError):
        for number in numbers:
            before[number] = signal.signal(number, handler)
    try:
        yield
    finally:
        for number, own in before.items():
            signal.signal(number, own)


@dataclass(frozen=True)
class Staged:
    """A temporary folder for what goes into another one.

    Attributes
    ----------
    scratch : Path
        Files are written here.
    folder : Path
        They go there.
    existed : bool
        Whether that one was there before.
    """

    scratch: Path
    folder: Path
    existed: bool

    def become(self) -> bool:
        """Make the temporary folder the one that was asked for; False if there is one by now."""
        try:
            self.scratch.replace(self.folder)
        except OSError:
            if not self.folder.is_dir():
                raise
            return False
        return True


@contextmanager
def files(out: str, field: str, names: Sequence[str]) -> Iterator[Path]:
    """Give a temporary folder whose files, of given names, become those of another folder.

    Files of these names that were there before are replaced, all of them or none.

    Parameters
    ----------
    out : str
        The folder; made if it is not there.
    field : str
        What the user calls it.
    names : sequence of str
        The last is the one by which others know that all are there.

    Raises
    ------
    InputError
        See `folder`.
    """
    with folder(out, field) as staged:
        for name in names:
            if (staged.folder / name).is_dir():
                allowed = f"holds a folder named {name}, which no file can replace"
                raise InputError(field, out, allowed, "Choose another folder")
        yield staged.scratch
        with undisturbed():
            if staged.existed:
                _exchange(staged, names)
            elif not staged.become():
                # Somebody else made it while this one was computing.
                with _held(staged.folder, field, out):
                    _exchange(staged, names)


def new_file(path: Path, text: str) -> None:
    """Write a file that must not exist yet; whole, or it does not exist afterwards either.

    Parameters
    ----------
    path : Path
    text : str

    Raises
    ------
    OSError
        It cannot be written; `FileExistsError` where it is there.
    """
    with path.open("x", encoding="utf-8") as file:
        try:
            file.write(text)
            file.flush()
        except BaseException:
            path.unlink()
            raise


def _exchange(staged: Staged, names: Sequence[str]) -> None:
    """Move files to their places; those that stood there come back if one cannot be moved."""
    scratch, place, aside = staged.scratch, staged.folder, staged.scratch / _REPLACED
    aside.mkdir()
    moved: list[tuple[Path, Path]] = []

    def move(start: Path, end: Path) -> None:
        if os.path.lexists(start):
            start.replace(end)
            moved.append((start, end))

    try:
        for name in reversed(names):
            move(place / name, aside / name)
        for name in names:
            move(scratch / name, place / name)
    except BaseException:
        for start, end in reversed(moved):
            end.replace(start)
        raise


@contextmanager
def folder(out: str, field: str) -> Iterator[Staged]:
    """Give a temporary folder in or beside the one that is asked for.

    Nothing is left of it afterwards, nor of folders that were made on the way if all did not go
    well.

    Raises
    ------
    InputError
        The folder cannot be written to, or somebody else is writing into it; raised before anything
        is computed.
    """
    place, made, held = Path(out), [], None
    scratch = None
    try:
        try:
            if not out.strip():
                raise InputError(field, out, "must name a folder")
            existed = place.is_dir()
            if not existed and _is_there(place):
                raise InputError(field, out, "is a file, not a folder", "Choose another name")
            for parent in [p for p in reversed(place.absolute().parents) if not p.exists()]:
                parent.mkdir(exist_ok=True)
                made.append(parent)
            if existed:
                # Inside: it may be a file system of its own.
                held = _locked(place)
                scratch = place / (_PREFIX + ("here" if held is not None else _token()))
                _fresh(scratch)
            else:
                scratch, held = _beside(place)
        except BlockingIOError:
            raise _taken(field, out) from None
        except (OSError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            why = getattr(error, "strerror", None) or str(error)
            raise InputError(
                field, out, f"cannot be written to ({why})", "Choose another folder"
            ) from None
        yield Staged(scratch, place, existed)
        made.clear()
    finally:
        with undisturbed():
            if scratch is not None and _still_ours(scratch, held, existed):
                shutil.rmtree(scratch, ignore_errors=True)
            _remove(made)
            if held is not None:
                os.close(held)


def _is_there(place: Path) -> bool:
    """Whether something is there; raises `OSError` if nothing can ever be, by its name."""
    try:
        os.lstat(place)
    except FileNotFoundError:
        return False
    return True


def _still_ours(scratch: Path, held: int | None, existed: bool) -> bool:
    """Whether a temporary folder is the one that was locked: by now it may bear its final name."""
    if held is None or existed:
        return True
    with suppress(OSError):
        return os.path.samestat(os.fstat(held), os.lstat(scratch))
    return False


def _taken(field: str, out: str) -> InputError:
    remedy = "Wait until it has ended, or choose another folder"
    return InputError(field, out, "another railbridge is writing into this folder", remedy)


def _token() -> str:
    return secrets.token_hex(6)


def _beside(place: Path) -> tuple[Path, int | None]:
    """Make the temporary folder of one that is not there yet, and lock it where that can be done.

    All who want the same folder want the same temporary one.
    """
    parent = place.absolute().parent
    scratch = parent / (_PREFIX + hashlib.sha256(os.fsencode(place.name)).hexdigest()[:12])
    while fcntl is not None:
        scratch.mkdir(exist_ok=True)
        held = _locked(scratch)
        if held is None:
            break
        # Whoever held it before may just have renamed or removed it; then it is tried again.
        if _still_ours(scratch, held, False):
            if os.fstat(held).st_uid == os.geteuid():
                _clear(scratch)
                return scratch, held
            os.close(held)
            break
        os.close(held)
    scratch = parent / (_PREFIX + _token())
    scratch.mkdir()
    return scratch, None


def _fresh(scratch: Path) -> None:
    """Make an empty folder; whoever left one of this name behind has ended."""
    if os.path.lexists(scratch):
        shutil.rmtree(scratch)
    scratch.mkdir()


def _clear(scratch: Path) -> None:
    for entry in os.scandir(scratch):
        if entry.is_dir(follow_symlinks=False):
            shutil.rmtree(entry.path)
        else:
            os.unlink(entry.path)


def _locked(path: Path) -> int | None:
    """Lock a folder until the number that is returned is closed; None where there are no locks.

    Raises
    ------
    BlockingIOError
        Somebody else holds it.
    """
    if fcntl is None:
        return None
    handle = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(handle)
        raise
    except OSError:  # a file system without locks
        os.close(handle)
        return None
    return handle


@contextmanager
def growing(out: str, field: str) -> Iterator[Path]:
    """Give a folder that is written into bit by bit, made if it is not there, to nobody else.

    Raises
    ------
    InputError
        It cannot be made, is a file, or somebody else writes into it.
    """
    place = Path(out)
    try:
        place.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise InputError(field, out, "is a file, must be a folder") from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(field, out, f"cannot be made ({why})") from None
    with _held(place, field, out):
        yield place


@contextmanager
def _held(path: Path, field: str, out: str) -> Iterator[None]:
    try:
        held = _locked(path)
    except BlockingIOError:
        raise _taken(field, out) from None
    try:
        yield
    finally:
        if held is not None:
            os.close(held)


def _remove(made: list[Path]) -> None:
    """Remove empty folders again, the innermost first."""
    for parent in reversed(made):
        try:
            parent.rmdir()
        except OSError:
            return
