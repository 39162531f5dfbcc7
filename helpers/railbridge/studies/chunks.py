"""Chunks of a study, computed here, in several processes, or on a cluster.

A chunk is a task of its own: a function that can be pickled, and what it is called with. Which
points make a chunk does not depend on who computes it, so all three give the same bits.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from importlib.metadata import PackageNotFoundError, version
from itertools import islice
from typing import Any

from ..errors import InputError
from .extras import needed, program_version

__all__ = ["AHEAD", "WorkerDiedError", "completed", "split"]

AHEAD = 2
"""Chunks a worker that wait for it; more would only fill memory."""
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Read by the libraries behind products of matrices when they are loaded."""
_TRIES = 3
"""How often a chunk is given to a worker before the study gives up: one that kills its worker each
time would do so for ever."""


class WorkerDiedError(RuntimeError):
    """Workers died of the same chunk again and again."""


def split(count: int, size: int) -> list[range]:
    """Return `count` numbers from 0 in chunks of `size`, the last one shorter."""
    return [range(first, min(first + size, count)) for first in range(0, count, size)]


def completed(
    task: Callable[[Any], Any],
    chunks: Sequence[Any],
    *,
    workers: int = 1,
    client: Any = None,
) -> Iterator[tuple[int, Any]]:
    """Yield the number and the result of every chunk, as they come.

    Parameters
    ----------
    task : callable
        Of one chunk.
    chunks : sequence
    workers : int
        Processes on this machine; 1 computes here.
    client : distributed.Client, optional
        A cluster instead.

    Raises
    ------
    InputError
        The cluster has no workers, or workers that cannot load the package.
    WorkerDiedError
        A worker died of the same chunk again and again.
    """
    if client is not None:
        yield from _on_cluster(task, chunks, client)
    elif workers > 1 and len(chunks) > 1:
        yield from _in_processes(task, chunks, min(workers, len(chunks)))
    else:
        for number, chunk in enumerate(chunks):
            yield number, task(chunk)


def _in_processes(task: Callable, chunks: Sequence[Any], workers: int) -> Iterator[tuple[int, Any]]:
    tries = [0] * len(chunks)
    left = list(range(len(chunks)))
    while left:
        # Processes are started anew, so that none inherits a thread in the middle of its work.
        context = multiprocessing.get_context("spawn")
        pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_begin)
        running: dict[Future, int] = {}
        threads = _few_threads(workers)
        try:
            waiting = iter(list(left))
            while True:
                for number in waiting:
                    running[pool.submit(task, chunks[number])] = number
                    if len(running) >= AHEAD * workers:
                        break
                if not running:
                    break
                done, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in done:
                    number = running[future]
                    result = future.result()
                    del running[future]
                    left.remove(number)
                    yield number, result
        except BrokenProcessPool:
            for number in running.values():
                tries[number] += 1
                if tries[number] == _TRIES:
                    raise WorkerDiedError(
                        f"a worker process died {_TRIES} times at chunk {number + 1} of "
                        f"{len(chunks)}: is there too little memory? Use fewer workers or a "
                        'smaller chunk; a script must start it below `if __name__ == "__main__":`'
                    ) from None
        except BaseException:  # stopped: nobody waits for what is half-done
            for process in list((getattr(pool, "_processes", None) or {}).values()):
                process.terminate()
            raise
        finally:
            for name in threads:
                os.environ.pop(name, None)
            pool.shutdown(wait=False, cancel_futures=True)


def _few_threads(workers: int) -> list[str]:
    """Let processes that are started now share the processors; return what was set for it.

    What the user has set stays.
    """
    own = {name: str(max((os.cpu_count() or 1) // workers, 1)) for name in _THREADS}
    new = {name: value for name, value in own.items() if name not in os.environ}
    os.environ.update(new)
    return list(new)


def _begin() -> None:
    """Prepare a worker: Ctrl-C is its parent's affair, and it does not outlive a killed parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def watch() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _on_cluster(task: Callable, chunks: Sequence[Any], client: Any) -> Iterator[tuple[int, Any]]:
    needed("distributed")
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    info = client.scheduler_info(n_workers=-1)["workers"]
    if not info:
        remedy = "Start workers, or give client.wait_for_workers(1) time"
        raise InputError("client", str(client), "the cluster has no workers", remedy)
    here = program_version()
    for name, found in client.run(version, "railbridge", on_error="return").items():
        if found != here and not (here == "none" and isinstance(found, PackageNotFoundError)):
            has = "does not have railbridge" if isinstance(found, Exception) else f"has {found}"
            remedy = f"Install version {here} there: pip install railbridge[study]"
            raise InputError("client", str(client), f"its worker {name} {has}", remedy)
    threads = sum(worker["nthreads"] for worker in info.values())
    waiting = iter(enumerate(chunks))
    numbers: dict[str, int] = {}

    def submit(number: int, chunk: Any) -> Any:
        future = client.submit(task, chunk, pure=False, retries=_TRIES - 1)
        numbers[future.key] = number
        return future

    pool = as_completed([submit(*each) for each in islice(waiting, AHEAD * threads)])
    for future in pool:
        number = numbers.pop(future.key)
        try:
            result = future.result()
        except KilledWorker:
            raise WorkerDiedError(
                f"workers of the cluster died again and again at chunk {number + 1} of "
                f"{len(chunks)}: is there too little memory? Use a smaller chunk"
            ) from None
        yield number, result
        for each in waiting:
            pool.add(submit(*each))
            break
