"""``python -m railbridge`` is the command ``railbridge``."""

import sys

from .cases.command import main

sys.exit(main())
