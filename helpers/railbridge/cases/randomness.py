"""Random tracks of a case: the rail that is drawn for a run, and the whole that is drawn anew."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..errors import InputError, within
from ..irregularities import PAIRS, Cosines, RandomTrack, spectrum
from ..irregularities.densities import ScaledDensity
from ..irregularities.realisations import PERIOD
from ..tracks import Irregularity, Rails, Track
from . import shelf, tables
from .tabletypes import Table, checked

__all__ = ["certain_part", "random_rail", "random_track"]

_ALIKE = ("spectrum", "band", "seed", "period")
"""What both directions of one random track have alike."""
_DEFAULTS = {"band": RandomTrack.band, "seed": RandomTrack.seed, "period": PERIOD}


def _stamp(name: str) -> tuple[int, ...]:
    """Return what changes with a file; nothing for what is shipped."""
    if not shelf.is_path(name):
        return ()
    stamp = Path(name).stat()
    return stamp.st_mtime_ns, stamp.st_size


@lru_cache(maxsize=16)
def _drawn(
    name: str,
    sigma: float | None,
    component: str,
    options: tuple[tuple[str, Any], ...],
    *_stamps: int,
) -> RandomTrack:
    """Draw a track once for both rails."""
    own = spectrum(name)
    return RandomTrack(own if sigma is None else own.scaled(sigma, component), **dict(options))


def _of_direction(path: str, given: dict[str, Any]) -> RandomTrack:
    """Return what a table ``kind = "random"`` draws in the direction that its path says."""
    direction = "lateral" if path.startswith("track.lateral") else "vertical"
    both, apart = PAIRS[direction]
    with within(path):
        own = spectrum(given["spectrum"])
        names = [name for name in (both, apart) if name in own.components]
        if not given.get("rails_differ", True):
            names = names[:1]
        if both not in names:
            allowed = f"{own.name} has no {both}, only {', '.join(own.components)}"
            raise InputError("spectrum", given["spectrum"], allowed)
        options = {name: given[name] for name in ("band", "seed", "period") if name in given}
        options |= {"components": tuple(names)}
        known = given["spectrum"], given.get("sigma"), both, tuple(options.items())
        return _drawn(*known, *_stamp(given["spectrum"]))


def random_rail(path: str, given: dict[str, Any], side: str) -> Irregularity:
    """Return one rail of a random track, in the direction that the path says.

    Parameters
    ----------
    path : str
        Of the table: ``track.lateral[2]``.
    given : dict
        Its keys but for ``kind``.
    side : {"left", "right"}
    """
    direction = "lateral" if path.startswith("track.lateral") else "vertical"
    found = getattr(_of_direction(path, given), direction)
    return getattr(found, side) if isinstance(found, Rails) else found


# ---- the whole


def random_track(content: Mapping[str, Any]) -> tuple[RandomTrack, tuple[str, ...]]:
    """Return what of a case's track is drawn, as one track, and the paths where it stands.

    Its realisation of a seed is the track of a case with that seed at all these paths.

    Parameters
    ----------
    content : mapping
        The tables of the case.

    Raises
    ------
    InputError
        Nothing of it is random; more than one random track in a direction, or one of a single rail;
        directions that differ in spectrum, band, seed or period.
    """
    found = dict(_tables(checked(tables.CASE, content).track))
    if not found:
        remedy = 'For instance vertical = { kind = "random", spectrum = "german-low", seed = 1 }'
        raise InputError("track", None, 'holds nothing of kind = "random"', remedy)
    first, own = next(iter(found.items()))
    for path, other in found.items():
        for name in _ALIKE:
            wanted, value = (table.get(name, _DEFAULTS.get(name)) for table in (own, other))
            if value != wanted:
                allowed = f"is not that of {first}, {wanted}: both are one random track"
                raise InputError(f"{path}.{name}", value, allowed, "Give both the same")
    drawn = [_of_direction(path, table) for path, table in found.items()]
    whole = drawn[0].spectrum
    if drawn[-1].spectrum.factor != whole.factor:  # each direction has a sigma of its own
        parts = dict(whole.parts)
        for track in drawn:
            for name in track.components:
                density = ScaledDensity(parts[name].density, track.spectrum.factor)
                parts[name] = replace(parts[name], density=density)
        whole = replace(whole, parts=parts, factor=1.0, scaling=None)
    components = tuple(name for track in drawn for name in track.components)
    # The period is that of a run, not chosen by the length of the train: it decides on the waves.
    period = own.get("period", PERIOD)
    return replace(drawn[0], spectrum=whole, components=components, period=period), tuple(found)


def _tables(given: Table | None) -> Iterator[tuple[str, dict[str, Any]]]:
    """Give the random track of each direction with its path; refuse what is no track of both."""
    for direction, value in {} if given is None else given.given.items():
        path = f"track.{direction}"
        if isinstance(value, tables.RAILS):
            for side, own in value.given.items():
                for at, _ in _random_ones(f"{path}.{side}", own):
                    allowed = "is a random track of one rail, and both are drawn together"
                    remedy = f"Write it into {path}; rails_differ = false moves both rails alike"
                    raise InputError(at, None, allowed, remedy)
            continue
        own = list(_random_ones(path, value))
        if len(own) > 1:
            allowed = f"is a second random track beside {own[0][0]}"
            raise InputError(own[1][0], None, allowed, "Leave one of them")
        yield from own


def _random_ones(path: str, value: Any) -> Iterator[tuple[str, dict[str, Any]]]:
    if isinstance(value, (list, tuple)):
        for i, part in enumerate(value, start=1):
            yield from _random_ones(f"{path}[{i}]", part)
    elif value.kind == "random":
        yield path, {name: own for name, own in value.given.items() if name != "kind"}


def certain_part(track: Track) -> Track:
    """Return what of a case's track is not random."""
    return Track(vertical=_certain(track.vertical), lateral=_certain(track.lateral))


def _certain(given: Any) -> Any:
    if isinstance(given, Rails):
        rails = Rails(_certain(given.left), _certain(given.right))
        return None if rails.left is None and rails.right is None else rails
    if isinstance(given, (list, tuple)):
        return [part for part in map(_certain, given) if part is not None] or None
    return None if isinstance(given, Cosines) else given
