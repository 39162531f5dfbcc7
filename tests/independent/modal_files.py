"""The example of another program's modes: read, spoiled and compared."""

import numpy as np

import railbridge as rb
from railbridge import exchange
from railbridge.cases.shelf import data_root

EXAMPLE = data_root() / "exchange" / "viaduct36_mm"
X = np.linspace(0.0, 36.0, 721)


def read(folder, masses=True, **options):
    files = [
        folder / f"{name}.csv"
        for name in (("nodes", "modes", "masses") if masses else ("nodes", "modes"))
    ]
    return exchange.read_modes(*files, **options)


def change(path, edit):
    """Apply a function to the lines of a file."""
    path.write_text(
        "\n".join(edit(path.read_text(encoding="utf-8").splitlines())) + "\n", encoding="utf-8"
    )


def cells(line, index, value):
    row = line.split(",")
    row[index] = value
    return ",".join(row)


def differ(a, b):
    """Largest difference between the shapes of two decks, against the largest value of each.

    By component.
    """
    a, b = a.shapes(X), b.shapes(X)
    return np.abs(a - b).max(axis=(0, 1)) / np.abs(a).max(axis=(0, 1))


def crossing(deck, **options):
    track = rb.Track(
        vertical=rb.Harmonic(5e-3, wavelength=14.4), lateral=rb.Harmonic(2e-3, wavelength=14.4)
    )
    train = rb.Train(rb.vehicle("xia2000"), cars=2)
    return rb.cross(
        train,
        deck,
        track,
        speed=20.0,
        track_offset="left",
        time_step=2e-3,
        lead_in=0.0,
        **{"iterations": 3, **options},
    )
