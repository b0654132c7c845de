"""The exact wall integral of the renormalised Gaussian in space, independent of the project's kernels and ghosts.

lambda(x) is the integral of W(x - x') over the solid. The field G = g(r) r / r^3, g(r) = int_r^R W s^2 ds, has the
divergence -W, so that lambda is the flux of G out of the fluid through its boundary.
"""

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

_RATIO = 1.3
_RULE = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6.0
"""barycentric points of the rule of degree 2 on a triangle"""

_S = np.linspace(0.0, 3.0, 3001)
_DENSITY = np.exp(-(_S**2)) - np.exp(-9.0)
_SHELL = CubicSpline(_S, _DENSITY * _S**2).antiderivative()
_NORM = 4.0 * np.pi * float(_SHELL(3.0))


def gaussian(r, h):
    """The renormalised Gaussian in space, cut off at 3h."""
    return np.where(r < 3 * h, (np.exp(-((r / h) ** 2)) - np.exp(-9.0)) / (_NORM * h**3), 0.0)


def wall_integral(surface, points, spacing):
    """lambda at ``points``, for a closed ``surface`` that faces out of the fluid."""
    h = _RATIO * spacing
    corner = fine(surface.triangles, points, 3 * h, 0.45 * spacing)
    area = 0.5 * np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    nodes = np.einsum("qc,tcd->tqd", _RULE, corner).reshape(-1, 3)
    weights = np.repeat(area / 3.0, 3, axis=0)
    total, tree = np.zeros(len(points)), cKDTree(nodes)
    for k, members in enumerate(tree.query_ball_point(points, 3 * h)):
        offset = nodes[members] - points[k]
        r = np.linalg.norm(offset, axis=1)
        g = (_SHELL(3.0) - _SHELL(r / h)) / _NORM
        total[k] = np.sum(g / r**3 * np.einsum("ij,ij->i", offset, weights[members]))
    return total


def fine(triangles, points, reach, longest):
    """Cut ``triangles`` (t, 3, 3) until no edge is longer than ``longest``; leave out what is beyond ``reach``."""
    tree, done = cKDTree(points), [np.empty((0, 3, 3))]
    while len(triangles):
        middle = triangles.mean(axis=1)
        radius = np.linalg.norm(triangles - middle[:, None], axis=2).max(axis=1)
        triangles = triangles[tree.query(middle)[0] < reach + radius]
        edge = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
        done.append(triangles[edge <= longest])
        a, b, c = np.moveaxis(triangles[edge > longest], 1, 0)
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = np.concatenate([np.stack(part, axis=1) for part in parts])
    return np.concatenate(done)


def filling_errors(group, spacing, count=400, seed=1):
    """sum V_G W - lambda at up to ``count`` points half a spacing inside the walls, away from open faces."""
    ghosts, domain, panels = group.ghosts(spacing, 4), group.domain, group.panels(spacing)
    normal = panels.area / np.linalg.norm(panels.area, axis=1)[:, None]
    points = panels.centre - 0.5 * spacing * normal
    points = points[np.abs(domain.feet(points).depth + 0.5 * spacing) < 0.02 * spacing]
    free = fine(domain.surface.triangles[domain.wall < 0], points, 5 * spacing, spacing)
    if len(free):
        points = points[cKDTree(free.mean(axis=1)).query(points)[0] > 4.5 * spacing]
    points = np.random.default_rng(seed).permutation(points)[:count]
    tree = cKDTree(ghosts.position)
    total = [
        gaussian(np.linalg.norm(ghosts.position[members] - point, axis=1), _RATIO * spacing) @ ghosts.volume[members]
        for point, members in zip(points, tree.query_ball_point(points, 3 * _RATIO * spacing), strict=True)
    ]
    return np.array(total) - wall_integral(domain.surface, points, spacing)
