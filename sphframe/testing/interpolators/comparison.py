"""Testing: comparison of the weights of interpolation methods: tolerances, and messages about differences.

Weights are compared within round-off times the condition number of the neighbourhood (:func:`tolerance`); where the
geometry does not determine the weights, only large errors are reported.
"""

import functools
from collections.abc import Callable

import numpy as np

from sphframe.arrays import Array
from sphframe.interfaces import BoundaryInterpolator
from sphframe.interfaces.traits import Status
from sphframe.testing.evaluation import KERNEL, KERNELS, Evaluate, Outcome, evaluator, title
from sphframe.testing.neighbourhoods import Cloud, condition
from sphframe.testing.proof import BrokenPromiseError

CLEAR = 1e-3
"""share of the cut-off radius: particles this near to it are left out, as vanishing weights magnify round-off"""
_EPSILON = float(np.finfo(np.float64).eps)
_COARSEST = 1e-4
CheckFunction = Callable[[BoundaryInterpolator, int], None]


def with_each_kernel(check: CheckFunction) -> CheckFunction:
    """Return ``check``, made once with each kernel; its message names the second one."""

    @functools.wraps(check)
    def each(method: BoundaryInterpolator, dim: int) -> None:
        for kernel in KERNELS:
            token = KERNEL.set(kernel)
            try:
                check(method, dim)
            except BrokenPromiseError as error:
                if kernel == KERNELS[0]:
                    raise
                raise BrokenPromiseError(f"with the kernel {kernel}, {error}") from error
            finally:
                KERNEL.reset(token)

    return each


def tolerance(cloud: Cloud, outcome: Outcome, degree: int) -> float:
    """Return the round-off to be expected in a sum of weights of a method of ``degree``, times a safety factor."""
    limit = 100.0 * _EPSILON * (condition(cloud, degree) + len(cloud)) * outcome.magnitude
    return min(limit, _COARSEST * outcome.magnitude)


def invariance_tolerance(cloud: Cloud, outcome: Outcome, degree: int) -> float:
    """Return the difference allowed between weights of two equivalent neighbourhoods."""
    return min(1e3 * tolerance(cloud, outcome, degree), _COARSEST * outcome.magnitude)


def degree_of(method: BoundaryInterpolator) -> int:
    """Degree of the polynomials that determine the condition number of the method.

    A method with negative weights may fit linear functions without declaring that it reproduces them.
    """
    degree = method.traits.reproduces_degree
    return degree if method.traits.non_negative else max(1, degree)


def evaluator_of(method: BoundaryInterpolator, dim: int, garbage: float = np.nan) -> Evaluate:
    """Return the function that evaluates the method.

    Raises
    ------
    BrokenPromiseError
        the weights function cannot be made.
    """
    try:
        return evaluator(method, dim, KERNEL.get(), garbage=garbage)
    except Exception as error:
        raise BrokenPromiseError(
            f"{title(method)} in {dim}-D: the weights function cannot be made: {type(error).__name__}: {error}"
        ) from error


def broken(method: BoundaryInterpolator, dim: int, complaint: str, cloud: Cloud | None = None) -> BrokenPromiseError:
    """Return the error that says which property the method lacks, with the cloud as code."""
    code = "" if cloud is None else f", for\n\n    cloud = {cloud!r}\n"
    return BrokenPromiseError(f"{title(method)} in {dim}-D: {complaint}{code}")


def difference_between(
    method: BoundaryInterpolator, cloud: Cloud, before: Outcome, after: Outcome, degree: int
) -> str | None:
    """Return how two results that should be equal differ, or None where they agree."""
    if not method.traits.continuous:
        r = np.sort(cloud.distances)
        if len(r) > 1 and r[1] - r[0] <= 1e-6 * cloud.support:
            return None  # two particles are equally near: a discontinuous method may take either
    if before.status != after.status:
        if condition(cloud, max(1, degree)) > 1e6:
            return None  # close to singular: round-off decides the status
        return f"changes the status from {status_name(before)} to {status_name(after)}"
    if len(before.weights) != len(after.weights):
        return None
    difference = float(np.max(np.abs(before.weights - after.weights)))
    if not difference <= invariance_tolerance(cloud, before, degree):
        return f"changes a weight by {difference:.3g}"
    return None


def status_name(outcome: Outcome) -> str:
    """Return the name of the status, or its number where it is not one of sphframe.Status."""
    return Status(outcome.status).name if outcome.status in tuple(Status) else str(outcome.status)


def shortened(weights: Array) -> str:
    """Return the first weights as text."""
    return f"{weights[:6].tolist()}{' ...' if len(weights) > 6 else ''}"
