"""Write the tables of docs/case.md, docs/units.md, docs/spectra.md and docs/codes.md, which come
from types and data; `--check` only says whether they are right."""

import re
import sys
from pathlib import Path

from railbridge.cases import pages
from railbridge.codes import catalogue

DOCS = Path(__file__).resolve().parents[1] / "docs"
CLAUSES = re.compile(r"(<!-- table: clauses -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def with_clauses(text):
    """The page of clauses with its table written anew."""
    lines = "".join(f"{line}\n" for line in catalogue.table())
    return CLAUSES.sub(lambda found: found[1] + lines + found[3], text)


PAGES = {
    "case.md": pages.with_tables,
    "units.md": pages.with_tables,
    "spectra.md": pages.with_tables,
    "codes.md": with_clauses,
}


def main(arguments):
    if arguments not in ([], ["--check"]):
        sys.exit(__doc__)
    for name, rewrite in PAGES.items():
        text = (DOCS / name).read_text(encoding="utf-8")
        written = rewrite(text)
        if not arguments:
            (DOCS / name).write_text(written, encoding="utf-8")
        elif written != text:
            sys.exit(f"{name} is not up to date: run `make pages`")


if __name__ == "__main__":
    main(sys.argv[1:])
