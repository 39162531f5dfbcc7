"""A bridge of one simple span by the numbers that are at hand, as a case and as a case file."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np

from .. import errors
from ..codes import DAMPING, damping_lower_bound
from ..cutoffs import EN1990_LEAST
from ..damping import RATIO
from ..errors import InputError, Range, check_fields
from . import staging
from .definition import Case

__all__ = ["KINDS", "SimpleBridge"]

KINDS = tuple(DAMPING)
"""Kinds of bridge that have a lower bound of damping."""

_Span = Annotated[float, Range(least=2.0, most=200.0, unit="m", remedy="Of one span, in m")]
_Mass = Annotated[float, Range(least=100.0, most=1e5, unit="kg/m", remedy="12 t/m is 12000")]
_Speed = Annotated[float, Range(above=0.0, most=200.0, unit="m/s", remedy="160 km/h is 44.4")]
_Stiffness = Annotated[float, Range(above=0.0, most=1e14, unit="N m2", remedy="E I in N m2")]
_Modulus = Annotated[
    float, Range(least=1e9, most=4e11, unit="Pa", remedy="Steel has 210e9, concrete about 35e9")
]
_Moment = Annotated[float, Range(above=0.0, most=1e4, unit="m4", remedy="In m4, not cm4")]
_Frequency = Annotated[float, Range(least=0.1, most=100.0, unit="Hz")]
_Tracks = Annotated[int, Range(least=1, most=2, whole=True)]
_Spacing = Annotated[float, Range(above=0.0, most=20.0, unit="m")]
_Ratio = Annotated[
    float, Range(above=0.0, most=RATIO.most, remedy="Leave it out for the lower bound of the kind")
]
_Twist = Annotated[float, Range(above=0.0, unit="N m2")]
_Inertia = Annotated[float, Range(above=0.0, unit="kg m")]
_LEAST_MODES = 6
_SAYS_STIFFNESS = (("bending_stiffness",), ("youngs_modulus", "second_moment"), ("frequency",))
_REMEDY = "Give bending_stiffness, or youngs_modulus and second_moment, or frequency"


@dataclass(frozen=True, kw_only=True)
class SimpleBridge:
    """A bridge of one simple span, as one describes it on the telephone.

    The stiffness is given in one of three ways: E I, or E and I, or the first bending frequency.

    Attributes
    ----------
    span : float
        m.
    mass : float
        kg/m, with track and all that lies on the deck.
    kind : str
        One of `KINDS`; says the lower bound of damping.
    line_speed : float
        Largest speed of the line, m/s.
    bending_stiffness : float, optional
        E I in the vertical plane, N m2.
    youngs_modulus, second_moment : float, optional
        E, Pa, and I, m4.
    frequency : float, optional
        First bending frequency under the permanent load, Hz, measured or from elsewhere.
    damping : float, optional
        Ratio of every mode that was measured, a fraction; left out, the lower bound of the kind.
    track : {"ballasted", "direct fastening"}
    tracks : {1, 2}
        One in the middle, or two beside it, of which the train takes the left one.
    track_spacing : float
        m between the two.
    torsional_stiffness, polar_inertia : float, optional
        G J, N m2, and mass moment of inertia about the axis, kg m2 per metre; both or none. Left
        out, the deck is rigid in twist.
    name : str

    Raises
    ------
    InputError
        Naming the field, its range and the remedy.
    """

    span: _Span
    mass: _Mass
    kind: Literal[
        "steel", "composite", "prestressed concrete", "filler beam", "reinforced concrete"
    ]
    line_speed: _Speed
    bending_stiffness: _Stiffness | None = None
    youngs_modulus: _Modulus | None = None
    second_moment: _Moment | None = None
    frequency: _Frequency | None = None
    damping: _Ratio | None = None
    track: Literal["ballasted", "direct fastening"] = "ballasted"
    tracks: _Tracks = 1
    track_spacing: _Spacing = 4.0
    torsional_stiffness: _Twist | None = None
    polar_inertia: _Inertia | None = None
    name: str = "my bridge"

    def __post_init__(self) -> None:
        check_fields(self)
        errors.choice("kind", self.kind, KINDS)
        errors.text("name", self.name)
        if any("\ud800" <= letter <= "\udfff" for letter in self.name):
            raise InputError("name", ascii(self.name), "must be a text that files can hold")
        given = tuple(
            name for group in _SAYS_STIFFNESS for name in group if getattr(self, name) is not None
        )
        if given not in _SAYS_STIFFNESS:
            named = " and ".join(given) if given else None
            raise InputError("bending_stiffness", named, "must be said in one way", _REMEDY)
        if (self.torsional_stiffness is None) != (self.polar_inertia is None):
            missing = "polar_inertia" if self.polar_inertia is None else "torsional_stiffness"
            raise InputError(missing, None, "is missing", "Give both, or none of the two")

    # ---- what follows from them

    @property
    def stiffness(self) -> float:
        """E I, N m2; from the frequency f1 it is m (2 f1 L^2 / pi)^2."""
        if self.bending_stiffness is not None:
            return self.bending_stiffness
        if self.frequency is not None:
            return self.mass * (2.0 * self.frequency * self.span**2 / math.pi) ** 2
        return self.youngs_modulus * self.second_moment

    @property
    def first_frequency(self) -> float:
        """First bending frequency, Hz: pi / (2 L^2) sqrt(E I / m)."""
        return math.pi / (2.0 * self.span**2) * math.sqrt(self.stiffness / self.mass)

    @property
    def damping_ratio(self) -> float:
        """Of every mode, a fraction: what was measured, or else the lower bound of the kind."""
        if self.damping is not None:
            return self.damping
        return float(damping_lower_bound(self.kind, self.span))

    @property
    def modes(self) -> int:
        """How many modes the deck has: those that accelerations are asked of, and more.

        Of bending alone f_n = n^2 f1, and EN 1990 asks for those up to max(30 Hz, 1.5 f1, f3).
        """
        bending = max(_LEAST_MODES, math.ceil(math.sqrt(EN1990_LEAST / self.first_frequency)) + 1)
        return bending if self.torsional_stiffness is None else 2 * bending

    # ---- as a case

    def content(
        self, train: Mapping[str, Any] | None = None, speed: float | None = None
    ) -> dict[str, Any]:
        """Return the tables of a case.

        Parameters
        ----------
        train : mapping, optional
            The table ``train`` of the case; default the first train of HSLM-A.
        speed : float, optional
            m/s; default the line's.
        """
        deck: dict[str, Any] = {
            "name": self.name,
            "length": self.span,
            "bending_stiffness_vertical": self.stiffness,
            "mass": self.mass,
            "damping": {"modal": self.damping_ratio},
            "modes": self.modes,
        }
        if self.torsional_stiffness is not None:
            deck["torsional_stiffness"] = self.torsional_stiffness
            deck["polar_inertia"] = self.polar_inertia
        train = {"name": "HSLM-A1"} if train is None else train
        if not isinstance(train, Mapping):
            raise InputError("train", train, "must be a table of named values")
        train = dict(train)
        if self.tracks == 2:
            deck["tracks"] = {"left": self.track_spacing / 2, "right": -self.track_spacing / 2}
            train = {"track": "left"} | train
        checks: dict[str, Any] = {
            "line_speed": self.line_speed,
            "track": self.track,
            "kind": self.kind,
        }
        if self.damping is not None:
            checks["measured_damping"] = self.damping
        run = {"speed": self.line_speed if speed is None else speed}
        run["acceleration_modes"] = "en1990"
        return {"deck": deck, "train": train, "run": run, "checks": checks}

    def case(self, train: Mapping[str, Any] | None = None, speed: float | None = None) -> Case:
        """Return the case; parameters as of `content`.

        Raises
        ------
        InputError
        """
        return Case(self.content(train, speed))

    def write(
        self,
        path: str | Path,
        train: Mapping[str, Any] | None = None,
        speed: float | None = None,
    ) -> Path:
        """Write the case as a commented TOML file that `railbridge run` and `report` take.

        Parameters
        ----------
        path : str or Path
            Ends in ``.toml``. A file that is there is left alone.
        train, speed
            As of `content`.

        Returns
        -------
        Path

        Raises
        ------
        InputError
            A file that is there, a wrong name, or a case that cannot be run; nothing is written.
        """
        if not isinstance(path, (str, Path)) or "\0" in str(path):
            raise InputError("path", path, "must be the name of a file")
        path = Path(path)
        if path.suffix != ".toml":
            raise InputError("path", str(path), "must end in .toml")
        self.case(train, speed)  # which refuses what cannot be run
        try:
            staging.new_file(path, _toml(self, train, speed))
        except FileExistsError:
            remedy = "Choose another name, or delete the file first"
            raise InputError("path", str(path), "is there already", remedy) from None
        except OSError as error:
            allowed = f"cannot be written ({error.strerror or error})"
            raise InputError("path", str(path), allowed) from None
        return path


_MEANT = {
    "deck.length": "m",
    "deck.bending_stiffness_vertical": "E I, N m2",
    "deck.mass": "kg/m",
    "deck.damping": "of critical, every mode",
    "deck.modes": "the lowest that loads can excite",
    "deck.torsional_stiffness": "G J, N m2",
    "deck.polar_inertia": "kg m2 per m",
    "deck.tracks": "m left of the deck axis",
    "run.speed": "m/s",
    "run.acceleration_modes": "accelerations of the modes up to max(30 Hz, 1.5 f1, f3)",
    "checks.line_speed": "m/s",
    "checks.kind": "of bridge, for the lower bound of damping",
    "checks.track": "how it lies on the deck",
    "checks.measured_damping": "of critical, measured on the bridge",
}
"""Comments in the file."""


_LARGE = 1e7
"""From which on numbers are written with a power of ten."""


def _toml(bridge: SimpleBridge, train: Mapping[str, Any] | None, speed: float | None) -> str:
    """Return the case as TOML with comments; keys as in docs/case.md."""
    f1, kmh = bridge.first_frequency, 3.6 * bridge.line_speed
    lines = [
        "# A bridge of one span and what is asked of it. All numbers are SI: m, kg, s, N.",
        f"# First bending frequency {f1:.4g} Hz; largest speed of the line {kmh:.4g} km/h.",
    ]
    for table, keys in bridge.content(train, speed).items():
        lines += ["", f"[{table}]"]
        for key, value in keys.items():
            meant = _MEANT.get(f"{table}.{key}", "")
            line = f"{key} = {_written(value)}"
            lines.append(f"{line:41} # {meant}" if meant else line)
    return "\n".join(lines) + "\n"


def _written(value: Any) -> str:
    """Return a value as TOML writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # TOML's basic strings escape as JSON's do, and delete too.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_written(v)}" for key, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_written, value)) + "]"
    if isinstance(value, float) and abs(value) >= _LARGE:
        return np.format_float_scientific(value, trim="0")
    return repr(value)
