"""The reference wagons of EN 15528, by which lines are classified."""

from __future__ import annotations

from .. import errors
from ..errors import Range
from ..trains import AxleTrain
from ..units import G

__all__ = ["LINE_CATEGORIES", "WAGONS", "wagon_train"]

_IN_BOGIE, _OVERHANG = 1.8, 1.5
"""m, of all wagons: between the axles of a bogie; from a buffer to the next axle."""

LINE_CATEGORIES = {
    "A": (16e3, 6.20), "B1": (18e3, 7.80), "B2": (18e3, 4.65), "C2": (20e3, 5.90),
    "C3": (20e3, 4.50), "C4": (20e3, 3.40), "D2": (22.5e3, 7.45), "D3": (22.5e3, 5.90),
    "D4": (22.5e3, 4.65), "D5": (22.5e3, 3.62), "E4": (25e3, 5.90), "E5": (25e3, 4.75),
}  # fmt: skip
"""EN 15528:2021, Table A.1: mass on an axle, kg; distance of the two inner axles, m."""

WAGONS = Range(least=1, most=1000, whole=True)
"""How many wagons a train may have."""


def wagon_train(category: str, wagons: int = 20) -> AxleTrain:
    """Return a train of equal reference wagons of EN 15528:2021, Table A.1, buffer to buffer.

    Parameters
    ----------
    category : str
        Line category: ``A``, ``B1`` to ``E5``.
    wagons : int
        20 if not given, 200 to 290 m: longer than the influence line of any usual span. A line is
        classified by a train without end, so take more where the deck is longer.

    Returns
    -------
    AxleTrain
        Four axles a wagon. A force is the mass on the axle times g = 9.81 m/s2.

    Raises
    ------
    InputError
    """
    errors.text("category", category)
    mass, inner = LINE_CATEGORIES[errors.choice("category", category, LINE_CATEGORIES)]
    count = WAGONS.checked("wagons", wagons)
    own = (_IN_BOGIE, inner, _IN_BOGIE)
    spacings = [*own, *(2 * _OVERHANG, *own) * (count - 1)]
    name = f"{category}, {count} wagon{'s' * (count > 1)}"
    return AxleTrain.from_spacings(spacings, [mass * G] * (4 * count), name)
