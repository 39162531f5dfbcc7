"""A plain box of 36 m for tests: upright webs, even plates."""

import railbridge as rb

PLAIN = {
    "slab_width": 9.6, "slab_thickness": 0.25, "depth": 2.0, "web_thickness": 0.35,
    "web_spacing": 5.0, "bottom_thickness": 0.2, "youngs_modulus": 34e9,
}  # fmt: skip


def box(**changes):
    return rb.Box("test", (36.0,), **(PLAIN | changes))
