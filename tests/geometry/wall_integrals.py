"""The exact wall integral of the renormalised Gaussian, independent of the project's kernels and ghosts.

lambda(x) is the integral of W(x - x') over the solid. With g(r) = int_r^R W r' dr' the divergence theorem turns it into
the sum over the edges of the domain of int g(|z|/cos t) dt, t the angle seen from x and z the distance of the edge.
"""

import itertools

import numpy as np
import shapely

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)
_CUT = np.exp(-9.0)
_RATIO = 1.3


def gaussian(r, h):
    """The renormalised Gaussian, cut off at 3h."""
    return np.where(r < 3 * h, (np.exp(-((r / h) ** 2)) - _CUT) / (np.pi * h**2 * (1 - 10 * _CUT)), 0.0)


def wall_integral(region, points, spacing):
    """lambda at ``points`` within ``region``, a polygon or several."""
    h, reach = _RATIO * spacing, 3 * _RATIO * spacing
    total = np.zeros(len(points))
    for polygon in shapely.get_parts(shapely.orient_polygons(region)):
        for ring in shapely.get_rings(polygon):
            corners = shapely.get_coordinates(ring)
            for a, b in itertools.pairwise(corners):
                along = (b - a) / np.hypot(*(b - a))
                inside = (points - a) @ np.array([-along[1], along[0]])
                half = np.sqrt(np.maximum(reach**2 - inside**2, 0.0))
                left, right = np.clip((a - points) @ along, -half, half), np.clip((b - points) @ along, -half, half)
                seen = (np.abs(inside) < reach) & (right > left) & (np.abs(inside) > 1e-14)
                z = inside[seen]
                t0, t1 = np.arctan2(left[seen], np.abs(z)), np.arctan2(right[seen], np.abs(z))
                t = 0.5 * (t0 + t1)[:, None] + 0.5 * (t1 - t0)[:, None] * _NODES
                r = np.abs(z)[:, None] / np.cos(t)
                g = 0.5 * h**2 * (np.exp(-((r / h) ** 2)) - _CUT) - 0.5 * _CUT * (reach**2 - r**2)
                g = np.where(r < reach, g / (np.pi * h**2 * (1 - 10 * _CUT)), 0.0)
                total[seen] += np.sign(z) * (g @ _WEIGHTS) * 0.5 * (t1 - t0)
    return total


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
    distance = np.hypot(*np.moveaxis(points[:, None] - ghosts.position, -1, 0))
    return gaussian(distance, _RATIO * spacing) @ ghosts.volume - exact
