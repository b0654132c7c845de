"""Testing: the weights of an interpolation method: finite, bounded, with sum one, exact on polynomials."""

import numpy as np
from scipy.sparse import csr_array

from sphframe.arrays import IntArray
from sphframe.boundary.operator import operator
from sphframe.boundary.promises import first_contradiction
from sphframe.interfaces import BoundaryInterpolator
from sphframe.interfaces.traits import DRY, OK, Status
from sphframe.testing.interpolators.comparison import broken, degree_of, evaluator_of, shortened, status_name, tolerance
from sphframe.testing.neighbourhoods import Cloud
from sphframe.testing.proof import prove

LARGEST_SUM = 1000.0
"""largest sum of |weights| that a method may return: above it, noise of 0.1 % is as large as the field"""


def check_honest_status(method: BoundaryInterpolator, dim: int) -> None:
    """Every cloud gets finite weights and a known status; only points without neighbours are DRY."""
    run = evaluator_of(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        try:
            outcome = run(cloud)
        except Exception as error:
            return f"the compiled function raises {type(error).__name__}: {error}; it must return a status instead"
        if outcome.status not in tuple(Status):
            return f"the status is {outcome.status}, which is not one of sphframe.Status"
        if outcome.status == DRY:
            return f"the status is DRY with {len(cloud)} neighbours; DRY is only for points without any"
        if not np.all(np.isfinite(outcome.weights)):
            return f"the weights are {shortened(outcome.weights)} (status {Status(outcome.status).name})"
        return None

    prove(method, dim, "weights must be finite, and the status known, for every cloud", wrong_with)

    if dim == 3:
        return  # a point without neighbours is that of the operator, whatever the dimension
    far_away = np.full((1, dim), 10.0)
    matrix, statuses = operator(method, np.zeros(dim), far_away, 1.0, smoothing_length=1.0)
    if statuses.tolist() != [DRY] or matrix.nnz:
        raise broken(method, dim, f"a point without neighbours has the status {statuses[0]} and {matrix.nnz} weights")


def check_guards(method: BoundaryInterpolator, dim: int) -> None:
    """The guards of a run accept the weights: they are finite and have the declared sign and sum."""
    run = evaluator_of(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        row = csr_array(outcome.weights[None, :])
        found = first_contradiction(method.traits, row, np.array([outcome.status]))
        return None if found is None else f"a run would stop with {found.what} (sum {found.sum:.9g})"

    prove(method, dim, "the guards of runs must accept the weights", wrong_with)


def check_bounded_weights(method: BoundaryInterpolator, dim: int) -> None:
    """sum_j |Phi_j| stays below 1000: where it would be larger, a method returns SINGULAR."""
    run = evaluator_of(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if outcome.magnitude > LARGEST_SUM:
            return f"sum |Phi_j| = {outcome.magnitude:.3g} (status {status_name(outcome)})"
        return None

    prove(method, dim, f"sum |Phi_j| must not exceed {LARGEST_SUM:g}", wrong_with)


def check_partition_of_unity(method: BoundaryInterpolator, dim: int) -> None:
    """sum_j Phi_j = 1 for any status: a constant field is reproduced."""
    run, degree = evaluator_of(method, dim), degree_of(method)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        total = float(np.sum(outcome.weights))
        if not abs(total - 1.0) <= tolerance(cloud, outcome, degree):
            return (
                f"the weights of {len(cloud)} neighbours sum to {total:.15g}, not to 1 (status {status_name(outcome)})"
            )
        return None

    prove(method, dim, "weights must sum to one (partition of unity)", wrong_with)


def check_non_negative(method: BoundaryInterpolator, dim: int) -> None:
    """Phi_j >= 0."""
    run = evaluator_of(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if not np.all(outcome.weights >= 0.0):
            return f"the smallest weight is {np.min(outcome.weights):.3g} (status {status_name(outcome)})"
        return None

    prove(method, dim, "weights must not be negative", wrong_with)


def check_range_restricted(method: BoundaryInterpolator, dim: int) -> None:
    """Min f <= sum_j Phi_j f_j <= max f, for the fields with the largest value of the sum and for random ones."""
    run = evaluator_of(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        phi = outcome.weights
        fields = [
            np.where(phi > 0.0, 1.0, -1.0),
            np.ones(len(phi)),
            *np.random.default_rng(0).normal(size=(2, len(phi))),
        ]
        for field in fields:
            value = float(phi @ field)
            slack = tolerance(cloud, outcome, 0) * np.max(np.abs(field))
            if not field.min() - slack <= value <= field.max() + slack:
                return f"a field between {field.min():.6g} and {field.max():.6g} gives {value:.15g}"
        return None

    prove(method, dim, "the value must lie between the smallest and the largest value of the neighbours", wrong_with)


def check_linear_reproduction(method: BoundaryInterpolator, dim: int) -> None:
    """Linear fields are reproduced where the status is OK; at the ghost for a method that extrapolates."""
    _check_reproduction(method, dim, 1)


def check_quadratic_reproduction(method: BoundaryInterpolator, dim: int) -> None:
    """Quadratic fields are reproduced where the status is OK."""
    _check_reproduction(method, dim, 2)


def _check_reproduction(method: BoundaryInterpolator, dim: int, degree: int) -> None:
    run = evaluator_of(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if outcome.status != OK:
            return None
        scale = cloud.support
        x, target = cloud.offsets / scale, cloud.lift / scale
        # the ghost may lie outside the cut-off, where the monomials are larger
        slack = tolerance(cloud, outcome, degree) * max(1.0, float(np.sum(target**2)))
        for exponents, name in _monomials(dim, degree):
            value = float(outcome.weights @ np.prod(x**exponents, axis=1))
            wanted = float(np.prod(target**exponents))
            if not abs(value - wanted) <= slack:
                return f"with lengths in R, the field {name} gives {value:.12g} instead of {wanted:.12g}"
        return None

    name = "linear" if degree == 1 else "quadratic"
    prove(method, dim, f"{name} fields must be reproduced where the status is OK", wrong_with)


def _monomials(dim: int, degree: int) -> list[tuple[IntArray, str]]:
    found = []
    for a in range(dim):
        exponents = np.zeros(dim, dtype=np.int64)
        exponents[a] += 1
        found.append((exponents, "xyz"[a]))
        for b in range(a + 1 if degree == 2 else 0):
            product = exponents.copy()
            product[b] += 1
            found.append((product, f"{'xyz'[a]} {'xyz'[b]}"))
    return found


def check_interpolates_particles(method: BoundaryInterpolator, dim: int) -> None:
    """At a particle the value is that of the particle; where several coincide, the others have no weight."""
    run = evaluator_of(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        here = cloud.distances == 0.0
        if not here.any():
            return None
        outcome = run(cloud.changed(lift=np.zeros(dim)))
        there = float(np.sum(outcome.weights[here]))
        if not abs(there - 1.0) <= tolerance(cloud, outcome, 0) or np.any(outcome.weights[~here] != 0.0):
            return f"the {int(here.sum())} particle(s) at the point have the weight {there:.12g} in total"
        return None

    families = ("at a particle", "coincident", "few at a particle")
    prove(method, dim, "at a particle, the value must be that of the particle", wrong_with, families)
