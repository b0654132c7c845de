"""Analysis: a run in three dimensions, seen obliquely from the front, the right and above, in light and shade.

What is seen is projected along one direction and drawn from the farthest to the nearest: the particles as discs, or the
surface of the water as triangles. Brightness follows from the angle between the light and the normal of the surface;
the normal of a particle is the direction in which it has no neighbours.
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
from sphframe.analysis.water import check_water_surface, water_surface
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
"""share of white where the light falls at a right angle on a particle, or is reflected by the surface to who looks"""
_HALFWAY = (_LIGHT + _TOWARDS) / np.linalg.norm(_LIGHT + _TOWARDS)
"""normal of a surface that reflects the light to who looks"""
_SHARPNESS = 30.0
"""exponent of the reflection, of Blinn (1977), doi:10.1145/563858.563893"""
_NEIGHBOURS = 24


def check_oblique(dataset: xr.Dataset, *, surface: bool = False) -> None:
    """Check that a run, or the ``surface`` of its water, can be seen obliquely.

    Raises
    ------
    InputError
        it is in two dimensions, or what the surface needs is not installed.
    """
    if int(dataset.attrs["dimension"]) != 3:
        raise InputError("only runs in three dimensions are seen obliquely, and this one is in two: leave out oblique")
    if surface:
        check_water_surface(dataset)


def oblique_view(dataset: xr.Dataset, frames: Sequence[xr.Dataset]) -> View:
    """Limits, m, of a picture that shows water and walls obliquely as far up as the slice of :func:`view_of` does."""
    (x0, x1), (z0, z1) = view_of(dataset, frames)
    y = outline_nodes(dataset)[:, 1]
    corners = np.array(list(itertools.product((x0, x1), (y.min(), y.max()), (z0, z1)))) @ _AXES
    (left, low), (right, high) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return (left, right), (low, high)


def draw_oblique(
    axes: "Axes",
    dataset: xr.Dataset,
    frame: xr.Dataset,
    values: Array,
    colours: str,
    limits: tuple[float, float],
    *,
    surface: bool = False,
) -> None:
    """Draw the particles of ``frame`` or the ``surface`` of the water, coloured by ``values`` of the particles.

    The ``limits`` are the values at the ends of the ``colours``. Walls behind the water are hidden by it, and shine
    through it faintly.
    """
    time = float(frame["time"])
    draw = _draw_surface if surface else _draw_discs
    draw(axes, dataset, frame, values, colours, limits)
    for points, _ in walls_at(dataset, time):
        for zorder, alpha in ((1, 1.0), (3, 0.25)):
            axes.plot(*(points @ _AXES).T, color=WALL_COLOUR, linewidth=1.0, alpha=alpha, zorder=zorder)
    if "probe_pressure" in dataset:
        for k, place in enumerate(probes_at(dataset, time) @ _AXES):
            axes.plot(*place, "o", color=line_style(k)["color"], markersize=5, markeredgecolor="white", zorder=4)
    axes.set_axis_off()


def _draw_discs(
    axes: "Axes", dataset: xr.Dataset, frame: xr.Dataset, values: Array, colours: str, limits: tuple[float, float]
) -> None:
    """Draw the particles as discs, the nearest last."""
    from matplotlib.collections import EllipseCollection

    spacing = float(dataset.attrs["particle_spacing"])
    left = np.isfinite(frame["position"].values).all(axis=1)
    position = frame["position"].values[left]
    lit = _light_on(position, spacing)
    colour = _lit_colours(values[left], colours, limits, lit, _GLOSS * lit**2)
    order = np.argsort(position @ _TOWARDS)
    axes.add_collection(
        EllipseCollection(
            [1.2 * spacing], [1.2 * spacing], [0.0], units="xy", offsets=position[order] @ _AXES,
            offset_transform=axes.transData, facecolors=colour[order], linewidths=0.0, zorder=2,
        ),
        autolim=False,
    )  # fmt: skip


def _draw_surface(
    axes: "Axes", dataset: xr.Dataset, frame: xr.Dataset, values: Array, colours: str, limits: tuple[float, float]
) -> None:
    """Draw the triangles of the surface that are seen from outside, the nearest last; colours vary within each."""
    from matplotlib.collections import TriMesh
    from matplotlib.tri import Triangulation

    water = water_surface(dataset, float(frame["time"]))
    lit = np.clip(water.normals @ _LIGHT, 0.0, 1.0)
    gloss = _GLOSS * np.clip(water.normals @ _HALFWAY, 0.0, 1.0) ** _SHARPNESS
    corners = water.nodes[water.triangles]
    seen = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) @ _TOWARDS > 0.0
    order = np.argsort(corners[seen].mean(axis=1) @ _TOWARDS)
    # as an image in .pdf and .svg, where each of 10^5 triangles would be a shape of its own
    right, up = (water.nodes @ _AXES).T
    mesh = TriMesh(Triangulation(right, up, water.triangles[seen][order]), zorder=2, rasterized=True)
    mesh.set_facecolor(_lit_colours(water.average @ values, colours, limits, lit, gloss))
    axes.add_collection(mesh, autolim=False)


def _lit_colours(values: Array, colours: str, limits: tuple[float, float], lit: Array, gloss: Array) -> Any:
    """Return the RGBA (n, 4) of ``values`` (n,), darker where little is ``lit``, with a share ``gloss`` of white."""
    from matplotlib import colormaps
    from matplotlib.colors import Normalize

    colour: Any = colormaps[colours](Normalize(*limits)(np.ma.masked_invalid(values)))
    colour[:, :3] *= _DARKEST + (1.0 - _DARKEST) * lit[:, None]
    colour[:, :3] += gloss[:, None] * (1.0 - colour[:, :3])
    return colour


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
