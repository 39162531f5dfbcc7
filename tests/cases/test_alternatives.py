"""Keys of which only one can be given: which cannot stand together is said, and what to do."""

import pytest

import railbridge as rb

BEAM = {
    "length": 20.0, "bending_stiffness_vertical": 2e10, "mass": 12e3, "modes": 4,
    "damping": {"modal": 0.01},
}  # fmt: skip
RATES = {"ratio": 0.01, "frequencies_hz": [3.0, 9.0]}
PER_MODE = {"per_mode": [0.01] * 4}
WAVE = {"kind": "harmonic", "amplitude": 1e-3, "wavelength": 10.0}


@pytest.mark.parametrize(
    ("path", "given", "said"),
    [
        ("deck.damping", PER_MODE | {"modal": 0.01},
         "deck.damping.per_mode = [0.01, 0.01, 0.01, 0.01]: cannot stand beside modal. Remove one"),
        ("deck.damping", {"beta": 1e-3, "modal": 0.01},
         "deck.damping.beta = 0.001: cannot stand beside modal"),
        ("deck.damping", PER_MODE | {"alpha": 0.1, "beta": 0.01},
         "deck.damping.alpha = 0.1: cannot stand beside per_mode"),
        ("deck.damping", RATES | {"modal": 0.01},
         "deck.damping.ratio = 0.01: cannot stand beside modal"),
        ("deck.damping", RATES | {"alpha": 0.1},
         "deck.damping.ratio = 0.01: cannot stand beside alpha"),
        ("deck.damping", {"modal": 0.01, "rate": 0.1}, "deck.damping.rate: unknown key"),
        ("deck", BEAM | {"box": {}},
         "deck.bending_stiffness_vertical = 20000000000.0: cannot stand beside box"),
        ("deck", BEAM | {"mesh": {}},
         "deck.mesh = {}: cannot stand beside bending_stiffness_vertical and mass"),
        ("deck", BEAM | {"modes": {"file": "x"}},
         "deck.length = 20.0: cannot stand beside a table of modes"),
        ("deck", BEAM | {"axis": {}}, "deck.axis: unknown key"),
        ("train", {"vehicle": "xia2000", "cars": 2, "axles": [0.0], "loads": [1e5]},
         "train.vehicle = 'xia2000': cannot stand beside axles and loads"),
        ("train", {"axles": [0.0], "loads": [1e5], "cars": 3},
         "train.cars = 3: cannot stand beside axles and loads"),
        ("track", {"vertical": WAVE | {"left": {"kind": "none"}}},
         "track.vertical.kind = 'harmonic': cannot stand beside left"),
        ("track", {"vertical": WAVE | {"seed": 1}},
         "track.vertical.seed = 1: belongs to kind = 'random', and this is kind = 'harmonic'"),
        ("track", {"vertical": WAVE | {"half_wave": 1}}, "track.vertical.half_wave: unknown key"),
    ],
)  # fmt: skip
def test_what_cannot_stand_together_is_said(path, given, said):
    content = {"deck": BEAM, "train": {"name": "ICE2"}, "run": {"speed": 40.0}}
    with pytest.raises(rb.InputError) as caught:
        rb.case(content | {path: given} if "." not in path else content | {
            "deck": BEAM | {path.partition(".")[2]: given},
        })  # fmt: skip
    assert str(caught.value).startswith(said)


def test_of_a_deck_file_too():
    deck = {"file": "viaduct36", "damping": PER_MODE | {"modal": 0.01}}
    with pytest.raises(rb.InputError, match="per_mode = .* cannot stand beside modal"):
        rb.case({"deck": deck, "train": {"name": "ICE2"}, "run": {"speed": 40.0}})
