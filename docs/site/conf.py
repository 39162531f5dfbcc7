"""How Sphinx turns the pages that tools/site.py has laid out into the site.

Nothing is executed, nothing is fetched.
"""

import re
from dataclasses import is_dataclass
from importlib.metadata import version as version_of
from importlib.util import find_spec
from pathlib import Path

from docutils import nodes

HERE = Path(__file__).parent
MATHJAX = (
    Path(find_spec("sphinx-mathjax-offline").origin).parent
    / "static"
    / "mathjax"
    / "tex-svg-full.js"
)

project = "railbridge"
author = "The railbridge contributors"
project_copyright = "The railbridge contributors. Code BSD-3-Clause, text and figures CC BY 4.0"
version = release = version_of("railbridge")
language = "en"
highlight_language = "none"  # blocks that name no language are commands and sketches

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
root_doc = "index"
exclude_patterns = ["data", "tests"]  # there to be downloaded

nb_execution_mode = "off"
myst_enable_extensions = ["amsmath", "colon_fence", "dollarmath"]
myst_heading_anchors = 4
myst_links_external_new_tab = False
nb_merge_streams = True
suppress_warnings = [
    # A page may go from its title to a small heading; the outline is the author's.
    "myst.header",
]

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
python_maximum_signature_line_length = 90
napoleon_google_docstring = False
# Types are words ("array of length 3"), not names to be looked up.
napoleon_use_param = False
napoleon_use_rtype = False

html_theme = "furo"
html_title = "railbridge"
html_static_path = [str(HERE / "static"), str(MATHJAX)]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"top_of_page_buttons": []}

# One file that draws formulas as SVG and fetches nothing: it works from disk. Its menu would fetch
# more files.
mathjax_path = MATHJAX.name
mathjax3_config = {"options": {"enableMenu": False}}


def keep_formulas_whole(app, doctree):
    """Hand formulas on as they are written.

    Sphinx would put those of several lines where no number may stand.
    """
    for formula in doctree.findall(nodes.math_block):
        if not formula.get("no-wrap"):
            formula.children = [nodes.Text(f"\\[{formula.astext()}\\]")]
            formula["no-wrap"] = True


def say_as_meant(app, what, name, thing, options, lines):
    """Two things that napoleon would misread in a docstring."""
    if what == "class" and is_dataclass(thing) and "Attributes" in lines:
        lines[lines.index("Attributes")] = "Parameters"  # a dataclass is made of its attributes
    if what in ("property", "attribute"):
        lines[:0] = ["..", ""]  # what stands before a colon in the first line is no type


def without_ranges(app, what, name, thing, options, signature, returned):
    """Numbers as numbers: the text below says their range."""
    if signature is not None:
        signature = re.sub(r"Annotated\[(\w+), Range\([^()]*\)\]", r"\1", signature)
        signature = re.sub(r"\b_[A-Z][a-z]+\b", "float", signature)
    return signature, returned


def setup(app):
    """Tell Sphinx of the functions above."""
    app.connect("autodoc-process-docstring", say_as_meant, priority=100)  # before napoleon reads it
    app.connect("autodoc-process-signature", without_ranges)
    app.connect("doctree-read", keep_formulas_whole)
