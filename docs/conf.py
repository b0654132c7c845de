"""Configuration of the documentation: ``sphinx-build -W docs SITE``."""

import functools
import os
import re

from nbclient import NotebookClient

import sphframe

project = "sphframe"
author = "The sphframe developers"
version = release = sphframe.__version__
html_theme = "furo"
html_extra_path = ["pages"]  # the league table, which sphframe rank writes
html_show_copyright = False
html_title = f"sphframe {version}"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3
include_patterns = [
    "index.md", "commands.md", "choosing.md",
    "shapes.md", "methods.md", "walls.md", "order.md", "flows.md", "theory/*.md",
    "gallery.md", "gallery_shapes.md", "notebooks/*.ipynb",
    "tutorial_plugin.md", "tutorial_treatment.md", "write_a_study.md", "api.md", "comparison.md", "performance.md",
    "reproduction/*.md", "development.md",
]  # fmt: skip
nb_execution_mode = os.environ.get("SPHFRAME_DOCS_NOTEBOOKS", "force")  # "off" builds the pages without running them
nb_execution_raise_on_error = True
nb_execution_in_temp = True
nb_execution_timeout = -1  # a slow machine is no error
# MyST-NB passes on no limit for the start of the kernel, which is 60 s by default
NotebookClient.__init__ = functools.partialmethod(NotebookClient.__init__, startup_timeout=1800, iopub_timeout=1800)
nb_merge_streams = True
autodoc_typehints = "description"
autodoc_member_order = "alphabetical"
toc_object_entries_show_parents = "hide"

_HEADING = re.compile(r"^(Parameters|Attributes|Raises|Warns|Returns)$")
_ITEM = re.compile(r"^(\*{0,2}[\w, .]+): (.*)$")


def _as_numpydoc(app, what, name, obj, options, lines):  # type: ignore[no-untyped-def]
    """Write ``name: meaning`` of our docstrings on two lines, as numpydoc has it, and give what is returned a name."""
    section, result = "", []
    for number, line in enumerate(lines):
        heading = number + 1 < len(lines) and re.fullmatch(r"-{3,}", lines[number + 1])
        if heading:
            section = line if _HEADING.match(line) else ""
        if section == "Returns":
            result.append(f"    {line}" if line and not heading and not re.fullmatch(r"-{3,}", line) else line)
            if re.fullmatch(r"-{3,}", line):
                result.append("result")
        elif section and (match := _ITEM.match(line)):
            result += [match[1], f"    {match[2]}"]
        else:
            result.append(line)
    lines[:] = result


def setup(app):  # type: ignore[no-untyped-def]
    """Connect the above, before napoleon."""
    app.connect("autodoc-process-docstring", _as_numpydoc, priority=400)
