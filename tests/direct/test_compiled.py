"""The compiled loop gives what the loop in NumPy gives, to the last digits."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import railbridge as rb
from railbridge.contacts.wheelsets import Wheelset, on_wheelsets
from railbridge.coupling import prepare
from railbridge.direct.plans import plan
from railbridge.direct.stepping import march
from railbridge.settings import check

compiled = pytest.importorskip("railbridge.direct.compiled", reason="needs the extra `fast`")

HELPERS = Path(rb.__file__).parents[1]
DECK = rb.deck("viaduct36")
CAR = rb.vehicle("xia2000")
LIGHT = rb.planar_car(CAR)
TRACK = rb.Track(
    vertical=rb.Harmonic(5e-3, wavelength=14.4),
    lateral=rb.Harmonic(2e-3, wavelength=7.0, phase=1.0),
)
SHORT = rb.Track(vertical=rb.Harmonic(4.5e-3, wavelength=2.5))


def both(train, track, deck=DECK, **options):
    chosen = {"speed": 50.0, "track_offset": 2.4, "time_step": 2e-3, "tail": 0.1, "lead_in": 60.0}
    settings = check(train, deck, track, **(chosen | options))
    steps = plan(
        prepare(train, deck, track, settings), track if settings.contact == "hertz" else None
    )
    return march(steps), compiled.march(steps)


def apart(pair):
    numpy, fast = pair
    parts = [(getattr(numpy, n), getattr(fast, n)) for n in ("q", "velocity", "force")]
    parts += list(zip(numpy.more, fast.more, strict=True))
    return max(np.max(np.abs(a - b)) / np.max(np.abs(a)) for a, b in parts)


@pytest.mark.parametrize("feedback", ["all", "vertical"])
@pytest.mark.parametrize("loads", ["wheels", "bogies", "condensed"])
def test_permanent_contact(loads, feedback):
    train = rb.Train(CAR, cars=3)
    assert apart(both(train, TRACK, loads=loads, feedback=feedback)) < 1e-12


def test_cars_of_several_kinds_and_wheels():
    train = rb.Train([CAR, LIGHT, rb.with_wheelsets(LIGHT, mass=1500.0)], car_spacing=23.3)
    assert apart(both(train, TRACK)) < 1e-12


def test_a_deck_whose_ends_move_and_that_is_overdamped():
    content = {
        "length": 20.0, "bending_stiffness_vertical": 5e9, "mass": 8000.0, "modes": 9,
        "damping": {"ratio": 0.05, "frequencies_hz": [3.0, 9.0]},
        "bearing": [
            {"x": x, "fixed": "x y roll", "stiffness": {"z": 5e8}} for x in (0.0, 20.0)
        ],
    }  # fmt: skip
    deck = rb.deck_from_table("elastic", content)
    assert apart(both(rb.Train(LIGHT, cars=2), TRACK, deck, track_offset=0.0)) < 1e-12


def test_modes_that_move_in_several_components():
    content = {
        "length": 30.0, "bending_stiffness_vertical": 4e10, "bending_stiffness_lateral": 8e10,
        "torsional_stiffness": 2e10, "polar_inertia": 3e4, "mass": 1e4, "modes": 9,
        "damping": {"modal": 0.02}, "centroid_height": 0.8,
        "bearing": [{"x": x, "z": -1.2, "fixed": "y z roll"} for x in (0.0, 30.0)],
    }  # fmt: skip
    deck = rb.deck_from_table("coupled", content)
    moves = np.any(deck.shapes.coefficients != 0.0, axis=(0, 1))
    assert moves.sum(axis=1).max() > 1
    assert apart(both(rb.Train(CAR, cars=2), TRACK, deck)) < 1e-12


def test_hertzian_contacts_that_part():
    train = rb.Train(rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=900.0), cars=2)
    pair = both(train, SHORT, contact="hertz", speed=60.0, time_step=1e-3)
    assert apart(pair) < 1e-11
    static = train.wheels[0].static_load
    run = rb.cross(
        train, DECK, SHORT, speed=60.0, time_step=1e-3, track_offset=2.4, contact="hertz",
        tail=0.1, lead_in=60.0,
    )  # fmt: skip
    assert run.parted.any() and run.wheel_forces[:, 1].max() < 1e-6 * static


def test_hertzian_contacts_of_cars_with_several_numbers_of_wheels():
    # The wheels that the smaller car does not have must not stand on springs of no stiffness.
    trolley = rb.Body("trolley", 20e3, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    above = rb.Spring("trolley", "wheelset", (0.0, 0.0, 0.5), (0.0, 1e6), (0.0, 2e4))
    below = Wheelset("wheelset", 0.0, 1500.0, gauge=0.0, contact_stiffness=(0.0, 6e8))
    small = on_wheelsets("trolley", [trolley], [above], [below])
    large = rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=900.0)
    for cars in ([small, large], [large, small, large]):
        train = rb.Train(cars, car_spacing=24.0)
        pair = both(train, SHORT, contact="hertz", speed=60.0, time_step=1e-3)
        assert all(
            more.shape[0] == len(car.contacts) for more, car in zip(pair[1].more, cars, strict=True)
        )
        assert apart(pair) < 1e-11


def test_a_contact_force_that_is_no_number_is_refused():
    train = rb.Train(rb.with_wheelsets(LIGHT, mass=1500.0))
    settings = check(train, DECK, SHORT, speed=50.0, contact="hertz", lead_in=0.0)
    steps = plan(prepare(train, DECK, SHORT, settings), SHORT)
    steps.rail[0][1, 5:] = np.nan
    for loop in (march, compiled.march):
        with pytest.raises(ArithmeticError, match="does not settle"):
            loop(steps)


def test_a_compiler_that_can_keep_nothing_compiles_all_the_same(tmp_path):
    # Files stand where both caches would make their folders, as on a disk that is read only.
    package = tmp_path / "railbridge"
    shutil.copytree(HELPERS / "railbridge", package, ignore=shutil.ignore_patterns("__pycache__"))
    (package / "direct" / "__pycache__").touch()
    code = "from railbridge.direct import compiled; print(compiled.__file__)"
    kept = {n: v for n, v in os.environ.items() if not n.startswith("NUMBA_")}
    nowhere = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "LOCALAPPDATA"), os.devnull)
    environment = kept | nowhere | {"PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
    )
    assert done.stdout.strip() == str(package / "direct" / "compiled.py"), done.stderr


def test_a_compiler_that_does_not_load_is_done_without(monkeypatch):
    train, options = rb.Train(LIGHT), {"speed": 50.0, "interaction": "direct", "lead_in": 0.0}
    expected = rb.cross(train, DECK, TRACK, **options)
    monkeypatch.setitem(sys.modules, "railbridge.direct.compiled", None)
    monkeypatch.delattr(sys.modules["railbridge.direct"], "compiled")
    found = rb.cross(train, DECK, TRACK, **options)
    size = np.abs(expected.state.q).max()
    assert found.state.q == pytest.approx(expected.state.q, abs=1e-12 * size)


_OWN_FILES = (
    "import numpy as np; from railbridge.direct import compiled; a = np.eye(2); "
    "compiled._make_ready(lambda: compiled._solve(2.0 * a, a, 2)); print(a[0, 0])"
)


@pytest.mark.parametrize("damaged", ["*.nbi", "*.nbc"])
def test_a_cache_that_is_damaged_is_made_anew(tmp_path, damaged):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(HELPERS)}

    def solved():
        return subprocess.run(
            [sys.executable, "-c", _OWN_FILES], env=environment, capture_output=True, text=True,
            check=False,
        )  # fmt: skip

    assert solved().stdout.strip() == "0.5"
    files = list(tmp_path.rglob(damaged))
    assert files
    for file in files:
        file.write_bytes(b"garbage")
    done = solved()
    assert done.stdout.strip() == "0.5", done.stderr
    # The index does not name what is damaged any more, so that the next one can keep its own.
    assert solved().stdout.strip() == "0.5"
    assert all(file.read_bytes() != b"garbage" for file in tmp_path.rglob("*.nbi"))


def test_a_long_wait_for_the_compiler_is_told_of_once_and_a_short_one_is_not(monkeypatch, capsys):
    with compiled._said():
        pass
    assert not capsys.readouterr().err
    monkeypatch.setattr(compiled, "_PATIENCE", 0.01)
    with compiled._said():
        time.sleep(0.3)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1 and lines[0].startswith("railbridge: compiling the loop")


@pytest.mark.parametrize("contact", ["permanent", "hertz"])
def test_the_loop_tells_how_far_it_is_and_can_be_stopped(contact):
    class Stopped(Exception):
        pass

    told = []

    def stop(text):
        told.append(text)
        if len(told) == 3:
            raise Stopped

    train = rb.Train(rb.with_wheelsets(LIGHT, mass=1500.0))
    options = {"speed": 50.0, "contact": contact, "lead_in": 0.0, "interaction": "direct"}
    with pytest.raises(Stopped):
        rb.cross(train, DECK, TRACK, progress=stop, **options)
    assert told[0] != told[1] and all(text.startswith("step ") for text in told)
    # A loop that was stopped leaves nothing behind for the next.
    one, other = (rb.cross(train, DECK, TRACK, **options).state.q for _ in range(2))
    assert np.array_equal(one, other)
