"""Write the tables of docs/case.md that come from the types of case files; `--check` only says
whether they are right."""

import sys
from pathlib import Path

from railbridge.cases import pages

PAGE = Path(__file__).resolve().parents[1] / "docs" / "case.md"


def main(arguments):
    text = PAGE.read_text(encoding="utf-8")
    written = pages.with_tables(text)
    if arguments == ["--check"]:
        sys.exit(f"{PAGE.name} is not up to date: run `make pages`" if written != text else 0)
    if arguments:
        sys.exit(__doc__)
    PAGE.write_text(written, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
