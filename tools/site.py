"""Build the static site in build/site: stored notebooks, documents, functions, a gallery.

    python tools/site.py            then open build/site/index.html, without server or network

Nothing is executed. A warning of Sphinx is an error.
"""

import shutil
import subprocess
import sys
from importlib.util import find_spec

from site_pages import PAGES, ROOT, lay_out

SITE = ROOT / "build" / "site"
NEEDED = ("sphinx", "myst_nb", "furo", "sphinx-mathjax-offline")


def main(arguments):
    if arguments:
        sys.exit(__doc__)
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        sys.exit(f"missing: {', '.join(missing)}. Install them with pip install -e .[site]")
    lay_out()
    shutil.rmtree(SITE, ignore_errors=True)
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-b",
        "html",
        "-q",
        "-W",
        "--keep-going",
        "-E",
        "-j",
        "2",
    ]
    command += ["-c", ROOT / "docs" / "site", "-d", ROOT / "build" / "site-doctrees", PAGES, SITE]
    code = subprocess.run(command).returncode
    print("the site has faults: see above" if code else SITE / "index.html")
    sys.exit(code)


if __name__ == "__main__":
    main(sys.argv[1:])
