"""Geometry: the particles that fill a region, each with the volume of its own cell."""

from functools import lru_cache
from typing import Any

import numpy as np
import shapely

from sphframe.arrays import Array, BoolArray
from sphframe.geometry.columns import parts_inside, straight_faces
from sphframe.geometry.lattice import ROUND_OFF, Fill, Lattice
from sphframe.geometry.regions import Region
from sphframe.geometry.shapes import CHORD, Box

_PARTS = 8
"""parts along each edge into which cells near an outline are divided"""


@lru_cache(maxsize=32)
def fill(region: Region, spacing: float) -> Fill:
    """Return the particles that fill ``region``, about one ``spacing`` (m) apart.

    They lie at the centres of lattice cells, stretched so that the lattice fits all straight edges of the outline that
    are parallel to an axis and at least 1.5 spacings apart. Where an outline cuts cells, the particles of these and of
    two cells around become the centres of their Voronoi cells within the region, by Lloyd's algorithm: the first layer
    follows the outline, half a spacing inside, and each volume is that of a Voronoi cell.

    Parameters
    ----------
    region
        what is filled; the result is kept, so that the arrays are read-only.
    spacing
        m.

    References
    ----------
    Q. Du, V. Faber, M. Gunzburger, Centroidal Voronoi tessellations, SIAM Review 41 (1999), 637-676,
    doi:10.1137/S0036144599352836.
    """
    filled = _filled(region, spacing)
    for array in filled:
        array.flags.writeable = False  # it is kept for the next call
    return filled


def _filled(region: Region, spacing: float) -> Fill:
    if isinstance(region, Box):
        lower, upper = region.bounds()
        lattice = Lattice.over(lower, upper, spacing, [*enumerate(lower), *enumerate(upper)])
        return Fill(lattice.centre, lattice.size.prod(axis=1))
    return (_filled_area if region.dimension == 2 else _filled_solid)(region, spacing)


def _filled_area(region: Region, spacing: float) -> Fill:
    area = region.geometry(CHORD * spacing)
    lower, upper = np.reshape(area.bounds, (2, 2))
    lattice = Lattice.over(lower, upper, spacing, straight_edges(area))
    near = np.flatnonzero(lattice.around(shapely.get_coordinates(shapely.segmentize(area.boundary, 0.25 * spacing))))
    shapely.prepare(area)
    size = lattice.size.prod(axis=1)
    volume = np.where(shapely.contains_xy(area, lattice.centre), size, 0.0)
    cells = shapely.intersection(shapely.box(*lattice.corners(near)), area)
    volume[near] = shapely.area(cells)
    cut, mobile, fixed = lattice.kinds(volume)
    cells = cells[cut[near]]
    start = shapely.get_coordinates(shapely.centroid(cells[lattice.chosen(cut, volume / size)[cut]]))
    parts = [_parts(shapely.box(*lattice.corners(np.flatnonzero(which)))) for which in (cut, mobile)]
    parts[0] = shapely.intersection(parts[0], cells[:, None])
    samples = np.concatenate([part.ravel() for part in parts])
    samples = samples[~shapely.is_empty(samples)]
    return lattice.filled(
        start, mobile, fixed, shapely.get_coordinates(shapely.centroid(samples)), shapely.area(samples)
    )


def _filled_solid(region: Region, spacing: float) -> Fill:
    mesh = region.geometry(0.02 * spacing)
    lattice = Lattice.over(mesh.bounds[0], mesh.bounds[1], spacing, straight_faces(mesh))
    return fill_mesh(mesh, lattice, float(mesh.volume))


