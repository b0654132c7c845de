"""Analysis: fields of the fluid at one time on particles and on a grid, and the free surface."""

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from sphframe.arrays import Array, IntArray
from sphframe.errors import InputError


def particles_at(dataset: xr.Dataset, time: float | None = None) -> xr.Dataset:
    """Return the frame nearest to ``time`` (s; by default the last), with the particles' ``speed`` added.

    Raises
    ------
    InputError
        the run has no frame yet, or ``time`` lies outside the run.
    """
    times = dataset["time"].values
    if not len(times):
        raise InputError("this run has no frame yet: wait for the first one")
    if time is not None and not -1e-9 <= time <= times[-1] * (1 + 1e-9) + np.max(np.diff(times), initial=0.0):
        raise InputError(f"t = {time:g} s lies outside the run: its frames cover {times[0]:g} to {times[-1]:g} s")
    index = -1 if time is None else int(np.argmin(np.abs(times - time)))
    names = [name for name, variable in dataset.data_vars.items() if variable.dims[:2] == ("time", "particle")]
    frame = dataset[names].isel(time=index).load()
    frame["speed"] = np.sqrt((frame["velocity"] ** 2).sum("space"))
    frame["speed"].attrs = {"units": "m s-1", "long_name": "speed"}
    return frame


def by_components(frame: xr.Dataset) -> xr.Dataset:
    """Return a frame with the components of vectors as variables of their own: ``x`` of position, ``velocity_x``."""
    parts = {}
    for name, variable in frame.data_vars.items():
        if "space" not in variable.dims:
            parts[str(name)] = variable
            continue
        for axis in frame["space"].values.astype(str):
            part = variable.sel(space=axis).drop_vars("space")
            part.attrs = {**variable.attrs, "long_name": f"{variable.attrs['long_name']}, {axis}"}
            parts[axis if name == "position" else f"{name}_{axis}"] = part
    return xr.Dataset(parts, attrs=frame.attrs)


def free_surface(dataset: xr.Dataset, time: float | None = None, *, resolution: float | None = None) -> xr.DataArray:
    """Elevation of the highest fluid in vertical columns, in m, at the frame nearest to ``time``.

    The surface of a particle is half a spacing above its centre. Overturning water and drops count as fluid.

    Parameters
    ----------
    resolution
        width of the columns in m; by default two particle spacings.

    Returns
    -------
    xr.DataArray
        ``elevation`` on (x) in 2-D, on (x, y) in 3-D; NaN in dry columns.
    """
    frame = particles_at(dataset, time)
    position = frame["position"].values
    spacing = float(dataset.attrs["particle_spacing"])
    axes = [_axis(dataset, k, resolution or 2.0 * spacing) for k in range(position.shape[1] - 1)]
    shape = tuple(len(axis) for axis in axes)
    cells = [
        np.clip(
            np.rint((position[:, k] - axis[0]) / (axis[1] - axis[0] if len(axis) > 1 else 1.0)).astype(int),
            0,
            len(axis) - 1,
        )
        for k, axis in enumerate(axes)
    ]
    elevation = np.full(shape, -np.inf)
    np.maximum.at(elevation, tuple(cells), position[:, -1] + 0.5 * spacing)
    return xr.DataArray(
        np.where(np.isfinite(elevation), elevation, np.nan),
        coords={"xy"[k]: ("xy"[k], axis, {"units": "m"}) for k, axis in enumerate(axes)} | {"time": frame["time"]},
        dims=tuple("xy"[: len(axes)]),
        name="elevation",
        attrs={"units": "m", "long_name": "elevation of the free surface"},
    )


def to_grid(
    dataset: xr.Dataset, field: str = "pressure", time: float | None = None, *, resolution: float | None = None
) -> xr.DataArray:
    """Interpolate a field of the particles to a regular grid at the frame nearest to ``time``.

    Each value is the average f = sum_j w_j V_j f_j / sum_j w_j V_j with Wendland's C2 weight
    w = (1 - q/2)^4 (1 + 2 q), q = r/h, of support 2h = 2.6 particle spacings. It is NaN outside the fluid, where the
    weights fill less than half of the space.

    Parameters
    ----------
    field
        ``pressure``, ``density``, ``speed``, or ``velocity`` (which keeps its dimension ``space``).
    resolution
        grid spacing in m; by default the particle spacing.

    Returns
    -------
    xr.DataArray
        The field on (y, x), or (z, y, x) in 3-D, with the unit of the field.
    """
    frame = particles_at(dataset, time)
    if field not in frame:
        raise InputError(f"no field {field!r}; this run has {', '.join(map(str, frame.data_vars))}")
    spacing = float(dataset.attrs["particle_spacing"])
    position = frame["position"].values
    dim = position.shape[1]
    axes = [_axis(dataset, k, resolution or spacing) for k in range(dim)]
    top = np.nanmax(position[:, -1]) + 1.5 * spacing
    axes[-1] = axes[-1][axes[-1] <= max(top, axes[-1][0])]
    nodes = np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
    rows, cols, weight = particle_weights(
        nodes, position, (dataset["particle_mass"] / frame["density"]).values, spacing
    )
    total = np.bincount(rows, weight, len(nodes))
    values = frame[field].values.reshape(len(position), -1)
    gridded = np.stack([np.bincount(rows, weight * v[cols], len(nodes)) for v in values.T], axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        gridded = np.where(total[:, None] >= 0.5, gridded / total[:, None], np.nan)
    names = "xyz"[:dim]
    shape = tuple(len(axis) for axis in axes)
    rest = tuple(frame[field].dims[1:])
    result = xr.DataArray(
        gridded.reshape(*shape, *frame[field].shape[1:]),
        coords={names[k]: (names[k], axis, {"units": "m"}) for k, axis in enumerate(axes)}
        | {name: frame[name] for name in ("time", *rest)},
        dims=(*names, *rest),
        name=field,
        attrs=frame[field].attrs,
    )
    return result.transpose(*reversed(names), *rest)


def particle_weights(nodes: Array, position: Array, volume: Array, spacing: float) -> tuple[IntArray, IntArray, Array]:
    """Return pairs of a node (n, dim) and a near particle (p, dim), as two arrays of indices, and w_j V_j of each.

    The weight w is that of :func:`to_grid`; particles without a finite position have no pairs.
    """
    alive, dim = np.flatnonzero(np.isfinite(position).all(axis=1)), position.shape[1]
    near = cKDTree(nodes).sparse_distance_matrix(cKDTree(position[alive]), 2.6 * spacing, output_type="coo_matrix")
    q = near.data / (1.3 * spacing)
    norm = {2: 7.0 / (4.0 * np.pi), 3: 21.0 / (16.0 * np.pi)}[dim] / (1.3 * spacing) ** dim
    return near.row, alive[near.col], norm * (1.0 - 0.5 * q) ** 4 * (1.0 + 2.0 * q) * volume[alive[near.col]]


def outline_nodes(dataset: xr.Dataset) -> Array:
    """Return the points (n, dim) of the outlines of walls, m; two corners of the domain if there are no walls."""
    if "outline_node" in dataset:
        nodes: Array = dataset["outline_node"].values
        return nodes
    return np.array([dataset.attrs["domain_lower"], dataset.attrs["domain_upper"]])


def _axis(dataset: xr.Dataset, k: int, step: float) -> Array:
    """Evenly spaced points from wall to wall along axis ``k``, half a step from the walls."""
    nodes = outline_nodes(dataset)[:, k]
    low, high = float(nodes.min()), float(nodes.max())
    count = max(round((high - low) / step), 1)
    return low + (np.arange(count) + 0.5) * (high - low) / count
