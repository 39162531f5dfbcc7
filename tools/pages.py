"""Write the tables of docs/case.md and docs/spectra.md, which come from types and data; `--check`
only says whether they are right."""

import sys
from pathlib import Path

from railbridge.cases import pages

DOCS = Path(__file__).resolve().parents[1] / "docs"
PAGES = (DOCS / "case.md", DOCS / "spectra.md")


def main(arguments):
    if arguments not in ([], ["--check"]):
        sys.exit(__doc__)
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        written = pages.with_tables(text)
        if not arguments:
            page.write_text(written, encoding="utf-8")
        elif written != text:
            sys.exit(f"{page.name} is not up to date: run `make pages`")


if __name__ == "__main__":
    main(sys.argv[1:])
