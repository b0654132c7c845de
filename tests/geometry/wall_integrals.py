"""The integral of the renormalised Gaussian over solids, and how well ghosts stand for it."""

import numpy as np
import shapely
from scipy.spatial import cKDTree

from sphframe.kernels.gaussian import RenormalisedGaussian
from sphframe.testing.wall_integrals import wall_integrals

_CUT = np.exp(-9.0)
_RATIO = 1.3


def gaussian(r, h):
    """The renormalised Gaussian, cut off at 3h."""
    return np.where(r < 3 * h, (np.exp(-((r / h) ** 2)) - _CUT) / (np.pi * h**2 * (1 - 10 * _CUT)), 0.0)


def wall_integral(region, points, spacing):
    """The integral of W(x - x') over the solid, 1 - gamma, at ``points`` within ``region``, a polygon or several."""
    rings = shapely.get_rings(shapely.get_parts(shapely.orient_polygons(region)))
    corners = [shapely.get_coordinates(ring) for ring in rings]
    starts, ends = np.vstack([ring[:-1] for ring in corners]), np.vstack([ring[1:] for ring in corners])
    return 1.0 - wall_integrals(RenormalisedGaussian(), _RATIO * spacing, points, starts, ends).gamma


def filling_errors(domain, ghosts, spacing, within=None):
    """sum V_G W - lambda at points half a spacing inside ``domain``, away from rims; ``within`` limits the points."""
    inner = shapely.buffer(domain.region, -0.5 * spacing, join_style="mitre")
    lines = [shapely.LineString(ring) for ring in shapely.get_rings(shapely.get_parts(inner))]
    points = np.vstack(
        [shapely.get_coordinates(line.interpolate(np.arange(0, line.length, 0.23 * spacing))) for line in lines]
    )
    edge = domain.feet(points)[1]
    points = points[domain.wall[edge] >= 0]
    wall = domain.wall >= 0
    rims = [domain.start[wall & ~wall[domain.before]], domain.end[wall & ~wall[domain.after]]]
    for rim in np.vstack(rims):
        points = points[np.hypot(*(points - rim).T) > 5 * spacing]
    if within is not None:
        points = points[shapely.contains_xy(within, *points.T)]
    exact = wall_integral(domain.region, points, spacing)
    near = cKDTree(points).sparse_distance_matrix(
        cKDTree(ghosts.position), 3.0 * _RATIO * spacing, output_type="coo_matrix"
    )
    parts = gaussian(near.data, _RATIO * spacing) * ghosts.volume[near.col]
    return np.bincount(near.row, parts, len(points)) - exact
