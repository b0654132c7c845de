"""Testing: changes of a neighbourhood that must not change the weights of an interpolation method."""

import itertools

import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.operator import operator
from sphframe.compiled import compile_part
from sphframe.interfaces import BoundaryInterpolator, EvaluationPoint, Kernel
from sphframe.interfaces.edge_integrals import ScalarFunction
from sphframe.interfaces.traits import OK
from sphframe.registry import create
from sphframe.testing.evaluation import Evaluate, Outcome, evaluator, extrapolates
from sphframe.testing.interpolators.comparison import (
    CLEAR,
    broken,
    degree_of,
    difference_between,
    evaluator_of,
    invariance_tolerance,
)
from sphframe.testing.neighbourhoods import REGULAR, SPARSE, Cloud, build
from sphframe.testing.proof import prove


def check_rotation_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """Rotating the cloud, and the lift with it, changes no weight."""
    rotations = [np.linalg.qr(np.random.default_rng(seed).normal(size=(dim, dim)))[0] for seed in (1, 2)]
    for rotation in rotations:
        rotation[:, 0] *= np.linalg.det(rotation)
    _check_orthogonal(method, dim, "rotating", rotations)


def check_reflection_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """Reflecting the cloud, and the lift with it, changes no weight."""
    _check_orthogonal(method, dim, "reflecting", [np.diag([-1.0] + [1.0] * (dim - 1))])


def _check_orthogonal(method: BoundaryInterpolator, dim: int, doing: str, maps: list[Array]) -> None:
    run, degree = evaluator_of(method, dim), degree_of(method)

    def wrong_with(cloud: Cloud) -> str | None:
        cloud = cloud.clear_of_cut_off(CLEAR)
        outcome = run(cloud)
        for matrix in maps:
            moved = cloud.changed(np.ascontiguousarray(cloud.offsets @ matrix.T), lift=matrix @ cloud.lift)
            difference = difference_between(method, cloud, outcome, run(moved), degree)
            if difference is not None:
                return f"{doing} the cloud by {matrix.round(3).tolist()} {difference}"
        return None

    prove(method, dim, f"{doing} the neighbourhood must not change the weights", wrong_with, SPARSE)


def check_permutation_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """The weights do not depend on the order of the particles."""
    run, degree = evaluator_of(method, dim), degree_of(method)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        for order in (np.arange(len(cloud))[::-1], np.random.default_rng(0).permutation(len(cloud))):
            answer = run(cloud.members(order))
            unpermuted = np.empty(len(cloud))
            unpermuted[order] = answer.weights
            difference = difference_between(method, cloud, outcome, Outcome(unpermuted, answer.status), degree)
            if difference is not None:
                return f"taking the particles in the order {order.tolist()[:12]} {difference}"
        return None

    families = (*SPARSE, "coincident", "lattice")
    prove(method, dim, "weights must not depend on the order of the particles", wrong_with, families)


def check_scale_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """Scaling all lengths by a power of two, from micrometres to kilometres, changes no weight."""
    _check_scaling(method, dim, (2.0**-20, 2.0**10))


def check_unit_independence(method: BoundaryInterpolator, dim: int) -> None:
    """Metres, millimetres and feet give the same weights."""
    _check_scaling(method, dim, (1000.0, 1.0 / 0.3048))


def _check_scaling(method: BoundaryInterpolator, dim: int, factors: tuple[float, ...]) -> None:
    run, degree = evaluator_of(method, dim), degree_of(method)

    def wrong_with(cloud: Cloud) -> str | None:
        cloud = cloud.clear_of_cut_off(CLEAR)
        outcome = run(cloud)
        for factor in factors:
            difference = difference_between(method, cloud, outcome, run(cloud.scaled(factor)), degree)
            if difference is not None:
                return f"multiplying all lengths by {factor:.6g} {difference}"
        return None

    prove(method, dim, "weights must not depend on the unit of length", wrong_with, SPARSE)


def check_translation_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """Moving point and particles together changes no weight, in :func:`sphframe.boundary.operator.operator`."""
    if dim == 3:
        return  # what the operator does with a method does not depend on the dimension
    lift = np.linspace(0.5, 1.0, dim) if extrapolates(method) else None
    for family in REGULAR:
        for seed in range(3):
            cloud = build(family, dim, seed, ratio=1.3 if dim == 2 else 1.0)
            positions = np.round(cloud.offsets * 2.0**20) * 2.0**-20  # so that shifting is exact
            h = cloud.support / 3.0
            point = np.zeros(dim)
            shift = 1024.0 * np.arange(1.0, dim + 1)
            here, _ = operator(method, point, positions, cloud.volumes, smoothing_length=h, lift=lift)
            there, _ = operator(method, point + shift, positions + shift, cloud.volumes, smoothing_length=h, lift=lift)
            difference = float(np.max(np.abs(here.toarray() - there.toarray())))
            if not difference <= 1e-12 * Outcome(here.data, OK).magnitude:
                raise broken(
                    method,
                    dim,
                    f"moving the point and the particles by {shift.tolist()} changes a weight by {difference:.3g};"
                    f" weights must depend only on offsets",
                    cloud,
                )


