"""Analysis: the surface of the water of a run in 3-D, as triangles. Needs PyVista, whose VTK draws the contour."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from sphframe.analysis.fields import particles_at
from sphframe.analysis.placed import ghosts_at, triangles_at
from sphframe.arrays import Array, IntArray
from sphframe.errors import InputError

_STEP = 0.5
"""of the grid, in spacings"""
_WIDTH = 0.7
"""standard deviation of the Gaussian, in spacings: rows of particles are not seen in a level surface"""
_LEAST_FILLING = 0.74
"""at a particle: a single one becomes a ball of 0.6 times its volume; at a level surface it is 0.75 anyway"""
_MARGIN = 3.0
"""of the grid around the particles, in spacings, more than the Gaussian reaches"""
_NEAREST = 8


class WaterSurface(NamedTuple):
    """The surface of the water as triangles, closed, with their corners counter-clockwise as seen from outside.

    Attributes
    ----------
    nodes
        positions (n, 3) in m.
    triangles
        indices (t, 3) of their nodes.
    normals
        unit vectors (n, 3) out of the water.
    average
        sparse matrix (n, particles): ``average @ values`` is the average at the nodes of ``values`` of the particles,
        (particles,) or (particles, 3).
    """

    nodes: Array
    triangles: IntArray
    normals: Array
    average: Any


def water_surface(dataset: xr.Dataset, time: float | None = None) -> WaterSurface:
    """Return the surface of the water of a run in 3-D at the frame nearest to ``time`` (s; by default the last).

    It is that of :func:`surface_of`, with the ghosts of the run as the solid. Values of particles are averaged over the
    eight that are nearest to a node, with the weights V_j G(x - x_j).

    Raises
    ------
    InputError
        the run is in two dimensions or has no frame yet, there is no water in the frame, ``time`` lies outside the run,
        or PyVista is not installed.
    """
    from scipy.sparse import csr_array
    from scipy.spatial import cKDTree

    check_water_surface(dataset)
    frame, spacing = particles_at(dataset, time), float(dataset.attrs["particle_spacing"])
    now, alive = float(frame["time"]), in_water(frame)
    position, volume = frame["position"].values[alive], (dataset["particle_mass"] / frame["density"]).values[alive]
    solid = ghosts_at(dataset, now) if "ghost_position" in dataset else None
    walls = triangles_at(dataset, now)[0] if "triangle_node" in dataset else None
    nodes, triangles, normals = surface_of(position, volume, spacing, solid, walls)
    count = min(_NEAREST, len(alive))
    distance, near = (part.reshape(-1, count) for part in cKDTree(position).query(nodes, k=count))
    beyond = distance**2 - distance[:, :1] ** 2  # so that none of the sums is zero
    weight = volume[near] * np.exp(-0.5 * beyond / (_WIDTH * spacing) ** 2)
    weight /= weight.sum(axis=1)[:, None]
    rows = np.arange(0, near.size + 1, count)
    average = csr_array((weight.ravel(), alive[near].ravel(), rows), shape=(len(nodes), frame.sizes["particle"]))
    return WaterSurface(nodes, triangles, normals, average)


def in_water(frame: xr.Dataset) -> IntArray:
    """Return the indices of the particles that are left in a frame.

    Raises
    ------
    InputError
        there are none.
    """
    alive = np.flatnonzero(np.isfinite(frame["position"].values).all(axis=1))
    if not len(alive):
        raise InputError(
            f"there is no water in the frame at t = {float(frame['time']):g} s: choose another time or run"
        )
    return alive


def check_water_surface(dataset: xr.Dataset) -> None:
    """Check that the surface of a run can be made of triangles.

    Raises
    ------
    InputError
        it is in two dimensions, or PyVista is not installed.
    """
    if int(dataset.attrs["dimension"]) != 3:
        raise InputError("only runs in three dimensions have a surface of triangles, and this one is in two")
    pyvista_for("surfaces of triangles need")


def pyvista_for(purpose: str) -> Any:
    """Return PyVista, or raise an :class:`InputError` that begins with the ``purpose`` and says how to install it."""
    try:
        import pyvista
    except ImportError:
        raise InputError(f"{purpose} PyVista: install it with pip install 'sphframe[vtk]'") from None
    return pyvista


def surface_of(
    position: Array, volume: Array, spacing: float, solid: Array | None = None, walls: Array | None = None
) -> tuple[Array, IntArray, Array]:
    """Return nodes (n, 3), triangles (t, 3) and normals (n, 3) of the surface around particles.

    Particles fill the share F(x) = sum_j V_j G(x - x_j) of space and solids the share S(x), the same sum over points in
    layers in them. G is the Gaussian with a standard deviation of 0.7 spacings, and the surface is the contour

        F / max(1 - S, 1/4) = 1/2

    on a grid of half a spacing. So water ends where it fills half of the space that solids leave: half a spacing above
    the upper particles of a level surface, up to the walls. Nodes within solids, where S > 1/2, are moved to the
    nearest points of the walls. The V_j of particles that fill less than 0.74 of the space around them, as those of
    drops, are increased to that.

    Parameters
    ----------
    position, volume
        of the particles: (p, 3) in m, and (p,) in m³.
    spacing
        of the particles, m.
    solid
        points (s, 3), m, each for the volume spacing³. Left out are those within the water, of thin walls, and those on
        the walls, which treatments with a single layer put there.
    walls
        triangles (w, 3, 3) of the surfaces of the solids, m.

    Notes
    -----
    F is the colour field of Müller, Charypar and Gross (2003), doi:10.2312/SCA03/154-159, with the share of solids
    added here. The contour is that of Schroeder, Maynard and Geveci (2015), doi:10.1109/LDAV.2015.7348069.
    """
    pyvista = pyvista_for("surfaces of triangles need")
    grid = _Grid(position, spacing)
    filled = grid.filling(position, volume)
    solid = np.empty((0, 3)) if solid is None else solid[grid.at(filled, solid) < 0.5]
    if walls is not None and len(solid):
        solid = solid[np.linalg.norm(solid - _nearest(solid, walls), axis=1) > 0.25 * spacing]
    left = 1.0 - grid.filling(solid, np.full(len(solid), spacing**3))
    space = np.maximum(left, 0.25)
    filled = grid.filling(position, volume * np.maximum(1.0, _LEAST_FILLING / grid.at(filled / space, position)))
    image = pyvista.ImageData(dimensions=grid.shape, spacing=[grid.step] * 3, origin=grid.lower)
    image["water"] = (filled / space).ravel(order="F")
    contour = image.contour([0.5], method="flying_edges", compute_normals=False, compute_scalars=False)
    nodes = np.asarray(contour.points, dtype=np.float64)
    if walls is not None:
        within = grid.at(left, nodes) < 0.5
        nodes[within] = _nearest(nodes[within], walls)
    normals = grid.downhill(np.minimum(filled / space, left), nodes)
    return nodes, np.asarray(contour.regular_faces, dtype=np.int64), normals


def _nearest(points: Array, triangles: Array) -> Array:
    """Return the points of ``triangles`` (t, 3, 3) nearest to ``points`` (n, 3)."""
    import igl

    corners = np.arange(3 * len(triangles)).reshape(-1, 3)
    nearest: Array = igl.point_mesh_squared_distance(points, triangles.reshape(-1, 3), corners)[2]
    return nearest


class _Grid:
    """The nodes of a uniform grid around ``points`` (n, 3)."""

    def __init__(self, points: Array, spacing: float) -> None:
        self.step = _STEP * spacing
        self.lower = points.min(axis=0) - _MARGIN * spacing
        self.shape = tuple(np.ceil((np.ptp(points, axis=0) + 2.0 * _MARGIN * spacing) / self.step).astype(int) + 1)

    def filling(self, points: Array, volume: Array) -> Array:
        """Return at the nodes the sums of V_j G over ``points`` (n, 3), shared among the eight nodes around each."""
        from scipy.ndimage import gaussian_filter

        place = (points - self.lower) / self.step
        inside = ((place >= 0.0) & (place < np.array(self.shape) - 1.0)).all(axis=1)
        cell = np.floor(place[inside]).astype(int)
        beyond = place[inside] - cell
        total = np.zeros(int(np.prod(self.shape)))
        for corner in np.ndindex(2, 2, 2):
            share = np.where(corner, beyond, 1.0 - beyond).prod(axis=1) * volume[inside] / self.step**3
            node = np.ravel_multi_index(tuple((cell + corner).T), self.shape)
            total += np.bincount(node, share, len(total))
        result: Array = gaussian_filter(total.reshape(self.shape), _WIDTH / _STEP, mode="constant", truncate=3.5)
        return result

    def downhill(self, values: Array, points: Array) -> Array:
        """Return the directions (n, 3) against the gradient of ``values`` at ``points``, smoothed over some nodes."""
        from scipy.ndimage import gaussian_filter

        smooth = gaussian_filter(values, 1.0)
        direction = -np.stack([self.at(part, points) for part in np.gradient(smooth)], axis=1)
        result: Array = direction / np.maximum(np.linalg.norm(direction, axis=1), 1e-30)[:, None]
        return result

    def at(self, values: Array, points: Array) -> Array:
        """Interpolate ``values`` at the nodes to ``points`` (n, 3); they are 0 outside of the grid."""
        from scipy.ndimage import map_coordinates

        result: Array = map_coordinates(values, ((points - self.lower) / self.step).T, order=1)
        return result
