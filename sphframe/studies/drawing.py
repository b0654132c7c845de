"""Studies: the look of figures, and their conversion to image files with reproducible bytes."""

import io
import itertools
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from sphframe.analysis import figures
from sphframe.arrays import Array
from sphframe.studies.chapter import Picture

_COLOURS = {
    "improved-shepard": "#D55E00",
    "shepard": "#F2B48C",
    "normalized": "#0072B2",
    "sfdi": "#009E73",
    "mls-linear": "#CC79A7",
    "mls-quadratic": "#7A4B8C",
    "mdbc": "#56B4E9",
    "adami": "#E69F00",
}
"""of Okabe and Ito, which people who confuse red and green can tell apart, and shades of them"""


def colour(method: str) -> str:
    """Return the colour of an interpolation method, the same in all figures."""
    known = next((name for name in sorted(_COLOURS, key=len, reverse=True) if method.startswith(name)), None)
    return _COLOURS[known] if known else f"C{sum(map(ord, method)) % 10}"


def tidy(axes: Any, **settings: Any) -> None:
    """Give axes the look of all figures, with the small labels of a report."""
    figures.tidy(axes, label_size=8.0, **settings)


def picture(name: str, caption: str, figure: Any, *, raster: bool = False) -> Picture:
    """Return ``figure`` as SVG, or as PNG if it holds many thousand particles."""
    import matplotlib

    content = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": name, "path.simplify": True, "path.simplify_threshold": 0.3}):
        if raster:
            figure.savefig(content, format="png", dpi=90, metadata={"Software": None})
        else:
            figure.savefig(content, format="svg", metadata={"Date": None, "Creator": None})
    return Picture(name, caption, content.getvalue(), "png" if raster else "svg")


def thinned(t: ArrayLike, values: ArrayLike, most: int = 800) -> tuple[Array, Array]:
    """Return a series with at most about ``most`` points that keeps the extremes, for drawing.

    >>> t, y = thinned(range(1000), [0.0] * 500 + [9.0] + [0.0] * 499, most=20)
    >>> len(t), float(y.max())
    (20, 9.0)
    """
    x, y = np.asarray(t, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(x) <= most:
        return x, y
    edges = np.linspace(0, len(x), most // 2 + 1).astype(int)
    kept = []
    for start, stop in itertools.pairwise(edges):
        part = y[start:stop]
        if np.all(np.isnan(part)):
            kept += [start, stop - 1]
        else:
            kept += sorted((start + int(np.nanargmin(part)), start + int(np.nanargmax(part))))
    return x[kept], y[kept]
