"""CLI: the files of a new plugin, as templates."""

import datetime
import re

import sphframe
from sphframe.registry import API_VERSION

LICENCES = ("BSD-3-Clause", "MIT", "none")


def plugin_files(name: str, *, licence: str, author: str) -> dict[str, str]:
    """Return the texts of the distribution's files by their paths in its folder; parameters as of ``new_plugin``."""
    words = {
        "NAME": name,
        "PACKAGE": f"sphframe_{name.replace('-', '_')}",
        "CLASS": "".join(word.capitalize() for word in name.split("-")),
        "LICENCE_LINES": "" if licence == "none" else f'license = "{licence}"\nlicense-files = ["LICENSE"]\n',
        "AUTHORS_LINE": f'authors = [{{ name = "{_quoted(author)}" }}]\n' if author else "",
        "OLDEST": ".".join(sphframe.__version__.split(".")[:2]),
        "NEXT": _next_minor(sphframe.__version__),
        "API": repr(API_VERSION),
        "YEAR": str(datetime.date.today().year),
        "AUTHOR": author or f"The authors of sphframe-{name}",
    }
    templates = {
        "pyproject.toml": _PYPROJECT,
        "README.md": _README,
        f"{words['PACKAGE']}/__init__.py": _MODULE,
        "tests/test_conformance.py": _TEST,
        ".gitignore": "__pycache__/\n*.egg-info/\n.hypothesis/\n.pytest_cache/\nbuild/\ndist/\n*.nc\n",
        **({} if licence == "none" else {"LICENSE": _LICENCE_TEXTS[licence]}),
    }
    return {path: _filled(text, words) for path, text in templates.items()}


def _filled(text: str, words: dict[str, str]) -> str:
    return re.sub(r"@([A-Z_]+)@", lambda match: words[match.group(1)], text)


def _quoted(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')


def _next_minor(version: str) -> str:
    major, minor, *_ = version.split(".")
    return f"{major}.{int(minor) + 1}"


_PYPROJECT = """\
[build-system]
requires = ["hatchling>=1.26"]
build-backend = "hatchling.build"

[project]
name = "sphframe-@NAME@"
version = "0.1.0"
description = "The boundary interpolation method @NAME@ for sphframe"
readme = "README.md"
requires-python = ">=3.11"
@LICENCE_LINES@@AUTHORS_LINE@dependencies = ["sphframe>=@OLDEST@,<@NEXT@"]

[project.optional-dependencies]
test = ["sphframe[testing]"]

[project.entry-points."sphframe.interpolators"]
@NAME@ = "@PACKAGE@:@CLASS@"

[tool.hatch.build.targets.wheel]
packages = ["@PACKAGE@"]

[tool.pytest.ini_options]
testpaths = ["tests"]
"""

_MODULE = '''\
"""The boundary interpolation method @NAME@."""

import math
from dataclasses import dataclass

from sphframe import OK, BoundaryInterpolator, CompiledKernel, Traits, WeightsFunction

__all__ = ["@CLASS@"]

SPHFRAME_API = @API@  # the version of the plugin interface for which this was written


@dataclass(frozen=True)
class @CLASS@(BoundaryInterpolator):
    """Gaussian weights of the distance: an example, to be replaced by your formula.

    With r_min the distance of the nearest particle, which keeps exp() from underflowing::

        Phi_j = g_j / sum_k g_k,   g_j = exp[-(r_j^2 - r_min^2) / (width R)^2]
    """

    width: float = 0.3
    """width of the Gaussian over the cut-off radius R, positive"""

    # the declared traits; "sphframe verify @NAME@" tests them, and lists further traits that the method has
    traits = Traits(non_negative=True, range_restricted=True, volume_independent=True)

    def __post_init__(self) -> None:
        if not self.width > 0.0:
            raise ValueError(f"width must be positive, got {self.width!r}")

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights of one evaluation point."""
        width = self.width

        # Compiled by Numba: plain loops and math; no arrays, no exceptions; writes to out alone.
        def weights(offsets, distances, kernel_values, volumes, support, lift, out):
            n = len(out)
            nearest = distances[0]
            for j in range(n):
                nearest = min(nearest, distances[j])
            total = 0.0
            for j in range(n):
                out[j] = math.exp((nearest**2 - distances[j] ** 2) / (width * support) ** 2)
                total += out[j]
            for j in range(n):
                out[j] /= total
            return OK

        return weights
'''

_TEST = """\
from @PACKAGE@ import @CLASS@

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([@CLASS@(), @CLASS@(width=0.5)])
def test_has_its_traits(method, check):
    check(method)
"""

_README = """\
# sphframe-@NAME@

The boundary interpolation method `@NAME@` for sphframe.

    pip install -e ".[test]"
    sphframe verify @NAME@
    pytest
    sphframe run dam-break --interpolator @NAME@

## Paper
Where the formula comes from: authors, year, doi.

## Equation

    Phi_j = g_j / sum_k g_k,   g_j = exp[-(r_j^2 - r_min^2) / (width R)^2]

Options: `width` = 0.3, the width of the Gaussian over the cut-off radius R.

## Limits
Never outside the range of the neighbours' values, defined for a single neighbour; exact on constant fields only.
"""

_LICENCE_TEXTS = {
    "BSD-3-Clause": """\
BSD 3-Clause License

Copyright (c) @YEAR@, @AUTHOR@

Redistribution and use in source and binary forms, with or without
modification, are permitted provided that the following conditions are met:

1. Redistributions of source code must retain the above copyright notice, this
   list of conditions and the following disclaimer.

2. Redistributions in binary form must reproduce the above copyright notice,
   this list of conditions and the following disclaimer in the documentation
   and/or other materials provided with the distribution.

3. Neither the name of the copyright holder nor the names of its
   contributors may be used to endorse or promote products derived from
   this software without specific prior written permission.

THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS"
AND ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE
IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE
DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDER OR CONTRIBUTORS BE LIABLE
FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL
DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR
SERVICES; LOSS OF USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER
CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY,
OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE
OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
""",
    "MIT": """\
MIT License

Copyright (c) @YEAR@ @AUTHOR@

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.
""",
}
