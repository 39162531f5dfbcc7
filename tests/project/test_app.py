"""The explorer's server: who may ask it, how many kernels it keeps and for how long."""

import asyncio
import http.client
import os
import re
import sys
import time
from pathlib import Path

import pytest

pytest.importorskip("voila", reason="needs the extra app")

from served import running, wait_until
from tornado.web import HTTPError

import app
import app_kernels

TOOLS = Path(app.__file__).parent


@pytest.fixture(scope="module")
def port(tmp_path_factory):
    """A server of one page at a time whose kernels end after two seconds."""
    program = (
        f"import sys\nsys.path.insert(0, {str(TOOLS)!r})\nimport app\n"
        "app.MOST_PAGES, app.IDLE_SECONDS = 1, 2\napp.main(['--no-browser'])"
    )
    home = tmp_path_factory.mktemp("app")
    with running([sys.executable, "-c", program], home, home) as (process, log):
        found = wait_until(
            lambda: re.search(r"http://127\.0\.0\.1:(\d+)", log.read_text(encoding="utf-8")),
            process,
            log,
        )
        yield int(found[1])


def asked(port, host=None, path="/"):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    try:
        connection.request("GET", path, headers={"Host": host} if host else {})
        answer = connection.getresponse()
        return answer.status, answer.read().decode()
    finally:
        connection.close()


@pytest.mark.parametrize("host", ["evil.example", "evil.example:{port}", "192.168.0.1", "[::2]"])
def test_foreign_names_get_no_page_and_no_kernel(port, host):
    host = host.format(port=port)
    kernel = "/api/kernels/00000000-0000-0000-0000-000000000000"
    for path in ("/", kernel, f"{kernel}/channels"):
        assert asked(port, host, path)[0] == 403


def test_there_are_only_so_many_pages_and_closed_ones_make_room(port):
    assert asked(port, f"localhost:{port}")[0] == 200
    status, words = asked(port)
    assert status == 503 and "1 pages are open: close one and wait a minute" in words
    end = time.monotonic() + 40.0
    while asked(port)[0] == 503:
        assert time.monotonic() < end, "the kernel of a page that nobody shows does not end"
        time.sleep(1.0)


def test_kernels_end_within_a_minute():
    assert app.IDLE_SECONDS + app.LOOKED_FOR_EVERY <= 45
    assert f"--FewKernels.most={app.MOST_PAGES}" in app.limits(app.MOST_PAGES, app.IDLE_SECONDS)


def test_kernels_that_are_being_started_count(monkeypatch):
    async def slowly(self, *_, **__):
        await asyncio.sleep(0.01)
        self._kernels[str(len(self._kernels))] = object()

    monkeypatch.setattr(app_kernels.AsyncMappingKernelManager, "start_kernel", slowly)

    async def crowd():
        few = app_kernels.FewKernels(most=3)
        done = await asyncio.gather(*(few.start_kernel() for _ in range(5)), return_exceptions=True)
        return few, done

    few, done = asyncio.run(crowd())
    assert [isinstance(d, HTTPError) for d in done] == [False] * 3 + [True] * 2
    assert (len(few), few.starting) == (3, 0)
    few._kernels.clear()


def test_the_server_finds_its_kernels_whatever_the_callers_path(monkeypatch, tmp_path):
    started = {}

    class Server:
        def __init__(self, command, env, **_):
            started.update(command=command, env=env)

        def poll(self):
            return 0

        def wait(self):
            return 0

    monkeypatch.setattr(app.subprocess, "Popen", Server)
    monkeypatch.setattr(app, "wait_until_ready", lambda *_: None)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    handler = app.signal.getsignal(app.signal.SIGTERM)
    try:
        app.main(["--no-browser"])
    finally:
        app.signal.signal(app.signal.SIGTERM, handler)
    assert started["env"]["PYTHONPATH"] == os.pathsep.join([str(TOOLS), str(tmp_path)])
