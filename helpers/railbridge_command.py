"""What the command ``railbridge`` starts.

It stands outside the package and imports nothing, so that Ctrl-C ends the command in one line while
its packages are still being loaded, too.
"""

import sys


def main() -> int:
    """Load the command and run it; return its exit code."""
    try:
        from railbridge.commands.command import main as command
    except KeyboardInterrupt:
        if sys.stderr is not None:
            print("railbridge: interrupted; nothing was written", file=sys.stderr)
        return 130
    return command()
