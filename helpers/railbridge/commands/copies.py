"""The notebooks as copies of one's own.

What belongs to them, what may be renewed and what was edited and is left alone.

A copy is *edited* when its bytes differ from what was copied, which a small file in the folder
(`MANIFEST`) records. JupyterLab writes outputs into a notebook, so a copy that was run and saved
counts as edited too: nothing a student did is ever lost.
"""

from __future__ import annotations

import hashlib
import json
import posixpath
import re
from dataclasses import dataclass
from pathlib import Path

from ..cases import shelf
from ..errors import InputError
from ..exchange.reading import read_text
from ..lessons import sheets
from ..lessons.editions import EDITIONS

__all__ = ["MANIFEST", "Copy", "contents", "place", "plan", "stage"]

MANIFEST = ".railbridge-copies.json"
PAGES = (
    "README.md",
    "LICENSE-notebooks.md",
    "docs/case.md",
    "docs/codes.md",
    "docs/exchange.md",
    "docs/report.md",
    "docs/spectra.md",
    "docs/studies.md",
    "docs/symbols.md",
    "docs/units.md",
    "docs/crossing.png",
    "docs/speed_wavelength.png",
)
"""What the notebooks lead to, besides each other and the data files."""
TEACHING = "docs/teaching.md"
"""What a teacher gets besides, with the sheets to print that are made of it."""


@dataclass(frozen=True)
class Copy:
    """What happens to one file.

    Attributes
    ----------
    name : str
        Place in the folder, with ``/``.
    action : {"copied", "updated", "unchanged", "kept", "replaced"}
        New; renewed, since it was not edited; the same as the suite's; edited and left alone;
        edited and replaced, see `backup`.
    content : bytes
        The suite's file.
    backup : str
        Where the edited copy is kept if it was replaced.
    """

    name: str
    action: str
    content: bytes
    backup: str = ""


def suite_root() -> Path:
    """Return the folder that holds ``notebooks`` and the pages.

    Inside an installed wheel, or the checkout.
    """
    packaged = Path(__file__).parents[1] / "share"
    return packaged if packaged.is_dir() else Path(__file__).parents[3]


def contents(edition: str = "reader") -> dict[str, bytes]:
    """Return every file that is copied, by its place in the folder.

    Notebooks on top, then what they lead to; a teacher's also with the teacher's page and its
    sheets.

    Links between them are made to fit the new places; links to what is not copied become plain
    text.

    Parameters
    ----------
    edition : {"reader", "student", "teacher"}
        See `lessons.editions`.
    """
    root, data = suite_root(), shelf.data_root()
    sources = {path.name: path for path in sorted((root / "notebooks").glob("[0-9][0-9]_*.ipynb"))}
    if not sources:
        raise InputError(
            "notebooks", None, "are missing from this installation", "Install the suite again"
        )
    pages = (*PAGES, TEACHING) if edition == "teacher" else PAGES
    sources |= {page: root / page for page in pages}
    sources |= {
        f"data/{p.relative_to(data).as_posix()}": p
        for p in sorted(data.rglob("*.*"))
        if p.is_file()
    }
    made = {
        name: _fitted(name, path.read_bytes(), set(sources), edition)
        for name, path in sources.items()
    }
    if edition == "teacher":
        printed = sheets.sheets((root / TEACHING).read_text(encoding="utf-8"))
        made |= {f"sheets/{name}": text.encode("utf-8") for name, text in printed.items()}
    return made


def _fitted(name: str, content: bytes, known: set[str], edition: str) -> bytes:
    if name.endswith(".ipynb"):
        notebook = EDITIONS[edition](json.loads(content))
        for cell in notebook["cells"]:
            if cell["cell_type"] == "markdown":
                text = _with_links(f"notebooks/{name}", "".join(cell["source"]), name, known)
                cell["source"] = text.splitlines(keepends=True)
        return _as_file(notebook)
    if name.endswith(".md"):
        return _with_links(name, content.decode("utf-8"), name, known).encode("utf-8")
    return content


def _with_links(was: str, text: str, now: str, known: set[str]) -> str:
    """Mend the relative links of a page that moves from the suite into the folder."""

    def mended(found: re.Match) -> str:
        label, target, anchor = found.groups(default="")
        place = posixpath.normpath(posixpath.join(posixpath.dirname(was), target)).removeprefix(
            "notebooks/"
        )
        if place not in known:
            return label.removeprefix("!")[1:-1]
        return f"{label}({posixpath.relpath(place, posixpath.dirname(now) or '.')}{anchor})"

    return re.sub(r"(!?\[[^][]*\])\((?!\w+:)([^()#\s]+)(#[^()\s]*)?\)", mended, text)


