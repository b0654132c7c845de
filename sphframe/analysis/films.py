"""Analysis: films of a run. Needs matplotlib and imageio-ffmpeg, which brings its own ffmpeg.

Only what moves is drawn anew in each frame. Particles are markers in 64 levels of colour: matplotlib draws equal
markers from one raster, six times as fast as discs of a colour each.
"""

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from sphframe.analysis.drawing import (
    colour_limits,
    draw_probes,
    draw_walls,
    field_to_draw,
    figure_class,
    move_walls,
    run_title,
    shown_particles,
    tidy,
    view_of,
)
from sphframe.analysis.fields import particles_at
from sphframe.analysis.scales import time_scale
from sphframe.errors import InputError, OutputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["animate_run", "film_frames"]

_LEVELS = 64
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
    frames_per_second: float = 25.0,
    track: Any = iter,
) -> int:
    """Write a film of all frames of a run, finished or still going, and return how many there are.

    Parameters
    ----------
    dataset: the run.
    path: the film, ``.mp4`` or ``.gif``; replaced if it exists.
    field: ``pressure``, ``speed`` or ``density``.
    frames_per_second: how fast the film plays.
    track: wraps the list of times, such as ``rich.progress.track``.

    Raises
    ------
    InputError: matplotlib or imageio-ffmpeg is not installed, the ending of ``path`` or the field is unknown, or the
        run has no frame yet.
    OutputError: the film cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() not in _CODECS:
        raise InputError(f"a film ends in .mp4 or .gif, not {path.name!r}")
    if not frames_per_second > 0.0:
        raise InputError(f"a film has a positive number of frames a second, such as 25, not {frames_per_second:g}")
    if not path.parent.is_dir():
        raise OutputError(f"the folder {path.parent} for {path.name} does not exist: create it")
    try:
        import imageio_ffmpeg
    except ImportError:
        raise InputError("films need imageio-ffmpeg: install it with pip install 'sphframe[film]'") from None
    pictures = film_frames(dataset, field=field, times=track([float(time) for time in dataset["time"].values]))
    first = next(pictures)
    height, width, _ = first.shape
    writer = imageio_ffmpeg.write_frames(
        str(path),
        (width, height),
        fps=frames_per_second,
        pix_fmt_in="rgba",
        macro_block_size=2,
        **_CODECS[path.suffix.lower()],
    )
    count = 0
    try:
        writer.send(None)
        for picture in _chained(first, pictures):
            writer.send(np.ascontiguousarray(picture))
            count += 1
    except OSError as error:
        raise OutputError(f"cannot write the film {path}: {error}") from None
    finally:
        writer.close()
    return count


def film_frames(
    dataset: xr.Dataset, *, field: str = "pressure", times: Iterable[float] | None = None
) -> Iterator[NDArray[np.uint8]]:
    """Draw the frames nearest to ``times`` (s; by default all), each as pixels (height, width, 4) in red, green, blue.

    Raises
    ------
    InputError: matplotlib is not installed, the run has no frame, or the field is unknown.
    """
    style = field_to_draw(field)
    make_figure = figure_class()
    from matplotlib import colormaps
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    stored = dataset["time"].values
    scale_frames = [particles_at(dataset, float(t)) for t in stored[:: max(len(stored) // 8, 1)]] or [
        particles_at(dataset)
    ]
    (x0, x1), (y0, y1) = view_of(dataset, scale_frames)
    low, high = colour_limits(dataset, scale_frames, field)
    height = float(np.clip(10.6 * (y1 - y0) / (x1 - x0) + 1.6, 3.0, 9.6))
    figure = make_figure(figsize=(12.8, 0.02 * round(height / 0.02)), dpi=100, layout="constrained")
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal")
    axes.set_xlabel("x (m)", fontsize=12)
    axes.set_ylabel(f"{'xyz'[int(dataset.attrs['dimension']) - 1]} (m)", fontsize=12)
    tidy(axes, grid=False)
    axes.tick_params(labelsize=11)
    bar = figure.colorbar(
        ScalarMappable(Normalize(low, high), style.colours),
        ax=axes,
        pad=0.01,
        fraction=0.03,
        extend="max" if low == 0.0 else "both",
    )
    bar.set_label(f"{style.label} ({style.unit})", fontsize=12)
    bar.ax.tick_params(labelsize=11)
    figure.suptitle(run_title(dataset), fontsize=13, wrap=True)
    probes = draw_probes(axes, dataset)
    title = axes.set_title(_time_text(dataset, 0.0), fontsize=12, loc="left")
    walls = draw_walls(axes, dataset, 0.0)
    canvas.draw()  # lays the figure out
    figure.set_layout_engine("none")
    dots = [
        axes.plot(
            [], [], "o", color=colour, markersize=_marker_size(axes, dataset), markeredgewidth=0.4, animated=True
        )[0]
        for colour in colormaps[style.colours](np.linspace(0.0, 1.0, _LEVELS))
    ]
    for artist in (title, *walls, *probes):
        artist.set_animated(True)
    canvas.draw()
    background = canvas.copy_from_bbox(figure.bbox)
    for time in stored if times is None else times:
        frame = particles_at(dataset, float(time))
        position, values = shown_particles(dataset, frame, frame[field].values * style.factor)
        level = np.clip(np.nan_to_num((values - low) / (high - low)) * _LEVELS, 0, _LEVELS - 1).astype(int)
        order = np.argsort(level, kind="stable")
        ends = np.searchsorted(level[order], np.arange(1, _LEVELS + 1))
        for line, members in zip(dots, np.split(order, ends[:-1]), strict=True):
            line.set_data(position[members, 0], position[members, 1])
        title.set_text(_time_text(dataset, float(frame["time"])))
        move_walls(walls, dataset, float(frame["time"]))
        canvas.restore_region(background)
        for artist in (*dots, *walls, *probes, title):
            axes.draw_artist(artist)
        yield np.asarray(canvas.buffer_rgba()).copy()


def _time_text(dataset: xr.Dataset, time: float) -> str:
    """Time in plain text, which is laid out faster than mathematics."""
    return f"t = {time:.3f} s    (t √(g/H) = {time / time_scale(dataset):.2f})"


def _marker_size(axes: "Axes", dataset: xr.Dataset) -> float:
    """A particle spacing in points, enlarged by a pixel: markers are drawn at whole pixels, and would leave gaps."""
    ends = axes.transData.transform([(0.0, 0.0), (float(dataset.attrs["particle_spacing"]), 0.0)])
    return (float(ends[1, 0] - ends[0, 0]) + 1.0) * 72.0 / 100.0


def _chained(first: NDArray[np.uint8], rest: Iterator[NDArray[np.uint8]]) -> Iterator[NDArray[np.uint8]]:
    yield first
    yield from rest
