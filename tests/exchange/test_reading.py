"""Only regular files of sane size are read, and nothing is said of what a foreign file holds."""

import os
import subprocess
import sys
import time
import tomllib

import pytest

import railbridge as rb
from railbridge.cases import shelf, tables
from railbridge.errors import InputError
from railbridge.exchange import reading
from railbridge.exchange.tables import read_columns

SECRET = "root:$6$hunter2:19000:0:99999:7:::\ndaemon:*:19000:0:99999:7:::\n"


def test_text_comes_as_it_stands_but_for_the_byte_order_mark(tmp_path):
    """A name between quotes may hold a line end, and comes back as it was written."""
    path = tmp_path / "a.csv"
    path.write_bytes("\ufeffä\r\nb\n".encode())
    assert reading.read_text(path) == "ä\r\nb\n"


def within_seconds(door, seconds=20, memory=3_000_000_000):
    """What a line of Python says of a refusal, in a process that may not grow without end."""

    import resource  # Unix only

    def bounded():
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))

    program = (
        f"import railbridge as rb\ntry:\n    {door}\nexcept rb.InputError as error:\n"
        "    print(error)"
    )
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=seconds,
        preexec_fn=bounded, env=environment,
    )  # fmt: skip
    assert done.stderr == ""
    return done.stdout


@pytest.mark.skipif(os.name == "nt", reason="devices and pipes are files there, too")
@pytest.mark.parametrize("kind", ["zeros", "pipe", "folder"])
@pytest.mark.parametrize("suffix", ["csv", "toml"])
def test_devices_pipes_and_folders_are_refused_at_every_door(tmp_path, kind, suffix):
    odd = tmp_path / f"odd.{suffix}"
    if kind == "zeros":
        odd.symlink_to("/dev/zero")
    elif kind == "pipe":
        os.mkfifo(odd)
    else:
        odd.mkdir()
    good = tmp_path / "deck.toml"
    good.write_text(f'[modes]\nnodes = "{odd}"\nmodes = "modes.csv"\n')
    doors = {
        "csv": [f"rb.vehicle('{odd}')", f"rb.deck('{good}')", f"rb.exchange.read_nodes('{odd}')"],
        "toml": [f"rb.vehicle('{odd}')", f"rb.deck('{odd}')", f"rb.case('{odd}')"],
    }[suffix]
    for door in doors:
        assert "must be a regular file, not a folder, a device or a pipe" in within_seconds(door)


def test_a_file_that_would_not_fit_into_memory_is_refused(tmp_path):
    path = tmp_path / "large.csv"
    with path.open("wb") as file:
        file.truncate(20_000_000_000)  # takes no room on the disk
    start = time.monotonic()
    with pytest.raises(InputError, match=r"^path = 'large.csv': is too large, must be at most"):
        read_columns(path, ["node"])
    with (tmp_path / "large.toml").open("wb") as file:
        file.truncate(20_000_000_000)
    with pytest.raises(InputError, match=r"^large.toml: is too large"):
        shelf.read_toml(tmp_path / "large.toml")
    assert time.monotonic() - start < 5.0


@pytest.mark.skipif(not os.path.exists("/proc/kallsyms"), reason="needs Linux")
def test_a_file_that_hides_its_size_is_bounded_all_the_same():
    with pytest.raises(InputError, match="too large"):
        reading.read_text("/proc/kallsyms", largest=1000)


@pytest.mark.parametrize("name", ["x" * 5000 + ".csv", "a\0b.csv"])
def test_names_that_no_file_system_has(tmp_path, name):
    with pytest.raises(InputError, match="cannot be read|no such file"):
        read_columns(tmp_path / name, ["node"])
    content = {"modes": {"nodes": str(tmp_path / name), "modes": "m.csv"}}
    case = {"deck": content, "train": {"vehicle": "xia2000"}, "run": {"speed": 20.0}}
    with pytest.raises(InputError, match=r"^deck\.modes\.nodes = "):
        rb.Case(case)


