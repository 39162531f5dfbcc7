"""Run every static check; `--fix` mends first what can be mended by itself.

Exit code 1 if anything is found.
"""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MEND = (["ruff", "check", "--fix", "--quiet"], ["ruff", "format", "--quiet"])
CHECKS = (["ruff", "check"], ["ruff", "format", "--check"], ["lint-imports", "--no-logo"])


def run(program, *arguments):
    """Run a program that stands beside this Python, in the environment."""
    return subprocess.run(
        [Path(sys.executable).with_name(program), *arguments], cwd=ROOT
    ).returncode


def main(arguments):
    if arguments == ["--fix"]:
        for command in MEND:
            run(*command)
    elif arguments:
        sys.exit(__doc__)
    sys.exit(max([run(*command) for command in CHECKS]) and 1)


if __name__ == "__main__":
    main(sys.argv[1:])
