"""Geometry: area or volume, centroid and second moments of solids, from which masses and inertias follow."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from sphframe.arrays import Array
from sphframe.geometry.shapes import Shape
from sphframe.geometry.walls import Wall
from sphframe.interfaces import Solid


def solid_within(walls: Sequence[Wall]) -> Solid | None:
    """Return the solid within all closed ``walls`` of a body together; None if there is none."""
    if walls and walls[0].dimension == 3:
        from trimesh import Trimesh, boolean

        solids = [wall.solid(1e-3 * float(np.ptp(wall.bounds(), axis=0).max()), 1.0) for wall in walls]
        meshes = [Trimesh(solid.vertices, solid.triangles) for solid in solids if not solid.open.any()]
        return solid_of(boolean.union(meshes)) if meshes else None
    shapes = [wall.geometry(0.01 * wall.coarse) for wall in walls if isinstance(wall, Shape)]
    areas = [shape for shape in shapes if shape.area > 0.0]
    return solid_of(shapely.union_all(areas)) if areas else None


def solid_of(geometry: Any) -> Solid:
    """Return the properties of an area of the plane, or of a closed mesh in space.

    The second moments of an area, about the origin, are sums over the edges of its rings, from (x0, y0) to (x1, y1)::

        int (x^2 + y^2) dA = 1/12 sum (x0 y1 - x1 y0) (x0^2 + x0 x1 + x1^2 + y0^2 + y0 y1 + y1^2)

    Parameters
    ----------
    geometry
        a shapely ``Polygon`` or ``MultiPolygon``, or a watertight ``trimesh.Trimesh``.

    Examples
    --------
    A square of 2 m: its polar moment is a^4 / 6.

    >>> solid = solid_of(shapely.box(1.0, 0.0, 3.0, 2.0))
    >>> solid.volume, solid.centroid.tolist(), solid.moments.round(4).tolist()
    (4.0, [2.0, 1.0], [[2.6667]])
    """
    if not isinstance(geometry, shapely.Geometry):
        return Solid(float(geometry.volume), np.array(geometry.center_mass), np.array(geometry.moment_inertia))
    area = shapely.orient_polygons(geometry)  # outer rings counter-clockwise, holes clockwise
    centroid = np.array(area.centroid.coords[0])
    polar = sum(_polar_moment(shapely.get_coordinates(ring) - centroid) for ring in _rings(area))
    return Solid(float(area.area), centroid, np.array([[polar]]))


def _rings(area: Any) -> list[Any]:
    polygons = shapely.get_parts(area)
    return [ring for polygon in polygons for ring in (polygon.exterior, *polygon.interiors)]


def _polar_moment(ring: Array) -> float:
    (x0, y0), (x1, y1) = ring[:-1].T, ring[1:].T
    squares = x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1
    return float(np.sum((x0 * y1 - x1 * y0) * squares)) / 12.0
