"""Configuration of the documentation: ``sphinx-build -W docs SITE``."""

import functools
import os
import sys
from pathlib import Path

from nbclient import NotebookClient

import sphframe

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))
import tables  # noqa: E402

tables.write(HERE / "generated")

project = "sphframe"
author = "The sphframe developers"
version = release = sphframe.__version__
html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_extra_path = ["pages"]  # the league table, which sphframe rank writes
html_show_copyright = False
html_title = f"sphframe {version}"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode", "equations"]
html_math_renderer = "svg"
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3
exclude_patterns = ["generated", "pages"]  # parts of pages, and pages that are complete
nb_execution_mode = os.environ.get("SPHFRAME_DOCS_NOTEBOOKS", "force")  # "off" builds the pages without running them
nb_execution_raise_on_error = True
nb_execution_in_temp = True
nb_execution_timeout = -1  # a slow machine is no error
# MyST-NB passes on no limit for the start of the kernel, which is 60 s by default
NotebookClient.__init__ = functools.partialmethod(NotebookClient.__init__, startup_timeout=1800, iopub_timeout=1800)
nb_merge_streams = True
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_class_signature = "separated"
napoleon_use_ivar = True  # one entry for an attribute, also where it is a field of a tuple
autodoc_member_order = "alphabetical"
toc_object_entries_show_parents = "hide"
