"""Boundary: weights functions are tried in plain Python before they are compiled, where a mistake can be named."""

from collections.abc import Iterator
from numbers import Integral
from typing import Any

import numpy as np

from sphframe.arrays import Array
from sphframe.compiled.parts import checked_function, place_of
from sphframe.errors import BrokenPluginError
from sphframe.interfaces import BoundaryInterpolator, CompiledKernel, EvaluationPoint, WeightsFunction

_ARGUMENTS = ("offsets", "distances", "kernel_values", "volumes", "support", "lift", "out")
CLOSER = 0.9
"""distance of particles in the largest neighbourhood that is tried, over the particle spacing"""


def weights_functions(
    method: BoundaryInterpolator, kernel: CompiledKernel, dim: int
) -> tuple[WeightsFunction, WeightsFunction]:
    """Return the weights function of a method and that of its fallback.

    Raises
    ------
    BrokenPluginError
        when one is not a function of the seven arguments.
    """
    makers = method.point_weights, method.fallback_weights
    made = [checked_function(method, maker.__name__, maker(kernel, dim), _ARGUMENTS) for maker in makers]
    return made[0], made[1]


def try_weights(method: BoundaryInterpolator, kernel: CompiledKernel, dim: int, ratio: float) -> str | None:
    """Call the weights function in plain Python with one, few and the largest number of neighbours.

    Parameters
    ----------
    ratio
        smoothing length over particle spacing.

    Returns
    -------
    str | None
        What it raised, if a compiled function need not fail there: what Numba compiles may not run in plain Python.

    Raises
    ------
    BrokenPluginError
        when it writes or reads beyond an array, or returns something else than a whole number.
    """
    parts: list[Any] = [getattr(part, "py_func", part) for part in kernel]
    bare = CompiledKernel(*parts)
    raised = None
    for which, function in enumerate(weights_functions(method, bare, dim)):
        plain = getattr(function, "py_func", function)
        for arguments in _neighbourhoods(method, bare, dim, ratio):
            count = len(arguments[-1])
            near = f"{count} neighbour{'s' * (count > 1)}"
            where = f"the weights of {type(method).__name__} ({place_of(plain)}), with {near} in {dim}-D,"
            try:
                with np.errstate(all="ignore"):
                    status = plain(*arguments)
            except IndexError as error:
                raise BrokenPluginError(
                    f"{where} reach beyond an array: {error} (h = {ratio:g} particle spacings); compiled code would"
                    " overwrite other memory: stay within out[0] .. out[n - 1], and make local arrays large enough"
                ) from error
            except Exception as error:
                raised = raised or f"{where} raise {type(error).__name__}: {error}"
                break
            if not isinstance(status, Integral):
                hint = "end every branch with 'return OK', or TOO_FEW or SINGULAR" if status is None else "return OK"
                raise BrokenPluginError(f"{where} return {status!r:.80}; expected a status: {hint}")
        if which == 0 and raised:
            break
    return raised


def _neighbourhoods(
    method: BoundaryInterpolator, kernel: CompiledKernel, dim: int, ratio: float
) -> Iterator[tuple[Any, ...]]:
    """Arguments for one particle, for few, and for as many as there are where particles are denser than a lattice."""
    support = kernel.support * ratio / CLOSER
    axis = np.arange(-np.ceil(support), np.ceil(support) + 1.0)
    lattice = np.stack(np.meshgrid(*[axis] * dim, indexing="ij"), axis=-1).reshape(-1, dim) + 0.3
    distances = np.linalg.norm(lattice, axis=1)
    order = np.argsort(distances, kind="stable")
    order = order[distances[order] < support]
    lift = np.zeros(dim)
    if method.traits.evaluation_point.takes_lift:
        lift[-1] = 1.0 if method.traits.evaluation_point is EvaluationPoint.DIRECTED else -1.5
    scale = kernel.normalisation * (CLOSER / ratio) ** dim
    for count in (1, min(dim + 2, len(order)), len(order)):
        offsets: Array = np.ascontiguousarray(lattice[order[:count]])
        near = distances[order[:count]]
        values = np.array([scale * kernel.value(r / ratio * CLOSER) for r in near.tolist()])
        yield offsets, near, values, np.ones(count), support, lift.copy(), np.full(count, np.nan)
