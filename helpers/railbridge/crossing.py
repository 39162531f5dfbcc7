"""One train crosses one deck at one speed: rigid, iterated, or solved directly."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable, Iterable
from dataclasses import fields
from typing import get_type_hints

from .cautions import remarks
from .coupling import Coupling, FixedPoint, grows, iterate, prepare
from .decks import Deck
from .direct import FEW, in_windows, solve_directly
from .errors import InputError, Remark
from .results import Crossing
from .settings import Options, Settings, check
from .tracks import Track
from .trains import AnyTrain

__all__ = ["NotConvergedError", "compute", "cross", "warn_of"]


class NotConvergedError(RuntimeError):
    """The iteration did not settle within the allowed passes.

    Parameters
    ----------
    run : Crossing
        Everything computed so far.
    path : str
        What stands before the names of options in the caller's words: "run." in a case.
    """

    def __init__(self, run: Crossing, path: str = "") -> None:
        s = run.settings
        direct, own = f"{path}interaction = 'direct'", f"{path}relaxation = 0.5 or 'aitken'"
        remedies = [direct, own, f"more {path}max_iterations"]
        found = f"the last change was {run.changes[-1]:.2g} and"
        needed = f"must be below {path}tolerance = {s.tolerance:g} twice in a row"
        if s.tolerance_of == "displacement":
            found = f"the last pass moved the deck by {run.changes[-1]:.2g} of its largest motion;"
            needed = f"that and what is left must be below {path}tolerance = {s.tolerance:g}"
        super().__init__(
            f"{path}max_iterations = {run.iterations}: not converged, {found} {needed}. "
            f"Try {', '.join(remedies[:-1])}, or {remedies[-1]}."
        )
        self.run = run


def _with_options(function: Callable) -> Callable:
    """Show the fields of `Options` as keyword arguments of a function that takes ``**options``."""
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    types = get_type_hints(Options)
    chosen = [
        inspect.Parameter(
            f.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=inspect.Parameter.empty if f.name == "speed" else f.default,
            annotation=types[f.name],
        )
        for f in fields(Options)
    ]
    positional = [p for p in own if p.kind is not p.KEYWORD_ONLY]
    keyword = [p for p in own if p.kind is p.KEYWORD_ONLY]
    function.__signature__ = signature.replace(parameters=[*positional, *chosen, *keyword])
    described = inspect.getdoc(Options).partition("Attributes\n----------\n")[2]
    function.__doc__ = inspect.getdoc(function).replace("**options\n", described + "\n")
    return function


@_with_options
def cross(
    train: AnyTrain,
    deck: Deck,
    track: Track | None = None,
    *,
    progress: Callable[[str], None] | None = None,
    **options,
) -> Crossing:
    """Compute a crossing.

    Parameters
    ----------
    train : Train or AxleTrain
    deck : Deck
    track : Track, optional
        Level if not given.
    **options
    progress : function of one text, optional
        Called now and then with how far the computation is.

    Returns
    -------
    Crossing

    Raises
    ------
    InputError
        A value out of range; raised before anything is computed.
    NotConvergedError
        With everything computed so far in its ``run``.

    Warns
    -----
    InputWarning, ResultWarning
        What `notices.remarks` says of the result.

    Notes
    -----
    Self-weight is not fed back: the track is laid level on the sagged deck.
    """
    track = Track() if track is None else track
    settings = check(train, deck, track, **options)
    try:
        run = compute(train, deck, track, settings, progress)
    except NotConvergedError as error:
        warn_of(remarks(error.run))  # a slip may be why
        raise
    warn_of(remarks(run))
    return run


def warn_of(found: Iterable[Remark]) -> None:
    """Warn of what is doubtful, in the name of who called the caller."""
    for remark in found:
        if remark.warned:
            warnings.warn(remark, stacklevel=3)


def compute(
    train: AnyTrain,
    deck: Deck,
    track: Track,
    settings: Settings,
    progress: Callable[[str], None] | None = None,
) -> Crossing:
    """Compute a crossing whose settings are checked, without warnings; see `cross`.

    Parameters
    ----------
    train, deck, track
    settings : Settings
        From `check`, for these three.
    progress : function of one text, optional
    """
    coupling = prepare(train, deck, track, settings)
    start = coupling.nothing_added()
    if settings.interaction == "rigid":
        return Crossing(train, deck, track, settings, (start,), (), None, 0, coupling)
    if settings.interaction == "direct":
        try:
            found = solve_directly(coupling, track, progress)
        except ArithmeticError as error:
            remedy = "Give a smaller one"
            raise InputError("time_step", settings.time_step, f"{error}", remedy) from None
        passes = start, found.added
        return Crossing(
            train, deck, track, settings, passes, (), None, 1, found.coupling, {1: found.state}
        )
    found = iterate(coupling, progress)
    if _needs_windows(found, settings):
        return _in_windows(train, deck, track, settings, coupling, progress)
    run = Crossing(
        train, deck, track, settings, found.passes, found.changes, found.converged,
        len(found.changes), coupling, found.states,
    )  # fmt: skip
    if settings.iterations is None and not found.converged:
        raise NotConvergedError(run)
    return run


def _needs_windows(found: FixedPoint, settings: Settings) -> bool:
    """Whether passes over the whole record have grown, or were many and yet too few.

    Who gives a number of passes or a relaxation, or allows a few passes only, means them.
    """
    if found.converged or settings.iterations is not None or settings.relaxation is not None:
        return False
    return grows(found.changes) or settings.max_iterations > FEW


def _in_windows(
    train: AnyTrain,
    deck: Deck,
    track: Track,
    settings: Settings,
    coupling: Coupling,
    progress: Callable[[str], None] | None,
) -> Crossing:
    """Compute a crossing whose passes over the whole record grow or fall too slowly."""
    found = in_windows(coupling, progress)
    passes = coupling.nothing_added(), coupling.train_pass(found.state)
    changes = (float(found.changes.max()),)
    return Crossing(
        train, deck, track, settings, passes, changes, True, 1, coupling, {1: found.state}, found
    )
