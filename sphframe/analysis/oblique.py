"""Analysis: a run in three dimensions, seen obliquely from the front, the right and above, in light and shade.

Particles are projected along one direction and drawn from the farthest to the nearest, as discs. Their brightness
follows from the angle between the light and the direction in which a particle has no neighbours.
"""

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from sphframe.analysis.drawing import WALL_COLOUR, View, view_of
from sphframe.analysis.fields import outline_nodes
from sphframe.analysis.figures import line_style
from sphframe.analysis.placed import probes_at, walls_at
from sphframe.arrays import Array
from sphframe.errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_AZIMUTH, _ELEVATION = np.radians([-60.0, 22.0])
_TOWARDS = np.array([
    np.cos(_ELEVATION) * np.cos(_AZIMUTH), np.cos(_ELEVATION) * np.sin(_AZIMUTH), np.sin(_ELEVATION)
])  # fmt: skip
"""unit vector towards who looks"""
_AXES = np.stack([
    [-np.sin(_AZIMUTH), np.cos(_AZIMUTH), 0.0],
    [-np.sin(_ELEVATION) * np.cos(_AZIMUTH), -np.sin(_ELEVATION) * np.sin(_AZIMUTH), np.cos(_ELEVATION)],
], axis=1)  # fmt: skip
"""directions to the right and upwards in the picture, as columns"""
_LIGHT = np.array([0.35, -0.55, 0.75]) / np.linalg.norm([0.35, -0.55, 0.75])
_DARKEST = 0.55
_GLOSS = 0.25
"""share of white where the light falls at a right angle"""
_NEIGHBOURS = 24


def check_oblique(dataset: xr.Dataset) -> None:
    """Check that a run can be seen obliquely.

    Raises
    ------
    InputError
        it is in two dimensions.
    """
    if int(dataset.attrs["dimension"]) != 3:
        raise InputError("only runs in three dimensions are seen obliquely, and this one is in two: leave out oblique")


def oblique_view(dataset: xr.Dataset, frames: Sequence[xr.Dataset]) -> View:
    """Limits, m, of a picture that shows water and walls obliquely as far up as the slice of :func:`view_of` does."""
    (x0, x1), (z0, z1) = view_of(dataset, frames)
    y = outline_nodes(dataset)[:, 1]
    corners = np.array(list(itertools.product((x0, x1), (y.min(), y.max()), (z0, z1)))) @ _AXES
    (left, low), (right, high) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return (left, right), (low, high)


def draw_oblique(
    axes: "Axes", dataset: xr.Dataset, frame: xr.Dataset, values: Array, colours: str, limits: tuple[float, float]
) -> None:
    """Draw the particles of ``frame``, coloured by ``values`` within ``limits``, the walls and the probes.

    Walls behind the water are hidden by it, and shine through it faintly.
    """
    from matplotlib import colormaps
    from matplotlib.collections import EllipseCollection
    from matplotlib.colors import Normalize

    time, spacing = float(frame["time"]), float(dataset.attrs["particle_spacing"])
    left = np.isfinite(frame["position"].values).all(axis=1)
    position = frame["position"].values[left]
    colour: Any = colormaps[colours](Normalize(*limits)(np.ma.masked_invalid(values[left])))
    lit = _light_on(position, spacing)[:, None]
    colour[:, :3] *= _DARKEST + (1.0 - _DARKEST) * lit
    colour[:, :3] += _GLOSS * lit**2 * (1.0 - colour[:, :3])
    order = np.argsort(position @ _TOWARDS)
    axes.add_collection(
        EllipseCollection(
            [1.2 * spacing], [1.2 * spacing], [0.0], units="xy", offsets=position[order] @ _AXES,
            offset_transform=axes.transData, facecolors=colour[order], linewidths=0.0, zorder=2,
        ),
        autolim=False,
    )  # fmt: skip
    for points, _ in walls_at(dataset, time):
        for zorder, alpha in ((1, 1.0), (3, 0.25)):
            axes.plot(*(points @ _AXES).T, color=WALL_COLOUR, linewidth=1.0, alpha=alpha, zorder=zorder)
    if "probe_pressure" in dataset:
        for k, place in enumerate(probes_at(dataset, time) @ _AXES):
            axes.plot(*place, "o", color=line_style(k)["color"], markersize=5, markeredgecolor="white", zorder=4)
    axes.set_axis_off()


def _light_on(position: Array, spacing: float) -> Array:
    """Return how much light falls on particles (n,), from 0 to 1, by the direction in which they have no neighbours."""
    from scipy.spatial import cKDTree

    count = min(_NEIGHBOURS, len(position))
    distance, near = cKDTree(position).query(position, k=count, distance_upper_bound=2.0 * spacing)
    found = np.isfinite(distance.reshape(len(position), -1))
    offset = position[np.where(found, near.reshape(found.shape), 0)] - position[:, None]
    outward = -np.einsum("ik,ikx->ix", found, offset) / found.sum(axis=1)[:, None]
    length = np.maximum(np.linalg.norm(outward, axis=1), 0.3 * spacing)  # within the water there is no direction
    lit: Array = np.clip(outward @ _LIGHT / length, 0.0, 1.0)
    return lit
