"""Analysis: where walls, ghosts and probes are at a time, as their bodies have moved and turned them."""

import numpy as np
import xarray as xr

from sphframe.arrays import Array, IntArray
from sphframe.geometry import to_world


def walls_at(dataset: xr.Dataset, time: float) -> list[tuple[Array, int]]:
    """Return the polylines (n, dim) of the walls in m at ``time`` (s), each with the index of its wall."""
    if "outline" not in dataset.sizes:
        return []
    nodes = dataset["outline_node"].values
    counts, bodies = dataset["outline_node_count"].values, dataset["wall_body"].values
    result = []
    for end, count, wall in zip(np.cumsum(counts), counts, dataset["outline_wall"].values, strict=True):
        points = nodes[end - count : end]
        if bodies[wall] >= 0:
            points = moved(points, dataset, int(bodies[wall]), time)
        result.append((points, int(wall)))
    return result


def triangles_at(dataset: xr.Dataset, time: float) -> tuple[Array, IntArray]:
    """Return the triangles (t, 3, 3) of the walls of a run in 3-D, m, at ``time`` (s), and their walls (t,)."""
    triangles, walls = dataset["triangle_node"].values.copy(), dataset["triangle_wall"].values
    for wall, body in enumerate(dataset["wall_body"].values):
        if body >= 0:
            own = walls == wall
            triangles[own] = moved(triangles[own].reshape(-1, 3), dataset, int(body), time).reshape(-1, 3, 3)
    return triangles, walls


def probes_at(dataset: xr.Dataset, time: float) -> Array:
    """Return the positions of the probes (p, dim), m, at ``time`` (s); a probe on a body moves with it."""
    dim = int(dataset.attrs["dimension"])
    position = np.stack([dataset[f"probe_{axis}"].values for axis in "xyz"[:dim]], axis=1)
    return _carried(position, dataset["probe_body"].values, dataset, time)


def ghosts_at(dataset: xr.Dataset, time: float) -> Array:
    """Return the positions of the ghosts (g, dim), m, at ``time`` (s)."""
    return _carried(dataset["ghost_position"].values.copy(), dataset["ghost_body"].values, dataset, time)


def _carried(points: Array, bodies: IntArray, dataset: xr.Dataset, time: float) -> Array:
    for body in np.unique(bodies[bodies >= 0]):
        points[bodies == body] = moved(points[bodies == body], dataset, int(body), time)
    return points


def moved(points: Array, dataset: xr.Dataset, body: int, time: float) -> Array:
    """Return where ``points`` (n, dim) of a ``body``, given as drawn, are at ``time`` (s), m.

    The position of the body is interpolated between samples, its rotation in 3-D along the shortest way.
    """
    times, dim = dataset["probe_time"].values, points.shape[1]
    if not len(times):
        return points
    position = dataset["body_position"].isel(body=body).values
    angle = dataset["body_angle"].isel(body=body).values.reshape(len(times), -1)
    now = np.array([np.interp(time, times, coordinate) for coordinate in (*position.T, *angle.T)])
    if dim == 3 and len(times) > 1:
        from scipy.spatial.transform import Rotation, Slerp

        turning = Slerp(times, Rotation.from_rotvec(angle))
        now[3:] = turning(np.clip(time, times[0], times[-1])).as_rotvec()
    return to_world(points, now, dataset["body_centre"].isel(body=body).values)
