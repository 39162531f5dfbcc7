"""Build the static site in build/site: stored notebooks, documents, functions, a gallery.

    python tools/site.py            then open build/site/index.html, without server or network
    python tools/site.py --teacher  with solutions, the teacher's page and sheets to print

Nothing is executed. A warning of Sphinx is an error.
"""

import shutil
import subprocess
import sys
from importlib.util import find_spec

from railbridge.lessons.sheets import sheets
from site_pages import PAGES, ROOT, TEACHING, lay_out

SITE = ROOT / "build" / "site"
NEEDED = ("sphinx", "myst_nb", "furo", "sphinx-mathjax-offline")


def main(arguments):
    teacher = arguments == ["--teacher"]
    if arguments and not teacher:
        sys.exit(__doc__)
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        sys.exit(f"missing: {', '.join(missing)}. Install them with pip install -e .[site]")
    lay_out(teacher=teacher)
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
    if teacher:
        (SITE / "sheets").mkdir(exist_ok=True)
        for name, text in sheets((ROOT / "docs" / TEACHING).read_text(encoding="utf-8")).items():
            (SITE / "sheets" / name).write_text(text, encoding="utf-8")
    print("the site has faults: see above" if code else SITE / "index.html")
    sys.exit(code)


if __name__ == "__main__":
    main(sys.argv[1:])
