"""What is written from the types of tables: the JSON Schema, the starter and tables of pages."""

from __future__ import annotations

import re
import textwrap
from itertools import zip_longest
from typing import Any

from pydantic_core import PydanticUndefined

from .. import irregularities
from ..cautions import bounds
from ..units import UNITS
from . import tables, unitpages
from .tabletypes import Table

__all__ = [
    "rows", "schema", "spectrum_rows", "starter", "study_starter", "unit_rows", "with_tables",
]  # fmt: skip


def schema() -> dict[str, Any]:
    """Return the JSON Schema of case files, for editors that complete and check them."""
    found = _tidy(tables.CASE.model_json_schema(by_alias=True))
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **found}


def _tidy(value: Any, properties: bool = False) -> Any:
    """Leave out titles and null defaults, which TOML does not know."""
    if isinstance(value, list):
        return [_tidy(part) for part in value]
    if not isinstance(value, dict):
        return value
    return {
        k: _tidy(v, k in ("properties", "$defs") and not properties)
        for k, v in value.items()
        if properties
        or not (k == "title" or (k == "default" and v is None) or k == "discriminator")
    }


# ---- tables of pages


def rows(table: type[Table]) -> list[str]:
    """Return the lines of a Markdown table: keys and their meaning, needed ones first marked."""
    lines = ["| key | meaning |", "|---|---|"]
    for name, f in table.model_fields.items():
        if name in ("name", "source", "note") and not f.is_required():
            continue
        said = (f.description or "").replace("|", "\\|")
        if f.is_required():
            said += " **Needed.**"
        elif f.default not in (None, PydanticUndefined) and "efault" not in said:
            said += f" Default {_toml(f.default)}."
        lines.append(f"| `{f.alias or name}` | {said} |")
    return lines


def unit_rows() -> list[str]:
    """Return the lines of a Markdown table of all units."""
    lines = ["| what | units |", "|---|---|"]
    for dimension, family in UNITS.items():
        names = ", ".join(f"`{unit}`" if unit else "nothing" for unit in family)
        lines.append(f"| {dimension} | {names} |")
    return lines


def spectrum_rows() -> list[str]:
    """Return the lines of a Markdown table of the shipped spectra of track irregularities."""
    lines = ["| name | family | component | density | grade | band, m | sigma(D1) |"]
    lines.append("|---|---|---|---|---|---|---|")
    for name in irregularities.spectrum_names():
        spectrum = irregularities.spectrum(name)
        band = "{:g} to {:g}".format(*spectrum.band)
        band += "" if spectrum.band_source.startswith("printed") else " (ours)"
        first = [f"`{name}`", spectrum.family]
        for component, row in spectrum.to_frame().iterrows():
            sigma = f"{row['sigma D1']:.4g} {row['sigma unit']}"
            cells = [*first, component, row["unit"], row["grade"], band, sigma]
            lines.append(f"| {' | '.join(cells)} |")
            first, band = ["", ""], ""
    return lines