def plan(folder: Path, force: bool = False, edition: str = "reader") -> list[Copy]:
    """Say what copying would do to each file of the folder; nothing is written.

    Raises
    ------
    InputError
        The folder belongs to the suite itself, or a folder stands where a file should go, or a file
        where a folder should.
    """
    _refuse_own(folder)
    known = _recorded(folder)
    result = []
    for name, content in contents(edition).items():
        target = folder / name
        if target.is_dir():
            raise InputError(
                "DIR",
                str(target),
                "is a folder where a file of the suite goes",
                "Move it, or choose another DIR",
            )
        blocked = next(
            (
                p
                for p in target.parents
                if p.is_relative_to(folder) and p.exists() and not p.is_dir()
            ),
            None,
        )
        if blocked:
            raise InputError(
                "DIR",
                str(blocked),
                "is a file where a folder of the suite goes",
                "Move it, or choose another DIR",
            )
        if not target.exists():
            result.append(Copy(name, "copied", content))
            continue
        if not target.is_file():
            allowed = "stands where a file of the suite goes and is none"
            raise InputError("DIR", str(target), allowed, "Move it, or choose another DIR")
        now = _as_handed_out(name, target.read_bytes(), content)
        if now == content:
            result.append(Copy(name, "unchanged", content))
        elif _digest(now) == known.get(name):
            result.append(Copy(name, "updated", content))
        elif force:
            result.append(Copy(name, "replaced", content, _free_name(folder, name)))
        else:
            result.append(Copy(name, "kept", content))
    return result


def _as_handed_out(name: str, now: bytes, content: bytes) -> bytes:
    """Return a copy without what JupyterLab writes into a page that was only opened: its kernel."""
    if not name.endswith(".ipynb"):
        return now
    try:
        notebook = json.loads(now)
        notebook["metadata"] = json.loads(content)["metadata"]
        return _as_file(notebook)
    except (ValueError, TypeError, RecursionError):
        return now


def _as_file(notebook: dict) -> bytes:
    return (json.dumps(notebook, indent=1, ensure_ascii=False) + "\n").encode("utf-8")


def stage(copies: list[Copy], folder: Path, scratch: Path) -> None:
    """Write all that will be placed into a temporary folder.

    A full disk is then met before anything is replaced.
    """
    for copy in copies:
        if copy.action in ("copied", "updated", "replaced"):
            (scratch / copy.name).parent.mkdir(parents=True, exist_ok=True)
            (scratch / copy.name).write_bytes(copy.content)
        if copy.backup:
            (scratch / copy.backup).write_bytes((folder / copy.name).read_bytes())
    digests = _recorded(folder) | {c.name: _digest(c.content) for c in copies if c.action != "kept"}
    (scratch / MANIFEST).write_text(
        json.dumps(dict(sorted(digests.items())), indent=1) + "\n", encoding="utf-8"
    )


def place(copies: list[Copy], folder: Path, scratch: Path) -> None:
    """Move what was staged into the folder, each file whole.

    Edited copies to their new names first, the record last.
    """
    names = [c.backup for c in copies if c.backup] + [
        c.name for c in copies if (scratch / c.name).exists()
    ]
    for name in [*names, MANIFEST]:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (scratch / name).replace(folder / name)


def _refuse_own(folder: Path) -> None:
    there, root = folder.resolve(), suite_root().resolve()
    own = [root / part for part in ("notebooks", "data", "docs", "helpers", "tests")] + [
        Path(__file__).resolve().parents[1]
    ]
    if there == root or any(there.is_relative_to(part) for part in own):
        raise InputError(
            "DIR", str(folder), "belongs to the suite itself", "Choose a folder of your own"
        )


def _recorded(folder: Path) -> dict[str, str]:
    """Digest of every copy as made; without a readable record every copy counts as edited."""
    try:
        record = json.loads(read_text(folder / MANIFEST))
    except (OSError, ValueError):
        return {}
    return (
        {k: v for k, v in record.items() if isinstance(v, str)} if isinstance(record, dict) else {}
    )


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _free_name(folder: Path, name: str) -> str:
    """Return a name beside a copy that nothing bears yet: ``03_x.edited-1.ipynb``."""
    stem, dot, suffix = name.rpartition(".")
    number = 1
    while (folder / f"{stem}.edited-{number}{dot}{suffix}").exists():
        number += 1
    return f"{stem}.edited-{number}{dot}{suffix}"
