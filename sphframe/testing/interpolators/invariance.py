"""Testing: changes of a neighbourhood that must not change the weights of an interpolation method."""

import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.operator import operator
from sphframe.interfaces import BoundaryInterpolator
from sphframe.interfaces.traits import OK
from sphframe.testing.evaluation import Outcome, extrapolates
from sphframe.testing.interpolators.comparison import CLEAR, broken, degree_of, difference_between, evaluator_of
from sphframe.testing.neighbourhoods import REGULAR, SPARSE, Cloud, build, condition
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
    """A tiny displacement of the evaluation point changes the weights little, even if the nearest particle changes."""
    run, degree = evaluator_of(method, dim), degree_of(method)

    def wrong_with(cloud: Cloud) -> str | None:
        if len(cloud) < 2:
            return None
        step = 1e-9 * cloud.support
        first, second = cloud.offsets[np.argsort(cloud.distances, kind="stable")[:2]]
        apart = second - first
        if np.linalg.norm(apart) < 1e-2 * cloud.support:
            return None
        along = apart / np.linalg.norm(apart)
        for centre in (np.zeros(dim), 0.5 * (first + second)):
            near = cloud.changed(cloud.offsets - centre)
            near = near.members(near.distances < 0.999 * cloud.support)
            if len(near) < 2:
                continue
            before = run(near.changed(near.offsets + step * along))
            after = run(near.changed(near.offsets - step * along))
            if (before.status, after.status) != (OK, OK):
                continue
            jump = float(np.max(np.abs(before.weights - after.weights)))
            allowed = min(1e-6 * condition(near, degree), 1e-3) * max(before.magnitude, after.magnitude)
            if not jump <= allowed:
                return (
                    f"near {centre.tolist()}, moving the evaluation point by {2.0 * step:.3g} along {along.tolist()}"
                    f" changes a weight by {jump:.3g}"
                )
        return None

    prove(method, dim, "weights must be continuous in the evaluation point", wrong_with, REGULAR)
