"""The receipt: digests of all inputs, versions, and choices."""

import hashlib
import json
import platform
import shutil
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

import railbridge as rb
from railbridge.reports.receipts import (
    choices,
    damping_in_words,
    input_files,
    inputs,
    names_only,
    programs,
)

DATA = Path(rb.data_root())


def rows(table):
    return {row[0]: row[1:] for row in table.rows}


def test_every_file_that_a_case_refers_to_is_there_once():
    content = {
        "deck": {"file": "viaduct36"},
        "train": {"cars": ["xia2000", {"vehicle": "manchester", "count": 2}, "xia2000"]},
        "track": {
            "vertical": [{"kind": "random", "spectrum": "german-low"}, {"kind": "none"}],
            "lateral": {"left": {"kind": "file", "file": str(DATA / "tracks/example_record.csv")}},
        },
        "trains": {"ICE2": {"name": "ICE2"}, "b": {"name": "HSLM-A1"}},
    }
    found = [(role, path.name) for role, path in input_files(content)]
    assert found == [
        ("deck", "viaduct36.toml"), ("vehicle", "xia2000.csv"), ("vehicle", "manchester.toml"),
        ("train ICE2", "ICE2.csv"), ("spectrum", "german-low.toml"),
        ("track", "example_record.csv"),
    ]  # fmt: skip


def test_files_of_another_programs_modes_count(tmp_path):
    source = DATA / "exchange/viaduct36_mm"
    deck = next(source.glob("*.toml"), None)
    if deck is None:
        names = {p.stem.split("_")[-1]: p for p in source.iterdir()}
        pytest.skip(f"no deck file among {sorted(names)}")
    shutil.copytree(source, tmp_path / "deck")
    found = dict(input_files({"deck": {"file": str(tmp_path / "deck" / deck.name)}}))
    assert {"deck", "deck, nodes", "deck, modes"} <= found.keys()


def test_a_digest_is_that_of_the_file_and_follows_its_content(tmp_path):
    deck, car = tmp_path / "my_deck.toml", tmp_path / "car.csv"
    shutil.copy(DATA / "decks/viaduct36.toml", deck)
    shutil.copy(DATA / "vehicles/xia2000.csv", car)
    content = {"deck": {"file": str(deck)}, "train": {"vehicle": str(car), "cars": 2}}
    before = rows(inputs(content))
    known = deck.read_bytes()
    assert before["deck"] == ("my_deck.toml", len(known), hashlib.sha256(known).hexdigest())
    text = json.dumps(names_only(content), sort_keys=True)
    assert before["tables of the case"][2] == hashlib.sha256(text.encode()).hexdigest()
    deck.write_bytes(known + b"# one more line\n")
    after = rows(inputs(content))
    assert after["deck"] != before["deck"] and after["vehicle"] == before["vehicle"]
    other = rows(inputs({**content, "train": {"vehicle": str(car), "cars": 3}}))
    assert other["tables of the case"] != after["tables of the case"]


def test_where_a_file_lies_is_no_input(tmp_path):
    digests = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        deck = tmp_path / name / "deck.toml"
        shutil.copy(DATA / "decks/viaduct36.toml", deck)
        digests.append(inputs({"deck": {"file": str(deck)}}).rows)
    assert digests[0] == digests[1]
    given = {"a": ["deck/none.toml", str(deck)], "b": (1, "word")}
    assert names_only(given) == {"a": ["deck/none.toml", "deck.toml"], "b": [1, "word"]}


def test_a_file_that_has_gone_is_left_out(tmp_path):
    content = {"deck": {"file": str(tmp_path / "gone.toml")}, "train": {"name": "HSLM-A1"}}
    assert input_files(content) == []


def test_programs_have_their_versions():
    found = rows(programs())
    assert found["railbridge"] == (rb.__version__,)
    assert found["Python"] == (platform.python_version(),)
    assert found["numpy"] == (np.__version__,) and found["scipy"] == (version("scipy"),)


def test_choices_of_a_run(quick):
    case, run = quick
    found = rows(choices(run.settings, case.deck, case.content, run))
    assert found["speed"] == ("40 m/s, 144 km/h",) and found["time step"] == ("0.004 s",)
    assert found["interaction"] == ("iterate, chosen by the program",)
    assert found["tolerance"] == ("0.001, of forces",) and found["converged"] == ("yes",)
    assert found["passes after the rigid deck"][0].startswith(f"{run.iterations}, last change")
    assert found["modes of the deck"][0].startswith("3, up to ")
    assert "random track" not in found


def test_seed_and_spectrum_of_a_random_track(quick):
    case, _ = quick
    wave = {"kind": "random", "spectrum": "german-low", "seed": 11, "band": [6.0, 60.0]}
    found = rows(choices(case.settings, case.deck, {"track": {"vertical": wave}}))
    assert found["random track"] == ("german-low, seed 11, waves of 6 to 60 m",)
    assert found["time step"] == ("0.004 s (at the first speed)",) and "speed" not in found


def test_damping_in_words(quick):
    assert damping_in_words(quick[0].deck) == "2 % of critical, by mode"
    assert "beta = 4.87e-4 s" in damping_in_words(rb.deck("viaduct36"))
