"""What one student asks of a server: memory and processor time of a page, on this machine.

    python benchmarks/student.py            all notebooks
    python benchmarks/student.py 00 04 06   those

Each notebook runs from top to bottom in a fresh kernel, as with Run All Cells; then each of its
panels is used: every slider goes five steps up and comes back, every list through its choices, with
a rest for the exact picture in between. Printed are processor seconds and memory (resident, of the
kernel alone) after the run, and after the panels; "most" is the largest in between.
"""

import sys
import threading
import time
from pathlib import Path

import nbformat
import psutil  # comes with ipykernel
from nbclient import NotebookClient
from nbformat.v4 import new_code_cell

NOTEBOOKS = Path(__file__).resolve().parents[1] / "notebooks"
EVERY = 0.02  # s, between two looks at the memory
USE_PANELS = """
import asyncio, gc
from ipywidgets import Dropdown
panels = [thing for thing in gc.get_objects() if type(thing).__name__ == "Panel"]
for panel in panels:
    for slider in panel.sliders.values():
        start = slider.value
        if isinstance(slider, Dropdown):
            steps = [step[1] if isinstance(step, tuple) else step for step in slider.options]
        else:
            steps = [min(start + k * slider.step, slider.max) for k in (1, 2, 3, 4, 5)]
        for value in [*steps, start]:
            slider.value = value
            await asyncio.sleep(0.2)
        await asyncio.sleep(1.0)
print(len(panels), sum(len(panel.sliders) for panel in panels))
"""


class Watch:
    """Memory of a process, looked at again and again, and what its processor time was."""

    def __init__(self, pid):
        self.process = psutil.Process(pid)
        self.most, self.over = 0, threading.Event()
        self.thread = threading.Thread(target=self.look, daemon=True)
        self.thread.start()

    def look(self):
        while not self.over.wait(EVERY):
            self.most = max(self.most, self.memory())

    def memory(self):
        return self.process.memory_info().rss / 1e6

    def seconds(self):
        spent = self.process.cpu_times()
        return spent.user + spent.system


def measured(path):
    """One line of the table."""
    notebook = nbformat.read(path, as_version=4)
    client = NotebookClient(notebook, timeout=600, resources={"metadata": {"path": path.parent}})
    with client.setup_kernel():
        watch = Watch(client.km.provisioner.pid)
        start = time.monotonic()
        for i, cell in enumerate(notebook.cells):
            client.execute_cell(cell, i)
        took, ran, held = time.monotonic() - start, watch.seconds(), watch.memory()
        cell = new_code_cell(USE_PANELS)
        notebook.cells.append(cell)
        client.execute_cell(cell, len(notebook.cells) - 1)
        panels = "".join(out.get("text", "") for out in cell.outputs).split()
        used, after = watch.seconds() - ran, watch.memory()
        watch.over.set()
    return (
        f"{path.stem:28}{took:8.1f}{ran:8.1f}{held:10.0f}   {'/'.join(panels):>6}{used:8.1f}"
        f"{after:10.0f}{watch.most:8.0f}"
    )


def main(arguments):
    print(f"{'':28}{'Run All Cells':>26}{'its panels, used':>35}")
    heads = f"{'s':>8}{'CPU s':>8}{'MB then':>10}", f"{'CPU s':>8}{'MB then':>10}{'most':>8}"
    print(f"{'':28}{heads[0]}{'panels':>9}{heads[1]}")
    for path in sorted(NOTEBOOKS.glob("[0-9][0-9]_*.ipynb")):
        if not arguments or path.name[:2] in arguments:
            print(measured(path), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
