"""Analysis: how every figure is made and looks. matplotlib is imported on first use."""

import errno
import os
import re
from typing import TYPE_CHECKING, Any

from sphframe.errors import InputError, OutputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = ("#0072B2", "#E69F00", "#CC79A7", "#56B4E9", "#D55E00", "#009E73")
"""of Okabe and Ito, which people who confuse red and green can tell apart"""
_LINES = ("-", "--", ":", "-.")


def line_style(number: int) -> dict[str, Any]:
    """Return colour and line style of the series with this ``number``, from 0."""
    return {"color": _COLOURS[number % len(_COLOURS)], "linestyle": _LINES[number // len(_COLOURS) % len(_LINES)]}


def plain(text: str) -> str:
    """Return a name as matplotlib shows it letter by letter: ``$`` starts no formula, and ``_`` hides no label."""
    text = text.replace("$", r"\$")
    return f" {text}" if text.startswith("_") else text


def printed_unit(unit: str) -> str:
    """Return a unit of the CF conventions as it is printed.

    >>> printed_unit("kg m-3"), printed_unit("m s-1"), printed_unit("J m-1")
    ('kg/m³', 'm/s', 'J/m')
    """
    unit = re.sub(r" ?([A-Za-z]+)-([123])", lambda part: f"/{part[1]}{('', '²', '³')[int(part[2]) - 1]}", unit)
    return re.sub(r"(?<=[A-Za-z])2", "²", unit)


def figure_class() -> type["Figure"]:
    """Return matplotlib's figure class, which opens no window.

    Raises
    ------
    InputError
        matplotlib is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise InputError("pictures need matplotlib: install it with pip install 'sphframe[plot]'") from None
    return Figure


def new_figure(width: float, height: float, *, dpi: float | None = None) -> Any:
    """Return an empty figure of ``width`` by ``height`` inches, by default with matplotlib's own resolution.

    Raises
    ------
    InputError
        matplotlib is not installed.
    """
    return figure_class()(figsize=(width, height), dpi=dpi, layout="constrained")


def tidy(axes: "Axes", *, grid: bool = True, label_size: float = 9.0, **settings: Any) -> None:
    """Give axes the look of all figures: small ticks, no box, a faint grid; ``settings`` are passed to ``axes.set``."""
    axes.set(**settings)
    axes.tick_params(labelsize=label_size, length=2)
    axes.spines[["top", "right"]].set_visible(False)
    if grid:
        axes.grid(linewidth=0.4, alpha=0.4)


def save_figure(figure: "Figure", path: str | os.PathLike[str]) -> None:
    """Write ``figure`` to the file ``path``, whose suffix chooses the format.

    Raises
    ------
    OutputError
        the file cannot be written, or the format is unknown.
    """
    try:
        figure.savefig(path)
    except ValueError as error:  # of matplotlib, about the format
        raise OutputError(f"cannot write the picture {path}: {error}; choose another name, ending in .png") from None
    except OSError as error:
        full = error.errno == errno.EMFILE
        remedy = "allow more open files (ulimit -n)" if full else "check its folder, its permissions and the free space"
        raise OutputError(f"cannot write the picture {path}: {error}; {remedy}") from None
