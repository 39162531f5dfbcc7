"""A car on the nodes of another program's deck, whose answers come from OpenSeesPy."""

import numpy as np

import railbridge as rb
from railbridge import exchange
from railbridge.cases.shelf import data_root

NODES = exchange.read_nodes(data_root() / "exchange" / "viaduct36_mm" / "nodes.csv")
AXIS = NODES.line({"y": 0.0, "z": 0.0})
ARM = NODES.line({"y": 3.38, "z": 1.3}, {"y": 0.0, "z": 0.0})
PAIR = NODES.line(
    {"left": {"y": 3.38, "z": 1.3}, "right": {"y": 1.42, "z": 1.3}}, {"y": 0.0, "z": 0.0}
)
TRACK = rb.Track(
    vertical=rb.Harmonic(5e-3, wavelength=14.4), lateral=rb.Harmonic(2e-3, wavelength=14.4)
)
TRAIN = rb.Train(rb.vehicle("xia2000"), cars=1)
OPTIONS = {"speed": 20.0, "track_offset": 2.4, "time_step": 2e-3, "tail": 0.2, "lead_in": 0.0}


def answer(deck, loads):
    """What OpenSeesPy, in N, mm, t, s, answers to loads on the axis nodes.

    mm and rad, shape (3, nodes, t).
    """
    return deck.respond(loads.time, list(loads.functions()))


def line_of(elements):
    """Return nodes at equal distances along the axis, in mm."""
    places = np.zeros((elements + 1, 3))
    places[:, 0] = np.linspace(0.0, 36.0, elements + 1)
    return exchange.Nodes(
        tuple(str(i + 1) for i in range(elements + 1)), places, ("mm", "t")
    ).line()


def rms(values):
    return np.sqrt(np.mean(np.square(values)))
