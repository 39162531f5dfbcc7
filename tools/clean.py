"""Delete what the project's commands write: the environment, caches and build/.

Nothing that git tracks is touched.
"""

import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = (
    ".venv",
    "build",
    "dist",
    ".pytest_cache",
    ".hypothesis",
    ".ruff_cache",
    ".import_linter_cache",
)
SCATTERED = ("__pycache__", ".ipynb_checkpoints")

if __name__ == "__main__":
    for name in FOLDERS:
        shutil.rmtree(ROOT / name, ignore_errors=True)
    for top in ("helpers", "notebooks", "tests", "tools", "benchmarks"):
        for name in SCATTERED:
            for folder in [*(ROOT / top).rglob(name)]:
                shutil.rmtree(folder, ignore_errors=True)
    shutil.rmtree(ROOT / "__pycache__", ignore_errors=True)
