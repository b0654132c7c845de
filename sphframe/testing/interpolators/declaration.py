"""Testing: the declared traits of an interpolation method, and the fewest neighbours that it needs."""

import numpy as np
from scipy.optimize import nnls

from sphframe.interfaces import BoundaryInterpolator, EvaluationPoint, Traits
from sphframe.interfaces.traits import OK
from sphframe.testing.evaluation import title
from sphframe.testing.interpolators.comparison import broken, evaluator_of, status_name
from sphframe.testing.neighbourhoods import REGULAR, Cloud, condition, magnification
from sphframe.testing.proof import BrokenPromiseError, prove

WELL_PLACED = 2.0
"""largest sum of |weights| of a quadratic fit for which a method must return OK"""
AROUND = 1.2
"""the same of a linear fit, for few neighbours: the particles are on all sides of the point"""
EXTRAPOLATED = 5.0
"""the same of a linear fit that is evaluated at the ghost: methods that extrapolate may refuse to magnify noise more"""
NEAR = 0.75
"""distance over the support up to which a neighbour counts for a linear fit: the kernel hardly counts others"""


def check_traits(method: BoundaryInterpolator, dim: int) -> None:
    """The traits have valid values and do not contradict each other."""
    traits = method.traits
    if not isinstance(traits, Traits):
        raise BrokenPromiseError(f"{title(method)}: traits must be a sphframe.Traits, got {traits!r}")
    fewest: object = traits.fewest_points
    if not (isinstance(fewest, tuple) and len(fewest) == 2 and all(isinstance(n, int) and n >= 1 for n in fewest)):
        raise BrokenPromiseError(
            f"{title(method)}: fewest_points must be two whole numbers, for 2-D and 3-D, got {fewest!r}"
        )
    if traits.reproduces_degree not in (0, 1, 2):
        raise BrokenPromiseError(
            f"{title(method)}: reproduces_degree must be 0, 1 or 2, got {traits.reproduces_degree!r}"
        )
    if not isinstance(traits.evaluation_point, EvaluationPoint):
        raise BrokenPromiseError(
            f"{title(method)}: evaluation_point must be a sphframe.EvaluationPoint, got {traits.evaluation_point!r}"
        )
    if traits.range_restricted and not (traits.partition_of_unity and traits.non_negative):
        raise BrokenPromiseError(
            f"{title(method)}: range_restricted needs partition_of_unity and non_negative; a value between the smallest"
            f" and the largest for every field is a weighted mean"
        )
    if traits.reproduces_degree > 0 and not traits.partition_of_unity:
        raise BrokenPromiseError(
            f"{title(method)}: a method exact on linear fields is exact on constants: partition_of_unity"
        )
    needed = (dim + 1) if traits.reproduces_degree == 1 else (dim + 1) * (dim + 2) // 2
    if traits.reproduces_degree > 0 and fewest[dim - 2] < needed:
        raise BrokenPromiseError(
            f"{title(method)}: fewest_points says {fewest[dim - 2]} in {dim}-D, but polynomials of degree"
            f" {traits.reproduces_degree} have {needed} coefficients"
        )


def check_fewest_points(method: BoundaryInterpolator, dim: int) -> None:
    """With ``fewest_points`` neighbours in general position the status is OK, with one fewer it is not."""
    run = evaluator_of(method, dim)
    fewest = method.traits.fewest_points[dim - 2]
    for seed in range(10):
        cloud = _general_position(dim, fewest, seed)
        outcome = run(cloud)
        if outcome.status != OK:
            raise broken(
                method,
                dim,
                f"fewest_points declares OK for {fewest} neighbours in general position, but the status is"
                f" {status_name(outcome)}",
                cloud,
            )
        if fewest > 1:
            cloud = cloud.members(np.arange(fewest - 1))
            outcome = run(cloud)
            if outcome.status == OK:
                raise broken(
                    method,
                    dim,
                    f"fewest_points says {fewest}, but the status is OK with {fewest - 1} neighbours: declare fewer, or"
                    f" return TOO_FEW",
                    cloud,
                )

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if outcome.status == OK and len(cloud) < fewest:
            return f"the status is OK with {len(cloud)} neighbours, and fewest_points says {fewest}"
        return None

    prove(method, dim, "the status must not be OK for fewer neighbours than fewest_points", wrong_with)

    def refused(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if outcome.status != OK and len(cloud) >= fewest and _well_placed(method, cloud):
            return f"the status is {status_name(outcome)} with {len(cloud)} well-placed neighbours"
        return None

    prove(method, dim, "the status must be OK for a well-placed neighbourhood", refused, REGULAR)
    for count in range(fewest, 40, 1 if dim == 2 else 3):  # no needless refusals for some number of neighbours
        for seed in range(3):
            cloud = _general_position(dim, count, seed)
            complaint = refused(cloud)
            if complaint:
                raise broken(method, dim, f"the status must be OK for a well-placed neighbourhood; {complaint}", cloud)


def _well_placed(method: BoundaryInterpolator, cloud: Cloud) -> bool:
    """Whether the neighbours surely determine the weights of a method of its kind, without much noise."""
    traits, fewest = method.traits, method.traits.fewest_points[cloud.dim - 2]
    extrapolates = traits.evaluation_point is EvaluationPoint.EXTRAPOLATED
    near = cloud.members(np.flatnonzero(cloud.distances < NEAR * cloud.support))

    def fits(part: Cloud, degree: int, largest_condition: float, most: float) -> bool:
        if condition(part, degree) > largest_condition or magnification(part, degree) > most:
            return False
        return not extrapolates or magnification(part, 1, at_ghost=True) < EXTRAPOLATED

    placed = len(cloud) >= 3 * fewest and fits(cloud, 2, 1e5, WELL_PLACED)
    if not placed and traits.reproduces_degree <= 1 and len(near) >= 2 * fewest:  # with fewer, the kernel decides
        placed = fits(near, 1, 1e3, AROUND)
    convex = traits.non_negative and traits.reproduces_degree > 0  # no such weights outside the hull of the particles
    return placed and not (convex and _beside(cloud))


def _beside(cloud: Cloud) -> bool:
    """Whether the point is outside the hull of the particles: it is no mean of them with weights of at least zero."""
    matrix = np.vstack([cloud.offsets.T / cloud.support, np.ones(len(cloud))])
    return bool(nnls(matrix, np.append(np.zeros(cloud.dim), 1.0))[1] > 1e-9)


def _general_position(dim: int, count: int, seed: int) -> Cloud:
    """A cloud of ``count`` vertices and edge midpoints of a randomly rotated regular simplex around the point.

    All of them, six in 2-D and ten in 3-D, determine a quadratic polynomial. Further particles are at random places.
    """
    rng = np.random.default_rng(seed)
    vertices = np.linalg.qr(np.column_stack([np.ones(dim + 1), np.eye(dim + 1)[:, :dim]]))[0][:, 1:]
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    middles = [0.5 * (vertices[a] + vertices[b]) for a in range(dim + 1) for b in range(a)]
    points = np.array([*vertices, *middles])
    if count > len(points):
        points = np.concatenate([points, rng.uniform(-0.5, 0.5, (count - len(points), dim))])
    rotation = np.linalg.qr(rng.normal(size=(dim, dim)))[0]
    points = points[:count] @ rotation.T + rng.uniform(-0.1, 0.1, (count, dim))
    return Cloud(1.5 * points, rng.uniform(0.8, 1.2, count), 3.9)
