"""Testing: the weights of a method on one cloud, computed by the compiled loop that :func:`operator` uses."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.operator import Workspace, weights_loop
from sphframe.errors import BrokenPluginError
from sphframe.interfaces import BoundaryInterpolator, CompiledKernel, EvaluationPoint, Kernel
from sphframe.registry import create
from sphframe.testing.neighbourhoods import Cloud


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
    """
    chosen = create("kernels", kernel) if isinstance(kernel, str) else kernel
    loop = weights_loop(method, chosen, dim)

    def run(cloud: Cloud) -> Outcome:
        outcome, work = run_loop(loop, cloud, chosen, garbage)
        if work.touched():
            raise BrokenPluginError(f"{title(method)} writes before or after its array {work.touched()[0]!r}")
        return outcome

    return run


def run_loop(loop: Callable[..., None], cloud: Cloud, kernel: Kernel, garbage: float) -> tuple[Outcome, Workspace]:
    """Return the result of a method's ``loop`` on one cloud, and the memory that it has used."""
    n, dim = len(cloud), cloud.dim
    out, work = np.full(n, garbage), Workspace.of(n, dim)
    statuses = np.empty(1, dtype=np.int64)
    scale = kernel.normalisation(dim) / (cloud.support / kernel.support) ** dim
    loop(
        cloud.offsets, cloud.volumes, np.zeros((1, dim)), cloud.lift[None, :], np.array([0, n]), np.arange(n),
        cloud.support, scale, work, out, statuses,
    )  # fmt: skip
    return Outcome(out, int(statuses[0])), work


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
