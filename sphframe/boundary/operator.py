"""Boundary: an interpolation method as a sparse matrix, for analysis and tests.

The solver uses no matrix, but the same compiled weights and fallback.
"""

# mypy: disable-error-code="no-untyped-call"

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from sphframe.arrays import Array, IntArray
from sphframe.boundary.trial import weights_functions
from sphframe.compiled import specialise
from sphframe.compiled.stand_ins import DIM, FALLBACK, SUPPORT, VALUE, WEIGHTS
from sphframe.errors import BrokenPluginError, InputError
from sphframe.interfaces import BoundaryInterpolator, Kernel
from sphframe.interfaces.traits import DRY, OK
from sphframe.kernels import compiled_kernel
from sphframe.registry import create


@dataclass(frozen=True)
class ParticleCloud:
    """The fluid particles from which a method interpolates.

    Attributes
    ----------
    positions
        (n, dim), m, with dim 2 or 3.
    volumes
        (n,), m^dim, positive; one number stands for all.
    smoothing_length
        h, m; the cut-off radius is ``kernel.support`` times h.
    kernel
        the name of a kernel or a kernel.
    """

    positions: ArrayLike
    volumes: ArrayLike
    smoothing_length: float
    kernel: str | Kernel = "gaussian"


def operator(
    interpolator: BoundaryInterpolator,
    points: ArrayLike,
    positions: ArrayLike,
    volumes: ArrayLike,
    *,
    smoothing_length: float,
    kernel: str | Kernel = "gaussian",
    lift: ArrayLike | None = None,
) -> tuple[csr_array, IntArray]:
    """Return the matrix Phi with value(points) = Phi @ f, and the status of each point.

    Parameters
    ----------
    interpolator
        the method.
    points
        (m, dim) or (dim,), m: evaluation points, dim 2 or 3.
    positions
        (n, dim), m: fluid particles.
    volumes
        (n,) or one number, m^dim: V_j = m_j / rho_j.
    smoothing_length
        h, m.
    kernel
        the name of a kernel or a kernel.
    lift
        (m, dim) or (dim,), m: from each point to its ghost, for a method that extrapolates; zero by default. For a
        method that evaluates at the ghost along the wall's normal, this unit normal.

    Returns
    -------
    Phi : csr_array
        (m, n), dimensionless, with an entry for each particle nearer than the cut-off, zeros included;
        rows of points where the method returned TOO_FEW or SINGULAR hold the weights of its fallback, rows of dry
        points are empty.
    statuses : IntArray
        (m,), see :class:`sphframe.Status`.

    Raises
    ------
    InputError
        when a shape, a dimension or a number is not as above.

    Examples
    --------
    >>> from sphframe import create
    >>> x, y = np.meshgrid(np.arange(8.0), np.arange(8.0))
    >>> positions = np.column_stack([x.ravel(), y.ravel()])
    >>> method = create("interpolators", "mls-linear")
    >>> phi, statuses = operator(method, [3.3, 4.1], positions, 1.0, smoothing_length=1.3)
    >>> (phi @ positions).round(12).tolist(), statuses.tolist()
    ([[3.3, 4.1]], [0])
    """
    points, positions = _points("points", points), _points("positions", positions)
    volumes = _volumes(volumes, positions, points.shape[1])
    lifts = _lifts(lift, points, interpolator)
    if not (math.isfinite(smoothing_length) and smoothing_length > 0.0):
        raise InputError(f"smoothing_length must be a positive number of metres, got {smoothing_length!r}")
    chosen = create("kernels", kernel) if isinstance(kernel, str) else kernel
    near = _search(points, positions, chosen.support * smoothing_length)
    return operator_of(interpolator, points, positions, volumes, near, lifts, smoothing_length, chosen)


def operator_of(
    interpolator: BoundaryInterpolator,
    points: Array,
    positions: Array,
    volumes: Array,
    near: tuple[IntArray, IntArray],
    lifts: Array,
    smoothing_length: float,
    kernel: Kernel,
) -> tuple[csr_array, IntArray]:
    """Return what :func:`operator` does, for checked arguments, where the particles ``near`` each point are known.

    These are all that are nearer than the cut-off, as row starts and columns of a CSR matrix.
    """
    (starts, members), dim = near, points.shape[1]
    entries, statuses = np.zeros(len(members)), np.empty(len(points), dtype=np.int64)
    work = Workspace.of(int(np.diff(starts).max(initial=0)), dim)
    weights_loop(interpolator, kernel, dim)(
        positions, volumes, points, lifts, starts, members, kernel.support * smoothing_length,
        kernel.normalisation(dim) / smoothing_length**dim, work, entries, statuses,
    )  # fmt: skip
    work.check(interpolator)
    return csr_array((entries, members, starts), shape=(len(points), len(positions))), statuses


def weights_loop(interpolator: BoundaryInterpolator, kernel: Kernel, dim: int) -> Callable[..., None]:
    """Return the compiled loop of :func:`operator` for one method, kernel and dimension."""
    functions = compiled_kernel(kernel, dim)
    weights, fallback = weights_functions(interpolator, functions, dim)
    parts = {"DIM": dim, "SUPPORT": kernel.support, "VALUE": functions.value}
    return specialise(_fill_rows, {**parts, "WEIGHTS": weights, "FALLBACK": fallback}, parallel=False)


