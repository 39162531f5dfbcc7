"""Runs as ``python -m railbridge.paper``; imported, it is `railbridge.validation.paper`."""

import sys

from .validation import paper

if __name__ == "__main__":
    paper.main()
else:
    sys.modules[__name__] = paper
