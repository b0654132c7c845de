"""Documentation: a Sphinx extension that draws equations as SVG pictures within the pages.

They need neither a network nor a script. ziamath sets the LaTeX of MyST's ``$...$`` with fonts of its own.
"""

import html
from typing import Any

import ziamath
from docutils.nodes import SkipNode

_SIZE = 17.0
"""of the letters, px; the text of the pages has 16"""


def _svg(source: str, inline: bool) -> str:
    """Return the picture of an equation; one within a line stands on the line of the text."""
    equation = ziamath.Latex(source, size=_SIZE, inline=inline, color="currentColor")
    shift = f' style="vertical-align:{equation.getyofst():.1f}px"' if inline else ""
    label = f'<svg role="img" aria-label="{html.escape(source, quote=True)}"{shift}'
    return str(equation.svg()).replace("<svg", label, 1)


def _visit_inline(translator: Any, node: Any) -> None:
    translator.body.append(f'<span class="math">{_svg(node.astext(), inline=True)}</span>')
    raise SkipNode


def _visit_display(translator: Any, node: Any) -> None:
    translator.body.append(f'<div class="math">{_svg(node.astext(), inline=False)}</div>')
    raise SkipNode


def setup(app: Any) -> dict[str, bool]:
    """Register the renderer, which ``html_math_renderer = "svg"`` chooses."""
    app.add_html_math_renderer("svg", (_visit_inline, None), (_visit_display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
