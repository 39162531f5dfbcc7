"""Execute notebooks and store their outputs. This is the only way outputs get into the repository.

    python tools/notebooks.py                       all numbered notebooks and the template
    python tools/notebooks.py notebooks/03_x.ipynb  only those named
    python tools/notebooks.py --check               list notebooks stored without outputs

Each notebook runs from top to bottom in a fresh kernel, in its own folder. What is stored depends
on nothing but the cells and the installed versions: no times, no widget state, no kernel details.
Unchanged cells give an identical file. A notebook that raises, warns, or prints a memory address is
refused, and its file stays as it was.
"""

import os
import re
import sys
import time
from base64 import b64decode, b64encode
from concurrent.futures import ThreadPoolExecutor
from io import BytesIO
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
from PIL import Image

import railbridge as rb
from railbridge.direct import has_compiler

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "notebooks"
TIMEOUT = 120  # s, for one cell

# Stands where a panel would be: rendered pages cannot show a living one, and the figure above it
# shows its first state.
PANEL_TEXT = (
    "Interactive panel: open this notebook in JupyterLab and run this cell to move its sliders."
)
WIDGET = "application/vnd.jupyter.widget-"

METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}
ADDRESS = re.compile(r"\bat 0x[0-9a-fA-F]{6,}")


class Refused(Exception):
    """Why a notebook's outputs are not stored."""


def find(folder=FOLDER):
    """All notebooks that are kept with outputs."""
    return [*sorted(folder.glob("[0-9][0-9]_*.ipynb")), *folder.glob("_template.ipynb")]


def execute(path):
    """Run a notebook file in a fresh kernel; return the notebook with tidy outputs, or raise
    Refused."""
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.update(outputs=[], execution_count=None)
    client = NotebookClient(
        notebook,
        kernel_name="python3",
        timeout=TIMEOUT,
        resources={"metadata": {"path": str(path.parent)}},
        record_timing=False,
        store_widget_state=False,
        extra_arguments=["--log-level=ERROR"],
    )
    try:
        client.execute()
    except (CellExecutionError, CellTimeoutError, DeadKernelError) as error:
        raise Refused(without_colour(str(error)).strip()) from None
    tidy(notebook)
    complain(notebook)
    return notebook


def tidy(notebook):
    """Leave nothing in the notebook that changes from run to run or that only one program
    understands."""
    notebook.metadata = nbformat.from_dict(METADATA)
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    known = set()
    for number, cell in enumerate(notebook.cells):
        if cell.get("id") is None or cell["id"] in known:
            cell["id"] = f"cell-{number:03d}"
        known.add(cell["id"])
        tags = cell.metadata.get("tags")
        cell.metadata = nbformat.from_dict({"tags": tags} if tags else {})
        if cell.cell_type == "code":
            cell.outputs = tidy_outputs(cell.outputs)


def tidy_outputs(outputs):
    tidied = []
    for output in outputs:
        previous = tidied[-1] if tidied else {}
        if output.output_type == "stream" and previous.get("name") == output.name:
            previous["text"] += (
                output.text
            )  # how a print is cut into messages is a matter of timing
            continue
        if "data" in output:
            if any(mime.startswith(WIDGET) for mime in output.data):
                output = nbformat.v4.new_output("display_data", data={"text/plain": PANEL_TEXT})
            if "image/png" in output.data:
                output.data["image/png"] = with_few_colours(output.data["image/png"])
            output.metadata = nbformat.from_dict({})
        tidied.append(output)
    return tidied


def with_few_colours(png):
    """The same picture with 128 colours, base64: line drawings need no more, and the file shrinks
    to a third."""
    small = BytesIO()
    with Image.open(BytesIO(b64decode(png))) as picture:
        picture.convert("RGB").quantize(128, dither=Image.Dither.NONE).save(
            small, "png", optimize=True
        )
    return b64encode(small.getvalue()).decode("ascii") + "\n"


def complain(notebook):
    """Raise Refused for outputs that nobody should find in a stored notebook."""
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            text = output.get("text") or output.get("data", {}).get("text/plain") or ""
            if output.output_type == "error":
                problem = f"raises {output.ename}: {output.evalue}"
            elif output.get("name") == "stderr":
                problem = f"warns:\n{without_colour(text).strip()}"
            elif ADDRESS.search(text):
                problem = f"prints a memory address, which differs in every run: {text.strip()}"
            else:
                continue
            raise Refused(f"this cell {problem}\n------------------\n{cell.source}")


def without_colour(text):
    return re.sub(r"\x1b\[[0-9;]*m", "", text)


def store(path):
    """Execute one notebook and write it if it changed; return a line for the reader and whether it
    went well."""
    start = time.monotonic()
    try:
        notebook = execute(path)
        nbformat.validate(notebook)
    except (Refused, nbformat.ValidationError, ValueError) as error:
        return f"REFUSED    {path.name}\n{error}", False
    text = nbformat.writes(notebook).rstrip("\n") + "\n"
    changed = text != path.read_text(encoding="utf-8")
    if changed:
        beside = path.with_name(f".{path.name}.tmp")
        beside.write_text(text, encoding="utf-8", newline="\n")
        os.replace(beside, path)
    seconds = time.monotonic() - start
    return (
        f"{'stored' if changed else 'unchanged':10} {path.name}  ({seconds:.1f} s, "
        f"{len(text) / 1000:.0f} kB)",
        True,
    )


def without_outputs(path):
    """True if a cell of the stored notebook has not been run."""
    cells = nbformat.read(path, as_version=4).cells
    return any(cell.cell_type == "code" and cell.execution_count is None for cell in cells)


def have_the_loop_compiled():
    """So that no page waits for the compiler and tells of it."""
    if has_compiler():
        train = rb.Train(rb.vehicle("xia2000_planar_wheelsets"))
        deck = rb.deck("viaduct36", rb.Rail(bending_stiffness=1.28e7, foundation=1e8))
        for contact in ("permanent", "hertz"):
            rb.cross(train, deck, speed=60.0, contact=contact, lead_in=0.0)


def main(arguments):
    check = "--check" in arguments
    names = [name for name in arguments if name != "--check"]
    if any(name.startswith("-") for name in names):
        sys.exit(__doc__)
    paths = [Path(name).resolve() for name in names] or find()
    missing = [path for path in paths if not path.is_file()]
    if missing:
        sys.exit("no such notebook: " + ", ".join(path.name for path in missing))
    if check:
        bare = [path.name for path in paths if without_outputs(path)]
        print(
            "\n".join(f"no outputs {name}" for name in bare)
            or f"{len(paths)} notebooks stored with outputs"
        )
        sys.exit(bool(bare))
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    have_the_loop_compiled()
    went_well = True
    with ThreadPoolExecutor(max_workers=min(2, os.cpu_count() or 1)) as pool:
        for line, good in pool.map(store, paths):
            print(line, flush=True)
            went_well = went_well and good
    sys.exit(not went_well)


if __name__ == "__main__":
    main(sys.argv[1:])
