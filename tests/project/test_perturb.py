"""The tool that moves every number of the data moves all of them, and nothing else."""

import random
import tomllib
from pathlib import Path

import perturb
import railbridge as rb

DATA = Path(__file__).resolve().parents[2] / "data"


def floats(value):
    if isinstance(value, dict):
        return [f for v in value.values() for f in floats(v)]
    if isinstance(value, list):
        return [f for v in value for f in floats(v)]
    return [value]


def test_every_float_of_a_toml_file_moves_and_nothing_else():
    text = (DATA / "decks" / "viaduct36.toml").read_text(encoding="utf-8")
    before, after = (
        floats(tomllib.loads(t)) for t in (text, perturb.perturbed(text, True, random.Random(0)))
    )
    moved = 0
    for a, b in zip(before, after, strict=True):
        if isinstance(a, float) and a != 0.0:
            assert a != b
            assert abs(b / a - 1) < 1.1e-10
            moved += 1
        else:
            assert a == b
    assert moved >= 12


def test_a_moved_copy_is_what_the_package_reads(tmp_path, monkeypatch):
    exact = rb.vehicle("xia2000").modes().frequencies_hz
    perturb.perturb(DATA, tmp_path / "data")
    monkeypatch.setenv("RAILBRIDGE_DATA", str(tmp_path / "data"))
    moved = rb.vehicle("xia2000").modes().frequencies_hz
    assert 0.0 < max(abs(moved / exact - 1)) < 1e-9
    assert rb.deck("viaduct36").supports == (0.0, rb.deck("viaduct36").length)
