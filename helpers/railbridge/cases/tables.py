"""Every table of case, deck and vehicle files, declared once.

What the keys may be comes from the dataclasses that the tables become; here stands which keys a
table has and which of them go together.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Union

from pydantic import BeforeValidator, Discriminator, Tag
from typing_extensions import TypeAliasType

from .. import errors
from ..beams import Beam, Bearing, Pier, PointMass, Section
from ..beams.bearings import FIXITIES
from ..beams.bearings import STIFFEST as STIFFEST_BEARING
from ..boxes import Box, BoxMesh, Pads
from ..boxes.pads import DIRECTIONS
from ..boxes.pads import STIFFEST as STIFFEST_PAD
from ..checks import Requirements
from ..codes.hslm import FORCES, SPACING
from ..codes.wagons import WAGONS
from ..contacts import Rail, Wheelset
from ..damping import ALPHA, BETA, RATIO, ModalDamping
from ..errors import InputError, Range, choice, keys, within
from ..exchange import ModesTable
from ..guideways import Guideway
from ..irregularities import Dip, Joint, RandomTrack, Weld
from ..irregularities.records import BAND, LARGEST_DRIFT, LARGEST_STEP, checked_band
from ..irregularities.repairs import REPAIRS
from ..settings import Options
from ..tracks import Harmonic, Notch
from ..tracks import Table as MeasuredTrack
from ..trains import AxleTrain, Train
from ..vehicles import FREEDOMS, AntiRollBar, Body, Spring, Vehicle
from .tabletypes import (
    Table,
    anything,
    boolean,
    by_key,
    by_value,
    fields_of,
    key,
    list_of,
    meanings,
    measured,
    named_numbers,
    number,
    numbers,
    switched,
    table,
)

__all__ = [
    "CASE", "CHECKS", "DECK", "DECK_FILE", "OUTPUT", "RUN", "TABLES", "TRACK", "TRAIN", "VEHICLE",
]  # fmt: skip


def _either(*groups: tuple[str, ...]) -> dict[str, Any]:
    """Return the JSON Schema of exactly one of several groups of keys, whole."""
    result = []
    for group in groups:
        others = [name for other in groups if other != group for name in other]
        own = {"required": list(group)}
        result.append(own | _without(*(name for name in others if name not in group)))
    return {"oneOf": result}


def _without(*names: str) -> dict[str, Any]:
    """Return the JSON Schema of a table that has none of some keys."""
    return {"not": {"anyOf": [{"required": [name]} for name in names]}}


def _words(allowed: tuple[str, ...], least: int = 0) -> Any:
    """Return the type of several words, as a list or in one text."""

    def check(value: Any) -> tuple[str, ...]:
        words = value.split() if isinstance(value, str) else value
        if not isinstance(words, (list, tuple)) or len(words) < least:
            raise InputError("", value, "must list some of " + " ".join(allowed))
        return tuple(choice("", word, allowed) for word in words)

    schema = {"anyOf": [{"type": "string"}, {"type": "array", "items": {"enum": list(allowed)}}]}
    return anything(schema, check)


def _for_people() -> dict[str, Any]:
    return {name: key(anything({}), "For people.") for name in ("name", "source", "note")}


NAME = anything({"type": "string", "minLength": 1})
"""A shipped name or a path; the shelf says what is wrong with it."""

# ---- track

_KINDS = ("none", "harmonic", "table", "random", "file", "dip", "joint", "weld")


def _kind(name: str) -> dict[str, Any]:
    check = anything({"const": name}, lambda value: choice("", value, _KINDS))
    return {"kind": key(check, f'"{name}".', required=True)}


LEVEL = table("Level", "A perfect rail.", **_kind("none"))
HARMONIC = table(
    "Harmonic",
    "A wave: r = amplitude sin(2 pi x / wavelength + phase).",
    schema=_either(("wavelength",), ("length", "half_waves")),
    **_kind("harmonic"),
    **fields_of(Harmonic),
)
MEASURED = table(
    "Measured", "A measured irregularity.", **_kind("table"), **fields_of(MeasuredTrack)
)

_WAVES = {
    "anyOf": [
        {"type": "array", "items": {"type": "number", "exclusiveMinimum": 0}, "minItems": 2,
         "maxItems": 2},
        {"enum": ["all"]},
    ]
}  # fmt: skip
RANDOM = table(
    "Random",
    "A track drawn from a spectrum: many waves with random phases. The same seed below "
    "track.vertical and track.lateral gives components that are independent all the same.",
    **_kind("random"),
    spectrum=key(
        NAME, "A shipped spectrum (german-low), or a .toml file beside this one.", required=True
    ),
    **fields_of(RandomTrack, only=("seed", "period")),
    band=key(
        numbers(2, above=0.0, unit="m"), "Shortest and longest wavelength, m.", RandomTrack.band
    ),
    sigma=key(
        number(above=0.0, unit="m"),
        "m; makes the spectrum rougher or smoother, so that its standard deviation over 3 to 25 m "
        "(D1 of EN 13848) is this: of vertical level, or of alignment below track.lateral.",
    ),
    rails_differ=key(
        boolean(),
        "Whether cross-level (below track.lateral gauge) moves the rails apart, where the spectrum "
        "has it.",
        True,
    ),
)
RECORDED = table(
    "Recorded",
    "What a recording car wrote into a CSV file: its heights below track.vertical, its places "
    "sideways below track.lateral.",
    **_kind("file"),
    file=key(NAME, "A shipped record, or a .csv file beside this one.", required=True),
    band=key(
        anything(_WAVES, lambda value: checked_band("", value)),
        'Shortest and longest wavelength kept, m; or "all". What the band takes out is told.',
        list(BAND),
    ),
    origin=key(number(unit="m"), "Place of the record at the bridge entrance, m.", 0.0),
    repair=key(
        _words(REPAIRS),
        "What is mended, else refused: some of " + " ".join(REPAIRS) + "; what was done is told.",
    ),
    largest_step=key(
        number(above=0.0, unit="m"), "m; neighbours that differ more are a step.", LARGEST_STEP
    ),
    largest_drift=key(
        number(above=0.0, unit="m"),
        "m; a straight line that rises more from end to end is a drift.",
        LARGEST_DRIFT,
    ),
)
DIP = table("Dip", "A smooth hollow, once or several times.", **_kind("dip"), **fields_of(Dip))
JOINT = table(
    "Joint",
    "A dipped joint, two half parabolas that meet in a cusp, once or several times.",
    **_kind("joint"),
    **fields_of(Joint),
)
WELD = table(
    "Weld",
    "A weld: a long hollow or hump with a short one in its middle, once or several times.",
    **_kind("weld"),
    **fields_of(Weld),
)


def _refuse_unknown_kind(value: Any) -> Any:
    if isinstance(value, dict) and isinstance(value.get("kind"), str):
        choice("kind", value["kind"], _KINDS)
    return value


_BY_KIND = {
    "none": LEVEL, "harmonic": HARMONIC, "table": MEASURED, "random": RANDOM, "file": RECORDED,
    "dip": DIP, "joint": JOINT, "weld": WELD,
}  # fmt: skip
IRREGULARITY = Annotated[
    switched(lambda value: by_value(value, "kind", _KINDS, otherwise="harmonic"), _BY_KIND),
    BeforeValidator(_refuse_unknown_kind),
]
IRREGULARITIES = TypeAliasType(
    "IRREGULARITIES",
    Annotated[
        Union[  # noqa: UP007 - a name in quotes cannot be joined by |
            Annotated[IRREGULARITY, Tag("~one")],
            Annotated[list["IRREGULARITIES"], Tag("~several")],
        ],
        Discriminator(lambda value: "~several" if isinstance(value, (list, tuple)) else "~one"),
    ],
)
_ONE_OR_MORE = "One irregularity, or a list of them on top of each other."
RAILS = table(
    "Rails",
    "Rails that differ.",
    schema={"minProperties": 1},
    left=key(IRREGULARITIES, _ONE_OR_MORE),
    right=key(IRREGULARITIES, _ONE_OR_MORE),
)
_DIRECTION = switched(
    lambda value: by_key(value, ("left", "right"), otherwise="both"),
    {"left": RAILS, "right": RAILS, "both": IRREGULARITIES},
)
RAILS.siblings = _BY_KIND
_EACH = " One irregularity, a list of them (added up), or { left, right } for rails that differ."
TRACK = table(
    "Track",
    "Irregularity of the rails; perfect where left out.",
    vertical=key(_DIRECTION, "Up positive." + _EACH),
    lateral=key(_DIRECTION, "Left positive." + _EACH),
)

# ---- vehicle and train


BODY = table(
    "Body",
    "A rigid body.",
    **fields_of(Body, optional=("inertia",), required=("freedoms",), freedoms=_words(FREEDOMS, 1)),
)
SPRING = table("Spring", "A spring and damper.", **fields_of(Spring, optional=("damping",)))
ANTI_ROLL_BAR = table(
    "AntiRollBar", "A torsion spring between the rolls of two bodies.", **fields_of(AntiRollBar)
)
WHEELSET = table(
    "Wheelset", "An axle with its wheels, and their contacts with the rails.", **fields_of(Wheelset)
)
VEHICLE = table(
    "Vehicle",
    "A linear vehicle: bodies on springs.",
    **_for_people(),
    **fields_of(Vehicle, only=("length", "static_wheelset_mass")),
    body=key(list_of(BODY, "body"), "Car body, bogies.", required=True),
    spring=key(list_of(SPRING, "spring"), "Suspension and contacts with the rail.", required=True),
    wheelset=key(
        list_of(WHEELSET, "wheelset"),
        "Wheelsets with mass, each with its contacts; springs end at their names.",
    ),
    anti_roll_bar=key(list_of(ANTI_ROLL_BAR, "anti_roll_bar"), "Between bodies that roll."),
)


def _pairs(value: Any) -> Any:
    return tuple(map(tuple, value)) if _is_pairs(value) else value


def _is_pairs(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(pair, list) for pair in value)


_WHEELS = {
    "type": "array", "minItems": 1,
    "items": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "integer",
    "minimum": 1}},
}  # fmt: skip
NOTCH = table(
    "Notch",
    "A flat spot that meets the rail once a turn (Eq. 2).",
    **fields_of(Notch, wheels=anything(_WHEELS, _pairs)),
)
_CARS = Range(least=1, most=1000, whole=True)
SEVERAL = table(
    "Several",
    "Some cars of one kind.",
    vehicle=key(NAME, "A shipped vehicle or a file.", required=True),
    count=key(number(**vars(_CARS)), "How many.", 1),
)
_OWN_TRACK = key(
    anything({"anyOf": [{"type": "number"}, {"type": "string"}]}),
    "m left of the deck axis, or the name of a track of the deck.",
    0.0,
)
_ROLLING = {
    **fields_of(Train, only=("car_spacing",)),
    "track": _OWN_TRACK,
    "notch": key(list_of(NOTCH, "train.notch"), "Flat spots of wheels: [[train.notch]]."),
}
OF_ONE_KIND = table(
    "Cars",
    "One vehicle several times.",
    vehicle=key(
        NAME, "A shipped vehicle (xia2000), or a .csv or .toml file beside this one.", required=True
    ),
    cars=key(number(**vars(_CARS)), "Number of cars.", 1),
    **_ROLLING,
)
MIXED = table(
    "Mixed",
    "Vehicles from front to back.",
    cars=key(
        list[
            switched(
                lambda value: "name" if isinstance(value, str) else "several",
                {"name": NAME, "several": SEVERAL},
            )
        ],
        'Front to back: names of vehicles, or { vehicle = "coach", count = 6 }.',
        required=True,
    ),
    **_ROLLING,
)
BARE = table(
    "Axles",
    "Bare axle loads, without suspension.",
    **fields_of(AxleTrain, omit=("name",)),
    track=_OWN_TRACK,
)
NAMED = table(
    "NamedTrain",
    "A train of bare axle loads by its name.",
    unknown_key=(
        "cannot stand beside train.name",
        "The name says all axles; beside it only wagons, n, d and track may stand",
    ),
    name=key(
        NAME,
        "HSLM-A1 to HSLM-A10 or HSLM-B (EN 1991-2), a line category of EN 15528 (A to E5), or a "
        "shipped axle list (ICE2); railbridge list trains shows all.",
        required=True,
    ),
    wagons=key(
        number(**vars(WAGONS)), "Of a line category: number of equal wagons; 20 if left out."
    ),
    n=key(number(**vars(FORCES)), "Of HSLM-B: number of forces, Figure 6.14. Needed there."),
    d=key(number(**vars(SPACING)), "Of HSLM-B: their spacing, m, Figure 6.14. Needed there."),
    track=_OWN_TRACK,
)
FROM_FILE = table(
    "TrainFile",
    "A train of bare axle loads from a file.",
    unknown_key=(
        "cannot stand beside train.file",
        "The file says all axles; beside it only track may stand",
    ),
    file=key(NAME, "A .csv file of axles beside this one.", required=True),
    track=_OWN_TRACK,
)


def _kind_of_train(value: Any) -> str:
    for name, kind in (("name", "named"), ("file", "file")):
        if isinstance(value, dict) and name in value:
            return kind
    if isinstance(value, dict) and ("axles" in value or "loads" in value):
        return "bare"
    return "mixed" if isinstance(value, dict) and isinstance(value.get("cars"), list) else "cars"


def _refuse_several_trains(value: Any) -> Any:
    if isinstance(value, list):
        allowed = "several trains on one deck are not supported: they feel each other through it"
        remedy = "Give one [train]; of bare axle loads, which feel nothing, run each and add them"
        raise InputError("", value, allowed, remedy)
    if isinstance(value, dict) and isinstance(value.get("cars"), list) and "vehicle" in value:
        allowed = "give either vehicle with a number of cars, or a list of cars"
        raise InputError("vehicle", value["vehicle"], allowed)
    return value


TRAIN = Annotated[
    switched(
        _kind_of_train,
        {"cars": OF_ONE_KIND, "mixed": MIXED, "bare": BARE, "named": NAMED, "file": FROM_FILE},
    ),
    BeforeValidator(_refuse_several_trains),
]

# ---- deck


class _Damping(Table):
    """Damping of a deck."""

    not_a_table = "Write { modal = 0.015 } for 1.5 % of critical in every mode"


MODAL = table(
    "Modal", "The same ratio for every mode.", base=_Damping,
    modal=key(number(**vars(RATIO)), "Share of critical of every mode.", required=True),
)  # fmt: skip
RAYLEIGH = table(
    "Rayleigh", "One ratio at two frequencies.", base=_Damping,
    ratio=key(number(**vars(RATIO)), "Share of critical at both frequencies.", required=True),
    frequencies_hz=key(numbers(2, above=0.0, unit="Hz"), "The two frequencies, Hz.", required=True),
)  # fmt: skip


def _per_mode(value: Any) -> ModalDamping:
    with within(names={"ratios": ""}):
        return ModalDamping(value)


_RATIO = {"type": "number", "minimum": RATIO.least, "maximum": RATIO.most}
PER_MODE = table(
    "PerMode",
    "A ratio for each mode.",
    base=_Damping,
    per_mode=key(
        measured(anything({"type": "array", "minItems": 1, "items": _RATIO}, _per_mode)),
        meanings(ModalDamping)["ratios"],
        required=True,
    ),
)
CONSTANTS = table(
    "Constants",
    "Rayleigh's constants: ratio = alpha / (2 omega) + beta omega / 2.",
    base=_Damping,
    schema={"minProperties": 1},
    alpha=key(number(**vars(ALPHA)), "Share of the mass, 1/s.", 0.0),
    beta=key(number(**vars(BETA)), "Share of the stiffness, s.", 0.0),
)


def _kind_of_damping(value: Any) -> str:
    found = by_key(value, ("modal", "per_mode", "alpha", "beta"), otherwise="rayleigh")
    return "constants" if found in ("alpha", "beta") else found


DAMPING = switched(
    _kind_of_damping,
    {"modal": MODAL, "per_mode": PER_MODE, "constants": CONSTANTS, "rayleigh": RAYLEIGH},
)


class _Holds(Table):
    """A bearing that holds something."""

    @classmethod
    def refuse_mixture(cls, given: Mapping[str, Any]) -> None:
        if given.get("fixed", []) in ([], "") and not given.get("stiffness"):
            remedy = "Say what the bearing holds, here or by stiffness"
            raise InputError("fixed", None, "is missing", remedy)


_HOLDS = {"anyOf": [{"required": ["fixed"]}, {"required": ["stiffness"]}]}
PIER = table("Pier", "A pier below a bearing, as springs.", **fields_of(Pier))
BEARING = table(
    "Bearing",
    "A bearing under the deck.",
    base=_Holds,
    schema=_HOLDS,
    **fields_of(
        Bearing,
        fixed=_words(FIXITIES),
        stiffness=named_numbers(FIXITIES, above=0.0, most=STIFFEST_BEARING, unit="N/m or N m/rad"),
        pier=PIER,
    )
    | {
        "fixed": key(
            _words(FIXITIES),
            "What it holds rigidly: some of x y z roll pitch yaw. Needed without stiffness.",
        )
    },
)
PADS = table(
    "Pads",
    "A bearing line of a box: pads under its webs.",
    base=_Holds,
    schema=_HOLDS,
    **fields_of(
        Pads,
        fixed=_words(DIRECTIONS),
        stiffness=named_numbers(DIRECTIONS, above=0.0, most=STIFFEST_PAD, unit="N/m"),
    ),
)
POINT_MASS = table("PointMass", "A mass at one place of the deck.", **fields_of(PointMass))
SECTION = table("Section", "Section and material.", **fields_of(Section))

RAIL = table(
    "DeckRail",
    "Rails that spread a wheel's load, and carry on over the deck's ends.",
    schema=_either(("spread",), ("bending_stiffness", "foundation")),
    **fields_of(Rail),
)
_RAIL = key(
    RAIL,
    "How rails spread a wheel's load and carry on over the deck's ends: { spread = 0.6 }, or "
    "{ bending_stiffness, foundation }; not at all if left out.",
)
_CARRYING = {
    "tracks": key(
        named_numbers(unit="m"), "Named tracks: m left of the deck axis, { left = 2.4 }."
    ),
    "width": key(number(above=0.0, unit="m"), "m, on which the wheels must stand."),
    "track_height": key(
        number(least=-50.0, most=50.0, unit="m"), meanings(Guideway)["track_height"], 0.0
    ),
    "rail": _RAIL,
}
_SPANS = {
    "length": key(number(above=0.0, unit="m"), "One span, m. Or spans."),
    "spans": key(numbers(above=0.0, unit="m"), "Several spans, m. Or length."),
}
_MODES = key(
    number(least=1, whole=True),
    "How many modes are kept, the lowest that loads can excite; chosen if left out.",
)
_DAMPING = (
    "Rayleigh { ratio, frequencies_hz } or { alpha, beta }, one ratio for every mode { modal }, or "
    "one for each { per_mode }."
)
_POINT_MASSES = "Masses at single places, besides the mass per metre: [[deck.point_mass]]."
_BEARINGS = "Bearings; default: y, z and roll at both ends of every span, x at the first."


class _Spans(Table):
    """A deck of one span or several."""

    @classmethod
    def refuse_mixture(cls, given: Mapping[str, Any]) -> None:
        if ("length" in given) == ("spans" in given):
            raise InputError("length", given.get("length"), "give either length or spans")

    @property
    def all_spans(self) -> tuple[float, ...]:
        """M."""
        return self.spans if self.has("spans") else (self.length,)


STIFFNESSES = tuple(
    name
    for name in meanings(Beam)
    if name.endswith(("_stiffness", "stiffness_vertical", "stiffness_lateral"))
    or name.startswith(("polar_inertia", "rotary_inertia_"))
)


class _BeamDeck(_Spans):
    """A beam, from a section or from stiffnesses."""

    @classmethod
    def refuse_mixture(cls, given: Mapping[str, Any]) -> None:
        super().refuse_mixture(given)
        if ("section" in given) == ("mass" in given):
            allowed = "give either a section or stiffnesses with mass, never both"
            raise InputError("section", None, allowed)
        if "section" in given:
            for name in STIFFNESSES:
                if name in given:
                    allowed = "a section is given too, never both"
                    raise InputError(name, given[name], allowed, "Remove one")
            return
        keys("", given, given, ["bending_stiffness_vertical"])
        if given.get("rotary_inertia") is True:
            remedy = "Give rotary_inertia_vertical and rotary_inertia_lateral, kg m"
            raise InputError("rotary_inertia", True, "follows from a section only", remedy)


BEAM = table(
    "BeamDeck",
    "A deck of beam elements, with stiffnesses and mass or with a section.",
    base=_BeamDeck,
    schema={
        "allOf": [
            _either(("length",), ("spans",)),
            _either(("section",), ("mass", "bending_stiffness_vertical")),
            {"if": {"required": ["section"]}, "then": _without(*STIFFNESSES)},
        ]
    },
    **_SPANS,
    **fields_of(Beam, only=("continuous",)),
    section=key(SECTION, "Instead of stiffnesses and mass: [deck.section]."),
    **fields_of(Beam, only=("mass", *STIFFNESSES), optional=("mass", *STIFFNESSES)),
    rotary_inertia=key(
        boolean(), "With a section: its own rotary inertias, density times second moments.", False
    ),
    damping=key(DAMPING, _DAMPING, required=True),
    modes=_MODES,
    **fields_of(Beam, only=("elements", "centroid_height")),
    bearing=key(list_of(BEARING, "bearing"), _BEARINGS),
    point_mass=key(list_of(POINT_MASS, "point_mass"), _POINT_MASSES),
    **_CARRYING,
    **_for_people(),
)

DIMENSIONS = tuple(n for n in fields_of(Box, omit=("name", "spans", "bearings", "tracks")))
BOX = table(
    "Box",
    "The dimensions of a single-cell box girder (extra fem).",
    **fields_of(Box, only=DIMENSIONS),
)
MESH = table("Mesh", "Elements of the shell.", **fields_of(BoxMesh))


class _BoxDeck(_Spans):
    """A box as a beam or as a shell."""

    @classmethod
    def refuse_mixture(cls, given: Mapping[str, Any]) -> None:
        super().refuse_mixture(given)
        shell = given.get("model") == "shell"
        for name in ("shear", "rotary_inertia") if shell else ():
            if name in given:
                allowed = "is a switch of the beam model"
                raise InputError(name, given[name], allowed, "Remove it, a shell has both")
        if "mesh" in given and not shell:
            remedy = 'Remove it, or set model = "shell"'
            raise InputError("mesh", given["mesh"], "belongs to the shell model", remedy)
        if "point_mass" in given and shell:
            allowed = "belongs to the beam model: the shell has no node that could carry it"
            remedy = 'Set model = "beam", or spread it as track_mass or edge_mass'
            raise InputError("point_mass", None, allowed, remedy)


BOX_DECK = table(
    "BoxDeck",
    "A box girder from its dimensions, as a beam or as a shell.",
    base=_BoxDeck,
    schema=_either(("length",), ("spans",)),
    **_SPANS,
    box=key(BOX, "Dimensions of the section: [deck.box].", required=True),
    model=key(
        anything({"enum": ["beam", "shell"]}, lambda value: choice("", value, ("beam", "shell"))),
        "Beam with the section's properties, or shell, of which only modes are known.",
        "beam",
    ),
    mesh=key(MESH, "Elements of the shell."),
    shear=key(boolean(), "Whether the beam gives way in shear.", True),
    rotary_inertia=key(boolean(), "Whether turning sections of the beam have inertia.", True),
    damping=key(DAMPING, _DAMPING, required=True),
    modes=_MODES,
    bearing=key(list_of(PADS, "bearing"), "Pads; default: y and z at every line, x at the first."),
    point_mass=key(list_of(POINT_MASS, "point_mass"), _POINT_MASSES + " Not of a shell."),
    tracks=_CARRYING["tracks"],
    rail=_RAIL,
    **_for_people(),
)
_AXES = ["x", "-x", "y", "-y", "z", "-z"]
MODES = table(
    "Modes",
    "Modes of another finite-element program; see docs/exchange.md.",
    **fields_of(
        ModesTable,
        units=anything(
            {"type": "array", "minItems": 1, "maxItems": 2, "items": {"type": ["string", "number"]}}
        ),
        axes=anything({"type": "array", "minItems": 3, "maxItems": 3, "items": {"enum": _AXES}}),
        rail=anything({"type": "object"}),
        axis=named_numbers(("y", "z"), unit="m"),
    ),
)
MODAL_DECK = table(
    "ModalDeck",
    "A deck of which another program knows the modes.",
    beside="a table of modes",
    modes=key(MODES, "Where the modes stand.", required=True),
    damping=key(DAMPING, _DAMPING + " Default: that of the file."),
    **_CARRYING,
    **_for_people(),
)


def _kind_of_deck(value: Any) -> str:
    if not isinstance(value, dict):
        return "beam"
    if isinstance(value.get("modes"), dict):
        return "modes"
    return "box" if "box" in value else "beam"


_MAKERS = {"beam": BEAM, "box": BOX_DECK, "modes": MODAL_DECK}
DECK_FILE = switched(_kind_of_deck, _MAKERS)
"""The content of a deck file."""
DECK_KEYS = frozenset().union(*(kind.model_fields for kind in _MAKERS.values()))
"""Keys that a deck file may have, whatever makes its deck."""
SHIPPED = table(
    "DeckFile",
    "A deck file; modes, damping and rail may replace its own.",
    unknown_key=(
        "cannot stand beside deck.file",
        "Beside a file only modes, damping and rail may stand; they replace its own. To change "
        "others, write the deck into the case: all keys of its file, in place of file",
    ),
    file=key(NAME, "A shipped deck (viaduct36), or a .toml file beside this one.", required=True),
    modes=key(number(least=1, whole=True), "How many modes, instead of the file's own number."),
    damping=key(DAMPING, "Instead of the file's own. " + _DAMPING),
    rail=key(RAIL, "Instead of the file's own: { spread }, or { bending_stiffness, foundation }."),
)
DECK = switched(
    lambda value: by_key(value, ("file",), otherwise=_kind_of_deck(value)),
    {"file": SHIPPED, **_MAKERS},
)

# ---- run, output, the whole

RUN = table("Run", "How the crossing is computed.", **fields_of(Options, omit=("track_offset",)))


def _points(value: Any) -> Any:
    if isinstance(value, (list, tuple)) and not 1 <= len(value) <= 100:
        remedy = "Leave it out for mid-length"
        raise InputError("", value, "must hold 1 to 100 places", remedy)
    return tuple(errors.numbers("", value, least=0.0, unit="m").tolist())


_PLACES = {
    "type": "array", "minItems": 1, "maxItems": 100, "items": {"type": "number", "minimum": 0},
}  # fmt: skip
OUTPUT = table(
    "Output",
    "What is told of the crossing.",
    points=key(measured(anything(_PLACES, _points), "m"), "m along the deck; default mid-length."),
)
CHECKS = table(
    "Checks",
    "What the clauses of the codes are told of line and bridge.",
    **fields_of(Requirements),
)
CASE = table(
    "Case",
    "One train crosses one deck at one speed. All numbers are SI: m, kg, s, N.",
    deck=key(DECK, "A deck file, or a deck of your own.", required=True),
    train=key(TRAIN, "Vehicles with suspension, or bare axle loads.", required=True),
    track=key(TRACK, "Irregularity of the rails; perfect where left out."),
    run=key(RUN, "How the crossing is computed.", required=True),
    output=key(OUTPUT, "What is told of it."),
    checks=key(CHECKS, "What the clauses of the codes are told of line and bridge."),
)
TABLES = {
    "deck": BEAM, "deck.file": SHIPPED, "deck.section": SECTION, "deck.bearing": BEARING,
    "deck.box": BOX, "box deck": BOX_DECK, "box bearing": PADS, "deck.mesh": MESH,
    "deck.modes": MODES, "modal deck": MODAL_DECK, "deck.damping": RAYLEIGH, "modal damping": MODAL,
    "damping constants": CONSTANTS, "damping per mode": PER_MODE, "deck.pier": PIER,
    "deck.point_mass": POINT_MASS, "deck.rail": RAIL,
    "train": OF_ONE_KIND, "mixed train": MIXED, "train.cars": SEVERAL, "bare train": BARE,
    "named train": NAMED, "train file": FROM_FILE, "train.notch": NOTCH, "track": TRACK,
    "rails": RAILS, "harmonic": HARMONIC, "table": MEASURED, "random": RANDOM, "file": RECORDED,
    "dip": DIP, "joint": JOINT, "weld": WELD, "none": LEVEL, "run": RUN,
    "output": OUTPUT, "checks": CHECKS, "vehicle": VEHICLE, "body": BODY, "spring": SPRING,
    "wheelset": WHEELSET, "anti roll bar": ANTI_ROLL_BAR,
}  # fmt: skip
"""Every table by what the pages call it."""
