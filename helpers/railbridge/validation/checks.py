"""One line that compares a number with a reference, and fails where it must not differ."""

from __future__ import annotations

__all__ = ["compared"]


def compared(
    name: str, value: float, reference: float, unit: str = "", *, limit: float, source: str = "paper", digits: int = 4
) -> str:
    """Return ``name   value unit   source reference unit   limit % ok``, rounded well above numerical noise.

    Parameters
    ----------
    name : str
        What is compared.
    value, reference : float
        In `unit`.
    unit : str
    limit : float
        Allowed difference, percent of the reference.
    source : str
        Where the reference comes from: ``paper``, ``closed form``, ``by hand``.
    digits : int
        Significant digits shown.

    Raises
    ------
    AssertionError
        The difference exceeds the limit, or is not a number.
    """
    difference = abs(value - reference) / abs(reference) * 100.0
    shown = [f"{v:#.{digits}g}".rstrip(".") + (f" {unit}" if unit else "") for v in (value, reference)]
    line = f"{name:<30} {shown[0]:>15}   {source} {shown[1]:>15}   limit {limit:g} %"
    if not difference <= limit:
        raise AssertionError(f"{line}   differs by {difference:.3g} %")
    return f"{line}   ok"