def fill_mesh(
    mesh: Any,
    lattice: Lattice,
    whole: float,
    *,
    near: BoolArray | None = None,
    least: float | None = None,
    rings: int = 2,
    sweeps: int = 20,
) -> Fill:
    """Return the particles of the cells of a ``lattice`` inside a closed mesh.

    Those of cells that the mesh cuts, and of ``rings`` of cells around, are relaxed by Lloyd's algorithm.

    Parameters
    ----------
    whole
        the exact volume inside all cells, m3; columns of the cells give it to about 0.01 dx beside a face.
    near
        (n,) which cells are filled; by default all.
    least
        share inside the mesh from which a cell gets a particle; by default as many as fill the cut cells get one.
    """
    size = lattice.size.prod(axis=1)
    volume, moment = np.zeros(len(size)), np.zeros((len(size), 3))
    for cell, centre, part in parts_inside(mesh, lattice.axes):
        volume += np.bincount(cell, part, len(size))
        moment += np.stack([np.bincount(cell, part * x, len(size)) for x in centre.T], axis=1)
    cut, mobile, fixed = lattice.kinds(volume, rings)
    exact = (whole - float(size[mobile | fixed].sum())) / float(volume[cut].sum()) if cut.any() else 1.0
    cut, mobile, fixed = (kind if near is None else kind & near for kind in (cut, mobile, fixed))
    if not cut.any():
        return Fill(lattice.centre[fixed], size[fixed])
    chosen = lattice.chosen(cut, volume / size) if least is None else cut & (volume >= least * size)
    found = [
        (centre[which], part[which] * np.where(cut[cell[which]], exact, 1.0))
        for cell, centre, part in parts_inside(mesh, lattice.axes)
        for which in [np.flatnonzero((cut | mobile)[cell])]
    ]
    samples, weights = (np.concatenate(arrays) for arrays in zip(*found, strict=True))
    return lattice.filled(moment[chosen] / volume[chosen, None], mobile, fixed, samples, weights, sweeps)


def common_part(one: Region, other: Region, spacing: float) -> tuple[float, Array] | None:
    """Return the measure (m2 or m3) and the centre (dim,) of what two regions have in common; None if they only touch.

    An overlap thinner than a hundredth of a ``spacing`` is round-off; between solids other than boxes, than a tenth.
    """
    if one.dimension == 2:
        common = one.geometry(CHORD * spacing).intersection(other.geometry(CHORD * spacing))
        thin = common.buffer(-0.005 * spacing).is_empty
        return None if thin else (float(common.area), shapely.get_coordinates(common.centroid)[0])
    bounds = np.array([one.bounds(), other.bounds()])
    lower, upper = bounds[:, 0].max(axis=0), bounds[:, 1].min(axis=0)
    if np.any(upper - lower < 0.01 * spacing):
        return None
    if isinstance(one, Box) and isinstance(other, Box):
        return float(np.prod(upper - lower)), 0.5 * (lower + upper)
    lattice = Lattice.over(lower, upper, spacing, ())
    size = lattice.size.prod(axis=1)
    twice = -size
    for region in (one, other):
        for cell, _, part in parts_inside(region.geometry(0.02 * spacing), lattice.axes):
            twice += np.bincount(cell, part, len(size))
    twice[twice < 0.1 * size] = 0.0
    return (float(twice.sum()), twice @ lattice.centre / twice.sum()) if twice.any() else None


def straight_edges(area: Any) -> list[tuple[int, float]]:
    """Return (axis, coordinate) of the edges of a plane ``area`` on which a coordinate is constant, longest first."""
    found = []
    for ring in shapely.get_parts(area.boundary):
        points = shapely.get_coordinates(ring)
        edge = np.abs(np.diff(points, axis=0))
        for axis in (0, 1):
            length = edge[:, 1 - axis]
            straight = edge[:, axis] <= ROUND_OFF * length
            found += [(-length[k], axis, points[k, axis]) for k in np.flatnonzero(straight)]
    return [(axis, float(place)) for _, axis, place in sorted(found)]


def _parts(boxes: Any) -> Any:
    """Divide ``boxes`` (n,) into equal parts (n, parts)."""
    lower_x, lower_y, upper_x, upper_y = shapely.bounds(boxes).T[:, :, None]
    i, j = np.divmod(np.arange(_PARTS**2), _PARTS)
    width, height = (upper_x - lower_x) / _PARTS, (upper_y - lower_y) / _PARTS
    x, y = lower_x + i * width, lower_y + j * height
    return shapely.box(x, y, x + width, y + height)
