"""Analysis: films of a run. Needs matplotlib and imageio-ffmpeg, which brings its own ffmpeg.

Only the moving parts are drawn again in each frame. Particles are markers in 64 colours: matplotlib copies equal
markers from one raster, which is six times as fast as discs with individual colours.
"""

import itertools
import math
import os
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from sphframe.analysis.drawing import (
    Field,
    View,
    colour_limits,
    draw_colour_bar,
    draw_probes,
    draw_walls,
    field_to_draw,
    move_probes,
    move_walls,
    run_title,
    shown_particles,
    stretch_of,
    style_of,
    vertical_axis,
    view_of,
    with_stretch,
)
from sphframe.analysis.fields import particles_at
from sphframe.analysis.figures import figure_class, new_figure, tidy
from sphframe.analysis.oblique import check_oblique, draw_oblique, oblique_view
from sphframe.analysis.scales import time_scale
from sphframe.errors import InputError, OutputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

_LEVELS = 64
_MOST_PER_SECOND = 50.0
"""frames, of a film in real time; players of .gif show no more"""
_DOTS_PER_INCH = 100.0
_CODECS: dict[str, dict[str, Any]] = {
    ".mp4": {"codec": "libx264", "quality": 7},
    ".gif": {
        "codec": "gif",
        "pix_fmt_out": "pal8",
        "quality": None,
        "output_params": ["-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse"],
    },
}


def animate_run(
    dataset: xr.Dataset,
    path: str | os.PathLike[str],
    *,
    field: str = "pressure",
    speed: float = 1.0,
    frames_per_second: float | None = None,
    oblique: bool = False,
    surface: bool = False,
    track: Any = iter,
) -> int:
    """Write a film of a run, by default in real time, and return its number of frames.

    A film in real time shows at most 50 frames per second; of a run with more, it shows each second one, or each third.

    Parameters
    ----------
    dataset
        the run, finished or in progress.
    path
        the film, ``.mp4`` or ``.gif``; replaced if it exists.
    field
        ``pressure``, ``speed`` or ``density``.
    speed
        how many times as fast as in reality the film plays, such as 0.5.
    frames_per_second
        plays all frames at this rate, whatever their times are; in place of ``speed``.
    oblique
        show a run in 3-D obliquely from above instead of a slice.
    surface
        with ``oblique``: show the surface of the water (:func:`sphframe.analysis.water_surface`) in place of particles.
    track
        wraps the list of times, such as ``rich.progress.track``.

    Raises
    ------
    InputError
        matplotlib or imageio-ffmpeg is not installed, the suffix of ``path`` or the field is unknown, the run has no
        frame yet, or it cannot be shown with ``oblique`` or ``surface``.
    OutputError
        the film cannot be written.
    """
    path = Path(path)
    _check_film(path, speed if frames_per_second is None else frames_per_second)
    ffmpeg = _imageio_ffmpeg()
    times = [float(time) for time in dataset["time"].values]
    rate, every = (frames_per_second, 1) if frames_per_second is not None else _real_time(times, speed)
    pictures = film_frames(dataset, field=field, times=track(times[::every]), oblique=oblique, surface=surface)
    first = next(pictures)
    height, width, _ = first.shape
    path.unlink(missing_ok=True)
    # ffmpeg would take the beginning of a:b.mp4 for a protocol
    writer = ffmpeg.write_frames(
        f"file:{path}", (width, height), fps=rate, pix_fmt_in="rgba", macro_block_size=2, **_CODECS[path.suffix.lower()]
    )
    count = 0
    try:
        writer.send(None)
        for picture in itertools.chain([first], pictures):
            writer.send(np.ascontiguousarray(picture))
            count += 1
    except OSError as error:
        raise OutputError(f"cannot write the film {path}: {error}") from None
    finally:
        writer.close()
    if not path.exists():
        raise OutputError(f"cannot write the film {path}: ffmpeg has failed, see above; choose another name")
    return count


