"""Show the explorer of notebook 00 as a web page: its title, one paragraph, the panel, and no code.
Ends with Ctrl-C.

    python tools/app.py                opens the browser
    python tools/app.py --no-browser   prints the address only
    python tools/app.py --port 8900    on a port of one's choice; default a free one

Voila serves the page on this machine only, and only under this machine's own names; nothing is
fetched from elsewhere. Numbers are computed here, for each page that is open by a kernel of its
own. A kernel takes 235 MB: it ends within a minute after its page was closed, and there are only so
many.
"""

import argparse
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import webbrowser
from importlib.util import find_spec
from pathlib import Path

import nbformat

ADDRESS = "127.0.0.1"
STARTS_WITHIN = 60.0  # s
NAME = "explorer.ipynb"
MOST_PAGES = 8
IDLE_SECONDS, LOOKED_FOR_EVERY = 30, 10  # together less than a minute

# Letters grow with the page, for those in the last row; the picture takes the height that is left.
STYLE = """<style>
:root { --jp-widgets-font-size: clamp(13px, 1.02vw, 22px) !important; }
:root { --jp-content-font-size1: clamp(13px, 1.02vw, 22px); }
body { background: white !important; color: #222 !important; }
.jp-Notebook, .jp-Cell, #rendered_cells { padding: 0 !important; margin: 0 !important; }
.rb-head { margin: 0 12px; font-family: sans-serif; line-height: 1.35; }
.rb-head { font-size: clamp(13px, 1.02vw, 22px); }
.rb-head h1 { font-size: 1.5em; margin: 6px 0 4px; }
.rb-head p { margin: 0 0 6px; }
.rb-panel { margin: 0 12px !important; }
.rb-panel { --jp-widgets-inline-width-short: 4em; --jp-widgets-inline-height: 2.15em; }
.rb-panel { --rb-bars: 7.2em; --rb-widest: 100%; --rb-beside: 20em; }
</style>"""
HEAD = """<div class="rb-head">
<h1>What does a train do to a railway bridge, and what does the bridge do back?</h1>
<p>The wheels roll over waves in the track and push on the deck; the deck bends and moves the
wheels; and so on, a few rounds, until the two agree. Move speed and wavelength: when is the force
large, when the sag, how much does each round still change?
</p></div>"""
CELLS = (
    f'from IPython.display import HTML\nHTML("""{STYLE}{HEAD}""")',
    "import railbridge as rb\nrb.panels.overview(dpi=130)",
)
# Voila's own page with its links to elsewhere taken out: icons that a panel does not use.
TEMPLATE = """{%- extends 'lab/index.html.j2' -%}
{%- block notebook_css -%}
{{ super() | replace('href="https://', 'data-left-out="https://') }}
{%- endblock -%}
"""


def write_page(folder):
    """Store the notebook that the page is made of, and the template that shows it."""
    template = Path(folder) / "voila" / "templates" / "explorer"
    template.mkdir(parents=True)
    (template / "conf.json").write_text('{"base_template": "lab"}', encoding="utf-8")
    (template / "index.html.j2").write_text(TEMPLATE, encoding="utf-8")
    cells = [nbformat.v4.new_code_cell(source) for source in CELLS]
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    path = Path(folder) / NAME
    nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=kernel), path)
    return path


def free_port():
    """A port that nobody listens on at this moment."""
    with socket.socket() as probe:
        probe.bind((ADDRESS, 0))
        return probe.getsockname()[1]


def listens(port):
    with socket.socket() as probe:
        return probe.connect_ex((ADDRESS, port)) == 0


def wait_until_ready(server, port, log):
    """Wait until the server answers; end the program with the server's words if it does not."""
    end = time.monotonic() + STARTS_WITHIN
    while not listens(port):
        if server.poll() is not None or time.monotonic() > end:
            sys.exit(
                f"voila did not start:\n{log.read_text(encoding='utf-8', errors='replace')[-2000:]}"
            )
        time.sleep(0.1)


def limits(pages, idle):
    """Options of the server: how many pages, how long a kernel whose page is closed stays (s), and
    no answer to whoever calls this machine by a foreign name (a page elsewhere whose name was made
    to lead here)."""
    return [
        "--VoilaConfiguration.multi_kernel_manager_class=app_kernels.FewKernels",
        f"--FewKernels.most={pages}",
        f"--MappingKernelManager.cull_idle_timeout={idle}",
        f"--MappingKernelManager.cull_interval={min(idle, LOOKED_FOR_EVERY)}",
        "--Voila.tornado_settings={'allow_remote_access': False}",
    ]


def main(arguments):
    parser = argparse.ArgumentParser(description="Show the explorer of notebook 00 as a web page.")
    parser.add_argument("--no-browser", action="store_true", help="print the address only")
    parser.add_argument("--port", type=int, help="default: a free one")
    given = parser.parse_args(arguments)
    if find_spec("voila") is None:
        sys.exit("voila is missing: pip install -e .[app]")
    port = given.port or free_port()
    if listens(port):
        sys.exit(f"port {port} is taken: leave --port out to have a free one chosen")
    signal.signal(
        signal.SIGTERM, signal.default_int_handler
    )  # ends like Ctrl-C, and the server with it
    with tempfile.TemporaryDirectory() as folder:
        path, log = write_page(folder), Path(folder) / "log.txt"
        command = [
            sys.executable,
            "-m",
            "voila",
            path.name,
            "--no-browser",
            f"--port={port}",
            f"--Voila.ip={ADDRESS}",
        ]
        command += ["--template=explorer", "--theme=light", *limits(MOST_PAGES, IDLE_SECONDS)]
        found = os.pathsep.join(filter(None, [folder, os.environ.get("JUPYTER_PATH")]))
        modules = [str(Path(__file__).resolve().parent), os.environ.get("PYTHONPATH")]
        modules = os.pathsep.join(filter(None, modules))
        own = {"JUPYTER_PATH": found, "PYTHONPATH": modules}
        environment = {"OMP_NUM_THREADS": "1", **os.environ, **own}
        with log.open("w", encoding="utf-8") as stream:
            server = subprocess.Popen(
                command, cwd=folder, env=environment, stdout=stream, stderr=subprocess.STDOUT
            )
        try:
            wait_until_ready(server, port, log)
            url = f"http://{ADDRESS}:{port}/"
            print(f"The explorer is at {url}\nIt ends with Ctrl-C.", flush=True)
            if not given.no_browser:
                webbrowser.open(url)
            server.wait()
        except KeyboardInterrupt:
            print("\nended")
        finally:
            if server.poll() is None:
                server.terminate()
                server.wait()


if __name__ == "__main__":
    main(sys.argv[1:])
