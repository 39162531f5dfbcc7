"""Run the notebook tests on data whose every number is off by one part in ten thousand million.

    python tools/perturb.py                              all notebooks
    python tools/perturb.py notebooks/03_x.ipynb -q ...  these arguments for pytest instead

A printed figure that changes with the eleventh digit of its input is printed with too many digits,
or hangs on a comparison of two numbers that happen to be equal. The copy of `data/` is temporary;
RAILBRIDGE_DATA points the package to it.
"""

import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SIZE = 1e-10
# A number with a point or an exponent; whole numbers count things (cars, modes) and stay.
FLOAT = re.compile(r"(?<![\w.])-?(?:\d+\.\d*(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+)(?![\w.])")


def perturbed(text, toml, chance):
    """Return a file's text with every float moved up or down; comments and texts in quotes stay."""

    parameters = text.startswith("symbol,")

    def move(match):
        return repr(float(match.group()) * (1 + chance.choice((-SIZE, SIZE))))

    def move_line(line):
        if not toml and parameters:
            # A parameter table: symbol, name, value, ...
            head, name, value, rest = line.split(",", 3)
            moved = (
                value
                if head == "symbol"
                else repr(float(value) * (1 + chance.choice((-SIZE, SIZE))))
            )
            return ",".join([head, name, moved, rest])
        code, hash_, comment = line.partition("#")
        parts = code.split('"')
        parts[::2] = [FLOAT.sub(move, part) for part in parts[::2]]
        return '"'.join(parts) + hash_ + comment

    return "\n".join(move_line(line) if line.strip() else line for line in text.split("\n"))


def perturb(source, target, seed=1):
    """Copy a folder of data with every number moved."""
    shutil.copytree(source, target)
    chance = random.Random(seed)
    for path in sorted(target.rglob("*.*")):
        if path.suffix in (".csv", ".toml"):
            text = path.read_text(encoding="utf-8")
            path.write_text(perturbed(text, path.suffix == ".toml", chance), encoding="utf-8")


def main(arguments):
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "data"
        perturb(ROOT / "data", data)
        environment = {**os.environ, "RAILBRIDGE_DATA": str(data)}
        chosen = arguments or ["notebooks", "-q", "-n", "2", "--dist", "loadscope"]
        sys.exit(
            subprocess.run(
                [sys.executable, "-m", "pytest", *chosen], cwd=ROOT, env=environment
            ).returncode
        )


if __name__ == "__main__":
    main(sys.argv[1:])