def _real_time(times: list[float], speed: float) -> tuple[float, int]:
    """Return the frames per second of a film played at ``speed``, and of how many stored frames one is shown.

    >>> _real_time([0.0, 0.02, 0.04], 0.5), _real_time([0.0, 0.005, 0.01], 1.0)
    ((25.0, 1), (50.0, 4))
    """
    interval = (times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 and times[-1] > times[0] else speed
    every = max(math.ceil(speed / interval / _MOST_PER_SECOND - 1e-6), 1)
    return round(speed / (interval * every), 6), every


def _check_film(path: Path, rate: float) -> None:
    if path.suffix.lower() not in _CODECS:
        raise InputError(f"the name of a film must end in .mp4 or .gif, not {path.name!r}")
    if not 0.0 < rate < math.inf:
        raise InputError(f"the speed or the number of frames per second must be positive, such as 1, not {rate:g}")
    if not path.parent.is_dir():
        raise OutputError(f"the folder {path.parent} for {path.name} does not exist: create it")


def _imageio_ffmpeg() -> Any:
    try:
        import imageio_ffmpeg
    except ImportError:
        raise InputError("films need imageio-ffmpeg: install it with pip install 'sphframe[film]'") from None
    return imageio_ffmpeg


def film_frames(
    dataset: xr.Dataset,
    *,
    field: str = "pressure",
    times: Iterable[float] | None = None,
    oblique: bool = False,
    surface: bool = False,
) -> Iterator[NDArray[np.uint8]]:
    """Draw the frames nearest to ``times`` (s; by default all) and yield the pixels of each, (height, width, 4) RGBA.

    Raises
    ------
    InputError
        matplotlib is not installed, the run has no frame, the field is unknown, ``oblique`` is asked for in 2-D, or
        ``surface`` without ``oblique``; with both also those of :func:`sphframe.analysis.water_surface`.
    """
    field_to_draw(field)
    figure_class()
    if surface and not oblique:
        raise InputError("films show the surface of the water obliquely: ask for oblique too, or leave out surface")
    if oblique:
        check_oblique(dataset, surface=surface)
    stored = dataset["time"].values
    shown = [particles_at(dataset, float(t)) for t in stored[:: max(len(stored) // 8, 1)]] or [particles_at(dataset)]
    style, limits = style_of(shown, field), colour_limits(dataset, shown, field)
    view = (oblique_view if oblique else view_of)(dataset, shown)
    made = partial(_ObliquePicture, surface=surface) if oblique else _FilmPicture
    picture = made(dataset, field, style, view, limits)
    for time in stored if times is None else times:
        yield picture.at(float(time))


class _FilmPicture:
    """The picture of a run: axes and labels drawn once, and the artists that are drawn again in each frame.

    Parameters
    ----------
    view
        limits of x and of the height, m.
    limits
        values at the ends of the colour bar, in the unit of the field.
    """

    def __init__(self, dataset: xr.Dataset, field: str, style: Field, view: View, limits: tuple[float, float]) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        self._dataset, self._field, self._factor, self._limits = dataset, field, style.factor, limits
        self._axes = _film_axes(dataset, style, view, limits)
        figure: Any = self._axes.figure
        canvas: Any = FigureCanvasAgg(figure)
        self._canvas = canvas
        self._probes = draw_probes(self._axes, dataset, 0.0)
        self._title = self._axes.set_title(_time_text(dataset, 0.0), fontsize=12, loc="left")
        self._walls = draw_walls(self._axes, dataset, 0.0)
        canvas.draw()  # computes the layout of the figure
        figure.set_layout_engine("none")
        self._dots = _particle_markers(self._axes, dataset, style.colours)
        for artist in (self._title, *self._walls, *self._probes):
            artist.set_animated(True)
        canvas.draw()
        self._background = canvas.copy_from_bbox(figure.bbox)

    def at(self, time: float) -> NDArray[np.uint8]:
        """Return the picture (height, width, 4) of the frame nearest to ``time`` (s)."""
        frame = particles_at(self._dataset, time)
        now = float(frame["time"])
        self._move_particles(frame)
        self._title.set_text(_time_text(self._dataset, now))
        move_walls(self._walls, self._dataset, now)
        move_probes(self._probes, self._dataset, now)
        self._canvas.restore_region(self._background)
        for artist in (*self._dots, *self._walls, *self._probes, self._title):
            self._axes.draw_artist(artist)
        return np.asarray(self._canvas.buffer_rgba()).copy()

    def _move_particles(self, frame: xr.Dataset) -> None:
        low, high = self._limits
        position, values = shown_particles(self._dataset, frame, frame[self._field].values * self._factor)
        level = np.clip(np.nan_to_num((values - low) / (high - low)) * _LEVELS, 0, _LEVELS - 1).astype(int)
        order = np.argsort(level, kind="stable")
        ends = np.searchsorted(level[order], np.arange(1, _LEVELS + 1))
        for line, members in zip(self._dots, np.split(order, ends[:-1]), strict=True):
            line.set_data(position[members, 0], position[members, 1])


class _ObliquePicture:
    """The oblique picture of a run, drawn whole in each frame; parameters as those of :class:`_FilmPicture`."""

    def __init__(
        self, dataset: xr.Dataset, field: str, style: Field, view: View, limits: tuple[float, float], *, surface: bool
    ) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        self._dataset, self._field, self._style, self._view, self._limits = dataset, field, style, view, limits
        self._axes, self._surface = _film_axes(dataset, style, view, limits, oblique=True), surface
        self._canvas: Any = FigureCanvasAgg(self._axes.figure)  # type: ignore[arg-type]

    def at(self, time: float) -> NDArray[np.uint8]:
        """Return the picture (height, width, 4) of the frame nearest to ``time`` (s)."""
        frame, axes = particles_at(self._dataset, time), self._axes
        axes.clear()
        values = frame[self._field].values * self._style.factor
        draw_oblique(axes, self._dataset, frame, values, self._style.colours, self._limits, surface=self._surface)
        axes.set(xlim=self._view[0], ylim=self._view[1], aspect=1)
        axes.set_title(_time_text(self._dataset, float(frame["time"])), fontsize=12, loc="left")
        self._canvas.draw()
        axes.figure.set_layout_engine("none")  # type: ignore[union-attr]  # the first picture has made the layout
        return np.asarray(self._canvas.buffer_rgba()).copy()


def _film_axes(
    dataset: xr.Dataset, style: Field, view: View, limits: tuple[float, float], *, oblique: bool = False
) -> "Axes":
    """Return the empty axes of a new figure, with all labels and the colour bar."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    (x0, x1), (y0, y1) = view
    stretch = 1 if oblique else stretch_of(view, 10.6)
    height = float(np.clip(stretch * 10.6 * (y1 - y0) / (x1 - x0) + 1.6, 3.0, 9.6))
    figure = new_figure(12.8, 0.02 * round(height / 0.02), dpi=_DOTS_PER_INCH)
    axes: Axes = figure.add_subplot()
    tidy(axes, grid=False, label_size=11, xlim=(x0, x1), ylim=(y0, y1), aspect=stretch)
    axes.set_xlabel("x (m)", fontsize=12)
    axes.set_ylabel(f"{vertical_axis(dataset)} (m)", fontsize=12)
    extend = "max" if style.label == "speed" else "both"
    draw_colour_bar(figure, ScalarMappable(Normalize(*limits), style.colours), axes, style, size=12, extend=extend)
    figure.suptitle(with_stretch(run_title(dataset, oblique=oblique), stretch), fontsize=13, wrap=True)
    return axes


def _particle_markers(axes: "Axes", dataset: xr.Dataset, colours: str) -> "list[Line2D]":
    """Return one line of markers per colour, without points yet."""
    from matplotlib import colormaps

    size = _marker_size(axes, dataset)
    return [
        axes.plot([], [], "o", color=colour, markersize=size, markeredgewidth=0.4, animated=True)[0]
        for colour in colormaps[colours](np.linspace(0.0, 1.0, _LEVELS))
    ]


def _time_text(dataset: xr.Dataset, time: float) -> str:
    """Time as plain text, whose layout takes less time than that of a formula."""
    seconds = f"t = {time:.3f} s"
    return f"{seconds}    (t √(g/H) = {time / time_scale(dataset):.2f})" if dataset.attrs["gravity"] > 0.0 else seconds


def _marker_size(axes: "Axes", dataset: xr.Dataset) -> float:
    """The longer side of a square of one spacing, in points, plus one pixel, which closes gaps between markers."""
    ends = axes.transData.transform(np.outer([0.0, float(dataset.attrs["particle_spacing"])], [1.0, 1.0]))
    return (float(np.max(ends[1] - ends[0])) + 1.0) * 72.0 / _DOTS_PER_INCH
