"""The numbers that the paper prints, and one that follows from them.

Amaral & Mazzilli, "The Influence of Deck Flexibility on the Dynamic Response of Railway Bridges",
Revista Sul-Americana de Engenharia Estrutural 13(3), 2016.
"""

from __future__ import annotations

__all__ = [
    "DAMPING", "FORCING", "MASS", "SPAN", "SPEED", "TABLE2_DECK", "TABLE2_VEHICLE", "TABLE3",
    "TABLE4",
]  # fmt: skip

SPEED = 20.0
"""Speed of the train, m/s."""

SPAN = 36.0
"""Length of the deck, m."""

DAMPING = (0.03, (3.307, 16.30))
"""Rayleigh damping of the deck: the ratio, and the two frequencies (Hz) that have it."""

TABLE2_VEHICLE = (
    0.645, 1.215, 1.230, 1.334, 1.667,
    9.044, 9.055, 11.72, 11.72, 15.48,
    15.48, 21.96, 21.96, 24.99, 24.99,
)  # fmt: skip
"""Natural frequencies of the vehicle, Hz."""

TABLE2_DECK = (
    3.307, 10.46, 10.56, 14.97, 16.30,
    16.73, 17.41, 17.67, 18.16, 18.48,
    18.83, 20.00, 21.60, 21.97, 22.62,
)  # fmt: skip
"""Natural frequencies of the deck's shell model, Hz. The modes have no names in print."""

TABLE3 = {
    "from_rigid": (1.934, 1.883, 1.911, 1.911),
    "from_previous": (1.934, -0.051, 0.028, -0.001),
}
"""Deviations of iterations 1 to 4, percent."""

TABLE4 = {
    "Torsion moment": ("kN m", -1222.52, -1256.62),
    "Horizontal bending moment": ("kN m", -64.04, -64.04),
    "Vertical bending moment": ("kN m", -24912.90, -24831.80),
    "Vertical displacement": ("mm", -38.13, -38.01),
    "Y-reaction in node 1": ("kN", 7.83, 7.83),
    "Y-reaction in node 2": ("kN", -8.80, -8.80),
    "Z-reaction in node 1": ("kN", 2851.86, 2857.16),
    "Z-reaction in node 2": ("kN", 2884.38, 2890.30),
}
"""Results for the structural model: unit (inferred), iteration 0, iteration 4.

Self-weight is included."""

FORCING = {5.0: 1.33, 11.7: 3.31}
"""Frequency of the forcing, Hz, for a number n of half-waves (Section 3)."""

MASS = 12000.0
"""Mass of the deck per metre that Table 4's self-weight asks for, kg/m, within about 10 %.

Not printed: it follows from what is printed."""
