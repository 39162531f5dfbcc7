"""Chunks: the same results here, in processes and on a cluster; killed workers lose nothing."""

import os
import signal
from pathlib import Path

import pytest

from railbridge.errors import InputError
from railbridge.studies.chunks import WorkerDiedError, completed, split


def square(chunk):
    return [number * number for number in chunk]


def dies_once(chunk):
    """Its worker is killed, the first time that the chunk of the number 3 is computed."""
    folder, numbers = chunk
    if 3 in numbers:
        try:
            Path(folder, "died").touch(exist_ok=False)
        except FileExistsError:
            pass
        else:
            os.kill(os.getpid(), signal.SIGKILL)
    return square(numbers)


def dies_always(_):
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.fixture(scope="module")
def client():
    pytest.importorskip("distributed")
    from distributed import Client, LocalCluster

    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
        ) as cluster,
        Client(cluster) as client,
    ):
        yield client


def test_a_number_is_split_into_chunks_of_which_the_last_is_shorter():
    assert [list(own) for own in split(5, 2)] == [[0, 1], [2, 3], [4]]
    assert split(0, 2) == []


def test_here_and_in_processes_each_chunk_comes_once():
    chunks = [list(own) for own in split(11, 2)]
    want = dict(enumerate(map(square, chunks)))
    for workers in (1, 2):
        found = list(completed(square, chunks, workers=workers))
        assert len(found) == len(chunks)
        assert dict(found) == want


def test_a_killed_process_loses_nothing(tmp_path):
    chunks = [(str(tmp_path), list(own)) for own in split(8, 1)]
    found = list(completed(dies_once, chunks, workers=2))
    assert len(found) == 8
    assert dict(found) == {i: [i * i] for i in range(8)}
    assert (tmp_path / "died").exists()


def test_what_kills_its_process_each_time_is_given_up_in_words():
    with pytest.raises(WorkerDiedError, match="chunk .* of 2.*fewer workers"):
        list(completed(dies_always, [[1], [2]], workers=2))


def test_a_cluster_gives_the_same_and_a_killed_worker_loses_nothing(client, tmp_path):
    chunks = [(str(tmp_path), list(own)) for own in split(8, 1)]
    assert dict(completed(square, [[1], [2]], client=client)) == {0: [1], 1: [4]}
    client.wait_for_workers(2)
    assert dict(completed(dies_once, chunks, client=client)) == {i: [i * i] for i in range(8)}
    assert (tmp_path / "died").exists()


def test_a_worker_without_the_package_is_named(client, monkeypatch):
    client.wait_for_workers(2)
    monkeypatch.setattr("railbridge.studies.chunks.program_version", lambda: "99.0")
    with pytest.raises(InputError, match=r"its worker tcp.*Install version 99.0"):
        list(completed(square, [[1]], client=client))


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