def check_volume_independence(method: BoundaryInterpolator, dim: int) -> None:
    """The weights do not depend on the particles' volumes, where the status is OK."""
    run, degree = evaluator_of(method, dim), degree_of(method)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        volumes = cloud.volumes.mean() * 10.0 ** np.random.default_rng(0).uniform(-1.0, 1.0, len(cloud))
        answer = run(cloud.changed(volumes=volumes))
        if OK not in (outcome.status, answer.status):
            return None  # the fallback may depend on them
        difference = difference_between(method, cloud, outcome, answer, degree)
        return None if difference is None else f"other volumes {difference}"

    prove(method, dim, "weights must not depend on the volumes", wrong_with, SPARSE)


def check_continuity(method: BoundaryInterpolator, dim: int) -> None:
    """The weights are continuous along segments on which the evaluation point moves, and where a particle enters.

    Each segment is halved again and again, towards the larger change: what remains of it on a length of 1e-12 R is a
    jump. A particle that enters the support has no weight at first, unless the method ``jumps_at_cut_off``.
    """
    run, degree = evaluator_of(method, dim), degree_of(method)

    def wrong_with(cloud: Cloud) -> str | None:
        rng = np.random.default_rng(len(cloud))
        reach = 0.5 * rng.uniform(0.2, 1.0) * cloud.support
        direction = np.linalg.qr(rng.normal(size=(dim, dim)))[0][0]
        nearest = cloud.offsets[np.argsort(cloud.distances, kind="stable")[:2]]
        ends = [(reach * direction, -reach * direction)]
        if len(nearest) == 2:  # across the place where another particle becomes the nearest one
            ends.append((0.5 * nearest.sum(axis=0) - 0.3 * (nearest[1] - nearest[0]), 0.8 * nearest[1]))
        for start, end in ends:
            found = _jump(run, cloud, start, end, degree, method.traits.jumps_at_cut_off)
            if found:
                return found
        return None

    prove(method, dim, "weights must be continuous in the evaluation point", wrong_with, REGULAR, drawn=False)


def _jump(run: Evaluate, cloud: Cloud, start: Array, end: Array, degree: int, may_enter: bool) -> str | None:
    """Return what jumps where the evaluation point moves from ``start`` to ``end``; None where nothing does."""
    support = cloud.support

    def at(share: float) -> tuple[Array, Outcome | None]:
        moved = cloud.changed(cloud.offsets - (start + share * (end - start)))
        inside = moved.distances < support
        weights = np.zeros(len(cloud))
        if not inside.any():
            return weights, None
        outcome = run(moved.members(inside))
        weights[inside] = outcome.weights
        return (np.where(inside, weights, np.nan) if may_enter else weights), outcome

    def change(one: tuple[Array, Outcome | None], other: tuple[Array, Outcome | None]) -> float:
        (a, before), (b, after) = one, other
        if before is None or after is None or (before.status, after.status) != (OK, OK):
            return 0.0
        if may_enter and not np.array_equal(np.isnan(a), np.isnan(b)):
            return 0.0
        return float(np.nanmax(np.abs(a - b)))

    grid = np.linspace(0.0, 1.0, 9)
    found = [at(share) for share in grid]
    changes = [change(one, other) for one, other in itertools.pairwise(found)]
    for k in np.argsort(changes)[-3:]:  # where the weights change most
        (low, high), (first, last) = (grid[k], grid[k + 1]), (found[k], found[k + 1])
        if changes[k] == 0.0 or last[1] is None:
            continue
        near = cloud.changed(cloud.offsets - (start + low * (end - start)))
        slack = invariance_tolerance(near, last[1], degree)
        for _ in range(40):
            middle = 0.5 * (low + high)
            half = at(middle)
            if change(first, half) >= change(half, last):
                high, last = middle, half
            else:
                low, first = middle, half
            jump = change(first, last)
            if jump <= slack:
                break
        else:
            return (
                f"moving the evaluation point by {(high - low) * np.linalg.norm(end - start):.3g}, at"
                f" {(start + low * (end - start)).tolist()}, changes a weight by {jump:.3g}; if a particle enters the"
                " support there, declare jumps_at_cut_off"
            )
    return None


def check_additivity(method: BoundaryInterpolator, dim: int) -> None:
    """Two particles at one place have the weight of one with their volume together, if weights depend on volumes."""
    run, degree = evaluator_of(method, dim), degree_of(method)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        smaller = cloud.volumes.copy()
        smaller[0] *= 0.5
        if np.abs(run(cloud.changed(volumes=smaller)).weights - outcome.weights).max() <= 1e-12 * outcome.magnitude:
            return None  # the weights do not depend on volumes, though this is not declared
        part = np.append(cloud.volumes, 0.5 * cloud.volumes[0])
        part[0] *= 0.5
        answer = run(cloud.changed(np.concatenate([cloud.offsets, cloud.offsets[:1]]), part))
        weights = answer.weights[:-1].copy()
        weights[0] += answer.weights[-1]
        difference = difference_between(method, cloud, outcome, Outcome(weights, answer.status), degree)
        return None if difference is None else f"dividing the first particle into two halves {difference} in total"

    if not method.traits.volume_independent and method.traits.partition_of_unity:
        prove(method, dim, "weights must depend on the volume that is at a place", wrong_with, REGULAR)