_MARKED = re.compile(r"(<!-- table: ([\w. ]+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def with_tables(page: str) -> str:
    """Return a page with its marked tables written anew.

    A table stands between ``<!-- table: NAME -->`` and ``<!-- end -->``; NAME is one of `TABLES`,
    ``units``, ``spectra``, ``doubts`` for what is doubted, or one of `unitpages.TABLES`.
    """
    special = {"units": unit_rows, "doubts": bounds.table, "spectra": spectrum_rows}
    special |= unitpages.TABLES

    def written(found: re.Match) -> str:
        name = found[2]
        lines = special[name]() if name in special else rows(tables.TABLES[name])
        return f"{found[1]}{chr(10).join(lines)}\n{found[4]}"

    return _MARKED.sub(written, page)


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    return f"`{value!r}`".replace("'", '"')


# ---- the starter

_HEAD = """\
# A railbridge case: one train crosses one deck at one speed. All numbers are SI: m, kg, s, N.
#
#   railbridge run {name} --out results
#
# Lines that start with # are choices left out; take the mark away to use them. For an editor that
# completes this file: railbridge schema > case.schema.json, and as the first line of this file
#:schema ./case.schema.json
"""
_WAVE = '{ kind = "harmonic", amplitude = 1e-3, wavelength = 10.0 }'
_EXAMPLES: dict[str, tuple[type[Table], dict[str, str]]] = {
    "deck": (
        tables.BEAM,
        {
            "length": "20.0",
            "bending_stiffness_vertical": "2.0e10",
            "mass": "9000.0",
            "# bending_stiffness_lateral": "1.5e11",
            "# torsional_stiffness": "3.0e10",
            "# polar_inertia": "50e3",
            "damping": "{ modal = 0.01 }",
            "modes": "4",
            "# tracks": "{ left = 2.0, right = -2.0 }",
        },
    ),
    "train": (
        tables.OF_ONE_KIND,
        {"vehicle": '"xia2000"', "cars": "2", "# car_spacing": "22.5", "# track": "0.0"},
    ),
    "# train": (
        tables.BARE,
        {"# axles": "[0.0, 3.0, 11.0, 14.0]", "# loads": "[200e3, 200e3, 200e3, 200e3]"},
    ),
    "track": (tables.TRACK, {"vertical": _WAVE, "# lateral": _WAVE}),
    "run": (
        tables.RUN,
        {
            "speed": "40.0",
            "# time_step": "1e-3",
            "# loads": '"wheels"',
            "# interaction": '"iterate"',
            "# tolerance": "1e-8",
            "# max_iterations": "50",
            "# relaxation": "0.5",
            "# lead_in": "300.0",
            "# tail": "1.0",
        },
    ),
    "output": (tables.OUTPUT, {"points": "[10.0]"}),
}
_NOTES = {
    "deck": '# A deck of your own. Or: file = "viaduct36" for a shipped deck (railbridge list '
    "decks),\n"
    '# or file = "my_deck.toml" for a file beside this one.',
    "train": "# One vehicle several times. Or a mixed train, front to back, without vehicle:\n"
    '#   cars = ["power", { vehicle = "coach", count = 6 }, "power"]',
    "# train": '# Or bare axle loads: name = "HSLM-A1", or file = "my_train.csv" beside this\n'
    "# one, or all of them here:",
    "track": "# Leave [track] out for perfect rails. A list adds irregularities up; rails that "
    "differ:\n"
    '# { left = { ... }, right = { ... } }; measured: { kind = "table", x = [ ... ], r = [ ... '
    "] };\n"
    '# drawn from a spectrum: { kind = "random", spectrum = "german-low", seed = 1 }.',
}


_COMMENTS = 40
"""Column of the comments, where the line leaves room."""


def _commented(line: str, said: str) -> list[str]:
    """Return a line with the first sentences of a meaning beside it."""
    sentences = re.split(r"(?<=[.]) (?=[A-Z0-9])", said.replace("`", ""))
    column = max(_COMMENTS, len(line) + 2)
    if column > 60:
        return [line]
    words = textwrap.wrap(" ".join(sentences[:2]), max(98 - column, 30))
    return [
        f"{start:<{column}}# {part}" for start, part in zip_longest([line], words, fillvalue="")
    ]


def starter(name: str) -> str:
    """Return a commented case file that runs as it is.

    Parameters
    ----------
    name : str
        Of the file.
    """
    lines = [_HEAD.format(name=name)]
    for title, (table, examples) in _EXAMPLES.items():
        if title.startswith("#"):
            lines.pop()  # no blank line before another way to say the same
        else:
            lines.append(f"[{title}]")
        lines += [_NOTES[title]] if title in _NOTES else []
        for shown, value in examples.items():
            said = table.model_fields[shown.removeprefix("# ")].description
            lines += _commented(f"{shown} = {value}", said)
        lines.append("")
    return "\n".join(lines[:-1]) + "\n"


_STUDY = """\
# A railbridge study: one case over values of its keys, all combinations. All numbers are SI.
#
#   railbridge sweep {name} --out my-study --dry-run     how many, how long, how large
#   railbridge sweep {name} --out my-study

case = "paper"               # a shipped case, or a case file beside this one
measure = ["displacement_z", "acceleration_z", "wheel_unloading"]
points = [18.0]              # m along the deck
# trains = ["HSLM-A1", "my_train.csv"]     # instead of the case's own train; HSLM-A is all ten

[over]                       # keys of the case, as in docs/case.md
"run.speed" = { from = 10.0, to = 80.0, step = 5.0 }      # m/s, both ends; or count = 15
"track.vertical.wavelength" = [7.2, 10.0, 14.4, 20.0]     # m
"""


def study_starter(name: str) -> str:
    """Return a commented study file that runs as it is, for a file of this name."""
    return _STUDY.replace("{name}", name)
