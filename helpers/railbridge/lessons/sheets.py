"""Sheets to print, from the tables of the teacher's page, without the key.

The guess sheet, and the marking numbers in two versions for neighbours. A sheet is one HTML file
that any browser prints.
"""

from __future__ import annotations

import html
import re

from ..errors import InputError

__all__ = ["sheets"]

PAGE = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>{title}</title>
<style>
@page {{ size: A4; margin: 18mm; }}
body {{ font: 11pt/1.35 sans-serif; max-width: 180mm; margin: auto; }}
body {{ color: #000; background: #fff; }}
table {{ border-collapse: collapse; width: 100%; }}
th, td {{ border: 1px solid #555; padding: 2mm; text-align: left; vertical-align: top; }}
td.answer {{ width: 38%; height: 16mm; }}
tr {{ break-inside: avoid; }}
</style>
<h1>{title}</h1>
<p>Name: ______________________________ &nbsp; Date: ______________</p>
<p>{before}</p>
<table>
<tr>{heads}</tr>
{rows}
</table>
</html>
"""
GUESSES = "Write each guess before you run the cell. Wrong guesses count; empty fields do not."
NUMBERS = "Every answer with its unit. Say in a word or two how you got it."


def sheets(teaching: str) -> dict[str, str]:
    """Return the sheets as HTML by file name.

    Parameters
    ----------
    teaching : str
        The teacher's page, Markdown.

    Raises
    ------
    InputError
        One of the two tables is missing.
    """
    guesses = _table(teaching, r"\| (G\d+) \| ([^|]+) \| ([^|]+) \|")
    made = {
        "guess_sheet.html": _sheet(
            "Guess sheet", GUESSES, ("", "before", "question", "my guess, and why"), guesses
        )
    }
    for version in "AB":
        rows = _table(teaching, rf"\| (M\d+) {version} \| ([^|]+) \| ([^|]+) \|")
        heads = ("", "notebook", "question", "my answer")
        made[f"numbers_{version}.html"] = _sheet(
            f"Numbers, version {version}", NUMBERS, heads, rows
        )
    return made


def _table(text: str, row: str) -> list[tuple[str, ...]]:
    found = re.findall(rf"^{row}", text, re.MULTILINE)
    if not found:
        raise InputError("docs/teaching.md", None, "has no table of guesses or marking numbers")
    return found


def _sheet(title: str, before: str, heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = [
        "<tr>"
        + "".join(f"<td>{_inline(cell)}</td>" for cell in row)
        + '<td class="answer"></td></tr>'
        for row in rows
    ]
    columns = "".join(f"<th>{head}</th>" for head in heads)
    return PAGE.format(title=title, before=before, heads=columns, rows="\n".join(lines))


def _inline(markdown: str) -> str:
    """Return a cell of a table as HTML: code and links are all that stands in them."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", html.escape(markdown.strip(), quote=False))
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", text)