class Workspace(NamedTuple):
    """Memory for one neighbourhood, with :data:`MARGIN` entries before and after, which no method may touch.

    ``offsets`` (MARGIN + n + MARGIN, dim); ``distances``, ``kernel_values``, ``volumes``, ``out``, all one-dimensional.
    """

    offsets: Array
    distances: Array
    kernel_values: Array
    volumes: Array
    out: Array

    @classmethod
    def of(cls, neighbours: int, dim: int) -> "Workspace":
        """Return memory for up to so many ``neighbours``."""
        size = neighbours + 2 * MARGIN
        return cls(np.full((size, dim), _UNTOUCHED), *(np.full(size, _UNTOUCHED) for _ in range(4)))

    def touched(self) -> list[str]:
        """Return the names of the arrays before or after which something has been written."""
        ends = ((name, array[:MARGIN], array[-MARGIN:]) for name, array in self._asdict().items())
        return [name for name, *margins in ends if any(one.tobytes() != _MARGIN[: one.nbytes] for one in margins)]

    def check(self, interpolator: BoundaryInterpolator) -> None:
        """Raise a BrokenPluginError if the method has written before or after an array."""
        if self.touched():
            raise BrokenPluginError(
                f"{type(interpolator).__name__} writes before or after its array {self.touched()[0]!r}, so that its"
                " weights cannot be trusted: it must write to out[0] .. out[n - 1] only; sphframe verify shows where"
            )


MARGIN = 16
_UNTOUCHED = 7.25
_MARGIN = np.full(3 * MARGIN, _UNTOUCHED).tobytes()


def _fill_rows(  # type: ignore[no-untyped-def]
    positions, volumes, points, lifts, starts, members, support, kernel_scale, work, entries, statuses
):
    per_h = SUPPORT / support
    size = work.out.shape[0]
    for i in range(points.shape[0]):
        first, n = starts[i], starts[i + 1] - starts[i]
        if n == 0:
            statuses[i] = DRY
            continue
        begin = size - MARGIN - n  # so that what follows the last neighbour is the margin
        x = work.offsets[begin : size - MARGIN]
        r = work.distances[begin : size - MARGIN]
        w = work.kernel_values[begin : size - MARGIN]
        v = work.volumes[begin : size - MARGIN]
        out = work.out[begin : size - MARGIN]
        for e in range(n):
            j = members[first + e]
            square = 0.0
            for k in range(DIM):
                x[e, k] = positions[j, k] - points[i, k]
                square += x[e, k] * x[e, k]
            r[e] = math.sqrt(square)
            w[e] = kernel_scale * VALUE(r[e] * per_h)
            v[e] = volumes[j]
            out[e] = entries[first + e]
        statuses[i] = WEIGHTS(x, r, w, v, support, lifts[i], out)
        if statuses[i] != OK:
            FALLBACK(x, r, w, v, support, lifts[i], out)
        for e in range(n):
            entries[first + e] = out[e]


def _search(points: Array, positions: Array, support: float) -> tuple[IntArray, IntArray]:
    """Return the particles nearer than ``support`` to each point as row starts and columns of a CSR matrix."""
    found = cKDTree(positions).query_ball_point(points, support, return_sorted=True)
    counts = np.array([len(row) for row in found], dtype=np.int64)
    members = np.fromiter((j for row in found for j in row), dtype=np.int64, count=int(counts.sum()))
    rows = np.repeat(np.arange(len(points)), counts)
    inside = np.sum((positions[members] - points[rows]) ** 2, axis=1) < support * support
    return row_starts(rows[inside], len(points)), members[inside]


def row_starts(rows: IntArray, count: int) -> IntArray:
    """Return where each of ``count`` rows starts, from the ascending row of each entry."""
    starts = np.zeros(count + 1, dtype=np.int64)
    np.cumsum(np.bincount(rows, minlength=count), out=starts[1:])
    return starts


def _points(name: str, given: ArrayLike) -> Array:
    array = _floats(name, given)
    array = array[None, :] if array.ndim == 1 and array.size in (2, 3) else array
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise InputError(f"{name} must have the shape (n, 2) or (n, 3), got {array.shape}: one row per point, in m")
    return np.ascontiguousarray(array)


def _volumes(given: ArrayLike, positions: Array, dim: int) -> Array:
    if positions.shape[1] != dim:
        raise InputError(
            f"points are in {dim} dimensions and positions in {positions.shape[1]}: give both 2 or both 3 columns"
        )
    volumes = _filled("volumes", given, (len(positions),), "one number per particle, or one number for all")
    if np.any(volumes <= 0.0):
        j = int(np.argmax(volumes <= 0.0))
        raise InputError(f"volumes must be positive, got {volumes[j]!r} for particle {j}: give m/rho, in m^{dim}")
    return volumes


def _lifts(given: ArrayLike | None, points: Array, interpolator: BoundaryInterpolator) -> Array:
    if given is not None and not interpolator.traits.evaluation_point.takes_lift:
        raise InputError(
            f"{type(interpolator).__name__} does not extrapolate, so it takes no lift: leave it out, or give the"
            " positions of the ghosts as points if their own neighbourhood is meant"
        )
    return _filled("lift", 0.0 if given is None else given, points.shape, "one vector per point, or one for all")


def _filled(name: str, given: ArrayLike, shape: tuple[int, ...], meaning: str) -> Array:
    array = _floats(name, given)
    try:
        return np.ascontiguousarray(np.broadcast_to(array, shape))
    except ValueError:
        raise InputError(f"{name} must have the shape {shape} ({meaning}), got {array.shape}") from None


def _floats(name: str, given: ArrayLike) -> Array:
    try:
        array = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must be an array of numbers: {error}") from None
    if not np.all(np.isfinite(array)):
        place = tuple(int(k) for k in np.argwhere(~np.isfinite(array))[0])
        raise InputError(f"{name} must be finite, got {array[place]} at index {place}")
    return array