def check_locality(method: BoundaryInterpolator, dim: int) -> None:
    """The nearer half of the neighbours has half of sum |Phi_j|, and weights that must not be negative do not grow.

    It is checked with equal volumes and without a lift.
    """
    run = evaluator_of(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        even = np.full(len(cloud), cloud.volumes.mean())
        outcome = run(cloud.changed(volumes=even, lift=np.zeros(dim)))
        if len(cloud) < 8:
            return None
        order = np.argsort(cloud.distances, kind="stable")
        r, weights = cloud.distances[order], outcome.weights[order]
        size = np.abs(weights)
        share = size[: (len(size) + 1) // 2].sum() / max(size.sum(), 1e-300)
        if share < 0.5 - 1e-9:
            return f"the nearer half of the particles has {share:.0%} of the weights"
        grown = np.flatnonzero(np.diff(weights) > 1e-9 * size.max())
        if method.traits.non_negative and len(grown):
            k = grown[0]
            return f"the weight grows from {weights[k]:.6g} at {r[k]:.6g} m to {weights[k + 1]:.6g} at {r[k + 1]:.6g} m"
        return None

    directed = method.traits.evaluation_point is EvaluationPoint.DIRECTED
    if not directed:
        prove(method, dim, "near particles must count more than far ones", wrong_with, ("full support", "lattice"))


class _Rescaled(Kernel):
    """A kernel described with another smoothing length: 3/2 of the support for half as many smoothing lengths."""

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self.support = kernel.support / 1.5  # type: ignore[misc]

    def value_function(self) -> ScalarFunction:
        value = compile_part(self._kernel.value_function())
        return lambda q: value(1.5 * q)

    def gradient_function(self) -> ScalarFunction:
        gradient = compile_part(self._kernel.gradient_function())
        return lambda q: 2.25 * gradient(1.5 * q)

    def normalisation(self, dim: int) -> float:
        return self._kernel.normalisation(dim) * 1.5**dim


class _Steeper(Kernel):
    """A kernel whose derivative is not that of its values, which shows whether weights depend on the derivative."""

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self.support = kernel.support  # type: ignore[misc]

    def value_function(self) -> ScalarFunction:
        return self._kernel.value_function()

    def gradient_function(self) -> ScalarFunction:
        gradient = compile_part(self._kernel.gradient_function())
        return lambda q: (1.0 + 0.3 * q) * gradient(q)

    def normalisation(self, dim: int) -> float:
        return self._kernel.normalisation(dim)


def check_kernel(method: BoundaryInterpolator, dim: int) -> None:
    """The weights are those of the kernel W(r) that is given, however many smoothing lengths its support has.

    A method whose weights are the same for every kernel of equal support declares ``kernel_independent``. One whose
    weights depend on dW/dr declares ``kernel_gradient``; then they must change where the kernel has another derivative
    than its values, as they do not where the derivative of one kernel is written into the method.
    """
    gaussian, other = create("kernels", "gaussian"), create("kernels", "wendland-c2")
    kernels = (gaussian, _Rescaled(gaussian), other, _Steeper(gaussian))
    runs = [evaluator(method, dim, kernel) for kernel in kernels]
    degree, depends, slopes = degree_of(method), False, False
    for family in REGULAR:
        for seed in range(3):
            cloud = build(family, dim, seed, ratio=1.3 if dim == 2 else 1.0, lifted=extrapolates(method))
            cloud = cloud.clear_of_cut_off(CLEAR)
            one, same, another, steeper = (run(cloud) for run in runs)
            difference = difference_between(method, cloud, one, same, degree)
            if difference is not None:
                raise broken(
                    method,
                    dim,
                    "a kernel with the same W(r) but a support of 2 h in place of 3 h"
                    f" {difference}: use kernel.support, not 3",
                    cloud,
                )
            if one.status == another.status == OK:
                alike = np.abs(one.weights - another.weights).max() <= 1e-12
                depends = depends or not alike
            if one.status == steeper.status == OK:
                slopes = slopes or np.abs(one.weights - steeper.weights).max() > 1e-9
    if method.traits.kernel_independent and depends:
        raise broken(method, dim, "the weights depend on the kernel, but kernel_independent is declared")
    if not method.traits.kernel_independent and not depends:
        raise broken(
            method,
            dim,
            "the weights do not depend on the kernel: use kernel_values or the functions of the kernel, or declare"
            " kernel_independent",
        )
    if slopes and not method.traits.kernel_gradient:
        raise broken(method, dim, "the weights depend on kernel.gradient: declare kernel_gradient")
    if method.traits.kernel_gradient and not slopes:
        raise broken(
            method,
            dim,
            "the weights do not depend on kernel.gradient, but kernel_gradient is declared: is the derivative of one"
            " kernel written into the method?",
        )