def shown(door, *arguments):
    with pytest.raises(InputError) as error:
        door(*arguments)
    return str(error.value)


def test_nothing_is_said_of_what_a_foreign_file_holds(tmp_path):
    for name in ("shadow.csv", "shadow.toml", "shadow"):
        (tmp_path / name).write_text(SECRET)
    shadow = tmp_path / "shadow"
    told = [
        shown(rb.exchange.read_nodes, shadow),
        shown(rb.vehicle, tmp_path / "shadow.csv"),
        shown(rb.vehicle, tmp_path / "shadow.toml"),
        shown(rb.case, tmp_path / "shadow.toml"),
        shown(rb.deck_from_table, "mine", {"modes": {"nodes": str(shadow), "modes": "m"}}),
    ]
    for line in told:
        assert not any(word in line for word in ("root", "hunter2", "19000", "daemon"))
    assert "shadow: header: has none of the columns" in told[0]


@pytest.mark.parametrize(
    "text",
    [
        'password = "hunter2"\n',
        "[hunter2]\na = 1\n[hunter2]\n",
        "hunter2 = 1\nhunter2 = 2\n",
        "a.hunter2 = 1\na.hunter2.b = 2\n",
        "a = {hunter2 = 1, hunter2 = 2}\n",
        "a = hunter2\n",
    ],
)
def test_nothing_is_said_of_a_foreign_toml_file(tmp_path, text):
    path = tmp_path / "config.toml"
    path.write_text(text)
    for door in (rb.vehicle, rb.deck, rb.box, rb.case):
        line = shown(door, path)
        assert line.startswith("config.toml: ")
        assert "hunter2" not in line and "password" not in line


def test_keys_that_tell_a_file_are_those_of_the_shipped_ones():
    """Whoever mistypes one key of a file of the right kind is still told which."""
    for kind, known in [
        ("decks", tables.DECK_KEYS),
        ("cases", tables.CASE.model_fields),
        ("vehicles", tables.VEHICLE.model_fields),
    ]:
        for name in shelf.data_names(kind, ".toml"):
            path = shelf.data_file(kind, name, ".toml")
            content = shelf.read_toml(path, known)
            assert content == tomllib.loads(path.read_text(encoding="utf-8"))


def tables_of(tmp_path, nodes, rows):
    (tmp_path / "nodes.csv").write_text(
        "# units: m, kg\nnode,x,y,z\n" + "".join(f"{i},{i},0,0\n" for i in range(nodes))
    )
    (tmp_path / "modes.csv").write_text("mode,frequency_hz,node,ux,uy,uz\n" + "".join(rows))
    return tmp_path / "nodes.csv", tmp_path / "modes.csv"


def test_shapes_that_would_not_fit_into_memory_are_refused(tmp_path):
    """Both files are small; the table of all modes at all nodes would be 30 GB."""
    files = tables_of(tmp_path, 40_000, (f"{m},{m + 1},0,0,0,1\n" for m in range(4000)))
    with pytest.raises(InputError, match=r"modes: 4000 modes at 40000 nodes .* limit is 2 GB"):
        rb.exchange.read_modes(*files)


def test_a_node_given_twice_or_missing_is_found_without_waiting(tmp_path):
    count = 100_000
    rows = [f"1,3.0,{i},0,0,1\n" for i in range(count)]
    start = time.monotonic()
    with pytest.raises(InputError, match=f"node = '{count - 1}': is given twice"):
        rb.exchange.read_modes(*tables_of(tmp_path, count, [*rows, f"1,3.0,{count - 1},0,0,1\n"]))
    with pytest.raises(InputError, match="mode 2: lacks 99999 of the nodes"):
        rb.exchange.read_modes(*tables_of(tmp_path, count, [*rows, "2,4.0,5,0,0,1\n"]))
    assert time.monotonic() - start < 20.0
