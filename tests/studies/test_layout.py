"""What is sent to another process comes back laid out as it went.

Products of arrays in another order of memory differ in the last digit on some processors, and a
study in several processes gives the same bits as one in one.
"""

import pickle
from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies import outputs_at

CONTINUOUS = {
    "spans": [20.0, 25.0], "bending_stiffness_vertical": 6e10, "bending_stiffness_lateral": 4e11,
    "torsional_stiffness": 5e10, "polar_inertia": 6e4, "mass": 11e3, "modes": 8,
    "damping": {"ratio": 0.02, "frequencies_hz": [4.0, 16.0]},
}  # fmt: skip


def differing(sent, back, path, seen):
    """Give paths of arrays whose two copies are laid out differently."""
    if id(sent) in seen:
        return
    seen.add(id(sent))
    if isinstance(sent, np.ndarray):
        long = [i for i, n in enumerate(sent.shape) if n > 1]
        if sent.size and any(sent.strides[i] != back.strides[i] for i in long):
            yield path
    elif isinstance(sent, dict):
        for key in sent:
            yield from differing(sent[key], back[key], f"{path}[{key}]", seen)
    elif isinstance(sent, (list, tuple)):
        for i, (a, b) in enumerate(zip(sent, back, strict=True)):
            yield from differing(a, b, f"{path}[{i}]", seen)
    elif hasattr(sent, "__dict__") and not isinstance(sent, type):
        for name in vars(sent).keys() & vars(back).keys():
            own = getattr(sent, name), vars(back)[name]
            yield from differing(*own, f"{path}.{name}", seen)


def _deck(name):
    if name == "continuous":
        return rb.deck_from_table(name, CONTINUOUS)
    deck = rb.deck("viaduct36")
    rail = rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
    return replace(deck, rail=rail) if name == "rail" else deck


@pytest.mark.parametrize("deck", ["viaduct36", "continuous", "rail"])
@pytest.mark.parametrize("vehicle", ["xia2000", "xia2000_wheelsets"])
def test_decks_and_trains_that_have_been_used(deck, vehicle):
    deck, train = _deck(deck), rb.Train(rb.vehicle(vehicle), cars=2, car_spacing=22.5)
    track = rb.Track(vertical=rb.Harmonic(1e-3, wavelength=10.0))
    run = rb.cross(train, deck, track, speed=30.0, tail=0.1, iterations=1)
    # What they have worked out is kept, and sent along.
    run.displacement(5.0), run.section_forces(5.0), run.reactions(), run.body_accelerations
    outputs = outputs_at(deck, ("acceleration_z", "displacement_z", "moment_vertical"), [5.0])
    used = {"deck": deck, "train": train, "settings": run.settings, "outputs": outputs}
    for name, sent in used.items():
        assert not list(differing(sent, pickle.loads(pickle.dumps(sent)), name, set()))
