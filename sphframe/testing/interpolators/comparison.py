"""Testing: how weights are compared: tolerances, evaluation, and the words of a failure.

Weights are compared within round-off times the condition number of the neighbourhood (:func:`tolerance`); where the
geometry does not determine an answer, only gross errors count.
"""

import numpy as np
from numpy.typing import NDArray

from sphframe.interfaces import BoundaryInterpolator
from sphframe.interfaces.traits import Status
from sphframe.testing.evaluation import Evaluate, Outcome, evaluator, title
from sphframe.testing.neighbourhoods import Cloud, condition
from sphframe.testing.proof import BrokenPromiseError

__all__ = [
    "CLEAR",
    "broken",
    "degree_of",
    "difference_between",
    "evaluator_of",
    "invariance_tolerance",
    "shortened",
    "status_name",
    "tolerance",
]

CLEAR = 1e-3
"""of the cut-off radius: beyond, round-off in r is magnified by methods whose weights vanish there"""
_EPSILON = float(np.finfo(np.float64).eps)
_COARSEST = 1e-4


def tolerance(cloud: Cloud, outcome: Outcome, degree: int) -> float:
    """Return the round-off to be expected in a sum of weights of a method of ``degree``, times a safety factor."""
    limit = 100.0 * _EPSILON * (condition(cloud, degree) + len(cloud)) * outcome.magnitude
    return min(limit, _COARSEST * outcome.magnitude)


def invariance_tolerance(cloud: Cloud, outcome: Outcome, degree: int) -> float:
    """Return the difference allowed between weights of two equivalent neighbourhoods."""
    return min(1e3 * tolerance(cloud, outcome, degree), _COARSEST * outcome.magnitude)


def degree_of(method: BoundaryInterpolator) -> int:
    """The degree of the polynomials behind the method, for its condition number; a method may not keep what it has."""
    degree = method.traits.reproduces_degree
    return degree if method.traits.non_negative else max(1, degree)


def evaluator_of(method: BoundaryInterpolator, dim: int, garbage: float = np.nan) -> Evaluate:
    """Return the function that evaluates the method; a weights function that cannot be made breaks the interface."""
    try:
        return evaluator(method, dim, garbage=garbage)
    except Exception as error:
        raise BrokenPromiseError(
            f"{title(method)} in {dim}-D: the weights function cannot be made: {type(error).__name__}: {error}"
        ) from error


def broken(method: BoundaryInterpolator, dim: int, complaint: str, cloud: Cloud | None = None) -> BrokenPromiseError:
    """Return the error that the method does not have a property, with the cloud as code."""
    code = "" if cloud is None else f", for\n\n    cloud = {cloud!r}\n"
    return BrokenPromiseError(f"{title(method)} in {dim}-D: {complaint}{code}")


def difference_between(
    method: BoundaryInterpolator, cloud: Cloud, before: Outcome, after: Outcome, degree: int
) -> str | None:
    """Say how two answers that should be equal differ."""
    if not method.traits.continuous:
        r = np.sort(cloud.distances)
        if len(r) > 1 and r[1] - r[0] <= 1e-6 * cloud.support:
            return None  # two particles are nearest: the method may choose either
    if before.status != after.status:
        if condition(cloud, max(1, degree)) > 1e6:
            return None  # on the brink
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


def shortened(weights: NDArray[np.float64]) -> str:
    """Return the first weights as text."""
    return f"{weights[:6].tolist()}{' ...' if len(weights) > 6 else ''}"
