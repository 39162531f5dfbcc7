"""Chunks computed here, in processes, on a cluster: the same bits, and nothing lost."""

import os
import signal
import time
from pathlib import Path

import numpy as np
import pytest

import railbridge as rb
from railbridge import studies
from railbridge.studies.chunks import completed, split


def square(numbers):
    return [n * n for n in numbers]


def kills_itself_once(argument):
    """End the process that computes it, the first time."""
    path, number = argument
    mark = Path(path) / f"{number}"
    if number == 2 and not mark.exists():
        mark.write_text("was here")
        os.kill(os.getpid(), signal.SIGKILL)
    return number * 10


def always_kills_itself(number):
    if number == 1:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def fails(number):
    raise ValueError(f"chunk {number}")


@pytest.mark.parametrize(
    ("count", "size", "lengths"), [(10, 4, [4, 4, 2]), (4, 4, [4]), (0, 4, []), (3, 10, [3])]
)
def test_points_are_cut_into_chunks(count, size, lengths):
    chunks = split(count, size)
    assert [len(chunk) for chunk in chunks] == lengths
    assert [i for chunk in chunks for i in chunk] == list(range(count))


@pytest.mark.parametrize("workers", [1, 2])
def test_each_chunk_comes_once_with_its_number(workers):
    chunks = [[i, i + 1] for i in range(7)]
    found = dict(completed(square, chunks, workers=workers))
    assert found == {i: [i * i, (i + 1) ** 2] for i in range(7)}


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL")
def test_a_worker_that_is_killed_loses_nothing(tmp_path):
    chunks = [(str(tmp_path), i) for i in range(6)]
    found = dict(completed(kills_itself_once, chunks, workers=2))
    assert found == {i: 10 * i for i in range(6)} and (tmp_path / "2").exists()


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL")
def test_a_chunk_that_always_kills_its_worker_ends_the_study():
    with pytest.raises(RuntimeError, match="died 3 times.*fewer workers"):
        list(completed(always_kills_itself, [0, 1, 2], workers=2))


@pytest.mark.parametrize("workers", [1, 2])
def test_what_a_chunk_raises_is_raised_here(workers):
    with pytest.raises(ValueError, match="chunk 0"):
        list(completed(fails, [0, 1], workers=workers))


# ---- a study, by every way there is


def envelope(**how):
    deck = rb.deck("viaduct36")
    trains = {"A1": rb.train("HSLM-A1"), "A2": rb.train("HSLM-A2")}
    return studies.speed_envelope(deck, trains, np.linspace(40.0, 60.0, 6), chunk=4, **how)


def small_map(**how):
    changes = {"train.cars": 1, "run.loads": "wheels", "run.iterations": 1, "run.tail": 0.05}
    twelve = np.linspace(0.0, 1.0, 12)
    over = {"run.speed": 70 + 10 * twelve, "track.vertical.wavelength": 20 + 11 * twelve}
    return rb.sweep(rb.case("paper").replace(changes), over, chunk=64, **how)


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    options = {"threads_per_worker": 1, "host": "127.0.0.1", "dashboard_address": None}
    with (
        distributed.LocalCluster(n_workers=2, processes=True, **options) as made,
        distributed.Client(made) as client,
    ):
        client.wait_for_workers(2, timeout=60)
        yield client


@pytest.mark.parametrize("study", [envelope, small_map])
def test_processes_and_a_cluster_give_the_same_bits(study, cluster):
    here = study()
    assert study(workers=2).identical(here)
    assert study(client=cluster).identical(here)


def test_a_killed_worker_of_a_cluster_loses_nothing(cluster):
    expected = envelope()
    pids = list(cluster.run(os.getpid).values())
    seen = []

    def progress(done, total):
        seen.append(done)
        if len(seen) == 2:
            os.kill(pids[0], signal.SIGKILL)

    assert envelope(client=cluster, progress=progress).identical(expected)
    cluster.wait_for_workers(1, timeout=60)


def test_a_cluster_without_workers_is_refused():
    class Empty:
        def scheduler_info(self, n_workers=None):
            return {"workers": {}}

    with pytest.raises(rb.InputError, match="client.*no workers.*Start workers"):
        list(completed(square, [[1]], client=Empty()))


@pytest.mark.parametrize(
    ("answer", "said"),
    [(ModuleNotFoundError("railbridge"), "does not have railbridge"), ("0.0.1", "has 0.0.1")],
)
def test_a_worker_without_the_package_is_named(answer, said):
    class Bare:
        def scheduler_info(self, n_workers=None):
            return {"workers": {"tcp://10.0.0.7:1": {"nthreads": 1}}}

        def run(self, function, *arguments, on_error):
            return {"tcp://10.0.0.7:1": answer}

    with pytest.raises(rb.InputError, match=rf"10\.0\.0\.7.*{said}.*Install version"):
        list(completed(square, [[1]], client=Bare()))


def test_chunks_come_as_they_are_finished():
    """One slow chunk does not hold the others back."""
    found = [n for n, _ in completed(time.sleep, [1.5, 0.0, 0.0, 0.0], workers=2)]
    assert found[0] != 0 and sorted(found) == [0, 1, 2, 3]


def threads_of(number):
    return os.environ.get("OMP_NUM_THREADS")


def test_processes_share_the_processors(monkeypatch):
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    share = str(max((os.cpu_count() or 1) // 2, 1))
    assert set(dict(completed(threads_of, [0, 1, 2], workers=2)).values()) == {share}
    assert "OMP_NUM_THREADS" not in os.environ, "here nothing has changed"
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    assert set(dict(completed(threads_of, [0, 1], workers=2)).values()) == {"3"}
    assert os.environ["OMP_NUM_THREADS"] == "3"
