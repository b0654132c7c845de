"""Testing: the weights of a method on one cloud, computed by its compiled functions."""

from collections.abc import Callable
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

import numba
import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.operator import MARGIN, Workspace
from sphframe.boundary.trial import weights_functions
from sphframe.compiled import specialise
from sphframe.compiled.stand_ins import FALLBACK, VALUE, WEIGHTS
from sphframe.interfaces import BoundaryInterpolator, CompiledKernel, EvaluationPoint, Kernel
from sphframe.interfaces.traits import OK
from sphframe.kernels import compiled_kernel
from sphframe.registry import create
from sphframe.testing.neighbourhoods import Cloud

KERNELS = ("gaussian", "wendland-c2")
"""the kernels, of supports 3 h and 2 h, with which checks of methods are made"""
KERNEL: ContextVar[str] = ContextVar("kernel", default=KERNELS[0])
"""the kernel of the check in progress"""


@dataclass(frozen=True)
class Outcome:
    """The result of a method: its status, and the weights (n,); those of the fallback where the status is not OK."""

    weights: Array
    status: int

    @property
    def magnitude(self) -> float:
        """``sum_j |Phi_j|``, at least 1."""
        return max(1.0, float(np.sum(np.abs(self.weights))))


Evaluate = Callable[[Cloud], Outcome]


def evaluate(method: BoundaryInterpolator, cloud: Cloud, kernel: str | Kernel = "gaussian") -> Outcome:
    """Return the weights of ``method`` on ``cloud``, and its status.

    Examples
    --------
    >>> from sphframe import create
    >>> from sphframe.testing import Cloud, evaluate
    >>> cloud = Cloud([[0.0, 1.0], [0.0, -1.0], [1.0, 0.0]], volumes=[1.0, 1.0, 2.0], support=3.0)
    >>> evaluate(create("interpolators", "normalized"), cloud).weights.tolist()
    [0.25, 0.25, 0.5]
    """
    return evaluator(method, cloud.dim, kernel)(cloud)


def evaluator(
    method: BoundaryInterpolator, dim: int, kernel: str | Kernel = "gaussian", *, garbage: float = np.nan
) -> Evaluate:
    """Return the function that evaluates ``method`` on clouds of ``dim`` dimensions.

    Each entry of ``out`` has the value ``garbage`` before the weights are computed.

    Raises
    ------
    BrokenPluginError
        by that function, when something is written before or after an array.
    """
    loop = point_loop(method, dim, kernel)

    def run(cloud: Cloud) -> Outcome:
        outcome, work = loop(cloud, garbage)
        work.check(method)
        return outcome

    return run


def point_loop(
    method: BoundaryInterpolator, dim: int, kernel: str | Kernel = "gaussian"
) -> Callable[[Cloud, float], tuple[Outcome, Workspace]]:
    """Return a function of a cloud, and of what ``out`` holds before, that gives the result and the memory used."""
    chosen = create("kernels", kernel) if isinstance(kernel, str) else kernel
    weights, fallback = weights_functions(method, compiled_kernel(chosen, dim), dim)
    weigh = specialise(_weigh, {"WEIGHTS": weights, "FALLBACK": fallback}, parallel=False)
    values, normalisation = _values_of(chosen, dim, named=isinstance(kernel, str)), chosen.normalisation(dim)

    def run(cloud: Cloud, garbage: float) -> tuple[Outcome, Workspace]:
        work, inside = Workspace.of(len(cloud), dim), slice(MARGIN, MARGIN + len(cloud))
        h = cloud.support / chosen.support
        work.offsets[inside], work.distances[inside], work.volumes[inside] = (
            cloud.offsets,
            cloud.distances,
            cloud.volumes,
        )
        values(cloud.distances, 1.0 / h, normalisation / h**dim, work.kernel_values[inside])
        work.out[inside] = garbage
        status = weigh(*(array[inside] for array in work[:4]), cloud.support, cloud.lift, work.out[inside])
        return Outcome(work.out[inside].copy(), int(status)), work

    return run


def _values_of(kernel: Kernel, dim: int, *, named: bool) -> Callable[[Array, float, float, Array], None]:
    """Return :func:`_values` for a kernel, compiled for one that has a name, with which many clouds are evaluated."""
    if named and not numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        return specialise(_values, {"VALUE": compiled_kernel(kernel, dim).value}, parallel=False)
    value = kernel.value_function()

    def values(distances: Array, per_h: float, scale: float, out: Array) -> None:
        out[:] = [scale * value(r * per_h) for r in distances.tolist()]

    return values


def _values(distances, per_h, scale, out):  # type: ignore[no-untyped-def]
    for j in range(distances.shape[0]):
        out[j] = scale * VALUE(distances[j] * per_h)


def _weigh(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
    status = WEIGHTS(offsets, distances, kernel_values, volumes, support, lift, out)
    if status != OK:
        FALLBACK(offsets, distances, kernel_values, volumes, support, lift, out)
    return status


def plain_evaluator(method: BoundaryInterpolator, dim: int, kernel: str = "gaussian") -> Evaluate:
    """Return the same as :func:`evaluator`, run by the Python interpreter and without the fallback."""
    chosen = create("kernels", kernel)
    value = chosen.value_function()
    functions = CompiledKernel(
        value,
        chosen.gradient_function(),
        chosen.support,
        chosen.normalisation(dim),
        chosen.gradient_of_square_function(),
        chosen.edge_integrals_function() if dim == 2 else None,
    )
    weights = method.point_weights(functions, dim)

    def run(cloud: Cloud) -> Outcome:
        h = cloud.support / chosen.support
        values = np.array([functions.normalisation / h**dim * value(r / h) for r in cloud.distances])
        out = np.full(len(cloud), np.nan)
        with np.errstate(all="ignore"):
            status = weights(
                cloud.offsets, cloud.distances, values, cloud.volumes, cloud.support, cloud.lift, out
            )  # fmt: skip
        return Outcome(out, int(status))

    return run


def extrapolates(method: BoundaryInterpolator) -> bool:
    """Whether the method extrapolates along a lift, from the evaluation point to the ghost."""
    return method.traits.evaluation_point is EvaluationPoint.EXTRAPOLATED


def title(component: Any) -> str:
    """The component as code, shortened; messages name the component so."""
    text = repr(component)
    return f"{type(component).__name__}()" if text.startswith("<") else text
