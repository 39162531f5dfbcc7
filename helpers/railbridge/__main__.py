"""``python -m railbridge`` is the command ``railbridge``."""

import sys

from railbridge_command import main

sys.exit(main())
